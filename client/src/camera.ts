// The camera: how it is moved, and how it sees. flowtex/rendering/camera.py does the same in Python.

import {
  add,
  clamp,
  cross,
  dot,
  fromFrame,
  length,
  rotated,
  scale,
  subtract,
  toFrame,
  unit,
  type Vector,
} from "./vectors.ts";

/** A camera as a plain dictionary, in the mesh's own coordinates. */
export interface CameraState {
  position: number[];
  focal_point: number[];
  up: number[];
  parallel: boolean;
  parallel_scale: number;
  view_angle: number;
}

/** Where a surface lies; `frame` has the rows of the matrix from the mesh to the surface's own frame. */
export interface Surface {
  planar: boolean;
  extent: number;
  center: number[];
  frame: number[];
  /** How far what stands beside it reaches from its center. */
  reach?: number;
}

/** How far a camera may go: CameraLimits of flowtex/rendering/camera.py. */
export interface CameraLimits {
  /** Deepest and farthest zoom, relative to the whole surface. */
  deepest_zoom: number;
  farthest_zoom: number;
  /** How many times closer the camera comes. */
  closest: number;
  /** View angle in perspective, in degrees. */
  view_angle: number;
  /** Share of the view that is left empty around a surface. */
  margin: number;
  /** Zoom by one notch of the wheel. */
  wheel_zoom: number;
  /** Degrees that a drag over half the height of the view turns, and the aspect up to which it does. */
  turn: number;
  widest_turn: number;
  /** Width over height of the view that a camera in perspective is usually made for. */
  aspect: number;
}

const NORTH: Vector = [0, 0, 1];
/** Sine of the latitude beyond which the eye does not go over a globe, and cosine of it that counts. */
const STEEPEST = Math.sin((89 * Math.PI) / 180);
const LEAST_COSINE = 0.2;
/** Cosine between the normals of planes that share a camera, at least. */
const LEAST_PARALLEL = 0.8;

const tangent = (degrees: number) => Math.tan((degrees * Math.PI) / 360);

/** A camera that is moved. Places in the view are (x, y) from -1 to 1, right and up. */
export class Camera {
  readonly flat: boolean;
  readonly limits: CameraLimits;
  aspect: number;
  state: CameraState;
  readonly start: CameraState;
  /** Point of the surface at a place of the view. */
  pick: ((x: number, y: number) => Vector | null) | null = null;
  /** Radius of the globe around the origin that is seen; 0 elsewhere. */
  readonly globe: number;
  private readonly homeHeight: number;
  private readonly nearest: number;

  /** `flat` says whether a drag pans; otherwise it rotates. */
  constructor(state: CameraState, limits: CameraLimits, flat: boolean, aspect = 1, globe = 0) {
    this.state = copyOf(state);
    this.start = copyOf(state);
    this.limits = limits;
    this.flat = flat;
    this.globe = globe;
    this.aspect = aspect;
    this.homeHeight = this.height;
    this.nearest = this.distance / limits.closest;
  }

  /** Half the height of the view at the focal point. */
  get height(): number {
    const { parallel, parallel_scale: half, view_angle: angle } = this.state;
    return parallel ? half : this.distance * tangent(angle);
  }

  get distance(): number {
    return length(subtract(this.state.focal_point, this.state.position));
  }

  /** How far in: 1 is the view that the scene came with. */
  get zoom(): number {
    return this.homeHeight / this.height;
  }

  /** Unit vectors to the right of the view, upwards, and away from the eye. */
  get axes(): [Vector, Vector, Vector] {
    const ahead = unit(subtract(this.state.focal_point, this.state.position));
    const right = unit(cross(ahead, this.state.up));
    return [right, cross(right, ahead), ahead];
  }

  /** What triangles and tiles are chosen by for a picture of so many rows. */
  sight(pixels: number): { eye: Vector | null; halfHeight: number; pixels: number } {
    const { parallel, position, view_angle: angle } = this.state;
    if (parallel) return { eye: null, halfHeight: this.height, pixels };
    return { eye: position as Vector, halfHeight: tangent(angle), pixels };
  }

