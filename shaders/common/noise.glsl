// Noise that is even in space and has no end.
//
// Every lattice point of every octave has a random phase, hashed from its integer coordinates.
// Octave 0 is the finest, with cells of u_noiseFinest; octave n has cells 2^n times as wide.
// Positions are given relative to u_noiseOrigin, a lattice point near the view. Its integer
// coordinates, in cells of octave 0, enter the hash, so the digits that float has are spent near
// the view and the pattern does not depend on where the view is.

uint flowtexHash(ivec3 cell, int octave)
{
  uint h = uint(cell.x) * 0x8da6b343u + uint(cell.y) * 0xd8163841u + uint(cell.z) * 0xcb1ab31fu
    + uint(octave) * 0x9e3779b9u + uint(u_seed) * 0x85ebca6bu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  return (h ^ (h >> 13)) * 0x297a2d39u;
}

// Value of a lattice point: a triangle wave of its phase, so that it is uniform in -1 ... 1 at
// every moment and comes back after one turn.
float flowtexGrain(ivec3 cell, int octave, float turn)
{
  float phase = float(flowtexHash(cell, octave) >> 8) * (1.0 / 16777216.0);
  return abs(fract(phase + turn) * 4.0 - 2.0) - 1.0;
}

// One octave at a position, with the variance of 1 everywhere between the lattice points.
float flowtexOctave(vec3 position, int octave, float turn)
{
  float size = u_noiseFinest * exp2(float(octave));
  ivec3 finest = ivec3(u_noiseOriginCell);
  ivec3 origin = finest >> octave;
  vec3 rest = vec3(finest - (origin << octave)) / exp2(float(octave));
  vec3 q = position / size + rest;
  vec3 base = floor(q);
  vec3 t = q - base;
  ivec3 cell = ivec3(base) + origin;
  vec3 w = t * t * (3.0 - 2.0 * t);
  vec3 spread = w * w + (1.0 - w) * (1.0 - w);
  float a = mix(flowtexGrain(cell, octave, turn),
                flowtexGrain(cell + ivec3(1, 0, 0), octave, turn), w.x);
  float b = mix(flowtexGrain(cell + ivec3(0, 1, 0), octave, turn),
                flowtexGrain(cell + ivec3(1, 1, 0), octave, turn), w.x);
  float value = mix(a, b, w.y);
  float variance = spread.x * spread.y;
#ifndef FLOWTEX_PLANAR
  a = mix(flowtexGrain(cell + ivec3(0, 0, 1), octave, turn),
          flowtexGrain(cell + ivec3(1, 0, 1), octave, turn), w.x);
  b = mix(flowtexGrain(cell + ivec3(0, 1, 1), octave, turn),
          flowtexGrain(cell + ivec3(1, 1, 1), octave, turn), w.x);
  value = mix(value, mix(a, b, w.y), w.z);
  variance *= spread.z;
#endif
  return value * inversesqrt(variance * (1.0 / 3.0));
}
