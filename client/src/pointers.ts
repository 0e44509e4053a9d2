// Pointers, wheel and keys on the picture.

import { CAMERA_KEYS, CLOSE_KEY, DIRECTIONS, FULLSCREEN_KEY, hasModifier, HELP_KEY, isOfControl, PLAY_KEY } from "./keyboard.ts";
import type { Timer } from "./lifetime.ts";
import type { Point } from "./picking.ts";
import { clamp } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

/** Within these a press is a click. */
const CLICK_PX = 4;
const CLICK_MS = 450;
/** Milliseconds for which a pointer that was moved counts as pointing at the view. */
const POINTED_MS = 1500;
/** Milliseconds between two looks at what is under the pointer. */
const HOVER_MS = 90;
/** Part of the view that an arrow key pans; rotates as much of half a turn. */
const KEY_STEP = 0.2;
/** A notch of the wheel, by the unit of its event: pixels, lines, pages; and pixels of a pinch. */
const NOTCH_SIZES = [100, 3, 1];
const PINCH_PX = 20;
/** Most notches that one event may have. */
const MOST_NOTCHES = 4;

interface Place {
  x: number;
  y: number;
}

/** Place in an element, from -1 to 1, right and up. */
export function placeIn(element: Element, event: { clientX: number; clientY: number }): Place {
  const box = element.getBoundingClientRect();
  return {
    x: (2 * (event.clientX - box.left)) / Math.max(box.width, 1) - 1,
    y: 1 - (2 * (event.clientY - box.top)) / Math.max(box.height, 1),
  };
}

