// Paths of all nodes from one lag to the next. Floats lie in whole numbers, which every WebGL2 draws into:
// displacement, reach, whose sign tells of a pole, and the rate ahead in half precision.

//#include common/constants.glsl
//#include webgl2/nodes.glsl
uniform highp usampler2D u_before;  // paths at the lag from which this pass goes on
uniform highp usampler2D u_earlier; // and at the one before
uniform float u_longest; // length of a path that is long enough

//#include common/trace.glsl

uniform float u_lagEarlier;
uniform float u_from;
uniform float u_to;
uniform float u_side;
uniform vec2 u_first;  // node that the first texel of the slices would hold
uniform vec2 u_texels; // columns and rows of texels
out uvec4 flowtexOut;

FlowtexPath flowtexPathOf(ivec2 node, bool earlier)
{
  uvec4 bits = earlier ? texelFetch(u_earlier, node, 0) : texelFetch(u_before, node, 0);
  float reach = uintBitsToFloat(bits.z);
  return FlowtexPath(uintBitsToFloat(bits.xy), abs(reach), unpackHalf2x16(bits.w), reach < 0.0);
}

// Whether a path is drawn, or else followed for others that are put together of it.
bool flowtexIsDrawn(vec2 node)
{
  vec2 cells = u_nodes - 1.0;
  vec2 texel = node - u_first;
  texel -= u_closed * cells * floor(texel / cells);
  return all(greaterThanEqual(texel, vec2(0.0))) && all(lessThan(texel, u_texels));
}

void main()
{
  ivec2 node = ivec2(gl_FragCoord.xy);
  vec2 start = vec2(node);
  float unit = flowtexNode(node, 0.0).w;
  FlowtexPath path = FlowtexPath(vec2(0.0), FLOWTEX_ENDLESS, vec2(0.0), false);
  if (u_from > 0.0)
    path = flowtexPathOf(node, false);
  bool isDrawn = flowtexIsDrawn(start);
  path.polar = path.polar || flowtexPole(start) >= 0;
  if ((isDrawn || !path.polar) && flowtexGoesOn(path, start, unit, u_from, u_to))
  {
    float lag = u_from;
#ifdef FLOWTEX_COMPOSED
    if (!path.polar)
      lag = flowtexCompose(path, start, unit, u_lagEarlier, u_from, u_to);
#endif
#if defined(FLOWTEX_POLES) || !defined(FLOWTEX_COMPOSED)
    if (lag < u_to)
      flowtexFollow(path, start, unit, u_side, lag, u_to);
#endif
  }
  float reach = path.polar ? -max(path.reach, FLOWTEX_LEAST_REACH) : path.reach;
  flowtexOut = uvec4(floatBitsToUint(path.moved), floatBitsToUint(reach), packHalf2x16(path.ahead));
}
