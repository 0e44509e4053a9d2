// The point of the surface at a place of the view: one pixel is drawn with the nodes' coordinates.

import { atPixel, projection } from "./camera.ts";
import { interpolated } from "./mesh.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, dot, fromFrame, subtract } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

export interface Point {
  position: number[];
  /** Place between the nodes, (i, j). */
  index: [number, number];
  values: Record<string, number>;
}

/** Point at (x, y), from -1 to 1, right and up; null beside the surface. */
export function pickedPoint(viewer: Viewer, x: number, y: number): Point | null {
  const { header, graphics, camera, scene, shown } = viewer;
  if (!header || !camera || !scene || !shown || !viewer.canPick) return null;
  const program = graphics.programs.get(header.shaders.vertex, header.shaders.pick);
  const { anchor } = viewer.view(shown, 1);
  const { width, height } = viewer.canvas;
  const matrix = atPixel(projection(header.geometry, camera, anchor), [x, y], [width, height]);
  const bits = graphics.pixel(() => {
    graphics.programs.use(program, { u_matrix: matrix, u_between: shown[2] });
    scene.draw(shown[0], shown[1], anchor, false);
  });
  if (!bits[3]) return null;
  const [u, v] = new Float32Array(bits.buffer, 0, 2);
  const { rows, columns, shape } = header.geometry;
  const i = clamp(u * columns.size - 0.5 - columns.before, 0, shape[1] - 1);
  const j = clamp(v * rows.size - 0.5 - rows.before, 0, shape[0] - 1);
  return { position: positionAt(viewer, i, j, x, y), index: [i, j], values: valuesAt(viewer, i, j, shown) };
}

/** Single precision finds the depth; the place itself is on the ray through the pointer. */
function positionAt(viewer: Viewer, i: number, j: number, x: number, y: number): number[] {
  const { header, camera, parts } = viewer;
  const nodes = parts.get("position")?.data;
  if (!header || !camera || !nodes) return [NaN, NaN, NaN];
  const { shape, frame, center } = header.geometry;
  const local = [0, 1, 2].map((k) => interpolated(shape, i, j, (n) => nodes[3 * n + k]));
  const about = add(fromFrame(frame, local), center);
  const [start, along] = camera.ray(x, y);
  const ahead = camera.axes[2];
  const depth = dot(subtract(about, start), ahead) / dot(along, ahead);
  return add(start, along, depth);
}

function valuesAt(viewer: Viewer, i: number, j: number, shown: Moment): Record<string, number> {
  const { header, scene, parts } = viewer;
  const name = header?.scalars.name ?? null;
  if (!header || !scene || name === null) return {};
  const [before, after] = scene.scalarParts(shown[0], shown[1]).map((n) => parts.get(n)?.data);
  if (!before || !after) return {};
  const value = (n: number) => before[n] + shown[2] * (after[n] - before[n]);
  return { [name]: interpolated(header.geometry.shape, i, j, value) };
}
