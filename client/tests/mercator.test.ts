// How flows on Mercator maps lie on a web map: against the formulas of the projection.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Camera, type CameraLimits } from "../src/camera.ts";
import { Mercator, placeOn, type MapLook } from "../src/mercator.ts";
import type { Earth, Part, PyramidHeader } from "../src/protocol.ts";
import { keyOf, Pyramid, wantedTiles, type TileKey } from "../src/tilechoice.ts";

const RADIUS = 6.4e6;
const DEGREE = Math.PI / 180;

const northing = (lat: number) => RADIUS * Math.asinh(Math.tan(lat * DEGREE));

/** A map around a longitude, with the ways to its places; `latitude` is that of a northing. */
function mapAround(
  middle: number,
  half: number,
  lats: [number, number],
  latitude = (y: number) => Math.atan(Math.sinh(y / RADIUS)),
): [Earth, Part] {
  const x = RADIUS * half * DEGREE;
  const box = [-x, northing(lats[0]), x, northing(lats[1])];
  const shape = [17, 33, 3];
  const data = new Float32Array(shape[0] * shape[1] * 3);
  for (let n = 0; n < shape[0] * shape[1]; n += 1) {
    const [j, i] = [Math.floor(n / shape[1]), n % shape[1]];
    const lon = middle * DEGREE + (box[0] + ((box[2] - box[0]) * i) / 32) / RADIUS;
    const lat = latitude(box[1] + ((box[3] - box[1]) * j) / 16);
    data.set([Math.cos(lat) * Math.cos(lon), Math.cos(lat) * Math.sin(lon), Math.sin(lat)], 3 * n);
  }
  return [{ map: box } as Earth, { data, shape, digest: "" }];
}

const near = (a: readonly number[], b: readonly number[], tolerance: number) => {
  assert.equal(a.length, b.length);
  a.forEach((value, k) => assert.ok(Math.abs(value - b[k]) < tolerance, `${String(a)} is not ${String(b)}`));
};

const LOOK: MapLook = {
  center: { lng: 0, lat: 0 },
  width: 600,
  height: 400,
  zoom: 2,
  bearing: 0,
  pitch: 0,
  fov: 36.87,
  globe: false,
};

test("places and positions are those of the projection, around the whole Earth too", () => {
  for (const [middle, half] of [[-20, 40], [180, 180], [10, 180]]) {
    const mercator = new Mercator(...mapAround(middle, half, [-70, 80]));
    const position = [0.3 * RADIUS, northing(35)];
    const lng = middle + 0.3 / DEGREE;
    near(mercator.lngLatOf(position), [lng, 35], 1e-4);
    near(mercator.positionOf(placeOn({ lng, lat: 35 })), position, 10);
    // The same place, another time around.
    near(mercator.positionOf(placeOn({ lng: lng - 720, lat: 35 })), position, 10);
  }
});

test("other maps are refused, with the remedy", () => {
  const said = /export it with projection="mercator"/;
  assert.throws(() => new Mercator(null, undefined), said);
  const [earth, part] = mapAround(0, 40, [0, 60], (y) => y / RADIUS / 2);
  assert.throws(() => new Mercator(earth, part), said);
});

test("a flat map is seen as it is, and a tilted one from where its eye is", () => {
  const mercator = new Mercator(...mapAround(0, 90, [-70, 70]));
  const pixel = (2 * Math.PI * RADIUS) / (512 * 4);
  const [flat, ...others] = mercator.look({ ...LOOK, bearing: 90 }, 0);
  assert.deepEqual([flat.width, flat.height, flat.state.parallel], [600, 400, true]);
  assert.deepEqual(others, []);
  near([flat.state.parallel_scale / pixel], [200], 1e-3);
  near(flat.state.up, [1, 0, 0], 1e-9);
  const [{ state }] = mercator.look({ ...LOOK, pitch: 60 }, 0);
  const away = 200 / Math.tan((36.87 / 2) * DEGREE);
  near(state.position.map((x) => x / pixel), [0, -away * Math.sin(60 * DEGREE), away / 2], 1e-2);
  assert.equal(state.parallel, false);
});