  /** Planes at the sides of what is seen; a point is inside where p . (x, y, z, 1) >= 0. */
  get planes(): number[][] {
    const [right, up, ahead] = this.axes;
    const { parallel, parallel_scale: half, view_angle: angle } = this.state;
    const { position, focal_point: focus } = this.state;
    const tall = parallel ? half : tangent(angle);
    return [right, scale(right, -1), up, scale(up, -1)].map((side, n) => {
      const size = n < 2 ? tall * this.aspect : tall;
      if (parallel) return [...side, size - dot(side, focus)];
      const normal = add(side, ahead, size);
      return [...normal, -dot(normal, position)];
    });
  }

  /** The eye and 1, or the way to it and 0 where all rays are parallel. */
  get eye(): number[] {
    if (!this.state.parallel) return [...this.state.position, 1];
    return [...scale(this.axes[2], -1), 0];
  }

  /** Half the height of the view at the depth of a point, and the unit vector from the eye to it. */
  at(point: Vector): { height: number; ray: Vector } {
    const ahead = this.axes[2];
    if (this.state.parallel) return { height: this.height, ray: ahead };
    const way = subtract(point, this.state.position);
    return { height: dot(way, ahead) * tangent(this.state.view_angle), ray: unit(way) };
  }

  /** Place of a point in the view; null behind the eye. */
  project(point: Vector): [number, number] | null {
    const [right, up] = this.axes;
    const { height } = this.at(point);
    if (!(height > 0)) return null;
    // From the focal point, which keeps the digits of a close view.
    const { parallel, position, focal_point: focus } = this.state;
    const way = subtract(point, parallel ? focus : position);
    return [dot(right, way) / height / this.aspect, dot(up, way) / height];
  }

  /** Move what is seen by parts of the view. */
  pan(dx: number, dy: number): void {
    const [right, up] = this.axes;
    const { height } = this;
    this.shift(add(scale(right, dx * this.aspect * height), up, dy * height));
  }

  /** Go around the focal point, as a drag by (dx, dy) asks. */
  rotate(dx: number, dy: number): void {
    if (this.globe) return this.roam(dx, dy);
    const { state, limits } = this;
    const up = unit(state.up);
    let back = subtract(state.position, state.focal_point);
    back = rotated(back, up, -limits.turn * dx * Math.min(this.aspect, limits.widest_turn));
    const right = unit(cross(up, back));
    back = rotated(back, right, limits.turn * dy);
    state.position = add(state.focal_point, back);
    state.up = unit(cross(back, right));
  }

  /** Go around a globe with north up, as far as the place under the pointer asks. */
  private roam(dx: number, dy: number): void {
    const { state, limits, globe } = this;
    const away = length(state.position as Vector);
    const above = Math.max(away - globe, 0) * tangent(state.view_angle);
    const height = state.parallel ? state.parallel_scale : above;
    const degrees = Math.min(((height / globe) * 180) / Math.PI, limits.turn);
    const cosine = Math.hypot(state.position[0], state.position[1]) / away;
    const aside = Math.min((degrees * this.aspect) / Math.max(cosine, LEAST_COSINE), limits.turn);
    this.turn(NORTH, -aside * dx);
    const [right] = this.axes;
    const steep = Math.abs(state.position[2]) / away;
    const before = copyOf(state);
    this.turn(right, degrees * dy);
    const steeper = Math.abs(state.position[2]) / away;
    if (steeper > Math.max(STEEPEST, steep)) this.state = before;
    const [, , ahead] = this.axes;
    const upward = add(NORTH, ahead, -dot(NORTH, ahead));
    if (length(upward) > 1 - STEEPEST) this.state.up = unit(upward);
  }

  /** Go around the middle of a globe. */
  private turn(axis: Vector, degrees: number): void {
    const { state } = this;
    for (const name of ["position", "focal_point", "up"] as const) {
      state[name] = rotated(state[name], axis, degrees);
    }
  }

  /** Zoom in; the point at (x, y) stays where it is. */
  zoomBy(factor: number, x = 0, y = 0): void {
    if (!Number.isFinite(factor) || factor <= 0) return;
    if (!this.flat) this.focusAt(x, y);
    const { farthest_zoom: farthest, deepest_zoom: deepest } = this.limits;
    const by = clamp(factor, farthest / this.zoom, deepest / this.zoom);
    const [right, up, ahead] = this.axes;
    const height = this.height * (1 - 1 / by);
    this.shift(add(scale(right, x * this.aspect * height), up, y * height));
    if (this.state.parallel) this.state.parallel_scale /= by;
    else this.approach(this.height / by, ahead);
  }

