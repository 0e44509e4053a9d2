// The surface in the picture, whose colours are there: as a whole, or its triangles again, whose outlines are smooth.

uniform highp usampler2D u_places;
uniform highp sampler2D u_depths;
uniform highp sampler2D u_colours;
uniform int u_layer;
uniform int u_bottom; // rows of pixels below the picture
out vec4 flowtexOut;
const float FLOWTEX_DEPTH_ROUNDING = 2e-7;

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy) + ivec2(0, u_bottom);
#ifdef FLOWTEX_SMOOTH
  // At an outline the pixel may show what is before or behind: of those around the nearest in depth is it.
  ivec2 found = pixel;
  float aside = fwidth(gl_FragCoord.z) + FLOWTEX_DEPTH_ROUNDING;
  float least = 2.0;
  for (int n = 0; n < 9; ++n)
  {
    ivec2 at = clamp(pixel + ivec2(n % 3, n / 3) - 1, ivec2(0), textureSize(u_places, 0) - 1);
    float away = abs(texelFetch(u_depths, at, 0).r - gl_FragCoord.z) + (n == 4 ? 0.0 : aside);
    if (int(texelFetch(u_places, at, 0).w) == u_layer && away < least)
    {
      least = away;
      found = at;
    }
  }
  if (least > 1.0)
    discard;
  flowtexOut = texelFetch(u_colours, found, 0);
#else
  if (texelFetch(u_places, pixel, 0).w == 0u)
    discard;
  gl_FragDepth = texelFetch(u_depths, pixel, 0).r;
  flowtexOut = texelFetch(u_colours, pixel, 0);
#endif
}
