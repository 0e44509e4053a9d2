// Hands on a view: what pointers, wheel and keys ask of the camera and of what is around the picture.

import assert from "node:assert/strict";
import { test } from "node:test";
import { eventOf, FakeElement } from "./fakepage.ts";
import { Lifetime } from "../src/lifetime.ts";
import { Pointers } from "../src/pointers.ts";
import type { Viewer } from "../src/viewer.ts";

/** An element that can be held, and is in a page. */
class Held extends FakeElement {
  readonly classes = new Set<string>();
  readonly classList = {
    add: (name: string) => this.classes.add(name),
    remove: (name: string) => this.classes.delete(name),
    contains: (name: string) => this.classes.has(name),
    toggle: (name: string, on: boolean) => (on ? this.classes.add(name) : this.classes.delete(name)),
  };
  readonly focus = () => undefined;
  readonly setPointerCapture = () => undefined;
}

/** A view that records requests. */
function viewed({ flat = true, guarded = false, camera = true, more = {} } = {}) {
  const log: unknown[][] = [];
  const note =
    (name: string) =>
    (...values: unknown[]) =>
      void log.push([name, ...values.map((v) => (typeof v === "number" ? Number(v.toFixed(6)) : v))]);
  const [root, canvas] = [new Held(), new Held()];
  const shown = { flat, aspect: 2, limits: { wheel_zoom: 1.25 } };
  const moves = { pan: note("pan"), rotate: note("rotate"), zoomBy: note("zoomBy") };
  const panel = { read: note("read"), hint: note("hint"), toggle: note("toggle"), fold: note("fold"), showHelp: note("showHelp") };
  const host = {
    root,
    canvas,
    options: { guarded },
    lifetime: new Lifetime(),
    camera: camera ? { ...shown, ...moves } : null,
    panel: { ...panel, fullscreen: note("fullscreen") },
    card: { close: note("close"), choose: (...at: number[]) => (note("choose")(...at), null) },
    player: { playing: false },
    sharp: true,
    canPick: true,
    point: () => "point",
    ground: () => "ground",
    reportCamera: () => undefined,
    reset: note("reset"),
    togglePlaying: note("togglePlaying"),
    ...more,
  };
  const pointers = new Pointers(host as unknown as Viewer);
  const send = (kind: string, values: object, target = canvas) => {
    const keys = { ctrlKey: false, metaKey: false, altKey: false, shiftKey: false };
    const at = { clientX: 50, clientY: 25, pointerId: 1, pointerType: "mouse", button: 0, movementX: 1 };
    const event = eventOf(kind, { ...keys, ...at, deltaMode: 0, timeStamp: 0, ...values });
    target.dispatchEvent(event);
    return event.defaultPrevented;
  };
  return { host, pointers, root, send, took: () => log.splice(0) };
}

test("a drag pans what is flat and rotates what is not, and the other with shift or the right button", () => {
  for (const [flat, more, name] of [
    [true, {}, "pan"],
    [true, { shiftKey: true }, "rotate"],
    [true, { button: 2 }, "rotate"],
    [false, {}, "rotate"],
    [false, { shiftKey: true }, "pan"],
  ] as const) {
    const { send, took, root } = viewed({ flat });
    send("pointerdown", more);
    assert.ok(root.classes.has("flowtex-grabbing"));
    send("pointermove", { clientX: 52 }); // may be a click yet
    assert.deepEqual(took(), [["hint", false]]);
    send("pointermove", { clientX: 60 });
    assert.deepEqual(took(), [[name, name === "pan" ? -0.2 : 0.2, 0], ["read", null]]);
    send("pointerup", { clientX: 60 });
    assert.deepEqual(took(), [["hint", false]]); // no point is chosen
    assert.ok(!root.classes.has("flowtex-grabbing"));
  }
});

test("a click chooses a point where it is quick, with the first button, and at rest", () => {
  const { send, took } = viewed();
  const click = (down: object, up: object, kind = "pointerup") => {
    send("pointerdown", down);
    send(kind, { ...down, ...up });
    return took().filter(([name]) => name === "choose");
  };
  assert.deepEqual(click({ clientX: 75 }, {}), [["choose", 0.5, 0]]);
  assert.deepEqual(click({}, { timeStamp: 1 }), click({}, {}));
  assert.deepEqual(click({ button: 2 }, {}), []);
  assert.deepEqual(click({ button: 4 }, {}), []);
  assert.deepEqual(click({}, {}, "pointercancel"), []);
  send("pointerup", { pointerId: 7 }); // went down elsewhere
  assert.deepEqual(took().filter(([name]) => name === "choose"), []);
});

