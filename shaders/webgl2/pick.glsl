// What lies under the pointer: the bits of the texture coordinate, and that there is something.

in vec2 flowtexCoordinateOut;
out uvec4 flowtexOut;

void main()
{
  flowtexOut = uvec4(floatBitsToUint(flowtexCoordinateOut), 0u, 1u);
}
