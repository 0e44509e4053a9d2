// Land and places without data, in the legend and in their colours.

import assert from "node:assert/strict";
import { test } from "node:test";
import { groundKinds, missingColour } from "../src/ground.ts";
import type { Header } from "../src/protocol.ts";

const header = (background: number[], land: number[] | null = [1, 0, 0]) =>
  ({ background, earth: { land, missingShare: 0.1 } }) as unknown as Header;

test("places without data are darker on white, and lighter on black", () => {
  assert.deepEqual(missingColour(header([1, 1, 1])), [0.9, 0.9, 0.9]);
  assert.deepEqual(missingColour(header([0, 0, 0])), [0.1, 0.1, 0.1]);
});

test("the legend names what is there", () => {
  const names = (parts: string[], land?: null) =>
    groundKinds(header([1, 1, 1], land), (part) => parts.includes(part)).map(({ name }) => name);
  assert.deepEqual(names(["land", "missing"]), ["land", "no data"]);
  assert.deepEqual(names(["missing"]), ["no data"]);
  assert.deepEqual(names(["land"]), []);
  assert.deepEqual(names(["land", "missing"], null), []);
});
