// The sheet of settings, made from the table that comes with the header.

import { dom, numberText } from "./dom.ts";
import { isSignFree, type Header, type Row, type Settings, type Value } from "./protocol.ts";
import { clamp } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

/** Stops of a slider for a number that is not whole. */
const SLIDER_STOPS = 400;

/** Whether the flow streams by a clock. */
export function hasStreaming({ slices, image, variant }: Header): boolean {
  return slices.steps === 1 && !image && !isSignFree({ variant });
}

/** Where a setting changes anything; `rebuild` says whether textures can be made again. */
const USES: Record<string, (header: Header, rebuild: boolean) => boolean> = {
  motion: hasStreaming,
  speed: hasStreaming,
  speed_in: hasStreaming,
  period: hasStreaming,
  grain: ({ image }) => !image || Boolean(image.deviations),
  fixed_grain: ({ image }) => !image,
  two_sided: ({ slices }) => slices.sides === 2,
  seed: ({ image }, rebuild) => !image || (Boolean(image.deviations) && rebuild),
  resolution: ({ image }, rebuild) => !image || (Boolean(image.deviations) && rebuild),
  tiles: ({ image }) => Boolean(image) && !image?.deviations,
  lines: ({ slices }, rebuild) => slices.steps > 1 && rebuild,
  parameter: ({ slices, settings }, rebuild) =>
    rebuild && (slices.steps === 1 || settings.lines !== "pathlines"),
  critical_points: ({ structure }) => Boolean(structure?.parts.includes("critical")),
  separatrices: ({ structure }) => Boolean(structure?.parts.includes("separatrices")),
  nullclines: ({ structure }) => Boolean(structure?.parts.includes("nullclines")),
  // These have a button in the bar.
  lod: () => false,
  show_level: () => false,
};

export function isUseful({ name, affects }: Row, header: Header, rebuild: boolean): boolean {
  return USES[name]?.(header, rebuild) ?? (affects === "uniform" || rebuild);
}

/** Whether a setting makes a difference as the others are. */
export function isInUse({ needs = [] }: Row, settings: Settings): boolean {
  const holds = needs.map(([name, sign, value]) => (settings[name] === value) === (sign === "=="));
  return !needs.length || holds.includes(true);
}

interface Control {
  /** What it is for, and its line. */
  row: Row;
  line: HTMLElement;
  input: HTMLElement;
  show: (value: Value) => void;
  /** The value beside a slider. */
  output?: HTMLElement;
}

type Made = Omit<Control, "row" | "line">;

export class Controls {
  readonly element = dom("div", { class: "settings glass", hidden: "", role: "group", "aria-label": "Settings" });
  private readonly viewer: Viewer;
  private readonly controls = new Map<string, Control>();
  private rows: Row[] | null = null;

  constructor(viewer: Viewer) {
    this.viewer = viewer;
  }

  /** Make the controls that a scene has use for; returns whether they have changed. */
  build(header: Header): boolean {
    const rebuild = this.viewer.options.rebuild ?? false;
    const rows = header.table.filter((each) => isUseful(each, header, rebuild));
    const kindOf = (some: Row[] | null) => JSON.stringify(some?.map((row) => ({ ...row, default: null })));
    if (kindOf(rows) === kindOf(this.rows)) return false;
    this.rows = rows;
    const focused = [...this.controls.values()].find(({ input }) => input.matches(":focus"));
    this.controls.clear();
    this.element.replaceChildren();
    for (const row of rows) {
      const control = this.control(row);
      const { input, output } = control;
      // A label would name the value beside the slider instead, the first element that can have one.
      input.setAttribute("aria-label", row.label);
      const name = dom("span", { class: "name" }, [row.label]);
      const attributes = { class: "row", "data-setting": row.name };
      const line = dom("label", attributes, [name, ...(output ? [output] : []), input]);
      line.classList.toggle("ranged", output !== undefined);
      this.controls.set(row.name, { ...control, row, line });
      this.element.append(line);
    }
    if (focused) this.controls.get(focused.row.name)?.input.focus();
    return true;
  }

  /** The rows of a formula's parameters. */
  get parameters(): HTMLElement[] {
    return [...this.controls.values()].filter(({ row }) => row.name.startsWith("formula.")).map(({ line }) => line);
  }

  update(): void {
    const { settings } = this.viewer;
    for (const [name, { row, line, show }] of this.controls) {
      if (name in settings) show(settings[name]);
      const isIdle = !isInUse(row, settings);
      line.classList.toggle("idle", isIdle);
      line.title = isIdle ? `${row.condition} ${row.text}` : row.text;
    }
  }

  private control(row: Row): Made {
    if (row.control === "checkbox") return this.switch(row);
    if (row.control === "choice") return this.menu(row);
    return row.control === "number" ? this.numberField(row) : this.slider(row);
  }

  private switch({ name }: Row): Made {
    const input = dom("input", { type: "checkbox", role: "switch" });
    this.viewer.lifetime.listen(input, "change", () => this.viewer.choose(name, input.checked));
    return { input, show: (value) => void (input.checked = Boolean(value)) };
  }

  private menu({ name, choices }: Row): Made {
    const options = choices.map((choice) => dom("option", { value: choice }, [choice]));
    const input = dom("select", {}, options);
    this.viewer.lifetime.listen(input, "change", () => this.viewer.choose(name, input.value));
    return { input, show: (value) => void (input.value = String(value)) };
  }

  private numberField({ name, whole, low, high }: Row): Made {
    const [min, max] = [low ?? 0, high ?? 1];
    const step = whole ? "1" : "any";
    const input = dom("input", { type: "number", min: String(min), max: String(max), step });
    this.viewer.lifetime.listen(input, "change", () => {
      const { valueAsNumber: value } = input;
      if (Number.isFinite(value)) this.viewer.choose(name, clamp(value, min, max));
    });
    return { input, show: (value) => void (input.value = String(value)) };
  }

  private slider(row: Row): Made {
    const { toSlider, fromSlider, min, max, step } = scaleOf(row);
    const range = { min: String(min), max: String(max), step: String(step) };
    const input = dom("input", { type: "range", ...range });
    const output = dom("output");
    const value = () => fromSlider(Number(input.value));
    const write = (shown: Value) => void (output.textContent = numberText(Number(shown)));
    this.viewer.lifetime.listen(input, "input", () => write(value()));
    // Changes that need new traces or textures wait until the pointer is released.
    const kind = row.affects === "uniform" ? "input" : "change";
    this.viewer.lifetime.listen(input, kind, () => this.viewer.choose(row.name, value()));
    const show = (shown: Value) => {
      input.value = String(toSlider(Number(shown)));
      write(shown);
    };
    return { input, output, show };
  }
}

/** Values of a setting as places of a slider: evenly, or by the logarithm. */
export function scaleOf(row: Pick<Row, "low" | "high" | "whole" | "logarithmic">) {
  const { low, high, whole, logarithmic } = row;
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
