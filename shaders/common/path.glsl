// Paths from the slice texture.
//
// A layer holds the mean slope since lag zero (see flowtex/textures/texture_set.py): the
// displacement at lag s is s * slope, s negative backward. Between two lags the slope is
// interpolated linearly, which makes the path a parabola and not a polygon.

#ifdef FLOWTEX_TRIANGLES
// A triangle has three nodes wherever they lie in the texture, and its coordinate is the share of the
// second and of the third.
ivec2 flowtexNodes[3]; // their texels

// Comes before all else: numbers of the nodes, which are wrapped into rows.
void flowtexSetCorners(vec3 corners)
{
  int width = int(u_slicesSize.x);
  for (int k = 0; k < 3; ++k)
  {
    int node = int(corners[k] + 0.5);
    flowtexNodes[k] = ivec2(node % width, node / width);
  }
}

vec3 flowtexShares(vec2 coordinate)
{
  return vec3(1.0 - coordinate.x - coordinate.y, coordinate);
}

vec4 flowtexFetch(int corner, int layer)
{
  ivec3 texel = ivec3(flowtexNodes[corner], layer);
#ifdef FLOWTEX_UNSTEADY
  return mix(texelFetch(u_slices, texel, 0), texelFetch(u_slicesNext, texel, 0), u_between);
#else
  return texelFetch(u_slices, texel, 0);
#endif
}

vec4 flowtexLayer(vec2 coordinate, int layer, float level)
{
  vec3 shares = flowtexShares(coordinate);
  return shares.x * flowtexFetch(0, layer) + shares.y * flowtexFetch(1, layer)
    + shares.z * flowtexFetch(2, layer);
}
#elif defined(FLOWTEX_SIGNFREE)
// In a sign-free field the nodes around a fragment may point either way, and filtering would
// cancel them. So the four texels are fetched one by one and those that point against the others
// are reversed: their two sides change places, and their slopes the sign. A coarser level has lost
// what cancels, so it is always the finest, which does no harm but to cost.
ivec2 flowtexTexel;  // lower left one of the four
vec2 flowtexPart;    // how far the fragment is from it to the next
vec4 flowtexSigns;   // -1 for those that are reversed

vec4 flowtexFetch(ivec2 right, int layer, float sign_)
{
  ivec2 texel = clamp(flowtexTexel + right, ivec2(0), ivec2(u_slicesSize) - 1);
  if (sign_ < 0.0 && layer > 0)
    layer += layer > u_lagCount ? -u_lagCount : u_lagCount;
  return texelFetch(u_slices, ivec3(texel, layer), 0) * vec4(vec3(sign_), 1.0);
}

float flowtexTurn(inout vec3 together, ivec2 right)
{
  vec3 tangent = flowtexFetch(right, 0, 1.0).xyz;
  float sign_ = dot(together, tangent) < 0.0 ? -1.0 : 1.0;
  together += sign_ * tangent;
  return sign_;
}

// Layer 0, the tangents, comes first: it says which of the four are reversed.
vec4 flowtexLayer(vec2 coordinate, int layer, float level)
{
  if (layer == 0)
  {
    vec2 at = coordinate * u_slicesSize - 0.5;
    flowtexTexel = ivec2(floor(at));
    flowtexPart = at - floor(at);
    vec3 together = vec3(0.0);
    flowtexSigns.x = flowtexTurn(together, ivec2(0, 0));
    flowtexSigns.y = flowtexTurn(together, ivec2(1, 0));
    flowtexSigns.z = flowtexTurn(together, ivec2(0, 1));
    flowtexSigns.w = flowtexTurn(together, ivec2(1, 1));
  }
  vec4 low = mix(flowtexFetch(ivec2(0, 0), layer, flowtexSigns.x),
                 flowtexFetch(ivec2(1, 0), layer, flowtexSigns.y), flowtexPart.x);
  vec4 high = mix(flowtexFetch(ivec2(0, 1), layer, flowtexSigns.z),
                  flowtexFetch(ivec2(1, 1), layer, flowtexSigns.w), flowtexPart.x);
  return mix(low, high, flowtexPart.y);
}
#else
vec4 flowtexLayer(vec2 coordinate, int layer, float level)
{
  vec3 at = vec3(coordinate, float(layer));
#ifdef FLOWTEX_UNSTEADY
  return mix(textureLod(u_slices, at, level), textureLod(u_slicesNext, at, level), u_between);
#else
  return textureLod(u_slices, at, level);
#endif
}
#endif

#ifdef FLOWTEX_UNCERTAIN
// How far the direction is known, from 0 to 1; layer 0 comes first, as above.
float flowtexKnown(vec2 coordinate, float level)
{
  return 1.0 - flowtexLayer(coordinate, FLOWTEX_UNCERTAIN_LAYER, level).w;
}
#endif
