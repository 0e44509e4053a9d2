// Around a pole cells have no width, and rates along them no bound: a path is followed in the plane that
// touches the surface there, in cells towards the pole, as flowtex/trace/sampler.py does.

//#include common/constants.glsl

#ifdef FLOWTEX_POLES
// Angle in the plane, and length, of a cell along each line to a pole; and the line before a share of a turn.
uniform highp sampler2D u_rays;
// The line of a pole, 1 where lines grow away from it and -1 where they fall, else 0; cells around it within
// which the plane is used; and how many lines further the velocities in the plane lie.
uniform vec4 u_poles[2];
uniform float u_polar; // 1 where j leads to the poles, 0 where i does

// A position as that around the poles and across.
vec2 flowtexTurned(vec2 at)
{
  return u_polar > 0.5 ? at : at.yx;
}

// Number of the pole in whose plane a path at a position is followed, -1 for none.
int flowtexPole(vec2 at)
{
  float across = flowtexTurned(at).y;
  for (int n = 0; n < 2; ++n)
    if (u_poles[n].y != 0.0 && (across - u_poles[n].x) * u_poles[n].y < u_poles[n].z)
      return n;
  return -1;
}

vec3 flowtexRay(int pole, float line)
{
  return texelFetch(u_rays, ivec2(int(line), pole), 0).xyz;
}

// From index space to the plane of a pole; elsewhere nothing changes.
vec2 flowtexEnter(int pole, vec2 at)
{
  if (pole < 0)
    return at;
  float cells = float(textureSize(u_rays, 0).x - 1);
  vec2 place = flowtexTurned(at);
  float around = clamp(place.x - cells * floor(place.x / cells), 0.0, cells);
  float line = min(floor(around), cells - 1.0);
  vec3 ray = mix(flowtexRay(pole, line), flowtexRay(pole, line + 1.0), around - line);
  return abs(place.y - u_poles[pole].x) * ray.y * vec2(cos(ray.x), sin(ray.x));
}

// And back.
vec2 flowtexLeave(int pole, vec2 place)
{
  if (pole < 0)
    return place;
  float cells = float(textureSize(u_rays, 0).x - 1);
  float first = flowtexRay(pole, 0.0).x;
  float angle = place == vec2(0.0) ? first : atan(place.y, place.x);
  angle += 2.0 * FLOWTEX_PI * ceil((first - angle) / (2.0 * FLOWTEX_PI));
  float turn = (angle - first) / (2.0 * FLOWTEX_PI);
  float line = flowtexRay(pole, clamp(floor(turn * cells), 0.0, cells - 1.0)).z;
  while (line < cells - 1.0 && angle >= flowtexRay(pole, line + 1.0).x)
    line += 1.0;
  vec3 low = flowtexRay(pole, line);
  vec3 high = flowtexRay(pole, line + 1.0);
  float share = clamp((angle - low.x) / (high.x - low.x), 0.0, 1.0);
  float depth = length(place) / mix(low.y, high.y, share);
  return flowtexTurned(vec2(line + share, u_poles[pole].x + u_poles[pole].y * depth));
}

// What to add to a node for the velocity in the plane.
ivec2 flowtexShift(int pole)
{
  return pole < 0 ? ivec2(0) : ivec2(flowtexTurned(vec2(0.0, u_poles[pole].w)));
}
#else
int flowtexPole(vec2 at)
{
  return -1;
}

vec2 flowtexEnter(int pole, vec2 at)
{
  return at;
}

vec2 flowtexLeave(int pole, vec2 place)
{
  return place;
}

ivec2 flowtexShift(int pole)
{
  return ivec2(0);
}
#endif
