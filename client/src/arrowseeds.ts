// Where arrows stand on a surface: flowtex/rendering/arrow_seeds.py in the browser; that file explains the method.

import type { Data, Geometry, Header } from "./protocol.ts";
import type { TileView } from "./tilechoice.ts";
import { add, cross, dot, fromFrame, length, scale, subtract, type Vector } from "./vectors.ts";

export type Pair = [i: number, j: number];

/** A point of a surface: cell, place in it from 0 to 1, position in its frame, and radius. */
export interface Seed {
  cell: number;
  place: Pair;
  position: Vector;
  radius: number;
}

/** A part of a cell: its lower corner and size, and a hashed number. */
interface Part {
  cell: number;
  low: Pair;
  size: Pair;
  key: number;
}

export type View = Omit<TileView, "cellPixels">;
type Limits = Header["constants"]["arrows"];

/** The surface as it is drawn; the last two of four corners of a triangle are one. */
export interface SeededSurface {
  geometry: Pick<Geometry, "center" | "extent" | "frame">;
  nodes: Data;
  corners: Uint32Array;
}

/** What is wanted of a view: that, and the least distance of two seeds in pixels. */
type Wanted = [view: View, spacing: number];

const CORNERS = 4;

export class ArrowSeeds {
  private readonly surface: SeededSurface;
  private readonly limits: Limits;
  /** Areas of the cells up to each. */
  private readonly sums: Float64Array;
  /** Seeds of the octaves of the whole surface. */
  private readonly whole: Seed[][] = [[]];
  private last: { wanted: Wanted; seeds: Seed[] } | null = null;

  constructor(surface: SeededSurface, limits: Limits) {
    this.surface = surface;
    this.limits = limits;
    let sum = 0;
    this.sums = Float64Array.from({ length: surface.corners.length / CORNERS }, (_, cell) => {
      return (sum += this.area(wholeCell(cell)));
    });
  }

  /** The seeds of a view that are this many pixels apart, and some more. */
  seen(view: View, spacing: number): Seed[] {
    if (!this.last || !this.covers(this.last.wanted, [view, spacing])) {
      this.last = { wanted: [view, spacing], seeds: this.make([view, spacing]) };
    }
    return this.last.seeds;
  }

  private position(cell: number, place: Pair): Vector {
    const { nodes, corners } = this.surface;
    return between(nodes, corners.subarray(CORNERS * cell, CORNERS * (cell + 1)), place, 3) as Vector;
  }

  private point(position: Vector): Vector {
    const { frame, center } = this.surface.geometry;
    return add(fromFrame(frame, position), center);
  }

  /** Whether the seeds of one view do for another. */
  private covers([last, least]: Wanted, [view, spacing]: Wanted): boolean {
    const { closer } = this.limits;
    return this.cornersOf(view).every((point) => {
      const isClose = closer * least * pixelAt(last, point) <= spacing * pixelAt(view, point);
      return isClose && this.sees(last, point, 0);
    });
  }

  /** Corners of what is in view as far as the surface goes. */
  private cornersOf({ planes }: View): Vector[] {
    const { center, extent } = this.surface.geometry;
    const normal = (n: number) => planes[n].slice(0, 3) as Vector;
    const away = cross(normal(0), normal(2));
    const reach = 0.5 * extent * length(away);
    const ends = [0, 1].flatMap((side) => [2, 3].flatMap((end) => [-1, 1].map((sign) => [side, end, sign])));
    return ends.map(([side, end, sign]) => {
      const [a, b] = [normal(side), normal(end)];
      const sum = add(scale(cross(b, away), -planes[side][3]), cross(away, a), -planes[end][3]);
      const both = cross(a, b);
      return scale(add(sum, both, dot(away, center) + sign * reach), 1 / dot(both, away));
    });
  }

  private sees(view: View, point: Vector, reach: number): boolean {
    const slack = reach + this.limits.around * view.pixels * pixelAt(view, point);
    return view.planes.every((p) => dot(p, point) + p[3] >= -slack * length(p));
  }

