// Where on the surface a pixel lies: the bits of its coordinate, the triangle, and the number of the layer from 1.

in vec2 flowtexCoordinateOut;
#ifdef FLOWTEX_TRIANGLES
flat in highp int flowtexTriangleOut;
#else
uniform highp usampler2D u_open; // whether cells are drawn; one texel if all are
uniform vec2 u_slicesSize;
uniform vec2 u_padding;
const float FLOWTEX_BORDER = 1e-3; // cells by which rounding may carry a pixel into the next
#endif
uniform int u_layer;
out uvec4 flowtexOut;

#ifndef FLOWTEX_TRIANGLES
bool flowtexIsOpen(vec2 at)
{
  return texelFetch(u_open, clamp(ivec2(floor(at)), ivec2(0), textureSize(u_open, 0) - 1), 0).r > 0u;
}
#endif

void main()
{
  uint triangle = 0u;
#ifdef FLOWTEX_TRIANGLES
  triangle = uint(flowtexTriangleOut);
#else
  vec2 at = flowtexCoordinateOut * u_slicesSize - 0.5 - u_padding;
  if (!flowtexIsOpen(at - FLOWTEX_BORDER) && !flowtexIsOpen(at + FLOWTEX_BORDER))
    discard;
#endif
  flowtexOut = uvec4(floatBitsToUint(flowtexCoordinateOut), triangle, uint(u_layer));
}
