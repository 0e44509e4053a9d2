// A scene as text in an exported page, which flowtex/host/export.py writes, or in its own module.

import { FlowtexView } from "./element.ts";
import { Embedded, type PackedScene } from "./sources/embedded.ts";
import { forwardKeys } from "./keyboard.ts";
import { type Header, unzipped, type Value } from "./protocol.ts";
import type { Source } from "./sources/source.ts";

/** Opens the store that has the rest of a scene. */
export type OpenStore = (header: Header) => Source;

/** Height of a view where its host names none, in pixels. */
const HEIGHT_PX = 480;

/** What a host of anywidget's kind gives; only values are read. */
interface Model {
  get(name: string): unknown;
}

/** Show a scene. Shaders are built while its parts are unpacked, one after the other. */
export function showPacked(
  element: HTMLElement,
  { headers, parts }: PackedScene,
  openStore?: OpenStore,
  report?: (view: number, part: number, parts: number) => void,
): { view: FlowtexView; filled: Promise<void> } {
  const known = new Map();
  const texts = new Map();
  const embedded = headers.map((header, n) => {
    const own = parts.flatMap(([view, info, text]) => (view === n ? [[info, text] as [typeof info, string]] : []));
    return new Embedded({ ...headers[0], ...header }, own, known, texts);
  });
  let isComing = true;
  const view = new FlowtexView();
  view.options = { isComing: () => isComing };
  element.append(view);
  view.scenes = embedded.map((source) => {
    const { header } = source;
    return { header, parts: [], source: openStore ? openStore(header) : source };
  });
  const fill = async () => {
    const { viewers } = view;
    for (const [n, source] of embedded.entries()) {
      for (const [m, part] of source.parts.entries()) {
        report?.(n, m, source.parts.length);
        const unpacked = await source.kept(part);
        if (view.viewers !== viewers) return; // the view has ended
        viewers[n].setPart(unpacked);
      }
    }
    isComing = false;
    for (const viewer of viewers) viewer.change();
  };
  return { view, filled: fill() };
}

/** What a module with a scene exports: `mount` for pages, `render` for hosts of anywidget's modules. */
export function packedModule(scene: PackedScene, openStore?: OpenStore) {
  /** Show the scene in an element, with some settings, in a height in pixels. */
  const mount = (element: HTMLElement, settings: Record<string, Value> = {}, height = HEIGHT_PX): FlowtexView => {
    const { view, filled } = showPacked(element, scene, openStore);
    view.style.height = `${height}px`;
    for (const [name, value] of Object.entries(settings)) {
      for (const viewer of view.viewers) viewer.followSetting(name, value);
    }
    filled.catch((error: Error) => view.first?.panel.fail("The flow cannot be drawn.", error.message));
    return view;
  };
  const render = ({ model, el }: { model: Model; el: HTMLElement }): (() => void) => {
    const named = scene.headers[0].table.map(({ name }) => [name, model.get(name)]);
    const settings = Object.fromEntries(named.filter(([, value]) => value !== undefined && value !== null));
    const view = mount(el, settings, Number(model.get("height")) || HEIGHT_PX);
    return () => {
      view.dispose();
      view.remove();
    };
  };
  return { mount, render };
}

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
