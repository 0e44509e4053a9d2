// One scene in an element.
//
//   header, parts --> Viewer --> Painter --> canvas
//                       |          by WebGL2 (webgl2painter.ts), or pictures of the host (painter.ts)
//                     Camera, Player, Panel (what is seen around the picture), Pointers

import { SceneView } from "./bareview.ts";
import { coloursOf, recoloured, type ColourChoice } from "./colours.ts";
import { copyOf, isSamePlace, type CameraState } from "./camera.ts";
import { FRAME_MS } from "./context.ts";
import { Ground } from "./dom.ts";
import { groundAt } from "./earthlayer.ts";
import type { Options } from "./options.ts";
import { Panel } from "./panel.ts";
import { StreamedPainter, type Painter } from "./painter.ts";
import type { Point } from "./picking.ts";
import { Player } from "./player.ts";
import { PointCard } from "./pointcard.ts";
import { Pointers } from "./pointers.ts";
import { EARTH_LINES, FORMAT, type Header, type NamedPart, type Settings, type Value } from "./protocol.ts";
import { Requests } from "./sources/source.ts";
import type { Moment } from "./uniforms.ts";
import type { Vector } from "./vectors.ts";
import { placedCamera } from "./viewstate.ts";
import { WebGL2Painter } from "./webgl2painter.ts";

/** For which a view that was moved, or data that have changed, count as changing. */
const [STILL_MS, STEADY_MS] = [160, 400];

const isEqual = (a: unknown, b: unknown) => JSON.stringify(a) === JSON.stringify(b);
/** Where the nodes of a surface lie, as far as a header says. */
const placeOf = ({ geometry: { center, extent, shape } }: Header) => [center, extent, shape];

export class Viewer extends SceneView {
  readonly options: Options;
  readonly requests: Requests;
  readonly player = new Player();
  /** What the picture fills. */
  readonly stage = document.createElement("div");
  readonly card: PointCard = new PointCard(this);
  readonly panel: Panel;
  readonly pointers: Pointers;
  header: Header | null = null;
  settings: Settings = {};
  /** Number of full pictures. */
  frames = 0;
  /** The views that stand beside each other. */
  together: Viewer[] = [this];
  readonly painter: Painter;
  private readonly page: Ground;
  /** The header as the host gave it, with the present colours. */
  private given: Header | null = null;
  /** Whether the picture has the ground of the page. */
  private isOnPage = false;
  private busyUntil = 0;
  /** The moment of which the chosen point was shown last. */
  private toldMoment = "";
  /** The camera that the scene came with, and the one that looks at it where that is another one. */
  private firstCamera: CameraState | null = null;
  private keptCamera: CameraState | null = null;

  constructor(element: HTMLElement, options: Options = {}) {
    super();
    this.options = options;
    this.requests = new Requests(options.source ?? null, this);
    const { root } = this;
    root.className = "flowtex";
    root.tabIndex = 0;
    // For hosts: whether the picture is the full one, the number of full ones so far, and of tiles and of
    // parts of the present time that are not there yet.
    Object.assign(root.dataset, { sharp: "false", frames: "0", tiles: "0", lacking: "0" });
    // JupyterLab also uses the keys that move the view.
    root.setAttribute("data-lm-suppress-shortcuts", "true");
    root.setAttribute("role", "application");
    this.panel = new Panel(this);
    const make = options.painter ?? ((view) => new (options.streamed ? StreamedPainter : WebGL2Painter)(view));
    this.painter = make(this);
    element.append(root);
    this.page = new Ground(root, this.lifetime, () => this.isOnPage && this.recolour({ background: null }));
    this.pointers = new Pointers(this);
    this.graphics.users.add(this);
    this.observe();
  }

  private observe(): void {
    const { lifetime, root } = this;
    lifetime.observe(new ResizeObserver(() => this.panel.arrange()), root);
    lifetime.observe(new ResizeObserver(() => this.resize()), this.stage);
    const seen = new IntersectionObserver((entries) => {
      this.isVisible = entries[entries.length - 1].isIntersecting;
      if (!this.isVisible) return;
      // Notebooks may put a view into the page after it was made.
      this.page.look();
      this.request();
    });
    lifetime.observe(seen, root);
    lifetime.listen(document, "visibilitychange", () => this.request());
    // The ratio changes when the window goes to another screen or is zoomed.
    lifetime.listen(window, "resize", () => this.resize());
  }