  /** Start and direction of the ray through a place of the view. */
  ray(x: number, y: number): [Vector, Vector] {
    const [right, up, ahead] = this.axes;
    const { height, state } = this;
    const there = add(add(state.focal_point, right, x * this.aspect * height), up, y * height);
    if (state.parallel) return [add(there, ahead, -this.distance), ahead];
    return [add(state.position, [0, 0, 0]), unit(subtract(there, state.position))];
  }

  /** Come closer, and from near look more narrowly. */
  private approach(height: number, ahead: Vector): void {
    const distance = Math.max(height / tangent(this.limits.view_angle), this.nearest);
    this.state.position = add(this.state.focal_point, ahead, -distance);
    this.state.view_angle = (Math.atan(height / distance) * 360) / Math.PI;
  }

  /** Bring the focal point to the depth of what is at a place. */
  private focusAt(x: number, y: number): void {
    const point = this.pick?.(x, y);
    if (!point) return;
    const ahead = this.axes[2];
    const depth = dot(subtract(point, this.state.position), ahead);
    if (depth > 0) this.state.focal_point = add(this.state.position, ahead, depth);
  }

  private shift(by: Vector): void {
    this.state.focal_point = add(this.state.focal_point, by);
    this.state.position = add(this.state.position, by);
  }
}

export function copyOf(state: CameraState): CameraState {
  const { position, focal_point: focus, up } = state;
  return { ...state, position: [...position], focal_point: [...focus], up: [...up] };
}

/** A camera that shows the whole surface, whose nodes are in its own frame. */
export function fitted(
  surface: Surface,
  limits: CameraLimits,
  positions: ArrayLike<number>,
  aspect: number,
): CameraState {
  const { center, extent, planar, frame } = surface;
  const half = tangent(limits.view_angle);
  const back = planar ? fromFrame(frame, [0, 0, 1]) : unit([1, 1, 1]);
  const up: Vector = planar ? fromFrame(frame, [0, 1, 0]) : [0, 0, 1];
  const right = unit(cross(up, back));
  const rows = [right, cross(back, right), back].map((row) => toFrame(frame, row));
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  let distance = 0;
  for (let n = 0; n < positions.length; n += 3) {
    const node = [positions[n], positions[n + 1], positions[n + 2]];
    if (!Number.isFinite(node[0])) continue;
    const [x, y, z] = rows.map((row) => dot(row, node));
    [x, y].forEach((value, k) => {
      low[k] = Math.min(low[k], value);
      high[k] = Math.max(high[k], value);
    });
    const wide = Math.max(Math.abs(x) / aspect, Math.abs(y));
    distance = Math.max(distance, z + wide / half / (1 - 2 * limits.margin));
  }
  const tall = Math.max(high[1] - low[1], (high[0] - low[0]) / aspect, 1e-12 * extent);
  return {
    position: add(center, back, planar ? extent : distance),
    focal_point: [...center],
    up,
    parallel: planar,
    parallel_scale: (0.5 * tall) / (1 - 2 * limits.margin),
    view_angle: limits.view_angle,
  };
}

/**
 * A camera that shows all of a surface in the shape of picture that it was made for, in another
 * shape; any other camera as it is.
 */
export function widened(
  surface: Surface,
  limits: CameraLimits,
  state: CameraState,
  positions: ArrayLike<number>,
  aspect: number,
): CameraState {
  const { center, extent, planar } = surface;
  const camera = copyOf(state);
  if (length(subtract(state.focal_point, center)) > 1e-3 * extent) return camera;
  if (planar && state.parallel) {
    const [high, usual, all] = [1e9, limits.aspect, aspect].map(
      (shape) => fitted(surface, limits, positions, shape).parallel_scale,
    );
    const isUsual = Math.abs(state.parallel_scale / usual - 1) < 1e-3;
    if (state.parallel_scale > 0.98 * high) {
      camera.parallel_scale = isUsual ? all : Math.max(state.parallel_scale, all);
    }
  } else if (!state.parallel && state.view_angle > 0.9 * limits.view_angle) {
    const back = subtract(state.position, state.focal_point);
    camera.position = add(state.focal_point, back, Math.max(1, limits.aspect / aspect));
  }
  return camera;
}

