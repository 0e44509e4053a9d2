// The local mean of the texture, which is subtracted before the colour, as shaders/common/even.glsl says.

import type { Graphics } from "./context.ts";
import { SAMPLERS, type Program } from "./programs.ts";
import type { Header } from "./protocol.ts";

/** Squares of pixels, whose means are blurred and interpolated, as flowtex/rendering/even.py has them. */
export interface EvenBlocks {
  /** Of a block, in pixels. */
  side: number;
  /** Lower left pixel of the first one, and column and row that follow the surface. */
  first: [number, number];
  end: [number, number];
  /** Columns and rows of them, and one more on each side. */
  columns: number;
  rows: number;
  /** Of the bell of the blur, in blocks, which goes over so many of them on each side. */
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
  // Means of blocks and linear interpolation have a variance of their own.
  const own = side > 1 ? 0.25 : 0;
  const variance = (deviation / side) ** 2 - own;
  // Blocks stay where they are when the surface moves.
  const [x, y] = [left, low].map((at) => Math.floor(at / side) * side);
  const [columns, rows] = [right - x, high - y].map((pixels) => Math.ceil(pixels / side) + 2);
  const reach = Math.ceil(radii * Math.sqrt(variance));
  return { side, first: [x, y], end: [right, high], columns, rows, variance, reach };
}

interface Means {
  frame: WebGLFramebuffer;
  texture: WebGLTexture;
}

const UNIT = SAMPLERS.indexOf("u_means");

/** Means of the blocks of a picture. */
export class LocalMeans {
  private readonly graphics: Graphics;
  private targets: Means[] = [];
  private columns = 0;
  private rows = 0;

  constructor(graphics: Graphics) {
    this.graphics = graphics;
  }

  /** Draw the means of the texture, which is in its unit, and blur them; they are in their unit from now on. */
  draw(means: Program, blur: Program, blocks: EvenBlocks): void {
    const { graphics } = this;
    const gl = graphics.context;
    const { side, first: u_first, end: u_end, columns, rows, variance, reach } = blocks;
    this.fit(columns, rows);
    gl.bindVertexArray(null);
    gl.viewport(0, 0, columns, rows);
    for (const test of [gl.SCISSOR_TEST, gl.DEPTH_TEST, gl.BLEND]) gl.disable(test);
    const [first, second] = this.targets;
    graphics.programs.use(means, { u_first, u_end, u_side: side });
    this.pass(first);
    const values = { u_blocks: [columns, rows], u_variance: variance, u_reach: reach };
    graphics.programs.use(blur, { ...values, u_along: [1, 0] });
    this.pass(second, first);
    graphics.programs.use(blur, { u_along: [0, 1] });
    this.pass(first, second);
    this.bind(first);
  }

  dispose(): void {
    for (const { frame, texture } of this.targets) {
      this.graphics.free("Framebuffer", frame);
      this.graphics.free("Texture", texture);
    }
    this.targets = [];
    this.columns = this.rows = 0;
  }

  private pass(to: Means, from?: Means): void {
    const gl = this.graphics.context;
    if (from) this.bind(from);
    gl.bindFramebuffer(gl.FRAMEBUFFER, to.frame);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  private bind({ texture }: Means): void {
    const gl = this.graphics.context;
    gl.activeTexture(gl.TEXTURE0 + UNIT);
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
      gl.texStorage2D(gl.TEXTURE_2D, 1, gl.R32F, wide, high);
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
