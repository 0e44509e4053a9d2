// Components of the app's page, in a page that is only pretended.

import assert from "node:assert/strict";
import { afterEach, mock, test } from "node:test";
import { asked, eventOf, FakeElement, page, root, server, shown, type Drawn } from "./fakepage.ts";
import { browser } from "../src/app/browser.ts";
import { hints } from "../src/app/hints.ts";
import { keys } from "../src/app/keys.ts";
import { upload } from "../src/app/upload.ts";

afterEach(() => mock.restoreAll());
const settled = () => new Promise((resolve) => setImmediate(resolve));

// --- keys ---

test("keys change the page, unless somebody else wants them", () => {
  page.location.hash = "#state";
  const { told, leave } = shown(keys, null);
  const press = (key: string, more: { target?: FakeElement; ctrlKey?: boolean } = {}) => {
    const modifiers = { ctrlKey: false, metaKey: false, altKey: false };
    const composedPath = () => [more.target ?? page];
    const event = eventOf("keydown", { key, ...modifiers, ...more, composedPath });
    page.dispatchEvent(event);
    return event.defaultPrevented;
  };
  assert.ok(press("t") && press("?"));
  assert.ok(!press("Escape")); // dialogs close by it as well
  const field = new FakeElement("input");
  const taken = [press("d"), press("t", { ctrlKey: true }), press("t", { target: field })];
  assert.deepEqual(taken, [false, false, false]);
  press("Escape", { target: field });
  leave();
  assert.ok(!press("t"));
  assert.deepEqual(told, [
    ["linked", "#state"],
    ["toggle", "theme"],
    ["toggle", "help"],
    ["toggle", "close"],
    ["toggle", "close"],
  ]);
});

