// The smaller modules that need no page.

import assert from "node:assert/strict";
import { test } from "node:test";
import { isUseful, scaleOf } from "../src/controls.ts";
import { numberText } from "../src/dom.ts";
import { throttled } from "../src/lifetime.ts";
import { coordinates, cornersAt, interpolated, positions, shares } from "../src/mesh.ts";
import { Player } from "../src/player.ts";
import type { Geometry, Header, Row } from "../src/protocol.ts";
import { reused } from "../src/progressive.ts";

test("nodes lie in the middles of texels", () => {
  const padding = { before: 1, size: 4 };
  const geometry = { shape: [1, 2], rows: padding, columns: padding } as Geometry;
  assert.deepEqual([...coordinates(geometry)], [0.375, 0.375, 0.625, 0.375]);
});

test("positions are counted from the anchor", () => {
  const nodes = Float32Array.of(1, 2, 3, 4, 5, 6);
  assert.equal(positions(nodes, [0, 0, 0]), nodes);
  assert.deepEqual([...positions(nodes, [1, 1, 2])], [0, 1, 1, 3, 4, 4]);
});

test("a node without a value has a share that no colour map has", () => {
  const steps = [Float32Array.of(2, NaN), Float32Array.of(3, 4)];
  const scalars = { low: 2, high: 4, log: false } as Header["scalars"];
  assert.deepEqual([...shares(steps, scalars)], [0, 0.5, -1e9, 1]);
  const powers = { low: 1, high: 100, log: true } as Header["scalars"];
  assert.deepEqual([...shares([Float32Array.of(0, 10)], powers)], [0, 0, 0.5, 0]);
});

test("values between nodes are those of the triangles", () => {
  const value = (node: number) => [0, 1, 10, 100][node];
  const at = (i: number, j: number) => interpolated(cornersAt([2, 2], [i, j]), value);
  assert.deepEqual([at(0.5, 0), at(0.5, 0.5), at(0, 0.5), at(1, 1)], [0.5, 50, 5, 100]);
});

test("numbers are short", () => {
  const texts = [0, 1.23456, 123456, 1e-4, -2, NaN].map((x) => numberText(x));
  assert.deepEqual(texts, ["0", "1.235", "1.23e5", "1.00e-4", "-2", "–"]);
});

test("a slider goes evenly or by the logarithm", () => {
  const even = scaleOf({ whole: true, logarithmic: false, low: 1, high: 50 });
  assert.deepEqual([even.min, even.max, even.step, even.fromSlider(7.2)], [1, 50, 1, 7]);
  const wide = scaleOf({ whole: false, logarithmic: true, low: 0.25, high: 32 });
  assert.deepEqual([wide.min, wide.max], [-2, 5]);
  assert.equal(wide.fromSlider(wide.toSlider(1.5)), 1.5);
});

test("settings are shown where they change anything", () => {
  const slices = { sides: 1, steps: 1 };
  const header = { variant: [], paper: null, slices, settings: {} } as unknown as Header;
  const row = (name: string, affects = "uniform") => ({ name, affects }) as Row;
  assert.ok(isUseful(row("grain"), header, false));
  assert.ok(isUseful(row("motion"), header, false));
  assert.ok(!isUseful(row("two_sided"), header, false));
  assert.ok(!isUseful(row("lod"), header, false)); // has a button
  assert.ok(!isUseful(row("noise", "shader"), header, false));
  assert.ok(isUseful(row("noise", "shader"), header, true));
  assert.ok(!isUseful(row("motion"), { ...header, variant: ["FLOWTEX_SIGNFREE"] }, false));
});

test("time waits for what is on its way, and begins again", () => {
  const player = new Player();
  const times = [0, 1, 2];
  player.setHeader({ slices: { times }, time: 0.5, clock: 0 } as unknown as Header);
  assert.equal(player.time, 0.5);
  player.start();
  assert.ok(player.advance(1000, () => true));
  assert.equal(player.time, 0.5); // no time has gone by
  assert.ok(player.advance(1300, () => true));
  assert.ok(Math.abs(player.time - 0.6) < 1e-12); // the series takes 6 s
  assert.ok(!player.advance(1600, () => false));
  assert.ok(Math.abs(player.time - 0.6) < 1e-12);
  player.seek(9);
  assert.equal(player.time, 2);
  player.advance(1900, () => true);
  assert.equal(player.time, 0);
  player.setHeader({ slices: { times }, time: 2, clock: 0 } as unknown as Header);
  assert.equal(player.time, 0); // the same times: the scene is only finer
});

test("a picture that was moved serves for what it covers", () => {
  const whole = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const at = (scale: number, x: number) => {
    const m = [...whole];
    [m[0], m[5], m[12]] = [scale, scale, x];
    return m;
  };
  const shift = reused(whole, at(1, 0.5), 200, 100);
  assert.deepEqual(shift, { matrix: [1, 0, 0, 1, 50, 0], covers: false, shifts: true });
  const closer = reused(whole, at(2, 0), 200, 100);
  assert.deepEqual(closer, { matrix: [2, 0, 0, 2, -100, -50], covers: true, shifts: false });
  assert.equal(reused(whole, at(5, 0), 200, 100), null);
  assert.equal(reused(whole, at(0.2, 0), 200, 100), null);
});

test("many values become few messages, the last of them for certain", () => {
  const waiting: (() => void)[] = [];
  const sent: number[] = [];
  const send = throttled<number>((call) => waiting.push(call), 100, (value) => sent.push(value));
  [1, 2, 3].forEach(send);
  assert.deepEqual(sent, [1]);
  waiting.shift()?.();
  assert.deepEqual(sent, [1, 3]);
  waiting.shift()?.();
  assert.equal(waiting.length, 0);
  send(4);
  assert.deepEqual(sent, [1, 3, 4]);
});

test("a series goes on as far as its steps are there, and from its end to its beginning", () => {
  const player = new Player();
  const times = [2, 4, 8];
  player.setHeader({ slices: { times }, time: 2, clock: 0 } as unknown as Header);
  assert.deepEqual([player.varies, player.span, player.timeOf([1, 2, 0.25])], [true, [2, 8], 5]);
  assert.deepEqual(player.range({ period: 4 } as never), { first: 2, last: 8, now: 2 });
  player.start();
  assert.ok(player.playing && player.advance(1000, () => true));
  assert.equal(player.time, 2); // the first picture is that of the moment itself
  assert.ok(player.advance(1500, () => true));
  assert.equal(player.time, 2.5); // of six seconds in which all is shown
  assert.ok(!player.advance(2000, () => false));
  assert.equal(player.time, 2.5);
  assert.ok(player.advance(60_000, () => true)); // a tab that was asleep jumps over nothing
  assert.equal(player.time, 3);
  player.seek(9);
  assert.equal(player.time, 8);
  player.advance(60_100, () => true);
  assert.equal(player.time, 2);
});

test("a steady flow streams by a clock", () => {
  const player = new Player();
  player.setHeader({ slices: { times: [0] }, time: 0, clock: 1 } as unknown as Header);
  player.start();
  player.advance(1000, () => false);
  player.advance(1250, () => false);
  assert.equal(player.clock, 1.25);
  assert.deepEqual(player.range({ period: 0.5 } as never), { first: 0, last: 0.5, now: 0.25 });
});
