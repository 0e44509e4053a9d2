// Ticks at the left and lower border of the picture, or a bar of a round length.

import { pointInPlane, type Camera } from "./camera.ts";
import { shape, withUnit } from "./dom.ts";
import { lonLatOf } from "./lonlat.ts";
import type { AxesKind, Earth, Header, Part } from "./protocol.ts";
import { degreeTicks, offsetOf, ticksOf, type Tick } from "./ticks.ts";
import { clamp, length, subtract, type Vector } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

/** Parts of a border; values between their ends are interpolated linearly. */
const PARTS = 48;
/** Least share of the distance along a border that its coordinate accounts for; an oblique view has less. */
const LEAST_SHARE = 0.999;
/** Degrees by which the latitudes of one row may differ where parallels are straight. */
const SAME_LATITUDE = 0.1;
/** Share of a map's height that is kept from its poles, and half a turn with what rounding adds. */
const [POLE_SHARE, HALF_TURN] = [1 / 64, 180.1];
/** Share of a border's degrees by which they may go back, as along an outline. */
const MOST_BACK = 0.02;
/** Pixels of a letter and between labels at the lower border, and between labels at the left one. */
const [LETTER_PX, GAP_PX, ROW_PX] = [6.5, 14, 34];
const [TICK_PX, LINE_PX] = [4, 13];
/** Pixels beside the picture. */
const ASIDE_PX = 42;
/** Most ticks of a border, and the widest scale bar, in pixels and as a share of the picture. */
const [MOST_TICKS, BAR_PX, BAR_SHARE] = [9, 140, 0.3];
/** Share of the half width of the view by which the scale of a map is measured. */
const MIDDLE_SHARE = 0.02;
const COORDINATES = ["x", "y", "z"];

/** A name, without its unit if there is no room for it. */
const fitting = (name: string, room: number) =>
  name.length * LETTER_PX > room ? name.replace(/ .*/, "") : name;

/** Values of a coordinate at even places of a border, and its name, or the letters of its two sides. */
export interface Border {
  readonly name?: string;
  /** What was taken from the values. */
  readonly offset?: string;
  readonly letters?: string;
  readonly values: number[];
}

/** Ticks of a border and the shares of its length at which they are. */
export function placedTicks({ values, letters }: Border, most: number): (Tick & { share: number })[] {
  const finite = values.filter(Number.isFinite);
  if (finite.length < 2) return [];
  const [low, high] = [Math.min(...finite), Math.max(...finite)];
  const ticks = letters ? degreeTicks(low, high, letters, most) : ticksOf(low, high, false, most);
  return ticks.flatMap((tick) => {
    const n = values.findIndex((value, at) => isBetween(tick.value, value, values[at + 1]));
    if (n < 0) return [];
    const part = (tick.value - values[n]) / (values[n + 1] - values[n] || 1);
    return [{ ...tick, share: (n + part) / (values.length - 1) }];
  });
}

const isBetween = (value: number, a: number, b: number) =>
  Math.min(a, b) <= value && value <= Math.max(a, b);

/** Whether a surface lies in a plane, along whose sides coordinates can be read. */
export function hasTicks({ geometry, earth }: Header): boolean {
  return geometry.planar && (!earth || earth.map !== null);
}

export class Axes {
  readonly element = shape("svg", { class: "axes", "aria-hidden": "true" });
  private readonly host: Viewer;

  constructor(host: Viewer) {
    this.host = host;
  }

  draw(kind: AxesKind): void {
    const { header, camera, stage } = this.host;
    this.element.replaceChildren();
    const [width, height] = [stage.clientWidth, stage.clientHeight];
    if (kind === "none" || !header || !camera || !width || !height) return;
    this.element.style.cssText = `width: ${width}px; height: ${height}px`;
    if (kind === "scale") return this.drawBar(header, camera, width, height);
    const below = borderOf(this.host, [-1, -1], [1, -1]);
    const aside = borderOf(this.host, [-1, -1], [-1, 1]);
    if (below) this.drawBelow(below, width, height);
    if (aside) this.drawAside(aside, height);
  }

