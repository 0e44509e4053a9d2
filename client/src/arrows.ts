// Arrows that follow the flow, over the surface of one scene: an instance for each seed. Those of a large
// surface have the seeds of its root, and where a tile is drawn its paths.

import { ArrowSeeds, between, type Pair, type Seed, type SeededSurface, type View } from "./arrowseeds.ts";
import type { Graphics } from "./context.ts";
import { coordinates, shares } from "./mesh.ts";
import type { Data, Header, Part, Settings } from "./protocol.ts";
import type { Program } from "./programs.ts";
import { fullIndex, levelIndex, type TileKey } from "./tilechoice.ts";
import { arrowDistance, hasArrows, type Uniform } from "./uniforms.ts";
import { add, cross, subtract, unit, type Vector } from "./vectors.ts";

/** Numbers of a seed by the place of their attribute: position, coordinate, normal, scalar, corners and radius. */
const SIZES: [attribute: number, size: number][] = [[0, 3], [1, 2], [2, 3], [3, 2], [4, 3], [5, 1]];
const FLOAT_BYTES = 4;
const STRIDE = SIZES.reduce((sum, [, size]) => sum + size, 0);

/** What is drawn of a surface: all of it, or a tile. */
export interface Layer {
  readonly header: Header;
  readonly parts: ReadonlyMap<string, Part>;
  readonly tile: TileKey | null;
}

/** A seed between four nodes of a layer. */
interface Placed {
  corners: ArrayLike<number>;
  place: Pair;
  radius: number;
  /** Where the values of its cell are: the first node, or the triangle. */
  cell: number;
}

const isEqual = (a: readonly unknown[], b: readonly unknown[]) =>
  a.length === b.length && a.every((each, n) => each === b[n]);
const levelOf = ({ tile }: Layer) => tile?.[0] ?? Infinity;

export class Arrows {
  private readonly graphics: Graphics;
  private readonly header: Header;
  private readonly parts: ReadonlyMap<string, Part>;
  private seeds: ArrowSeeds | null = null;
  private array: WebGLVertexArrayObject | null = null;
  private buffer: WebGLBuffer | null = null;
  private known: SeededSurface | null = null;
  /** Seeds as they were shared last, and as they lie in the buffer. */
  private last: { seeds: Seed[]; layers: readonly Layer[]; shared: Map<Layer, Placed[]> } | null = null;
  private drawn: { placed: Placed[]; key: string } | null = null;

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

  /** Seeds of a view, and which of the layers draws each: the finest that is there. */
  share<L extends Layer>(view: View, settings: Settings, layers: readonly L[]): Map<L, Placed[]> {
    const { header, last } = this;
    this.seeds ??= new ArrowSeeds(this.surface, header.constants.arrows);
    const seeds = this.seeds.seen(view, arrowDistance(header, settings));
    if (last?.seeds === seeds && isEqual(layers, last.layers)) return last.shared as Map<L, Placed[]>;
    const { corners } = this.surface;
    const whole = seeds.map(({ cell, place, radius }): Placed => {
      const around = corners.subarray(4 * cell, 4 * cell + 4);
      return { corners: around, place, radius, cell: header.geometry.triangles ? cell : around[0] };
    });
    const shared = new Map<L, Placed[]>(layers.map((layer) => [layer, []]));
    const finest = [...layers].sort((a, b) => levelOf(a) - levelOf(b));
    for (const seed of whole) {
      for (const layer of finest) {
        const placed = layer.tile ? this.inTile(seed, layer, layer.tile) : seed;
        if (!placed) continue;
        shared.get(layer)?.push(placed);
        break;
      }
    }
    this.last = { seeds, layers, shared };
    return shared;
  }

