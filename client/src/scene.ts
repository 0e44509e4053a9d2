// The buffers and textures of one scene, made of its parts when they are first drawn.

import { Arrows } from "./arrows.ts";
import { Bodies, BODY_PARTS } from "./bodies.ts";
import { texelsOf } from "./colours.ts";
import type { Graphics, Resource } from "./context.ts";
import { EarthLayer } from "./earthlayer.ts";
import { Marks } from "./marks.ts";
import { makeLayers, sendLayer, type LayersSize } from "./layers.ts";
import { coordinates, cornersAt, noiseCoordinates, positions, shares, type Corners } from "./mesh.ts";
import { MeshLevels, type Sight } from "./meshlevels.ts";
import { SAMPLERS, type Program } from "./programs.ts";
import { stepOf, type Data, type Header, type Part, type Settings } from "./protocol.ts";
import type { TileKey } from "./tilechoice.ts";
import { flowsOf, normalOf, positionOf, programsOf, Tracing, type Made } from "./tracer.ts";
import {
  atVertices,
  cornersOf,
  TriangleMesh,
  vertexCorners,
  vertexNormals,
  vertexShares,
} from "./trianglemesh.ts";
import type { Vector } from "./vectors.ts";

/** Objects that are made of a part, by the part's name without its step. */
const USERS: Record<string, string[]> = {
  position: ["position", "coordinate"],
  normal: ["normal"],
  cells: ["index"],
  mesh: ["index"],
  triangles: ["index", "position", "coordinate", "corners", "normal", "scalar"],
  blocks: ["index"],
  cmap: ["cmap"],
  noise: ["noise"],
  step: ["step"],
  scalars: ["scalar"],
};
/** Parts that slices are traced from beside the flow. */
const SOURCES = ["padded", "unit", "open", "nearest", "rays"];

type Scalar = Pick<Header["scalars"], "name" | "steps" | "number">;

/** The channels of a texel. */
export type Four = [number, number, number, number];

/** Bytes of four numbers in half precision, with those of the mip levels. */
const TEXEL_BYTES = 8 * (4 / 3);
/** Number of all scenes. */
let count = 0;

export class Scene {
  readonly graphics: Graphics;
  readonly header: Header;
  readonly parts: Map<string, Part>;
  readonly earth: EarthLayer;
  readonly bodies: Bodies;
  readonly arrows: Arrows;
  readonly marks: Marks;
  readonly tile: TileKey | null;
  anchor: Vector = [0, 0, 0];
  private readonly resources = new Map<string, Resource>();
  private scalarSteps = "";
  /** Levels of the mesh's blocks, and of their borders. */
  private drawn: { levels: Int8Array; joins: Int8Array } | null = null;
  private meshLevels: MeshLevels | TriangleMesh | null = null;
  /** Slices that are being traced, by their key, and what stands in it for parts without a digest. */
  private tracing = "";
  private readonly number = (count += 1);

  constructor(graphics: Graphics, header: Header, parts: Map<string, Part>, tile: TileKey | null = null) {
    this.tile = tile;
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
    this.earth = new EarthLayer(graphics, header, parts);
    this.bodies = new Bodies(graphics, header, parts);
    this.arrows = new Arrows(graphics, header, parts);
    this.marks = new Marks(graphics, header, parts);
  }

  /** Whether the programs are built of what is drawn beside the surface; asks for them. */
  isReady(settings: Settings): boolean {
    const programs = [false, true].map((isClose) => this.arrows.program(settings, isClose));
    const others = [this.earth.isReady, this.bodies.isReady, this.marks.isReady(settings)];
    return others.every(Boolean) && programs.every((program) => program?.ready ?? true);
  }

