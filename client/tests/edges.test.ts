// What has no length, no width or no direction, and what lies behind or beyond.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Camera, fitted, type CameraLimits, type CameraState } from "../src/camera.ts";
import { groundAt } from "../src/earthlayer.ts";
import { toHalf } from "../src/half.ts";
import { eastNorth, lonLatOf } from "../src/lonlat.ts";
import { grainAt, mover, pathThrough, type PathPlace } from "../src/pointpath.ts";
import { isOfStep, shareOf, type Earth, type Geometry, type Header } from "../src/protocol.ts";
import type { Scene } from "../src/scene.ts";
import { rotated, type Vector } from "../src/vectors.ts";
import { assertClose } from "./close.ts";
import { texelsOf } from "./texels.ts";

interface Example {
  geometry: Geometry;
  limits: CameraLimits;
  nodes: number[];
}

const file = new URL("camera.json", import.meta.url);
const [{ geometry, limits, nodes }]: Example[] = Object.values(JSON.parse(readFileSync(file, "utf8")));

test("a range without a width has one share", () => {
  const scalars = (low: number, high: number, log = false) => ({ low, high, log }) as Header["scalars"];
  assert.equal(shareOf(scalars(2, 2))(2), 0);
  assert.equal(shareOf(scalars(2, 2, true))(2), 0);
});

test("values of a step are those of a scalar that varies", () => {
  const header = { scalars: { steps: 1, choices: [{ steps: 1 }, { steps: 3 }] } } as unknown as Header;
  assert.ok(isOfStep("scalars/2/1", 2, header));
  assert.ok(!isOfStep("scalars/2/1", 1, header));
  assert.ok(!isOfStep("scalars/2", 2, header));
  assert.ok(isOfStep("scalars/2", 2, { scalars: { steps: 3, choices: [] } } as unknown as Header));
});

test("nothing turns around an axis without a direction", () => {
  assert.deepEqual(rotated([1, 0, 0], [0, 0, 0], 90), [0, 0, 0]);
});

test("where nothing is known there is no place on the Earth, and what rests has no direction", () => {
  const globe = { map: null, radius: 2 } as unknown as Earth;
  assert.equal(lonLatOf(globe, [NaN, 0, 0], undefined), null);
  assert.deepEqual(eastNorth(globe, [0, 2, 0], [0, 0, 0], undefined), [0, 0]);
  const [east, north] = eastNorth(globe, [0, 0, 2], [1, 0, 0], undefined); // at the pole
  assert.ok(Number.isFinite(east) && Number.isFinite(north));
  assert.equal(lonLatOf({ ...globe, map: [0, 0, 1, 1] } as unknown as Earth, [0, 0, 0], undefined), null);
});

const eye = (position: Vector, more: Partial<CameraState> = {}): CameraState => ({
  position,
  focal_point: [0, 0, 0],
  up: [0, 0, 1],
  parallel: false,
  parallel_scale: 1,
  view_angle: 30,
  ...more,
});

test("what is behind the eye has no place in the view, and is not looked at", () => {
  const camera = new Camera(eye([5, 0, 0]), limits, false, 1);
  assert.equal(camera.project([6, 0, 0]), null);
  assert.ok(camera.project([-6, 0, 0]));
  camera.pick = () => [9, 0, 0];
  camera.zoomBy(1.5, 0.1, 0.1);
  const before = camera.state.focal_point;
  camera.pick = () => null;
  camera.zoomBy(1.1, 0.1, 0.1);
  assert.ok([...before, ...camera.state.focal_point].every(Number.isFinite));
});

test("a globe is turned up to its poles and not over them, with and without perspective", () => {
  for (const parallel of [false, true]) {
    const camera = new Camera(eye([3, 0, 0], { parallel }), limits, false, 1, 1);
    for (let n = 0; n < 400; n += 1) camera.rotate(0, -0.2);
    const [x, y, z] = camera.state.position;
    assertClose(Math.hypot(x, y, z), 3, 1e-9);
    assert.ok(Math.abs(z) / 3 > 0.9 && Math.hypot(x, y) > 0);
    assert.ok(camera.axes[1].every(Number.isFinite));
  }
});

test("nodes without a position do not count for what is seen", () => {
  const seen = fitted(geometry, limits, nodes, 1.5);
  assert.deepEqual(fitted(geometry, limits, [NaN, NaN, NaN, ...nodes], 1.5), seen);
});

test("the ground is where a ray meets the globe or the map, and nowhere beside them", () => {
  const header = (earth: object | null) =>
    ({ earth, geometry: { frame: FRAME, center: [0, 0, 0] } }) as unknown as Header;
  const camera = new Camera(eye([0, 0, 5], { up: [0, 1, 0], parallel: true, parallel_scale: 4 }), limits, true, 1);
  const globe = header({ map: null, radius: 2 });
  assertClose(groundAt(globe, camera, 0, 0), [0, 0, 2], 1e-9); // on the near side
  assertClose(groundAt(globe, camera, 0.25, 0), [1, 0, Math.sqrt(3)], 1e-9);
  assert.equal(groundAt(globe, camera, 0.75, 0), null);
  camera.state.focal_point = [0, 0, 10]; // away from it
  assert.equal(groundAt(globe, camera, 0, 0), null);
  camera.state.focal_point = [0, 0, 0];
  const map = header({ map: [-1, -2, 3, 2] });
  assertClose(groundAt(map, camera, 0.5, 0.25), [2, 1, 0], 1e-9);
  const beside = [[-0.5, 0], [0.9, 0], [0, -0.6], [0, 0.6]].map(([x, y]) => groundAt(map, camera, x, y));
  assert.deepEqual(beside, [null, null, null, null]);
  assert.equal(groundAt(header(null), camera, 0, 0), null);
});

