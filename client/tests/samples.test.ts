// The words and the chart of the samples of a path.

import assert from "node:assert/strict";
import { test } from "node:test";
import { sampleText } from "../src/samples.ts";

test("a sample is told by its lag, its weight and its noise", () => {
  const sample = { lag: 0.1234, weight: 0.05678, noise: -0.456, grey: 0.4 };
  assert.equal(sampleText(sample, "m"), "0.12 m behind, weight 0.057, noise -0.46");
  assert.equal(sampleText({ ...sample, lag: -3 }, ""), "3 ahead, weight 0.057, noise -0.46");
  assert.equal(sampleText({ ...sample, lag: 0, noise: null }, "s"), "here, weight 0.057");
});
