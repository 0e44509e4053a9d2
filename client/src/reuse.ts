// A full picture serves for a moved view: without perspective a plane is mapped to the view by an
// affine map, so that a drag follows the pointer on any machine.

import type { mat2d as Mat2d } from "gl-matrix";
import * as mat2d from "gl-matrix/esm/mat2d.js";

/** Range of sizes, beside those it was drawn for, in which a picture's pixels serve. */
const GREATEST_GROWTH = 4;
const LEAST_GROWTH = 0.3;
/** Tolerance of rounding, as a share of the picture. */
const ROUNDING = 1e-6;

/** An affine map of a plane, as a canvas takes it; numbers of an array are doubles. */
type Affine = [number, number, number, number, number, number];

export interface Reuse {
  /** From the old picture's pixels to the new one's. */
  matrix: Affine;
  /** Whether nothing of the new picture is left out. */
  covers: boolean;
  /** Whether it is only moved, so that each pixel stays a pixel. */
  shifts: boolean;
}

const product = (a: Mat2d, b: Mat2d) => mat2d.multiply([0, 0, 0, 0, 0, 0], a, b) as Affine;
const inverse = (a: Mat2d) => mat2d.invert([0, 0, 0, 0, 0, 0], a) as Affine;

/** How the picture of one projection of a plane lies in that of another, if it serves. */
export function reused(
  before: readonly number[],
  now: readonly number[],
  width: number,
  height: number,
): Reuse | null {
  const [w, h] = [width / 2, height / 2];
  const toPixels = (m: readonly number[]) =>
    product([w, 0, 0, -h, w, h], [m[0], m[1], m[4], m[5], m[12], m[13]]);
  const matrix = product(toPixels(now), inverse(toPixels(before)));
  const area = Math.abs(mat2d.determinant(matrix));
  if (!(area > LEAST_GROWTH ** 2 && area < GREATEST_GROWTH ** 2)) return null;
  const [a, b, c, d, e, f] = inverse(matrix);
  const isInside = ([x, y]: number[]) =>
    Math.abs((a * x + c * y + e) / w - 1) < 1 + ROUNDING &&
    Math.abs((b * x + d * y + f) / h - 1) < 1 + ROUNDING;
  const covers = [[0, 0], [width, 0], [0, height], [width, height]].every(isInside);
  const [xx, xy, yx, yy] = matrix;
  const shifts = Math.abs(xx - 1) + Math.abs(yy - 1) + Math.abs(xy) + Math.abs(yx) < ROUNDING;
  if (shifts) for (const n of [4, 5]) matrix[n] = Math.round(matrix[n]);
  return { matrix, covers, shifts };
}
