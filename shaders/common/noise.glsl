// Noise that is even in space and has no end.
//
// Every lattice point of every octave has a random phase, hashed from its integer coordinates.
// Octave n has cells sqrt(2)^n times as wide as u_noiseFinest: even octaves belong to one family
// of lattices, each nested in the next, odd ones to another that is wider by sqrt(2). Two
// neighbours are so close that their mixture has the grain of either.
//
// Positions are given relative to u_noiseOrigin, a point near the view. Its coordinates in the
// finest cells of both families, whole numbers and what is left, enter the hash, so the digits
// that float has are spent near the view and the pattern does not depend on where the view is.

// What is the same for every point of a fragment's path.
struct FlowtexLattice
{
  vec3 here;     // the fragment, in cells from the lattice point nearest to the origin
  float inverse; // cells by length
  uvec3 key;     // hash of that lattice point, the octave and the seed, by axis
#ifdef FLOWTEX_SPARSE
  uvec3 origin;  // that lattice point
  uint salt;     // hash of the octave and the seed
#endif
};

// ``turn`` is how often the noise there is that of the other end of a map around the Earth.
FlowtexLattice flowtexLattice(vec3 position, int octave, float turn)
{
  bool odd = (octave & 1) == 1;
  vec3 whole = odd ? u_noiseOriginOdd : u_noiseOriginEven;
  vec3 left = odd ? u_noiseRestOdd : vec3(0.0);
#ifdef FLOWTEX_REPEATED
  whole -= turn * (odd ? u_turnOdd : u_turnEven);
  left -= turn * (odd ? u_turnRestOdd : u_turnRestEven);
#endif
  int doublings = octave >> 1;
  float shrink = exp2(-float(doublings));
  float inverse = shrink / u_noiseFinest * (odd ? FLOWTEX_SQRT_HALF : 1.0);
  ivec3 finest = ivec3(whole);
  ivec3 origin = finest >> doublings;
  vec3 rest = (vec3(finest - (origin << doublings)) + left) * shrink;
  uvec3 key = uvec3(origin) * FLOWTEX_AXIS_PRIMES;
  uint salt = uint(octave) * FLOWTEX_OCTAVE_PRIME + uint(u_seed) * FLOWTEX_SEED_PRIME;
  key.x += salt;
#ifdef FLOWTEX_SPARSE
  return FlowtexLattice(position * inverse + rest, inverse, key, uvec3(origin), salt);
#else
  return FlowtexLattice(position * inverse + rest, inverse, key);
#endif
}

// Motion of the grains at a fragment: two rates, and how far it is from one to the other.
struct FlowtexMotion
{
  vec2 clock;  // the moment in turns
  vec2 turns;  // turns by length of path
  vec2 phases; // turns by the values of grains that stand, which say where those in motion begin
  vec2 shares; // of the two rates in a grain
};

FlowtexMotion flowtexMotion;

// Scatters the keys of an axis.
uvec3 flowtexScatter(uvec3 key)
{
  return (key ^ (key >> FLOWTEX_HASH_SHIFT)) * FLOWTEX_HASH_FACTORS.x;
}

// The corners of a cell along the first two axes, from what the axes have at its lower and upper end.
uvec4 flowtexCorners(uvec3 low, uvec3 high)
{
  return uvec4(low.x, high.x, low.x, high.x) ^ uvec4(low.yy, high.yy);
}

#ifdef FLOWTEX_SPARSE
// Where grains are bright, so that streaks lie at even distances: one in a block, at random, and in every
// other block, like the black squares of a chessboard.
struct FlowtexBlocks
{
  uvec3 hash;  // of the block, by axis
  uvec3 place; // number of the grain in its block, and a bit for the colour of the square, by axis
};

FlowtexBlocks flowtexBlocks(uvec3 cell, uint salt)
{
#ifdef FLOWTEX_PLANAR
  const uint bits = FLOWTEX_BLOCK_BITS / 2u;
#else
  const uint bits = FLOWTEX_BLOCK_BITS / 3u;
#endif
  uvec3 block = cell >> bits;
  uvec3 key = block * FLOWTEX_AXIS_PRIMES;
  key.x += salt;
  uvec3 place = (cell & ((1u << bits) - 1u)) << uvec3(0u, bits, 2u * bits);
  uvec3 colour = block & 1u;
  colour.x ^= salt >> 31u;
  return FlowtexBlocks(flowtexScatter(key), place | (colour << FLOWTEX_BLOCK_BITS));
}

