// What a view shows of a surface: all of it, or the root and the loaded tiles of a large one.
//
//   camera --> Pyramid.choose --> wanted tiles --> Requests --> Source
//                     |                                       |
//                     +--> cover (those that are there) <-- setPart, and the levels of all meshes

import type { SceneView } from "./bareview.ts";
import type { Camera } from "./camera.ts";
import { placesOf } from "./formula.ts";
import type { Layer } from "./places.ts";
import { isOfStep, stepOf, type Header, type NamedPart, type Part, type TileHeader } from "./protocol.ts";
import { Scene } from "./scene.ts";
import {
  cellPixels,
  cover,
  keyOf,
  nameOf,
  Pyramid,
  ROOT,
  wantedTiles,
  type Choices,
  type TileKey,
} from "./tilechoice.ts";
import { Failures } from "./sources/source.ts";
import { flowsOf } from "./tracer.ts";
import type { Moment } from "./uniforms.ts";

/** Milliseconds from a change of what is wanted to the request. */
const REQUEST_MS = 60;
/** Milliseconds of a picture that the upload of tiles may take. */
const LOAD_MS = 25;
/** Default memory of the tiles in bytes, and memory for each received byte, here and on the graphics card. */
const BUDGET_BYTES = 900e6;
const BYTES_HELD = 3.5;
/** Time steps of a tile that are held. */
const STEPS_HELD = { slices: 4, flow: 24 };

interface Tile {
  parts: Map<string, Part>;
  /** Null where nothing of it is drawn; not known before it has come. */
  scene: Scene | null | undefined;
  /** When it was wanted last. */
  used: number;
}

export class Tiles {
  /** What was drawn last. */
  layers: Layer[] = [];
  /** Names of the tiles that are wanted and not there. */
  missing: string[] = [];
  /** Number of the tiles that are wanted, and of those that cannot be drawn yet. */
  wanted = 0;
  pending = 0;
  private readonly host: SceneView;
  private readonly root: Scene;
  private readonly tiles = new Map<string, Tile>();
  private pyramid: Pyramid | null = null;
  /** What the last picture has requested and shown. */
  private chosen: { choices: Choices; steps: number[]; names: string } = {
    choices: new Map(),
    steps: [],
    names: "",
  };
  private count = 0;
  private isWaiting = false;
  private hasAsked = false;
  private isOver = false;
  /** Tiles that cannot be had, each with what of it was wanted. */
  private readonly failed = new Failures();

  constructor(host: SceneView, root: Scene) {
    this.host = host;
    this.root = root;
  }

  /** Return whether a part of a tile is loaded. */
  has(name: string, part: string): boolean {
    return this.tiles.get(name)?.parts.has(part) ?? false;
  }

  /** Show what is coarser in place of a tile that cannot be had for some steps and the present colours. */
  fail(name: string, steps: number[]): void {
    this.failed.add(this.need(name, steps));
    this.host.refine();
  }

  private need(name: string, steps: number[]): string {
    return `${name} ${steps} ${this.root.header.scalars.name}`;
  }

  dispose(): void {
    this.isOver = true;
    for (const name of [...this.tiles.keys()]) this.drop(name);
  }

  /** Take a part of a tile. */
  setPart(name: string, part: NamedPart): void {
    const { graphics, header } = this.root;
    const tile = this.tiles.get(name) ?? this.emptyTile();
    this.tiles.set(name, tile);
    if (part.digest && tile.parts.get(part.name)?.digest === part.digest) return;
    graphics.release(tile.parts.get(part.name));
    tile.parts.set(part.name, graphics.hold(part));
    if (part.name === "header") {
      const own = JSON.parse(new TextDecoder().decode(part.data)) as TileHeader | null;
      tile.scene?.dispose();
      if (own) own.geometry.reach = header.geometry.reach;
      tile.scene = own && new Scene(graphics, { ...header, ...own, pyramid: null, bodies: null, structure: null }, tile.parts, keyOf(name));
      this.giveMap(tile);
    } else tile.scene?.forget(part.name);
    const { names, steps } = this.chosen;
    this.missing = this.missing.filter((missing) => !this.isHere(missing, steps));
    const shown = cover(this.chosen.choices, (other) => this.isHere(other, steps));
    if (String([...shown.keys()]) !== names) this.host.refine();
  }

