// Lines of the Earth, longitude and latitude, and dates: earth.json has what Python computes.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

import { dateText, eastNorth, lonLatOf, lonLatText } from "../src/lonlat.ts";
import { BREAK, linePoints, linesOf, pieceGroups, thinned, visibleRuns } from "../src/earthlayer.ts";
import type { Earth } from "../src/protocol.ts";

interface Map {
  earth: Earth;
  steps: number[];
  points: number[][];
  /** Points that are left with one about every 5 km, of the lines that are that long. */
  thinned: number[][];
  starts: number[];
  lonlat: { shape: number[]; data: number[] } | null;
  positions: number[][];
  expected: [number, number][];
  vector: number[];
  at: number[];
}

interface Moment {
  start: string;
  step: number;
  time: number;
  text: string;
}

const { maps, dates }: { maps: Record<string, Map>; dates: Moment[] } = JSON.parse(
  readFileSync(new URL("earth.json", import.meta.url), "utf8"),
);
const placesOf = ({ lonlat }: Map) =>
  lonlat ? { shape: lonlat.shape, data: new Float64Array(lonlat.data), digest: "" } : undefined;
const isBreak = (points: Float32Array, n: number) => points[3 * n] === Math.fround(BREAK);

for (const [name, map] of Object.entries(maps)) {
  test(`lines are where they are in Python, on ${name}`, () => {
    const anchor: [number, number, number] = [1000, -2000, 500];
    const points = linePoints(linesOf(map.steps, map.earth), anchor);
    const nodes = points.length / 3;
    const places = Array.from({ length: nodes }, (_, n) => n).filter((n) => !isBreak(points, n));
    assert.equal(places.length, map.points.length);
    places.forEach((n, at) => {
      for (let k = 0; k < 3; k += 1) {
        const error = points[3 * n + k] - (map.points[at][k] - anchor[k]);
        assert.ok(Math.abs(error) <= map.earth.size[k] / 65535 + 1);
      }
    });
    // A break stands before each line.
    const breaks = Array.from({ length: nodes }, (_, n) => n).filter((n) => isBreak(points, n));
    assert.deepEqual(breaks.map((n, line) => n - line), map.starts);
  });

  test(`lines are thinned as in Python, on ${name}`, () => {
    const cuts = [...map.starts.slice(1), map.points.length];
    const lines = cuts.map((end, n) => map.points.slice(map.starts[n], end));
    assert.deepEqual(thinned(lines as [number, number, number][][], 5000).flat(), map.thinned);
  });

  test(`a velocity has an eastward and a northward component, on ${name}`, () => {
    const [east, north] = eastNorth(map.earth, map.at, map.vector, placesOf(map));
    assert.ok(Math.abs(east - 2) < 1e-4 && Math.abs(north + 1) < 1e-4);
  });

  test(`places have their longitude and latitude, on ${name}`, () => {
    map.positions.forEach((position, n) => {
      const found = lonLatOf(map.earth, position, placesOf(map));
      assert.ok(found);
      const turns = (found[0] - map.expected[n][0]) / 360;
      assert.ok(Math.abs(turns - Math.round(turns)) < 1e-5);
      assert.ok(Math.abs(found[1] - map.expected[n][1]) < 1e-3);
    });
  });
}

test("a place beside a map without its grid is not known", () => {
  assert.equal(lonLatOf(maps.platecarree.earth, [0, 0, 0], undefined), null);
});


test("longitude and latitude are told with the decimals that a view tells apart", () => {
  assert.equal(lonLatText([12.3456, 45.2], 0.1), "12.35° E, 45.20° N");
  assert.equal(lonLatText([-12.3456, -45.2], 1e-3), "12.346° W, 45.200° S");
  assert.equal(lonLatText([-12.3456789, 1], 1e-9), "12.3457° W, 1.0000° N");
  assert.equal(lonLatText([-180, -0.001], 1), "180.00° W, 0.00° S");
});

test("dates are told as Python tells them", () => {
  for (const { start, step, time, text } of dates) {
    assert.equal(dateText({ start, dates: [], step }, [0, step], time), text);
  }
  const own = { start: null, dates: ["2000-02-29", "2000-02-30"], step: 86400 };
  assert.equal(dateText(own, [0, 86400], 50000), "2000-02-30");
  assert.equal(dateText({ start: null, dates: [], step: 0 }, [0], 0), null);
});

test("only groups of pieces that are seen are drawn, those in a row together", () => {
  const row = Array.from({ length: 1001 }, (_, n) => [n, 0, 0]).flat();
  const groups = pieceGroups(new Float32Array(row));
  assert.deepEqual(groups.map(({ first, count }) => [first, count]), [
    [0, 256],
    [256, 256],
    [512, 256],
    [768, 232],
  ]);
  assert.deepEqual(visibleRuns(groups, []), [[0, 1000]]);
  assert.deepEqual(visibleRuns(groups, [[1, 0, 0, -300]]), [[256, 744]]);
  assert.deepEqual(visibleRuns(groups, [[1, 0, 0, -300], [-1, 0, 0, 500]]), [[256, 256]]);
  assert.deepEqual(visibleRuns(groups, [[0, 1, 0, -1000]]), []);
});
