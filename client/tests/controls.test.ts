// The sheet of settings, icons and pictures, in a page that is only pretended.

import assert from "node:assert/strict";
import { test } from "node:test";
import { FakeElement, page } from "./fakepage.ts";
import type { Controls as Sheet } from "../src/controls.ts";
import type { Viewer } from "../src/viewer.ts";
import type { Header, Row, Value } from "../src/protocol.ts";

/** An element that is made by its kind, as much of one as the sheet touches. */
class MadeElement extends FakeElement {
  attributes: Record<string, string> = {};
  children: unknown[] = [];
  value = "";
  checked = false;
  classes: [name: string, on: boolean][] = [];
  classList = { toggle: (name: string, on: boolean) => this.classes.push([name, on]) };

  setAttribute(name: string, value: string): void {
    this.attributes[name] = value;
    if (name === "value") this.value = value;
  }

  append(...children: unknown[]): void {
    this.children.push(...children);
  }

  replaceChildren(): void {
    this.children = [];
  }

  get valueAsNumber(): number {
    return this.value === "" ? NaN : Number(this.value);
  }
}

Object.assign(document, {
  createElement: (kind: string) => new MadeElement(kind),
  createElementNS: (_: string, kind: string) => new MadeElement(kind),
});
const { Controls, isUseful } = await import("../src/controls.ts");
const { icon, pictureOf } = await import("../src/dom.ts");
const { Lifetime } = await import("../src/lifetime.ts");

const row = (name: string, more: Partial<Row> = {}): Row => ({
  ...{ name, label: name, text: "", control: "slider", logarithmic: false, whole: false },
  ...{ default: 0, affects: "uniform", low: 0, high: 1, choices: [], ...more },
});

function sheetOf(table: Row[], rebuild?: boolean) {
  const chosen: [string, Value][] = [];
  const settings: Record<string, Value> = {};
  const lifetime = new Lifetime();
  const choose = (name: string, value: Value) => void chosen.push([name, value]);
  const sheet: Sheet = new Controls({ lifetime, options: { rebuild }, settings, choose } as unknown as Viewer);
  const slices = { sides: 1, steps: 1 };
  sheet.build({ table, variant: [], image: null, slices, settings: {} } as unknown as Header);
  const rows = (sheet.element as unknown as MadeElement).children as MadeElement[];
  const inputs = rows.map(({ children }) => children[children.length - 1] as MadeElement);
  return { chosen, settings, lifetime, sheet, rows, inputs };
}

function use(input: MadeElement, kind: string, values: Partial<MadeElement>): void {
  Object.assign(input, values);
  input.dispatchEvent(new Event(kind));
}

test("each kind of setting has its control, which shows and chooses", () => {
  const table = [
    row("shown", { control: "checkbox" }),
    row("noise", { control: "choice", choices: ["a", "b"] }),
    row("seed", { control: "number", whole: true, low: 0, high: 9 }),
    row("share", { control: "number", low: null, high: null }),
    row("contrast", { low: 0.25, high: 4, logarithmic: true }),
    row("lod"), // has a button
  ];
  const { chosen, settings, sheet, rows, inputs } = sheetOf(table);
  assert.deepEqual(rows.map(({ attributes }) => attributes["data-setting"]), ["shown", "noise", "seed", "share", "contrast"]);
  assert.deepEqual(rows.map(({ classes }) => classes[0][1]), [false, false, false, false, true]);
  assert.deepEqual(inputs.map(({ attributes }) => attributes.step), [undefined, undefined, "1", "any", "0.01"]);
  Object.assign(settings, { shown: true, noise: "b", seed: 3, contrast: 2 });
  sheet.update();
  assert.deepEqual(inputs.map(({ checked, value }) => (checked ? "on" : value)), ["on", "b", "3", "", "1"]);
  assert.equal((rows[4].children[1] as MadeElement).textContent, "2");
  use(inputs[0], "change", { checked: false });
  use(inputs[1], "change", { value: "a" });
  use(inputs[2], "change", { value: "12" }); // beyond the end
  use(inputs[3], "change", { value: "" }); // no number
  use(inputs[4], "input", { value: "-1" });
  assert.deepEqual(chosen, [["shown", false], ["noise", "a"], ["seed", 9], ["contrast", 0.5]]);
  assert.equal((rows[4].children[1] as MadeElement).textContent, "0.5");
});

test("what has to be traced anew waits until the hand lets go", () => {
  const { chosen, inputs } = sheetOf([row("samples", { affects: "trace", whole: true, low: 1, high: 9 })], true);
  use(inputs[0], "input", { value: "4" });
  assert.deepEqual(chosen, []);
  use(inputs[0], "change", { value: "4" });
  assert.deepEqual(chosen, [["samples", 4]]);
});

test("a sheet that is built again has nothing of the one before", () => {
  const { sheet, settings, chosen, inputs, lifetime } = sheetOf([row("grain")]);
  sheet.build({ table: [row("noise", { affects: "shader" })], variant: [], image: null } as unknown as Header);
  assert.equal((sheet.element as unknown as MadeElement).children.length, 0);
  settings.grain = 0.5;
  sheet.update();
  assert.equal(inputs[0].value, "");
  lifetime.end();
  use(inputs[0], "input", { value: "1" });
  assert.deepEqual(chosen, []);
});

