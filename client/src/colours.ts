// Colours of the surface: what is chosen of them, and the colours that the picture then has.

import { shareOf, type Data, type Header, type NamedPart, type Part, type Settings, type Shading } from "./protocol.ts";
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
/** Colours of a map up to which a ramp shows each of them with its borders. */
const MOST_STEPS = 32;
const SRGB = { knee: 0.04045, slope: 12.92, offset: 0.055, scale: 1.055, power: 2.4 };

/** What of a header says how the surface is coloured. */
export function coloursOf(header: Header): Partial<Header> {
  const { scalars, colour, background, lighting, opacity, earth } = header;
  return { scalars, colour, background, lighting, opacity, earth };
}

/** Numbers of colours of all maps to choose from. */
const ENTRIES = 256;

/** The table of a map to choose from, (N, 4), of the part that has all of them, or the table of a norm in its colours. */
export function mapOf({ scalars }: Header, maps: Data, name: string, norm?: Float32Array): Uint8Array | Float32Array {
  const { entries, flip, maps: names } = scalars;
  const table = norm ? norm.slice() : new Uint8Array(4 * entries).fill(255);
  const last = table.length / 4 - 1 || 1;
  return table.map((own: number, at: number) => {
    const [n, k] = [at >> 2, at & 3];
    const place = Math.round(((flip ? last - n : n) / last) * (ENTRIES - 1));
    return k === 3 ? own : maps[3 * (names.indexOf(name) * ENTRIES + place) + k];
  });
}

/** Colours below the range, in it, above it, and without a value: as ColourScale.texels of Python. */
export function texelsOf(map: Data, { beyond }: Header["scalars"]): Float32Array {
  const count = map.length / 4;
  const norm = map instanceof Float32Array;
  return Float32Array.from({ length: map.length + 12 }, (_, at) => {
    const [n, k] = [at >> 2, at & 3];
    const own = map[4 * clamp(n - 1, 0, count - 1) + k];
    if (k === 3) return norm ? (n ? own : 1) : 0;
    const end = n > count ? beyond[n - count] : n ? null : beyond[0];
    return end?.[k] ?? own / 255;
  });
}

/** What gives the place of a value on a map, from 0 to 1. */
export function placeOf(scalars: Header["scalars"], map: Data): (value: number) => number {
  const share = shareOf(scalars);
  if (!(map instanceof Float32Array)) return share;
  const count = map.length / 4;
  const edge = (n: number) => (n < count ? map[4 * n + 3] : 1);
  return (value) => {
    const at = share(value);
    let n = 0;
    while (n < count - 1 && edge(n + 1) <= at) n += 1;
    return (n + clamp((at - edge(n)) / (edge(n + 1) - edge(n) || 1), 0, 1)) / count;
  };
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
    const { cmap = "", least, ...usual } = scalars.choices[scalars.number];
    // A logarithmic map shows all values, if they have logarithms.
    const isWhole = scalars.log && least > 0;
    const [low, high] = isWhole ? [least, usual.most] : [usual.low, usual.high];
    const isSigned = (low < 0 && high > 0) || scalars.diverging.includes(cmap);
    const widest = isSigned && scalars.diverging.includes(scalars.cmap);
    const end = Math.max(-low, high);
    [scalars.low, scalars.high] = widest ? [-end, end] : [low, high];
  }
  const { coastlines = header.earth?.coastlines, graticule = header.earth?.graticule } = choice;
  const earth = header.earth && { ...header.earth, coastlines, graticule };
  const { opacity = header.opacity } = choice;
  const colours = { scalars, earth, opacity } as Partial<Header>;
  const [maps, map] = [parts.get("maps"), parts.get("cmap")?.data];
  // A norm has limits of its own, so another range or other scalars end it.
  const norm = map instanceof Float32Array;
  const ends = norm && (choice.clim !== undefined || choice.scalars !== undefined);
  if (!maps || !(choice.cmap || ends)) return { colours, part: null };
  if (ends) Object.assign(scalars, { ticks: [], beyond: [null, null, scalars.beyond[2]] });
  const own = norm && !ends;
  const data = choice.cmap ? mapOf(header, maps.data, choice.cmap, own ? map : undefined) : Uint8Array.from(map ?? []);
  const digest = [OWN, choice.cmap, own].join();
  return { colours, part: { name: "cmap", data, shape: [data.length / 4, 4], digest } };
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
    const roots = times([shown, a, b], shading.fromLab);
    const linear = times(roots.map((x) => x ** 3), shading.fromCones);
    const grey = shown ** 3;
    // Where sRGB has no such colour, grey is mixed in until it has.
    const rooms = linear.map((x) => Math.abs(Number(x >= grey) - grey) / Math.max(Math.abs(x - grey), 1e-6));
    const room = Math.min(...rooms, 1);
    linear.forEach((x, k) => (mean[k] += (255 * fromLinear(grey + room * (x - grey))) / values.length));
  });
  return mean;
}

/** Runs of equal colours of a map: the first, and the one after the last. */
function runsOf(map: Data): [number, number][] {
  const runs: [number, number][] = [];
  for (let n = 0; n < map.length / 4; n += 1) {
    const isSame = n > 0 && [0, 1, 2].every((k) => map[4 * n + k] === map[4 * n - 4 + k]);
    if (isSame) runs[runs.length - 1][1] = n + 1;
    else runs.push([n, n + 1]);
  }
  return runs;
}

/** A ramp of the mean colours that the picture has with a map, (N, 4), as a background. */
export function rampOf(map: Data, header: Header, settings: Settings, stops: number): string {
  const count = map.length / 4;
  // An image on the surface has colours of its own.
  const hasOwn = Boolean(header.image) && !header.image?.deviations;
  const shown = (n: number) => {
    const colour = [...map.slice(4 * n, 4 * n + 3)];
    return `rgb(${(hasOwn ? colour : meanColour(colour, settings, header.constants.shading)).map(Math.round).join(" ")})`;
  };
  // Few colours have borders.
  const runs = runsOf(map);
  const colours =
    runs.length <= MOST_STEPS
      ? runs.map(([from, to]) => `${shown(from)} ${(100 * from) / count}% ${(100 * to) / count}%`)
      : Array.from({ length: stops }, (_, n) => shown(Math.round((n / (stops - 1)) * (count - 1))));
  return `linear-gradient(90deg, ${colours.join(", ")})`;
}
