import assert from "node:assert/strict";
import { test } from "node:test";
import { cornersAndBlocks, cornersOf, interpolated, placeIn } from "../src/mesh.ts";

/** Two triangles between four nodes. */
const TRIANGLES = Uint32Array.of(0, 1, 2, 2, 1, 3);

test("a triangle has its nodes and the blocks in which it lies", () => {
  assert.deepEqual([...cornersAndBlocks(TRIANGLES, Uint16Array.of(1, 1 << 15))], [0, 1, 2, 1, 2, 1, 3, 1 << 15]);
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
