// Paths in index space through a velocity at nodes, as flowtex/trace follows them: bilinear between
// the nodes, along the direction of the flow, ended where the surface or the flow does, and at a length that
// does for any picture.
//
// Wrappers supply
//   vec4 flowtexNode(ivec2 node, float lag)
// which is at a lag the rate along i and j in cells in a length, times the speed; the speed; and the length
// of a unit of lag, or its time;
//   vec2 flowtexPace(vec3 flow)
// which is the rate of that in cells in a length, none where the flow has stopped, or in a time;
//   bool flowtexOpen(ivec2 cell)
// which returns whether a cell is not blanked.

//#include common/poles.glsl

// Where a path has come: displacement in cells, the lag at which it has ended, the rate in cells in a unit of
// lag with which it goes on straight, and whether it came so close to a pole that others cannot be put
// together of it, whose neighbours pass the pole on its other side.
struct FlowtexPath
{
  vec2 moved;
  float reach;
  vec2 ahead;
  bool polar;
};

FlowtexPath flowtexPathOf(ivec2 node, bool earlier);

// The cell of a position, and where in the cell it is.
ivec2 flowtexCellOf(vec2 at, out vec2 inside)
{
  vec2 cells = u_nodes - 1.0;
  vec2 turns = floor(at / cells);
  at = mix(clamp(at, vec2(0.0), cells), clamp(at - turns * cells, vec2(0.0), cells), u_closed);
  vec2 cell = min(floor(at), cells - 1.0);
  inside = at - cell;
  return ivec2(cell);
}

// The same at a position, or in the plane of a pole there.
vec2 flowtexRate(int pole, vec2 at, float lag)
{
  vec2 inside;
  ivec2 cell = flowtexCellOf(at, inside) + flowtexShift(pole);
  vec3 low = mix(flowtexNode(cell, lag).xyz, flowtexNode(cell + ivec2(1, 0), lag).xyz, inside.x);
  vec3 high =
    mix(flowtexNode(cell + ivec2(0, 1), lag).xyz, flowtexNode(cell + ivec2(1, 1), lag).xyz, inside.x);
  return flowtexPace(mix(low, high, inside.y));
}

bool flowtexAlive(vec2 at)
{
  vec2 inside;
  vec2 beyond = max(-at, at - (u_nodes - 1.0)) * (1.0 - u_closed);
  return max(beyond.x, beyond.y) <= FLOWTEX_BORDER_CELLS && flowtexOpen(flowtexCellOf(at, inside));
}

// How far along first * x + bend * x * x a path is inside, by bisection; all of ``piece`` where it does not leave.
float flowtexInside(int pole, vec2 place, vec2 first, vec2 bend, float piece)
{
  float low = 0.0;
  float high = piece;
  float middle = piece;
  // Compilers do not unroll it: without a graphics card all of it would be run each time.
  while (high - low > FLOWTEX_BISECTED * piece)
  {
    if (flowtexAlive(flowtexLeave(pole, place + middle * (first + bend * middle))))
      low = middle;
    else
      high = middle;
    middle = 0.5 * (low + high);
  }
  return low;
}

// How far a path has come that goes on from a place in the plane of a pole, or in index space.
vec2 flowtexMoved(vec2 start, vec2 moved, int pole, vec2 place, vec2 next)
{
  return pole < 0 ? moved + next : flowtexLeave(pole, place + next) - start;
}

// Goes on straight where a path has ended, and ends it where it is long enough; returns whether it
// continues.
bool flowtexGoesOn(inout FlowtexPath path, vec2 start, float unit, float from, float to)
{
  if (path.reach >= FLOWTEX_ENDLESS && from * unit < u_longest)
    return true;
  if (path.reach >= FLOWTEX_ENDLESS)
  {
    path.reach = from;
    path.ahead = vec2(0.0);
  }
  vec2 at = start + path.moved;
  int pole = flowtexPole(at);
  path.moved = flowtexMoved(start, path.moved, pole, flowtexEnter(pole, at), path.ahead * (to - from));
  return false;
}

