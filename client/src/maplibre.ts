// A flow as a layer of a MapLibre map, built into flowtex/host/static/maplibre.js: the package flowtex-maplibre.
//
//   scene (JSON of flowtex.export) --> BareView --> canvas --> MapPicture, a texture of the map
//   the map's camera --> Mercator.look --^
//
// A picture lies on the map at the place that it shows, so that it moves with the map until the next one is there.
// Where the map shows both ends of data around the Earth there are two of them.

import type { CustomLayerInterface, CustomRenderMethodInput, Map as MapLibreMap } from "maplibre-gl";
import { BareView, type BareHost } from "./bareview.ts";
import { velocityOnEarth } from "./onearth.ts";
import { MapPicture } from "./mappicture.ts";
import { Mercator, placeOn, type MapLook } from "./mercator.ts";
import { Player } from "./player.ts";
import { pathThrough } from "./pointpath.ts";
import { Programs } from "./programs.ts";
import type { Header } from "./protocol.ts";
import { Embedded, type PackedScene } from "./sources/embedded.ts";
import { Stream } from "./sources/stream.ts";
import type { Vector } from "./vectors.ts";

/** Pixels along a side of a picture at most, and as many times more than the map has that it may have: a globe shows
 * what lies beyond its sides, as small as it is there. */
const MOST_PIXELS = 4096;
const MOST_SHARE = 4;
/** The view in which points are looked up: its pixels, and half its height in cells of the finest level. */
const CLOSE_PIXELS = 32;
const CLOSE_CELLS = 0.25;
/** Milliseconds for which a point waits for its tile. */
const PATIENCE_MS = 10_000;

// The declarations of what is public name no type of other modules: they are one file of the package.

/** Settings of the texture, by their names in Python, such as `samples` and `contrast`. */
export type FlowSettings = Record<string, boolean | number | string>;

/** A scalar by its name, or one colour; a colour map, its range, and whether that is logarithmic. */
export interface FlowColours {
  scalars?: string | false;
  cmap?: string;
  clim?: [least: number, most: number] | "robust" | null;
  log_scale?: boolean;
}

export interface LayerOptions {
  id: string;
  /** Address of the scene that `flowtex.export` has written, or the scene. */
  scene: string | object;
  /** From 0 to 1; by default that of the scene. */
  opacity?: number;
  settings?: FlowSettings;
  /** The scene is here, so that its times and bounds are known. */
  onOpen?: () => void;
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

/** What all pictures of a layer show. */
interface Scene {
  header: Header;
  settings: FlowSettings;
  player: Player;
  mercator: Mercator;
  add(): Promise<BareView>;
  /** Make a view, and give it the parts that are known. */
  make(host: BareHost, taken: (view: BareView) => void): Promise<BareView>;
}

export class FlowtexLayer implements CustomLayerInterface {
  readonly id: string;
  readonly type = "custom";
  readonly renderingMode = "2d";
  private readonly options: LayerOptions;
  private map: MapLibreMap | null = null;
  private gl: WebGL2RenderingContext | null = null;
  private programs: Programs | null = null;
  private array: WebGLVertexArrayObject | null = null;
  private scene: Scene | null = null;
  private pictures: MapPicture[] = [];
  /** What the map showed when pictures were last asked for, and whether that was a globe. */
  private look = "";
  private globe = false;
  private shownOpacity = 1;
  /** The view in which points are looked up, and the last one that is being looked up. */
  private close: Promise<BareView> | null = null;
  private asked: Promise<FlowPoint | null> = Promise.resolve(null);
  /** Settings and colours that were chosen, also before the scene is here. */
  private readonly own: FlowSettings;
  private readonly colours: FlowColours = {};

  constructor(options: LayerOptions) {
    this.options = options;
    this.own = { ...options.settings };
    this.id = options.id;
  }

  onAdd(map: MapLibreMap, gl: WebGL2RenderingContext): void {
    this.onRemove(); // a map that has lost its context forgets a layer without a word
    this.map = map;
    this.gl = gl;
    const context = { context: gl, counted: <T>(made: T | null) => made as T, free: () => undefined };
    this.programs = new Programs(context);
    this.array = gl.createVertexArray();
    this.open(gl).catch((error: Error) => this.failed(error.message, ""));
  }

  onRemove(): void {
    const { gl } = this;
    for (const picture of this.pictures) picture.dispose(gl);
    void this.close?.then((view) => view.dispose());
    this.close = null;
    gl?.deleteVertexArray(this.array);
    this.programs?.dispose();
    this.map = this.gl = this.scene = null;
    [this.pictures, this.look] = [[], ""];
  }

