// Slices of a scene, traced on the graphics card from the velocity at its nodes. Python follows the
// paths alike, and lays out the texels alike: flowtex/rendering/webgl/velocity.py has what comes here.

import { fromHalf } from "./half.ts";
import type { Program, ProgramContext, Programs } from "./programs.ts";
import type { Data, Header, Part, TraceHeader } from "./protocol.ts";
import type { Uniform } from "./uniforms.ts";
import { cross, length, type Vector } from "./vectors.ts";

type Traced = Pick<Header, "geometry" | "slices" | "shaders">;

/** A part that is made of others. */
export type Made = Omit<Part, "digest">;

/** Greatest value of a component of a normal in sixteen bits. */
const NORMAL_MAX = 32767;
/** Numbers by the bits of their half precision. */
const HALVES = Float32Array.from({ length: 1 << 16 }, (_, bits) => fromHalf(bits));
/** What the fourth channel of a layer has, as shaders/webgl2/layers.glsl knows it. */
const [NOTHING, UNIT, REACH, SPEED] = [0, 1, 2, 3];
const [TANGENTS, SLOPES, VELOCITY] = [0, 1, 2];
/** Units of the textures that a pass has. */
const UNITS = 6;

/** Positions of the nodes that are drawn. */
export function positionOf(padded: Part, trace: TraceHeader, shape: [number, number]): Made {
  const [rows, columns] = shape;
  const width = padded.shape[1];
  const [top, left] = trace.drawn;
  const data = new Float32Array(rows * columns * 3);
  for (let j = 0, n = 0; j < rows; j += 1) {
    const first = 3 * ((j + top + 1) * width + left + 1);
    for (let k = 0; k < 3 * columns; k += 1) data[n++] = padded.data[first + k] + trace.middle[k % 3];
  }
  return { data, shape: [rows, columns, 3] };
}

/** Unit normals of the same nodes, by those around them. */
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
  return { data, shape: [rows, columns, 3] };
}

/** The context that paths are traced in. */
interface TraceContext extends ProgramContext {
  readonly programs: Programs;
}

/** Parts by their names, of which some may be missing. */
export type FindPart = (name: string) => Part | undefined;

/** The slices of one time while they are traced, some passes in each frame. */
export class Tracing {
  private readonly graphics: TraceContext;
  private readonly header: Traced;
  private readonly trace: TraceHeader;
  private readonly find: FindPart;
  private readonly textures: WebGLTexture[] = [];
  private readonly frames: WebGLFramebuffer[] = [];
  private readonly passes: Generator<void, Made>;

  constructor(graphics: TraceContext, header: Traced, trace: TraceHeader, find: FindPart, step: number) {
    this.graphics = graphics;
    this.header = header;
    this.trace = trace;
    this.find = find;
    this.passes = this.slices(`flow/${step}`);
  }

  /** Go on until a time; gives the slices when they are whole. */
  advance(until: number): Made | null {
    const programs = [this.program("trace"), this.program("layers")];
    if (!programs.every(({ ready }) => ready)) return null;
    const gl = this.graphics.context;
    try {
      do {
        const { done, value } = this.passes.next();
        // What was read of a card that is lost is nothing.
        if (gl.isContextLost()) return null;
        if (done) return value;
      } while (performance.now() < until);
      return null;
    } finally {
      this.unbind();
    }
  }

  dispose(): void {
    for (const texture of this.textures) this.graphics.free("Texture", texture);
    for (const frame of this.frames) this.graphics.free("Framebuffer", frame);
    this.textures.length = this.frames.length = 0;
  }

  private program(fragment: "trace" | "layers"): Program {
    const { fullVertex = "", [fragment]: text = "" } = this.header.shaders;
    const program = this.graphics.programs.get(fullVertex, text);
    if (program.error) throw new Error(`the tracer cannot be built: ${program.error}`);
    return program;
  }

  private data(name: string): Data {
    const part = this.find(name);
    if (!part) throw new Error(`the part "${name}" of the scene is missing`);
    return part.data;
  }

