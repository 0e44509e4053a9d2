// The path through a point, and the velocity there, from the slices that the picture is drawn with.
// It is what shaders/common/path.glsl does at the finest level, in double precision.

import type { Camera } from "./camera.ts";
import { type Corners, interpolated, placeIn } from "./mesh.ts";
import { isSignFree, type Settings } from "./protocol.ts";
import type { PathSample } from "./samples.ts";
import type { Four, Scene } from "./scene.ts";
import { isMoving, type Moment } from "./uniforms.ts";
import { add, clamp, cross, dot, fromFrame, length, scale, subtract, unit, type Vector } from "./vectors.ts";

/** The layer whose fourth channel is the speed. */
const SPEED_LAYER = 2;
/** Points of a path between two slices, where it is a parabola. */
const POINTS_BETWEEN_SLICES = 8;
/** How many times as long as the part that is summed the path is that is shown. */
const PATH_LENGTH = 4;
/** Samples on a side as which fewer count, so that there is something to see. */
const FEWEST_SAMPLES = 10;
/** Cosine between the surface and the ray to the eye, at least: that of the shaders. */
const LEAST_FACING = 0.05;
/** Shorter side of a pixel on the surface, over the longer one, that counts at least. */
const LEAST_ROUND = 0.25;
/** Width of a streak seen aslant in the picture over the usual one, at least. */
const LEAST_ACROSS = 0.75;
/** Samples of a streak seen aslant over the usual number, at most, and the reverse. */
const MOST_STRETCH = 4;
/** Change of their number below which it stays the usual one. */
const LEAST_STRETCH = 0.01;
/** Slope below which nothing moves. */
const LEAST_SLOPE = 1e-6;
/** Part of a cell over which a direction in image coordinates is one in space. */
const SMALL = 1e-3;

/** A path in the mesh's coordinates, downstream. */
export interface PointPath {
  path: Vector[];
  /** The part that is summed. */
  sampled: Vector[];
  /** Whether the flow has a direction along the path. */
  directed: boolean;
  /** Velocity in the surface. */
  velocity: Vector;
  /** The samples that are summed, from the farthest behind, where they are known. */
  samples?: PathSample[];
}

/** Where a path is looked for: a scene, and a place (i, j) between its nodes. */
export interface PathPlace {
  scene: Scene;
  moment: Moment;
  place: [number, number];
  position: Vector;
}

type Layers = (layer: number) => Four;
type Beside = [number, number];

/**
 * The texels around a place, and their shares: four, or those of a triangle's nodes. The place may be
 * one beside it, by so many cells, or so much in the shares of the second and the third node.
 */
