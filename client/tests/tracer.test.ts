// Parts of a path between time steps, and the steps that paths lead through.

import assert from "node:assert/strict";
import { test } from "node:test";
import type { Header } from "../src/protocol.ts";
import { flowsOf, stretches } from "../src/tracer.ts";

type Slices = Pick<Header, "slices">;

function timed(pathlines: boolean, lags: number[]): Slices {
  const trace = { pathlines, timed: { unit: 0.5, speed: 1 } };
  return { slices: { trace, lags, times: [0, 1, 3, 4] } } as unknown as Slices;
}

test("streamlines follow the flow of one step", () => {
  assert.deepEqual(flowsOf(timed(false, [9]), 2), [2]);
  const [whole, ...others] = stretches(timed(false, [9]), 2, -1, 0.5, 8);
  assert.deepEqual([whole.from, whole.to, whole.steps, others], [0.5, 8, [2, 2], []]);
});

test("pathlines need the steps that the longest lag meets, and those next to them", () => {
  assert.deepEqual(flowsOf(timed(true, [1]), 0), [0, 1]);
  assert.deepEqual(flowsOf(timed(true, [1, 2.5]), 1), [0, 1, 2]);
  assert.deepEqual(flowsOf(timed(true, [6]), 3), [1, 2, 3]);
});

test("a path is followed from step to step, and beyond the last one as there", () => {
  const found = stretches(timed(true, [16]), 2, -1, 1, 16);
  const told = found.map(({ from, to, steps, between }) => [from, to, steps, between.map((lag) => lag + 0)]);
  assert.deepEqual(told, [
    [1, 4, [2, 1], [0, 4]],
    [4, 6, [1, 0], [4, 6]],
    [6, 16, [0, 0], [0, 1]],
  ]);
  const ahead = stretches(timed(true, [16]), 2, 1, 0, 1).map(({ from, to, steps }) => [from, to, steps]);
  assert.deepEqual(ahead, [[0, 1, [2, 3]]]);
});

test("a lag that meets a step but for rounding is not followed for that rest", () => {
  const ends = (to: number) => stretches(timed(true, [16]), 2, -1, 2, to).map((each) => each.to);
  assert.deepEqual(ends(4 + 1e-9), [4 + 1e-9]);
  assert.deepEqual(ends(4 - 1e-9), [4 - 1e-9]);
  const from = stretches(timed(true, [16]), 2, -1, 4 - 1e-9, 5);
  assert.deepEqual(from.map(({ steps }) => steps), [[1, 0]]);
});
