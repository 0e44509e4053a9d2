// What the passes that trace have of the nodes.

uniform highp sampler2D u_flow;  // as common/trace.glsl asks for it
uniform highp sampler2D u_cells; // 1 where the cell beyond a node is open, and the nearest valid node
uniform vec2 u_nodes;            // columns and rows
uniform vec2 u_closed;           // 1 along axes that close

vec4 flowtexNode(ivec2 node)
{
  return texelFetch(u_flow, node, 0);
}

bool flowtexOpen(ivec2 cell)
{
  return texelFetch(u_cells, cell, 0).x > 0.5;
}
