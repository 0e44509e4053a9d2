// A source of parts that reads them from the store that they lie in: flowtex/pyramid/layout.py
// describes the layout, and flowtex/pyramid/tasks.py the surface of a tile.

import { HALVES } from "../half.ts";
import {
  infosOfFile,
  partsOfFile,
  stepOf,
  tilePart,
  type Data,
  type Header,
  type NamedPart,
  type StoreHeader,
  type TileHeader,
  type TraceHeader,
} from "../protocol.ts";
import type { LoadTile, Source } from "./source.ts";
import { Store, StoreError, storeError, type StoreFault } from "./store.ts";
import { nameOf, type TileKey } from "../tilechoice.ts";

/** Greatest numbers of layers and of lags, of nodes along a side of a tile, and of bytes of a file. */
const MOST_LAYERS = 64;
const MOST_LAGS = 32;
const MOST_NODES = 4096;
const MOST_BYTES = 2 ** 28;
/** Parts that a tile may need beside its flow. */
const TRACED_FROM = ["padded", "unit", "open", "nearest", "normal", "rays"];

/** Why a request failed. */
const REASONS: Record<Exclude<StoreFault, "other">, string> = {
  missing: "it is not in the store, or the store is not public.",
  broken: "its data in the store are corrupt.",
  unreachable:
    "the store does not answer. The server or the network may be down, or the server does not allow this page to read it (CORS).",
};

/** What of a store has to be that of the page. */
const IDENTITY = ["format", "fingerprint", "parameter", "lines"] as const;
/** Returns whether a part of a tile or of the whole is loaded. */
type Has = (part: string) => boolean;

/** Flows that are loading, by their steps. */
type Flows = Map<number, Promise<NamedPart[]>>;
type Place = Pick<Header, "geometry" | "slices">;

/** What of a tile is the same at all times; no header where nothing of it is drawn. */
interface Surface {
  header: TileHeader | null;
  parts: NamedPart[];
}

const isCount = (value: unknown, most: number): value is number =>
  Number.isInteger(value) && Number(value) > 0 && Number(value) <= most;
const areNumbers = (values: unknown, count?: number): values is number[] =>
  Array.isArray(values) && values.every(Number.isFinite) && (count ?? values.length) === values.length;
const areWhole = (values: unknown, count: number): boolean =>
  areNumbers(values, count) && values.every(Number.isInteger);

/** Whether the header's description of the poles matches the nodes of the tile. */
function arePoles({ nodes, longest = 0, poles = [] }: TraceHeader): boolean {
  return (
    Number.isFinite(longest) &&
    poles.length <= 2 &&
    poles.every(
      ({ component, line, inward, near, plane }) =>
        [0, 1].includes(component) &&
        component === poles[0].component &&
        line === (inward > 0 ? 0 : nodes[1 - component] - 1) &&
        [1, -1].includes(inward) &&
        isCount(near, MOST_NODES) &&
        areNumbers(plane, 6),
    )
  );
}

/** Refuse the description of a tile that cannot be drawn. */
function checkHeader(own: TileHeader, { geometry: whole, slices: all }: Header): void {
  const { geometry, slices } = own;
  const { shape, rows, columns } = geometry;
  const { trace } = slices;
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
    [2, 4].includes(slices.channels) &&
    areNumbers(slices.lags) &&
    isCount(slices.lags.length, MOST_LAGS) &&
    slices.sides === all.sides &&
    areNumbers(slices.extra) &&
    slices.extra.every((n) => Number.isInteger(n) && n >= 0 && n < slices.count) &&
    areNumbers([slices.unit, slices.cell, slices.critical]) &&
    (!trace ||
      (trace.parts.every((part) => TRACED_FROM.includes(part)) &&
        areNumbers(trace.nodes, 2) &&
        trace.nodes.every((n, axis) => isCount(n, MOST_NODES) && trace.drawn[axis] + shape[axis] <= n) &&
        areWhole([...trace.first, ...trace.drawn], 4) &&
        trace.drawn.every((n) => n >= 0) &&
        areNumbers(trace.closed.map(Number), 2) &&
        areNumbers([...trace.offset, ...trace.middle, trace.unit, trace.pace, trace.rest], 12) &&
        arePoles(trace) &&
        (!trace.timed || areNumbers([trace.timed.unit, trace.timed.speed], 2))));
  if (!fits) throw new Error("the header of a tile does not match the page");
}

