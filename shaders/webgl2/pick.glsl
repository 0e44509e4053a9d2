// What lies under the pointer: the bits of the texture coordinate, in which part of the surface, and
// that there is something.

in vec2 flowtexCoordinateOut;
uniform int u_part;
out uvec4 flowtexOut;

void main()
{
  flowtexOut = uvec4(floatBitsToUint(flowtexCoordinateOut), uint(u_part), 1u);
}