/** Longitudes from the middle, and latitudes, of what a window shows of a globe, point by point. */
function seenOnGlobe({ center, width, height, zoom, bearing, pitch, fov }: MapLook): { aside: number; lats: number[] } {
  const radius = (512 * 2 ** zoom) / (2 * Math.PI * Math.cos(center.lat * DEGREE));
  const away = height / 2 / Math.tan((fov / 2) * DEGREE);
  const lats: number[] = [];
  let aside = 0;
  for (let lat = -89.5; lat < 90; lat += 1) {
    for (let lng = -179.5; lng < 180; lng += 1) {
      // To the east and north from the middle, and up from there, in pixels.
      const out = Math.cos(lat * DEGREE) * Math.cos(lng * DEGREE);
      const [sine, cosine] = [Math.sin(center.lat * DEGREE), Math.cos(center.lat * DEGREE)];
      const east = radius * Math.cos(lat * DEGREE) * Math.sin(lng * DEGREE);
      const north = radius * (Math.sin(lat * DEGREE) * cosine - out * sine);
      const above = radius * (Math.sin(lat * DEGREE) * sine + out * cosine - 1);
      // Along the window.
      const right = east * Math.cos(bearing * DEGREE) - north * Math.sin(bearing * DEGREE);
      const ahead = east * Math.sin(bearing * DEGREE) + north * Math.cos(bearing * DEGREE);
      const up = ahead * Math.cos(pitch * DEGREE) + above * Math.sin(pitch * DEGREE);
      const depth = away + ahead * Math.sin(pitch * DEGREE) - above * Math.cos(pitch * DEGREE);
      const isInside = Math.abs(right) <= (depth / away) * (width / 2) && Math.abs(up) <= (depth / away) * (height / 2);
      // The eye is above the plane that touches the globe there.
      const toEye = [-away * Math.sin(pitch * DEGREE) - ahead, away * Math.cos(pitch * DEGREE) - above];
      const facing = -right * right + toEye[0] * ahead + toEye[1] * (above + radius);
      if (depth <= 0 || !isInside || facing <= 0) continue;
      lats.push(lat);
      aside = Math.max(aside, Math.abs(lng));
    }
  }
  return { aside, lats };
}

test("a globe is seen as far as the window shows it, at most to its horizon", () => {
  const mercator = new Mercator(...mapAround(0, 180, [-85, 85]));
  const views: [zoom: number, lat: number, pitch: number, bearing: number][] = [
    [0, 0, 0, 0], [1, 20, 0, 0], [1.6, 20, 0, 0], [1.6, 20, 50, 30], [3, 40, 0, 0], [3, 40, 60, 0], [3, -30, 40, 120],
    [4, 0, 80, 0], [2, 75, 0, 0], [1, 80, 45, 0], [2, -60, 60, 200],
  ];
  for (const [zoom, lat, pitch, bearing] of views) {
    const look = { ...LOOK, width: 300, height: 200, center: { lng: 0, lat }, zoom, pitch, bearing, globe: true };
    const [{ state, width, height }] = mercator.look(look, 0);
    const middle = placeOn({ lng: 0, lat: mercator.lngLatOf(state.focal_point)[1] })[1];
    const world = 512 * 2 ** zoom;
    const [north, south] = [-1, 1].map((side) => middle + (side * height) / (2 * world));
    const { aside, lats } = seenOnGlobe(look);
    const [top, bottom] = [Math.max(...lats), Math.min(...lats)].map((at) => placeOn({ lng: 0, lat: at })[1]);
    const said = `${width} x ${height} at ${zoom}, ${lat}, ${pitch}, ${bearing}`;
    assert.ok((180 * width) / world >= aside - 0.5 && north <= top && south >= bottom, said);
    // Not much more, so that pictures are sharp.
    assert.ok((180 * width) / world <= 1.1 * aside + 2, said);
    const more = placeOn({ lng: 0, lat: Math.max(...lats) + 4 })[1];
    assert.ok(north >= more - 1e-9 && south <= placeOn({ lng: 0, lat: Math.min(...lats) - 4 })[1] + 1e-9, said);
  }
});

test("the tiles of a globe are those in view, as far as its corners", () => {
  const mercator = new Mercator(...mapAround(0, 180, [-85, 85]));
  const look = { ...LOOK, zoom: 1.6, width: 300, height: 200, center: { lng: 0, lat: 20 }, globe: true };
  const [{ shownOn }] = mercator.look(look, 0);
  // Its corners are beyond the horizon, which is 62 degrees away.
  const radius = (512 * 2 ** look.zoom) / (2 * Math.PI * Math.cos(20 * DEGREE));
  const horizon = Math.acos(radius / (radius + 100 / Math.tan((36.87 / 2) * DEGREE))) / DEGREE;
  near([horizon], [62], 0.5);
  const blockAt = (away: number) => [0, northing(20 - away), 0, 0, 1];
  assert.equal(shownOn?.sees(blockAt(horizon - 0.5)), true);
  assert.equal(shownOn?.sees(blockAt(horizon + 3)), false);
});

