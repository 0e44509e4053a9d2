// What draws the picture of a view: WebGL2, pictures that a host sends, or a painter of one's own.

import type { SceneView } from "./bareview.ts";
import type { Found } from "./picking.ts";
import type { Header } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import type { Tiles } from "./tiles.ts";
import type { Moment } from "./uniforms.ts";

export interface Painter {
  /** Go on with the picture until a time, and call `painted`. */
  frame(now: number, until: number): void;
  /** Show another scene. */
  open?(header: Header): void;
  /** Begin another picture, of the same things where only the camera has changed. */
  restart?(cameraOnly: boolean): void;
  /** Change the size of the canvas, which a view does by itself otherwise. */
  resize?(width: number, height: number): void;
  dispose?(): void;
  /** Have ready what shows some steps, if there is time; returns whether they can be played. */
  make?(steps: number[], until: number): boolean;
  /** Draw the same picture once more, as more of the surface is there. */
  refine?(): void;
  /** Show a part of a picture of the host's. */
  show?(picture: ImageBitmap, left: number, width: number, isSharp: boolean): void;
  /** Find the point of the surface at (x, y), from -1 to 1 to the right and up. */
  find?(x: number, y: number): Found | null;
  /** Whether points can be found yet. */
  readonly canPick?: boolean;
  /** Names of the parts that the present moment lacks. */
  readonly lacking?: string[];
  /** What is on the graphics card, and the moment that was drawn. */
  readonly scene?: Scene | null;
  readonly tiles?: Tiles | null;
  readonly shown?: Moment | null;
}

/** Shows images that the host draws and sends; the view moves its camera and waits for them. */
export class StreamedPainter implements Painter {
  private readonly view: SceneView;
  /** Whether the host has drawn the last request. */
  private isPainted = true;

  constructor(view: SceneView) {
    this.view = view;
  }

  /** Change the size; what is on show stays, stretched, until there is something better. */
  resize(width: number, height: number): void {
    const { canvas } = this.view;
    const before = new OffscreenCanvas(Math.max(canvas.width, 1), Math.max(canvas.height, 1));
    before.getContext("2d")?.drawImage(canvas, 0, 0);
    [canvas.width, canvas.height] = [width, height];
    this.pen?.drawImage(before, 0, 0, width, height);
  }

  private get pen() {
    return this.view.canvas.getContext("2d", { alpha: false });
  }

  /** Have a place, and go on with time once the picture before is there. */
  frame(now: number): void {
    const { view } = this;
    if (!view.camera) view.place();
    if (!view.player.playing || !this.isPainted) return;
    this.isPainted = false;
    view.advance(now);
  }

  show(picture: ImageBitmap, left: number, width: number, isSharp: boolean): void {
    const { view } = this;
    const { canvas, panel } = view;
    this.pen?.drawImage(picture, left, 0, width, picture.height, 0, 0, canvas.width, canvas.height);
    this.isPainted = true;
    panel.wait([], true, !isSharp);
    view.painted(isSharp);
  }
}
