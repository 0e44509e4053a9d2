import assert from "node:assert/strict";
import { test } from "node:test";
import { Failures } from "../src/tilequeue.ts";

test("what failed is asked for again after a while", () => {
  let now = 0;
  const failures = new Failures(() => now);
  assert.equal(failures.has("0/1/2"), false);
  failures.add("0/1/2");
  now += 9000;
  assert.equal(failures.has("0/1/2"), true);
  now += 2000;
  assert.equal(failures.has("0/1/2"), false);
  failures.add("0/1/2");
  assert.equal(failures.has("0/1/2"), true);
});
