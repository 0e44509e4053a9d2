// Components of the app's page, in a page that is only pretended.

import assert from "node:assert/strict";
import { afterEach, mock, test } from "node:test";
import { eventOf, FakeButton, FakeElement, observers, page, root, shown, type Drawn } from "./fakepage.ts";
import { browser } from "../src/app/browser.ts";
import { covers } from "../src/app/covers.ts";
import { hints } from "../src/app/hints.ts";
import { keys } from "../src/app/keys.ts";
import { inset, path } from "../src/app/path.ts";
import { upload } from "../src/app/upload.ts";

afterEach(() => mock.restoreAll());
const settled = () => new Promise((resolve) => setImmediate(resolve));

// --- keys ---

test("keys are commands, unless somebody else wants them", () => {
  page.location.hash = "#state";
  const { told, leave } = shown(keys, null);
  const press = (key: string, more: object = {}) => {
    const event = eventOf("keydown", { key, ctrlKey: false, metaKey: false, altKey: false, ...more });
    page.dispatchEvent(event);
    return event.defaultPrevented;
  };
  assert.ok(press("ArrowLeft") && press("d") && press("t") && press(" "));
  assert.ok(!press("Escape")); // dialogs close by it as well
  const field = new FakeElement("input");
  const taken = [press("q"), press("d", { ctrlKey: true }), press("d", { target: field })];
  assert.deepEqual(taken, [false, false, false]);
  assert.ok(!press(" ", { target: new FakeButton() }));
  press("Escape", { target: field });
  let isFull = 0;
  Object.assign(root, { requestFullscreen: () => Promise.resolve((isFull += 1)) });
  assert.ok(press("f"));
  leave();
  assert.ok(!press("d"));
  assert.deepEqual(told, [
    ["linked", "#state"],
    ["command", "left"],
    ["command", "detail"],
    ["toggle", "theme"],
    ["toggle", "play"],
    ["toggle", "close"],
    ["toggle", "close"],
  ]);
  assert.equal(isFull, 1);
  page.location.hash = "";
  assert.deepEqual(shown(keys, null).told, []);
});

// --- panels that cover the picture ---

test("what covers the picture is told once, in shares of it", () => {
  const whole = new FakeElement();
  whole.box = { left: 0, top: 0, width: 1000, height: 500 };
  const put = (kind: string, left: number, top: number, width: number, height: number) => {
    const panel = new FakeElement(kind);
    panel.box = { left, top, width, height };
    return panel;
  };
  const player = put(".flowtex-player", 0, 450, 1000, 50);
  const corner = put(".flowtex-corner", 4, 104, 600, 100);
  whole.inside = [corner, put(".flowtex-panel", 804, 4, 300, 100), put(".flowtex-title", 9, 9, 0, 9), player];
  const own = new FakeElement();
  own.parentElement = whole;
  const { told, leave } = shown(covers, own);
  const watcher = observers[observers.length - 1];
  assert.equal(watcher.watched.size, 1 + 4);
  watcher.tell();
  watcher.tell(); // nothing is different
  const expected = [
    [0, 0.2, 0.208, 0.416], // of the colour bar only a part, however long its numbers are
    [0.8, 0, 1, 1], // unfolds down to the end
    [0, 0.892, 1, 1],
  ];
  assert.deepEqual(told, [["change", expected]]);
  assert.equal(whole.style["--foot"], "50px");
  whole.box.width = 0; // out of sight
  watcher.tell();
  whole.box.width = 1000;
  whole.inside = [corner];
  watcher.tell();
  assert.deepEqual(told[1], ["change", expected.slice(0, 1)]);
  leave();
  assert.equal(watcher.watched.size, 0);
  const lost = shown(covers, new FakeElement()); // not in a page
  observers[observers.length - 1].tell();
  assert.deepEqual([lost.told, observers[observers.length - 1].watched.size], [[], 0]);
});

// --- hints ---

