// Which tiles a view asks for: flowtex/rendering/tile_choice.py in the browser.
//
// From the root down, a block is replaced by finer ones where its cells cover too many pixels, and
// where it is in view.

import type { Data, PyramidHeader, Settings } from "./protocol.ts";
import { dot, length, subtract, type Vector } from "./vectors.ts";

/** A tile: its level, and its row and column among the tiles of that level. */
export type TileKey = readonly [level: number, row: number, column: number];

/** Name of the root, which the tiles of the next level refine. */
export const ROOT = "";

/** What decides on tiles. */
export interface TileView {
  /** Where the camera is; null where all rays are parallel. */
  eye: Vector | null;
  /** Half the height of what is seen: a length where rays are parallel, else for a distance of one. */
  halfHeight: number;
  /** Height of the picture in pixels, as the settings count them. */
  pixels: number;
  /** Planes around what is seen: a point is inside where p . (x, y, z, 1) >= 0. */
  planes: readonly (readonly number[])[];
  /** Pixels of a cell above which the next level is drawn. */
  cellPixels: number;
  /** What is made of the picture; null where it is shown as it is. */
  shownOn?: Shown | null;
}

/** A picture that is shown on something else, such as a globe. */
export interface Shown {
  /** Whether a block may be in view there. */
  sees(place: Data | number[]): boolean;
  /** How many times as large as in the picture cells of a block are at most. */
  scale(place: Data | number[]): number;
}

/** What a view asks of a tile, or of the root. */
export interface Choice {
  key: TileKey;
  /** Whether some of its own cells are to be shown, and the size of the largest in pixels. */
  needed: boolean;
  pixels: number;
  /** Names of the tiles that are to be shown in place of its larger cells. */
  finer: string[];
}

/** By name, coarse ones first. */
export type Choices = Map<string, Choice>;

/** The place of a block of a level. */
export type PlaceOf = (level: number, row: number, column: number) => Data | number[];

/** Numbers of a block's place: centre, radius, and longest side of a cell. */
const PLACE = 5;

export const nameOf = (key: TileKey) => key.join("/");
export const keyOf = (name: string) => name.split("/").map(Number) as unknown as TileKey;

/** Pixels of a cell above which the next level is drawn, where streaks are no longer cut. */
export function cellPixels(pyramid: PyramidHeader, settings: Settings): number {
  const [samples, spacing, grain] = ["samples", "spacing", "grain"].map((s) => Number(settings[s]));
  const streak = 0.5 * samples * spacing * grain;
  return pyramid.cellPixels * Math.max(1, (2 * streak) / (pyramid.cellPixels * pyramid.pathCells));
}

export class Pyramid {
  readonly header: PyramidHeader;
  private readonly place: PlaceOf;

  /** `places` has those of each level, row by row, or tells them. */
  constructor(header: PyramidHeader, places: Data | PlaceOf) {
    this.header = header;
    let start = 0;
    const starts = header.blocks.map(([rows, columns]) => (start += rows * columns) - rows * columns);
    this.place =
      typeof places === "function"
        ? places
        : (level, row, column) => {
            const at = PLACE * (starts[level] + row * header.blocks[level][1] + column);
            return places.subarray(at, at + PLACE);
          };
  }

  /** First row and column of a tile's blocks among those of its level, and the rows and columns after them. */
  private blocksOf(name: string, [level, row, column]: TileKey): number[] {
    const [rows, columns] = this.header.blocks[level];
    if (name === ROOT) return [0, 0, rows, columns];
    const { tileBlocks: size } = this.header;
    const ends = [Math.min(size * (row + 1), rows), Math.min(size * (column + 1), columns)];
    return [size * row, size * column, ...ends];
  }

  /** Tiles of the next level that cover a tile, or the root. */
  private children(name: string, [level, row, column]: TileKey): TileKey[] {
    const { blocks, tileBlocks } = this.header;
    const counts = blocks[level - 1].map((n) => Math.ceil(n / tileBlocks));
    const [from, to] =
      name === ROOT
        ? [[0, 0], counts]
        : [[2 * row, 2 * column], [row, column].map((n, k) => Math.min(2 * n + 2, counts[k]))];
    const keys: TileKey[] = [];
    for (let j = from[0]; j < to[0]; j += 1) {
      for (let i = from[1]; i < to[1]; i += 1) keys.push([level - 1, j, i]);
    }
    return keys;
  }

