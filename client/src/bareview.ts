// The base of all views of a scene, and a view without controls, for a host that shows the image itself and moves the
// camera.

import { recoloured, type ColourChoice } from "./colours.ts";
import { Camera, type CameraState } from "./camera.ts";
import { sharedGraphics, type Graphics, type User } from "./context.ts";
import { HeldParts } from "./heldparts.ts";
import { Lifetime } from "./lifetime.ts";
import type { Options } from "./options.ts";
import type { Painter } from "./painter.ts";
import type { Panel } from "./panel.ts";
import type { Found } from "./picking.ts";
import { Player } from "./player.ts";
import { tilePart, type Header, type NamedPart, type Settings } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import { Requests, type Source, type Taker } from "./sources/source.ts";
import type { Shown } from "./tilechoice.ts";
import type { Tiles } from "./tiles.ts";
import type { Moment, ViewState } from "./uniforms.ts";
import { viewState } from "./viewstate.ts";
import { WebGL2Painter } from "./webgl2painter.ts";

/** Who shows the picture. */
export interface BareHost {
  /** Whether the camera is being moved. */
  isHeld(): boolean;
  /** The canvas has another picture, and whether that is the full one. */
  painted(isComplete: boolean): void;
  /** Time or clock have gone on, as they play. */
  advanced(): void;
  failed(problem: string, detail: string): void;
}

/** What several views have in common. */
interface Shared {
  header: Header;
  settings: Settings;
  player: Player;
  source: Source;
  /** Whether parts are still arriving without being requested. */
  isComing(): boolean;
}

/** Holds the parts of a scene, and has a painter draw them in turn with the other views of the page. */
export abstract class SceneView implements User, Taker {
  readonly canvas = document.createElement("canvas");
  readonly root = document.createElement("div");
  readonly graphics: Graphics = sharedGraphics();
  readonly lifetime = new Lifetime();
  readonly held = new HeldParts(this.graphics);
  readonly parts = this.held.all;
  abstract readonly player: Player;
  abstract readonly panel: Pick<Panel, "wait" | "showKinds" | "fail">;
  abstract readonly requests: Requests;
  abstract readonly options: Pick<Options, "smooth" | "source" | "isComing">;
  abstract readonly header: Header | null;
  abstract readonly settings: Settings;
  abstract readonly painter: Painter;
  abstract readonly isHeld: boolean;
  abstract readonly ratio: number;
  /** Height of the picture in pixels of the page. */
  protected abstract readonly rows: number;
  camera: Camera | null = null;
  /** Whether the full picture is shown. */
  sharp = false;
  isVisible = true;
  /** Whether the picture is clear beside the surface. */
  readonly isClear: boolean = false;
  /** What the host makes of the picture; null where it is shown as it is. */
  shownOn: Shown | null = null;

  abstract place(): void;
  abstract advance(now: number): void;
  abstract change(cameraOnly?: boolean): void;
  abstract refine(): void;
  abstract painted(isComplete: boolean): void;
  /** Show why some data are missing; the view draws the rest. */
  protected abstract tell(reason: string): void;
  /** Stop playing and show that drawing failed. */
  protected abstract fail(error: unknown): void;

  dispose(): void {
    if (this.lifetime.isOver) return;
    this.lifetime.end();
    this.requests.stop();
    this.painter.dispose?.();
    this.held.clear();
    this.graphics.leave(this);
  }

  /** Buffers and textures on the graphics card; null if the host draws. */
  get scene(): Scene | null {
    return this.painter.scene ?? null;
  }

  get tiles(): Tiles | null {
    return this.painter.tiles ?? null;
  }

  /** Take a part; return whether it differs from the one before. */
  setPart(part: NamedPart): boolean {
    const tile = tilePart(part.name);
    if (tile) this.tiles?.setPart(tile[0], { ...part, name: tile[1] });
    if (tile || !this.held.set(part)) return false;
    this.scene?.forget(part.name);
    this.trim();
    if (part.name === "cmap") this.tiles?.recolour();
    this.change();
    return true;
  }

  /** Draw without a tile at some steps, or without a step, because the source has none, and show why. */
  lack(reason: string, tile?: string, steps: number[] = []): void {
    if (tile !== undefined) this.tiles?.fail(tile, steps);
    this.tell(reason);
  }

