// What a click shows: the path through the point, over the picture, and a card of its numbers.

import type { Camera } from "./camera.ts";
import { dom, numberText, shape, withUnit } from "./dom.ts";
import type { Timer } from "./lifetime.ts";
import { lonLatOf, lonLatText } from "./lonlat.ts";
import { speedAt, velocityOnEarth } from "./onearth.ts";
import type { Options } from "./options.ts";
import { type Dot, type Line, pathShapes, type Place, sampleChart } from "./samples.ts";
import { valuesAt, type Found, type Point } from "./picking.ts";
import { pixelSum, type Sample } from "./pixelsum.ts";
import { pathThrough, type PointPath } from "./pointpath.ts";
import type { Header, Part } from "./protocol.ts";
import type { Vector } from "./vectors.ts";
import type { Viewer } from "./viewer.ts";

const TITLE = "Path through this point";
/** Digits of a coordinate, at first and at most: more are shown the closer the view is. */
const FEWEST_DIGITS = 4;
const MOST_DIGITS = 14;
/** Those of a velocity, which comes from numbers in half precision. */
const VELOCITY_DIGITS = 3;
/** Milliseconds for which a click waits until points can be found, and between two looks. */
const PATIENCE_MS = 5000;
const RETRY_MS = 40;
/** Places that are distinct in half the height of a view, and metres of a degree on the Earth. */
const PLACES_IN_VIEW = 200;
const DEGREE_M = 111_195;
/** Radius of the sample of the greatest weight, in pixels. */
const DOT_RADIUS = 8;
/** Two components of a vector in a surface that lies across z, else three. */
function vectorText(vector: readonly number[], size: number, digits: number, flat: boolean): string {
  const texts = vector.slice(0, flat ? 2 : 3).map((x) => {
    const value = Math.abs(x) < 10 ** (-1 - digits) * size ? 0 : x; // a residue
    return digits > 5 ? String(Number(value.toPrecision(digits))) : numberText(value, digits);
  });
  return `(${texts.join(", ")})`;
}

const liesAcross = ({ planar, frame }: Header["geometry"]) => planar && Math.abs(frame[8]) > 0.999;

/** Where a point is: longitude and latitude on the Earth, else its position with the unit. */
export function placeText(
  position: readonly number[],
  header: Header,
  parts: ReadonlyMap<string, Part>,
  camera: Camera | null,
  isWithUnit = false,
): string {
  const { earth } = header;
  const lonLat = earth && lonLatOf(earth, position, parts.get("lonlat"));
  if (lonLat) return lonLatText(lonLat, (camera?.height ?? 0) / PLACES_IN_VIEW / DEGREE_M);
  const text = positionText(position, header, camera);
  return isWithUnit ? withUnit(text, header.lengthUnit) : text;
}

function positionText(position: readonly number[], header: Header, camera: Camera | null): string {
  const { geometry } = header;
  const zoom = Math.max(camera?.zoom ?? 1, 1);
  const digits = Math.min(Math.ceil(FEWEST_DIGITS + Math.log10(zoom)), MOST_DIGITS);
  const isInPlane =
    liesAcross(geometry) && Math.abs(position[2] - geometry.center[2]) < 1e-12 * geometry.extent;
  return vectorText(position, geometry.extent, digits, isInPlane);
}

export class PointCard {
  readonly element = dom("div", { class: "card glass", role: "region", hidden: "" });
  readonly overlay = shape("svg", {});
  private readonly host: Viewer;
  private readonly list = dom("dl");
  private readonly chart = dom("div");
  private chosen: Found | null = null;
  /** The point that was read last, where a host reads them, and the number of what it was asked. */
  private read: Point | null = null;
  private asked = 0;
  private later: Timer | null = null;
  /** Whether the numbers are shown here: in the view that was clicked. */
  private hasNumbers = true;
  /** The path that is drawn, and its point. */
  private drawn: { path: PointPath; point: Vector; samples: Sample[] } | null = null;

