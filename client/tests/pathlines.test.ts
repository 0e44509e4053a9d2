// A path as shapes of SVG.

import assert from "node:assert/strict";
import { test } from "node:test";
import { arrowHeads, pathShapes, type Line } from "../src/samples.ts";

const LINE: Line = [
  [0, 50],
  [100, 50],
  [100, 50],
  [200, 50],
];

test("heads stand along a line from its end back, and point along it", () => {
  const heads = arrowHeads(LINE, 80);
  assert.deepEqual(
    heads.map(([tip]) => tip),
    [
      [200, 50],
      [120, 50],
      [40, 50],
    ],
  );
  for (const [tip, left, right] of heads) {
    assert.ok(left[0] < tip[0] && right[0] === left[0]);
    assert.equal(left[1] + right[1], 100);
  }
  assert.deepEqual(arrowHeads([[1, 1]]), []);
});

test("casings lie below their lines, and a flow without a sign has no heads", () => {
  const shown = { path: [LINE], sampled: [LINE.slice(1, 3)], point: null, directed: true };
  const kinds = (directed: boolean) =>
    pathShapes({ ...shown, directed }).map(([, attributes]) => attributes.class);
  const lines = ["whole-casing", "whole", "casing", "sampled"];
  assert.deepEqual(kinds(true), [...lines, "arrow", "arrow", "arrow"]);
  assert.deepEqual(kinds(false), lines);
});

test("the point is not hidden by a head", () => {
  const shown = { path: [LINE], sampled: [], directed: true };
  const tips = (x: number) =>
    pathShapes({ ...shown, point: [x, 50] }).filter(([tag]) => tag === "polygon").length;
  assert.equal(tips(150), 3);
  assert.equal(tips(112), 2);
});

test("samples are dots in the grey of their noise, below the ring of the point", () => {
  const dots = [{ place: [10, 50] as [number, number], radius: 3, grey: 0.5 }];
  const shapes = pathShapes({ path: [LINE], sampled: [], point: [10, 50], directed: false, dots });
  const [tag, { fill, r }] = shapes[2];
  assert.deepEqual([tag, fill, r], ["circle", "rgb(128,128,128)", 3]);
  assert.equal(shapes[shapes.length - 1][1].class, "point");
});
