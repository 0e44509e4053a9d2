// A flow as a layer of a MapLibre map, built into flowtex/web/maplibre.js: the package flowtex-maplibre.
//
//   scene (JSON of flowtex.export) --> BareView --> canvas --> texture of the map, drawn where it was seen
//   the map's camera --> Mercator.look --^
//
// A picture lies on the map at the place that it shows, so that it moves with the map until the next one is there.

import type { CustomLayerInterface, CustomRenderMethodInput, Map as MapLibreMap } from "maplibre-gl";
import fragmentShader from "../../shaders/webgl2/map_fragment.glsl";
import vertexShader from "../../shaders/webgl2/map_vertex.glsl";
import { BareView, type BareHost } from "./bareview.ts";
import { projection, type Camera } from "./camera.ts";
import type { ColourChoice } from "./colours.ts";
import { eastNorth } from "./lonlat.ts";
import { Mercator, placeOn, type MapLook, type Place } from "./mercator.ts";
import { pathThrough } from "./pointpath.ts";
import { Programs } from "./programs.ts";
import type { Header, Settings } from "./protocol.ts";
import { Embedded, type PackedScene } from "./sources/embedded.ts";
import { Stream } from "./sources/stream.ts";
import { clamp, subtract, toFrame, type Vector } from "./vectors.ts";

/** Units along a side of a tile, in MapLibre, and its deepest tiles. */
const TILE_UNITS = 8192;
const DEEPEST_TILE = 22;
/** Cells along a side of what is drawn on a globe, and copies of the world beside the one of the middle. */
const GLOBE_CELLS = 64;
const COPIES = 1;
/** Pixels along a side of a picture at most, and as many times more than the map has that it may have: a globe shows
 * what lies beyond its sides, as small as it is there. */
const MOST_PIXELS = 4096;
const MOST_SHARE = 4;

export interface LayerOptions {
  id: string;
  /** Address of the scene that `flowtex.export` has written, or the scene. */
  scene: string | PackedScene;
  /** From 0 to 1; by default that of the scene. */
  opacity?: number;
  /** Settings of the texture, by their names in Python, such as `samples` and `contrast`. */
  settings?: Settings;
  /** The time, or the clock of a steady flow, has gone on. */
  onTime?: (time: number) => void;
}

/** A point of the flow. */
export interface FlowPoint {
  /** Velocity on the Earth, in the unit of the data. */
  eastward: number;
  northward: number;
  /** Values of the scalars, by their names. */
  values: Record<string, number>;
  /** Longitudes and latitudes of the path through the point, downstream. */
  path: [lng: number, lat: number][];
}

/** A picture, and from where it sees the flow. */
interface Shown {
  camera: Camera;
  isComplete: boolean;
}

export class FlowtexLayer implements CustomLayerInterface {
  readonly id: string;
  readonly type = "custom";
  readonly renderingMode = "2d";
  private readonly options: LayerOptions;
  private map: MapLibreMap | null = null;
  private gl: WebGL2RenderingContext | null = null;
  private programs: Programs | null = null;
  private texture: WebGLTexture | null = null;
  private array: WebGLVertexArrayObject | null = null;
  private view: BareView | null = null;
  private mercator: Mercator | null = null;
  /** What the texture shows, and whether the canvas has another picture. */
  private shown: Shown | null = null;
  private next: Shown | null = null;
  /** What the map showed when the picture was last asked for, and whether that was a globe. */
  private look = "";
  private globe = false;
  private shownOpacity = 1;

  constructor(options: LayerOptions) {
    this.options = options;
    this.id = options.id;
  }

  onAdd(map: MapLibreMap, gl: WebGL2RenderingContext): void {
    this.map = map;
    this.gl = gl;
    const context = { context: gl, counted: <T>(made: T | null) => made as T, free: () => undefined };
    this.programs = new Programs(context);
    this.texture = gl.createTexture();
    this.array = gl.createVertexArray();
    [this.shown, this.next, this.look] = [null, null, ""];
    this.open().catch((error: Error) => this.failed(error.message, ""));
  }

  onRemove(): void {
    const { gl } = this;
    this.view?.dispose();
    gl?.deleteTexture(this.texture);
    gl?.deleteVertexArray(this.array);
    this.programs?.dispose();
    this.map = this.gl = this.view = null;
  }