  /** Names of the parts that a moment needs and that are not there. */
  missing(before: number, after: number): string[] {
    const { geometry, slices, scalars, paper, pyramid, formula } = this.header;
    const { trace } = slices;
    const names = ["mesh", ...(trace?.parts ?? ["position", ...(geometry.planar ? [] : ["normal"])])];
    if (pyramid && !formula) names.push("places");
    if (this.header.bodies?.runs.length) names.push(...BODY_PARTS);
    if (geometry.triangles) names.push("triangles", "blocks");
    for (const step of new Set([before, after])) {
      if (trace) names.push(...flowsOf(this.header, step).map((n) => `flow/${n}`));
      else names.push(`slices/${step}`);
      if (slices.channels === 2) names.push(`extra/${step}`);
    }
    names.push(...this.scalarParts(before, after));
    if (scalars.name !== null) names.push("cmap");
    if (paper) names.push("noise", "step");
    return [...new Set(names)].filter((name) => !this.fits(name));
  }

  /** Steps that have to come before a step can be shown: it, or those that paths to it lead through. */
  lacking(step: number): number[] {
    const steps = this.missing(step, step).map((name) => (name.startsWith("flow/") ? stepOf(name) : step));
    return [...new Set(steps)];
  }

  /** Names of the parts with the nodal values of a moment, of what colours say or of another scalar. */
  scalarParts(before: number, after: number, of: Scalar = this.header.scalars): string[] {
    const { name, steps, number } = of;
    if (name === null) return [];
    const end = number ? `/${number}` : "";
    return (steps > 1 ? [before, after] : [0, 0]).map((step) => `scalars/${step}${end}`);
  }

  /** Whether a part is there and of this scene: while one is rebuilt those of the last come first.
  */
  private fits(name: string): boolean {
    const part = this.parts.get(name);
    if (!part) return false;
    const { geometry, slices, paper, mesh } = this.header;
    const blocks = geometry.shape.map((n) => Math.max(Math.ceil((n - 1) / mesh.tileCells), 1));
    const nodes = slices.trace?.nodes ?? [];
    const shapes: Record<string, number[]> = {
      flow: [...nodes, part.shape[2]],
      unit: nodes,
      padded: [...nodes.map((n) => n + 2), 3],
      slices: [slices.count, geometry.rows.size, geometry.columns.size, slices.channels],
      position: [...geometry.shape, 3],
      mesh: geometry.triangles ? part.shape : [...blocks, part.shape[2]],
      step: paper ? [paper.size[1], paper.size[0]] : [],
    };
    const shape = shapes[name.split("/")[0]];
    return !shape || String(shape) === String(part.shape);
  }

  /**
   * Make the parts of some steps that are not sent, as far as there is time; returns whether all
   * are ready. Nothing that they are made of may be missing.
   */
  make(steps: number[], until: number): boolean {
    const { slices, geometry } = this.header;
    const { trace } = slices;
    if (!trace) return true;
    const padded = this.part("padded");
    const digest = (name: string) => this.key(["padded"], name, trace);
    this.put("position", digest("position"), () => positionOf(padded, trace, geometry.shape));
    if (!geometry.planar && !trace.parts.includes("normal")) {
      this.put("normal", digest("normal"), () => normalOf(padded, trace, geometry.shape));
    }
    return steps.every((step) => this.trace(step, until));
  }

  /** Have the programs built that trace. */
  prepare(): void {
    const { trace } = this.header.slices;
    if (trace) programsOf(this.graphics, this.header, trace);
  }

  /** Trace the slices of a step, or take those that another view has. */
  private trace(step: number, until: number): boolean {
    const { graphics, header } = this;
    const { trace, lags, sides } = header.slices;
    const name = `slices/${step}`;
    if (!trace || this.resources.has(name)) return true;
    const flows = flowsOf(header, step).map((n) => `flow/${n}`);
    const key = this.key([...flows, ...SOURCES], step, trace, lags, sides, header.geometry.levels);
    let texture: WebGLTexture | null = null;
    if (!key || !graphics.common.has(`slices ${key}`)) {
      const { tracings } = graphics;
      const tracked = key || `${this.number} ${step}`;
      if (this.tracing !== tracked) this.stopTracing();
      const find = (part: string) => this.parts.get(part);
      const tracing = tracings.get(tracked) ?? new Tracing(graphics, header, trace, find, step);
      tracings.set((this.tracing = tracked), tracing);
      texture = tracing.advance(until);
      if (!texture) return false;
      this.stopTracing();
    }
    this.take(name, "Texture", key, () => texture, () => undefined);
    return true;
  }