  private make(wanted: Wanted): Seed[] {
    const [view, spacing] = wanted;
    const { limits, sums, whole } = this;
    const { extent, center } = this.surface.geometry;
    const total = sums[sums.length - 1] ?? 0;
    const nearest = view.eye ? Math.max(length(subtract(center, view.eye)) - 0.5 * extent, 0) : 1;
    const least = limits.closer * spacing * pixelOf(view, nearest);
    let radius = extent;
    let seeds = whole[0];
    let parts: Part[] | null = null;
    for (let octave = 0; octave < limits.mostOctaves; octave += 1) {
      const area = limits.candidateArea * radius ** 2;
      if (total <= limits.mostCandidates * area) {
        whole[octave + 1] ??= this.grown(seeds, this.spread(octave, area), radius);
        seeds = whole[octave + 1];
      } else {
        parts ??= Array.from(sums, (_, cell) => wholeCell(cell));
        parts = this.divided(parts.filter((part) => this.isNeeded(part, wanted, radius)), area);
        const candidates = parts.flatMap((part) => {
          const key = mixed(part.key + octave);
          return shareOf(key) * area < this.area(part) ? [this.candidate(part, key)] : [];
        });
        seeds = this.grown(seeds, candidates, radius);
        if (!parts.length) break;
      }
      if (radius <= least) break;
      radius *= limits.octave;
    }
    return seeds.filter((seed) => {
      const point = this.point(seed.position);
      const isFar = seed.radius >= limits.closer * spacing * pixelAt(view, point);
      return isFar && this.sees(view, point, 0);
    });
  }

  /** Candidates of an octave all over the surface, evenly along the row of its cells. */
  private spread(octave: number, area: number): Seed[] {
    const { sums } = this;
    const base = mixed(octave + OCTAVE_PRIME);
    let cell = 0;
    return Array.from({ length: Math.floor((sums[sums.length - 1] ?? 0) / area) }, (_, number) => {
      const key = mixed(base + number);
      const at = (number + shareOf(key)) * area;
      while (cell < sums.length - 1 && sums[cell] <= at) cell += 1;
      return this.candidate(wholeCell(cell), key);
    });
  }

  private candidate({ cell, low, size }: Part, key: number): Seed {
    const first = mixed(key + OCTAVE_PRIME);
    const second = mixed(first + OCTAVE_PRIME);
    const place: Pair = [low[0] + size[0] * shareOf(first), low[1] + size[1] * shareOf(second)];
    return { cell, place, position: this.position(cell, place), radius: Infinity };
  }

  /** Take candidates, the farthest from all others first, that are not too near. */
  private grown(seeds: Seed[], candidates: Seed[], least: number): Seed[] {
    const most = least / this.limits.octave;
    const near = new Neighbours(most);
    for (const seed of seeds) near.add(seed.position);
    for (const seed of candidates) seed.radius = near.distance(seed.position);
    const order = candidates.filter(({ radius }) => radius >= least).sort((a, b) => b.radius - a.radius);
    const fresh = new Neighbours(most);
    const taken = order.filter((seed) => {
      seed.radius = Math.min(seed.radius, fresh.distance(seed.position));
      if (seed.radius < least) return false;
      fresh.add(seed.position);
      return true;
    });
    return [...seeds, ...taken];
  }

  /** Whether something of a part is seen, or near what is, and the octave is needed there. */
  private isNeeded(part: Part, [view, spacing]: Wanted, radius: number): boolean {
    const { octave, closer, aroundRadii } = this.limits;
    const { cell, low, size } = part;
    const middle = this.point(this.position(cell, [low[0] + 0.5 * size[0], low[1] + 0.5 * size[1]]));
    const [a, b] = this.sides(part);
    const reach = 0.5 * (length(a) + length(b));
    const away = Math.max(awayOf(view, middle) - reach, 0);
    const isFine = radius < octave * closer * spacing * pixelOf(view, away);
    return !isFine && this.sees(view, middle, reach + aroundRadii * radius);
  }

