// The colour of a pixel of a layer: below the texture, with the texture less its local mean, and in the light.
#define FLOWTEX_EVEN_LAID

//#include common/uniforms.glsl
//#include common/shade.glsl
//#include common/even.glsl
uniform highp usampler2D u_places;
uniform highp sampler2D u_below;   // colour below the texture
uniform highp sampler2D u_texture; // texture before it fades, the factor by which it does, and the light
uniform int u_layer;
uniform vec3 u_ground;             // behind the surface
uniform float u_opacity;

out vec4 flowtexOut;

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (int(texelFetch(u_places, pixel, 0).w) != u_layer)
    discard;
  vec3 colour = texelFetch(u_below, pixel, 0).rgb;
  vec4 texture_ = texelFetch(u_texture, pixel, 0);
#ifndef FLOWTEX_PAINTED
  if (u_even)
    texture_.x -= flowtexMeanAround(pixel);
  colour = flowtexShade(colour, texture_.x * texture_.y);
#endif
  // One layer before the ground: no order of drawing to keep.
  flowtexOut = vec4(mix(u_ground, texture_.z * colour, u_opacity), 1.0);
}
