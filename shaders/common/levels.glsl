#ifndef FLOWTEX_PLANAR
// A derivative of position on the screen as it is on the smooth surface, not on its flat facets,
// whose slants would show as steps of the level where the surface is seen at a grazing angle.
// What is added lies along the ray to the eye, so it does not move on the screen.
vec3 flowtexOnSurface(vec3 derivative, vec3 position, vec3 normal)
{
  vec3 ray = normalize(u_eye.xyz - u_eye.w * position);
  float facing = dot(normalize(normal), ray);
  facing = (facing < 0.0 ? -1.0 : 1.0) * max(abs(facing), FLOWTEX_LEAST_FACING);
  return derivative - ray * (dot(normalize(normal), derivative) / facing);
}
#endif

// Level of the slice texture for a footprint in its texels.
//
// The shorter side of the footprint decides: the paths are smooth in space, so a level too fine
// does no harm, while a level too coarse would average cells that lie many pixels apart where
// cells are long and thin.
float flowtexSliceLevel(vec2 dx, vec2 dy)
{
#ifdef FLOWTEX_TRIANGLES
  return 0.0; // other levels are other meshes
#else
  if (!u_lod)
    return 0.0;
  vec2 footprint = flowtexFootprint(vec3(dx * u_slicesSize, 0.0), vec3(dy * u_slicesSize, 0.0));
  return clamp(log2(max(footprint.y, FLOWTEX_LEAST_TEXELS)), 0.0, u_deepest);
#endif
}