test("a setting is offered where it changes the picture", () => {
  const of = (image: object | null, steps = 1, lines = "") =>
    ({ variant: [], image, slices: { sides: 2, steps }, settings: { lines } }) as unknown as Header;
  const [whole, image] = [of(null), of({})];
  const noise = of({ deviations: [1] });
  const cases: [name: string, header: Header, rebuild: boolean, useful: boolean][] = [
    ["grain", whole, false, true],
    ["fixed_grain", image, true, false],
    ["two_sided", whole, false, true],
    ["seed", whole, false, true],
    ["seed", image, true, false],
    ["resolution", image, true, false],
    ["grain", image, true, false],
    ["grain", noise, false, true],
    ["fixed_grain", noise, true, false],
    ["seed", noise, true, true],
    ["seed", noise, false, false],
    ["resolution", noise, true, true],
    ["tiles", noise, true, false],
    ["tiles", whole, true, false],
    ["tiles", image, false, true],
    ["lines", of(null, 3), true, true],
    ["lines", whole, true, false],
    ["parameter", whole, true, true],
    ["parameter", of(null, 3, "pathlines"), true, false],
    ["parameter", of(null, 3), true, true],
    ["show_level", whole, true, false],
  ];
  for (const [name, header, rebuild, useful] of cases) {
    assert.equal(isUseful(row(name), header, rebuild), useful, `${name} ${JSON.stringify(header)} ${rebuild}`);
  }
});

test("an icon is a path, filled where it plays", () => {
  const pathOf = (name: Parameters<typeof icon>[0]) => (icon(name) as unknown as MadeElement).children[0] as MadeElement;
  assert.equal(pathOf("play").attributes.class, "solid");
  assert.ok(pathOf("pause").attributes.d.startsWith("M8.5") && !("class" in pathOf("pause").attributes));
});

test("pictures of views lie beside each other, each at least one pixel wide", async () => {
  const drawn: unknown[][] = [];
  class Canvas {
    size: [number, number];
    constructor(...size: [number, number]) {
      this.size = size;
    }
    getContext = () => ({ drawImage: (_: unknown, ...place: number[]) => drawn.push(place) });
    convertToBlob = (format: object) => Promise.resolve({ size: this.size, format });
  }
  Object.assign(globalThis, { OffscreenCanvas: Canvas });
  const views = [{ width: 40, height: 20 }, { width: 1, height: 20 }].map((canvas) => ({ canvas }) as never);
  assert.deepEqual(await pictureOf(views, 0.25, { type: "image/jpeg" }), { size: [11, 5], format: { type: "image/jpeg" } } as never);
  assert.deepEqual(drawn, [[0, 0, 10, 5], [10, 0, 1, 5]]);
  assert.deepEqual(await pictureOf(views), { size: [41, 20], format: {} } as never);
});

test("nothing of a viewer outlives it", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const lifetime = new Lifetime();
  const calls: string[] = [];
  lifetime.listen(page, "keydown", () => calls.push("key"));
  lifetime.listen(new FakeElement(), "click", () => undefined);
  lifetime.later(() => calls.push("soon"), 10);
  lifetime.later(() => calls.push("late"), 100);
  const none = lifetime.later(() => calls.push("never"), 10);
  lifetime.cancel(none);
  lifetime.cancel(null);
  const watching = new Set<unknown>();
  const observer = { observe: (element: unknown) => watching.add(element), disconnect: () => watching.clear() };
  lifetime.observe(observer as never, new FakeElement() as never);
  page.dispatchEvent(new Event("keydown"));
  context.mock.timers.tick(20);
  assert.deepEqual(calls, ["key", "soon"]);
  assert.deepEqual(lifetime.stats(), { listeners: 1, observers: 1, timers: 1 });
  assert.deepEqual([lifetime.isOver, watching.size], [false, 1]);
  lifetime.end();
  page.dispatchEvent(new Event("keydown"));
  context.mock.timers.tick(200);
  assert.deepEqual(calls, ["key", "soon"]);
  assert.deepEqual(lifetime.stats(), { listeners: 0, observers: 0, timers: 0 });
  assert.deepEqual([lifetime.isOver, watching.size], [true, 0]);
});

test("a setting that makes no difference is dimmed, and says where it would", () => {
  const needs: Row["needs"] = [["noise", "!=", "procedural"], ["lod", "==", false]];
  const { rows, settings, sheet } = sheetOf([row("shown", { text: "Text.", needs, condition: "Only there." })]);
  const look = () => {
    sheet.update();
    const [line] = rows as (MadeElement & { title: string })[];
    return [line.title, line.classes.at(-1)];
  };
  Object.assign(settings, { noise: "procedural", lod: true });
  assert.deepEqual(look(), ["Only there. Text.", ["idle", true]]);
  settings.lod = false;
  assert.deepEqual(look(), ["Text.", ["idle", false]]);
});
