// Where on the surface each pixel of a view lies, and the colours there.
//
//   layers --triangles, once for a view--> places, depths --pixels, strip by strip--> sums --at once--> colours
//
// Drafts, strips, outlines and the pointer read the places.

import { projection, type Camera } from "./camera.ts";
import type { Graphics } from "./context.ts";
import { evenBlocks, LocalMeans } from "./even.ts";
import { seenBlocks, type Covered, type Seen } from "./meshlevels.ts";
import { SAMPLERS, type Program } from "./programs.ts";
import type { Scene } from "./scene.ts";
import type { TileKey } from "./tilechoice.ts";
import type { Uniform } from "./uniforms.ts";
import { clamp, type Vector } from "./vectors.ts";

/** A part of the surface that is drawn: the whole, the root, or a tile, without what finer tiles cover. */
export interface Layer {
  scene: Scene;
  key: TileKey;
  covered: readonly Covered[];
}

/** A view of some layers in a picture of so many pixels. */
export interface PlaceView {
  layers: readonly Layer[];
  camera: Camera;
  anchor: Vector;
  width: number;
  height: number;
}

/** What lies at a pixel. */
export interface PlaceAt {
  layer: Layer;
  coordinate: [u: number, v: number];
  triangle: number;
}

type Uniforms = Record<string, Uniform>;

interface Target {
  /** Of the places, of the sums, and of the colours. */
  frames: WebGLFramebuffer[];
  /** In the order of `UNITS`. */
  textures: WebGLTexture[];
  width: number;
  height: number;
}

/** Squares along a side of the surface at most, by which vertices look up how others are drawn. */
const MOST_SQUARES = 1024;
const UNITS = ["u_places", "u_depths", "u_colours", "u_strides", "u_below", "u_texture"].map((name) => SAMPLERS.indexOf(name));

export class Places {
  /** Size of the picture whose places are there. */
  width = 0;
  height = 0;
  private readonly graphics: Graphics;
  private readonly means: LocalMeans;
  private target: Target | null = null;
  private key = "";
  private layers: readonly Layer[] = [];
  private seen: Seen[] = [];
  /** Doublings from one of the finest blocks to a square. */
  private squares = 0;

  constructor(graphics: Graphics) {
    this.graphics = graphics;
    this.means = new LocalMeans(graphics);
  }

