// Tiles and time steps of a page from the store that they lie in: flowtex/pyramid/layout.py tells what is
// where, and flowtex/pyramid/client_parts.py what the surface of a tile is.

import {
  partsOfFile,
  stepOf,
  tilePart,
  type Data,
  type Header,
  type NamedPart,
  type StoreHeader,
  type TileHeader,
} from "./protocol.ts";
import { Store, StoreError, storeError, type Numbers, type StoreFault } from "./store.ts";
import { nameOf, type TileKey } from "./tilechoice.ts";

/** Greatest numbers of layers and of lags, and of nodes along a side, that a tile can have. */
const MOST_LAYERS = 64;
const MOST_LAGS = 32;
const MOST_NODES = 4096;
/** Parts of a surface, their types and numbers of a node. */
const KINDS: Record<string, [type: abstract new (...args: never[]) => Data, size: number]> = {
  position: [Float32Array, 3],
  normal: [Int16Array, 3],
  cells: [Uint8Array, 1],
};
/** Layer in which it is told of a tile what it is. */
const TOLD = 0;
const CHANNELS = 4;

/** What is said of what could not be had, and why. */
const COARSE = "A part of the surface is shown coarse:";
const ABSENT_STEP = "A time step cannot be shown:";
const NO_STORE = "The surface is shown coarse:";
const REASONS: Record<Exclude<StoreFault, "other">, string> = {
  missing: "it is not in the store, or the store is not open to everyone.",
  broken: "what the store has of it is broken.",
  unreachable:
    "the store does not answer. It is away, the network is, or pages from elsewhere may not read it (CORS).",
};

/** What of a store has to be that of the page. */
const IDENTITY = ["format", "fingerprint", "parameter", "lines"] as const;
/** Share of a number by which it may differ where it was computed elsewhere. */
const ROUNDING = 1e-6;

/** What traces tell of themselves: which they are, and what they are measured in. */
type Told = Partial<Pick<Header["slices"], "count" | "lags" | "unit" | "cell">> & {
  tile?: number[];
  step?: number;
  of?: string;
  size?: number[];
};

/** Tells whether a part is there, of a tile or of the whole. */
export type Has = (part: string) => boolean;

/** What of a tile is the same at all times; no header where nothing of it is drawn. */
interface Surface {
  header: TileHeader | null;
  parts: NamedPart[];
}

/** Where a tile is read, and what of. */
interface Place {
  key: TileKey;
  header: TileHeader;
  signal: AbortSignal;
}

const isCount = (value: unknown, most: number): value is number =>
  Number.isInteger(value) && Number(value) > 0 && Number(value) <= most;
const areNumbers = (values: unknown, count?: number): values is number[] =>
  Array.isArray(values) && values.every(Number.isFinite) && (count ?? values.length) === values.length;
const areAlike = (some: unknown[], others: unknown[]) =>
  some.length === others.length &&
  some.every((n, k) => Math.abs(Number(n) - Number(others[k])) <= ROUNDING * Math.abs(Number(n)));

/** Refuse what is told of a tile where it cannot be drawn. */
function checkHeader(own: TileHeader, { geometry: whole, slices: all }: Header): void {
  const { geometry, slices, ranges } = own;
  const { shape, rows, columns } = geometry;
  const fits =
    areNumbers(shape, 2) &&
    shape.every((n) => isCount(n, MOST_NODES) && n > 1) &&
    [rows, columns].every(
      ({ before, size }, axis) =>
        Number.isInteger(before) && isCount(size, MOST_NODES) && before >= 0 && before + shape[axis] <= size,
    ) &&
    Number.isInteger(geometry.levels) &&
    geometry.levels >= 0 &&
    2 ** geometry.levels <= Math.max(rows.size, columns.size) &&
    geometry.triangles === whole.triangles &&
    geometry.planar === whole.planar &&
    Number.isFinite(geometry.extent) &&
    areNumbers(geometry.periodic.map(Number), 2) &&
    areNumbers(geometry.center, 3) &&
    areNumbers(geometry.frame, 9) &&
    isCount(slices.count, MOST_LAYERS) &&
    slices.channels === all.channels &&
    areNumbers(slices.lags) &&
    isCount(slices.lags.length, MOST_LAGS) &&
    slices.sides === all.sides &&
    areNumbers(slices.extra) &&
    slices.extra.every((n) => Number.isInteger(n) && n >= 0 && n < slices.count) &&
    areNumbers([slices.unit, slices.cell, slices.critical]) &&
    Object.values(ranges ?? {}).every((range) => areNumbers(range, 2));
  if (!fits) throw new Error("what is told of a tile does not fit the page");
}

