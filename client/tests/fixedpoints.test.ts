import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { closedOrbits, fixedPoints as found, nullclines, separatrices as lines, trajectory, type Ends, type FixedPoint, type Gradient, type Pair, type Rate } from "../src/fixedpoints.ts";
import { compiled, FormulaSource } from "../src/formula.ts";
import { LINE, type FormulaHeader, type Header, type Tree } from "../src/protocol.ts";

const BOX: Ends = [[-2, 2], [-1, 1]];

/** Derivatives of rates that have no tree. */
const differences = (rate: Rate): Gradient => (x, y) => {
  const h = 1e-4;
  const weights = [[-2, 1 / 12], [-1, -2 / 3], [1, 2 / 3], [2, -1 / 12]];
  const of = (k: number, m: number) => weights.reduce((sum, [n, w]) => sum + (w * rate(x + (m ? 0 : n * h), y + (m ? n * h : 0))[k]) / h, 0);
  return [of(0, 0), of(0, 1), of(1, 0), of(1, 1)];
};
const fixedPoints = (rate: Rate, ends: Ends) => found(rate, differences(rate), ends);
const separatrices = (rate: Rate, ends: Ends, points: FixedPoint[], saddles: FixedPoint[]) => lines(rate, differences(rate), ends, points, saddles);

interface Case {
  name: string;
  x: Pair;
  y: Pair;
  parameters: Record<string, number>;
  points: { kind: string; at: Pair; index: number; eigenvalues: [Pair, Pair] }[];
  orbits: boolean[];
  trees: Tree[];
  gradient: Tree[];
}

test("the points of formulas are exact, as in Python", () => {
  // tests/trace/formula_cases.json, with the trees of Python.
  const cases = JSON.parse(readFileSync(new URL("fixedpoints.json", import.meta.url), "utf8")) as Case[];
  assert.ok(cases.length > 50);
  for (const { name, x, y, parameters, points, orbits, trees, gradient } of cases) {
    const at = (some: Tree[]) => {
      const evaluates = some.map(compiled);
      const values = { ...parameters, x: 0, y: 0 };
      return (a: number, b: number) => {
        Object.assign(values, { x: a, y: b });
        return evaluates.map((evaluate) => evaluate(values));
      };
    };
    const rate = at(trees) as Rate;
    const own = found(rate, at(gradient), [x, y]);
    assert.equal(own.length, points.length, name);
    for (const expected of points) {
      const distanceOf = (point: FixedPoint) => Math.hypot(point.at[0] - expected.at[0], point.at[1] - expected.at[1]);
      const [point] = own.sort((one, two) => distanceOf(one) - distanceOf(two));
      const isDegenerate = expected.kind === "degenerate";
      assert.ok(distanceOf(point) < (isDegenerate ? 1e-3 : 1e-8), name);
      assert.deepEqual([point.kind, point.index], [expected.kind, expected.index], name);
      const values = point.eigenvalues.flat();
      expected.eigenvalues.flat().forEach((value, n) => assert.ok(Math.abs(value - values[n]) < (isDegenerate ? 1e-2 : 1e-8), name));
    }
    const cycles = closedOrbits(rate, [x, y], own);
    assert.deepEqual(cycles.map(({ isStable }) => isStable).sort(), orbits, name);
  }
});

test("a degenerate point has the separatrices between its sectors", () => {
  const ways = (rate: Rate) => fixedPoints(rate, BOX)[0].ways.map(({ way, leaves }) => `${Math.round((Math.atan2(way[1], way[0]) * 180) / Math.PI)} ${leaves}`).sort();
  assert.deepEqual(ways((x, y) => [x * x - y * y, 2 * x * y]).map((way) => way.replace("-180", "180")), ["0 true", "180 false"]);
  assert.deepEqual(ways((x, y) => [-x * x, -y]).map((way) => way.replace("-180", "180")), ["-90 false", "180 true", "90 false"]);
  assert.equal(ways((x, y) => [x * x - y * y, -2 * x * y]).length, 6);
  assert.deepEqual(ways((x, y) => [x ** 3, y]), []);
});

test("linear flows have one point of their kind, wherever it is", () => {
  const matrices: Record<string, number[]> = {
    saddle: [1, 0.3, 0.2, -1],
    source: [1, 0.3, 0.2, 0.5],
    sink: [-1, 0.3, 0.2, -0.5],
    centre: [0, 2, -1, 0],
    "spiral source": [0.2, 2, -1, 0.2],
    "spiral sink": [-0.2, 2, -1, -0.2],
  };
  for (const [kind, [a, b, c, d]] of Object.entries(matrices)) {
    for (const [x0, y0] of [[0, 0], [0.137, -0.211], [1.999, 1]]) {
      const found = fixedPoints((x, y) => [a * (x - x0) + b * (y - y0), c * (x - x0) + d * (y - y0)], BOX);
      assert.deepEqual(found.map((point) => point.kind), [kind]);
      assert.ok(Math.hypot(found[0].at[0] - x0, found[0].at[1] - y0) < 1e-8);
    }
  }
});