/** The camera of a first picture: the one that a scene came with, or one that shows the whole surface. */
export function firstLook(
  surface: Surface,
  limits: CameraLimits,
  first: CameraState | null,
  nodes: ArrayLike<number>,
  aspect: number,
): CameraState {
  return first ? widened(surface, limits, first, nodes, aspect) : fitted(surface, limits, nodes, aspect);
}

/** Point of the plane of a flat surface at a place of the view. */
export function pointInPlane({ center, frame }: Surface, camera: Camera, x: number, y: number): Vector {
  const [start, along] = camera.ray(x, y);
  const normal = fromFrame(frame, [0, 0, 1]);
  return add(start, along, dot(subtract(center, start), normal) / dot(along, normal));
}

const normalOf = ({ frame }: Surface): Vector => [frame[6], frame[7], frame[8]];

/** Whether two surfaces lie in the same place, as a coarse form and the whole one. */
export function isSamePlace(a: Surface, b: Surface): boolean {
  const near = length(subtract(a.center, b.center)) < 0.1 * a.extent;
  const ratio = a.extent / b.extent;
  const isTurned = a.planar && dot(normalOf(a), normalOf(b)) < LEAST_PARALLEL;
  return a.planar === b.planar && !isTurned && near && ratio > 0.8 && ratio < 1.25;
}

/**
 * Matrix from the surface's frame, counted from an anchor, to clip space, in columns.
 *
 * Counting from the focal point in both axes of the picture keeps the digits of a close view.
 */
export function projection(surface: Surface, camera: Camera, anchor: Vector): number[] {
  const { state, aspect } = camera;
  const { center, extent, frame } = surface;
  const [right, up, ahead] = camera.axes.map((axis) => toFrame(frame, axis));
  const local = (point: number[]) => subtract(toFrame(frame, subtract(point, center)), anchor);
  const focus = local(state.focal_point);
  const middle = scale(anchor, -1);
  const radius = Math.max(0.51 * extent, surface.reach ?? 0);
  const m = new Array<number>(16).fill(0);
  const half = state.parallel ? state.parallel_scale : tangent(state.view_angle);
  const rows = [right.map((c) => c / half / aspect), up.map((c) => c / half)];
  rows.forEach((row, k) => {
    for (let n = 0; n < 3; n += 1) m[4 * n + k] = row[n];
    m[12 + k] = -dot(row, focus);
  });
  if (state.parallel) {
    for (let n = 0; n < 3; n += 1) m[4 * n + 2] = ahead[n] / radius;
    m[14] = -dot(ahead, middle) / radius;
    m[15] = 1;
    return m;
  }
  const eye = local(state.position);
  const depth = dot(subtract(middle, eye), ahead);
  const far = Math.max(depth + radius, 1e-3 * radius);
  const near = Math.max(depth - radius, 1e-3 * far);
  const a = (far + near) / (far - near);
  const b = (-2 * far * near) / (far - near);
  for (let n = 0; n < 3; n += 1) {
    m[4 * n + 2] = ahead[n] * a;
    m[4 * n + 3] = ahead[n];
  }
  m[15] = -dot(ahead, eye);
  m[14] = m[15] * a + b;
  return m;
}

/** Uniforms of the rays through the pixels of a picture, as shaders/common/place.glsl has them. */
export function rays({ center, frame }: Surface, camera: Camera, anchor: Vector, width: number, height: number) {
  const [right, up] = camera.axes;
  const { height: half, state, aspect } = camera;
  const [x, y] = [scale(right, (2 * half * aspect) / width), scale(up, (2 * half) / height)];
  const corner = add(add(subtract(state.focal_point, center), x, -width / 2), y, -height / 2);
  return { u_rayCorner: subtract(toFrame(frame, corner), anchor), u_rayX: toFrame(frame, x), u_rayY: toFrame(frame, y) };
}
