// The local mean of the texture, which is subtracted before the colour, as shaders/common/even.glsl says.

import type { Graphics } from "./context.ts";
import { SAMPLERS, type Program } from "./programs.ts";
import type { Header } from "./protocol.ts";

/** Squares of pixels, around whose middles means are taken and interpolated, as in flowtex/rendering/even.py. */
export interface EvenBlocks {
  /** Of a block, in pixels. */
  side: number;
  /** Lower left pixel of the first one, and column and row that follow the surface. */
  first: [number, number];
  end: [number, number];
  /** Columns and rows of them, and one more on each side. */
  columns: number;
  rows: number;
  /** Of the bell of the means, which goes over so many pixels on each side. */
  variance: number;
  reach: number;
}

/** The blocks for a grain in pixels, by first column and row, and those that follow. */
export function evenBlocks(
  { sigma, radii }: Header["constants"]["even"],
  grain: number,
  [left, low, right, high]: readonly number[],
): EvenBlocks {
  const deviation = sigma * grain;
  const side = 2 ** Math.max(Math.floor(Math.log2(Math.SQRT2 * deviation)), 0);
  // Linear interpolation has a variance of its own.
  const own = side > 1 ? side ** 2 / 6 + 1 / 12 : 0;
  const variance = deviation ** 2 - own;
  // Blocks stay where they are when the surface moves.
  const [x, y] = [left, low].map((at) => Math.floor(at / side) * side);
  const [columns, rows] = [right - x, high - y].map((pixels) => Math.ceil(pixels / side) + 2);
  const reach = radii * Math.sqrt(variance);
  return { side, first: [x, y], end: [right, high], columns, rows, variance, reach };
}

interface Means {
  frame: WebGLFramebuffer;
  texture: WebGLTexture;
}

/** Means of the blocks of a picture. */
export class LocalMeans {
  private readonly graphics: Graphics;
  private targets: Means[] = [];
  private columns = 0;
  private rows = 0;

  constructor(graphics: Graphics) {
    this.graphics = graphics;
  }

  /** Draw the means along the rows of a texture, and of these along the columns; they are in their unit then. */
  draw(blur: Program, blocks: EvenBlocks, texture: WebGLTexture | null): void {
    const { graphics } = this;
    const gl = graphics.context;
    const { side, first, end, columns, rows, variance, reach } = blocks;
    const [across, upward] = [end[0] - first[0], end[1] - first[1]];
    this.fit(columns, Math.max(upward, rows));
    gl.bindVertexArray(null);
    for (const test of [gl.SCISSOR_TEST, gl.DEPTH_TEST, gl.BLEND]) gl.disable(test);
    const [byRow, means] = this.targets;
    const values = { u_side: side, u_variance: variance, u_reach: reach };
    graphics.programs.use(blur, { ...values, u_from: first, u_along: [1, 0], u_count: across });
    this.pass(byRow, columns, upward, texture);
    graphics.programs.use(blur, { u_from: [0, 0], u_along: [0, 1], u_count: upward });
    this.pass(means, columns, rows, byRow.texture);
    this.bind("u_means", means.texture);
  }

  dispose(): void {
    for (const { frame, texture } of this.targets) {
      this.graphics.free("Framebuffer", frame);
      this.graphics.free("Texture", texture);
    }
    this.targets = [];
    this.columns = this.rows = 0;
  }

  private pass({ frame }: Means, width: number, height: number, source: WebGLTexture | null): void {
    const gl = this.graphics.context;
    this.bind("u_source", source);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport(0, 0, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  private bind(name: string, texture: WebGLTexture | null): void {
    const gl = this.graphics.context;
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.indexOf(name));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.length);
  }

  /** Have textures of at least a size. */
  private fit(columns: number, rows: number): void {
    if (this.columns >= columns && this.rows >= rows) return;
    const [wide, high] = [Math.max(columns, this.columns), Math.max(rows, this.rows)];
    this.dispose();
    const { graphics } = this;
    const gl = graphics.context;
    this.targets = [0, 1].map(() => {
      const texture = graphics.counted(gl.createTexture());
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.R16F, wide, high);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      const frame = graphics.counted(gl.createFramebuffer());
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
      return { frame, texture };
    });
    [this.columns, this.rows] = [wide, high];
  }
}