/** Types of the parts of a tile, and how many numbers each has. */
function sizesOf({ geometry, slices }: Pick<Header, "geometry" | "slices">) {
  const { shape, planar } = geometry;
  const { trace, count, channels, extra } = slices;
  const size = (numbers: number[], ...more: number[]) => [...numbers, ...more].reduce((a, b) => a * b, 1);
  const texels = [geometry.rows.size, geometry.columns.size];
  const nodes = trace?.nodes ?? [];
  const sizes: Record<string, [type: abstract new (...args: never[]) => Data, sizes: number[]]> = {
    cells: [Uint8Array, [size(shape.map((n) => n - 1))]],
    normal: [Int16Array, [size(shape, 3)]],
    scalars: [Float32Array, [size(shape)]],
  };
  if (trace) {
    sizes.unit = [Uint16Array, [size(nodes)]];
    sizes.padded = [Float32Array, [size(nodes.map((n) => n + 2), 3)]];
    sizes.open = [Uint8Array, [size(nodes)]];
    sizes.nearest = [Int16Array, [size(nodes, 2)]];
    const poles = trace.poles ?? [];
    sizes.rays = [Float32Array, [size(poles.slice(0, 1).map((pole) => nodes[pole.component]), 2, poles.length)]];
    sizes.flow = [Uint16Array, trace.uncertain ? [size(nodes, 5)] : [size(nodes, 3), size(nodes, 4)]];
  } else {
    sizes.position = [Float32Array, [size(shape, 3)]];
    sizes.slices = [Uint16Array, [size(texels, count, channels)]];
    sizes.extra = [Uint16Array, [size(texels, extra.length)]];
  }
  const needed = trace ? ["mesh", ...trace.parts] : ["mesh", "position", ...(planar ? [] : ["normal"])];
  return { sizes, needed };
}

/** Refuse parts whose sizes do not match the header of the tile. */
function checkParts(parts: NamedPart[], header: Pick<Header, "geometry" | "slices">, tileCells: number): void {
  const { sizes } = sizesOf(header);
  const blocks = header.geometry.shape.map((n) => Math.ceil((n - 1) / tileCells));
  for (const { name, data, shape: own } of parts) {
    const kind = sizes[name.split("/")[0]];
    const fits = kind
      ? data instanceof kind[0] && kind[1].includes(data.length)
      : name === "mesh" &&
        data instanceof Float32Array &&
        own.length === 3 &&
        own[0] === blocks[0] &&
        own[1] === blocks[1] &&
        data.length === own[0] * own[1] * own[2];
    if (!fits) throw new Error(`the part "${name}" of a tile has a wrong size`);
  }
}

/** The speed at the nodes that are drawn, in the field's own unit. */
function speedOf(flow: NamedPart, { geometry, slices }: Place, typical: number): NamedPart {
  const [rows, columns] = geometry.shape;
  const [channels, { drawn, nodes } = { drawn: [0, 0], nodes: [0, 0] }] = [flow.shape[2], slices.trace];
  const data = new Float32Array(rows * columns);
  for (let n = 0; n < data.length; n += 1) {
    const at = (Math.floor(n / columns) + drawn[0]) * nodes[1] + (n % columns) + drawn[1];
    data[n] = typical * HALVES[Number(flow.data[channels * (at + 1) - 1 - Number(slices.trace?.uncertain ?? false)])];
  }
  return { name: "", data, shape: [rows, columns], digest: `${flow.digest} speed` };
}

/** An error with a plain reason, once. */
function explained(error: unknown): StoreError {
  const known = storeError(error);
  if (known.fault === "other" || known.detail !== known.message) return known;
  return new StoreError(known.fault, REASONS[known.fault], known.message);
}

