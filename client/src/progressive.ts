// Progressive drawing: a draft in the time that there is, then the full picture strip by strip.

import type { SceneView } from "./bareview.ts";
import type { mat2d as Mat2d } from "gl-matrix";
import * as mat2d from "gl-matrix/esm/mat2d.js";
import { Camera, projection, rays } from "./camera.ts";
import type { Graphics } from "./context.ts";
import type { EarthView } from "./earthlayer.ts";
import type { Layer, PlaceAt, Places } from "./places.ts";
import type { Program } from "./programs.ts";
import { draftUniforms, learnedPrice, motionFactor, movingTime, quality, rowsIn } from "./quality.ts";
import type { Scene } from "./scene.ts";
import { hasArrows, isEven, isNear, type Moment, uniforms, type ViewState } from "./uniforms.ts";
import { clamp, scale, subtract, toFrame } from "./vectors.ts";

/** Milliseconds for a picture in motion of one of many views at least, and for a strip at rest. */
const MOVING_LEAST_MS = 14;
const STRIP_MS = 40;
/** Rows that are drawn with smooth outlines at a time. */
const SMOOTH_ROWS = 256;

type Pen = CanvasRenderingContext2D | null;

/** Put a picture where another one is, of which nothing is to be seen through it. */
function replace(pen: Pen, picture: HTMLCanvasElement): void {
  pen?.clearRect(0, 0, picture.width, picture.height);
  pen?.drawImage(picture, 0, 0);
}

const penOf = (canvas: HTMLCanvasElement, alpha: boolean): Pen => canvas.getContext("2d", { alpha });

/** What is drawn of a surface. */
interface Content {
  readonly scene: Scene | null;
  readonly places: Places | null;
  /** Choose what is drawn at a moment: the whole, or the root and the tiles of a large surface. */
  arrange(shown: Moment): Layer[];
  /** Whether outlines are smoothed. */
  readonly smooth: boolean;
  /** Whether more of what is to be seen is on its way. */
  readonly isComing: boolean;
}

export class ProgressiveRenderer {
  private readonly viewer: SceneView;
  private readonly content: Content;
  private readonly graphics: Graphics;
  private readonly canvas: HTMLCanvasElement;
  private readonly pen: Pen;
  /** The last full picture, with the camera that it shows. */
  private readonly last = document.createElement("canvas");
  private readonly lastPen: Pen;
  private lastCamera: Camera | null = null;
  /** A picture of few pixels. */
  private readonly coarse = document.createElement("canvas");
  private readonly coarsePen: Pen;
  /** Lines above the flow, what they show, and the pixels of the page's for the picture's. */
  private readonly front = document.createElement("canvas");
  private readonly frontPen = this.front.getContext("2d");
  private frontLook = "";
  /** Number of the picture, and of the last draft; rows of the full picture that are drawn. */
  private version = 1;
  private draftVersion = 0;
  private rowsDone = 0;
  /** What is drawn of it, and whether there is more by now. */
  private layers: Layer[] = [];
  private isRefined = false;
  /** Milliseconds that a draft takes beside its sums. */
  private fixed = 4;
  /** Whether the picture on show has fewer pixels or samples than the full one. */
  private isCoarse = false;

  constructor(viewer: SceneView, content: Content) {
    this.viewer = viewer;
    this.content = content;
    this.graphics = viewer.graphics;
    this.canvas = viewer.canvas;
    const { canvas, last, coarse } = this;
    const pens = [canvas, last, coarse].map((each) => penOf(each, viewer.isClear ?? false));
    [this.pen, this.lastPen, this.coarsePen] = pens;
  }

  /** Begin another picture, of the same things where only the camera has changed. */
  restart(cameraOnly = false): void {
    if (!cameraOnly) this.lastCamera = null;
    this.version += 1;
    this.rowsDone = 0;
  }

  /** More of the surface is there: draw the picture again, at once if nothing else is coming, else when it is complete. */
  refine(): void {
    if (this.rowsDone >= this.canvas.height || !this.content.isComing) this.rowsDone = 0;
    this.isRefined = true;
  }

