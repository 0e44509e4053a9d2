// The interface between a view and its painter, and the camera and moment from which uniforms are computed.

import { Camera, firstLook, type CameraState } from "./camera.ts";
import type { Graphics } from "./context.ts";
import type { Lifetime } from "./lifetime.ts";
import type { Player } from "./player.ts";
import type { Header, Part, Settings, StructureHeader } from "./protocol.ts";
import type { Requests, Source } from "./sources/source.ts";
import type { Moment, ViewState } from "./uniforms.ts";
import { subtract, toFrame, type Vector } from "./vectors.ts";

/** A view that a painter draws. */
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
  /** Whether the picture is clear beside the surface. */
  readonly isClear?: boolean;
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

/** The camera that a scene comes with, or one that sees all of its nodes. */
export function placedCamera(
  { geometry, limits, earth }: Header,
  first: CameraState | null,
  nodes: ArrayLike<number>,
  aspect: number,
): Camera {
  const state = firstLook(geometry, limits, first, nodes, aspect);
  return new Camera(state, limits, geometry.planar, aspect, earth && !earth.map ? earth.radius : 0);
}

interface Look {
  header: Header;
  camera: Camera;
  /** Point from which positions were counted before. */
  anchor: Vector;
  player: Player;
  /** Pixels of the page that the picture is high. */
  rows: number;
}

/** The view of a moment, with so many pixels along one of the page. */
export function viewState({ header, camera, anchor, player, rows }: Look, shown: Moment, density: number): ViewState {
  const { geometry, constants } = header;
  const focus = camera.state.focal_point;
  const local = toFrame(geometry.frame, subtract(focus, geometry.center));
  const range = constants.anchorRange * 2 * camera.height;
  const isFar = (v: Vector) => v.some((c) => Math.abs(c) > range);
  return {
    focus,
    anchor: !isFar(subtract(local, anchor)) ? anchor : isFar(local) ? local : [0, 0, 0],
    eye: camera.eye,
    between: shown[2],
    time: player.timeOf(shown),
    clock: player.clock,
    still: !player.playing,
    density,
    pixel: (2 * camera.height) / Math.max(rows * density, 1),
  };
}
