// Vectors of three numbers in double precision: gl-matrix, with results in new arrays.

import type { mat3 as Mat3, mat4 as Mat4, ReadonlyVec3 } from "gl-matrix";
// The modules themselves: of the whole library a bundle would hold every function.
import * as mat3 from "gl-matrix/esm/mat3.js";
import * as mat4 from "gl-matrix/esm/mat4.js";
import * as vec3 from "gl-matrix/esm/vec3.js";

export type Vector = [number, number, number];
type Like = ReadonlyVec3 | readonly number[];

/** The type of gl-matrix for numbers that are counted on to be three. */
const v = (a: Like) => a as ReadonlyVec3;
/** Results are arrays of numbers, which are doubles; the library's own would be of single precision. */
const result = () => [0, 0, 0] as Vector;
const zeros = (n: number) => new Array<number>(n).fill(0);

export const dot = (a: Like, b: Like): number => vec3.dot(v(a), v(b));
export const length = (a: Like): number => vec3.length(v(a));
export const subtract = (a: Like, b: Like) => vec3.subtract(result(), v(a), v(b)) as Vector;
export const scale = (a: Like, by: number) => vec3.scale(result(), v(a), by) as Vector;
export const cross = (a: Like, b: Like) => vec3.cross(result(), v(a), v(b)) as Vector;
export const unit = (a: Like) => vec3.normalize(result(), v(a)) as Vector;

/** a + t b */
export const add = (a: Like, b: Like, t = 1) => vec3.scaleAndAdd(result(), v(a), v(b), t) as Vector;

export function rotated(a: Like, axis: Like, degrees: number): Vector {
  const turn = mat4.fromRotation(zeros(16) as Mat4, (degrees * Math.PI) / 180, v(axis));
  return turn === null ? result() : (vec3.transformMat4(result(), v(a), turn) as Vector);
}

/** A vector of the mesh in the surface's frame, whose matrix is in rows. */
export function toFrame(frame: readonly number[], a: Like): Vector {
  const columns = mat3.transpose(zeros(9) as Mat3, frame as Mat3);
  return vec3.transformMat3(result(), v(a), columns) as Vector;
}

export function fromFrame(frame: readonly number[], a: Like): Vector {
  return vec3.transformMat3(result(), v(a), frame as Mat3) as Vector;
}

export function clamp(x: number, low: number, high: number): number {
  return Math.min(Math.max(x, low), high);
}
