// An arrow as the distance in pixels from its outline: a shaft that widens to the head, and barbs.

//#include common/arrow_numbers.glsl

float flowtexArrowDistance(vec2 place, float size)
{
  float head = FLOWTEX_ARROW_HEAD * size;
  float barb = FLOWTEX_ARROW_WIDTH * head;
  float aside = abs(place.y);
  float beyond = place.x - size; // the tip
  float shaft = barb * FLOWTEX_ARROW_SHAFT * clamp(place.x / size, 0.0, 1.0);
  float line = max(max(aside - shaft, -place.x), beyond + 0.5 * head);
  float flank = (beyond * barb + aside * head) * inversesqrt(barb * barb + head * head);
  float back = -beyond - head * (1.0 - FLOWTEX_ARROW_SWEPT * (1.0 - aside / barb));
  return min(line, max(flank, back));
}

// A dark arrow with a light edge, or with `tint` one of its colour with a dark edge.
vec4 flowtexArrow(vec2 place, float size, vec4 tint)
{
  float away = flowtexArrowDistance(place, size);
  float core = clamp(0.5 - away, 0.0, 1.0);
  float whole = clamp(0.5 + FLOWTEX_ARROW_OUTLINE - away, 0.0, 1.0);
  float halo = whole * FLOWTEX_ARROW_OUTLINE_OPACITY;
  vec3 inside = mix(FLOWTEX_ARROW_DARK, tint.rgb, tint.a);
  vec3 edge = mix(FLOWTEX_ARROW_LIGHT, FLOWTEX_ARROW_DARK, tint.a);
  return vec4(mix(edge, inside, core), mix(halo, 1.0, core));
}