  /** Draw the places of a view, unless they are there. */
  draw({ layers, camera, anchor, width, height }: PlaceView): void {
    const drawn = layers.map(({ scene, covered }) => [scene.number, scene.version, covered]);
    const key = JSON.stringify([drawn, camera.state, camera.aspect, anchor, width, height]);
    if (key === this.key) return;
    Object.assign(this, { key, layers, width, height });
    const gl = this.graphics.context;
    const { frames } = this.make(width, height);
    const [{ scene: root }] = layers;
    // The corner of a fine block must be a corner of coarse triangles beside it.
    const most = Math.min(...layers.map(({ key: [step] }) => step)) + Math.log2(root.header.mesh.tileCells);
    this.seen = layers.map(({ scene, covered, key: [step] }) => {
      const doublings = scene.doublings.map((own) => Math.max(Math.min(own, most - step), 0));
      return seenBlocks(scene.blocks, camera, height, covered, doublings);
    });
    this.sendStrides();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frames[0]);
    gl.viewport(0, 0, width, height);
    gl.disable(gl.SCISSOR_TEST);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
    gl.clearBufferuiv(gl.COLOR, 0, [0, 0, 0, 0]);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    const matrix = projection(root.header.geometry, camera, anchor);
    root.bodies.hide(matrix, anchor);
    root.bodies.seeThrough(() => this.triangles(root.programs("place"), matrix, anchor), false);
  }

  /** Draw the triangles of all layers by a program. */
  triangles(program: Program, matrix: number[], anchor: Vector, values: Uniforms = {}): void {
    const { graphics, layers, seen } = this;
    const gl = graphics.context;
    const { mesh, pyramid, geometry } = layers[0].scene.header;
    const [rows, columns] = pyramid?.shapes[0] ?? geometry.shape;
    this.bind();
    gl.bindVertexArray(null);
    layers.forEach(({ scene, key: [step, ...tile] }, n) => {
      const { levels } = seen[n];
      const { columns: u, rows: v, shape, triangles } = scene.header.geometry;
      const [top, left] = tile.map((at) => at * mesh.tileCells * (pyramid?.tileBlocks ?? 0) * 2 ** step);
      scene.bindNodes(anchor);
      graphics.programs.use(program, {
        ...values,
        u_matrix: matrix,
        u_layer: n + 1,
        u_blocks: levels.reduce((bits, level, block) => bits | (level < 0 ? 0 : 1 << block), 0),
        u_part: [left, top, step],
        u_lastNode: [columns - 1, rows - 1, this.squares],
        u_closed: [Number(geometry.periodic[1]), Number(geometry.periodic[0])],
        u_blockCells: mesh.tileCells,
        u_slicesSize: [u.size, v.size],
        u_padding: [u.before, v.before],
      });
      if (triangles) gl.drawArrays(gl.TRIANGLES, 0, scene.part("triangles").data.length);
      const across = scene.blocks.shape[1];
      levels.forEach((level, block) => {
        if (level < 0 || triangles) return;
        const first = [block % across, Math.floor(block / across)].map((at) => at * mesh.tileCells);
        const [x, y] = first.map((at, k) => Math.ceil(Math.min(mesh.tileCells, shape[1 - k] - 1 - at) / 2 ** level));
        graphics.programs.use(program, { u_block: [...first, level, x] });
        gl.drawArrays(gl.TRIANGLES, 0, 6 * x * y);
      });
    });
  }

  /** Have sums of some rows of the picture, from the top, computed by a program. */
  sum(program: Program, top: number, rows: number, valuesOf: (scene: Scene) => Uniforms): void {
    const { graphics, width, height, target } = this;
    const gl = graphics.context;
    const bottom = height - top - rows;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.frames[1] ?? null);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, bottom, width, rows);
    gl.clearBufferfv(gl.COLOR, 1, [0, 0, 0, 0]);
    this.pixels(program, bottom, rows, valuesOf);
    // Reading a pixel waits until everything is drawn.
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** Have colours computed from the sums, less their local means for a grain in pixels. */
  colour(grain: number | null, valuesOf: (scene: Scene) => Uniforms): void {
    const { graphics, layers, means, height, target } = this;
    const gl = graphics.context;
    const [{ scene: root }] = layers;
    this.bind();
    const blocks = grain === null ? null : evenBlocks(root.header.constants.even, grain, this.box);
    if (blocks) means.draw(root.programs("blur"), blocks, target?.textures[5] ?? null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.frames[2] ?? null);
    const own = { u_first: blocks?.first ?? [0, 0], u_side: blocks?.side ?? 1 };
    this.pixels(root.programs("colour"), 0, height, (scene) => ({ ...valuesOf(scene), ...own }));
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /** First column and row of what is seen of a layer, and those that follow. */
  private boxOf({ box }: Seen): number[] {
    const { width, height } = this;
    const [left, low, right, high] = box.map((at, side) => (0.5 + 0.5 * at) * (side % 2 ? height : width));
    const first = [left, low].map((at) => Math.max(Math.floor(at), 0));
    return [...first, Math.min(Math.ceil(right), width), Math.min(Math.ceil(high), height)];
  }

  /** The same of all layers. */
  private get box(): number[] {
    const boxes = this.seen.map((seen) => this.boxOf(seen)).filter(([x, y, right, high]) => x < right && y < high);
    if (!boxes.length) return [0, 0, 1, 1];
    return [0, 1, 2, 3].map((side) => {
      const ends = boxes.map((box) => box[side]);
      return side < 2 ? Math.min(...ends) : Math.max(...ends);
    });
  }

  /** Draw the pixels of all layers in some rows by a program. */
  private pixels(program: Program, bottom: number, rows: number, valuesOf: (scene: Scene) => Uniforms): void {
    const { graphics, width, height } = this;
    const gl = graphics.context;
    gl.viewport(0, 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
    this.layers.forEach(({ scene }, n) => {
      const [left, low, right, high] = this.boxOf(this.seen[n]);
      const [x, y] = [left, Math.max(low, bottom)];
      const [w, h] = [right - x, Math.min(high, bottom + rows) - y];
      if (w <= 0 || h <= 0) return;
      gl.scissor(x, y, w, h);
      const values = valuesOf(scene);
      this.bind();
      graphics.programs.use(program, { ...values, u_layer: n + 1 });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    });
  }

  /** Draw the surface with its colours and depths, without smooth outlines. */
  show(program: Program): void {
    const gl = this.graphics.context;
    this.bind();
    gl.bindVertexArray(null);
    this.graphics.programs.use(program, { u_bottom: 0 });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  /** Return the place drawn at (x, y), from -1 to 1, right and up, or in the pixel beside it; null off the surface. */
  at(x: number, y: number): PlaceAt | null {
    const { graphics, target, layers } = this;
    const gl = graphics.context;
    const [column, row] = [(0.5 + 0.5 * x) * this.width, (0.5 + 0.5 * y) * this.height];
    const left = clamp(Math.floor(column - 0.5), 0, this.width - 2);
    const low = clamp(Math.floor(row - 0.5), 0, this.height - 2);
    const bits = new Uint32Array(16);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target?.frames[0] ?? null);
    gl.readPixels(left, low, 2, 2, gl.RGBA_INTEGER, gl.UNSIGNED_INT, bits);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    const own = Number(column >= left + 1) + 2 * Number(row >= low + 1);
    const at = 4 * ([own, own ^ 1, own ^ 2, own ^ 3].find((n) => bits[4 * n + 3]) ?? own);
    const [u, v] = new Float32Array(bits.buffer, 4 * at, 2);
    return bits[at + 3] ? { layer: layers[bits[at + 3] - 1], coordinate: [u, v], triangle: bits[at + 2] } : null;
  }

  dispose(): void {
    const { graphics, target } = this;
    for (const texture of target?.textures ?? []) graphics.free("Texture", texture);
    for (const frame of target?.frames ?? []) graphics.free("Framebuffer", frame);
    this.means.dispose();
    this.target = null;
    this.key = "";
  }

  /** Tell vertices in which doublings each of the finest blocks is drawn, or a square of them. */
  private sendStrides(): void {
    const { layers, seen, target } = this;
    const gl = this.graphics.context;
    const [{ scene: root }] = layers;
    const { pyramid, geometry } = root.header;
    const finest = geometry.triangles ? [1, 1] : (pyramid?.blocks[0] ?? root.blocks.shape);
    this.squares = Math.max(Math.ceil(Math.log2(Math.max(...finest) / MOST_SQUARES)), 0);
    const scale = 2 ** -this.squares;
    const [rows, columns] = finest.map((n) => Math.ceil(n * scale));
    const strides = new Uint8Array(rows * columns);
    layers.forEach(({ scene, key: [step, ...tile] }, n) => {
      const across = scene.blocks.shape[1];
      const size = 2 ** step * scale;
      seen[n].levels.forEach((level, block) => {
        if (level < 0 || geometry.triangles) return;
        const [[top, bottom], [left, right]] = [Math.floor(block / across), block % across].map((at, k) => {
          const first = (at + tile[k] * (pyramid?.tileBlocks ?? 0)) * size;
          return [Math.floor(first), Math.min(Math.ceil(first + size), [rows, columns][k])];
        });
        for (let j = top; j < bottom; j += 1) {
          for (let i = left + j * columns; i < right + j * columns; i += 1) strides[i] = Math.max(strides[i], step + level);
        }
      });
    });
    gl.activeTexture(gl.TEXTURE0 + UNITS[3]);
    gl.bindTexture(gl.TEXTURE_2D, target?.textures[3] ?? null);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8UI, columns, rows, 0, gl.RED_INTEGER, gl.UNSIGNED_BYTE, strides);
  }

  /** Have textures of at least a size. */
  private make(width: number, height: number): Target {
    const { target, graphics } = this;
    if (target && target.width >= width && target.height >= height) return target;
    const gl = graphics.context;
    const { key } = this;
    const size = { width: Math.max(width, target?.width ?? 0), height: Math.max(height, target?.height ?? 0) };
    this.dispose();
    const textures = [gl.RGBA32UI, gl.DEPTH_COMPONENT24, gl.RGBA8, 0, gl.RGBA8, gl.RGBA16F].map((format) => {
      const texture = graphics.counted(gl.createTexture());
      gl.bindTexture(gl.TEXTURE_2D, texture);
      if (format) gl.texStorage2D(gl.TEXTURE_2D, 1, format, size.width, size.height);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      return texture;
    });
    const [first, second] = [gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1];
    const [places, depths, colours, , below, sums] = textures;
    const frames = [
      [[first, places], [gl.DEPTH_ATTACHMENT, depths]] as const,
      [[first, below], [second, sums]] as const,
      [[first, colours]] as const,
    ].map((attached) => {
      const frame = graphics.counted(gl.createFramebuffer());
      gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
      for (const [point, texture] of attached) {
        gl.framebufferTexture2D(gl.FRAMEBUFFER, point, gl.TEXTURE_2D, texture, 0);
      }
      gl.drawBuffers(attached.map(([point]) => point).filter((point) => point !== gl.DEPTH_ATTACHMENT));
      return frame;
    });
    this.key = key;
    return (this.target = { frames, textures, ...size });
  }

  /** Have the textures in their units. */
  private bind(): void {
    const gl = this.graphics.context;
    UNITS.forEach((unit, n) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.target?.textures[n] ?? null);
    });
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.length);
  }
}
