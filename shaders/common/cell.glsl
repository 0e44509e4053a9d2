// Paths that stay within a cell or two beside a critical point.
//
// A slice between the nodes is a mean over paths that begin cells apart. Beside a critical point
// those part, and their mean vanishes elsewhere than the velocity does, which shows once a streak is
// shorter than a cell. It then follows the velocity between the nodes of the cell, where these do not
// agree on the direction.

mat3x2 flowtexBy;   // change of the fragment's coordinate by a vector in space
vec3 flowtexCellNormal; // of the cell

// Sets both from derivatives on the screen.
void flowtexSetBy(vec3 dx, vec3 dy, vec2 byX, vec2 byY)
{
  // In pixels, so that no square is too small for single precision.
  float size = max(max(length(dx), length(dy)), FLOWTEX_LEAST_SQUARE);
  dx /= size;
  dy /= size;
  vec3 normal = cross(dx, dy);
  float square = max(dot(normal, normal), FLOWTEX_LEAST_SQUARE);
  flowtexCellNormal = normal * inversesqrt(square);
  vec3 across = normal / square;
  flowtexBy = (outerProduct(byX, cross(dy, across)) + outerProduct(byY, cross(across, dx)))
    * (1.0 / size);
}

#ifdef FLOWTEX_CELLS
#ifndef FLOWTEX_TRIANGLES
vec4 flowtexFetch(ivec2 node, int layer)
{
  ivec3 texel = ivec3(clamp(node, ivec2(0), ivec2(u_slicesSize) - 1), layer);
#ifdef FLOWTEX_UNSTEADY
  return mix(texelFetch(u_slices, texel, 0), texelFetch(u_slicesNext, texel, 0), u_between);
#else
  return texelFetch(u_slices, texel, 0);
#endif
}
#endif

// Basis functions of the velocity, for a point x, y cells away: 1, x, y and x y between four
// nodes; between the three of a triangle x and y are shares of its corners, and there is no x y.
#ifdef FLOWTEX_TRIANGLES
const int FLOWTEX_CELL_NODES = 3;
#define FLOWTEX_FACTORS vec3
#define FLOWTEX_VELOCITY mat3
#define FLOWTEX_RATE mat3x2
#define flowtexFactors(at) vec3(1.0, at)
#else
const int FLOWTEX_CELL_NODES = 4;
#define FLOWTEX_FACTORS vec4
#define FLOWTEX_VELOCITY mat4x3
#define FLOWTEX_RATE mat4x2
#define flowtexFactors(at) vec4(1.0, at, at.x * at.y)
#endif

struct FlowtexCell
{
  FLOWTEX_VELOCITY velocity; // in space
  FLOWTEX_RATE rate;         // the same in cells
  float share;     // of the path in the cell in that of the fragment
  vec2 at;         // where the path has come, in cells from the fragment
  vec3 moved;      // and in space
  float alive;     // 0 beyond the place where the flow ends
};

FlowtexCell flowtexCell;

#ifdef FLOWTEX_TRIANGLES
// Inverse of the longest side of the triangle times the sine of the angle opposite.
float flowtexSliver()
{
  vec3 one = vec3(flowtexBy[0].x, flowtexBy[1].x, flowtexBy[2].x);
  vec3 two = vec3(flowtexBy[0].y, flowtexBy[1].y, flowtexBy[2].y);
  // Heights, over the area, are as the sides.
  vec3 sides = vec3(length(one), length(two), length(one + two));
  float longest = max(max(sides.x, sides.y), sides.z);
  return sides.x * sides.y * sides.z / (longest * longest);
}
#endif

