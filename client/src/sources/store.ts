// A Zarr store behind any web server: objects are read whole, requested again if a server or the
// network fails, and their checksums are verified.

import * as zarr from "zarrita";

/** Milliseconds before a failed object is requested again. */
const PAUSES_MS = [300, 1000, 3000];
/** Milliseconds without a byte after which an answer counts as lost. */
const STALL_MS = 20_000;
/** What a server says of an object that is not there; buckets do not distinguish that from a private one. */
const ABSENT = [401, 403, 404, 410];
const OK = 200;
const BUSY = 429;
const FAULT = 500;
/** The polynomial of CRC-32C, its bits turned around, and bytes of a check sum. */
const CASTAGNOLI = 0x82f63b78;
const SUM_BYTES = 4;
/** Bytes of a number, at most, and those of a chunk. */
const NUMBER_BYTES = 8;
const MOST_CHUNK_BYTES = 1 << 28;

/** What is wrong: the object is missing or corrupt, or the server does not answer. */
export type StoreFault = "missing" | "broken" | "unreachable" | "other";

/** An error with a plain message, and its details. */
export class StoreError extends Error {
  readonly fault: StoreFault;
  readonly detail: string;

  constructor(fault: StoreFault, message: string, detail = message) {
    super(message);
    this.fault = fault;
    this.detail = detail;
  }
}

export type Numbers = zarr.Array<zarr.NumberDataType, Objects>;
type Get = zarr.AsyncReadable["get"];
type GetRange = NonNullable<zarr.AsyncReadable["getRange"]>;
type Bytes = Promise<Uint8Array | undefined>;

/** Check sums of a byte that none to three others follow. */
const sums = Array.from({ length: 4 }, (_, more) =>
  Uint32Array.from({ length: 256 }, (__, byte) => {
    let sum = byte;
    for (let bit = 0; bit < 8 * (more + 1); bit += 1) sum = (sum >>> 1) ^ (sum & 1 ? CASTAGNOLI : 0);
    return sum;
  }),
);

export function crc32c(bytes: Uint8Array): number {
  const [last, third, second, first] = sums;
  const whole = bytes.length - (bytes.length % 4);
  let sum = 0xffffffff;
  for (let n = 0; n < whole; n += 4) {
    sum ^= bytes[n] | (bytes[n + 1] << 8) | (bytes[n + 2] << 16) | (bytes[n + 3] << 24);
    sum = first[sum & 255] ^ second[(sum >>> 8) & 255] ^ third[(sum >>> 16) & 255] ^ last[sum >>> 24];
  }
  for (let n = whole; n < bytes.length; n += 1) sum = (sum >>> 8) ^ last[(sum ^ bytes[n]) & 255];
  return ~sum >>> 0;
}

/** All bytes of a stream; `grown` is called with the size so far, and ends it where it throws. */
async function joined(
  stream: ReadableStream<Uint8Array> | null,
  grown: (size: number) => void,
): Promise<Uint8Array<ArrayBuffer>> {
  const pieces: Uint8Array[] = [];
  let size = 0;
  const reader = stream?.getReader();
  try {
    for (;;) {
      const { done = true, value } = (await reader?.read()) ?? {};
      if (done || !value) break;
      pieces.push(value);
      size += value.length;
      grown(size);
    }
  } catch (error) {
    reader?.cancel().catch(() => undefined);
    throw error;
  }
  const bytes = new Uint8Array(size);
  pieces.reduce((at, piece) => {
    bytes.set(piece, at);
    return at + piece.length;
  }, 0);
  return bytes;
}

/** The codec of that name: zarrita's leaves the check sum out without a look at it. */
class CheckSum {
  readonly kind = "bytes_to_bytes" as const;

  static fromConfig(): CheckSum {
    return new CheckSum();
  }

  encode(): never {
    throw new Error("nothing is written");
  }

  decode(bytes: Uint8Array): Uint8Array {
    const end = bytes.byteLength - SUM_BYTES;
    if (end < 0) throw new Error("the checksum is missing");
    const { buffer, byteOffset } = bytes;
    const told = new DataView(buffer, byteOffset + end, SUM_BYTES).getUint32(0, true);
    const inside = new Uint8Array(buffer, byteOffset, end);
    if (told !== crc32c(inside)) throw new Error("checksum mismatch");
    return inside;
  }

  computeEncodedSize(size: number): number {
    return size + SUM_BYTES;
  }
}

/** What gzip packs, no longer than its chunk is declared: zarrita's unpacks whatever comes. */
class Gzip {
  readonly kind = "bytes_to_bytes" as const;
  private readonly most: number;

  constructor(most: number) {
    this.most = most;
  }

  static fromConfig(_: unknown, { shape }: { shape: readonly number[] }): Gzip {
    return new Gzip(Math.min(shape.reduce((size, n) => size * n, NUMBER_BYTES), MOST_CHUNK_BYTES));
  }

