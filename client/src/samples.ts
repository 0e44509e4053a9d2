// Shapes of a path and of its samples over a picture.

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
