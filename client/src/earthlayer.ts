// What is drawn of the Earth: land or a globe below the flow, and lines above it.

import { type Camera, pointInPlane, projection } from "./camera.ts";
import type { Graphics } from "./context.ts";
import { GROUND, missingColour } from "./ground.ts";
import { positions } from "./mesh.ts";
import { type Earth, EARTH_LINES, type EarthLines, type Header, type Part } from "./protocol.ts";
import { add, clamp, cross, dot, length, scale, subtract, toFrame, unit, type Vector } from "./vectors.ts";

/** A value that is not a point, before each line. */
export const BREAK = 1e30;
/** Steps that a side of the box has. */
const STEPS = 65535;
/** Pieces of lines that are drawn or left out together. */
const GROUP = 256;

/** Pieces that lie in a ball, which is seen or not. */
export interface PieceGroup {
  first: number;
  count: number;
  middle: Vector;
  radius: number;
}

/**
 * Lines in the surface's frame. The part has the steps from each point to the next, which go around at
 * their greatest number, and whether a line begins there.
 */
export function linesOf(steps: ArrayLike<number>, { low, size }: Pick<Earth, "low" | "size">): Vector[][] {
  const lines: Vector[][] = [];
  const place = [0, 0, 0];
  for (let n = 0; n < steps.length; n += 4) {
    if (steps[n + 3]) lines.push([]);
    const point = place.map((_, k) => {
      place[k] = (place[k] + steps[n + k]) & STEPS;
      return low[k] + (place[k] / STEPS) * size[k];
    });
    lines[lines.length - 1].push(point as Vector);
  }
  return lines;
}

/** Lines with a point about every `spacing` metres, without shorter ones: MapLines.thinned in Python. */
export function thinned(lines: Vector[][], spacing: number): Vector[][] {
  if (!spacing) return lines;
  return lines.flatMap((line) => {
    let along = 0;
    const kept = line.filter((point, n) => {
      const before = along;
      if (n) along += Math.hypot(...point.map((x, k) => x - line[n - 1][k]));
      const isNext = Math.floor(along / spacing) > Math.floor(before / spacing);
      return isNext || n === 0 || n === line.length - 1;
    });
    return along < spacing ? [] : [kept];
  });
}

/** Points of lines, counted from an anchor, with a break before each line. */
export function linePoints(lines: Vector[][], anchor: Vector): Float32Array {
  const size = lines.reduce((count, line) => count + line.length + 1, 0);
  const points = new Float32Array(3 * size).fill(BREAK);
  let n = 0;
  for (const line of lines) {
    n += 3;
    for (const point of line) {
      for (let k = 0; k < 3; k += 1) points[n++] = point[k] - anchor[k];
    }
  }
  return points;
}

/** Balls around groups of pieces; piece n goes from point n to the next. */
export function pieceGroups(points: Float32Array): PieceGroup[] {
  const groups: PieceGroup[] = [];
  const pieces = points.length / 3 - 1;
  for (let first = 0; first < pieces; first += GROUP) {
    const count = Math.min(GROUP, pieces - first);
    const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
    for (let n = 3 * first; n < 3 * (first + count + 1); n += 1) {
      if (points[n] === Math.fround(BREAK)) continue;
      low[n % 3] = Math.min(low[n % 3], points[n]);
      high[n % 3] = Math.max(high[n % 3], points[n]);
    }
    const middle = low.map((least, k) => (least + high[k]) / 2) as Vector;
    const radius = Math.hypot(...low.map((least, k) => (high[k] - least) / 2));
    groups.push({ first, count, middle, radius });
  }
  return groups;
}

/** First piece and number of those in a row that planes (a, b, c, d) do not leave out. */
export function visibleRuns(groups: PieceGroup[], planes: number[][]): [number, number][] {
  const runs: [number, number][] = [];
  for (const { first, count, middle: [x, y, z], radius } of groups) {
    const isOut = ([a, b, c, d]: number[]) =>
      a * x + b * y + c * z + d < -radius * Math.hypot(a, b, c);
    if (planes.some(isOut)) continue;
    const last = runs[runs.length - 1];
    if (last && last[0] + last[1] === first) last[1] += count;
    else runs.push([first, count]);
  }
  return runs;
}

