// What the passes that trace have of the nodes.

uniform highp sampler2D u_flow;  // as common/trace.glsl asks for it
uniform highp sampler2D u_cells; // 1 where the cell beyond a node is open, and the nearest valid node
uniform vec2 u_nodes;            // columns and rows
uniform vec2 u_closed;           // 1 along axes that close
uniform float u_timed;           // typical speed where lags are times, else zero
uniform float u_rest;            // cells in a unit of lag: a slower particle rests
#ifdef FLOWTEX_PATHLINES
uniform highp sampler2D u_flowNext; // at the next step
uniform vec2 u_between;             // lags of both steps
#endif

vec4 flowtexNode(ivec2 node, float lag)
{
#ifdef FLOWTEX_PATHLINES
  float late = clamp((lag - u_between.x) / (u_between.y - u_between.x), 0.0, 1.0);
  return mix(texelFetch(u_flow, node, 0), texelFetch(u_flowNext, node, 0), late);
#else
  return texelFetch(u_flow, node, 0);
#endif
}

vec2 flowtexPace(vec3 flow)
{
  if (u_timed > 0.0)
    return flow.xy * u_timed;
  return flow.z > 0.0 ? flow.xy / flow.z : vec2(0.0);
}

bool flowtexOpen(ivec2 cell)
{
  return texelFetch(u_cells, cell, 0).x > 0.5;
}
