"""Stills of views in browsers: everything stands where it belongs, on any ground."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import flowtex
from flowtex import FlowField
from flowtex._util.colours import rgb
from flowtex.host.still import still_png
from flowtex.host.view import WebView, web_views
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.marks import KIND_MARKS
from flowtex.scene.options import Options

Pixels = NDArray[np.int64]


def pixels(png: bytes) -> Pixels:
    with Image.open(io.BytesIO(png)) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def views(field: FlowField, **options: Any) -> tuple[WebView, Any]:
    view = web_views(field, Options.split(**options))[0]
    return view, lambda aspect: Camera.fit(view.field.surface, aspect)


def near(image: Pixels, color: Any, within: int = 12) -> NDArray[np.bool_]:
    return np.asarray(np.abs(image - np.rint(255 * np.array(rgb(color)))).max(axis=-1) <= within)


@pytest.mark.parametrize("size", [(800, 400), (500, 300), (300, 200)])
def test_ticks_stand_at_their_coordinates(size: tuple[int, int]) -> None:
    field = flowtex.examples.double_gyre_field(shape=(21, 41))  # 2 by 1
    view, camera = views(field, scalars=False, color="red", strength=0.0, samples=5)
    image = pixels(still_png(view, size, camera))
    assert image.shape == (*size[::-1], 3)
    rows, columns = (np.flatnonzero(near(image, "red").any(axis=axis)) for axis in (1, 0))
    frame = near(image, "grey", 1)
    below = int(np.flatnonzero(frame.sum(axis=1) > 0.5 * size[0])[-1])
    ticks = np.flatnonzero(frame[below + 3])
    assert np.abs(ticks[[0, -1]] - columns[[0, -1]]).max() <= 3  # x = 0 and x = 2
    left = int(np.flatnonzero(frame.sum(axis=0) > 0.3 * size[1])[0])
    ticks = np.flatnonzero(frame[:, left - 3])
    assert np.abs(ticks[[0, -1]] - rows[[0, -1]]).max() <= 3  # y = 1 and y = 0
    # Numbers stand beside the ticks, and nothing on the flow.
    assert (image[rows[0] : rows[-1], : left - 4] < 100).any()
    assert near(image, "red")[rows[0] + 3 : rows[-1] - 3, columns[0] + 3 : columns[-1] - 3].all()


@pytest.mark.parametrize("axes", ["ticks", "scale", "none"])
def test_a_still_has_what_the_browser_shows(axes: str) -> None:
    field = flowtex.examples.double_gyre_field(shape=(41, 81))
    view, camera = views(field, samples=5, arrows=True, critical_points=8)
    image = pixels(still_png(view, (600, 320), camera, axes=axes))
    table = view.scene.legend_colours[::32, :3]
    corner = image[-45:, -160:]
    assert all((np.abs(corner - colour).max(axis=-1) < 12).any() for colour in table)
    for kind in ("saddle", "centre"):  # on the flow and in the legend
        marks = near(image, KIND_MARKS[kind].color)
        assert marks[:270].any() and marks[270:, :200].any()
    assert near(image, "grey", 1)[:270].any() == (axes == "ticks")
    without, _ = views(field, samples=5, critical_points=8)
    plain = pixels(still_png(without, (600, 320), camera, axes=axes))
    arrows = near(image, "black", 4) & ~near(plain, "black", 40)
    assert 0.005 < arrows[30:270].mean() < 0.1


def test_arrows_of_a_still_point_along_the_flow() -> None:
    x, y = np.meshgrid(np.linspace(0, 2, 21), np.linspace(0, 1, 11))
    field = FlowField.from_arrays((x[0], y[:, 0]), np.stack([1 + 0 * x, 0 * x], axis=-1))
    view, camera = views(field, scalars=False, strength=0.0, arrows=60, samples=5)
    ink = near(pixels(still_png(view, (600, 320), camera, axes="none"))[30:-30], "black", 4)
    from scipy import ndimage

    labels, count = ndimage.label(ink, np.ones((3, 3)))
    found = 0
    for box in ndimage.find_objects(labels):
        arrow = ink[box]
        height, width = arrow.shape
        if width < 35:
            continue
        found += 1
        assert height < 20  # along x
        heads = arrow.sum(axis=0)
        assert heads[width // 2 :].max() > 2 * heads[: width // 2].max()  # to the right
    assert found > 5 <= count


def test_a_still_of_a_browsers_frame_has_its_size_and_ground() -> None:
    field = flowtex.examples.double_gyre_field(shape=(21, 41))
    view, camera = views(field, samples=5)
    for frame in ((526, 200), (600, 300)):  # between bars, and all of a small view
        flow = Image.new("RGB", frame, "#3060ff")
        image = pixels(still_png(view, (600, 300), camera, flow=flow, ground=(0.1, 0.1, 0.1)))
        assert image.shape == (300, 600, 3)
        assert (image[0, 300] == 26).all()
        assert near(image, "#3060ff").mean() > 0.3
        assert (image[:20, :100] > 200).any()  # the title
