// Where the focus goes when what has it is hidden or removed.

import assert from "node:assert/strict";
import { test } from "node:test";
import { eventOf } from "./fakepage.ts";
import { Focus } from "../src/focus.ts";
import { Lifetime } from "../src/lifetime.ts";

class Field {
  isConnected = true;
  isShown = true;
  private readonly name: string;
  private readonly log: string[];

  constructor(name: string, log: string[]) {
    this.name = name;
    this.log = log;
  }

  getClientRects = () => (this.isShown && this.isConnected ? [{}] : []);
  focus = () => void this.log.push(this.name);
}

function scene() {
  const log: string[] = [];
  const scope = new EventTarget();
  const fields = ["gear", "slider", "root"].map((name) => new Field(name, log));
  const [gear, slider, root] = fields;
  const focus = new Focus(scope as Document, new Lifetime(), () => root as unknown as HTMLElement);
  const send = (kind: string, value: Field) => scope.dispatchEvent(Object.defineProperty(eventOf(kind), "target", { value }));
  const enter = (field: Field) => send("focusin", field);
  const leave = (field: Field) => send("focusout", field);
  return { log, gear, slider, focus, enter, leave };
}

test("the focus goes back to what had it before", () => {
  for (const hide of [(field: Field) => (field.isShown = false), (field: Field) => (field.isConnected = false)]) {
    const { log, gear, slider, focus, enter } = scene();
    enter(gear);
    enter(slider);
    focus.keep();
    assert.deepEqual(log, []);
    hide(slider);
    focus.keep();
    assert.deepEqual(log, ["gear"]);
  }
});

test("the focus goes to the fallback where nothing else had it", () => {
  const { log, gear, focus, enter } = scene();
  enter(gear);
  gear.isShown = false;
  focus.keep();
  assert.deepEqual(log, ["root"]);
});

test("the focus that has gone elsewhere stays there", async () => {
  const { log, gear, slider, focus, enter, leave } = scene();
  enter(gear);
  enter(slider);
  leave(slider);
  await null;
  slider.isShown = false;
  focus.keep();
  assert.deepEqual(log, []);
});
