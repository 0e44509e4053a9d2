// The legend of the colours, with a mark at the value under the pointer.

import { rampOf } from "./colours.ts";
import { dom, numberText } from "./dom.ts";
import { legendLimits, shareOf, type Data, type Header, type Settings } from "./protocol.ts";
import { clamp } from "./vectors.ts";

/** Colours of which the ramp is made. */
const STOPS = 33;

export class Legend {
  readonly element = dom("div", { class: "legend glass", hidden: "" });
  private readonly mark = dom("i", { hidden: "" });

  /** Show a colour map, where colours say anything. */
  show(header: Header, settings: Settings, map: Data | undefined): void {
    const { name, label, unit, bar } = header.scalars;
    this.element.hidden = name === null || !bar || !map || Boolean(settings.show_level);
    if (this.element.hidden || !map) return;
    const ramp = dom("div", { class: "ramp" }, [this.mark]);
    ramp.style.background = rampOf(map, header, settings, STOPS);
    this.mark.hidden = true;
    const ends = legendLimits(header.scalars).map((value) => dom("span", {}, [numberText(value)]));
    this.element.replaceChildren(
      dom("div", { class: "name" }, [unit ? `${label} (${unit})` : label]),
      ramp,
      dom("div", { class: "ends" }, ends),
    );
  }

  point(header: Header | null, value = NaN): void {
    this.mark.hidden = !header || !Number.isFinite(value);
    if (!header || this.mark.hidden) return;
    this.mark.style.left = `${100 * clamp(shareOf(header.scalars)(value), 0, 1)}%`;
  }
}