  /** Read the scene, and have a first picture of it. */
  private async open(gl: WebGL2RenderingContext): Promise<void> {
    const { scene: given, opacity } = this.options;
    const base = new URL(typeof given === "string" ? given : "", location.href).href;
    const { headers, parts } = typeof given === "string" ? await fetched(base) : (given as PackedScene);
    if (this.gl !== gl) return; // the layer has gone
    const header = bare(headers[0]);
    const embedded = new Embedded(header, parts.flatMap(([n, info, text]) => (n ? [] : [[info, text]])), new Map(), new Map());
    const source = header.store ? new Stream(header, base) : embedded;
    const shared = { header, settings: { ...header.settings, ...header.own, ...this.own }, player: new Player() };
    this.shownOpacity = opacity ?? headers[0].opacity;
    const make: Scene["make"] = async (host, taken) => {
      let isComing = true;
      const view = new BareView(host, { ...shared, source, isComing: () => isComing });
      taken(view);
      for (const part of embedded.parts) {
        const unpacked = await embedded.kept(part);
        if (view.lifetime.isOver) break; // the layer has gone
        view.setPart(unpacked);
      }
      isComing = false;
      if (Object.keys(this.colours).length) view.chooseColours(this.colours);
      return view;
    };
    const add = () => {
      let picture: MapPicture | null = null;
      return make(this.hostOf(() => picture), (view) => this.pictures.push((picture = new MapPicture(gl, view))));
    };
    const view = await add();
    if (this.gl !== gl) return;
    this.scene = { ...shared, add, make, mercator: new Mercator(header.earth, view.parts.get("lonlat"), header.ends) };
    view.requests.open();
    this.options.onOpen?.();
    this.map?.triggerRepaint();
  }

  private readonly hostOf = (picture: () => MapPicture | null): BareHost => ({
    isHeld: () => this.map?.isMoving() ?? false,
    painted: (isComplete) => {
      picture()?.painted(isComplete);
      this.map?.triggerRepaint();
    },
    advanced: () => this.options.onTime?.(this.time),
    failed: (problem, detail) => this.failed(problem, detail),
  });

  /** Time of the field, in its own unit, or seconds of the clock of a steady one. */
  get time(): number {
    const { varies = false, time = 0, clock = 0 } = this.scene?.player ?? {};
    return varies ? time : clock;
  }

  set time(time: number) {
    const { player } = this.scene ?? {};
    if (player?.varies) player.seek(time);
    else if (player) player.clock = time;
    this.change();
  }

  /** Times of the field. */
  get times(): readonly number[] {
    return this.scene?.header.slices.times ?? [];
  }

  /** Longitudes and latitudes of two corners of the data; null before the scene is here. */
  get bounds(): [[west: number, south: number], [east: number, north: number]] | null {
    const { mercator } = this.scene ?? {};
    if (!mercator) return null;
    const { box } = mercator;
    return [mercator.lngLatOf(box.slice(0, 2)), mercator.lngLatOf(box.slice(2))];
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
    const { player, settings } = this.scene ?? {};
    if (!player || !settings) return;
    if (!player.varies && settings.motion === "off") settings.motion = "speed";
    player.start();
    this.change();
  }

  pause(): void {
    if (this.scene) this.scene.player.playing = false;
    this.change();
  }

  /** Change settings of the texture, by their names in Python. */
  set(settings: FlowSettings): void {
    Object.assign(this.own, settings);
    Object.assign(this.scene?.settings ?? {}, settings);
    this.change();
  }

  /** Colour by another scalar, with another map or range. */
  setColours(choice: FlowColours): void {
    Object.assign(this.colours, choice);
    for (const { view } of this.pictures) view.chooseColours(choice);
  }

  private change(): void {
    for (const { view } of this.pictures) view.change();
  }

  /** What is at a place, at every zoom; null beside the flow. */
  async pointAt(lngLat: { lng: number; lat: number }): Promise<FlowPoint | null> {
    const { mercator, header } = this.scene ?? {};
    if (!mercator || !header) return null;
    const place: Vector = [...mercator.positionOf(placeOn(lngLat)), header.geometry.center[2]];
    const views = this.pictures.filter(({ isUsed }) => isUsed).map(({ view }) => view);
    await until(() => views.every(({ painter }) => painter.canPick && painter.shown));
    // The path is that of the picture; it is as long as the map's scale allows.
    const shown = views.map((view) => this.pointIn(view, place)).find(Boolean) ?? null;
    if (shown && !header.pyramid) return shown;
    this.asked = this.asked.then(() => this.pointClose(place)).catch(() => null);
    const found = await this.asked;
    return found && { ...found, path: shown?.path ?? found.path };
  }

