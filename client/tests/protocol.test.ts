import assert from "node:assert/strict";
import { test } from "node:test";
import { gzipSync } from "node:zlib";
import { fromHalf } from "../src/half.ts";
import { beyondEnds, decoded, isSignFree, legendLimits, partOfText, partsOfFile, stepOf } from "../src/protocol.ts";

const INFO = { name: "position", dtype: "float32", shape: [1, 2], digest: "d" };

test("bytes that begin anywhere become a part in memory of its own", () => {
  const numbers = new Float32Array([1.5, -2]);
  const shifted = new Uint8Array(11);
  shifted.set(new Uint8Array(numbers.buffer), 3);
  const part = decoded(INFO, new DataView(shifted.buffer, 3));
  assert.deepEqual([...part.data], [1.5, -2]);
  assert.deepEqual([part.name, part.shape, part.digest], ["position", [1, 2], "d"]);
  shifted.fill(0);
  assert.deepEqual([...part.data], [1.5, -2]);
});

test("an end of the colours that is 0 but for rounding is told as 0", () => {
  const scalars = { low: 1.94e-7, high: 10.3, log: false } as Parameters<typeof legendLimits>[0];
  assert.deepEqual(legendLimits(scalars), [0, 10.3]);
  assert.deepEqual(legendLimits({ ...scalars, log: true }), [1.94e-7, 10.3]);
  assert.deepEqual(legendLimits({ ...scalars, low: -3e-8, high: 2e-7 }), [-3e-8, 2e-7]);
});

test("values beyond the ends of the colours are known", () => {
  const choice = { name: "p", label: "p", unit: "", low: 0, high: 1, least: 0, most: 1, steps: 1 };
  const scalars = { low: 0, high: 1, number: 0, choices: [choice] } as unknown as Parameters<typeof beyondEnds>[0];
  assert.deepEqual(beyondEnds(scalars), [false, false]);
  assert.deepEqual(beyondEnds({ ...scalars, low: 0.1, high: 0.9 }), [true, true]);
  assert.deepEqual(beyondEnds({ ...scalars, choices: [{ ...choice, most: 3 }] }), [false, true]);
  assert.deepEqual(beyondEnds({ ...scalars, choices: [] }), [false, false]);
});

test("half precision stays bits", () => {
  const part = decoded({ ...INFO, dtype: "float16" }, new Uint16Array([0x3c00, 0xc000]).buffer);
  assert.ok(part.data instanceof Uint16Array);
});

test("an unknown type is told with those that are known", () => {
  assert.throws(() => decoded({ ...INFO, dtype: "complex64" }, new ArrayBuffer(8)), /complex64.*float32/);
});

test("a file has several parts", () => {
  const infos = [
    { ...INFO, bytes: 8 },
    { name: "cells", dtype: "uint8", shape: [3], digest: "e", bytes: 3 },
  ];
  const text = new TextEncoder().encode(JSON.stringify(infos));
  const file = new Uint8Array(4 + text.length + 11);
  new DataView(file.buffer).setUint32(0, text.length, true);
  file.set(text, 4);
  file.set(new Uint8Array(new Float32Array([7, 8]).buffer), 4 + text.length);
  file.set([1, 0, 1], 12 + text.length);
  const parts = partsOfFile(file.buffer);
  assert.deepEqual(
    parts.map(({ name, data }) => [name, [...data]]),
    [
      ["position", [7, 8]],
      ["cells", [1, 0, 1]],
    ],
  );
});

test("text has the bytes of one significance side by side, the sign last", async () => {
  const bits = [...new Int32Array(new Float32Array([1.5, -2]).buffer)].map((n) => (n << 1) ^ (n >> 31));
  const bytes = new Uint8Array(Int32Array.from(bits).buffer);
  const planes = new Uint8Array(8);
  for (let k = 0; k < 4; k += 1) for (let n = 0; n < 2; n += 1) planes[2 * k + n] = bytes[4 * n + k];
  const part = await partOfText(INFO, gzipSync(planes).toString("base64"));
  assert.deepEqual([...part.data], [1.5, -2]);
});

test("differences are summed along both axes, and whole numbers are multiples of a unit", async () => {
  // Of the rows (1, 10), (3, 20) and (-4, 7), (-1, 18): 2 for 1, and 1 for -1.
  const numbers = [2, 4, 9, 2, 20, 20, 5, 2];
  const differences: [number, number] = [1, 1];
  for (const [dtype, width] of [["float32", 4], ["float16", 2]] as const) {
    const planes = new Uint8Array(8 * width);
    planes.set(numbers);
    const info = { ...INFO, dtype, shape: [2, 2, 2], differences, scale: [-1, -1] };
    const { data } = await partOfText(info, gzipSync(planes).toString("base64"));
    const told = width === 2 ? [...data].map(fromHalf) : [...data];
    assert.deepEqual(told, [0.5, 5, 1.5, 10, -2, 3.5, -0.5, 9]);
  }
});

test("an array without numbers is a part as well", async () => {
  const part = await partOfText({ ...INFO, shape: [0, 3] }, gzipSync("").toString("base64"));
  assert.equal(part.data.length, 0);
});

test("names tell the step, the variant tells the sign", () => {
  assert.equal(stepOf("slices/12"), 12);
  assert.ok(Number.isNaN(stepOf("position")));
  assert.ok(isSignFree({ variant: ["FLOWTEX_SIGNFREE"] }));
  assert.ok(!isSignFree({ variant: ["FLOWTEX_PLANAR"] }));
});
