// The flow texture in a browser: WebGL2, without a library.
//
// A scene comes as a header (JSON) and parts (arrays), from a notebook's kernel or out of a page.
// `Viewer` shows one in an element. All viewers of a page draw with one WebGL2 context, off screen,
// and copy their pictures into 2D canvases: browsers allow some sixteen contexts, and a notebook
// has more pictures than that.
//
//   scene --> Viewer --> Drawing (buffers, textures) --> Graphics (context, programs) --> canvas
//               |            uniforms() of header, settings and view
//             Navigator (camera), Panel (what is seen around the picture)
//
// Numbers that depend on the view are computed in double precision, as flowtex/rendering/uniforms.py
// and flowtex/rendering/vtk/layer.py do, and so are the moves of flowtex/app/navigate.py.

/**
 * @typedef {[number, number, number]} Vector
 * @typedef {boolean | number | string} Value
 * @typedef {Record<string, Value>} Settings
 * @typedef {Float32Array | Uint16Array | Int16Array | Int8Array | Uint8Array} Data
 * @typedef {{ data: Data, shape: number[], digest?: string }} Part
 * @typedef {{ before: number, size: number }} Padding
 * @typedef {{
 *   name: string, kind: string, default: Value, affects: string, text: string,
 *   low: number | null, high: number | null, choices: string[],
 * }} Row
 * @typedef {{
 *   position: number[], focal_point: number[], up: number[],
 *   parallel: boolean, parallel_scale: number, view_angle: number,
 * }} CameraState
 * @typedef {{
 *   size: [number, number], grain: number, corrected: boolean, deviations: number[],
 *   repeat: [boolean, boolean], picture: boolean, grey: boolean, alongI: number[], alongJ: number[],
 * }} Paper
 * @typedef {{
 *   format: number, version: string, name: string, variant: string[],
 *   shaders: { vertex: string, fragment: string, pick: string },
 *   geometry: {
 *     shape: [number, number], rows: Padding, columns: Padding, levels: number, planar: boolean,
 *     extent: number, center: number[], frame: number[], periodic: [boolean, boolean],
 *   },
 *   slices: {
 *     count: number, channels: number, extra: number[], lags: number[], sides: number,
 *     unit: number, pace: number, steps: number, times: number[], timeUnit?: string,
 *   },
 *   scalars: {
 *     name: string | null, low: number, high: number, steps: number, unit: string, bar?: boolean,
 *   },
 *   colour: number[], background: number[], lighting: boolean, opacity?: number,
 *   paper: Paper | null,
 *   settings: Settings, table: Row[], camera: CameraState | null, time: number, clock: number,
 *   generation?: number, differs?: string[], own?: Settings, beside?: Header,
 * }} Header
 * @typedef {{
 *   focus: Vector, anchor: Vector, eye: number[], between: number, time: number, clock: number,
 * }} ViewState
 * @typedef {{ position: number[], index: [number, number], values: Record<string, number> }} Point
 * @typedef {boolean | number | number[] | Float32Array} Uniform
 */

// --- numbers ---------------------------------------------------------------------------------

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {number} */
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {Vector} */
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @param {number} [t] @returns {Vector} */
const plus = (a, b, t = 1) => [a[0] + t * b[0], a[1] + t * b[1], a[2] + t * b[2]];
/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b @returns {Vector} */
const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** @param {ArrayLike<number>} a @returns {Vector} */
const unit = (a) => {
  const length = Math.sqrt(dot(a, a)) || 1;
  return [a[0] / length, a[1] / length, a[2] / length];
};
/** @param {number} x @param {number} low @param {number} high @returns {number} */
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

/**
 * Turn a vector around a unit axis.
 * @param {Vector} v @param {Vector} axis @param {number} degrees @returns {Vector}
 */
function turned(v, axis, degrees) {
  const angle = (degrees * Math.PI) / 180;
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const along = dot(v, axis) * (1 - c);
  const aside = cross(axis, v);
  return plus(
    plus(
      v.map((x) => x * c),
      aside,
      s,
    ),
    axis,
    along,
  );
}

/** @param {number} bits @returns {number} */
function fromHalf(bits) {
  const exponent = (bits >> 10) & 31;
  const part = bits & 1023;
  const size =
    exponent === 0
      ? part * 2 ** -24
      : exponent === 31
        ? part
          ? NaN
          : Infinity
        : (1024 + part) * 2 ** (exponent - 25);
  return bits & 32768 ? -size : size;
}

/** @param {number} x @returns {number} */
function toHalf(x) {
  const sign = x < 0 ? 32768 : 0;
  const size = Math.abs(x);
  if (!(size < 65520)) return sign | (size >= 65520 ? 31744 : 32256);
  const exponent = Math.max(Math.floor(Math.log2(size || 1e-30)), -14);
  const part = Math.round(size / 2 ** (exponent - 10));
  // A part that rounds up to 2048 carries into the exponent by itself.
  return sign | (part < 1024 ? part : (exponent + 14) * 1024 + part);
}

/** @param {number} x @returns {string} */
function text(x) {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(4)));
}

// --- what the shaders are told -----------------------------------------------------------------

/** Octaves between the finest cell of the noise and the extent; octaves that the origin keeps clear. */
const OCTAVES = 30;
const SNAP = 9;
/** What the flow goes while a grain in motion takes one turn, in pixels. */
const WAVE = 96;
/** Coarse part of the clock, in base periods. */
const COARSE = 2 ** -12;
const KERNELS = ["hann", "box", "ramp"];
/** Heights of the view within which positions may be counted from another point than its middle. */
const NEAR = 8;

/**
 * Rows that take a vector of the mesh to the surface's frame, applied to one.
 * @param {Header} header @param {ArrayLike<number>} v @returns {Vector}
 */
function toFrame(header, v) {
  const f = header.geometry.frame;
  return [dot(f.slice(0, 3), v), dot(f.slice(3, 6), v), dot(f.slice(6, 9), v)];
}

/** @param {Header} header @param {ArrayLike<number>} v @returns {Vector} */
function fromFrame(header, v) {
  const f = header.geometry.frame;
  return [dot([f[0], f[3], f[6]], v), dot([f[1], f[4], f[7]], v), dot([f[2], f[5], f[8]], v)];
}

/**
 * The uniforms of shaders/common/uniforms.glsl, by name.
 *
 * `ratio` is how many pixels of what is drawn lie along a pixel of the page: grains and speeds that
 * are measured in pixels keep their size on the page.
 * @param {Header} header @param {Settings} settings @param {ViewState} view
 * @param {Part | undefined} noise @param {number} ratio
 * @returns {Record<string, Uniform>}
 */
export function uniforms(header, settings, view, noise = undefined, ratio = 1) {
  const { geometry, slices } = header;
  const s = /** @type {Record<string, any>} */ (settings);
  const signFree = header.variant.includes("FLOWTEX_SIGNFREE");
  const finest = 2 ** (Math.floor(Math.log2(geometry.extent)) - OCTAVES);
  const motion = moves(header, settings, view, ratio);
  const w = view.eye[3];
  const eye = toFrame(
    header,
    minus(
      view.eye,
      geometry.center.map((c) => c * w),
    ),
  );
  return {
    u_eye: [
      ...minus(
        eye,
        view.anchor.map((c) => c * w),
      ),
      w,
    ],
    u_between: view.between,
    u_slicesSize: [geometry.columns.size, geometry.rows.size],
    u_deepest: geometry.levels,
    u_lags: slices.lags,
    u_lagCount: slices.lags.length,
    u_sides: s.two_sided || signFree ? slices.sides : 1,
    u_unit: slices.unit,
    u_samples: motion.u_moving ? 2 * s.samples - 1 : s.samples,
    u_spacing: s.spacing,
    // A grain much smaller than a pixel would only be grey.
    u_grain: Math.max(s.grain * ratio, Math.min(s.grain, 1)),
    u_kernel: signFree && s.kernel === "ramp" ? 0 : KERNELS.indexOf(s.kernel),
    u_lod: s.lod,
    u_contrast: s.contrast,
    u_strength: s.strength,
    u_seed: s.seed,
    u_showLevel: s.show_level,
    u_fixed: s.fixed_grain,
    ...motion,
    ...noiseOrigin(header, view, finest),
    u_noiseFinest: finest,
    u_texel: geometry.extent / s.resolution,
    ...(header.paper && noise ? paperUniforms(header.paper, settings, noise) : {}),
  };
}

/**
 * How the grains change: with the time of a field that varies, by the clock of a steady one.
 * @param {Header} header @param {Settings} settings @param {ViewState} view @param {number} ratio
 * @returns {Record<string, Uniform>}
 */
function moves(header, settings, view, ratio) {
  const { geometry, slices } = header;
  const s = /** @type {Record<string, any>} */ (settings);
  const varies = slices.steps > 1;
  const inPixels = !varies && s.speed_in === "pixels";
  // The time in which the flow crosses the surface, or the setting's.
  const turns = varies
    ? ((view.time - slices.times[0]) * slices.pace) / geometry.extent
    : (((view.clock / s.period) % 1) + 1) % 1;
  const travel = varies ? geometry.extent : s.speed * s.period * (inPixels ? ratio : 1);
  const streams = s.motion !== "off" && !header.variant.includes("FLOWTEX_SIGNFREE");
  const coarse = Math.floor(turns / COARSE) * COARSE;
  return {
    u_moving: (varies || streams) && !header.paper,
    u_clock: [coarse, turns - coarse],
    u_travel: travel,
    u_travelInPixels: inPixels,
    u_travelBySpeed: varies || s.motion === "speed",
    u_wave: WAVE * ratio,
  };
}

/**
 * The noise's origin in space and in the finest cells of both families of lattices.
 * @param {Header} header @param {ViewState} view @param {number} finest
 * @returns {Record<string, Uniform>}
 */
function noiseOrigin(header, view, finest) {
  const focus = toFrame(header, minus(view.focus, header.geometry.center));
  const limit = 2 ** (OCTAVES - SNAP) - 1;
  const even = focus.map(
    (x) => clamp(Math.round(x / finest / 2 ** SNAP), -limit, limit) * 2 ** SNAP,
  );
  const odd = even.map((x) => x / Math.SQRT2);
  const whole = odd.map((x) => Math.floor(x / 2 ** SNAP) * 2 ** SNAP);
  return {
    u_noiseOrigin: even.map((x, k) => x * finest - view.anchor[k]),
    u_noiseOriginEven: even,
    u_noiseOriginOdd: whole,
    u_noiseRestOdd: odd.map((x, k) => x - whole[k]),
  };
}

/** @param {Paper} paper @param {Settings} settings @param {Part} noise @returns {Record<string, Uniform>} */
function paperUniforms(paper, settings, noise) {
  const tiles = settings.noise === "image" ? Number(settings.tiles) : 1;
  const [rows, columns] = noise.shape;
  return {
    u_noiseSize: paper.size,
    u_noiseGrain: paper.grain,
    u_noiseDeviation: paper.deviations,
    u_noiseCorrected: paper.corrected,
    u_pictureSize: [columns * tiles, rows * tiles],
    u_pictureRound: [Number(paper.repeat[1]), Number(paper.repeat[0])],
    u_pictureGrey: noise.shape.length === 2,
    u_tiles: tiles,
  };
}

/**
 * The two time steps around a time, and how far it is between them.
 * @param {number[]} times @param {number} time @returns {[number, number, number]}
 */
export function moment(times, time) {
  if (times.length < 2) return [0, 0, 0];
  let step = 0;
  while (step < times.length - 2 && times[step + 1] <= time) step += 1;
  const late = (time - times[step]) / (times[step + 1] - times[step]);
  return [step, step + 1, clamp(late, 0, 1)];
}

// --- the camera --------------------------------------------------------------------------------

/** Farthest in and out, relative to the whole surface; how many times closer the camera comes. */
const DEEPEST = 1e6;
const FARTHEST = 0.25;
const CLOSEST = 16;
/** View angle in perspective, in degrees; zoom by one notch of the wheel; empty share around. */
const ANGLE = 30;
const NOTCH = 1.25;
const MARGIN = 0.04;
/** Width over height that a view in perspective is usually made for. */
const ASPECT = 1.5;

/** Moves a camera. Places in the view are (x, y) from -1 to 1, right and up. */
export class Navigator {
  /** @param {CameraState} camera @param {boolean} flat whether a drag pans, otherwise it turns */
  constructor(camera, flat) {
    this.flat = flat;
    this.aspect = 1;
    /** @type {((x: number, y: number) => Vector | null) | null} */
    this.hit = null;
    this.camera = copied(camera);
    this.start = copied(camera);
    this._home = this.height;
    this._nearest = this.distance / CLOSEST;
  }

  /** Half the height of the view at the focal point. */
  get height() {
    const c = this.camera;
    if (c.parallel) return c.parallel_scale;
    return this.distance * Math.tan((c.view_angle * Math.PI) / 360);
  }

  get distance() {
    const ahead = minus(this.camera.focal_point, this.camera.position);
    return Math.sqrt(dot(ahead, ahead));
  }

  /** How far in: 1 is the view that the scene came with. */
  get zoom() {
    return this._home / this.height;
  }

  /** Unit vectors to the right of the view, upwards, and away from the eye. @returns {Vector[]} */
  get axes() {
    const ahead = unit(minus(this.camera.focal_point, this.camera.position));
    const right = unit(cross(ahead, this.camera.up));
    return [right, cross(right, ahead), ahead];
  }

  /** The eye and 1, or the way to it and 0 where all rays are parallel. @returns {number[]} */
  get eye() {
    if (!this.camera.parallel) return [...this.camera.position, 1];
    return [...this.axes[2].map((c) => -c), 0];
  }

  /** @param {number} dx @param {number} dy parts of the view */
  pan(dx, dy) {
    const [right, up] = this.axes;
    const h = this.height;
    this._shift(
      plus(
        right.map((c) => c * dx * this.aspect * h),
        up,
        dy * h,
      ),
    );
  }

  /** Go around the focal point, by half a turn for the whole view. @param {number} dx @param {number} dy */
  turn(dx, dy) {
    const c = this.camera;
    const up = unit(c.up);
    let back = minus(c.position, c.focal_point);
    back = turned(back, up, -90 * dx * Math.min(this.aspect, 2));
    const right = unit(cross(up, back));
    back = turned(back, right, 90 * dy);
    c.position = plus(c.focal_point, back);
    c.up = unit(cross(back, right));
  }

  /** Zoom in; the point at (x, y) stays where it is. @param {number} factor @param {number} [x] @param {number} [y] */
  zoomBy(factor, x = 0, y = 0) {
    if (!Number.isFinite(factor) || factor <= 0) return;
    if (!this.flat) this._focusAt(x, y);
    const by = clamp(factor, FARTHEST / this.zoom, DEEPEST / this.zoom);
    const [right, up, ahead] = this.axes;
    const h = this.height * (1 - 1 / by);
    this._shift(
      plus(
        right.map((c) => c * x * this.aspect * h),
        up,
        y * h,
      ),
    );
    if (this.camera.parallel) this.camera.parallel_scale /= by;
    else this._comeTo(this.height / by, ahead);
  }

  /** Come closer, and from near look more narrowly. @param {number} height @param {Vector} ahead */
  _comeTo(height, ahead) {
    const half = Math.tan((ANGLE * Math.PI) / 360);
    const distance = Math.max(height / half, this._nearest);
    this.camera.position = plus(this.camera.focal_point, ahead, -distance);
    this.camera.view_angle = (Math.atan(height / distance) * 360) / Math.PI;
  }

  /** Bring the focal point to the depth of what is at a place. @param {number} x @param {number} y */
  _focusAt(x, y) {
    const point = this.hit?.(x, y);
    if (!point) return;
    const ahead = this.axes[2];
    const depth = dot(minus(point, this.camera.position), ahead);
    if (depth > 0) this.camera.focal_point = plus(this.camera.position, ahead, depth);
  }

  /** @param {Vector} by */
  _shift(by) {
    this.camera.focal_point = plus(this.camera.focal_point, by);
    this.camera.position = plus(this.camera.position, by);
  }

  /**
   * Start and direction of the ray through a place of the view.
   * @param {number} x @param {number} y @returns {[Vector, Vector]}
   */
  ray(x, y) {
    const [right, up, ahead] = this.axes;
    const h = this.height;
    const focus = this.camera.focal_point;
    const there = plus(plus(focus, right, x * this.aspect * h), up, y * h);
    if (this.camera.parallel) return [plus(there, ahead, -this.distance), ahead];
    return [plus(this.camera.position, [0, 0, 0]), unit(minus(there, this.camera.position))];
  }
}