  private texture(width: number, height: number, inner: number, data: Float32Array | null) {
    const gl = this.graphics.context;
    const texture = this.graphics.counted(gl.createTexture());
    this.textures.push(texture);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, inner, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, gl.RGBA, gl.FLOAT, data);
    return texture;
  }

  private target(width: number, height: number): [WebGLTexture, WebGLFramebuffer] {
    const gl = this.graphics.context;
    const texture = this.texture(width, height, gl.RGBA32UI, null);
    const frame = this.graphics.counted(gl.createFramebuffer());
    this.frames.push(frame);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return [texture, frame];
  }

  private unbind(): void {
    const gl = this.graphics.context;
    for (let n = 0; n < UNITS; n += 1) {
      gl.activeTexture(gl.TEXTURE0 + n);
      gl.bindTexture(gl.TEXTURE_2D, null);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Velocity of the nodes as the shaders ask for it, and the whole speed. */
  private flow(name: string): [Float32Array, Float32Array] {
    const data = this.data(name);
    const unit = this.data("unit");
    const channels = data.length / unit.length;
    const flow = new Float32Array(4 * unit.length);
    const whole = new Float32Array(4 * unit.length);
    for (let n = 0, at = 0; n < unit.length; n += 1, at += channels) {
      const speed = HALVES[data[at + 2]];
      const size = HALVES[unit[n]] * this.trace.unit;
      flow[4 * n] = (HALVES[data[at]] * speed) / size;
      flow[4 * n + 1] = (HALVES[data[at + 1]] * speed) / size;
      flow[4 * n + 2] = speed;
      flow[4 * n + 3] = size;
      whole[4 * n] = HALVES[data[at + channels - 1]];
    }
    return [flow, whole];
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

  /** Make one layer after the other. */
  private *slices(name: string): Generator<void, Made> {
    const { graphics, trace, header } = this;
    const gl = graphics.context;
    const { geometry, slices } = header;
    const [rows, columns] = trace.nodes;
    const [height, width] = [geometry.rows.size, geometry.columns.size];
    const pairs = Math.ceil(width / 2);
    const [flow, whole] = this.flow(name);
    gl.activeTexture(gl.TEXTURE0);
    const inputs = [
      this.texture(columns, rows, gl.RGBA32F, flow),
      this.texture(columns, rows, gl.RGBA32F, this.cells()),
      this.texture(columns + 2, rows + 2, gl.RGBA32F, this.padded()),
      this.texture(columns, rows, gl.RGBA32F, whole),
    ];
    // The first slices are laid out last, as they have the reach.
    const [first, ...paths] = [0, 1, 2, 3].map(() => this.target(columns, rows));
    const [, texels] = this.target(pairs, height);
    const uniforms: Record<string, Uniform> = {
      ...{ u_flow: 0, u_cells: 1, u_padded: 2, u_speed: 3, u_before: 4, u_last: 5, u_earlier: 5 },
      u_nodes: [columns, rows],
      u_closed: [Number(trace.closed[1]), Number(trace.closed[0])],
      u_first: [trace.first[1], trace.first[0]],
      u_offsetJ: trace.offset.slice(0, 3),
      u_offsetI: trace.offset.slice(3, 6),
      u_pace: trace.pace,
      u_unit: slices.unit,
      u_cell: slices.cell / slices.unit,
      u_planar: Number(geometry.planar),
      u_mostReach: 2 * slices.lags[slices.lags.length - 1],
    };
    const draw = (
      frame: WebGLFramebuffer,
      size: [number, number],
      before: WebGLTexture,
      last: WebGLTexture,
      pass: Program,
      values: Record<string, Uniform>,
    ) => {
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.viewport(0, 0, ...size);
      for (const ability of [gl.SCISSOR_TEST, gl.DEPTH_TEST, gl.BLEND, gl.CULL_FACE]) {
        gl.disable(ability);
      }
      [...inputs, before, last].forEach((texture, n) => {
        gl.activeTexture(gl.TEXTURE0 + n);
        gl.bindTexture(gl.TEXTURE_2D, texture);
      });
      gl.bindVertexArray(null);
      graphics.programs.use(pass, { ...uniforms, ...values });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    };
    const data = new Uint16Array(slices.count * height * width * 4);
    const read = new Uint32Array(pairs * height * 4);
    const halves = new Uint16Array(read.buffer);
    const layer = (
      n: number,
      at: WebGLTexture,
      last: WebGLTexture,
      values: Record<string, Uniform>,
    ) => {
      draw(texels, [pairs, height], at, last, this.program("layers"), { u_lag: 1, ...values });
      gl.readPixels(0, 0, pairs, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, read);
      for (let row = 0; row < height; row += 1) {
        const texelsOfRow = halves.subarray(8 * pairs * row, 8 * pairs * row + 4 * width);
        data.set(texelsOfRow, 4 * width * (n * height + row));
      }
    };
    const { lags, sides, count } = slices;
    const [none] = first;
    layer(0, none, none, { u_kind: TANGENTS, u_fourth: UNIT });
    if (count > 1 + sides * lags.length) {
      layer(count - 1, none, none, { u_kind: VELOCITY, u_fourth: SPEED });
    }
    for (let side = 0; side < sides; side += 1) {
      const sign = side ? 1 : -1;
      const start = 1 + side * lags.length;
      const [unused] = paths[0];
      let [last] = first;
      let before = last;
      for (const [m, lag] of lags.entries()) {
        const [at, frame] = m ? paths[m % 3] : first;
        const [from, earlier] = [lags[m - 1] ?? 0, lags[m - 2] ?? 0];
        const steps = { u_lagEarlier: earlier, u_from: from, u_to: lag, u_side: sign };
        const pass = this.program("trace");
        draw(frame, [columns, rows], m ? last : unused, m > 1 ? before : unused, pass, steps);
        const fourth = m === 1 && !side ? SPEED : NOTHING;
        const values = { u_kind: SLOPES, u_fourth: fourth, u_lag: sign * lag };
        if (m) layer(start + m, at, at, values);
        [before, last] = [last, at];
        yield;
      }
      layer(start, none, last, { u_kind: SLOPES, u_fourth: REACH, u_lag: sign * lags[0] });
    }
    return { data, shape: [count, height, width, 4] };
  }
}
