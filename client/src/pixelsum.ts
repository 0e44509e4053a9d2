// How the texture at a point is computed: its samples, their weights and noise, and the sum. It is
// what shaders/common/texture.glsl does at the finest level of the slices, in double precision.

import type { Camera } from "./camera.ts";
import { grainAt, layersAt, mover, partingAt, stretchAt, type PathPlace } from "./pointpath.ts";
import { isSignFree, type Settings } from "./protocol.ts";
import { isMoving, isSparse, type Uniform, uniforms } from "./uniforms.ts";
import { add, clamp, length, scale, subtract, toFrame, type Vector } from "./vectors.ts";

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

// The noise at one point, as in shaders/common/noise.glsl for grains that do not move.

interface Lattice {
  /** The point in cells from the lattice point nearest to the origin, and cells by length. */
  here: Vector;
  inverse: number;
  /** Hash of that lattice point, the octave and the seed, by axis. */
  key: number[];
  /** That lattice point, and the hash of the octave and the seed. */
  origin: number[];
  salt: number;
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
  const salt = Math.imul(octave, c.OCTAVE_PRIME[0]) + Math.imul(Number(u.u_seed), c.SEED_PRIME[0]);
  key[0] += salt;
  return { here: add(rest, point, inverse), inverse, key, origin, salt };
}

/** Scatters the key of an axis. */
function scatter(key: number, c: Constants): number {
  const whole = key >>> 0;
  return Math.imul(whole ^ (whole >>> c.HASH_SHIFT[0]), c.HASH_FACTORS[0]);
}

/** Value of a grain of streaklets at whole coordinates: in every other block one is bright. */
function sparseGrain(cell: number[], { salt }: Lattice, c: Constants): number {
  const [all] = c.BLOCK_BITS;
  const bits = Math.floor(all / cell.length);
  let hash = 0;
  let place = (salt >>> 31) << all;
  cell.forEach((n, axis) => {
    const block = n >>> bits;
    const key = Math.imul(block, c.AXIS_PRIMES[axis]) + (axis === 0 ? salt : 0);
    hash ^= scatter(key, c);
    place |= (n & (2 ** bits - 1)) << (bits * axis);
    place ^= (block & 1) << all;
  });
  const isBright = Math.imul(hash, c.HASH_FACTORS[1]) >>> (32 - all) === place;
  return c.MOST_GRAIN[0] * (isBright ? c.SPARSE_HIGH[0] : -c.SPARSE_LOW[0]);
}