  /** Change the size; what is on show stays, stretched, until there is something better. */
  resize(width: number, height: number): void {
    const { canvas, coarse, last } = this;
    coarse.width = canvas.width;
    coarse.height = canvas.height;
    this.coarsePen?.drawImage(canvas, 0, 0);
    canvas.width = last.width = width;
    canvas.height = last.height = height;
    if (coarse.width > 1) this.pen?.drawImage(coarse, 0, 0, width, height);
  }

  dispose(): void {
    for (const canvas of [this.last, this.coarse, this.front]) canvas.width = canvas.height = 0;
  }

  /** Go on with the picture until a time; returns whether it is complete. */
  draw(program: Program, shown: Moment, until: number): boolean {
    const moving = this.isMoving;
    if (this.draftVersion !== this.version) return this.draft(program, shown, moving);
    if (moving) return false;
    let complete = false;
    do complete = this.strip(program, shown) && !this.isRefined;
    while (!complete && performance.now() < until);
    return complete;
  }

  private get isMoving(): boolean {
    return this.viewer.player.playing || this.viewer.isHeld;
  }

  /** Whether details are left out for the sake of motion. */
  get leavesOut(): boolean {
    return this.isCoarse && this.isMoving;
  }

  private arrange(shown: Moment): void {
    this.isRefined = false;
    this.layers = this.content.arrange(shown);
  }

  /** A picture in the time that there is. */
  private draft(program: Program, shown: Moment, moving: boolean): boolean {
    const { width, height } = this.canvas;
    const samples = Number(this.viewer.settings.samples);
    // Views that move share the time; at rest one after the other gets its whole picture.
    const crowd = moving ? this.graphics.waiting.size + 1 : 1;
    this.arrange(shown);
    const price = program.price * this.factor(samples);
    const isPlaying = this.viewer.player.playing && !this.viewer.isHeld;
    const time = movingTime(price, this.fixed, width * height, samples, isPlaying);
    const budget = Math.max(time / crowd, MOVING_LEAST_MS);
    const best = quality(price, this.fixed, width * height, samples, budget);
    const w = Math.max(Math.round(width * best.scale), 1);
    const h = Math.max(Math.round(height * best.scale), 1);
    this.draftVersion = this.version;
    const reuse = best.scale < 1 ? this.reuse() : null;
    if (!reuse?.covers) {
      const started = performance.now();
      this.place(shown, w, h);
      const summed = this.sum(program, shown, 0, h, best.samples);
      this.show(shown, false, best.samples);
      this.fixed += 0.5 * (clamp(performance.now() - started - summed, 0.5, 500) - this.fixed);
    }
    if (reuse && this.pen) {
      this.pen.imageSmoothingEnabled = !reuse.shifts;
      this.pen.setTransform(...reuse.matrix);
      replace(this.pen, this.last);
      this.pen.setTransform(1, 0, 0, 1, 0, 0);
    }
    this.isCoarse = best.scale < 1 || best.samples < samples;
    const isWhole = !this.isCoarse && !this.content.smooth;
    if (isWhole) this.complete();
    this.drawLines(shown);
    return isWhole && !this.isRefined;
  }

  /** One more strip of the full picture, which is shown when it is complete. */
  private strip(program: Program, shown: Moment): boolean {
    const { width, height } = this.canvas;
    const samples = Number(this.viewer.settings.samples);
    if (this.rowsDone >= height) this.rowsDone = 0;
    if (this.rowsDone === 0) {
      this.arrange(shown);
      // What is on its way to the graphics card is waited for, or each tile would cost a picture.
      if (this.isRefined) return false;
    }
    this.place(shown, width, height);
    const price = program.price * this.factor(samples);
    const rows = Math.min(height - this.rowsDone, rowsIn(STRIP_MS, price, width, samples));
    this.sum(program, shown, this.rowsDone, rows, samples);
    this.rowsDone += rows;
    if (this.rowsDone < height) return false;
    this.show(shown, this.content.smooth, samples);
    this.complete();
    this.drawLines(shown);
    return true;
  }

