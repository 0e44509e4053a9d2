import assert from "node:assert/strict";
import { test } from "node:test";
import { fromHalf, toHalf } from "../src/half.ts";

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
