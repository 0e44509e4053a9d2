// The buffers and textures of one scene, made of its parts when they are first drawn.

import { Arrows } from "./arrows.ts";
import { Bodies, BODY_PARTS } from "./bodies.ts";
import { texelsOf } from "./colours.ts";
import type { Graphics, Resource } from "./context.ts";
import { EarthLayer } from "./earthlayer.ts";
import { Marks } from "./marks.ts";
import { checkSize, makeLayers, type LayersSize } from "./half.ts";
import { alongAxes, type Corners, cornersAndBlocks, cornersAt, cornersOf, positions, shares, unitNormals } from "./mesh.ts";
import { mostDoublings } from "./meshlevels.ts";
import { SAMPLERS, type Program } from "./programs.ts";
import { stepOf, type Data, type Header, type Part, type Settings } from "./protocol.ts";
import type { TileKey } from "./tilechoice.ts";
import { flowsOf, normalOf, positionOf, programsOf, Tracing, type Made } from "./tracer.ts";
import type { Vector } from "./vectors.ts";

/** Objects that are made of a part, by the part's name without its step. */
const USERS: Record<string, string[]> = {
  position: ["nodes"],
  normal: ["nodes"],
  cells: ["cells"],
  triangles: ["nodes", "cells", "scalar"],
  blocks: ["cells"],
  cmap: ["cmap"],
  image: ["image"],
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
/** Triangles in a row of the texture of their corners. */
const CORNERS_WIDTH = 2048;
/** Samplers of textures with layers. */
const ARRAYS = ["u_slices", "u_slicesNext", "u_image", "u_stepImage", "u_nodes"];
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
  /** Changes with the surface, and what stands beside it. */
  version = 0;
  private readonly resources = new Map<string, Resource>();
  private scalarSteps = "";
  private most: Int8Array | null = null;
  /** Slices that are being traced, by their key, and what stands in it for parts without a digest. */
  private tracing = "";
  /** Steps whose slices are made, perhaps while those of others are shown. */
  private wanted: number[] = [];
  readonly number = (count += 1);

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

  /** Whether the programs are built that draw the scene, maybe with smooth outlines; asks for them. */
  isReady(settings: Settings, smooth = false): boolean {
    const programs = [false, true].map((isClose) => this.arrows.program(settings, isClose));
    const names = (["place", "blur", "colour", "surface", "smooth", "probe"] as const).filter((name) => smooth || name !== "smooth");
    const own = names.map((name) => this.programs(name).ready);
    const others = [...own, this.earth.isReady, this.bodies.isReady, this.marks.isReady(settings)];
    return others.every(Boolean) && programs.every((program) => program?.ready ?? true);
  }

  /** Names of the parts that a moment needs and that are not there. */
  missing(before: number, after: number): string[] {
    const { geometry, slices, scalars, image, pyramid, formula } = this.header;
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
    if (image) names.push("image", "step");
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
    const { geometry, slices, image, mesh } = this.header;
    const blocks = geometry.shape.map((n) => Math.max(Math.ceil((n - 1) / mesh.tileCells), 1));
    const nodes = slices.trace?.nodes ?? [];
    const shapes: Record<string, number[]> = {
      flow: [...nodes, part.shape[2]],
      unit: nodes,
      padded: [...nodes.map((n) => n + 2), 3],
      slices: [slices.count, geometry.rows.size, geometry.columns.size, slices.channels],
      position: [...geometry.shape, 3],
      mesh: geometry.triangles ? part.shape : [...blocks, part.shape[2]],
      step: image ? [...image.stepSize].reverse() : [],
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
    this.wanted = steps;
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
    if (["position", "cells", "triangles"].includes(kind)) this.arrows.forget();
    const sliced = ["slices", "extra", "flow"].includes(kind);
    if (!sliced && kind !== "scalars") {
      this.earth.forget(name);
      this.version += 1;
      this.most = null;
    }
    if (BODY_PARTS.includes(kind)) this.bodies.dispose();
    for (const user of sliced ? [`slices/${step}`] : (USERS[kind] ?? [])) this.drop(user);
    if (!SOURCES.includes(kind)) return;
    this.wanted = [];
    this.dropSlices(NaN, NaN);
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

  /** Places of the blocks, which are drawn by themselves. */
  get blocks(): Part {
    return this.part("mesh");
  }

  /** Most doublings of the nodes of each block. */
  get doublings(): Int8Array {
    const { geometry, mesh } = this.header;
    return (this.most ??= mostDoublings(geometry, this.blocks, this.part("position").data, mesh.tileCells));
  }

  /** Nodes around a place (i, j) of the surface, and their shares. */
  cornersAt(place: [number, number]): Corners {
    const { triangles, shape } = this.header.geometry;
    return triangles ? cornersOf(this.part("triangles").data, place) : cornersAt(shape, place);
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

  /** Have positions and normals in their unit, and the nodes of triangles, or which cells are drawn. */
  bindNodes(anchor: Vector): void {
    const gl = this.graphics.context;
    const { shape, triangles, planar } = this.header.geometry;
    if (anchor.some((x, k) => x !== this.anchor[k])) this.drop("nodes");
    this.anchor = anchor;
    const [height, width] = this.nodesSize;
    const nodes = this.texture("nodes", this.key(["position", "normal"], width, anchor), (texture) => {
      checkSize(gl, width, height);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      const data = new Float32Array((planar ? 3 : 6) * width * height);
      data.set(positions(this.part("position").data, anchor));
      if (!planar) data.set(unitNormals(this.part("normal").data), 3 * width * height);
      const size = [width, height, planar ? 1 : 2] as const;
      gl.texImage3D(gl.TEXTURE_2D_ARRAY, 0, gl.RGB32F, ...size, 0, gl.RGB, gl.FLOAT, data);
      nearest(gl, gl.TEXTURE_2D_ARRAY);
    });
    const open = () => this.parts.get("cells")?.data ?? Uint8Array.of(1);
    const cells = triangles
      ? this.table("cells", this.key(["triangles", "blocks"]), gl.RGBA32UI, CORNERS_WIDTH, () =>
          cornersAndBlocks(this.part("triangles").data, this.part("blocks").data),
        )
      : this.table("cells", this.key(["cells"], shape), gl.R8UI, this.parts.has("cells") ? shape[1] - 1 : 1, open);
    this.bind("u_nodes", nodes);
    this.bind(triangles ? "u_corners" : "u_open", cells);
  }

  /** Rows and columns of nodes, those of triangles as they are wrapped. */
  private get nodesSize(): [number, number] {
    const { shape, triangles, rows, columns } = this.header.geometry;
    return triangles ? [rows.size, columns.size] : shape;
  }

  private bind(sampler: string, texture: WebGLTexture | null): void {
    const gl = this.graphics.context;
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.indexOf(sampler));
    gl.bindTexture(ARRAYS.includes(sampler) ? gl.TEXTURE_2D_ARRAY : gl.TEXTURE_2D, texture);
    gl.activeTexture(gl.TEXTURE0 + SAMPLERS.length);
  }

  /** A texture of numbers that are looked up one by one, in rows of a width. */
  private table(name: string, key: string, inner: number, width: number, values: () => Data): WebGLTexture {
    const gl = this.graphics.context;
    const formats: Record<number, [format: number, type: number, channels: number]> = {
      [gl.RGBA32UI]: [gl.RGBA_INTEGER, gl.UNSIGNED_INT, 4],
      [gl.R8UI]: [gl.RED_INTEGER, gl.UNSIGNED_BYTE, 1],
      [gl.RG32F]: [gl.RG, gl.FLOAT, 2],
      [gl.RGBA32F]: [gl.RGBA, gl.FLOAT, 4],
    };
    const [format, type, channels] = formats[inner];
    return this.texture(name, key, (texture) => {
      const data = values();
      const height = Math.ceil(data.length / channels / width);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
      const all = filled(data, channels * width * height) as AllowSharedBufferSource & ArrayBufferView;
      gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, all);
      nearest(gl, gl.TEXTURE_2D);
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

  /** The program that draws places, local means of the texture, colours, the surface with its colours or with smooth outlines, or looks up texels. */
  programs(name: "place" | "blur" | "colour" | "surface" | "smooth" | "probe"): Program {
    const { programs } = this.graphics;
    const { vertex, place, fullVertex, even, surface, ...others } = this.header.shaders;
    if (name === "place") return programs.get(vertex, place);
    if (name === "smooth") return programs.get(vertex, surface, "FLOWTEX_SMOOTH");
    if (name === "surface") return programs.get(fullVertex, surface);
    if (name === "blur") return programs.get(fullVertex, even);
    return programs.get(fullVertex, others[name]);
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
      graphics.programs.use(this.programs("probe"), { u_texels: places });
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
    const gl = this.graphics.context;
    const { width, height, layers, channels, levels } = size;
    makeLayers(gl, texture, size);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const format = channels === 1 ? gl.RED : gl.RGBA;
    for (let n = 0; n < layers; n += 1) {
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, n, width, height, 1, format, gl.HALF_FLOAT, layer(n));
    }
    if (levels) gl.generateMipmap(gl.TEXTURE_2D_ARRAY);
  }

  /** Drop the slices of steps that are neither shown, nor next, nor made while others are shown. */
  private dropSlices(before: number, after: number): void {
    const next = after + 1 < this.header.slices.steps ? after + 1 : 0;
    const kept = [before, after, next, after + 1, ...this.wanted];
    for (const name of [...this.resources.keys()]) {
      if (name.startsWith("slices/") && !kept.includes(stepOf(name))) this.drop(name);
    }
  }

  /** Have the slices of a moment, colours and images in their units. */
  bindTextures(before: number, after: number): void {
    const gl = this.graphics.context;
    const { image, scalars } = this.header;
    const steps = String(this.scalarParts(before, after));
    if (steps !== this.scalarSteps) this.drop("scalar");
    this.scalarSteps = steps;
    this.dropSlices(before, after);
    this.bind("u_slices", this.slices(before));
    this.bind("u_slicesNext", after === before ? null : this.slices(after));
    this.bind("u_image", image && this.image("image", image.repeated));
    this.bind("u_stepImage", image && this.image("step", image.repeat));
    const colours = texelsOf(this.parts.get("cmap")?.data ?? new Uint8Array(4), scalars);
    this.bind("u_cmap", this.table("cmap", this.key(["cmap"], scalars.beyond), gl.RGBA32F, colours.length / 4, () => colours));
    const [key, values] = this.shares(before, after);
    this.bind("u_shares", scalars.name === null ? null : this.table("scalar", key, gl.RG32F, this.nodesSize[1], values));
    const along = () => alongAxes(image?.alongI ?? [], image?.alongJ ?? []);
    this.bind("u_along", image && this.table("along", "", gl.RG32F, Math.max(image.alongI.length, image.alongJ.length), along));
  }
}

function nearest(gl: WebGL2RenderingContext, target: number): void {
  gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
}

/** Numbers with zeros behind them. */
function filled<T extends Data>(data: T, length: number): T {
  if (data.length === length) return data;
  const all = new (data.constructor as new (length: number) => T)(length);
  all.set(data);
  return all;
}