// Which of four grains are bright.
vec4 flowtexBright(uvec4 hash, uvec4 place)
{
  return vec4(equal((hash * FLOWTEX_HASH_FACTORS.y) >> (32u - FLOWTEX_BLOCK_BITS), place));
}

// Values of grains that are bright, or not, once in a turn, and leave a tail.
vec4 flowtexDash(vec4 bright, vec4 grains, float phases, float turn)
{
  vec4 late = fract(grains * phases + turn) / FLOWTEX_DASH_SHARE;
  return bright * max(1.0 - late, 0.0) * FLOWTEX_DASH_HIGH - FLOWTEX_DASH_LOW;
}

// Values of four lattice points from their scattered keys, and which are bright.
vec4 flowtexGrains(uvec4 key, vec2 turns, vec4 bright)
{
#ifdef FLOWTEX_MOVING
  vec4 grains = vec4(ivec4(key * FLOWTEX_HASH_FACTORS.y));
  vec4 slow = flowtexDash(bright, grains, flowtexMotion.phases.x, turns.x);
  vec4 fast = flowtexDash(bright, grains, flowtexMotion.phases.y, turns.y);
  return slow * flowtexMotion.shares.x + fast * flowtexMotion.shares.y;
#else
  return FLOWTEX_MOST_GRAIN * mix(vec4(-FLOWTEX_SPARSE_LOW), vec4(FLOWTEX_SPARSE_HIGH), bright);
#endif
}
#else
// Values of four lattice points from their scattered keys, even over all whole numbers with a sign
// at every moment. In motion each is a mixture of two waves with different phases.
vec4 flowtexGrains(uvec4 key, vec2 turns)
{
  vec4 grains = vec4(ivec4(key * FLOWTEX_HASH_FACTORS.y));
#ifdef FLOWTEX_MOVING
  vec4 slow = abs(fract(grains * flowtexMotion.phases.x + turns.x) * 4.0 - 2.0) - 1.0;
  vec4 fast = abs(fract(grains * flowtexMotion.phases.y + turns.y) * 4.0 - 2.0) - 1.0;
  grains = slow * flowtexMotion.shares.x + fast * flowtexMotion.shares.y;
#endif
  return grains;
}
#endif

// One octave at a displacement, with the variance of 1 everywhere between the lattice points.
//
// What can be is done by axis: it is shared by the points of a cell. In a plane nothing depends on
// the third one.
float flowtexOctave(FlowtexLattice lattice, vec3 displacement, vec2 turns)
{
  vec3 q = lattice.here + displacement * lattice.inverse;
  vec3 base = floor(q);
  vec3 w = q - base;
  vec3 spread = 1.0 - 2.0 * w * (1.0 - w);
  uvec3 cell = uvec3(ivec3(base));
  uvec3 key = lattice.key + cell * FLOWTEX_AXIS_PRIMES;
  uvec3 low = flowtexScatter(key);
  uvec3 high = flowtexScatter(key + FLOWTEX_AXIS_PRIMES);
  uvec4 corners = flowtexCorners(low, high);
#ifdef FLOWTEX_SPARSE
  FlowtexBlocks near = flowtexBlocks(lattice.origin + cell, lattice.salt);
  FlowtexBlocks far = flowtexBlocks(lattice.origin + cell + 1u, lattice.salt);
  uvec4 hash = flowtexCorners(near.hash, far.hash);
  uvec4 place = flowtexCorners(near.place, far.place);
#endif
#ifdef FLOWTEX_PLANAR
  float variance = spread.x * spread.y;
#ifdef FLOWTEX_SPARSE
  vec4 grains = flowtexGrains(corners, turns, flowtexBright(hash, place));
#else
  vec4 grains = flowtexGrains(corners, turns);
#endif
#else
  float variance = spread.x * spread.y * spread.z;
#ifdef FLOWTEX_SPARSE
  vec4 below = flowtexGrains(corners ^ low.z, turns, flowtexBright(hash ^ near.hash.z, place ^ near.place.z));
  vec4 above = flowtexGrains(corners ^ high.z, turns, flowtexBright(hash ^ far.hash.z, place ^ far.place.z));
#else
  vec4 below = flowtexGrains(corners ^ low.z, turns);
  vec4 above = flowtexGrains(corners ^ high.z, turns);
#endif
  vec4 grains = mix(below, above, w.z);
#endif
  vec2 rows = mix(grains.xz, grains.yw, w.x);
  return mix(rows.x, rows.y, w.y) * inversesqrt(variance * FLOWTEX_GRAIN_VARIANCE);
}
