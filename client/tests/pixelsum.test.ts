// Samples, their noise and their sum are those of the judge.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Camera, type CameraState } from "../src/camera.ts";
import { constantsOf, noiseAround, pixelSum } from "../src/pixelsum.ts";
import type { Header, Part } from "../src/protocol.ts";
import { cornersAt } from "../src/mesh.ts";
import type { Scene } from "../src/scene.ts";
import type { Uniform } from "../src/uniforms.ts";
import type { Vector } from "../src/vectors.ts";
import { assertClose } from "./close.ts";
import { texelsOf } from "./texels.ts";

interface Case {
  header: Header;
  camera: CameraState;
  size: [number, number];
  place: [number, number];
  position: Vector;
  points: number[][];
  lags: number[];
  weights: number[];
  greys: number[];
  noise: number[];
  level: number;
  gain: number;
  value: number;
}

interface NoiseCase {
  uniforms: Record<string, Uniform>;
  point: Vector;
  moved: Vector;
  octave: number;
  planar: boolean;
  values: number[];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const file = new URL("samples.json", import.meta.url);
const cases: { parts: Record<string, Part>; sums: Record<string, Case>; noise: NoiseCase[] } = JSON.parse(
  readFileSync(file, "utf8"),
);
const shader = readFileSync(new URL("../../shaders/common/constants.glsl", import.meta.url), "utf8");
const constants = constantsOf(shader);

test("constants are those of the shader's text", () => {
  assert.deepEqual(constants.AXIS_PRIMES, [0x8da6b343, 0xd8163841, 0xcb1ab31f]);
  assert.deepEqual(constants.LEAST_WEIGHT, [1e-3]);
  assert.equal(constants.TO_CONES.length, 9);
  assert.ok(Object.values(constants).flat().every(Number.isFinite));
});

for (const { uniforms, point, moved, octave, planar, values } of cases.noise) {
  test(`noise is that of Python: octave ${octave}, ${planar ? "plane" : "space"}`, () => {
    assertClose(noiseAround(point, octave, planar, false, uniforms, constants)(moved), values, 1e-6);
  });
}

for (const [name, each] of Object.entries(cases.sums)) {
  test(`samples and sum are those of Python: ${name}`, () => {
    const { header, size, place, position } = each;
    header.shaders = { fragment: shader } as Header["shaders"];
    const parts = new Map(Object.entries(cases.parts));
    const scene = {
      header,
      parts,
      part: (part: string) => parts.get(part),
      texels: texelsOf(header, (part) => parts.get(part)),
      cornersAt: (at: [number, number]) => cornersAt(header.geometry.shape, at),
    } as unknown as Scene;
    const camera = new Camera(each.camera, header.limits, true, size[0] / size[1]);
    const at = { scene, moment: [0, 0, 0] as [number, number, number], place, position };
    const sum = pixelSum({ at, settings: header.settings, camera, rows: size[1] });
    assert.ok(sum);
    const close = (found: unknown, expected: unknown, what: string) =>
      assertClose(found, expected, 2e-3, what);
    close(sum.level, each.level, "level");
    close(sum.gain, each.gain, "gain");
    close(
      sum.samples.map(({ weight }) => weight),
      each.weights,
      "weights",
    );
    close(
      sum.samples.map(({ lag }) => lag),
      each.lags,
      "lags",
    );
    sum.samples.forEach(({ grey }, n) => assert.ok(Math.abs(grey - each.greys[n]) < 0.01, `grey ${n}`));
    close(
      sum.samples.map(({ position: point }) => point),
      each.points,
      "points",
    );
    const apart = sum.samples.map(({ noise }, n) => Math.abs(noise - each.noise[n]));
    assert.ok(Math.max(...apart) < 0.02, `noise is ${Math.max(...apart)} off`);
    assert.ok(Math.abs(sum.gain * sum.mean - each.value) < 0.02);
    assertClose(sum.samples[sum.middle].position, position, 1e-9);
  });
}

test("where the grains move nothing is told", () => {
  const { header, position, place } = cases.sums.whole;
  const scene = { header } as Scene;
  const at = { scene, moment: [0, 0, 0] as [number, number, number], place, position };
  const camera = new Camera(cases.sums.whole.camera, header.limits, true);
  assert.equal(pixelSum({ at, settings: { ...header.settings, motion: "speed" }, camera, rows: 100 }), null);
});
