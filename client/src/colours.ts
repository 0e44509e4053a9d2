// Colours of the surface: what is chosen of them, and the colours that the picture then has.

import type { Data, Header, NamedPart, Part, Settings, Shading } from "./protocol.ts";
import { clamp } from "./vectors.ts";

/** What a person chooses; a range of null is that of the values. */
export interface ColourChoice {
  scalars?: string | false;
  cmap?: string;
  clim?: [number, number] | "robust" | null;
  log_scale?: boolean;
  opacity?: number;
  coastlines?: boolean;
  graticule?: boolean;
}

/** Name of a part that a client has made: no other one has its digest. */
const OWN = "own cmap";
const SRGB = { knee: 0.04045, slope: 12.92, offset: 0.055, scale: 1.055, power: 2.4 };

/** What of a header says how the surface is coloured. */
export function coloursOf(header: Header): Partial<Header> {
  const { scalars, colour, background, lighting, opacity, earth } = header;
  return { scalars, colour, background, lighting, opacity, earth };
}

/** The table of a map to choose from, (256, 4), of the part that has all of them. */
export function mapOf(header: Header, maps: Data, name: string): Uint8Array {
  const [first, count] = [header.scalars.maps.indexOf(name) * 3 * 256, 256];
  const table = new Uint8Array(4 * count).fill(255);
  for (let n = 0; n < count; n += 1) {
    for (let k = 0; k < 3; k += 1) table[4 * n + k] = maps[first + 3 * n + k];
  }
  return table;
}

/** The choice of other scalars: a map by default is then that of these. */
export function choiceOf({ scalars }: Header, name: string | false): ColourChoice {
  const [before, after] = [scalars.name, name].map((each) => scalars.choices.find((one) => one.name === each));
  const cmap = after?.cmap !== before?.cmap && scalars.cmap === before?.cmap ? after?.cmap : undefined;
  return { scalars: name, clim: null, ...(cmap && { cmap }) };
}

/** Other colours, where no host makes them: what of the header changes, and the map. */
export function recoloured(
  header: Header,
  choice: ColourChoice,
  parts: ReadonlyMap<string, Part>,
): { colours: Partial<Header>; part: NamedPart | null } {
  const scalars = { ...header.scalars };
  if (choice.scalars === false) scalars.name = null;
  const number = scalars.choices.findIndex(({ name }) => name === choice.scalars);
  if (number >= 0) {
    const { name, label, unit, steps, flat } = scalars.choices[number];
    Object.assign(scalars, { name, label, unit, steps, flat, number, auto: true });
  }
  if (choice.cmap) scalars.cmap = choice.cmap;
  if (Array.isArray(choice.clim)) [scalars.low, scalars.high] = choice.clim;
  if (choice.clim !== undefined) scalars.auto = !choice.clim;
  if (scalars.auto && scalars.choices[scalars.number]) {
    const { low, high, cmap = "" } = scalars.choices[scalars.number];
    const isSigned = (low < 0 && high > 0) || scalars.diverging.includes(cmap);
    const widest = isSigned && scalars.diverging.includes(scalars.cmap);
    const end = Math.max(-low, high);
    [scalars.low, scalars.high] = widest ? [-end, end] : [low, high];
  }
  const { coastlines = header.earth?.coastlines, graticule = header.earth?.graticule } = choice;
  const earth = header.earth && { ...header.earth, coastlines, graticule };
  const { opacity = header.opacity } = choice;
  const colours = { scalars, earth, opacity } as Partial<Header>;
  const maps = parts.get("maps");
  if (!choice.cmap || !maps) return { colours, part: null };
  const data = mapOf(header, maps.data, choice.cmap);
  const part = { name: "cmap", data, shape: [256, 4], digest: `${OWN} ${choice.cmap}` };
  return { colours, part };
}

const toLinear = (c: number) =>
  c < SRGB.knee ? c / SRGB.slope : ((c + SRGB.offset) / SRGB.scale) ** SRGB.power;

function fromLinear(x: number): number {
  const c = clamp(x, 0, 1);
  if (c < SRGB.knee / SRGB.slope) return c * SRGB.slope;
  return SRGB.scale * c ** (1 / SRGB.power) - SRGB.offset;
}

const times = (v: number[], m: number[]) =>
  [0, 1, 2].map((k) => v[0] * m[k] + v[1] * m[3 + k] + v[2] * m[6 + k]);

/**
 * The mean colour of the picture, from 0 to 255, where the map has a colour: mean_colours in
 * flowtex/rendering/cpu/shade.py.
 */
export function meanColour(colour: number[], settings: Settings, shading: Shading): number[] {
  const { values } = shading;
  const [[dark, light], [range, slope]] = [shading.base, shading.tone];
  const [strength, contrast] = [Number(settings.strength), Number(settings.contrast)];
  const cones = times(colour.map((c) => toLinear(c / 255)), shading.toCones).map(Math.cbrt);
  const [lightness, a, b] = times(cones, shading.toLab);
  const base = lightness + strength * (dark + (light - dark) * lightness - lightness);
  const mean = [0, 0, 0];
  values.forEach((value) => {
    const tone = 2 / (1 + Math.exp(-slope * contrast * value)) - 1;
    const shown = clamp(base + range * strength * tone, 0, 1);
    const room = shown < base ? shown / base : (1 - shown) / Math.max(1 - base, 1e-6);
    const roots = times([shown, a * room, b * room], shading.fromLab);
    const linear = times(roots.map((x) => x ** 3), shading.fromCones);
    linear.forEach((x, k) => (mean[k] += (255 * fromLinear(x)) / values.length));
  });
  return mean;
}

/** A ramp of the mean colours that the picture has with a map, (256, 4), as a background. */
export function rampOf(map: Data, header: Header, settings: Settings, stops: number): string {
  const colours = Array.from({ length: stops }, (_, n) => {
    const first = 4 * Math.round((n / (stops - 1)) * 255);
    const colour = [...map.slice(first, first + 3)];
    // An image on the surface has colours of its own.
    const own = header.paper?.picture ?? false;
    const shown = own ? colour : meanColour(colour, settings, header.constants.shading);
    return `rgb(${shown.map(Math.round).join(" ")})`;
  });
  return `linear-gradient(90deg, ${colours.join(", ")})`;
}
