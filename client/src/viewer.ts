// One scene in an element.
//
//   header, parts --> Viewer --> Scene (buffers, textures) --> Graphics (context, programs) --> canvas
//                       |          uniforms() of header, settings and view
//                     Camera, Player, Panel (what is seen around the picture), Pointers

import { coloursOf, recoloured, type ColourChoice } from "./colours.ts";
import { copyOf, isSamePlace, type Camera, type CameraState } from "./camera.ts";
import { FRAME_MS, sharedGraphics, type Graphics, type User } from "./context.ts";
import { groundAt } from "./earthlayer.ts";
import { HeldParts } from "./heldparts.ts";
import { Lifetime } from "./lifetime.ts";
import type { Options } from "./options.ts";
import { Panel } from "./panel.ts";
import { pickedPoint, type Found, type Point } from "./picking.ts";
import { Player } from "./player.ts";
import { PointCard } from "./pointcard.ts";
import { Pointers } from "./pointers.ts";
import { ProgressiveRenderer } from "./progressive.ts";
import {
  EARTH_LINES,
  FORMAT,
  tilePart,
  type Header,
  type NamedPart,
  type Settings,
  type Value,
} from "./protocol.ts";
import { CARD_PRICE_MS } from "./quality.ts";
import { Scene } from "./scene.ts";
import { Requests } from "./sources/source.ts";
import { Tiles } from "./tiles.ts";
import type { Program } from "./programs.ts";
import { isNear, variantOf, type Moment, type ViewState } from "./uniforms.ts";
import type { Vector } from "./vectors.ts";
import { placedCamera, viewState } from "./viewstate.ts";

/** For which a view that was moved, or data that have changed, count as changing. */
const [STILL_MS, STEADY_MS] = [160, 400];

const isEqual = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);

export class Viewer implements User {
  readonly options: Options;
  readonly requests: Requests;
  readonly graphics: Graphics = sharedGraphics();
  readonly lifetime = new Lifetime();
  readonly player = new Player();
  readonly root = document.createElement("div");
  /** What the picture fills. */
  readonly stage = document.createElement("div");
  readonly canvas = document.createElement("canvas");
  readonly card: PointCard = new PointCard(this);
  readonly panel: Panel;
  readonly pointers: Pointers;
  readonly held = new HeldParts(this.graphics);
  readonly parts = this.held.all;
  header: Header | null = null;
  settings: Settings = {};
  scene: Scene | null = null;
  tiles: Tiles | null = null;
  camera: Camera | null = null;
  /** Whether the full picture is shown. */
  sharp = false;
  isVisible = true;
  shown: Moment | null = null;
  /** The views that stand beside each other. */
  together: Viewer[] = [this];
  private readonly renderer: ProgressiveRenderer;
  private busyUntil = 0;
  /** Whether the host has drawn what it was last asked for. */
  private isPainted = true;
  /** The camera that the scene came with, and the one that looks at it where that is another one. */
  private firstCamera: CameraState | null = null;
  private keptCamera: CameraState | null = null;
  /** Steps that the player goes on to. */
  private next: number[] = [];

  constructor(element: HTMLElement, options: Options = {}) {
    this.options = options;
    this.requests = new Requests(options.source ?? null, this);
    const { root } = this;
    root.className = "flowtex";
    root.tabIndex = 0;
    // For hosts: whether the picture is the full one, the number of full ones so far, and of tiles and of
    // parts of the present time that are not there yet.
    Object.assign(root.dataset, { sharp: "false", frames: "0", tiles: "0", lacking: "0" });
    // JupyterLab has shortcuts of its own for the keys that move the view.
    root.setAttribute("data-lm-suppress-shortcuts", "true");
    root.setAttribute("role", "application");
    this.renderer = new ProgressiveRenderer(this);
    this.panel = new Panel(this);
    element.append(root);
    this.pointers = new Pointers(this);
    this.graphics.users.add(this);
    this.observe();
    if (!this.graphics.gl && !options.streamed) this.panel.failWithout();
  }

  private observe(): void {
    const { lifetime, root } = this;
    lifetime.observe(new ResizeObserver(() => this.panel.arrange()), root);
    lifetime.observe(new ResizeObserver(() => this.resize()), this.stage);
    const seen = new IntersectionObserver((entries) => {
      this.isVisible = entries[entries.length - 1].isIntersecting;
      if (this.isVisible) this.request();
    });
    lifetime.observe(seen, root);
    lifetime.listen(document, "visibilitychange", () => this.request());
    // The ratio changes when the window goes to another screen or is zoomed.
    lifetime.listen(window, "resize", () => this.resize());
  }

