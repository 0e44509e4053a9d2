// A store as flowtex/pyramid/layout.py has it, over a web server that may fail; tests/pyramid/
// test_client_store.py writes store.json.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, mock, test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Header, NamedPart } from "../src/protocol.ts";
import { crc32c, StoreError } from "../src/sources/store.ts";
import { Stream } from "../src/sources/stream.ts";

interface Fixture {
  files: Record<string, string>;
  told: { geometry: object; slices: object };
  expected: Record<string, { shape: number[]; data: number[] }>;
}

const fixture: Fixture = JSON.parse(readFileSync(new URL("store.json", import.meta.url), "utf8"));
const BASE = "http://flow.test/flow.zarr/";
const ABOUT = { format: "form", fingerprint: "print", parameter: "arclength", lines: "pathlines" };
const TILE = "tile/0/0/0";
const FLOW = "0/flow/c/0/0/0/0";

/** What the server has, its requests, and how it fails: a status, or to answer at all. */
let files: Map<string, Uint8Array<ArrayBuffer>>;
let asked: string[];
let fault: (path: string) => number | Error | null;

const server: typeof fetch = async (address, options) => {
  const path = String(address).slice(BASE.length);
  asked.push(path);
  await new Promise((resolve) => setImmediate(resolve));
  options?.signal?.throwIfAborted();
  const failed = fault(path);
  if (failed instanceof Error) throw failed;
  const file = files.get(path);
  return new Response(failed || !file ? null : file, { status: failed ?? (file ? 200 : 404) });
};

beforeEach(() => {
  files = new Map();
  for (const [path, text] of Object.entries(fixture.files)) {
    files.set(path, new Uint8Array(Buffer.from(text, "base64")));
  }
  asked = [];
  fault = () => null;
  globalThis.fetch = server;
});

function streamOf(scalars: Partial<Header["scalars"]> = {}, store = {}): { header: Header; stream: Stream } {
  const { geometry, slices } = fixture.told;
  const times = { steps: 2, times: [0, 1], timeUnit: "s", dates: { start: null, dates: [], step: 0 }, pace: 1 };
  const header = {
    geometry,
    slices: { ...slices, ...times },
    scalars: { name: null, steps: 2, number: 0, ...scalars },
    mesh: { tileCells: 64 },
    store: { url: BASE, ...ABOUT, depth: 2, steps: [0, 1], ...store },
  } as unknown as Header;
  return { header, stream: new Stream(header, BASE) };
}

const signal = new AbortController().signal;
const nothing = () => false;
const named = (parts: NamedPart[]) => new Map(parts.map((part) => [part.name, part]));

/** Bits of a part, as the fixture has them. */
function assertPart(part: NamedPart | undefined, expected: string): void {
  const { shape, data } = fixture.expected[expected];
  assert.ok(part, expected);
  assert.deepEqual(part.shape, shape);
  const bits = part.data instanceof Float32Array ? new Uint32Array(part.data.buffer) : part.data;
  assert.deepEqual([...bits], data);
}

/** Fails with a kind of fault. */
const failing = (kind: string) => (error: unknown) => error instanceof StoreError && error.fault === kind;

test("check sums are those of the standard", () => {
  assert.equal(crc32c(new TextEncoder().encode("123456789")), 0xe3069283);
});

test("a tile is what Python wrote, in one request for each object", async () => {
  const { stream } = streamOf({ name: "depth", number: 1 });
  const parts = named(await stream.load([0, 0, 0], [0, 1], signal, nothing));
  for (const step of [0, 1]) {
    assertPart(parts.get(`${TILE}/slices/${step}`), `slices/${step}`);
    assertPart(parts.get(`${TILE}/extra/${step}`), `extra/${step}`);
    assertPart(parts.get(`${TILE}/scalars/${step}/1`), `scalars/${step}/1`);
  }
  const header = JSON.parse(new TextDecoder().decode(parts.get(`${TILE}/header`)?.data));
  assert.deepEqual(header.geometry, fixture.told.geometry);
  assert.deepEqual([header.slices.times, header.slices.pace], [[0, 1], 1]);
  assert.ok(parts.has(`${TILE}/position`) && parts.has(`${TILE}/mesh`));
  assert.equal(new Set(asked).size, asked.length);
  assert.equal(asked.filter((path) => path.includes("/c/")).length, 5);
});

