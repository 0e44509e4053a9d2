// A rectangle of the picture.
in vec4 vertexMC;
in vec2 tcoordMC;

void main()
{
  gl_Position = vec4(vertexMC.xy, tcoordMC.x, 1.0); // no depth counts, but VTK complains of what is not used
}
