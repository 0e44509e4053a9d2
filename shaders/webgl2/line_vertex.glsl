// A piece of a line on the surface: a strip of four corners around it, as wide as the line and its
// smooth sides. Pieces that follow one another meet at one edge, so that none is drawn twice.

layout(location = 0) in vec3 flowtexBefore; // in the surface's own frame, from u_anchor of the client
layout(location = 1) in vec3 flowtexFrom;
layout(location = 2) in vec3 flowtexTo;
layout(location = 3) in vec3 flowtexAfter;

uniform mat4 u_matrix;
uniform vec2 u_picture;  // width and height in pixels
uniform float u_width;   // of the line, in pixels
uniform vec4 u_horizon;  // plane before which a globe is seen; flat maps have one behind all

out float flowtexAcross; // pixels from the middle of the line
out float flowtexSeen;

const float FLOWTEX_BREAK = 1e29;     // coordinates above are no point: a line begins or ends
const float FLOWTEX_SHARPEST = 0.4;   // cosine of half a turn beyond which corners are cut

// Place in the picture in pixels, and whether it is one.
bool flowtexPlace(vec3 point, out vec2 place)
{
  vec4 clip = u_matrix * vec4(point, 1.0);
  place = 0.5 * u_picture * clip.xy / clip.w;
  return abs(point.x) < FLOWTEX_BREAK && clip.w > 0.0;
}

void main()
{
  bool isEnd = gl_VertexID > 1;
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  vec2 from, to, other;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside
  flowtexAcross = flowtexSeen = 0.0;
  if (!flowtexPlace(flowtexFrom, from) || !flowtexPlace(flowtexTo, to) || from == to)
    return;
  vec2 along = normalize(to - from);
  bool isJoined = flowtexPlace(isEnd ? flowtexAfter : flowtexBefore, other);
  vec2 next = isEnd ? other - to : from - other;
  vec2 sum = along + (isJoined && dot(next, next) > 0.0 ? normalize(next) : along);
  vec2 mean = length(sum) > 2.0 * FLOWTEX_SHARPEST ? normalize(sum) : along;
  float reach = 0.5 * u_width + 0.5;
  vec2 place = (isEnd ? to : from) + vec2(-mean.y, mean.x) * (side * reach / dot(mean, along));
  if (!isJoined)
    place += along * (isEnd ? 0.5 : -0.5) * u_width; // a ring closes
  gl_Position = vec4(place / (0.5 * u_picture), 0.0, 1.0);
  flowtexAcross = side * reach;
  flowtexSeen = dot(u_horizon.xyz, isEnd ? flowtexTo : flowtexFrom) + u_horizon.w;
}
