// Triangles of any surface, which are drawn with three vertices each that no other one shares: so each
// has the numbers of its nodes, and a fragment its shares of them.

import type { Corners } from "./mesh.ts";
import type { Data, Part } from "./protocol.ts";
import { cross, dot, length, subtract, unit, type Vector } from "./vectors.ts";

/** Shares of the second and third corner at the vertices of a triangle. */
const SHARES = [0, 0, 1, 0, 0, 1];
/** Cosine of the angle between the normals of a node and a triangle below which there is an edge. */
const SHARP = 0.86;
/** Greatest coordinate of a second corner, just below the next triangle's number. */
const MOST_SHARE = 1 - 1e-7;

/** Values of nodes, this many of each, at the vertices of triangles. */
export function atVertices<T extends Data>(values: T, triangles: Data, size: number): T {
  const result = new (values.constructor as new (length: number) => T)(size * triangles.length);
  let n = 0;
  for (const node of triangles) {
    for (let k = size * node; k < size * node + size; k += 1) result[n++] = values[k];
  }
  return result;
}

/** Barycentric coordinates at the vertices of this many triangles. */
export function vertexShares(count: number): Float32Array {
  return Float32Array.from({ length: SHARES.length * count }, (_, n) => SHARES[n % SHARES.length]);
}

/**
 * Normals at the vertices of triangles: those of the nodes, of any scale, and at sharp edges that of the
 * triangle, so that every face is even up to its end; flowtex/field/triangles/creases.py is the same.
 */
export function vertexNormals<T extends Data>(normals: T, positions: Data, triangles: Data): T {
  const result = atVertices(normals, triangles, 3);
  const at = (values: Data, n: number): Vector => [values[3 * n], values[3 * n + 1], values[3 * n + 2]];
  for (let n = 0; n < triangles.length; n += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => at(positions, triangles[n + k]));
    const own = unit(cross(subtract(b, a), subtract(c, a)));
    for (let k = n; k < n + 3; k += 1) {
      const normal = at(result, k);
      const scale = length(normal);
      const alike = dot(own, normal);
      if (Math.abs(alike) < SHARP * scale) {
        result.set(
          own.map((x) => x * (alike < 0 ? -scale : scale)),
          3 * k,
        );
      }
    }
  }
  return result;
}

/** Numbers of all corners' nodes at each vertex. */
export function vertexCorners(triangles: Data): Float32Array {
  const result = new Float32Array(3 * triangles.length);
  for (let n = 0; n < result.length; n += 1) result[n] = triangles[3 * Math.floor(n / 9) + (n % 3)];
  return result;
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

/** The parts of a mesh that are drawn or left out by themselves: blocks, with a level of 0 or -1. */
export class TriangleMesh {
  /** Rows and columns of blocks. */
  readonly shape: [number, number];
  /** Of each triangle a bit for each block in which it lies. */
  private readonly blocks: Data;

  constructor(mesh: Part, blocks: Part) {
    this.shape = [mesh.shape[0], mesh.shape[1]];
    this.blocks = blocks.data;
  }

  /** All blocks are drawn as they are: there is nothing coarser. */
  levels(): Int8Array {
    return new Int8Array(this.shape[0] * this.shape[1]);
  }

  /** Vertices of the triangles of blocks whose level is not -1, each triangle once. */
  triangles(levels: Int8Array): Uint32Array {
    const { blocks } = this;
    const drawn = levels.reduce((bits, level, block) => bits | (level < 0 ? 0 : 1 << block), 0);
    const index = new Uint32Array(3 * blocks.length);
    let end = 0;
    for (let n = 0; n < blocks.length; n += 1) {
      if (!(blocks[n] & drawn)) continue;
      for (let k = 0; k < 3; k += 1) index[end++] = 3 * n + k;
    }
    return index.slice(0, end);
  }
}
