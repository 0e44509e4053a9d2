// The point of the surface at a place of the view: one pixel is drawn with the nodes' coordinates.

import { atPixel, projection, type Camera } from "./camera.ts";
import { interpolated, type Corners } from "./mesh.ts";
import { placeOnEarth, cornersOn } from "./onearth.ts";
import type { Geometry, Header, Padding } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import { fullIndex } from "./tilechoice.ts";
import type { Layer } from "./tiles.ts";
import { placeIn } from "./trianglemesh.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, dot, fromFrame, subtract, type Vector } from "./vectors.ts";

export interface Point {
  position: number[];
  /** Place between the nodes of the whole surface, (i, j); of triangles that of `placeIn`. */
  index: [number, number];
  values: Record<string, number>;
  /** Velocity on the Earth, to the east and to the north. */
  eastNorth?: [number, number];
  /** The kind of the critical point that is marked here, if any. */
  mark?: string;
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
  const [program] = layers[0].scene.pickers;
  const whole = projection(header.geometry, camera, anchor);
  const matrix = atPixel(whole, [x, y], [canvas.width, canvas.height]);
  const [before, after, between] = moment;
  const bits = graphics.numbers(() => {
    layers[0].scene.bodies.hide(matrix, anchor);
    layers.forEach(({ scene }, n) => {
      graphics.programs.use(program, { u_matrix: matrix, u_between: between, u_part: n });
      scene.draw(before, after, anchor, false);
    });
  });
  if (!bits[3]) return null;
  const [u, v] = new Float32Array(bits.buffer, 0, 2);
  const layer = layers[bits[2]];
  const { geometry } = layer.scene.header;
  const near = geometry.triangles ? placeIn(bits[3] - 1, u, v) : placeAmong(geometry, u, v);
  const position = positionAt(layer.scene, camera, layer.scene.cornersAt(near), x, y);
  const place = placeOnEarth(layer.scene, near, position, layers[0].scene.parts.get("lonlat"));
  const index = geometry.triangles ? place : wholeIndex(header, layer, place);
  return { point: { position, index, values: valuesAt(layer.scene, moment, place) }, layer, place };
}

/** Place between the nodes at a coordinate of the slices. */
function placeAmong({ rows, columns, shape }: Geometry, u: number, v: number): [number, number] {
  const at = (share: number, { size, before }: Padding, nodes: number) =>
    clamp(share * size - 0.5 - before, 0, nodes - 1);
  return [at(u, columns, shape[1]), at(v, rows, shape[0])];
}

/** Place between the nodes of the whole surface, of one in a layer. */
function wholeIndex(header: Header, { key }: Layer, [i, j]: [number, number]): [number, number] {
  const { pyramid, geometry, mesh } = header;
  const [level, row, column] = key;
  const [rows, columns] = pyramid?.shapes[0] ?? geometry.shape;
  const side = mesh.tileCells * (pyramid?.tileBlocks ?? 0);
  const at = (n: number, tile: number, nodes: number) => fullIndex(n + tile * side, level, nodes);
  return [at(i, column, columns), at(j, row, rows)];
}

/** Single precision finds the depth; the place itself is on the ray through the pointer. */
function positionAt(scene: Scene, camera: Camera, corners: Corners, x: number, y: number) {
  const { data } = scene.part("position");
  const { frame, center } = scene.header.geometry;
  const local = [0, 1, 2].map((k) => interpolated(corners, (n) => data[3 * n + k]));
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
  place: [number, number],
): Record<string, number> {
  const { header, parts } = scene;
  const { scalars, geometry } = header;
  const corners = cornersOn(scene, place);
  const cell = geometry.triangles ? Math.floor(place[1]) : corners[0][0];
  const [from, to, between] = moment;
  const values: Record<string, number> = {};
  const others = scalars.choices.map((choice, number) => ({ ...choice, number }));
  for (const each of [scalars, ...others]) {
    const names = scene.scalarParts(from, to, each);
    const [before, after] = names.map((part) => parts.get(part)?.data);
    if (each.name === null || each.name in values || !before || !after) continue;
    const value = (n: number) => before[n] + between * (after[n] - before[n]);
    values[each.name] = each.flat ? value(cell) : interpolated(corners, value);
  }
  return values;
}
