// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow.
// `projectTile` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w
out vec2 flowtexSidesOut;   // ways to both sides of the box, as shares of its width

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  flowtexSidesOut = vec2(cell.x, u_mapCells - cell.x) / u_mapCells;
  gl_Position = projectTile(place);
}