test("a link is taken at first and later, and leaves the address", () => {
  page.location.hash = "#first";
  asked.length = 0;
  const { told, leave } = shown(keys, null);
  assert.deepEqual([page.location.hash, asked], ["", [["address", "/page/?a=b"]]]);
  page.dispatchEvent(eventOf("hashchange"));
  page.location.hash = "#later";
  page.dispatchEvent(eventOf("hashchange"));
  assert.equal(page.location.hash, "");
  leave();
  page.location.hash = "#too late";
  page.dispatchEvent(eventOf("hashchange"));
  page.location.hash = "";
  assert.deepEqual(told, [["linked", "#first"], ["linked", "#later"]]);
  assert.deepEqual(shown(keys, null).told, []);
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

// --- the view ---

/** Stands for the client, whose elements it keeps. */
const CLIENT = `data:text/javascript,
  class Viewer {
    constructor(log, own) {
      Object.assign(this, { log, own, header: null, playing: false, player: { time: 7 }, root: {}, stage: {}, canvas: { width: 300, height: 200 } });
      this.panel = { fail: (...values) => log.push(["fail", ...values]) };
      for (const name of ["setHeader", "followSetting", "setCamera", "setTime", "followTime", "setClock",
        "setPart", "keepParts", "play", "pause", "change", "resize"])
        this[name] = (...values) => this.log.push([name, ...values]);
    }
  }
  export class FlowtexView extends EventTarget {
    constructor() {
      super();
      Object.assign(this, { viewers: [], log: [] });
      globalThis.views.push(this);
      for (const name of ["dispose", "remove", "paint"]) this[name] = (...values) => this.log.push([name, ...values]);
    }
    get first() { return this.viewers[0]; }
    open(count, own) { this.viewers = Array.from({ length: count }, (_, n) => new Viewer(this.log, own(n))); }
  }
  export const partsOfFile = (file) => [file];`;
interface FakeViewer {
  playing: boolean;
  own: { reader: (at: object, path: boolean) => Promise<unknown>; source?: object };
}
interface FakeView extends EventTarget {
  options: { streamed: boolean; onColours: (choice: object) => void };
  viewers: FakeViewer[];
  log: unknown[][];
}
const views: FakeView[] = [];
Object.assign(globalThis, { views });

const CARD = "ANGLE (NVIDIA)";
let generation = 0;
const scene = (name: string) => ({ header: { name, generation: (generation += 1) }, parts: `/${name}.` });
const one = scene("one");
const start = { client: CLIENT, area: "view", scenes: [one], settings: { grain: 3 }, camera: null, time: 0 };

const place = () => Object.assign(new FakeElement(), { append: () => undefined });

async function rested(): Promise<void> {
  for (let n = 0; n < 20; n += 1) await settled();
}

function serve(card: string): void {
  server.answer = { ...start, timeBeside: null, clock: 0, playing: false };
  server.card = card;
  asked.length = 0;
  mock.method(globalThis, "fetch", (address: string) =>
    Promise.resolve({ ok: true, arrayBuffer: () => Promise.resolve(address) }),
  );
}

async function begun(card = CARD) {
  serve(card);
  const component = shown(browser, place(), { begin: "begin", read: "read" });
  await rested();
  const view = views[views.length - 1];
  const methods = component.exposed as { take: (changes: object) => void; paint: (painter: string) => void };
  return { ...component, view, ...methods, taken: () => view.log.splice(0).map(([name, ...rest]) => [name, ...rest]) };
}

test("the view shows what the server hands over, and follows it", async () => {
  const { view, take, taken, leave } = await begun();
  assert.deepEqual(asked[0], ["begin", "browser"]);
  assert.ok(!view.options.streamed && view.viewers[0].own.source);
  const seen = taken();
  assert.deepEqual(seen[0], ["setHeader", one.header]);
  assert.ok(seen.some(([name, part]) => name === "setPart" && part === "/one.whole"));
  assert.ok(seen.some(([name]) => name === "keepParts")); // what another flow had besides is gone
  take({ settings: { grain: 4 }, camera: { position: [1, 2, 3] }, time: 2, playing: true });
  assert.deepEqual(taken(), [
    ["followSetting", "grain", 4],
    ["setCamera", { position: [1, 2, 3] }],
    ["followTime", 2],
    ["play"],
  ]);
  view.viewers[0].playing = true;
  take({ time: 3, clock: 1, playing: false }); // a view that plays has a time of its own
  assert.deepEqual(taken(), [["pause"]]);
  take({ scenes: [{ ...one, parts: "/coloured." }] });
  await rested();
  const coloured = taken();
  assert.ok(coloured.some(([name, part]) => name === "setPart" && part === "/coloured.colours"));
  assert.ok(!coloured.some(([name]) => name === "keepParts"));
  const two = scene("two");
  take({ scenes: [one, two], timeBeside: 5 });
  await rested();
  assert.equal(view.viewers.length, 2);
  const names = taken().filter(([name]) => name === "setHeader" || name === "setTime");
  assert.deepEqual(names, [["setHeader", one.header], ["setHeader", two.header], ["setTime", 5]]);
  await view.viewers[1].own.reader({ place: [0, 1] }, true);
  assert.deepEqual(asked.at(-1), ["read", 1, { place: [0, 1], path: true, time: 7 }]);
  leave();
  assert.deepEqual(taken().at(-1), ["dispose"]);
});

test("what changes while the client is loaded is taken over after that", async () => {
  serve(CARD);
  const { exposed, leave } = shown(browser, place(), { begin: "begin", read: "read" });
  await Promise.resolve();
  await Promise.resolve();
  (exposed as { take: (changes: object) => void }).take({ scenes: [scene("late")], time: 9 });
  await rested();
  const { log } = views[views.length - 1];
  const headers = log.filter(([name]) => name === "setHeader").map(([, header]) => (header as { name: string }).name);
  assert.deepEqual(headers, ["one", "late"]);
  assert.ok(log.some(([name, time]) => name === "followTime" && time === 9));
  leave();
});

test("a scene that the server does not have any more is told", async () => {
  const { take, taken, leave } = await begun();
  taken();
  mock.method(globalThis, "fetch", () => Promise.resolve({ ok: false, status: 404 }));
  take({ scenes: [scene("lost")] });
  await rested();
  const failed = taken().filter(([name]) => name === "fail");
  assert.deepEqual(failed, [["fail", "The flow could not be loaded.", "Error: /lost.whole: 404"]]);
  leave();
});

test("what a person does is told to the server", async (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { view, told, take, taken } = await begun();
  taken();
  const tell = (name: string, detail: unknown) => view.dispatchEvent(Object.assign(new Event(name), { detail }));
  tell("camera", { position: [4, 5, 6] });
  tell("camera", { position: [7, 8, 9] }); // soon after, and told later
  tell("time", 7);
  tell("playing", true);
  tell("setting", ["grain", 2]);
  view.options.onColours({ cmap: "magma" });
  context.mock.timers.tick(100);
  const { page: own } = told[0][1] as { page: string };
  assert.ok(own && told.every(([, value]) => (value as { page: string }).page === own));
  assert.deepEqual(told.map(([name, value]) => [name, (value as { value: unknown }).value]), [
    ["camera", { position: [4, 5, 6] }],
    ["time", 7],
    ["playing", true],
    ["setting", ["grain", 2]],
    ["colours", { cmap: "magma" }],
    ["camera", { position: [7, 8, 9] }],
  ]);
  take({ time: 7, by: own });
  assert.deepEqual(taken(), []);
  take({ time: 7, by: "another" });
  assert.deepEqual(taken(), [["followTime", 7]]);
});

test("without WebGL2 the server draws, and a person may choose", async () => {
  const { view, paint, take, taken } = await begun("");
  assert.deepEqual(asked[0], ["begin", "server"]);
  assert.ok(view.options.streamed && !view.viewers[0].own.source);
  assert.ok(taken().some(([name, part]) => name === "setPart" && part === "/one.controls"));
  assert.deepEqual(server.called, ["trame.rca.size", ["view", "view", { w: 300, h: 200, p: 1 }]]);
  server.called = [];
  take({ scenes: [{ ...one, parts: "/coloured." }] });
  await rested();
  assert.deepEqual([server.called, taken().length > 0], [[], true]); // the size is known
  const picture = { width: 300, height: 200, close: () => undefined };
  Object.assign(globalThis, { createImageBitmap: () => Promise.resolve(picture) });
  const frame = { name: "view", meta: { type: "image/jpeg", sharp: true }, content: new Uint8Array(2) };
  server.push(frame);
  server.push({ ...frame, name: "another" });
  await rested();
  assert.deepEqual(taken(), [["paint", picture, 2, true]]);
  paint("browser");
  await rested();
  assert.deepEqual(taken(), [["dispose"], ["remove"]]);
  server.push(frame);
  await rested();
  assert.ok(!views[views.length - 1].log.some(([name]) => name === "paint"));
  assert.deepEqual(asked.at(-1), ["begin", "browser"]);
});

test("the browser draws first where it has a graphics card, or where a person has chosen it", async (context) => {
  const kept = new Map<string, string>();
  const sessionStorage = {
    getItem: (key: string) => kept.get(key) ?? null,
    setItem: (key: string, value: string) => kept.set(key, value),
  };
  const first = async (card: string) => {
    const { leave } = await begun(card);
    leave();
    return asked[0][1];
  };
  const cards = ["", CARD, "ANGLE (Google, Vulkan (SwiftShader Device))", "llvmpipe, or similar", "Microsoft Basic Render"];
  const painters = [];
  for (const card of cards) painters.push(await first(card));
  assert.deepEqual(painters, ["server", "browser", "server", "server", "server"]);
  Object.assign(globalThis, { sessionStorage });
  context.after(() => Reflect.deleteProperty(globalThis, "sessionStorage"));
  (await begun(cards[2])).paint("browser");
  assert.equal(await first(cards[2]), "browser");
});

test("a view that goes while it is loaded is not made", async () => {
  const before = views.length;
  shown(browser, place(), { begin: "begin", read: "read" }).leave();
  await rested();
  assert.equal(views.length, before);
  shown(browser, null, {}).leave();
});
