// Pictures that the host draws and sends: the view moves its camera, and waits for them.

import type { Painter, View } from "./painter.ts";

export class StreamedPainter implements Painter {
  private readonly view: View;
  /** Whether the host has drawn the last request. */
  private isPainted = true;

  constructor(view: View) {
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