#if defined(FLOWTEX_POLES) || !defined(FLOWTEX_COMPOSED)
// Follows a path from ``start`` on, from a lag to another one in units of ``unit``, by the midpoint rule.
void flowtexFollow(inout FlowtexPath path, vec2 start, float unit, float side, float from, float to)
{
  float lag = from;
  int steps = 0;
  int pole = -1;
  float h = 0.0;
  vec2 place = vec2(0.0);
  vec2 next = vec2(0.0);
  vec2 moved = path.moved;
  bool ended = false;
  do
  {
    path.moved = moved;
    lag += h;
    vec2 at = start + moved;
    pole = flowtexPole(at);
    place = flowtexEnter(pole, at);
    path.polar = path.polar || pole >= 0;
    vec2 rate = side * unit * flowtexRate(pole, at, lag);
    float speed = max(abs(rate.x), abs(rate.y));
    bool rests = speed < u_rest;
    h = rests ? 0.0 : min(FLOWTEX_STEP_CELLS / max(speed, FLOWTEX_LEAST_SPEED), to - lag);
    vec2 middle = flowtexLeave(pole, place + 0.5 * h * rate);
    next = h * side * unit * flowtexRate(pole, middle, lag + 0.5 * h);
    vec2 there = flowtexLeave(pole, place + next);
    moved = pole < 0 ? moved + next : there - start;
    ended = rests || ++steps >= FLOWTEX_MOST_STEPS || !flowtexAlive(there);
  }
  while (!ended && lag + h < to * (1.0 - FLOWTEX_LAG_ROUNDING));
  // Without a graphics card the body of a loop is run each time, even if it is not needed.
  if (ended)
  {
    float low = flowtexInside(pole, place, next, vec2(0.0), 1.0);
    path.reach = lag + low * h;
    path.ahead = h > 0.0 ? next / h : vec2(0.0);
    moved = flowtexMoved(start, path.moved, pole, place, path.ahead * (to - lag));
  }
  path.moved = moved;
}
#endif

#ifdef FLOWTEX_COMPOSED
// Paths around a position, at two lags: mean displacements in a unit of lag, the reach, and the unit.
struct FlowtexNear
{
  vec2 slope;
  vec2 earlier;
  float reach;
  float unit;
  bool polar;
};

FlowtexNear flowtexNearOf(vec2 at, float lag, float earlier)
{
  vec2 inside;
  ivec2 cell = flowtexCellOf(at, inside);
  FlowtexNear near = FlowtexNear(vec2(0.0), vec2(0.0), 0.0, 0.0, false);
  for (int n = 0; n < 4; ++n)
  {
    ivec2 corner = ivec2(n & 1, n >> 1);
    vec2 share = mix(1.0 - inside, inside, vec2(corner));
    float weight = share.x * share.y;
    FlowtexPath path = flowtexPathOf(cell + corner, false);
    near.slope += weight / lag * path.moved;
    near.earlier += weight / earlier * flowtexPathOf(cell + corner, true).moved;
    // A path ends only between nodes whose paths all end.
    near.reach += weight * min(path.reach, FLOWTEX_MANY_LAGS * lag);
    near.unit += weight * flowtexNode(cell + corner, 0.0).w;
    near.polar = near.polar || path.polar;
  }
  return near;
}

// Continues a path by those that begin where it has come, which have been followed up to ``from``, and gives the
// lag up to which that goes: to a pole, at most.
float flowtexCompose(inout FlowtexPath path, vec2 start, float unit, float earlier, float from, float to)
{
  float lag = from;
  int pieces = 0;
  float piece = 0.0;
  float scale = 1.0;
  float ends = 0.0;
  bool ended = false;
  bool polar = false;
  vec2 first = vec2(0.0);
  vec2 bend = vec2(0.0);
  do
  {
    path.moved += piece * (first + bend * piece);
    lag += piece / scale;
    FlowtexNear near = flowtexNearOf(start + path.moved, from, earlier);
    scale = unit / near.unit; // of a lag, to the units there
    piece = min((to - lag) * scale, from);
    bend = (near.slope - near.earlier) / (from - earlier);
    first = near.slope - bend * from;
    ends = ++pieces > FLOWTEX_PIECES ? 0.0 : near.reach;
    polar = near.polar;
    ended = ends < piece || !flowtexAlive(start + path.moved + piece * (first + bend * piece));
  }
  while (!polar && !ended && lag + piece / scale < to * (1.0 - FLOWTEX_LAG_ROUNDING));
  if (polar)
    return lag;
  if (ended)
  {
    ends = min(ends, flowtexInside(-1, start + path.moved, first, bend, piece));
    path.reach = lag + ends / scale;
    path.ahead = (first + 2.0 * bend * ends) * scale;
    path.moved += ends * (first + bend * ends) + path.ahead * (to - path.reach);
  }
  else
    path.moved += piece * (first + bend * piece);
  return to;
}
#endif
