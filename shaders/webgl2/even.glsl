// One step towards the local mean of the texture.
#define FLOWTEX_EVEN_BLUR

//#include common/even.glsl

out float flowtexOut;

void main()
{
  flowtexOut = flowtexBlurred(ivec2(gl_FragCoord.xy));
}
