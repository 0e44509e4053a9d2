// Colours of the surface: what is chosen of them, and the colours that the picture then has.

import type { Data, Header, NamedPart, Part } from "./protocol.ts";

/** What a person chooses; a range of null is that of the values. */
export interface ColourChoice {
  scalars?: string | false;
  cmap?: string;
  clim?: [number, number] | null;
}

/** Name of a part that a client has made: no other one has its digest. */
const OWN = "own cmap";
const SRGB = { knee: 0.04045, slope: 12.92, offset: 0.055, scale: 1.055, power: 2.4 };

/** What of a header says how the surface is coloured. */
export function coloursOf(header: Header): Partial<Header> {
  const { scalars, colour, background, lighting, opacity } = header;
  return { scalars, colour, background, lighting, opacity };
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
    const { name, unit, steps } = scalars.choices[number];
    Object.assign(scalars, { name, unit, steps, number, auto: true });
  }
  if (choice.cmap) scalars.cmap = choice.cmap;
  if (choice.clim) [scalars.low, scalars.high] = choice.clim;
  if (choice.clim !== undefined) scalars.auto = !choice.clim;
  if (scalars.auto && scalars.choices[scalars.number]) {
    const { low, high } = scalars.choices[scalars.number];
    const widest = low < 0 && high > 0 && scalars.diverging.includes(scalars.cmap);
    const end = Math.max(-low, high);
    [scalars.low, scalars.high] = widest ? [-end, end] : [low, high];
  }
  // Triangles were chosen for the first range: a narrower one shows smaller differences.
  const narrower = (scalars.high - scalars.low) / (header.scalars.high - header.scalars.low || 1);
  const error = header.mesh.maxColourError * Math.min(narrower, 1);
  const mesh = number < 0 ? { ...header.mesh, maxColourError: error } : header.mesh;
  const maps = parts.get("maps");
  if (!choice.cmap || !maps) return { colours: { scalars, mesh }, part: null };
  const data = mapOf(header, maps.data, choice.cmap);
  const part = { name: "cmap", data, shape: [256, 4], digest: `${OWN} ${choice.cmap}` };
  return { colours: { scalars, mesh }, part };
}

/**
 * The mean colour of the picture where the map has a colour, from 0 to 255: the shading of
 * flowtex/rendering/cpu/shade.py for a texture of value 0.
 */
export function meanColour(
  colour: ArrayLike<number>,
  strength: number,
  { toCones, toLab, baseDark, baseLight }: Header["constants"]["shading"],
): [number, number, number] {
  const linear = [0, 1, 2].map((k) => {
    const c = colour[k] / 255;
    const { knee, slope, offset, scale, power } = SRGB;
    return c < knee ? c / slope : ((c + offset) / scale) ** power;
  });
  const times = (v: number[], m: number[]) =>
    [0, 1, 2].map((k) => v[0] * m[k] + v[1] * m[3 + k] + v[2] * m[6 + k]);
  const [light, a, b] = times(times(linear, toCones).map(Math.cbrt), toLab);
  return [light + strength * (baseDark + (baseLight - baseDark) * light - light), a, b];
}

/** A ramp of the mean colours that the picture has with a map, (256, 4), as a background. */
export function rampOf(map: Data, header: Header, strength: number, stops: number): string {
  const { shading } = header.constants;
  const colours = Array.from({ length: stops }, (_, n) => {
    const first = 4 * Math.round((n / (stops - 1)) * 255);
    // A picture on the surface has colours of its own.
    const shown = header.paper?.picture ? 0 : strength;
    const lab = meanColour(map.slice(first, first + 3), shown, shading);
    return `oklab(${lab.map((x) => x.toFixed(4)).join(" ")})`;
  });
  return `linear-gradient(90deg, ${colours.join(", ")})`;
}