export class Stream implements Source {
  readonly hasSteps = true;
  readonly atOnce = 6;
  readonly memory = 180e6;
  private readonly header: Header;
  private readonly told: StoreHeader;
  private readonly url: URL;
  private readonly store: Store;
  private readonly headers = new Map<string, TileHeader | null>();
  private opening: Promise<void> | null = null;

  /** `header` is that of the page, whose colours may change. */
  constructor(header: Header, base: string) {
    const told = header.store;
    if (!told) throw new Error("the page does not say where its store is");
    this.header = header;
    this.told = told;
    this.url = new URL(told.url, base);
    this.store = new Store(this.url.href);
  }

  /** Make sure that the store is that of the page. */
  open(): Promise<void> {
    this.opening ??= this.compare().catch((error) => {
      const fault = explained(error);
      if (fault.fault === "unreachable") this.opening = null; // for another try
      throw fault;
    });
    return this.opening;
  }

  private async compare(): Promise<void> {
    const { url } = this.told;
    if (!/^https?:/.test(this.url.protocol)) {
      const text =
        `This page reads its store from ${url} in the same folder, which browsers do not allow when ` +
        "the page is opened as a file: open it from a web server.";
      throw new StoreError("other", text);
    }
    const own = (await this.store.attributes()).flowtex as Partial<StoreHeader> | undefined;
    if (IDENTITY.every((name) => own?.[name] === this.told[name])) return;
    const text =
      `The store at ${url} does not match this page: it has another flow, other paths or another ` +
      "version: export the page again.";
    throw new StoreError("other", text);
  }

  /** Parts of a tile, or of the whole, that are not there yet, for some time steps and the present colours. */
  readonly load: LoadTile = async (tile, steps, signal, has) => {
    const key: TileKey = tile ?? [this.told.depth, 0, 0];
    const name = nameOf(key);
    return this.loaded(signal, async (whole) => {
      const late = steps.filter((step) => !has(`slices/${step}`) && !has(`flow/${step}`));
      const known = tile ? (has("header") && !late.length ? this.headers.get(name) : undefined) : this.header;
      const surface = known === undefined ? this.surface(key, whole) : { header: known, parts: [] };
      // On their way before it is known what they belong to.
      const coming: Flows = new Map(late.map((step) => [step, this.flow(key, step, whole)]));
      const flows = [...coming.values()];
      const rest = async () => {
        const { header, parts } = await surface;
        if (tile) this.headers.set(name, header);
        if (!header) return parts;
        const [values, ...slices] = await Promise.all([
          this.values(key, header, steps, has, whole, coming),
          ...flows,
        ]);
        checkParts(slices.flat(), header, this.header.mesh.tileCells);
        if (!slices.every((each) => each.length)) throw new Error(`tile ${name} has no flow`);
        return [...parts, ...slices.flat(), ...values];
      };
      const [parts] = await Promise.all([rest(), ...flows]);
      return tile ? parts.map((part) => ({ ...part, name: `tile/${name}/${part.name}` })) : parts;
    });
  };

  /** Call with a signal that ends all of it where a part fails. */
  private async loaded<T>(signal: AbortSignal, load: (whole: AbortSignal) => Promise<T>): Promise<T> {
    const controller = new AbortController();
    signal.addEventListener("abort", () => controller.abort(), { once: true });
    try {
      await this.open();
      signal.throwIfAborted();
      return await load(controller.signal);
    } catch (error) {
      signal.throwIfAborted();
      throw explained(error);
    } finally {
      controller.abort();
    }
  }

