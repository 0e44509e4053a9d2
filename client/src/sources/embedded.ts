// A source of parts that lie in a page as text: flowtex/web/export.py writes them.

import { isOfStep, partOfText, stepOf, tilePart, type Header, type NamedPart, type PartInfo } from "../protocol.ts";
import type { LoadTile, Source } from "./source.ts";
import { nameOf } from "../tilechoice.ts";

/** A part with its text as the page has it; equal ones have it once. */
type Packed = [info: PartInfo, text: string];

/** What lies in the page of one of its views, taken out of it. */
export class Embedded implements Source {
  /** Unpacking goes on in the page itself, and what is needed most comes first. */
  readonly atOnce = 1;
  readonly header: Header;
  /** Those of the whole. */
  readonly parts: Packed[] = [];
  private readonly tiles = new Map<string, Packed[]>();
  private readonly known: Map<string, NamedPart>;
  private readonly texts: Map<string, string>;

  /** `known` has what is unpacked, and `texts` what is not, of all views by digests. */
  constructor(header: Header, view: string, known: Map<string, NamedPart>, texts: Map<string, string>) {
    this.header = header;
    this.known = known;
    this.texts = texts;
    for (const element of document.querySelectorAll<HTMLElement>(`script[data-view="${view}"]`)) {
      const info: PartInfo = JSON.parse(element.dataset.part ?? "");
      const packed: Packed = [info, element.textContent ?? ""];
      const tile = tilePart(info.name)?.[0];
      if (!tile) this.parts.push(packed);
      else this.tiles.set(tile, [...(this.tiles.get(tile) ?? []), packed]);
      if (tile && packed[1]) texts.set(info.digest, packed[1]);
      element.remove();
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
}
