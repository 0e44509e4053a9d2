// Paths of all nodes from one lag to the next. Floats lie in whole numbers, which every WebGL2 draws into:
// displacement, reach, and the rate ahead in half precision.

//#include common/constants.glsl
//#include webgl2/nodes.glsl
uniform highp usampler2D u_before;  // paths at the lag from which this pass goes on
uniform highp usampler2D u_earlier; // and at the one before

//#include common/trace.glsl

uniform float u_lagEarlier;
uniform float u_from;
uniform float u_to;
uniform float u_side;
out uvec4 flowtexOut;

FlowtexPath flowtexPathOf(ivec2 node, bool earlier)
{
  uvec4 bits = earlier ? texelFetch(u_earlier, node, 0) : texelFetch(u_before, node, 0);
  return FlowtexPath(uintBitsToFloat(bits.xy), uintBitsToFloat(bits.z), unpackHalf2x16(bits.w));
}

void main()
{
  ivec2 node = ivec2(gl_FragCoord.xy);
  float unit = flowtexNode(node, 0.0).w;
  FlowtexPath path = FlowtexPath(vec2(0.0), FLOWTEX_ENDLESS, vec2(0.0));
  if (u_from > 0.0)
    path = flowtexPathOf(node, false);
#ifdef FLOWTEX_COMPOSED
  flowtexCompose(path, vec2(node), unit, u_lagEarlier, u_from, u_to);
#else
  flowtexFollow(path, vec2(node), unit, u_side, u_from, u_to);
#endif
  flowtexOut = uvec4(floatBitsToUint(path.moved), floatBitsToUint(path.reach), packHalf2x16(path.ahead));
}
