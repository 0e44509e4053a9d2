// How a flow on a Mercator map lies on a web map, and the camera that sees of it what that shows.
//
// Places of the web map are from 0 to 1, from west to east and from north to south.

import type { CameraState } from "./camera.ts";
import { globeSight, type GlobeCamera, type GlobeSight } from "./globesight.ts";
import type { Earth, Header, Part } from "./protocol.ts";
import type { Shown } from "./tilechoice.ts";
import { clamp, dot, type Vector } from "./vectors.ts";

/** Difference of places, as a share of the map, that counts as none. */
const NEAR = 1e-5;
/** Latitude at which a web map ends. */
const LAST_LATITUDE = (Math.atan(Math.sinh(Math.PI)) * 180) / Math.PI;
const RADIANS = Math.PI / 180;
/** Angle from below of a ray that meets the map far beyond all that is to be seen. */
const STEEPEST = 88 * RADIANS;
const REMEDY = 'export it with projection="mercator"';

export type Place = [x: number, y: number];

/** What a web map shows: its middle, pixels of the page, zoom, and degrees. */
export interface MapLook {
  center: { lng: number; lat: number };
  width: number;
  height: number;
  zoom: number;
  bearing: number;
  pitch: number;
  fov: number;
  /** Whether it is drawn as a globe. */
  globe: boolean;
}

/** A picture of the flow: what sees it, and its pixels of the page. */
export interface FlowLook {
  state: CameraState;
  width: number;
  height: number;
  /** The globe on which it is shown. */
  shownOn?: Shown;
}

/** Place of a longitude and latitude on the web map. */
export function placeOn({ lng, lat }: { lng: number; lat: number }): Place {
  const sine = Math.sin(clamp(lat, -LAST_LATITUDE, LAST_LATITUDE) * RADIANS);
  return [lng / 360 + 0.5, 0.5 - Math.atanh(sine) / (2 * Math.PI)];
}

/** How many times as large as at the equator a map shows a latitude, or a globe with the map's scale in its middle. */
export function mapScale(lat: number): number {
  return 1 / Math.cos(clamp(lat, -LAST_LATITUDE, LAST_LATITUDE) * RADIANS);
}

/** The linear mapping between positions of a flow and places of the web map. */
export class Mercator {
  /** Place of the position 0, and the change of a place with a position. */
  readonly origin: Place;
  readonly slope: Place;
  /** Least and greatest position. */
  readonly box: readonly number[];

  /** `ends` are those along x of a map around the Earth. */
  constructor(earth: Earth | null, lonLat: Part | undefined, ends?: Header["ends"]) {
    const map = earth?.map;
    if (!map || !lonLat) throw new Error(`the flow is not on a map; ${REMEDY}`);
    const [west, east] = ends ?? [map[0], map[2]];
    this.box = [west, map[1], east, map[3]];
    const [rows, columns] = lonLat.shape;
    const at = (j: number, i: number) => {
      const [x, y, z] = lonLat.data.subarray(3 * (j * columns + i));
      const place = placeOn({ lng: Math.atan2(y, x) / RADIANS, lat: Math.asin(z / Math.hypot(x, y, z)) / RADIANS });
      const position = [map[0] + ((map[2] - map[0]) * i) / (columns - 1), map[1] + ((map[3] - map[1]) * j) / (rows - 1)];
      return { place, position };
    };
    // Beside the edges, where a longitude might be that of the other side.
    const [first, middle, last] = [at(1, 1), at(rows >> 1, columns >> 1), at(rows - 2, columns - 2)];
    const turned = (x: number) => x + Math.ceil(first.place[0] - x);
    const span = [turned(last.place[0]) - first.place[0], last.place[1] - first.place[1]];
    this.slope = [0, 1].map((k) => span[k] / (last.position[k] - first.position[k])) as Place;
    this.origin = [0, 1].map((k) => first.place[k] - this.slope[k] * first.position[k]) as Place;
    const [x, y] = this.placeOf(middle.position);
    const isNear = Math.abs(x - turned(middle.place[0])) < NEAR && Math.abs(y - middle.place[1]) < NEAR;
    if (!isNear) throw new Error(`the flow is on another map; ${REMEDY}`);
    if (!ends) return;
    // The ends meet at a place, which single precision would miss by many metres.
    this.slope = [1 / (east - west), -1 / (east - west)];
    const place = [turned(middle.place[0]), middle.place[1]];
    this.origin = [0, 1].map((k) => place[k] - this.slope[k] * middle.position[k]) as Place;
  }