/** @param {CameraState} c @returns {CameraState} */
function copied(c) {
  return { ...c, position: [...c.position], focal_point: [...c.focal_point], up: [...c.up] };
}

/**
 * A camera that shows the whole surface.
 * @param {Header} header @param {Part} position @param {number} aspect @returns {CameraState}
 */
function fitted(header, position, aspect) {
  const { center, extent, planar } = header.geometry;
  const half = Math.tan((ANGLE * Math.PI) / 360);
  const back = planar ? fromFrame(header, [0, 0, 1]) : unit([1, 1, 1]);
  const up = planar ? fromFrame(header, [0, 1, 0]) : /** @type {Vector} */ ([0, 0, 1]);
  const right = unit(cross(up, back));
  const rows = [right, cross(back, right), back].map((v) => toFrame(header, v));
  const low = [Infinity, Infinity],
    high = [-Infinity, -Infinity];
  let distance = 0;
  for (let n = 0; n < position.data.length; n += 3) {
    const p = [position.data[n], position.data[n + 1], position.data[n + 2]];
    if (!Number.isFinite(p[0])) continue;
    const [x, y, z] = rows.map((row) => dot(row, p));
    ((low[0] = Math.min(low[0], x)), (low[1] = Math.min(low[1], y)));
    ((high[0] = Math.max(high[0], x)), (high[1] = Math.max(high[1], y)));
    const wide = Math.max(Math.abs(x) / aspect, Math.abs(y));
    distance = Math.max(distance, z + wide / half / (1 - 2 * MARGIN));
  }
  const tall = Math.max(high[1] - low[1], (high[0] - low[0]) / aspect, 1e-12 * extent);
  return {
    position: plus(center, back, planar ? extent : distance),
    focal_point: [...center],
    up,
    parallel: planar,
    parallel_scale: (0.5 * tall) / (1 - 2 * MARGIN),
    view_angle: ANGLE,
  };
}

/**
 * A camera that shows all of a surface in the shape of picture that it was made for, in another
 * shape; any other camera as it is.
 * @param {Header} header @param {CameraState} given @param {Part} position @param {number} aspect
 * @returns {CameraState}
 */
function widened(header, given, position, aspect) {
  const { center, extent, planar } = header.geometry;
  const camera = copied(given);
  const aside = minus(given.focal_point, center);
  if (Math.sqrt(dot(aside, aside)) > 1e-3 * extent) return camera;
  if (planar && given.parallel) {
    const [high, all] = [1e9, aspect].map((a) => fitted(header, position, a).parallel_scale);
    if (given.parallel_scale > 0.98 * high) {
      camera.parallel_scale = Math.max(given.parallel_scale, all);
    }
  } else if (!given.parallel && given.view_angle > 0.9 * ANGLE) {
    const back = minus(given.position, given.focal_point);
    camera.position = plus(given.focal_point, back, Math.max(1, ASPECT / aspect));
  }
  return camera;
}

/** Whether two scenes lie in the same place, as a coarse form and the whole one. @param {Header} a @param {Header} b */
function sameplace(a, b) {
  const [one, other] = [a.geometry, b.geometry];
  const apart = minus(one.center, other.center);
  const near = Math.sqrt(dot(apart, apart)) < 0.1 * one.extent;
  const ratio = one.extent / other.extent;
  return one.planar === other.planar && near && ratio > 0.8 && ratio < 1.25;
}

/**
 * Matrix from the surface's frame, counted from an anchor, to clip space, in columns.
 *
 * Counting from the focal point in both axes of the picture keeps the digits of a close view.
 * @param {Header} header @param {Navigator} navigator @param {Vector} anchor
 * @returns {Float64Array}
 */
