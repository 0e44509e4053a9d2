// How parts travel to a view: its Source has them, and returns those of a tile, or of the whole
// surface, at time steps. A view asks for what it shows by its Requests, the most needed first.
//
//   Messages    a kernel answers         embedded.ts   text in an exported page
//   loadFiles   a server makes them      stream.ts     objects of a Zarr store
//
// flowtex/host/view.py is the other side of the first three.

import { FormulaSource } from "../formula.ts";
import type { Header, MarkKind, NamedPart, Settings } from "../protocol.ts";
import type { StoreError } from "./store.ts";
import { nameOf, type TileKey } from "../tilechoice.ts";
import type { Vector } from "../vectors.ts";

/**
 * Gives the parts of a tile at time steps, or those of the whole, or of its marks of a kind;
 * existing ones may be left out.
 */
export type LoadTile = (
  key: TileKey | null,
  steps: number[],
  signal: AbortSignal,
  has: (part: string) => boolean,
  mark?: MarkKind,
) => Promise<NamedPart[]>;

export interface Source {
  load: LoadTile;
  /** Whether it can load time steps of the whole again, and any tile at any time. */
  readonly hasSteps?: boolean;
  /** Whether it can load marks. */
  readonly hasMarks?: boolean;
  /** Tiles that are loaded at once. */
  readonly atOnce?: number;
  /** Memory in bytes that its parts may take, here and on the graphics card. */
  readonly memory?: number;
  /** Rejects if the source cannot be read at all. */
  open?(): Promise<void>;
}

/** Receives parts, or the reason why they are missing. */
export interface Taker {
  readonly parts: ReadonlyMap<string, unknown>;
  readonly tiles: { has(name: string, part: string): boolean } | null;
  setPart(part: NamedPart): void;
  lack(reason: string, tile?: string, steps?: number[]): void;
}

type Job = readonly [key: TileKey | null, steps: number[], mark?: MarkKind];

/** Milliseconds after which a failed request may be repeated. */
const FAILED_MS = 10000;
/** Milliseconds by which a timer may be early. */
const SPARE_MS = 20;
/** Jobs that run at once where a source does not say, and time steps that wait though others are needed now. */
const AT_ONCE = 4;
const SPARE_STEPS = 4;
const ALL_COARSE = "The surface is shown coarse";
const COARSE = "A part of the surface is shown coarse";
const ABSENT_STEP = "A time step cannot be shown";

/** Requests that failed recently; the network may have come back since. */
export class Failures {
  private readonly times = new Map<string, number>();
  private readonly now: () => number;

  constructor(now: () => number = () => performance.now()) {
    this.now = now;
  }

  add(name: string): void {
    this.times.set(name, this.now());
  }

  has(name: string): boolean {
    return this.now() - (this.times.get(name) ?? -Infinity) < FAILED_MS;
  }
}

/** Jobs of a source, some of which run at a time. */
class Queue {
  private readonly source: () => Source | null;
  readonly taker: Taker;
  private readonly running = new Map<string, AbortController>();
  /** Jobs that wait or run, and failed ones, which are tried again. */
  jobs: Job[] = [];
  private failed = new Failures();

  constructor(source: () => Source | null, taker: Taker) {
    this.source = source;
    this.taker = taker;
  }

  /** Load in this order, and drop earlier requests that are not among these. */
  want(jobs: Job[]): void {
    this.jobs = jobs;
    const names = new Set(jobs.map(String));
    for (const [name, controller] of this.running) {
      if (names.has(name)) continue;
      this.running.delete(name);
      controller.abort();
    }
    this.next();
  }

  /** Cancel all jobs, and forget the failures. */
  stop(): void {
    this.want([]);
    this.failed = new Failures();
  }

  private next(): void {
    for (const job of this.jobs) {
      if (this.running.size >= (this.source()?.atOnce ?? AT_ONCE)) return;
      if (!this.running.has(String(job)) && !this.failed.has(String(job))) void this.run(job);
    }
  }

  private async run(job: Job): Promise<void> {
    const { taker } = this;
    const source = this.source();
    if (!source) return;
    const [key, steps, mark] = job;
    const controller = new AbortController();
    const { signal } = controller;
    const has = (part: string) =>
      key ? (taker.tiles?.has(nameOf(key), part) ?? false) : taker.parts.has(part);
    this.running.set(String(job), controller);
    try {
      const parts = await source.load(key, steps, signal, has, mark);
      if (!signal.aborted) for (const part of parts) taker.setPart(part);
    } catch (error) {
      if (!signal.aborted) this.fail(job, error);
    }
    if (signal.aborted) return;
    this.running.delete(String(job));
    if (!this.failed.has(String(job))) this.jobs = this.jobs.filter((other) => String(other) !== String(job));
    this.next();
  }

  private fail(job: Job, error: unknown): void {
    const [key, steps] = job;
    this.failed.add(String(job));
    setTimeout(() => this.next(), FAILED_MS + SPARE_MS);
    // A coarser tile replaces another, unless the server does not answer.
    const isAway = (error as Partial<StoreError>).fault === "unreachable";
    const name = key && !isAway ? nameOf(key) : undefined;
    this.taker.lack(wordsOf(key ? COARSE : ABSENT_STEP, error), name, steps);
  }
}