  /** Draw in other colours, given by a part of the header; what they need is requested. */
  recolour(colours: Partial<Header> = {}): void {
    const { steps } = this.chosen;
    for (const tile of this.tiles.values()) {
      const { scene, parts } = tile;
      if (!scene) continue;
      Object.assign(scene.header, colours);
      this.giveMap(tile);
      scene.forget("scalars");
      const painted = steps.length ? scene.scalarParts(steps[0], steps[steps.length - 1]) : [];
      if (painted.every((name) => parts.has(name))) continue;
      const others = [...parts.keys()].filter((name) => name.startsWith("scalars/"));
      for (const name of others) this.release(tile, name);
    }
  }

  private emptyTile(): Tile {
    return { parts: new Map(), scene: undefined, used: this.count };
  }

  /** Colour by the map of the root. */
  private giveMap({ scene, parts }: Tile): void {
    const map = this.root.parts.get("cmap");
    if (map) parts.set("cmap", map);
    scene?.forget("cmap");
  }

  /** Choose what is drawn at a moment. */
  arrange([before, after]: Moment): Layer[] {
    const { camera } = this.host;
    if (!camera) return [];
    const shown = this.choose(camera, [...new Set([before, after])]);
    this.layers = [ROOT, ...[...shown.keys()].filter((name) => name !== ROOT)].flatMap((name) => {
      const scene = name === ROOT ? this.root : this.tiles.get(name)?.scene;
      const covered = (shown.get(name) ?? []).flatMap((finer) => (this.pyramid ? [this.pyramid.finerPart(keyOf(finer), name)] : []));
      const key: TileKey = name === ROOT ? [this.root.header.pyramid?.depth ?? 0, 0, 0] : keyOf(name);
      return scene ? [{ scene, key, covered }] : [];
    });
    return this.layers;
  }

  /** The tiles to show, with those that cover parts of them; asks for others. */
  private choose(camera: Camera, steps: number[]): Map<string, string[]> {
    const { header } = this.root;
    const { settings, canvas, ratio } = this.host;
    if (!header.pyramid) return new Map();
    this.pyramid ??= new Pyramid(header.pyramid, placesOf(header) ?? this.root.part("places").data);
    const choices = this.pyramid.choose({
      ...camera.sight(canvas.height / ratio),
      planes: camera.planes,
      cellPixels: cellPixels(header.pyramid, settings),
      shownOn: this.host.shownOn,
    });
    this.count += 1;
    for (const name of choices.keys()) {
      const tile = this.tiles.get(name);
      if (tile) tile.used = this.count;
    }
    const until = performance.now() + LOAD_MS;
    const wanted = this.obtainable(wantedTiles(choices), steps, header.pyramid.depth);
    this.missing = wanted.filter((name) => !this.isHere(name, steps));
    this.ask();
    this.trim(steps);
    // The largest on the screen come first.
    for (const name of wanted) if (this.isHere(name, steps)) this.load(name, steps, until);
    const shown = cover(choices, (name) => this.isHere(name, steps) && this.load(name, steps, until));
    this.wanted = wanted.length;
    this.pending = wanted.filter((name) => !this.isHere(name, steps) || !this.isLoaded(name, steps)).length;
    this.chosen = { choices, steps, names: String([...shown.keys()]) };
    return shown;
  }