  placeOf(position: readonly number[]): Place {
    return [0, 1].map((k) => this.origin[k] + this.slope[k] * position[k]) as Place;
  }

  lngLatOf(position: readonly number[]): [lng: number, lat: number] {
    const [x, y] = this.placeOf(position);
    return [360 * (x - 0.5), Math.atan(Math.sinh(2 * Math.PI * (0.5 - y))) / RADIANS];
  }

  /** Position of a place, on that side of the Earth where the middle of the flow is. */
  positionOf(place: Place): Place {
    const [x, y] = place.map((p, k) => (p - this.origin[k]) / this.slope[k]);
    const turn = 1 / this.slope[0];
    return [x + turn * Math.round((0.5 * (this.box[0] + this.box[2]) - x) / turn), y];
  }

  /**
   * What sees of the flow, at a height, what a map shows: once, or twice where the map shows both of its ends and not
   * all that is between them.
   */
  look(map: MapLook, z: number): FlowLook[] {
    const unit = 1 / (512 * 2 ** map.zoom * this.slope[0]);
    const [x, y] = this.positionOf(placeOn(map.center));
    const [low, , high] = this.box;
    const other = x + (x < 0.5 * (low + high) ? 1 : -1) / this.slope[0];
    if (map.globe) return this.globeLooks(map, unit, [x, other, z]);
    const whole = this.wholeLook(map, unit, [x, y, z]);
    if (whole) return [whole];
    const looks = [this.flatLook(map, unit, [x, y, z])];
    const inside = 0.5 * unit * Math.min(map.width, map.height);
    const isWhole = x - inside <= low && x + inside >= high;
    const reach = unit * farthest(map);
    if (!isWhole && Math.abs(other - clamp(other, low, high)) < reach) looks.push(this.flatLook(map, unit, [other, y, z]));
    return looks;
  }

  /** Whether the data are around the Earth. */
  private get isAround(): boolean {
    const [low, , high] = this.box;
    return Math.abs((high - low) * this.slope[0] - 1) < NEAR;
  }

  /** What is seen of a globe; all of data around the Earth where that is less than two pictures. */
  private globeLooks(map: MapLook, unit: number, [x, other, z]: number[]): FlowLook[] {
    const sight = globeSight(globeCamera(map, 1 / (unit * this.slope[0])));
    const [low, , high] = this.box;
    const reach = (0.5 * sight.aside) / (Math.PI * this.slope[0]);
    const isWhole = x - reach <= low && x + reach >= high;
    const hasOther = !isWhole && Math.abs(other - clamp(other, low, high)) < reach;
    if (hasOther && this.isAround && 4 * reach >= high - low) {
      return [this.globeLook(map, unit, { ...sight, aside: Math.PI }, [0.5 * (low + high), z])];
    }
    const middles = hasOther ? [x, other] : [x];
    return middles.map((middle) => this.globeLook(map, unit, sight, [middle, z]));
  }

  /** All of data around the Earth, where a map shows both of their ends and copies beyond; else null. */
  private wholeLook(map: MapLook, unit: number, [x, y, z]: number[]): FlowLook | null {
    const [low, , high] = this.box;
    if (!this.isAround || map.pitch > 0) return null;
    const reach = unit * farthest(map);
    if (x - reach > low || x + reach < high) return null;
    let { height } = map;
    if (map.bearing) height = (2 * reach) / unit;
    const width = (high - low) / unit;
    return this.flatLook({ ...map, width, height, bearing: 0 }, unit, [0.5 * (low + high), y, z]);
  }

  private flatLook({ width, height, bearing, pitch, fov }: MapLook, unit: number, [x, y, z]: number[]): FlowLook {
    const [b, p] = [bearing * RADIANS, pitch * RADIANS];
    const half = 0.5 * height * unit;
    const away = half / Math.tan(0.5 * fov * RADIANS);
    const state = {
      position: [x - away * Math.sin(p) * Math.sin(b), y - away * Math.sin(p) * Math.cos(b), z + away * Math.cos(p)],
      focal_point: [x, y, z],
      up: [Math.sin(b), Math.cos(b), 0],
      parallel: pitch === 0,
      parallel_scale: half,
      view_angle: fov,
    };
    return { state, width, height };
  }

