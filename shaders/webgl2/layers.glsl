// Texels of a layer of the slices, FLOWTEX_SLOPES or those without a lag: flowtex/textures/texture_set.py has what they are.

//#include common/constants.glsl
//#include webgl2/nodes.glsl

uniform highp sampler2D u_padded;   // positions of the nodes with a line of ghosts around them
uniform highp usampler2D u_before;  // paths at the lag of the layer
uniform highp usampler2D u_last;    // and at the last lag
uniform highp sampler2D u_speed;    // whole speed of the flow, and the uncertainty of its direction
uniform vec2 u_first;               // node that the first texel would hold
uniform vec3 u_offsetI;             // change of a position with a period
uniform vec3 u_offsetJ;
uniform float u_inCells; // 1 for the velocity in cells, and not the tangents
uniform float u_fourth;  // 0 nothing, 1 speed, 2 reach, 3 the uncertainty of the direction
uniform float u_lag;     // with the sign of the side
uniform float u_mostReach;
uniform float u_pace;
uniform float u_unit;    // that of the texels
uniform float u_cell;    // cells of the last layer, in units
uniform float u_planar;
//#include common/poles.glsl
#ifdef FLOWTEX_POLES
uniform vec3 u_planes[4]; // what the planes of the poles are spanned by
#endif
out vec4 flowtexOut;

vec3 flowtexPadded(ivec2 node)
{
  return texelFetch(u_padded, node + 1, 0).xyz;
}

#ifdef FLOWTEX_SLOPES
// Weights of the nodes around a place between two, and straight on beyond it.
vec4 flowtexCubic(float t, float beyond)
{
  vec4 weights = vec4(((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
                      ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t);
  vec4 change = vec4((-1.5 * t + 2.0) * t - 0.5, (4.5 * t - 5.0) * t,
                     (-4.5 * t + 4.0) * t + 0.5, (1.5 * t - 1.0) * t);
  return weights + beyond * change;
}

// Position between the nodes, straight on beyond the border.
vec3 flowtexPosition(vec2 at)
{
  vec2 cells = u_nodes - 1.0;
  vec2 turns = floor(at / cells) * u_closed;
  at -= turns * cells;
  vec2 inside = clamp(at, vec2(0.0), cells);
  vec2 beyond = (at - inside) * (1.0 - u_closed);
  vec2 cell = min(floor(inside), cells - 1.0);
  vec2 f = inside - cell;
  vec4 wi = flowtexCubic(f.x, beyond.x);
  vec4 wj = flowtexCubic(f.y, beyond.y);
  vec3 result = vec3(0.0);
  for (int b = 0; b < 4; ++b)
  {
    ivec2 node = ivec2(cell) + ivec2(-1, b - 1);
    vec3 row = wi[0] * flowtexPadded(node) + wi[1] * flowtexPadded(node + ivec2(1, 0))
      + wi[2] * flowtexPadded(node + ivec2(2, 0)) + wi[3] * flowtexPadded(node + ivec2(3, 0));
    result += wj[b] * row;
  }
  return result + turns.x * u_offsetI + turns.y * u_offsetJ;
}
#endif

vec4 flowtexTexel(vec2 texel)
{
  vec2 at = texel + u_first;
  vec2 cells = u_nodes - 1.0;
  ivec2 node = ivec2(mix(clamp(at, vec2(0.0), cells), at - floor(at / cells) * cells, u_closed) + 0.5);
  node += ivec2(round(texelFetch(u_cells, node, 0).yz));
  vec4 flow = flowtexNode(node, 0.0);
  float unit = flow.w * u_pace;
  vec2 rate = flow.w * flowtexPace(flow.xyz);
  vec4 result = vec4(0.0);
#ifdef FLOWTEX_SLOPES
  vec2 moved = uintBitsToFloat(texelFetch(u_before, node, 0).xy);
  float reach = abs(uintBitsToFloat(texelFetch(u_last, node, 0).z));
  result.xyz = (flowtexPosition(vec2(node) + moved) - flowtexPadded(node)) / (u_lag * unit);
  if (u_fourth > 2.5)
    result.w = texelFetch(u_speed, node, 0).y;
  else if (u_fourth > 1.5)
    // Where nothing moves, the neighbours alone decide.
    result.w = rate == vec2(0.0) ? u_mostReach : min(reach, u_mostReach);
  else if (u_fourth > 0.5)
    result.w = texelFetch(u_speed, node, 0).x;
#else
  if (u_inCells > 0.5)
  {
    result.xy = rate * u_cell;
    result.w = u_timed > 0.0 ? 1.0 : max(texelFetch(u_speed, node, 0).x, 0.0);
  }
  else
  {
    vec3 alongI = 0.5 * (flowtexPadded(node + ivec2(1, 0)) - flowtexPadded(node - ivec2(1, 0)));
    vec3 alongJ = 0.5 * (flowtexPadded(node + ivec2(0, 1)) - flowtexPadded(node - ivec2(0, 1)));
#ifdef FLOWTEX_POLES
    // One point has one velocity, of which its nodes hold a component each.
    int pole = flowtexPole(vec2(node));
    if (pole >= 0 && flowtexTurned(vec2(node)).y == u_poles[pole].x)
    {
      rate = flow.w * flowtexPace(flowtexNode(node + flowtexShift(pole), 0.0).xyz);
      alongI = u_planes[2 * pole];
      alongJ = u_planes[2 * pole + 1];
    }
#endif
    result = vec4(rate.x * alongI + rate.y * alongJ, unit * unit / u_unit) / unit;
  }
#endif
  if (u_planar > 0.5)
    result.z = 0.0;
  return clamp(result, -FLOWTEX_HALF_MAX, FLOWTEX_HALF_MAX);
}

void main()
{
  flowtexOut = flowtexTexel(floor(gl_FragCoord.xy));
}
