// How the texture at a point is computed, below a live view: sliders of what enters, the samples
// that are met along the path with their weights, and their sum. Its looks are the page's.

import { dom, numberText, shape } from "./dom.ts";
import type { FlowtexView } from "./element.ts";
import type { Options } from "./options.ts";
import { pixelSum, type PixelSum, type Sample } from "./pixelsum.ts";
import type { Value } from "./protocol.ts";
import type { Viewer } from "./viewer.ts";

/** Where a point is chosen at first, in the view from -1 to 1. */
const FIRST_POINT = [-0.4, 0.5] as const;
/** Doublings of the zoom. */
const ZOOM = "zoom";
/** Sliders: setting, label, lowest and highest value, step. */
const SLIDERS: [name: string, label: string, low: number, high: number, step: number][] = [
  ["samples", "Samples, K", 1, 49, 2],
  ["spacing", "Spacing, Δt", 0.1, 3, 0.1],
  ["grain", "Grain, pixels", 2, 24, 1],
  ["seed", "Noise seed", 0, 20, 1],
  [ZOOM, "Zoom", 0, 12, 0.25],
];
const KERNELS = { hann: "smooth", box: "even", ramp: "falling" };
/** Heights of bars in a row of bars. */
const ROW = 40;

/** A row of marks, one for each sample, as wide as the page lets it be. */
function row(name: string, count: number, marks: Mark[]): HTMLElement {
  const bars = marks.map(({ at, y, height, fill, title }) => {
    const words = shape("title", {}, [document.createTextNode(title)]);
    return shape("rect", { x: at + 0.04, y, width: 0.92, height: Math.max(height, 0.4), fill }, [words]);
  });
  const box = { viewBox: `0 0 ${count} ${ROW}`, preserveAspectRatio: "none", "aria-hidden": "true" };
  const svg = shape("svg", box, bars);
  return dom("div", { class: "explained-row" }, [dom("span", {}, [name]), svg]);
}

interface Mark {
  at: number;
  y: number;
  height: number;
  fill: string;
  title: string;
}

const greyText = (grey: number) => `rgb(${Array(3).fill(Math.round(255 * grey)).join()})`;
const signed = (value: number) => `${value < 0 ? "−" : "+"}${Math.abs(value).toFixed(2)}`;

export class Explanation {
  readonly options: Options;
  private readonly controls = dom("div", { class: "explained-controls" });
  private readonly strip = dom("div", { class: "explained-strip" });
  private readonly words = dom("p", { class: "explained-sum", role: "status" });
  private readonly chosen = new Map<string, Value>();
  private readonly shows = new Map<string, (value: Value) => void>();
  private viewer: Viewer | null = null;
  private sum: PixelSum | null = null;
  private isBegun = false;

  /** Set up below the element of a live view. */
  constructor(element: HTMLElement) {
    this.options = {
      controls: false,
      explainer: { explain: (pixel) => this.tell(pixelSum(pixel)), clear: () => void this.tell(null) },
    };
    for (const slider of SLIDERS) this.controls.append(this.slider(slider));
    this.controls.append(this.menu(), this.box());
    const panel = dom("div", { class: "explained" }, [this.controls, this.strip, this.words]);
    element.after(panel);
    this.tell(null);
  }

  /** Explain a view. */
  attach(view: FlowtexView): void {
    const viewer = (this.viewer = view.first);
    view.addEventListener("frame", () => this.begin());
    view.addEventListener("camera", () => this.follow());
    this.isBegun = false;
    viewer.setSettings(Object.fromEntries(this.chosen));
    for (const [name, show] of this.shows) if (name in viewer.settings) show(viewer.settings[name]);
    this.shows.get(ZOOM)?.(0);
  }

  /** Choose a point once there is a picture. */
  private begin(): void {
    if (this.isBegun) return;
    this.isBegun = true;
    this.viewer?.card.choose(...FIRST_POINT);
  }

  private follow(): void {
    const { viewer } = this;
    if (viewer?.camera) this.shows.get(ZOOM)?.(Math.log2(viewer.camera.zoom));
    viewer?.card.update();
  }