  /** What is still held, for tests. */
  stats() {
    const { objects, users } = this.graphics;
    return { ...this.lifetime.stats(), objects, users: users.size, frames: this.frames };
  }

  override dispose(): void {
    this.player.playing = false;
    super.dispose();
    this.canvas.width = this.canvas.height = 0;
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
    if (isSame) return this.takeDifferences(old, header);
    if (old) this.holdDraft(STEADY_MS);
    this.given = header;
    header = { ...header, ...this.grounded(header) };
    this.header = header;
    this.settings = { ...header.settings, ...header.own };
    this.player.setHeader(header);
    this.requests.setHeader(header);
    this.painter.open?.(header);
    const isElsewhere = !old || old.place !== header.place || !isSamePlace(old.geometry, header.geometry);
    const isOther = old && !isEqual(placeOf(old), placeOf(header));
    // A host reads the point of another surface.
    if (isOther && (isElsewhere || !this.options.reader)) this.card.close();
    if (isElsewhere) {
      this.keptCamera = old && keepsCamera ? this.cameraState : null;
      [this.firstCamera, this.camera] = [this.keptCamera ? null : header.camera, null];
    }
    if (old && old.generation !== header.generation) {
      // What is the same at all times is sent again only where it differs.
      this.held.clear((name) => (isElsewhere && !keepsCamera) || name.includes("/"));
      if (header.surface?.length) this.keepParts(header.surface);
    }
    this.panel.build();
    this.resize(); // at once, so that no picture is drawn in the size without the bar
    this.change();
  }

  /** Follow a header of the same arrays, which may have other colours, and another view beside it. */
  private takeDifferences(old: Header, header: Header): void {
    const { differs, own, timeShift, name, settings } = header;
    const names = Object.keys({ ...old.own, ...own });
    Object.assign(old, { differs, own, timeShift, name });
    this.recolour(coloursOf(header));
    this.setSettings(Object.fromEntries(names.map((each) => [each, own?.[each] ?? settings[each]])));
    this.panel.update();
  }

  /** Remove the time-independent parts of the previous scene that are not among these names. */
  keepParts(names: string[]): void {
    for (const name of [...this.parts.keys()]) {
      if (name.includes("/") || names.includes(name)) continue;
      this.held.remove(name);
      this.scene?.forget(name);
    }
  }

  /** Draw the same arrays in other colours, given by a part of the header. */
  recolour(changes: Partial<Header>): void {
    if (!this.header) return;
    const colours = this.grounded(changes);
    Object.assign(this.header, colours);
    this.fitColours();
    Object.assign(this.given ?? {}, changes); // a source reads there what is wanted
    this.scene?.forget("scalars");
    this.tiles?.recolour(colours);
    this.panel.showLegend();
    this.change();
  }

  /** Have colours without a chosen range follow the parameters of a formula. */
  private fitColours(): void {
    if (this.header && this.requests.fit()) Object.assign(this.header, recoloured(this.header, {}, this.parts).colours);
  }

