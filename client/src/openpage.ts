// What an exported page does: flowtex/host/export.py writes the page around it.

import { forwardKeys } from "./keyboard.ts";
import { showPacked, type OpenStore } from "./packed.ts";
import { unzipped } from "./protocol.ts";
import type { PackedScene } from "./sources/embedded.ts";

/** Take the parts out of the page. */
function partsOfPage(): PackedScene["parts"] {
  return Array.from(document.querySelectorAll<HTMLElement>("script[data-part]"), (element) => {
    element.remove();
    const { view, part = "" } = element.dataset;
    return [Number(view), JSON.parse(part), element.textContent ?? ""];
  });
}

/** Unpack the page, and take the preview away once the client has drawn. */
export async function openPage(openStore?: OpenStore): Promise<void> {
  const place = document.getElementById("flowtex") as HTMLElement;
  const status = document.getElementById("status") as HTMLElement;
  const loading = document.getElementById("loading") as HTMLElement;
  try {
    const headers = await unzipped(document.getElementById("headers")?.textContent ?? "").json();
    const look = () => {
      // The client says why in its own place, which the preview covers.
      status.hidden = !place.querySelector('[data-failed="true"]');
      loading.hidden = !status.hidden;
      status.textContent =
        "This browser cannot draw the flow because it has no WebGL2; this is a still picture.";
      // A coarse picture that can be moved is better than a sharp one that cannot.
      if (place.querySelector('.flowtex:not([data-drawn="true"])')) return;
      watch.disconnect();
      document.getElementById("preview")?.remove();
      loading.remove();
    };
    const watch = new MutationObserver(look);
    const attributeFilter = ["data-drawn", "data-failed"];
    watch.observe(place, { subtree: true, childList: true, attributeFilter });
    const scene = { headers, parts: partsOfPage() };
    const { view, filled } = showPacked(place, scene, openStore, (n, part, parts) => {
      const which = headers.length > 1 ? ` of view ${n + 1}` : "";
      (loading.lastElementChild as HTMLElement).textContent = `${which}, ${part} of ${parts} parts`;
    });
    const { root } = view.first;
    // Keys are the view's from the beginning, without a click.
    document.addEventListener("keydown", (event) => forwardKeys(root, event));
    await filled;
    loading.textContent = "Drawing the first picture";
  } catch (error) {
    loading.remove();
    status.hidden = false;
    const reason = error instanceof Error ? error.message : String(error);
    status.textContent = `The flow cannot be drawn here: ${reason}`;
    throw error;
  }
}
