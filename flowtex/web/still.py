"""A still of a view in a browser, with axes, legend and marks, where no browser draws it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import scipy
from PIL import Image, ImageDraw

from flowtex._util.array_types import AnyArray, Floats
from flowtex._util.colours import rgb
from flowtex.rendering.arrow_seeds import ArrowSeeds
from flowtex.rendering.camera import Camera
from flowtex.rendering.cpu.render import Picture
from flowtex.rendering.map_overlay import USUAL_HEIGHT_PX, WIDTH_RANGE
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import arrow_distance, has_arrows
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.marks import (
    KIND_MARKS,
    LINE_COLORS,
    NULLCLINE_COLORS,
    RIM_COLOR,
    strokes,
)
from flowtex.scene.annotations import annotate, difference_text, layout, write_ticks
from flowtex.web import preview
from flowtex.web.view import WebView

#: Returns the camera for a ratio of width to height.
MakeCamera = Callable[[float], Camera]
#: Most pixels that NumPy draws.
MOST_PIXELS = 160_000
#: Room in pixels for ticks at the left, beside the last one at the right, and below.
TICK_ROOM = (58, 16, 20)
#: Steps of an arrow on each side of its seed, and its length over the distance of arrows.
ARROW_STEPS, ARROW_LENGTH = 6, 1.05
#: Length and half the width of a head over the length of the arrow, and width of the shaft and of
#: what is light around it, in pixels.
HEAD, HEAD_WIDTH, SHAFT_PX, HALO_PX = 0.32, 0.144, 2, 2
#: Share of the surface in a pixel where arrows are.
INSIDE = 0.9
#: Pixels over which the directions of nodes are smoothed.
SMOOTHING_PX = 2.0
#: Distance of a seed from the surface in the picture, in heights of the view, that hides it.
HIDDEN = 0.05


def still_png(
    view: WebView,
    size: tuple[int, int],
    camera: MakeCamera,
    *,
    axes: str | None = None,
    data: ClientData | None = None,
    flow: Image.Image | None = None,
    ground: Sequence[float] | None = None,
    differs: Sequence[str] = (),
) -> bytes:
    """Draw a view as a browser shows it, without controls, and return it as PNG.

    ``camera`` returns the camera for a ratio of width to height. ``flow`` is what a browser has
    drawn, on a ``ground``; otherwise NumPy draws the ``data``. The title has the settings in which
    the view ``differs`` from another.
    """
    scene, (width, height) = view.scene, size
    data = data or view.coarse_data(preview.NODES)
    ground = tuple(ground or data.colours.background or preview.WHITE)
    seen = camera(width / height)
    frame = scene.whole.surface.frame if seen.parallel and not scene.field.projection else None
    if axes not in (None, "ticks") or frame is None or not np.allclose(seen.axes[:2], frame):
        frame = None
    look: dict[str, Any] = {"background": ground, "legend": data.colours.bar, "beside": True}
    look["label"] = difference_text(scene, dict.fromkeys(differs))
    look["scale_bar"] = frame is None and axes != "none"
    room = layout(scene, size, seen, **look)
    left, right, row = (0, 0, 0) if frame is None else TICK_ROOM
    across, down = width - left - right, height - room.above - room.below - row
    box = (max(across, 1), max(down, 1))
    if flow is None:
        seen = camera(box[0] / box[1])
        flow = _drawn(view, data, box, seen)
    flow.thumbnail(box)
    picture = Image.new("RGB", size, tuple(round(255 * c) for c in ground))
    picture.paste(flow, (left, room.above))
    if frame is not None:
        half = np.array([seen.height * flow.width / flow.height, seen.height])
        middle = frame @ seen.focal_point
        corners = (left, room.above, left + flow.width, room.above + flow.height)
        write_ticks(picture, corners, (middle - half, middle + half), ground)
    canvas = np.array(picture)
    annotate(canvas, scene, seen, flow_height=flow.height, **look)
    colors = {*LINE_COLORS.values(), *NULLCLINE_COLORS.values(), RIM_COLOR, "black", "white"}
    colors |= {mark.color for mark in KIND_MARKS.values()}
    exact = [round(255 * c) for color in sorted(colors) for c in rgb(color)]
    return preview.encoded(
        Image.fromarray(canvas), [*exact, *scene.legend_colours[::4, :3].ravel().tolist()]
    )


def _drawn(view: WebView, data: ClientData, size: tuple[int, int], camera: Camera) -> Image.Image:
    """Draw the flow with its arrows and marks."""
    scene = view.scene
    coarser = max(preview.COARSER, math.ceil(math.sqrt(size[0] * size[1] / MOST_PIXELS)))
    image, picture = preview.draw_flow(view, data, size, camera, scene.time, coarser)
    draw = ImageDraw.Draw(image)
    if has_arrows(data.textures, scene.settings):
        length = ARROW_LENGTH * arrow_distance(scene.settings)
        for path in _arrow_paths(view, data, picture, camera, size):
            path = path[np.append(True, np.diff(path, axis=0).any(axis=-1))]
            if len(path) <= ARROW_STEPS:
                continue
            tip, back = path[-1], path[-1] - path[-2]
            back *= HEAD * length / max(float(np.hypot(*back)), 1e-9)
            side = HEAD_WIDTH / HEAD * np.array([-back[1], back[0]])
            head = [tuple(p) for p in (tip, tip - back + side, tip - back - side)]
            shaft = [tuple(p) for p in path[: -ARROW_STEPS // 2]]
            for more, ink in ((HALO_PX, "white"), (0, "black")):
                draw.line(shaft, ink, SHAFT_PX + more, joint="curve")
                draw.line([*head, head[0]], ink, more or 1, joint="curve")
            draw.polygon(head, "black")
    wide = float(np.clip(np.sqrt(size[1] / USUAL_HEIGHT_PX), *WIDTH_RANGE))
    for pieces, color, thick, _ in strokes(scene.structure, scene.settings, scene.step):
        for start, end in preview.pixels_of(pieces, camera, size):
            if (start == end).all():
                draw.circle(tuple(start), wide * thick / 2, color)
            else:
                draw.line([tuple(start), tuple(end)], color, max(round(wide * thick), 1))
    return image


def _arrow_paths(
    view: WebView, data: ClientData, picture: Picture, camera: Camera, size: tuple[int, int]
) -> Iterator[AnyArray]:
    """Yield the pixels of arrows from tail to head, along the directions of the picture."""
    geometry, aspect = data.textures.geometry, size[0] / size[1]
    matrix, apart = camera.matrix(aspect), arrow_distance(view.scene.settings)
    sides = np.stack([matrix[3] + sign * matrix[row] for row in (0, 1) for sign in (1, -1)])
    half = camera.height / (1 if camera.parallel else camera.distance)
    eye = None if camera.parallel else np.asarray(camera.position)
    seeds = ArrowSeeds(geometry).seen(TileView(eye, half, size[1], sides), apart)
    points = seeds.position @ geometry.frame + geometry.center
    away = 1.0 if eye is None else np.linalg.norm(points - eye, axis=1)
    points = points[seeds.radius * size[1] > 2 * half * away * apart]
    # Directions on the screen, of the nearest node of each pixel.
    field, pixels = data.field, picture.position
    velocity = field.velocity[view.scene.step].reshape(-1, 3)[picture.nearest]
    speed = np.maximum(np.linalg.norm(velocity, axis=-1, keepdims=True), np.finfo(float).tiny)
    moved = pixels + velocity / speed * camera.height * 1e-3
    way = np.subtract(*(preview.pixels_of(p, camera, size) for p in (moved, pixels)))
    way = scipy.ndimage.gaussian_filter(np.nan_to_num(way), (SMOOTHING_PX, SMOOTHING_PX, 0))
    way /= np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), np.finfo(float).tiny)
    scale = np.array(picture.covered.shape[::-1]) / size

    def at(values: AnyArray, places: Floats) -> Floats:
        index = (places * scale - 0.5).T[::-1]
        return scipy.ndimage.map_coordinates(values, index, order=1, mode="nearest")

    covered = picture.covered.astype(float)
    start = preview.pixels_of(points, camera, size)
    inside = ((start >= 0) & (start < size)).all(axis=-1) & (at(covered, start) > INSIDE)
    start, points = start[inside], points[inside]
    shown = np.stack([at(np.nan_to_num(pixels[..., n]), start) for n in range(3)], axis=-1)
    start = start[np.linalg.norm(shown - points, axis=-1) < HIDDEN * camera.height]
    step = ARROW_LENGTH * apart / (2 * ARROW_STEPS)
    tracks: list[list[Floats]] = []
    for sign in (-1, 1):
        place, track = start, []
        for _ in range(ARROW_STEPS):
            moved = np.stack([at(way[..., n], place) for n in (0, 1)], axis=-1)
            goes_on = at(covered, place + sign * step * moved) > INSIDE  # else the flow ends
            place = place + sign * step * moved * goes_on[:, None]
            track.append(place)
        tracks.append(track)
    yield from np.stack([*tracks[0][::-1], start, *tracks[1]], axis=1)
