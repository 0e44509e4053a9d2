// The page around a view: its colour, and whether that is dark.

import type { Lifetime } from "./lifetime.ts";

const WHITE = [1, 1, 1];
/** Lightness, from 0 to 1, below which a page is dark. */
const DARK = 0.5;
/** What pages and notebooks change when they go from light to dark. */
const THEME = ["class", "style", "data-theme", "data-jp-theme-light", "data-vscode-theme-kind"];

const isDarkWished = () => matchMedia("(prefers-color-scheme: dark)");

/** Colour of the page around an element, from 0 to 1. */
function groundAround(element: HTMLElement): number[] {
  const colours: string[] = [];
  for (let at: Element | null = element; at; ) {
    colours.push(getComputedStyle(at).backgroundColor);
    const root: Node = at.getRootNode();
    at = at.parentElement ?? (root instanceof ShadowRoot ? root.host : null);
  }
  const pen = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  if (!pen) return WHITE;
  const { colorScheme } = getComputedStyle(document.documentElement);
  const isDark = colorScheme.includes("dark") && (!colorScheme.includes("light") || isDarkWished().matches);
  // Below all others is the browser's own.
  for (const colour of [isDark ? "#121212" : "white", ...colours.reverse()]) {
    pen.fillStyle = colour;
    pen.fillRect(0, 0, 1, 1);
  }
  return Array.from(pen.getImageData(0, 0, 1, 1).data.subarray(0, 3), (value) => value / 255);
}

export class Ground {
  /** Red, green and blue of the page, from 0 to 1. */
  colour = WHITE;
  private readonly root: HTMLElement;

  /** `changed` is called when the page goes from light to dark, or back. */
  constructor(root: HTMLElement, lifetime: Lifetime, changed: () => void) {
    this.root = root;
    const look = () => {
      const before = String(this.colour);
      this.update();
      if (String(this.colour) !== before) changed();
    };
    const observer = new MutationObserver(look);
    for (const element of [document.documentElement, document.body]) {
      lifetime.watch(observer, element, { attributeFilter: THEME });
    }
    lifetime.listen(isDarkWished(), "change", look);
  }

  /** Look at the page once more. */
  update(): void {
    const { root } = this;
    if (!root.parentElement) return;
    this.colour = groundAround(root.parentElement);
    const [r, g, b] = this.colour.map((value) => Math.round(255 * value));
    root.classList.toggle("flowtex-dark", (0.299 * r + 0.587 * g + 0.114 * b) / 255 < DARK);
    root.style.setProperty("--ground", `rgb(${r} ${g} ${b})`);
  }
}