  /** Put the lines of a map, and labels, on the picture: all its pixels are theirs, in drafts as well. */
  private drawLines(shown: Moment): void {
    const { front, frontPen, graphics } = this;
    const { camera, ratio } = this.viewer;
    const { scene } = this.content;
    const { width, height } = this.canvas;
    if (!scene || !camera || !frontPen) return;
    const { earth, bodies } = scene;
    if (!earth.lines.length && !bodies.labels.length) return;
    const { state, aspect } = camera;
    const look = JSON.stringify([state, aspect, width, height, earth.lines, earth.version]);
    if (look !== this.frontLook) {
      const { anchor } = this.viewer.view(shown, ratio);
      const { canvas } = graphics;
      if (canvas.width < width) canvas.width = width;
      if (canvas.height < height) canvas.height = height;
      front.width = width; // which clears it
      front.height = height;
      earth.drawLines({ camera, anchor, width, height, ratio }, () => {
        const top = canvas.height - height;
        frontPen.drawImage(canvas, 0, top, width, height, 0, 0, width, height);
      });
      bodies.drawLabels(frontPen, { camera, anchor, width, height, ratio });
      this.frontLook = look;
    }
    this.pen?.drawImage(front, 0, 0);
  }

  private complete(): void {
    const { camera, player } = this.viewer;
    this.rowsDone = this.canvas.height;
    this.isCoarse = false;
    this.draftVersion = this.version;
    replace(this.lastPen, this.canvas);
    if (camera && !player.playing) {
      this.lastCamera = new Camera(camera.state, camera.limits, camera.flat, camera.aspect);
    }
  }

  /** How the last full picture lies in the present view, where it serves. */
  private reuse(): Reuse | null {
    const { lastCamera } = this;
    const { camera } = this.viewer;
    const { scene } = this.content;
    if (!scene?.header.geometry.planar || !camera || !lastCamera) return null;
    if (!camera.state.parallel || !lastCamera.state.parallel) return null;
    const { geometry } = scene.header;
    const focus = subtract(camera.state.focal_point, geometry.center);
    const anchor = toFrame(geometry.frame, focus);
    const [before, now] = [lastCamera, camera].map((view) => projection(geometry, view, anchor));
    return reused(before, now, this.canvas.width, this.canvas.height);
  }

  /** As many times more each sample costs while grains move. */
  private factor(samples: number): number {
    const { settings, player } = this.viewer;
    return settings.motion !== "off" || (player.varies && player.playing) ? motionFactor(samples) : 1;
  }

  /** What is at (x, y), from -1 to 1, right and up; null beside the surface. */
  placeAt(shown: Moment, x: number, y: number): PlaceAt | null {
    const { places } = this.content;
    this.place(shown, places?.width || this.canvas.width, places?.height || this.canvas.height);
    return places?.at(x, y) ?? null;
  }

  /** Draw the places of a picture of a size, unless they are there. */
  private place(shown: Moment, width: number, height: number): void {
    const { viewer, layers, content } = this;
    const { camera } = viewer;
    if (!camera || !layers.length) return;
    const { anchor } = viewer.view(shown, this.density(height));
    content.places?.draw({ layers, camera, anchor, width, height });
  }

  /** Pixels drawn along one of the page. */
  private density(height: number): number {
    return (this.viewer.ratio * height) / this.canvas.height;
  }

  /** Compute some rows of a picture, and learn what it costs; returns the milliseconds. */
  private sum(program: Program, shown: Moment, top: number, rows: number, samples: number): number {
    const { places, scene } = this.content;
    const { camera } = this.viewer;
    if (!places || !scene || !camera) return 0;
    const { width, height } = places;
    const view = this.viewer.view(shown, this.density(height));
    const draft = this.isDraft(height, samples);
    const valuesOf = (layer: Scene) => {
      layer.bindNodes(view.anchor);
      layer.bindTextures(shown[0], shown[1]);
      return { ...this.values(layer, scene, camera, view, samples, draft), ...rays(layer.header.geometry, camera, view.anchor, width, height) };
    };
    // The first time is slow by itself.
    if (!program.warm) places.sum(program, top, 1, valuesOf);
    program.warm = true;
    const started = performance.now();
    places.sum(program, top, rows, valuesOf);
    const spent = performance.now() - started;
    program.price = learnedPrice(program.price, spent, width * rows, samples, this.factor(samples));
    return spent;
  }

