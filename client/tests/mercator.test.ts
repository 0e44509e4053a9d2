// How flows on Mercator maps lie on a web map: against the formulas of the projection.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Mercator, placeOn, type MapLook } from "../src/mercator.ts";
import type { Earth, Part } from "../src/protocol.ts";

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

test("a globe is seen as far as the window shows it, at most to its horizon", () => {
  const mercator = new Mercator(...mapAround(0, 180, [-85, 85]));
  const world = 512 * 8;
  const radius = world / (2 * Math.PI);
  const [close] = mercator.look({ ...LOOK, zoom: 3, globe: true }, 0);
  const seen = Math.asin(Math.hypot(300, 200) / radius);
  near([close.width / world], [seen / Math.PI], 1e-6);
  near([close.state.parallel_scale / RADIUS], [Math.asinh(Math.tan(seen))], 1e-4);
  const [far] = mercator.look({ ...LOOK, zoom: 0, globe: true }, 0);
  near([far.width, far.height], [256, 512], 1e-3);
  // Over the pole all longitudes are seen, and tilted the horizon.
  const [polar] = mercator.look({ ...LOOK, zoom: 1, center: { lng: 0, lat: 80 }, globe: true }, 0);
  near([polar.width], [1024], 1e-6);
  assert.ok(mercator.look({ ...LOOK, zoom: 5, pitch: 85, globe: true }, 0)[0].height > 16 * 300);
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
  // All of the data are in one picture, or there are none beyond their end.
  assert.equal(around.look({ ...LOOK, center, zoom: 0, height: 1200, width: 1200 }, 0).length, 1);
  const region = new Mercator(...mapAround(0, 40, [-70, 70]));
  assert.equal(region.look({ ...LOOK, center: { lng: 40, lat: 0 }, zoom: 4 }, 0).length, 1);
});
