// Views among the text of a page, such as a documentation: one client for all of them. A view is an
// element of the class "flowtex-live" with a still picture in it; its scene, a script beside the page,
// is loaded when the element comes into sight, and unloaded again when it is far away. With
// "data-plays" it streams, and "data-label" is what it is called by those who do not see it.

import { FlowtexView, type SceneData } from "./element.ts";
import { Explanation } from "./explanation.ts";
import { partOfText, type Header, type NamedPart, type PartInfo } from "./protocol.ts";

/** A scene as its script passes it; equal parts have their text once, large ones have their own script. */
interface Packed {
  /** Of a second header there is what differs from the first. */
  headers: Header[];
  parts: [view: number, info: PartInfo, text: string | null][];
}

/** Distances, in heights of the window, within which a view is loaded, and beyond which it is unloaded. */
const LOADED_HEIGHTS = 0.5;
const KEPT_HEIGHTS = 2;

/** What is around a view that is explained. */
const EXPLAINED = ".flowtex-explained";

const scenes = new Map<string, (scene: Packed) => void>();
const texts = new Map<string, (text: string) => void>();
const underway = new Map<string, Promise<unknown>>();

declare global {
  interface Window {
    flowtexScene?: (name: string, scene: Packed) => void;
    flowtexPart?: (digest: string, text: string) => void;
  }
}

/** Run a script, which passes its content: pages that lie in a folder may not fetch files. */
function handedOver<T>(address: string, takers: Map<string, (what: T) => void>): Promise<T> {
  const name = address.replace(/^.*\//, "").replace(/\.js$/, "");
  const begun = underway.get(address) as Promise<T> | undefined;
  if (begun) return begun;
  const result = new Promise<T>((resolve, reject) => {
    const script = document.createElement("script");
    takers.set(name, resolve);
    script.src = address;
    script.onload = () => script.remove();
    script.onerror = () => reject(new Error(`${address} cannot be loaded`));
    document.head.append(script);
  }).finally(() => underway.delete(address));
  underway.set(address, result);
  return result;
}

async function fetchScene({ dataset: { scene = "" } }: HTMLElement): Promise<SceneData[]> {
  const { headers, parts } = await handedOver(scene, scenes);
  const apart = (digest: string) => handedOver(scene.replace(/[^/]*$/, `${digest}.js`), texts);
  const known = new Map<string, Promise<NamedPart>>();
  const result: SceneData[] = headers.map((header) => ({ header: { ...headers[0], ...header }, parts: [] }));
  const read = async (info: PartInfo, text: string | null) => partOfText(info, text ?? (await apart(info.digest)));
  await Promise.all(
    parts.map(async ([view, info, text]) => {
      const part = known.get(info.digest) ?? read(info, text);
      known.set(info.digest, part);
      result[view].parts.push({ ...(await part), name: info.name });
    }),
  );
  return result;
}

class LiveView {
  private readonly element: HTMLElement;
  private readonly explanation: Explanation | null;
  private view: FlowtexView | null = null;
  private isWanted = false;
  private isLoading = false;

  constructor(element: HTMLElement) {
    this.element = element;
    this.explanation = element.closest(EXPLAINED) && new Explanation(element);
    const within = (heights: number) => ({ rootMargin: `${100 * heights}% 0%` });
    const observe = (heights: number, call: (isNear: boolean) => void) =>
      new IntersectionObserver(([entry]) => call(entry.isIntersecting), within(heights)).observe(element);
    observe(LOADED_HEIGHTS, (isNear) => isNear && void this.show());
    observe(KEPT_HEIGHTS, (isNear) => isNear || this.leave());
  }

  private async show(): Promise<void> {
    this.isWanted = true;
    if (this.view || this.isLoading) return;
    this.isLoading = true;
    const { element } = this;
    try {
      const data = await fetchScene(element);
      if (!this.isWanted) return;
      for (const { header } of data) header.background = null;
      const { explanation } = this;
      const view = (this.view = new FlowtexView());
      view.options = { guarded: true, label: element.dataset.label, ...explanation?.options };
      element.append(view);
      view.scenes = data;
      explanation?.attach(view);
      this.watch();
    } catch (error) {
      element.title = `This view is a picture only: ${error instanceof Error ? error.message : error}`;
    } finally {
      this.isLoading = false;
    }
  }

  /** Remove the still once all is drawn, and start the streaming. */
  private watch(): void {
    const { element } = this;
    const look = () => {
      if (element.querySelector('[data-sharp="false"]')) return;
      seen.disconnect();
      element.dataset.live = "true";
      const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
      if ("plays" in element.dataset && !isCalm) this.view?.first.play();
    };
    const seen = new MutationObserver(look);
    seen.observe(element, { subtree: true, attributeFilter: ["data-sharp"] });
  }

  private leave(): void {
    this.isWanted = false;
    if (!this.view) return;
    this.view.dispose();
    this.view.remove();
    this.view = null;
    delete this.element.dataset.live;
  }
}

/** Show the live views of this page, if it has any. */
export function showLiveViews(): void {
  const elements = document.querySelectorAll<HTMLElement>(".flowtex-live");
  if (!elements.length) return;
  window.flowtexScene = (name, scene) => scenes.get(name)?.(scene);
  window.flowtexPart = (digest, text) => texts.get(digest)?.(text);
  for (const element of elements) new LiveView(element);
}