  private isDraft(height: number, samples: number): boolean {
    return samples !== this.viewer.settings.samples || height !== this.canvas.height;
  }

  /** Have the colours of a picture whose sums are there. */
  private colour(places: Places, shown: Moment, samples: number): void {
    const { scene } = this.content;
    const { camera } = this.viewer;
    if (!scene || !camera) return;
    const { height } = places;
    const view = this.viewer.view(shown, this.density(height));
    const draft = this.isDraft(height, samples);
    const valuesOf = (layer: Scene) => this.values(layer, scene, camera, view, samples, draft);
    const grain = isEven(scene.header, this.viewer.settings) ? Number(valuesOf(scene).u_grain) : null;
    places.colour(grain, valuesOf);
  }

  /** Show the picture whose sums are there, with what is around the surface. */
  private show(shown: Moment, smooth: boolean, samples: number): void {
    const { places } = this.content;
    if (!places) return;
    this.colour(places, shown, samples);
    const { width, height } = places;
    const { canvas } = this.graphics;
    if (canvas.width < width) canvas.width = width;
    if (canvas.height < height) canvas.height = height;
    const most = smooth ? SMOOTH_ROWS : height;
    for (let bottom = 0; bottom < height; bottom += most) {
      this.render(shown, bottom, Math.min(most, height - bottom), smooth);
    }
  }

  /** Draw some rows of a picture, and copy them. */
  private render(shown: Moment, bottom: number, rows: number, smooth: boolean): void {
    const { graphics, viewer } = this;
    const { camera } = viewer;
    const { scene, places } = this.content;
    if (!camera || !scene || !places) return;
    const gl = graphics.context;
    const { width, height } = places;
    const view = viewer.view(shown, this.density(height));
    if (smooth) graphics.bindSmooth(width, rows);
    else gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, -bottom, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(0, 0, width, rows);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LESS);
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
    const [r, g, b] = scene.header.background ?? [1, 1, 1];
    gl.clearColor(r, g, b, viewer.isClear ? 0 : 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const around: EarthView = { camera, anchor: view.anchor, width, height, ratio: viewer.ratio };
    scene.earth.drawGround(around);
    const { bodies } = scene;
    bodies.draw(around, "opaque");
    bodies.seeThrough(() => {
      if (!smooth) return places.show(scene.programs("surface"));
      const matrix = projection(scene.header.geometry, camera, view.anchor);
      places.triangles(scene.programs("smooth"), matrix, view.anchor, { u_bottom: bottom });
    });
    this.drawArrows(shown, view, width, height);
    bodies.draw(around, "clear");
    scene.marks.draw({ ...around, ratio: view.density }, viewer.settings, shown);
    if (smooth) graphics.copySmooth(width, rows);
    this.copy(width, height, bottom, rows);
  }

  /** Draw arrows on what is drawn of the surface. */
  private drawArrows(shown: Moment, view: ViewState, width: number, height: number): void {
    const { camera, settings } = this.viewer;
    const { scene } = this.content;
    if (!scene || !camera || !hasArrows(scene.header, settings)) return;
    const seen = { ...camera.sight(height / view.density), planes: camera.planes };
    const draft = height !== this.canvas.height;
    const layers = this.layers.map((layer) => layer.scene);
    for (const [layer, placed] of scene.arrows.share(seen, settings, layers)) {
      const { arrows, header } = layer;
      const program = arrows.program(settings, isNear(header, settings, view));
      if (!program || !placed.length) continue;
      layer.bindTextures(shown[0], shown[1]);
      const painted = layer.scalarParts(shown[0], shown[1]);
      const values = this.values(layer, scene, camera, view, Number(settings.samples), draft);
      arrows.draw(program, placed, painted, view.anchor, { ...values, u_picture: [width, height] });
    }
  }

