// What stands beside the flow: meshes, lines and points in colours of their own, and labels.

import { projection, type Camera } from "./camera.ts";
import type { Graphics } from "./context.ts";
import type { EarthView } from "./earthlayer.ts";
import type { Program } from "./programs.ts";
import type { BodiesHeader, Data, Header, Part } from "./protocol.ts";
import { add, scale, subtract, toFrame, type Vector } from "./vectors.ts";

/** Names of the arrays, of vertices, triangles and pieces of lines. */
export const BODY_PARTS = ["bodyPoints", "bodyNormals", "bodyColours", "bodyFaces", "bodyPieces"];
/** Lights that the shader has. */
const LIGHTS = 8;
/** Bytes of two points, and of two colours, of a piece of a line. */
const [ENDS_BYTES, COLOURS_BYTES] = [24, 8];
/** How much farther triangles of the flow, and of bodies, lie than lines in the same place. */
const BEHIND: [flow: number, faces: number] = [1, 2];
/** Room around a label's letters, in their height. */
const PLATE_MARGIN = 0.2;

type Run = BodiesHeader["runs"][number];

interface Drawn {
  faces: WebGLVertexArrayObject;
  pieces: WebGLVertexArrayObject;
  ends: WebGLBuffer;
  colours: WebGLBuffer;
  buffers: WebGLBuffer[];
}

/** Values of both ends of pieces, one after the other. */
export function atEnds<T extends Data>(values: T, pieces: ArrayLike<number>, size: number): T {
  const Type = values.constructor as new (count: number) => T;
  const ends = new Type(size * pieces.length);
  for (let n = 0; n < pieces.length; n += 1) {
    for (let k = 0; k < size; k += 1) ends[size * n + k] = values[size * pieces[n] + k];
  }
  return ends;
}

/** Ways to the lights in the surface's own frame, and their colours. */
export function lightUniforms({ geometry, bodies }: Header, camera: Camera) {
  const [right, up, ahead] = camera.axes;
  const lights = (bodies?.lights ?? []).slice(0, LIGHTS);
  const ways = lights.map(({ way, turns }) => {
    const turned = add(add(scale(right, way[0]), up, way[1]), ahead, -way[2]);
    return toFrame(geometry.frame, turns ? turned : (way as Vector));
  });
  const padded = (vectors: number[][]) =>
    Float32Array.from({ length: 3 * LIGHTS }, (_, n) => vectors.flat()[n] ?? 0);
  return { u_lightWays: padded(ways), u_lightColours: padded(lights.map(({ color }) => color)) };
}

export class Bodies {
  private readonly graphics: Graphics;
  private readonly header: Header;
  private readonly parts: ReadonlyMap<string, Part>;
  private drawn: Drawn | null = null;

  constructor(graphics: Graphics, header: Header, parts: ReadonlyMap<string, Part>) {
    this.graphics = graphics;
    this.header = header;
    this.parts = parts;
  }

  get labels(): BodiesHeader["labels"] {
    return this.header.bodies?.labels ?? [];
  }

  private get runs(): Run[] {
    const { bodies } = this.header;
    return bodies && BODY_PARTS.every((name) => this.parts.has(name)) ? bodies.runs : [];
  }

  /** Whether something is seen through the flow. */
  get areBehind(): boolean {
    return this.runs.length > 0 && this.header.opacity < 1;
  }

  /** Programs of triangles, of pieces of lines, and for the pointer, which may not be ready yet. */
  private get programs(): [faces: Program, pieces: Program, hiding: Program] {
    const { programs } = this.graphics;
    const { bodyVertex, bodyFragment, lineVertex, lineFragment } = this.header.shaders;
    return [
      programs.get(bodyVertex, bodyFragment),
      programs.get(lineVertex, lineFragment, "FLOWTEX_BODY"),
      programs.get(bodyVertex, bodyFragment, "FLOWTEX_HIDING"),
    ];
  }

  get isReady(): boolean {
    return !this.runs.length || this.programs.every(({ ready }) => ready);
  }

  dispose(): void {
    const { drawn, graphics } = this;
    if (!drawn) return;
    for (const buffer of drawn.buffers) graphics.free("Buffer", buffer);
    graphics.free("VertexArray", drawn.faces);
    graphics.free("VertexArray", drawn.pieces);
    this.drawn = null;
  }

