import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { join, type Region } from "../src/meshlevels.ts";
import type { MeshLimits, NamedPart, PyramidHeader } from "../src/protocol.ts";
import {
  cellPixels,
  cover,
  fullIndex,
  nameOf,
  Pyramid,
  wantedTiles,
  type TileView,
} from "../src/tilechoice.ts";
import { TileQueue } from "../src/tilequeue.ts";

interface Tiles {
  pyramid: PyramidHeader;
  places: number[];
  periodic: [boolean, boolean];
  limits: MeshLimits;
  views: {
    view: TileView;
    chosen: Record<string, [needed: boolean, finer: string[]]>;
    wanted: string[];
    ready: string[];
    shown: Record<string, string[]>;
    regions: (Omit<Region, "levels"> & { levels: number[]; joined: number[]; borders: number[] })[];
  }[];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const data: Tiles = JSON.parse(readFileSync(new URL("tiles.json", import.meta.url), "utf8"));

for (const [n, { view, chosen, wanted, ready, shown, regions }] of data.views.entries()) {
  test(`tiles are chosen as Python does: view ${n}`, () => {
    const pyramid = new Pyramid(data.pyramid, Float32Array.from(data.places));
    const choices = pyramid.choose(view);
    const found = [...choices].map(([name, { needed, finer }]) => [name, [needed, finer]]);
    assert.deepEqual(Object.fromEntries(found), chosen);
    assert.deepEqual(wantedTiles(choices).sort(), [...wanted].sort());
    const covered = cover(choices, (name) => ready.includes(name));
    assert.deepEqual(Object.fromEntries(covered), shown);
  });

  test(`tiles join as in Python: view ${n}`, () => {
    const parts = regions.map((region) => ({ ...region, levels: Int8Array.from(region.levels) }));
    const most = Math.log2(data.limits.tileCells);
    const borders = join(parts, data.pyramid.blocks[0], data.periodic, most);
    regions.forEach((region, k) => {
      assert.deepEqual([...parts[k].levels], region.joined);
      // Borders of what is not drawn are of no use.
      const drawn = (values: number[]) => values.filter((_, at) => region.joined[at >> 2] >= 0);
      assert.deepEqual(drawn([...borders[k]]), drawn(region.borders));
    });
  });
}

test("long streaks ask for coarser tiles", () => {
  const settings = { samples: 25, spacing: 0.7, grain: 2 };
  assert.equal(cellPixels(data.pyramid, settings), 2);
  assert.equal(cellPixels(data.pyramid, { ...settings, grain: 8 }), 140 / 32);
});

test("a place on a coarse level lies among all nodes", () => {
  assert.equal(fullIndex(3, 0, 10), 3);
  assert.equal(fullIndex(1.5, 2, 10), 6);
  assert.equal(fullIndex(2.5, 2, 10), 8.5); // the last line is always there
  assert.equal(fullIndex(3, 2, 10), 9);
});

test("tiles that are not wanted any more are given up", async () => {
  const [given, aborted]: [string[], string[]] = [[], []];
  const waiting: (() => void)[] = [];
  const queue = new TileQueue(
    (key, steps, signal) =>
      new Promise((resolve) => {
        signal.addEventListener("abort", () => aborted.push(nameOf(key)));
        waiting.push(() => resolve([{ name: `${nameOf(key)} ${steps}` } as NamedPart]));
      }),
    (part) => given.push(part.name),
  );
  queue.request([[0, 0, 0], [0, 0, 1]], [0]);
  queue.request([[0, 0, 1], [0, 0, 2]], [0]);
  assert.deepEqual(aborted, ["0/0/0"]);
  for (let n = 0; n < 3; n += 1) {
    waiting.shift()?.();
    await new Promise((resolve) => setTimeout(resolve, 0));
  }
  assert.deepEqual(given, ["0/0/1 0", "0/0/2 0"]);
});
