// A vertex of the surface's triangles, which follows from its number: each has three of its own.

uniform mat4 u_matrix; // from the surface's frame to the picture
uniform highp sampler2DArray u_nodes; // as in common/place.glsl
#ifdef FLOWTEX_TRIANGLES
uniform highp usampler2D u_corners; // nodes of each triangle, and a bit for each block in which it lies
uniform int u_blocks; // bits of the blocks that are drawn
flat out highp int flowtexTriangleOut;
#else
uniform highp usampler2D u_strides; // doublings from node to node of squares of the finest blocks
uniform vec4 u_block;    // its first node, the doublings in which it is drawn, and its squares in a row
uniform vec3 u_part;     // node at which the layer begins among the finest ones, and doublings between its own
uniform vec3 u_lastNode; // of the finest ones, and doublings from one of their blocks to a square
uniform vec2 u_closed;   // 1 along axes whose first line of nodes is the last one
uniform int u_blockCells;
uniform vec2 u_slicesSize;
uniform vec2 u_padding;
const ivec2 FLOWTEX_CORNERS[6] =
  ivec2[6](ivec2(0), ivec2(1, 0), ivec2(1), ivec2(0), ivec2(1), ivec2(0, 1));

int flowtexStride(ivec2 block)
{
  ivec2 size = textureSize(u_strides, 0);
  block >>= int(u_lastNode.z);
  ivec2 around = (block + size) % size;
  block = clamp(block, ivec2(0), size - 1);
  block = ivec2(u_closed.x > 0.5 ? around.x : block.x, u_closed.y > 0.5 ? around.y : block.y);
  return int(texelFetch(u_strides, block, 0).r);
}

// Where a node on a line between blocks is drawn along it: at one of those that both sides have, so that no crack
// opens, also between tiles of different levels.
int flowtexSnapped(ivec2 node, ivec2 last, int most, bool turned)
{
  ivec2 block = node / u_blockCells;
  if (node.y == last.y)
    block.y = (turned ? textureSize(u_strides, 0).x : textureSize(u_strides, 0).y) << int(u_lastNode.z);
  ivec2 below = block - ivec2(0, 1);
  int stride = max(flowtexStride(turned ? block.yx : block), flowtexStride(turned ? below.yx : below));
  stride = min(stride, most);
  return node.x == last.x ? node.x : (node.x >> stride) << stride;
}

// Node of the layer at a corner of a square.
ivec2 flowtexNode(int square, ivec2 corner)
{
  ivec2 first = ivec2(u_block.xy);
  ivec2 end = min(first + u_blockCells, textureSize(u_nodes, 0).xy - 1);
  int row = int(u_block.w);
  ivec2 node = min(first + ((ivec2(square % row, square / row) + corner) << int(u_block.z)), end);
  ivec2 start = ivec2(u_part.xy);
  int step_ = int(u_part.z);
  ivec2 last = ivec2(u_lastNode.xy);
  int most = step_ + int(log2(float(u_blockCells)) + 0.5);
  ivec2 place = min(start + (node << step_), last);
  ivec2 moved = place;
  if (node.y == first.y || node.y == end.y)
    moved.x = flowtexSnapped(place, last, most, false);
  if (node.x == first.x || node.x == end.x)
    moved.y = flowtexSnapped(place.yx, last.yx, most, true);
  return node - ((place - moved) >> step_);
}
#endif

out vec2 flowtexCoordinateOut; // in the slices, or shares of the second and third corner

void main()
{
#ifdef FLOWTEX_TRIANGLES
  int triangle = gl_VertexID / 3;
  int corner = gl_VertexID % 3;
  int width = textureSize(u_corners, 0).x;
  uvec4 corners = texelFetch(u_corners, ivec2(triangle % width, triangle / width), 0);
  flowtexTriangleOut = triangle;
  flowtexCoordinateOut = vec2(corner == 1, corner == 2);
  int number = int(corners[corner]);
  width = textureSize(u_nodes, 0).x;
  ivec2 node = ivec2(number % width, number / width);
#else
  ivec2 node = flowtexNode(gl_VertexID / 6, FLOWTEX_CORNERS[gl_VertexID % 6]);
  flowtexCoordinateOut = (vec2(node) + u_padding + 0.5) / u_slicesSize;
#endif
  gl_Position = u_matrix * vec4(texelFetch(u_nodes, ivec3(node, 0), 0).xyz, 1.0);
#ifdef FLOWTEX_TRIANGLES
  if ((int(corners.w) & u_blocks) == 0)
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // out of the picture
#endif
}
