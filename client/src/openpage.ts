// What an exported page does: flowtex/web/export.py writes the page around it.

import {
  isOfStep,
  partOfText,
  stepOf,
  tilePart,
  type Header,
  type NamedPart,
  type PartInfo,
} from "./protocol.ts";
import type { Source } from "./source.ts";
import { nameOf } from "./tilechoice.ts";
import { mountPage, type SceneData } from "./views.ts";

/** Opens the store in which the rest of a page lies. */
export type OpenStore = (header: Header) => Source;

/** A part with its text as the page has it; what lies in the page already has none. */
type Packed = [info: PartInfo, text: string];

/** What lies in the page of one of the views: its parts, and those of each tile by its name. */
function packedOf(view: string): { parts: Packed[]; tiles: Map<string, Packed[]> } {
  const [parts, tiles]: [Packed[], Map<string, Packed[]>] = [[], new Map()];
  for (const element of document.querySelectorAll<HTMLElement>(`script[data-view="${view}"]`)) {
    const info: PartInfo = JSON.parse(element.dataset.part ?? "");
    const packed: Packed = [info, element.textContent ?? ""];
    const tile = tilePart(info.name)?.[0];
    if (tile) tiles.set(tile, [...(tiles.get(tile) ?? []), packed]);
    else parts.push(packed);
    element.remove();
  }
  return { parts, tiles };
}

/** A view as it lies in the page; `known` has what is unpacked, and `texts` what is not, by digests. */
function sceneOf(
  header: Header,
  tiles: Map<string, Packed[]>,
  known: Map<string, NamedPart>,
  texts: Map<string, string>,
  openStore?: OpenStore,
): SceneData {
  for (const [{ digest }, text] of [...tiles.values()].flat()) if (text) texts.set(digest, text);
  if (openStore) return { header, parts: [], source: openStore(header) };
  const load: Source["load"] = (key, steps) => {
    const needed = ((key && tiles.get(nameOf(key))) ?? []).filter(([{ name }]) => {
      const part = tilePart(name)?.[1] ?? "";
      const step = stepOf(part);
      const isOfAll = part.startsWith("scalars/") && !isOfStep(part, step, header);
      return Number.isNaN(step) || steps.includes(step) || isOfAll;
    });
    return Promise.all(
      needed.map(async ([info, text]) => {
        const part = known.get(info.digest);
        if (part) return { ...part, name: info.name };
        return partOfText(info, text || (texts.get(info.digest) ?? ""));
      }),
    );
  };
  return { header, parts: [], source: { load, atOnce: 1 } };
}

/** Unpack the page, and take the preview away once the client has drawn. */
export async function openPage(openStore?: OpenStore): Promise<void> {
  const place = document.getElementById("flowtex") as HTMLElement;
  const status = document.getElementById("status") as HTMLElement;
  const loading = document.getElementById("loading") as HTMLElement;
  try {
    // Of a second header there is what differs from the first.
    const headers: Header[] = JSON.parse(document.getElementById("headers")?.textContent ?? "");
    const known = new Map<string, NamedPart>();
    const texts = new Map<string, string>();
    const packed = headers.map((_, n) => packedOf(String(n)));
    const scenes = headers.map((header, n) =>
      sceneOf({ ...headers[0], ...header }, packed[n].tiles, known, texts, openStore),
    );
    const look = () => {
      // The client says why in its own place, which the preview covers.
      status.hidden = !place.querySelector('[data-failed="true"]');
      loading.hidden = !status.hidden;
      status.textContent =
        "This browser cannot draw the flow, for want of WebGL2; here is a picture of it.";
      // A coarse picture that can be moved is better than a sharp one that cannot.
      if (place.querySelector('.flowtex:not([data-drawn="true"])')) return;
      watch.disconnect();
      document.getElementById("preview")?.remove();
      loading.remove();
    };
    const watch = new MutationObserver(look);
    const attributeFilter = ["data-drawn", "data-failed"];
    watch.observe(place, { subtree: true, childList: true, attributeFilter });
    let isComing = true;
    const { root, together } = mountPage(place, scenes, { isComing: () => isComing });
    // Keys are the view's from the beginning, without a click.
    document.addEventListener("keydown", (event) => {
      const isFree = event.target === document.body;
      if (isFree && !root.dispatchEvent(new KeyboardEvent("keydown", event))) event.preventDefault();
    });
    // Meanwhile the shaders are built.
    for (const [n, viewer] of together.entries()) {
      const view = together.length > 1 ? ` of view ${n + 1}` : "";
      for (const [m, [info, text]] of packed[n].parts.entries()) {
        const done = `${view}, ${m} of ${packed[n].parts.length} parts`;
        (loading.lastElementChild as HTMLElement).textContent = done;
        const part = known.get(info.digest) ?? (await partOfText(info, text));
        known.set(info.digest, part);
        viewer.setPart({ ...part, name: info.name });
      }
    }
    isComing = false;
    loading.textContent = "Drawing the first picture";
    for (const viewer of together) viewer.change();
  } catch (error) {
    loading.remove();
    status.hidden = false;
    const reason = error instanceof Error ? error.message : String(error);
    status.textContent = `The flow cannot be drawn here: ${reason}`;
    throw error;
  }
}