test("two fingers pan by their middle and zoom by their distance", () => {
  const { send, took } = viewed();
  const touch = { pointerType: "touch" };
  send("pointerdown", { ...touch, pointerId: 1, clientX: 40 });
  send("pointerdown", { ...touch, pointerId: 2, clientX: 60 });
  send("pointermove", { ...touch, pointerId: 2, clientX: 80 });
  assert.deepEqual(took(), [["pan", -0.2, 0], ["zoomBy", 2, 0.2, 0], ["read", null]]);
  send("pointermove", { ...touch, pointerId: 2, clientX: 40 });
  took();
  send("pointermove", { ...touch, pointerId: 2, clientX: 60 }); // from one place they have no distance
  assert.deepEqual(took().map(([name]) => name), ["pan", "read"]);
  send("pointerup", { ...touch, pointerId: 1 });
  assert.deepEqual(took(), []);
  send("pointerup", { ...touch, pointerId: 2 });
  assert.deepEqual(took(), [["hint", false]]);
});

test("the wheel is the page's until the view is held, and a notch has one size in all units", () => {
  const free = viewed({ guarded: true });
  assert.ok(!free.send("wheel", { deltaY: -100 }));
  assert.deepEqual(free.took(), []); // what the page moved under the pointer was not pointed at
  free.send("pointermove", {});
  free.took();
  assert.ok(!free.send("wheel", { deltaY: -100 }));
  assert.deepEqual(free.took(), [["hint", true]]);
  assert.ok(free.send("wheel", { deltaY: -20, ctrlKey: true }));
  free.send("pointerdown", {});
  free.took();
  for (const [deltaMode, deltaY] of [[0, -100], [1, -3], [2, -1]]) {
    assert.ok(free.send("wheel", { deltaMode, deltaY }));
    assert.deepEqual(free.took(), [["zoomBy", 1.25, 0, 0]]);
  }
  free.send("wheel", { deltaY: 1e6 });
  assert.deepEqual(free.took(), [["zoomBy", 0.4096, 0, 0]]);
  document.dispatchEvent(eventOf("wheel")); // elsewhere
  assert.ok(!free.root.classes.has("flowtex-held"));
  free.root.kinds = [":focus-visible"];
  free.root.dispatchEvent(eventOf("focus"));
  assert.ok(free.root.classes.has("flowtex-held"));
});

test("keys move the view, unless somebody else wants them", () => {
  const { send, took, root, host } = viewed();
  const press = (key: string, more: object = {}) => send("keydown", { key, ...more }, root);
  assert.ok(["ArrowLeft", "+", "-", "0", " ", "f", "h", "?", "Escape"].every((key) => press(key)));
  assert.deepEqual(took(), [
    ["pan", -0.2, 0],
    ["zoomBy", 1.25],
    ["zoomBy", 0.8],
    ["reset"],
    ["togglePlaying"],
    ["fullscreen"],
    ["toggle"],
    ["showHelp"],
    ["fold"],
    ["showHelp", false],
    ["close"],
  ]);
  assert.ok(press("ArrowUp", { shiftKey: true }));
  assert.deepEqual(took(), [["rotate", 0, -0.2]]);
  assert.ok(!press("q") && !press("0", { ctrlKey: true }));
  const inside = (tagName: string, type?: string) => ({
    composedPath: () => [Object.assign(new FakeElement(), { tagName, type })],
  });
  assert.ok(!press("0", inside("INPUT")) && !press(" ", inside("BUTTON")) && press("0", inside("BUTTON")));
  assert.deepEqual(took(), [["reset"]]);
  for (const key of ["ArrowLeft", "Home"]) assert.ok(!press(key, inside("INPUT", "range")));
  assert.ok(press("0", inside("INPUT", "range")) && press("0", inside("INPUT", "checkbox")));
  assert.ok(!press(" ", inside("INPUT", "checkbox")) && press("Escape", inside("INPUT", "number")));
  took();
  let isToggled = false;
  Object.assign(host.options, { follows: { panel: { toggle: () => (isToggled = true) } } });
  assert.ok(press("h") && isToggled); // the bar is that of the other view
  assert.deepEqual(took(), []);
});

test("a view without a scene takes hands without an error", () => {
  const { send, took, root } = viewed({ camera: false });
  send("pointermove", {});
  send("wheel", { deltaY: -100 });
  send("dblclick", {});
  assert.ok(!send("keydown", { key: "0" }, root));
  assert.ok(send("contextmenu", {}));
  send("pointerleave", {});
  assert.deepEqual(took(), [["close"], ["read", null]]);
});

test("what is under the pointer is read when the picture is the full one", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { send, took, host } = viewed({ more: { sharp: false } });
  send("pointermove", { movementX: 0, movementY: 0 });
  context.mock.timers.tick(90);
  assert.deepEqual(took(), []);
  host.sharp = true;
  context.mock.timers.tick(90);
  assert.deepEqual(took(), [["read", "point", "ground"]]);
  host.sharp = false;
  host.player.playing = true; // nothing stands still to be read
  send("pointermove", {});
  context.mock.timers.runAll();
  assert.deepEqual(took(), []);
});
