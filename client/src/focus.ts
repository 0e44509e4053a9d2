// Where the focus goes when the element that has it is hidden or removed.

import type { Lifetime } from "./lifetime.ts";

const isShown = (element: HTMLElement) => element.getClientRects().length > 0;

export class Focus {
  /** Elements that had the focus, the latest last. */
  private had: HTMLElement[] = [];
  /** The element that has the focus, or had it until it was hidden or removed. */
  private current: HTMLElement | null = null;
  private readonly fallback: (lost: HTMLElement) => HTMLElement | null;

  /** `fallback` gives an element where nothing that had the focus is shown any more. */
  constructor(
    scope: Document | ShadowRoot,
    lifetime: Lifetime,
    fallback: (lost: HTMLElement) => HTMLElement | null,
  ) {
    this.fallback = fallback;
    lifetime.listen(scope, "focusin", ({ target }: FocusEvent) => {
      const element = target as HTMLElement;
      this.had = this.had.filter((each) => each !== element && each.isConnected);
      this.had.push(element);
      this.current = element;
    });
    // Browsers take the focus from what is hidden or removed while or after that happens: whether a person has
    // left the element is known when what runs now is over.
    lifetime.listen(scope, "focusout", ({ target }: FocusEvent) => {
      queueMicrotask(() => {
        if (this.current === target && isShown(this.current as HTMLElement)) this.current = null;
      });
    });
  }

  /** Give the focus back, if the element that has it is no longer shown; call it before the next frame. */
  keep(): void {
    const lost = this.current;
    if (!lost || isShown(lost)) return;
    const shown = this.had.filter(isShown);
    const next = shown.length ? shown[shown.length - 1] : this.fallback(lost);
    next?.focus({ preventScroll: true });
  }
}
