uniform sampler2D u_cmap;  // FLOWTEX_COLOURS colours

// Where there is no value: nodes without one are given one far below all others.
const vec3 FLOWTEX_NO_VALUE_COLOUR = vec3(0.663);
const float FLOWTEX_NO_VALUE = -1e3;
const float FLOWTEX_ROUNDED_UP = 1.000001; // a value at the border of two colours has the second
const float FLOWTEX_COLOURS = 256.0; // entries of the colour map

// Scalars are interpolated first and mapped then, each entry of the map over an equal share.
vec3 flowtexMapped(float share)
{
  if (share < FLOWTEX_NO_VALUE)
    return FLOWTEX_NO_VALUE_COLOUR;
  int entry = int(clamp(share * FLOWTEX_ROUNDED_UP * FLOWTEX_COLOURS, 0.0, FLOWTEX_COLOURS - 1.0));
  return texelFetch(u_cmap, ivec2(entry, 0), 0).rgb;
}
