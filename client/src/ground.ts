// What lies below a flow where a field of the Earth has no data: land, and sea of which nothing is known.

import type { Header, StructureHeader } from "./protocol.ts";
import { dot } from "./vectors.ts";

/** Parts with the cells of a field that have no data: land, and what lacks them at sea. */
export const GROUND = ["land", "missing"];
const LAND = "land";
/** Luminance from which black has more contrast than white. */
const LIGHT_FROM = 0.18;

/** Colour of places without data at sea, near that of the background. */
export function missingColour({ background, earth }: Header): number[] {
  const ground = background ?? [1, 1, 1];
  const share = earth?.missingShare ?? 0;
  const ink = dot(ground.map((value) => value ** 2.2), [0.2126, 0.7152, 0.0722]) >= LIGHT_FROM ? 0 : 1;
  return ground.map((value) => value * (1 - share) + ink * share);
}

/** Land and places without data, in their colours, where some are drawn. */
export function groundKinds(header: Header): StructureHeader["kinds"] {
  const { earth } = header;
  const land = earth?.land;
  if (!land) return [];
  return earth.kinds.map((name) => ({ name, color: name === LAND ? land : missingColour(header), isGround: true }));
}
