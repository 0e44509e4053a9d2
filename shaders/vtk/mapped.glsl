uniform sampler2DArray u_shares;  // of the range of the colour map, and where there is a value
uniform sampler2DArray u_colours; // below the range, in it, above it, and without a value
uniform vec2 u_padding;           // texels of the slices before the first node
uniform bool u_flat;              // values belong to cells: shares lie at first nodes, or at triangles

const float FLOWTEX_ROUNDED_UP = 1.000001;
int flowtexTriangleNumber; // number of the triangle

// Values of nodes are interpolated first and mapped then, each entry of the map over an equal share.
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
  int count = textureSize(u_colours, 0).x - 3;
  float place = share.x / max(share.y, 0.5);
  place = min(place * FLOWTEX_ROUNDED_UP, max(place, 1.0)); // a value at the border of two colours has the second
  int entry = place == 1.0 ? count : int(clamp(floor(place * float(count)), -1.0, float(count))) + 1;
  if (share.y < 0.5)
    entry = count + 2;
  return texelFetch(u_colours, ivec3(entry, 0, 0), 0).rgb;
}
