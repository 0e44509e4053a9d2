// Tiles from a host that gives them one by one: a page that holds them, or a server.

import type { NamedPart } from "./protocol.ts";
import { nameOf, type TileKey } from "./tilechoice.ts";

type Job = readonly [key: TileKey, steps: number[]];

/** Gives the parts of a tile for some time steps. */
export type LoadTile = (key: TileKey, steps: number[], signal: AbortSignal) => Promise<NamedPart[]>;

/** Milliseconds after which what could not be had may be asked for again. */
const FAILED_MS = 10000;

/** What could not be had of late: a network may be there again. */
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

export class TileQueue {
  private readonly load: LoadTile;
  private readonly give: (part: NamedPart) => void;
  private readonly most: number;
  private readonly fail: (key: TileKey, error: unknown, steps: number[]) => void;
  private readonly running = new Map<string, AbortController>();
  private wanted: Job[] = [];

  /** So many tiles at most are loaded at a time; `fail` is told of those that cannot be had. */
  constructor(
    load: LoadTile,
    give: (part: NamedPart) => void,
    most = 1,
    fail: (key: TileKey, error: unknown, steps: number[]) => void = (_, error) => {
      throw error;
    },
  ) {
    this.load = load;
    this.give = give;
    this.most = most;
    this.fail = fail;
  }

  /** Load tiles in this order, and none that was asked for before and is not among them. */
  request(keys: TileKey[], steps: number[]): void {
    this.want(keys.map((key) => [key, steps]));
  }

  /** The same, each for steps of its own. */
  want(jobs: Job[]): void {
    this.wanted = [...jobs];
    const names = new Set(jobs.map(([key, steps]) => `${nameOf(key)} ${steps}`));
    for (const [name, controller] of this.running) if (!names.has(name)) controller.abort();
    this.next();
  }

  private next(): void {
    while (this.wanted.length && this.running.size < this.most) {
      const [key, steps] = this.wanted[0];
      this.wanted.shift();
      const name = `${nameOf(key)} ${steps}`;
      if (!this.running.has(name)) void this.run(name, key, steps);
    }
  }

  private async run(name: string, key: TileKey, steps: number[]): Promise<void> {
    const controller = new AbortController();
    this.running.set(name, controller);
    try {
      const parts = await this.load(key, steps, controller.signal);
      if (!controller.signal.aborted) parts.forEach(this.give);
    } catch (error) {
      if (!controller.signal.aborted) this.fail(key, error, steps);
    } finally {
      this.running.delete(name);
      this.next();
    }
  }
}