function projection(header, navigator, anchor) {
  const { camera, aspect } = navigator;
  const { center, extent } = header.geometry;
  const [right, up, ahead] = navigator.axes.map((v) => toFrame(header, v));
  const local = (/** @type {ArrayLike<number>} */ p) =>
    minus(toFrame(header, minus(p, center)), anchor);
  const focus = local(camera.focal_point);
  const middle = minus([0, 0, 0], anchor);
  const radius = 0.51 * extent;
  const m = new Float64Array(16);
  const half = camera.parallel
    ? camera.parallel_scale
    : Math.tan((camera.view_angle * Math.PI) / 360);
  const rows = [right.map((c) => c / half / aspect), up.map((c) => c / half)];
  rows.forEach((row, k) => {
    for (let n = 0; n < 3; n += 1) m[4 * n + k] = row[n];
    m[12 + k] = -dot(row, focus);
  });
  if (camera.parallel) {
    for (let n = 0; n < 3; n += 1) m[4 * n + 2] = ahead[n] / radius;
    m[14] = -dot(ahead, middle) / radius;
    m[15] = 1;
    return m;
  }
  const eye = local(camera.position);
  const depth = dot(minus(middle, eye), ahead);
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

// --- the graphics card -------------------------------------------------------------------------

/** Before a shader's text, which has neither version nor precisions of its own. */
const PREAMBLE = ["#version 300 es", "precision highp float;", "precision highp int;", ""].join(
  "\n",
);
const ATTRIBUTES = [
  "flowtexPosition",
  "flowtexCoordinate",
  "flowtexNormal",
  "flowtexNoise",
  "flowtexScalar",
];
const SAMPLERS = ["u_slices", "u_slicesNext", "u_noiseImage", "u_stepImage", "u_cmap"];
/** Samples of a pixel on the outline; rows that are drawn with them at a time. */
const OUTLINE = 4;
const SMOOTH = 256;
/** Milliseconds that all viewers may draw in one frame of the page. */
const TURN = 45;
/** Key of what all copies of this module on a page share. */
const SHARED = Symbol.for("flowtex.gl/2");

/**
 * @typedef {{
 *   program: WebGLProgram, ready: boolean, error: string, warm: boolean, price: number,
 *   uniforms: Map<string, { at: WebGLUniformLocation, type: number }>,
 *   shaders: WebGLShader[],
 * }} Program
 * @typedef {{ kind: string, object: object, count: number, key: string, users: number }} Made
 * @typedef {{ frame: WebGLFramebuffer, buffers: WebGLRenderbuffer[] }} Target
 * @typedef {{ frame(now: number, until: number): void, lost(): void, restored(): void }} User
 */

/** The context of a page, and what its viewers share. */
class Graphics {
  constructor() {
    this.canvas = document.createElement("canvas");
    this.canvas.width = this.canvas.height = 16;
    this.gl = this.canvas.getContext("webgl2", {
      // Multisampled pictures are copied in, which takes the same format on both sides.
      alpha: true,
      antialias: false,
      powerPreference: "high-performance",
    });
    /** @type {Map<string, Program>} */
    this.programs = new Map();
    /** @type {Set<User>} */
    this.users = new Set();
    /** @type {Set<User>} */
    this.waiting = new Set();
    // What views of the same scene have in common: objects by what they were made of, and arrays.
    /** @type {Map<string, Made>} */
    this.common = new Map();
    /** @type {Map<string, { part: Part, users: number }>} */
    this.stock = new Map();
    this.objects = 0;
    this.isLost = false;
    this.restorations = 0;
    this._frame = 0;
    /** @type {Target | null} */
    this._picker = null;
    /** @type {(Target & { width: number, height: number }) | null} */
    this._smooth = null;
    this._features();
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.isLost = true;
      this.objects = 0;
      this.programs.clear();
      this.common.clear();
      this._picker = this._smooth = null;
      for (const user of this.users) user.lost();
    });
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.isLost = false;
      this.restorations += 1;
      this._features();
      for (const user of this.users) user.restored();
    });
  }

  _features() {
    const gl = this.gl;
    this.floats = gl
      ? Boolean(
          gl.getExtension("EXT_color_buffer_float") ||
          gl.getExtension("EXT_color_buffer_half_float"),
        )
      : false;
    this.parallel = gl ? gl.getExtension("KHR_parallel_shader_compile") : null;
  }

  /** @returns {WebGL2RenderingContext} */
  get context() {
    if (!this.gl) throw new Error("there is no WebGL2");
    return this.gl;
  }

  /** @param {User} user */
  enter(user) {
    this.users.add(user);
  }

  /** @param {User} user */
  leave(user) {
    this.users.delete(user);
    this.waiting.delete(user);
    if (this.users.size) return;
    cancelAnimationFrame(this._frame);
    this._frame = 0;
    for (const entry of this.programs.values()) {
      for (const shader of entry.shaders) this.free("Shader", shader);
      this.free("Program", entry.program);
    }
    this.programs.clear();
    for (const target of [this._picker, this._smooth]) if (target) this._freeTarget(target);
    this._picker = this._smooth = null;
    this.canvas.width = this.canvas.height = 16;
  }

  /** Call `user.frame` when its turn comes. @param {User} user */
  request(user) {
    this.waiting.add(user);
    if (!this._frame) this._frame = requestAnimationFrame((now) => this._run(now));
  }

  /** @param {number} now */
  _run(now) {
    this._frame = 0;
    const until = performance.now() + TURN;
    // Those that ask again go to the end of the line.
    for (const user of [...this.waiting]) {
      this.waiting.delete(user);
      user.frame(now, until);
      if (performance.now() > until) break;
    }
    if (this.waiting.size && !this._frame) {
      this._frame = requestAnimationFrame((then) => this._run(then));
    }
  }

  /**
   * Count an object that was made.
   * @template T @param {T | null} object @returns {T}
   */
  made(object) {
    if (object === null)
      {throw new Error("the graphics card has no memory left, or the context is lost");}
    this.objects += 1;
    return object;
  }

  /** Hold an array for one more view; where it is there already that one is returned. @param {Part} part @returns {Part} */
  hold(part) {
    if (!part.digest) return part;
    const known = this.stock.get(part.digest);
    if (!known) this.stock.set(part.digest, { part, users: 1 });
    else known.users += 1;
    return known?.part ?? part;
  }

  /** @param {Part | undefined} part */
  release(part) {
    const known = part?.digest ? this.stock.get(part.digest) : undefined;
    if (!part?.digest || !known) return;
    known.users -= 1;
    if (!known.users) this.stock.delete(part.digest);
  }

  /** @param {string} kind @param {object | null} object */
  free(kind, object) {
    if (object === null || this.isLost) return;
    this.objects -= 1;
    /** @type {any} */ (this.gl)[`delete${kind}`](object);
  }

  /**
   * Program of two texts, built in the background where the browser can.
   * @param {string} vertex @param {string} fragment @returns {Program}
   */
  program(vertex, fragment) {
    const key = `${vertex}\0${fragment}`;
    let entry = this.programs.get(key);
    if (!entry) this.programs.set(key, (entry = this._build(vertex, fragment)));
    if (!entry.ready && !entry.error) this._finish(entry);
    return entry;
  }

  /** @param {string} vertex @param {string} fragment @returns {Program} */
  _build(vertex, fragment) {
    const gl = this.context;
    const program = this.made(gl.createProgram());
    const kinds = [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER];
    const shaders = [vertex, fragment].map((source, n) => {
      const shader = this.made(gl.createShader(kinds[n]));
      gl.shaderSource(shader, source.startsWith("#version") ? source : PREAMBLE + source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    ATTRIBUTES.forEach((name, n) => gl.bindAttribLocation(program, n, name));
    gl.linkProgram(program);
    return {
      program,
      shaders,
      ready: false,
      error: "",
      warm: false,
      price: 4e-5,
      uniforms: new Map(),
    };
  }

  /** @param {Program} entry */
  _finish(entry) {
    const gl = this.context;
    const { program } = entry;
    const done = this.parallel?.COMPLETION_STATUS_KHR;
    if (done && !gl.getProgramParameter(program, done)) return;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      if (gl.isContextLost()) return;
      const logs = entry.shaders.map((shader) => gl.getShaderInfoLog(shader) ?? "");
      entry.error = [...logs, gl.getProgramInfoLog(program) ?? ""].filter(Boolean).join("\n");
      entry.error ||= "the driver gave no reason";
      return;
    }
    for (const shader of entry.shaders) this.free("Shader", shader);
    entry.shaders = [];
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let n = 0; n < count; n += 1) {
      const info = gl.getActiveUniform(program, n);
      const at = info && gl.getUniformLocation(program, info.name);
      if (info && at) entry.uniforms.set(info.name.replace(/\[0\]$/, ""), { at, type: info.type });
    }
    gl.useProgram(program);
    SAMPLERS.forEach((name, n) => {
      const known = entry.uniforms.get(name);
      if (known) gl.uniform1i(known.at, n);
    });
    entry.ready = true;
  }

  /** @param {Program} entry @param {Record<string, Uniform>} values */
  write(entry, values) {
    const gl = this.context;
    gl.useProgram(entry.program);
    for (const [name, value] of Object.entries(values)) {
      const known = entry.uniforms.get(name);
      if (!known) continue;
      const { at, type } = known;
      const list = typeof value === "object" ? value : [Number(value)];
      if (type === gl.FLOAT) gl.uniform1fv(at, list);
      else if (type === gl.FLOAT_VEC2) gl.uniform2fv(at, list);
      else if (type === gl.FLOAT_VEC3) gl.uniform3fv(at, list);
      else if (type === gl.FLOAT_VEC4) gl.uniform4fv(at, list);
      else if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(at, false, list);
      else gl.uniform1i(at, list[0]);
    }
  }

  /** Make the canvas large enough. @param {number} width @param {number} height */
  reserve(width, height) {
    if (this.canvas.width < width) this.canvas.width = width;
    if (this.canvas.height < height) this.canvas.height = height;
  }

  /** Wait until everything is drawn. */
  settle() {
    this.context.readPixels(
      0,
      0,
      1,
      1,
      this.context.RGBA,
      this.context.UNSIGNED_BYTE,
      new Uint8Array(4),
    );
  }

  /**
   * What is drawn into instead of the canvas.
   * @param {number} format @param {number} width @param {number} height @param {number} samples
   * @returns {Target}
   */
  _target(format, width, height, samples) {
    const gl = this.context;
    const frame = this.made(gl.createFramebuffer());
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    /** @type {[number, number][]} */
    const kinds = [
      [format, gl.COLOR_ATTACHMENT0],
      [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT],
    ];
    const buffers = kinds.map(([kind, attachment]) => {
      const buffer = this.made(gl.createRenderbuffer());
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, kind, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      return buffer;
    });
    return { frame, buffers };
  }

  /** @param {Target} target */
  _freeTarget(target) {
    this.free("Framebuffer", target.frame);
    for (const buffer of target.buffers) this.free("Renderbuffer", buffer);
  }

  /** Draw from now on with smooth outlines, into rows that `copySmooth` takes over. @param {number} width @param {number} rows */
  bindSmooth(width, rows) {
    const gl = this.context;
    const was = this._smooth;
    if (!was || was.width < width || was.height < rows) {
      const size = {
        width: Math.max(width, was?.width ?? 0),
        height: Math.max(rows, was?.height ?? 0),
      };
      if (was) this._freeTarget(was);
      this._smooth = { ...this._target(gl.RGBA8, size.width, size.height, OUTLINE), ...size };
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, /** @type {Target} */ (this._smooth).frame);
  }

  /** Put what was drawn into the lowest rows of the canvas: samples stay in place. @param {number} width @param {number} rows */
  copySmooth(width, rows) {
    const gl = this.context;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, /** @type {Target} */ (this._smooth).frame);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(0, 0, width, rows, 0, 0, width, rows, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Draw into a pixel of whole numbers, and read it. @param {() => void} draw @returns {Uint32Array} */
  pick(draw) {
    const gl = this.context;
    this._picker ??= this._target(gl.RGBA32UI, 1, 1, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this._picker.frame);
    gl.viewport(0, 0, 1, 1);
    gl.disable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    draw();
    const bits = new Uint32Array(4);
    gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return bits;
  }
}

/** @returns {Graphics} */
function sharedGraphics() {
  const page = /** @type {Record<symbol, Graphics>} */ (/** @type {unknown} */ (globalThis));
  return (page[SHARED] ??= new Graphics());
}

/** The buffers and textures of one scene, made of its parts when they are first drawn. */
class Drawing {
  /** @param {Graphics} graphics @param {Header} header @param {Map<string, Part>} parts */
  constructor(graphics, header, parts) {
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
    /** @type {Map<string, Made>} */
    this._made = new Map();
    /** @type {Vector} */
    this.anchor = [0, 0, 0];
    this._scalars = "";
  }

  /** Names of the parts that a moment needs and that are not there. @param {number} before @param {number} after */
  missing(before, after) {
    const { header } = this;
    const names = ["position", ...(header.geometry.planar ? [] : ["normal"])];
    for (const step of new Set([before, after])) {
      names.push(`slices/${step}`);
      if (header.slices.channels === 2) names.push(`extra/${step}`);
      if (header.scalars.name !== null && (step === before || header.scalars.steps > 1)) {
        names.push(`scalars/${header.scalars.steps > 1 ? step : 0}`);
      }
    }
    if (header.scalars.name !== null) names.push("cmap");
    if (header.paper) names.push("noise", "step");
    return [...new Set(names)].filter((name) => !this._fits(name));
  }

  /** Whether a part is there and is of this scene: while one is built anew those of the last come first. @param {string} name */
  _fits(name) {
    const part = this.parts.get(name);
    if (!part) return false;
    const { geometry, slices, paper } = this.header;
    /** @type {Record<string, number[]>} */
    const shapes = {
      slices: [slices.count, geometry.rows.size, geometry.columns.size, slices.channels],
      position: [...geometry.shape, 3],
      step: paper ? [paper.size[1], paper.size[0]] : [],
    };
    const shape = shapes[name.split("/")[0]];
    return !shape || equal(shape, part.shape);
  }

  /** @param {string} name @returns {Part} */
  part(name) {
    const part = this.parts.get(name);
    if (!part) throw new Error(`the part "${name}" of the scene is missing`);
    return part;
  }

  /** Forget what was made of a part, as it has changed. @param {string} name */
  forget(name) {
    const [kind, step] = name.split("/");
    const users = {
      position: ["position", "coordinate"],
      normal: ["normal"],
      cells: ["index"],
      cmap: ["cmap"],
      noise: ["noise"],
      step: ["step"],
      scalars: ["scalar"],
      slices: [`slices/${step}`],
      extra: [`slices/${step}`],
    }[kind];
    for (const user of users ?? []) this._drop(user);
    this._drop("array");
  }

  /** @param {string} name */
  _drop(name) {
    const made = this._made.get(name);
    this._made.delete(name);
    if (!made) return;
    made.users -= 1;
    if (made.users) return;
    this.graphics.free(made.kind, made.object);
    this.graphics.common.delete(made.key);
  }

  dispose() {
    for (const name of [...this._made.keys()]) this._drop(name);
  }

  /**
   * What some parts are known by on the whole page; nothing where one of them has no digest.
   * @param {string[]} names @param {unknown[]} rest @returns {string}
   */
  _key(names, ...rest) {
    const digests = names.map((name) => (this.parts.has(name) ? this.part(name).digest : "none"));
    return digests.every(Boolean) ? JSON.stringify([digests, rest]) : "";
  }

  /**
   * An object by its name, made when it is first needed; `key` finds that of another view.
   * @template {object} T @param {string} name @param {string} kind @param {string} key
   * @param {() => T | null} make @param {(object: T) => number | void} fill gives a count
   * @returns {T}
   */
  _take(name, kind, key, make, fill) {
    const known = this._made.get(name);
    if (known) return /** @type {T} */ (known.object);
    const { common } = this.graphics;
    const whole = key && `${name.split("/")[0]} ${key}`;
    const theirs = whole ? common.get(whole) : undefined;
    if (theirs) {
      theirs.users += 1;
      this._made.set(name, theirs);
      return /** @type {T} */ (theirs.object);
    }
    const object = this.graphics.made(make());
    const made = { kind, object, count: 0, key: whole, users: 1 };
    this._made.set(name, made);
    made.count = fill(object) || 0;
    if (whole) common.set(whole, made);
    return object;
  }

  /**
   * @param {string} name @param {string} key @param {() => Data | Uint32Array} data
   * @param {boolean} [elements] @returns {WebGLBuffer}
   */
  _buffer(name, key, data, elements = false) {
    const gl = this.graphics.context;
    return this._take(
      name,
      "Buffer",
      key,
      () => gl.createBuffer(),
      (buffer) => {
        const target = elements ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
        const numbers = data();
        gl.bindVertexArray(null);
        gl.bindBuffer(target, buffer);
        gl.bufferData(target, numbers, gl.STATIC_DRAW);
        return numbers.length;
      },
    );
  }

  /** Triangles of the cells that are drawn. @returns {Uint32Array} */
  _triangles() {
    const [rows, columns] = this.header.geometry.shape;
    const drawn = this.parts.get("cells")?.data;
    const index = new Uint32Array(6 * (rows - 1) * (columns - 1));
    let n = 0;
    for (let j = 0, cell = 0; j < rows - 1; j += 1) {
      for (let i = 0; i < columns - 1; i += 1, cell += 1) {
        if (drawn && !drawn[cell]) continue;
        const corner = j * columns + i;
        const far = corner + columns + 1;
        ((index[n++] = corner), (index[n++] = corner + 1), (index[n++] = far));
        ((index[n++] = corner), (index[n++] = far), (index[n++] = far - 1));
      }
    }
    return index.subarray(0, n);
  }

  /** Nodes relative to the anchor. @returns {Float32Array} */
  _positions() {
    const data = /** @type {Float32Array} */ (this.part("position").data);
    const [x, y, z] = this.anchor;
    if (!x && !y && !z) return data;
    const moved = new Float32Array(data.length);
    for (let n = 0; n < data.length; n += 3) {
      moved[n] = data[n] - x;
      moved[n + 1] = data[n + 1] - y;
      moved[n + 2] = data[n + 2] - z;
    }
    return moved;
  }

  /** Coordinates of the nodes in the slices: middles of texels. @returns {Float32Array} */
  _coordinates() {
    const { shape, rows, columns } = this.header.geometry;
    const result = new Float32Array(2 * shape[0] * shape[1]);
    for (let j = 0, n = 0; j < shape[0]; j += 1) {
      for (let i = 0; i < shape[1]; i += 1) {
        result[n++] = (i + columns.before + 0.5) / columns.size;
        result[n++] = (j + rows.before + 0.5) / rows.size;
      }
    }
    return result;
  }

  /** Coordinates of the nodes in the noise texture. @returns {Float32Array} */
  _along() {
    const [rows, columns] = this.header.geometry.shape;
    const { alongI: u, alongJ: v } = /** @type {Paper} */ (this.header.paper);
    const result = new Float32Array(2 * rows * columns);
    for (let j = 0, n = 0; j < rows; j += 1) {
      for (let i = 0; i < columns; i += 1) {
        result[n++] = u[i];
        result[n++] = v[j];
      }
    }
    return result;
  }

  /** Values as shares of the colour map's range. @param {number} before @param {number} after */
  _shares(before, after) {
    const { scalars, geometry } = this.header;
    const nodes = geometry.shape[0] * geometry.shape[1];
    const result = new Float32Array(2 * nodes);
    if (scalars.name === null) return result;
    const steps = scalars.steps > 1 ? [before, after] : [0, 0];
    const span = scalars.high - scalars.low || 1;
    steps.forEach((step, k) => {
      const values = this.part(`scalars/${step}`).data;
      for (let n = 0; n < nodes; n += 1) {
        const share = (values[n] - scalars.low) / span;
        result[2 * n + k] = Number.isFinite(share) ? share : -1e9;
      }
    });
    return result;
  }

  /** Make ready to draw the nodes. @param {number} before @param {number} after @param {Vector} anchor */
  _bindNodes(before, after, anchor) {
    const gl = this.graphics.context;
    const scalars = this.header.scalars.steps > 1 ? `${before} ${after}` : "0";
    if (scalars !== this._scalars) (this._drop("scalar"), this._drop("array"));
    if (anchor.some((x, k) => x !== this.anchor[k])) (this._drop("position"), this._drop("array"));
    this._scalars = scalars;
    this.anchor = anchor;
    const { geometry, scalars: range } = this.header;
    const own = range.name === null ? [] : range.steps > 1 ? [before, after] : [0];
    const painted = own.map((step) => `scalars/${step}`);
    const array = this._take(
      "array",
      "VertexArray",
      "",
      () => gl.createVertexArray(),
      (made) => {
        const grid = JSON.stringify([geometry.shape, geometry.rows, geometry.columns]);
        const cells = this._key(["cells"], geometry.shape);
        const index = this._buffer("index", cells, () => this._triangles(), true);
        const normal = this.header.geometry.planar ? null : this.part("normal").data;
        const kind =
          normal instanceof Int8Array
            ? gl.BYTE
            : normal instanceof Int16Array
              ? gl.SHORT
              : gl.FLOAT;
        /** @type {[WebGLBuffer | null, number, number][]} */
        const attributes = [
          [
            this._buffer("position", this._key(["position"], anchor), () => this._positions()),
            3,
            gl.FLOAT,
          ],
          [this._buffer("coordinate", grid, () => this._coordinates()), 2, gl.FLOAT],
          [normal ? this._buffer("normal", this._key(["normal"]), () => normal) : null, 3, kind],
          [this.header.paper ? this._buffer("along", "", () => this._along()) : null, 2, gl.FLOAT],
          [
            this._buffer(
              "scalar",
              this._key(painted, geometry.shape, range.low, range.high),
              () => this._shares(before, after),
            ),
            2,
            gl.FLOAT,
          ],
        ];
        gl.bindVertexArray(made);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index);
        attributes.forEach(([buffer, size, type], n) => {
          if (!buffer) return;
          gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
          gl.enableVertexAttribArray(n);
          gl.vertexAttribPointer(n, size, type, type !== gl.FLOAT, 0, 0);
        });
      },
    );
    gl.bindVertexArray(array);
  }

  /** @param {number} step @returns {WebGLTexture} */
  _slices(step) {
    const { slices, geometry } = this.header;
    const gl = this.graphics.context;
    return this._take(
      `slices/${step}`,
      "Texture",
      this._key([`slices/${step}`, `extra/${step}`], geometry.levels, slices.extra),
      () => gl.createTexture(),
      (texture) => {
        const [layers, height, width, channels] = this.part(`slices/${step}`).shape;
        const data = /** @type {Uint16Array} */ (this.part(`slices/${step}`).data);
        const extra = /** @type {Uint16Array | undefined} */ (
          this.parts.get(`extra/${step}`)?.data
        );
        const layer = (/** @type {number} */ n) => {
          const size = height * width;
          const from = data.subarray(n * size * channels, (n + 1) * size * channels);
          if (channels === 4) return from;
          const texels = new Uint16Array(4 * size);
          const at = slices.extra.indexOf(n);
          const fourth = extra && at >= 0 ? extra.subarray(at * size, (at + 1) * size) : null;
          for (let k = 0; k < size; k += 1) {
            texels[4 * k] = from[2 * k];
            texels[4 * k + 1] = from[2 * k + 1];
            if (fourth) texels[4 * k + 3] = fourth[k];
          }
          return texels;
        };
        this._fill(texture, { width, height, layers, channels: 4, levels: geometry.levels }, layer);
      },
    );
  }

  /** @param {string} name @param {[boolean, boolean]} repeat along (v, u) @returns {WebGLTexture} */
  _image(name, repeat) {
    const gl = this.graphics.context;
    return this._take(
      name,
      "Texture",
      this._key([name], repeat),
      () => gl.createTexture(),
      (texture) => {
        const { data, shape } = this.part(name);
        const [height, width, channels = 1] = shape;
        const levels = Math.floor(Math.log2(Math.max(width, height)));
        this._fill(
          texture,
          { width, height, layers: 1, channels, levels },
          () => /** @type {Uint16Array} */ (data),
        );
        gl.texParameteri(
          gl.TEXTURE_2D_ARRAY,
          gl.TEXTURE_WRAP_S,
          repeat[1] ? gl.REPEAT : gl.CLAMP_TO_EDGE,
        );
        gl.texParameteri(
          gl.TEXTURE_2D_ARRAY,
          gl.TEXTURE_WRAP_T,
          repeat[0] ? gl.REPEAT : gl.CLAMP_TO_EDGE,
        );
      },
    );
  }

  /**
   * Send the layers of a half-precision texture array, and make its mip levels.
   * @param {WebGLTexture} texture
   * @param {{ width: number, height: number, layers: number, channels: number, levels: number }} size
   * @param {(n: number) => Uint16Array} layer
   */
  _fill(texture, size, layer) {
    const gl = this.graphics.context;
    const { width, height, layers, channels, levels } = size;
    const target = gl.TEXTURE_2D_ARRAY;
    const most = [
      gl.getParameter(gl.MAX_TEXTURE_SIZE),
      gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS),
    ];
    if (Math.max(width, height) > most[0] || layers > most[1]) {
      throw new Error(
        `a texture of ${width} x ${height} texels in ${layers} layers is asked for, and this graphics ` +
          `card has ${most[0]} x ${most[0]} in ${most[1]}; show fewer nodes`,
      );
    }
    const format = channels === 1 ? gl.RED : gl.RGBA;
    gl.bindTexture(target, texture);
    gl.texStorage3D(
      target,
      levels + 1,
      channels === 1 ? gl.R16F : gl.RGBA16F,
      width,
      height,
      layers,
    );
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    for (let n = 0; n < layers; n += 1) {
      let texels = layer(n);
      let [w, h] = [width, height];
      gl.texSubImage3D(target, 0, 0, 0, n, w, h, 1, format, gl.HALF_FLOAT, texels);
      for (let level = 1; level <= levels && !this.graphics.floats; level += 1) {
        [texels, w, h] = halved(texels, w, h, channels);
        gl.texSubImage3D(target, level, 0, 0, n, w, h, 1, format, gl.HALF_FLOAT, texels);
      }
    }
    if (this.graphics.floats && levels) gl.generateMipmap(target);
  }

  /** @returns {WebGLTexture} */
  _colours() {
    const gl = this.graphics.context;
    return this._take(
      "cmap",
      "Texture",
      this._key(["cmap"]),
      () => gl.createTexture(),
      (texture) => {
        gl.bindTexture(gl.TEXTURE_2D, texture);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        const data = this.parts.get("cmap")?.data ?? new Uint8Array(1024);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, data);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      },
    );
  }

  /** Make the slices of a step ready before they are shown. @param {number} step */
  prepare(step) {
    if (!this._made.has(`slices/${step}`) && !this.missing(step, step).length) this._slices(step);
  }

  /** Draw all cells with a program that is in use. @param {number} before @param {number} after @param {Vector} anchor @param {boolean} textures */
  draw(before, after, anchor, textures) {
    const gl = this.graphics.context;
    if (textures) {
      for (const name of [...this._made.keys()]) {
        const step = name.startsWith("slices/") ? Number(name.slice(7)) : before;
        // One ahead stays, as it is next.
        if (
          step !== before &&
          step !== after &&
          step !== after + 1 &&
          !(after + 1 >= this.header.slices.steps && step === 0)
        )
          {this._drop(name);}
      }
      const { paper } = this.header;
      const repeat = paper?.repeat ?? [false, false];
      /** @type {[number, WebGLTexture | null][]} */
      const units = [
        [gl.TEXTURE_2D_ARRAY, this._slices(before)],
        [gl.TEXTURE_2D_ARRAY, after === before ? null : this._slices(after)],
        [
          gl.TEXTURE_2D_ARRAY,
          paper ? this._image("noise", paper.picture ? [true, true] : repeat) : null,
        ],
        [gl.TEXTURE_2D_ARRAY, paper ? this._image("step", repeat) : null],
        [gl.TEXTURE_2D, this._colours()],
      ];
      units.forEach(([target, texture], n) => {
        gl.activeTexture(gl.TEXTURE0 + n);
        gl.bindTexture(target, texture);
      });
      gl.activeTexture(gl.TEXTURE0 + SAMPLERS.length);
    }
    this._bindNodes(before, after, anchor);
    gl.drawElements(gl.TRIANGLES, this._made.get("index")?.count ?? 0, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }
}

/**
 * The next mip level of an image, filtered linearly, where the driver does not make it.
 * @param {Uint16Array} texels @param {number} width @param {number} height @param {number} channels
 * @returns {[Uint16Array, number, number]}
 */