test("lines of rest, jumps and poles are no points", () => {
  const rates: Rate[] = [
    (x, y) => [x, x * y],
    (x, y) => [Math.sign(x - 0.013), Math.sign(y - 0.017)],
    (x, y) => [1 / (x - 0.013), y],
    () => [0, 0],
    () => [NaN, 1],
  ];
  for (const rate of rates) assert.deepEqual(fixedPoints(rate, BOX), []);
});

test("separatrices end at points and borders, and on closed orbits", () => {
  const straight: Rate = (x, y) => [0.25 - x * x, -y];
  const points = fixedPoints(straight, BOX);
  assert.deepEqual(points.map(({ kind }) => kind).sort(), ["saddle", "sink"]);
  const lines = separatrices(straight, BOX, points, points.filter(({ ways }) => ways.length));
  const ends = lines.map(({ path, leaves }) => [leaves, ...path[path.length - 1].map((x) => Math.round(1e6 * x) / 1e6)].join());
  assert.deepEqual(ends.sort(), ["false,-0.5,-1", "false,-0.5,1", "true,-2,0", "true,0.5,0"]);
  const orbits: Rate = (x, y) => [y, x - x ** 3 + y * (0.85 - x * x)];
  const box: Ends = [[-2.2, 2.2], [-1.6, 1.6]];
  const found = fixedPoints(orbits, box);
  const closed = separatrices(orbits, box, found, found.filter(({ ways }) => ways.length)).flatMap(({ orbit, leaves }) => (orbit ? [{ orbit, leaves }] : []));
  assert.equal(closed.length, 2);
  for (const { orbit, leaves } of closed) {
    assert.ok(!leaves);
    const [first, last] = [orbit[0], orbit[orbit.length - 1]];
    assert.ok(Math.hypot(first[0] - last[0], first[1] - last[1]) < 0.01);
  }
});

test("closed orbits are found where no separatrix ends", () => {
  const box: Ends = [[-3, 3], [-4, 4]];
  const orbitsOf = (rate: Rate) => closedOrbits(rate, box, fixedPoints(rate, box));
  for (const sign of [1, -1]) {
    const [orbit, ...others] = orbitsOf((x, y) => [sign * y, sign * ((1 - x * x) * y - x)]);
    assert.equal(others.length, 0);
    assert.equal(orbit.isStable, sign > 0);
    assert.ok(Math.abs(Math.max(...orbit.path.map(([x]) => x)) - 2.0086) < 1e-3);
  }
  const turning = (growth: (r: number) => number): Rate => (x, y) => {
    const k = growth(x * x + y * y);
    return [k * x - y, k * y + x];
  };
  for (const k of [1, 0.05]) {
    const [orbit] = orbitsOf(turning((r) => k * (1 - r)));
    assert.ok(orbit.path.every((at) => Math.abs(Math.hypot(...at) - 1) < 1e-4));
  }
  const two = orbitsOf(turning((r) => (1 - r) * (r - 2.25)));
  assert.deepEqual(two.map(({ path, isStable }) => [Math.round(1e3 * Math.hypot(...path[0])), isStable]), [[1000, false], [1500, true]]);
  const none: Rate[] = [(x, y) => [-y, x], (x, y) => [y, -Math.sin(x)], (x, y) => [y, -Math.sin(x) - 0.2 * y], (x, y) => [-Math.sin(2 * x), -Math.cos(y)]];
  for (const rate of none) assert.deepEqual(orbitsOf(rate), []);
});

test("a damped pendulum has no closed orbit, and its points at rest are no centres", () => {
  for (const damping of [0.05, 0.1, 0.2, 0.5]) {
    const rate: Rate = (x, y) => [y, -Math.sin(x) - damping * y];
    const ends: Ends = [[-7, 7], [-4, 4]];
    const points = fixedPoints(rate, ends);
    assert.deepEqual(closedOrbits(rate, ends, points), []);
    assert.deepEqual([...new Set(points.map(({ kind }) => kind))].sort(), ["saddle", "spiral sink"]);
  }
});

