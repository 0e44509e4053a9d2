// One view of a scene, or two beside each other that move together.

import { dom } from "./dom.ts";
import type { Header, NamedPart } from "./protocol.ts";
import type { Options } from "./options.ts";
import type { Source } from "./sources/source.ts";
import { Viewer } from "./viewer.ts";

/** A scene with the parts that are there, and where others come from. */
export interface SceneData {
  header: Header;
  parts: NamedPart[];
  source?: Source;
}

/** Viewers in an element; `own` gives what each has for itself, and the first has the bar. */
export function viewersIn(
  element: HTMLElement,
  count: number,
  options: Options,
  own: (n: number) => Options = () => ({}),
): Viewer[] {
  if (count < 2) return [new Viewer(element, { ...options, ...own(0) })];
  const pair = dom("div", { class: "flowtex-pair" });
  pair.style.cssText = "display: flex; gap: 2px; width: 100%; height: 100%";
  element.append(pair);
  const viewers: Viewer[] = [];
  for (let n = 0; n < count; n += 1) {
    const cell = dom("div");
    cell.style.cssText = "flex: 1 1 0; min-width: 0; height: 100%";
    pair.append(cell);
    const others = () => viewers.filter((_, m) => m !== n);
    const follower = n ? { controls: false, follows: viewers[0] } : {};
    viewers.push(new Viewer(cell, { ...options, ...own(n), ...linked(options, others), ...follower }));
  }
  for (const viewer of viewers) viewer.together = viewers;
  return viewers;
}

/** Callbacks that report to the other views and to the host. */
function linked(options: Options, others: () => Viewer[]): Options {
  const both =
    <T extends unknown[]>(
      follow: (other: Viewer, ...values: T) => void,
      report?: (...values: T) => void,
    ) =>
    (...values: T) => {
      for (const other of others()) follow(other, ...values);
      report?.(...values);
    };
  return {
    onCamera: both((other, camera) => other.setCamera(camera), options.onCamera),
    onTime: both((other, time) => other.setTime(time), options.onTime),
    onClock: both((other, clock) => other.setClock(clock), options.onClock),
    onSetting: both((other, name, value) => other.followSetting(name, value), options.onSetting),
  };
}

/** Show scenes beside each other; gives the first view. */
export function mountPage(
  element: HTMLElement,
  scenes: SceneData[],
  options: Options = {},
): Viewer {
  const viewers = viewersIn(element, scenes.length, options, (n) => ({ source: scenes[n].source }));
  scenes.forEach(({ header }, n) => viewers[n].setHeader(header));
  scenes.forEach(({ parts }, n) => parts.forEach((part) => viewers[n].setPart(part)));
  viewers[0].requests?.open();
  return viewers[0];
}
