// Shapes of a path and of its samples over a picture, and a small chart of the samples.

import { dom, numberText, withUnit } from "./dom.ts";

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

/** A sample of a path: its lag, negative ahead, its share in the mean, and the noise, also as a grey. */
export interface PathSample {
  lag: number;
  weight: number;
  /** Null for an image in place of the noise. */
  noise: number | null;
  grey: number;
}

/** Digits of a lag and of a weight in the chart. */
const SAMPLE_DIGITS = 2;

/** The place of a sample along the path in words. */
function lagText(lag: number, unit: string): string {
  const text = withUnit(numberText(Math.abs(lag), SAMPLE_DIGITS), unit);
  if (lag === 0) return "here";
  return lag > 0 ? `${text} behind` : `${text} ahead`;
}

/** A sample in words. */
export function sampleText({ lag, weight, noise }: PathSample, unit: string): string {
  const share = `weight ${numberText(weight, SAMPLE_DIGITS)}`;
  const value = noise === null ? [] : [`noise ${numberText(noise, SAMPLE_DIGITS)}`];
  return [lagText(lag, unit), share, ...value].join(", ");
}

/** A chart of samples: a bar for each, as high as its weight and as grey as its noise. */
export function sampleChart(samples: PathSample[], unit: string): HTMLElement {
  const most = Math.max(...samples.map(({ weight }) => weight));
  const bars = samples.map((sample) => {
    const bar = dom("i");
    const level = Math.round(255 * sample.grey);
    bar.style.height = `${(100 * sample.weight) / most}%`;
    bar.style.background = `rgb(${[level, level, level].join()})`;
    const words = sampleText(sample, unit);
    return dom("li", { title: words }, [bar, dom("span", { class: "unseen" }, [words])]);
  });
  const count = samples.length === 1 ? "1 sample" : `${samples.length} samples`;
  const ends = [samples[0], samples[samples.length - 1]].map(({ lag }) => dom("span", {}, [lagText(lag, unit)]));
  return dom("div", { class: "samples" }, [
    dom("div", { class: "caption" }, [`${count}: the height is the weight, the grey the noise`]),
    dom("ol", { "aria-label": "Samples along the path" }, bars),
    dom("div", { class: "ends", "aria-hidden": "true" }, ends),
  ]);
}
