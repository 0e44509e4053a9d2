import assert from "node:assert/strict";
import { test } from "node:test";
import { placedTicks } from "../src/axes.ts";

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
