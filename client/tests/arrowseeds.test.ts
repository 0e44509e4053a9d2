import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { ArrowSeeds, type SeededSurface, type View } from "../src/arrowseeds.ts";
import type { Header } from "../src/protocol.ts";

interface Case {
  surface: SeededSurface;
  view: View;
  /** Cell, place and radius of each. */
  seeds: number[][];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const { limits, spacing, cases }: { limits: Header["constants"]["arrows"]; spacing: number; cases: Case[] } =
  JSON.parse(readFileSync(new URL("seeds.json", import.meta.url), "utf8"));

const near = (a: number[], b: number[]) => a.every((x, n) => Math.abs(x - b[n]) <= 1e-6 * Math.abs(b[n]) + 1e-12);

for (const { surface } of cases) surface.corners = Uint32Array.from(surface.corners);

cases.forEach(({ surface, view, seeds }, n) => {
  test(`seeds are those of Python, in view ${n}`, () => {
    const found = new ArrowSeeds(surface, limits)
      .seen(view, spacing)
      .map(({ cell, place, radius }) => [cell, ...place, radius])
      .sort((a, b) => a[0] - b[0] || a[3] - b[3]);
    assert.equal(found.length, seeds.length);
    found.forEach((seed, k) => assert.ok(near(seed, seeds[k]), `${seed} is not ${seeds[k]}`));
  });
});

test("seeds that are there serve the next views", () => {
  const [{ surface, view }] = cases;
  const arrows = new ArrowSeeds(surface, limits);
  const first = arrows.seen(view, spacing);
  assert.equal(arrows.seen({ ...view, halfHeight: 0.95 * view.halfHeight }, spacing), first);
  assert.notEqual(arrows.seen({ ...view, halfHeight: 0.5 * view.halfHeight }, spacing), first);
});
