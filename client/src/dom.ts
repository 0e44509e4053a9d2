// Elements and texts of the page, and its colour around a view.

import type { Lifetime } from "./lifetime.ts";

export function dom<K extends keyof HTMLElementTagNameMap>(
  kind: K,
  attributes: Record<string, string> = {},
  children: (Node | string)[] = [],
): HTMLElementTagNameMap[K] {
  const element = document.createElement(kind);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** An element of SVG. */
export function shape(tag: string, attributes: Record<string, string | number>, children: Node[] = []): SVGElement {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, `${value}`);
  element.append(...children);
  return element;
}

/** Lines of the icons, in a square of 24. */
const ICONS = {
  play: "M8 5.2v13.6L19 12z",
  pause: "M8.5 6v12M15.5 6v12",
  previous: "M17 6v12l-9-6zM6.5 6v12",
  next: "M7 6v12l9-6zM17.5 6v12",
  home: "M4 11.5 12 5l8 6.5M6.5 10v9h11v-9",
  lod: "M12 3.8l8 4.1-8 4.1-8-4.1zM4 12.2l8 4.1 8-4.1M4 16.3l8 4.1 8-4.1",
  levels: "M3.5 18a8.5 8.5 0 0 1 17 0M7 18a5 5 0 0 1 10 0M10.3 18a1.7 1.7 0 0 1 3.4 0",
  settings: "M4 7h8M17 7h3M4 17h3M12 17h8M14.5 4.8v4.4M9.5 14.8v4.4",
  save: "M12 4v11M7.5 10.8 12 15.3l4.5-4.5M5 19.5h14",
  full: "M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5",
  hide: "M6 9.5l6 6 6-6",
  show: "M6 14.5l6-6 6 6",
};

export type IconName = keyof typeof ICONS;

export function icon(name: IconName): SVGElement {
  const path = shape("path", { d: ICONS[name], ...(name === "play" && { class: "solid" }) });
  return shape("svg", { viewBox: "0 0 24 24", "aria-hidden": "true" }, [path]);
}

/** A number as people read it. */
export function numberText(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return x.toExponential(2).replace("e+", "e");
  return String(Number(x.toPrecision(digits)));
}

/** Units longer than this are left out. */
const UNIT_LENGTH = 12;

/** A number with its unit. */
export function withUnit(text: string, unit: string): string {
  return unit && unit.length <= UNIT_LENGTH ? `${text} ${unit}` : text;
}

/** Pictures of views beside each other, as PNG and in full size where nothing else is said. */
export function pictureOf(
  views: readonly { canvas: HTMLCanvasElement }[],
  size = 1,
  format: ImageEncodeOptions = {},
): Promise<Blob> {
  const widths = views.map(({ canvas }) => Math.max(Math.round(size * canvas.width), 1));
  const height = Math.max(Math.round(size * views[0].canvas.height), 1);
  const all = new OffscreenCanvas(widths.reduce((sum, width) => sum + width, 0), height);
  const pen = all.getContext("2d", { alpha: false });
  let left = 0;
  for (const [n, { canvas }] of views.entries()) {
    pen?.drawImage(canvas, left, 0, widths[n], height);
    left += widths[n];
  }
  return all.convertToBlob(format);
}

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
  private readonly changed: () => void;

  /** `changed` is called when the page goes from light to dark, or back. */
  constructor(root: HTMLElement, lifetime: Lifetime, changed: () => void) {
    this.root = root;
    this.changed = changed;
    const look = () => this.look();
    const observer = new MutationObserver(look);
    for (const element of [document.documentElement, document.body]) {
      lifetime.watch(observer, element, { attributeFilter: THEME });
    }
    lifetime.listen(isDarkWished(), "change", look);
  }

  /** Look at the page once more, and tell of another colour. */
  look(): void {
    const before = String(this.colour);
    this.update();
    if (String(this.colour) !== before) this.changed();
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
