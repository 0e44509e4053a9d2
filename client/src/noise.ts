// Noise that is even in space, at one point: shaders/common/noise.glsl, of grains that stand.

import type { Uniform } from "./uniforms.ts";
import { add, scale, type Vector } from "./vectors.ts";

/** Numbers of the method, by their names in the shaders. */
export type Constants = Record<string, number[]>;
type Uniforms = Record<string, Uniform>;

/** The constants that the text of a shader begins with, so that they are written in one place. */
export function constantsOf(shader: string): Constants {
  const lines = shader.matchAll(/^const \w+ FLOWTEX_(\w+) =\s*(?:\w+\()?([^;]*?)\)?;/gm);
  return Object.fromEntries(
    Array.from(lines, ([, name, values]) => [
      name,
      values.split(",").map((value) => Number(value.trim().replace(/u$/, ""))),
    ]),
  );
}

interface Lattice {
  /** The point in cells from the lattice point nearest to the origin, and cells by length. */
  here: Vector;
  inverse: number;
  /** Hash of that lattice point, the octave and the seed, by axis. */
  key: number[];
}

/** The lattice of an octave around a point, given from the origin of the noise. */
function latticeOf(point: Vector, octave: number, u: Uniforms, c: Constants): Lattice {
  const isOdd = (octave & 1) === 1;
  const cells = 2 ** (octave >> 1);
  const inverse = (isOdd ? Math.SQRT1_2 : 1) / cells / Number(u.u_noiseFinest);
  const finest = (isOdd ? u.u_noiseOriginOdd : u.u_noiseOriginEven) as number[];
  const past = (isOdd ? u.u_noiseRestOdd : [0, 0, 0]) as number[];
  const origin = finest.map((n) => Math.floor(n / cells));
  const rest = finest.map((n, axis) => (n - origin[axis] * cells + past[axis]) / cells);
  const key = origin.map((n, axis) => Math.imul(n, c.AXIS_PRIMES[axis]));
  key[0] += Math.imul(octave, c.OCTAVE_PRIME[0]) + Math.imul(Number(u.u_seed), c.SEED_PRIME[0]);
  return { here: add(rest, point, inverse), inverse, key };
}

/** Value of a sparse grain for an even one. */
function sparse(even: number, c: Constants): number {
  const bright = even >= (1 - 2 * c.SPARSE_SHARE[0]) * c.MOST_GRAIN[0];
  return c.MOST_GRAIN[0] * (bright ? c.SPARSE_HIGH[0] : -c.SPARSE_LOW[0]);
}

/** Value of an octave at a displacement, of variance 1; in a plane nothing depends on the third axis. */
function octaveAt(
  { here, inverse, key }: Lattice,
  displacement: Vector,
  c: Constants,
  axes: number,
  isSparse: boolean,
) {
  const [toKey, toGrain] = c.HASH_FACTORS;
  const at = add(here, displacement, inverse).slice(0, axes);
  const sides = at.map((x, axis) => {
    const low = Math.floor(x);
    const hash = (n: number) => {
      const k = (key[axis] + Math.imul(n, c.AXIS_PRIMES[axis])) >>> 0;
      return Math.imul(k ^ (k >>> c.HASH_SHIFT[0]), toKey);
    };
    return { hashes: [hash(low), hash(low + 1)], shares: [1 - x + low, x - low] };
  });
  let sum = 0;
  for (let corner = 0; corner < 2 ** axes; corner += 1) {
    const side = (axis: number) => (corner >> axis) & 1;
    const hash = sides.reduce((all, { hashes }, axis) => all ^ hashes[side(axis)], 0);
    const share = sides.reduce((all, { shares }, axis) => all * shares[side(axis)], 1);
    const grain = Math.imul(hash, toGrain);
    sum += share * (isSparse ? sparse(grain, c) : grain);
  }
  const spread = (all: number, { shares: [a, b] }: (typeof sides)[0]) => all * (1 - 2 * a * b);
  return sum / Math.sqrt(sides.reduce(spread, 1) * c.GRAIN_VARIANCE[0]);
}

/** The noise around a point of the surface's frame: at a displacement, in an octave and the next one. */
export function noiseAround(
  local: Vector,
  octave: number,
  isPlanar: boolean,
  isSparse: boolean,
  u: Uniforms,
  c: Constants,
): (displacement: Vector) => [number, number] {
  const point = add(local, scale(u.u_noiseOrigin as number[], -1));
  const [fine, coarse] = [0, 1].map((n) => latticeOf(point, octave + n, u, c));
  const axes = isPlanar ? 2 : 3;
  return (displacement) => [
    octaveAt(fine, displacement, c, axes, isSparse),
    octaveAt(coarse, displacement, c, axes, isSparse),
  ];
}