  private change(name: string, value: Value): void {
    const { viewer, sum } = this;
    if (name !== ZOOM) this.chosen.set(name, value);
    if (!viewer?.camera) return;
    if (name === ZOOM) {
      const { camera } = viewer;
      const point = sum?.samples[sum.middle].position;
      const place = (point && camera.project(point)) ?? [0, 0];
      camera.zoomBy(2 ** Number(value) / camera.zoom, ...place);
      viewer.reportCamera();
    } else viewer.choose(name, value);
    viewer.card.update();
  }

  private slider([name, label, low, high, step]: (typeof SLIDERS)[0]): HTMLElement {
    const range = { min: `${low}`, max: `${high}`, step: `${step}` };
    const input = dom("input", { type: "range", "data-setting": name, ...range });
    const output = dom("output");
    const write = (value: number) => {
      output.textContent = name === ZOOM ? `×${numberText(2 ** value, 2)}` : numberText(value, 2);
    };
    input.addEventListener("input", () => {
      write(input.valueAsNumber);
      this.change(name, input.valueAsNumber);
    });
    this.shows.set(name, (value) => {
      input.value = String(value);
      write(Number(value));
    });
    return dom("label", {}, [dom("span", {}, [label]), output, input]);
  }

  private menu(): HTMLElement {
    const options = Object.entries(KERNELS).map(([value, name]) => dom("option", { value }, [name]));
    const input = dom("select", { "data-setting": "kernel" }, options);
    input.addEventListener("change", () => this.change("kernel", input.value));
    this.shows.set("kernel", (value) => void (input.value = String(value)));
    return dom("label", {}, [dom("span", {}, ["Kernel"]), input]);
  }

  private box(): HTMLElement {
    const input = dom("input", { type: "checkbox", "data-setting": "lod" });
    input.addEventListener("change", () => this.change("lod", input.checked));
    this.shows.set("lod", (value) => void (input.checked = Boolean(value)));
    return dom("label", { class: "explained-box" }, [input, dom("span", {}, ["Level of detail"])]);
  }

  private tell(sum: PixelSum | null): Sample[] {
    this.sum = sum;
    if (!sum) {
      this.words.replaceChildren("Click a point of the picture.");
      this.strip.replaceChildren();
      return [];
    }
    const { samples, mean, gain, grey, level } = sum;
    const most = Math.max(...samples.map(({ weight }) => weight));
    const products = samples.map(({ weight, noise }) => weight * noise);
    const largest = Math.max(...products.map(Math.abs), 1e-9);
    const marks = (mark: (n: number) => Omit<Mark, "at" | "title">): Mark[] =>
      samples.map(({ weight, noise }, at) => {
        const title = `sample ${at - sum.middle}: weight ${weight.toFixed(3)}, noise ${signed(noise)}`;
        return { at, title, ...mark(at) };
      });
    const noises = marks((n) => ({ y: 0, height: ROW, fill: greyText(samples[n].grey) }));
    const weights = marks((n) => {
      const height = (samples[n].weight / most) * ROW;
      return { y: ROW - height, height, fill: "currentColor" };
    });
    const both = marks((n) => {
      const height = ((Math.abs(products[n]) / largest) * ROW) / 2;
      return { y: products[n] > 0 ? ROW / 2 - height : ROW / 2, height, fill: "currentColor" };
    });
    const ends = dom("div", { class: "explained-ends" }, [
      dom("span", {}, ["← where the particle was"]),
      dom("span", {}, ["where it will be →"]),
    ]);
    this.strip.replaceChildren(
      row("noise", samples.length, noises),
      row("weight", samples.length, weights),
      row("product", samples.length, both),
      ends,
    );
    const swatch = dom("span", { class: "explained-pixel" });
    swatch.style.background = greyText(grey);
    this.words.replaceChildren(
      `${samples.length} samples at level ${level.toFixed(1)}. Sum of the products: ${signed(mean)}; `,
      `times ${gain.toFixed(2)}, so that the contrast is the same for every K: `,
      dom("strong", {}, [signed(gain * mean)]),
      ", this grey: ",
      swatch,
    );
    return samples;
  }
}
