// The picture of a view, drawn with WebGL2.
//
//   header, parts --> Scene (buffers, textures), Tiles --> ProgressiveRenderer --> canvas
//                     Graphics (context, programs)           uniforms() of header, settings and view

import type { SceneView } from "./bareview.ts";
import type { Painter } from "./painter.ts";
import { pickedPoint, type Found } from "./picking.ts";
import { Places, type Layer } from "./places.ts";
import { ProgressiveRenderer } from "./progressive.ts";
import type { Program } from "./programs.ts";
import type { Header } from "./protocol.ts";
import { CARD_PRICE_MS } from "./quality.ts";
import { Scene } from "./scene.ts";
import { Tiles } from "./tiles.ts";
import { isNear, variantOf, type Moment } from "./uniforms.ts";

export class WebGL2Painter implements Painter {
  scene: Scene | null = null;
  tiles: Tiles | null = null;
  places: Places | null = null;
  shown: Moment | null = null;
  private readonly view: SceneView;
  private readonly renderer: ProgressiveRenderer;
  /** Steps that the player shows next. */
  private next: number[] = [];
  /** Whether the slices of the present moment are missing, so that another one is shown. */
  private isLate = false;

  constructor(view: SceneView) {
    this.view = view;
    this.renderer = new ProgressiveRenderer(view, this);
    if (view.graphics.gl) return;
    view.panel.fail(
      "This browser has no WebGL2 with floating-point targets, which are needed to draw the picture.",
      "Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.",
    );
  }

  open(header: Header): void {
    const { view } = this;
    this.leave();
    this.scene = new Scene(view.graphics, header, view.parts);
    this.tiles = new Tiles(view, this.scene);
    this.places = new Places(view.graphics);
  }

  private leave(): void {
    this.tiles?.dispose();
    this.scene?.dispose();
    this.places?.dispose();
    this.tiles = this.scene = this.places = null;
  }

  dispose(): void {
    this.leave();
    this.renderer.dispose();
  }

  restart(cameraOnly: boolean): void {
    this.renderer.restart(cameraOnly);
  }

  resize(width: number, height: number): void {
    this.renderer.resize(width, height);
  }

  refine(): void {
    this.renderer.refine();
  }

  /** Choose what is drawn at a moment: the whole, or the root and the tiles of a large surface. */
  arrange(shown: Moment): Layer[] {
    const layers = this.tiles?.arrange(shown) ?? [];
    this.view.root.dataset.tiles = String(this.tiles?.pending ?? 0);
    return layers;
  }

  /** Whether outlines are smoothed in the full picture: on a processor it would take many times as long. */
  get smooth(): boolean {
    const { header, options } = this.view;
    if (options.smooth !== undefined || !header) return options.smooth ?? false;
    return this.program(header).price < CARD_PRICE_MS;
  }

  get isComing(): boolean {
    return !!this.tiles?.missing.length;
  }

  get lacking(): string[] {
    const [before, after] = this.view.player.moment;
    return this.scene?.missing(before, after) ?? [];
  }

  /** Steps that have to come before some can be shown. */
  private missing(steps: number[]): number[] {
    return [...new Set(steps.flatMap((step) => this.scene?.lacking(step) ?? []))];
  }

  make(steps: number[], until: number): boolean {
    this.next = steps;
    return !this.missing(steps).length && !!this.scene?.make(steps, until);
  }

  /** Ask for the parts of the steps that are missing, and trace them until a time; gives what can be shown. */
  private available(until: number): Moment | null {
    const { view, scene, shown, lacking } = this;
    const { header, player } = view;
    if (!header || !scene) return null;
    const moment = player.moment;
    const ahead = player.playing ? [1, 2].map((n) => (moment[1] + n) % header.slices.steps) : [];
    const steps = this.missing([moment[0], moment[1], ...this.next, ...ahead]);
    if (steps.length && view.requests.hasSteps && !view.options.isComing?.()) view.requests.wantSteps(steps);
    const isMade = !lacking.length && scene.make(moment.slice(0, 2), until);
    this.isLate = !isMade;
    const marks = view.requests.hasMarks ? scene.marks.lacking(view.settings, moment) : [];
    if (!view.options.isComing?.()) view.requests.wantMarks(marks);
    view.root.dataset.lacking = String(lacking.length + marks.length || Number(!isMade));
    view.panel.wait(lacking, isMade, this.renderer.leavesOut, marks.length > 0);
    view.panel.showKinds(scene.marks.legend(view.settings, moment));
    // A picture that was begun before the slices were there shows another moment.
    if (isMade && String(moment.slice(0, 2)) !== String(shown?.slice(0, 2))) {
      view.trim();
      view.change();
    }
    if (isMade) return (this.shown = moment);
    if (!lacking.length) view.request();
    return shown && scene.isMade(shown.slice(0, 2)) ? shown : null;
  }

  /** The program that draws at the present settings, from near or from afar, also while no time goes by. */
  private program(header: Header, isClose = this.isClose(header), still = !this.view.player.playing): Program {
    const { fullVertex, fragment } = header.shaders;
    const variant = variantOf(header, this.view.settings, isClose, still);
    return this.view.graphics.programs.get(fullVertex, fragment, ...variant);
  }

  private isClose(header: Header): boolean {
    const { view } = this;
    if (!view.camera) return false;
    const seen = view.view([0, 0, 0], view.ratio);
    // Where there are tiles hardly anything of the root is seen.
    const tiles = this.tiles?.layers.slice(1).map(({ scene }) => scene.header) ?? [];
    return (tiles.length ? tiles : [header]).some((part) => isNear(part, view.settings, seen));
  }

  frame(now: number, until: number): void {
    const { view, scene } = this;
    const { graphics, header } = view;
    if (graphics.isLost || !graphics.gl || !view.isVisible) return;
    if (!header || !scene || view.canvas.width < 2) return;
    this.next = [];
    view.advance(now);
    const shown = this.available(until);
    if (!view.camera) view.place();
    const program = this.program(header); // built while parts come and slices are made
    scene.prepare();
    if (!shown || !view.camera) return;
    // The picture of another moment is complete: the slices of this one get all the time.
    if (this.isLate && view.sharp) return;
    if (program.error) return view.panel.fail("The shader does not compile with this graphics driver.", program.error);
    if (!program.ready || !scene.isReady(view.settings, this.smooth)) return view.request();
    const isComplete = !view.sharp && this.renderer.draw(program, shown, until);
    if (isComplete) {
      if (header.slices.critical) this.program(header, true); // the wheel asks for this next,
      if (view.player.varies) this.program(header, this.isClose(header), false); // and the player for this
    }
    view.painted(isComplete);
  }

  /** Whether something is drawn, so that points can be found. */
  get canPick(): boolean {
    return !!this.places?.width && !this.view.graphics.isLost;
  }

  find(x: number, y: number): Found | null {
    const { tiles, shown, scene, view } = this;
    const { camera } = view;
    const at = tiles?.layers.length && shown ? this.renderer.placeAt(shown, x, y) : null;
    if (!at || !camera || !shown || !scene) return null;
    const found = pickedPoint(at, scene, camera, shown, [x, y]);
    const pointed = { place: [x, y] as [number, number], position: found.point.position, height: view.root.clientHeight };
    found.point.mark = scene.marks.at(pointed, camera, view.settings, shown);
    return found;
  }
}
