// Slices of a scene, traced on the graphics card from the velocity at its nodes, into the texture that is
// drawn from. Python follows the paths alike, and lays out the texels alike:
// flowtex/rendering/webgl/velocity.py has what comes here.

import { HALVES, makeLayers } from "./half.ts";
import { Poles } from "./poles.ts";
import type { Program, ProgramContext, Programs } from "./programs.ts";
import type { Data, Header, Part, TraceHeader } from "./protocol.ts";
import type { Uniform } from "./uniforms.ts";
import { clamp, cross, length, type Vector } from "./vectors.ts";

type Traced = Pick<Header, "geometry" | "slices" | "shaders">;

/** A part that is made of others. */
export type Made = Omit<Part, "digest">;

/** Greatest value of a component of a normal in sixteen bits. */
const NORMAL_MAX = 32767;
/** What the fourth channel of a layer has, as shaders/webgl2/layers.glsl knows it. */
const [NOTHING, SPEED, REACH, UNKNOWN] = [0, 1, 2, 3];
/** The layer of a side with the uncertainty of the direction, counted from 0. */
const UNKNOWN_LAYER = 2;
/** Units of the textures that a pass has. */
const UNITS = 8;
/** Lag up to which paths of a steady flow are followed; longer ones are composed. */
const DIRECT_LAG = 4;
/** Steps whose flow is held on the graphics card while paths through it are followed. */
const FLOWS_HELD = 4;
/** Cells that the fastest particle goes in a pass, at most: a pass is never long. */
const PASS_CELLS = 64;
const MOST_PARTS = 64;
/** Nodes whose paths are followed until it is waited for them. */
const PASS_NODES = 20_000;
/** Length of paths that do not end. */
const ENDLESS = 1e30;
/** Share of a lag by which rounding may miss a step. */
const LAG_ROUNDING = 1e-5;

/** Positions of the nodes that are drawn. */
export function positionOf(padded: Part, trace: TraceHeader, shape: [number, number]): Made {
  const [rows, columns] = shape;
  const width = padded.shape[1];
  const [top, left] = trace.drawn;
  const data = new Float64Array(rows * columns * 3);
  for (let j = 0, n = 0; j < rows; j += 1) {
    const first = 3 * ((j + top + 1) * width + left + 1);
    for (let k = 0; k < 3 * columns; k += 1) data[n++] = padded.data[first + k] + trace.middle[k % 3];
  }
  return { data, shape: [rows, columns, 3] };
}

/** Unit normals of the same nodes, by those around them; a pole has the mean of those of its ring. */
export function normalOf(padded: Part, trace: TraceHeader, shape: [number, number]): Made {
  const [rows, columns] = shape;
  const width = 3 * padded.shape[1];
  const [top, left] = trace.drawn;
  const data = new Int16Array(rows * columns * 3);
  for (let j = 0, n = 0; j < rows; j += 1) {
    for (let i = 0; i < columns; i += 1, n += 3) {
      const at = width * (j + top + 1) + 3 * (i + left + 1);
      const along = (step: number) =>
        [0, 1, 2].map((k) => padded.data[at + step + k] - padded.data[at - step + k]) as Vector;
      const normal = cross(along(3), along(width));
      const size = length(normal) || 1;
      for (let k = 0; k < 3; k += 1) data[n + k] = Math.round((normal[k] / size) * NORMAL_MAX);
    }
  }
  for (const { component, line, inward } of trace.poles ?? []) {
    const [at, last] = component ? [line - top, columns] : [line - left, rows];
    if (at < 0 || at >= (component ? rows : columns)) continue;
    const offset = (across: number, around: number) =>
      3 * (component ? across * columns + around : around * columns + across);
    const sum: Vector = [0, 0, 0];
    for (let m = 0; m < last; m += 1) {
      for (let k = 0; k < 3; k += 1) sum[k] += data[offset(at + inward, m) + k];
    }
    const size = length(sum) || 1;
    const mean = sum.map((x) => Math.round((x / size) * NORMAL_MAX));
    for (let m = 0; m < last; m += 1) data.set(mean, offset(at, m));
  }
  return { data, shape: [rows, columns, 3] };
}

