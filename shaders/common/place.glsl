// Where on the surface a pixel lies: the point at which its ray meets the cell or the triangle there, with
// the derivatives on the screen.

uniform highp sampler2DArray u_nodes; // positions as the vertices have them, and unit normals unless in a plane
const int FLOWTEX_POSITIONS = 0, FLOWTEX_NORMALS = 1; // layers

struct FlowtexPlace
{
  vec2 coordinate;
  vec3 position;
  vec3 normal;
  float rim; // factor of the texture, less at the outline of a smooth surface
  vec3 dx; // of the position
  vec3 dy;
  vec2 byX; // of the coordinate
  vec2 byY;
};

// What nodes have at one corner of a triangle, and its change to the next and to the last one by a coordinate.
#ifdef FLOWTEX_TRIANGLES
mat3 flowtexCorners(int layer)
{
  vec3 near = texelFetch(u_nodes, ivec3(flowtexNodes[0], layer), 0).xyz;
  return mat3(texelFetch(u_nodes, ivec3(flowtexNodes[1], layer), 0).xyz - near,
              texelFetch(u_nodes, ivec3(flowtexNodes[2], layer), 0).xyz - near, near);
}

// Normals as the positions above; at sharp edges that of the triangle, as in flowtex/field/triangles/triangle_nodes.py.
mat3 flowtexNormals(vec3 across)
{
  vec3 face = flowtexUnit(across);
  mat3 normals;
  for (int k = 0; k < 3; ++k)
  {
    vec3 corner = texelFetch(u_nodes, ivec3(flowtexNodes[k], FLOWTEX_NORMALS), 0).xyz;
    float alike = dot(face, corner);
    normals[k] = abs(alike) < FLOWTEX_SHARP ? (alike < 0.0 ? -face : face) : corner;
  }
  return mat3(normals[1] - normals[0], normals[2] - normals[0], normals[0]);
}
#else
mat3 flowtexCorners(ivec2 cell, bool lower, int layer)
{
  vec3 near = texelFetch(u_nodes, ivec3(cell, layer), 0).xyz;
  vec3 beside = texelFetch(u_nodes, ivec3(cell + (lower ? ivec2(1, 0) : ivec2(0, 1)), layer), 0).xyz;
  vec3 far = texelFetch(u_nodes, ivec3(cell + 1, layer), 0).xyz;
  return lower ? mat3(beside - near, far - beside, near) : mat3(far - beside, beside - near, near);
}
#endif

// The place on the ray through a point, whose change on the screen is that of a plane parallel to the picture
// or of any other through it. The coordinate may be off by a few cells.
FlowtexPlace flowtexPlaceOn(vec3 point, vec3 byX, vec3 byY, vec2 coordinate)
{
#ifdef FLOWTEX_TRIANGLES
  vec2 scale = vec2(1.0);
  vec2 part = coordinate;
  mat3 nodes = flowtexCorners(FLOWTEX_POSITIONS);
#else
  vec2 scale = u_slicesSize;
  vec2 at = coordinate * u_slicesSize - 0.5 - u_padding;
  ivec2 cell = clamp(ivec2(floor(at)), ivec2(0), textureSize(u_nodes, 0).xy - 2);
  vec2 part = at - vec2(cell);
  bool lower = part.x >= part.y;
  mat3 nodes = flowtexCorners(cell, lower, FLOWTEX_POSITIONS);
#endif
  FlowtexPlace place;
  place.coordinate = coordinate;
  place.position = nodes * vec3(part, 1.0);
  // In cells, so that no square is too large or too small for single precision.
  vec3 most = max(abs(nodes[0]), abs(nodes[1]));
  float size = max(max(most.x, most.y), max(most.z, FLOWTEX_LEAST_SQUARE));
  vec3 first = nodes[0] / size;
  vec3 second = nodes[1] / size;
  vec3 across = cross(first, second);
#ifdef FLOWTEX_PLANAR
  across = vec3(0.0, 0.0, across.z);
#endif
  vec3 ray = u_eye.xyz - u_eye.w * point;
  float facing = dot(across, ray);
  float far = dot(across, nodes[2] - point) / facing; // ways to the eye
  float nearer = 1.0 - u_eye.w * far;
  place.dx = nearer * (byX - ray * (dot(across, byX) / facing));
  place.dy = nearer * (byY - ray * (dot(across, byY) / facing));
  mat3 off = mat3(point + far * ray - place.position, place.dx, place.dy) / size;
  // Collapsed cells have no finite value.
  mat3x2 cells = transpose(mat2x3(cross(second, across), cross(across, first))) * off / dot(across, across);
  bool found = max(abs(cells[0].x), abs(cells[0].y)) <= FLOWTEX_PLACE_FAR;
  if (found)
  {
    place.position += off[0] * size;
    place.coordinate += cells[0] / scale;
    place.byX = cells[1] / scale;
    place.byY = cells[2] / scale;
  }
  else
  {
    place.dx = byX;
    place.dy = byY;
    place.byX = place.byY = vec2(0.0);
  }
#ifdef FLOWTEX_PLANAR
  place.normal = vec3(0.0, 0.0, 1.0);
  place.rim = 1.0;
#else
#ifdef FLOWTEX_TRIANGLES
  mat3 normals = flowtexNormals(across);
#else
  mat3 normals = flowtexCorners(cell, lower, FLOWTEX_NORMALS);
#endif
  place.normal = normals * vec3(found ? part + cells[0] : part, 1.0);
  // The square of how a curved surface faces the eye grows evenly from its outline.
  vec2 change = ray * mat2x3(normals * vec3(place.byX * scale, 0.0), normals * vec3(place.byY * scale, 0.0));
  float aslant = abs(dot(place.normal, ray));
  float inwards = 0.5 * aslant / max(length(change), FLOWTEX_LEAST_SQUARE);
  float cosine = aslant / (length(place.normal) * length(ray));
  place.rim = max(smoothstep(FLOWTEX_RIM_HIDDEN, FLOWTEX_RIM_SHOWN, inwards),
                  smoothstep(FLOWTEX_RIM_ASLANT, FLOWTEX_RIM_FACING, cosine));
#endif
  return place;
}

#ifdef FLOWTEX_DEFERRED
uniform vec3 u_rayCorner; // corner of the picture on the plane through the focus that is parallel to it,
uniform vec3 u_rayX;      // and change of it by a pixel
uniform vec3 u_rayY;

// The place of a pixel, counted from the corner of the picture.
FlowtexPlace flowtexFindPlace(vec2 pixel, vec2 coordinate)
{
  return flowtexPlaceOn(u_rayCorner + pixel.x * u_rayX + pixel.y * u_rayY, u_rayX, u_rayY, coordinate);
}
#endif
