// Controls of the appearance: what the surface is coloured by, the map, its range, and lines of the Earth.

import { choiceOf, rampOf, mapOf } from "./colours.ts";
import { dom, numberText } from "./dom.ts";
import { EARTH_LINES, legendLimits, type EarthLines, type Header, type Part } from "./protocol.ts";
import type { Viewer } from "./viewer.ts";

/** Colours of a swatch, and the choice of none. */
const STOPS = 9;
const PLAIN = "none";
const LINE_NAMES: Record<EarthLines, string> = { coastlines: "Coastlines", graticule: "Graticule" };

const labelled = (name: string, input: HTMLElement) =>
  dom("label", { class: "row" }, [dom("span", { class: "name" }, [name]), input]);

export class ColourControls {
  readonly element = dom("div", { class: "colours" });
  private readonly viewer: Viewer;
  private readonly scalars = dom("select", { "aria-label": "Colour by" });
  private readonly swatches = dom("div", { class: "swatches", role: "group", "aria-label": "Colour map" });
  private readonly ends = ["Lowest value", "Highest value"].map((name) =>
    dom("input", { type: "number", step: "any", "aria-label": name }),
  );
  private readonly auto = dom("button", { type: "button", class: "link" }, ["auto"]);
  /** What only a host can make. */
  private readonly robust = dom("button", { type: "button", class: "link" }, ["robust"]);
  private readonly log = dom("input", { type: "checkbox", role: "switch" });
  private readonly opacity = dom("input", { type: "range", min: "0", max: "1", step: "0.05" });
  private readonly logRow = labelled("Log scale", this.log);
  private readonly opacityRow = labelled("Opacity", this.opacity);
  private readonly mapRow: HTMLElement;
  private readonly rangeRow: HTMLElement;
  private readonly lines = dom("div", { class: "colours" });

  constructor(viewer: Viewer) {
    this.viewer = viewer;
    const { scalars, swatches, ends, auto } = this;
    const { lifetime } = viewer;
    lifetime.listen(scalars, "change", () => {
      const name = scalars.value === PLAIN ? false : scalars.value;
      if (viewer.header) viewer.chooseColours(choiceOf(viewer.header, name));
    });
    for (const end of ends) lifetime.listen(end, "change", () => this.takeRange());
    lifetime.listen(auto, "click", () => viewer.chooseColours({ clim: null }));
    lifetime.listen(this.robust, "click", () => viewer.chooseColours({ clim: "robust" }));
    lifetime.listen(this.log, "change", () => viewer.chooseColours({ log_scale: this.log.checked }));
    lifetime.listen(this.opacity, "input", () => viewer.chooseColours({ opacity: this.opacity.valueAsNumber }));
    this.robust.title = "Ignore the lowest and the highest values.";
    lifetime.listen(swatches, "click", (event: MouseEvent) => {
      const name = (event.target as HTMLElement).dataset.cmap;
      if (name) viewer.chooseColours({ cmap: name });
    });
    const row = (name: string, ...fields: HTMLElement[]) =>
      dom("div", { class: "row" }, [dom("span", { class: "name" }, [name]), ...fields]);
    this.rangeRow = row("Range", dom("span", { class: "between" }, [...ends, auto, this.robust]));
    this.mapRow = row("Colour map", swatches);
    this.mapRow.classList.add("ranged");
    this.opacityRow.classList.add("ranged");
    this.element.append(row("Colour by", scalars), this.mapRow, this.rangeRow, this.logRow, this.opacityRow);
  }

  /** Rows of all controls, from the topmost. */
  get rows(): HTMLElement[] {
    return [this.element, this.lines];
  }

  /** Switches of the lines of the Earth that the scene has. */
  private updateLines(): void {
    const { header, parts, lifetime } = this.viewer;
    const names = EARTH_LINES.filter((name) => header?.earth && parts.has(name));
    this.lines.hidden = !names.length;
    if (this.lines.children.length !== names.length) {
      this.lines.replaceChildren(
        ...names.map((name) => {
          const input = dom("input", { type: "checkbox", role: "switch" });
          lifetime.listen(input, "change", () =>
            this.viewer.chooseColours({ [name]: input.checked }),
          );
          const label = dom("span", { class: "name" }, [LINE_NAMES[name]]);
          return dom("label", { class: "row", "data-lines": name }, [label, input]);
        }),
      );
    }
    names.forEach((name, n) => {
      const input = this.lines.children[n].querySelector("input");
      if (input) input.checked = header?.earth?.[name] ?? false;
    });
  }

  /** Show the colours as they are, where others can be chosen. */
  update(): void {
    const { header, parts } = this.viewer;
    this.updateLines();
    const maps = parts.get("maps");
    this.element.hidden = !header?.scalars.choices.length || !maps;
    if (!header || !maps || this.element.hidden) return;
    const { choices, name, auto } = header.scalars;
    const options = [...choices, { name: PLAIN, label: PLAIN }];
    this.scalars.replaceChildren(...options.map((each) => dom("option", { value: each.name }, [each.label])));
    this.scalars.value = name ?? PLAIN;
    const isHosted = this.viewer.options.onColours !== undefined;
    this.mapRow.hidden = this.rangeRow.hidden = name === null;
    this.logRow.hidden = this.mapRow.hidden || !isHosted;
    this.robust.hidden = !isHosted;
    this.log.checked = header.scalars.log;
    this.opacity.value = String(header.opacity);
    legendLimits(header.scalars).forEach((value, n) => {
      this.ends[n].value = String(Number(value.toPrecision(4)));
    });
    this.auto.setAttribute("aria-pressed", String(auto));
    this.updateSwatches(header, maps.data);
  }

  /** Show the colour maps; buttons stay where the names do, as one of them may have the focus. */
  private updateSwatches(header: Header, maps: Part["data"]): void {
    const { swatches } = this;
    const { maps: names, cmap } = header.scalars;
    const isSame = swatches.childElementCount === names.length && names.every((name, n) => name === this.swatch(n).title);
    if (!isSame) {
      swatches.replaceChildren(
        ...names.map((name) => dom("button", { type: "button", title: name, "aria-label": name, "data-cmap": name })),
      );
    }
    names.forEach((name, n) => {
      const swatch = this.swatch(n);
      swatch.setAttribute("aria-pressed", String(name === cmap));
      swatch.style.background = rampOf(mapOf(header, maps, name), header, this.viewer.settings, STOPS);
    });
  }

  private swatch(n: number): HTMLElement {
    return this.swatches.children[n] as HTMLElement;
  }

  private takeRange(): void {
    const [low, high] = this.ends.map((end) => end.valueAsNumber);
    this.rangeRow.title = "";
    if (low < high) this.viewer.chooseColours({ clim: [low, high] });
    else this.rangeRow.title = `${numberText(low)} is not below ${numberText(high)}`;
    for (const end of this.ends) end.setCustomValidity(this.rangeRow.title);
  }
}
