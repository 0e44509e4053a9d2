"""Pictures of a view where no browser draws it: a preview, and a still with axes, legend and marks.

The renderer in NumPy draws a preview from few nodes and samples, so that it takes a fraction of a
second, needs no OpenGL, and can be made in any thread.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike
from PIL import Image, ImageDraw

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.colours import rgb
from flowtex.field.interpolation import steps_around
from flowtex.host.view import WebView
from flowtex.rendering.arrow_seeds import ArrowSeeds
from flowtex.rendering.camera import Camera, CameraValues
from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.map_overlay import (
    SPACING_PX,
    SPACINGS,
    STROKES,
    USUAL_HEIGHT_PX,
    WIDTH_RANGE,
    map_lines,
)
from flowtex.rendering.tile_choice import TileView
from flowtex.rendering.uniforms import ViewState, arrow_distance, has_arrows
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.rendering.webgl.marks import (
    KIND_MARKS,
    LINE_COLORS,
    NULLCLINE_COLORS,
    RIM_COLOR,
    strokes,
)
from flowtex.scene.annotations import annotate, difference_text, layout, write_ticks
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

#: Returns the camera for a ratio of width to height.
MakeCamera = Callable[[float], Camera]
#: Most pixels that NumPy draws.
MOST_PIXELS = 160_000
#: Room in pixels for ticks at the left, beside the last one at the right, and below.
TICK_ROOM = (58, 16, 20)
#: Steps of an arrow on each side of its seed.
ARROW_STEPS = 6
#: Length of an arrow over the distance of arrows.
ARROW_LENGTH = 1.05
#: Length of a head over that of the arrow.
HEAD = 0.32
#: Half the width of a head over the length of the arrow.
HEAD_WIDTH = 0.144
#: Width of the shaft, in pixels.
SHAFT_PX = 2
#: Width of the light outline of an arrow, in pixels.
HALO_PX = 2
#: Share of the surface in a pixel where arrows are.
INSIDE = 0.9
#: Pixels over which the directions of nodes are smoothed.
SMOOTHING_PX = 2.0
#: Distance of a seed from the surface in the picture, in heights of the view, that hides it.
HIDDEN = 0.05
#: Nodes of a small picture; more make no visible difference.
NODES = 3_000
#: Samples of a small picture; more make no visible difference.
SAMPLES = 17
#: Greatest spacing of samples in grains. Pixels side by side share no sample of a greater one, and
#: streaks become rows of dots.
WIDEST_SPACING = 0.7
#: Pixels of the picture by one that NumPy draws, along each side.
COARSER = 2
#: Background of the preview where it is that of the surrounding page.
WHITE = (1.0, 1.0, 1.0)


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
    scene = view.scene
    (width, height) = size
    data = data or view.coarse_data(NODES)
    ground = tuple(ground or data.colours.background or WHITE)
    seen = camera(width / height)
    if seen.parallel and not scene.field.projection:
        frame = scene.whole.surface.frame
    else:
        frame = None
    if axes not in (None, "ticks") or frame is None or not np.allclose(seen.axes[:2], frame):
        frame = None
    look: dict[str, Any] = {"background": ground, "legend": data.colours.bar, "beside": True}
    look["label"] = difference_text(scene, dict.fromkeys(differs))
    look["scale_bar"] = frame is None and axes != "none"
    room = layout(scene, size, seen, **look)
    across = width
    down = height - room.above - room.below
    left = 0
    if frame is not None:
        left, right, row = TICK_ROOM
        across -= left + right
        down -= row
    box = (max(across, 1), max(down, 1))
    if flow is None:
        seen = camera(box[0] / box[1])
        flow = _drawn(view, data, box, seen)
    flow.thumbnail(box)
    picture = Image.new("RGB", size, _bytes(ground))
    picture.paste(flow, (left, room.above))
    if frame is not None:
        half = np.array([seen.height * flow.width / flow.height, seen.height])
        middle = frame @ seen.focal_point
        corners = (left, room.above, left + flow.width, room.above + flow.height)
        write_ticks(picture, corners, (middle - half, middle + half), ground)
    canvas = np.array(picture)
    annotate(canvas, scene, seen, flow_height=flow.height, **look)
    return encoded(Image.fromarray(canvas), _exact_colours(scene))


def _exact_colours(scene: Scene) -> list[int]:
    """Return the red, green and blue of lines, marks and the legend, one after the other."""
    names = {*LINE_COLORS.values(), *NULLCLINE_COLORS.values(), RIM_COLOR, "black", "white"}
    for mark in KIND_MARKS.values():
        names.add(mark.color)
    exact: list[int] = []
    for name in sorted(names):
        exact += _bytes(rgb(name))
    return exact + scene.legend_colours[::4, :3].ravel().tolist()


def _bytes(fractions: Sequence[float]) -> tuple[int, ...]:
    """Return the parts of a colour as numbers from 0 to 255."""
    return tuple(round(255 * fraction) for fraction in fractions)


def _drawn(view: WebView, data: ClientData, size: tuple[int, int], camera: Camera) -> Image.Image:
    """Return the flow of a view with arrows, critical points and lines."""
    scene = view.scene
    coarser = max(COARSER, math.ceil(math.sqrt(size[0] * size[1] / MOST_PIXELS)))
    image, picture = draw_flow(view, data, size, camera, scene.time, coarser)
    draw = ImageDraw.Draw(image)
    if has_arrows(data.textures, scene.settings):
        length = ARROW_LENGTH * arrow_distance(scene.settings)
        for path in _arrow_paths(view, data, picture, camera, size):
            _draw_arrow(draw, path, length)
    wide = float(np.clip(np.sqrt(size[1] / USUAL_HEIGHT_PX), *WIDTH_RANGE))
    for pieces, color, thick, _ in strokes(scene.structure, scene.settings, scene.step):
        for start, end in pixels_of(pieces, camera, size):
            if (start == end).all():
                draw.circle(tuple(start), wide * thick / 2, color)
            else:
                draw.line([tuple(start), tuple(end)], color, max(round(wide * thick), 1))
    return image


def _draw_arrow(draw: ImageDraw.ImageDraw, path: AnyArray, length: float) -> None:
    """Draw a shaft along a path of pixels and a head at its end, unless the flow ends there."""
    goes_on = np.append(True, np.diff(path, axis=0).any(axis=-1))
    path = path[goes_on]
    if len(path) <= ARROW_STEPS:
        return
    tip = path[-1]
    back = path[-1] - path[-2]
    back *= HEAD * length / max(float(np.hypot(*back)), 1e-9)
    side = HEAD_WIDTH / HEAD * np.array([-back[1], back[0]])
    head = [tuple(tip), tuple(tip - back + side), tuple(tip - back - side)]
    shaft = list(map(tuple, path[: -ARROW_STEPS // 2]))
    for more, ink in ((HALO_PX, "white"), (0, "black")):
        draw.line(shaft, ink, SHAFT_PX + more, joint="curve")
        draw.line([*head, head[0]], ink, more or 1, joint="curve")
    draw.polygon(head, "black")


def _arrow_paths(
    view: WebView, data: ClientData, picture: Picture, camera: Camera, size: tuple[int, int]
) -> Iterator[AnyArray]:
    """Yield the pixels of arrows from tail to head, along the directions of the picture."""
    apart = arrow_distance(view.scene.settings)
    points = _arrow_points(data, camera, size, apart)
    pixels = picture.position
    velocity = data.field.velocity[view.scene.step].reshape(-1, 3)
    way = _directions_on_screen(pixels, velocity[picture.nearest], camera, size)
    scale = np.array(picture.covered.shape[::-1]) / size

    def at(values: AnyArray, places: Floats) -> Floats:
        """Return values (H, W) or (H, W, C) of the picture at places (N, 2)."""
        index = (places * scale - 0.5).T[::-1]
        if values.ndim == 3:
            return np.stack([at(component, places) for component in np.moveaxis(values, -1, 0)], -1)
        return scipy.ndimage.map_coordinates(values, index, order=1, mode="nearest")

    covered = picture.covered.astype(float)
    start = pixels_of(points, camera, size)
    inside = ((start >= 0) & (start < size)).all(axis=-1) & (at(covered, start) > INSIDE)
    start = start[inside]
    points = points[inside]
    shown = at(np.nan_to_num(pixels), start)
    start = start[np.linalg.norm(shown - points, axis=-1) < HIDDEN * camera.height]
    step = ARROW_LENGTH * apart / (2 * ARROW_STEPS)
    tracks: list[list[Floats]] = []
    for sign in (-1, 1):
        place = start
        track = []
        for _ in range(ARROW_STEPS):
            moved = at(way, place)
            goes_on = at(covered, place + sign * step * moved) > INSIDE  # else the flow ends
            place = place + sign * step * moved * goes_on[:, None]
            track.append(place)
        tracks.append(track)
    yield from np.stack([*tracks[0][::-1], start, *tracks[1]], axis=1)


def _arrow_points(
    data: ClientData, camera: Camera, size: tuple[int, int], apart: float
) -> AnyArray:
    """Return the positions of arrows (N, 3), as far apart as the camera needs them."""
    geometry = data.textures.geometry
    matrix = camera.matrix(size[0] / size[1])
    right, up, _, depth = matrix
    sides = np.stack([depth + right, depth - right, depth + up, depth - up])
    if camera.parallel:
        eye = None
        half = camera.height
    else:
        eye = np.asarray(camera.position)
        half = camera.height / camera.distance
    seeds = ArrowSeeds(geometry).seen(TileView(eye, half, size[1], sides), apart)
    points = seeds.position @ geometry.frame + geometry.center
    away: Any = 1.0
    if eye is not None:
        away = np.linalg.norm(points - eye, axis=1)
    return points[seeds.radius * size[1] > 2 * half * away * apart]


def _directions_on_screen(
    positions: AnyArray, velocity: AnyArray, camera: Camera, size: tuple[int, int]
) -> AnyArray:
    """Return unit vectors in pixels, smoothed, for the positions of pixels (J, I, 3)."""
    least = np.finfo(float).tiny
    speed = np.maximum(np.linalg.norm(velocity, axis=-1, keepdims=True), least)
    moved = positions + velocity / speed * camera.height * 1e-3
    way = pixels_of(moved, camera, size) - pixels_of(positions, camera, size)
    way = scipy.ndimage.gaussian_filter(np.nan_to_num(way), (SMOOTHING_PX, SMOOTHING_PX, 0))
    way /= np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), least)
    return way


def preview_png(
    view: WebView,
    size: tuple[int, int],
    *,
    camera: CameraValues | None = None,
    time: float | None = None,
    coarser: int = COARSER,
) -> bytes:
    """Draw a small picture and return it as PNG.

    By default the whole surface is shown, at the first time; one pixel is computed for ``coarser``
    along each side.
    """
    scene = view.coarse_data(NODES)
    camera = camera or scene.first_camera(size[0] / size[1]).to_dict()
    image, _ = draw_flow(view, scene, size, Camera.from_dict(camera), time, coarser)
    return encoded(image, is_page=scene.colours.background is None)


def draw_flow(
    view: WebView,
    scene: ClientData,
    size: tuple[int, int],
    camera: Camera,
    time: float | None,
    coarser: int,
) -> tuple[Image.Image, Picture]:
    """Return a picture of the flow and the lines of its map, and the smaller one it is made of."""
    if time is None:
        time = scene.first_time
    before, after, between = steps_around(scene.times, float(time))
    steps = (scene.source(before), scene.source(after))
    picture = render(
        scene.textures,
        _few_samples(view.scene.settings),
        camera,
        (max(size[0] // coarser, 1), max(size[1] // coarser, 1)),
        view=ViewState(between=between, still=True),
        steps=steps,
    )
    ground = scene.colours.background or WHITE
    drawn = picture.rgb(_colour(scene, picture, steps, between), ground)
    behind = 255.0 * np.asarray(ground)
    drawn = np.rint(behind + scene.colours.opacity * (drawn - behind)).astype(np.uint8)
    image = Image.fromarray(drawn).resize(size, Image.Resampling.BICUBIC)
    _draw_lines(image, scene, camera)
    return image, picture


def encoded(image: Image.Image, exact: Iterable[int] = (), *, is_page: bool = False) -> bytes:
    """Return a picture as PNG, with up to 90 ``exact`` colours in one list.

    White is transparent on a page whose colour is not known.
    """
    picture = np.asarray(image)
    # Colours are chosen among a few pixels: among all of them it takes longer than the drawing.
    palette_image = Image.fromarray(np.ascontiguousarray(picture[::4, ::4])).quantize(160)
    palette_image.putpalette([*(palette_image.getpalette() or [])[: 3 * 160], *exact])
    reduced = Image.fromarray(picture).quantize(palette=palette_image, dither=Image.Dither.NONE)
    palette = reduced.getpalette() or []
    corner = 3 * int(np.asarray(reduced)[0, 0])
    palette[corner : corner + 3] = picture[0, 0].tolist()  # the exact background
    reduced.putpalette(palette)
    file = io.BytesIO()
    options = {}
    if is_page and (picture[0, 0] == 255).all():
        options["transparency"] = corner // 3
    reduced.save(file, "PNG", optimize=True, **options)
    return file.getvalue()


def _few_samples(settings: Settings) -> Settings:
    """Return settings with fewer samples of a streak, which NumPy draws sooner."""
    settings = settings.copy()
    samples = min(settings.samples, SAMPLES)
    # Streaks keep their length as far as possible.
    spacing = settings.spacing * settings.samples / samples
    widest = max(settings.spacing, WIDEST_SPACING * settings.grain)
    settings.update(samples=samples, spacing=min(spacing, widest))
    return settings


def _draw_lines(picture: Image.Image, scene: ClientData, camera: Camera) -> None:
    """Draw the coasts and the graticule of a map over a picture, or of the near side of a globe."""
    field = scene.field
    size = np.array(picture.size)
    if field.projection is None:
        return
    draw = ImageDraw.Draw(picture, "RGBA")
    fine = SPACING_PX * camera.height / (size[1] / 2)
    spacing = next((s for s in SPACINGS if s <= fine), 0.0)
    for option, lines in map_lines(field, has_globe=False, coast=scene.colours.coast).items():
        if not getattr(scene.colours, option):
            continue
        if spacing:
            lines = lines.thinned(spacing)
        pixels = pixels_of(lines.points, camera, size)
        if field.surface.on_globe:
            far = np.sum(lines.points * (camera.eye[:3] - camera.eye[3] * lines.points), -1) <= 0
            pixels[far] = np.nan
        seen: Bools = np.isfinite(pixels[..., 0])
        stroke = STROKES[option]
        colour = _bytes((*rgb(stroke.color), stroke.opacity))
        for begin, end in pairwise(lines.starts):
            for run in np.split(np.arange(begin, end), 1 + np.flatnonzero(~seen[begin:end])):
                draw.line(list(map(tuple, pixels[run][seen[run]])), fill=colour)


def pixels_of(points: Floats, camera: Camera, size: ArrayLike) -> Floats:
    """Return the pixels (..., 2) of points, from the top left, NaN behind the camera."""
    sides = np.asarray(size)
    return np.asarray((camera.project(points, sides[0] / sides[1]) * [0.5, -0.5] + 0.5) * sides)


def _colour(scene: ClientData, picture: Picture, steps: tuple[int, int], between: float) -> Floats:
    """Return the colours of the pixels at a time, (H, W, 3), or one for all."""
    colours = scene.colours
    if colours.values is None or not len(colours.scale.table):
        return np.asarray(colours.plain)
    before = colours.values[min(steps[0], len(colours.values) - 1)]
    after = colours.values[min(steps[1], len(colours.values) - 1)]
    values = before * (1 - between) + after * between
    if colours.flat:
        nearest = picture.cell
    else:
        nearest = picture.nearest
    return colours.scale.colours(values.ravel()[nearest])