export function halved(texels, width, height, channels) {
  const [w, h] = [Math.max(width >> 1, 1), Math.max(height >> 1, 1)];
  const result = new Uint16Array(w * h * channels);
  /** @param {number} n @param {number} few @param {number} many @returns {[number, number, number]} */
  const between = (n, few, many) => {
    const x = (n + 0.5) * (many / few) - 0.5;
    const base = Math.floor(x);
    return [base, Math.min(base + 1, many - 1), x - base];
  };
  for (let j = 0, n = 0; j < h; j += 1) {
    const [low, high, v] = between(j, h, height);
    for (let i = 0; i < w; i += 1) {
      const [left, right, u] = between(i, w, width);
      for (let c = 0; c < channels; c += 1) {
        const at = (/** @type {number} */ y, /** @type {number} */ x) =>
          fromHalf(texels[(y * width + x) * channels + c]);
        const below = at(low, left) * (1 - u) + at(low, right) * u;
        result[n++] = toHalf(
          below * (1 - v) + (at(high, left) * (1 - u) + at(high, right) * u) * v,
        );
      }
    }
  }
  return [result, w, h];
}

// --- how well there is time to draw ------------------------------------------------------------

/** Milliseconds for a picture in motion, and for a strip at rest. */
const MOVING = 55;
const STRIP = 40;
/** What a pixel costs beside its samples, in samples; samples of a draft; its least share of the width. */
const BASE = 8;
const DRAFT = 9;
const COARSEST = 0.2;
/** Price below which a graphics card draws, in milliseconds for a sample of a pixel. */
const CHEAP = 2e-6;
/** A picture serves for a moved view while its pixels grow, or shrink, by less than this. */
const STRETCH = 4;
const SHRINK = 0.3;
/** Milliseconds for which a view that was moved counts as being moved. */
const STILL = 160;

/**
 * The best share of the width, and samples, that can be drawn in a time.
 * @param {number} price milliseconds for a sample of a pixel @param {number} fixed milliseconds at least
 * @param {number} pixels @param {number} samples @param {number} budget milliseconds
 * @returns {{ scale: number, samples: number }}
 */
export function quality(price, fixed, pixels, samples, budget) {
  const room = Math.max(budget - fixed, 2) / price;
  if (pixels * (samples + BASE) <= room) return { scale: 1, samples };
  const fewer = Math.min(DRAFT, samples);
  const scale = Math.sqrt(room / (fewer + BASE) / pixels);
  if (scale < 1) return { scale: Math.max(scale, COARSEST), samples: fewer };
  return { scale: 1, samples: clamp(Math.floor(room / pixels - BASE), fewer, samples) };
}

// --- the viewer --------------------------------------------------------------------------------

/**
 * @typedef {{
 *   onCamera?: (camera: CameraState) => void, onTime?: (time: number) => void,
 *   onClock?: (clock: number) => void, onPlaying?: (playing: boolean) => void,
 *   onPoint?: (point: Point) => void, onNeed?: (step: number) => void, onFrame?: () => void,
 *   onSetting?: (name: string, value: Value) => void, onControls?: (shown: boolean) => void,
 * }} Callbacks
 * @typedef {Callbacks & { bare?: boolean,
 *   rebuild?: boolean, controls?: boolean, smooth?: boolean, guarded?: boolean, follows?: Viewer,
 * }} Options
 *
 * `rebuild`: the host makes textures anew. `guarded`: the view is part of a page that is scrolled,
 * and takes wheel and finger only once it was clicked. `follows`: another view that has the bar.
 */

/** Seconds in which a whole series is shown: at least, for each step, at most. */
const SERIES = [6, 0.5, 60];
/** Time steps that are kept where more can be asked for. */
const KEPT = 12;
/** Milliseconds between two looks at what is under the pointer. */
const LOOK = 90;

/** One scene in an element. */
export class Viewer {
  /** @param {HTMLElement} element filled with the picture @param {Options} [options] */
  constructor(element, options = {}) {
    this.element = element;
    this.options = options;
    /** @type {Header | null} */
    this.header = null;
    /** @type {Map<string, Part>} */
    this.parts = new Map();
    /** @type {Settings} */
    this.settings = {};
    this.time = 0;
    this.clock = 0;
    this.playing = false;
    this.sharp = false;
    this.disposed = false;
    /** The views that stand beside each other. @type {Viewer[]} */
    this.together = [this];
    /** @type {Navigator | null} */
    this.navigator = null;
    /** @type {Drawing | null} */
    this.drawing = null;
    this.graphics = sharedGraphics();
    this._listeners = new AbortController();
    this._listening = 0;
    /** @type {Set<ResizeObserver | IntersectionObserver>} */
    this._observers = new Set();
    /** @type {Set<ReturnType<typeof setTimeout>>} */
    this._timers = new Set();
    this._visible = true;
    this._version = 1;
    this._drafted = 0;
    this._rows = 0;
    this._busyUntil = 0;
    this._last = 0;
    this._fixed = 4;
    /** @type {CameraState | null} */
    this._given = null;
    this._asked = new Map();
    /** @type {[number, number, number] | null} */
    this._shown = null;
    this._frames = 0;
    this.root = document.createElement("div");
    this.root.className = "flowtex";
    this.root.tabIndex = 0;
    this.root.dataset.sharp = "false";
    // JupyterLab has shortcuts of its own for the keys that move the view.
    this.root.setAttribute("data-lm-suppress-shortcuts", "true");
    this.root.setAttribute("role", "application");
    this.canvas = document.createElement("canvas");
    this._pen = this.canvas.getContext("2d", { alpha: false });
    this._back = document.createElement("canvas");
    this._backPen = this._back.getContext("2d", { alpha: false });
    // The last full picture, with the camera that it shows, serves while a flat surface is moved.
    this._kept = document.createElement("canvas");
    this._keptPen = this._kept.getContext("2d", { alpha: false });
    /** @type {Navigator | null} */
    this._keptView = null;
    this.panel = new Panel(this);
    element.append(this.root);
    this.pointers = new Pointers(this);
    this.graphics.enter(this);
    this._observe();
    if (!this.graphics.gl) {
      this.panel.fail(
        "This browser has no WebGL2, which the picture is drawn with.",
        "Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.",
      );
    }
  }

  _observe() {
    const sized = new ResizeObserver(() => this.resize());
    sized.observe(this.root);
    const seen = new IntersectionObserver((entries) => {
      this._visible = entries[entries.length - 1].isIntersecting;
      if (this._visible) this._request();
    });
    seen.observe(this.root);
    this._observers.add(sized).add(seen);
    this.listen(document, "visibilitychange", () => this._request());
    // The ratio changes when the window goes to another screen or is zoomed.
    this.listen(window, "resize", () => this.resize());
  }

  /**
   * Listen until the viewer is disposed of.
   * @param {EventTarget} target @param {string} kind @param {(event: any) => void} call
   * @param {AddEventListenerOptions} [options]
   */
  listen(target, kind, call, options = {}) {
    if (target === document || target === window) this._listening += 1;
    target.addEventListener(kind, call, { ...options, signal: this._listeners.signal });
  }

  /** @param {() => void} call @param {number} delay milliseconds @returns {ReturnType<typeof setTimeout>} */
  later(call, delay) {
    const timer = setTimeout(() => {
      this._timers.delete(timer);
      call();
    }, delay);
    this._timers.add(timer);
    return timer;
  }

  /** What is still held, for tests. */
  stats() {
    return {
      objects: this.graphics.objects,
      users: this.graphics.users.size,
      listeners: this._listening,
      observers: this._observers.size,
      timers: this._timers.size,
      frames: this._frames,
      restorations: this.graphics.restorations,
    };
  }

  dispose() {
    if (this.disposed) return;
    this.disposed = true;
    this.playing = false;
    this._listeners.abort();
    this._listening = 0;
    for (const observer of this._observers) observer.disconnect();
    this._observers.clear();
    for (const timer of this._timers) clearTimeout(timer);
    this._timers.clear();
    this.drawing?.dispose();
    this.drawing = null;
    for (const name of [...this.parts.keys()]) this._remove(name);
    this.graphics.leave(this);
    for (const canvas of [this.canvas, this._back, this._kept]) canvas.width = canvas.height = 0;
    this.root.remove();
  }

  // --- what is shown ---

  /** @param {Header} header */
  setHeader(header) {
    if (header.format !== 1) {
      this.panel.fail(
        `The scene has format ${header.format}, and this client reads format 1.`,
        "Use the client of the flowtex that made the scene.",
      );
      return;
    }
    const was = this.header;
    this.header = header;
    this.settings = { ...header.settings, ...header.own };
    if (!was || !equal(was.slices.times, header.slices.times)) {
      this.time = header.time;
      this.clock = header.clock;
    }
    this.drawing?.dispose();
    this.drawing = new Drawing(this.graphics, header, this.parts);
    this._asked.clear();
    if (!was || !sameplace(was, header)) {
      this._given = header.camera;
      this.navigator = null;
    }
    if (was && was.generation !== header.generation) {
      // What is the same at all times is sent again only where it differs.
      for (const name of [...this.parts.keys()]) if (name.includes("/")) this._remove(name);
    }
    this.panel.build();
    this.change();
  }

  /** Look from where the scene says, or so that the whole surface is seen. */
  _place() {
    const { header, _given: given } = this;
    const position = this.parts.get("position");
    if (!header || !position) return;
    const aspect = this._aspect();
    const camera = given
      ? widened(header, given, position, aspect)
      : fitted(header, position, aspect);
    this.navigator = new Navigator(camera, header.geometry.planar);
    this.navigator.hit = (x, y) =>
      /** @type {Vector | null} */ (this.point(x, y)?.position ?? null);
    this.navigator.aspect = aspect;
    // A host holds the camera that is shown.
    if (!given || !equal(given, camera)) this.options.onCamera?.(copied(camera));
  }

  /** @param {string} name */
  _remove(name) {
    this.graphics.release(this.parts.get(name));
    this.parts.delete(name);
  }

  /**
   * @param {string} name @param {Data} data @param {number[]} shape
   * @param {string} [digest] what the array is known by on the whole page
   */
  setPart(name, data, shape, digest = "") {
    this._asked.delete(Number(name.split("/")[1]));
    if (digest && this.parts.get(name)?.digest === digest) return;
    const part = this.graphics.hold({ data, shape, digest });
    this._remove(name);
    this.parts.set(name, part);
    this.drawing?.forget(name);
    this._trim();
    if (name === "cmap") this.panel.colours();
    this.change();
  }

  /** Keep a few time steps where the others can be asked for again. */
  _trim() {
    if (!this.options.onNeed || !this.header) return;
    const steps = [...this.parts.keys()].filter((name) => name.startsWith("slices/"));
    const needed = this._moment();
    for (const name of steps.slice(0, Math.max(steps.length - KEPT, 0))) {
      const step = Number(name.slice(7));
      if (needed.slice(0, 2).includes(step)) continue;
      for (const kind of ["slices", "extra"]) this._remove(`${kind}/${step}`);
    }
  }

  /** @param {Settings} settings */
  setSettings(settings) {
    if (Object.entries(settings).every(([name, value]) => this.settings[name] === value)) return;
    Object.assign(this.settings, settings);
    this.panel.update();
    this.change();
  }

  /** Follow the setting of another view, unless it is this one's own. @param {string} name @param {Value} value */
  takeSetting(name, value) {
    if (!(name in (this.header?.own ?? {}))) this.setSettings({ [name]: value });
  }

  /** Set one setting as a person does, which the host is told of. @param {string} name @param {Value} value */
  choose(name, value) {
    this._busyUntil = performance.now() + STILL;
    this.setSettings({ [name]: value });
    this.options.onSetting?.(name, value);
  }

  /** @returns {CameraState | null} */
  get camera() {
    const camera = this.navigator?.camera ?? this._given;
    return camera ? copied(camera) : null;
  }

  /** @param {CameraState} camera */
  setCamera(camera) {
    if (!this.navigator) this._given = copied(camera);
    else if (equal(this.navigator.camera, camera)) return;
    else this.navigator.camera = copied(camera);
    this.change(false);
  }

  /** The camera was moved by hand. */
  moved() {
    this._busyUntil = performance.now() + STILL;
    this.change(false);
    if (this.navigator) this.options.onCamera?.(copied(this.navigator.camera));
  }

  reset() {
    if (!this.navigator) return;
    this._place();
    this.moved();
  }

  /** @param {number} time */
  setTime(time) {
    const times = this.header?.slices.times ?? [0];
    this.time = clamp(time, times[0], times[times.length - 1]);
    this.panel.tick();
    this.change();
  }

  /** @param {number} clock seconds */
  setClock(clock) {
    this.clock = clock;
    this.panel.tick();
    this.change();
  }

  /** Whether the flow on show changes with time. */
  get varies() {
    return (this.header?.slices.steps ?? 1) > 1;
  }

  /** @returns {void} */
  play() {
    if (this.options.follows) return this.options.follows.play();
    if (this.playing || !this.header) return;
    if (!this.varies && this.settings.motion === "off") this.choose("motion", "speed");
    this.playing = true;
    this._last = 0;
    this.panel.update();
    this._request();
    this.options.onPlaying?.(true);
  }

  /** @returns {void} */
  pause() {
    if (this.options.follows) return this.options.follows.pause();
    if (!this.playing) return;
    this.playing = false;
    this.panel.update();
    this.change();
    this.options.onPlaying?.(false);
  }

  /**
   * Something changed: the picture is not sharp any more, and is drawn when its turn comes.
   * @param {boolean} [more] whether more than the camera changed
   */
  change(more = true) {
    if (more) this._keptView = null;
    this._version += 1;
    this._rows = 0;
    this._setSharp(false);
    this._request();
  }

  /** Draw at once, as far as there is time. */
  draw() {
    this.frame(performance.now(), performance.now() + TURN);
  }

  /** @param {boolean} sharp */
  _setSharp(sharp) {
    if (sharp === this.sharp) return;
    this.sharp = sharp;
    this.root.dataset.sharp = String(sharp);
    if (sharp) this.options.onFrame?.();
  }

  _request() {
    if (!this.disposed && this._visible) this.graphics.request(this);
  }

  _aspect() {
    return Math.max(this.root.clientWidth, 1) / Math.max(this.root.clientHeight, 1);
  }

  resize() {
    const ratio = Math.max(window.devicePixelRatio || 1, 0.1);
    const width = Math.max(Math.round(this.root.clientWidth * ratio), 1);
    const height = Math.max(Math.round(this.root.clientHeight * ratio), 1);
    if (width === this.canvas.width && height === this.canvas.height) return;
    // What is on show is kept, stretched, until there is something better.
    const old = this.canvas.width > 1 ? copiedCanvas(this.canvas) : null;
    for (const canvas of [this.canvas, this._back, this._kept]) {
      canvas.width = width;
      canvas.height = height;
    }
    if (old) this._pen?.drawImage(old, 0, 0, width, height);
    if (this.navigator) {
      this.navigator.aspect = this._aspect();
      if (equal(this.navigator.camera, this.navigator.start)) this._place();
    }
    this.change();
  }

  /** Whether outlines are smoothed in the full picture: on a processor it would take many times as long. */
  get smooth() {
    const { header } = this;
    if (this.options.smooth !== undefined || !header) return this.options.smooth ?? false;
    return this.graphics.program(header.shaders.vertex, header.shaders.fragment).price < CHEAP;
  }

  /** Pixels of the canvas along one of the page. */
  get ratio() {
    return this.canvas.height / Math.max(this.root.clientHeight, 1);
  }

  // --- drawing ---

  lost() {
    // What was made is gone with the context.
    this.drawing = this.header ? new Drawing(this.graphics, this.header, this.parts) : null;
    this._setSharp(false);
  }

  restored() {
    this.change();
  }

  /** @returns {[number, number, number]} */
  _moment() {
    return moment(this.header?.slices.times ?? [0], this.time);
  }

  /**
   * Ask for the parts of the steps that are missing, and tell whether there is something to show.
   * @returns {[number, number, number] | null}
   */
  _available() {
    if (!this.header || !this.drawing) return null;
    const wanted = this._moment();
    const count = this.header.slices.steps;
    const ahead = this.playing ? [1, 2].map((n) => (wanted[1] + n) % count) : [];
    for (const step of new Set([wanted[0], wanted[1], ...ahead])) {
      if (this.drawing.missing(step, step).length) this._ask(step);
    }
    const lacking = this.drawing.missing(wanted[0], wanted[1]);
    this.panel.wait(lacking);
    if (!lacking.length) return (this._shown = wanted);
    const shown = this._shown;
    return shown && !this.drawing.missing(shown[0], shown[1]).length ? shown : null;
  }