const POINT_BYTES = 12;
const PIECE_ENDS = 2;

/** Objects of the graphics card, and from where their positions are counted. */
interface Drawn {
  array: WebGLVertexArrayObject;
  buffers: WebGLBuffer[];
  anchor: Vector;
  spacing: number;
  count: number;
  groups: PieceGroup[];
}

/** Place of a globe, or of a flat map, in a view; null beside them. */
export function groundAt({ earth, geometry }: Header, camera: Camera, x: number, y: number) {
  if (!earth) return null;
  if (earth.map) {
    const place = pointInPlane(geometry, camera, x, y);
    const [x0, y0, x1, y1] = earth.map;
    const isInside = place[0] >= x0 && place[0] <= x1 && place[1] >= y0 && place[1] <= y1;
    return isInside ? place : null;
  }
  const [start, along] = camera.ray(x, y);
  const nearest = dot(start, along);
  const square = nearest ** 2 - dot(start, start) + earth.radius ** 2;
  const depth = -nearest - Math.sqrt(square);
  return depth > 0 ? add(start, along, depth) : null;
}

/** What of a picture the layer needs. */
export interface EarthView {
  camera: Camera;
  anchor: Vector;
  width: number;
  height: number;
  /** Pixels of the picture along one of the page. */
  ratio: number;
}

export class EarthLayer {
  /** Changes with what is drawn. */
  version = 0;
  private readonly graphics: Graphics;
  private readonly header: Header;
  private readonly parts: ReadonlyMap<string, Part>;
  private readonly drawn = new Map<string, Drawn>();

  constructor(graphics: Graphics, header: Header, parts: ReadonlyMap<string, Part>) {
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
  }

  /** Drop what was made of a part that has changed. */
  forget(name: string): void {
    this.version += 1;
    for (const each of name === "position" ? GROUND : [name]) this.drop(each);
  }

  dispose(): void {
    for (const name of [...this.drawn.keys()]) this.drop(name);
  }

  private drop(name: string): void {
    const drawn = this.drawn.get(name);
    if (!drawn) return;
    for (const buffer of drawn.buffers) this.graphics.free("Buffer", buffer);
    this.graphics.free("VertexArray", drawn.array);
    this.drawn.delete(name);
  }

  /** The lines that are shown and here. */
  get lines(): EarthLines[] {
    const { earth } = this.header;
    return earth ? EARTH_LINES.filter((name) => earth[name] && this.parts.has(name)) : [];
  }

