// Arrows along the paths of seeds, as ribbons that face the eye: vertices are pieces of the path, two at
// each end of a piece. What a path is, the texture knows; here its points are kept instead of noise there.

//#include common/uniforms.glsl
//#include common/arrow_numbers.glsl
vec2 flowtexLookup(vec3 displacement, float length_);
float flowtexBlend(vec2 sums, float near);
//#include common/path.glsl
//#include common/cell.glsl
//#include common/even_gain.glsl
//#include common/texture.glsl

uniform vec2 u_picture;      // width and height in pixels
uniform float u_apart;       // pixels from a seed to the next, at least
uniform bool u_bySpeed;      // longer where the flow is faster
uniform int u_arrowSides;    // those of the slices
uniform int u_pieces;        // of a whole arrow

struct FlowtexStroke
{
  vec4 position; // in clip space
  vec2 place;    // pixels from the tail along the path, and across it
  float size;    // pixels from the tail to the tip
};

vec3 flowtexTrail[3]; // the last points, the newest at the end
int flowtexTrailCount;

vec2 flowtexLookup(vec3 displacement, float length_)
{
  flowtexTrail[0] = flowtexTrail[1];
  flowtexTrail[1] = flowtexTrail[2];
  flowtexTrail[2] = displacement;
  ++flowtexTrailCount;
  return vec2(0.0);
}

float flowtexBlend(vec2 sums, float near)
{
  return 0.0;
}

// Leaves the last of some points of one side of a path, and gives the number of those before its end.
int flowtexWalk(vec2 coordinate, vec4 base, int side, float spacing, int count, bool inCell)
{
  flowtexTrailCount = 0;
  flowtexTrail[1] = flowtexTrail[2] = vec3(0.0);
  FlowtexSums sums = FlowtexSums(vec2(0.0), 0.0, 0.0);
  int layer = side > 0 ? u_lagCount : 0;
  flowtexSide(sums, coordinate, 0.0, base.xyz, layer, float(side), spacing, base.w * u_unit, float(count), inCell);
  return flowtexTrailCount < count ? max(flowtexTrailCount - 1, 0) : count;
}

// The number of pieces, of a whole arrow, before one side of a path ends; and how far from the seed the path
// is after these, over their length, where that is less than what came.
int flowtexPieces(vec2 coordinate, vec4 base, int side, float spacing, bool inCell, inout float straight)
{
  if (side > 0 && u_arrowSides < 2)
    return 0;
  float whole = spacing * float(u_pieces) / (base.w * u_unit); // as a lag
  int layer = side > 0 ? u_lagCount : 0;
  if (flowtexLayer(coordinate, layer + 1, 0.0).w < FLOWTEX_ARROW_FREE * whole)
    return flowtexWalk(coordinate, base, side, spacing, u_pieces, inCell);
  int slice = 0;
  do ++slice;
  while (slice < u_lagCount && u_lags[slice - 1] < whole);
  straight = min(straight, length(flowtexLayer(coordinate, layer + slice, 0.0).xyz) / length(base.xyz));
  return u_pieces;
}

// Change in pixels of a point of clip space along a way there.
vec2 flowtexPixels(vec4 point, vec4 way)
{
  return 0.5 * u_picture * (way.xy - point.xy / point.w * way.w) / point.w;
}