  /** The part of the map that is seen of a globe, from straight above and at the scale of its middle. */
  private globeLook(map: MapLook, unit: number, sight: GlobeSight, [x, z]: number[]): FlowLook {
    const world = 1 / (unit * this.slope[0]);
    const [south, north] = [sight.south, sight.north].map((end) => placeOn({ lng: 0, lat: end / RADIANS })[1]);
    const y = (0.5 * (south + north) - this.origin[1]) / this.slope[1];
    const [wide, high] = [sight.aside / Math.PI, south - north];
    const state = {
      position: [x, y, z + 1 / this.slope[0]],
      focal_point: [x, y, z],
      up: [0, 1, 0],
      parallel: true,
      parallel_scale: (0.5 * high) / this.slope[0],
      view_angle: map.fov,
    };
    const shownOn = new OnGlobe(this, map.center, sight.seen);
    return { state, width: wide * world, height: high * world, shownOn };
  }
}

/** The camera of a globe, on which a web map of a width in pixels has the scale of its middle. */
function globeCamera({ center, width, height, bearing, pitch, fov }: MapLook, world: number): GlobeCamera {
  const radius = (world * mapScale(center.lat)) / (2 * Math.PI);
  return {
    latitude: center.lat * RADIANS,
    bearing: bearing * RADIANS,
    pitch: pitch * RADIANS,
    away: (0.5 * height) / Math.tan(0.5 * fov * RADIANS) / radius,
    half: [(0.5 * width) / radius, (0.5 * height) / radius],
  };
}

/** A picture of the map on a globe, whose cells become smaller towards the poles. */
class OnGlobe implements Shown {
  private readonly mercator: Mercator;
  private readonly middle: Vector;
  private readonly cosine: number;
  private readonly seen: number;

  /** The globe shows what is within an angle from its middle. */
  constructor(mercator: Mercator, { lng, lat }: MapLook["center"], seen: number) {
    this.mercator = mercator;
    this.middle = wayTo(lng, lat);
    this.cosine = 1 / mapScale(lat);
    this.seen = seen;
  }

  sees(place: ArrayLike<number>): boolean {
    const [x, y, , radius] = Array.from(place);
    const away = Math.acos(clamp(dot(wayTo(...this.mercator.lngLatOf([x, y])), this.middle), -1, 1));
    // A length on the map is shorter on the Earth.
    return away <= this.seen + this.angle(radius);
  }

  /** The picture has no more pixels than the map at its middle. */
  scale(place: ArrayLike<number>): number {
    const [, y, , radius] = Array.from(place);
    const fromEquator = Math.abs(2 * Math.PI * (this.mercator.placeOf([0, y])[1] - 0.5));
    const least = Math.max(fromEquator - this.angle(radius), 0);
    return Math.min(1 / Math.cosh(least) / this.cosine, 1);
  }

  /** Angle at the equator of a length on the map. */
  private angle(length: number): number {
    return 2 * Math.PI * this.mercator.slope[0] * length;
  }
}

/** Unit vector to a longitude and latitude, in degrees. */
function wayTo(lng: number, lat: number): Vector {
  const across = Math.cos(lat * RADIANS);
  return [across * Math.cos(lng * RADIANS), across * Math.sin(lng * RADIANS), Math.sin(lat * RADIANS)];
}

/** Pixels from the middle of a map to the farthest corner that is seen, in its plane. */
function farthest({ width, height, pitch, fov }: MapLook): number {
  const [tilt, half] = [pitch * RADIANS, 0.5 * fov * RADIANS];
  const top = tilt + half;
  if (top > STEEPEST) return Infinity;
  const away = (0.5 * height) / Math.tan(half);
  const ahead = away * Math.cos(tilt) * (Math.tan(top) - Math.tan(tilt));
  return Math.hypot(ahead, (0.5 * width * Math.cos(tilt) * Math.cos(half)) / Math.cos(top));
}
