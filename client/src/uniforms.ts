// The uniforms of the shaders, by name, as flowtex/rendering/uniforms.py computes them; one
// fixture holds both to the same values. They depend on the view, so all is in double precision.

import { isSignFree, type Header, type ImageTextures, type Settings } from "./protocol.ts";
import { clamp, dot, scale, subtract, toFrame, type Vector } from "./vectors.ts";

export type Uniform = boolean | number | readonly number[] | Float32Array;

export interface ViewState {
  focus: readonly number[];
  anchor: Vector;
  eye: readonly number[];
  between: number;
  time: number;
  clock: number;
  /** Whether the grains of a field that varies stand still, as where no time goes by. */
  still?: boolean;
  /** Pixels that are drawn along one that the settings speak of. */
  density: number;
  /** Length that a pixel drawn covers at the focus. */
  pixel: number;
}

/** The table's settings with the types that they have there. */
type Numbers = Record<"kernel" | "texture" | "motion" | "speed_in", string> &
  Record<"two_sided" | "lod" | "fixed_grain" | "show_level", boolean> &
  Record<"samples" | "spacing" | "grain" | "contrast" | "strength" | "fade" | "seed", number> &
  Record<"tiles" | "resolution" | "speed" | "period", number>;

/** Uniforms of shaders/common/uniforms.glsl. */
export function uniforms(header: Header, settings: Settings, view: ViewState): Record<string, Uniform> {
  const { geometry, slices, constants } = header;
  const s = settings as unknown as Numbers;
  const signFree = isSignFree(header);
  const finest = 2 ** (Math.floor(Math.log2(geometry.extent)) - constants.noiseDoublings);
  const w = view.eye[3];
  const eye = toFrame(geometry.frame, subtract(view.eye, scale(geometry.center, w)));
  const sparse = isSparse(header, settings);
  const chosen = sparse ? "ramp" : s.kernel;
  const kernel = signFree && chosen === "ramp" ? "hann" : chosen;
  return {
    u_eye: [...subtract(eye, scale(view.anchor, w)), w],
    u_between: view.between,
    u_slicesSize: [geometry.columns.size, geometry.rows.size],
    u_deepest: geometry.levels,
    u_lags: slices.lags,
    u_lagCount: slices.lags.length,
    u_sides: s.two_sided || signFree || sparse ? slices.sides : 1,
    u_unit: slices.unit,
    u_rateLayer: slices.count - 1,
    u_cell: slices.cell,
    u_samples: isMoving(header, settings, view.still) ? 2 * s.samples - 1 : s.samples,
    u_spacing: s.spacing,
    u_grain: s.grain * view.density,
    u_kernel: constants.kernels.indexOf(kernel),
    u_lod: s.lod,
    u_contrast: s.contrast,
    u_strength: s.strength,
    u_even: isEven(header, settings),
    u_fade: signFree ? 0 : s.fade,
    u_seed: s.seed,
    u_showLevel: s.show_level,
    u_fixed: s.fixed_grain,
    ...motionUniforms(header, s, view),
    ...noiseOrigin(header, view, finest),
    ...turnUniforms(header, view, finest),
    u_noiseFinest: finest,
    u_texel: geometry.extent / s.resolution,
    u_apart: arrowDistance(header, settings) * view.density,
    u_bySpeed: settings.arrow_length === "speed",
    u_arrowSides: slices.sides,
    u_pieces: constants.arrows.pieces,
    ...(header.image ? imageUniforms(header.image, s, view.density) : {}),
  };
}

/** Whether the grains change in time, which is a variant of the shader. */
export function isMoving(header: Header, settings: Settings, still = false): boolean {
  const streams = settings.motion !== "off" && !isSignFree(header);
  return !header.image && (streams || (header.slices.steps > 1 && !still));
}

/** Whether the texture is one of streaklets, which is a variant too. */
export function isSparse(header: Header, settings: Settings): boolean {
  return !header.image && settings.texture === "streaklets";
}

/** Whether the local mean of the texture is subtracted, where grains fit the pixels. */
export function isEven(header: Header, settings: Settings): boolean {
  const fits = settings.lod && !settings.fixed_grain;
  return Boolean(fits) && !header.image && !isSparse(header, settings);
}

/** Whether arrows are drawn: a sign-free field has none, nor has an image. */
export function hasArrows(header: Header, settings: Settings): boolean {
  return Number(settings.arrows) > 0 && !isSignFree(header) && !header.image;
}

/** Pixels of the page from an arrow to the next at least. */
export function arrowDistance({ constants }: Header, { arrows }: Settings): number {
  return constants.arrows.least * Math.max(Number(arrows), constants.arrows.mostDense);
}

/**
 * Whether a path may be so short that it stays in a cell where the flow turns, which is a variant too.
 * In perspective the nearest point of the surface counts, or of the ball around it.
 */
