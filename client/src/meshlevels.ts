// Triangles of a surface, as many as a view needs: flowtex/rendering/mesh_levels.py in the browser.
//
// Python sends the errors of each block at each level; the client chooses the levels for a view and
// makes the triangles. Along the border of two blocks the finer one moves its extra nodes to those
// of the coarser one, so that no crack opens, also where both belong to tiles of different levels.

import type { Data, MeshLimits } from "./protocol.ts";
import { clamp, length, subtract, type Vector } from "./vectors.ts";

/** What is seen: the eye, or null where all rays are parallel, and half the height of the view. */
export interface Sight {
  eye: Vector | null;
  /** A length where all rays are parallel, else that for a distance of one. */
  halfHeight: number;
  /** Height of the picture in pixels. */
  pixels: number;
}

/** Numbers of a block beside its errors: middle, radius and size of a cell. */
const PLACE = 5;

/** First node and number of cells of a block along one axis. */
interface Block {
  first: number;
  cells: number;
}

function blocksOf(nodes: number, size: number): Block[] {
  const count = Math.max(Math.ceil((nodes - 1) / size), 1);
  return Array.from({ length: count }, (_, n) => ({
    first: n * size,
    cells: Math.min(nodes - 1 - n * size, size),
  }));
}

/** What Python sends of a mesh. */
export interface MeshData {
  /** Rows and columns of nodes. */
  shape: [number, number];
  /** Whether the first line of nodes lies where the last one does, along j and i. */
  periodic: [boolean, boolean];
  /**
   * Of each block: errors of the positions at each level, infinite where it does not serve; and middle,
   * radius and size of a cell.
   */
  blocks: Data;
  /** Cells that are drawn; all of them if it is missing. */
  cells?: Data;
}

export class MeshLevels {
  private readonly mesh: MeshData;
  private readonly limits: MeshLimits;
  private readonly rows: Block[];
  private readonly columns: Block[];

  constructor(mesh: MeshData, limits: MeshLimits) {
    this.mesh = mesh;
    this.limits = limits;
    this.rows = blocksOf(mesh.shape[0], limits.tileCells);
    this.columns = blocksOf(mesh.shape[1], limits.tileCells);
  }

  /** Rows and columns of blocks. */
  get shape(): [number, number] {
    return [this.rows.length, this.columns.length];
  }

  /** Level of each block, row by row; 0 has every node. */
  levels({ eye, halfHeight, pixels }: Sight): Int8Array {
    const { limits } = this;
    const { blocks } = this.mesh;
    const count = this.rows.length * this.columns.length;
    const size = blocks.length / count;
    const last = size - PLACE - 1;
    return Int8Array.from({ length: count }, (_, block) => {
      const record = blocks.subarray(size * block, size * (block + 1));
      const [x, y, z, radius, cell] = record.subarray(size - PLACE);
      const near = limits.leastDistance * radius;
      const away = eye ? Math.max(length(subtract(eye, [x, y, z])) - radius, near) : 1;
      const scale = (0.5 * pixels) / (halfHeight * Math.max(away, Number.MIN_VALUE));
      let level = 0;
      for (; level < last; level += 1) {
        const error = record[level + 1];
        const side = cell * scale * 2 ** (level + 1);
        const fits = error * scale <= limits.maxErrorPixels || (Number.isFinite(error) && side <= 1);
        if (!fits || side > limits.maxSideHeights * pixels) break;
      }
      return level;
    });
  }

  /**
   * Nodes of the triangles, numbered row by row, of blocks whose level is not -1; `joins` has the levels
   * of their borders, as `join` gives them.
   */
  triangles(levels: Int8Array, joins: Int8Array): Uint32Array {
    const sizes = Array.from(levels, (level) => (level < 0 ? 0 : this.limits.tileCells >> level));
    const index = new Uint32Array(6 * sizes.reduce((sum, size) => sum + size * size, 0));
    let end = 0;
    levels.forEach((level, block) => {
      if (level >= 0) end = this.add(index, end, level, joins, block);
    });
    return index.slice(0, end);
  }

