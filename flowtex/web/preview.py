"""A small picture of a flow, shown where the client cannot draw or has not drawn yet.

The renderer in NumPy draws it from few nodes and samples, so that it takes a fraction of a second,
needs no OpenGL, and can be made in any thread.
"""

from __future__ import annotations

import io
from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex._util.colours import rgb
from flowtex.field.interpolation import steps_around
from flowtex.rendering.camera import Camera, CameraValues
from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.map_overlay import SPACING_PX, SPACINGS, STROKES, map_lines
from flowtex.rendering.uniforms import ViewState
from flowtex.rendering.webgl.client_data import ClientData
from flowtex.settings import Settings
from flowtex.web.view import WebView

if TYPE_CHECKING:
    from PIL import Image

#: Nodes and samples of a small picture; more make no visible difference.
NODES, SAMPLES = 3_000, 17
#: Greatest spacing of samples in grains. Pixels side by side share no sample of a greater one, and
#: streaks become rows of dots.
WIDEST_SPACING = 0.7
#: Pixels of the picture by one that NumPy draws, along each side.
COARSER = 2
#: Background of the preview where it is that of the surrounding page.
WHITE = (1.0, 1.0, 1.0)


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
    from PIL import Image

    before, after, between = steps_around(
        scene.times, float(scene.times[0] if time is None else time)
    )
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
    from PIL import Image

    picture = np.asarray(image)
    # Colours are chosen among a few pixels: among all of them it takes longer than the drawing.
    palette_image = Image.fromarray(np.ascontiguousarray(picture[::4, ::4])).quantize(160)
    palette_image.putpalette([*(palette_image.getpalette() or [])[: 3 * 160], *exact])
    reduced = Image.fromarray(picture).quantize(palette=palette_image, dither=Image.Dither.NONE)
    palette, corner = reduced.getpalette() or [], 3 * int(np.asarray(reduced)[0, 0])
    palette[corner : corner + 3] = picture[0, 0].tolist()  # the exact background
    reduced.putpalette(palette)
    file = io.BytesIO()
    is_page &= bool((picture[0, 0] == 255).all())
    reduced.save(file, "PNG", optimize=True, **({"transparency": corner // 3} if is_page else {}))
    return file.getvalue()


def _few_samples(settings: Settings) -> Settings:
    settings = settings.copy()
    samples = min(settings.samples, SAMPLES)
    # Streaks keep their length as far as possible.
    spacing = settings.spacing * settings.samples / samples
    widest = max(settings.spacing, WIDEST_SPACING * settings.grain)
    settings.update(samples=samples, spacing=min(spacing, widest))
    return settings


def _draw_lines(picture: Image.Image, scene: ClientData, camera: Camera) -> None:
    """Draw the coasts and the graticule of a map over a picture, or of the near side of a globe."""
    from PIL import ImageDraw

    field, size = scene.field, np.array(picture.size)
    if field.projection is None:
        return
    draw = ImageDraw.Draw(picture, "RGBA")
    fine = SPACING_PX * camera.height / (size[1] / 2)
    spacing = next((s for s in SPACINGS if s <= fine), 0.0)
    for option, lines in map_lines(field, has_globe=False).items():
        if not getattr(scene.colours, option):
            continue
        lines = lines.thinned(spacing) if spacing else lines
        pixels = pixels_of(lines.points, camera, size)
        if field.surface.on_globe:
            far = np.sum(lines.points * (camera.eye[:3] - camera.eye[3] * lines.points), -1) <= 0
            pixels[far] = np.nan
        seen: Bools = np.isfinite(pixels[..., 0])
        stroke = STROKES[option]
        colour = tuple(round(255 * c) for c in (*rgb(stroke.color), stroke.opacity))
        for begin, end in pairwise(lines.starts):
            for run in np.split(np.arange(begin, end), 1 + np.flatnonzero(~seen[begin:end])):
                draw.line([tuple(p) for p in pixels[run][seen[run]]], fill=colour)


def pixels_of(points: Floats, camera: Camera, size: ArrayLike) -> Floats:
    """Return the pixels (..., 2) of points, from the top left, NaN behind the camera."""
    sides = np.asarray(size)
    return np.asarray((camera.project(points, sides[0] / sides[1]) * [0.5, -0.5] + 0.5) * sides)


def _colour(scene: ClientData, picture: Picture, steps: tuple[int, int], between: float) -> Floats:
    """Return the colour of the surface at each pixel, (H, W, 3)."""
    colours = scene.colours
    if colours.values is None or not len(colours.scale.table):
        return np.asarray(colours.plain)
    before, after = (colours.values[min(step, len(colours.values) - 1)] for step in steps)
    values = before * (1 - between) + after * between
    nearest = picture.cell if colours.flat else picture.nearest
    return colours.scale.colours(values.ravel()[nearest])
