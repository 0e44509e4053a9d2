import assert from "node:assert/strict";
import { test } from "node:test";
import { fromHalf, halved, toHalf } from "../src/half.ts";

test("half precision goes there and back", () => {
  for (const bits of [0, 1, 1023, 1024, 0x3c00, 0x7bff, 0x8001, 0xfbff]) {
    assert.equal(toHalf(fromHalf(bits)), bits);
  }
  assert.equal(fromHalf(0x3c00), 1);
  assert.equal(fromHalf(0xc000), -2);
  assert.equal(fromHalf(1), 2 ** -24);
  assert.equal(fromHalf(0x7c00), Infinity);
  assert.ok(Number.isNaN(fromHalf(0x7e00)));
  assert.equal(toHalf(1e9), 0x7c00);
  assert.ok(Number.isNaN(fromHalf(toHalf(NaN))));
});

/** Value at a place from 0 to 1, filtered linearly between middles of texels. */
function sampled(values: number[][], u: number, v: number): number {
  const line = (list: number[], x: number) => {
    const place = x * list.length - 0.5;
    const base = Math.floor(place);
    return list[base] * (1 - place + base) + list[Math.min(base + 1, list.length - 1)] * (place - base);
  };
  return line(
    values.map((row) => line(row, u)),
    v,
  );
}

test("the next mip level is filtered linearly, whatever the size", () => {
  const [width, height] = [11, 6];
  const values = Array.from({ length: height }, (_, j) =>
    Array.from({ length: width }, (__, i) => Math.sin(3 * i + 7 * j)),
  );
  const channels = values.flat().flatMap((x) => [toHalf(x), toHalf(-x)]);
  const [texels, w, h] = halved(Uint16Array.from(channels), width, height, 2);
  assert.deepEqual([w, h], [5, 3]);
  for (let j = 0; j < h; j += 1) {
    for (let i = 0; i < w; i += 1) {
      const expected = sampled(values, (i + 0.5) / w, (j + 0.5) / h);
      const at = 2 * (j * w + i);
      assert.ok(Math.abs(fromHalf(texels[at]) - expected) < 2e-3);
      assert.equal(fromHalf(texels[at + 1]), -fromHalf(texels[at]));
    }
  }
});
