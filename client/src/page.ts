// The script of an exported page: flowtex/web/export.py writes the page around it.

import { partOfText, type Header, type NamedPart, type PartInfo } from "./protocol.ts";
import { mountPage, type SceneData } from "./views.ts";

/** Parts of one of the views; what lies in the page already is in `known` by its digest. */
async function partsOf(view: string, known: Map<string, NamedPart>): Promise<NamedPart[]> {
  const parts: NamedPart[] = [];
  for (const element of document.querySelectorAll<HTMLElement>(`script[data-view="${view}"]`)) {
    const info: PartInfo = JSON.parse(element.dataset.part ?? "");
    const text = element.textContent ?? "";
    const part = known.get(info.digest) ?? (await partOfText(info, text));
    known.set(info.digest, part);
    parts.push({ ...part, name: info.name });
    element.remove();
  }
  return parts;
}

/** Unpack the page, and take the preview away once the client has drawn. */
async function openPage(): Promise<void> {
  const place = document.getElementById("flowtex") as HTMLElement;
  const status = document.getElementById("status") as HTMLElement;
  try {
    // Of a second header there is what differs from the first.
    const headers: Header[] = JSON.parse(document.getElementById("headers")?.textContent ?? "");
    const known = new Map<string, NamedPart>();
    const scenes: SceneData[] = [];
    for (const [n, header] of headers.entries()) {
      scenes.push({ header: { ...headers[0], ...header }, parts: await partsOf(String(n), known) });
    }
    const look = () => {
      // The client says why in its own place, which the preview covers.
      status.hidden = !place.querySelector('[data-failed="true"]');
      status.textContent =
        "This browser cannot draw the flow, for want of WebGL2; here is a picture of it.";
      if (place.querySelector('[data-sharp="false"]')) return;
      watch.disconnect();
      document.getElementById("preview")?.remove();
    };
    const watch = new MutationObserver(look);
    const attributeFilter = ["data-sharp", "data-failed"];
    watch.observe(place, { subtree: true, childList: true, attributeFilter });
    const { root } = mountPage(place, scenes);
    // Keys are the view's from the beginning, without a click.
    document.addEventListener("keydown", (event) => {
      const isFree = event.target === document.body;
      if (isFree && !root.dispatchEvent(new KeyboardEvent("keydown", event))) event.preventDefault();
    });
  } catch (error) {
    status.hidden = false;
    const reason = error instanceof Error ? error.message : String(error);
    status.textContent = `The flow cannot be drawn here: ${reason}`;
    throw error;
  }
}

void openPage();
