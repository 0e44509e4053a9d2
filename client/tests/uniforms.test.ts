import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import type { Header } from "../src/protocol.ts";
import { isMoving, isNear, momentOf, uniforms, type Uniform, type ViewState } from "../src/uniforms.ts";
import { assertClose } from "./close.ts";

interface Case {
  header: Header;
  view: ViewState;
  moving: boolean;
  near: boolean;
  uniforms: Record<string, Uniform>;
}

// What Python computes: tests/rendering/test_client_numbers.py.
const file = new URL("uniforms.json", import.meta.url);
const cases: Record<string, Case> = JSON.parse(readFileSync(file, "utf8"));

for (const [name, { header, view, moving, near, uniforms: expected }] of Object.entries(cases)) {
  test(`uniforms are those of Python: ${name}`, () => {
    assertClose(uniforms(header, header.settings, view), expected, 1e-12);
    assert.equal(isMoving(header, header.settings), moving);
    assert.equal(isNear(header, header.settings, view), near);
  });
}

test("an image takes its level from as many more texels as pixels are drawn", () => {
  const { header, view } = cases["finer image"];
  const sizeAt = (density: number) =>
    uniforms(header, header.settings, { ...view, density }).u_imageSize as number[];
  assert.deepEqual(
    sizeAt(2),
    sizeAt(1).map((n) => 2 * n),
  );
});

test("a grain is as small as the density asks for", () => {
  const { header, view } = cases.coarser;
  const settings = { ...header.settings, grain: 1.5 };
  assert.equal(uniforms(header, settings, { ...view, density: 0.25 }).u_grain, 0.375);
});

test("a time lies between two steps, and outside of them at an end", () => {
  assert.deepEqual(momentOf([3], 5), [0, 0, 0]);
  assert.deepEqual(momentOf([0, 1, 3], 2), [1, 2, 0.5]);
  assert.deepEqual(momentOf([0, 1, 3], 1), [1, 2, 0]);
  assert.deepEqual(momentOf([0, 1, 3], 9), [1, 2, 1]);
  assert.deepEqual(momentOf([0, 1, 3], -9), [0, 1, 0]);
});
