import assert from "node:assert/strict";
import { test } from "node:test";
import { interpolated } from "../src/mesh.ts";
import type { Part } from "../src/protocol.ts";
import {
  atVertices,
  cornersOf,
  placeIn,
  TriangleMesh,
  vertexCorners,
  vertexShares,
} from "../src/trianglemesh.ts";

/** Two triangles between four nodes. */
const TRIANGLES = Uint32Array.of(0, 1, 2, 2, 1, 3);

test("each triangle has vertices of its own", () => {
  const pairs = Int16Array.of(0, 1, 10, 11, 20, 21, 30, 31);
  const apart = atVertices(pairs, TRIANGLES, 2);
  assert.ok(apart instanceof Int16Array);
  assert.deepEqual([...apart], [0, 1, 10, 11, 20, 21, 20, 21, 10, 11, 30, 31]);
  assert.deepEqual([...vertexShares(2)], [0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]);
  const corners = [...vertexCorners(TRIANGLES)];
  assert.deepEqual(corners, [0, 1, 2, 0, 1, 2, 0, 1, 2, 2, 1, 3, 2, 1, 3, 2, 1, 3]);
});

test("a place is in a triangle, and values there are linear", () => {
  const place = placeIn(1, 0.5, 0.25);
  assert.deepEqual(place, [0.25, 1.5]);
  assert.deepEqual(cornersOf(TRIANGLES, place), [
    [2, 0.25],
    [1, 0.5],
    [3, 0.25],
  ]);
  assert.equal(interpolated(cornersOf(TRIANGLES, place), (node) => node), 1.75);
});

test("the second corner belongs to its triangle, and not to the next", () => {
  for (const share of [1, 1.0001]) {
    const corners = cornersOf(TRIANGLES, placeIn(0, share, 0));
    assert.deepEqual(
      corners.map(([node]) => node),
      [0, 1, 2],
    );
    assert.ok(Math.abs(interpolated(corners, (node) => node) - 1) < 1e-6);
  }
});

test("triangles of blocks that are drawn are drawn once", () => {
  const part = (data: Uint16Array | Float32Array, shape: number[]): Part => ({
    data,
    shape,
    digest: "",
  });
  // The last of 16 blocks, the first, and both.
  const blocks = part(Uint16Array.of(1 << 15, 1, (1 << 15) | 1), [3]);
  const mesh = new TriangleMesh(part(new Float32Array(80), [4, 4, 5]), blocks);
  assert.deepEqual(mesh.shape, [4, 4]);
  const levels = mesh.levels();
  assert.deepEqual([...mesh.triangles(levels)], [0, 1, 2, 3, 4, 5, 6, 7, 8]);
  levels[0] = -1;
  assert.deepEqual([...mesh.triangles(levels)], [0, 1, 2, 6, 7, 8]);
  levels.fill(-1);
  levels[0] = 0;
  assert.deepEqual([...mesh.triangles(levels)], [3, 4, 5, 6, 7, 8]);
});
