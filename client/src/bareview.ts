// A picture of a scene and nothing around it, for a host that shows it in its own way and moves the camera.

import { recoloured, type ColourChoice } from "./colours.ts";
import { Camera, type CameraState } from "./camera.ts";
import { sharedGraphics, type Graphics, type User } from "./context.ts";
import { HeldParts } from "./heldparts.ts";
import { Lifetime } from "./lifetime.ts";
import type { View } from "./painter.ts";
import type { Found } from "./picking.ts";
import { Player } from "./player.ts";
import { tilePart, type Header, type NamedPart, type Settings } from "./protocol.ts";
import { Requests, type Source, type Taker } from "./sources/source.ts";
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

export class BareView implements View, User, Taker {
  readonly canvas = document.createElement("canvas");
  readonly root = document.createElement("div");
  readonly graphics: Graphics = sharedGraphics();
  readonly lifetime = new Lifetime();
  readonly player: Player;
  readonly held = new HeldParts(this.graphics);
  readonly parts = this.held.all;
  readonly isClear = true;
  isVisible = true;
  readonly panel: View["panel"];
  readonly requests: Requests;
  readonly options: View["options"];
  readonly header: Header;
  readonly settings: Settings;
  readonly painter: WebGL2Painter;
  camera: Camera | null = null;
  sharp = false;
  ratio = 1;
  private readonly host: BareHost;
  /** Whether nothing has been drawn yet of the picture that is wanted. */
  private isNew = true;

  constructor(host: BareHost, { header, settings, player, source, isComing }: Shared) {
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

  dispose(): void {
    if (this.lifetime.isOver) return;
    this.lifetime.end();
    this.requests.stop();
    this.painter.dispose();
    this.held.clear();
    this.graphics.leave(this);
  }

  get tiles() {
    return this.painter.tiles;
  }

  get isHeld(): boolean {
    return this.host.isHeld();
  }

  setPart(part: NamedPart): void {
    const tile = tilePart(part.name);
    if (tile) return void this.tiles?.setPart(tile[0], { ...part, name: tile[1] });
    if (!this.held.set(part)) return;
    this.painter.scene?.forget(part.name);
    this.trim();
    if (part.name === "cmap") this.tiles?.recolour();
    this.change();
  }

  lack(reason: string, tile?: string, steps: number[] = []): void {
    if (tile !== undefined) this.tiles?.fail(tile, steps);
    this.host.failed(reason, "");
  }

  trim(): void {
    this.held.trim(this.header, this.options.source, this.player.moment.slice(0, 2));
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

  place(): void {
    // The host says from where.
  }

  advance(now: number): void {
    const { player, painter } = this;
    if (!player.playing || !player.advance(now, (steps) => painter.make(steps, now))) return;
    this.host.advanced();
    this.change();
  }

  request(): void {
    if (!this.lifetime.isOver) this.graphics.request(this);
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

  lost(): void {
    this.painter.open(this.header);
    this.sharp = false;
  }

  frame(now: number, until: number): void {
    if (this.lifetime.isOver) return;
    try {
      this.painter.frame(now, until);
    } catch (error) {
      this.player.playing = false;
      this.host.failed("The flow cannot be drawn.", String(error));
    }
  }

  view(shown: Moment, density: number): ViewState {
    const { header, camera, player, rows } = this;
    if (!camera) throw new Error("no camera is set yet");
    const anchor = this.painter.scene?.anchor ?? [0, 0, 0];
    return viewState({ header, camera, anchor, player, rows }, shown, density);
  }

  /** Height of the picture in pixels of the page. */
  get rows(): number {
    return this.canvas.height / this.ratio;
  }

  /** What is at (x, y), from -1 to 1, right and up. */
  find(x: number, y: number): Found | null {
    return this.painter.canPick ? this.painter.find(x, y) : null;
  }
}
