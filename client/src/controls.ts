// The sheet of settings, made from the table that comes with the header.

import { dom, numberText } from "./dom.ts";
import type { Lifetime } from "./lifetime.ts";
import { isSignFree, type Header, type Row, type Settings, type Value } from "./protocol.ts";
import { clamp } from "./vectors.ts";

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

/** The view whose settings are shown. */
export interface ControlsHost {
  readonly lifetime: Lifetime;
  readonly options: { rebuild?: boolean };
  readonly settings: Settings;
  choose(name: string, value: Value): void;
}

export class Controls {
  readonly element = dom("div", { class: "settings glass", hidden: "", "aria-label": "Settings" });
  private readonly viewer: ControlsHost;
  private readonly controls = new Map<string, Control>();

  constructor(viewer: ControlsHost) {
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
    switch (row.control) {
      case "checkbox":
        return this.switch(row);
      case "choice":
        return this.menu(row);
      case "number":
        return this.numberField(row);
      default:
        return this.slider(row);
    }
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

  private numberField({ name, whole, low, high }: Row): Control {
    const [min, max] = [low ?? 0, high ?? 1];
    const step = whole ? "1" : "any";
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

/** Values of a setting as places of a slider: evenly, or by the logarithm. */
export function scaleOf({ low, high, whole, logarithmic }: Pick<Row, "low" | "high" | "whole" | "logarithmic">) {
  const [least, most] = [low ?? 0, high ?? 1];
  const toSlider = (value: number) => (logarithmic ? Math.log2(value) : value);
  const fromSlider = (place: number) => {
    const value = logarithmic ? 2 ** place : place;
    return whole ? Math.round(value) : Number(clamp(value, least, most).toPrecision(3));
  };
  const [min, max] = [least, most].map(toSlider);
  const step = whole && !logarithmic ? 1 : (max - min) / SLIDER_STOPS;
  return { toSlider, fromSlider, min, max, step };
}