  /** Draw some above the surface, whose slices lie in their units, with the values of these parts. */
  draw(program: Program, placed: Placed[], painted: string[], anchor: Vector, values: Record<string, Uniform>): void {
    const { graphics } = this;
    const gl = graphics.context;
    this.array ??= this.make();
    gl.bindVertexArray(this.array);
    const { name, low, high, log } = this.header.scalars;
    const digests = painted.map((part) => this.parts.get(part)?.digest);
    const key = JSON.stringify([anchor, painted, digests, name, low, high, log]);
    if (this.drawn?.placed !== placed || this.drawn.key !== key) {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
      gl.bufferData(gl.ARRAY_BUFFER, this.numbers(placed, painted, anchor) as AllowSharedBufferSource, gl.DYNAMIC_DRAW);
      this.drawn = { placed, key };
    }
    graphics.programs.use(program, values);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
    gl.depthMask(false);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * (this.header.constants.arrows.pieces + 1), placed.length);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }

  /** Drop what was made of the surface, which has changed. */
  forget(): void {
    this.known = this.seeds = this.last = this.drawn = null;
  }

  dispose(): void {
    this.graphics.free("Buffer", this.buffer);
    this.graphics.free("VertexArray", this.array);
    this.array = this.buffer = null;
    this.forget();
  }

  /** A seed of the root of a grid in a tile; null where it is not there. */
  private inTile({ corners, place, radius }: Placed, layer: Layer, [level, row, column]: TileKey): Placed | null {
    const { geometry, pyramid, mesh } = this.header;
    if (!pyramid || geometry.triangles) return null; // triangles of a level are not those of another
    const side = mesh.tileCells * pyramid.tileBlocks;
    const [rows, columns] = layer.header.geometry.shape;
    const width = geometry.shape[1];
    const line = (at: number, axis: number, tile: number, cells: number): Pair | null => {
      const nodes = pyramid.shapes[0][axis];
      const own = levelIndex(fullIndex(at, pyramid.depth, nodes), level, nodes) - tile * side;
      const cell = Math.min(Math.max(Math.floor(own), 0), cells - 1);
      return own < 0 || own > cells ? null : [cell, own - cell];
    };
    const i = line((corners[0] % width) + place[0], 1, column, columns - 1);
    const j = line(Math.floor(corners[0] / width) + place[1], 0, row, rows - 1);
    if (!i || !j) return null;
    if (layer.parts.get("cells")?.data[j[0] * (columns - 1) + i[0]] === 0) return null;
    const low = j[0] * columns + i[0];
    return { corners: [low, low + 1, low + columns, low + columns + 1], place: [i[1], j[1]], radius, cell: low };
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

  private numbers(placed: Placed[], painted: string[], anchor: Vector): Float32Array {
    const { geometry, scalars } = this.header;
    const steps = painted.map((name) => this.parts.get(name)?.data ?? new Float32Array());
    const colour = shares(steps, scalars);
    const nodes = this.nodes;
    const coordinate = geometry.triangles ? null : coordinates(geometry);
    return Float32Array.from(
      placed.flatMap(({ corners, place, radius, cell }) => {
        const [i, j] = place;
        const [a, b, c, d] = Array.from(corners, (n) => [...nodes.subarray(3 * n, 3 * n + 3)] as Vector);
        const across = cross(subtract(add(b, d), add(a, c)), subtract(add(c, d), add(a, b)));
        return [
          ...subtract(between(nodes, corners, place, 3), anchor),
          ...(coordinate ? between(coordinate, corners, place, 2) : [i * (1 - j), j]),
          ...unit(across),
          ...(scalars.flat ? colour.subarray(2 * cell, 2 * cell + 2) : between(colour, corners, place, 2)),
          ...Array.from(corners).slice(0, 3),
          radius,
        ];
      }),
    );
  }

  private get nodes(): Data {
    return this.parts.get("position")?.data ?? new Float32Array();
  }

  private get surface(): SeededSurface {
    return (this.known ??= { geometry: this.header.geometry, nodes: this.nodes, corners: this.corners() });
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
