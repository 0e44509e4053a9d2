// Texels of slices as the graphics card has them, from parts that are sent.

import { fromHalf } from "../src/half.ts";
import type { Header, Part } from "../src/protocol.ts";
import type { Four, Scene } from "../src/scene.ts";

type Numbers = Pick<Part, "data"> | undefined;

export function texelsOf(
  { slices, geometry }: Pick<Header, "slices" | "geometry">,
  find: (name: string) => Numbers,
): Scene["texels"] {
  const count = geometry.rows.size * geometry.columns.size;
  return (step, texels) => (layer, n): Four => {
    const { channels } = slices;
    const first = (layer * count + texels[n]) * channels;
    const sent = find(`slices/${step}`)?.data ?? [];
    const four = [0, 1, 2, 3].map((c) => (c < channels ? fromHalf(sent[first + c]) : 0));
    const place = slices.extra.indexOf(layer);
    const extra = find(`extra/${step}`)?.data;
    if (channels < 4 && extra && place >= 0) four[3] = fromHalf(extra[place * count + texels[n]]);
    return four as Four;
  };
}
