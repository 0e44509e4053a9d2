// The legend of the colours, with a mark at the value under the pointer.

import { dom, numberText } from "./dom.ts";
import type { Data, Header, Settings } from "./protocol.ts";
import { clamp } from "./vectors.ts";

/** Colours of which the ramp is made, and those of the map. */
const STOPS = 33;
const COLOURS = 256;

export class Legend {
  readonly element = dom("div", { class: "legend glass", hidden: "" });
  private readonly mark = dom("i", { hidden: "" });

  /** Show a colour map, where colours say anything. */
  show(header: Header, settings: Settings, map: Data | undefined): void {
    const { name, low, high, unit, bar } = header.scalars;
    this.element.hidden = name === null || !bar || !map || Boolean(settings.show_level);
    if (this.element.hidden || !map) return;
    const stops = Array.from({ length: STOPS }, (_, n) => {
      const first = 4 * Math.round((n / (STOPS - 1)) * (COLOURS - 1));
      return `rgb(${map[first]} ${map[first + 1]} ${map[first + 2]})`;
    });
    const ramp = dom("div", { class: "ramp" }, [this.mark]);
    ramp.style.background = `linear-gradient(90deg, ${stops.join(", ")})`;
    this.mark.hidden = true;
    const ends = [low, high].map((value) => dom("span", {}, [numberText(value)]));
    this.element.replaceChildren(
      dom("div", { class: "name" }, [unit ? `${name} (${unit})` : String(name)]),
      ramp,
      dom("div", { class: "ends" }, ends),
    );
  }

  point(header: Header | null, value = NaN): void {
    this.mark.hidden = !header || !Number.isFinite(value);
    if (!header || this.mark.hidden) return;
    const { low, high } = header.scalars;
    this.mark.style.left = `${100 * clamp((value - low) / (high - low || 1), 0, 1)}%`;
  }
}
