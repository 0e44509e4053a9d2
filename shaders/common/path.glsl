// Paths from the slice texture.
//
// A layer holds the mean slope since lag zero (see flowtex/textures/texture_set.py): the
// displacement at lag s is s * slope, s negative backward. Between two lags the slope is
// interpolated linearly, which makes the path a parabola and not a polygon.

#ifdef FLOWTEX_SIGNFREE
// In a field without a sign the nodes around a fragment may point either way, and filtering would
// cancel them. So the four texels are fetched one by one and those that point against the others
// are turned over: their two sides change places, and their slopes the sign. A coarser level has
// lost what cancels, so it is always the finest, which does no harm but to cost.
ivec2 flowtexTexel;  // lower left one of the four
vec2 flowtexPart;    // how far the fragment is from it to the next
vec4 flowtexSigns;   // -1 for those that are turned over

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

// Layer 0, the tangents, comes first: it says which of the four are turned over.
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

// A path followed outward from lag zero, one side at a time.
struct FlowtexPath
{
  vec2 coordinate;
  float level;
  int first;   // layer before the side's first slice
  int segment; // slices passed so far
  vec3 before; // slopes at both ends of the present segment
  vec3 after;
  float from;  // lags at both ends
  float to;
};

FlowtexPath flowtexStart(vec2 coordinate, float level, vec3 tangent, vec3 next, int first)
{
  return FlowtexPath(coordinate, level, first, 0, tangent, next, 0.0, u_lags[0]);
}

// Displacement at a lag that is not smaller than that of the call before.
vec3 flowtexFollow(inout FlowtexPath path, float lag)
{
  while (lag > path.to && path.segment < u_lagCount - 1)
  {
    path.segment += 1;
    path.before = path.after;
    path.after = flowtexLayer(path.coordinate, path.first + path.segment + 1, path.level).xyz;
    path.from = path.to;
    path.to = u_lags[path.segment];
  }
  float late = (lag - path.from) / (path.to - path.from);
  return lag * mix(path.before, path.after, late);
}

// Speed of the particle at that lag: length of the derivative of lag * slope(lag).
float flowtexSpeed(FlowtexPath path, float lag)
{
  vec3 bend = (path.after - path.before) / (path.to - path.from);
  return length(path.before + bend * (2.0 * lag - path.from));
}