/** The message for an error; a bare detail follows on the consequence for the picture. */
function wordsOf(what: string, error: unknown): string {
  const { fault, message = String(error), detail = "" } = error as Partial<StoreError>;
  console.warn(message, detail);
  return fault === "other" ? message : `${what}: ${message}`;
}

/** Requests of a view to its source. */
export class Requests {
  private readonly tiles: Queue;
  private readonly wholes: Queue;
  private readonly marks: Queue;
  private readonly given: Source | null;
  /** What computes the parts here. */
  formula: FormulaSource | null = null;

  constructor(source: Source | null, taker: Taker) {
    this.given = source;
    this.tiles = new Queue(() => this.source, taker);
    this.wholes = new Queue(() => this.source, taker);
    this.marks = new Queue(() => this.source, taker);
  }

  /** What comes from the host, or is computed here of a formula. */
  private get source(): Source | null {
    return this.formula ?? this.given;
  }

  /** Whether time steps of the whole can be had. */
  get hasSteps(): boolean {
    return this.source?.hasSteps ?? false;
  }

  get hasMarks(): boolean {
    return this.source?.hasMarks ?? false;
  }

  /** Ask for what belongs to another scene from now on. */
  setHeader(header: Header): void {
    this.stop();
    this.formula = header.formula ? new FormulaSource(header, header.formula) : null;
  }

  /** Follow the settings; returns whether they change the result. */
  follow(settings: Settings): boolean {
    return this.formula?.follow(settings) ?? false;
  }

  /** Have the header's ranges follow the parameters of a formula; returns whether they are others than its own. */
  fit(): boolean {
    return this.formula?.fit() ?? false;
  }

  /** The trajectory through a point, where a formula gives it. */
  trajectory(position: Vector): ReturnType<FormulaSource["trajectory"]> {
    return this.formula?.trajectory(position) ?? null;
  }

  /** Report an unreadable source before anybody zooms in. */
  open(): void {
    const { taker } = this.tiles;
    this.source?.open?.().catch((error) => taker.lack(wordsOf(ALL_COARSE, error)));
  }

  /** Tiles are lacking, in the order of need; no others that were requested before are needed. */
  wantTiles(keys: TileKey[], steps: number[]): void {
    this.tiles.want(keys.map((key) => [key, steps]));
  }

  /** Time steps of the whole are lacking; a few that were requested before may be needed again. */
  wantSteps(steps: number[]): void {
    const before = this.wholes.jobs.flatMap(([, some]) => some);
    if (steps.every((step) => before.includes(step))) return;
    const wanted = [...new Set([...steps, ...before])].slice(0, steps.length + SPARE_STEPS);
    this.wholes.want(wanted.map((step) => [null, [step]]));
  }

  /** Marks of time steps are lacking; no others that were requested before are needed. */
  wantMarks(marks: [kind: MarkKind, step: number][]): void {
    const jobs = marks.map(([kind, step]): Job => [null, [step], kind]);
    if (String(jobs) !== String(this.marks.jobs)) this.marks.want(jobs);
  }

  /** Cancel running requests: their scene or their colours are not shown any more. */
  stop(): void {
    this.tiles.stop();
    this.wholes.stop();
    this.marks.stop();
  }
}

/** The end of a request, with what went wrong. */
export interface Loaded {
  kind: "loaded";
  request: string;
  error?: string;
}

/** A source that a kernel answers by messages: parts arrive before the message that ends their request. */
export class Messages implements Source {
  readonly hasSteps = true;
  readonly hasMarks = true;
  private readonly send: (content: object) => void;
  private readonly requests = new Map<string, (error?: string) => void>();

  constructor(send: (content: object) => void) {
    this.send = send;
  }

  readonly load: LoadTile = (key, steps, signal, _has, mark) => {
    const request = String(Math.random()); // no other view of the widget has it
    this.send({ kind: "load", request, key, steps, ...(mark && { mark }) });
    signal.addEventListener("abort", () => {
      this.requests.delete(request);
      this.send({ kind: "drop", request });
    });
    return new Promise<NamedPart[]>((resolve, reject) => {
      this.requests.set(request, (error) => (error ? reject(new Error(error)) : resolve([])));
    });
  };

  end({ request, error }: Loaded): void {
    this.requests.get(request)?.(error);
    this.requests.delete(request);
  }
}

/**
 * Gives parts from an address and a name, such as "whole", or some parts of it by another name, for what is the same at all times, "whole.3" for a
 * time step, and "0,2,5.3.4" for a tile at two.
 */
export function loadFiles(address: () => string, partsOfFile: (file: ArrayBuffer) => NamedPart[]) {
  return async (
    key: TileKey | null,
    steps: number[],
    signal?: AbortSignal,
    _has?: unknown,
    whole = "whole",
  ): Promise<NamedPart[]> => {
    const name = address() + [String(key ?? whole), ...steps].join(".");
    const answer = await fetch(name, { signal });
    if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
    return partsOfFile(await answer.arrayBuffer());
  };
}
