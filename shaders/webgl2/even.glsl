// One step towards the local mean of the texture.

//#include common/even.glsl

out float flowtexOut;

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef FLOWTEX_EVEN_BLOCKS
  flowtexOut = flowtexBlock(texel);
#else
  flowtexOut = flowtexBlurred(texel);
#endif
}
