in vec3 flowtexPositionVSOutput;
in vec2 flowtexCoordinateVSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalVSOutput;
#endif
#ifdef FLOWTEX_TRIANGLES
flat in vec3 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl

uniform bool u_mapped;            // colour by the values of the nodes, or as VTK does
uniform sampler2DArray u_shares;  // of the range of the colour map, and where there is a value
uniform sampler2DArray u_colours; // below the range, in it, above it, and without a value
uniform vec2 u_padding;           // texels of the slices before the first node

vec2 flowtexPlaced; // texture coordinate of the fragment

#ifdef FLOWTEX_PLACED
uniform sampler2DArray u_nodes;   // nodes as positions are given, from the middle of the surface
uniform vec3 u_anchor;            // what positions are counted from there
const float FLOWTEX_PLACE_FAR = 4.0;       // cells beyond which a correction is none
const float FLOWTEX_EXTENT = 1073741824.0; // finest cells of the noise in the size of the surface, 2^30
const float FLOWTEX_LEAST_DEPTH = 1e-6;    // of the size, up to which it is rounding

vec3 flowtexNode(ivec2 node)
{
#ifdef FLOWTEX_PLANAR
  return vec3(texelFetch(u_nodes, ivec3(node, 0), 0).xy, 0.0);
#else
  return texelFetch(u_nodes, ivec3(node, 0), 0).xyz;
#endif
}

// A triangle that covers many cells gives a guess. A step of Newton's method takes the error: to where the
// ray from the eye meets the triangle of the cell, with the derivatives there.
void flowtexPlace(inout vec2 coordinate, inout vec3 position, vec3 dx, vec3 dy, inout vec2 byX, inout vec2 byY)
{
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_nodes, 0).xy - 2);
  vec2 part = at - vec2(cell);
  bool lower = part.x >= part.y;
  vec3 near = flowtexNode(cell);
  vec3 beside = flowtexNode(cell + (lower ? ivec2(1, 0) : ivec2(0, 1)));
  vec3 far = flowtexNode(cell + 1);
  vec3 first = lower ? beside - near : far - beside;
  vec3 second = lower ? far - beside : beside - near;
  mat3 off = mat3(position + u_anchor - near - first * part.x - second * part.y, dx, dy);
  // In sizes of the surface, so that no square is too large or too small for single precision.
  float size = u_noiseFinest * FLOWTEX_EXTENT;
  first /= size;
  second /= size;
  off /= size;
  vec3 normal = cross(first, second);
#ifdef FLOWTEX_PLANAR
  off = mat3(vec3(off[0].xy, 0.0), vec3(dx.xy, 0.0), vec3(dy.xy, 0.0));
#else
  vec3 ray = u_eye.xyz - u_eye.w * position;
  ray /= dot(normal, ray);
  vec3 moved = -dot(normal, off[0]) * ray;
  off -= outerProduct(ray, normal * off);
#endif
  // Where cells have collapsed there is no number.
  mat3x2 cells = transpose(mat2x3(cross(second, normal), cross(normal, first))) * off / dot(normal, normal);
  if (max(abs(cells[0].x), abs(cells[0].y)) <= FLOWTEX_PLACE_FAR)
  {
    flowtexPlaced = coordinate += cells[0] / u_slicesSize;
    byX = cells[1] / u_slicesSize;
    byY = cells[2] / u_slicesSize;
#ifndef FLOWTEX_PLANAR
    if (length(moved) > FLOWTEX_LEAST_DEPTH)
      position += moved * size;
#endif
  }
}
#endif

// Values are interpolated first and mapped then, each entry of the map over an equal share.
vec3 flowtexMapped(vec2 coordinate)
{
#ifdef FLOWTEX_TRIANGLES
  vec3 shares = flowtexShares(coordinate);
  vec2 share = vec2(0.0);
  for (int k = 0; k < 3; ++k)
    share += shares[k] * texelFetch(u_shares, ivec3(flowtexNodes[k], 0), 0).rg;
#else
  vec2 at = (coordinate * u_slicesSize - u_padding) / vec2(textureSize(u_shares, 0).xy);
  vec2 share = textureLod(u_shares, vec3(at, 0.0), 0.0).rg;
#endif
  int count = textureSize(u_colours, 0).x - 3;
  float place = share.x / max(share.y, 0.5);
  int entry = place == 1.0 ? count : int(clamp(floor(place * float(count)), -1.0, float(count))) + 1;
  if (share.y < 0.5)
    entry = count + 2;
  return texelFetch(u_colours, ivec3(entry, 0, 0), 0).rgb;
}
