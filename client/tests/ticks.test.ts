import assert from "node:assert/strict";
import { test } from "node:test";
import { degreeTicks, offsetOf, ticksOf } from "../src/ticks.ts";

const texts = (low: number, high: number, log = false, most = 5) =>
  ticksOf(low, high, log, most).map(({ text }) => text);

test("ticks are round, and as precise as they need to be", () => {
  assert.deepEqual(texts(0.00786, 22.2), ["0", "5", "10", "15", "20"]);
  assert.deepEqual(texts(0, 1), ["0", "0.25", "0.50", "0.75", "1.00"]);
  assert.deepEqual(texts(0, 1, false, 3), ["0", "0.5", "1.0"]);
  assert.deepEqual(texts(-10.3, 10.3), ["−10", "−5", "0", "5", "10"]);
  assert.deepEqual(texts(101320, 101331, false, 3), ["101320", "101325", "101330"]);
  assert.deepEqual(texts(0, 3e-6), ["0", "1e-6", "2e-6", "3e-6"]);
});

test("a constant has one tick, and what is no number none", () => {
  assert.deepEqual(texts(1, 1), ["1.000"]);
  assert.deepEqual(texts(0, 0), ["0"]);
  assert.deepEqual(texts(NaN, NaN), []);
});

test("logarithmic ticks are powers of ten where there is room", () => {
  assert.deepEqual(texts(0.02, 30, true), ["0.1", "1", "10"]);
  assert.deepEqual(texts(1, 100, true), ["1", "3", "10", "30", "100"]);
  assert.deepEqual(texts(1e-6, 1e6, true), ["1e-6", "0.001", "1", "1000", "1e6"]);
  assert.deepEqual(texts(1, 2, true).length, 5, "close ends have even ticks");
});

test("any two ends have two to five ticks between them, in order and apart", () => {
  let seed = 1;
  const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
  for (let n = 0; n < 2000; n += 1) {
    const low = (random() - 0.5) * 10 ** (12 * random() - 6);
    const high = low + Math.abs(low) * 10 ** (6 * random() - 4) + 1e-9;
    for (const log of low > 0 ? [false, true] : [false]) {
      const ticks = ticksOf(low, high, log);
      assert.ok(ticks.length >= 2 && ticks.length <= 5, `${low} ${high} ${log}`);
      const slack = 0.005 * (high - low) + 1e-8 * Math.max(Math.abs(low), Math.abs(high));
      for (const { value } of ticks) assert.ok(value >= low - slack && value <= high + slack);
      assert.equal(new Set(ticks.map(({ text }) => text)).size, ticks.length, JSON.stringify(ticks));
    }
  }
});

test("degrees have round steps and the letters of their sides", () => {
  const east = (low: number, high: number) => degreeTicks(low, high, "EW").map(({ text }) => text);
  assert.deepEqual(east(-180, 180), ["180°", "90°W", "0°", "90°E", "180°"]);
  assert.deepEqual(east(170, 190), ["170°E", "175°E", "180°", "175°W", "170°W"]);
  assert.deepEqual(east(0.1, 0.9), ["0.2°E", "0.4°E", "0.6°E", "0.8°E"]);
  assert.deepEqual(degreeTicks(-80, 80, "NS").map(({ text }) => text), ["60°S", "30°S", "0°", "30°N", "60°N"]);
});

test("a round number is taken from coordinates that are large beside their range", () => {
  for (const [low, high, text] of [
    [4e6, 4e6 + 2, "4e6"],
    [4_321_987.1, 4_321_990, "4.3e6"],
    [-5e5, -5e5 + 0.01, "−500000"],
    [4e6, 4.05e6, undefined],
    [0, 2e12, undefined],
  ] as const) {
    const offset = offsetOf(low, high, 9);
    assert.equal(offset?.text, text);
    const taken = offset?.value ?? 0;
    const labels = ticksOf(low - taken, high - taken, false, 9).map((tick) => tick.text);
    assert.ok(labels.every((each) => each.length <= 7), labels.join());
  }
});