  /** What is still held, for tests. */
  stats() {
    const { objects, users } = this.graphics;
    return { ...this.lifetime.stats(), objects, users: users.size, frames: this.renderer.frames };
  }

  dispose(): void {
    if (this.lifetime.isOver) return;
    this.player.playing = false;
    this.lifetime.end();
    this.requests.stop();
    this.tiles?.dispose();
    this.tiles = null;
    this.scene?.dispose();
    this.scene = null;
    this.held.clear();
    this.graphics.leave(this);
    this.renderer.dispose();
    this.root.remove();
  }

  /** Draw another scene, from where it says or from the camera that there is. */
  setHeader(header: Header, keepsCamera = false): void {
    if (header.format !== FORMAT) {
      const fault = `The scene has format ${header.format}, and this client reads format ${FORMAT}.`;
      return this.panel.fail(fault, "Use the client of the flowtex that made the scene.");
    }
    this.requests.stop();
    const old = this.header;
    const isSame = old?.generation !== undefined && old.generation === header.generation;
    if (isSame) return this.recolour(coloursOf(header));
    if (old) this.holdDraft(STEADY_MS);
    this.header = header;
    this.settings = { ...header.settings, ...header.own };
    this.player.setHeader(header);
    this.requests.setHeader(header);
    this.makeScene(header);
    const isElsewhere = !old || !isSamePlace(old.geometry, header.geometry);
    if (isElsewhere) {
      this.keptCamera = old && keepsCamera ? this.cameraState : null;
      [this.firstCamera, this.camera] = [this.keptCamera ? null : header.camera, null];
    }
    if (old && old.generation !== header.generation) {
      // What is the same at all times is sent again only where it differs.
      this.held.clear((name) => (isElsewhere && !keepsCamera) || name.includes("/"));
    }
    this.panel.build();
    this.resize(); // at once, so that no picture is drawn in the size without the bar
    this.change();
  }

  /** Draw the same arrays in other colours, of which a part of the header tells. */
  recolour(colours: Partial<Header>): void {
    if (!this.header) return;
    Object.assign(this.header, colours);
    for (const name of ["scalars", "mesh"]) this.scene?.forget(name);
    this.tiles?.recolour(colours);
    this.panel.showLegend();
    this.change();
  }

  /** Colour as a person chooses, or ask the host to. */
  chooseColours(choice: ColourChoice): void {
    if (this.options.onColours) return this.options.onColours(choice);
    for (const viewer of this.together) {
      if (!viewer.header) continue;
      const { colours, part } = recoloured(viewer.header, choice, viewer.parts);
      if (part) viewer.setPart(part);
      viewer.recolour(colours);
    }
  }

  private makeScene(header: Header): void {
    this.tiles?.dispose();
    this.scene?.dispose();
    if (this.options.streamed) return;
    this.scene = new Scene(this.graphics, header, this.parts);
    this.tiles = new Tiles(this, this.scene);
  }

  setPart(part: NamedPart): void {
    const { name } = part;
    const tile = tilePart(name);
    if (tile) return void this.tiles?.setPart(tile[0], { ...part, name: tile[1] });
    if (!this.held.set(part)) return;
    this.scene?.forget(name);
    this.trim();
    if (name === "cmap") this.tiles?.recolour();
    if (["cmap", "maps", ...EARTH_LINES].includes(name)) this.panel.showLegend();
    this.change();
  }

  private trim(): void {
    this.held.trim(this.header, this.options.source, this.player.moment.slice(0, 2));
  }

  setSettings(settings: Settings): void {
    if (Object.entries(settings).every(([name, value]) => this.settings[name] === value)) return;
    Object.assign(this.settings, settings);
    if (this.requests.follow(this.settings)) this.renew();
    this.panel.update();
    this.change();
  }