  /** Read the scene, and hand its parts to a view. */
  private async open(): Promise<void> {
    const { scene: given, settings = {} } = this.options;
    const base = new URL(typeof given === "string" ? given : "", location.href).href;
    const scene = typeof given === "string" ? await fetched(base) : given;
    const header = bare(scene.headers[0]);
    const embedded = new Embedded(header, scene.parts.flatMap(([n, info, text]) => (n ? [] : [[info, text]])), new Map(), new Map());
    let isComing = true;
    if (!this.map) return; // the layer has gone
    const view = new BareView(this.host, header, header.store ? new Stream(header, base) : embedded, () => isComing);
    this.view = view;
    view.set(settings);
    this.shownOpacity = this.options.opacity ?? scene.headers[0].opacity;
    for (const part of embedded.parts) {
      const unpacked = await embedded.kept(part);
      if (this.view !== view) return;
      view.setPart(unpacked);
    }
    isComing = false;
    this.mercator = new Mercator(header.earth, view.parts.get("lonlat"));
    view.requests.open();
    this.map?.triggerRepaint();
  }

  private readonly host: BareHost = {
    isHeld: () => this.map?.isMoving() ?? false,
    painted: (isComplete: boolean) => {
      const { view } = this;
      if (!view?.camera) return;
      this.next = { camera: view.camera, isComplete };
      this.map?.triggerRepaint();
    },
    advanced: () => this.options.onTime?.(this.time),
    failed: (problem, detail) => this.failed(problem, detail),
  };

  /** Time of the field, in its own unit, or seconds of the clock of a steady one. */
  get time(): number {
    const { varies = false, time = 0, clock = 0 } = this.view?.player ?? {};
    return varies ? time : clock;
  }

  set time(time: number) {
    this.view?.setTime(time);
  }

  /** Times of the field. */
  get times(): readonly number[] {
    return this.view?.header.slices.times ?? [];
  }

  get opacity(): number {
    return this.shownOpacity;
  }

  set opacity(opacity: number) {
    this.shownOpacity = opacity;
    this.map?.triggerRepaint();
  }

  /** Go on with the time; a steady flow streams. */
  play(): void {
    this.view?.play();
  }

  pause(): void {
    this.view?.pause();
  }

  /** Change settings of the texture, by their names in Python. */
  set(settings: Settings): void {
    this.view?.set(settings);
  }

  /** Colour by another scalar, with another map or range. */
  setColours(choice: Pick<ColourChoice, "scalars" | "cmap" | "clim" | "log_scale">): void {
    this.view?.chooseColours(choice);
  }

  /** What is at a place of the picture; null beside the flow, and before the first picture is complete. */
  pointAt(lngLat: { lng: number; lat: number }): FlowPoint | null {
    const { view, mercator } = this;
    const { earth, geometry } = view?.header ?? {};
    const { camera, parts, settings } = view ?? {};
    if (!view || !mercator || !camera || !earth || !geometry || !settings) return null;
    const at = camera.project([...mercator.positionOf(placeOn(lngLat)), geometry.center[2]]);
    const [found, moment] = [at && view.find(...at), view.painter.shown];
    if (!found || !moment) return null;
    const { point, place, layer } = found;
    const position = point.position as Vector;
    const { path, velocity } = pathThrough({ scene: layer.scene, moment, place, position }, settings, camera, view.rows);
    const [eastward, northward] = eastNorth(earth, position, velocity, parts?.get("lonlat"));
    return { eastward, northward, values: point.values, path: path.map((each) => mercator.lngLatOf(each)) };
  }

  private failed(problem: string, detail: string): void {
    this.map?.fire("error", { error: new Error([problem, detail].filter(Boolean).join(" ")) });
  }

  render(gl: WebGL2RenderingContext, args: CustomRenderMethodInput): void {
    const { map, view, mercator } = this;
    if (!map || !view || !mercator) return;
    const globe = args.defaultProjectionData.projectionTransition > 0;
    this.follow(map, view, mercator, globe);
    this.upload(gl, view);
    if (this.shown) this.draw(gl, args, view.header, mercator, this.shown.camera, globe);
  }

  /** Look at what the map shows now. */
  private follow(map: MapLibreMap, view: BareView, mercator: Mercator, globe: boolean): void {
    const { what, ratio, text } = lookOf(map, globe);
    if (text === this.look) return;
    this.look = text;
    this.globe = globe;
    const { state, width: wide, height: high } = mercator.look(what, view.header.geometry.center[2]);
    const most = Math.sqrt((MOST_SHARE * what.width * what.height) / (wide * high));
    view.look(state, wide, high, Math.min(ratio, ratio * most, MOST_PIXELS / Math.max(wide, high)));
  }

