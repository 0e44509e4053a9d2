// The texture of a fragment from its varyings. Called outside of any branch: derivatives are not
// defined behind one.

#ifdef FLOWTEX_PAPER
float flowtexValue(vec2 coordinate, vec2 noise)
{
  float level = flowtexSliceLevel(flowtexDx(coordinate), flowtexDy(coordinate));
  return flowtexFragment(coordinate, noise, flowtexDx(noise), flowtexDy(noise), level);
}
#else
#ifdef FLOWTEX_PLACED
void flowtexPlace(inout vec2 coordinate, inout vec3 position, inout vec3 normal, vec3 dx, vec3 dy,
                  inout vec2 byX, inout vec2 byY);
#endif

float flowtexValue(vec2 coordinate, vec3 position, vec3 normal)
{
  vec2 byX = flowtexDx(coordinate);
  vec2 byY = flowtexDy(coordinate);
  // Relative to a point near the view: fewer digits are lost.
  vec3 dx = flowtexDx(position - u_noiseOrigin);
  vec3 dy = flowtexDy(position - u_noiseOrigin);
#ifdef FLOWTEX_PLACED
  flowtexPlace(coordinate, position, normal, dx, dy, byX, byY);
#endif
#if defined(FLOWTEX_TRIANGLES) && defined(FLOWTEX_CELLS) || defined(FLOWTEX_SPARSE)
  flowtexSetBy(dx, dy, byX, byY);
#endif
#ifndef FLOWTEX_PLANAR
  dx = flowtexOnSurface(dx, position, normal);
  dy = flowtexOnSurface(dy, position, normal);
#endif
  return flowtexFragment(position, dx, dy, coordinate, flowtexSliceLevel(byX, byY));
}
#endif
