// Level of the slice texture for a footprint in its texels.
//
// The shorter side of the footprint decides: the paths are smooth in space, so a level too fine
// does no harm, while a level too coarse would average cells that lie many pixels apart where
// cells are long and thin.
float flowtexSliceLevel(vec2 dx, vec2 dy)
{
  if (!u_lod)
    return 0.0;
  vec2 sx = dx * u_slicesSize;
  vec2 sy = dy * u_slicesSize;
  float determinant = sx.x * sy.y - sx.y * sy.x;
  vec2 footprint = flowtexFootprint(dot(sx, sx), dot(sy, sy), determinant);
  return clamp(log2(max(footprint.y, 1e-6)), 0.0, u_deepest);
}
