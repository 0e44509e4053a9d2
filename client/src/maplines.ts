// Lines of the Earth as the points of a draw call.

import type { Earth } from "./protocol.ts";
import type { Vector } from "./vectors.ts";

/** A value that is not a point, before each line. */
export const BREAK = 1e30;
/** Steps that a side of the box has. */
const STEPS = 65535;
/** Pieces of lines that are drawn or left out together. */
const GROUP = 256;

/** Pieces that lie in a ball, which is seen or not. */
export interface PieceGroup {
  first: number;
  count: number;
  middle: Vector;
  radius: number;
}

/**
 * Lines in the surface's frame. The part has the steps from each point to the next, which go around at
 * their greatest number, and whether a line begins there.
 */
export function linesOf(
  steps: ArrayLike<number>,
  { low, size }: Pick<Earth, "low" | "size">,
): Vector[][] {
  const lines: Vector[][] = [];
  const place = [0, 0, 0];
  for (let n = 0; n < steps.length; n += 4) {
    if (steps[n + 3]) lines.push([]);
    const point = place.map((_, k) => {
      place[k] = (place[k] + steps[n + k]) & STEPS;
      return low[k] + (place[k] / STEPS) * size[k];
    });
    lines[lines.length - 1].push(point as Vector);
  }
  return lines;
}

/** Lines with a point about every `spacing` metres, without shorter ones: MapLines.thinned in Python. */
export function thinned(lines: Vector[][], spacing: number): Vector[][] {
  if (!spacing) return lines;
  return lines.flatMap((line) => {
    let along = 0;
    const kept = line.filter((point, n) => {
      const before = along;
      if (n) along += Math.hypot(...point.map((x, k) => x - line[n - 1][k]));
      const isNext = Math.floor(along / spacing) > Math.floor(before / spacing);
      return isNext || n === 0 || n === line.length - 1;
    });
    return along < spacing ? [] : [kept];
  });
}

/** Points of lines, counted from an anchor, with a break before each line. */
export function linePoints(lines: Vector[][], anchor: Vector): Float32Array {
  const size = lines.reduce((count, line) => count + line.length + 1, 0);
  const points = new Float32Array(3 * size).fill(BREAK);
  let n = 0;
  for (const line of lines) {
    n += 3;
    for (const point of line) {
      for (let k = 0; k < 3; k += 1) points[n++] = point[k] - anchor[k];
    }
  }
  return points;
}

/** Balls around groups of pieces; piece n goes from point n to the next. */
export function pieceGroups(points: Float32Array): PieceGroup[] {
  const groups: PieceGroup[] = [];
  const pieces = points.length / 3 - 1;
  for (let first = 0; first < pieces; first += GROUP) {
    const count = Math.min(GROUP, pieces - first);
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let n = 3 * first; n < 3 * (first + count + 1); n += 1) {
      if (points[n] === Math.fround(BREAK)) continue;
      low[n % 3] = Math.min(low[n % 3], points[n]);
      high[n % 3] = Math.max(high[n % 3], points[n]);
    }
    const middle = low.map((least, k) => (least + high[k]) / 2) as Vector;
    const radius = Math.hypot(...low.map((least, k) => (high[k] - least) / 2));
    groups.push({ first, count, middle, radius });
  }
  return groups;
}

/** First piece and number of those in a row that planes (a, b, c, d) do not leave out. */
export function visibleRuns(groups: PieceGroup[], planes: number[][]): [number, number][] {
  const runs: [number, number][] = [];
  for (const { first, count, middle: [x, y, z], radius } of groups) {
    const isOut = ([a, b, c, d]: number[]) =>
      a * x + b * y + c * z + d < -radius * Math.hypot(a, b, c);
    if (planes.some(isOut)) continue;
    const last = runs[runs.length - 1];
    if (last && last[0] + last[1] === first) last[1] += count;
    else runs.push([first, count]);
  }
  return runs;
}
