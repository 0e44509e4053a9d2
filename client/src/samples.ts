// How the texture at a point is computed, in a card: the samples along its path, enlarged, and bars
// of their weights in the greys that they meet.

import type { Camera } from "./camera.ts";
import { dom } from "./dom.ts";
import type { Place } from "./pathlines.ts";
import { clamp, type Vector } from "./vectors.ts";

/** A sample of a path: its weight is 1 for the greatest. */
export interface PathSample {
  position: Vector;
  weight: number;
  colour: string;
}

const SVG = "http://www.w3.org/2000/svg";
/** Width and height of the enlarged path, what is left free around it, and radii, in pixels. */
const INSET = { width: 232, height: 112, margin: 9 };
const DOT = { least: 1.5, most: 4.5 };
const POINT_RADIUS = 6;

function shape(tag: string, attributes: Record<string, string | number>): SVGElement {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, `${value}`);
  return element;
}

/** The mapping that fits places into the inset; the samples of a path are a pixel apart in the picture. */
export function fitting(places: Place[], aspect: number): (place: Place) => Place {
  const { width: wide, height: high, margin } = INSET;
  const flat = ([x, y]: Place): Place => [x * aspect, -y];
  const flattened = places.map(flat);
  const [xs, ys] = [0, 1].map((k) => flattened.map((place) => place[k]));
  const [left, top] = [Math.min(...xs), Math.min(...ys)];
  const [width, height] = [Math.max(...xs) - left, Math.max(...ys) - top];
  const ratios = [(wide - 2 * margin) / (width || 1e-9), (high - 2 * margin) / (height || 1e-9)];
  const scale = Math.min(...ratios);
  return (place) => {
    const [x, y] = flat(place);
    return [wide / 2 + (x - left - width / 2) * scale, high / 2 + (y - top - height / 2) * scale];
  };
}

function enlarged(samples: PathSample[], point: Vector, camera: Camera): SVGElement {
  const { width, height } = INSET;
  const picture = shape("svg", { class: "inset", viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true" });
  const seen = samples.flatMap(({ position, ...rest }) => {
    const place = camera.project(position);
    return place ? [{ place, ...rest }] : [];
  });
  if (!seen.length) return picture;
  const mapping = fitting(seen.map(({ place }) => place), camera.aspect);
  const centres = seen.map(({ place }) => mapping(place));
  seen.forEach(({ weight, colour }, n) => {
    const [cx, cy] = centres[n];
    const [nx, ny] = centres[n > 0 ? n - 1 : 1] ?? [cx + DOT.most, cy + DOT.most];
    // Neighbours touch, and do not hide one another.
    const most = clamp(0.75 * Math.hypot(nx - cx, ny - cy), DOT.least, DOT.most);
    picture.append(shape("circle", { cx, cy, r: most * (0.35 + 0.65 * weight), fill: colour }));
  });
  const place = camera.project(point);
  if (place) {
    const [cx, cy] = mapping(place);
    picture.append(shape("circle", { cx, cy, r: POINT_RADIUS, class: "point" }));
  }
  return picture;
}

/** The samples of a path, and words and numbers about them. */
export function samplesOf(samples: PathSample[], point: Vector, camera: Camera): HTMLElement {
  const bars = samples.map(({ weight, colour }) => {
    const bar = dom("i");
    bar.style.cssText = `height: ${100 * weight}%; background: ${colour}`;
    return bar;
  });
  const title = "Each bar is a sample: its height is the weight, its grey is the noise.";
  return dom("div", { class: "samples" }, [
    enlarged(samples, point, camera),
    dom("div", { class: "bars", title }, bars),
    dom("div", { class: "ends" }, [dom("span", {}, ["behind"]), dom("span", {}, ["ahead"])]),
  ]);
}
