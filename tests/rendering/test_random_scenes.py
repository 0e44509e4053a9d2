"""Random scenes: VTK, the browser and NumPy draw the same, and paths are those of SciPy."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from case_counts import count_case
from drawn_views import drawn_by_vtk, drawn_by_webgl
from hypothesis import given
from hypothesis import strategies as st
from matrix import COLOUR, GROUND, View
from random_views import FLAT, Flow, flows, views
from scipy.integrate import solve_ivp
from scipy.ndimage import binary_erosion
from strategies import property_test
from webgl_page import ClientPage

from flowtex._util.array_types import Bools, Bytes, Floats
from flowtex.rendering.cpu.render import Picture, render
from flowtex.rendering.uniforms import ViewState
from flowtex.scene.probe import locate, probe
from flowtex.scene.scene import Scene
from flowtex.settings import Settings

pytestmark = [
    pytest.mark.filterwarnings("ignore::flowtex.errors.Notice"),
    pytest.mark.filterwarnings("ignore:The surface is outside"),
]
SIZE = (72, 48)
#: Root mean square in steps of 8 bits, and share of pixels that may differ by more than 8.
ROOT, SHARE = 1.5, 0.01
#: A part of a surface that is nearer to the eye than this is clipped by OpenGL, not by NumPy.
NEAR = 0.02
CELL = 0.15  #: About the longest side of a cell of the flat surfaces.


def drawn_by_numpy(view: View) -> tuple[Scene, Picture]:
    """Draw a view with its scene."""
    shown = view.made()
    before, after, between = shown.moment
    state = ViewState(between=between, still=True, clock=view.clock)
    steps = (before, after)
    return shown, render(shown.textures, shown.settings, view.camera, SIZE, view=state, steps=steps)


def inner(picture: Picture) -> Bools:
    """Return the pixels (H, W) away from outlines, also of parts before others."""
    steps = [np.linalg.norm(np.diff(picture.position, axis=axis), axis=-1) for axis in (0, 1)]
    usual = np.nanmedian(np.concatenate([step.ravel() for step in steps]))
    result = binary_erosion(picture.covered, iterations=2)
    with np.errstate(invalid="ignore"):
        down, right = (step > 6 * usual for step in steps)
    result[1:] &= ~down
    result[:-1] &= ~down
    result[:, 1:] &= ~right
    result[:, :-1] &= ~right
    return np.asarray(result)


def is_clipped(view: View, picture: Picture) -> bool:
    """Return whether a view may show what lies behind a part that is too near."""
    away = np.linalg.norm(picture.position - view.camera.position, axis=-1)
    return bool(np.nanmin(away) < NEAR)


def agree(theirs: Bytes, picture: Picture, contrast: float) -> None:
    """Fail unless a picture is that of NumPy, but for pixels at outlines."""
    ours = picture.rgb(COLOUR, background=GROUND)
    inside = inner(picture)
    off = np.abs(theirs[inside].astype(float) - ours[inside])
    # Beside a critical point or an edge, rounding decides where a path goes.
    few = max(int(SHARE * len(off)), 2)
    usual = np.sort(off.max(axis=-1))[:-few]
    if not usual.size:
        return
    assert usual.max() <= 8
    assert np.sqrt(np.mean(usual**2)) < ROOT * contrast


@property_test(12, fuzz=250)
@given(views())
def test_vtk_draws_what_numpy_does(plotter: Any, drawn: tuple[str, View]) -> None:
    _, view = drawn
    shown, picture = drawn_by_numpy(view)
    if picture.covered.any() and not is_clipped(view, picture):
        agree(drawn_by_vtk(plotter, view, SIZE), picture, max(shown.settings.contrast, 1.0))
    count_case("random scenes")


@pytest.mark.browser
@property_test(8, fuzz=100)
@given(views())
def test_browser_draws_what_numpy_does(client: ClientPage, drawn: tuple[str, View]) -> None:
    _, view = drawn
    shown, picture = drawn_by_numpy(view)
    if picture.covered.any() and not is_clipped(view, picture):
        theirs = drawn_by_webgl(client, view, shown, SIZE)
        client.clear()
        agree(theirs, picture, max(shown.settings.contrast, 1.0))
    count_case("random scenes")


def exact(flow: Flow, start: Floats, moment: float, length: float, *, series: bool) -> Floats:
    """Return points of the path through a point in the plane z = 0, (N, 2)."""

    def rate(lag: float, place: Floats) -> Floats:
        time = np.clip(moment + lag, 0, len(flow.means) - 1) if series else moment
        velocity = flow.at(np.array([*place, 0.0]), float(time))[:2]
        # At a critical point a path of unit speed would have no direction.
        speed = 1.0 if series else max(float(np.linalg.norm(velocity)), 0.1)
        return np.asarray(velocity / speed)

    points = []
    for side in (-1.0, 1.0):
        lags = side * np.linspace(0, length, 400)
        found = solve_ivp(rate, (0, lags[-1]), start, t_eval=lags, rtol=1e-8, atol=1e-10)
        points.append(found.y.T)
    return np.concatenate(points)


def kink(flow: Flow, place: Floats) -> float:
    """Return the greatest change, from one interval of a series to the next, of what it adds."""
    last = len(flow.means) - 1
    place = np.array([*place, 0.0])
    steps = [flow.at(place, float(min(max(step, 0), last))) for step in range(-1, last + 2)]
    return float(np.linalg.norm(np.diff(steps, n=2, axis=0), axis=-1).max())


@property_test(10, fuzz=150)
@given(flows(), st.sampled_from(FLAT), st.integers(0, 2**20), st.floats(0.002, 0.02))
def test_paths_are_those_of_scipy(flow: Flow, kind: str, seed: int, pixel: float) -> None:
    rng = np.random.default_rng(seed)
    field = flow.field(kind)
    series = not field.steady
    scene = Scene(field, Settings(samples=25, lines="pathlines"))
    scene.time = float(rng.uniform(0, len(flow.means) - 1))
    start = rng.uniform(-0.6, 0.6, 2)
    slow = np.linalg.norm(flow.at(np.array([*start, 0.0]), scene.time)[:2]) < 0.3
    place = locate(field, start)
    if slow or place is None:
        return
    found = probe(scene, place, pixel=pixel)
    path = exact(flow, start, scene.time, 40 * pixel, series=series)
    off = np.linalg.norm(found.points[:, None, :2] - path, axis=-1).min(axis=1)
    # Slices between the nodes are means of paths that may part; so are paths between two steps,
    # which are off by as much as a line through two points on both sides of a kink.
    usual = CELL + kink(flow, start) / 2 * 40 * pixel
    assert off[found.weights > 0].max() < 0.5 * usual
    count_case("random scenes")