  /** @param {number} step */
  _ask(step) {
    const now = performance.now();
    // A question that was lost is asked again.
    if (!this.options.onNeed || now - (this._asked.get(step) ?? -Infinity) < 5000) return;
    this._asked.set(step, now);
    this.options.onNeed(step);
  }

  /** @param {number} now @param {number} until milliseconds */
  frame(now, until) {
    if (this.disposed || this.graphics.isLost || !this.graphics.gl || !this._visible) return;
    if (!this.header || !this.drawing || this.canvas.width < 2) return;
    try {
      this._advance(now);
      this._frame(until);
    } catch (error) {
      this.pause();
      this.panel.fail("The picture could not be drawn.", String(error));
    }
  }

  /** @param {number} until milliseconds */
  _frame(until) {
    const { header, graphics } = this;
    if (!header) return;
    const shown = this._available();
    if (!this.navigator) this._place();
    if (!shown || !this.navigator) return;
    const program = graphics.program(header.shaders.vertex, header.shaders.fragment);
    if (program.error) {
      this.panel.fail("The shader does not compile with this graphics driver.", program.error);
      return;
    }
    if (!program.ready) return this._request();
    const moving = this.playing || performance.now() < this._busyUntil;
    if (this._drafted !== this._version) {
      this._draft(program, shown);
    } else if (!moving && !this.sharp) {
      do this._strip(program, shown);
      while (!this.sharp && performance.now() < until);
    }
    if (!this.sharp) this._request();
  }

  /** Go on with the time or the clock. @param {number} now milliseconds */
  _advance(now) {
    if (!this.playing || !this.header) return;
    const passed = this._last ? Math.min((now - this._last) / 1000, 0.5) : 0;
    this._last = now;
    if (!this.varies) {
      this.clock += passed;
      this.options.onClock?.(this.clock);
    } else {
      const { times } = this.header.slices;
      const [first, last] = [times[0], times[times.length - 1]];
      const series = clamp(SERIES[1] * (times.length - 1), SERIES[0], SERIES[2]);
      const next = this.time + (passed * (last - first)) / series;
      const [before, after] = moment(times, Math.min(next, last));
      // Wait for what is on the way instead of jumping over it.
      const lacking = [before, after].filter((step) => this.drawing?.missing(step, step).length);
      for (const step of lacking) this._ask(step);
      if (lacking.length) return;
      this.time = next > last ? first : next;
      this.options.onTime?.(this.time);
    }
    this.panel.tick();
    this._keptView = null;
    this._version += 1;
    this._rows = 0;
    this._setSharp(false);
  }

  /** A picture in the time that there is. @param {Program} program @param {[number, number, number]} shown */
  _draft(program, shown) {
    const { width, height } = this.canvas;
    const samples = Number(this.settings.samples);
    // Views that move share the time; at rest one after the other gets its whole picture.
    const moving = this.playing || performance.now() < this._busyUntil;
    const crowd = moving ? this.graphics.waiting.size + 1 : 1;
    const budget = Math.max(MOVING / crowd, 14);
    if (!program.warm) this._warm(program, shown);
    const cost = this._cost(program, samples);
    const best = quality(cost, this._fixed, width * height, samples, budget);
    const w = Math.max(Math.round(width * best.scale), 1);
    const h = Math.max(Math.round(height * best.scale), 1);
    this._drafted = this._version;
    const moved = best.scale < 1 ? this._fromKept() : null;
    if (!moved?.covers) {
      const started = performance.now();
      this._render(program, shown, w, h, best.samples, 0, h);
      this._copy(this._pen, w, h, 0, h, width, height);
      this._learn(program, performance.now() - started, w * h, best.samples);
    }
    if (moved && this._pen) {
      this._pen.imageSmoothingEnabled = !moved.shifts;
      this._pen.setTransform(...moved.matrix);
      this._pen.drawImage(this._kept, 0, 0);
      this._pen.setTransform(1, 0, 0, 1, 0, 0);
    }
    if (best.scale === 1 && best.samples === samples && !this.smooth) {
      this._done();
    }
  }

  /**
   * How the last full picture lies in the present view, where it serves: without perspective a
   * plane is mapped to the view by an affine map, so that a drag follows the hand on any machine.
   * @returns {{ matrix: [number, number, number, number, number, number], covers: boolean, shifts: boolean } | null}
   */
  _fromKept() {
    const { header, navigator, _keptView: then } = this;
    if (!header || !navigator || !then || !header.geometry.planar) return null;
    if (!navigator.camera.parallel || !then.camera.parallel) return null;
    const anchor = toFrame(header, minus(navigator.camera.focal_point, header.geometry.center));
    const [was, now] = [then, navigator].map((view) => projection(header, view, anchor));
    const size = was[0] * was[5] - was[4] * was[1];
    // Rows of now * was^-1, from -1 to 1 in both pictures.
    const a = (now[0] * was[5] - now[4] * was[1]) / size;
    const b = (now[4] * was[0] - now[0] * was[4]) / size;
    const c = (now[1] * was[5] - now[5] * was[1]) / size;
    const d = (now[5] * was[0] - now[1] * was[4]) / size;
    const area = Math.abs(a * d - b * c);
    if (!(area > SHRINK ** 2 && area < STRETCH ** 2)) return null;
    const [e, f] = [now[12] - a * was[12] - b * was[13], now[13] - c * was[12] - d * was[13]];
    const [w, h] = [this.canvas.width / 2, this.canvas.height / 2];
    /** @type {[number, number, number, number, number, number]} */
    const matrix = [a, (-c * h) / w, (-b * w) / h, d, w * (1 + e - a + b), h * (1 - f + c - d)];
    const corners = [
      [-1, -1],
      [1, -1],
      [-1, 1],
      [1, 1],
    ].map(([x, y]) => [
      (d * (x - e) - b * (y - f)) / (a * d - b * c),
      (a * (y - f) - c * (x - e)) / (a * d - b * c),
    ]);
    const covers = corners.every((corner) => corner.every((x) => Math.abs(x) < 1 + 1e-6));
    const shifts = Math.abs(a - 1) + Math.abs(d - 1) + Math.abs(b) + Math.abs(c) < 1e-6;
    if (shifts) ((matrix[4] = Math.round(matrix[4])), (matrix[5] = Math.round(matrix[5])));
    return { matrix, covers, shifts };
  }

  /** One more strip of the full picture; it is shown when it is complete. @param {Program} program @param {[number, number, number]} shown */
  _strip(program, shown) {
    const { width, height } = this.canvas;
    const samples = Number(this.settings.samples);
    if (!program.warm) this._warm(program, shown);
    const row = this._cost(program, samples) * width * (samples + BASE);
    const budget = Math.max(STRIP - this._fixed, this._fixed);
    const most = Math.min(height - this._rows, this.smooth ? SMOOTH : height);
    const rows = Math.min(Math.max(Math.floor(budget / row), 4), most);
    const started = performance.now();
    this._render(program, shown, width, height, samples, this._rows, rows, this.smooth);
    const drawn = this.smooth ? rows : height;
    this._copy(
      this._backPen,
      width,
      drawn,
      this.smooth ? 0 : this._rows,
      rows,
      width,
      drawn,
      this._rows,
    );
    this._learn(program, performance.now() - started, width * rows, samples);
    this._rows += rows;
    if (this._rows < height) return;
    this._pen?.drawImage(this._back, 0, 0);
    this._done();
  }

  _done() {
    this._rows = this.canvas.height;
    this._frames += 1;
    this._drafted = this._version;
    this._keptPen?.drawImage(this.canvas, 0, 0);
    if (this.navigator && !this.playing) {
      this._keptView = new Navigator(this.navigator.camera, this.navigator.flat);
      this._keptView.aspect = this.navigator.aspect;
    }
    this.panel.drawn();
    // The pointer asks for it next.
    if (this.header) this.graphics.program(this.header.shaders.vertex, this.header.shaders.pick);
    this._setSharp(!this.playing);
  }

  /** What a sample of a pixel costs; moving grains take twice the samples. @param {Program} program @param {number} samples */
  _cost(program, samples) {
    const more =
      this.settings.motion !== "off" || this.varies ? (2 * samples + BASE) / (samples + BASE) : 1;
    return program.price * more;
  }

  /** The first drawing is slow by itself, and what it costs with hardly a pixel is paid by each. @param {Program} program @param {[number, number, number]} shown */
  _warm(program, shown) {
    const { width, height } = this.canvas;
    this._render(program, shown, width, height, 1, 0, 1);
    const started = performance.now();
    this._render(program, shown, width, height, 1, 0, 1);
    this._fixed = clamp(performance.now() - started, 0.5, 200);
    program.warm = true;
  }

  /** @param {Program} program @param {number} spent milliseconds @param {number} pixels @param {number} samples */
  _learn(program, spent, pixels, samples) {
    const all = this._cost(program, samples) / program.price;
    const price = Math.max(spent - this._fixed, 0.05) / (pixels * (samples + BASE) * all);
    // Slower is believed at once, faster by and by: a picture that is late is felt.
    program.price += (price - program.price) * (price > program.price ? 0.7 : 0.3);
  }

  /**
   * Draw some rows of a picture of a size, counted from its top.
   * @param {Program} program @param {[number, number, number]} shown
   * @param {number} width @param {number} height @param {number} samples
   * @param {number} top @param {number} rows @param {boolean} [smooth]
   */
  _render(program, shown, width, height, samples, top, rows, smooth = false) {
    const { graphics, header, navigator, drawing } = this;
    if (!header || !navigator || !drawing) return;
    const gl = graphics.context;
    const ratio = (this.ratio * height) / this.canvas.height;
    const [before, after, between] = shown;
    const view = this._view(shown);
    const values = uniforms(
      header,
      { ...this.settings, samples },
      view,
      this.parts.get("noise"),
      ratio,
    );
    if (samples !== this.settings.samples || ratio !== 1) {
      // Streaks keep their length on the page.
      const length =
        Number(this.settings.samples) * Number(this.settings.spacing) * Number(this.settings.grain);
      const grown = Number(values.u_grain) / ratio;
      values.u_spacing = clamp(
        length / (samples * grown),
        0.1,
        Math.max(1.4, Number(this.settings.spacing)),
      );
    }
    const eye = navigator.camera.parallel
      ? navigator.axes[2].map((c) => -c)
      : unit(minus(navigator.camera.position, navigator.camera.focal_point));
    graphics.reserve(width, height);
    const bottom = height - top - rows;
    if (smooth) graphics.bindSmooth(width, rows);
    else gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, smooth ? -bottom : 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, smooth ? 0 : bottom, width, rows);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    const [r, g, b] = header.background;
    gl.clearColor(r, g, b, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    graphics.write(program, {
      ...values,
      u_between: between,
      u_matrix: new Float32Array(projection(header, navigator, view.anchor)),
      u_mapped: header.scalars.name !== null,
      u_colour: header.colour,
      u_lit: header.lighting,
      u_ground: header.background,
      u_opacity: header.opacity ?? 1,
      u_toEye: toFrame(header, eye),
    });
    drawing.draw(before, after, view.anchor, true);
    if (smooth) graphics.copySmooth(width, rows);
    graphics.settle();
  }

  /** @param {[number, number, number]} shown @returns {ViewState} */
  _view(shown) {
    const navigator = /** @type {Navigator} */ (this.navigator);
    const header = /** @type {Header} */ (this.header);
    const focus = /** @type {Vector} */ ([...navigator.camera.focal_point]);
    const there = toFrame(header, minus(focus, header.geometry.center));
    const anchor = this.drawing?.anchor ?? [0, 0, 0];
    const near = NEAR * 2 * navigator.height;
    const far = (/** @type {ArrayLike<number>} */ v) =>
      Math.max(Math.abs(v[0]), Math.abs(v[1]), Math.abs(v[2])) > near;
    const { times } = header.slices;
    return {
      focus,
      anchor: !far(minus(there, anchor)) ? anchor : far(there) ? there : [0, 0, 0],
      eye: navigator.eye,
      between: shown[2],
      time: times[shown[0]] + shown[2] * (times[shown[1]] - times[shown[0]]),
      clock: this.clock,
    };
  }

  /**
   * Copy what was drawn, rows from the top, to a picture of another size.
   * @param {CanvasRenderingContext2D | null} pen @param {number} w @param {number} h
   * @param {number} top @param {number} rows @param {number} width @param {number} height
   * @param {number} [to] row that the first one goes to
   */
  _copy(pen, w, h, top, rows, width, height, to = 0) {
    if (!pen) return;
    const { canvas } = this.graphics;
    pen.imageSmoothingEnabled = w !== width || h !== height;
    pen.drawImage(canvas, 0, canvas.height - h + top, w, rows, 0, to, width, (rows * height) / h);
  }

  // --- what is under the pointer ---

  /** Whether the program that finds points is built. */
  get canPick() {
    const { header, graphics } = this;
    if (!header || graphics.isLost || !graphics.gl) return false;
    return graphics.program(header.shaders.vertex, header.shaders.pick).ready;
  }

  /**
   * Point of the surface at a place of the view, or null.
   * @param {number} x @param {number} y from -1 to 1, right and up @returns {Point | null}
   */
  point(x, y) {
    const { header, graphics, navigator, drawing, _shown: shown } = this;
    if (!header || !navigator || !drawing || !shown || !this.canPick) return null;
    const program = graphics.program(header.shaders.vertex, header.shaders.pick);
    const view = this._view(shown);
    const m = projection(header, navigator, view.anchor);
    // The picture is the one pixel at that place.
    for (let n = 0; n < 4; n += 1) {
      m[4 * n] = (m[4 * n] - x * m[4 * n + 3]) * this.canvas.width;
      m[4 * n + 1] = (m[4 * n + 1] - y * m[4 * n + 3]) * this.canvas.height;
    }
    const bits = graphics.pick(() => {
      graphics.write(program, { u_matrix: new Float32Array(m), u_between: shown[2] });
      drawing.draw(shown[0], shown[1], view.anchor, false);
    });
    if (!bits[3]) return null;
    const [u, v] = new Float32Array(bits.buffer, 0, 2);
    const { rows, columns, shape } = header.geometry;
    const i = clamp(u * columns.size - 0.5 - columns.before, 0, shape[1] - 1);
    const j = clamp(v * rows.size - 0.5 - rows.before, 0, shape[0] - 1);
    return this._pointAt(i, j, x, y, shown);
  }

  /**
   * @param {number} i @param {number} j @param {number} x @param {number} y
   * @param {[number, number, number]} shown @returns {Point}
   */
  _pointAt(i, j, x, y, shown) {
    const header = /** @type {Header} */ (this.header);
    const navigator = /** @type {Navigator} */ (this.navigator);
    const position = /** @type {Part} */ (this.parts.get("position")).data;
    const local = /** @type {Vector} */ (
      [0, 1, 2].map((k) => this._nodal(i, j, (n) => position[3 * n + k]))
    );
    const about = plus(fromFrame(header, local), header.geometry.center);
    // Single precision finds the depth; the place itself is on the ray through the pointer.
    const [start, along] = navigator.ray(x, y);
    const ahead = navigator.axes[2];
    const depth = dot(minus(about, start), ahead) / dot(along, ahead);
    /** @type {Record<string, number>} */
    const values = {};
    const { name, steps } = header.scalars;
    if (name !== null) {
      const [a, b] = steps > 1 ? shown : [0, 0];
      const before = this.parts.get(`scalars/${a}`)?.data;
      const after = this.parts.get(`scalars/${b}`)?.data;
      if (before && after) {
        values[name] = this._nodal(i, j, (n) => before[n] + shown[2] * (after[n] - before[n]));
      }
    }
    return { position: plus(start, along, depth), index: [i, j], values };
  }

  /** Nodal values as the triangles interpolate them. @param {number} i @param {number} j @param {(node: number) => number} value @returns {number} */
  _nodal(i, j, value) {
    const [rows, columns] = /** @type {Header} */ (this.header).geometry.shape;
    const [left, low] = [Math.min(Math.floor(i), columns - 2), Math.min(Math.floor(j), rows - 2)];
    const [a, b] = [i - left, j - low];
    const corner = low * columns + left;
    const [from, to] = [value(corner), value(corner + columns + 1)];
    if (a >= b) {
      const aside = value(corner + 1);
      return from + a * (aside - from) + b * (to - aside);
    }
    const aside = value(corner + columns);
    return from + b * (aside - from) + a * (to - aside);
  }

  /** The picture as PNG. @returns {Promise<Blob>} */
  png() {
    return pngOf([this]);
  }
}

