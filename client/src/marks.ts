// Critical points and separatrices above the flow, of the step that is nearest to the time that is shown.
// flowtex/rendering/webgl/marks.py is the other side, and describes their parts.

import { atEnds } from "./bodies.ts";
import { projection, type Camera } from "./camera.ts";
import type { Graphics } from "./context.ts";
import type { EarthView } from "./earthlayer.ts";
import type { Program } from "./programs.ts";
import { LINE, MARKS, type Header, type MarkKind, type Part, type Settings, type StructureHeader } from "./protocol.ts";
import type { Moment } from "./uniforms.ts";
import { add, clamp, fromFrame, scale, subtract, toFrame, type Vector } from "./vectors.ts";

/** How much nearer than the surface lines are, and those above them, as a share of the distance. */
const [NEARER, ABOVE_SHARE] = [1e-2, 0.2];
/** Numbers of a point, and bytes of both ends of a piece. */
const [ROW, ENDS_BYTES] = [4, 24];
/** Pixels of the page around a point that are still it. */
const REACH_PX = 9;

/** Pieces of lines, or dots, of one colour and width. */
interface Layer {
  first: number;
  count: number;
  color: number[];
  width: number;
  above: number;
}

/** Lines by what they are, and points by their kinds: places in the surface's frame, three numbers each. */
interface Shapes {
  lines: Record<"from saddle" | "to saddle" | "stable orbit" | "unstable orbit", number[][]>;
  points: number[][];
}

/** What the settings leave of the parts. */
export function shapesOf(points: ArrayLike<number>, lines: ArrayLike<number>, most: { points: number; saddles: number }): Shapes {
  const shapes: Shapes = { lines: { "from saddle": [], "to saddle": [], "stable orbit": [], "unstable orbit": [] }, points: [] };
  for (let n = 0; n < Math.min(points.length / ROW, most.points); n += 1) {
    const kind = points[ROW * n + 3];
    (shapes.points[kind] ??= []).push(...[0, 1, 2].map((k) => points[ROW * n + k]));
  }
  let last = NaN;
  for (let n = 0; n < lines.length / ROW; n += 1) {
    const number = lines[ROW * n + 3];
    if (number >= LINE.saddle * most.saddles) continue;
    const names = number & LINE.orbit ? (["stable orbit", "unstable orbit"] as const) : (["from saddle", "to saddle"] as const);
    const path = shapes.lines[names[number & LINE.leaving ? 0 : 1]];
    if (number !== last) path.push([]);
    last = number;
    path[path.length - 1].push(...[0, 1, 2].map((k) => lines[ROW * n + k]));
  }
  return shapes;
}

/** Both ends of the pieces of the nullcline of a component. */
export function zeroPieces(rows: ArrayLike<number>, component: number): Float32Array {
  const numbers: number[] = [];
  for (let n = 0; n < rows.length; n += ROW) {
    if (rows[n + 3] === component) numbers.push(rows[n], rows[n + 1], rows[n + 2]);
  }
  return Float32Array.from(numbers);
}

/** Both ends of the pieces of lines, and of dots, which begin where they end. */
function ends(paths: number[][], areDots = false): Float32Array {
  const values = Float32Array.from(paths.flat());
  if (areDots) return atEnds(values, Array.from({ length: (2 * values.length) / 3 }, (_, n) => n >> 1), 3);
  const pieces: number[] = [];
  let first = 0;
  for (const path of paths) {
    const count = path.length / 3;
    for (let n = first; n < first + count - 1; n += 1) pieces.push(n, n + 1);
    first += count;
  }
  return atEnds(values, pieces, 3);
}

interface Pointed {
  place: [number, number];
  position: readonly number[];
  height: number;
}

export class Marks {
  private readonly graphics: Graphics;
  private readonly header: Header;
  private readonly parts: ReadonlyMap<string, Part>;
  private array: WebGLVertexArrayObject | null = null;
  private buffer: WebGLBuffer | null = null;
  private drawn: { key: string; layers: Layer[] } | null = null;

  constructor(graphics: Graphics, header: Header, parts: ReadonlyMap<string, Part>) {
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
  }

