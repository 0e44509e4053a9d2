// A vertex of a mesh that stands beside the flow.

layout(location = 0) in vec3 flowtexPosition; // in the surface's own frame, from its middle
layout(location = 1) in vec3 flowtexNormal;   // zero of a flat face
layout(location = 2) in vec4 flowtexColour;

uniform mat4 u_matrix;
uniform vec3 u_anchor;

out vec3 flowtexPositionOut;
out vec3 flowtexNormalOut;
out vec4 flowtexColourOut;

void main()
{
  flowtexPositionOut = flowtexPosition - u_anchor;
  flowtexNormalOut = flowtexNormal;
  flowtexColourOut = flowtexColour;
  gl_Position = u_matrix * vec4(flowtexPositionOut, 1.0);
}
