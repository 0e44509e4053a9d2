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
};

FlowtexLattice flowtexLattice(vec3 position, int octave)
{
  bool odd = (octave & 1) == 1;
  int doublings = octave >> 1;
  float shrink = exp2(-float(doublings));
  float inverse = shrink / u_noiseFinest * (odd ? FLOWTEX_SQRT_HALF : 1.0);
  ivec3 finest = ivec3(odd ? u_noiseOriginOdd : u_noiseOriginEven);
  ivec3 origin = finest >> doublings;
  vec3 rest = (vec3(finest - (origin << doublings)) + (odd ? u_noiseRestOdd : vec3(0.0))) * shrink;
  uvec3 key = uvec3(origin) * FLOWTEX_AXIS_PRIMES;
  key.x += uint(octave) * FLOWTEX_OCTAVE_PRIME + uint(u_seed) * FLOWTEX_SEED_PRIME;
  return FlowtexLattice(position * inverse + rest, inverse, key);
}

// Motion of the grains at a fragment: two rates, and how far it is from one to the other.
struct FlowtexMotion
{
  vec2 clock;  // the moment in turns
  vec2 turns;  // turns by length of path
  vec2 phases; // which phases of a grain belong to the rates
  float late;
};

FlowtexMotion flowtexMotion;

// Values of four lattice points from their keys, uniform in -1 ... 1 at every moment. In motion
// each is a mixture of two triangle waves with phases of their own.
vec4 flowtexGrains(uvec4 h, vec2 turns)
{
  h = (h ^ (h >> FLOWTEX_HASH_SHIFTS.x)) * FLOWTEX_HASH_FACTORS.x;
  h = (h ^ (h >> FLOWTEX_HASH_SHIFTS.y)) * FLOWTEX_HASH_FACTORS.y;
  vec4 phase = vec4(h >> FLOWTEX_PHASE_SHIFT) * (1.0 / FLOWTEX_PHASES);
#ifndef FLOWTEX_MOVING
  return phase * 2.0 - 1.0;
#else
  vec4 slow = abs(fract(phase * flowtexMotion.phases.x + turns.x) * 4.0 - 2.0) - 1.0;
  vec4 fast = abs(fract(phase * flowtexMotion.phases.y + turns.y) * 4.0 - 2.0) - 1.0;
  float late = flowtexMotion.late;
  return mix(slow, fast, late) * inversesqrt(1.0 - 2.0 * late * (1.0 - late));
#endif
}

// One octave at a displacement, with the variance of 1 everywhere between the lattice points.
float flowtexOctave(FlowtexLattice lattice, vec3 displacement, vec2 turns)
{
  vec3 q = lattice.here + displacement * lattice.inverse;
  vec3 base = floor(q);
  vec3 w = q - base;
  vec3 spread = 1.0 - 2.0 * w * (1.0 - w);
  uvec3 k = lattice.key + uvec3(ivec3(base)) * FLOWTEX_AXIS_PRIMES;
  uvec4 corners = uvec4(k.x + k.y + k.z);
  corners.yw += FLOWTEX_AXIS_PRIMES.x;
  corners.zw += FLOWTEX_AXIS_PRIMES.y;
  vec4 grains = flowtexGrains(corners, turns);
  float variance = spread.x * spread.y;
#ifndef FLOWTEX_PLANAR
  grains = mix(grains, flowtexGrains(corners + FLOWTEX_AXIS_PRIMES.z, turns), w.z);
  variance *= spread.z;
#endif
  vec2 rows = mix(grains.xz, grains.yw, w.x);
  return mix(rows.x, rows.y, w.y) * inversesqrt(variance * (1.0 / FLOWTEX_GRAIN_PRECISION));
}