  /** All uniforms of a picture. */
  private values(
    { header }: Scene,
    { bodies }: Scene,
    camera: Camera,
    view: ViewState,
    samples: number,
    draft: boolean,
  ) {
    const { settings } = this.viewer;
    const { columns, rows } = header.geometry;
    const plain = header.scalars.name !== null && hasArrows(header, settings) && settings.arrow_color === "scalars";
    return {
      ...uniforms(header, { ...settings, samples }, view),
      ...(draft ? draftUniforms(settings, samples, view.density) : {}),
      u_matrix: projection(header.geometry, camera, view.anchor),
      u_mapped: header.scalars.name !== null && !plain,
      u_plain: plain,
      u_flat: !!header.scalars.flat,
      u_padding: [columns.before, rows.before],
      u_colour: header.colour,
      u_lit: header.lighting,
      u_ground: header.background ?? [1, 1, 1],
      u_opacity: bodies.areBehind ? 1 : header.opacity,
      u_toEye: toFrame(header.geometry.frame, scale(camera.axes[2], -1)),
    };
  }

  /** Copy rows that were drawn, of a picture that may have another size. */
  private copy(width: number, height: number, bottom: number, rows: number): void {
    const { pen } = this;
    if (!pen) return;
    let { canvas } = this.graphics;
    let first = canvas.height - rows;
    const [w, scaled] = [this.canvas.width, this.canvas.height / height];
    pen.imageSmoothingEnabled = w !== width || scaled !== 1;
    if (pen.imageSmoothingEnabled) {
      // Alone, or what lies beside it would be smoothed into its edges.
      const { coarse, coarsePen } = this;
      coarse.width = width;
      coarse.height = rows;
      coarsePen?.drawImage(canvas, 0, first, width, rows, 0, 0, width, rows);
      [canvas, first] = [coarse, 0];
    }
    const to = (height - bottom - rows) * scaled;
    pen.clearRect(0, to, w, rows * scaled);
    pen.drawImage(canvas, 0, first, width, rows, 0, to, w, rows * scaled);
  }
}

/** Range of sizes, beside those it was drawn for, in which a picture's pixels serve. */
const GREATEST_GROWTH = 4;
const LEAST_GROWTH = 0.3;
/** Tolerance of rounding, as a share of the picture. */
const ROUNDING = 1e-6;

/** An affine map of a plane, as a canvas takes it; numbers of an array are doubles. */
type Affine = [number, number, number, number, number, number];

export interface Reuse {
  /** From the old picture's pixels to the new one's. */
  matrix: Affine;
  /** Whether nothing of the new picture is left out. */
  covers: boolean;
  /** Whether it is only moved, so that each pixel stays a pixel. */
  shifts: boolean;
}

const product = (a: Mat2d, b: Mat2d) => mat2d.multiply([0, 0, 0, 0, 0, 0], a, b) as Affine;
const inverse = (a: Mat2d) => mat2d.invert([0, 0, 0, 0, 0, 0], a) as Affine;

/**
 * Return the affine map from the old image of a plane to the new one, or null if the old image does not serve.
 * Without perspective the view of a plane changes by an affine map, so that a drag follows the pointer.
 */
export function reused(
  before: readonly number[],
  now: readonly number[],
  width: number,
  height: number,
): Reuse | null {
  const [w, h] = [width / 2, height / 2];
  const toPixels = (m: readonly number[]) =>
    product([w, 0, 0, -h, w, h], [m[0], m[1], m[4], m[5], m[12], m[13]]);
  const matrix = product(toPixels(now), inverse(toPixels(before)));
  const area = Math.abs(mat2d.determinant(matrix));
  if (!(area > LEAST_GROWTH ** 2 && area < GREATEST_GROWTH ** 2)) return null;
  const [a, b, c, d, e, f] = inverse(matrix);
  const isInside = ([x, y]: number[]) =>
    Math.abs((a * x + c * y + e) / w - 1) < 1 + ROUNDING &&
    Math.abs((b * x + d * y + f) / h - 1) < 1 + ROUNDING;
  const covers = [[0, 0], [width, 0], [0, height], [width, height]].every(isInside);
  const [xx, xy, yx, yy] = matrix;
  const shifts = Math.abs(xx - 1) + Math.abs(yy - 1) + Math.abs(xy) + Math.abs(yx) < ROUNDING;
  if (shifts) for (const n of [4, 5]) matrix[n] = Math.round(matrix[n]);
  return { matrix, covers, shifts };
}
