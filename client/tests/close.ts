// Comparison of numbers from both sides.

import assert from "node:assert/strict";

/** Check that numbers, in whatever they lie, agree; booleans and integers of each other count as such. */
export function assertClose(actual: unknown, expected: unknown, tolerance = 1e-9, where = ""): void {
  if (Array.isArray(expected)) {
    const list = actual as ArrayLike<unknown>;
    assert.equal(list.length, expected.length, `${where}: length`);
    expected.forEach((value, n) => assertClose(list[n], value, tolerance, `${where}[${n}]`));
  } else if (typeof expected === "object" && expected !== null) {
    const [ours, theirs] = [actual as object, expected].map((each) => Object.keys(each).sort());
    assert.deepEqual(ours, theirs, `${where}: names`);
    for (const [name, value] of Object.entries(expected)) {
      assertClose((actual as Record<string, unknown>)[name], value, tolerance, `${where}.${name}`);
    }
  } else if (typeof expected === "number" || typeof expected === "boolean") {
    const difference = Math.abs(Number(actual) - Number(expected));
    const size = Math.max(Math.abs(Number(expected)), 1e-3);
    assert.ok(difference <= tolerance * size, `${where} is ${actual}; expected ${expected}`);
  } else assert.equal(actual, expected, where);
}