  /** Take the picture over that the canvas has. */
  private upload(gl: WebGL2RenderingContext, view: BareView): void {
    if (!this.next) return;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true);
    gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, true);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, view.canvas);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    for (const size of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, size, gl.LINEAR);
    this.shown = this.next;
    this.next = null;
  }

  private draw(
    gl: WebGL2RenderingContext,
    { shaderData, getProjectionData }: CustomRenderMethodInput,
    header: Header,
    mercator: Mercator,
    camera: Camera,
    globe: boolean,
  ): void {
    const { vertexShaderPrelude, define } = shaderData;
    const program = this.programs?.get(`${define}\n${vertexShaderPrelude}\n${vertexShader}`, fragmentShader);
    if (program?.error) this.failed("The flow cannot be drawn on the map.", program.error);
    if (!program?.ready) return this.map?.triggerRepaint();
    // Counted from a tile near the middle of the picture, which keeps the digits of a close view.
    const z = Math.floor(clamp(this.map?.getZoom() ?? 0, 0, DEEPEST_TILE));
    const middle = mercator.placeOf(camera.state.focal_point);
    const tiles = 2 ** z;
    const tile = middle.map((at, k) => clamp(Math.floor(at * tiles), k ? 0 : -Infinity, k ? tiles - 1 : Infinity)) as Place;
    const wrap = Math.floor(tile[0] / tiles);
    const canonical = { z, x: tile[0] - wrap * tiles, y: tile[1] };
    const inTile = (place: Place) => place.map((at, k) => (at * tiles - tile[k]) * TILE_UNITS);
    const [x0, y0, x1, y1] = mercator.box;
    const [low, high] = [[x0, y0], [x1, y1]].map((position) => inTile(mercator.placeOf(position)));
    gl.bindVertexArray(this.array);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    const cells = globe ? GLOBE_CELLS : 1;
    for (let copy = globe ? 0 : -COPIES; copy <= (globe ? 0 : COPIES); copy += 1) {
      const data = getProjectionData({ tileID: { wrap: wrap + copy, canonical }, applyGlobeMatrix: globe });
      this.programs?.use(program, {
        u_projection_matrix: data.mainMatrix as Float32Array,
        u_projection_fallback_matrix: data.fallbackMatrix as Float32Array,
        u_projection_tile_mercator_coords: data.tileMercatorCoords,
        u_projection_clipping_plane: data.clippingPlane,
        u_projection_transition: data.projectionTransition,
        u_box: [...low, high[0] - low[0], high[1] - low[1]],
        u_mapCells: cells,
        u_flowMatrix: fromTile(header, camera, mercator, tile, 1 / (tiles * TILE_UNITS)),
        u_flowPicture: 0,
        u_opacity: this.opacity,
      });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 2 * cells + 2, cells);
    }
    gl.bindVertexArray(null);
  }

  /** Whether the full picture of what the map shows is on it. */
  get isComplete(): boolean {
    const { map, view } = this;
    if (!map || !view?.sharp || this.next || view.tiles?.pending) return false;
    return !!this.shown?.isComplete && this.look === lookOf(map, this.globe).text;
  }
}

/** What a map shows, pixels along one of the page, and all of it as a text. */
function lookOf(map: MapLibreMap, globe: boolean): { what: MapLook; ratio: number; text: string } {
  const { clientWidth: width, clientHeight: height } = map.getCanvas();
  const what = {
    center: map.unproject([width / 2, height / 2]),
    width,
    height,
    zoom: map.getZoom(),
    bearing: map.getBearing(),
    pitch: map.getPitch(),
    fov: map.getVerticalFieldOfView(),
    globe,
  };
  const ratio = map.getPixelRatio();
  return { what, ratio, text: JSON.stringify([what, ratio]) };
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

async function fetched(address: string): Promise<PackedScene> {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`the scene ${address} cannot be read: the server answers ${answer.status}`);
  return (await answer.json()) as PackedScene;
}

/** A header of what lies on a map: coasts and land are the map's. */
function bare(header: Header): Header {
  const { earth } = header;
  const none = { land: null, coastlines: false, graticule: false };
  return { ...header, background: [0, 0, 0], opacity: 1, earth: earth && { ...earth, ...none } };
}
