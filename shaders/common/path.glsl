// Paths from the slice texture.
//
// A layer holds the mean slope since lag zero (see flowtex/textures/textureset.py): the
// displacement at lag s is s * slope, s negative backward. Between two lags the slope is
// interpolated linearly, which makes the path a parabola and not a polygon.

vec4 flowtexLayer(vec2 coordinate, int layer, float level)
{
  vec3 at = vec3(coordinate, float(layer));
#ifdef FLOWTEX_UNSTEADY
  return mix(textureLod(u_slices, at, level), textureLod(u_slicesNext, at, level), u_between);
#else
  return textureLod(u_slices, at, level);
#endif
}

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
