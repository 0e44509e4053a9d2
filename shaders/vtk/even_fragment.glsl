// One step of the subtraction of the local mean, from the sums of one surface.

//#include common/even.glsl

#ifdef FLOWTEX_EVEN_LAID
uniform sampler2D u_texture; // texture before it fades, and the factor by which it does
#endif

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef FLOWTEX_EVEN_BLUR
  gl_FragData[0] = vec4(flowtexBlurred(texel), 0.0, 0.0, 0.0);
#else
  // Added to the texture as it is shown.
  float share = texelFetch(u_texture, texel, 0).g;
  gl_FragData[0] = vec4(0.0, 0.0, 0.0, -share * flowtexMeanAround(texel));
#endif
}
