// The sheet of settings, made from the table that comes with the header.

import { dom, numberText } from "./dom.ts";
import { isSignFree, type Header, type Row, type Value } from "./protocol.ts";
import { clamp } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

/** A range with more values than these, or whole numbers, is typed. */
const MOST_STOPS = 100_000;
const MOST_WHOLE_STOPS = 20_000;
/** A range of a greater ratio goes by its logarithm. */
const LOGARITHMIC_RATIO = 60;
/** Stops of a slider for a number that is not whole. */
const SLIDER_STOPS = 400;
/** Settings with a button in the bar. */
const IN_BAR = ["lod", "show_level"];

/** Whether a clock moves the picture. */
export function hasStreaming(header: Header): boolean {
  return header.slices.steps === 1 && !header.paper && !isSignFree(header);
}

/** Whether a setting changes anything here; `rebuild` tells whether textures can be made anew. */
export function isUseful(row: Row, header: Header, rebuild: boolean): boolean {
  const { paper, slices } = header;
  switch (row.name) {
    case "motion":
    case "speed":
    case "speed_in":
    case "period":
      return hasStreaming(header);
    case "grain":
    case "fixed_grain":
      return !paper;
    case "two_sided":
      return slices.sides === 2;
    case "seed":
      return !paper || (rebuild && !paper.picture);
    case "resolution":
      return !paper || rebuild;
    case "tiles":
      return Boolean(paper?.picture) && (header.settings.noise === "image" || rebuild);
    case "noise_correction":
      return Boolean(paper) && rebuild;
    case "parameter":
      return slices.steps === 1 && rebuild;
    default:
      return !IN_BAR.includes(row.name) && (row.affects === "uniform" || rebuild);
  }
}

/** A control, and what shows a value in it. */
interface Control {
  input: HTMLElement;
  show: (value: Value) => void;
  /** The value beside a slider. */
  output?: HTMLElement;
}

export class Controls {
  readonly element = dom("div", { class: "settings glass", hidden: "", "aria-label": "Settings" });
  private readonly viewer: Viewer;
  private readonly controls = new Map<string, Control>();

  constructor(viewer: Viewer) {
    this.viewer = viewer;
  }

  /** Make the controls that are of use in a scene. */
  build(header: Header): void {
    this.controls.clear();
    this.element.replaceChildren();
    const rebuild = this.viewer.options.rebuild ?? false;
    for (const row of header.table.filter((each) => isUseful(each, header, rebuild))) {
      const control = this.control(row);
      this.controls.set(row.name, control);
      const { input, output } = control;
      const name = dom("span", { class: "name" }, [row.label]);
      const attributes = { class: "row", title: row.text, "data-setting": row.name };
      const line = dom("label", attributes, [name, ...(output ? [output] : []), input]);
      line.classList.toggle("ranged", output !== undefined);
      this.element.append(line);
    }
  }

  /** Show the present values. */
  update(): void {
    const { settings } = this.viewer;
    for (const [name, { show }] of this.controls) if (name in settings) show(settings[name]);
  }

  private control(row: Row): Control {
    if (row.kind === "bool") return this.switch(row);
    if (row.choices.length) return this.menu(row);
    const range = (row.high ?? 1) - (row.low ?? 0);
    const isTyped = range > MOST_STOPS || (row.kind === "int" && range > MOST_WHOLE_STOPS);
    return isTyped ? this.numberField(row) : this.slider(row);
  }

  private listen(input: HTMLElement, kind: string, call: () => void): void {
    this.viewer.lifetime.listen(input, kind, call);
  }

  private switch({ name }: Row): Control {
    const input = dom("input", { type: "checkbox", role: "switch" });
    this.listen(input, "change", () => this.viewer.choose(name, input.checked));
    return { input, show: (value) => void (input.checked = Boolean(value)) };
  }

  private menu({ name, choices }: Row): Control {
    const options = choices.map((choice) => dom("option", { value: choice }, [choice]));
    const input = dom("select", {}, options);
    this.listen(input, "change", () => this.viewer.choose(name, input.value));
    return { input, show: (value) => void (input.value = String(value)) };
  }

  private numberField({ name, kind, low, high }: Row): Control {
    const [min, max] = [low ?? 0, high ?? 1];
    const step = kind === "int" ? "1" : "any";
    const input = dom("input", { type: "number", min: String(min), max: String(max), step });
    this.listen(input, "change", () => {
      const { valueAsNumber: value } = input;
      if (Number.isFinite(value)) this.viewer.choose(name, clamp(value, min, max));
    });
    return { input, show: (value) => void (input.value = String(value)) };
  }

  private slider(row: Row): Control {
    const { toSlider, fromSlider, min, max, step } = scaleOf(row);
    const range = { min: String(min), max: String(max), step: String(step) };
    const input = dom("input", { type: "range", ...range });
    const output = dom("output");
    const value = () => fromSlider(Number(input.value));
    this.listen(input, "input", () => void (output.textContent = numberText(value())));
    // What has to be traced or built anew waits until the hand lets go.
    const kind = row.affects === "uniform" ? "input" : "change";
    this.listen(input, kind, () => this.viewer.choose(row.name, value()));
    const show = (shown: Value) => {
      input.value = String(toSlider(Number(shown)));
      output.textContent = numberText(Number(shown));
    };
    return { input, output, show };
  }
}

/** Values of a setting as places of a slider: evenly, or by the logarithm where the range is great. */
export function scaleOf(row: Pick<Row, "kind" | "low" | "high">) {
  const [low, high] = [row.low ?? 0, row.high ?? 1];
  const whole = row.kind === "int";
  const even = !(low > 0 && high / low > LOGARITHMIC_RATIO);
  const toSlider = (value: number) => (even ? value : Math.log2(value));
  const fromSlider = (place: number) => {
    const value = even ? place : 2 ** place;
    return whole ? Math.round(value) : Number(clamp(value, low, high).toPrecision(3));
  };
  const [min, max] = [toSlider(low), toSlider(high)];
  return { toSlider, fromSlider, min, max, step: even && whole ? 1 : (max - min) / SLIDER_STOPS };
}
