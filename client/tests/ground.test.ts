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
  const names = (kinds: string[], land?: null) => {
    const whole = header([1, 1, 1], land);
    Object.assign(whole.earth ?? {}, { kinds });
    return groundKinds(whole).map(({ name, color }) => [name, color]);
  };
  const lacking = ["no data", [0.9, 0.9, 0.9]];
  assert.deepEqual(names(["land", "no data"]), [["land", [1, 0, 0]], lacking]);
  assert.deepEqual(names(["no data"]), [lacking]);
  assert.deepEqual(names([]), []);
  assert.deepEqual(names(["land", "no data"], null), []);
});
