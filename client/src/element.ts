// <flowtex-view>: a scene in any page, or two beside each other that move together.
//
// A host sets `options` and then `scenes`, or makes the views by `open` and passes headers and
// parts itself. Events report what a person does. Each view draws in a shadow of its own.

import type { Header, NamedPart } from "./protocol.ts";
import type { Options } from "./options.ts";
import type { Source } from "./sources/source.ts";
import { Viewer } from "./viewer.ts";

/** A scene with the parts that are loaded, and the source of others. */
export interface SceneData {
  header: Header;
  parts: NamedPart[];
  source?: Source;
}

/** Reports of a view, and the events whose `detail` has what is reported. */
const EVENTS = {
  onCamera: "camera",
  onTime: "time",
  onClock: "clock",
  onPlaying: "playing",
  onSetting: "setting",
  onPoint: "point",
  onControls: "controls",
  onAxes: "axes",
  onFrame: "frame",
  onError: "error",
} as const;

type Report = keyof typeof EVENTS;

export class FlowtexView extends HTMLElement {
  /** Taken by views when they are made; events report the same. */
  options: Options = {};
  /** The first one has the bar. */
  viewers: Viewer[] = [];
  private shown: SceneData[] = [];

  connectedCallback(): void {
    const { style } = this;
    this.classList.add("flowtex-views");
    style.display ||= "flex";
    style.gap ||= "2px";
    style.width ||= "100%";
    style.height ||= "100%";
  }

  get first(): Viewer {
    return this.viewers[0];
  }

  get scenes(): SceneData[] {
    return this.shown;
  }

  /** Show scenes; a view whose source stays keeps its data. */
  set scenes(scenes: SceneData[]) {
    const sources = scenes.map(({ source }) => source);
    const isSame = this.shown.length === scenes.length && this.shown.every(({ source }, n) => source === sources[n]);
    this.shown = scenes;
    if (!isSame) this.open(scenes.length, (n) => ({ source: sources[n] }));
    scenes.forEach(({ header }, n) => this.viewers[n].setHeader(header));
    scenes.forEach(({ parts }, n) => parts.forEach((part) => this.viewers[n].setPart(part)));
    if (!isSame) for (const { requests } of this.viewers) requests?.open();
  }

  /** Make as many views; `own` gives what each has for itself. */
  open(count: number, own: (n: number) => Options = () => ({})): void {
    this.dispose();
    for (let n = 0; n < count; n += 1) {
      const follower = n ? { controls: false, follows: this.first } : {};
      const viewer = new Viewer(this, { ...this.options, ...this.reports(n), ...own(n), ...follower });
      Object.assign(viewer.root.style, { flex: "1 1 0", minWidth: "0" });
      this.viewers.push(viewer);
    }
    for (const viewer of this.viewers) viewer.together = this.viewers;
  }

  /** Show a picture of all views, `gap` of whose pixels apart, that the host has drawn. */
  paint(picture: ImageBitmap, gap: number, isSharp: boolean): void {
    const count = this.viewers.length;
    const width = (picture.width - (count - 1) * gap) / count;
    this.viewers.forEach((viewer, n) => viewer.painter.show?.(picture, n * (width + gap), width, isSharp));
  }

  /** End the views; an element that is only moved in its page keeps them. */
  dispose(): void {
    for (const viewer of this.viewers) viewer.dispose();
    this.viewers = [];
  }

  /** Reports to the other views and to the host. */
  private reports(n: number): Options {
    const tell = (name: Report, ...values: unknown[]) => {
      (this.options[name] as ((...values: unknown[]) => void) | undefined)?.(...values);
      const detail = values.length > 1 ? values : values[0];
      this.dispatchEvent(new CustomEvent(EVENTS[name], { detail }));
    };
    const names = Object.keys(EVENTS) as Report[];
    const told = Object.fromEntries(
      names.map((name) => [name, (...values: unknown[]) => tell(name, ...values)]),
    ) as Options;
    const follow = (call: (other: Viewer) => void) => {
      for (const [m, other] of this.viewers.entries()) if (m !== n) call(other);
    };
    return {
      ...told,
      onCamera: (camera) => {
        follow((other) => other.setCamera(camera));
        tell("onCamera", camera);
      },
      onTime: (time) => {
        follow((other) => other.followTime(time));
        tell("onTime", time);
      },
      onClock: (clock) => {
        follow((other) => other.setClock(clock));
        tell("onClock", clock);
      },
      onSetting: (name, value) => {
        follow((other) => other.followSetting(name, value));
        tell("onSetting", name, value);
      },
    };
  }
}

/** Define the element; a page may have this module several times, of several versions. */
function define(): void {
  let name = "flowtex-view";
  for (let n = 2; customElements.get(name); n += 1) name = `flowtex-view-${n}`;
  customElements.define(name, FlowtexView);
}

define();

/** Show scenes beside each other; gives the first view. */
export function mountPage(element: HTMLElement, scenes: SceneData[], options: Options = {}): Viewer {
  const view = new FlowtexView();
  view.options = options;
  element.append(view);
  view.scenes = scenes;
  return view.first;
}