function texelsAt({ scene, place }: PathPlace, [di, dj]: Beside): Corners {
  const { rows, columns, triangles } = scene.header.geometry;
  if (triangles) {
    const more = [-di - dj, di, dj];
    return scene.cornersAt(place).map(([node, share], n) => [node, share + more[n]]);
  }
  const [x, y] = [place[0] + di + columns.before, place[1] + dj + rows.before];
  const [left, low] = [Math.floor(x), Math.floor(y)];
  const [s, t] = [x - left, y - low];
  return [(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t].map((share, n) => {
    const column = clamp(left + (n & 1), 0, columns.size - 1);
    return [clamp(low + (n >> 1), 0, rows.size - 1) * columns.size + column, share];
  });
}

/** Layers between the nodes and the time steps, at a place or beside it. */
export function layersAt(at: PathPlace, beside: Beside = [0, 0]): Layers {
  const { scene, moment } = at;
  const { slices } = scene.header;
  const texels = texelsAt(at, beside);
  const [before, after, late] = moment;
  const numbers = texels.map(([texel]) => texel);
  const steps = (before === after ? [before] : [before, after]).map((step) => scene.texels(step, numbers));
  const shares = before === after ? [1] : [1 - late, late];
  const signs = isSignFree(scene.header)
    ? signsOf(texels.map((_, n) => steps[0](0, n)))
    : texels.map(() => 1);
  return (layer) => {
    const sum: Four = [0, 0, 0, 0];
    texels.forEach(([, weight], n) => {
      // The two sides of a reversed node are swapped.
      const other = layer + (layer > slices.lags.length ? -1 : 1) * slices.lags.length;
      const from = signs[n] < 0 && layer > 0 ? other : layer;
      steps.forEach((step, k) => {
        if (!shares[k]) return;
        step(from, n).forEach((channel, c) => {
          // A negative speed is the share by which streaks fade, where the flow crosses the surface.
          const value = layer === SPEED_LAYER && c === 3 ? Math.max(channel, 0) : channel;
          sum[c] += weight * shares[k] * value * (c < 3 ? signs[n] : 1);
        });
      });
    });
    return sum;
  };
}

/** -1 for the nodes that point against the others, in a sign-free field. */
function signsOf(tangents: Four[]): number[] {
  let together: Vector = [0, 0, 0];
  return tangents.map(([x, y, z]) => {
    const sign = dot(together, [x, y, z]) < 0 ? -1 : 1;
    together = add(together, [x, y, z], sign);
    return sign;
  });
}

/** Displacements of one side of the path, from the point to its end. */
function sideOf(layers: Layers, lags: number[], first: number, sign: number, by: number): Vector[] {
  let [before, from] = [layers(0).slice(0, 3), 0];
  const reach = layers(first + 1)[3];
  const end = Math.min(reach, lags[lags.length - 1]);
  const result: Vector[] = [];
  for (let m = 0; m < lags.length && from < end; m += 1) {
    const after = layers(first + m + 1).slice(0, 3);
    for (let n = 1; n <= POINTS_BETWEEN_SLICES; n += 1) {
      const share = n / POINTS_BETWEEN_SLICES;
      const lag = Math.min(from + share * (lags[m] - from), end);
      const late = (lag - from) / (lags[m] - from);
      const slope = before.map((x, c) => x + late * (after[c] - x));
      result.push(scale(slope, sign * lag * by));
      if (lag === end) break;
    }
    [before, from] = [after, lags[m]];
  }
  return result;
}

/** Return the function from displacements to points in space; it returns null beyond the border of the image. */
export function mover({ scene, place, position }: PathPlace): (moved: Vector) => Vector | null {
  const { image, geometry } = scene.header;
  if (!image) return (moved) => add(position, fromFrame(geometry.frame, moved));
  const { alongI, alongJ } = image;
  const here = [between(alongI, place[0]), between(alongJ, place[1])];
  const start = pointAt(scene, place);
  return ([u, v]) => {
    const at = [indexOf(alongI, here[0] + u), indexOf(alongJ, here[1] + v)];
    if (at.some(Number.isNaN)) return null;
    return add(position, subtract(pointAt(scene, at as [number, number]), start));
  };
}

/** Position of a place between the nodes. */
export function nodeAt(scene: Scene, place: [number, number]): Vector {
  return add(pointAt(scene, place), scene.header.geometry.center as Vector);
}

function pointAt(scene: Scene, place: [number, number]): Vector {
  const { data } = scene.part("position");
  const corners = scene.cornersAt(place);
  const local = [0, 1, 2].map((c) => interpolated(corners, (n) => data[3 * n + c]));
  return fromFrame(scene.header.geometry.frame, local);
}

/** Sides of the cell at a place, or two of the triangle. */
function sidesAt(scene: Scene, place: [number, number]): [Vector, Vector] {
  const { shape, triangles } = scene.header.geometry;
  if (triangles) {
    const corner = (second: number, third: number) =>
      pointAt(scene, placeIn(Math.floor(place[1]), second, third));
    return [subtract(corner(1, 0), corner(0, 0)), subtract(corner(0, 1), corner(0, 0))];
  }
  const [i, j] = place.map((n, axis) => clamp(n, 0.5, shape[1 - axis] - 1.5));
  const at = (di: number, dj: number) => pointAt(scene, [i + di, j + dj]);
  return [subtract(at(0.5, 0), at(-0.5, 0)), subtract(at(0, 0.5), at(0, -0.5))];
}

/** Sine of the angle to paths so far beside, as shaders/common/texture.glsl has it: below 0 where they meet. */
export function partingAt(at: PathPlace, half: number): number {
  const { scene, place } = at;
  const [first, second] = sidesAt(scene, place);
  const normal = cross(first, second);
  const wayAt = (beside: Beside) =>
    unit(fromFrame(scene.header.geometry.frame, layersAt(at, beside)(0).slice(0, 3)));
  const across = unit(cross(normal, wayAt([0, 0])));
  const by = half / dot(normal, normal);
  const [di, dj] = [cross(second, normal), cross(normal, first)].map((side) => by * dot(across, side));
  return 0.5 * dot(across, subtract(wayAt([di, dj]), wayAt([-di, -dj])));
}

function between(values: number[], at: number): number {
  const n = Math.min(Math.floor(at), values.length - 2);
  return values[n] + (at - n) * (values[n + 1] - values[n]);
}

/** Place of a value among increasing ones; NaN beside them. */
function indexOf(values: number[], value: number): number {
  const n = values.findIndex((other) => other >= value);
  if (n < 0 || value < values[0]) return NaN;
  if (n === 0) return 0;
  return n - 1 + (value - values[n - 1]) / (values[n] - values[n - 1]);
}

/**
 * Length of a grain at a point: of the pixel's mean side as it lies on the surface, or of a texel of
 * the step texture's level, which is that of the pixel unless its own texels are larger.
 */
export function grainAt(at: PathPlace, settings: Settings, camera: Camera, rows: number) {
  const { scene, place, position } = at;
  const { geometry, image } = scene.header;
  const { height, ray } = camera.at(position);
  const pixel = (2 * height) / rows;
  if (image) {
    const normal = cross(...sidesAt(scene, place));
    const facing = Math.max(Math.abs(dot(unit(normal), ray)), LEAST_FACING);
    const [across, up] = [image.alongI, image.alongJ].map((along, axis) => {
      const n = Math.min(Math.floor(place[axis]), along.length - 2);
      return (along[n + 1] - along[n]) * image.stepSize[axis];
    });
    const texel = Math.sqrt(length(normal) / (across * up));
    const grain = image.deviations ? pixel * Number(settings.grain) : pixel;
    return settings.lod ? Math.max(grain / Math.sqrt(facing), texel) : texel;
  }
  const texel = geometry.extent / Number(settings.resolution);
  if (!settings.lod) return texel;
  const grain = pixel * footprintAt(at, camera).side * Number(settings.grain);
  return settings.fixed_grain ? Math.max(grain, texel) : grain;
}

/** How many times as many samples are summed at a point, as shaders/common/lookup_space.glsl has it. */
export function stretchAt(at: PathPlace, settings: Settings, camera: Camera): number {
  if (at.scene.header.image || !settings.lod || settings.fixed_grain) return 1;
  const { side, across, area } = footprintAt(at, camera);
  if (!across) return 1;
  const stretch = clamp(area / (across * side), 1 / MOST_STRETCH, MOST_STRETCH);
  return Math.abs(stretch - 1) < LEAST_STRETCH ? 1 : stretch;
}

/** What a pixel covers of the surface, in pixels of a plane parallel to the picture. */
interface Footprint {
  /** Side of the pixel for which grains are made. */
  side: number;
  /** How far it extends across the flow. */
  across: number;
  area: number;
}

function footprintAt(at: PathPlace, camera: Camera): Footprint {
  const { geometry } = at.scene.header;
  const normal = unit(cross(...sidesAt(at.scene, at.place)));
  const across = unit(cross(normal, fromFrame(geometry.frame, layersAt(at)(0).slice(0, 3))));
  const { ray } = camera.at(at.position);
  const slant = dot(normal, ray);
  const facing = (slant < 0 ? -1 : 1) * Math.max(Math.abs(slant), LEAST_FACING);
  const [dx, dy] = camera.axes.slice(0, 2).map((axis) => add(axis, ray, -dot(normal, axis) / facing));
  const area = length(cross(dx, dy));
  const half = 0.5 * (dot(dx, dx) + dot(dy, dy));
  const longer = Math.sqrt(half + Math.sqrt(Math.max(half ** 2 - area ** 2, 0)));
  const mean = Math.sqrt(longer * Math.max(area / longer, LEAST_ROUND * longer));
  const aside = Math.hypot(dot(dx, across), dot(dy, across));
  return { side: Math.max(mean, LEAST_ACROSS * aside), across: aside, area };
}

/** The first points of a side, up to a length. */
function upTo(start: Vector, side: Vector[], most: number): Vector[] {
  const result: Vector[] = [];
  let [from, left] = [start, most];
  for (const point of side) {
    const step = length(subtract(point, from));
    if (step >= left) {
      if (left > 0) result.push(add(from, subtract(point, from), left / (step || 1)));
      break;
    }
    result.push(point);
    left -= step;
    from = point;
  }
  return result;
}

/** The moments of the time steps around one, and their shares. */
export function stepsAround([before, after, late]: Moment): [Moment, number][] {
  if (before === after) return [[[before, before, 0], 1]];
  return [[[before, before, 0], 1 - late], [[after, after, 0], late]];
}

/** Velocity in the surface. */
export function velocityAt(at: PathPlace): Vector {
  let velocity: Vector = [0, 0, 0];
  for (const [moment, share] of stepsAround(at.moment)) {
    if (share) velocity = add(velocity, velocityAtStep({ ...at, moment }), share);
  }
  return velocity;
}

function velocityAtStep(at: PathPlace): Vector {
  const { scene, position } = at;
  const { slices, image, speed } = scene.header;
  const layers = layersAt(at);
  const [x, y, z] = layers(0);
  const slope: Vector = [x, y, z];
  const small = scale(slope, (SMALL * (image ? 1 / image.stepSize[0] : slices.cell)) / (length(slope) || 1));
  const along = length(slope) > LEAST_SLOPE ? subtract(mover(at)(small) ?? position, position) : slope;
  return scale(unit(along), layers(SPEED_LAYER)[3] * speed.typical);
}

/** The path through a point as the picture has it that is so many of the page's pixels high. */
export function pathThrough(at: PathPlace, settings: Settings, camera: Camera, rows: number): PointPath {
  const { scene, position } = at;
  const { slices, image } = scene.header;
  const layers = layersAt(at);
  const directed = !isSignFree(scene.header);
  const base = layers(0);
  const slope: Vector = [base[0], base[1], base[2]];
  const moved = mover(at);
  const whole: Vector[][] = [];
  const sides = settings.two_sided || !directed ? slices.sides : 1;
  for (let side = 0; side < sides && length(slope) > LEAST_SLOPE; side += 1) {
    const by = image ? 1 : base[3] * slices.unit;
    const ways = sideOf(layers, slices.lags, side * slices.lags.length, side ? 1 : -1, by);
    const points = ways.map(moved);
    const end = points.findIndex((point) => point === null);
    whole.push(points.slice(0, end < 0 ? undefined : end) as Vector[]);
  }
  const set = Number(settings.samples);
  const samples = isMoving(scene.header, settings, true) ? 2 * set - 1 : set;
  const usual = sides === 2 ? Math.floor(samples / 2) : samples - 1;
  const count = usual * stretchAt(at, settings, camera);
  const step = Number(settings.spacing) * grainAt(at, settings, camera, rows);
  const joined = (reach: number) => {
    const [back = [], ahead = []] = whole.map((side) => upTo(position, side, reach));
    return [...back.reverse(), position, ...ahead];
  };
  const path = joined(PATH_LENGTH * Math.max(count, FEWEST_SAMPLES) * step);
  return { path, sampled: joined(count * step), directed, velocity: velocityAt(at) };
}
