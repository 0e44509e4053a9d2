import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import type { PyramidHeader } from "../src/protocol.ts";
import {
  cellPixels,
  cover,
  fullIndex,
  levelIndex,
  Pyramid,
  wantedTiles,
  type TileView,
} from "../src/tilechoice.ts";

interface View {
  view: TileView;
  chosen: Record<string, [needed: boolean, finer: string[]]>;
  wanted: string[];
  ready: string[];
  shown: Record<string, string[]>;
}

interface Tiles {
  pyramid: PyramidHeader;
  places: number[];
  views: View[];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const read = (name: string) => JSON.parse(readFileSync(new URL(name, import.meta.url), "utf8"));
const data: Tiles = read("tiles.json");
const triangles: Tiles = read("triangles.json");

const all = [data, triangles].flatMap(({ views, ...tiles }) => views.map((view) => ({ ...tiles, ...view })));

for (const [n, { pyramid: header, places, view, chosen, wanted, ready, shown }] of all.entries()) {
  test(`tiles are chosen as Python does: view ${n}`, () => {
    // JSON has no infinity: what is empty has a radius below all others.
    const numbers = places.map((x) => (x <= -1e30 ? -Infinity : x));
    const pyramid = new Pyramid(header, Float32Array.from(numbers));
    const choices = pyramid.choose(view);
    const found = [...choices].map(([name, { needed, finer }]) => [name, [needed, finer]]);
    assert.deepEqual(Object.fromEntries(found), chosen);
    assert.deepEqual(wantedTiles(choices).sort(), [...wanted].sort());
    const covered = cover(choices, (name) => ready.includes(name));
    assert.deepEqual(Object.fromEntries(covered), shown);
  });
}

test("long streaks ask for coarser tiles", () => {
  const settings = { samples: 25, spacing: 0.7, grain: 2 };
  const { cellPixels: pixels, pathCells } = data.pyramid;
  assert.equal(cellPixels(data.pyramid, settings), pixels);
  assert.equal(cellPixels(data.pyramid, { ...settings, grain: 8 }), 140 / pathCells);
});

test("a place on a coarse level lies among all nodes", () => {
  assert.equal(fullIndex(3, 0, 10), 3);
  assert.equal(fullIndex(1.5, 2, 10), 6);
  assert.equal(fullIndex(2.5, 2, 10), 8.5); // the last line is always there
  assert.equal(fullIndex(3, 2, 10), 9);
});

test("a place among the lines of a level is found again from that of level 0", () => {
  for (const [place, level, nodes] of [[2.25, 3, 100], [12.9, 3, 100], [12.1, 3, 102], [0, 2, 5], [1, 2, 5]]) {
    const found = levelIndex(fullIndex(place, level, nodes), level, nodes);
    assert.ok(Math.abs(found - Math.min(place, Math.ceil((nodes - 1) / 2 ** level))) < 1e-12);
  }
});
