uniform sampler2DArray u_shares;  // of the range of the colour map, and where there is a value
uniform sampler2DArray u_colours;
uniform bool u_flat;              // values belong to cells: shares lie at first nodes, or at triangles

int flowtexTriangleNumber; // number of the triangle

int flowtexColourCount()
{
  return textureSize(u_colours, 0).x;
}

vec4 flowtexColourOf(int n)
{
  return texelFetch(u_colours, ivec3(n, 0, 0), 0);
}

//#include common/mapped.glsl

// Values of nodes are interpolated first and mapped then.
vec3 flowtexMapped(vec2 coordinate)
{
  ivec2 size = textureSize(u_shares, 0).xy;
#ifdef FLOWTEX_TRIANGLES
  vec3 shares = flowtexShares(coordinate);
  vec2 share = vec2(0.0);
  if (u_flat)
    share = texelFetch(u_shares, ivec3(flowtexTriangleNumber % size.x, flowtexTriangleNumber / size.x, 0), 0).rg;
  else for (int k = 0; k < 3; ++k)
    share += shares[k] * texelFetch(u_shares, ivec3(flowtexNodes[k], 0), 0).rg;
#else
  vec2 at = coordinate * u_slicesSize - u_padding;
  ivec2 cell = clamp(ivec2(floor(at - 0.5)), ivec2(0), size - 2);
  vec2 share = u_flat ? texelFetch(u_shares, ivec3(cell, 0), 0).rg
    : textureLod(u_shares, vec3(at / vec2(size), 0.0), 0.0).rg;
#endif
  return flowtexColourAt(share.x / max(share.y, 0.5), share.y >= 0.5);
}
