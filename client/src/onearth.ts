// Places and velocities on the Earth, which do not depend on the map, the zoom, or the triangles that are drawn: they
// are bilinear in longitude and latitude, as flowtex/field/locate.py has them.

import { eastNorth, lonLatOf } from "./lonlat.ts";
import type { Corners } from "./mesh.ts";
import { nodeAt, stepsAround, velocityAt, type PathPlace } from "./pointpath.ts";
import type { Part } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import { clamp } from "./vectors.ts";

/** Cells that are tried for a place, and the share of a cell by which it may lie beside one. */
const MOST_CELLS = 8;
const ROUNDING = 1e-6;
/** How far a cell is from a parallelogram, as a share of its size. */
const SKEW = 1e-3;
/** Latitude from which on the longitude of a node is not known. */
const POLE_LATITUDE = 89.99;

type Place = [i: number, j: number];
type LonLats = Part | undefined;

const turned = (lon: number) => lon - 360 * Math.round(lon / 360);

function cornersOf([i, j]: Place): Place[] {
  return [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]];
}

function cellOf({ header }: Scene, place: Place): Place {
  return place.map((at, axis) => clamp(Math.floor(at), 0, header.geometry.shape[1 - axis] - 2)) as Place;
}

/** Shares of the corners of a cell. */
const sharesOf = ([s, t]: number[]) => [(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t];

/** Shares of a cell, along i and along j, at a longitude and latitude; null where it is no parallelogram of these. */
function sharesIn(scene: Scene, cell: Place, [lon, lat]: Place, places: LonLats): Place | null {
  const { earth } = scene.header;
  const known = cornersOf(cell).map((node) => earth && lonLatOf(earth, nodeAt(scene, node), places));
  if (known.some((each) => !each || Math.abs(each[1]) > POLE_LATITUDE)) return null;
  const [a, b, c, d] = (known as Place[]).map((each): Place => [turned(each[0] - lon), each[1] - lat]);
  const [first, second] = [b, c].map((each): Place => [each[0] - a[0], each[1] - a[1]]);
  const size = Math.max(...[...first, ...second].map(Math.abs));
  const area = first[0] * second[1] - first[1] * second[0];
  if (!area || [0, 1].some((k) => Math.abs(a[k] - b[k] - c[k] + d[k]) > SKEW * size)) return null;
  return [(a[1] * second[0] - a[0] * second[1]) / area, (a[0] * first[1] - a[1] * first[0]) / area];
}

/** The place (i, j) between the nodes at a position, near another place; that one where it is not known better. */
export function placeOnEarth(scene: Scene, near: Place, position: readonly number[], places: LonLats): Place {
  const { earth, geometry } = scene.header;
  const lonLat = earth && !geometry.triangles && lonLatOf(earth, position, places);
  if (!lonLat) return near;
  let cell = cellOf(scene, near);
  for (let n = 0; n < MOST_CELLS; n += 1) {
    const shares = sharesIn(scene, cell, lonLat, places);
    if (!shares) return near;
    const beyond = shares.map((share) => (Math.abs(share - 0.5) > 0.5 + ROUNDING ? share : 0));
    const beside = cellOf(scene, cell.map((first, k) => first + beyond[k]) as Place);
    if (String(beside) === String(cell)) return cell.map((at, k) => at + clamp(shares[k], 0, 1)) as Place;
    cell = beside;
  }
  return near;
}

/** The nodes around a place, and their shares: on the Earth those of the cell, else of a triangle. */
export function cornersOn(scene: Scene, place: Place): Corners {
  const { earth, geometry } = scene.header;
  if (!earth || geometry.triangles) return scene.cornersAt(place);
  const cell = cellOf(scene, place);
  const shares = sharesOf(place.map((at, k) => at - cell[k]));
  return cornersOf(cell).map(([i, j], n) => [j * geometry.shape[1] + i, shares[n]]);
}

/** Velocity on the Earth, to the east and to the north, at a place; null elsewhere than there. */
export function velocityOnEarth(at: PathPlace, places: LonLats): [east: number, north: number] | null {
  const { scene, place, position } = at;
  const { earth, geometry } = scene.header;
  const lonLat = earth && lonLatOf(earth, position, places);
  if (!lonLat) return null;
  const componentsAt = (each: PathPlace) => eastNorth(earth, each.position, velocityAt(each), places);
  const cell = cellOf(scene, place);
  if (geometry.triangles || !sharesIn(scene, cell, lonLat, places)) return componentsAt(at);
  const shares = sharesOf(place.map((each, k) => each - cell[k]));
  const corners = cornersOf(cell).map((node) => componentsAt({ ...at, place: node, position: nodeAt(scene, node) }));
  return [0, 1].map((k) => corners.reduce((sum, each, n) => sum + shares[n] * each[k], 0)) as Place;
}

/** Speed at a place, on the Earth where that is known; between two time steps the mean of those at both, as in colours. */
export function speedAt(at: PathPlace, places: LonLats): number {
  let speed = 0;
  for (const [moment, share] of stepsAround(at.moment)) {
    const then = { ...at, moment };
    if (share) speed += share * Math.hypot(...(velocityOnEarth(then, places) ?? velocityAt(then)));
  }
  return speed;
}