  constructor(host: Viewer) {
    this.host = host;
    this.element.setAttribute("aria-label", TITLE);
    this.overlay.setAttribute("class", "path");
    const button = dom("button", { type: "button", class: "link" }, ["Close"]);
    button.addEventListener("click", () => this.close());
    this.element.append(
      dom("div", { class: "first" }, [dom("span", {}, [TITLE]), button]),
      this.list,
      this.chart,
    );
  }

  /** Show the path through what is at (x, y), from -1 to 1, right and up, in all views, or none. */
  choose(x: number, y: number, until = performance.now() + PATIENCE_MS): Point | null {
    const { lifetime, canPick, options, together } = this.host;
    lifetime.cancel(this.later);
    if (!options.streamed && !canPick && performance.now() < until) {
      // The program that finds points is still being compiled.
      this.later = lifetime.later(() => this.choose(x, y, until), RETRY_MS);
      return null;
    }
    this.close();
    for (const { card } of together) if (card !== this) card.begin(x, y, false);
    return this.begin(x, y, true)?.point ?? null;
  }

  /** Show this view's own path through what is at (x, y), perhaps with its numbers. */
  private begin(x: number, y: number, hasNumbers: boolean): Found | null {
    const { options } = this.host;
    this.hasNumbers = hasNumbers;
    if (options.streamed) {
      void this.ask({ place: [x, y] });
      return null;
    }
    const found = this.host.find(x, y);
    if (!found) return null;
    if (hasNumbers) options.onPoint?.(found.point);
    if (options.reader) void this.ask(found.point);
    else {
      this.chosen = found;
      this.update();
    }
    return found;
  }

  /** Show the path that a host reads. */
  private async ask(at: Parameters<NonNullable<Options["reader"]>>[0]): Promise<void> {
    const { options, header } = this.host;
    const number = (this.asked += 1);
    const found = await options.reader?.(at, true).catch(() => null);
    const { camera } = this.host;
    if (number !== this.asked || header !== this.host.header || !header || !camera) return;
    if (!found?.path) return this.hasNumbers ? this.close() : this.clear();
    if ("place" in at && this.hasNumbers) options.onPoint?.(found.point);
    this.read = found.point;
    const { point, path } = found;
    this.tell(point, path, header, camera);
    this.show(path, point.position as Vector, []);
  }

  private show(path: PointPath, point: Vector, samples: Sample[]): void {
    this.drawn = { path, point, samples };
    this.draw();
  }

  /** Show no path, in no view. */
  close(): void {
    for (const { card } of this.host.together) card.clear();
  }

  private clear(): void {
    this.host.lifetime.cancel(this.later);
    this.chosen = this.read = null;
    this.asked += 1;
    this.hide();
    this.host.options.explainer?.clear();
  }

  /** Show nothing of the chosen point until the next update. */
  hide(): void {
    this.drawn = null;
    this.element.hidden = true;
    this.host.panel.keepFocus();
    this.overlay.replaceChildren();
  }

  /** Show the path as things are now; where the point's tile has gone it stays as it was. */
  update(): void {
    const { chosen } = this;
    if (this.read) return void this.ask(this.read);
    const { options, camera, shown, header, tiles, settings, stage, requests } = this.host;
    if (!chosen || options.bare || !camera || !shown || !header) return;
    const { point, layer, place } = chosen;
    const scene = tiles?.layers.find(({ key }) => String(key) === String(layer.key))?.scene;
    const position = point.position as Vector;
    const exact = requests.trajectory(position);
    if (!scene || scene.missing(shown[0], shown[1]).length) {
      if (!exact) return;
      const now = { ...exact, sampled: [], directed: true };
      this.tell({ ...point, values: {} }, now, header, camera);
      return this.show(now, position, []);
    }
    const at = { scene, moment: shown, place, position };
    const pixel = { at, settings, camera, rows: stage.clientHeight };
    const summed = exact || options.explainer ? undefined : pixelSum(pixel)?.samples;
    const path = { ...pathThrough(at, settings, camera, stage.clientHeight), samples: summed, ...exact };
    const places = this.host.parts.get("lonlat");
    const eastNorth = velocityOnEarth(at, places) ?? undefined;
    const speed = exact ? undefined : speedAt(at, places);
    const now = { ...point, values: valuesAt(scene, shown, place), eastNorth, speed };
    this.report(now);
    this.tell(now, path, header, camera);
    const samples = options.explainer?.explain(pixel) ?? [];
    this.show(path, position, samples);
  }

