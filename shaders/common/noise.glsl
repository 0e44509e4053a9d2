// Noise that is even in space and has no end.
//
// Every lattice point of every octave has a random phase, hashed from its integer coordinates.
// Octave 0 is the finest, with cells of u_noiseFinest; octave n has cells 2^n times as wide.
// Positions are given relative to u_noiseOrigin, a lattice point near the view. Its integer
// coordinates, in cells of octave 0, enter the hash, so the digits that float has are spent near
// the view and the pattern does not depend on where the view is.

const uvec3 flowtexPrimes = uvec3(0x8da6b343u, 0xd8163841u, 0xcb1ab31fu);

// What is the same for every point of a fragment's path.
struct FlowtexLattice
{
  vec3 here;     // the fragment, in cells from the lattice point nearest to the origin
  float inverse; // cells by length
  uvec3 key;     // hash of that lattice point, the octave and the seed, by axis
};

FlowtexLattice flowtexLattice(vec3 position, int octave)
{
  ivec3 finest = ivec3(u_noiseOriginCell);
  ivec3 origin = finest >> octave;
  float inverse = exp2(-float(octave)) / u_noiseFinest;
  vec3 rest = vec3(finest - (origin << octave)) * exp2(-float(octave));
  uvec3 key = uvec3(origin) * flowtexPrimes;
  key.x += uint(octave) * 0x9e3779b9u + uint(u_seed) * 0x85ebca6bu;
  return FlowtexLattice(position * inverse + rest, inverse, key);
}

// Values of four lattice points from their keys: a triangle wave of a random phase, so that they
// are uniform in -1 ... 1 at every moment and come back after one turn.
vec4 flowtexGrains(uvec4 h, float turn)
{
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 13)) * 0x297a2d39u;
  vec4 phase = vec4(h >> 8) * (1.0 / 16777216.0);
  return abs(fract(phase + turn) * 4.0 - 2.0) - 1.0;
}

// One octave at a displacement, with the variance of 1 everywhere between the lattice points.
float flowtexOctave(FlowtexLattice lattice, vec3 displacement, float turn)
{
  vec3 q = lattice.here + displacement * lattice.inverse;
  vec3 base = floor(q);
  vec3 t = q - base;
  vec3 w = t * t * (3.0 - 2.0 * t);
  vec3 spread = w * w + (1.0 - w) * (1.0 - w);
  uvec3 k = lattice.key + uvec3(ivec3(base)) * flowtexPrimes;
  uvec4 corners = uvec4(0u, flowtexPrimes.x, flowtexPrimes.y, flowtexPrimes.x + flowtexPrimes.y)
    + (k.x + k.y + k.z);
  vec4 grains = flowtexGrains(corners, turn);
  float variance = spread.x * spread.y;
#ifndef FLOWTEX_PLANAR
  grains = mix(grains, flowtexGrains(corners + flowtexPrimes.z, turn), w.z);
  variance *= spread.z;
#endif
  vec2 rows = mix(grains.xz, grains.yw, w.x);
  return mix(rows.x, rows.y, w.y) * inversesqrt(variance * (1.0 / 3.0));
}