test("where a map shows both ends of data around the Earth there are two pictures, a world apart", () => {
  const around = new Mercator(...mapAround(0, 180, [-85, 85]));
  const world = 2 * Math.PI * RADIUS;
  const center = { lng: 175, lat: 0 };
  for (const globe of [false, true]) {
    const [main, other] = around.look({ ...LOOK, center, zoom: 4, globe }, 0);
    near([main.state.focal_point[0], other.state.focal_point[0]], [(175 / 360) * world, (-185 / 360) * world], 100);
    assert.equal(around.look({ ...LOOK, center: { lng: 100, lat: 0 }, zoom: 4, globe }, 0).length, 1);
  }
  // On a globe of which half a world is seen, all of the data are in one picture.
  const [globe, ...further] = around.look({ ...LOOK, center: { lng: 120, lat: 20 }, zoom: 1.6, globe: true }, 0);
  assert.deepEqual(further, []);
  near([globe.width / 512 / 2 ** 1.6, globe.state.focal_point[0]], [1, 0], 1e-3);
  // All of the data are in one picture, wherever its middle is, or there are none beyond their end.
  const [whole, ...more] = around.look({ ...LOOK, center: { lng: -80, lat: 0 }, zoom: 0, width: 900, bearing: 30 }, 0);
  assert.deepEqual(more, []);
  near([whole.width, whole.height, whole.state.focal_point[0]], [512, Math.hypot(900, 400), 0], 0.1);
  assert.equal(around.look({ ...LOOK, center, zoom: 0, height: 1200, width: 1200 }, 0).length, 1);
  const region = new Mercator(...mapAround(0, 40, [-70, 70]));
  assert.equal(region.look({ ...LOOK, center: { lng: 40, lat: 0 }, zoom: 4 }, 0).length, 1);
});

const [DEPTH, TILE_BLOCKS, BLOCK_CELLS] = [6, 8, 32];
const LIMITS = { closest: 1e6 } as CameraLimits;

/** Place of a block of the rows of equal latitudes of a store around the Earth, whose cells are tall near the poles. */
function blockPlace(count: number, row: number, column: number): number[] {
  const step = 170 / count;
  const width = (2 * Math.PI * RADIUS) / count;
  const [south, north] = [row, row + 1].map((n) => northing(n * step - 85));
  const cellHeights = [row, row + 1 - 1 / BLOCK_CELLS].map((n) => {
    const from = n * step - 85;
    return northing(from + step / BLOCK_CELLS) - northing(from);
  });
  const middle = [(column + 0.5) * width - Math.PI * RADIUS, 0.5 * (south + north), 0];
  return [...middle, 0.5 * Math.hypot(width, north - south), Math.max(width / BLOCK_CELLS, ...cellHeights)];
}

/** Tiles that a globe of 900 x 600 pixels wants, by zoom and latitude of its middle. */
function tilesWanted(zoom: number, lat: number): TileKey[] {
  const mercator = new Mercator(...mapAround(0, 180, [-85, 85]));
  const counts = Array.from({ length: DEPTH + 1 }, (_, level) => 2 ** (DEPTH - level) * TILE_BLOCKS);
  const header = { depth: DEPTH, finest: 0, tileBlocks: TILE_BLOCKS, blocks: counts.map((n) => [n, n]) };
  const pyramid = new Pyramid(header as PyramidHeader, (level, row, column) => blockPlace(counts[level], row, column));
  const look = { ...LOOK, width: 900, height: 600, center: { lng: 0, lat }, zoom, globe: true };
  const [{ state, width, height, shownOn }] = mercator.look(look, 0);
  const camera = new Camera(state, LIMITS, true, width / height);
  const sight = { ...camera.sight(height), planes: camera.planes };
  return wantedTiles(pyramid.choose({ ...sight, cellPixels: 4, shownOn })).map(keyOf);
}

test("a globe asks for tiles by their size on the screen, also beside a pole", () => {
  for (const [zoom, lat] of [[0, 0], [1.6, 0], [1.6, 60], [3, 40], [3, 80], [5, 75], [5, -80]]) {
    const wanted = tilesWanted(zoom, lat);
    assert.ok(wanted.length <= 16, `${wanted.length} tiles at ${zoom}, ${lat}`);
    // At the middle of the view a pixel is this share of the map, and cells grow up to 8 pixels.
    const cells = (512 * 2 ** zoom) / (2 ** DEPTH * TILE_BLOCKS * BLOCK_CELLS);
    const finest = Math.min(...wanted.map(([level]) => level));
    assert.ok(2 ** finest * cells > 0.5, `level ${finest} at ${zoom}, ${lat}`);
  }
});