test("a trajectory of a pendulum keeps its energy, closes, or ends at rest", () => {
  const ends: Ends = [[-7, 7], [-4, 4]];
  const energy = ([x, y]: [number, number]) => y * y / 2 - Math.cos(x);
  const free: Rate = (x, y) => [y, -Math.sin(x)];
  for (const start of [[1, 0.5], [-4.849, 2.666], [0, -2.5]] as [number, number][]) {
    const path = trajectory(free, ends, fixedPoints(free, ends), start);
    for (const at of path) assert.ok(Math.abs(energy(at) - energy(start)) < 1e-4);
    const [first, last] = [path[0], path[path.length - 1]];
    const isClosed = Math.hypot(first[0] - last[0], first[1] - last[1]) < 0.03;
    assert.equal(isClosed, energy(start) < 1);
    if (!isClosed) assert.deepEqual([Math.abs(first[0]), Math.abs(last[0])], [7, 7]);
  }
  const braked: Rate = (x, y) => [y, -Math.sin(x) - 0.5 * y];
  const damped = trajectory(braked, ends, fixedPoints(braked, ends), [1, 0.5]);
  assert.ok(Math.hypot(...damped[damped.length - 1]) < 1e-6);
  for (let n = 1; n < damped.length; n += 1) assert.ok(energy(damped[n]) < energy(damped[n - 1]) + 1e-9);
});

test("no separatrix of a flow without divergence ends on a closed orbit", () => {
  const box: Ends = [[0, 6.28], [0, 6.28]];
  const waves = [[2, -1, 0.7, 0.9], [1, 3, 2.1, -0.6], [-3, 2, 4.4, 0.5], [1, 1, 5.2, 0.8]];
  const rate: Rate = (x, y) => {
    const parts = waves.map(([a, b, phase, size]) => [b, -a].map((k) => k * size * Math.cos(a * x + b * y + phase)));
    return [0, 1].map((k) => parts.reduce((sum, part) => sum + part[k], 0)) as [number, number];
  };
  const points = fixedPoints(rate, box);
  const lines = separatrices(rate, box, points, points.filter(({ ways }) => ways.length));
  assert.ok(lines.length > 20);
  assert.ok(lines.every(({ orbit }) => !orbit));
});

test("nullclines are where a rate is zero, and not where it jumps", () => {
  const box: Ends = [[-2, 2], [-1.9, 2.1]];
  const lengthOf = (pieces: [number, number][][]) => pieces.reduce((sum, [a, b]) => sum + Math.hypot(a[0] - b[0], a[1] - b[1]), 0);
  const [circle, line] = nullclines((x, y) => [x * x + y * y - 1, y - x], box);
  assert.ok(circle.flat().every((at) => Math.abs(Math.hypot(...at) - 1) < 1e-4));
  assert.ok(Math.abs(lengthOf(circle) - 2 * Math.PI) < 1e-3);
  assert.ok(Math.abs(lengthOf(line) - 3.9 * Math.SQRT2) < 1e-6);
  assert.deepEqual(nullclines((x, y) => [1 / (x - 0.013), Math.sign(y - 0.017)], box), [[], []]);
  assert.deepEqual(nullclines((x, y) => [1 / (x - y + 0.001), Math.abs(x) / x], box), [[], []]);
  assert.deepEqual(nullclines(() => [0, NaN], box), [[], []]);
});

test("the points and lines of a formula are those of Python", async () => {
  const data = JSON.parse(readFileSync(new URL("formula.json", import.meta.url), "utf8"));
  const header = data.header as Header & { formula: FormulaHeader };
  const source = new FormulaSource(header, header.formula);
  const [critical] = await source.load(null, [0], null, null, "critical");
  assert.equal(critical.name, "critical/0");
  const kinds = header.structure?.kinds.map(({ name }) => name) ?? [];
  const { center } = header.geometry;
  const rowsOf = (values: ArrayLike<number>) =>
    Array.from({ length: values.length / 4 }, (_, n) => [0, 1, 2, 3].map((k) => values[4 * n + k]));
  const own = rowsOf(critical.data);
  assert.equal(own.length, data.critical.length);
  for (const [kind, x, y] of data.critical as [string, number, number][]) {
    const isThere = own.some(([a, b, , n]) => kinds[n] === kind && Math.hypot(a + center[0] - x, b + center[1] - y) < 1e-3);
    assert.ok(isThere, `a ${kind} at ${x}, ${y}`);
  }
  const [part] = await source.load(null, [0], null, null, "separatrices");
  const paths = new Map<number, number[][]>();
  for (const row of rowsOf(part.data)) paths.set(row[3], [...(paths.get(row[3]) ?? []), row]);
  for (const [leaves, x0, y0, x1, y1] of data.separatrices as [boolean, number, number, number, number][]) {
    const isNear = ([a, b]: number[], x: number, y: number) => Math.hypot(a + center[0] - x, b + center[1] - y) < 0.1;
    const alike = [...paths].filter(([number, path]) => Boolean(number & LINE.leaving) === leaves && isNear(path[0], x0, y0));
    assert.ok(alike.some(([, path]) => path.some((row) => isNear(row, x1, y1))), `a line from ${[x0, y0]} to ${[x1, y1]}`);
  }
});
