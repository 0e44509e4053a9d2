// Mip levels of textures that lie on the parameters of the surface.

// Texels of a texture that a pixel covers.
float flowtexCovered(vec2 dx, vec2 dy, vec2 size)
{
  vec2 footprint = flowtexFootprint(vec3(dx * size, 0.0), vec3(dy * size, 0.0));
  return sqrt(footprint.x * footprint.y);
}

// Level at which a texel is as wide as so many of the finest level.
float flowtexMip(float texels)
{
  return u_lod ? max(log2(max(texels, FLOWTEX_LEAST_TEXELS)), 0.0) : 0.0;
}