  /** First row and column of the blocks of a tile that one of the next level covers, and their number a side. */
  finerPart([, row, column]: TileKey, above: string): [row: number, column: number, size: number] {
    const { tileBlocks } = this.header;
    const half = tileBlocks / 2;
    const [, j, i] = above === ROOT ? [0, 0, 0] : keyOf(above);
    return [half * row - tileBlocks * j, half * column - tileBlocks * i, half];
  }

  /** What a view asks of each tile of which it shows something. */
  choose(view: TileView): Choices {
    const chosen: Choices = new Map();
    const { depth, finest } = this.header;
    const waiting = [ROOT];
    for (const name of waiting) {
      const key: TileKey = name === ROOT ? [depth, 0, 0] : keyOf(name);
      const choice: Choice = { key, needed: false, pixels: 0, finer: [] };
      const [top, left, bottom, right] = this.blocksOf(name, key);
      const width = this.header.blocks[key[0]][1];
      const coarse = new Set<number>();
      for (let j = top; j < bottom; j += 1) {
        for (let i = left; i < right; i += 1) {
          const place = this.place(key[0], j, i);
          if (!isSeen(view, place) || view.shownOn?.sees(place) === false) continue;
          const pixels = cellSize(view, place) * (view.shownOn?.scale(place) ?? 1);
          if (key[0] > finest && pixels > view.cellPixels) coarse.add(j * width + i);
          else choice.needed = true;
          if (!coarse.has(j * width + i)) choice.pixels = Math.max(choice.pixels, pixels);
        }
      }
      if (coarse.size) {
        choice.finer = this.children(name, key)
          .filter((child) => {
            const [row, column, size] = this.finerPart(child, ROOT);
            return [...coarse].some((block) => {
              const [j, i] = [Math.floor(block / width) - row, (block % width) - column];
              return j >= 0 && j < size && i >= 0 && i < size;
            });
          })
          .map(nameOf);
      }
      chosen.set(name, choice);
      waiting.push(...choice.finer);
    }
    return chosen;
  }
}

export function isSeen({ planes }: Pick<TileView, "planes">, [x, y, z, radius]: Data | number[]): boolean {
  return planes.every((p) => dot(p, [x, y, z]) + p[3] >= -radius * length(p.slice(0, 3)));
}

/** Greatest size of the cells of a block in pixels. */
export function cellSize({ eye, halfHeight, pixels }: Omit<TileView, "planes" | "cellPixels">, [x, y, z, radius, size]: Data | number[]): number {
  const away = eye ? Math.max(length(subtract([x, y, z], eye)) - radius, size) : 1;
  return (size * 0.5 * pixels) / (halfHeight * away);
}

/** Names of the tiles of which something is to be shown, those of the largest cells first. */
export function wantedTiles(chosen: Choices): string[] {
  const wanted = [...chosen].filter(([name, { needed }]) => name !== ROOT && needed);
  return wanted.sort(([, a], [, b]) => b.pixels - a.pixels).map(([name]) => name);
}

/**
 * The tiles to show of those that are ready, and the ones that cover parts of each. A tile is replaced by
 * finer ones where these cover all of it that is in view; until then the tiles of a coarser level
 * are shown. The root is always ready.
 */
export function cover(chosen: Choices, ready: (name: string) => boolean): Map<string, string[]> {
  const shown = new Map<string, string[]>();
  const hide = (name: string) => {
    shown.delete(name);
    chosen.get(name)?.finer.forEach(hide);
  };
  /** Have a tile shown, by itself or by finer ones, if it can be. */
  const covered = (name: string): boolean => {
    const { needed = false, finer = [] } = chosen.get(name) ?? {};
    const done = finer.filter(covered);
    if (name !== ROOT && !needed && done.length === finer.length) return true;
    if (name !== ROOT && !ready(name)) {
      done.forEach(hide);
      return false;
    }
    shown.set(name, done);
    return true;
  };
  covered(ROOT);
  return shown;
}

/** Where a line of nodes of a level, or a place between two, lies among those of level 0. */
export function fullIndex(place: number, level: number, nodes: number): number {
  const line = (n: number) => Math.min(n * 2 ** level, nodes - 1);
  const low = Math.floor(place);
  return line(low) + (place - low) * (line(low + 1) - line(low));
}

/** Where a place among the lines of level 0 lies among those of a level. */
export function levelIndex(place: number, level: number, nodes: number): number {
  const step = 2 ** level;
  const low = Math.max(Math.min(Math.floor(place / step), Math.ceil((nodes - 1) / step) - 1), 0);
  return low + (place - low * step) / (Math.min((low + 1) * step, nodes - 1) - low * step);
}