// A vertex of the arrow of a seed: at the end of a piece, 0 being the tail, on one side, -1 or 1.
FlowtexStroke flowtexStroke(mat4 matrix, vec3 position, vec3 normal, vec2 coordinate, float radius, int piece, float side)
{
  FlowtexStroke stroke = FlowtexStroke(vec4(2.0, 2.0, 2.0, 1.0), vec2(0.0), 0.0); // outside
  vec4 base = flowtexLayer(coordinate, 0, 0.0);
  float speed = length(base.xyz);
  vec4 seed = matrix * vec4(position, 1.0);
  if (speed < FLOWTEX_LEAST_SPEED || seed.w <= 0.0)
    return stroke;
  vec3 tangent = base.xyz / speed;
  // In a radius: in a length they may be too few or too many for single precision.
  vec2 along = radius * flowtexPixels(seed, matrix * vec4(tangent, 0.0));
  vec2 aside = radius * flowtexPixels(seed, matrix * vec4(cross(normal, tangent), 0.0));
  vec2 pixels = flowtexFootprint(vec3(along, 0.0), vec3(aside, 0.0));
  float apart = mix(pixels.x, pixels.y, FLOWTEX_ARROW_FORESHORTENED) / u_apart;
  // An arrow is opaque or absent: one that fades in is grey in a still.
  if (apart < FLOWTEX_ARROW_APART || pixels.y < FLOWTEX_ARROW_EDGE * pixels.x)
    return stroke;
#ifdef FLOWTEX_UNCERTAIN
  if (flowtexKnown(coordinate, 0.0) < FLOWTEX_ARROW_KNOWN)
    return stroke;
#endif
  float shown = flowtexLayer(coordinate, 2, 0.0).w;
  if (1.0 + shown < FLOWTEX_ARROW_KNOWN)
    return stroke;
  float pace = u_bySpeed ? clamp(shown, FLOWTEX_ARROW_SLOWEST, FLOWTEX_ARROW_FASTEST) : 1.0;
  float step_ = FLOWTEX_ARROW_LENGTH * pace * u_apart / float(u_pieces); // in pixels
  float spacing = radius * step_ / max(length(along), FLOWTEX_ARROW_SHORTEST * pixels.x);
  bool inCell = flowtexEnterCell(coordinate, spacing * float(u_pieces));
  // The seed is in the middle if the path continues on both sides.
  float straight = 1.0;
  int before = flowtexPieces(coordinate, base, -1, spacing, inCell, straight);
  int beyond = flowtexPieces(coordinate, base, 1, spacing, inCell, straight);
  if (straight < FLOWTEX_ARROW_WOUND)
    return stroke;
  int behind = min(before, u_pieces / 2);
  int ahead = min(beyond, u_pieces - behind);
  behind = min(before, u_pieces - ahead);
  int count = behind + ahead;
  if (2 * count < u_pieces)
    return stroke;
  int at = min(piece, count) - behind;
  vec3 here = vec3(0.0);
  vec3 way = radius * tangent;
  if (at != 0)
  {
    flowtexWalk(coordinate, base, at < 0 ? -1 : 1, spacing, abs(at) + 1, inCell);
    bool isWhole = flowtexTrailCount > abs(at);
    here = flowtexTrail[isWhole ? 1 : 2];
    way = (at < 0 ? -1.0 : 1.0) * (flowtexTrail[2] - flowtexTrail[isWhole ? 0 : 1]);
  }
  vec4 point = matrix * vec4(position + here, 1.0);
  if (point.w <= 0.0)
    return stroke;
  vec2 onward = flowtexPixels(point, matrix * vec4(way, 0.0));
  onward /= max(length(onward), FLOWTEX_LEAST_TEXELS);
  stroke.size = step_ * float(count);
  float reach = FLOWTEX_ARROW_HEAD * FLOWTEX_ARROW_WIDTH * stroke.size + FLOWTEX_ARROW_OUTLINE + 1.0;
  float more = piece == 0 ? -reach : piece >= count ? reach : 0.0;
  stroke.place = vec2(step_ * float(min(piece, count)) + more, side * reach);
  vec2 corner = onward * more + vec2(-onward.y, onward.x) * stroke.place.y;
  stroke.position = point;
  stroke.position.xy += corner / (0.5 * u_picture) * point.w;
  // As deep as what is nearer to the eye by a little more than the ribbon is wide.
  vec3 toEye = normalize(u_eye.xyz - u_eye.w * position);
  vec4 nearer = matrix * vec4(position + here + toEye * (FLOWTEX_ARROW_LIFT * reach * radius / pixels.x), 1.0);
  stroke.position.z = max(nearer.z / nearer.w, -FLOWTEX_ARROW_NEAREST) * point.w;
  return stroke;
}
