// What the keys and the mouse do, as a dialog over the view. The page that trame serves has its own, with one more key.

import { dom } from "./dom.ts";

const TITLE = "Keys and the mouse";

/** Keys or gestures, and what each does. */
export const HELP: [keys: string, effect: string][] = [
  ["drag", "pan a flat surface, turn a curved one"],
  ["Shift and drag", "the opposite: turn, or pan"],
  ["wheel, two fingers", "zoom to the pointer"],
  ["click", "values and path of a point"],
  ["arrows", "pan"],
  ["+ and -", "zoom"],
  ["space", "play or pause"],
  [", and .", "a step back or on"],
  ["0", "the whole surface"],
  ["d", "level of detail on or off"],
  ["h", "the bar of controls"],
  ["f", "full screen"],
  ["?", "these keys"],
  ["Esc", "close panels and messages"],
];

export class Help {
  readonly element: HTMLElement;
  private readonly button = dom("button", { type: "button", class: "link" }, ["Close"]);

  /** `close` is called when a person closes the dialog. */
  constructor(close: () => void) {
    const rows = HELP.flatMap(([keys, effect]) => [dom("dt", {}, [keys]), dom("dd", {}, [effect])]);
    const attributes = { class: "help glass", role: "dialog", "aria-label": TITLE, hidden: "" };
    const head = dom("div", { class: "first" }, [dom("strong", {}, [TITLE]), this.button]);
    this.element = dom("div", attributes, [head, dom("dl", {}, rows)]);
    this.button.addEventListener("click", close);
  }

  show(shown: boolean): void {
    this.element.hidden = !shown;
    if (shown) this.button.focus();
  }
}

/** A button that presses the key of the dialog: a host that has its own hears it first. */
export function helpButton(root: HTMLElement, key: string): HTMLButtonElement {
  const button = dom("button", { type: "button", class: "link" }, [`${TITLE} (${key})`]);
  const press = { key, bubbles: true, composed: true, cancelable: true };
  button.addEventListener("click", () => root.dispatchEvent(new KeyboardEvent("keydown", press)));
  return button;
}
