// The pixels of one surface as they are shown: the colour under the texture, and the texture without its
// local mean.
#define FLOWTEX_EVEN_LAID

uniform sampler2D u_sums;    // colour and texture of each pixel
uniform sampler2D u_texture; // texture before it fades, and the factor by which it does: negative off the surface
//#include common/uniforms.glsl
//#include common/shade.glsl
//#include common/even.glsl

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float share = texelFetch(u_texture, texel, 0).g;
  if (share < 0.0)
    discard;
  vec4 sum = texelFetch(u_sums, texel, 0);
  float value = sum.a;
  if (u_even)
    value -= share * flowtexMeanAround(texel);
  gl_FragData[0] = vec4(flowtexShade(sum.rgb, value), value);
}
