// The one WebGL2 context of a page, and what its viewers share: browsers allow some sixteen contexts,
// and a notebook has more pictures than that.

import type { Part } from "./protocol.ts";
import { Programs } from "./programs.ts";
import type { Tracing } from "./tracer.ts";

const OUTLINE_SAMPLES = 4;
/** Milliseconds that all viewers may draw in one frame of the page. */
export const FRAME_MS = 45;
/** Pixels of whole numbers that can be drawn: texels around a place, and layers of slices. */
const MOST_NUMBERS: [number, number] = [4, 68];
/** Key of what all copies of this module on a page share. */
const SHARED = Symbol.for("flowtex.gl/3");

/** An object of the graphics card, and by what it is known to other views. */
export interface Resource {
  kind: string;
  object: object;
  count: number;
  key: string;
  users: number;
}

interface Target {
  frame: WebGLFramebuffer;
  buffers: WebGLRenderbuffer[];
}

/** Who draws with the context. */
export interface User {
  frame(now: number, until: number): void;
  lost(): void;
  /** The picture is not up to date any more. */
  change(): void;
}

/** Enable drawing into half-precision textures, which also makes their mip levels; return whether it is supported. */
export function drawsFloats(gl: WebGL2RenderingContext): boolean {
  return ["EXT_color_buffer_float", "EXT_color_buffer_half_float"].some((name) => gl.getExtension(name) !== null);
}

export class Graphics {
  readonly canvas = document.createElement("canvas");
  readonly gl: WebGL2RenderingContext | null;
  readonly programs: Programs;
  readonly users = new Set<User>();
  readonly waiting = new Set<User>();
  /** What views of the same scene have in common: objects by what they were made of, and arrays. */
  readonly common = new Map<string, Resource>();
  readonly stock = new Map<string, { part: Part; users: number }>();
  /** Slices that are being traced, by their digests. */
  readonly tracings = new Map<string, Tracing>();
  objects = 0;
  isLost = false;
  private scheduled = 0;
  private picker: Target | null = null;
  private smooth: (Target & { width: number; height: number }) | null = null;

  constructor() {
    this.canvas.width = this.canvas.height = 16;
    const gl = this.canvas.getContext("webgl2", {
      // Multisampled pictures are copied in, which takes the same format on both sides.
      alpha: true,
      antialias: false,
      powerPreference: "high-performance",
    });
    this.gl = gl && drawsFloats(gl) ? gl : null;
    this.programs = new Programs(this);
    if (this.gl) this.programs.findFeatures();
    this.canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.isLost = true;
      this.objects = 0;
      this.programs.clear();
      this.common.clear();
      this.tracings.clear();
      this.picker = this.smooth = null;
      for (const user of this.users) user.lost();
    });
    this.canvas.addEventListener("webglcontextrestored", () => {
      this.isLost = false;
      if (this.gl && drawsFloats(this.gl)) this.programs.findFeatures();
      for (const user of this.users) user.change();
    });
  }

  get context(): WebGL2RenderingContext {
    if (!this.gl) throw new Error("WebGL2 is not available");
    return this.gl;
  }

  leave(user: User): void {
    this.users.delete(user);
    this.waiting.delete(user);
    if (this.users.size) return;
    cancelAnimationFrame(this.scheduled);
    this.scheduled = 0;
    this.programs.dispose();
    for (const target of [this.picker, this.smooth]) if (target) this.freeTarget(target);
    this.picker = this.smooth = null;
    this.canvas.width = this.canvas.height = 16;
  }

  /** Call `user.frame` when its turn comes. */
  request(user: User): void {
    this.waiting.add(user);
    this.scheduled ||= requestAnimationFrame((now) => this.run(now));
  }

  private run(now: number): void {
    this.scheduled = 0;
    const until = performance.now() + FRAME_MS;
    // Those that ask again go to the end of the line.
    for (const user of [...this.waiting]) {
      this.waiting.delete(user);
      user.frame(now, until);
      if (performance.now() > until) break;
    }
    if (this.waiting.size) this.scheduled ||= requestAnimationFrame((then) => this.run(then));
  }

  /** Count an object that was made. */
  counted<T>(object: T | null): T {
    if (object === null) {
      throw new Error("the graphics card has no memory left, or the context is lost");
    }
    this.objects += 1;
    return object;
  }

  free(kind: string, object: object | null): void {
    if (object === null || this.isLost || !this.gl) return;
    this.objects -= 1;
    const gl = this.gl as unknown as Record<string, (object: object) => void>;
    gl[`delete${kind}`](object);
  }

  /** Hold an array for one more view; where it is there already that one is returned. */
  hold(part: Part): Part {
    if (!part.digest) return part;
    const entry = this.stock.get(part.digest) ?? { part, users: 0 };
    this.stock.set(part.digest, { ...entry, users: entry.users + 1 });
    return entry.part;
  }

  release(part: Part | undefined): void {
    const entry = part && this.stock.get(part.digest);
    if (!part || !entry) return;
    entry.users -= 1;
    if (!entry.users) this.stock.delete(part.digest);
  }

  private target(format: number, width: number, height: number, samples: number): Target {
    const gl = this.context;
    const frame = this.counted(gl.createFramebuffer());
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    const kinds = [[format, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]];
    const buffers = kinds.map(([kind, attachment]) => {
      const buffer = this.counted(gl.createRenderbuffer());
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, samples, kind, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, attachment, gl.RENDERBUFFER, buffer);
      return buffer;
    });
    return { frame, buffers };
  }

  private freeTarget(target: Target): void {
    this.free("Framebuffer", target.frame);
    for (const buffer of target.buffers) this.free("Renderbuffer", buffer);
  }

  /** Draw from now on with smooth outlines, into rows that `copySmooth` takes over. */
  bindSmooth(width: number, rows: number): void {
    const gl = this.context;
    const old = this.smooth;
    if (!old || old.width < width || old.height < rows) {
      const [w, h] = [Math.max(width, old?.width ?? 0), Math.max(rows, old?.height ?? 0)];
      if (old) this.freeTarget(old);
      const target = this.target(gl.RGBA8, w, h, OUTLINE_SAMPLES);
      this.smooth = { ...target, width: w, height: h };
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.smooth?.frame ?? null);
  }

  /** Put what was drawn into the lowest rows of the canvas: samples stay in place. */
  copySmooth(width: number, rows: number): void {
    const gl = this.context;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.smooth?.frame ?? null);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(0, 0, width, rows, 0, 0, width, rows, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Draw into a few pixels of whole numbers, and read them. */
  numbers(draw: () => void, width = 1, height = 1): Uint32Array<ArrayBuffer> {
    const gl = this.context;
    this.picker ??= this.target(gl.RGBA32UI, ...MOST_NUMBERS, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.picker.frame);
    gl.viewport(0, 0, width, height);
    gl.disable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    draw();
    const bits = new Uint32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return bits;
  }
}

export function sharedGraphics(): Graphics {
  const page = globalThis as unknown as Record<symbol, Graphics>;
  return (page[SHARED] ??= new Graphics());
}
