// The texture of a fragment from its varyings. Called outside of any branch: derivatives are not
// defined behind one.

#ifdef FLOWTEX_PAPER
float flowtexValue(vec2 coordinate, vec2 noise)
{
  float level = flowtexSliceLevel(flowtexDx(coordinate), flowtexDy(coordinate));
  return flowtexFragment(coordinate, noise, flowtexDx(noise), flowtexDy(noise), level);
}
#else
float flowtexValue(vec2 coordinate, vec3 position, vec3 normal)
{
  vec2 byX = flowtexDx(coordinate);
  vec2 byY = flowtexDy(coordinate);
  float level = flowtexSliceLevel(byX, byY);
  // Relative to a point near the view: fewer digits are lost.
  vec3 dx = flowtexDx(position - u_noiseOrigin);
  vec3 dy = flowtexDy(position - u_noiseOrigin);
#if defined(FLOWTEX_TRIANGLES) && defined(FLOWTEX_CELLS)
  flowtexSetSharesBy(dx, dy, byX, byY);
#endif
#ifndef FLOWTEX_PLANAR
  dx = flowtexOnSurface(dx, position, normal);
  dy = flowtexOnSurface(dy, position, normal);
#endif
  return flowtexFragment(position, dx, dy, coordinate, level);
}
#endif