test("what is there is not asked for again", async () => {
  const { stream, header } = streamOf({ name: "speed" });
  const held = named(await stream.load([0, 0, 0], [1], signal, nothing));
  const has = (part: string) => held.has(`${TILE}/${part}`);
  asked = [];
  assert.deepEqual(await stream.load([0, 0, 0], [1], signal, has), []);
  header.scalars.number = 1;
  const [values] = await stream.load([0, 0, 0], [1], signal, has);
  assertPart(values, "scalars/1/1");
  assert.deepEqual(asked, ["0/values/c/1/0/0/1/0"]);
});

test("colours that change on the way are asked for as well", async () => {
  const { stream, header } = streamOf({ name: "speed" });
  const loading = stream.load([0, 0, 0], [0], signal, nothing);
  fault = (path) => {
    if (path.startsWith("0/values/c/")) header.scalars.number = 1;
    return null;
  };
  const parts = named(await loading);
  assertPart(parts.get(`${TILE}/scalars/0/1`), "scalars/0/1");
});

test("values that do not vary are those of the first step, and steps are those of the page", async () => {
  const { stream } = streamOf({ name: "depth", steps: 1, number: 1 }, { steps: [1] });
  const parts = named(await stream.load([0, 0, 0], [0], signal, nothing));
  assertPart(parts.get(`${TILE}/slices/0`), "slices/1");
  assertPart(parts.get(`${TILE}/scalars/0/1`), "scalars/0/1");
});

test("of a tile in which nothing is drawn there is only that", async () => {
  const { stream } = streamOf({ name: "speed" });
  const [header, ...rest] = await stream.load([0, 0, 1], [0], signal, nothing);
  assert.equal(new TextDecoder().decode(header.data), "null");
  assert.deepEqual([header.name, rest], ["tile/0/0/1/header", []]);
});

test("no flipped byte passes", async () => {
  for (const path of [FLOW, "0/surface/c/0/0/0", "0/values/c/0/0/0/0/0"]) {
    const whole = files.get(path) as Uint8Array<ArrayBuffer>;
    for (let n = 0; n < whole.length; n += Math.ceil(whole.length / 60)) {
      const bytes = whole.slice();
      bytes[n] ^= 1 << n % 8;
      files.set(path, bytes);
      const { stream } = streamOf({ name: "speed" });
      // Some bytes of a shard belong to chunks that are not read.
      const parts = await stream.load([0, 0, 0], [0], signal, nothing).catch((error) => {
        assert.ok(failing("broken")(error), `${path} ${n}: ${error}`);
      });
      if (parts) assertPart(named(parts).get(`${TILE}/slices/0`), "slices/0");
    }
    files.set(path, whole);
  }
});

