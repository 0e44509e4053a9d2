// Arrows that follow the flow, over the surface of one scene: an instance for each seed.

import { ArrowSeeds, type Seed, type View } from "./arrowseeds.ts";
import type { Graphics } from "./context.ts";
import { coordinates } from "./mesh.ts";
import type { Header, Part, Settings } from "./protocol.ts";
import type { Program } from "./programs.ts";
import { arrowDistance, hasArrows, type Uniform } from "./uniforms.ts";
import { subtract, type Vector } from "./vectors.ts";

/** Numbers of a seed by the place of their attribute: position, coordinate, normal, corners and radius. */
const SIZES: [attribute: number, size: number][] = [
  [0, 3],
  [1, 2],
  [2, 3],
  [5, 3],
  [6, 1],
];
const FLOAT_BYTES = 4;
const STRIDE = SIZES.reduce((sum, [, size]) => sum + size, 0);

export class Arrows {
  private readonly graphics: Graphics;
  private readonly header: Header;
  private readonly parts: ReadonlyMap<string, Part>;
  private seeds: ArrowSeeds | null = null;
  private array: WebGLVertexArrayObject | null = null;
  private buffer: WebGLBuffer | null = null;
  private drawn: { seeds: Seed[]; anchor: Vector } | null = null;

  constructor(graphics: Graphics, header: Header, parts: ReadonlyMap<string, Part>) {
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
  }

  /** The program, which may not be ready yet; null where no arrows are drawn. */
  program(settings: Settings, isClose: boolean): Program | null {
    const { shaders, geometry } = this.header;
    if (!hasArrows(this.header, settings)) return null;
    // In triangles the shader needs what only fragments have, to follow the velocity in a cell.
    const variant = isClose && !geometry.triangles ? ["FLOWTEX_CELLS"] : [];
    return this.graphics.programs.get(shaders.arrowVertex, shaders.arrowFragment, ...variant);
  }

  /** Draw above the surface, whose slices lie in their units. */
  draw(program: Program, view: View, anchor: Vector, settings: Settings, values: Record<string, Uniform>): void {
    const { graphics } = this;
    const gl = graphics.context;
    this.seeds ??= new ArrowSeeds(this.surface(), this.header.constants.arrows);
    const seeds = this.seeds.seen(view, arrowDistance(this.header, settings));
    this.array ??= this.make();
    gl.bindVertexArray(this.array);
    if (this.drawn?.seeds !== seeds || String(this.drawn.anchor) !== String(anchor)) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.numbers(seeds, anchor) as AllowSharedBufferSource, gl.DYNAMIC_DRAW);
      this.drawn = { seeds, anchor };
    }
    graphics.programs.use(program, values);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
    gl.depthMask(false);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * (this.header.constants.arrows.pieces + 1), seeds.length);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  /** Drop what was made of the surface, which has changed. */
  forget(): void {
    this.seeds = this.drawn = null;
  }

  dispose(): void {
    this.graphics.free("Buffer", this.buffer);
    this.graphics.free("VertexArray", this.array);
    this.array = this.buffer = this.seeds = this.drawn = null;
  }

  private make(): WebGLVertexArrayObject {
    const gl = this.graphics.context;
    const array = this.graphics.counted(gl.createVertexArray());
    this.buffer = this.graphics.counted(gl.createBuffer());
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    let offset = 0;
    for (const [attribute, size] of SIZES) {
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, size, gl.FLOAT, false, STRIDE * FLOAT_BYTES, offset);
      gl.vertexAttribDivisor(attribute, 1);
      offset += size * FLOAT_BYTES;
    }
    return array;
  }

  private numbers(seeds: Seed[], anchor: Vector): Float32Array {
    const { geometry } = this.header;
    const { seeds: made } = this;
    const triangles = this.parts.get("triangles")?.data;
    const places = geometry.triangles ? null : coordinates(geometry);
    return Float32Array.from(
      seeds.flatMap((seed) => {
        const [i, j] = seed.place;
        const first = 3 * seed.cell;
        return [
          ...subtract(seed.position, anchor),
          ...((places && made?.between(places, seed, 2)) ?? [i * (1 - j), j]),
          ...(made?.normal(seed) ?? [0, 0, 1]),
          ...(triangles && geometry.triangles ? triangles.slice(first, first + 3) : [0, 0, 0]),
          seed.radius,
        ];
      }),
    );
  }

  private surface() {
    const { geometry } = this.header;
    const nodes = this.parts.get("position")?.data ?? new Float32Array();
    return { geometry, nodes, corners: this.corners() };
  }

  /** Nodes at the corners of the cells that are drawn, at (0, 0), (1, 0), (0, 1) and (1, 1) of each. */
  private corners(): Uint32Array {
    const { geometry } = this.header;
    const [rows, columns] = geometry.shape;
    const result: number[] = [];
    if (geometry.triangles) {
      const nodes = this.parts.get("triangles")?.data ?? [];
      for (let n = 0; n < nodes.length; n += 3) result.push(nodes[n], nodes[n + 1], nodes[n + 2], nodes[n + 2]);
      return Uint32Array.from(result);
    }
    const cells = this.parts.get("cells")?.data;
    for (let n = 0; n < (rows - 1) * (columns - 1); n += 1) {
      if (cells && !cells[n]) continue;
      const low = n + Math.floor(n / (columns - 1));
      result.push(low, low + 1, low + columns, low + columns + 1);
    }
    return Uint32Array.from(result);
  }
}
