import assert from "node:assert/strict";
import { test } from "node:test";
import type { NamedPart } from "../src/protocol.ts";
import type { TileKey } from "../src/tilechoice.ts";
import { Failures, TileQueue, type LoadTile } from "../src/tilequeue.ts";

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

test("what was wanted and is wanted no more is neither given nor a fault", async () => {
  const given: string[] = [];
  const failed: TileKey[] = [];
  const running: { key: TileKey; signal: AbortSignal; end: (fault?: Error) => void }[] = [];
  const load: LoadTile = (key, _, signal) =>
    new Promise((resolve, reject) => {
      const end = (fault?: Error) => (fault ? reject(fault) : resolve([{ name: String(key) } as NamedPart]));
      running.push({ key, signal, end });
    });
  const queue = new TileQueue(load, ({ name }) => given.push(name), 2, (key) => failed.push(key));
  const settled = () => new Promise((resolve) => setImmediate(resolve));
  queue.request([[0, 0, 0], [0, 0, 1], [0, 0, 2]], [0]);
  assert.deepEqual(running.map(({ key }) => key[2]), [0, 1]); // two at a time
  queue.request([[0, 0, 1], [0, 0, 3]], [0]);
  assert.deepEqual(running.map(({ signal }) => signal.aborted), [true, false]);
  running[0].end(new Error("stopped"));
  running[1].end();
  await settled();
  assert.deepEqual(running.map(({ key }) => key[2]), [0, 1, 3]);
  running[2].end(new Error("a fault"));
  await settled();
  assert.deepEqual([given, failed], [["0,0,1"], [[0, 0, 3]]]);
});