// Sets the cell of a fragment whose path is so long to each side; returns whether it has a share.
bool flowtexEnterCell(vec2 coordinate, float reach)
{
#ifdef FLOWTEX_TRIANGLES
  vec3 here = flowtexShares(coordinate);
#else
  vec2 at = coordinate * u_slicesSize - 0.5;
  vec2 f = at - floor(at);
  vec2 g = 1.0 - f;
  vec4 here = vec4(g.x, f.x, g.x, f.x) * vec4(g.y, g.y, f.y, f.y);
#endif
  FLOWTEX_VELOCITY velocity;
  FLOWTEX_RATE rate;
  vec2 lengths = vec2(0.0);
  vec3 together = vec3(0.0); // sum of the nodes' velocities,
  float alone = 0.0;         // and of their lengths
  float off = 0.0;
  for (int n = 0; n < FLOWTEX_CELL_NODES; ++n)
  {
#ifdef FLOWTEX_TRIANGLES
    vec4 turn = flowtexFetch(n, u_rateLayer);
    vec3 moved = flowtexFetch(n, 0).xyz * turn.w;
    rate[n] = flowtexBy * moved;
    // One along any side of the triangle.
    float cells = sqrt(dot(rate[n], rate[n]) + rate[n].x * rate[n].y);
    float speed = length(moved);
    // Velocities lie in the tangent planes of the nodes, and the path in that of the triangle. Paths
    // of nodes at sharp edges may leave their face and not its plane.
    float height = dot(flowtexCellNormal, moved);
    velocity[n] = moved - height * flowtexCellNormal;
    off = max(off, max(turn.z, abs(height) / max(speed, FLOWTEX_LEAST_SPEED)));
    for (int side = 0; side < u_sides; ++side)
    {
      vec3 slope = flowtexFetch(n, 1 + side * u_lagCount).xyz;
      off = max(off, abs(dot(flowtexCellNormal, slope)) / max(length(slope), FLOWTEX_LEAST_SPEED));
    }
#else
    ivec2 node = ivec2(floor(at)) + ivec2(n & 1, n >> 1);
    vec4 tangent = flowtexFetch(node, 0);
    vec4 turn = flowtexFetch(node, u_rateLayer);
    velocity[n] = tangent.xyz * turn.w;
    rate[n] = turn.xy * (turn.w / (tangent.w * u_cell));
    float cells = length(rate[n]);
    float speed = length(velocity[n]);
#endif
    lengths += here[n] * vec2(speed, cells);
    together += velocity[n];
    alone += speed;
  }
  lengths.x = max(lengths.x, FLOWTEX_LEAST_SPEED);
#ifdef FLOWTEX_TRIANGLES
  mat3 about = mat3(here, vec3(-1.0, 1.0, 0.0), vec3(-1.0, 0.0, 1.0)) * (1.0 / lengths.x);
#else
  mat4 about = mat4(here, vec4(-g.y, g.y, -f.y, f.y), vec4(-g.x, -f.x, g.x, f.x),
                    vec4(1.0, -1.0, -1.0, 1.0)) * (1.0 / lengths.x);
#endif
  flowtexCell.velocity = velocity * about;
  flowtexCell.rate = rate * about;
  // Also of all nodes alike: paths part between two nodes that agree beside a third that does not.
  float agreed = min(length(flowtexCell.velocity[0]), length(together) / max(alone, FLOWTEX_LEAST_SPEED));
#ifdef FLOWTEX_TRIANGLES
  lengths.y = min(lengths.y, FLOWTEX_SLIVER_CELLS * lengths.x * flowtexSliver());
#endif
  float cells = reach * lengths.y / lengths.x;
  float edge = smoothstep(FLOWTEX_ALONG_PLANE, FLOWTEX_OFF_PLANE, off);
  cells /= mix(1.0, FLOWTEX_EDGE_CELLS, edge);
  flowtexCell.share = max(1.0 - smoothstep(FLOWTEX_PARTING, FLOWTEX_AGREED, agreed), edge)
    * (1.0 - smoothstep(FLOWTEX_NEAR_CELLS, FLOWTEX_FAR_CELLS, cells));
  return flowtexCell.share > 0.0;
}

// Begins a side of the path.
void flowtexLeaveFragment()
{
  flowtexCell.at = vec2(0.0);
  flowtexCell.moved = vec3(0.0);
  flowtexCell.alive = 1.0;
}

// Goes on by a length, by the midpoint rule, and mixes in where that leads.
void flowtexGoOn(float length_, inout vec3 displacement, inout float alive)
{
  vec2 at = flowtexCell.at;
  FLOWTEX_FACTORS place = flowtexFactors(at);
  vec3 first = flowtexCell.velocity * place;
  float square = max(dot(first, first), FLOWTEX_LEAST_SQUARE);
  at += 0.5 * length_ * inversesqrt(square) * (flowtexCell.rate * place);
  place = flowtexFactors(at);
  vec3 middle = flowtexCell.velocity * place;
  float time = length_ * inversesqrt(max(dot(middle, middle), FLOWTEX_LEAST_SQUARE));
  flowtexCell.at += time * (flowtexCell.rate * place);
  flowtexCell.moved += time * middle;
  // Share of the step before the velocity turns round, as it does where the flow ends in a node.
  float lost = 2.0 * max(square - dot(first, middle), FLOWTEX_LEAST_SQUARE);
  flowtexCell.alive = flowtexCell.alive < 1.0 ? 0.0 : min(square / lost, 1.0);
  displacement = mix(displacement, flowtexCell.moved, flowtexCell.share);
  alive = mix(alive, flowtexCell.alive, flowtexCell.share);
}
#else
bool flowtexEnterCell(vec2 coordinate, float reach)
{
  return false;
}

void flowtexLeaveFragment()
{
}

void flowtexGoOn(float length_, inout vec3 displacement, inout float alive)
{
}
#endif
