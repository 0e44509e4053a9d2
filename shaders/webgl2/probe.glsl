// Texels of the slices as the bits of their numbers: a column for each of some, and a row for each layer.

uniform highp sampler2DArray u_slices;
uniform vec2 u_texels[4];
out uvec4 flowtexOut;

void main()
{
  ivec2 at = ivec2(gl_FragCoord.xy);
  flowtexOut = floatBitsToUint(texelFetch(u_slices, ivec3(u_texels[at.x], at.y), 0));
}