  /** Halve parts along their longer sides until none has more than an area. */
  private divided(parts: Part[], area: number): Part[] {
    const large = parts.filter((part) => this.area(part) > area);
    if (!large.length) return parts;
    const halves = large.map((part): [Part, Part] => {
      const [a, b] = this.sides(part);
      const axis = length(b) > length(a) ? 1 : 0;
      const size: Pair = [...part.size];
      size[axis] *= 0.5;
      const low: Pair = [...part.low];
      low[axis] += size[axis];
      return [
        { ...part, size, key: mixed(part.key + OCTAVE_PRIME) },
        { ...part, size, low, key: mixed(part.key + SEED_PRIME) },
      ];
    });
    const small = parts.filter((part) => this.area(part) <= area);
    return this.divided([...small, ...halves.map(([first]) => first), ...halves.map(([, second]) => second)], area);
  }

  /** What leads across a part along i and j. */
  private sides({ cell, low, size }: Part): [Vector, Vector] {
    const at = (i: number, j: number) => this.position(cell, [low[0] + size[0] * i, low[1] + size[1] * j]);
    return [subtract(at(1, 0.5), at(0, 0.5)), subtract(at(0.5, 1), at(0.5, 0))];
  }

  private area(part: Part): number {
    return length(cross(...this.sides(part)));
  }
}

/** What lies in a cell between its corners, of what the nodes have, so many numbers each. */
export function between(nodal: Data, corners: ArrayLike<number>, [i, j]: Pair, size: number): number[] {
  const shares = [(1 - j) * (1 - i), (1 - j) * i, j * (1 - i), j * i];
  const result = new Array<number>(size).fill(0);
  for (let n = 0; n < CORNERS; n += 1) {
    for (let k = 0; k < size; k += 1) result[k] += shares[n] * nodal[size * corners[n] + k];
  }
  return result;
}

/** Points by cubes, to find the distance to the nearest one, up to the side of a cube. */
class Neighbours {
  private readonly most: number;
  private readonly cubes = new Map<number, Vector[]>();

  constructor(most: number) {
    this.most = most;
  }

  private cube(point: Vector): Vector {
    return point.map((x) => Math.floor(x / this.most)) as Vector;
  }

  add(point: Vector): void {
    const key = cubeKey(...this.cube(point));
    const there = this.cubes.get(key);
    if (there) there.push(point);
    else this.cubes.set(key, [point]);
  }

  distance(point: Vector): number {
    const [i, j, k] = this.cube(point);
    let nearest = this.most;
    for (let n = 0; n < 27; n += 1) {
      const key = cubeKey(i + (n % 3) - 1, j + (Math.floor(n / 3) % 3) - 1, k + Math.floor(n / 9) - 1);
      for (const other of this.cubes.get(key) ?? []) nearest = Math.min(nearest, length(subtract(point, other)));
    }
    return nearest;
  }
}

/** Primes of the hash, which shaders/common/constants.glsl has as well. */
const OCTAVE_PRIME = 0x9e3779b9;
const SEED_PRIME = 0x85ebca6b;
const HASH_FACTORS = [0x2c1b3c6d, 0x297a2d39];
const HASH_SHIFT = 15;

/** A number by which a cube is found; that others have it too does no harm. */
function cubeKey(i: number, j: number, k: number): number {
  return Math.imul(i, 0x8da6b343) ^ Math.imul(j, 0xd8163841) ^ Math.imul(k, 0xcb1ab31f);
}

function mixed(key: number): number {
  let hash = key >>> 0;
  for (const factor of HASH_FACTORS) hash = Math.imul(hash ^ (hash >>> HASH_SHIFT), factor) >>> 0;
  return (hash ^ (hash >>> HASH_SHIFT)) >>> 0;
}

const shareOf = (key: number) => key / 2 ** 32;

function wholeCell(cell: number): Part {
  return { cell, low: [0, 0], size: [1, 1], key: mixed(cell) };
}

const awayOf = ({ eye }: View, point: Vector) => (eye ? length(subtract(point, eye)) : 1);

/** Length that a pixel covers at a distance from the eye, and at a point. */
const pixelOf = ({ halfHeight, pixels }: View, away: number) => ((2 * halfHeight) / pixels) * away;
const pixelAt = (view: View, point: Vector) => pixelOf(view, awayOf(view, point));
