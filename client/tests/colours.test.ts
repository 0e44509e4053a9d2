import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { choiceOf, mapOf, meanColour, rampOf, recoloured } from "../src/colours.ts";
import { shareOf, type Header, type Settings, type Shading } from "../src/protocol.ts";

interface Case {
  settings: Settings;
  colours: number[][];
  means: number[][];
}

// What Python computes: tests/rendering/test_client_numbers.py.
const file = new URL("colours.json", import.meta.url);
const { shading, cases }: { shading: Shading; cases: Case[] } = JSON.parse(readFileSync(file, "utf8"));

test("mean colours are those of Python", () => {
  for (const { settings, colours, means } of cases) {
    const found = colours.map((colour) => meanColour(colour, settings, shading).map(Math.round));
    assert.deepEqual(found, means);
  }
});

const header = {
  scalars: {
    ...{ name: "speed", unit: "m/s", number: 0, low: 0, high: 2, auto: true, cmap: "viridis" },
    choices: [
      { name: "speed", unit: "m/s", low: 0, high: 2, steps: 1 },
      { name: "p", unit: "Pa", low: -1, high: 3, steps: 4 },
    ],
    ...{ maps: ["viridis", "coolwarm"], entries: 256, flip: false, beyond: [null, null, null], diverging: ["coolwarm"], log: false, bar: true, steps: 1 },
  },
} as unknown as Header;

test("a map by default follows the scalars, and one that was chosen does not", () => {
  const [speed, pressure] = header.scalars.choices;
  const choices = [{ ...speed, cmap: "viridis" }, { ...pressure, cmap: "coolwarm" }];
  const named = (cmap: string, name: string) =>
    ({ ...header, scalars: { ...header.scalars, choices, cmap, name } }) as Header;
  assert.equal(choiceOf(named("viridis", "speed"), "p").cmap, "coolwarm");
  assert.equal(choiceOf(named("coolwarm", "p"), "speed").cmap, "viridis");
  assert.equal(choiceOf(named("magma", "speed"), "p").cmap, undefined);
  assert.equal(choiceOf(named("viridis", "speed"), false).cmap, undefined);
  assert.equal(choiceOf(header, "p").cmap, undefined);
});

test("what is chosen is what the surface is coloured by", () => {
  const changed = (choice: Parameters<typeof recoloured>[1]) => {
    const { colours } = recoloured(header, choice, new Map());
    return colours.scalars as Header["scalars"];
  };
  const pressure = changed({ scalars: "p" });
  assert.deepEqual([pressure.name, pressure.unit, pressure.number, pressure.steps], ["p", "Pa", 1, 4]);
  assert.deepEqual([pressure.low, pressure.high], [-1, 3]);
  assert.deepEqual([changed({ clim: [1, 1.5] }).low, changed({ clim: [1, 1.5] }).auto], [1, false]);
  assert.equal(changed({ scalars: false }).name, null);
  const centred = changed({ scalars: "p", cmap: "coolwarm" });
  assert.deepEqual([centred.low, centred.high], [-3, 3]);
  assert.deepEqual(header.scalars.name, "speed"); // the header itself stays
});

test("places on the map go by the logarithm where that is asked for", () => {
  const share = shareOf({ low: 1, high: 100, log: true } as Header["scalars"]);
  assert.deepEqual([-1, 1, 10, 100].map(share), [0, 0, 0.5, 1]);
});

test("a map is a part of the table of all of them, and an image has colours of its own", () => {
  const data = Uint8Array.from({ length: 2 * 3 * 256 }, (_, n) => Math.floor(n / 3) % 256);
  const maps = new Map([["maps", { data, shape: [2, 256, 3] }]]) as unknown as Parameters<typeof recoloured>[2];
  const { part } = recoloured(header, { cmap: "coolwarm" }, maps);
  assert.deepEqual([...(part?.data ?? [])].slice(0, 8), [0, 0, 0, 255, 1, 1, 1, 255]);
  const map = mapOf(header, data, "coolwarm");
  const [settings] = cases.map((each) => each.settings);
  const rampFor = (image: object | null) => {
    const shown = { ...header, image, constants: { shading } } as unknown as Header;
    return rampOf(map, shown, settings, 3);
  };
  assert.equal(rampFor({}), "linear-gradient(90deg, rgb(0 0 0), rgb(128 128 128), rgb(255 255 255))");
  const [middle] = [meanColour([128, 128, 128], settings, shading).map(Math.round)];
  for (const noise of [null, { deviations: [1] }]) {
    assert.ok(rampFor(noise).includes(`, rgb(${middle.join(" ")}), `));
  }
});
