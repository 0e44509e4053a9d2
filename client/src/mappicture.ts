// One picture of a flow on a MapLibre map: a texture of the map's, drawn at the place that it shows.

import type { CustomRenderMethodInput } from "maplibre-gl";
import fragmentShader from "../../shaders/webgl2/map_fragment.glsl";
import vertexShader from "../../shaders/webgl2/map_vertex.glsl";
import type { BareView } from "./bareview.ts";
import { projection, type Camera } from "./camera.ts";
import { mapScale, placeOn, type FlowLook, type Mercator, type Place } from "./mercator.ts";
import type { Programs } from "./programs.ts";
import type { Header } from "./protocol.ts";
import { clamp, subtract, toFrame } from "./vectors.ts";

/** Units along a side of a tile, in MapLibre, and its deepest tiles. */
const TILE_UNITS = 8192;
const DEEPEST_TILE = 22;
/** Pixels of the page along a side of the map at zoom 0. */
const WORLD_PIXELS = 512;
/** Cells along a side of what is drawn on a globe. */
const GLOBE_CELLS: readonly [least: number, most: number] = [64, 256];
/** Pixels of the page by which the middle of a cell may lie below the globe. */
const GLOBE_SAGITTA = 0.25;

/** A picture, and from where it sees the flow. */
interface Shown {
  camera: Camera;
  isComplete: boolean;
}

/** The map of a frame: its programs, an array without attributes, zoom and middle. */
export interface MapFrame extends Pick<CustomRenderMethodInput, "shaderData" | "getProjectionData"> {
  gl: WebGL2RenderingContext;
  programs: Programs;
  array: WebGLVertexArrayObject | null;
  mercator: Mercator;
  zoom: number;
  center: { lng: number; lat: number };
  globe: boolean;
  opacity: number;
  /** Whether it is drawn on the worlds beside the one of the middle as well. */
  isRepeated: boolean;
}

export class MapPicture {
  readonly view: BareView;
  /** Whether it shows some of what the map does. */
  isUsed = false;
  private readonly texture: WebGLTexture | null;
  /** What the texture shows, and what the canvas has in its place. */
  private shown: Shown | null = null;
  private next: Shown | null = null;

  constructor(gl: WebGL2RenderingContext, view: BareView) {
    this.view = view;
    this.texture = gl.createTexture();
  }

  dispose(gl: WebGL2RenderingContext | null): void {
    this.view.dispose();
    gl?.deleteTexture(this.texture);
  }

  /** Look from somewhere, into so many pixels along one of the page; from nowhere where it is not used. */
  follow(look: FlowLook | undefined, ratio: number): void {
    this.isUsed = this.view.isVisible = look !== undefined;
    this.view.shownOn = look?.shownOn ?? null;
    if (look) this.view.look(look.state, look.width, look.height, ratio);
    else this.shown = this.next = null;
  }

  /** The canvas has another picture. */
  painted(isComplete: boolean): void {
    const { camera } = this.view;
    if (camera && this.isUsed) this.next = { camera, isComplete };
  }

  /** Whether the full picture is on the map. */
  get isComplete(): boolean {
    const { view, next, shown } = this;
    return !this.isUsed || (view.sharp && !next && !!shown?.isComplete && !view.tiles?.pending);
  }