/** Pictures beside each other as PNG. @param {Viewer[]} viewers @returns {Promise<Blob>} */
function pngOf(viewers) {
  const canvas = viewers.length > 1 ? document.createElement("canvas") : viewers[0].canvas;
  if (viewers.length > 1) {
    canvas.width = viewers.reduce((sum, viewer) => sum + viewer.canvas.width, 0);
    canvas.height = viewers[0].canvas.height;
    let left = 0;
    for (const viewer of viewers) {
      canvas.getContext("2d")?.drawImage(viewer.canvas, left, 0);
      left += viewer.canvas.width;
    }
  }
  return new Promise((done, failed) => {
    canvas.toBlob(
      (blob) => (blob ? done(blob) : failed(new Error("there is no picture yet"))),
      "image/png",
    );
  });
}

/**
 * One view of a scene in an element, or two beside each other that move together.
 * @param {HTMLElement} element @param {number} count @param {Options} options of the first view
 * @param {(n: number) => Options} [rest] callbacks that each view has for itself
 * @returns {Viewer[]}
 */
function viewersIn(element, count, options, rest = () => ({})) {
  if (count < 2) return [new Viewer(element, { ...options, ...rest(0) })];
  const pair = dom("div", { class: "flowtex-pair" });
  pair.style.cssText = "display: flex; gap: 2px; width: 100%; height: 100%";
  element.append(pair);
  /** @type {Viewer[]} */
  const viewers = [];
  for (let n = 0; n < count; n += 1) {
    const cell = dom("div", {});
    cell.style.cssText = "flex: 1 1 0; min-width: 0; height: 100%";
    pair.append(cell);
    const others = () => viewers.filter((_, m) => m !== n);
    /** @type {Options} */
    const linked = {
      ...options,
      ...rest(n),
      onCamera: (camera) => {
        for (const other of others()) other.setCamera(camera);
        options.onCamera?.(camera);
      },
      onTime: (time) => {
        for (const other of others()) other.setTime(time);
        options.onTime?.(time);
      },
      onClock: (clock) => {
        for (const other of others()) other.setClock(clock);
        options.onClock?.(clock);
      },
      onSetting: (name, value) => {
        for (const other of others()) other.takeSetting(name, value);
        options.onSetting?.(name, value);
      },
    };
    if (n) Object.assign(linked, { controls: false, follows: viewers[0] });
    viewers.push(new Viewer(cell, linked));
  }
  for (const viewer of viewers) viewer.together = viewers;
  return viewers;
}

/** @param {HTMLCanvasElement} canvas @returns {HTMLCanvasElement} */
function copiedCanvas(canvas) {
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  copy.getContext("2d")?.drawImage(canvas, 0, 0);
  return copy;
}

