// Means of the texture of one surface, along the rows or along the columns.
#define FLOWTEX_EVEN_BLUR
//#include common/even.glsl

void main()
{
  gl_FragData[0] = vec4(flowtexBlurred(ivec2(gl_FragCoord.xy)), 0.0, 0.0, 0.0);
}