  private drawBelow(border: Border, width: number, height: number): void {
    const { name, offset } = border;
    const shown = name && offset ? name.replace(/^\w+/, `$& − ${offset}`) : name;
    const isTooWide = (ticks: readonly { share: number; text: string }[]) =>
      ticks.some(({ share, text }, n) => {
        const apart = n ? Math.abs(share - ticks[n - 1].share) * width : width;
        const letters = Math.max(text.length, ticks[n - 1]?.text.length ?? 0);
        // Without its offset nobody knows what the ticks mean.
        const between = offset && n && n === ticks.length - 1 ? (shown?.length ?? 0) * LETTER_PX + GAP_PX : 0;
        return apart < letters * LETTER_PX + GAP_PX + between;
      });
    let most = MOST_TICKS;
    let ticks = placedTicks(border, most);
    while (most > 2 && ticks.length && isTooWide(ticks)) ticks = placedTicks(border, (most -= 1));
    for (const { share, text } of ticks) {
      this.line(share * width, height, share * width, height + TICK_PX);
      this.text(share * width, height + TICK_PX + 2, text, "below");
    }
    const [before, last] = ticks.slice(-2);
    if (!shown || !last) return;
    const middle = ((before.share + last.share) / 2) * width;
    const room = (last.share - before.share) * width - LETTER_PX * last.text.length - GAP_PX;
    this.text(middle, height + TICK_PX + 2, offset ? shown : fitting(shown, room), "below name");
  }

  private drawAside(border: Border, height: number): void {
    const { name, offset } = border;
    const row = ROW_PX + (offset ? LINE_PX : 0);
    const most = Math.min(Math.max(Math.floor(height / row), 2), MOST_TICKS);
    const ticks = placedTicks(border, most);
    for (const { share, text } of ticks) {
      const y = (1 - share) * height;
      this.line(-TICK_PX, y, 0, y);
      this.text(-TICK_PX - 3, y, text, "aside");
    }
    const [before, last] = ticks.slice(-2);
    if (!name || !last) return;
    const middle = (1 - (before.share + last.share) / 2) * height;
    const lines = offset ? [name.replace(/( .*)?$/, " −"), offset] : [fitting(name, ASIDE_PX)];
    lines.forEach((words, n) => {
      this.text(-TICK_PX - 3, middle + LINE_PX * (n - (lines.length - 1) / 2), words, "aside name");
    });
  }

  private drawBar(header: Header, camera: Camera, width: number, height: number): void {
    const { earth, lengthUnit } = header;
    const pixel = ((2 * camera.height) / height) * scaleOf(this.host, header, camera);
    const most = Math.min(BAR_PX, BAR_SHARE * width) * pixel;
    const power = 10 ** Math.floor(Math.log10(most));
    const size = power * ([5, 2].find((factor) => factor * power <= most) ?? 1);
    const [x, y] = [size / pixel, height + TICK_PX + 4];
    this.line(0, y, x, y);
    for (const end of [0, x]) this.line(end, y - TICK_PX, end, y + TICK_PX);
    const isLong = (earth !== null || lengthUnit === "m") && size >= 1000;
    const text = withUnit(String(Number((isLong ? size / 1000 : size).toPrecision(3))), isLong ? "km" : lengthUnit);
    this.text(x + 8, y - 5, text, "beside");
  }

  private line(x1: number, y1: number, x2: number, y2: number): void {
    const ends = Object.entries({ x1, y1, x2, y2 }).map(([name, value]) => [name, value.toFixed(1)]);
    this.element.append(shape("line", Object.fromEntries(ends)));
  }

  private text(x: number, y: number, words: string, kind: string): void {
    const place = { x: x.toFixed(1), y: y.toFixed(1), class: kind };
    this.element.append(shape("text", place, [document.createTextNode(words)]));
  }
}

/** Lengths on the Earth for one of its map, in the middle of the view; 1 elsewhere. */
function scaleOf({ parts }: Viewer, header: Header, camera: Camera): number {
  const { earth } = header;
  if (!earth?.map) return 1;
  const [a, b] = [-1, 1].map((x) => pointInPlane(header.geometry, camera, MIDDLE_SHARE * x, 0));
  const [from, to] = [a, b].map((place) => lonLatOf(earth, place, parts.get("lonlat")));
  if (!from || !to) return 1;
  const [east, north] = [to[0] - from[0], to[1] - from[1]].map((degrees) => (degrees * Math.PI) / 180);
  const middle = (((from[1] + to[1]) / 2) * Math.PI) / 180;
  const angle = Math.hypot(Math.sin(east / 2) * 2 * Math.cos(middle), north);
  return (angle * earth.radius) / length(subtract(b, a)) || 1;
}