/** @param {unknown} a @param {unknown} b @returns {boolean} */
function equal(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

// --- the hand ----------------------------------------------------------------------------------

/** Pixels and milliseconds within which a press is a click. */
const CLICK = [4, 450];
/** Milliseconds after which who scrolls means the page; for which a hint is shown. */
const POINTED = 1500;
const HINT = 1600;
/** Part of the view that an arrow key pans; turns as much of half a turn. */
const KEY = 0.2;

/** Pointers, wheel and keys on the picture. */
class Pointers {
  /** @param {Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    /** @type {Map<number, { x: number, y: number }>} */
    this._down = new Map();
    this._other = false;
    this._pressed = { x: 0, y: 0, at: 0, moved: false };
    this._looked = 0;
    /** @type {ReturnType<typeof setTimeout> | null} */
    this._look = null;
    this._pointed = -Infinity;
    const { canvas, root } = viewer;
    root.classList.toggle("flowtex-guarded", viewer.options.guarded ?? false);
    if (viewer.options.guarded) this._guard();
    viewer.listen(canvas, "pointerdown", (event) => this._press(event));
    viewer.listen(canvas, "pointermove", (event) => this._move(event));
    for (const kind of ["pointerup", "pointercancel"]) {
      viewer.listen(canvas, kind, (event) => this._release(event));
    }
    viewer.listen(canvas, "pointerleave", () => viewer.panel.read(null));
    viewer.listen(canvas, "contextmenu", (event) => event.preventDefault());
    viewer.listen(canvas, "wheel", (event) => this._wheel(event), { passive: false });
    viewer.listen(canvas, "dblclick", (event) => this._zoom(2, event));
    viewer.listen(root, "keydown", (event) => this._key(event));
  }

  /** Take the wheel from a click on, until the page is clicked or scrolled elsewhere. */
  _guard() {
    const { viewer } = this;
    const elsewhere = (/** @type {Event} */ event) => {
      if (!event.composedPath().includes(viewer.root)) this._hold(false);
    };
    viewer.listen(document, "pointerdown", elsewhere, { capture: true });
    viewer.listen(document, "wheel", elsewhere, { capture: true, passive: true });
    viewer.listen(viewer.root, "focus", () => {
      if (viewer.root.matches(":focus-visible")) this._hold(true);
    });
  }

  /** @param {boolean} held */
  _hold(held) {
    this.viewer.root.classList.toggle("flowtex-held", held);
    if (held) this.viewer.panel.hint(false);
  }

  /** Whether wheel and finger are the view's and not the page's. @returns {boolean} */
  get held() {
    const { root } = this.viewer;
    if (!this.viewer.options.guarded || root.classList.contains("flowtex-held")) return true;
    return document.fullscreenElement !== null && document.fullscreenElement.contains(root);
  }

  /** Place in the view, from -1 to 1. @param {{ clientX: number, clientY: number }} event @returns {{ x: number, y: number }} */
  _place(event) {
    const box = this.viewer.canvas.getBoundingClientRect();
    return {
      x: (2 * (event.clientX - box.left)) / Math.max(box.width, 1) - 1,
      y: 1 - (2 * (event.clientY - box.top)) / Math.max(box.height, 1),
    };
  }

  /** @param {PointerEvent} event */
  _press(event) {
    if (event.button > 2) return;
    this.viewer.root.focus({ preventScroll: true });
    if (event.pointerType !== "touch") this._hold(true);
    this.viewer.canvas.setPointerCapture(event.pointerId);
    this._down.set(event.pointerId, this._place(event));
    this._other = event.button === 2 || event.shiftKey;
    this._pressed = {
      x: event.clientX,
      y: event.clientY,
      at: event.timeStamp,
      moved: this._down.size > 1,
    };
    this.viewer.root.classList.add("flowtex-grabbing");
  }

  /** @param {PointerEvent} event */
  _move(event) {
    const { navigator } = this.viewer;
    if (!navigator) return;
    const place = this._place(event);
    const was = this._down.get(event.pointerId);
    // What the page moves under a pointer at rest was not pointed at.
    if (event.movementX || event.movementY) this._pointed = performance.now();
    if (!was) return this._hover(place);
    const far = Math.hypot(event.clientX - this._pressed.x, event.clientY - this._pressed.y);
    if (far > CLICK[0]) this._pressed.moved = true;
    if (!this._pressed.moved) return;
    const before = this._middle();
    this._down.set(event.pointerId, place);
    const now = this._middle();
    if (this._down.size > 1) {
      navigator.pan(before.x - now.x, before.y - now.y);
      if (before.apart > 0) navigator.zoomBy(now.apart / before.apart, now.x, now.y);
    } else if (navigator.flat === this._other) {
      navigator.turn(place.x - was.x, place.y - was.y);
    } else {
      navigator.pan(was.x - place.x, was.y - place.y);
    }
    this.viewer.panel.read(null);
    this.viewer.moved();
  }

  /** Middle of the pointers that are down, and how far they are apart. */
  _middle() {
    const [a, b = a] = [...this._down.values()];
    const aspect = this.viewer.navigator?.aspect ?? 1;
    return {
      x: (a.x + b.x) / 2,
      y: (a.y + b.y) / 2,
      apart: Math.hypot((a.x - b.x) * aspect, a.y - b.y),
    };
  }

  /** @param {PointerEvent} event */
  _release(event) {
    const place = this._down.get(event.pointerId);
    this._down.delete(event.pointerId);
    if (this._down.size) return;
    this.viewer.root.classList.remove("flowtex-grabbing");
    const quick = event.timeStamp - this._pressed.at < CLICK[1];
    if (event.type === "pointerup") this._hold(true);
    if (!place || event.type !== "pointerup" || this._pressed.moved || !quick || event.button !== 0)
      {return;}
    const point = this.viewer.point(place.x, place.y);
    if (point) this.viewer.options.onPoint?.(point);
    this.viewer.panel.read(point);
  }

  /** @param {WheelEvent} event */
  _wheel(event) {
    if (!this.held && !event.ctrlKey && !event.metaKey) {
      if (performance.now() - this._pointed < POINTED) this.viewer.panel.hint(true);
      return;
    }
    event.preventDefault();
    // A notch is 100 pixels or 3 lines; a pinch on a touch pad comes as a wheel with ctrl.
    const size = event.deltaMode === 1 ? 3 : event.deltaMode === 2 ? 1 : event.ctrlKey ? 20 : 100;
    this._zoom(NOTCH ** clamp(-event.deltaY / size, -4, 4), event);
  }

  /** @param {number} factor @param {{ clientX: number, clientY: number }} event */
  _zoom(factor, event) {
    const { x, y } = this._place(event);
    this.viewer.navigator?.zoomBy(factor, x, y);
    this.viewer.moved();
  }

  /** Read off what is under the pointer, now and then. @param {{ x: number, y: number }} place */
  _hover(place) {
    const { viewer } = this;
    if (this._look) clearTimeout(this._look);
    if (this._look) viewer._timers.delete(this._look);
    const wait = Math.max(LOOK - (performance.now() - this._looked), viewer.sharp ? 0 : LOOK);
    this._look = viewer.later(() => {
      this._look = null;
      this._looked = performance.now();
      if (viewer.sharp && viewer.canPick) viewer.panel.read(viewer.point(place.x, place.y));
      else if (!viewer.playing) this._hover(place);
    }, wait);
  }

  /** @param {KeyboardEvent} event */
  _key(event) {
    const { viewer } = this;
    const { navigator } = viewer;
    const aimed = event.composedPath()[0];
    const inside = aimed instanceof Element && aimed !== viewer.root ? aimed.tagName : "";
    const control = /^(INPUT|SELECT)$/.test(inside) || (inside === "BUTTON" && event.key === " ");
    if (!navigator || event.ctrlKey || event.metaKey || event.altKey || control) return;
    const move = (/** @type {number} */ x, /** @type {number} */ y) => {
      if (navigator.flat === event.shiftKey) navigator.turn(-x, -y);
      else navigator.pan(x, y);
      viewer.moved();
    };
    const zoom = (/** @type {number} */ factor) => {
      navigator.zoomBy(factor);
      viewer.moved();
    };
    /** @type {Record<string, () => void>} */
    const actions = {
      ArrowLeft: () => move(-KEY, 0),
      ArrowRight: () => move(KEY, 0),
      ArrowUp: () => move(0, KEY),
      ArrowDown: () => move(0, -KEY),
      "+": () => zoom(NOTCH),
      "=": () => zoom(NOTCH),
      "-": () => zoom(1 / NOTCH),
      _: () => zoom(1 / NOTCH),
      0: () => viewer.reset(),
      " ": () => ((viewer.options.follows ?? viewer).playing ? viewer.pause() : viewer.play()),
      f: () => viewer.panel.fullscreen(),
      h: () => (viewer.options.follows ?? viewer).panel.toggle(),
      Escape: () => {
        viewer.panel.fold();
        this._hold(false);
      },
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    event.stopPropagation();
    action();
  }
}

// --- what is seen around the picture -------------------------------------------------------------

/** Lines of the icons, in a square of 24. */
const ICONS = {
  play: "M8 5.2v13.6L19 12z",
  pause: "M8.5 6v12M15.5 6v12",
  home: "M4 11.5 12 5l8 6.5M6.5 10v9h11v-9",
  lod: "M12 3.8l8 4.1-8 4.1-8-4.1zM4 12.2l8 4.1 8-4.1M4 16.3l8 4.1 8-4.1",
  levels: "M3.5 18a8.5 8.5 0 0 1 17 0M7 18a5 5 0 0 1 10 0M10.3 18a1.7 1.7 0 0 1 3.4 0",
  settings: "M4 7h8M17 7h3M4 17h3M12 17h8M14.5 4.8v4.4M9.5 14.8v4.4",
  save: "M12 4v11M7.5 10.8 12 15.3l4.5-4.5M5 19.5h14",
  full: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
  hide: "M6 9.5l6 6 6-6",
  show: "M6 14.5l6-6 6 6",
};

/** Names of settings as people read them. @type {Record<string, string>} */
const LABELS = { lod: "Level of detail", show_level: "Show levels", two_sided: "Both directions" };
/** A range with more values than this is typed; one with a greater ratio goes by its logarithm. */
const STOPS = 100000;
const RATIO = 60;

/**
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} kind @param {Record<string, string>} [attributes] @param {(Node | string)[]} [children]
 * @returns {HTMLElementTagNameMap[K]}
 */
function dom(kind, attributes = {}, children = []) {
  const element = document.createElement(kind);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** @param {keyof typeof ICONS} name @returns {SVGSVGElement} */
function icon(name) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  const path = document.createElementNS(space, "path");
  path.setAttribute("d", ICONS[name]);
  if (name === "play") path.setAttribute("class", "solid");
  svg.append(path);
  return svg;
}

/** @param {string} name @returns {string} */
function label(name) {
  const words = LABELS[name] ?? name.replaceAll("_", " ");
  return words[0].toUpperCase() + words.slice(1);
}

/** @type {CSSStyleSheet | null} */
let sheet = null;

/** The bar, the legend, the settings, the readout and messages. */
class Panel {
  /** @param {Viewer} viewer */
  constructor(viewer) {
    this.viewer = viewer;
    this.shown = viewer.options.controls ?? true;
    this._open = false;
    const shadow = viewer.root.attachShadow({ mode: "open" });
    if (!sheet) {
      sheet = new CSSStyleSheet();
      sheet.replaceSync(STYLE);
    }
    shadow.adoptedStyleSheets = [sheet];
    this._title = dom("div", { class: "title" });
    this._readout = dom("div", { class: "readout", role: "status" });
    this._legend = dom("div", { class: "legend glass", hidden: "" });
    this._sheet = dom("div", { class: "settings glass", hidden: "", "aria-label": "Settings" });
    this._note = dom("div", { class: "note", hidden: "", role: "alert" });
    this._busy = dom("div", { class: "busy", hidden: "" }, ["waiting for data …"]);
    const key = /Mac|iP(hone|ad)/.test(navigator.platform) ? "⌘" : "Ctrl";
    this._hint = dom("div", { class: "hint glass", hidden: "" }, [
      `Click, or hold ${key}, to zoom with the wheel`,
    ]);
    this._handle = this._button("show", "Show the bar (h)", () => this.toggle());
    this._handle.classList.add("handle", "glass");
    this._bar = dom("div", { class: "bar glass", role: "toolbar", "aria-label": "Controls" });
    this._head = dom("div", { class: "head glass", hidden: "" }, [this._title, this._readout]);
    viewer.canvas.className = "picture";
    viewer.root.classList.toggle("flowtex-bare", viewer.options.bare ?? false);
    shadow.append(
      viewer.canvas,
      this._head,
      this._legend,
      this._sheet,
      this._bar,
      this._handle,
      this._busy,
      this._hint,
      this._note,
    );
    /** @type {Map<string, (value: Value) => void>} */
    this._controls = new Map();
    this._fill();
    this._arrange();
  }

  /**
   * @param {keyof typeof ICONS} name @param {string} title @param {() => void} press
   * @returns {HTMLButtonElement}
   */
  _button(name, title, press) {
    const button = dom(
      "button",
      { type: "button", title, "aria-label": title, "data-name": name },
      [icon(name)],
    );
    this.viewer.listen(button, "click", press);
    return button;
  }

  _fill() {
    const { viewer } = this;
    this._play = this._button("play", "Play (space)", () =>
      viewer.playing ? viewer.pause() : viewer.play(),
    );
    this._slider = dom("input", {
      type: "range",
      min: "0",
      max: "1",
      step: "any",
      "aria-label": "Time",
    });
    this._time = dom("span", { class: "time" });
    this._track = dom("div", { class: "track" }, [this._slider, this._time]);
    viewer.listen(this._slider, "input", () => this._scrub(Number(this._slider?.value)));
    this._lod = this._button("lod", "Level of detail", () =>
      viewer.choose("lod", !viewer.settings.lod),
    );
    this._levels = this._button("levels", "Show the levels of detail", () =>
      viewer.choose("show_level", !viewer.settings.show_level),
    );
    this._gear = this._button("settings", "Settings", () => this.fold(!this._open));
    this._bar.append(
      this._play,
      this._track,
      this._button("home", "Show everything (0)", () => viewer.reset()),
      this._lod,
      this._levels,
      this._gear,
      this._button("save", "Save the picture", () => void this._save()),
      this._button("full", "Fill the screen (f)", () => this.fullscreen()),
      this._button("hide", "Hide the bar (h)", () => this.toggle()),
    );
  }

  /** Make what depends on the scene. */
  build() {
    const { header } = this.viewer;
    if (!header) return;
    this._note.hidden = true;
    this._controls.clear();
    this._sheet.replaceChildren();
    for (const row of header.table) if (this._useful(row)) this._sheet.append(this._control(row));
    this.colours();
    this.update();
    this._arrange();
  }

  /** Whether a setting changes anything here. @param {Row} row @returns {boolean} */
  _useful(row) {
    const header = /** @type {Header} */ (this.viewer.header);
    const rebuild = this.viewer.options.rebuild ?? false;
    const { paper, slices } = header;
    if (["lod", "show_level"].includes(row.name)) return false; // in the bar
    if (["motion", "speed", "speed_in", "period"].includes(row.name)) return this._streams;
    if (["grain", "fixed_grain"].includes(row.name)) return !paper;
    if (row.name === "two_sided") return slices.sides === 2;
    if (row.name === "seed") return !paper || (rebuild && !paper.picture);
    if (row.name === "resolution") return !paper || rebuild;
    if (row.name === "tiles")
      {return Boolean(paper?.picture && (header.settings.noise === "image" || rebuild));}
    if (row.name === "noise_correction") return Boolean(paper && rebuild);
    if (row.name === "parameter") return slices.steps === 1 && rebuild;
    return row.affects === "uniform" || rebuild;
  }

  /** Whether a clock moves the picture. */
  get _streams() {
    const { header, varies } = this.viewer;
    return Boolean(
      header && !varies && !header.paper && !header.variant.includes("FLOWTEX_SIGNFREE"),
    );
  }

  /** @param {Row} row @returns {HTMLElement} */
  _control(row) {
    const name = dom("span", { class: "name" }, [label(row.name)]);
    const shown = dom("output", {}, []);
    const input = this._input(row, shown);
    const line = dom("label", { class: "row", title: row.text, "data-setting": row.name });
    const typed = input instanceof HTMLInputElement && input.type === "range";
    line.append(name, ...(typed ? [shown] : []), input);
    if (typed) line.classList.add("ranged");
    return line;
  }

  /** @param {Row} row @param {HTMLOutputElement} shown @returns {HTMLElement} */
  _input(row, shown) {
    const { viewer } = this;
    // What has to be traced or built anew waits until the hand lets go.
    const when = row.affects === "uniform" ? "input" : "change";
    if (row.kind === "bool") {
      const input = dom("input", { type: "checkbox", role: "switch" });
      viewer.listen(input, "change", () => viewer.choose(row.name, input.checked));
      this._controls.set(row.name, (value) => void (input.checked = Boolean(value)));
      return input;
    }
    if (row.choices.length) {
      const options = row.choices.map((choice) => dom("option", { value: choice }, [choice]));
      const input = dom("select", {}, options);
      viewer.listen(input, "change", () => viewer.choose(row.name, input.value));
      this._controls.set(row.name, (value) => void (input.value = String(value)));
      return input;
    }
    const [low, high] = [row.low ?? 0, row.high ?? 1];
    const whole = row.kind === "int";
    if (high - low > STOPS || (whole && high - low > 20000)) {
      const bounds = { min: String(low), max: String(high), step: whole ? "1" : "any" };
      const input = dom("input", { type: "number", ...bounds });
      viewer.listen(input, "change", () => {
        if (Number.isFinite(input.valueAsNumber))
          {viewer.choose(row.name, clamp(input.valueAsNumber, low, high));}
      });
      this._controls.set(row.name, (value) => void (input.value = String(value)));
      return input;
    }
    const even = !(low > 0 && high / low > RATIO);
    const to = (/** @type {number} */ v) => (even ? v : Math.log2(v));
    const from = (/** @type {number} */ x) => {
      const v = even ? x : 2 ** x;
      return whole ? Math.round(v) : Number(clamp(v, low, high).toPrecision(3));
    };
    const step = even && whole ? "1" : String((to(high) - to(low)) / 400);
    const input = dom("input", {
      type: "range",
      min: String(to(low)),
      max: String(to(high)),
      step,
    });
    viewer.listen(input, "input", () => void (shown.textContent = text(from(Number(input.value)))));
    viewer.listen(input, when, () => viewer.choose(row.name, from(Number(input.value))));
    this._controls.set(row.name, (value) => {
      input.value = String(to(Number(value)));
      shown.textContent = text(Number(value));
    });
    return input;
  }

  /** Name the flow, or tell what is different in one of two views of it. */
  _name() {
    const { header, settings } = this.viewer;
    const names = (header?.differs ?? []).filter((name) => name in settings);
    const told = names.map((name) => {
      const value = settings[name];
      return `${label(name)}: ${value === true ? "on" : value === false ? "off" : value}`;
    });
    const title = told.join(", ") || header?.name || "";
    this._title.textContent = title;
    this._title.hidden = !title;
    this.viewer.root.setAttribute("aria-label", title ? `Flow texture: ${title}` : "Flow texture");
  }

  /** Show the present values. */
  update() {
    const { settings, playing } = this.viewer;
    this._name();
    for (const [name, show] of this._controls) if (name in settings) show(settings[name]);
    if (this._ramps !== Boolean(settings.show_level)) this.colours();
    this._lod?.setAttribute("aria-pressed", String(Boolean(settings.lod)));
    this._levels?.setAttribute("aria-pressed", String(Boolean(settings.show_level)));
    if (this._play) {
      const title = playing ? "Pause (space)" : "Play (space)";
      this._play.replaceChildren(icon(playing ? "pause" : "play"));
      this._play.title = title;
      this._play.setAttribute("aria-label", title);
      this._play.hidden = !this.viewer.varies && !this._streams;
    }
    if (this._track)
      {this._track.hidden = !this.viewer.varies && !(this._streams && settings.motion !== "off");}
    this.tick();
  }

  /** Show the present time. */
  tick() {
    const { header, varies, time, clock, settings } = this.viewer;
    if (!header || !this._slider || !this._time || this._track?.hidden) return;
    const { times, timeUnit = "" } = header.slices;
    const [first, last] = varies
      ? [times[0], times[times.length - 1]]
      : [0, Number(settings.period)];
    const now = varies ? time : clock % last;
    this._slider.value = String((now - first) / (last - first || 1));
    this._slider.style.setProperty("--share", this._slider.value);
    const shown = varies ? `${text(now)} ${timeUnit}` : `${now.toFixed(1)} s`;
    if (this._time.textContent !== shown) this._time.textContent = shown;
  }

  /** @param {number} share */
  _scrub(share) {
    const { viewer } = this;
    const { header, varies } = viewer;
    if (!header) return;
    viewer._busyUntil = performance.now() + STILL;
    if (!varies) {
      viewer.setClock(share * Number(viewer.settings.period));
      viewer.options.onClock?.(viewer.clock);
      return;
    }
    const { times } = header.slices;
    viewer.setTime(times[0] + share * (times[times.length - 1] - times[0]));
    viewer.options.onTime?.(viewer.time);
  }

  /** The legend, from the colours of the map. */
  colours() {
    const { header, parts, settings } = this.viewer;
    const map = parts.get("cmap")?.data;
    const name = header?.scalars.name ?? null;
    this._ramps = Boolean(settings.show_level);
    const bare =
      header?.paper?.picture === true && settings.strength === 1 && !header.scalars.bar;
    const unwanted = header?.scalars.bar === false || Boolean(settings.show_level);
    this._legend.hidden = name === null || !map || bare || unwanted;
    if (this._legend.hidden || !header || !map) return;
    const stops = Array.from({ length: 33 }, (_, n) => {
      const at = 4 * Math.round((n / 32) * 255);
      return `rgb(${map[at]} ${map[at + 1]} ${map[at + 2]})`;
    });
    const ramp = dom("div", { class: "ramp" });
    ramp.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
    this._mark = dom("i", { hidden: "" });
    ramp.append(this._mark);
    const { low, high, unit: measure } = header.scalars;
    this._legend.replaceChildren(
      dom("div", { class: "name" }, [measure ? `${name} (${measure})` : String(name)]),
      ramp,
      dom("div", { class: "ends" }, [
        dom("span", {}, [text(low)]),
        dom("span", {}, [text(high)]),
      ]),
    );
  }

  /** Tell what is under the pointer. @param {Point | null} point */
  read(point) {
    const header = this.viewer.header;
    this._readout.replaceChildren();
    if (this._mark) this._mark.hidden = true;
    if (!point || !header) return;
    const zoom = Math.max(this.viewer.navigator?.zoom ?? 1, 1);
    const digits = Math.min(Math.ceil(4 + Math.log10(zoom)), 14);
    const tiny = 1e-12 * header.geometry.extent;
    const flat =
      header.geometry.planar &&
      Math.abs(point.position[2] - header.geometry.center[2]) < tiny &&
      Math.abs(header.geometry.frame[8]) > 0.999;
    const shown = point.position.slice(0, flat ? 2 : 3).map((x) => {
      const near = Math.abs(x) < 1e-9 * header.geometry.extent ? 0 : x;
      return digits > 5 ? String(Number(near.toPrecision(digits))) : text(near);
    });
    this._readout.append(dom("span", {}, [`(${shown.join(", ")})`]));
    for (const [name, value] of Object.entries(point.values)) {
      const { unit: measure, low, high } = header.scalars;
      this._readout.append(
        dom("b", {}, [`${name} ${text(value)}${measure ? ` ${measure}` : ""}`]),
      );
      if (this._mark && Number.isFinite(value)) {
        this._mark.hidden = false;
        this._mark.style.left = `${100 * clamp((value - low) / (high - low || 1), 0, 1)}%`;
      }
    }
  }

  /** Unfold or fold the settings. @param {boolean} [open] */
  fold(open = false) {
    this._open = open;
    this._arrange();
  }

  /** Show or hide the bar. @param {boolean} [shown] */
  toggle(shown = !this.shown) {
    if (shown === this.shown) return;
    this.shown = shown;
    this._arrange();
    this.viewer.options.onControls?.(shown);
  }

  _arrange() {
    const ready = this.viewer.header !== null;
    this._bar.hidden = !this.shown || !ready;
    const follows = Boolean(this.viewer.options.follows);
    this._handle.hidden = this.shown || !ready || follows;
    this._head.hidden = !(this.shown || follows) || !ready;
    this._sheet.hidden = !this.shown || !this._open || !ready;
    this.viewer.root.classList.toggle("flowtex-open", !this._sheet.hidden);
    this._gear?.setAttribute("aria-pressed", String(this._open));
  }

  /** Tell what is waited for, or that nothing is. @param {string[]} missing */
  wait(missing) {
    this._busy.hidden = !missing.length;
    const { viewer } = this;
    if (missing.length && !viewer.options.onNeed && !this._late) {
      // Parts come in any order; what does not come within a while is told.
      this._late = viewer.later(() => {
        this._late = null;
        const [a, b] = viewer._moment();
        const lacking = viewer.drawing?.missing(a, b) ?? [];
        if (lacking.length)
          {this.fail("The scene is not complete.", `Missing: ${lacking.join(", ")}`);}
      }, 4000);
    }
  }

  /** Tell for a moment how the wheel zooms, or no longer. @param {boolean} shown */
  hint(shown) {
    if (this._hinted) clearTimeout(this._hinted);
    if (this._hinted) this.viewer._timers.delete(this._hinted);
    this._hinted = shown ? this.viewer.later(() => this.hint(false), HINT) : null;
    this._hint.hidden = !shown;
  }

  /** A picture is complete. */
  drawn() {
    this._note.hidden = true;
    delete this.viewer.root.dataset.failed;
  }

  /** Tell what went wrong. @param {string} what @param {string} detail */
  fail(what, detail) {
    this._note.replaceChildren(dom("strong", {}, [what]), dom("pre", {}, [detail]));
    this._note.hidden = false;
    this._busy.hidden = true;
    this.viewer.root.dataset.failed = "true";
  }

  fullscreen() {
    const { root } = this.viewer;
    const whole = root.closest(".flowtex-pair") ?? root;
    if (document.fullscreenElement) void document.exitFullscreen();
    else void whole.requestFullscreen?.().catch(() => undefined);
  }

  async _save() {
    const blob = await pngOf(this.viewer.together);
    const link = dom("a", {
      href: URL.createObjectURL(blob),
      download: `${(this.viewer.header?.name || "flow").replace(/[\\/:*?"<>|]+/g, " ").trim()}.png`,
    });
    link.click();
    this.viewer.later(() => URL.revokeObjectURL(link.href), 5000);
  }
}

// --- style -------------------------------------------------------------------------------------

const STYLE = `
:host {
  --ink: var(--jp-ui-font-color1, #1b2430);
  --quiet: var(--jp-ui-font-color2, #566373);
  --ground: var(--jp-layout-color1, #ffffff);
  --edge: color-mix(in srgb, var(--ink) 14%, transparent);
  --hover: color-mix(in srgb, var(--ink) 9%, transparent);
  --accent: var(--jp-brand-color1, #0f766e);
  --shadow: 0 4px 18px rgb(16 24 40 / 0.16);
  --glass: color-mix(in srgb, var(--ground) 78%, transparent);
  color-scheme: light dark;
  position: relative;
  display: block;
  box-sizing: border-box;
  width: 100%;
  height: 100%;
  overflow: hidden;
  container-type: inline-size;
  color: var(--ink);
  background: var(--ground);
  font: 12px/1.35 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif;
  outline: none;
  user-select: none;
  -webkit-user-select: none;
}
@media (prefers-color-scheme: dark) {
  :host {
    --ink: var(--jp-ui-font-color1, #e8edf2);
    --quiet: var(--jp-ui-font-color2, #a3b0bd);
    --ground: var(--jp-layout-color1, #151a21);
    --accent: var(--jp-brand-color1, #4fd1c5);
    --shadow: 0 4px 18px rgb(0 0 0 / 0.35);
  }
}
:host(:focus-visible) { box-shadow: inset 0 0 0 2px var(--accent); }
:host(:fullscreen) { width: 100vw !important; height: 100vh !important; }
* { box-sizing: border-box; }
[hidden] { display: none !important; }
.picture {
  position: absolute; inset: 0; width: 100%; height: 100%;
  cursor: grab; touch-action: none; display: block;
}
:host(.flowtex-guarded:not(.flowtex-held, :fullscreen)) .picture { touch-action: pan-y; }
:host(.flowtex-grabbing) .picture { cursor: grabbing; }
.glass {
  background: var(--glass);
  border: 1px solid var(--edge);
  border-radius: 10px;
  box-shadow: var(--shadow);
  backdrop-filter: blur(12px) saturate(1.3);
  -webkit-backdrop-filter: blur(12px) saturate(1.3);
}
.head {
  position: absolute; left: 10px; top: 10px; max-width: calc(100% - 20px);
  padding: 5px 10px; display: flex; gap: 10px; align-items: baseline;
  pointer-events: none; white-space: nowrap; overflow: hidden;
}
.title { font-weight: 600; overflow: hidden; text-overflow: ellipsis; }
.title::first-letter { text-transform: uppercase; }
.readout { display: flex; gap: 8px; color: var(--quiet); font-variant-numeric: tabular-nums; }
.readout:empty { display: none; }
.head:not(:has(.title:not([hidden]), .readout:not(:empty))) { display: none; }
.readout b { color: var(--ink); font-weight: 500; }
.legend {
  position: absolute; right: 10px; top: 10px; width: 150px; padding: 5px 10px 6px;
  font-size: 11px; pointer-events: none;
}
.legend .name { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; margin-bottom: 3px; }
.ramp { position: relative; height: 8px; border-radius: 4px; box-shadow: inset 0 0 0 1px var(--edge); }
.ramp i {
  position: absolute; top: -2px; bottom: -2px; width: 2px; margin-left: -1px; border-radius: 1px;
  background: var(--ink); box-shadow: 0 0 0 1px var(--ground);
}
.ends {
  display: flex; justify-content: space-between; margin-top: 2px;
  color: var(--quiet); font-variant-numeric: tabular-nums;
}
.bar {
  position: absolute; left: 10px; right: 10px; bottom: 10px; width: fit-content; margin: 0 auto;
  display: flex; align-items: center; gap: 1px; padding: 3px;
}
button {
  appearance: none; flex: none; display: grid; place-items: center; width: 30px; height: 30px;
  margin: 0; padding: 0; border: 0; border-radius: 7px; background: none; color: var(--ink);
  cursor: pointer; transition: background-color 0.12s, color 0.12s;
}
button:hover { background: var(--hover); }
button:focus-visible, input:focus-visible, select:focus-visible {
  outline: 2px solid var(--accent); outline-offset: -1px;
}
button[aria-pressed="true"] { color: var(--accent); background: color-mix(in srgb, var(--accent) 14%, transparent); }
svg { width: 18px; height: 18px; pointer-events: none; }
path {
  fill: none; stroke: currentColor; stroke-width: 1.7; stroke-linecap: round; stroke-linejoin: round;
}
path.solid { fill: currentColor; }
.handle {
  position: absolute; left: 50%; bottom: 8px; margin-left: -17px; width: 34px; height: 20px; opacity: 0.35;
}
:host(:hover) .handle, .handle:focus-visible { opacity: 1; }
.handle:hover { background: var(--glass); }
.track { display: flex; align-items: center; gap: 8px; min-width: 90px; width: 260px; flex: 0 1 auto; padding: 0 6px 0 4px; }
.time { flex: none; min-width: 44px; color: var(--quiet); font-variant-numeric: tabular-nums; white-space: nowrap; }
input[type="range"] {
  appearance: none; -webkit-appearance: none; flex: 1; min-width: 0; width: 100%; height: 18px;
  margin: 0; background: none; cursor: pointer; accent-color: var(--accent);
}
input[type="range"]::-webkit-slider-runnable-track { height: 4px; border-radius: 2px; background: var(--edge); }
input[type="range"]::-moz-range-track { height: 4px; border-radius: 2px; background: var(--edge); }
input[type="range"]::-webkit-slider-thumb {
  -webkit-appearance: none; width: 14px; height: 14px; margin-top: -5px; border: 0; border-radius: 50%;
  background: var(--accent); box-shadow: 0 1px 3px rgb(0 0 0 / 0.3);
}
input[type="range"]::-moz-range-thumb {
  width: 14px; height: 14px; border: 0; border-radius: 50%; background: var(--accent);
}
.settings {
  position: absolute; right: 10px; bottom: 58px; width: 248px; max-width: calc(100% - 20px);
  max-height: calc(100% - 68px); overflow-y: auto; padding: 6px 12px; scrollbar-width: thin;
  overscroll-behavior: contain; --glass: color-mix(in srgb, var(--ground) 90%, transparent);
  background: var(--glass);
}
:host(.flowtex-open) .legend { display: none; }
.row {
  display: grid; grid-template-columns: 1fr auto; align-items: center; column-gap: 10px;
  min-height: 30px; padding: 2px 0;
}
.row.ranged input { grid-column: 1 / -1; }
.row output { color: var(--quiet); font-variant-numeric: tabular-nums; }
.row + .row { border-top: 1px solid var(--edge); }
select, input[type="number"] {
  font: inherit; color: var(--ink); background: var(--hover); border: 0; border-radius: 6px;
  padding: 3px 6px; width: 110px; height: 24px;
}
option { color: var(--ink); background: var(--ground); }
input[role="switch"] {
  appearance: none; -webkit-appearance: none; position: relative; width: 30px; height: 18px; margin: 0;
  border-radius: 9px; background: var(--edge); cursor: pointer; transition: background-color 0.15s;
}
input[role="switch"]::after {
  content: ""; position: absolute; left: 2px; top: 2px; width: 14px; height: 14px; border-radius: 50%;
  background: #fff; box-shadow: 0 1px 3px rgb(0 0 0 / 0.35); transition: transform 0.15s;
}
input[role="switch"]:checked { background: var(--accent); }
input[role="switch"]:checked::after { transform: translateX(12px); }
.busy {
  position: absolute; left: 50%; top: 50%; transform: translate(-50%, -50%); padding: 5px 12px;
  border-radius: 10px; background: var(--glass); color: var(--quiet); pointer-events: none;
}
.hint {
  position: absolute; left: 50%; bottom: 56px; transform: translateX(-50%); padding: 4px 12px;
  color: var(--quiet); pointer-events: none; white-space: nowrap; max-width: calc(100% - 20px);
  overflow: hidden; text-overflow: ellipsis;
}
.note {
  position: absolute; inset: 0; display: flex; flex-direction: column; align-items: center;
  justify-content: center; gap: 6px; padding: 24px; text-align: center; background: var(--ground);
  overflow: auto; user-select: text; -webkit-user-select: text;
}
.note pre {
  margin: 0; max-width: 100%; white-space: pre-wrap; color: var(--quiet);
  font: 11px/1.4 ui-monospace, Menlo, Consolas, monospace; text-align: left;
}
@container (max-width: 460px) {
  .bar { flex-wrap: wrap; justify-content: center; }
  .track { order: -1; flex: 1 1 100%; width: auto; }
  .legend { width: 104px; padding: 4px 8px; }
  .settings { bottom: 80px; max-height: calc(100% - 90px); }
  .title { max-width: 110px; }
  .readout { flex-direction: column; gap: 0; }
  .head { flex-direction: column; gap: 0; max-width: calc(100% - 134px); }
}
@container (max-width: 220px) {
  .legend { display: none; }
}
@container (max-width: 330px) {
  button { width: 27px; height: 27px; }
}
:host(.flowtex-bare) :is(.head, .legend, .settings, .bar, .handle) { display: none; }
`;

// --- a page of its own, and a notebook -----------------------------------------------------------

/** @type {Record<string, (bytes: ArrayBuffer) => Data>} */
const KINDS = {
  float32: (bytes) => new Float32Array(bytes),
  float16: (bytes) => new Uint16Array(bytes),
  uint16: (bytes) => new Uint16Array(bytes),
  int16: (bytes) => new Int16Array(bytes),
  int8: (bytes) => new Int8Array(bytes),
  uint8: (bytes) => new Uint8Array(bytes),
};

/**
 * Bytes as numbers, in memory of their own: what comes over a wire need not be aligned.
 * @param {string} kind @param {ArrayBuffer | ArrayBufferView} bytes @returns {Data}
 */
export function decoded(kind, bytes) {
  const view = ArrayBuffer.isView(bytes)
    ? new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength)
    : new Uint8Array(bytes);
  const make = KINDS[kind];
  if (!make)
    {throw new Error(`a part has the type "${kind}"; expected ${Object.keys(KINDS).join(", ")}`);}
  return make(view.slice().buffer);
}

