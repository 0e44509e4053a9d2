import assert from "node:assert/strict";
import { test } from "node:test";
import type { NamedPart } from "../src/protocol.ts";
import { Failures, Messages, Requests, type Source, type Taker } from "../src/sources/source.ts";
import { nameOf, type TileKey } from "../src/tilechoice.ts";

const settled = () => new Promise((resolve) => setImmediate(resolve));

/** A source that gives what a test says when it says so, and who takes it. */
function host(atOnce?: number) {
  const running: { name: string; signal: AbortSignal; has: (part: string) => boolean; end: (fault?: Error) => void }[] = [];
  const given: string[] = [];
  const lacking: unknown[][] = [];
  const source: Source = {
    atOnce,
    load: (key, steps, signal, has) =>
      new Promise((resolve, reject) => {
        const name = `${key ? nameOf(key) : "whole"} ${steps}`;
        const end = (fault?: Error) => (fault ? reject(fault) : resolve([{ name } as NamedPart]));
        running.push({ name, signal, has, end });
      }),
  };
  const taker: Taker = {
    parts: new Map([["cmap", null]]),
    tiles: { has: (name, part) => name === "0/0/1" && part === "mesh" },
    setPart: ({ name }) => void given.push(name),
    lack: (...told) => void lacking.push(told),
  };
  return { requests: new Requests(source, taker), running, given, lacking };
}

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

test("what was wanted and is wanted no more is neither given nor a fault", async (context) => {
  context.mock.method(console, "warn", () => undefined);
  context.mock.timers.enable({ apis: ["setTimeout"] });
  let now = 0;
  context.mock.method(performance, "now", () => now);
  const { requests, running, given, lacking } = host(2);
  const names = () => running.map(({ name }) => name[4]);
  requests.wantTiles([[0, 0, 0], [0, 0, 1], [0, 0, 2]], [0]);
  assert.deepEqual(names(), ["0", "1"]); // two at a time
  requests.wantTiles([[0, 0, 1], [0, 0, 3], [0, 0, 4]], [0]);
  assert.deepEqual(running.map(({ signal }) => signal.aborted), [true, false, false]);
  running[0].end(new Error("stopped"));
  running[1].end();
  await settled();
  assert.deepEqual(names(), ["0", "1", "3", "4"]);
  running[2].end(new Error("a fault"));
  running[3].end(Object.assign(new Error("no server answers"), { fault: "unreachable" }));
  await settled();
  assert.deepEqual(given, ["0/0/1 0"]);
  assert.deepEqual(lacking, [
    ["A part of the surface is shown coarse: a fault", "0/0/3", [0]],
    ["A part of the surface is shown coarse: no server answers", undefined, [0]],
  ]);
  requests.wantTiles([[0, 0, 4]], [0]); // too early to be tried again
  assert.equal(running.length, 4);
  now += 10_001;
  context.mock.timers.tick(10_100);
  assert.deepEqual(names().slice(4), ["4"]);
  running[4].end();
  await settled();
  assert.deepEqual(given, ["0/0/1 0", "0/0/4 0"]);
});

test("what was given up is had when it is wanted again", async () => {
  const { requests, running, given } = host();
  const keys: TileKey[] = [[0, 0, 1]];
  requests.wantTiles(keys, [0]);
  requests.stop();
  requests.wantTiles(keys, [0]);
  requests.wantTiles(keys, [0]); // it is on its way
  assert.deepEqual(running.map(({ signal }) => signal.aborted), [true, false]);
  running[0].end(new Error("stopped"));
  running[1].end();
  await settled();
  assert.deepEqual(given, ["0/0/1 0"]);
  assert.deepEqual(["mesh", "header"].map(running[1].has), [true, false]);
});

test("of time steps those that are needed now come first, and few others", async (context) => {
  context.mock.method(console, "warn", () => undefined);
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { requests, running, given, lacking } = host(1);
  requests.wantSteps([0, 1, 2, 3, 4, 5]);
  requests.wantSteps([7, 1]);
  assert.deepEqual(running.map(({ signal }) => signal.aborted), [false]);
  for (let n = 0; n < 6; n += 1) {
    running[n].end(n === 5 ? new Error("no disk") : undefined);
    await settled();
  }
  assert.deepEqual(given, [0, 7, 1, 2, 3].map((step) => `whole ${step}`));
  assert.deepEqual(lacking, [["A time step cannot be shown: no disk", undefined, [4]]]);
  assert.equal(running.length, 6);
  assert.deepEqual(["cmap", "slices/0"].map(running[0].has), [true, false]);
});

test("a kernel answers each request, and hears of what is given up", async () => {
  const sent: Record<string, unknown>[] = [];
  const source = new Messages((content) => sent.push(content as Record<string, unknown>));
  const controller = new AbortController();
  const loads = [0, 1].map((row) => source.load([0, row, 2], [3], controller.signal, () => false));
  const [first, second] = sent.map(({ request }) => String(request));
  assert.deepEqual(sent, [
    { kind: "load", request: first, key: [0, 0, 2], steps: [3] },
    { kind: "load", request: second, key: [0, 1, 2], steps: [3] },
  ]);
  assert.notEqual(first, second);
  for (const request of ["unknown", second, first, first]) {
    source.end({ kind: "loaded", request, ...(request === first ? { error: "no disk" } : {}) });
  }
  await assert.rejects(loads[0], /no disk/);
  assert.deepEqual(await loads[1], []);
  sent.length = 0;
  controller.abort();
  assert.deepEqual(sent, [first, second].map((request) => ({ kind: "drop", request })));
});
