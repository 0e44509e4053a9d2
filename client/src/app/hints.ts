// One hint at a time: what a control is for, while the pointer rests on it or the keyboard is there.

import { clamp } from "../vectors.ts";
import { vue } from "./vue.ts";

/** Milliseconds for which the pointer rests first, and pixels between a control and its hint. */
const DELAY_MS = 400;
const GAP_PX = 10;

/** Put a hint beside its subject, on the requested side, or below it, within the window. */
function put(box: HTMLElement, owner: HTMLElement): void {
  const at = owner.getBoundingClientRect();
  const { offsetWidth: width, offsetHeight: height } = box;
  const middle = [at.left + (at.width - width) / 2, at.top + (at.height - height) / 2];
  const below = [middle[0], at.bottom + GAP_PX];
  const above = [middle[0], at.top - height - GAP_PX];
  const places: Record<string, number[]> = {
    start: [at.left - width - 2 * GAP_PX, middle[1]],
    end: [at.right + 2 * GAP_PX, middle[1]],
    top: above,
  };
  let [left, top] = places[owner.dataset.side ?? ""] ?? below;
  if (left < 0 || left + width > innerWidth) [left, top] = below;
  if (top + height > innerHeight) [left, top] = above;
  box.style.left = `${clamp(left, 4, innerWidth - width - 4)}px`;
  box.style.top = `${Math.max(top, 4)}px`;
}

class Hint {
  private readonly box: HTMLElement;
  private owner: HTMLElement | null = null;
  private timer = 0;
  private byKeyboard = false;

  constructor(box: HTMLElement) {
    this.box = box;
  }

  private show(owner: HTMLElement): void {
    this.box.textContent = owner.dataset.hint ?? "";
    this.box.hidden = !this.box.textContent;
    put(this.box, owner);
  }

  /** Hide it; it does not come back before the pointer has been elsewhere. */
  readonly hide = (event?: Event) => {
    if (event) this.byKeyboard = event.type === "keydown";
    clearTimeout(this.timer);
    this.box.hidden = true;
  };

  /** Hide one that does not move along; one that is about to be shown is put where it belongs. */
  readonly scroll = () => {
    this.box.hidden = true;
  };

  readonly leave = () => {
    this.hide();
    this.owner = null;
  };

  private take(target: EventTarget | null, delay: number): void {
    const owner = target instanceof Element ? target.closest<HTMLElement>("[data-hint]") : null;
    if (owner === this.owner && owner) return;
    this.leave();
    this.owner = owner;
    if (owner) this.timer = window.setTimeout(() => this.show(owner), delay);
  }

  readonly point = (event: PointerEvent) => {
    if (event.pointerType !== "touch") this.take(event.target, DELAY_MS);
  };

  readonly focus = (event: FocusEvent) => {
    if (this.byKeyboard) this.take(event.target, 0);
  };
}

export const hints = {
  name: "flowtex-hints",
  setup() {
    const { h, ref, onMounted, onBeforeUnmount } = vue();
    const place = ref<HTMLElement | null>(null);
    const ended = new AbortController();
    onMounted(() => {
      if (!place.value) return;
      const hint = new Hint(place.value);
      const options = { signal: ended.signal, capture: true };
      window.addEventListener("pointerover", hint.point, options);
      window.addEventListener("focusin", hint.focus, options);
      for (const name of ["focusout", "blur"]) window.addEventListener(name, hint.leave, options);
      for (const name of ["pointerdown", "keydown"]) window.addEventListener(name, hint.hide, options);
      window.addEventListener("scroll", hint.scroll, options);
      document.documentElement.addEventListener("pointerleave", hint.leave, { signal: ended.signal });
    });
    onBeforeUnmount(() => ended.abort());
    return () => h("div", { ref: place, role: "tooltip", class: "flowtex-tooltip", hidden: true });
  },
};