  /** Have the flow computed anew. */
  private renew(): void {
    this.held.clear((name) => /^(flow|scalars)\//.test(name));
    this.requests.stop();
    if (this.header) this.makeScene(this.header);
    this.requests.wantSteps(this.missing(this.player.moment.slice(0, 2)));
  }

  /** Follow the setting of another view, unless it is this one's own. */
  followSetting(name: string, value: Value): void {
    if (!(name in (this.header?.own ?? {}))) this.setSettings({ [name]: value });
  }

  /** Set one setting as a person does, and report it to the host. */
  choose(name: string, value: Value): void {
    this.holdDraft();
    this.setSettings({ [name]: value });
    this.options.onSetting?.(name, value);
  }

  get cameraState(): CameraState | null {
    const state = this.camera?.state ?? this.keptCamera ?? this.firstCamera;
    return state ? copyOf(state) : null;
  }

  /** Look from a camera, or so that the whole surface is seen. */
  setCamera(state: CameraState | null): void {
    if (!state) {
      this.firstCamera = this.keptCamera = null;
      this.place();
    } else if (!this.camera) [this.firstCamera, this.keptCamera] = [copyOf(state), null];
    else if (isEqual(this.camera.state, state)) return;
    else this.camera.state = copyOf(state);
    this.change(true);
  }

  /** Draw what a camera sees that was moved by hand, and report it to the host. */
  reportCamera(): void {
    this.holdDraft();
    this.change(true);
    if (this.camera) this.options.onCamera?.(copyOf(this.camera.state));
  }

  reset(): void {
    if (!this.camera) return;
    this.place();
    this.reportCamera();
  }

  /** Look from where the scene says, or so that the whole surface is seen. */
  private place(): void {
    const { header, firstCamera: first, keptCamera: kept, aspect } = this;
    const nodes = this.parts.get("position")?.data;
    if (!header || !nodes) return;
    const camera = (this.camera = placedCamera(header, first, nodes, aspect));
    camera.pick = (x, y) => (this.point(x, y)?.position as Vector | undefined) ?? this.ground(x, y);
    camera.state = kept ?? camera.state;
    this.keptCamera = null;
    this.panel.showAxes();
    // A host holds the camera that is shown.
    if (!first || !isEqual(first, camera.start)) this.options.onCamera?.(copyOf(camera.state));
  }

  private get aspect(): number {
    return Math.max(this.stage.clientWidth, 1) / Math.max(this.stage.clientHeight, 1);
  }

  get playing(): boolean {
    return this.player.playing;
  }

  setTime(time: number): void {
    this.player.seek(time);
    this.panel.tick();
    this.change();
  }

  /** Follow the time of another view, unless this one has its own. */
  followTime(time: number): void {
    const { timeShift = 0 } = this.header ?? {};
    if (timeShift === null) return;
    const [first, last] = this.player.span;
    const own = time + timeShift;
    this.setTime(first <= own && own <= last ? own : last);
  }

  /** Go to the next step, 1, or to the one before, -1. */
  step(count: number): void {
    const { player, options } = this;
    if (options.follows) return options.follows.step(count);
    if (!player.varies) return;
    this.pause();
    this.setTime(player.stepFrom(count));
    options.onTime?.(player.time);
  }

  /** Go to a share of the times, or of the clock's period, as the slider asks. */
  scrub(share: number): void {
    const { player, options } = this;
    const { first, last } = player.range(this.settings);
    const value = first + share * (last - first);
    this.holdDraft();
    if (player.varies) {
      this.setTime(value);
      options.onTime?.(player.time);
    } else {
      this.setClock(value);
      options.onClock?.(player.clock);
    }
  }

  setClock(seconds: number): void {
    this.player.clock = seconds;
    this.panel.tick();
    this.change();
  }

  play(): void {
    if (this.options.follows) return this.options.follows.play();
    if (this.playing || !this.header) return;
    if (!this.player.varies && this.settings.motion === "off") this.choose("motion", "speed");
    this.player.start();
    this.panel.update();
    this.request();
    this.options.onPlaying?.(true);
  }

  pause(): void {
    if (this.options.follows) return this.options.follows.pause();
    if (!this.playing) return;
    this.player.playing = false;
    this.panel.update();
    this.change();
    this.options.onPlaying?.(false);
  }

  /** Play or pause, in the view that has the bar. */
  togglePlaying(): void {
    const leader = this.options.follows ?? this;
    if (leader.playing) leader.pause();
    else leader.play();
  }

  /** Draw drafts alone for a while, as the view or a control is being moved. */
  private holdDraft(duration = STILL_MS): void {
    this.busyUntil = performance.now() + duration;
  }

  get isHeld(): boolean {
    return performance.now() < this.busyUntil;
  }

  /** Draw another picture when its turn comes. */
  change(cameraOnly = false): void {
    this.renderer.restart(cameraOnly);
    this.card.draw();
    this.panel.showAxes();
    this.setSharp(false);
    this.request();
  }

  /** Draw the picture once more, as more of the surface is there. */
  refine(): void {
    this.renderer.refine();
    this.setSharp(false);
    this.request();
  }

  /** Choose what is drawn at a moment: the whole, or the root and the tiles of a large surface. */
  arrange(shown: Moment): Scene[] {
    const scenes = this.tiles?.arrange(shown) ?? [];
    this.root.dataset.tiles = String(this.tiles?.pending ?? 0);
    return scenes;
  }

  /** Draw at once, as far as there is time. */
  draw(): void {
    this.frame(performance.now(), performance.now() + FRAME_MS);
  }

  private setSharp(sharp: boolean): void {
    if (sharp === this.sharp) return;
    this.sharp = sharp;
    this.root.dataset.sharp = String(sharp);
    if (!sharp) return;
    this.card.update();
    this.options.onFrame?.();
  }

  private request(): void {
    if (!this.lifetime.isOver && this.isVisible) this.graphics.request(this);
  }

  resize(): void {
    const ratio = Math.max(window.devicePixelRatio || 1, 0.1);
    const { clientWidth, clientHeight } = this.stage;
    const [width, height] = [clientWidth, clientHeight].map((n) => Math.max(Math.round(n * ratio), 1));
    if (width === this.canvas.width && height === this.canvas.height) return;
    this.renderer.resize(width, height);
    if (this.camera) {
      this.camera.aspect = this.aspect;
      if (isEqual(this.camera.state, this.camera.start)) this.place();
    }
    this.change();
  }

  /** Whether outlines are smoothed in the full picture: on a processor it would take many times as long. */
  get smooth(): boolean {
    const { header } = this;
    if (this.options.smooth !== undefined || !header) return this.options.smooth ?? false;
    return this.program(header).price < CARD_PRICE_MS;
  }

  /** Pixels of the canvas along one of the page. */
  get ratio(): number {
    return this.canvas.height / Math.max(this.stage.clientHeight, 1);
  }

  lost(): void {
    this.scene = null; // buffers and textures are lost with the context
    if (this.header) this.makeScene(this.header);
    this.setSharp(false);
  }

  /** Names of the parts that the present moment lacks. */
  get lacking(): string[] {
    const [before, after] = this.player.moment;
    return this.scene?.missing(before, after) ?? [];
  }

  /** Ask for the parts of the steps that are missing, and trace them until a time; gives what can be shown. */
  private available(until: number): Moment | null {
    const { header, scene, player, shown, lacking } = this;
    if (!header || !scene) return null;
    const moment = player.moment;
    const ahead = player.playing ? [1, 2].map((n) => (moment[1] + n) % header.slices.steps) : [];
    const steps = this.missing([moment[0], moment[1], ...this.next, ...ahead]);
    const { isComing } = this.options;
    if (steps.length && this.requests.hasSteps && !isComing?.()) this.requests.wantSteps(steps);
    const isMade = !lacking.length && scene.make(moment.slice(0, 2), until);
    this.root.dataset.lacking = String(lacking.length || Number(!isMade));
    this.panel.wait(lacking, isMade, this.renderer.leavesOut);
    // A picture that was begun before the slices were there shows another moment.
    if (isMade && String(moment.slice(0, 2)) !== String(shown?.slice(0, 2))) {
      this.trim();
      this.change();
    }
    if (isMade) return (this.shown = moment);
    if (!lacking.length) this.request();
    return shown && scene.isMade(shown.slice(0, 2)) ? shown : null;
  }

  /** Go on without a tile at some steps, or a step, that a host could not give, and say why once. */
  lack(reason: string, tile?: string, steps: number[] = []): void {
    if (tile !== undefined) this.tiles?.fail(tile, steps);
    this.panel.tell(reason);
  }

  /** Steps that have to come before some can be shown. */
  private missing(steps: number[]): number[] {
    return [...new Set(steps.flatMap((step) => this.scene?.lacking(step) ?? []))];
  }

  frame(now: number, until: number): void {
    if (this.options.streamed) return this.wait(now);
    if (this.lifetime.isOver || this.graphics.isLost || !this.graphics.gl || !this.isVisible) return;
    if (!this.header || !this.scene || this.canvas.width < 2) return;
    try {
      this.advance(now);
      this.drawPicture(this.header, until);
    } catch (error) {
      this.pause();
      this.panel.fail("The picture could not be drawn.", String(error));
    }
  }

  /** Have a place, and go on with time once the picture before is there. */
  private wait(now: number): void {
    if (!this.camera) this.place();
    if (this.playing && this.isPainted) this.advance(now);
  }

  /** Show a part of a picture that the host has drawn. */
  paint(picture: ImageBitmap, left: number, width: number, isSharp: boolean): void {
    this.renderer.show(picture, left, width, isSharp);
    this.isPainted = true;
    this.root.dataset.drawn = "true";
    this.root.dataset.frames = String(this.renderer.frames);
    this.panel.wait([], true, !isSharp);
    if (isSharp) this.panel.clear();
    this.setSharp(isSharp && !this.playing);
    if (this.playing) this.request();
  }

  /** The program that draws at the present settings, from near or from afar. */
  private program(header: Header, isClose = this.isClose(header)): Program {
    const { vertex, fragment } = header.shaders;
    const variant = variantOf(header, this.settings, isClose);
    return this.graphics.programs.get(vertex, fragment, ...variant);
  }

  private isClose(header: Header): boolean {
    if (!this.camera) return false;
    const view = this.view([0, 0, 0], this.ratio);
    // Where there are tiles hardly anything of the root is seen.
    const tiles = this.tiles?.layers.slice(1).map(({ scene }) => scene.header) ?? [];
    return (tiles.length ? tiles : [header]).some((part) => isNear(part, this.settings, view));
  }

  /** Go on with the picture until a time. */
  private drawPicture(header: Header, until: number): void {
    const shown = this.available(until);
    if (!this.camera) this.place();
    const program = this.program(header); // built while parts come and slices are made
    this.scene?.prepare();
    if (!shown || !this.camera) return;
    if (program.error) return this.panel.fail("The shader does not compile with this graphics driver.", program.error);
    if (!program.ready || !this.scene?.isReady(this.settings)) return this.request();
    const isComplete = !this.sharp && this.renderer.draw(program, shown, until);
    this.root.dataset.drawn = "true"; // coarse or not
    if (isComplete) {
      this.root.dataset.frames = String(this.renderer.frames);
      this.panel.clear();
      void this.scene.pickers; // the pointer asks for them next,
      if (header.slices.critical) this.program(header, true); // and the wheel for this
      this.setSharp(!this.playing);
    }
    if (!this.sharp) this.request();
  }

  /** Go on with the time or the clock. */
  private advance(now: number): void {
    const { player, options } = this;
    const isMade = (steps: number[]) => {
      this.next = steps;
      if (options.streamed) return true;
      return !this.missing(steps).length && !!this.scene?.make(steps, now);
    };
    this.next = [];
    this.isPainted = false;
    if (!player.playing || !player.advance(now, isMade)) return;
    if (player.varies) options.onTime?.(player.time);
    else options.onClock?.(player.clock);
    this.panel.tick();
    this.renderer.restart();
    this.setSharp(false);
  }

  /** Where from and when a moment is seen, with so many pixels along one of the page. */
  view(shown: Moment, density: number): ViewState {
    const { header, camera, scene, player } = this;
    if (!header || !camera) throw new Error("there is nothing to look at yet");
    const anchor = scene?.anchor ?? [0, 0, 0];
    return viewState({ header, camera, anchor, player, rows: this.stage.clientHeight }, shown, density);
  }

  /** Whether the programs that find points are built. */
  get canPick(): boolean {
    const { scene, graphics } = this;
    return !!scene && !graphics.isLost && !!graphics.gl && scene.pickers.every(({ ready }) => ready);
  }

  /** Point of the surface at (x, y), from -1 to 1, right and up. */
  point(x: number, y: number): Point | null {
    return this.find(x, y)?.point ?? null;
  }

  /** Place of the Earth at (x, y), also where there are no data. */
  ground(x: number, y: number): Vector | null {
    const { header, camera } = this;
    return header && camera && groundAt(header, camera, x, y);
  }

  /** The same, and where in what is drawn. */
  find(x: number, y: number): Found | null {
    const { tiles, camera, shown, canvas } = this;
    if (!tiles?.layers.length || !camera || !shown || !this.canPick) return null;
    const { anchor } = this.view(shown, 1);
    return pickedPoint({ layers: tiles.layers, camera, moment: shown, anchor, canvas }, x, y);
  }
}
