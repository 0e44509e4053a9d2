// Colour with the texture laid over it, in Oklab (Ottosson 2020), where lightness is one number.
//
// The lightness of every colour is first drawn towards the middle, by one straight line for all,
// so that there is room for the texture below and above it; then the texture goes up and down from
// there by the same amount everywhere. The mean lightness over many grains is thus on that line,
// and a colour map that grows lighter still does. Hue and chroma stay; where sRGB has no such colour,
// the grey of the same lightness is mixed in until it has.

vec3 flowtexToOklab(vec3 colour)
{
  vec3 c = clamp(colour, 0.0, 1.0);
  vec3 curved = pow((c + FLOWTEX_SRGB_OFFSET) / FLOWTEX_SRGB_SCALE, vec3(FLOWTEX_SRGB_POWER));
  vec3 linear = mix(c / FLOWTEX_SRGB_SLOPE, curved, step(FLOWTEX_SRGB_KNEE, c));
  vec3 lms = FLOWTEX_TO_CONES * linear;
  return FLOWTEX_TO_LAB * pow(lms, vec3(1.0 / 3.0));
}

vec3 flowtexFromOklab(vec3 lab)
{
  vec3 lms = FLOWTEX_FROM_LAB * lab;
  vec3 linear = FLOWTEX_FROM_CONES * (lms * lms * lms);
  vec3 grey = vec3(lab.x * lab.x * lab.x);
  vec3 chroma = linear - grey;
  vec3 room = abs(step(0.0, chroma) - grey) / max(abs(chroma), FLOWTEX_LEAST_CHROMA);
  linear = clamp(grey + min(min(min(room.r, room.g), room.b), 1.0) * chroma, 0.0, 1.0);
  vec3 curved = FLOWTEX_SRGB_SCALE * pow(linear, vec3(1.0 / FLOWTEX_SRGB_POWER)) - FLOWTEX_SRGB_OFFSET;
  return mix(linear * FLOWTEX_SRGB_SLOPE, curved, step(FLOWTEX_SRGB_LINEAR_KNEE, linear));
}

// Lightness between black (0) and white (1) of a value of the texture, 0 without one.
float flowtexTone(float value)
{
  return 2.0 / (1.0 + exp(-FLOWTEX_TONE_SLOPE * u_contrast * value)) - 1.0;
}

vec3 flowtexShade(vec3 colour, float value)
{
  vec3 lab = flowtexToOklab(colour);
  float base = mix(lab.x, mix(FLOWTEX_BASE_DARK, FLOWTEX_BASE_LIGHT, lab.x), u_strength);
  float light = clamp(base + FLOWTEX_TONE_RANGE * u_strength * flowtexTone(value), 0.0, 1.0);
  return flowtexFromOklab(vec3(light, lab.yz));
}

// A colour for a level of detail, for teaching: one hue for each doubling, six in a round.
vec3 flowtexLevelColour(float level)
{
  vec3 turn = level / FLOWTEX_LEVELS_AROUND + FLOWTEX_HUE_SHIFT * vec3(0.0, -1.0, 1.0);
  vec3 hue = 0.5 + 0.5 * cos(2.0 * FLOWTEX_PI * turn);
  return mix(vec3(FLOWTEX_LEVEL_DARKEST), vec3(1.0), hue);
}
