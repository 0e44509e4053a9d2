// The point of the surface at a place of the view: one pixel is drawn with the nodes' coordinates.

import { atPixel, projection, type Camera } from "./camera.ts";
import { interpolated } from "./mesh.ts";
import type { Scene } from "./scene.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, dot, fromFrame, subtract, type Vector } from "./vectors.ts";

export interface Point {
  position: number[];
  /** Place between the nodes, (i, j). */
  index: [number, number];
  values: Record<string, number>;
}

/** The view in which a point is looked for. */
export interface PickContext {
  scene: Scene;
  camera: Camera;
  moment: Moment;
  anchor: Vector;
  canvas: HTMLCanvasElement;
}

/** Point at (x, y), from -1 to 1, right and up; null beside the surface. */
export function pickedPoint(context: PickContext, x: number, y: number): Point | null {
  const { scene, camera, moment, anchor, canvas } = context;
  const { graphics, header } = scene;
  const program = graphics.programs.get(header.shaders.vertex, header.shaders.pick);
  const whole = projection(header.geometry, camera, anchor);
  const matrix = atPixel(whole, [x, y], [canvas.width, canvas.height]);
  const [before, after, between] = moment;
  const bits = graphics.pixel(() => {
    graphics.programs.use(program, { u_matrix: matrix, u_between: between });
    scene.draw(before, after, anchor, false);
  });
  if (!bits[3]) return null;
  const [u, v] = new Float32Array(bits.buffer, 0, 2);
  const { rows, columns, shape } = header.geometry;
  const i = clamp(u * columns.size - 0.5 - columns.before, 0, shape[1] - 1);
  const j = clamp(v * rows.size - 0.5 - rows.before, 0, shape[0] - 1);
  const position = positionAt(context, i, j, x, y);
  return { position, index: [i, j], values: valuesAt(context, i, j) };
}

/** Single precision finds the depth; the place itself is on the ray through the pointer. */
function positionAt({ scene, camera }: PickContext, i: number, j: number, x: number, y: number) {
  const { data } = scene.part("position");
  const { shape, frame, center } = scene.header.geometry;
  const local = [0, 1, 2].map((k) => interpolated(shape, i, j, (n) => data[3 * n + k]));
  const about = add(fromFrame(frame, local), center);
  const [start, along] = camera.ray(x, y);
  const ahead = camera.axes[2];
  const depth = dot(subtract(about, start), ahead) / dot(along, ahead);
  return add(start, along, depth);
}

function valuesAt({ scene, moment }: PickContext, i: number, j: number) {
  const { header, parts } = scene;
  const { name } = header.scalars;
  const [from, to, between] = moment;
  const [before, after] = scene.scalarParts(from, to).map((part) => parts.get(part)?.data);
  if (name === null || !before || !after) return {};
  const value = (n: number) => before[n] + between * (after[n] - before[n]);
  return { [name]: interpolated(header.geometry.shape, i, j, value) };
}