test("no shorter object passes", async () => {
  for (const path of [FLOW, "0/surface/c/0/0/0", "0/values/c/0/0/0/0/0"]) {
    const whole = files.get(path) as Uint8Array<ArrayBuffer>;
    for (const size of [0, 3, 4, whole.length >> 1, whole.length - 1]) {
      files.set(path, whole.slice(0, size));
      const { stream } = streamOf({ name: "speed" });
      await assert.rejects(stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
    }
    files.set(path, whole);
  }
});

test("a chunk unpacks to what its array declares, and no further", async () => {
  const stops: number[] = [];
  const Packed = globalThis.DecompressionStream;
  globalThis.DecompressionStream = class extends Packed {
    constructor(format: CompressionFormat) {
      super(format);
      let size = 0;
      const count = new TransformStream<Uint8Array, Uint8Array>({
        transform(piece, controller) {
          size += piece.length;
          stops[0] = size;
          controller.enqueue(piece);
        },
      });
      Object.defineProperty(this, "readable", { value: super.readable.pipeThrough(count) });
    }
  };
  try {
    const size = 100_000_000;
    const about = JSON.parse(new TextDecoder().decode(files.get("0/flow/zarr.json")));
    const told = { ...about, codecs: about.codecs[0].configuration.codecs }; // without shards
    files.set("0/flow/zarr.json", new TextEncoder().encode(JSON.stringify(told)));
    const packed = gzipSync(new Uint8Array(size));
    const sum = new Uint8Array(packed.length + 4);
    sum.set(packed);
    new DataView(sum.buffer).setUint32(packed.length, crc32c(packed), true);
    files.set(FLOW, sum);
    await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
    assert.ok(stops[0] > 0 && stops[0] < size / 2, `${stops[0]}`);
  } finally {
    globalThis.DecompressionStream = Packed;
  }
});

test("what is wrong is said in words", async () => {
  const tile = () => streamOf({ name: "speed" }).stream.load([0, 0, 0], [0], signal, nothing);
  const text = (words: string) => new TextEncoder().encode(words);
  const flip = (bytes: Uint8Array<ArrayBuffer>) => bytes.map((byte, n) => (n === bytes.length >> 1 ? byte ^ 64 : byte));
  const broken = /^Error: its data in the store are corrupt/;
  const cases: [string, (bytes: Uint8Array<ArrayBuffer>) => Uint8Array<ArrayBuffer>, RegExp][] = [
    [FLOW, flip, broken],
    [FLOW, () => text("<!doctype html><title>Welcome</title>".repeat(200)), broken],
    ["0/surface/c/0/0/0", flip, broken],
    ["0/values/c/0/0/0/0/0", (bytes) => bytes.slice(0, -9), broken],
    ["zarr.json", () => text("<!doctype html>"), broken],
    ["zarr.json", () => text('{"zarr_format":3,"node_type":"group","attributes":{}}'), /does not match this page/],
  ];
  for (const [path, change, words] of cases) {
    const whole = files.get(path) as Uint8Array<ArrayBuffer>;
    files.set(path, change(whole));
    await assert.rejects(tile(), words, path);
    files.set(path, whole);
  }
  for (const path of [FLOW, "0/flow/zarr.json"]) {
    fault = (asked_) => (asked_ === path ? 404 : null);
    await assert.rejects(tile(), /^Error: it is not in the store, or the store is not public/, path);
  }
  fault = (path) => (path === "zarr.json" ? 404 : null);
  await assert.rejects(tile(), /it is not in the store, or the store is not public/);
});

test("what is not there or not open is missing, and not tried again", async () => {
  for (const status of [401, 403, 404, 410]) {
    fault = (path) => (path === FLOW ? status : null);
    asked = [];
    await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("missing"));
    assert.equal(asked.filter((path) => path === FLOW).length, 1);
  }
});

test("who does not answer is asked again, some times", async () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  const turn = setInterval(() => mock.timers.tick(100), 0);
  try {
    let count = 0;
    fault = (path) => (path === FLOW && (count += 1) < 3 ? [503, new TypeError("failed")][count - 1] : null);
    const parts = named(await streamOf().stream.load([0, 0, 0], [0], signal, nothing));
    assertPart(parts.get(`${TILE}/slices/0`), "slices/0");
    assert.equal(count, 3);
    fault = (path) => (path === FLOW ? 500 : null);
    asked = [];
    await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("unreachable"));
    assert.equal(asked.filter((path) => path === FLOW).length, 4);
  } finally {
    clearInterval(turn);
    mock.timers.reset();
  }
});

test("a server that refuses a request is not asked again", async () => {
  fault = (path) => (path === FLOW ? 400 : null);
  await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
  assert.equal(asked.filter((path) => path === FLOW).length, 1);
  fault = () => null;
  const text = new TextDecoder().decode(files.get("0/flow/zarr.json"));
  files.set("0/flow/zarr.json", new TextEncoder().encode(text.replace('"uint8"', '"bool"')));
  await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
});

test("a store that did not answer is tried again, and a page has to tell where its store is", async () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  const turn = setInterval(() => mock.timers.tick(5000), 0);
  try {
    const { stream } = streamOf();
    fault = () => 503;
    await assert.rejects(stream.open(), failing("unreachable"));
    fault = () => null;
    await stream.open();
    await stream.open();
    const beside = new Stream({ store: { url: "./flow.zarr" } } as unknown as Header, "file:///page.html");
    await assert.rejects(beside.open(), /open it from a web server/);
    assert.throws(() => new Stream({} as Header, BASE), /does not say where its store is/);
  } finally {
    clearInterval(turn);
    mock.timers.reset();
  }
});

test("what is given up ends at once, without a fault", async () => {
  // Time stands still: it does not wait for the next trial.
  mock.timers.enable({ apis: ["setTimeout"] });
  const controller = new AbortController();
  let answered = 0;
  fault = (path) => {
    if (path !== FLOW) return null;
    answered += 1;
    return 503;
  };
  const { stream } = streamOf();
  const loading = stream.load([0, 0, 0], [0], controller.signal, nothing);
  while (!answered) await new Promise((resolve) => setImmediate(resolve));
  controller.abort();
  await assert.rejects(loading, (error: Error) => error.name === "AbortError");
  mock.timers.reset();
});

