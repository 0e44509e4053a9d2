// Triangles of any surface, and places in them: shares of their corners.

import type { Corners } from "./mesh.ts";
import type { Data } from "./protocol.ts";

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
  const shares = [1 - second - third, second, third];
  return shares.map((share, k) => [triangles[3 * number + k], share]);
}
