// One view of a scene, or two beside each other that move together.

import { dom } from "./dom.ts";
import type { Header, NamedPart } from "./protocol.ts";
import type { Options } from "./options.ts";
import type { StoreError } from "./store.ts";
import { nameOf, type TileKey } from "./tilechoice.ts";
import { TileQueue, type LoadTile } from "./tilequeue.ts";
import { Viewer } from "./viewer.ts";

/** Tiles and time steps that are loaded at once from a source, and steps that are wanted at a time. */
const TILES_AT_ONCE = 6;
const STEPS_AT_ONCE = 2;
const STEPS_WANTED = 4;
/** Stands for the whole among the tiles. */
const WHOLE: TileKey = [0, 0, 0];
/** Memory that tiles from a source may take, in bytes. */
const MEMORY = 180e6;

/** Where what is not there yet comes from; errors are for everybody to read. */
export interface Source {
  /** Parts of a tile that are not there yet, of a moment. */
  tile(
    key: TileKey,
    steps: number[],
    signal: AbortSignal,
    has: (part: string) => boolean,
  ): Promise<NamedPart[]>;
  /** Parts of the whole at a time step, of those that are lacking. */
  root(step: number, signal: AbortSignal, lacking: () => string[]): Promise<NamedPart[]>;
  /** Fails where there is nothing that belongs to the view. */
  open(): Promise<void>;
}

/** A scene that is there as a whole. */
export interface SceneData {
  header: Header;
  parts: NamedPart[];
  /** Gives the tiles of a large surface. */
  loadTile?: LoadTile;
  /** Gives these and the time steps, where they are not there. */
  source?: Source;
}

/** Viewers in an element; `own` gives what each has for itself, and the first has the bar. */
export function viewersIn(
  element: HTMLElement,
  count: number,
  options: Options,
  own: (n: number) => Options = () => ({}),
): Viewer[] {
  if (count < 2) return [new Viewer(element, { ...options, ...own(0) })];
  const pair = dom("div", { class: "flowtex-pair" });
  pair.style.cssText = "display: flex; gap: 2px; width: 100%; height: 100%";
  element.append(pair);
  const viewers: Viewer[] = [];
  for (let n = 0; n < count; n += 1) {
    const cell = dom("div");
    cell.style.cssText = "flex: 1 1 0; min-width: 0; height: 100%";
    pair.append(cell);
    const others = () => viewers.filter((_, m) => m !== n);
    const follower = n ? { controls: false, follows: viewers[0] } : {};
    viewers.push(new Viewer(cell, { ...options, ...own(n), ...linked(options, others), ...follower }));
  }
  for (const viewer of viewers) viewer.together = viewers;
  return viewers;
}

/** Callbacks that report to the other views and to the host. */
function linked(options: Options, others: () => Viewer[]): Options {
  const both =
    <T extends unknown[]>(
      follow: (other: Viewer, ...values: T) => void,
      report?: (...values: T) => void,
    ) =>
    (...values: T) => {
      for (const other of others()) follow(other, ...values);
      report?.(...values);
    };
  return {
    onCamera: both((other, camera) => other.setCamera(camera), options.onCamera),
    onTime: both((other, time) => other.setTime(time), options.onTime),
    onClock: both((other, clock) => other.setClock(clock), options.onClock),
    onSetting: both((other, name, value) => other.followSetting(name, value), options.onSetting),
  };
}

/** What a view asks of a source. */
function sourceFeed(source: Source, viewer: () => Viewer): Options {
  const give = (part: NamedPart) => viewer().setPart(part);
  const fail = (error: unknown, tile?: string, steps?: number[]) => {
    const { fault, message = String(error), detail } = error as Partial<StoreError>;
    console.warn(message, detail ?? "");
    // Where nobody answers it is tried again.
    viewer().lack(message, fault === "unreachable" ? undefined : tile, steps);
  };
  const tiles = new TileQueue(
    (key, steps, signal) =>
      source.tile(key, steps, signal, (part) => viewer().tiles?.has(nameOf(key), part) ?? false),
    give,
    TILES_AT_ONCE,
    (key, error, steps) => fail(error, nameOf(key), steps),
  );
  const wholes = new TileQueue(
    (_, [step], signal) => source.root(step, signal, () => viewer().scene?.missing(step, step) ?? []),
    give,
    STEPS_AT_ONCE,
    (_, error) => fail(error),
  );
  let wanted: number[] = [];
  return {
    memory: MEMORY,
    onTiles: (keys, steps) => tiles.request(keys, steps),
    onNeed: (step) => {
      wanted = [step, ...wanted.filter((other) => other !== step)].slice(0, STEPS_WANTED);
      wholes.want(wanted.map((each) => [WHOLE, [each]]));
    },
  };
}

/** Show scenes that are there as a whole, beside each other; gives the first view. */
export function mountPage(
  element: HTMLElement,
  scenes: SceneData[],
  options: Options = {},
): Viewer {
  const feeds = scenes.map(({ loadTile, source }, n): Options => {
    const viewer = () => viewers[n];
    if (source) return sourceFeed(source, viewer);
    const queue = loadTile && new TileQueue(loadTile, (part) => viewer().setPart(part));
    return { onTiles: (keys, steps) => queue?.request(keys, steps) };
  });
  const viewers = viewersIn(element, scenes.length, options, (n) => feeds[n]);
  scenes.forEach(({ header }, n) => viewers[n].setHeader(header));
  scenes.forEach(({ parts }, n) => parts.forEach((part) => viewers[n].setPart(part)));
  // What is wrong with a source is told before anybody looks closer.
  scenes[0].source?.open().catch((error: Error) => viewers[0].lack(error.message));
  return viewers[0];
}