  /** Draw the flow, through which what lies behind it may be seen. */
  seeThrough(draw: () => void, mixes = this.areBehind): void {
    if (!this.runs.length) return draw();
    const gl = this.graphics.context;
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(BEHIND[0], BEHIND[0]);
    if (mixes) {
      gl.enable(gl.BLEND);
      gl.blendColor(0, 0, 0, this.header.opacity);
      gl.blendFuncSeparate(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA, gl.ZERO, gl.ONE);
    }
    draw();
    gl.disable(gl.BLEND);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  /** Draw those that hide what lies behind, or those that do not, which the flow has to be there for. */
  draw({ camera, anchor, width, height, ratio }: EarthView, kind: "opaque" | "clear"): void {
    const isClear = kind === "clear";
    const runs = this.runs.filter(({ clear }) => clear === isClear);
    if (!runs.length) return;
    const { header, graphics } = this;
    const { geometry } = header;
    const gl = graphics.context;
    const [faces, pieces] = this.programs;
    const drawn = (this.drawn ??= this.make());
    const matrix = projection(geometry, camera, anchor);
    const [x, y, z, w] = camera.eye;
    const eye = toFrame(geometry.frame, subtract([x, y, z], scale(geometry.center, w)));
    if (isClear) {
      gl.enable(gl.BLEND);
      gl.blendFuncSeparate(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA, gl.ZERO, gl.ONE);
      gl.depthMask(false);
    }
    graphics.programs.use(faces, {
      u_matrix: matrix,
      u_anchor: anchor,
      u_eye: [...subtract(eye, scale(anchor, w)), w],
      ...lightUniforms(header, camera),
    });
    gl.bindVertexArray(drawn.faces);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(BEHIND[1], BEHIND[1]);
    for (const { faces: [first, count], ambient, diffuse } of runs) {
      if (!count) continue;
      graphics.programs.use(faces, { u_ambient: ambient, u_diffuse: diffuse });
      gl.drawElements(gl.TRIANGLES, 3 * count, gl.UNSIGNED_INT, 12 * first);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    const around = { u_matrix: matrix, u_anchor: anchor, u_picture: [width, height], u_horizon: [0, 0, 0, 1] };
    graphics.programs.use(pieces, around);
    gl.bindVertexArray(drawn.pieces);
    for (const { pieces: [first, count], width: thickness } of runs) {
      if (!count) continue;
      graphics.programs.use(pieces, { u_width: thickness * ratio });
      for (const [buffer, size, type, bytes, at] of [
        [drawn.ends, 3, gl.FLOAT, ENDS_BYTES, 0],
        [drawn.colours, 4, gl.UNSIGNED_BYTE, COLOURS_BYTES, 2],
      ] as const) {
        gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
        for (const end of [0, 1]) {
          gl.vertexAttribPointer(at + end, size, type, size === 4, bytes, bytes * (first + end / 2));
        }
      }
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
    }
    gl.bindVertexArray(null);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  /** Hide from the pointer what lies behind opaque faces. */
  hide(matrix: readonly number[], anchor: Vector): void {
    const { runs, graphics } = this;
    if (!runs.length) return;
    const gl = graphics.context;
    const drawn = (this.drawn ??= this.make());
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(BEHIND[1], BEHIND[1]);
    graphics.programs.use(this.programs[2], { u_matrix: matrix, u_anchor: anchor });
    gl.bindVertexArray(drawn.faces);
    for (const { faces: [first, count], clear } of runs) {
      if (!clear) gl.drawElements(gl.TRIANGLES, 3 * count, gl.UNSIGNED_INT, 12 * first);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindVertexArray(null);
  }

  /** Write the labels at their points, above all else. */
  drawLabels(pen: CanvasRenderingContext2D, { camera, anchor, width, height, ratio }: EarthView): void {
    const { geometry } = this.header;
    const m = projection(geometry, camera, anchor);
    for (const { text, position, size, color, plate } of this.labels) {
      const p = subtract(toFrame(geometry.frame, subtract(position, geometry.center)), anchor);
      const [x, y, , w] = [0, 1, 2, 3].map((k) => m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2] + m[12 + k]);
      if (w <= 0) continue;
      const [left, bottom] = [(0.5 + (0.5 * x) / w) * width, (0.5 - (0.5 * y) / w) * height];
      const letters = size * ratio;
      const margin = PLATE_MARGIN * letters;
      pen.font = `600 ${letters}px system-ui, sans-serif`;
      pen.textBaseline = "middle";
      const [wide, high] = [pen.measureText(text).width + 2 * margin, letters + 2 * margin];
      pen.fillStyle = css(plate);
      pen.beginPath();
      pen.roundRect(left, bottom - high, wide, high, margin);
      pen.fill();
      pen.fillStyle = css(color);
      pen.fillText(text, left + margin, bottom - 0.5 * high);
    }
  }

  private make(): Drawn {
    const { graphics, parts } = this;
    const gl = graphics.context;
    const [points, normals, colours, corners, pieces] = BODY_PARTS.map((name) => parts.get(name)?.data ?? []) as Data[];
    const array = () => {
      const made = graphics.counted(gl.createVertexArray());
      gl.bindVertexArray(made);
      return made;
    };
    const buffer = (data: Data, target: number = gl.ARRAY_BUFFER) => {
      const made = graphics.counted(gl.createBuffer());
      gl.bindBuffer(target, made);
      gl.bufferData(target, data as AllowSharedBufferSource, gl.STATIC_DRAW);
      return made;
    };
    const faces = array();
    const own = [[points, 3, gl.FLOAT], [normals, 3, gl.BYTE], [colours, 4, gl.UNSIGNED_BYTE]] as const;
    const buffers = own.map(([data, size, type], n) => {
      const made = buffer(data);
      gl.enableVertexAttribArray(n);
      gl.vertexAttribPointer(n, size, type, type !== gl.FLOAT, 0, 0);
      return made;
    });
    buffers.push(buffer(corners, gl.ELEMENT_ARRAY_BUFFER));
    const lines = array();
    const ends = buffer(atEnds(points, pieces, 3));
    const paints = buffer(atEnds(colours, pieces, 4));
    for (let n = 0; n < 4; n += 1) {
      gl.enableVertexAttribArray(n);
      gl.vertexAttribDivisor(n, 1);
    }
    gl.bindVertexArray(null);
    return { faces, pieces: lines, ends, colours: paints, buffers: [...buffers, ends, paints] };
  }
}

function css([r, g, b, opacity = 1]: number[]): string {
  return `rgb(${[r, g, b].map((c) => Math.round(255 * c)).join(" ")} / ${opacity})`;
}