  /** The kinds that settings ask for, and that there are. */
  private kinds(settings: Settings): MarkKind[] {
    const there = this.header.structure?.parts ?? [];
    return (Object.keys(MARKS) as MarkKind[]).filter((kind) => there.includes(kind) && Number(settings[MARKS[kind]]) > 0);
  }

  /** Parts that are lacking at a moment. */
  lacking(settings: Settings, moment: Moment): [kind: MarkKind, step: number][] {
    const step = nearest(moment);
    return this.kinds(settings).flatMap((kind) => (this.parts.has(`${kind}/${step}`) ? [] : [[kind, step]]));
  }

  private get program(): Program {
    const { lineVertex, lineFragment } = this.header.shaders;
    return this.graphics.programs.get(lineVertex, lineFragment, "FLOWTEX_BODY", "FLOWTEX_MARK");
  }

  isReady(settings: Settings): boolean {
    return !this.kinds(settings).length || this.program.ready;
  }

  /** Number of those of a kind that are drawn, and what of them there is. */
  private shown(settings: Settings, moment: Moment, kind: MarkKind): [most: number, part: Part | undefined] {
    const isWanted = this.kinds(settings).includes(kind);
    const part = isWanted ? this.parts.get(`${kind}/${nearest(moment)}`) : undefined;
    return [part ? Number(settings[MARKS[kind]]) : 0, part];
  }

  /** Names and colours of the kinds of points, and of lines, that are drawn, in the order of a legend. */
  legend(settings: Settings, moment: Moment): StructureHeader["kinds"] {
    const [most, part] = this.shown(settings, moment, "critical");
    const kinds = new Set<number>();
    for (let n = 0; n < Math.min(most, part?.shape[0] ?? 0); n += 1) kinds.add(Number(part?.data[ROW * n + 3]));
    const { kinds: all = [], lines = {}, nullclines = [] } = this.header.structure ?? {};
    const [saddles, paths] = this.shown(settings, moment, "separatrices");
    const drawn = Object.entries(shapesOf([], paths?.data ?? [], { points: 0, saddles }).lines)
      .filter(([, some]) => some.length)
      .map(([name]) => ({ name, color: lines[name] }));
    if (this.shown(settings, moment, "nullclines")[0]) drawn.push(...nullclines);
    return [...all.filter((_, n) => kinds.has(n)), ...drawn.map((line) => ({ ...line, isLine: true }))];
  }

