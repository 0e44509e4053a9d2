// What lies under the flow: cells of a map or a globe, or a globe as the disc that its horizon bounds, which is
// hidden by all that is seen of the flow, and hides the rest.

#ifdef FLOWTEX_GLOBE
uniform vec3 u_middle;   // of the disc
uniform vec3 u_aside;    // its half axes
uniform vec3 u_upward;
out vec2 flowtexPlaceOut;
out vec2 flowtexDepthOut; // as z and w
#else
layout(location = 0) in vec3 flowtexPosition;
#ifdef FLOWTEX_ROUND
uniform vec3 u_middle;   // of the Earth
out vec3 flowtexOutwardOut;
#endif
#endif
uniform mat4 u_matrix;

void main()
{
#ifdef FLOWTEX_GLOBE
  flowtexPlaceOut = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 position = u_middle + flowtexPlaceOut.x * u_aside + flowtexPlaceOut.y * u_upward;
#else
  vec3 position = flowtexPosition;
#ifdef FLOWTEX_ROUND
  flowtexOutwardOut = position - u_middle;
#endif
#endif
  gl_Position = u_matrix * vec4(position, 1.0);
#ifdef FLOWTEX_GLOBE
  // A globe may be larger than the flow, by which the nearest and the farthest depth are chosen.
  flowtexDepthOut = gl_Position.zw;
  gl_Position.z = 0.0;
#endif
}