  /** Write the triangles of a block from a place on; gives the end of them. */
  private add(index: Uint32Array, start: number, level: number, joins: Int8Array, block: number) {
    const { rows, columns, limits } = this;
    const { shape, cells } = this.mesh;
    const step = 1 << level;
    const count = limits.tileCells / step + 1;
    const row = rows[Math.floor(block / columns.length)];
    const column = columns[block % columns.length];
    const [below, above, left, right] = [0, 1, 2, 3].map((side) => joins[4 * block + side]);
    const snapped = (place: number, size: number, border: number) =>
      place === size ? place : (place >> border) << border;
    const nodes = new Uint32Array(count * count);
    for (let b = 0; b < count; b += 1) {
      const y = Math.min(b * step, row.cells);
      for (let a = 0; a < count; a += 1) {
        let [px, py] = [Math.min(a * step, column.cells), y];
        if (b === 0 || b === count - 1) px = snapped(px, column.cells, b ? above : below);
        if (a === 0 || a === count - 1) py = snapped(py, row.cells, a ? right : left);
        nodes[b * count + a] = (row.first + py) * shape[1] + column.first + px;
      }
    }
    let end = start;
    const put = (p: number, q: number, r: number) => {
      if (p === q || q === r || p === r) return;
      index[end++] = p;
      index[end++] = q;
      index[end++] = r;
    };
    for (let b = 0; b < count - 1; b += 1) {
      const y = Math.min(row.first + Math.min(b * step, row.cells), shape[0] - 2);
      for (let a = 0; a < count - 1; a += 1) {
        const x = Math.min(column.first + Math.min(a * step, column.cells), shape[1] - 2);
        if (cells && !cells[y * (shape[1] - 1) + x]) continue;
        const at = b * count + a;
        const [p, q, r, s] = [nodes[at], nodes[at + 1], nodes[at + count + 1], nodes[at + count]];
        put(p, q, r);
        put(p, r, s);
      }
    }
    return end;
  }
}

/** Where a part of a surface lies among the blocks of its finest nodes, and how it is drawn. */
export interface Region {
  /** It begins at block (row, column), and its nodes are every 2^step-th. */
  step: number;
  row: number;
  column: number;
  /** Rows and columns of its own blocks, each of which covers 2^step of the finest ones along a side. */
  shape: readonly [number, number];
  /** Levels of its blocks; -1 where another part covers them. */
  levels: Int8Array;
}

/** More doublings than there are. */
const NOT_DRAWN = 99;

/** Levels of the lines between the finest blocks: below each row of them, or to the left of each column. */
class Lines {
  readonly values: Int16Array;
  /** From one line to the next, and along a line. */
  readonly strides: [number, number];
  readonly count: number;
  readonly width: number;

  constructor([rows, columns]: readonly [number, number], axis: number) {
    [this.count, this.width] = axis ? [columns + 1, rows] : [rows + 1, columns];
    this.strides = axis ? [1, columns + 1] : [columns, 1];
    this.values = new Int16Array(this.count * this.width);
  }

  at(line: number, along: number): number {
    return line * this.strides[0] + along * this.strides[1];
  }

  /** A line that is first and last at the same time. */
  close(): void {
    for (let n = 0; n < this.width; n += 1) {
      const [first, last] = [this.at(0, n), this.at(this.count - 1, n)];
      const most = Math.max(this.values[first], this.values[last]);
      this.values[first] = this.values[last] = most;
    }
  }
}

/** Call with each finest block that a part's own blocks cover, and the number of the own one. */
function eachBlock(
  { step, row, column, shape }: Region,
  [rows, columns]: readonly [number, number],
  call: (block: number, own: number) => void,
): void {
  const bottom = Math.min(row + (shape[0] << step), rows);
  const right = Math.min(column + (shape[1] << step), columns);
  for (let j = row; j < bottom; j += 1) {
    const own = ((j - row) >> step) * shape[1];
    for (let i = column; i < right; i += 1) call(j * columns + i, own + ((i - column) >> step));
  }
}

