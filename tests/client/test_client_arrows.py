"""Arrows in the browser are those of VTK's pictures."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

import numpy as np
import pytest
from flows import gyre, scattered_gyre, swinging, torus
from matrix import ASIDE, COLOUR, GROUND, SIZE, TILTED, straight
from scipy import ndimage
from webgl_page import ClientPage, packed, state

from flowtex import FlowField
from flowtex._util.array_types import Bytes
from flowtex.host.view import web_views
from flowtex.plotting.offscreen.plotter import OffscreenPlotter
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.client_data import ClientData, Colours
from flowtex.scene.options import Options
from flowtex.scene.scene import Scene, make_scenes
from flowtex.settings import Settings

pytestmark = pytest.mark.browser

PLAIN = {"samples": 11, "strength": 0.0, "arrows": 24}
LARGE = 2.0**40  #: As large as the orbit of a planet in metres.
LARGE_VIEW = Camera(
    (0.9 * LARGE, 0.5 * LARGE, 3 * LARGE),
    (0.9 * LARGE, 0.5 * LARGE, 0.0),
    (0, 1, 0),
    parallel=True,
    parallel_scale=0.5 * LARGE,
)


def large_gyre() -> FlowField:
    return FlowField.from_arrays(LARGE * gyre().points, gyre().velocity[0])


VIEWS: dict[str, tuple[Callable[[], FlowField], Camera, dict[str, Any]]] = {
    "plane": (gyre, straight(2), {}),
    "near": (gyre, straight(300), {}),
    "aslant": (gyre, TILTED, {"arrow_length": "speed"}),
    "curved": (torus, ASIDE, {}),
    "between two steps": (swinging, straight(1, (0, 0)), {"time": 0.55}),
    "triangles": (scattered_gyre, straight(3), {}),
    "large": (large_gyre, LARGE_VIEW, {}),
}


@pytest.mark.parametrize("name", VIEWS)
def test_arrows_are_those_of_vtk(client: ClientPage, name: str) -> None:
    make, camera, given = VIEWS[name]
    options = {**PLAIN, **given}
    time = options.pop("time", None)
    scene = Scene(make(), Settings(**options))
    data = ClientData(scene.textures, Colours(plain=COLOUR, background=GROUND))
    header = data.header(scene.settings, camera=state(camera), time=time)
    steps = tuple(range(scene.textures.store.steps))
    view = client.mount(packed(data, header, steps), SIZE, controls=False, smooth=False)
    theirs = client.picture(view)
    look = {"scalars": False, "color": COLOUR, "background": GROUND, "lighting": False}
    compare(theirs, make(), camera=camera, time=time, **{**look, **options})


def test_arrows_have_the_colours(client: ClientPage) -> None:
    look = {"color": COLOUR, "background": GROUND, "lighting": False, "cmap": "turbo"}
    options: dict[str, Any] = {**look, **PLAIN, "arrow_color": "scalars"}
    web = web_views(swinging(), Options.split(**options))[0]
    data, camera = web.data(), straight(1, (0, 0))
    header = data.header(web.scene.settings, camera=state(camera), time=0.55)
    view = client.mount(packed(data, header, (0, 1, 2)), SIZE, controls=False, smooth=False)
    theirs = client.picture(view)
    compare(theirs, swinging(), camera=camera, time=0.55, show_scalar_bar=False, **options)


def frame(field: FlowField, *, time: float | None = None, **options: Any) -> Bytes:
    """Draw a frame of a view that may come nearer."""
    chosen = Options.split(**options)
    with closing(OffscreenPlotter(make_scenes(field, chosen), chosen.view, size=SIZE)) as plotter:
        return plotter.picture(time=time)


def compare(theirs: Bytes, field: FlowField, **options: Any) -> None:
    ours, without = (
        frame(field, **{**options, **more}) for more in ({}, {"arrows": 0, "scalars": False})
    )
    assert (np.abs(ours.astype(int) - without) > 60).any(axis=-1).mean() > 0.02
    # Outlines of the surface are smoothed in one of them.
    inside = ndimage.binary_erosion((without == without[60, 90]).all(axis=-1), iterations=2)
    off = np.abs(theirs.astype(int) - ours).max(axis=-1)[inside]
    # Vertices lie at other fractions of a pixel.
    assert (off > 8).mean() < 0.05
    assert (off > 40).mean() < 0.003
