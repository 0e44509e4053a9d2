// The point of the surface at a place of the view: one pixel is drawn with the nodes' coordinates.

import { atPixel, projection, type Camera } from "./camera.ts";
import { interpolated } from "./mesh.ts";
import type { Scene } from "./scene.ts";
import { fullIndex } from "./tilechoice.ts";
import type { Layer } from "./tiles.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, dot, fromFrame, subtract, type Vector } from "./vectors.ts";

export interface Point {
  position: number[];
  /** Place between the nodes of the whole surface, (i, j). */
  index: [number, number];
  values: Record<string, number>;
}

/** A point, and where it was found. */
export interface Found {
  point: Point;
  layer: Layer;
  /** Place between the nodes of the layer, (i, j). */
  place: [number, number];
}

/** The view in which a point is looked for. */
export interface PickContext {
  /** What is drawn; the whole, or the root and the tiles of a large surface. */
  layers: Layer[];
  camera: Camera;
  moment: Moment;
  anchor: Vector;
  canvas: HTMLCanvasElement;
}

/** Point at (x, y), from -1 to 1, right and up; null beside the surface. */
export function pickedPoint(context: PickContext, x: number, y: number): Found | null {
  const { layers, camera, moment, anchor, canvas } = context;
  const { graphics, header } = layers[0].scene;
  const program = graphics.programs.get(header.shaders.vertex, header.shaders.pick);
  const whole = projection(header.geometry, camera, anchor);
  const matrix = atPixel(whole, [x, y], [canvas.width, canvas.height]);
  const [before, after, between] = moment;
  const bits = graphics.pixel(() => {
    layers.forEach(({ scene }, n) => {
      graphics.programs.use(program, { u_matrix: matrix, u_between: between, u_part: n });
      scene.draw(before, after, anchor, false);
    });
  });
  if (!bits[3]) return null;
  const [u, v] = new Float32Array(bits.buffer, 0, 2);
  const layer = layers[bits[2]];
  const { scene, key } = layer;
  const { rows, columns, shape } = scene.header.geometry;
  const i = clamp(u * columns.size - 0.5 - columns.before, 0, shape[1] - 1);
  const j = clamp(v * rows.size - 0.5 - rows.before, 0, shape[0] - 1);
  const position = positionAt(scene, camera, [i, j], x, y);
  const full = header.pyramid?.shapes[0] ?? shape;
  const side = header.mesh.tileCells * (header.pyramid?.tileBlocks ?? 0);
  const [level, row, column] = key;
  const place = (n: number, tile: number, axis: number) =>
    fullIndex(n + tile * side, level, full[axis]);
  const index: [number, number] = [place(i, column, 1), place(j, row, 0)];
  const point = { position, index, values: valuesAt(scene, moment, [i, j]) };
  return { point, layer, place: [i, j] };
}

/** Single precision finds the depth; the place itself is on the ray through the pointer. */
function positionAt(scene: Scene, camera: Camera, [i, j]: number[], x: number, y: number) {
  const { data } = scene.part("position");
  const { shape, frame, center } = scene.header.geometry;
  const local = [0, 1, 2].map((k) => interpolated(shape, i, j, (n) => data[3 * n + k]));
  const about = add(fromFrame(frame, local), center);
  const [start, along] = camera.ray(x, y);
  const ahead = camera.axes[2];
  const depth = dot(subtract(about, start), ahead) / dot(along, ahead);
  return add(start, along, depth);
}

/** Values of the scalars that are here, that of the colours first. */
export function valuesAt(
  scene: Scene,
  moment: Moment,
  [i, j]: [number, number],
): Record<string, number> {
  const { header, parts } = scene;
  const { scalars, geometry } = header;
  const [from, to, between] = moment;
  const values: Record<string, number> = {};
  const others = scalars.choices.map(({ name, steps }, number) => ({ name, steps, number }));
  for (const each of [scalars, ...others]) {
    const names = scene.scalarParts(from, to, each);
    const [before, after] = names.map((part) => parts.get(part)?.data);
    if (each.name === null || each.name in values || !before || !after) continue;
    const value = (n: number) => before[n] + between * (after[n] - before[n]);
    values[each.name] = interpolated(geometry.shape, i, j, value);
  }
  return values;
}
