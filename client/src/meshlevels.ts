// Which blocks of a surface are drawn for a view, and from how many of their nodes: flowtex/rendering/mesh_levels.py
// describes blocks. Fragments find their place between all nodes, so triangles need only be of about a pixel.

import type { Camera } from "./camera.ts";
import type { Data, Geometry, Part } from "./protocol.ts";
import { cellSize, isSeen } from "./tilechoice.ts";
import { add, dot, subtract, type Vector } from "./vectors.ts";

/** Greatest side of a triangle in pixels where nodes are left out. */
const MOST_SIDE_PX = 3;
/** Numbers of a block's place: centre, radius, and longest side of a cell. */
const PLACE = 5;

/** Blocks as rows, columns and size, in blocks of a scene. */
export type Covered = readonly [row: number, column: number, size: number];

/** What of a surface is drawn. */
export interface Seen {
  /** Doublings of the nodes of each block, row by row; -1 where it is not drawn. */
  levels: Int8Array;
  /** Left, lower, right and upper side of what is drawn in the view, from -1 to 1. */
  box: number[];
}

/** Most doublings of the nodes of each block: none where some have no position. */
export function mostDoublings({ shape, triangles }: Geometry, blocks: Part, positions: Data, cells: number): Int8Array {
  const [rows, columns] = blocks.shape;
  const most = new Int8Array(rows * columns).fill(triangles ? 0 : Math.log2(cells));
  for (let n = 0; n < positions.length; n += 3) {
    if (Number.isFinite(positions[n])) continue;
    const [j, i] = [Math.floor(n / 3 / shape[1]), (n / 3) % shape[1]];
    for (const row of [Math.floor((j - 1) / cells), Math.floor(j / cells)]) {
      for (const column of [Math.floor((i - 1) / cells), Math.floor(i / cells)]) {
        if (row >= 0 && row < rows && column >= 0 && column < columns) most[row * columns + column] = 0;
      }
    }
  }
  return most;
}

/** Blocks that are seen in a picture of so many rows of pixels, and not covered by others. */
export function seenBlocks(
  { shape, data }: Part,
  camera: Camera,
  pixels: number,
  covered: readonly Covered[],
  most: Int8Array,
): Seen {
  const [rows, columns] = shape;
  const sight = { ...camera.sight(pixels), planes: camera.planes };
  const levels = new Int8Array(rows * columns).fill(-1);
  const box = [1, 1, -1, -1];
  for (let block = 0; block < levels.length; block += 1) {
    const [row, column] = [Math.floor(block / columns), block % columns];
    const place = data.subarray(PLACE * block, PLACE * (block + 1));
    const isCovered = covered.some(([j, i, n]) => row >= j && row < j + n && column >= i && column < i + n);
    if (isCovered || !isSeen(sight, place)) continue;
    const level = Math.floor(Math.log2(MOST_SIDE_PX / cellSize(sight, place)));
    levels[block] = Math.min(Math.max(level, 0), most[block]);
    boundsOf(camera, place).forEach((side, n) => (box[n] = n < 2 ? Math.min(box[n], side) : Math.max(box[n], side)));
  }
  return { levels, box };
}

/** Sides of a ball in the view, about. */
function boundsOf(camera: Camera, [x, y, z, radius]: Data | number[]): number[] {
  const [right, up, ahead] = camera.axes;
  const { parallel, position, focal_point: focus } = camera.state;
  const way = subtract([x, y, z], parallel ? focus : position);
  const ends = [-radius, radius].map((by) => camera.at(add([x, y, z] as Vector, ahead, by)).height);
  if (!(ends[0] > 0)) return [-1, -1, 1, 1];
  const [low, high] = [-radius, radius].map((by) =>
    [dot(way, right) / camera.aspect, dot(way, up)].map((at, axis) =>
      ends.map((height) => (at + by / (axis ? 1 : camera.aspect)) / height),
    ),
  );
  return [...low.map((each) => Math.min(...each)), ...high.map((each) => Math.max(...each))];
}
