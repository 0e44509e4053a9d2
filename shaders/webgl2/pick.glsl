// What lies under the pointer: the bits of the texture coordinate, in which part of the surface, and
// that there is something: 1, and in a surface of triangles the number of the one more.

in vec2 flowtexCoordinateOut;
#ifdef FLOWTEX_TRIANGLES
flat in highp int flowtexTriangleOut;
#endif
uniform int u_part;
out uvec4 flowtexOut;

void main()
{
  uint there = 1u;
#ifdef FLOWTEX_TRIANGLES
  there += uint(flowtexTriangleOut);
#endif
  flowtexOut = uvec4(floatBitsToUint(flowtexCoordinateOut), uint(u_part), there);
}