test("a hint comes late, lies in the window, and goes", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const box = new FakeElement();
  box.hidden = true;
  const { leave } = shown(hints, box);
  const owner = (side: string, left: number, top: number, hint = "what it does") => {
    const made = new FakeElement("[data-hint]");
    made.dataset = { hint, side };
    made.box = { left, top, width: 40, height: 20 };
    return made;
  };
  const point = (target: unknown, pointerType = "mouse") => {
    page.dispatchEvent(eventOf("pointerover", { target, pointerType }));
    context.mock.timers.tick(400);
    return box.hidden ? null : [box.style.left, box.style.top];
  };
  const seen = [
    point(owner("", 150, 100)), // below
    point(owner("top", 150, 100)),
    point(owner("start", 150, 100)),
    point(owner("end", 150, 100)),
    point(owner("end", 350, 100)), // no room: below, and not out of the window
    point(owner("start", 0, 100)),
    point(owner("", 150, 270)), // no room below
    point(owner("top", 150, 10)),
  ];
  assert.deepEqual(seen, [
    ["120px", "130px"],
    ["120px", "40px"],
    ["30px", "85px"],
    ["210px", "85px"],
    ["296px", "130px"],
    ["4px", "130px"],
    ["120px", "210px"],
    ["120px", "4px"],
  ]);
  assert.equal(point(new FakeElement()), null);
  assert.equal(point(page), null);
  assert.equal(point(owner("", 1, 1), "touch"), null);
  assert.equal(point(owner("", 1, 1, "")), null); // nothing to say
  const held = owner("", 150, 100);
  assert.ok(point(held));
  page.dispatchEvent(eventOf("scroll"));
  assert.ok(box.hidden);
  assert.equal(point(held), null); // until the pointer has been elsewhere
  const focus = (target: unknown) => {
    page.dispatchEvent(eventOf("focusin", { target }));
    context.mock.timers.tick(0);
    return !box.hidden;
  };
  page.dispatchEvent(eventOf("pointerdown"));
  assert.ok(!focus(owner("", 9, 9))); // by a click
  page.dispatchEvent(eventOf("keydown"));
  assert.ok(focus(owner("", 9, 9)));
  page.dispatchEvent(eventOf("blur"));
  assert.ok(box.hidden);
  leave();
  assert.equal(point(owner("", 150, 100)), null);
  shown(hints, null).leave();
});

// --- files ---

test("files are sent one after the other, and what goes wrong is told", async () => {
  const sent: string[] = [];
  mock.method(globalThis, "fetch", (address: string) => {
    sent.push(address);
    if (sent.length === 2) return Promise.reject(new TypeError("offline"));
    return Promise.resolve({ ok: sent.length === 1, text: () => Promise.resolve("too large") });
  });
  const input = Object.assign(new FakeElement(), { files: [{ name: "d e.vtu" }], value: "d e.vtu" });
  const { told, draw, leave } = shown(upload, null, { address: "/up", accept: ".vtu" });
  const children = () => (draw() as Drawn).content[1] as Drawn[];
  const [field, button, zone] = children();
  const chosen = field.content[0] as { ref: { value: unknown }; onChange: () => void };
  const isHidden = () => (children()[2].content[0] as { hidden: boolean }).hidden;
  chosen.onChange(); // before it is in the page
  chosen.ref.value = input;
  assert.ok(button && zone && isHidden());
  const drag = (kind: string, more: object) => {
    const event = eventOf(kind, more);
    page.dispatchEvent(event);
    return event.defaultPrevented;
  };
  const files = { types: ["Files"], files: [{ name: "a" }, { name: "b" }, { name: "c" }] };
  assert.ok(!drag("dragover", { dataTransfer: { types: ["text/plain"] } }));
  assert.ok(!drag("dragover", { dataTransfer: null }) && isHidden());
  assert.ok(drag("dragover", { dataTransfer: files }) && !isHidden());
  drag("dragleave", { relatedTarget: root }); // to another element of the page
  assert.ok(!isHidden());
  drag("dragleave", { relatedTarget: null });
  assert.ok(isHidden());
  assert.ok(!drag("drop", { dataTransfer: { types: [] } }));
  assert.ok(drag("drop", { dataTransfer: files }));
  await settled();
  chosen.onChange();
  await settled();
  assert.deepEqual(sent, ["/up?name=a", "/up?name=b", "/up?name=c", "/up?name=d+e.vtu"]);
  assert.equal(input.value, ""); // the same file may be chosen again
  const problems = told.filter(([name]) => name === "problem").map(([, text]) => text);
  assert.deepEqual(problems, ["b: could not be sent", "too large", "too large"]);
  assert.deepEqual(told.at(-2), ["busy", ""]);
  leave();
  assert.ok(!drag("drop", { dataTransfer: files }));
});