  encode(): never {
    throw new Error("nothing is written");
  }

  async decode(bytes: Uint8Array): Promise<Uint8Array> {
    const packed = new Blob([bytes as Uint8Array<ArrayBuffer>]).stream();
    return joined(packed.pipeThrough(new DecompressionStream("gzip")), (size) => {
      if (size > this.most) throw new Error(`a chunk unpacks to more than ${this.most} bytes`);
    });
  }
}

zarr.registry.set("gzip", () => Promise.resolve(Gzip));
zarr.registry.set("crc32c", () => Promise.resolve(CheckSum));

function paused(wait: number, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const stop = () => {
      clearTimeout(timer);
      reject(signal.reason);
    };
    const timer = setTimeout(() => {
      signal.removeEventListener("abort", stop);
      resolve();
    }, wait);
    signal.addEventListener("abort", stop, { once: true });
  });
}

/** The bytes of an answer, and its status; cancelled if no more arrives. */
async function answer(url: string, signal: AbortSignal): Promise<[status: number, bytes: Uint8Array]> {
  const controller = new AbortController();
  const stop = () => controller.abort();
  signal.addEventListener("abort", stop, { once: true });
  let timer = setTimeout(stop, STALL_MS);
  try {
    signal.throwIfAborted();
    const { status, body } = await fetch(url, { signal: controller.signal });
    const bytes = await joined(status === OK ? body : null, () => {
      clearTimeout(timer);
      timer = setTimeout(stop, STALL_MS);
    });
    return [status, bytes];
  } finally {
    controller.abort(); // what is not read is not sent
    clearTimeout(timer);
    signal.removeEventListener("abort", stop);
  }
}

/** The bytes of an object, or nothing if it does not exist; repeats requests without an answer. */
async function object(url: string, signal: AbortSignal): Bytes {
  for (let trial = 0; ; trial += 1) {
    let said = "no server answers";
    try {
      const [status, bytes] = await answer(url, signal);
      if (status === OK) return bytes;
      if (ABSENT.includes(status)) return undefined;
      said = `the server answers ${status}`;
      if (status < FAULT && status !== BUSY) throw new StoreError("broken", said);
    } catch (error) {
      signal.throwIfAborted();
      if (error instanceof StoreError) throw error;
    }
    if (trial === PAUSES_MS.length) throw new StoreError("unreachable", said);
    await paused(PAUSES_MS[trial], signal);
  }
}

/** Objects of a store, of which ranges are given from the whole: one request for a shard and its chunks. */
export class Objects implements zarr.AsyncReadable {
  private readonly url: string;
  private readonly described: Map<string, Bytes>;
  private readonly shards = new Map<string, Bytes>();

  constructor(url: string, described: Map<string, Bytes>) {
    this.url = url;
    this.described = described;
  }

  readonly get: Get = async (key, options) => {
    if (key.endsWith("/zarr.json")) return this.description(key);
    return this.object(key, options?.signal);
  };

  readonly getRange: GetRange = async (key, range, options) => {
    const bytes = this.shards.get(key) ?? this.object(key, options?.signal);
    this.shards.set(key, bytes);
    const all = await bytes;
    if ("suffixLength" in range) return all?.subarray(-range.suffixLength);
    return all?.subarray(range.offset, range.offset + range.length);
  };

  private async object(key: string, signal = new AbortController().signal): Bytes {
    const bytes = await object(this.url + key, signal);
    if (!bytes) throw new StoreError("missing", `${key} is missing`);
    return bytes;
  }

  /** Metadata of an array or a group, kept for all callers, even if one cancels. */
  private description(key: string): Bytes {
    const known = this.described.get(key);
    if (known) return known;
    const found = object(this.url + key, new AbortController().signal);
    this.described.set(key, found);
    found.catch(() => this.described.delete(key));
    return found;
  }
}

/** What kind of fault an error is. */
export function storeError(error: unknown): StoreError {
  if (error instanceof StoreError) return error;
  // An array where there is something else is not missing.
  const fault = error instanceof zarr.NotFoundError && !error.found ? "missing" : "broken";
  return new StoreError(fault, error instanceof Error ? error.message : String(error));
}

export class Store {
  private readonly url: string;
  private readonly described = new Map<string, Bytes>();

  constructor(url: string) {
    this.url = url.replace(/\/+$/, "");
  }

  /** Attributes of the whole. */
  async attributes(): Promise<Record<string, unknown>> {
    const objects = new Objects(this.url, this.described);
    const group = await zarr.open.v3(zarr.root(objects), { kind: "group" });
    return group.attrs;
  }

  /** An array by its path; its shards are kept for as long as it is. */
  async array(path: string): Promise<Numbers> {
    const objects = new Objects(this.url, this.described);
    const array = await zarr.open.v3(zarr.root(objects).resolve(path), { kind: "array" });
    if (!array.is("number")) throw new StoreError("broken", `${path} has no numbers`);
    return array as Numbers;
  }
}
