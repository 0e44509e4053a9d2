// The legend of the colours, with a mark at the value under the pointer.

import { placeOf, rampOf } from "./colours.ts";
import { dom } from "./dom.ts";
import { beyondEnds, legendLimits, type Data, type Header, type Settings, type StructureHeader } from "./protocol.ts";
import { ticksOf } from "./ticks.ts";
import { clamp } from "./vectors.ts";

/** Colours of which the ramp is made. */
const STOPS = 33;
/** Characters of all ticks for which a legend has room. */
const MOST_CHARACTERS = 16;
/** Share of the ramp beside an end in which the text of a tick ends where the ramp does. */
const END_SHARE = 0.1;

type Kinds = StructureHeader["kinds"];

export class Legend {
  /** Kinds of critical points, each with its mark. */
  readonly kinds = dom("div", { class: "kinds glass", hidden: "" });
  private shownKinds = "";
  private place = (value: number) => value;

  readonly element = dom("div", { class: "legend glass", hidden: "" });
  private readonly mark = dom("i", { hidden: "" });

  /** Show a colour map, where colours say anything. */
  show(header: Header, settings: Settings, map: Data | undefined): void {
    const { name, label, unit, bar } = header.scalars;
    this.element.hidden = name === null || !bar || !map || Boolean(settings.show_level);
    if (this.element.hidden || !map) return;
    const ramp = dom("div", { class: "ramp" }, [this.mark]);
    ramp.style.background = rampOf(map, header, settings, STOPS);
    const [isBelow, isAbove] = beyondEnds(header.scalars);
    ramp.classList.toggle("below", isBelow);
    ramp.classList.toggle("above", isAbove);
    this.mark.hidden = true;
    const place = placeOf(header.scalars, map);
    this.place = place;
    const ticks = legendTicks(header).map(({ value, text }) => {
      const tick = dom("span", {}, [text]);
      const share = clamp(place(value), 0, 1);
      tick.style.left = `${100 * share}%`;
      const isAtEnd = Math.abs(share - 0.5) > 0.5 - END_SHARE;
      tick.style.transform = `translateX(${isAtEnd ? -100 * share : -50}%)`;
      return tick;
    });
    this.element.replaceChildren(
      dom("div", { class: "name" }, [unit ? `${label} (${unit})` : label]),
      ramp,
      dom("div", { class: "ticks" }, ticks),
    );
  }

  showKinds(kinds: Kinds): void {
    const names = kinds.map(({ name, color }) => `${name} ${color}`).join();
    if (names === this.shownKinds) return;
    this.shownKinds = names;
    this.kinds.hidden = !names;
    this.kinds.replaceChildren(
      ...kinds.map(({ name, color, turns, isLine, isGround }) => {
        const mark = dom("i", { class: turns ? "turns" : isLine ? "line" : "" });
        mark.style.background = `rgb(${color.map((c) => Math.round(255 * c)).join(" ")})`;
        return dom("span", { class: isGround ? "ground" : "" }, [mark, name]);
      }),
    );
  }

  point(header: Header | null, value = NaN): void {
    this.mark.hidden = !header || !Number.isFinite(value);
    if (!header || this.mark.hidden) return;
    this.mark.style.left = `${100 * clamp(this.place(value), 0, 1)}%`;
  }
}

/** As many round values as there is room for. */
function legendTicks({ scalars }: Header) {
  if (scalars.ticks.length) return scalars.ticks;
  const [low, high] = legendLimits(scalars);
  const ticks = [5, 4, 3].map((most) => ticksOf(low, high, scalars.log, most));
  const size = (some: typeof ticks[0]) => some.reduce((sum, { text }) => sum + text.length, 0);
  return ticks.find((some) => size(some) <= MOST_CHARACTERS) ?? ticks[2];
}