// --- paths ---

/** A square of two by two nodes over which all moves along x, or nothing at all. */
function placed(speed: number, more: object = {}, flip: number[] = []): PathPlace {
  const lags = [1, 2];
  // The tangent with the length of the base, and two slices on either side that go straight on.
  const layers = Array.from({ length: 5 }, (_, layer) =>
    Array.from({ length: 4 }, (__, node) => {
      const way = speed * (flip.includes(node) ? -1 : 1);
      return [way, 0, 0, layer === 0 ? 1 : 2];
    }),
  ).flat(2);
  const size = { before: 0, size: 2 };
  const header = {
    geometry: { shape: [2, 2], rows: size, columns: size, triangles: false, planar: true, extent: 1, frame: FRAME },
    slices: { lags, sides: 2, channels: 4, extra: [], unit: 0.1, cell: 0.5 },
    speed: { typical: 1 },
    variant: flip.length ? ["FLOWTEX_SIGNFREE"] : [],
    image: null,
    ...more,
  };
  const parts: Record<string, { data: ArrayLike<number> }> = {
    "slices/0": { data: Uint16Array.from(layers, toHalf) },
    position: { data: Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0) },
  };
  const cornersAt = ([i, j]: [number, number]) =>
    [(1 - i) * (1 - j), i * (1 - j), (1 - i) * j, i * j].map((share, node) => [node, share]);
  const part = (name: string) => parts[name];
  const texels = texelsOf(header as unknown as Header, part as unknown as Parameters<typeof texelsOf>[1]);
  const scene = { header, parts: new Map(), part, texels, cornersAt };
  return { scene: scene as unknown as Scene, moment: [0, 0, 0], place: [0.5, 0.5], position: [0.5, 0.5, 0] };
}

const FRAME = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const above = new Camera(
  { ...eye([0.5, 0.5, 5]), focal_point: [0.5, 0.5, 0], up: [0, 1, 0], parallel: true, parallel_scale: 0.5 },
  limits,
  true,
  1,
);
const settings = { samples: 5, spacing: 1, grain: 2, resolution: 100, lod: true, two_sided: true, motion: "off" };

test("where nothing moves the path is the point", () => {
  const found = pathThrough(placed(0), settings, above, 100);
  assert.deepEqual([found.path, found.sampled, found.velocity], [[[0.5, 0.5, 0]], [[0.5, 0.5, 0]], [0, 0, 0]]);
});

test("a path is as long as its samples, on one side or on both", () => {
  const ends = (two_sided: boolean) => {
    const { sampled } = pathThrough(placed(1), { ...settings, two_sided }, above, 100);
    return [sampled[0][0], sampled[sampled.length - 1][0]];
  };
  assertClose(ends(true), [0.46, 0.54], 1e-6); // two samples of 0.02 on a side
  assertClose(ends(false), [0.42, 0.5], 1e-6);
  const none = pathThrough(placed(1), { ...settings, samples: 1 }, above, 100).sampled;
  assert.deepEqual(none, [[0.5, 0.5, 0]]);
});

test("without a sign nodes that point the other way are turned", () => {
  const turned = pathThrough(placed(1, {}, [1, 3]), settings, above, 100);
  const straight = pathThrough(placed(1, {}, [9]), settings, above, 100);
  assert.ok(!turned.directed && !straight.directed);
  assertClose(turned.sampled, straight.sampled, 1e-6);
});

const image = { alongI: [0, 1], alongJ: [0, 1], stepSize: [20, 20] };

test("beyond the border of an image there is no place", () => {
  const moved = mover(placed(1, { image }));
  assertClose(moved([0.25, 0, 0]), [0.75, 0.5, 0], 1e-6);
  assertClose(moved([-0.5, 0, 0]), [0, 0.5, 0], 1e-6);
  assert.equal(moved([0.75, 0, 0]), null);
  assert.equal(moved([0, -0.75, 0]), null);
});

test("a grain is as long as a pixel or a texel of the image's steps", () => {
  const grain = (more: object, lines = {}) => grainAt(placed(1, lines), { ...settings, ...more }, above, 100);
  assertClose(grain({}), 0.02);
  assertClose(grain({ lod: false }), 0.01);
  assertClose(grain({ fixed_grain: true, resolution: 10 }), 0.1);
  assertClose([grain({}, { image }), grain({ lod: false }, { image })], [0.05, 0.05]);
  const noise = { ...image, stepSize: [200, 200], deviations: [1] };
  assertClose([grain({ grain: 3 }, { image: noise }), grain({ lod: false }, { image: noise })], [0.03, 0.005]);
});
