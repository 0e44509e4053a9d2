import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import {
  Camera,
  fitted,
  isSamePlace,
  projection,
  rays,
  widened,
  type CameraLimits,
  type CameraState,
} from "../src/camera.ts";
import type { Geometry } from "../src/protocol.ts";
import { add, dot, length, scale, subtract, toFrame, type Vector } from "../src/vectors.ts";
import { assertClose } from "./close.ts";

interface Case {
  geometry: Geometry;
  limits: CameraLimits;
  nodes: number[];
  aspect: number;
  fit: CameraState;
  moves: { name: "pan" | "rotate" | "zoom"; values: number[] }[];
  states: CameraState[];
  points: Vector[];
  places: [number, number][];
  ray: [Vector, Vector];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const file = new URL("camera.json", import.meta.url);
const cases: Record<string, Case> = JSON.parse(readFileSync(file, "utf8"));

function cameraOf({ fit, limits, geometry, aspect }: Case): Camera {
  return new Camera(fit, limits, geometry.planar, aspect);
}

/** Place of a point in the view. */
function placeOf(example: Case, camera: Camera, point: Vector, anchor: Vector): [number, number] {
  const { geometry } = example;
  const m = projection(geometry, camera, anchor);
  const p = subtract(toFrame(geometry.frame, subtract(point, geometry.center)), anchor);
  const row = (k: number) => m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k];
  return [row(0) / row(3), row(1) / row(3)];
}

for (const [name, example] of Object.entries(cases)) {
  test(`moves of the camera are those of Python: ${name}`, () => {
    const camera = cameraOf(example);
    example.moves.forEach(({ name: move, values }, n) => {
      if (move === "zoom") camera.zoomBy(values[0], values[1], values[2]);
      else camera[move](values[0], values[1]);
      const { parallel_scale: half, ...state } = example.states[n];
      const { parallel_scale: ours, ...actual } = camera.state;
      if (state.parallel) assertClose(ours, half);
      assertClose(actual, state, 1e-8, `after move ${n}`);
    });
  });

  test(`the camera that shows all is that of Python: ${name}`, () => {
    const actual = fitted(example.geometry, example.limits, example.nodes, example.aspect);
    // Without perspective any distance will do, and with it any scale.
    const { parallel_scale: ours, ...state } = actual;
    const { parallel_scale: theirs, ...expected } = example.fit;
    assertClose(state, expected, 1e-6);
    if (state.parallel) assertClose(ours, theirs, 1e-6);
  });

  test(`points are seen where Python sees them, from any anchor: ${name}`, () => {
    const camera = cameraOf(example);
    for (const anchor of [[0, 0, 0], [0.3, -0.2, 0.1]] as Vector[]) {
      const places = example.points.map((point) => placeOf(example, camera, point, anchor));
      assertClose(places, example.places);
    }
    const ray = camera.ray(0.4, -0.3);
    assertClose(ray, example.ray);
    assertClose(placeOf(example, camera, add(ray[0], scale(ray[1], 1.5)), [0, 0, 0]), [0.4, -0.3]);
  });

  test(`the point under the pointer stays there in a zoom: ${name}`, () => {
    const camera = cameraOf(example);
    const point = example.points[1];
    camera.pick = () => point;
    const [x, y] = placeOf(example, camera, point, [0, 0, 0]);
    camera.zoomBy(5, x, y);
    assertClose(placeOf(example, camera, point, [0, 0, 0]), [x, y]);
    assertClose(camera.zoom > 3, true);
  });

  test(`zoom ends where the header says: ${name}`, () => {
    const camera = cameraOf(example);
    camera.zoomBy(1e9);
    if (example.geometry.planar) assertClose(camera.zoom, example.limits.deepest_zoom);
    else assertClose(camera.distance, new Camera(example.fit, example.limits, false).distance / example.limits.closest);
    const far = cameraOf({ ...example, limits: { ...example.limits, farthest_zoom: 0.5 } });
    far.zoomBy(1e-9);
    assertClose(far.zoom, 0.5);
    far.zoomBy(NaN);
    far.zoomBy(-1);
    assertClose(far.zoom, 0.5);
  });
}

test("the ray through a pixel meets what is seen there", () => {
  for (const example of Object.values(cases)) {
    const camera = cameraOf(example);
    const { geometry, points } = example;
    const [width, height] = [300, 200];
    const anchor: Vector = [0.1, -0.2, 0.3];
    const { u_rayCorner, u_rayX, u_rayY } = rays(geometry, camera, anchor, width, height);
    const local = (point: readonly number[]) => subtract(toFrame(geometry.frame, subtract(point, geometry.center)), anchor);
    for (const point of points) {
      const place = camera.project(point);
      if (!place) continue;
      const [x, y] = place.map((at, axis) => (0.5 + 0.5 * at) * [width, height][axis]);
      const there = add(add(u_rayCorner, u_rayX, x), u_rayY, y);
      const toEye = camera.state.parallel
        ? toFrame(geometry.frame, camera.axes[2])
        : subtract(there, local(camera.state.position));
      const away = subtract(local(point), there);
      const across = subtract(away, scale(toEye, dot(away, toEye) / dot(toEye, toEye)));
      assert.ok(length(across) < 1e-9 * camera.distance);
    }
  }
});

test("a first camera is widened for narrower views, and any other left alone", () => {
  for (const example of Object.values(cases)) {
    const { geometry, limits, nodes } = example;
    const first = fitted(geometry, limits, nodes, 1.5);
    const narrow = widened(geometry, limits, first, nodes, 0.5);
    const [before, after] = [first, narrow].map((state) => new Camera(state, limits, geometry.planar).height);
    assert.ok(after > 1.2 * before);
    assertClose(widened(geometry, limits, first, nodes, 1.5), first);
    const aside = { ...first, focal_point: add(first.focal_point, [geometry.extent, 0, 0]) };
    assertClose(widened(geometry, limits, aside, nodes, 0.5), aside);
  }
});

test("a coarse form lies in the place of the whole, another surface does not", () => {
  const { geometry } = cases.flat;
  const center = add(geometry.center, [0.01 * geometry.extent, 0, 0]);
  assert.ok(isSamePlace(geometry, { ...geometry, center, extent: 1.1 * geometry.extent }));
  assert.ok(!isSamePlace(geometry, { ...geometry, extent: 2 * geometry.extent }));
  assert.ok(!isSamePlace(geometry, cases.curved.geometry));
  const { frame } = geometry;
  const turned = [...frame.slice(3, 6), ...frame.slice(6, 9), ...frame.slice(0, 3)];
  assert.ok(!isSamePlace(geometry, { ...geometry, frame: turned })); // a plane across it
});

for (const [name, example] of Object.entries(cases)) {
  test(`planes are the sides of what is seen: ${name}`, () => {
    const camera = cameraOf(example);
    const isInside = (x: number, y: number) => {
      const [start, along] = camera.ray(x, y);
      const point = [...add(start, along, camera.distance), 1];
      return camera.planes.every((p) => p.reduce((sum, c, n) => sum + c * point[n], 0) >= 0);
    };
    assert.ok([[0.99, 0], [-0.99, 0.99], [0.5, -0.99]].every(([x, y]) => isInside(x, y)));
    assert.ok(![[1.01, 0], [-1.01, 0], [0, 1.01], [0.5, -1.01]].some(([x, y]) => isInside(x, y)));
  });
}