  /** What a view shows at a place. */
  private pointIn(view: BareView, place: Vector): FlowPoint | null {
    const { camera, parts, settings } = view;
    const { mercator } = this.scene ?? {};
    const at = camera?.project(place) ?? [2, 2];
    const found = Math.max(...at.map(Math.abs)) > 1 ? null : view.find(at[0], at[1]);
    const moment = view.painter.shown;
    if (!mercator || !camera || !found || !moment) return null;
    const position = found.point.position as Vector;
    const through = { scene: found.layer.scene, moment, place: found.place, position };
    const [eastward, northward] = velocityOnEarth(through, parts.get("lonlat")) ?? [NaN, NaN];
    const { path } = pathThrough(through, settings, camera, view.rows);
    return { eastward, northward, values: found.point.values, path: path.map((each) => mercator.lngLatOf(each)) };
  }

  /** What the finest level has at a place, for which its tile is requested. */
  private async pointClose(place: Vector): Promise<FlowPoint | null> {
    const { scene } = this;
    if (!scene) return null;
    const host = { ...this.hostOf(() => null), painted: () => undefined, advanced: () => undefined };
    const view = await (this.close ??= scene.make(host, (made) => made.requests.open()));
    const { box } = scene.mercator;
    const { pyramid, geometry } = scene.header;
    const half = (CLOSE_CELLS * (box[2] - box[0])) / (pyramid?.shapes[0] ?? geometry.shape)[1];
    const [x, y, z] = place;
    const state = { up: [0, 1, 0], view_angle: 30, position: [x, y, z + half], focal_point: place, parallel: true, parallel_scale: half };
    view.isVisible = true;
    view.look(state, CLOSE_PIXELS, CLOSE_PIXELS, 1);
    await until(() => !view.isNew && view.painter.canPick && !view.tiles?.pending && !view.tiles?.missing.length);
    view.isVisible = false;
    return this.pointIn(view, place);
  }

  private failed(problem: string, detail: string): void {
    this.map?.fire("error", { error: new Error([problem, detail].filter(Boolean).join(" ")) });
  }

  render(gl: WebGL2RenderingContext, args: CustomRenderMethodInput): void {
    const { map, scene, programs, array, opacity } = this;
    if (!map || !scene || !programs) return;
    const globe = args.defaultProjectionData.projectionTransition > 0;
    this.follow(map, scene, globe);
    const [zoom, center] = [map.getZoom(), map.getCenter()];
    const used = this.pictures.filter(({ isUsed }) => isUsed);
    const { shaderData, getProjectionData } = args;
    const frame = { gl, programs, array, shaderData, getProjectionData, zoom, center, globe, opacity };
    for (const picture of used) {
      const done = picture.draw({ ...frame, mercator: scene.mercator, isRepeated: used.length === 1 });
      if (typeof done === "string" && done) this.failed("The flow cannot be drawn on the map.", done);
      else if (done !== true) map.triggerRepaint();
    }
  }

  /** Look at what the map shows now. */
  private follow(map: MapLibreMap, { mercator, header, add }: Scene, globe: boolean): void {
    const { what, ratio, text } = lookOf(map, globe);
    if (text === this.look) return;
    const looks = mercator.look(what, header.geometry.center[2]);
    if (looks.length > this.pictures.length) void add();
    [0, 1].forEach((n) => {
      const { width = 1, height = 1 } = looks[n] ?? {};
      const most = Math.sqrt((MOST_SHARE * what.width * what.height) / (width * height));
      this.pictures[n]?.follow(looks[n], Math.min(ratio, ratio * most, MOST_PIXELS / Math.max(width, height)));
    });
    this.look = text;
    this.globe = globe;
  }

  /** Whether the full picture of what the map shows is on it. */
  get isComplete(): boolean {
    const { map, pictures } = this;
    if (!map || !this.scene || !pictures.every((picture) => picture.isComplete)) return false;
    return this.look === lookOf(map, this.globe).text;
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

/** Wait for something, for some time. */
async function until(isSo: () => unknown): Promise<void> {
  const last = performance.now() + PATIENCE_MS;
  while (!isSo() && performance.now() < last) await new Promise(requestAnimationFrame);
}

async function fetched(address: string): Promise<PackedScene> {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`the scene ${address} cannot be read: the server answers ${answer.status}`);
  return (await answer.json()) as PackedScene;
}

/** A header of what lies on a map: coasts and land are the map's, which shows what goes around the Earth many times. */
function bare(header: Header): Header {
  const { earth } = header;
  const none = { land: null, coastlines: false, graticule: false };
  return { ...header, ends: endsOf(header), background: [0, 0, 0], opacity: 1, earth: earth && { ...earth, ...none } };
}

/** Where a map ends that goes around the Earth; null for others. */
function endsOf({ earth, geometry, slices }: Header): Header["ends"] {
  const { map } = earth ?? {};
  if (!earth || !map || !geometry.periodic[1]) return null;
  // The box of the map is a little larger.
  const middle = 0.5 * (map[0] + map[2]);
  const half = 0.5 * (slices.trace?.offset[3] ?? 2 * Math.PI * earth.radius);
  return [middle - half, middle + half];
}