  /** Have a part that is made of others, once for all who have the same. */
  private put(name: string, digest: string, make: () => Made): void {
    const { graphics, parts } = this;
    if (parts.get(name)?.digest === digest) return;
    const part = graphics.stock.get(digest)?.part ?? { ...make(), digest };
    graphics.release(parts.get(name));
    parts.set(name, graphics.hold(part));
    this.forget(name);
  }

  /** Whether all is there that shows some steps. */
  isMade(steps: number[]): boolean {
    const isWhole = !this.missing(steps[0], steps[steps.length - 1]).length;
    return isWhole && (!this.header.slices.trace || this.isLoaded(steps));
  }

  private stopTracing(): void {
    this.graphics.tracings.get(this.tracing)?.dispose();
    this.graphics.tracings.delete(this.tracing);
    this.tracing = "";
  }

  part(name: string): Part {
    const part = this.parts.get(name);
    if (!part) throw new Error(`the part "${name}" of the scene is missing`);
    return part;
  }

  /** Drop the objects of a part that has changed. */
  forget(name: string): void {
    const [kind, step] = name.split("/");
    if (USERS[kind]?.includes("index")) this.meshLevels = this.drawn = null;
    if (["position", "cells", "triangles"].includes(kind)) this.arrows.forget();
    const sliced = ["slices", "extra", "flow"].includes(kind);
    if (!sliced && kind !== "scalars") this.earth.forget(name);
    if (BODY_PARTS.includes(kind)) this.bodies.dispose();
    for (const user of sliced ? [`slices/${step}`] : (USERS[kind] ?? [])) this.drop(user);
    if (SOURCES.includes(kind)) this.dropSlices(NaN, NaN);
    this.drop("array");
  }

  private drop(name: string): void {
    const resource = this.resources.get(name);
    this.resources.delete(name);
    if (!resource) return;
    resource.users -= 1;
    if (resource.users) return;
    this.graphics.free(resource.kind, resource.object);
    this.graphics.common.delete(resource.key);
  }

  dispose(): void {
    for (const name of [...this.resources.keys()]) this.drop(name);
    this.stopTracing();
    this.earth.dispose();
    this.bodies.dispose();
    this.arrows.dispose();
    this.marks.dispose();
  }

  /** What some parts are known by on the whole page; nothing where one of them has no digest. */
  private key(names: string[], ...rest: unknown[]): string {
    const digests = names.map((name) => (this.parts.has(name) ? this.part(name).digest : "none"));
    return digests.every(Boolean) ? JSON.stringify([digests, rest]) : "";
  }

  /**
   * An object by its name, made when it is first needed; `key` finds that of another view, and `fill`
   * may give a count.
   */
  private take<T extends object>(
    name: string,
    kind: string,
    key: string,
    make: () => T | null,
    fill: (object: T) => number | void,
  ): T {
    const own = this.resources.get(name);
    if (own) return own.object as T;
    const { graphics } = this;
    const whole = key && `${name.split("/")[0]} ${key}`;
    const shared = whole ? graphics.common.get(whole) : undefined;
    const object = (shared?.object as T | undefined) ?? graphics.counted(make());
    const resource = shared ?? { kind, object, count: 0, key: whole, users: 0 };
    resource.users += 1;
    this.resources.set(name, resource);
    if (!shared) resource.count = fill(object) || 0;
    if (whole) graphics.common.set(whole, resource);
    return object;
  }

  private buffer(name: string, key: string, data: () => Data, elements = false) {
    const gl = this.graphics.context;
    const fill = (buffer: WebGLBuffer) => {
      const target = elements ? gl.ELEMENT_ARRAY_BUFFER : gl.ARRAY_BUFFER;
      const numbers = data();
      gl.bindVertexArray(null);
      gl.bindBuffer(target, buffer);
      gl.bufferData(target, numbers as AllowSharedBufferSource, gl.STATIC_DRAW);
      return numbers.length;
    };
    return this.take(name, "Buffer", key, () => gl.createBuffer(), fill);
  }