// --- paths ---

const over = {
  path: [[[-1, 0], [1, 0]]],
  sampled: [[[-0.5, 0], [0.5, 0]]],
  directed: true,
  point: [0, 0],
  samples: [{ x: 0, y: 0, weight: 1, grey: "#888" }],
  panes: 2,
  shown: [1],
  aspect: 2,
};

test("a path lies in its pane, with the size that the page has now", () => {
  const props: { over: unknown } = { over: null };
  const { draw, leave } = shown(path, new FakeElement(), props);
  const watcher = observers[observers.length - 1];
  assert.equal((draw() as Drawn).content.length, 1); // nothing is drawn
  watcher.tell(...([[{ contentRect: { width: 400, height: 100 } }]] as never[]));
  props.over = over;
  const svg = (draw() as Drawn).content[1] as Drawn;
  const panes = svg.content[0] as Drawn[];
  const [, [clip, ...marks]] = panes[0].content as [object, Drawn[]];
  const { content } = clip.content[1] as Drawn;
  assert.deepEqual(content, [{ x: 200, y: 0, width: 200, height: 100 }]);
  const attributes = marks.flatMap((mark) => mark.content) as Record<string, unknown>[];
  const [whole] = attributes.filter((each) => each.class === "whole");
  const [point] = attributes.filter((each) => each.class === "point");
  assert.deepEqual([whole.points, point.cx, point.cy], ["200.0,50.0 400.0,50.0", 300, 50]);
  props.over = { ...over, point: null };
  const bare = ((draw() as Drawn).content[1] as Drawn).content[0] as Drawn[];
  assert.ok(!JSON.stringify(bare).includes('"point"'));
  leave();
  assert.equal(watcher.watched.size, 0);
  shown(path, null, { over: null }).leave();
});

test("the enlarged path fits, though it be one point", () => {
  const circles = (given: object) => {
    const { draw } = shown(inset, null, { over: given });
    const [svg] = (draw() as Drawn).content[0] as Drawn[];
    return (svg.content[1] as Drawn[]).flatMap(({ kind, content }) => (kind === "circle" ? content : []));
  };
  const [alone, point] = circles(over) as Record<string, number>[];
  assert.deepEqual([alone.cx, alone.cy, point.cx, point.cy], [116, 56, 116, 56]);
  const row = [-1, 0, 1].map((x) => ({ x, y: x, weight: 1, grey: "" }));
  const found = circles({ ...over, samples: row, point: null }) as Record<string, number>[];
  assert.equal(found.length, 3);
  assert.deepEqual([found[0].cy, found[2].cy], [103, 9]); // up is up
  const none = shown(inset, null, { over: null }).draw() as Drawn;
  assert.deepEqual(none.content, [[]]);
});

// --- drawing in the browser ---

/** Stands for the client, whose viewers it keeps. */
const CLIENT = `data:text/javascript,
  export class Viewer {
    constructor(element, options) {
      Object.assign(this, { options, log: [], sharp: false, playing: false, header: null });
      this.root = { style: {} };
      globalThis.viewers.push(this);
      for (const name of ["setHeader", "setSettings", "setCamera", "setTime", "setPart", "lack", "play", "pause", "dispose"])
        this[name] = (...values) => this.log.push([name, ...values]);
    }
  }
  export const partsOfFile = (file) => [file];`;
interface FakeViewer {
  options: Record<string, (...values: unknown[]) => void> & {
    source: { hasSteps: boolean; load: (...values: unknown[]) => Promise<unknown> };
  };
  log: unknown[][];
  sharp: boolean;
  playing: boolean;
  header: unknown;
}
const viewers: FakeViewer[] = [];
Object.assign(globalThis, { viewers });

const source = { client: CLIENT, header: "header", parts: "/parts." };
const properties = { source, settings: {}, camera: null, time: 0, playing: false };