  /** Draw the lines one above the other, each into its own picture, for which `take` is called. */
  drawLines(view: EarthView, take: () => void): void {
    const { header, graphics } = this;
    const { earth, shaders } = header;
    const program = graphics.programs.get(shaders.lineVertex, shaders.lineFragment);
    if (!earth || !program.ready) return;
    const gl = graphics.context;
    const { camera, anchor, width, height, ratio } = view;
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, 0, width, height);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendEquation(gl.MAX);
    gl.clearColor(0, 0, 0, 0);
    const horizon = this.horizon(camera);
    const planes = [...camera.planes, ...(horizon ? [horizon] : [])];
    const local = planes.map((plane) => this.localPlane(plane, anchor));
    const pixel = (2 * camera.height * ratio) / height;
    // Lines of a large view are wider, not by as much as it is larger.
    const wider = clamp(Math.sqrt(height / ratio / earth.usualHeight), ...earth.widthRange);
    const most = earth.spacingPixels * pixel;
    const spacing = earth.spacings.find((each) => each <= most) ?? 0;
    for (const { option, color, opacity, width: thickness } of earth.strokes) {
      if (!this.lines.includes(option)) continue;
      gl.clear(gl.COLOR_BUFFER_BIT);
      const drawn = this.take(option, anchor, () => this.linesOf(option, anchor, spacing), spacing);
      graphics.programs.use(program, {
        u_matrix: projection(header.geometry, camera, anchor),
        u_picture: [width, height],
        u_width: thickness * wider * ratio,
        u_lineColour: [...color, opacity],
        u_horizon: horizon ? local[local.length - 1] : [0, 0, 0, 1],
      });
      gl.bindVertexArray(drawn.array);
      gl.bindBuffer(gl.ARRAY_BUFFER, drawn.buffers[0]);
      for (const [first, count] of visibleRuns(drawn.groups, local)) {
        for (let n = 0; n < PIECE_ENDS; n += 1) {
          gl.vertexAttribPointer(n, 3, gl.FLOAT, false, POINT_BYTES, (first + n) * POINT_BYTES);
        }
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
      }
      take();
    }
    gl.bindVertexArray(null);
    gl.blendEquation(gl.FUNC_ADD);
    gl.disable(gl.BLEND);
  }

  /** Whether the programs of ground and lines are ready, where there are any; asks for them. */
  get isReady(): boolean {
    const { lineVertex, lineFragment } = this.header.shaders;
    const { earth } = this.header;
    if (earth?.land) {
      if (earth.map === null && earth.below && !this.groundProgram("FLOWTEX_GLOBE").ready) return false;
      if (this.hasCells && !this.groundProgram(...this.roundness).ready) return false;
    }
    return !this.lines.length || this.graphics.programs.get(lineVertex, lineFragment).ready;
  }

  private groundProgram(...defines: string[]) {
    const { groundVertex, groundFragment } = this.header.shaders;
    return this.graphics.programs.get(groundVertex, groundFragment, ...defines);
  }

  private get hasCells(): boolean {
    return GROUND.some((name) => this.parts.has(name));
  }

  /** What the program of cells needs on a globe. */
  private get roundness(): string[] {
    return this.header.earth?.map === null ? ["FLOWTEX_ROUND"] : [];
  }

  /** Draw what lies below the flow, into a picture without it. */
  drawGround({ camera, anchor }: EarthView): void {
    const { header, graphics } = this;
    const { earth, geometry } = header;
    if (!earth?.land) return;
    const globe = earth.map === null;
    const cells = GROUND.filter((name) => this.parts.has(name));
    const gl = graphics.context;
    const common = {
      u_matrix: projection(geometry, camera, anchor),
      u_ground: header.background ?? [1, 1, 1],
      u_lit: header.lighting,
      u_toEye: toFrame(geometry.frame, scale(camera.axes[2], -1)),
    };
    const missing = missingColour(header);
    if (globe && earth.below) {
      const program = this.groundProgram("FLOWTEX_GLOBE");
      if (!program.ready) return;
      graphics.programs.use(program, { ...common, u_colour: missing, ...this.disc(camera, earth.radius, anchor) });
      gl.bindVertexArray(this.take("disc", anchor, () => this.emptyArray()).array);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
    const program = this.groundProgram(...this.roundness);
    if (!cells.length || !program.ready) return gl.bindVertexArray(null);
    // The flow lies in the same plane.
    gl.depthMask(false);
    for (const name of cells) {
      const colour = name === "land" ? earth.land : missing;
      const middle = subtract(toFrame(geometry.frame, scale(geometry.center, -1)), anchor);
      graphics.programs.use(program, { ...common, u_colour: colour, ...(globe && { u_middle: middle }) });
      const drawn = this.take(name, anchor, () => this.cellsOf(name, anchor));
      gl.bindVertexArray(drawn.array);
      gl.drawElements(gl.TRIANGLES, drawn.count, gl.UNSIGNED_INT, 0);
    }
    gl.depthMask(true);
    gl.bindVertexArray(null);
  }

  /** Plane of what is seen of a globe, which lies where p . (x, y, z, 1) >= 0; null of a flat map. */
  private horizon(camera: Camera): number[] | null {
    const { earth } = this.header;
    if (!earth || earth.map) return null;
    const { radius } = earth;
    const [x, y, z, w] = camera.eye;
    const away = w * Math.hypot(x, y, z);
    return [...unit([x, y, z]), away ? -(radius ** 2) / away : 0];
  }

  /** A plane of the mesh's coordinates in the surface's frame from an anchor. */
  private localPlane(plane: number[], anchor: Vector): number[] {
    const { frame, center } = this.header.geometry;
    const normal = plane.slice(0, 3) as Vector;
    const local = toFrame(frame, normal);
    return [...local, dot(local, anchor) + dot(normal, center) + plane[3]];
  }

  /** The disc that the horizon of a globe bounds. */
  private disc(camera: Camera, radius: number, anchor: Vector) {
    const { frame, center } = this.header.geometry;
    const [a, b, c, offset] = this.horizon(camera) ?? [0, 0, 1, 0];
    const toEye: Vector = [a, b, c];
    const size = Math.sqrt(Math.max(radius ** 2 - offset ** 2, 0));
    const aside = unit(cross(camera.axes[1], toEye));
    const upward = cross(toEye, aside);
    const middle = add(scale(toEye, -offset), center, -1);
    return {
      u_middle: subtract(toFrame(frame, middle), anchor),
      u_aside: scale(toFrame(frame, aside), size),
      u_upward: scale(toFrame(frame, upward), size),
      u_away: camera.state.parallel ? 0 : length(camera.state.position as Vector) / radius,
    };
  }

  private take(name: string, anchor: Vector, make: () => Drawn, spacing = 0): Drawn {
    const old = this.drawn.get(name);
    if (old && String([old.anchor, old.spacing]) === String([anchor, spacing])) return old;
    this.drop(name);
    const drawn = { ...make(), anchor, spacing };
    this.drawn.set(name, drawn);
    return drawn;
  }

  private emptyArray(): Drawn {
    const { graphics } = this;
    const array = graphics.counted(graphics.context.createVertexArray());
    return { array, buffers: [], anchor: [0, 0, 0], spacing: 0, count: 0, groups: [] };
  }

  private buffer(target: number, data: AllowSharedBufferSource): WebGLBuffer {
    const { graphics } = this;
    const gl = graphics.context;
    const buffer = graphics.counted(gl.createBuffer());
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, data, gl.STATIC_DRAW);
    return buffer;
  }

  private linesOf(name: EarthLines, anchor: Vector, spacing: number): Drawn {
    const gl = this.graphics.context;
    const { earth } = this.header;
    const steps = this.parts.get(name)?.data ?? [];
    const lines = earth ? linesOf(steps, earth) : [];
    const points = linePoints(thinned(lines, spacing), anchor);
    const drawn = { ...this.emptyArray(), groups: pieceGroups(points) };
    gl.bindVertexArray(drawn.array);
    drawn.buffers = [this.buffer(gl.ARRAY_BUFFER, points as AllowSharedBufferSource)];
    for (let n = 0; n < PIECE_ENDS; n += 1) {
      gl.enableVertexAttribArray(n);
      gl.vertexAttribDivisor(n, 1);
    }
    return drawn;
  }

  private cellsOf(name: string, anchor: Vector): Drawn {
    const gl = this.graphics.context;
    const cells = this.parts.get(name);
    const nodes = this.parts.get("position");
    const drawn = this.emptyArray();
    if (!cells || !nodes) return drawn;
    const corners = this.header.geometry.triangles ? cells.data : cellCorners(cells);
    gl.bindVertexArray(drawn.array);
    const points = positions(nodes.data as Float32Array, anchor);
    drawn.buffers = [
      this.buffer(gl.ARRAY_BUFFER, points as AllowSharedBufferSource),
      this.buffer(gl.ELEMENT_ARRAY_BUFFER, corners as AllowSharedBufferSource),
    ];
    drawn.count = corners.length;
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    return drawn;
  }
}

/** Nodes at the corners of the triangles of cells that are marked. */
function cellCorners({ data, shape: [rows, columns] }: Part): Uint32Array {
  const corners: number[] = [];
  for (let n = 0; n < rows * columns; n += 1) {
    if (!data[n]) continue;
    const low = n + Math.floor(n / columns);
    const high = low + columns + 1;
    corners.push(low, low + 1, high + 1, low, high + 1, high);
  }
  return Uint32Array.from(corners);
}
