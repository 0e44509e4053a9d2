// What a perspective camera sees of a globe: the part between its horizon and the edges of the picture.
//
// The globe has radius 1. Vectors are along the east, the north and the vertical of its middle, which the camera looks
// at.

import { add, dot, length, scale, unit, type Vector } from "./vectors.ts";

/** Rays along each edge of a picture. */
const EDGE_RAYS = 64;
/** Share by which what is seen is taken larger, for what lies between two of those rays. */
const WIDER = 0.02;
const RIGHT_ANGLE = Math.PI / 2;

/** A camera above a globe: latitude of the middle and the other angles in radians, and lengths in radii. */
export interface GlobeCamera {
  latitude: number;
  bearing: number;
  pitch: number;
  /** Distance of the camera from the middle. */
  away: number;
  /** Half the width and height of what is seen at that distance. */
  half: readonly [number, number];
}

/** Angles in radians: the greatest from the middle, latitudes, and the greatest difference of longitude. */
export interface GlobeSight {
  seen: number;
  south: number;
  north: number;
  aside: number;
}

/** The part of a globe that a camera sees, or a little more. */
export function globeSight(camera: GlobeCamera): GlobeSight {
  const view = frameOf(camera);
  const ways = edgePoints(camera.half).map((at) => seenAlong(view, at));
  const places = ways.map((way) => placeOf(way, camera.latitude));
  const latitudes = places.map(([latitude]) => latitude);
  const sight = {
    seen: Math.max(...ways.map((way) => Math.acos(Math.min(way[2], 1)))),
    south: Math.min(...latitudes),
    north: Math.max(...latitudes),
    aside: Math.max(...places.map(([, longitude]) => Math.abs(longitude))),
  };
  const margin = WIDER * sight.seen;
  const isNorthSeen = isInView(view, camera, 1) || sight.north + margin > RIGHT_ANGLE;
  const isSouthSeen = isInView(view, camera, -1) || sight.south - margin < -RIGHT_ANGLE;
  sight.seen += margin;
  sight.north = isNorthSeen ? RIGHT_ANGLE : sight.north + margin;
  sight.south = isSouthSeen ? -RIGHT_ANGLE : sight.south - margin;
  // Around a pole all longitudes are.
  sight.aside = isNorthSeen || isSouthSeen ? Math.PI : Math.min((1 + WIDER) * sight.aside, Math.PI);
  return sight;
}

/** The camera's position from the centre of the globe, and its axes. */
interface Frame {
  eye: Vector;
  look: Vector;
  right: Vector;
  up: Vector;
}

function frameOf({ bearing, pitch, away }: GlobeCamera): Frame {
  const ahead: Vector = [Math.sin(bearing), Math.cos(bearing), 0];
  const look = add(scale(ahead, Math.sin(pitch)), [0, 0, -Math.cos(pitch)]);
  const up = add(scale(ahead, Math.cos(pitch)), [0, 0, Math.sin(pitch)]);
  const eye = add([0, 0, 1], look, -away);
  // Scaled as a point of the picture is, whose plane goes through the middle.
  return { eye, look: scale(look, away), right: [ahead[1], -ahead[0], 0], up };
}

/** Points around a picture, by their ways to the right and up. */
function edgePoints([width, height]: readonly [number, number]): [number, number][] {
  const points: [number, number][] = [];
  for (let n = 0; n <= EDGE_RAYS; n += 1) {
    const along = (2 * n) / EDGE_RAYS - 1;
    points.push([along * width, height], [along * width, -height], [width, along * height], [-width, along * height]);
  }
  return points;
}

/** Where a ray meets the globe; of one that misses it, the point of the horizon that is next to it. */
function seenAlong({ eye, look, right, up }: Frame, [x, y]: [number, number]): Vector {
  const ray = unit(add(add(look, right, x), up, y));
  const nearest = -dot(eye, ray);
  const depth = nearest ** 2 - dot(eye, eye) + 1;
  if (depth > 0 && nearest > 0) return add(eye, ray, nearest - Math.sqrt(depth));
  const cosine = 1 / length(eye);
  const outward = unit(eye);
  const across = unit(add(ray, outward, -dot(ray, outward)));
  return add(scale(outward, cosine), across, Math.sqrt(1 - cosine ** 2));
}

/** Latitude of a point, and its longitude from that of the middle. */
function placeOf([east, north, upward]: Vector, middle: number): [latitude: number, longitude: number] {
  const toPole = upward * Math.sin(middle) + north * Math.cos(middle);
  const out = upward * Math.cos(middle) - north * Math.sin(middle);
  return [Math.asin(Math.min(Math.max(toPole, -1), 1)), Math.atan2(east, out)];
}

/** Whether a pole is in view, that of the north (1) or of the south (-1), or nearly so. */
function isInView({ eye, look, right, up }: Frame, { latitude, away, half }: GlobeCamera, sign: number): boolean {
  const pole: Vector = [0, sign * Math.cos(latitude), sign * Math.sin(latitude)];
  const isOverHorizon = dot(pole, eye) >= 1 - WIDER;
  const toPole = add(pole, eye, -1);
  const depth = dot(toPole, look) / away ** 2;
  const most = (1 + WIDER) * depth;
  return isOverHorizon && Math.abs(dot(toPole, right)) <= most * half[0] && Math.abs(dot(toPole, up)) <= most * half[1];
}
