// What a host sets of a view, and what a view reports to its host.

import type { CameraState } from "./camera.ts";
import type { ColourChoice } from "./colours.ts";
import type { Point } from "./picking.ts";
import type { PixelPlace, Sample } from "./pixelsum.ts";
import type { Value } from "./protocol.ts";
import type { Source } from "./sources/source.ts";

/** A view that has the bar for another one as well. */
interface Leader {
  readonly playing: boolean;
  readonly panel: { readonly isShown: boolean; toggle(): void };
  play(): void;
  pause(): void;
}

export interface Explainer {
  explain(pixel: PixelPlace): Sample[];
  /** No point is chosen any more. */
  clear(): void;
}

export interface Options {
  onCamera?: (camera: CameraState) => void;
  onTime?: (time: number) => void;
  onClock?: (clock: number) => void;
  onPlaying?: (playing: boolean) => void;
  onPoint?: (point: Point) => void;
  /** What tells how the texture at the chosen point comes about; its samples are drawn as well. */
  explainer?: Explainer;
  /** Where what is lacking comes from. */
  source?: Source;
  /** A picture is complete. */
  onFrame?: () => void;
  onSetting?: (name: string, value: Value) => void;
  /** Whether parts are still on their way, which nobody has to ask for. */
  isComing?: () => boolean;
  /** Colours are chosen, which the host changes. */
  onColours?: (choice: ColourChoice) => void;
  onControls?: (shown: boolean) => void;
  /** Whether nothing but the picture is shown. */
  bare?: boolean;
  /** Whether the host makes textures anew where a setting asks for it. */
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
