in vec3 flowtexPositionVSOutput;
in vec2 flowtexCoordinateVSOutput;
#ifndef FLOWTEX_PLANAR
in vec3 flowtexNormalVSOutput;
#endif
#ifdef FLOWTEX_TRIANGLES
flat in vec4 flowtexCornersVSOutput;
#endif
#ifdef FLOWTEX_PAPER
in vec2 flowtexNoiseVSOutput;
#endif
//#include common/uniforms.glsl
//#include common/flowtex.glsl

//#include vtk/mapped.glsl
uniform bool u_mapped;            // colour by the values of the nodes, or as VTK does,
uniform bool u_plain;             // or in one colour, as arrows have the others
uniform vec3 u_plainColour;

vec2 flowtexPlaced; // texture coordinate of the fragment

#ifdef FLOWTEX_PLACED
uniform sampler2DArray u_nodes;   // positions as they are given, from the middle of the surface, and normals
uniform vec3 u_anchor;            // what positions are counted from there
const int FLOWTEX_POSITIONS = 0, FLOWTEX_NORMALS = 1; // layers
const float FLOWTEX_PLACE_FAR = 16.0;      // cells beyond which no correction is made
const float FLOWTEX_EXTENT = 1073741824.0; // finest cells of the noise in the size of the surface, 2^30
const float FLOWTEX_LEAST_DEPTH = 1e-6;    // of the size, up to which it is rounding

// What nodes have at the corner of a cell, and its change by the parts of the cell in one of its triangles.
mat3 flowtexTriangle(ivec2 cell, bool lower, int layer)
{
  vec3 near = texelFetch(u_nodes, ivec3(cell, layer), 0).xyz;
  vec3 beside = texelFetch(u_nodes, ivec3(cell + (lower ? ivec2(1, 0) : ivec2(0, 1)), layer), 0).xyz;
  vec3 far = texelFetch(u_nodes, ivec3(cell + 1, layer), 0).xyz;
  return lower ? mat3(beside - near, far - beside, near) : mat3(far - beside, beside - near, near);
}

// A triangle that covers many cells gives a guess. A step of Newton's method takes the error: to where the
// ray from the eye meets the triangle of the cell, with the derivatives and the normal there.
void flowtexPlace(inout vec2 coordinate, inout vec3 position, inout vec3 normal, vec3 dx, vec3 dy,
                  inout vec2 byX, inout vec2 byY)
{
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_nodes, 0).xy - 2);
  vec2 part = at - vec2(cell);
  bool lower = part.x >= part.y;
  mat3 nodes = flowtexTriangle(cell, lower, FLOWTEX_POSITIONS);
  // In sizes of the surface, so that no square is too large or too small for single precision.
  float size = u_noiseFinest * FLOWTEX_EXTENT;
  vec3 first = nodes[0] / size;
  vec3 second = nodes[1] / size;
  mat3 off = mat3(position + u_anchor - nodes[2], dx, dy) / size;
  off[0] -= first * part.x + second * part.y;
  vec3 across = cross(first, second);
#ifndef FLOWTEX_PLANAR
  vec3 ray = u_eye.xyz - u_eye.w * position;
  ray /= dot(across, ray);
  vec3 moved = -dot(across, off[0]) * ray;
  off -= outerProduct(ray, across * off);
#endif
  // Collapsed cells have no finite value.
  mat3x2 cells = transpose(mat2x3(cross(second, across), cross(across, first))) * off / dot(across, across);
  if (max(abs(cells[0].x), abs(cells[0].y)) <= FLOWTEX_PLACE_FAR)
  {
    flowtexPlaced = coordinate += cells[0] / u_slicesSize;
    byX = cells[1] / u_slicesSize;
    byY = cells[2] / u_slicesSize;
#ifndef FLOWTEX_PLANAR
    normal = flowtexTriangle(cell, lower, FLOWTEX_NORMALS) * vec3(part + cells[0], 1.0);
    if (length(moved) > FLOWTEX_LEAST_DEPTH)
      position += moved * size;
#endif
  }
}
#endif