/** Refuse a surface whose arrays are not as long as it is told. */
function checkSurface(parts: Map<string, NamedPart>, header: TileHeader, tileCells: number): void {
  const { shape, planar } = header.geometry;
  const needed = ["position", "mesh", ...(planar ? [] : ["normal"])];
  const missing = needed.filter((name) => !parts.has(name));
  if (missing.length) throw new Error(`a tile has no ${missing.join(", ")}`);
  for (const [name, { data, shape: own }] of parts) {
    const [rows, columns] = shape.map((n) => (name === "cells" ? n - 1 : n));
    const blocks = shape.map((n) => Math.ceil((n - 1) / tileCells));
    const kind = KINDS[name];
    const fits = kind
      ? data instanceof kind[0] && data.length === rows * columns * kind[1]
      : data instanceof Float32Array &&
        own.length === 3 &&
        own[0] === blocks[0] &&
        own[1] === blocks[1] &&
        data.length === own[0] * own[1] * own[2] &&
        own[2] % 2 === 1;
    if (!fits) throw new Error(`the part "${name}" of a tile has another size than is told`);
  }
}

/** Numbers of a chunk, of which there must be so many at least along each axis. */
async function chunkOf(
  array: Numbers,
  at: number[],
  least: number[],
  signal: AbortSignal,
): Promise<{ data: Data; shape: number[] }> {
  const { data, shape } = await array.getChunk(at, { signal });
  const last = shape.slice(shape.length - least.length);
  const count = shape.reduce((product, n) => product * n, 1);
  const fits = last.every((n, k) => n >= least[k]) && data.length === count;
  if (!fits) throw new Error(`a chunk of ${array.path} has the shape ${shape}`);
  return { data: data as Data, shape: last };
}

export class Stream {
  private readonly header: Header;
  private readonly told: StoreHeader;
  private readonly url: URL;
  private readonly store: Store;
  private readonly headers = new Map<string, TileHeader | null>();
  private opening: Promise<void> | null = null;

  /** `header` is that of the page, whose colours may change. */
  constructor(header: Header, base: string) {
    const told = header.store;
    if (!told) throw new Error("the page does not tell where its store is");
    this.header = header;
    this.told = told;
    this.url = new URL(told.url, base);
    this.store = new Store(this.url.href);
  }

  /** Make sure that the store is that of the page. */
  open(): Promise<void> {
    if (this.opening) return this.opening;
    this.opening = this.compare().catch((error) => {
      const { fault, message } = storeError(error);
      if (fault === "other") throw error;
      if (fault === "unreachable") this.opening = null; // for another try
      const text = `${fault === "missing" ? NO_STORE : COARSE} ${REASONS[fault]}`;
      throw new StoreError(fault, text, message);
    });
    return this.opening;
  }

  private async compare(): Promise<void> {
    const { url } = this.told;
    if (!/^https?:/.test(this.url.protocol)) {
      const text =
        `This page looks for its store at ${url} beside itself, which a browser does not read where ` +
        "the page is a file: open it from a web server.";
      throw new StoreError("other", text);
    }
    const own = (await this.store.attributes()).flowtex as Partial<StoreHeader> | undefined;
    if (IDENTITY.every((name) => own?.[name] === this.told[name])) return;
    const text =
      `The store at ${url} holds another flow than this page, or one with other paths or of another ` +
      "version: export the page again.";
    throw new StoreError("other", text);
  }

