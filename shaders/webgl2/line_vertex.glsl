// A piece of a line on the surface, or of a body beside it, as a strip of four corners around it. A mark is
// a body of one colour that lies nearer than the surface, by a share of the distance.

layout(location = 0) in vec3 flowtexFrom; // in the surface's own frame
layout(location = 1) in vec3 flowtexTo;
#ifdef FLOWTEX_BODY
layout(location = 2) in vec4 flowtexFromColour;
layout(location = 3) in vec4 flowtexToColour;
out vec4 flowtexColourOut;
#endif

uniform mat4 u_matrix;
uniform vec3 u_anchor; // zero where positions are counted from it
#ifdef FLOWTEX_MARK
uniform vec4 u_eye; // as in common/uniforms.glsl
uniform float u_nearer;
#endif
uniform vec2 u_picture; // width and height in pixels
uniform float u_width;  // of the line, in pixels
uniform vec4 u_horizon; // plane before which a globe is seen; on flat maps it is positive

out vec2 flowtexPlace;  // pixels along the piece and across
out float flowtexSize;  // its length
out float flowtexSeen;

const float FLOWTEX_BREAK = 1e29; // coordinates above are not a point: a line begins or ends

#ifdef FLOWTEX_MARK
// Depth of a point that is brought nearer, where it is not cut off.
float flowtexNearerDepth(vec3 point, float w)
{
  vec4 nearer = u_matrix * vec4(point + u_nearer * (u_eye.xyz - u_eye.w * point), 1.0);
  return max(nearer.z / nearer.w, -0.999) * w;
}
#endif

void main()
{
  bool isEnd = gl_VertexID > 1;
  vec4 from = u_matrix * vec4(flowtexFrom - u_anchor, 1.0);
  vec4 to = u_matrix * vec4(flowtexTo - u_anchor, 1.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside
  flowtexPlace = vec2(0.0);
  flowtexSize = flowtexSeen = 0.0;
  if (max(abs(flowtexFrom.x), abs(flowtexTo.x)) > FLOWTEX_BREAK)
    return;
#ifdef FLOWTEX_MARK
  from.z = flowtexNearerDepth(flowtexFrom - u_anchor, from.w);
  to.z = flowtexNearerDepth(flowtexTo - u_anchor, to.w);
#endif
#ifdef FLOWTEX_BODY
  // What lies before the nearest depth is cut off.
  float nearFrom = from.z + from.w, nearTo = to.z + to.w;
  if (max(nearFrom, nearTo) <= 0.0)
    return;
  if (nearFrom < 0.0)
    from = mix(from, to, nearFrom / (nearFrom - nearTo));
  else if (nearTo < 0.0)
    to = mix(to, from, nearTo / (nearTo - nearFrom));
#else
  if (min(from.w, to.w) <= 0.0)
    return;
#endif
  vec2 start = 0.5 * u_picture * from.xy / from.w, way = 0.5 * u_picture * to.xy / to.w - start;
  flowtexSize = length(way);
  vec2 along = flowtexSize > 0.0 ? way / flowtexSize : vec2(1.0, 0.0);
  // Half a pixel more, on which it fades.
  float reach = 0.5 * u_width + 0.5;
  float side = float(gl_VertexID & 1) * 2.0 - 1.0;
  flowtexPlace = vec2(isEnd ? flowtexSize + reach : -reach, side * reach);
  vec2 corner = start + along * flowtexPlace.x + vec2(-along.y, along.x) * flowtexPlace.y;
  gl_Position = vec4(corner / (0.5 * u_picture), 0.0, 1.0);
#ifdef FLOWTEX_BODY
  gl_Position.z = isEnd ? to.z / to.w : from.z / from.w;
  flowtexColourOut = isEnd ? flowtexToColour : flowtexFromColour;
#endif
  flowtexSeen = dot(u_horizon.xyz, isEnd ? flowtexTo : flowtexFrom) + u_horizon.w;
}
