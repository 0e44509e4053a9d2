// Shader programs: built in the background where the browser can, found by their text, and written to.

import { FIRST_PRICE_MS } from "./quality.ts";
import type { Uniform } from "./uniforms.ts";

/** Before a shader's text, which has neither version nor precisions. */
const PREAMBLE = "#version 300 es\nprecision highp float;\nprecision highp int;\n";
const ATTRIBUTES = [
  "flowtexPosition",
  "flowtexCoordinate",
  "flowtexNormal",
  "flowtexScalar",
  "flowtexCorners",
  "flowtexRadius",
];
/** Samplers, each in the texture unit of its place. */
export const SAMPLERS = [
  ...["u_slices", "u_slicesNext", "u_image", "u_stepImage", "u_cmap", "u_shares", "u_along", "u_nodes"],
  ...["u_corners", "u_open", "u_places", "u_depths", "u_colours", "u_strides"],
  ...["u_below", "u_texture", "u_source", "u_means"],
];

export interface Program {
  program: WebGLProgram;
  shaders: WebGLShader[];
  uniforms: Map<string, { location: WebGLUniformLocation; type: number }>;
  ready: boolean;
  /** What the compiler says against it. */
  error: string;
  /** Whether it has drawn, as the first time is slow by itself. */
  warm: boolean;
  /** Milliseconds for a sample of a pixel. */
  price: number;
}

/** The context that programs are built in, which counts its objects. */
export interface ProgramContext {
  readonly context: WebGL2RenderingContext;
  counted<T>(object: T | null): T;
  free(kind: string, object: object): void;
}

export class Programs {
  private readonly graphics: ProgramContext;
  private readonly entries = new Map<string, Program>();
  private parallel: KHR_parallel_shader_compile | null = null;

  constructor(graphics: ProgramContext) {
    this.graphics = graphics;
  }

  findFeatures(): void {
    this.parallel = this.graphics.context.getExtension("KHR_parallel_shader_compile");
  }

  /** Forget programs that were lost with the context. */
  clear(): void {
    this.entries.clear();
  }

  dispose(): void {
    for (const entry of this.entries.values()) {
      for (const shader of entry.shaders) this.graphics.free("Shader", shader);
      this.graphics.free("Program", entry.program);
    }
    this.clear();
  }

  /** Program of two texts and names that are defined before them, which may not be ready yet. */
  get(vertex: string, fragment: string, ...defines: string[]): Program {
    const key = [vertex, fragment, ...defines].join("\0");
    let entry = this.entries.get(key);
    if (!entry) this.entries.set(key, (entry = this.build(vertex, fragment, defines)));
    if (!entry.ready && !entry.error) this.finish(entry);
    return entry;
  }

  private build(vertex: string, fragment: string, defines: string[]): Program {
    const { graphics } = this;
    const gl = graphics.context;
    const program = graphics.counted(gl.createProgram());
    const kinds = [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER];
    const preamble = PREAMBLE + defines.map((name) => `#define ${name}\n`).join("");
    const shaders = [vertex, fragment].map((source, n) => {
      const shader = graphics.counted(gl.createShader(kinds[n]));
      gl.shaderSource(shader, source.startsWith("#version") ? source : preamble + source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      return shader;
    });
    ATTRIBUTES.forEach((name, n) => gl.bindAttribLocation(program, n, name));
    gl.linkProgram(program);
    const state = { ready: false, error: "", warm: false, price: FIRST_PRICE_MS };
    return { program, shaders, uniforms: new Map(), ...state };
  }

  private finish(entry: Program): void {
    const gl = this.graphics.context;
    const { program } = entry;
    const done = this.parallel?.COMPLETION_STATUS_KHR;
    if (done && !gl.getProgramParameter(program, done)) return;
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      if (gl.isContextLost()) return;
      const logs = entry.shaders.map((shader) => gl.getShaderInfoLog(shader));
      const log = [...logs, gl.getProgramInfoLog(program)].filter(Boolean).join("\n");
      entry.error = log || "the driver gave no reason";
      return;
    }
    for (const shader of entry.shaders) this.graphics.free("Shader", shader);
    entry.shaders = [];
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) as number;
    for (let n = 0; n < count; n += 1) {
      const info = gl.getActiveUniform(program, n);
      const location = info && gl.getUniformLocation(program, info.name);
      if (!info || !location) continue;
      entry.uniforms.set(info.name.replace(/\[0\]$/, ""), { location, type: info.type });
    }
    gl.useProgram(program);
    SAMPLERS.forEach((name, n) => {
      const sampler = entry.uniforms.get(name);
      // Some programs have vectors of these names, as u_nodes of traces and u_along of means.
      const isVector = sampler?.type === gl.FLOAT_VEC2 || sampler?.type === gl.INT_VEC2;
      if (sampler && !isVector) gl.uniform1i(sampler.location, n);
    });
    entry.ready = true;
  }

  /** Use a program with these uniforms; what it does not have is left out. */
  use(entry: Program, values: Record<string, Uniform>): void {
    const gl = this.graphics.context;
    gl.useProgram(entry.program);
    for (const [name, value] of Object.entries(values)) {
      const uniform = entry.uniforms.get(name);
      if (!uniform) continue;
      const { location, type } = uniform;
      const numbers = (typeof value === "object" ? value : [Number(value)]) as Float32List;
      if (type === gl.FLOAT) gl.uniform1fv(location, numbers);
      else if (type === gl.FLOAT_VEC2) gl.uniform2fv(location, numbers);
      else if (type === gl.FLOAT_VEC3) gl.uniform3fv(location, numbers);
      else if (type === gl.FLOAT_VEC4) gl.uniform4fv(location, numbers);
      else if (type === gl.FLOAT_MAT4) gl.uniformMatrix4fv(location, false, numbers);
      else if (type === gl.INT_VEC2) gl.uniform2iv(location, numbers as Int32List);
      else gl.uniform1i(location, numbers[0]);
    }
  }
}
