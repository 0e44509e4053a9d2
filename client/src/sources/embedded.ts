// A source of parts that lie in a page or module as text: flowtex/host/export.py writes them.

import { isOfStep, partOfText, stepOf, tilePart, type Header, type NamedPart, type PartInfo } from "../protocol.ts";
import type { LoadTile, Source } from "./source.ts";
import { nameOf } from "../tilechoice.ts";

/** A part with its text; equal ones have it once. */
type Packed = [info: PartInfo, text: string];

/** A scene, or two beside each other, as text. */
export interface PackedScene {
  /** Of a second header there is what differs from the first. */
  headers: Header[];
  parts: [view: number, ...packed: Packed][];
}

/** The packed parts of one view. */
export class Embedded implements Source {
  /** Parts are unpacked in the page itself, the most needed ones first. */
  readonly atOnce = 1;
  readonly header: Header;
  /** Those of the whole. */
  readonly parts: Packed[] = [];
  private readonly tiles = new Map<string, Packed[]>();
  private readonly known: Map<string, NamedPart>;
  private readonly texts: Map<string, string>;

  /** `known` has unpacked parts and `texts` those of tiles, of all views by their digests. */
  constructor(header: Header, packed: Packed[], known: Map<string, NamedPart>, texts: Map<string, string>) {
    this.header = header;
    this.known = known;
    this.texts = texts;
    for (const part of packed) {
      const [{ name, digest }, text] = part;
      const tile = tilePart(name)?.[0];
      if (!tile) this.parts.push(part);
      else this.tiles.set(tile, [...(this.tiles.get(tile) ?? []), part]);
      if (tile && text) texts.set(digest, text);
    }
  }

  readonly load: LoadTile = (key, steps) => {
    const needed = ((key && this.tiles.get(nameOf(key))) ?? []).filter(([{ name }]) => {
      const part = tilePart(name)?.[1] ?? "";
      const step = stepOf(part);
      const isOfAll = part.startsWith("scalars/") && !isOfStep(part, step, this.header);
      return Number.isNaN(step) || steps.includes(step) || isOfAll;
    });
    return Promise.all(needed.map((packed) => this.unpacked(packed)));
  };

  async unpacked([info, text]: Packed): Promise<NamedPart> {
    const { digest, name } = info;
    const part = this.known.get(digest);
    return part ? { ...part, name } : partOfText(info, text || (this.texts.get(digest) ?? ""));
  }

  /** Unpack a part of the whole, and keep it for the views that have an equal one. */
  async kept(packed: Packed): Promise<NamedPart> {
    const part = await this.unpacked(packed);
    this.known.set(part.digest, part);
    return part;
  }
}