/** The context that paths are traced in. */
interface TraceContext extends ProgramContext {
  readonly programs: Programs;
}

/** Parts by their names, of which some may be missing. */
export type FindPart = (name: string) => Part | undefined;

/** Numbers of the steps whose flow the slices of a step are traced from. */
export function flowsOf({ slices }: Pick<Header, "slices">, step: number): number[] {
  const { trace, times, lags } = slices;
  if (!trace?.pathlines || !trace.timed) return [step];
  const reach = lags[lags.length - 1] * trace.timed.unit;
  const near = times.map((time) => Math.abs(time - times[step]) < reach);
  const isNeeded = (n: number) => near[n] || near[n - 1] || near[n + 1];
  return [...times.keys()].filter(isNeeded);
}

/** A part of a path in which the flow changes evenly from that of one step to that of another. */
interface Stretch {
  from: number;
  to: number;
  /** The steps, and the lags at which the flow is theirs. */
  steps: [near: number, far: number];
  between: [near: number, far: number];
}

/** The stretches of paths to a step, on one side, from a lag to another. */
export function stretches(
  { slices }: Pick<Header, "slices">,
  step: number,
  side: number,
  from: number,
  to: number,
): Stretch[] {
  const { trace, times } = slices;
  if (!trace?.pathlines || !trace.timed) return [{ from, to, steps: [step, step], between: [0, 1] }];
  const result: Stretch[] = [];
  const { unit } = trace.timed;
  const lagOf = (n: number) => (side * (times[n] - times[step])) / unit;
  for (let n = step; from < to; n += side) {
    const isLast = !(n + side in times);
    const end = isLast ? to : lagOf(n + side);
    if (end <= from + LAG_ROUNDING * to) continue;
    const between: [number, number] = isLast ? [0, 1] : [lagOf(n), end];
    const isWhole = end >= to - LAG_ROUNDING * to;
    result.push({ from, to: isWhole ? to : end, steps: [n, isLast ? n : n + side], between });
    from = isWhole ? to : end;
  }
  return result;
}

/** Programs that follow paths, put long ones together, and lay out texels; they may not be ready yet. */
export function programsOf({ programs }: TraceContext, header: Traced, trace: TraceHeader) {
  const { fullVertex, trace: path = "", layers = "" } = header.shaders;
  const get = (fragment: string, ...variant: (string | boolean)[]) => {
    const names = variant.filter((name) => typeof name === "string");
    const program = programs.get(fullVertex, fragment, ...names);
    if (program.error) throw new Error(`the tracer cannot be built: ${program.error}`);
    return program;
  };
  const polar = trace.poles !== undefined && "FLOWTEX_POLES";
  return {
    follow: get(path, polar, trace.pathlines && "FLOWTEX_PATHLINES"),
    compose: trace.pathlines ? null : get(path, polar, "FLOWTEX_COMPOSED"),
    slopes: get(layers, "FLOWTEX_SLOPES"),
    tangents: get(layers, polar),
  };
}

/** The slices of one time while they are traced, some passes in each frame. */
export class Tracing {
  private readonly graphics: TraceContext;
  private readonly header: Traced;
  private readonly trace: TraceHeader;
  private readonly find: FindPart;
  private readonly textures = new Set<WebGLTexture>();
  private readonly frames: WebGLFramebuffer[] = [];
  /** What is traced into, which who takes it counts. */
  private result: WebGLTexture | null = null;
  private readonly passes: Generator<void, WebGLTexture>;
  /** Those of the flow at steps, by which paths are followed. */
  private readonly flows = new Map<number, WebGLTexture>();
  /** Most cells that a particle goes in a unit of lag. */
  private fastest = 1;
  private readonly poles: Poles;

