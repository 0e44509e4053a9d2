// The nodes of a surface as the arrays of a draw call, places in its triangles, and values between nodes.

import { type Data, type Geometry, type Header, shareOf } from "./protocol.ts";
import { clamp, type Vector } from "./vectors.ts";

/** What a node without a value has, far below every colour map, and the farthest share that others have. */
const NO_VALUE = -1e9;
const MOST_RANGES = 500;

/** Positions relative to a point, in whose surroundings single precision does. */
export function positions(data: Data, anchor: Vector): Float32Array {
  if (data instanceof Float32Array && !anchor.some(Boolean)) return data;
  const result = new Float32Array(data.length);
  for (let n = 0; n < data.length; n += 1) result[n] = data[n] - anchor[n % 3];
  return result;
}

/** Coordinates (u, v) of the nodes in the slices: middles of texels. */
export function coordinates({ shape, rows, columns }: Geometry): Float32Array {
  return Float32Array.from({ length: 2 * shape[0] * shape[1] }, (_, n) => {
    const [at, { before, size }] = n % 2 ? [Math.floor((n >> 1) / shape[1]), rows] : [(n >> 1) % shape[1], columns];
    return (at + before + 0.5) / size;
  });
}

/** Coordinates of columns and of rows side by side. */
export function alongAxes(alongI: number[], alongJ: number[]): Float32Array {
  const count = Math.max(alongI.length, alongJ.length);
  return Float32Array.from({ length: 2 * count }, (_, n) => (n % 2 ? alongJ : alongI)[n >> 1] ?? 0);
}

/** Normals of any scale with a length of one. */
export function unitNormals(data: Data): Float32Array {
  const result = Float32Array.from(data);
  for (let n = 0; n < data.length; n += 3) {
    const size = Math.hypot(data[n], data[n + 1], data[n + 2]) || 1;
    for (let k = n; k < n + 3; k += 1) result[k] /= size;
  }
  return result;
}

/** Values before and after, for each node or cell, as shares of the colour map's range. */
export function shares(steps: Data[], scalars: Header["scalars"]): Float32Array {
  const nodes = steps[0]?.length ?? 0;
  const result = new Float32Array(2 * nodes);
  const place = shareOf(scalars);
  steps.forEach((values, k) => {
    for (let n = 0; n < nodes; n += 1) {
      const share = place(values[n]);
      result[2 * n + k] = Number.isFinite(share) ? clamp(share, -MOST_RANGES, MOST_RANGES) : NO_VALUE;
    }
  });
  return result;
}

/** Nodes around a place of a surface, and their shares. */
export type Corners = readonly (readonly [node: number, share: number])[];

/** Corners of the triangle in which a place (i, j) of a structured surface lies. */
export function cornersAt([rows, columns]: [number, number], [i, j]: readonly number[]): Corners {
  const [left, low] = [Math.min(Math.floor(i), columns - 2), Math.min(Math.floor(j), rows - 2)];
  const [a, b] = [i - left, j - low];
  const corner = low * columns + left;
  const [least, most] = [Math.min(a, b), Math.max(a, b)];
  const aside = corner + (a >= b ? 1 : columns);
  return [[corner, 1 - most], [aside, most - least], [corner + columns + 1, least]];
}

/** A nodal value between nodes. */
export function interpolated(corners: Corners, value: (node: number) => number): number {
  return corners.reduce((sum, [node, share]) => sum + share * value(node), 0);
}

/** Greatest coordinate of a second corner, just below the next triangle's number. */
const MOST_SHARE = 1 - 1e-7;

/** Nodes of each triangle, and a bit for each block in which it lies. */
export function cornersAndBlocks(triangles: Data, blocks: Data): Uint32Array {
  return Uint32Array.from({ length: 4 * blocks.length }, (_, n) => (n % 4 < 3 ? triangles[3 * (n >> 2) + (n % 4)] : blocks[n >> 2]));
}

/**
 * A place of the surface as two numbers (i, j): j is the number of a triangle and the share of its second
 * corner, i that of its third.
 */
export function placeIn(triangle: number, second: number, third: number): [number, number] {
  return [third, triangle + Math.min(Math.max(second, 0), MOST_SHARE)];
}

/** Corners of the triangle in which a place lies. */
export function cornersOf(triangles: Data, [i, j]: readonly number[]): Corners {
  const number = Math.floor(j);
  const [second, third] = [j - number, i];
  return [1 - second - third, second, third].map((share, k) => [triangles[3 * number + k], share]);
}