  private mesh(): MeshLevels | TriangleMesh {
    if (this.meshLevels) return this.meshLevels;
    const { geometry, mesh } = this.header;
    if (geometry.triangles) {
      return (this.meshLevels = new TriangleMesh(this.part("mesh"), this.part("blocks")));
    }
    const { shape, periodic } = geometry;
    const parts = { blocks: this.part("mesh").data, cells: this.parts.get("cells")?.data };
    return (this.meshLevels = new MeshLevels({ shape, periodic, ...parts }, mesh));
  }

  /** Nodes around a place (i, j) of the surface, and their shares. */
  cornersAt(place: [number, number]): Corners {
    const { triangles, shape } = this.header.geometry;
    return triangles ? cornersOf(this.part("triangles").data, place) : cornersAt(shape, place);
  }

  /** Levels of the mesh's blocks for a view, and their rows and columns. */
  levels(sight: Sight): { levels: Int8Array; shape: [number, number] } {
    return { levels: this.mesh().levels(sight), shape: this.mesh().shape };
  }

  get hasTriangles(): boolean {
    return this.drawn !== null;
  }

  /** Draw other triangles: those of some levels of the blocks and of their borders. */
  setTriangles(levels: Int8Array, joins: Int8Array = new Int8Array()): void {
    const { drawn } = this;
    if (drawn && String([levels, joins]) === String([drawn.levels, drawn.joins])) return;
    this.drawn = { levels, joins };
    this.drop("index");
    this.drop("array");
  }

  /** Whether the slices of some steps are on the graphics card. */
  isLoaded(steps: number[]): boolean {
    return steps.every((step) => this.resources.has(`slices/${step}`));
  }

  /** Bytes of the slices that were traced, about. */
  get tracedBytes(): number {
    const { slices, geometry } = this.header;
    if (!slices.trace) return 0;
    const steps = [...this.resources.keys()].filter((name) => name.startsWith("slices/")).length;
    return steps * TEXEL_BYTES * slices.count * geometry.rows.size * geometry.columns.size;
  }

  load(steps: number[]): void {
    for (const step of steps) this.slices(step);
  }

  private bindNodes(before: number, after: number, anchor: Vector): void {
    const gl = this.graphics.context;
    const steps = String(this.scalarParts(before, after));
    const stale = steps !== this.scalarSteps ? ["scalar", "array"] : [];
    if (anchor.some((x, k) => x !== this.anchor[k])) stale.push("position", "array");
    for (const name of stale) this.drop(name);
    this.scalarSteps = steps;
    this.anchor = anchor;
    const fill = (array: WebGLVertexArrayObject) => this.fillArray(array, before, after);
    const make = () => gl.createVertexArray();
    gl.bindVertexArray(this.take("array", "VertexArray", "", make, fill));
  }