  constructor(graphics: TraceContext, header: Traced, trace: TraceHeader, find: FindPart, step: number) {
    this.graphics = graphics;
    this.header = header;
    this.trace = trace;
    this.find = find;
    this.poles = new Poles(trace.poles ?? [], trace.nodes, find("rays")?.data ?? []);
    this.passes = this.slices(step);
  }

  /** Go on until a time; gives the texture of the slices, which is the caller's, when it is whole. */
  advance(until: number): WebGLTexture | null {
    if (!Object.values(programsOf(this.graphics, this.header, this.trace)).every((program) => program?.ready ?? true)) return null;
    const gl = this.graphics.context;
    try {
      do {
        const { done, value } = this.passes.next();
        // What was made on a card that is lost is nothing.
        if (gl.isContextLost()) return null;
        if (done) {
          this.result = null;
          return value;
        }
      } while (performance.now() < until);
      return null;
    } finally {
      this.unbind();
    }
  }

  dispose(): void {
    for (const texture of this.textures) this.graphics.free("Texture", texture);
    for (const frame of this.frames) this.graphics.free("Framebuffer", frame);
    if (this.result && !this.graphics.context.isContextLost()) this.graphics.context.deleteTexture(this.result);
    this.result = null;
    this.textures.clear();
    this.frames.length = 0;
  }

  private data(name: string): Data {
    const part = this.find(name);
    if (!part) throw new Error(`the part "${name}" of the scene is missing`);
    return part.data;
  }

  /** The numbers of a part, which may come in half precision. */
  private numbers(name: string): Float32Array {
    const data = this.data(name);
    return data instanceof Float32Array ? data : new Float32Array(data).map((bits) => HALVES[bits]);
  }

