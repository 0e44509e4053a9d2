import assert from "node:assert/strict";
import { test } from "node:test";
import { degreesAlong, placedTicks } from "../src/axes.ts";
import type { Earth, Part } from "../src/protocol.ts";
import type { Vector } from "../src/vectors.ts";

const even = (low: number, high: number, parts = 8) =>
  Array.from({ length: parts + 1 }, (_, n) => low + ((high - low) * n) / parts);

test("ticks of an even border lie where their values are", () => {
  for (const { value, share } of placedTicks({ values: even(-1, 3) }, 5)) {
    assert.ok(Math.abs(value - (-1 + 4 * share)) < 1e-12);
  }
  assert.deepEqual(
    placedTicks({ values: even(3, -1) }, 5).map(({ text, share }) => [text, share]),
    [["−1", 1], ["0", 0.75], ["1", 0.5], ["2", 0.25], ["3", 0]],
    "a border that is seen the other way round",
  );
});

test("ticks of a map lie between the places where its degrees are known", () => {
  const values = [NaN, NaN, ...even(-60, 60, 4), NaN, NaN];
  const ticks = placedTicks({ letters: "NS", values }, 5);
  assert.deepEqual(ticks.map(({ text }) => text), ["60°S", "30°S", "0°", "30°N", "60°N"]);
  assert.deepEqual(ticks.map(({ share }) => share), [2, 3, 4, 5, 6].map((n) => n / 8));
  assert.deepEqual(placedTicks({ values: [NaN, NaN, 1] }, 5), []);
});

/** A map of the world on which parallels have lengths of their own, and the ways to its places. */
function world(length: (latitude: number) => number): [Earth & { map: number[] }, Part] {
  const map = [-180, -90, 180, 90];
  const ways = even(-90, 90, 36).flatMap((lat) =>
    even(-180, 180, 72).flatMap((x) => {
      const [a, b] = [x / length(lat), lat].map((degrees) => (degrees * Math.PI) / 180);
      return [Math.cos(b) * Math.cos(a), Math.cos(b) * Math.sin(a), Math.sin(b)];
    }),
  );
  const part = { shape: [37, 73, 3], data: Float32Array.from(ways) };
  return [{ map } as Earth & { map: number[] }, part as unknown as Part];
}

for (const [name, length] of [
  ["cylinder", () => 1],
  ["map whose poles are short lines", (lat: number) => 1 - Math.abs(lat) / 180],
] as [string, (latitude: number) => number][]) {
  test(`the borders of a ${name} have its longitudes and latitudes`, () => {
    const [earth, lonlat] = world(length);
    const below = [-200, -170, -60, 0, 60, 170].map((x): Vector => [x, -100, 0]);
    const lon = degreesAlong(earth, below, 0, lonlat);
    const share = length(90 * (1 - 2 / 64));
    const isOn = ([x]: Vector) => Math.abs(x) <= 180 * share;
    for (const [n, place] of below.entries()) {
      if (isOn(place)) assert.ok(Math.abs(lon[n] - place[0] / share) < 0.5, `${place[0]}: ${lon[n]}`);
      else assert.ok(Number.isNaN(lon[n]));
    }
    const beside = [-100, -75, 0, 45, 85].map((y): Vector => [-190, y, 0]);
    const lat = degreesAlong(earth, beside, 1, lonlat);
    assert.ok(Number.isNaN(lat[0]));
    for (const n of [1, 2, 3, 4]) assert.ok(Math.abs(lat[n] - beside[n][1]) < 0.1);
  });
}
