// What stands beside the flow: ends of lines, lights, and depths that reach as far.

import assert from "node:assert/strict";
import { test } from "node:test";

import { atEnds, lightUniforms } from "../src/bodies.ts";
import { Camera, projection, type CameraLimits } from "../src/camera.ts";
import type { Header } from "../src/protocol.ts";
import type { Vector } from "../src/vectors.ts";

const FRAME = [0, 1, 0, 0, 0, 1, 1, 0, 0];
const geometry = { planar: true, extent: 2, center: [1, 2, 3], frame: FRAME };
const camera = new Camera(
  { position: [1, 2, 13], focal_point: [1, 2, 3], up: [0, 1, 0], parallel: true, parallel_scale: 1, view_angle: 30 },
  { closest: 1e4 } as CameraLimits,
  true,
);

test("pieces of lines have the values of both ends", () => {
  assert.deepEqual([...atEnds(Float32Array.of(1, 2, 3, 4, 5, 6), [1, 0, 2, 2], 2)], [3, 4, 1, 2, 5, 6, 5, 6]);
});

test("lights turn with the camera, or stay", () => {
  const lights = [
    { way: [0, 0, 1], color: [1, 0.5, 0], turns: true },
    { way: [1, 0, 0], color: [0, 0, 1], turns: false },
  ];
  const header = { geometry, bodies: { runs: [], labels: [], lights } } as unknown as Header;
  const { u_lightWays: ways, u_lightColours: colours } = lightUniforms(header, camera);
  // The eye lies along z, which is the surface's second axis; x is its third.
  assert.deepEqual([...ways.slice(0, 6)], [0, 1, 0, 0, 0, 1]);
  assert.deepEqual([...colours.slice(0, 6)], [1, 0.5, 0, 0, 0, 1]);
  assert.ok([...ways.slice(6), ...colours.slice(6)].every((n) => n === 0));
});

test("depths reach as far as what stands beside the flow", () => {
  const depth = (reach: number, z: number) => {
    const m = projection({ ...geometry, reach }, camera, [0, 0, 0] as Vector);
    return m[6] * z + m[14]; // the frame's second axis is z
  };
  assert.ok(Math.abs(depth(0, 5)) > 1);
  assert.ok(Math.abs(depth(5, 5)) <= 1);
  assert.equal(Math.sign(depth(5, 1)), -1); // nearer to the eye
});