test("another store is refused, before anything of it is read", async () => {
  for (const name of Object.keys(ABOUT)) {
    asked = [];
    const { stream } = streamOf({}, { [name]: "other" });
    await assert.rejects(stream.load([0, 0, 0], [0], signal, nothing), /does not match this page/);
    assert.deepEqual(asked, ["zarr.json"]);
  }
});

test("the flow of another tile, time or store is refused", async () => {
  const whole = files.get(FLOW) as Uint8Array<ArrayBuffer>;
  for (const other of ["0/flow/c/1/0/0/0", "0/flow/c/0/0/1/0"]) {
    files.set(FLOW, files.get(other) as Uint8Array<ArrayBuffer>);
    await assert.rejects(streamOf().stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
  }
  files.set(FLOW, whole);
  const told = { attributes: { flowtex: { ...ABOUT, fingerprint: "other" } } };
  const group = JSON.stringify({ zarr_format: 3, node_type: "group", ...told });
  files.set("zarr.json", new TextEncoder().encode(group));
  const { stream } = streamOf({}, { fingerprint: "other" });
  await assert.rejects(stream.load([0, 0, 0], [0], signal, nothing), failing("broken"));
});

test("slices of the whole of another size are refused", async () => {
  for (const other of [{}, { count: 4 }, { channels: 4 }, { extra: [0] }]) {
    const { stream, header } = streamOf({}, { depth: 0 });
    Object.assign(header.slices, other);
    const loading = stream.load(null, [0], signal, nothing);
    if (Object.keys(other).length) await assert.rejects(loading, failing("broken"));
    else assertPart(named(await loading).get("slices/0"), "slices/0");
  }
});

test("a header that does not fit is refused", async () => {
  const garbage: unknown[] = [undefined, null, "x", -1, 1e9, [], {}, [-1, 2], true];
  const { geometry, slices } = fixture.told;
  const told = new TextDecoder().decode(files.get("0/surface/c/0/0/0")); // packed: replaced as a whole
  assert.ok(told);
  for (const [kind, own] of Object.entries({ geometry, slices })) {
    for (const name of Object.keys(own)) {
      for (const value of garbage) {
        const { stream, header } = streamOf();
        // The page is told the same, so that only what is wrong in itself is found.
        const wrong = { ...fixture.told, [kind]: { ...own, [name]: value } };
        const check = () => (stream as unknown as Inner).tileHeader(textPart(JSON.stringify(wrong)));
        let passed: object | null = null;
        try {
          passed = check();
        } catch {
          continue;
        }
        // What passes is as harmless as what it stands for.
        assert.equal(typeof value, typeof (own as Record<string, unknown>)[name], `${kind}.${name} = ${value}`);
        assert.ok(passed && header);
      }
    }
  }
});

test("poles that do not fit the nodes of a tile are refused", () => {
  const { slices } = fixture.told;
  const pole = { component: 1, line: 99, inward: -1, near: 6, plane: [1, 0, 0, 0, 1, 0] };
  const isTaken = (...poles: unknown[]) => {
    const traced = { nodes: [100, 80], first: [0, 0], drawn: [0, 0], closed: [false, true], unit: 1, pace: 1, rest: 0 };
    const trace = { ...traced, parts: ["rays"], offset: [0, 0, 0, 0, 0, 0], middle: [0, 0, 0], poles };
    const told = { ...fixture.told, slices: { ...slices, trace } };
    try {
      return Boolean((streamOf().stream as unknown as Inner).tileHeader(textPart(JSON.stringify(told))));
    } catch {
      return false;
    }
  };
  assert.ok(isTaken(pole));
  assert.ok(isTaken({ ...pole, line: 0, inward: 1 }, pole));
  for (const wrong of [{ component: 2 }, { line: 1 }, { inward: 2 }, { near: -1 }, { near: 1e9 }, { plane: [1] }]) {
    assert.ok(!isTaken({ ...pole, ...wrong }), JSON.stringify(wrong));
  }
  assert.ok(!isTaken(pole, pole, pole) && !isTaken(null));
});

interface Inner {
  tileHeader(part: NamedPart): object | null;
}

function textPart(text: string): NamedPart {
  const data = new TextEncoder().encode(text);
  return { name: "header", data, shape: [data.length], digest: "" };
}
