import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Camera, type CameraLimits } from "../src/camera.ts";
import { mostDoublings, seenBlocks } from "../src/meshlevels.ts";
import type { Geometry, Part } from "../src/protocol.ts";
import type { Vector } from "../src/vectors.ts";

const file = new URL("camera.json", import.meta.url);
const [{ limits }]: { limits: CameraLimits }[] = Object.values(JSON.parse(readFileSync(file, "utf8")));

/** Blocks in the plane from their middles, with a radius and a size of cells. */
function blocks(rows: number, columns: number, radius: number, cell: number): Part {
  const places = Array.from({ length: rows * columns }, (_, n) => [n % columns, Math.floor(n / columns), 0, radius, cell]);
  return { data: Float32Array.from(places.flat()), shape: [rows, columns, 5], digest: "" };
}

function camera(focus: Vector, half: number, parallel: boolean): Camera {
  const [x, y] = focus;
  const state = { position: [x, y, half / Math.tan(Math.PI / 12)], focal_point: focus, up: [0, 1, 0], parallel };
  return new Camera({ ...state, parallel_scale: half, view_angle: 30 }, limits, true, 1.5);
}

const most = (count: number) => new Int8Array(count).fill(6);

test("triangles are of a pixel to three where nodes are closer", () => {
  const levels = (cell: number, parallel: boolean) =>
    seenBlocks(blocks(1, 1, 0.01, cell), camera([0, 0, 0], 1, parallel), 200, [], most(1)).levels[0];
  for (const parallel of [true, false]) {
    assert.equal(levels(0.0101, parallel), 1); // a pixel is 0.01
    assert.equal(levels(0.001, parallel), 4);
    assert.equal(levels(1e-9, parallel), 6);
    assert.equal(levels(0.5, parallel), 0);
  }
});

test("blocks beside the view and those that others cover are not drawn", () => {
  const { levels, box } = seenBlocks(blocks(3, 4, 0.4, 0.5), camera([1, 1, 0], 0.5, true), 100, [[1, 1, 1]], most(12));
  const drawn = [...levels].flatMap((level, n) => (level < 0 ? [] : [n]));
  assert.deepEqual(drawn, [4, 6]);
  assert.deepEqual(box.map((side) => Math.round(100 * side)), [-187, -80, 187, 80]);
});

test("the box of what is drawn has all of its balls in it", () => {
  for (const parallel of [true, false]) {
    const view = camera([0.3, -0.2, 0], 2, parallel);
    const { box } = seenBlocks(blocks(1, 1, 0.7, 0.5), view, 100, [], most(1));
    for (let n = 0; n < 100; n += 1) {
      const [a, b] = [0.4 * n, 1.3 * n];
      const [x, y] = view.project([0.7 * Math.cos(a) * Math.sin(b), 0.7 * Math.sin(a) * Math.sin(b), 0.7 * Math.cos(b)]) ?? [];
      assert.ok(Number(x) >= box[0] && Number(y) >= box[1] && Number(x) <= box[2] && Number(y) <= box[3]);
    }
    assert.ok(box[2] - box[0] < 0.7);
  }
});

test("no node is left out where some have no position", () => {
  const positions = new Float32Array(3 * 9 * 13);
  positions[3 * (4 * 13 + 8)] = NaN; // at the corner of four blocks
  const geometry = { shape: [9, 13], triangles: false } as unknown as Geometry;
  assert.deepEqual([...mostDoublings(geometry, blocks(2, 3, 1, 1), positions, 4)], [2, 0, 0, 2, 0, 0]);
});