async function begun(given: object = {}) {
  mock.method(globalThis, "fetch", (address: string) =>
    Promise.resolve({ ok: !address.includes("9,"), status: 404, arrayBuffer: () => Promise.resolve(address) }),
  );
  const element = new FakeElement();
  const component = shown(browser, element, { ...properties, ...given });
  for (let n = 0; n < 20; n += 1) await settled();
  const viewer = viewers[viewers.length - 1];
  const taken = () => viewer.log.splice(0);
  return { ...component, viewer, taken };
}

test("the browser draws what the server gives, and follows it", async () => {
  const { change, taken, viewer, leave } = await begun({ playing: true });
  assert.deepEqual(taken(), [["setHeader", "header"], ["setPart", "/parts.whole"], ["play"]]);
  change({ settings: { grain: 3 } });
  change({ camera: { position: [1, 2, 3] } });
  change({ camera: null });
  change({ time: 2 });
  viewer.playing = true;
  change({ time: 3 }); // a view that plays has a time of its own
  viewer.playing = false;
  change({ playing: false });
  change({ playing: true });
  assert.deepEqual(taken(), [
    ["setSettings", { grain: 3 }],
    ["setCamera", { position: [1, 2, 3] }],
    ["setTime", 2],
    ["pause"],
    ["play"],
  ]);
  change({ source: { ...source, header: "other", parts: "/other." } });
  await settled();
  assert.deepEqual(taken().slice(0, 2), [["setHeader", "other"], ["setPart", "/other.whole"]]);
  leave();
  assert.deepEqual(taken(), [["dispose"]]);
});

test("what a person does is told to the server, and not taken back from it", async (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { told, change, taken, viewer, draw } = await begun();
  const { onCamera, onTime, onPlaying, onPoint, onSetting } = viewer.options;
  taken();
  onCamera({ position: [4, 5, 6] });
  onTime(7);
  change({ camera: { position: [4, 5, 6] } });
  change({ time: 7 });
  assert.deepEqual(taken(), []);
  onPlaying(true);
  onSetting("grain", 2);
  onPoint({ index: [1, 2], position: [9, 9, 9] });
  viewer.header = { geometry: { triangles: true } };
  onPoint({ index: [1, 2], position: [9, 9, 9] });
  const watcher = observers[observers.length - 1];
  watcher.tell();
  viewer.sharp = true;
  watcher.tell();
  const { ref, onPointermove, onPointerleave } = (draw() as Drawn).content[0] as {
    ref: { value: unknown };
    onPointermove: (event: object) => void;
    onPointerleave: () => void;
  };
  onPointermove({ clientX: 75, clientY: 25, buttons: 0 });
  ref.value = null; // it has gone meanwhile
  onPointermove({ clientX: 0, clientY: 0, buttons: 0 });
  const [sharp, ...others] = [told.filter(([name]) => name === "sharp"), ...told];
  assert.ok(sharp.length === 1 && Number(sharp[0][1]) >= 0);
  assert.deepEqual(
    others.filter(([name]) => name !== "sharp"),
    [
      ["update:camera", { position: [4, 5, 6] }],
      ["update:time", 7],
      ["update:playing", true],
      ["setting", ["grain", 2]],
      ["point", [1, 2]],
      ["point", [9, 9, 9]],
      ["hover", [0.5, 0]],
    ],
  );
  onPointerleave();
  context.mock.timers.tick(100);
  assert.deepEqual(told.at(-1), ["hover", null]);
});

test("parts are files of the server", async () => {
  const { viewer, change } = await begun();
  const { load, hasSteps } = viewer.options.source;
  const { signal } = new AbortController();
  assert.ok(hasSteps);
  assert.deepEqual(await load(null, [1], signal), ["/parts.whole.1"]);
  assert.deepEqual(await load([0, 1, 2], [3, 4], signal), ["/parts.0,1,2.3.4"]);
  await assert.rejects(load([9, 1, 2], [3], signal), /9,1,2.3: 404/);
  change({ source: { ...source, parts: "/other." } });
  assert.deepEqual(await load(null, [1], signal), ["/other.whole.1"]);
});

test("a view that goes while it is loaded is not made", async () => {
  const before = viewers.length;
  const component = shown(browser, new FakeElement(), { ...properties });
  component.change({ time: 5 }); // before there is a view
  component.leave();
  for (let n = 0; n < 20; n += 1) await settled();
  assert.equal(viewers.length, before);
  shown(browser, null, properties).leave();
});