  /** Tell the host of the chosen point with other values than before. */
  private report(point: Point): void {
    const { chosen } = this;
    if (!chosen || !this.hasNumbers || JSON.stringify(chosen.point.values) === JSON.stringify(point.values)) return;
    this.chosen = { ...chosen, point: { ...chosen.point, values: point.values } };
    this.host.options.onPoint?.(this.chosen.point);
  }

  private tell(point: Point, path: PointPath, header: Header, camera: Camera): void {
    const { velocity, samples = [] } = path;
    const { unit } = header.speed;
    const { eastNorth, speed } = point;
    // On a map this is the speed on the Earth, and not in the surface.
    const label = eastNorth ? "speed" : header.speed.label;
    const size = Math.hypot(...(eastNorth ?? velocity));
    const speedShown = speed ?? size;
    const lines = new Map<string, string>();
    const where = placeText(point.position, header, this.host.parts, camera, true);
    if (eastNorth) {
      const [east, north] = eastNorth;
      lines.set("place", where);
      lines.set("eastward", withUnit(numberText(east, VELOCITY_DIGITS), unit));
      lines.set("northward", withUnit(numberText(north, VELOCITY_DIGITS), unit));
    } else {
      const text = vectorText(velocity, size, VELOCITY_DIGITS, liesAcross(header.geometry));
      lines.set("position", where);
      lines.set(label.replace("speed", "velocity").replaceAll("|", ""), withUnit(text, unit));
    }
    lines.set(label, withUnit(numberText(speedShown, VELOCITY_DIGITS), unit));
    for (const [name, value] of Object.entries(point.values)) {
      const named = header.scalars.choices.find((each) => each.name === name) ?? header.scalars;
      lines.set(named.label, withUnit(numberText(value), named.unit));
    }
    if (point.mark) lines.set("critical point", point.mark);
    this.list.replaceChildren(
      ...[...lines].flatMap(([word, value]) => [dom("dt", {}, [word]), dom("dd", {}, [value])]),
    );
    const lagUnit = header.slices.byTime ? header.slices.timeUnit : header.lengthUnit;
    this.chart.replaceChildren(...(samples.length > 1 ? [sampleChart(samples, lagUnit)] : []));
    this.element.hidden = !this.hasNumbers || this.host.options.explainer !== undefined;
  }

  /** Draw the path where the camera sees it. */
  draw(): void {
    const { drawn } = this;
    const { camera, stage } = this.host;
    if (!drawn || !camera) return;
    const { clientWidth: width, clientHeight: height } = stage;
    const placeOf = (point: Vector): Place | null => {
      const place = camera.project(point);
      return place && [((place[0] + 1) / 2) * width, ((1 - place[1]) / 2) * height];
    };
    const linesOf = (points: Vector[]) => {
      const lines: Line[] = [[]];
      for (const place of points.map(placeOf)) {
        if (place) lines[lines.length - 1].push(place);
        else lines.push([]);
      }
      return lines.filter((line) => line.length > 1);
    };
    const { path, sampled, directed } = drawn.path;
    const point = placeOf(drawn.point);
    const { samples } = drawn;
    const most = Math.max(...samples.map(({ weight }) => weight));
    const dots = samples.flatMap(({ position, weight, grey }): Dot[] => {
      const place = placeOf(position);
      return place ? [{ place, radius: DOT_RADIUS * Math.sqrt(weight / most), grey }] : [];
    });
    const lines = { path: linesOf(path), sampled: dots.length ? [] : linesOf(sampled) };
    const shapes = pathShapes({ ...lines, dots, point, directed });
    this.overlay.replaceChildren(...shapes.map(([tag, attributes]) => shape(tag, attributes)));
  }
}