/** Least doublings of the nodes of each block and those beside it. */
function finestAround(
  nodes: Int16Array,
  [rows, columns]: readonly [number, number],
  periodic: readonly [boolean, boolean],
): Int16Array {
  const around = (n: number, by: number, count: number, closed: boolean) =>
    closed ? (n + by + count) % count : clamp(n + by, 0, count - 1);
  return nodes.map((own, block) => {
    const [j, i] = [Math.floor(block / columns), block % columns];
    let least = own;
    for (const by of [-1, 1]) {
      const row = around(j, by, rows, periodic[0]);
      const column = around(i, by, columns, periodic[1]);
      least = Math.min(least, nodes[row * columns + i], nodes[j * columns + column]);
    }
    return least;
  });
}

/**
 * Levels of the borders of each part's blocks: below, above, left and right of each, so that no crack
 * opens. Levels of the parts are made finer in place, where a neighbour is so much finer that its corner
 * would lie inside of a side. `blocks` are the rows and columns of blocks of the finest nodes.
 */
export function join(
  parts: readonly Region[],
  blocks: readonly [number, number],
  periodic: readonly [boolean, boolean],
  most: number,
): Int8Array[] {
  const nodes = new Int16Array(blocks[0] * blocks[1]).fill(NOT_DRAWN);
  const put = (target: Int16Array, part: Region, value: (level: number) => number) =>
    eachBlock(part, blocks, (block, own) => {
      if (part.levels[own] >= 0) target[block] = value(part.levels[own]);
    });
  for (const part of parts) put(nodes, part, () => part.step);
  const finest = finestAround(nodes, blocks, periodic);
  const strides = new Int16Array(nodes.length);
  for (const part of parts) {
    const { levels, step } = part;
    eachBlock(part, blocks, (block, own) => {
      levels[own] = Math.min(levels[own], finest[block] + most - step);
    });
    put(strides, part, (level) => level + step);
  }
  const lines = [new Lines(blocks, 0), new Lines(blocks, 1)];
  strides.forEach((stride, block) => {
    const [j, i] = [Math.floor(block / blocks[1]), block % blocks[1]];
    [[j, i], [i, j]].forEach(([line, along], axis) => {
      const { values } = lines[axis];
      for (const far of [0, 1]) {
        const at = lines[axis].at(line + far, along);
        values[at] = Math.max(values[at], stride);
      }
    });
  });
  for (;;) {
    lines.forEach((line, axis) => periodic[axis] && line.close());
    const joined = parts.map((part) => bordersOf(part, lines));
    if (!joined.some(([, changed]) => changed)) return joined.map(([borders]) => borders);
  }
}

/** Give each side of a part its coarsest level; returns whether any changed. */
function bordersOf({ step, row, column, shape, levels }: Region, lines: Lines[]) {
  const size = 1 << step;
  const borders = new Int8Array(4 * levels.length);
  let changed = false;
  for (const side of [0, 1, 2, 3]) {
    const [axis, far] = [side >> 1, side & 1];
    const line = lines[axis];
    const { values } = line;
    levels.forEach((level, own) => {
      const place = [Math.floor(own / shape[1]), own % shape[1]];
      const [first, start] = axis ? [column, row] : [row, column];
      const pick = Math.min(first + (place[axis] + far) * size, line.count - 1);
      const from = start + place[1 - axis] * size;
      const end = Math.max(Math.min(from + size, line.width), from + 1);
      let coarsest = 0;
      for (let n = from; n < end; n += 1) coarsest = Math.max(coarsest, values[line.at(pick, n)]);
      borders[4 * own + side] = coarsest - step;
      if (level < 0) return;
      for (let n = from; n < end; n += 1) {
        changed ||= values[line.at(pick, n)] !== coarsest;
        values[line.at(pick, n)] = coarsest;
      }
    });
  }
  return [borders, changed] as const;
}