/** Value of an octave at a displacement, of variance 1; in a plane nothing depends on the third axis. */
function octaveAt(
  lattice: Lattice,
  displacement: Vector,
  c: Constants,
  axes: number,
  isSparse: boolean,
) {
  const { here, inverse, key, origin } = lattice;
  const at = add(here, displacement, inverse).slice(0, axes);
  const sides = at.map((x, axis) => {
    const low = Math.floor(x);
    const hash = (n: number) => scatter(key[axis] + Math.imul(n, c.AXIS_PRIMES[axis]), c);
    return { low, hashes: [hash(low), hash(low + 1)], shares: [1 - x + low, x - low] };
  });
  let sum = 0;
  for (let corner = 0; corner < 2 ** axes; corner += 1) {
    const side = (axis: number) => (corner >> axis) & 1;
    const hash = sides.reduce((all, { hashes }, axis) => all ^ hashes[side(axis)], 0);
    const share = sides.reduce((all, { shares }, axis) => all * shares[side(axis)], 1);
    const cell = sides.map(({ low }, axis) => origin[axis] + low + side(axis));
    const grain = isSparse
      ? sparseGrain(cell, lattice, c)
      : Math.imul(hash, c.HASH_FACTORS[1]);
    sum += share * grain;
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

/** One look-up of the noise. */
export interface Sample {
  position: Vector;
  /** How far back along the path, negative ahead: a length, or a time if slices are by time. */
  lag: number;
  /** Share in the mean. */
  weight: number;
  /** Of mean zero and deviation one, and the same as it is drawn by itself, from 0 to 1. */
  noise: number;
  grey: number;
}

/** A point, and the picture that it is seen in, which is so many of the page's pixels high. */
export interface PixelPlace {
  at: PathPlace;
  settings: Settings;
  camera: Camera;
  rows: number;
}

/** The same as flowtex/scene/probe.py computes. */
export interface PixelSum {
  /** In the order in which the flow passes them. */
  samples: Sample[];
  /** Number of the sample at the point itself. */
  middle: number;
  /** Doublings of the grain above the one that is fixed on the surface. */
  level: number;
  /** Mean of the noise, and the factor that brings such means to the deviation one. */
  mean: number;
  gain: number;
  grey: number;
}

interface Step {
  displacement: Vector;
  /** In units of the node, negative ahead. */
  lag: number;
  weight: number;
}

/**
 * Weight on a side, -1 behind the point, at t from 0 there to 1 beyond the last sample. Paths part from 0 to
 * 1 where they begin.
 */
function kernelAt(side: number, t: number, parting: number, u: Uniforms, c: Constants): number {
  if (u.u_kernel === c.KERNEL_BOX[0]) return 1;
  if (u.u_kernel !== c.KERNEL_RAMP[0]) return 0.5 + 0.5 * Math.cos(Math.PI * t);
  if (u.u_sides === 1) return 1 - t;
  return (0.5 + 0.5 * side * parting) * (1 - side * t);
}

/** Samples of a side, from the point outward, the last one in part; `spacing` is that between two. */
function sideSteps(
  layers: (layer: number) => number[],
  side: number,
  spacing: number,
  count: number,
  parting: number,
  u: Uniforms,
  c: Constants,
): Step[] {
  const lags = u.u_lags as number[];
  const slope = (layer: number) => layers(layer).slice(0, 3) as Vector;
  const by = layers(0)[3] * Number(u.u_unit);
  const first = side * lags.length;
  const end = Math.min(layers(first + 1)[3], lags[lags.length - 1]);
  const sign = side ? 1 : -1;
  let [before, after] = [slope(0), slope(first + 1)];
  let [from, m] = [0, 0];
  const bendAt = () => scale(subtract(after, before), 1 / (lags[m] - from));
  // From a point nearly at rest the path does not jump: it is at least as fast as it will soon be.
  const stepAt = (along: Vector, bend: Vector) => {
    const least = Math.max(Math.sqrt((length(bend) * spacing) / by), c.LEAST_SPEED[0]);
    return spacing / by / Math.max(length(along), least);
  };
  let [lag, step] = [0, stepAt(before, bendAt())];
  const result: Step[] = [];
  for (let k = 1; k < count + 1; k += 1) {
    lag += step;
    const alive = clamp((end - lag) / step + 1, 0, 1) * Math.min(count - k + 1, 1);
    if (!alive) break;
    for (; lag > lags[m] && m < lags.length - 1; m += 1) {
      [before, from] = [after, lags[m]];
      after = slope(first + m + 2);
    }
    const bend = bendAt();
    const at = (lateness: number) => before.map((x, n) => x + bend[n] * lateness) as Vector;
    const weight = alive * kernelAt(sign, k / (count + 1), parting, u, c);
    result.push({ displacement: scale(at(lag - from), lag * sign * by), lag: -sign * lag, weight });
    // Evenly spaced along the path where the particle is faster or slower there.
    step = stepAt(at(2 * lag - from), bend);
  }
  return result;
}

/** Variance of a sum over that of independent samples, for some a number of grains apart. */
function shared(apart: number, near: number, c: Constants): number {
  const square = apart ** 2;
  const decay = c.BELL[0] * square - Math.log(Math.max(near, c.LEAST_SQUARE[0]));
  const bend = c.BELL_BEND[0] * square ** 2;
  const bent = bend / decay ** 2;
  const many = Math.sqrt(Math.PI / (decay * (1 + bent * (c.BENT[0] - c.BENT_TWICE[0] * bent))));
  const few = 1 + 2 * Math.exp(-decay - bend);
  return Math.max(many, few);
}

const total = (values: number[]) => values.reduce((sum, value) => sum + value, 0);

/** Grey of a value of the texture, from 0 to 1. */
function greyOf(value: number, contrast: number, c: Constants): number {
  return 1 / (1 + Math.exp(-c.TONE_SLOPE[0] * contrast * value));
}

/** The sum at a point; null where an image takes the place of the noise, or it moves. */
export function pixelSum({ at, settings, camera, rows }: PixelPlace): PixelSum | null {
  const { header } = at.scene;
  const { geometry, slices, shaders } = header;
  if (header.image || isMoving(header, settings, true)) return null;
  const c = constantsOf(shaders.fragment);
  const focus = camera.state.focal_point;
  const still = { eye: camera.eye, between: at.moment[2], time: slices.times[0], clock: 0, still: true };
  const view = { ...still, focus, anchor: [0, 0, 0] as Vector, density: 1, pixel: 1 };
  const u = uniforms(header, settings, view);
  const grain = grainAt(at, settings, camera, rows);
  const spacing = Number(u.u_spacing) * grain;
  const layers = layersAt(at);
  const moves = length(layers(0).slice(0, 3)) > c.LEAST_SPEED[0];
  const sides = moves ? [...Array(Number(u.u_sides)).keys()] : [];
  const areSparse = isSparse(header, settings);
  const set = Number(u.u_samples);
  const usual = u.u_sides === 2 ? Math.floor(set / 2) : set - 1;
  const whole = usual * stretchAt(at, settings, camera);
  const sine = areSparse && !isSignFree(header) ? partingAt(at, 0.5 * whole * spacing) : 0;
  const cosine = Math.sqrt(Math.max(1 - sine ** 2, 0));
  const parting = clamp(2 * sine, 0, 1);
  const together = (c.TOGETHER[0] * cosine) / Math.max(Math.abs(sine), c.LEAST_SPEED[0]);
  const count = whole * Math.min(together, 1);
  const [back = [], ahead = []] = sides.map((side) =>
    sideSteps(layers, side, spacing, count, parting, u, c),
  );
  const own = Math.max(kernelAt(1, 0, parting, u, c), c.LEAST_WEIGHT[0]);
  const steps = [...back.reverse(), { displacement: [0, 0, 0] as Vector, lag: 0, weight: own }, ...ahead];

  const octaves = clamp(2 * Math.log2(grain / Number(u.u_noiseFinest)), 0, c.LAST_OCTAVE[0]);
  const octave = Math.floor(octaves);
  const late = octaves - octave;
  const local = toFrame(geometry.frame, subtract(at.position, geometry.center));
  const noise = noiseAround(local, octave, geometry.planar, areSparse, u, c);
  const weights = steps.map(({ weight }) => weight);
  const squares = total(weights.map((weight) => weight ** 2));
  const pairs = weights.slice(1).map((weight, n) => weight * weights[n]);
  const near = total(pairs) / squares;
  const apart = Number(u.u_spacing) * 2 ** (late / 2);
  const shares = [1 - late, late];
  const alone = Math.hypot(...shares);
  const variance = shares.map((w, n) => w ** 2 * shared(apart * Math.SQRT1_2 ** n, near, c));
  const slow = u.u_fade ? clamp(layers(2)[3] / Number(u.u_fade), 0, 1) : 1;
  const fade = moves ? slow ** 2 * (3 - 2 * slow) : 0;
  const gain = (fade * alone * total(weights)) / Math.sqrt(squares * total(variance));
  const moved = mover(at);
  const lagUnit = layers(0)[3] * slices.lagUnit;
  const samples = steps.map(({ displacement, lag, weight }) => {
    const [fine, coarse] = noise(displacement);
    const value = (shares[0] * fine + shares[1] * coarse) / alone;
    const position = moved(displacement) ?? at.position;
    const share = weight / total(weights);
    return { position, lag: lag * lagUnit, weight: share, noise: value, grey: greyOf(value, 1, c) };
  });
  const mean = total(samples.map((sample) => sample.weight * sample.noise));
  return {
    samples,
    middle: back.length,
    level: Math.log2(grain / Number(u.u_texel)),
    mean,
    gain,
    grey: greyOf(gain * mean, Number(settings.contrast), c),
  };
}