  /** Colours whose ground is that of the page, unless it is another one. */
  private grounded(colours: Partial<Header>): Partial<Header> {
    this.page.update();
    if (colours.background === undefined) return colours;
    this.isOnPage = colours.background === null;
    return { ...colours, background: colours.background ?? this.page.colour };
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

  override setPart(part: NamedPart): boolean {
    const isOther = super.setPart(part);
    if (isOther && ["cmap", "maps", ...EARTH_LINES].includes(part.name)) this.panel.showLegend();
    return isOther;
  }

  setSettings(settings: Settings): void {
    if (Object.entries(settings).every(([name, value]) => this.settings[name] === value)) return;
    Object.assign(this.settings, settings);
    if (this.requests.follow(this.settings)) {
      this.recolour({});
      this.renew();
      this.card.update();
    }
    this.panel.update();
    this.change();
  }

  /** Have the flow computed again. */
  private renew(): void {
    this.held.clear((name) => /^(flow|scalars|critical|separatrices|nullclines)\//.test(name));
    this.requests.stop();
    if (this.header) this.painter.open?.(this.header);
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

  /** Draw the view of a camera that the user has moved, and report it to the host. */
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
  place(): void {
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
    const parts = this.camera && this.requests.formula?.look(this.camera, this.parts.keys());
    for (const part of parts ?? []) this.setPart(part);
    this.painter.restart?.(cameraOnly);
    if (!cameraOnly) this.pointers.outdate();
    this.card.draw();
    this.panel.showAxes();
    this.setSharp(false);
    this.request();
  }

  /** Draw the picture once more, as more of the surface is there. */
  refine(): void {
    this.painter.refine?.();
    this.setSharp(false);
    this.request();
  }

  /** Draw at once, as far as there is time. */
  draw(): void {
    this.frame(performance.now(), performance.now() + FRAME_MS);
  }

  /** The picture has gone on, and may be complete: the full one. */
  painted(isComplete: boolean): void {
    this.root.dataset.drawn = "true"; // coarse or not
    if (isComplete) {
      this.frames += 1;
      this.root.dataset.frames = String(this.frames);
      this.panel.clear();
    }
    this.followMoment();
    this.setSharp(isComplete && !this.playing);
    if (!this.sharp) this.request();
  }

  /** Show of the chosen point what the picture shows, as soon as it shows another moment. */
  private followMoment(): void {
    const moment = String(this.shown);
    if (moment === this.toldMoment) return;
    this.toldMoment = moment;
    // A host that reads paths would be asked at every picture.
    if (this.playing && this.options.reader) this.card.hide();
    else this.card.update();
  }

  private setSharp(sharp: boolean): void {
    if (sharp === this.sharp) return;
    this.sharp = sharp;
    this.root.dataset.sharp = String(sharp);
    if (!sharp) return;
    this.card.update();
    this.pointers.again();
    this.options.onFrame?.();
  }

  resize(): void {
    const ratio = Math.max(window.devicePixelRatio || 1, 0.1);
    const { clientWidth, clientHeight } = this.stage;
    const [width, height] = [clientWidth, clientHeight].map((n) => Math.max(Math.round(n * ratio), 1));
    if (width === this.canvas.width && height === this.canvas.height) return;
    const { painter, canvas } = this;
    if (painter.resize) painter.resize(width, height);
    else [canvas.width, canvas.height] = [width, height];
    if (this.camera) {
      this.camera.aspect = this.aspect;
      if (isEqual(this.camera.state, this.camera.start)) this.place();
    }
    this.change();
  }

  /** Pixels of the canvas along one of the page. */
  get ratio(): number {
    return this.canvas.height / Math.max(this.stage.clientHeight, 1);
  }

  override lost(): void {
    super.lost();
    this.root.dataset.sharp = "false";
  }

  get shown(): Moment | null {
    return this.painter.shown ?? null;
  }

  /** Names of the parts that the present moment lacks. */
  get lacking(): string[] {
    return this.painter.lacking ?? [];
  }

  protected tell(reason: string): void {
    this.panel.tell(reason);
  }

  protected fail(error: unknown): void {
    this.pause();
    this.panel.fail("The picture could not be drawn.", String(error));
  }

  /** Go on with the time or the clock, to steps that the painter can show. */
  advance(now: number): void {
    const { player, options, painter } = this;
    const isMade = (steps: number[]) => painter.make?.(steps, now) ?? true;
    if (!player.playing || !player.advance(now, isMade)) return;
    if (player.varies) {
      options.onTime?.(player.time);
      this.pointers.outdate();
    } else options.onClock?.(player.clock);
    this.panel.tick();
    painter.restart?.(false);
    this.setSharp(false);
  }

  protected get rows(): number {
    return this.stage.clientHeight;
  }

  /** Whether points can be found in the picture. */
  get canPick(): boolean {
    return this.painter.canPick ?? false;
  }

  /** Point of the surface at (x, y), from -1 to 1, right and up. */
  point(x: number, y: number): Point | null {
    return this.find(x, y)?.point ?? null;
  }

  /** Longitude and latitude at (x, y), also without data. */
  ground(x: number, y: number): Vector | null {
    const { header, camera } = this;
    return header && camera && groundAt(header, camera, x, y);
  }
}
