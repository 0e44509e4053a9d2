// What an exported page does: flowtex/web/export.py writes the page around it.

import type { Header, NamedPart } from "./protocol.ts";
import { Embedded } from "./sources/embedded.ts";
import type { Source } from "./sources/source.ts";
import { mountPage } from "./element.ts";
import { forwardKeys } from "./keyboard.ts";

/** Opens the store in which the rest of a page lies. */
export type OpenStore = (header: Header) => Source;

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
    const embedded = headers.map(
      (header, n) => new Embedded({ ...headers[0], ...header }, String(n), known, texts),
    );
    const scenes = embedded.map((source) => {
      const { header } = source;
      return { header, parts: [], source: openStore ? openStore(header) : source };
    });
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
    document.addEventListener("keydown", (event) => forwardKeys(root, event));
    // Meanwhile the shaders are built.
    for (const [n, viewer] of together.entries()) {
      const view = together.length > 1 ? ` of view ${n + 1}` : "";
      const { parts } = embedded[n];
      for (const [m, packed] of parts.entries()) {
        (loading.lastElementChild as HTMLElement).textContent = `${view}, ${m} of ${parts.length} parts`;
        const part = await embedded[n].unpacked(packed);
        known.set(part.digest, part);
        viewer.setPart(part);
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