/**
 * @typedef {{
 *   dtype: string, shape: number[], data: ArrayBuffer | ArrayBufferView, digest?: string,
 * }} Packed
 */

/** Before the names of the parts of a second view. */
const BESIDE = "beside:";

/**
 * Show a scene that is there as a whole.
 * @param {HTMLElement} element
 * @param {Header} header
 * @param {Record<string, Packed>} parts those of a view beside it are named `beside:...`
 * @param {Options} [options]
 * @returns {Viewer} the first view
 */
export function mountPage(element, header, parts, options = {}) {
  const headers = header.beside ? [header, header.beside] : [header];
  const viewers = viewersIn(element, headers.length, options);
  viewers.forEach((viewer, n) => viewer.setHeader(headers[n]));
  for (const [name, part] of Object.entries(parts)) {
    const aside = name.startsWith(BESIDE);
    const viewer = viewers[aside ? 1 : 0];
    const data = decoded(part.dtype, part.data);
    viewer?.setPart(aside ? name.slice(BESIDE.length) : name, data, part.shape, part.digest);
  }
  return viewers[0];
}

/** Milliseconds between two messages about the camera, and about the time. */
const CAMERA = 100;
const CLOCK = 250;

/**
 * Call at most once in a while, the last time for certain.
 * @template T @param {Viewer} viewer @param {number} wait milliseconds @param {(value: T) => void} call
 * @returns {(value: T) => void}
 */
function throttled(viewer, wait, call) {
  /** @type {{ value: T } | null} */
  let next = null;
  let running = false;
  const run = () => {
    running = next !== null;
    if (!next) return;
    const { value } = next;
    next = null;
    call(value);
    viewer.later(run, wait);
  };
  return (value) => {
    next = { value };
    if (!running) run();
  };
}

/**
 * A message with arrays, which the page holds for as long as nobody has taken them; what was only
 * offered, and is not there, is null.
 * @typedef {{ view: number, generation: number, names: string[], parts: (Part | null)[] }} Letter
 */

/** @param {any} content @param {any[]} buffers @returns {Letter} */
function opened(content, buffers) {
  const graphics = sharedGraphics();
  const { view = 0, generation = 0, names, kind, digests = [] } = content;
  const parts = names.map((/** @type {string} */ _, /** @type {number} */ n) => {
    const known = graphics.stock.get(digests[n])?.part;
    if (known) return graphics.hold(known);
    if (kind === "offer") return null;
    const data = decoded(content.dtypes[n], buffers[n]);
    return graphics.hold({ data, shape: content.shapes[n], digest: digests[n] });
  });
  return { view, generation, names, parts };
}

/** @param {Letter[]} letters */
function discard(letters) {
  for (const { parts } of letters) for (const part of parts) sharedGraphics().release(part ?? undefined);
}

/** Traits with the headers of the views. */
const HEADERS = ["_header", "_header_beside"];

/** Letters that came before there was a view, by the widget's key. @type {Map<string, Letter[]>} */
const mailbox = new Map();

/**
 * What anywidget calls for each widget: arrays come as soon as the kernel has them, while the cell
 * that shows the widget may still be running.
 * @param {{ model: any }} given @returns {() => void}
 */
function initialize({ model }) {
  const key = model.get("_key");
  mailbox.set(key, []);
  const hear = (/** @type {any} */ content, /** @type {any[]} */ buffers) => {
    if (content?.kind === "parts" || content?.kind === "offer") {
      mailbox.get(key)?.push(opened(content, buffers));
    }
  };
  model.on("msg:custom", hear);
  return () => {
    model.off("msg:custom", hear);
    discard(mailbox.get(key) ?? []);
    mailbox.delete(key);
  };
}

/**
 * What anywidget calls for each view of a widget; see flowtex/widget.
 * @param {{ model: any, el: HTMLElement }} given @returns {() => void}
 */
function render({ model, el }) {
  /** @type {Map<string, string>} */
  const sent = new Map();
  const tell = (/** @type {string} */ name, /** @type {unknown} */ value) => {
    sent.set(name, JSON.stringify(value));
    model.set(name, value);
    model.save_changes();
  };
  let told = false;
  const beside = model.get("_header_beside");
  const count = beside && beside.format ? 2 : 1;
  /** @type {Options} */
  const options = {
    rebuild: true,
    guarded: true,
    controls: model.get("bar") ?? true,
    onCamera: (camera) => tellCamera(camera),
    onTime: (time) => tellTime({ time }),
    onClock: (clock) => tellTime({ clock }),
    onPlaying: (playing) => tell("playing", playing),
    onPoint: (point) => tell("point", point),
    onSetting: (name, value) => tell(name, value),
    onControls: (shown) => tell("bar", shown),
  };
  const viewers = viewersIn(el, count, options, (n) => ({
    onNeed: (step) => model.send({ kind: "need", step, view: n }),
    onFrame: () => {
      if (told || !viewers.every(({ sharp }) => sharp)) return;
      told = true;
      void pngOf(viewers)
        .then((blob) => blob.arrayBuffer())
        .then((png) => {
          if (!viewer.disposed) model.send({ kind: "frame" }, undefined, [png]);
        });
    },
  }));
  const [viewer] = viewers;
  const tellCamera = throttled(viewer, CAMERA, (/** @type {CameraState} */ camera) =>
    tell("camera", camera),
  );
  const tellTime = throttled(viewer, CLOCK, (/** @type {Record<string, number>} */ value) => {
    for (const [name, now] of Object.entries(value)) tell(name, now);
  });
  const resize = () => {
    const [width, height] = model.get("size") ?? [0, 480];
    const frame = /** @type {HTMLElement} */ (viewer.root.closest(".flowtex-pair") ?? viewer.root);
    frame.style.width = width ? `${width}px` : "100%";
    frame.style.height = `${height || 480}px`;
  };
  const takeHeader = (/** @type {number} */ n) => {
    const header = model.get(HEADERS[n]);
    if (!header || !header.format) return;
    const rows = /** @type {Row[]} */ (header.table);
    const settings = Object.fromEntries(
      rows.map(({ name, default: usual }) => [name, model.get(name) ?? usual]),
    );
    viewers[n].setHeader({
      ...header,
      settings,
      camera: stateOf(model.get("camera")),
      time: model.get("time") ?? 0,
      clock: model.get("clock") ?? 0,
    });
    const came = early;
    early = [];
    came.forEach(take);
    for (const { name } of rows) {
      follow(name, (value) => {
        for (const each of viewers) each.takeSetting(name, /** @type {Value} */ (value));
      });
    }
  };
  /** @type {[string, (...given: any[]) => void][]} */
  const followed = [];
  const listen = (/** @type {string} */ event, /** @type {(...given: any[]) => void} */ call) => {
    if (followed.some(([known]) => known === event)) return;
    followed.push([event, call]);
    model.on(event, call);
  };
  const follow = (/** @type {string} */ name, /** @type {(value: unknown) => void} */ take) =>
    listen(`change:${name}`, () => {
      const value = model.get(name);
      // What comes back from the kernel is what was sent, and may be late.
      if (sent.get(name) !== JSON.stringify(value)) take(value);
      sent.delete(name);
    });
  // The first view takes what has come; further ones ask.
  /** @type {Letter[]} */
  let early = mailbox.get(model.get("_key")) ?? [];
  mailbox.delete(model.get("_key"));
  const take = (/** @type {Letter} */ letter) => {
    const theirs = viewers[letter.view];
    if (!theirs) return;
    const now = theirs.header ? (theirs.header.generation ?? 0) : -1;
    if (letter.generation > now) {
      early.push(letter);
      return;
    }
    /** @type {string[]} */
    const lacking = [];
    letter.names.forEach((name, n) => {
      // Slices that the kernel has made anew meanwhile are on their way.
      if (letter.generation !== now && name.includes("/")) return;
      const part = letter.parts[n];
      if (part) theirs.setPart(name, part.data, part.shape, part.digest);
      else lacking.push(name);
    });
    discard([letter]);
    if (lacking.length) model.send({ kind: "want", names: lacking, view: letter.view });
  };
  listen("msg:custom", (content, buffers) => {
    if (content?.kind === "parts" || content?.kind === "offer") take(opened(content, buffers));
    if (content?.kind === "error") viewer.panel.fail("The kernel could not go on.", content.text);
  });
  viewers.forEach((_, n) => listen(`change:${HEADERS[n]}`, () => takeHeader(n)));
  listen("change:size", resize);
  follow("camera", (camera) => {
    const state = stateOf(/** @type {CameraState | null} */ (camera));
    if (state) for (const each of viewers) each.setCamera(state);
  });
  follow("time", (time) => viewers.forEach((each) => each.setTime(Number(time))));
  follow("clock", (clock) => viewers.forEach((each) => each.setClock(Number(clock))));
  follow("playing", (playing) => (playing ? viewer.play() : viewer.pause()));
  follow("bar", (shown) => viewer.panel.toggle(Boolean(shown)));
  resize();
  viewers.forEach((_, n) => takeHeader(n));
  if (model.get("playing")) viewer.play();
  // What came before the client was loaded is lost.
  const whole = viewers.every((each) => {
    const [before, after] = each._moment();
    return each.drawing && !each.drawing.missing(before, after).length;
  });
  if (!whole) model.send({ kind: "ready" });
  return () => {
    for (const [event, call] of followed) model.off(event, call);
    discard(early);
    for (const each of viewers) each.dispose();
  };
}

/** A camera, or null where a host has none yet. @param {CameraState | null | undefined} camera */
function stateOf(camera) {
  return camera && Array.isArray(camera.position) ? camera : null;
}

export default { initialize, render };
