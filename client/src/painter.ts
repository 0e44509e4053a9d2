// What draws the picture of a view: WebGL2, pictures that a host sends, or a painter of one's own.

import type { Camera } from "./camera.ts";
import type { Graphics } from "./context.ts";
import type { Lifetime } from "./lifetime.ts";
import type { Found } from "./picking.ts";
import type { Player } from "./player.ts";
import type { Header, Part, Settings, StructureHeader } from "./protocol.ts";
import type { Scene } from "./scene.ts";
import type { Requests, Source } from "./sources/source.ts";
import type { Tiles } from "./tiles.ts";
import type { Moment, ViewState } from "./uniforms.ts";

/** The view that a painter draws, and what it may ask of it. */
export interface View {
  readonly canvas: HTMLCanvasElement;
  readonly root: HTMLElement;
  readonly header: Header | null;
  readonly settings: Settings;
  readonly parts: Map<string, Part>;
  readonly camera: Camera | null;
  readonly player: Player;
  readonly options: { smooth?: boolean; source?: Source; isComing?: () => boolean };
  readonly requests: Requests;
  readonly panel: {
    wait(missing: string[], isMade: boolean, isCoarse: boolean, isFinding?: boolean): void;
    showKinds(kinds: StructureHeader["kinds"]): void;
    fail(problem: string, detail: string): void;
  };
  readonly graphics: Graphics;
  readonly lifetime: Lifetime;
  /** Whether the full picture is shown, and whether the view is on the screen. */
  readonly sharp: boolean;
  readonly isVisible: boolean;
  /** Whether the user is moving the view or a control. */
  readonly isHeld: boolean;
  /** Pixels of the canvas along one of the page. */
  readonly ratio: number;
  /** Where from and when a moment is seen, with so many pixels along one of the page. */
  view(shown: Moment, density: number): ViewState;
  /** Look from where the scene says, once the parts are there that this takes. */
  place(): void;
  /** Go on with the time or the clock, as they play. */
  advance(now: number): void;
  /** Have `frame` called. */
  request(): void;
  /** Begin another picture. */
  change(): void;
  /** Draw the same picture once more, as more of the surface is there. */
  refine(): void;
  /** The picture has gone on, and may be complete. */
  painted(isComplete: boolean): void;
  /** Hold no more time steps than are needed. */
  trim(): void;
}

export interface Painter {
  /** Go on with the picture until a time, and call `painted`. */
  frame(now: number, until: number): void;
  /** Show another scene. */
  open?(header: Header): void;
  /** Begin another picture, of the same things where only the camera has changed. */
  restart?(cameraOnly: boolean): void;
  /** Change the size of the canvas, which a view does by itself otherwise. */
  resize?(width: number, height: number): void;
  dispose?(): void;
  /** Have ready what shows some steps, if there is time; returns whether they can be played. */
  make?(steps: number[], until: number): boolean;
  /** Draw the same picture once more, as more of the surface is there. */
  refine?(): void;
  /** Show a part of a picture of the host's. */
  show?(picture: ImageBitmap, left: number, width: number, isSharp: boolean): void;
  /** Find the point of the surface at (x, y), from -1 to 1 to the right and up. */
  find?(x: number, y: number): Found | null;
  /** Whether points can be found yet. */
  readonly canPick?: boolean;
  /** Names of the parts that the present moment lacks. */
  readonly lacking?: string[];
  /** What is on the graphics card, and the moment that was drawn. */
  readonly scene?: Scene | null;
  readonly tiles?: Tiles | null;
  readonly shown?: Moment | null;
}
