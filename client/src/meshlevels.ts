// Triangles of a surface, as many as a view needs: flowtex/rendering/mesh_levels.py in the browser.
//
// Python sends the errors of each tile at each level; the client chooses the levels for a view and
// makes the triangles. Along the border of two tiles the finer one moves its extra nodes to those
// of the coarser one, so that no crack opens.

import type { Data, MeshLimits } from "./protocol.ts";
import { length, subtract, type Vector } from "./vectors.ts";

/** What is seen: the eye, or null where all rays are parallel, and half the height of the view. */
export interface Sight {
  eye: Vector | null;
  /** A length where all rays are parallel, else that for a distance of one. */
  halfHeight: number;
  /** Height of the picture in pixels. */
  pixels: number;
}

/** Numbers of a tile beside its errors: middle, radius and size of a cell. */
const PLACE = 5;

/** First node and number of cells of a tile along one axis. */
interface Tile {
  first: number;
  cells: number;
}

function tilesOf(nodes: number, size: number): Tile[] {
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
   * Of each tile: errors of the positions at each level, infinite where it does not serve; those of
   * the colours, as shares of the colour map; and middle, radius and size of a cell.
   */
  tiles: Data;
  /** Cells that are drawn; all of them where there is none. */
  cells?: Data;
}

export class MeshLevels {
  private readonly mesh: MeshData;
  private readonly limits: MeshLimits;
  private readonly rows: Tile[];
  private readonly columns: Tile[];

  constructor(mesh: MeshData, limits: MeshLimits) {
    this.mesh = mesh;
    this.limits = limits;
    this.rows = tilesOf(mesh.shape[0], limits.tileCells);
    this.columns = tilesOf(mesh.shape[1], limits.tileCells);
  }

  /** Level of each tile, row by row; 0 has every node. */
  levels({ eye, halfHeight, pixels }: Sight): Uint8Array {
    const { limits } = this;
    const { tiles } = this.mesh;
    const count = this.rows.length * this.columns.length;
    const size = tiles.length / count;
    const last = (size - PLACE) / 2 - 1;
    return Uint8Array.from({ length: count }, (_, tile) => {
      const record = tiles.subarray(size * tile, size * (tile + 1));
      const [x, y, z, radius, cell] = record.subarray(size - PLACE);
      const near = limits.leastDistance * radius;
      const away = eye ? Math.max(length(subtract(eye, [x, y, z])) - radius, near) : 1;
      const scale = (0.5 * pixels) / (halfHeight * Math.max(away, Number.MIN_VALUE));
      let level = 0;
      for (; level < last; level += 1) {
        const error = record[level + 1];
        const colourError = record[last + 2 + level];
        const side = cell * scale * 2 ** (level + 1);
        const exact =
          error * scale <= limits.maxErrorPixels && colourError <= limits.maxColourError;
        const fits = exact || (Number.isFinite(error) && side <= 1);
        if (!fits || side > limits.maxSideHeights * pixels) break;
      }
      return level;
    });
  }

  /** Nodes of the triangles, numbered row by row. */
  triangles(levels: Uint8Array): Uint32Array {
    const index: number[] = [];
    this.rows.forEach((_, j) => this.columns.forEach((__, i) => this.add(index, levels, j, i)));
    return Uint32Array.from(index);
  }

  private add(index: number[], levels: Uint8Array, j: number, i: number): void {
    const { rows, columns, limits } = this;
    const { shape, cells } = this.mesh;
    const step = 1 << levels[j * columns.length + i];
    const count = limits.tileCells / step + 1;
    const [row, column] = [rows[j], columns[i]];
    const along = (length: number) =>
      Array.from({ length: count }, (_, n) => Math.min(n * step, length));
    const [y, x] = [along(row.cells), along(column.cells)];
    const border = (dj: number, di: number) => 1 << this.coarser(levels, j, i, dj, di);
    const snapped = (place: number, length: number, coarse: number) =>
      place === length ? place : Math.floor(place / coarse) * coarse;
    const [below, above, left, right] = [border(-1, 0), border(1, 0), border(0, -1), border(0, 1)];
    const node = (b: number, a: number) => {
      const [inX, inY] = [a > 0 && a < count - 1, b > 0 && b < count - 1];
      const px = inY ? x[a] : snapped(x[a], column.cells, b === 0 ? below : above);
      const py = inX ? y[b] : snapped(y[b], row.cells, a === 0 ? left : right);
      return (row.first + py) * shape[1] + column.first + px;
    };
    for (let b = 0; b < count - 1; b += 1) {
      const cellRow = Math.min(row.first + y[b], shape[0] - 2) * (shape[1] - 1);
      for (let a = 0; a < count - 1; a += 1) {
        if (cells && !cells[cellRow + Math.min(column.first + x[a], shape[1] - 2)]) continue;
        const [p, q, r, s] = [node(b, a), node(b, a + 1), node(b + 1, a + 1), node(b + 1, a)];
        if (p !== q && q !== r && p !== r) index.push(p, q, r);
        if (p !== r && r !== s && p !== s) index.push(p, r, s);
      }
    }
  }

  /** Level of a border of a tile: the coarser one of both tiles. */
  private coarser(levels: Uint8Array, j: number, i: number, dj: number, di: number): number {
    const { rows, columns } = this;
    const { periodic } = this.mesh;
    const own = levels[j * columns.length + i];
    let [row, column] = [j + dj, i + di];
    if (periodic[0]) row = (row + rows.length) % rows.length;
    if (periodic[1]) column = (column + columns.length) % columns.length;
    const outside = row < 0 || row >= rows.length || column < 0 || column >= columns.length;
    return outside ? own : Math.max(own, levels[row * columns.length + column]);
  }
}
