"""Critical points and separatrices in VTK's pictures: where, of which step, and for whom."""

from __future__ import annotations

import threading
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from waiting import PATIENCE_S

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Bytes, Floats
from flowtex._util.colours import rgb
from flowtex.rendering.camera import Camera
from flowtex.rendering.webgl.marks import KIND_MARKS, LINE_COLORS
from flowtex.scene.scene import Scene
from flowtex.settings import SettingsError

UNIT = 300  #: A picture of four units by two, one of which is this many pixels.
PICTURE: dict[str, Any] = {"size": (4 * UNIT, 2 * UNIT), "samples": 3, "scalars": False}


def grid(velocity: Any, nodes: int = 41) -> FlowField:
    x, y = np.meshgrid(np.linspace(-2, 2, 2 * nodes - 1), np.linspace(-1, 1, nodes))
    return FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack(velocity(x, y), axis=-1))


def saddle_and_sink(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """A saddle at (-0.5, 0) and a sink at (0.5, 0) with a straight line between them."""
    return 0.25 - x**2, -y


def seen(picture: Bytes, color: str, least: int = 4) -> Floats:
    """Places (N, 2) of a colour in a picture of :data:`UNIT`."""
    away = np.abs(picture.astype(int) - np.rint(255 * np.array(rgb(color))).astype(int))
    rows, columns = np.nonzero((away <= 2).all(axis=-1))
    assert len(rows) >= least, f"there are {len(rows)} pixels of {color}"
    return np.stack([(columns + 0.5) / UNIT - 2, 1 - (rows + 0.5) / UNIT], axis=-1)


def whole(field: FlowField, **options: Any) -> Bytes:
    camera = Camera.fit(field.surface, 2.0)
    picture = flowtex.render(field, camera=camera, **PICTURE, **options)
    return np.asarray(picture)


def test_points_and_lines_stand_where_they_are() -> None:
    field = grid(saddle_and_sink)
    scale = Camera.fit(field.surface, 2.0).height  # half of what is seen: a bit more than 1
    dots = whole(field, critical_points=True)
    for kind, place in (("saddle", (-0.5, 0.0)), ("sink", (0.5, 0.0))):
        found = scale * seen(dots, KIND_MARKS[kind].color)
        assert np.abs(found.mean(axis=0) - place).max() < 0.02
        assert np.ptp(found, axis=0).max() < 0.12
    picture = whole(field, separatrices=True)
    # The flow leaves the saddle along y = 0, to the sink and outwards, and comes along x = -0.5.
    leaving = scale * seen(picture, LINE_COLORS["from saddle"], 50)
    assert np.abs(leaving[:, 1]).max() < 0.02
    assert leaving[:, 0].min() < -1.9
    coming = scale * seen(picture, LINE_COLORS["to saddle"], 50)
    assert np.abs(coming[:, 0] + 0.5).max() < 0.02
    assert coming[:, 1].min() < -0.9 < 0.9 < coming[:, 1].max()


def test_stable_and_unstable_orbits_have_their_colors() -> None:
    rate = "(1 - x**2 - y**2) * (x**2 + y**2 - 2.25)"
    field = flowtex.formula(
        f"x*({rate}) - y", f"y*({rate}) + x", x=(-4, 4), y=(-2, 2), resolution=129
    )
    scale = Camera.fit(field.surface, 2.0).height
    picture = whole(field, separatrices=True)
    for name, radius in (("unstable orbit", 1.0), ("stable orbit", 1.5)):
        found = scale * seen(picture, LINE_COLORS[name], 50)
        away = np.linalg.norm(found[np.abs(found).max(axis=1) < 1.9], axis=1)
        assert np.abs(away - radius).max() < 0.05


def test_settings_and_time_are_followed() -> None:
    x, y = np.meshgrid(np.linspace(-2, 2, 81), np.linspace(-1, 1, 41))
    velocity = [np.stack([x - at, -y], axis=-1) for at in (-1.0, 0.0, 1.0)]
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, times=[0.0, 1.0, 2.0])
    plotter = pv.Plotter(off_screen=True, window_size=[4 * UNIT, 2 * UNIT])
    handle = plotter.flowtex.add(field, samples=3, scalars=False)
    handle.settings.critical_points = True
    assert handle.settings.critical_points == 100
    color = KIND_MARKS["saddle"].color
    for time, place in ((0.0, -1.0), (0.4, -1.0), (0.6, 0.0), (2.0, 1.0)):
        handle.time = time
        found = seen(np.asarray(plotter.screenshot(return_img=True)), color)
        assert abs(found[:, 0].mean() - place) < 0.1
    handle.settings.critical_points = False
    with pytest.raises(AssertionError, match="there are 0 pixels"):
        seen(np.asarray(plotter.screenshot(return_img=True)), color)
    plotter.close()


def test_they_are_found_in_the_background_where_that_is_asked_for() -> None:
    plotter = pv.Plotter(off_screen=True, window_size=[4 * UNIT, 2 * UNIT])
    # Of this field nothing is known from other tests.
    field = grid(saddle_and_sink, nodes=43)
    handle = plotter.flowtex.add(field, samples=3, scalars=False)
    told = threading.Event()
    handle.load_in_background(told.set)
    structure_of = handle.scene.structure
    with structure_of._lock:  # nothing can be found yet
        handle.settings.critical_points = True
        assert handle.busy
        with pytest.raises(AssertionError, match="there are 0 pixels"):
            seen(np.asarray(plotter.screenshot(return_img=True)), KIND_MARKS["saddle"].color)
    assert told.wait(PATIENCE_S)
    assert not handle.busy
    plotter.render()
    seen(np.asarray(plotter.screenshot(return_img=True)), KIND_MARKS["saddle"].color)
    plotter.close()


def test_fields_without_a_sign_are_refused() -> None:
    points = np.stack(np.meshgrid(np.arange(9.0), np.arange(9.0)), axis=-1)
    field = FlowField.from_arrays(points, np.ones((9, 9, 2)), sign_free=True)
    expected = "separatrices is 25; expected 0, because the field is sign-free"
    with pytest.raises(SettingsError, match=expected):
        flowtex.render(field, separatrices=True)
    scene = Scene(field)
    with pytest.raises(SettingsError, match="critical_points is 7; expected 0"):
        scene.settings.critical_points = 7
    assert scene.settings.critical_points == 0


def test_a_nullcline_of_a_formula_is_exact_at_a_zoom_of_5000() -> None:
    field = flowtex.formula("x^2 + y^2 - 1", "y - x", x=(-2, 2), y=(-2, 2))
    look: dict[str, Any] = {"size": (240, 180), "scalars": False, "samples": 3}
    picture = flowtex.render(field, nullclines=True, zoom=5000, focus=(0.6, 0.8), **look)
    rows, columns = np.nonzero(picture[..., 0].astype(int) - picture[..., 2] > 100)  # orange
    assert len(rows) > 200
    pixel = 4 / 5000 / 180
    x, y = 0.6 + (columns - 119.5) * pixel, 0.8 - (rows - 89.5) * pixel
    assert np.abs(np.hypot(x, y) - 1).max() < 1.5 * pixel
