// The end of an exported page's script. There client.js stands before it in one and the same module,
// and the next line is left out.
import { mountPage } from "./client.js";

/**
 * Take one part out of the page: base64, gzip, and the bytes of all numbers by significance.
 * @param {HTMLElement} element
 * @returns {Promise<{dtype: string, shape: number[], data: Uint8Array}>}
 */
async function pagePart(element) {
  const text = atob(element.textContent ?? "");
  const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
  const opened = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const planes = new Uint8Array(await new Response(opened).arrayBuffer());
  const width = Number(element.dataset.bytes);
  const count = planes.length / width;
  const data = new Uint8Array(planes.length);
  for (let plane = 0; plane < width; plane += 1) {
    const first = plane * count;
    for (let n = 0; n < count; n += 1) data[n * width + plane] = planes[first + n];
  }
  element.remove();
  const shape = (element.dataset.shape ?? "").split(" ").map(Number);
  return { dtype: element.dataset.dtype ?? "", shape, data };
}

/** Unpack the page, and take the preview away once the client has drawn. */
async function openPage() {
  const place = /** @type {HTMLElement} */ (document.getElementById("flowtex"));
  const said = /** @type {HTMLElement} */ (document.getElementById("said"));
  try {
    const header = JSON.parse(document.getElementById("header")?.textContent ?? "");
    /** @type {Record<string, {dtype: string, shape: number[], data: Uint8Array, digest: string}>} */
    const parts = {};
    for (const element of document.querySelectorAll("script[data-part]")) {
      if (!(element instanceof HTMLElement)) continue;
      const { part = "", same } = element.dataset;
      // What two views, or two times, have in common lies in the page once.
      parts[part] = same ? parts[same] : { ...(await pagePart(element)), digest: part };
    }
    const look = () => {
      // The client says why in its own place, which the preview covers.
      said.hidden = !place.querySelector('[data-failed="true"]');
      said.textContent = "This browser cannot draw the flow, for want of WebGL2; here is a picture of it.";
      if (place.querySelector('[data-sharp="false"]')) return;
      watch.disconnect();
      document.getElementById("preview")?.remove();
    };
    const watch = new MutationObserver(look);
    watch.observe(place, {
      subtree: true, childList: true, attributeFilter: ["data-sharp", "data-failed"],
    });
    mountPage(place, header, parts);
  } catch (error) {
    said.hidden = false;
    said.textContent = `The flow cannot be drawn here: ${error instanceof Error ? error.message : error}`;
    throw error;
  }
}

openPage();