export function isNear(header: Header, settings: Settings, view: ViewState): boolean {
  const { geometry, slices, constants } = header;
  const s = settings as unknown as Numbers;
  const gap = Math.hypot(...subtract(view.eye, geometry.center)) - 0.5 * geometry.extent;
  const away = view.eye[3] ? Math.max(gap, 0) / Math.hypot(...subtract(view.eye, view.focus)) : 1;
  const grain = s.lod ? view.pixel * away * s.grain * view.density : geometry.extent / s.resolution;
  return Math.floor(s.samples / 2) * s.spacing * grain < constants.farCells * slices.critical;
}

/** Names that are defined before the shaders' text at these settings. */
export function variantOf(header: Header, settings: Settings, isClose: boolean, still: boolean): string[] {
  const chosen = {
    FLOWTEX_CELLS: isClose,
    FLOWTEX_MOVING: isMoving(header, settings, still),
    FLOWTEX_SPARSE: isSparse(header, settings),
    FLOWTEX_REPEATED: !!header.ends,
  };
  return Object.entries(chosen).flatMap(([name, holds]) => (holds ? [name] : []));
}

/** How the grains change: with the time of a field that varies, by the clock of a steady one. */
function motionUniforms(header: Header, s: Numbers, view: ViewState): Record<string, Uniform> {
  const { geometry, constants } = header;
  const { times, pace } = header.slices;
  const varies = times.length > 1;
  const inPixels = !varies && s.speed_in === "pixels";
  // About the time in which the flow crosses the surface, a whole share of the series.
  const span = times[times.length - 1] - times[0];
  const rounds = (span * pace) / geometry.extent;
  const period = varies ? span / (Math.round(rounds) || rounds) : s.period;
  const turns = ((varies ? view.time - times[0] : view.clock) / period) % constants.mostTurns;
  const travel = period * (varies ? pace : s.speed);
  const fine = turns % constants.clockStep;
  return {
    u_clock: [turns - fine, fine],
    u_travel: travel * (inPixels ? view.density : 1),
    u_travelInPixels: inPixels,
    u_travelBySpeed: varies || s.motion === "speed",
    u_wave: constants.wavePixels * view.density,
  };
}

/** The noise's origin in space and in the finest cells of both families of lattices. */
function noiseOrigin(header: Header, view: ViewState, finest: number): Record<string, Uniform> {
  const { noiseDoublings, clearDoublings } = header.constants;
  const { frame, center } = header.geometry;
  const focus = toFrame(frame, subtract(view.focus, center));
  const limit = 2 ** (noiseDoublings - clearDoublings) - 1;
  const cells = 2 ** clearDoublings;
  const even = focus.map((x) => clamp(Math.round(x / finest / cells), -limit, limit) * cells);
  const odd = even.map((x) => x / Math.SQRT2);
  const whole = odd.map((x) => Math.floor(x / cells) * cells);
  return {
    u_noiseOrigin: even.map((x, k) => x * finest - view.anchor[k]),
    u_noiseOriginEven: even,
    u_noiseOriginOdd: whole,
    u_noiseRestOdd: odd.map((x, k) => x - whole[k]),
  };
}

/** The ends of a map around the Earth, and from one to the other in the finest cells of both families of lattices. */
function turnUniforms(header: Header, view: ViewState, finest: number): Record<string, Uniform> {
  const { ends, geometry, constants } = header;
  if (!ends) return {};
  const { frame, center } = geometry;
  const across = toFrame(frame, [1, 0, 0]);
  const [low, high] = ends.map((end) => end - center[0] - dot(across, view.anchor));
  const cells = 2 ** constants.clearDoublings;
  const even = scale(across, (ends[1] - ends[0]) / finest);
  const odd = scale(even, Math.SQRT1_2);
  const wholeOf = (turn: Vector) => turn.map((x) => Math.floor(x / cells) * cells);
  const restOf = (turn: Vector) => turn.map((x) => x - Math.floor(x / cells) * cells);
  return {
    u_ends: [across[0], across[1], low, high],
    u_turnEven: wholeOf(even),
    u_turnRestEven: restOf(even),
    u_turnOdd: wholeOf(odd),
    u_turnRestOdd: restOf(odd),
  };
}

/** Sizes of an image, or of noise that is a texture; a greater density of pixels chooses a finer level. */
function imageUniforms({ size, stepSize, repeat, deviations }: ImageTextures, s: Numbers, density: number) {
  const tiles = deviations ? 1 : s.tiles;
  // A texel of the level of noise that is drawn is a grain.
  const texels = density * (deviations ? s.grain : tiles);
  return {
    u_stepSize: stepSize.map((n) => n * density),
    u_imageSize: size.map((n) => n * texels),
    u_imageRound: [Number(repeat[1]), Number(repeat[0])],
    u_tiles: tiles,
    ...(deviations ? { u_noiseDeviations: deviations } : {}),
  };
}

/** The two time steps around a time, and how far it is between them. */
export type Moment = [before: number, after: number, between: number];

export function momentOf(times: readonly number[], time: number): Moment {
  if (times.length < 2) return [0, 0, 0];
  let step = 0;
  while (step < times.length - 2 && times[step + 1] <= time) step += 1;
  const late = (time - times[step]) / (times[step + 1] - times[step]);
  return [step, step + 1, clamp(late, 0, 1)];
}