  /** Hold no more time steps than are needed. */
  trim(): void {
    this.held.trim(this.header, this.options.source, this.player.moment.slice(0, 2));
  }

  /** Have `frame` called. */
  request(): void {
    if (!this.lifetime.isOver && this.isVisible) this.graphics.request(this);
  }

  frame(now: number, until: number): void {
    if (this.lifetime.isOver) return;
    try {
      this.painter.frame(now, until);
    } catch (error) {
      this.fail(error);
    }
  }

  /** Buffers and textures are lost with the context. */
  lost(): void {
    if (this.header) this.painter.open?.(this.header);
    this.sharp = false;
  }

  /** Where from and when a moment is seen, with so many pixels along one of the page. */
  view(shown: Moment, density: number): ViewState {
    const { header, camera, player, rows } = this;
    if (!header || !camera) throw new Error("no scene is shown yet");
    return viewState({ header, camera, anchor: this.scene?.anchor ?? [0, 0, 0], player, rows }, shown, density);
  }

  /** Return the point at (x, y), from -1 to 1, right and up, and its place in the drawn layers. */
  find(x: number, y: number): Found | null {
    return this.painter.canPick ? (this.painter.find?.(x, y) ?? null) : null;
  }
}

export class BareView extends SceneView {
  readonly player: Player;
  override readonly isClear = true;
  readonly panel: SceneView["panel"];
  readonly requests: Requests;
  readonly options: SceneView["options"];
  readonly header: Header;
  readonly settings: Settings;
  readonly painter: WebGL2Painter;
  ratio = 1;
  private readonly host: BareHost;
  /** Whether nothing has been drawn yet of the picture that is wanted. */
  isNew = true;

  constructor(host: BareHost, { header, settings, player, source, isComing }: Shared) {
    super();
    this.host = host;
    this.header = header;
    this.settings = settings;
    this.player = player;
    this.options = { source, isComing };
    this.panel = {
      wait: () => undefined,
      showKinds: () => undefined,
      fail: (problem, detail) => host.failed(problem, detail),
    };
    this.requests = new Requests(source, this);
    this.graphics.users.add(this);
    player.setHeader(header);
    this.painter = new WebGL2Painter(this);
    this.requests.setHeader(header);
    this.painter.open(header);
  }

  get isHeld(): boolean {
    return this.host.isHeld();
  }

  chooseColours(choice: ColourChoice): void {
    const { colours, part } = recoloured(this.header, choice, this.parts);
    if (part) this.setPart(part);
    Object.assign(this.header, colours);
    this.painter.scene?.forget("scalars");
    this.tiles?.recolour(colours);
    this.change();
  }

  /** Look from a camera into a picture of so many pixels of the page, `ratio` of the canvas along each. */
  look(state: CameraState, width: number, height: number, ratio: number): void {
    const { header, canvas } = this;
    this.ratio = ratio;
    this.camera = new Camera(state, header.limits, header.geometry.planar, width / height);
    const size = [width, height].map((n) => Math.max(Math.round(n * ratio), 1));
    if (size[0] !== canvas.width || size[1] !== canvas.height) this.painter.resize(size[0], size[1]);
    this.change(true);
  }

  protected tell(reason: string): void {
    this.host.failed(reason, "");
  }

  protected fail(error: unknown): void {
    this.player.playing = false;
    this.host.failed("The flow cannot be drawn.", String(error));
  }

  place(): void {
    // The host says from where.
  }

  advance(now: number): void {
    const { player, painter } = this;
    if (!player.playing || !player.advance(now, (steps) => painter.make(steps, now))) return;
    this.host.advanced();
    this.change();
  }

  change(cameraOnly = false): void {
    this.painter.restart(cameraOnly);
    this.isNew = true;
    this.refine();
  }

  refine(): void {
    if (!this.isNew) this.painter.refine();
    this.sharp = false;
    this.request();
  }

  painted(isComplete: boolean): void {
    this.sharp = isComplete && !this.player.playing;
    if (this.isNew || isComplete) this.host.painted(isComplete);
    this.isNew = false;
    if (!this.sharp) this.request();
  }

  get rows(): number {
    return this.canvas.height / this.ratio;
  }
}