  /** Take the picture over that the canvas has. */
  private upload(gl: WebGL2RenderingContext, globe: boolean): void {
    if (!this.next) return;
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, this.view.canvas);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    // Towards the sides of a globe, and its poles, many pixels of the picture lie in one of the map.
    if (globe) gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, globe ? gl.LINEAR_MIPMAP_LINEAR : gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    this.shown = this.next;
    this.next = null;
  }

  /** Draw on the map; gives what is wrong with the program, or whether it can be drawn yet. */
  draw(frame: MapFrame): string | boolean {
    const { gl, programs, mercator, globe } = frame;
    const { vertexShaderPrelude, define } = frame.shaderData;
    const program = programs.get(`${define}\n${vertexShaderPrelude}\n${vertexShader}`, fragmentShader);
    if (!program.ready) return program.error;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    this.upload(gl, globe);
    if (!this.shown) return true;
    const { camera } = this.shown;
    // Counted from a tile near the middle of the picture, which keeps the digits of a close view.
    const z = Math.floor(clamp(frame.zoom, 0, DEEPEST_TILE));
    const middle = mercator.placeOf(camera.state.focal_point);
    const tiles = 2 ** z;
    const tile: Place = [Math.floor(middle[0] * tiles), clamp(Math.floor(middle[1] * tiles), 0, tiles - 1)];
    const world = Math.floor(tile[0] / tiles);
    const canonical = { z, x: tile[0] - world * tiles, y: tile[1] };
    const inTile = (place: Place) => place.map((at, k) => (at * tiles - tile[k]) * TILE_UNITS);
    const [x0, y0, x1, y1] = mercator.box;
    const [low, high] = [[x0, y0], [x1, y1]].map((position) => inTile(mercator.placeOf(position)));
    gl.bindVertexArray(frame.array);
    const cells = globe ? globeCells(frame, Math.max(x1 - x0, y1 - y0) * Math.abs(mercator.slope[0])) : 1;
    // The world in which the middle of the picture lies next to that of the map.
    const nearest = globe ? 0 : Math.round(placeOn(frame.center)[0] - middle[0]);
    let most = 0;
    if (frame.isRepeated && !globe) most = Math.ceil(gl.drawingBufferWidth / (WORLD_PIXELS * 2 ** frame.zoom));
    for (let beside = -most; beside <= most; beside += 1) {
      const tileID = { wrap: world + nearest + beside, canonical };
      const data = frame.getProjectionData({ tileID, applyGlobeMatrix: globe });
      programs.use(program, {
        u_projection_matrix: data.mainMatrix as Float32Array,
        u_projection_fallback_matrix: data.fallbackMatrix as Float32Array,
        u_projection_tile_mercator_coords: data.tileMercatorCoords,
        u_projection_clipping_plane: data.clippingPlane,
        u_projection_transition: data.projectionTransition,
        u_box: [...low, high[0] - low[0], high[1] - low[1]],
        u_mapCells: cells,
        u_flowMatrix: fromTile(this.view.header, camera, mercator, tile, 1 / (tiles * TILE_UNITS)),
        u_flowPicture: 0,
        u_flowPixel: (2 * camera.height) / this.view.canvas.height / (x1 - x0),
        u_repeated: !!this.view.header.ends,
        u_opacity: frame.opacity,
      });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * cells + 2, cells);
    }
    gl.bindVertexArray(null);
    return true;
  }
}

/** Cells along a share of the map's width, which are flat where the globe is round. */
function globeCells({ zoom, center }: MapFrame, share: number): number {
  const around = WORLD_PIXELS * 2 ** zoom * mapScale(center.lat);
  const radius = around / (2 * Math.PI);
  const enough = share * Math.PI * Math.sqrt(radius / (2 * GLOBE_SAGITTA));
  return clamp(Math.ceil(enough), ...GLOBE_CELLS);
}

/** Matrix from a tile, with so much of the map to a unit, to the picture of a camera. */
function fromTile({ geometry }: Header, camera: Camera, mercator: Mercator, tile: Place, unit: number): number[] {
  const { center, frame } = geometry;
  const { focal_point: focus } = camera.state;
  const anchor = toFrame(frame, subtract(focus, center));
  const m = projection(geometry, camera, anchor);
  const sides = [0, 1].map((k) => toFrame(frame, [0, 1].map((n) => (n === k ? unit / mercator.slope[k] : 0)).concat(0)));
  const middle = mercator.placeOf(focus);
  const start = [0, 1].map((k) => (tile[k] * unit * TILE_UNITS - middle[k]) / mercator.slope[k]).concat(0);
  const columns = [...sides, [0, 0, 0], toFrame(frame, start)];
  return columns.flatMap((column, n) =>
    [0, 1, 2, 3].map((row) => column.reduce((sum, x, k) => sum + m[4 * k + row] * x, n === 3 ? m[12 + row] : 0)),
  );
}