  /** The tiles that can be had of these, or in their place those that cover them, below the root. */
  private obtainable(names: string[], steps: number[], depth: number): string[] {
    const needs = [steps, ...steps.map((step) => [step])];
    const isFailed = (name: string) => needs.some((some) => this.failed.has(this.need(name, some)));
    const found = names.map((name) => {
      let [level, row, column] = keyOf(name);
      while (level < depth && isFailed(nameOf([level, row, column]))) {
        [level, row, column] = [level + 1, row >> 1, column >> 1];
      }
      return level < depth ? nameOf([level, row, column]) : ROOT;
    });
    return [...new Set(found)].filter((name) => name !== ROOT);
  }

  /** Whether all of a tile has come that these steps need. */
  private isHere(name: string, steps: number[]): boolean {
    const scene = this.tiles.get(name)?.scene;
    return scene === null || (scene?.missing(steps[0], steps[steps.length - 1]).length === 0);
  }

  private isLoaded(name: string, steps: number[]): boolean {
    const scene = this.tiles.get(name)?.scene;
    return scene === null || (scene?.isLoaded(steps) ?? false);
  }

  /** Have a tile on the graphics card; the others of many come with the next picture. */
  private load(name: string, steps: number[], until: number): boolean {
    const scene = this.tiles.get(name)?.scene;
    if (!scene || this.isLoaded(name, steps)) return true;
    if (performance.now() > until || !scene.make(steps, until)) {
      this.host.refine();
      return false;
    }
    scene.load(steps);
    return true;
  }

  /** Request what is missing, and nothing else, once the view has been still for a moment. */
  private ask(): void {
    const { requests, lifetime } = this.host;
    if (this.isWaiting || !(this.missing.length || this.hasAsked)) return;
    this.isWaiting = true;
    lifetime.later(() => {
      this.isWaiting = false;
      if (this.isOver) return;
      this.hasAsked = this.missing.length > 0;
      // Those that paths lead through are needed too.
      const lacking = (name: string, step: number) =>
        this.tiles.get(name)?.scene?.lacking(step) ?? flowsOf(this.root.header, step);
      const needed = this.missing.flatMap((name) => this.chosen.steps.flatMap((step) => lacking(name, step)));
      const steps = [...new Set(needed)].sort((a, b) => a - b);
      requests.wantTiles(this.missing.map(keyOf), steps);
    }, REQUEST_MS);
  }

  /** Drop the tiles that were wanted longest ago where all take too much memory, and steps of long ago. */
  private trim(steps: number[]): void {
    let bytes = 0;
    for (const [name, tile] of [...this.tiles].sort(([, a], [, b]) => b.used - a.used)) {
      const { parts, scene, used } = tile;
      const kind = scene?.header.slices.trace ? "flow" : "slices";
      const held = [...parts.keys()].filter((part) => part.startsWith(`${kind}/`));
      const needed = scene ? steps.flatMap((step) => flowsOf(scene.header, step)) : steps;
      for (const part of held.slice(0, Math.max(held.length - STEPS_HELD[kind], 0))) {
        const step = stepOf(part);
        if (needed.includes(step)) continue;
        for (const each of [kind, "extra"]) this.release(tile, `${each}/${step}`);
        const values = [...parts.keys()].filter((each) => isOfStep(each, step, this.root.header));
        for (const each of values) this.release(tile, each);
      }
      for (const { data } of parts.values()) bytes += BYTES_HELD * data.byteLength;
      bytes += scene?.tracedBytes ?? 0;
      if (bytes > (this.host.options.source?.memory ?? BUDGET_BYTES) && used < this.count) this.drop(name);
    }
  }

  private drop(name: string): void {
    const tile = this.tiles.get(name);
    tile?.scene?.dispose();
    for (const part of [...(tile?.parts.keys() ?? [])]) this.release(tile, part);
    this.tiles.delete(name);
  }

  private release(tile: Tile | undefined, part: string): void {
    if (part !== "cmap") this.root.graphics.release(tile?.parts.get(part)); // that of the root
    tile?.parts.delete(part);
  }
}
