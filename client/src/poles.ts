// The planes at the poles of a surface, in which paths next to them are traced: flowtex/field/grids/poles.py and
// flowtex/trace/sampler.py have what they are, shaders/common/poles.glsl follows paths in them.

import type { PoleHeader } from "./protocol.ts";
import type { Uniform } from "./uniforms.ts";

/** Lines of nodes with their velocity in a plane, beyond those within which it is used. */
const SPARE_LINES = 3;
/** Angle by which lines may differ from where even ones would be. */
const ROUNDING = 1e-6;
/** Poles that a surface has, at most. */
const MOST_POLES = 2;

/** The velocity of the nodes in texels of four numbers, and around them that in the planes of poles. */
export class Poles {
  readonly size: { width: number; height: number };
  private readonly poles: PoleHeader[];
  private readonly rays: ArrayLike<number>;
  private readonly nodes: [number, number];
  /** Whether j leads to the poles. */
  private readonly isAlongJ: boolean;
  /** Cells around the poles, and lines from pole to pole. */
  private readonly cells: number;
  private readonly lines: number;

  /** Of nodes in this many rows and columns; `rays` are cells along the lines that lead to each pole. */
  constructor(poles: PoleHeader[], nodes: [number, number], rays: ArrayLike<number>) {
    const [rows, columns] = nodes;
    this.poles = poles;
    this.nodes = nodes;
    this.rays = rays;
    this.isAlongJ = poles[0]?.component !== 0;
    [this.lines, this.cells] = this.isAlongJ ? [rows, columns - 1] : [columns, rows - 1];
    const more = poles.reduce((sum, pole) => sum + this.depth(pole) + 1, 0);
    this.size = { width: columns + (this.isAlongJ ? 0 : more), height: rows + (this.isAlongJ ? more : 0) };
  }

  /** Texels of the nodes' own (i, j, speed, unit), with those in the planes. */
  laidOut(own: Float32Array): Float32Array {
    if (!this.poles.length) return own;
    const [rows, columns] = this.nodes;
    const { width, height } = this.size;
    const result = new Float32Array(4 * width * height);
    for (let j = 0; j < rows; j += 1) {
      result.set(own.subarray(4 * columns * j, 4 * columns * (j + 1)), 4 * width * j);
    }
    this.poles.forEach((pole, n) => this.fill(result, pole, n));
    return result;
  }

  /** The greatest component of texels that paths are followed by. */
  fastest(texels: Float32Array): number {
    let most = 0;
    for (let line = 0; line < (this.isAlongJ ? this.size.height : this.size.width); line += 1) {
      const isNear = (pole: PoleHeader) => (line - pole.line) * pole.inward < pole.near;
      if (line < this.lines && this.poles.some(isNear)) continue;
      for (let k = 0; k <= this.cells; k += 1) {
        const at = this.at(line, k);
        most = Math.max(most, Math.abs(texels[at]), Math.abs(texels[at + 1]));
      }
    }
    return most;
  }

  /** Where (line, number around) is in the texels. */
  private at(line: number, around: number): number {
    return 4 * (this.isAlongJ ? line * this.size.width + around : around * this.size.width + line);
  }

  private depth({ near }: PoleHeader): number {
    return Math.min(near + SPARE_LINES, this.lines - 1);
  }

  /** How many lines further than the nodes those in the plane of a pole are. */
  private shift(n: number): number {
    const before = this.poles.slice(0, n).reduce((sum, pole) => sum + this.depth(pole) + 1, 0);
    const { inward, line } = this.poles[n];
    return this.lines + before - (inward > 0 ? line : line - this.depth(this.poles[n]));
  }

  private ray(n: number, around: number): [number, number] {
    const at = 2 * (n * (this.cells + 1) + around);
    return [this.rays[at], this.rays[at + 1]];
  }

  private fill(texels: Float32Array, pole: PoleHeader, n: number): void {
    const { cells } = this;
    const { line, inward, component } = pole;
    const [shift, still] = [this.shift(n), this.still(texels, pole, n)];
    for (let depth = 0; depth <= this.depth(pole); depth += 1) {
      for (let k = 0; k <= cells; k += 1) {
        const from = this.at(line + inward * depth, k);
        const to = this.at(line + inward * depth + shift, k);
        const [around, across] = [texels[from + 1 - component], texels[from + component]];
        const [ray, next, last] = [k, (k + 1) % cells, (k + cells - 1) % cells].map((m) => this.ray(n, m));
        for (const c of [0, 1]) {
          const turn = (next[c] - last[c]) / 2;
          texels[to + c] = depth ? inward * across * ray[c] + around * depth * turn : still[c];
        }
        texels.copyWithin(to + 2, from + 2, from + 4);
      }
    }
  }

  /** The velocity of a pole, of which its nodes have a component each. */
  private still(texels: Float32Array, { line, inward, component }: PoleHeader, n: number): [number, number] {
    let [a, b, c, x, y] = [0, 0, 0, 0, 0];
    for (let k = 0; k < this.cells; k += 1) {
      const [p, q] = this.ray(n, k);
      const square = p * p + q * q;
      const part = texels[this.at(line, k) + component] * inward;
      [x, y] = [x + part * p, y + part * q];
      [a, b, c] = [a + (p * p) / square, b + (p * q) / square, c + (q * q) / square];
    }
    const determinant = a * c - b * b;
    return [(c * x - b * y) / determinant, (a * y - b * x) / determinant];
  }

  get raysSize(): [width: number, height: number] {
    return [this.cells + 1, Math.max(this.poles.length, 1)];
  }

  /** Angles and lengths of the rays, and the last ray before each share of a turn, in texels. */
  get angles(): Float32Array {
    const { cells } = this;
    const [width, height] = this.raysSize;
    const result = new Float32Array(4 * width * height);
    this.poles.forEach((_, n) => {
      const angles: number[] = [];
      for (let k = 0; k <= cells; k += 1) {
        const [p, q] = this.ray(n, k);
        let angle = Math.atan2(q, p);
        while (angle < angles[k - 1]) angle += 2 * Math.PI;
        angles.push(angle);
      }
      angles.forEach((angle, k) => {
        const turn = angles[0] + (2 * Math.PI * k) / cells + ROUNDING;
        const line = angles.findLastIndex((other) => other <= turn);
        result.set([angle, Math.hypot(...this.ray(n, k)), line], 4 * (n * width + k));
      });
    });
    return result;
  }

  /** What the shaders have to know beside. */
  get uniforms(): Record<string, Uniform> {
    const numbers = this.poles.flatMap(({ line, inward, near }, n) => [line, inward, near, this.shift(n)]);
    const planes = this.poles.flatMap(({ plane }) => plane);
    while (numbers.length < 4 * MOST_POLES) numbers.push(0);
    while (planes.length < 6 * MOST_POLES) planes.push(0);
    return { u_poles: numbers, u_planes: planes, u_polar: Number(this.isAlongJ) };
  }
}