export class Pointers {
  readonly down = new Map<number, Place>();
  private readonly viewer: Viewer;
  private isOther = false;
  /** The last request to a host. */
  private asked: object | null = null;
  private press = { x: 0, y: 0, time: 0, isDrag: false };
  private lastLook = 0;
  private look: Timer | null = null;
  /** Where the pointer rests on the picture. */
  private pointed: Place | null = null;
  private lastPointed = -Infinity;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    const { canvas, root, options, lifetime } = viewer;
    root.classList.toggle("flowtex-guarded", options.guarded ?? false);
    if (options.guarded) this.guard();
    const listen = <E extends Event>(kind: string, call: (event: E) => void) =>
      lifetime.listen(canvas, kind, call, { passive: false });
    listen("pointerdown", (event: PointerEvent) => this.onDown(event));
    listen("pointermove", (event: PointerEvent) => this.onMove(event));
    listen("pointerup", (event: PointerEvent) => this.onUp(event));
    listen("pointercancel", (event: PointerEvent) => this.onUp(event));
    listen("pointerleave", () => this.leave());
    listen("contextmenu", (event) => event.preventDefault());
    listen("wheel", (event: WheelEvent) => this.onWheel(event));
    listen("dblclick", (event: MouseEvent) => {
      viewer.card.close();
      this.zoom(2, event);
    });
    lifetime.listen(root, "keydown", (event: KeyboardEvent) => this.onKey(event));
  }

  /** Take the wheel from a click on, until the page is clicked or scrolled elsewhere. */
  private guard(): void {
    const { root, lifetime } = this.viewer;
    const release = (event: Event) => {
      if (!event.composedPath().includes(root)) this.hold(false);
    };
    lifetime.listen(document, "pointerdown", release, { capture: true });
    lifetime.listen(document, "wheel", release, { capture: true, passive: true });
    lifetime.listen(root, "focus", () => {
      if (root.matches(":focus-visible")) this.hold(true);
    });
  }

  private hold(held: boolean): void {
    this.viewer.root.classList.toggle("flowtex-held", held);
    if (held) this.viewer.panel.hint(false);
  }

  /** Whether wheel and finger are the view's and not the page's. */
  private get isHeld(): boolean {
    const { root, options } = this.viewer;
    if (!options.guarded || root.classList.contains("flowtex-held")) return true;
    return document.fullscreenElement?.contains(root) ?? false;
  }

  private place(event: { clientX: number; clientY: number }): Place {
    return placeIn(this.viewer.canvas, event);
  }

  private onDown(event: PointerEvent): void {
    if (event.button > 2) return;
    const { root, canvas } = this.viewer;
    // The ring is for those who come by keys.
    root.focus({ preventScroll: true, focusVisible: false } as FocusOptions);
    if (event.pointerType !== "touch") this.hold(true);
    canvas.setPointerCapture(event.pointerId);
    this.down.set(event.pointerId, this.place(event));
    this.isOther = event.button === 2 || event.shiftKey;
    const { clientX: x, clientY: y, timeStamp: time } = event;
    this.press = { x, y, time, isDrag: this.down.size > 1 };
    root.classList.add("flowtex-grabbing");
  }

  private onMove(event: PointerEvent): void {
    const { camera } = this.viewer;
    if (!camera) return;
    const place = this.place(event);
    const old = this.down.get(event.pointerId);
    // What the page moves under a pointer at rest was not pointed at.
    if (event.movementX || event.movementY) this.lastPointed = performance.now();
    if (!old) return this.hover(place);
    const distance = Math.hypot(event.clientX - this.press.x, event.clientY - this.press.y);
    if (distance > CLICK_PX) this.press.isDrag = true;
    if (!this.press.isDrag) return;
    const before = this.middle();
    this.down.set(event.pointerId, place);
    const now = this.middle();
    if (this.down.size > 1) {
      camera.pan(before.x - now.x, before.y - now.y);
      if (before.apart > 0) camera.zoomBy(now.apart / before.apart, now.x, now.y);
    } else if (camera.flat === this.isOther) {
      camera.rotate(place.x - old.x, place.y - old.y);
    } else {
      camera.pan(old.x - place.x, old.y - place.y);
    }
    this.leave();
    this.viewer.reportCamera();
  }

  /** Read nothing off any more. */
  private leave(): void {
    this.pointed = this.asked = null;
    this.viewer.lifetime.cancel(this.look);
    this.viewer.panel.read(null);
  }

  /** What was read off has changed: show nothing of it until it is read again. */
  outdate(): void {
    if (!this.pointed) return;
    this.asked = null;
    this.viewer.panel.read(null);
  }

  /** Read again what is under the pointer. */
  again(): void {
    if (this.pointed && !this.down.size) this.hover(this.pointed);
  }

  /** Middle of the pointers that are down, and how far they are apart. */
  private middle(): Place & { apart: number } {
    const [a, b = a] = [...this.down.values()];
    const aspect = this.viewer.camera?.aspect ?? 1;
    const apart = Math.hypot((a.x - b.x) * aspect, a.y - b.y);
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart };
  }

  private onUp(event: PointerEvent): void {
    const place = this.down.get(event.pointerId);
    this.down.delete(event.pointerId);
    if (this.down.size) return;
    this.viewer.root.classList.remove("flowtex-grabbing");
    if (event.type !== "pointerup") return;
    this.hold(true);
    const isQuick = event.timeStamp - this.press.time < CLICK_MS;
    if (!place || this.press.isDrag || !isQuick || event.button !== 0) return;
    this.pointed = place;
    this.viewer.panel.read(this.viewer.card.choose(place.x, place.y));
  }

  private onWheel(event: WheelEvent): void {
    if (!this.isHeld && !event.ctrlKey && !event.metaKey) {
      if (performance.now() - this.lastPointed < POINTED_MS) this.viewer.panel.hint(true);
      return;
    }
    event.preventDefault();
    // A pinch on a touch pad comes as a wheel with ctrl.
    const isPinch = event.ctrlKey && event.deltaMode === 0;
    const size = isPinch ? PINCH_PX : NOTCH_SIZES[event.deltaMode];
    const notches = clamp(-event.deltaY / size, -MOST_NOTCHES, MOST_NOTCHES);
    this.zoom((this.viewer.camera?.limits.wheel_zoom ?? 1) ** notches, event);
  }

  private zoom(factor: number, event: MouseEvent): void {
    const { x, y } = this.place(event);
    this.viewer.camera?.zoomBy(factor, x, y);
    this.viewer.reportCamera();
  }

  /** Read off what is under the pointer, now and then. */
  private hover(place: Place): void {
    const { viewer } = this;
    this.pointed = place;
    viewer.lifetime.cancel(this.look);
    const rest = HOVER_MS - (performance.now() - this.lastLook);
    const look = () => {
      this.look = null;
      this.lastLook = performance.now();
      const { x, y } = place;
      const { streamed, reader } = viewer.options;
      if (streamed) {
        const asked = (this.asked = {});
        const show = (point: Point | null) => {
          if (asked === this.asked && !this.down.size) viewer.panel.read(point, viewer.ground(x, y));
        };
        void reader?.({ place: [x, y] }, false).then((found) => show(found?.point ?? null), () => null);
      } else if (viewer.sharp && viewer.canPick) viewer.panel.read(viewer.point(x, y), viewer.ground(x, y));
      else if (!viewer.player.playing) this.hover(place);
    };
    this.look = viewer.lifetime.later(look, Math.max(rest, viewer.sharp ? 0 : HOVER_MS));
  }

  private onKey(event: KeyboardEvent): void {
    const [target] = event.composedPath();
    const isTaken = event.defaultPrevented || hasModifier(event) || isOfControl(target, event.key);
    if (isTaken || !this.command(event)) return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Do what a key says; returns whether it says anything. */
  private command({ key, shiftKey }: KeyboardEvent): boolean {
    const { viewer } = this;
    const { camera, panel, options } = viewer;
    if (!camera) return false;
    const command = CAMERA_KEYS[key];
    if (command in DIRECTIONS) {
      const [x, y] = DIRECTIONS[command].map((way) => way * KEY_STEP);
      if (camera.flat === shiftKey) camera.rotate(-x, -y);
      else camera.pan(x, y);
      viewer.reportCamera();
    } else if (command === "closer" || command === "farther") {
      const { wheel_zoom: notch } = camera.limits;
      camera.zoomBy(command === "closer" ? notch : 1 / notch);
      viewer.reportCamera();
    } else if (command === "whole") viewer.reset();
    else if (command === "next" || command === "previous") viewer.step(command === "next" ? 1 : -1);
    else if (command === "detail") viewer.choose("lod", !viewer.settings.lod);
    else if (key === PLAY_KEY) viewer.togglePlaying();
    else if (key === FULLSCREEN_KEY) panel.fullscreen();
    else if (key === "h") (options.follows?.panel ?? panel).toggle();
    else if (key === HELP_KEY) panel.showHelp();
    else if (key === CLOSE_KEY) {
      panel.fold();
      panel.showHelp(false);
      viewer.card.close();
      this.hold(false);
    } else return false;
    return true;
  }
}