  private fillArray(array: WebGLVertexArrayObject, before: number, after: number): void {
    const gl = this.graphics.context;
    const { geometry, paper, scalars } = this.header;
    const { shape, rows, columns } = geometry;
    const { levels, joins } = this.drawn ?? { levels: new Int8Array(), joins: new Int8Array() };
    const key = (names: string[], ...rest: unknown[]) => this.key(["triangles", ...names], ...rest);
    const cells = () => this.mesh().triangles(levels, joins);
    const drawn = key(["cells", "mesh", "blocks"], shape, [...levels], [...joins]);
    const index = this.buffer("index", drawn, cells, true);
    const corners = geometry.triangles ? this.part("triangles").data : null;
    const vertices = <T extends Data>(values: T, size: number, flat?: boolean) =>
      corners ? atVertices(values, flat ? corners.map((_: number, n: number) => n / 3) : corners, size) : values;
    const nodes = () =>
      vertices(positions(this.part("position").data, this.anchor), 3);
    const normal = geometry.planar ? null : this.part("normal").data;
    const normals = <T extends Data>(nodal: T) =>
      corners ? vertexNormals(nodal, this.part("position").data, corners) : nodal;
    const [colour, values] = this.shares(before, after);
    const grid = JSON.stringify([shape, rows, columns, corners?.length]);
    const place = () => (corners ? vertexShares(corners.length / 3) : coordinates(geometry));
    let type: number = gl.FLOAT;
    if (normal instanceof Int8Array) type = gl.BYTE;
    if (normal instanceof Int16Array) type = gl.SHORT;
    const attributes: [WebGLBuffer | null, number, number][] = [
      [this.buffer("position", key(["position"], this.anchor), nodes), 3, gl.FLOAT],
      [this.buffer("coordinate", grid, place), 2, gl.FLOAT],
      [normal && this.buffer("normal", key(["normal"]), () => normals(normal)), 3, type],
      [paper && this.buffer("along", "", () => noiseCoordinates(paper)), 2, gl.FLOAT],
      [corners && this.buffer("scalar", colour, () => vertices(values(), 2, scalars.flat)), 2, gl.FLOAT],
      [corners && this.buffer("corners", key([]), () => vertexCorners(corners)), 3, gl.FLOAT],
    ];
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, index);
    attributes.forEach(([buffer, size, kind], n) => {
      if (!buffer) return;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(n);
      gl.vertexAttribPointer(n, size, kind, kind !== gl.FLOAT, 0, 0);
    });
  }

  /** Shares of the colour map's range at the nodes, two each, and what they are known by. */
  private shares(before: number, after: number): [key: string, make: () => Float32Array] {
    const { geometry, scalars } = this.header;
    const { shape } = geometry;
    const painted = this.scalarParts(before, after);
    const key = this.key(["triangles", ...new Set(painted)], shape, scalars.low, scalars.high, scalars.log);
    const make = () => shares(painted.map((name) => this.part(name).data), scalars);
    return [key, make];
  }

  /** The same where fragments look them up. */
  private nodalShares(before: number, after: number): WebGLTexture {
    const gl = this.graphics.context;
    const [rows, columns] = this.header.geometry.shape;
    const [key, values] = this.shares(before, after);
    return this.texture("scalar", key, (texture) => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32F, columns, rows, 0, gl.RG, gl.FLOAT, values());
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    });
  }

  private texture(name: string, key: string, fill: (texture: WebGLTexture) => void): WebGLTexture {
    const gl = this.graphics.context;
    return this.take(name, "Texture", key, () => gl.createTexture(), fill);
  }

  private slices(step: number): WebGLTexture {
    const { slices, geometry } = this.header;
    const key = this.key([`slices/${step}`, `extra/${step}`], geometry.levels, slices.extra);
    return this.texture(`slices/${step}`, key, (texture) => {
      const part = this.part(`slices/${step}`);
      const [layers, height, width, channels] = part.shape;
      const data = part.data as Uint16Array;
      const extra = this.parts.get(`extra/${step}`)?.data as Uint16Array | undefined;
      const texels = height * width;
      const layer = (n: number) => {
        const own = data.subarray(n * texels * channels, (n + 1) * texels * channels);
        if (channels === 4) return own;
        const all = new Uint16Array(4 * texels);
        const place = slices.extra.indexOf(n);
        const fourth = place < 0 ? null : extra?.subarray(place * texels, (place + 1) * texels);
        for (let k = 0; k < texels; k += 1) {
          all[4 * k] = own[2 * k];
          all[4 * k + 1] = own[2 * k + 1];
          if (fourth) all[4 * k + 3] = fourth[k];
        }
        return all;
      };
      this.fill(texture, { width, height, layers, channels: 4, levels: geometry.levels }, layer);
    });
  }

  /** Programs that find a point, and what the slices have there; they may not be ready yet. */
  get pickers(): [place: Program, texels: Program] {
    const { programs } = this.graphics;
    const { vertex, pick, fullVertex, probe } = this.header.shaders;
    return [programs.get(vertex, pick), programs.get(fullVertex, probe)];
  }

  /** What the slices of a step have at some texels, four at most: channels by layer, and by texel. */
  texels(step: number, texels: number[]): (layer: number, n: number) => Four {
    const { graphics, header } = this;
    const gl = graphics.context;
    const { slices, geometry } = header;
    const width = geometry.columns.size;
    const texture = this.slices(step);
    const draw = () => {
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      gl.bindVertexArray(null);
      const places = texels.flatMap((n) => [n % width, Math.floor(n / width)]);
      graphics.programs.use(this.pickers[1], { u_texels: places });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    };
    const bits = graphics.numbers(draw, texels.length, slices.count);
    const numbers = new Float32Array(bits.buffer);
    return (layer, n) => {
      const [x, y, z, w] = numbers.subarray(4 * (layer * texels.length + n));
      return [x, y, z, w];
    };
  }

  /** An image that is repeated along (v, u). */
  private image(name: string, repeat: [boolean, boolean]): WebGLTexture {
    const gl = this.graphics.context;
    return this.texture(name, this.key([name], repeat), (texture) => {
      const { data, shape } = this.part(name);
      const [height, width, channels = 1] = shape;
      const levels = Math.floor(Math.log2(Math.max(width, height)));
      const size = { width, height, layers: 1, channels, levels };
      this.fill(texture, size, () => data as Uint16Array);
      const wrap = (n: number) => (repeat[n] ? gl.REPEAT : gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_S, wrap(1));
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_T, wrap(0));
    });
  }

  /** Send the layers of a texture, and make its mip levels. */
  private fill(texture: WebGLTexture, size: LayersSize, layer: (n: number) => Uint16Array): void {
    const { context: gl, floats } = this.graphics;
    makeLayers(gl, texture, size);
    for (let n = 0; n < size.layers; n += 1) sendLayer(gl, floats ? { ...size, levels: 0 } : size, n, layer(n));
    if (floats && size.levels) gl.generateMipmap(gl.TEXTURE_2D_ARRAY);
  }

  private colourMap(): WebGLTexture {
    const gl = this.graphics.context;
    const { scalars } = this.header;
    return this.texture("cmap", this.key(["cmap"], scalars.beyond), (texture) => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      const data = texelsOf(this.parts.get("cmap")?.data ?? new Uint8Array(4), scalars);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, data.length / 4, 1, 0, gl.RGBA, gl.FLOAT, data);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    });
  }

  /** Drop the slices of steps that are neither shown nor next. */
  private dropSlices(before: number, after: number): void {
    const next = after + 1 < this.header.slices.steps ? after + 1 : 0;
    for (const name of [...this.resources.keys()]) {
      if (!name.startsWith("slices/")) continue;
      if (![before, after, next, after + 1].includes(stepOf(name))) this.drop(name);
    }
  }

  /** Have the slices of a moment, and images, in their units. */
  bindTextures(before: number, after: number): void {
    const gl = this.graphics.context;
    const { geometry, paper, scalars } = this.header;
    const repeat = paper?.repeat ?? [false, false];
    const units = [
      this.slices(before),
      after === before ? null : this.slices(after),
      paper && this.image("noise", paper.picture ? [true, true] : repeat),
      paper && this.image("step", repeat),
      this.colourMap(),
      geometry.triangles || scalars.name === null ? null : this.nodalShares(before, after),
    ];
    units.forEach((texture, n) => {
      gl.activeTexture(gl.TEXTURE0 + n);
      gl.bindTexture(n < 4 ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, texture);
    });
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.length);
  }

  /** Number of the triangles that are drawn. */
  get triangles(): number {
    return (this.resources.get("index")?.count ?? 0) / 3;
  }

  /** Draw all cells with a program that is in use. */
  draw(before: number, after: number, anchor: Vector, textures: boolean): void {
    const gl = this.graphics.context;
    this.bindNodes(before, after, anchor);
    if (textures) {
      this.dropSlices(before, after);
      this.bindTextures(before, after);
    }
    gl.drawElements(gl.TRIANGLES, this.resources.get("index")?.count ?? 0, gl.UNSIGNED_INT, 0);
    gl.bindVertexArray(null);
  }
}
