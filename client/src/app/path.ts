// The path through a point: over the picture, and enlarged with its samples.

import { pathShapes, type Line, type PathLines, type Place } from "../pathlines.ts";
import { clamp } from "../vectors.ts";
import { vue, type Node } from "./vue.ts";

interface Sample {
  x: number;
  y: number;
  weight: number;
  grey: string;
}

/** Places go from -1 to 1, right and up. */
interface Over extends PathLines {
  samples: Sample[];
  panes: number;
  /** Numbers of the panes that it lies in. */
  shown: number[];
  aspect: number;
}

type Mapping = (place: Place) => Place;

/** Width and height of the enlarged path, what is left free around it, and radii, in pixels. */
const INSET = { width: 232, height: 112, margin: 9 };
const DOT = { least: 1.5, most: 4.5 };
const POINT_RADIUS = 6;

function polyline(line: Line, kind: string, mapping: Mapping): Node {
  const points = line.map((place) => mapping(place).map((v) => v.toFixed(1)).join(",")).join(" ");
  return vue().h("polyline", { class: kind, points });
}

function circle([cx, cy]: Place, r: number, attributes: object): Node {
  return vue().h("circle", { cx, cy, r, ...attributes });
}

/** A path in one of the panes: its whole length, and the part that is summed. */
function pane(over: Over, number: number, width: number, height: number): Node {
  const { h } = vue();
  const mapping: Mapping = ([x, y]) => [(number + (x + 1) / 2) * width, ((1 - y) / 2) * height];
  const lines = (all: Line[]) => all.map((line) => line.map(mapping));
  const { path: whole, sampled, directed } = over;
  const point = over.point && mapping(over.point);
  const shapes = pathShapes({ path: lines(whole), sampled: lines(sampled), point, directed });
  const marks = shapes.map(([tag, attributes]) => h(tag, attributes));
  const id = `flowtex-pane-${number}`;
  const clip = h("clipPath", { id }, h("rect", { x: number * width, y: 0, width, height }));
  return h("g", { "clip-path": `url(#${id})` }, [clip, ...marks]);
}

export const path = {
  name: "flowtex-path",
  props: ["over"],
  setup(props: { over: Over | null }) {
    const { h, ref, onMounted, onBeforeUnmount } = vue();
    const place = ref<Element | null>(null);
    const size = ref([1, 1]);
    const watcher = new ResizeObserver(([{ contentRect }]) => {
      size.value = [contentRect.width, contentRect.height];
    });
    onMounted(() => place.value && watcher.observe(place.value));
    onBeforeUnmount(() => watcher.disconnect());
    return () => {
      const { over } = props;
      if (!over) return h("div", { ref: place });
      const [width, height] = size.value;
      const wide = width / over.panes;
      const panes = over.shown.map((n) => pane(over, n, wide, height));
      return h("div", { ref: place }, h("svg", panes));
    };
  },
};

/** The mapping that fits places into the inset; the samples of a path are a pixel apart in the picture. */
function fitting(places: Place[], aspect: number): Mapping {
  const { width: wide, height: high, margin } = INSET;
  const flat: Mapping = ([x, y]) => [x * aspect, -y];
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

function enlarged({ samples, sampled, point, aspect }: Over): Node {
  const { h } = vue();
  const places = samples.map(({ x, y }): Place => [x, y]);
  const mapping = fitting(places, aspect);
  const centres = places.map(mapping);
  const lines = sampled.map((line) => polyline(line, "sampled", mapping));
  const dots = samples.map(({ weight, grey }, n) => {
    const [cx, cy] = centres[n];
    const [nx, ny] = centres[n > 0 ? n - 1 : 1] ?? [cx + DOT.most, cy + DOT.most];
    // Neighbours touch, and do not hide one another.
    const most = clamp(0.75 * Math.hypot(nx - cx, ny - cy), DOT.least, DOT.most);
    return circle([cx, cy], most * (0.35 + 0.65 * weight), { fill: grey });
  });
  if (point) dots.push(circle(mapping(point), POINT_RADIUS, { class: "point" }));
  const { width, height } = INSET;
  return h("svg", { viewBox: `0 0 ${width} ${height}`, width, height }, [...lines, ...dots]);
}

export const inset = {
  name: "flowtex-inset",
  props: ["over"],
  setup(props: { over: Over | null }) {
    return () => vue().h("div", props.over?.samples.length ? [enlarged(props.over)] : []);
  },
};
