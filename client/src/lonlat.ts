// Longitude and latitude of places, and dates, as people read them.

import type { Dates, Earth, Part } from "./protocol.ts";
import { clamp } from "./vectors.ts";

const DEGREES = 180 / Math.PI;
/** Decimals of a degree: at least, and at most, which is some 10 m. */
const FEWEST_DECIMALS = 2;
const MOST_DECIMALS = 4;
/** Share of a map's width over which directions are taken. */
const NEAR = 1e-4;
const DAY_S = 86_400;

/** Weights of four places in a row, at 0 to 3, at a place between them: those of a cubic. */
function weights(t: number): number[] {
  const [a, b, c] = [t - 1, t - 2, t - 3];
  return [-(a * b * c) / 6, (t * b * c) / 2, -(t * a * c) / 2, (t * a * b) / 6];
}

/** The four places around one of `count` that are spread from 0 to 1, and their weights. */
function around(share: number, count: number): [first: number, weights: number[]] {
  const at = share * (count - 1);
  const first = clamp(Math.floor(at) - 1, 0, count - 4);
  return [first, weights(at - first)];
}

/** Way from the middle of the Earth to a place of a flat map. */
function wayOn([x0, y0, x1, y1]: number[], { data, shape }: Part, position: readonly number[]) {
  const [rows, columns] = shape;
  const [i, across] = around((position[0] - x0) / (x1 - x0), columns);
  const [j, upward] = around((position[1] - y0) / (y1 - y0), rows);
  const way = [0, 0, 0];
  upward.forEach((v, n) => {
    across.forEach((u, m) => {
      for (let k = 0; k < 3; k += 1) way[k] += u * v * data[3 * ((j + n) * columns + i + m) + k];
    });
  });
  return way;
}

/** Longitude and latitude in degrees of a position; null where they are not known. */
export function lonLatOf(
  earth: Earth,
  position: readonly number[],
  places: Part | undefined,
): [number, number] | null {
  if (earth.map && !places) return null;
  const [x, y, z] = earth.map && places ? wayOn(earth.map, places, position) : position;
  const lonLat: [number, number] = [Math.atan2(y, x), Math.atan2(z, Math.hypot(x, y))];
  return lonLat.every(Number.isFinite) ? [lonLat[0] * DEGREES, lonLat[1] * DEGREES] : null;
}

/** Components on the Earth, to the east and to the north, of a velocity at a position. */
export function eastNorth(
  earth: Earth,
  position: readonly number[],
  velocity: readonly number[],
  places: Part | undefined,
): [number, number] {
  let [from, change] = [position, velocity];
  if (earth.map && places) {
    // What moves on the map moves on the Earth: the change of the way there, in a short time.
    const { map, radius } = earth;
    const time = (NEAR * (map[2] - map[0])) / (Math.hypot(...velocity) || 1);
    const [before, after] = [-time, time].map((t) =>
      wayOn(map, places, position.map((p, k) => p + t * velocity[k])),
    );
    from = wayOn(map, places, position);
    change = after.map((way, k) => (radius * (way - before[k])) / (2 * time));
  }
  const [x, y, z] = from;
  const [across, away] = [Math.hypot(x, y) || 1, Math.hypot(x, y, z) || 1];
  const east = (x * change[1] - y * change[0]) / across;
  const outward = (x * change[0] + y * change[1]) / across;
  return [east, (across * change[2] - z * outward) / away];
}

/** Such as 12.35° E, 45.20° N, with enough decimals to distinguish positions this many degrees apart. */
export function lonLatText([lon, lat]: [number, number], apart: number): string {
  const decimals = clamp(Math.ceil(-Math.log10(apart)), FEWEST_DECIMALS, MOST_DECIMALS);
  const told = (degrees: number, [before, after]: string) => {
    return `${Math.abs(degrees).toFixed(decimals)}° ${degrees < 0 ? before : after}`;
  };
  return `${told(lon, "WE")}, ${told(lat, "SN")}`;
}

/** The date of a time in seconds, as date_text in flowtex/field/dates.py writes it; null where it has none. */
export function dateText({ start, dates, step }: Dates, times: readonly number[], time: number) {
  if (start === null) {
    if (!dates.length) return null;
    // A calendar of its own: the step that is nearest.
    const apart = times.map((each) => Math.abs(each - time));
    return dates[apart.indexOf(Math.min(...apart))];
  }
  const first = Date.parse(`${start}Z`);
  const isMidnight = first % (1000 * DAY_S) === 0;
  const text = new Date(first + 1000 * time).toISOString();
  if (isMidnight && step % DAY_S === 0 && time % DAY_S === 0) return text.slice(0, 10);
  return text.slice(0, step >= 60 ? 16 : 19).replace("T", " ");
}