/** The coordinate that goes along a border of the picture, if one does. */
function borderOf(host: Viewer, from: [number, number], to: [number, number]): Border | null {
  const { header, camera, parts } = host;
  if (!header || !camera || !hasTicks(header)) return null;
  const places = Array.from({ length: PARTS + 1 }, (_, n) =>
    pointInPlane(
      header.geometry,
      camera,
      from[0] + ((to[0] - from[0]) * n) / PARTS,
      from[1] + ((to[1] - from[1]) * n) / PARTS,
    ),
  );
  const { earth, lengthUnit } = header;
  if (earth?.map) {
    const along = from[1] === to[1] ? 0 : 1;
    const degrees = degreesAlong({ ...earth, map: earth.map }, places, along, parts.get("lonlat"));
    const values = unwrapped(degrees);
    return goesOneWay(values) ? { letters: along ? "NS" : "EW", values } : null;
  }
  const way = subtract(places[PARTS], places[0]);
  const axis = way.map(Math.abs).indexOf(Math.max(...way.map(Math.abs)));
  if (Math.abs(way[axis]) < LEAST_SHARE * length(way)) return null;
  // Lines along which the coordinate is the same have to lie across the border.
  const [right, up] = camera.axes;
  const border = from[1] === to[1] ? right : up;
  const normal = header.geometry.frame.slice(6).map(Math.abs);
  const across = [0, 1, 2].find((n) => n !== axis && n !== normal.indexOf(Math.max(...normal)));
  if (Math.abs(border[across ?? 0]) > 1 - LEAST_SHARE) return null;
  const name = withUnit(COORDINATES[axis], lengthUnit && `(${lengthUnit})`);
  const values = places.map((place) => place[axis]);
  const offset = offsetOf(Math.min(...values), Math.max(...values), MOST_TICKS);
  return { name, offset: offset?.text, values: values.map((value) => value - (offset?.value ?? 0)) };
}

/** Longitudes, or latitudes, at places of a border; NaN beside the map. */
export function degreesAlong(earth: Earth & { map: number[] }, places: Vector[], along: number, lonlat?: Part): number[] {
  const [low, high] = [earth.map.slice(0, 2), earth.map.slice(2)];
  const [width, height] = low.map((c, n) => high[n] - c);
  const read = (x: number, y: number) => lonLatOf(earth, [x, y, 0], lonlat) ?? [NaN, NaN];
  const middle = low[0] + width / 2;
  const [one, other] = [middle, low[0] + width / 4].map((x) => read(x, low[1] + height / 4)[1]);
  const isStraight = Math.abs(one - other) < SAME_LATITUDE;
  return places.map(([x, y]) => {
    if (along ? y < low[1] || y > high[1] : x < low[0] || x > high[0]) return NaN;
    if (!isStraight) return read(clamp(x, low[0], high[0]), clamp(y, low[1], high[1]))[along];
    if (along) return read(middle, y)[1];
    // Along a straight parallel meridians are even; a pole may be a line, along which none is known.
    const row = clamp(y, low[1] + POLE_SHARE * height, high[1] - POLE_SHARE * height);
    const [from, to] = [0, 1 / 64].map((share) => read(middle + share * width, row)[0]);
    const away = (64 * (((to - from + 540) % 360) - 180) * (x - middle)) / width;
    return Math.abs(away) < HALF_TURN ? from + away : NaN;
  });
}

/** Whether values only rise or only fall, so that each is met once. */
function goesOneWay(values: number[]): boolean {
  const finite = values.filter(Number.isFinite);
  const steps = finite.slice(1).map((value, n) => value - finite[n]);
  const [rise, fall] = [1, -1].map((sign) => steps.reduce((sum, step) => sum + Math.max(sign * step, 0), 0));
  return Math.min(rise, fall) < MOST_BACK * Math.max(rise, fall);
}

/** Angles without the jumps of a turn. */
function unwrapped(degrees: number[]): number[] {
  let turns = 0;
  return degrees.map((value, n) => {
    if (n && Number.isFinite(value - degrees[n - 1])) turns -= Math.round((value - degrees[n - 1]) / 360);
    return value + 360 * turns;
  });
}