  draw({ camera, anchor, width, height, ratio }: EarthView, settings: Settings, moment: Moment): void {
    const { header, graphics } = this;
    const { structure, geometry } = header;
    const layers = structure && this.layers(structure, settings, moment);
    if (!structure || !layers?.length) return;
    const gl = graphics.context;
    const [x, y, z, w] = camera.eye;
    const eye = toFrame(geometry.frame, subtract([x, y, z], scale(geometry.center, w)));
    // Lines of a large view are wider, not by as much as it is larger.
    const wider = ratio * clamp(Math.sqrt(height / ratio / structure.usualHeight), ...structure.widthRange);
    const distance = w ? 1 : camera.distance / Math.hypot(...eye);
    gl.bindVertexArray(this.array);
    gl.enable(gl.BLEND);
    gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
    gl.depthFunc(gl.LEQUAL);
    const program = this.program;
    graphics.programs.use(program, {
      u_matrix: projection(geometry, camera, anchor),
      u_anchor: anchor,
      u_eye: [...subtract(eye, scale(anchor, w)), w],
      u_picture: [width, height],
      u_horizon: [0, 0, 0, 1],
    });
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    for (const { first, count, color, width: thickness, above } of layers) {
      const [r, g, b, opacity = 1] = color;
      graphics.programs.use(program, { u_width: thickness * wider, u_nearer: NEARER * distance * (1 + ABOVE_SHARE * above) });
      for (const end of [0, 1]) {
        gl.vertexAttribPointer(end, 3, gl.FLOAT, false, ENDS_BYTES, ENDS_BYTES * (first + end / 2));
        gl.vertexAttrib4f(2 + end, r, g, b, opacity);
      }
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
    gl.bindVertexArray(null);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
  }

  /** What is drawn, from below to above; its pieces lie in the buffer. */
  private layers(structure: StructureHeader, settings: Settings, moment: Moment): Layer[] {
    const [[points, dots], [saddles, lines], [, zeros]] = (["critical", "separatrices", "nullclines"] as const).map(
      (kind) => this.shown(settings, moment, kind),
    );
    const key = JSON.stringify([points, dots?.digest, saddles, lines?.digest, zeros?.digest, nearest(moment)]);
    if (this.drawn?.key === key) return this.drawn.layers;
    const shapes = shapesOf(dots?.data ?? [], lines?.data ?? [], { points, saddles });
    const { line, dot, rim, middle } = structure;
    const layers: Layer[] = [];
    const pieces: Float32Array[] = [];
    let first = 0;
    const put = (data: Float32Array, color: number[], width: number, above: number) => {
      const count = data.length / 6;
      if (count) layers.push({ first, count, color, width, above });
      pieces.push(data);
      first += count;
    };
    const nullclines = structure.nullclines.map((_, n) => zeroPieces(zeros?.data ?? [], n));
    nullclines.forEach((data) => put(data, rim, line[0], 0));
    nullclines.forEach((data, n) => put(data, structure.nullclines[n].color, line[1], 1));
    put(ends(Object.values(shapes.lines).flat()), rim, line[0], 1.5);
    Object.entries(shapes.lines).forEach(([name, paths], n) => put(ends(paths), structure.lines[name], line[1], 2 + n));
    const places = structure.kinds.map((_, n) => shapes.points[n] ?? []);
    put(ends(places, true), rim, dot[0], 6);
    structure.kinds.forEach(({ color }, n) => put(ends([places[n]], true), color, dot[1], 7));
    put(ends(places.filter((_, n) => structure.kinds[n].turns), true), middle, dot[2], 8);
    this.send(pieces);
    this.drawn = { key, layers };
    return layers;
  }

  private send(pieces: Float32Array[]): void {
    const { graphics } = this;
    const gl = graphics.context;
    this.array ??= graphics.counted(gl.createVertexArray());
    this.buffer ??= graphics.counted(gl.createBuffer());
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.from(pieces.flatMap((some) => [...some])), gl.STATIC_DRAW);
    for (const end of [0, 1]) {
      gl.enableVertexAttribArray(end);
      gl.vertexAttribDivisor(end, 1);
    }
    gl.bindVertexArray(null);
  }

  /**
   * The kind of the critical point at a place of a view, from -1 to 1, right and up, so many pixels high,
   * where the surface has a position; empty beside them.
   */
  at({ place, position, height }: Pointed, camera: Camera, settings: Settings, moment: Moment): string {
    const { geometry, structure } = this.header;
    const [most, part] = this.shown(settings, moment, "critical");
    const pixel = (2 * camera.height) / Math.max(height, 1);
    let [kind, least] = ["", REACH_PX];
    for (let n = 0; n < Math.min(most, part?.shape[0] ?? 0); n += 1) {
      const [a, b, c, number] = [0, 1, 2, 3].map((k) => Number(part?.data[ROW * n + k]));
      const point = add(fromFrame(geometry.frame, [a, b, c]), geometry.center as Vector);
      const seen = camera.project(point);
      if (!seen || Math.hypot(...subtract(point, position as Vector)) > 4 * REACH_PX * pixel) continue;
      const away = 0.5 * height * Math.hypot((seen[0] - place[0]) * camera.aspect, seen[1] - place[1]);
      if (away < least) [kind, least] = [structure?.kinds[number]?.name ?? "", away];
    }
    return kind;
  }

  dispose(): void {
    this.graphics.free("Buffer", this.buffer);
    this.graphics.free("VertexArray", this.array);
    this.array = this.buffer = this.drawn = null;
  }
}

/** The step that is nearest to a moment. */
function nearest([before, after, between]: Moment): number {
  return between < 0.5 ? before : after;
}
