uniform bool u_mapped;      // colour by the values of the nodes, or as VTK does,
uniform bool u_plain;       // or in one colour, as arrows have the others
uniform vec3 u_plainColour; // that of the surface

//#include vtk/mapped.glsl

// A colour, unless there is another one, below the texture.
vec3 flowtexBelow(vec3 colour, vec2 coordinate)
{
  if (u_mapped)
    colour = flowtexMapped(coordinate);
  if (u_plain)
    colour = u_plainColour;
  if (u_showLevel)
    colour = flowtexLevelColour(flowtexNoiseLevel);
  return colour;
}
