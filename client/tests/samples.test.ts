// Samples of a path, enlarged.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fitting } from "../src/samples.ts";

test("the enlarged path fits, though it be one point", () => {
  assert.deepEqual(fitting([[0, 0]], 2)([0, 0]), [116, 56]);
  const places: [number, number][] = [-1, 0, 1].map((x) => [x, x]);
  const found = places.map(fitting(places, 2));
  assert.deepEqual([found[0][1], found[2][1]], [103, 9]); // up is up
});
