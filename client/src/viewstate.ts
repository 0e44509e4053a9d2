// The camera and moment from which uniforms are computed.

import { Camera, firstLook, type CameraState } from "./camera.ts";
import type { Player } from "./player.ts";
import type { Header } from "./protocol.ts";
import type { Moment, ViewState } from "./uniforms.ts";
import { subtract, toFrame, type Vector } from "./vectors.ts";

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
