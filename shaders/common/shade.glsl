// Colour with the texture laid over it, in Oklab (Ottosson 2020), where lightness is one number.
//
// The lightness of every colour is first drawn towards the middle, by one straight line for all,
// so that there is room for the texture below and above it; then the texture goes up and down from
// there by the same amount everywhere. The mean lightness over many grains is thus on that line,
// and a colour map that grows lighter still does. Hue stays; chroma shrinks towards black and white
// as the room for it does.

vec3 flowtexToOklab(vec3 colour)
{
  vec3 c = clamp(colour, 0.0, 1.0);
  vec3 linear = mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
  vec3 lms = mat3(0.4122214708, 0.2119034982, 0.0883024619,
                  0.5363325363, 0.6806995451, 0.2817188376,
                  0.0514459929, 0.1073969566, 0.6299787005) * linear;
  lms = pow(lms, vec3(1.0 / 3.0));
  return mat3(0.2104542553, 1.9779984951, 0.0259040371,
              0.7936177850, -2.4285922050, 0.7827717662,
              -0.0040720468, 0.4505937099, -0.8086757660) * lms;
}

vec3 flowtexFromOklab(vec3 lab)
{
  vec3 lms = mat3(1.0, 1.0, 1.0,
                  0.3963377774, -0.1055613458, -0.0894841775,
                  0.2158037573, -0.0638541728, -1.2914855480) * lab;
  lms = lms * lms * lms;
  vec3 linear = mat3(4.0767416621, -1.2684380046, -0.0041960863,
                     -3.3077115913, 2.6097574011, -0.7034186147,
                     0.2309699292, -0.3413193965, 1.7076147010) * lms;
  linear = clamp(linear, 0.0, 1.0);
  return mix(linear * 12.92, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, linear));
}

// Lightness between black (0) and white (1) of a value of the texture, 0 without one.
float flowtexTone(float value)
{
  return 2.0 / (1.0 + exp(-1.1 * u_contrast * value)) - 1.0;
}

vec3 flowtexShade(vec3 colour, float value)
{
  vec3 lab = flowtexToOklab(colour);
  float base = mix(lab.x, mix(0.36, 0.80, lab.x), u_strength);
  float light = clamp(base + 0.34 * u_strength * flowtexTone(value), 0.0, 1.0);
  float room = light < base ? light / max(base, 1e-6) : (1.0 - light) / max(1.0 - base, 1e-6);
  return flowtexFromOklab(vec3(light, lab.yz * room));
}
