// A full picture serves for a moved view: without perspective a plane is mapped to the view by an
// affine map, so that a drag follows the hand on any machine.

/** Range of sizes, beside those it was drawn for, in which a picture's pixels serve. */
const GREATEST_GROWTH = 4;
const LEAST_GROWTH = 0.3;
/** What is less than this is a matter of rounding. */
const ROUNDING = 1e-6;

export type Affine = [number, number, number, number, number, number];

export interface Reuse {
  /** From the old picture's pixels to the new one's, as a canvas takes it. */
  matrix: Affine;
  /** Whether nothing of the new picture is left out. */
  covers: boolean;
  /** Whether it is only moved, so that each pixel stays a pixel. */
  shifts: boolean;
}

/** How the picture of one projection of a plane lies in that of another, if it serves. */
export function reused(
  before: readonly number[],
  now: readonly number[],
  width: number,
  height: number,
): Reuse | null {
  const size = before[0] * before[5] - before[4] * before[1];
  // Rows of now * before^-1, from -1 to 1 in both pictures.
  const a = (now[0] * before[5] - now[4] * before[1]) / size;
  const b = (now[4] * before[0] - now[0] * before[4]) / size;
  const c = (now[1] * before[5] - now[5] * before[1]) / size;
  const d = (now[5] * before[0] - now[1] * before[4]) / size;
  const determinant = a * d - b * c;
  const area = Math.abs(determinant);
  if (!(area > LEAST_GROWTH ** 2 && area < GREATEST_GROWTH ** 2)) return null;
  const e = now[12] - a * before[12] - b * before[13];
  const f = now[13] - c * before[12] - d * before[13];
  const [w, h] = [width / 2, height / 2];
  const matrix: Affine = [
    a,
    (-c * h) / w,
    (-b * w) / h,
    d,
    w * (1 + e - a + b),
    h * (1 - f + c - d),
  ];
  const isInside = ([x, y]: [number, number]) =>
    Math.abs((d * (x - e) - b * (y - f)) / determinant) < 1 + ROUNDING &&
    Math.abs((a * (y - f) - c * (x - e)) / determinant) < 1 + ROUNDING;
  const corners: [number, number][] = [
    [-1, -1],
    [1, -1],
    [-1, 1],
    [1, 1],
  ];
  const covers = corners.every(isInside);
  const shifts = Math.abs(a - 1) + Math.abs(d - 1) + Math.abs(b) + Math.abs(c) < ROUNDING;
  if (shifts) for (const n of [4, 5]) matrix[n] = Math.round(matrix[n]);
  return { matrix, covers, shifts };
}
