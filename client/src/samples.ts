// How the texture at a point is computed, in a card: the samples along its path, enlarged, and bars
// of their weights in the greys that they meet.

import type { Camera } from "./camera.ts";
import { dom, shape } from "./dom.ts";
import { clamp, type Vector } from "./vectors.ts";

export type Place = [number, number];
export type Line = Place[];
/** An element of SVG and its attributes. */
export type Shape = [tag: string, attributes: Record<string, string | number>];

/** A dot on the path: its radius in pixels, and its grey from 0 to 1. */
export interface Dot {
  place: Place;
  radius: number;
  grey: number;
}

/** A path in pixels, lines downstream; it is `directed` unless the flow is sign-free. */
export interface PathLines {
  /** The whole path, and the part of it that is summed. */
  path: Line[];
  sampled: Line[];
  point: Place | null;
  directed: boolean;
  dots?: Dot[];
}

/** Pixels from one head of an arrow to the next, and length and half the width of one. */
const HEAD = { apart: 90, length: 14, half: 5 };
/** Radius of the point, and around it that where there are no heads. */
const POINT_RADIUS = 6;
const FREE_RADIUS = 20;

const textOf = (line: Line) => line.map((place) => place.map((v) => v.toFixed(1)).join()).join(" ");

/** Corners of heads along a line, from its end back. */
export function arrowHeads(line: Line, apart = HEAD.apart): Line[] {
  const heads: Line[] = [];
  let due = 0;
  for (let n = line.length - 1; n > 0; n -= 1) {
    const [[ax, ay], [bx, by]] = [line[n - 1], line[n]];
    const size = Math.hypot(bx - ax, by - ay);
    if (!size) continue;
    const [ux, uy] = [(bx - ax) / size, (by - ay) / size];
    for (; due < size; due += apart) {
      const [x, y] = [bx - due * ux, by - due * uy];
      const [left, low] = [x - HEAD.length * ux, y - HEAD.length * uy];
      const [wide, tall] = [-HEAD.half * uy, HEAD.half * ux];
      heads.push([[x, y], [left + wide, low + tall], [left - wide, low - tall]]);
    }
    due -= size;
  }
  return heads;
}

/** Shapes from the lowest to the topmost: light lines in dark casings, which contrast with all colours. */
export function pathShapes({ path, sampled, point, directed, dots = [] }: PathLines): Shape[] {
  const lines = (all: Line[], kind: string) =>
    all.map((line): Shape => ["polyline", { class: kind, points: textOf(line) }]);
  const isFree = ([[x, y]]: Line) =>
    !point || Math.hypot(x - point[0], y - point[1]) > FREE_RADIUS;
  // The part that is summed may be too short for one.
  const heads = directed ? path.flatMap((line) => arrowHeads(line)).filter(isFree) : [];
  const ring = (kind: string): Shape[] => {
    return point ? [["circle", { class: kind, cx: point[0], cy: point[1], r: POINT_RADIUS }]] : [];
  };
  return [
    ...lines(path, "whole-casing"),
    ...lines(path, "whole"),
    ...lines(sampled, "casing"),
    ...lines(sampled, "sampled"),
    ...heads.map((head): Shape => ["polygon", { class: "arrow", points: textOf(head) }]),
    ...dots.map(({ place: [cx, cy], radius, grey }): Shape => {
      const fill = `rgb(${[grey, grey, grey].map((x) => Math.round(255 * x)).join()})`;
      return ["circle", { class: "dot", cx, cy, r: radius, fill }];
    }),
    ...ring("point-casing"),
    ...ring("point"),
  ];
}

/** A sample of a path: its weight is 1 for the greatest. */
export interface PathSample {
  position: Vector;
  weight: number;
  colour: string;
}

/** Width and height of the enlarged path, what is left free around it, and radii, in pixels. */
const INSET = { width: 232, height: 112, margin: 9 };
const DOT = { least: 1.5, most: 4.5 };

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
