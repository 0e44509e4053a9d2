// What a host sets of a view, and what a view reports to its host.

import type { SceneView } from "./bareview.ts";
import type { CameraState } from "./camera.ts";
import type { ColourChoice } from "./colours.ts";
import type { Painter } from "./painter.ts";
import type { Point } from "./picking.ts";
import type { PixelPlace, Sample } from "./pixelsum.ts";
import type { PointPath } from "./pointpath.ts";
import type { AxesKind, Value } from "./protocol.ts";
import type { Source } from "./sources/source.ts";

/** A view that has the bar for another one as well. */
interface Leader {
  readonly playing: boolean;
  readonly panel: { readonly isShown: boolean; toggle(): void };
  play(): void;
  pause(): void;
  step(count: number): void;
}

export interface Explainer {
  explain(pixel: PixelPlace): Sample[];
  /** No point is chosen any more. */
  clear(): void;
}

/** A point as a host has read it, with the path through it if requested. */
export interface Reading {
  point: Point;
  path?: PointPath;
}

/** Reads a point: at a place of the view from -1 to 1, or one that was found. */
export type Reader = (
  at: { place: [number, number] } | Pick<Point, "index" | "position">,
  path: boolean,
) => Promise<Reading | null>;

export interface Options {
  onCamera?: (camera: CameraState) => void;
  onTime?: (time: number) => void;
  onClock?: (clock: number) => void;
  onPlaying?: (playing: boolean) => void;
  onPoint?: (point: Point) => void;
  /** The explanation of the texture at the chosen point; its samples are drawn as well. */
  explainer?: Explainer;
  /** Where what is lacking comes from. */
  source?: Source;
  /** A picture is complete. */
  onFrame?: () => void;
  /** Something cannot be shown, and why. */
  onError?: (problem: string, detail: string) => void;
  onSetting?: (name: string, value: Value) => void;
  /** Whether parts are still arriving without being requested. */
  isComing?: () => boolean;
  /** A host that knows more of a point than is here. */
  reader?: Reader;
  /** Whether the host draws, and sends pictures. */
  streamed?: boolean;
  /** A painter of the host's own. */
  painter?: (view: SceneView) => Painter;
  /** Whether the name of the flow stands beside the view already. */
  named?: boolean;
  /** Colours are chosen, which the host changes. */
  onColours?: (choice: ColourChoice) => void;
  onControls?: (shown: boolean) => void;
  onAxes?: (kind: AxesKind) => void;
  /** Whether nothing but the picture is shown. */
  bare?: boolean;
  /** Whether the host makes new textures if a setting needs them. */
  rebuild?: boolean;
  controls?: boolean;
  /** Whether outlines are smoothed; by default where it takes little time. */
  smooth?: boolean;
  /** What the view is called by those who do not see it; by default the name of the flow. */
  label?: string;
  /** Whether the page around is scrolled: the view takes wheel and finger only after a click. */
  guarded?: boolean;
  /** The view that has the bar, where it is not this one. */
  follows?: Leader;
}