  /** Parts of a tile that are not there yet, for some time steps and the present colours. */
  async tile(key: TileKey, steps: number[], signal: AbortSignal, has: Has): Promise<NamedPart[]> {
    const name = nameOf(key);
    return this.loaded(COARSE, signal, async (whole) => {
      const known = has("header") ? this.headers.get(name) : undefined;
      const surface = known === undefined ? this.surface(key, whole) : { header: known, parts: [] };
      const late = steps.filter((step) => !has(`slices/${step}`));
      // On its way before it is known what it belongs to.
      const traces = late.map((step) => this.traces(key, step, whole));
      const rest = async () => {
        const { header, parts } = await surface;
        this.headers.set(name, header);
        if (!header) return parts;
        const place = { key, header, signal: whole };
        const slices = late.map(async (step, n) => this.slices(place, step, await traces[n]));
        return [parts, ...(await Promise.all([...slices, this.values(place, steps, has)]))].flat();
      };
      const [parts] = await Promise.all([rest(), ...traces]);
      return parts.map((part) => ({ ...part, name: `tile/${name}/${part.name}` }));
    });
  }

  /** Parts of the whole surface at a time step, of which some are lacking. */
  async root(step: number, signal: AbortSignal, lacking: () => string[]): Promise<NamedPart[]> {
    const { header } = this;
    const key: TileKey = [this.told.depth, 0, 0];
    return this.loaded(ABSENT_STEP, signal, async (whole) => {
      const place = { key, header, signal: whole };
      const names = lacking();
      const parts: NamedPart[] = [];
      if (names.some((name) => /^(slices|extra)\//.test(name))) {
        parts.push(...(await this.slices(place, step, await this.traces(key, step, whole))));
      }
      const has = (part: string) => !lacking().includes(part);
      return [...parts, ...(await this.values(place, [step], has))];
    });
  }

  /** Call with a signal that ends all of it where a part fails. */
  private async loaded<T>(what: string, signal: AbortSignal, load: (whole: AbortSignal) => Promise<T>) {
    const controller = new AbortController();
    let stop = (): void => undefined;
    const stopped = new Promise<never>((_, reject) => {
      stop = () => reject(signal.reason);
      signal.addEventListener("abort", stop, { once: true });
    });
    try {
      // What is for all who ask goes on though one of them has gone.
      return await Promise.race([this.open().then(() => load(controller.signal)), stopped]);
    } catch (error) {
      signal.throwIfAborted();
      const { fault, message } = storeError(error);
      throw fault === "other" ? error : new StoreError(fault, `${what} ${REASONS[fault]}`, message);
    } finally {
      controller.abort();
      signal.removeEventListener("abort", stop);
    }
  }

  /** What of a tile is the same at all times. */
  private async surface([level, row, column]: TileKey, signal: AbortSignal): Promise<Surface> {
    const array = await this.store.array(`${level}/surface`);
    const { data } = await chunkOf(array, [row, column, 0], [1], signal);
    const parts = new Map<string, NamedPart>();
    for (const part of partsOfFile(new Uint8Array(data as Uint8Array).buffer)) {
      const [tile, name] = tilePart(part.name) ?? ["", ""];
      if (tile === nameOf([level, row, column])) parts.set(name, { ...part, name });
    }
    const header = this.tileHeader(parts.get("header"));
    parts.delete("header");
    if (header) checkSurface(parts, header, this.header.mesh.tileCells);
    const text = new TextEncoder().encode(JSON.stringify(header));
    const digest = this.digest([level, row, column], "header");
    const told = { name: "header", data: text, shape: [text.length], digest };
    return { header, parts: [told, ...parts.values()] };
  }

  /** What is told of a tile, with what is the same in all of them. */
  private tileHeader(part: NamedPart | undefined): TileHeader | null {
    const own = JSON.parse(new TextDecoder().decode(part?.data as Uint8Array | undefined));
    if (own === null) return null;
    const { steps, times, timeUnit, dates, pace } = this.header.slices;
    checkHeader(own as TileHeader, this.header);
    return { ...own, slices: { ...own.slices, steps, times, timeUnit, dates, pace } };
  }

  /** The traces of a tile, and what is told of them. */
  private async traces([level, row, column]: TileKey, step: number, signal: AbortSignal) {
    const { steps, fingerprint, parameter, lines } = this.told;
    const array = await this.store.array(`${level}/traces`);
    const at = [steps[step], row, column];
    const { data } = await chunkOf(array, [...at, TOLD, 0, 0, 0], [1, 1, CHANNELS], signal);
    const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
    const text = new TextDecoder().decode(bytes.subarray(0, Math.max(bytes.indexOf(0), 0)));
    if (!text) throw new StoreError("missing", `tile ${level}/${row}/${column} is empty`);
    const told = JSON.parse(text) as Told;
    const which = [level, row, column, steps[step], `${fingerprint} ${parameter} ${lines}`];
    if (String([told.tile, told.step, told.of]) !== String(which)) {
      throw new Error(`in place of tile ${level}/${row}/${column} there is another one`);
    }
    return { array, at, told };
  }

  /** Slopes of a time step, as they are sent by a host: flowtex/rendering/webgl/packing.py. */
  private async slices(
    { key, header, signal }: Place,
    step: number,
    { array, at, told }: Awaited<ReturnType<Stream["traces"]>>,
  ): Promise<NamedPart[]> {
    const { count, channels, extra, unit, cell, lags } = header.slices;
    const [height, width] = [header.geometry.rows.size, header.geometry.columns.size];
    const measures = [told.unit, told.cell, ...(told.lags ?? [])];
    if (
      told.count !== count ||
      String(told.size) !== String([height, width]) ||
      !areAlike([unit, cell, ...lags], measures)
    ) {
      throw new Error(`the traces of tile ${nameOf(key)} do not fit its surface`);
    }
    const texels = height * width;
    // Two halves are copied at a time.
    const slopes = new Uint32Array((count * texels * channels) / 2);
    const fourth = new Uint16Array(extra.length * texels);
    for (let layer = 0; layer < count; layer += 1) {
      signal.throwIfAborted();
      const place = [...at, TOLD + 1 + layer, 0, 0, 0];
      const { data, shape } = await chunkOf(array, place, [height, width, CHANNELS], signal);
      const pairs = new Uint32Array(data.buffer, data.byteOffset, data.length / 2);
      const also = extra.indexOf(layer);
      let to = (layer * texels * channels) / 2;
      for (let j = 0; j < height; j += 1) {
        const row = j * shape[1];
        for (let i = row; i < row + width; i += 1) {
          slopes[to++] = pairs[2 * i];
          if (channels === CHANNELS) slopes[to++] = pairs[2 * i + 1];
          if (also >= 0) fourth[also * texels + j * width + i - row] = data[CHANNELS * i + 3];
        }
      }
    }
    const part = (name: string, values: Uint16Array, shape: number[]): NamedPart => ({
      name: `${name}/${step}`,
      data: values,
      shape,
      digest: this.digest(key, `${name}/${step}`),
    });
    const rest = part("extra", fourth, [extra.length, height, width]);
    return [rest, part("slices", new Uint16Array(slopes.buffer), [count, height, width, channels])];
  }

  /** Values to colour by at some steps, once more where the colours have changed meanwhile. */
  private async values(place: Place, steps: number[], has: Has): Promise<NamedPart[]> {
    const parts = new Map<string, NamedPart>();
    for (;;) {
      const { name, steps: count, number } = this.header.scalars;
      const shown = count > 1 ? steps : [0];
      const names = shown.map((step) => (number ? `scalars/${step}/${number}` : `scalars/${step}`));
      const lacking = name === null ? [] : names.filter((each) => !has(each) && !parts.has(each));
      if (!lacking.length) return [...parts.values()];
      const found = await Promise.all(
        lacking.map((each) => this.valuesOf(place, each, count > 1 ? stepOf(each) : null, number)),
      );
      for (const part of found) parts.set(part.name, part);
    }
  }

  private async valuesOf(
    { key, header, signal }: Place,
    name: string,
    step: number | null,
    number: number,
  ): Promise<NamedPart> {
    const [level, row, column] = key;
    const [rows, columns] = header.geometry.shape;
    const array = await this.store.array(`${level}/values`);
    const source = step === null ? 0 : this.told.steps[step];
    const at = [source, row, column, number, 0, 0];
    const { data, shape } = await chunkOf(array, at, [rows, columns], signal);
    const values = new Float32Array(rows * columns);
    for (let j = 0; j < rows; j += 1) {
      values.set(data.subarray(j * shape[1], j * shape[1] + columns), j * columns);
    }
    return { name, data: values, shape: [rows, columns], digest: this.digest(key, name) };
  }

  /** What a part is known by on the whole page. */
  private digest(key: TileKey, name: string): string {
    const [kind, step, ...rest] = name.split("/");
    const source = step === undefined ? [] : [this.told.steps[Number(step)]];
    return [this.told.fingerprint, nameOf(key), kind, ...source, ...rest].join(" ");
  }
}
