// Velocities in the planes of poles, and the lines that lead there.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Poles } from "../src/poles.ts";
import type { PoleHeader } from "../src/protocol.ts";

const CELLS = 12;
const LINES = 9;
const NEAR = 2;

/** Angles of lines that are not evenly spread, and an ellipse around the pole. */
const angles = Array.from({ length: CELLS + 1 }, (_, k) => {
  const turn = (2 * Math.PI * k) / CELLS;
  return turn + 0.2 * Math.sin(turn);
});
const rays = angles.map((a): [number, number] => [1.5 * Math.cos(a), Math.sin(a)]);

/** A stream in the plane as the nodes have it: speed, and unit, beside. */
function nodesOf(pole: PoleHeader, [x, y]: [number, number]): Float32Array {
  const columns = pole.component ? CELLS + 1 : LINES;
  const texels = new Float32Array(4 * LINES * (CELLS + 1));
  for (let line = 0; line < LINES; line += 1) {
    for (let k = 0; k <= CELLS; k += 1) {
      const depth = Math.abs(line - pole.line);
      const [p, q] = rays[k];
      const [next, last] = [rays[(k + 1) % CELLS], rays[(k + CELLS - 1) % CELLS]];
      const [tp, tq] = [(depth * (next[0] - last[0])) / 2, (depth * (next[1] - last[1])) / 2];
      // At the pole a node has the component along its own line.
      const determinant = p * tq - q * tp;
      const across = depth ? (x * tq - y * tp) / determinant : (x * p + y * q) / (p * p + q * q);
      const around = depth ? (p * y - q * x) / determinant : 0;
      const at = 4 * (pole.component ? line * columns + k : k * columns + line);
      texels[at + pole.component] = across * pole.inward;
      texels[at + 1 - pole.component] = around;
      texels.set([7, 3], at + 2);
    }
  }
  return texels;
}

for (const component of [0, 1]) {
  test(`a stream over both poles is the same everywhere in their planes, along ${component}`, () => {
    const pole = { component, near: NEAR, plane: [1, 0, 0, 0, 1, 0] };
    const both = [
      { ...pole, line: 0, inward: 1 },
      { ...pole, line: LINES - 1, inward: -1 },
    ];
    const nodes: [number, number] = component ? [LINES, CELLS + 1] : [CELLS + 1, LINES];
    const poles = new Poles(both, nodes, [...rays, ...rays].flat());
    const { width } = poles.size;
    both.forEach((one, n) => {
      const texels = poles.laidOut(nodesOf(one, [2, -1]));
      assert.equal(texels.length, 4 * width * poles.size.height);
      const shift = (poles.uniforms.u_poles as number[])[4 * n + 3];
      for (let depth = 0; depth <= NEAR + 1; depth += 1) {
        for (let k = 0; k <= CELLS; k += 1) {
          const line = one.line + one.inward * depth + shift;
          const at = 4 * (component ? line * width + k : k * width + line);
          [2, -1, 7, 3].forEach((value, c) => assert.ok(Math.abs(texels[at + c] - value) < 1e-5, `${n} ${depth} ${k}`));
        }
      }
    });
  });
}

test("a line is found by its angle", () => {
  const pole = { component: 1, line: 0, inward: 1, near: NEAR, plane: [1, 0, 0, 0, 1, 0] };
  const poles = new Poles([pole], [LINES, CELLS + 1], rays.flat());
  const found = poles.angles;
  for (let share = 0.005; share < 1; share += 0.01) {
    const angle = 2 * Math.PI * share;
    let line = found[4 * Math.floor(share * CELLS) + 2];
    assert.ok(found[4 * line] <= angle);
    while (found[4 * (line + 1)] <= angle) line += 1;
    assert.ok(line < CELLS && found[4 * line] <= angle && angle < found[4 * (line + 1)]);
  }
  assert.equal(found[4 * CELLS], found[0] + Math.fround(2 * Math.PI));
});

test("nothing is added where there is no pole", () => {
  const poles = new Poles([], [4, 5], []);
  const own = new Float32Array(80).fill(2);
  assert.deepEqual(poles.size, { width: 5, height: 4 });
  assert.equal(poles.laidOut(own), own);
  assert.equal(poles.fastest(own), 2);
});