  private texture(width: number, height: number, inner: number, data: Float32Array | null) {
    const gl = this.graphics.context;
    const texture = this.graphics.counted(gl.createTexture());
    this.textures.add(texture);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, inner, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, data);
    return texture;
  }

  private frame(): WebGLFramebuffer {
    const gl = this.graphics.context;
    const frame = this.graphics.counted(gl.createFramebuffer());
    this.frames.push(frame);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    return frame;
  }

  private target(width: number, height: number): [WebGLTexture, WebGLFramebuffer] {
    const gl = this.graphics.context;
    const texture = this.texture(width, height, gl.RGBA32UI, null);
    const frame = this.frame();
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return [texture, frame];
  }

  private unbind(): void {
    const gl = this.graphics.context;
    for (let n = 0; n < UNITS; n += 1) {
      gl.activeTexture(gl.TEXTURE0 + n);
      gl.bindTexture(gl.TEXTURE_2D, null);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, null);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Velocity of the nodes as the shaders ask for it; notes the most cells in a unit of lag. */
  private flow(step: number): Float32Array {
    const { trace } = this;
    const data = this.numbers(`flow/${step}`);
    const unit = this.data("unit");
    const channels = data.length / unit.length;
    const flow = new Float32Array(4 * unit.length);
    for (let n = 0, at = 0; n < unit.length; n += 1, at += channels) {
      const speed = data[at + 2];
      const size = HALVES[unit[n]] * trace.unit;
      flow[4 * n] = (data[at] * speed) / size;
      flow[4 * n + 1] = (data[at + 1] * speed) / size;
      flow[4 * n + 2] = speed;
      flow[4 * n + 3] = trace.timed ? trace.timed.unit : size;
    }
    const result = this.poles.laidOut(flow);
    if (trace.timed) {
      this.fastest = Math.max(this.fastest, this.poles.fastest(result) * trace.timed.speed * trace.timed.unit);
    }
    return result;
  }

  /** The whole speed, and the uncertainty of the direction. */
  private wholeSpeed(step: number): Float32Array {
    const data = this.numbers(`flow/${step}`);
    const nodes = this.data("unit").length;
    const channels = data.length / nodes;
    const unknown = Number(this.trace.uncertain ?? false);
    const whole = new Float32Array(4 * nodes);
    for (let n = 0; n < nodes; n += 1) {
      whole[4 * n] = data[(n + 1) * channels - 1 - unknown];
      whole[4 * n + 1] = unknown * data[(n + 1) * channels - 1];
    }
    return whole;
  }

  private cells(): Float32Array {
    const [rows, columns] = this.trace.nodes;
    const [open, nearest] = ["open", "nearest"].map((name) => this.find(name)?.data);
    const cells = new Float32Array(4 * rows * columns);
    for (let n = 0; n < rows * columns; n += 1) {
      cells[4 * n] = open ? open[n] : 1;
      for (const k of [0, 1]) cells[4 * n + 1 + k] = nearest ? nearest[2 * n + k] : 0;
    }
    return cells;
  }

  private padded(): Float32Array {
    const data = this.data("padded");
    const result = new Float32Array((data.length / 3) * 4);
    for (let n = 0; n < data.length / 3; n += 1) {
      for (let k = 0; k < 3; k += 1) result[4 * n + k] = data[3 * n + k];
    }
    return result;
  }

  /** The flow of a step on the graphics card, with that of the last one requested. */
  private flowTexture(step: number): WebGLTexture {
    const { width, height } = this.poles.size;
    const gl = this.graphics.context;
    const known = this.flows.get(step);
    const texture = known ?? this.texture(width, height, gl.RGBA32F, this.flow(step));
    this.flows.delete(step);
    this.flows.set(step, texture);
    for (const [other, old] of this.flows) {
      if (this.flows.size <= FLOWS_HELD) break;
      this.flows.delete(other);
      this.textures.delete(old);
      this.graphics.free("Texture", old);
    }
    return texture;
  }

  /** Parts of a stretch, none of which has more steps than a pass may take. */
  private partsOf({ from, to }: Stretch): [from: number, to: number][] {
    const count = clamp(Math.ceil(((to - from) * this.fastest) / PASS_CELLS), 1, MOST_PARTS);
    const at = (n: number) => (n === count ? to : from + ((to - from) * n) / count);
    return Array.from({ length: count }, (_, n) => [at(n), at(n + 1)]);
  }

  /** Make one layer after the other. */
  private *slices(step: number): Generator<void, WebGLTexture> {
    const { graphics, trace, header } = this;
    const gl = graphics.context;
    const { geometry, slices } = header;
    const [rows, columns] = trace.nodes;
    const [height, width] = [geometry.rows.size, geometry.columns.size];
    const size = { width, height, layers: slices.count, channels: 4, levels: geometry.levels };
    const result = gl.createTexture();
    this.result = result;
    gl.activeTexture(gl.TEXTURE0);
    makeLayers(gl, result, size);
    const { poles } = this;
    const own = this.texture(poles.size.width, poles.size.height, gl.RGBA32F, this.flow(step));
    const rays = this.texture(...poles.raysSize, gl.RGBA32F, poles.angles);
    const constant = [
      this.texture(columns, rows, gl.RGBA32F, this.cells()),
      this.texture(columns + 2, rows + 2, gl.RGBA32F, this.padded()),
      this.texture(columns, rows, gl.RGBA32F, this.wholeSpeed(step)),
    ];
    // Paths at the first lag, at the last two, where they are now, and where they are put next.
    const pool = [0, 1, 2, 3, 4].map(() => this.target(columns, rows));
    const { lags, sides, count } = slices;
    const uniforms: Record<string, Uniform> = {
      ...{ u_flow: 0, u_cells: 1, u_padded: 2, u_speed: 3, u_before: 4, u_last: 5, u_earlier: 5 },
      ...{ u_flowNext: 6, u_rays: 7, ...poles.uniforms },
      u_longest: trace.longest ?? ENDLESS,
      u_nodes: [columns, rows],
      u_closed: [Number(trace.closed[1]), Number(trace.closed[0])],
      u_first: [trace.first[1], trace.first[0]],
      u_texels: [width, height],
      u_offsetJ: trace.offset.slice(0, 3),
      u_offsetI: trace.offset.slice(3, 6),
      u_timed: trace.timed?.speed ?? 0,
      u_rest: trace.rest,
      u_pace: trace.pace,
      u_unit: slices.unit,
      u_cell: slices.cell / slices.unit,
      u_planar: Number(geometry.planar),
      u_mostReach: 2 * lags[lags.length - 1],
    };
    const draw = (
      [w, h]: [number, number],
      textures: WebGLTexture[],
      pass: Program,
      values: Record<string, Uniform>,
    ) => {
      gl.viewport(0, 0, w, h);
      for (const ability of [gl.SCISSOR_TEST, gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE]) {
        gl.disable(ability);
      }
      textures.forEach((texture, n) => {
        gl.activeTexture(gl.TEXTURE0 + n);
        gl.bindTexture(gl.TEXTURE_2D, texture);
      });
      gl.bindVertexArray(null);
      graphics.programs.use(pass, { ...uniforms, ...values });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    };
    const frame = this.frame();
    const layer = (n: number, pass: Program, textures: WebGLTexture[], values: Record<string, Uniform>) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, result, 0, n);
      draw([width, height], [own, ...constant, ...textures], pass, values);
    };
    const { follow, compose, slopes, tangents } = programsOf(graphics, header, trace);
    layer(0, tangents, [], { u_inCells: 0 });
    if (count > 1 + sides * lags.length) layer(count - 1, tangents, [], { u_inCells: 1 });
    let asked = 0;
    for (let side = 0; side < sides; side += 1) {
      const sign = side ? 1 : -1;
      const start = 1 + side * lags.length;
      let [first, before, now] = [pool[0], pool[0], pool[0]];
      for (const [m, lag] of lags.entries()) {
        const [from, earlier] = [lags[m - 1] ?? 0, lags[m - 2] ?? 0];
        const composer = lag > DIRECT_LAG && earlier > 0 ? compose : null;
        let at = now;
        for (const stretch of stretches(header, step, sign, from, lag)) {
          const [near, far] = stretch.steps.map((n) => this.flowTexture(n));
          const parts = composer ? [[from, lag]] : this.partsOf(stretch);
          for (const [begin, end] of parts) {
            const next = pool.find((each) => ![first, before, now, at].includes(each)) ?? pool[0];
            gl.bindFramebuffer(gl.FRAMEBUFFER, next[1]);
            draw([columns, rows], [near, ...constant, at[0], before[0], far, rays], composer ?? follow, {
              u_lagEarlier: earlier,
              u_from: begin,
              u_to: end,
              u_side: sign,
              u_between: stretch.between,
            });
            at = next;
            if ((asked += rows * columns) < PASS_NODES) continue;
            // Waits until it is drawn, or a frame would have more passes than there is time for.
            gl.readPixels(0, 0, 1, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, new Uint32Array(4));
            asked = 0;
            yield;
          }
        }
        [before, now] = [now, at];
        if (!m) first = now;
        const isUnknown = trace.uncertain && m === UNKNOWN_LAYER;
        const fourth = m === 1 && !side ? SPEED : isUnknown ? UNKNOWN : NOTHING;
        if (m) layer(start + m, slopes, [now[0], now[0]], { u_fourth: fourth, u_lag: sign * lag });
      }
      layer(start, slopes, [first[0], now[0]], { u_fourth: REACH, u_lag: sign * lags[0] });
    }
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, result);
    if (size.levels) gl.generateMipmap(gl.TEXTURE_2D_ARRAY);
    return result;
  }
}
