// The point of the surface at a place of the view, from the triangle that its pixel shows.

import type { Camera } from "./camera.ts";
import { interpolated, placeIn } from "./mesh.ts";
import { placeOnEarth, cornersOn } from "./onearth.ts";
import type { Layer, PlaceAt } from "./places.ts";
import { nodeAt } from "./pointpath.ts";
import type { Geometry, Header, Padding } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import { fullIndex } from "./tilechoice.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, cross, dot, fromFrame, subtract, type Vector } from "./vectors.ts";

/** Cells from the place at the middle of a pixel at most, as far as triangles are straight. */
const FARTHEST = 16;

export interface Point {
  position: number[];
  /** Place between the nodes of the whole surface, (i, j); of triangles that of `placeIn`. */
  index: [number, number];
  values: Record<string, number>;
  /** Speed, which is interpolated between time steps; else that of the velocity. */
  speed?: number;
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

/** Point at (x, y), from -1 to 1, right and up, whose pixel shows a place; `root` is the whole surface. */
export function pickedPoint(at: PlaceAt, root: Scene, camera: Camera, moment: Moment, [x, y]: [number, number]): Found {
  const { layer, coordinate, triangle } = at;
  const { geometry } = layer.scene.header;
  const near = geometry.triangles ? placeIn(triangle, ...coordinate) : placeAmong(geometry, ...coordinate);
  const ray = camera.ray(x, y);
  const beside = onRay(layer.scene, near, ray)[1];
  const [position, there] = onRay(layer.scene, beside, ray); // in the next triangle, perhaps
  const place = placeOnEarth(layer.scene, there, position, root.parts.get("lonlat"));
  const index = geometry.triangles ? place : wholeIndex(root.header, layer, place);
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
  const { pyramid, geometry, mesh, formula } = header;
  const [level, row, column] = key;
  const [rows, columns] = pyramid?.shapes[0] ?? geometry.shape;
  const side = mesh.tileCells * (pyramid?.tileBlocks ?? 0);
  // A formula has no finest level: its nodes are those of the grid in Python.
  const finer = formula ? 2 ** (pyramid?.depth ?? 0) : 1;
  const at = (n: number, tile: number, nodes: number) => fullIndex(n + tile * side, level, nodes) / finer;
  return [at(i, column, columns), at(j, row, rows)];
}

/** Where a ray meets the triangle of a place, and the place there: that of a pixel is the one at its middle. */
function onRay(scene: Scene, near: [number, number], [start, along]: [Vector, Vector]): [Vector, [number, number]] {
  const { geometry } = scene.header;
  const { data } = scene.part("position");
  const nodes = scene.cornersAt(near).map(([node]) => node);
  const [a, b, c] = nodes.map((n) => add(fromFrame(geometry.frame, [...data.subarray(3 * n, 3 * n + 3)]), geometry.center));
  const [first, second] = [subtract(b, a), subtract(c, a)];
  const normal = cross(first, second);
  const position = add(start, along, dot(normal, subtract(a, start)) / dot(normal, along));
  const way = subtract(position, a);
  const [s, t] = [cross(way, second), cross(first, way)].map((each) => dot(each, normal) / dot(normal, normal));
  if (!(Math.max(Math.abs(s), Math.abs(t)) < FARTHEST)) {
    // Seen from aside: the place itself is on the ray.
    const about = nodeAt(scene, near);
    return [add(start, along, dot(subtract(about, start), along) / dot(along, along)), near];
  }
  if (geometry.triangles) return [position, placeIn(Math.floor(near[1]), s, Math.max(t, 0))];
  const [rows, columns] = geometry.shape;
  const at = (of: (node: number) => number, count: number) => {
    const [own, one, two] = nodes.map(of);
    return clamp(own + s * (one - own) + t * (two - own), 0, count - 1);
  };
  return [position, [at((n) => n % columns, columns), at((n) => Math.floor(n / columns), rows)]];
}

/** Values of the scalars that are here, that of the colours first. */
export function valuesAt(scene: Scene, moment: Moment, place: [number, number]): Record<string, number> {
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
