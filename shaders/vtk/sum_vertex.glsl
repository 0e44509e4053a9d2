// A rectangle of the picture, at the depth of a layer.
in vec4 vertexMC;
in vec2 tcoordMC;
uniform float u_depth;

void main()
{
  // VTK complains of an attribute that is not used; this one is never negative.
  gl_Position = vec4(vertexMC.xy, u_depth + min(tcoordMC.x, 0.0), 1.0);
}
