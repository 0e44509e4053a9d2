// The texture of a fragment, and the factor by which it is shown.

//#include common/place.glsl

#ifdef FLOWTEX_IMAGE
// Called outside of any branch: derivatives are not defined behind one.
vec2 flowtexValue(vec2 coordinate, vec2 at)
{
  float level = flowtexSliceLevel(flowtexDx(coordinate), flowtexDy(coordinate));
  return flowtexFragment(coordinate, at, flowtexDx(at), flowtexDy(at), level);
}
#else
vec2 flowtexValueAt(FlowtexPlace place)
{
#if defined(FLOWTEX_TRIANGLES) && defined(FLOWTEX_CELLS) || defined(FLOWTEX_SPARSE)
  flowtexSetBy(place.dx, place.dy, place.byX, place.byY);
#endif
  vec3 dx = place.dx;
  vec3 dy = place.dy;
#ifndef FLOWTEX_PLANAR
  dx = flowtexOnSurface(dx, place.position, place.normal);
  dy = flowtexOnSurface(dy, place.position, place.normal);
#endif
  vec2 value = flowtexFragment(place.position, dx, dy, place.coordinate, flowtexSliceLevel(place.byX, place.byY));
  return vec2(value.x, value.y * place.rim);
}

#ifndef FLOWTEX_DEFERRED
// From varyings, outside of any branch.
vec2 flowtexValue(inout vec2 coordinate, vec3 position)
{
  // Relative to a point near the view: fewer digits are lost.
  vec3 dx = flowtexDx(position - u_noiseOrigin);
  vec3 dy = flowtexDy(position - u_noiseOrigin);
  FlowtexPlace place = flowtexPlaceOn(position, dx, dy, coordinate);
  coordinate = place.coordinate;
  return flowtexValueAt(place);
}
#endif
#endif