  /** The parts of a file of a tile, by their names in it. */
  private async file(kind: string, key: TileKey, at: number[], signal: AbortSignal): Promise<Map<string, NamedPart>> {
    const array = await this.store.array(`${key[0]}/${kind}`);
    const chunk = async (n: number) => {
      const { data } = await array.getChunk([...at, n], { signal });
      if (!(data instanceof Uint8Array)) throw new Error(`${array.path} is empty`);
      return data;
    };
    const first = await chunk(0);
    const [infos, start] = infosOfFile(first);
    const size = infos.reduce((sum, { bytes }) => sum + bytes, start);
    if (!isCount(size, MOST_BYTES)) throw new Error(`a file of ${array.path} has a wrong size`);
    const file = new Uint8Array(Math.ceil(size / first.length) * first.length);
    file.set(first);
    for (let n = 1; n * first.length < size; n += 1) file.set(await chunk(n), n * first.length);
    const parts = new Map<string, NamedPart>();
    for (const part of partsOfFile(file.buffer)) {
      const [tile, name] = tilePart(part.name) ?? ["", part.name];
      if (tile && tile !== nameOf(key)) throw new Error(`in place of tile ${nameOf(key)} is ${tile}`);
      parts.set(name, { ...part, name });
    }
    const of = new TextDecoder().decode(parts.get("of")?.data as Uint8Array | undefined);
    if (of !== this.told.fingerprint) throw new Error(`tile ${nameOf(key)} belongs to another flow`);
    parts.delete("of");
    return parts;
  }

  /** What of a tile is the same at all times. */
  private async surface(key: TileKey, signal: AbortSignal): Promise<Surface> {
    const parts = await this.file("surface", key, [key[1], key[2]], signal);
    const header = this.tileHeader(parts.get("header"));
    parts.delete("header");
    if (header) {
      const missing = sizesOf(header).needed.filter((name) => !parts.has(name));
      if (missing.length) throw new Error(`a tile has no ${missing.join(", ")}`);
      checkParts([...parts.values()], header, this.header.mesh.tileCells);
    }
    const text = new TextEncoder().encode(JSON.stringify(header));
    const told = { name: "header", data: text, shape: [text.length], digest: `${this.told.fingerprint} ${nameOf(key)} header` };
    return { header, parts: [told, ...parts.values()] };
  }

  /** The description of a tile, with what all tiles have in common. */
  private tileHeader(part: NamedPart | undefined): TileHeader | null {
    const own = JSON.parse(new TextDecoder().decode(part?.data as Uint8Array | undefined));
    if (own === null) return null;
    const { steps, times, timeUnit, dates, pace } = this.header.slices;
    checkHeader(own as TileHeader, this.header);
    return { ...own, slices: { ...own.slices, steps, times, timeUnit, dates, pace } };
  }

  /** The flow of a tile at a time step, by the names that the page has for it. */
  private async flow(key: TileKey, step: number, signal: AbortSignal): Promise<NamedPart[]> {
    const source = this.told.steps[step];
    const parts = await this.file("flow", key, [source, key[1], key[2]], signal);
    return [...parts.values()].map((part) => {
      const [kind, own] = part.name.split("/");
      if (Number(own) !== source) throw new Error(`in place of step ${source} is ${part.name}`);
      return { ...part, name: `${kind}/${step}` };
    });
  }

  /** Values to colour by at some steps, once more where the colours have changed meanwhile. */
  private async values(
    key: TileKey,
    place: Place,
    steps: number[],
    has: Has,
    signal: AbortSignal,
    coming: Flows,
  ): Promise<NamedPart[]> {
    const parts = new Map<string, NamedPart>();
    for (;;) {
      const { name, steps: count, number } = this.header.scalars;
      const shown = count > 1 ? steps : [0];
      const names = shown.map((step) => (number ? `scalars/${step}/${number}` : `scalars/${step}`));
      const lacking = name === null ? [] : names.filter((each) => !has(each) && !parts.has(each));
      if (!lacking.length) return [...parts.values()];
      const found = await Promise.all(
        lacking.map(async (each) => {
          const step = count > 1 ? stepOf(each) : 0;
          if (!number && this.told.derivesSpeed && place.slices.trace) {
            const [flow] = await (coming.get(step) ?? this.flow(key, step, signal));
            return { ...speedOf(flow, place, this.header.speed.typical), name: each };
          }
          const source = count > 1 ? this.told.steps[step] : 0;
          const file = await this.file("values", key, [source, key[1], key[2], number], signal);
          const part = file.get(`scalars/${source}/${number}`);
          if (!part) throw new Error(`tile ${nameOf(key)} has no values of step ${source}`);
          return { ...part, name: each };
        }),
      );
      checkParts(found, place, this.header.mesh.tileCells);
      for (const part of found) parts.set(part.name, part);
    }
  }
}
