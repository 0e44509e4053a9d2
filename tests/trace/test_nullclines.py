"""Nullclines against the curves on which a component is zero."""

from __future__ import annotations

import numpy as np
import pytest
from flows import torus
from scipy.spatial import Delaunay

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.scene.scene import Scene
from flowtex.settings import Settings, SettingsError
from flowtex.trace.structure.formula_lines import nullclines, view_window


def lengths(pieces: Floats) -> float:
    return float(np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1).sum())


@pytest.mark.parametrize("kind", ["grid", "triangles"])
def test_pieces_lie_on_the_curves_and_cover_them(kind: str) -> None:
    x, y = np.meshgrid(np.linspace(-2, 2, 81), np.linspace(-1.9, 2.1, 83))
    points, velocity = np.stack([x, y], axis=-1), np.stack([x**2 + y**2 - 1, y - x], axis=-1)
    field = FlowField.from_arrays(points, velocity)
    if kind == "triangles":
        flat = points.reshape(-1, 2)
        triangles = Delaunay(flat).simplices
        field = FlowField.from_triangles(flat, triangles, velocity.reshape(-1, 2))
    circle, line = nullclines(field)
    assert np.linalg.norm(circle, axis=-1) == pytest.approx(1, abs=1e-3)
    assert lengths(circle) == pytest.approx(2 * np.pi, rel=1e-3)
    assert line[..., 0] == pytest.approx(line[..., 1], abs=1e-12)
    assert lengths(line) == pytest.approx(np.sqrt(2) * 3.9, rel=1e-6)


def test_walls_are_whole_lines_and_rest_is_none() -> None:
    field = flowtex.examples.double_gyre_field(shape=(41, 81))
    one, two = nullclines(field)
    for pieces, across in ((one, (0, 2)), (two, (0, 1))):
        axis = 0 if pieces is one else 1
        shift = np.array([[0, 0.5], [0.5, 0]][axis])
        assert np.abs(np.sin(np.pi * (pieces[..., :2] + shift)).prod(axis=-1)).max() < 0.01
        # A wall along which a component is zero but for rounding is one whole line.
        for wall in across:
            on = pieces[(np.abs(pieces[..., axis] - wall) < 1e-9).all(axis=1)]
            assert lengths(on) == pytest.approx(1 if pieces is one else 2, abs=0.06)
    still = FlowField.from_arrays(field.points, field.velocity[0] * (1, 0, 0))
    assert len(nullclines(still)[1]) == 0


@pytest.mark.parametrize("rate", ["1/x", "1/(x - y + 0.01)", "abs(x)/x", "tan(3*x)/sin(3*x)"])
def test_poles_and_jumps_of_a_formula_are_none(rate: str) -> None:
    one, two = nullclines(flowtex.formula(rate, "y - x", x=(-1, 1.1), y=(-1, 1.07)))
    assert len(one) == 0
    assert lengths(two) == pytest.approx(np.sqrt(2) * 2.07, rel=1e-6)


def test_a_formula_has_its_lines_at_its_time() -> None:
    field = flowtex.formula("x - t", "1/y", x=(-2, 2), times=(0, 1))
    for step, time in enumerate(field.times):
        one, two = nullclines(field.at_step(step))
        assert one[..., 0] == pytest.approx(time, abs=1e-9)
        assert len(one) and not len(two)


def test_curved_surfaces_have_none() -> None:
    settings = Settings(nullclines=True)
    with pytest.raises(SettingsError, match="nullclines is True; expected False: the surface"):
        Scene(torus(), settings)
    scene = Scene(torus())
    with pytest.raises(SettingsError, match="nullclines"):
        scene.settings.nullclines = True
    assert scene.settings.nullclines is False


def test_lines_of_a_formula_are_as_fine_as_the_view() -> None:
    field = flowtex.formula("x^2 + y^2 - 1", "y - x", x=(-2, 2), y=(-2, 2), resolution=33)
    assert view_window(field, np.zeros(3), 3.0) is None
    focus = np.array([0.6, 0.8, 0.0])
    window = view_window(field, focus, 0.01)
    assert window is not None
    assert (np.abs(focus[:2] - window.mean(axis=1)) + 0.005 < np.ptp(window, axis=1) / 2).all()
    circle, _ = nullclines(field, window)
    middles = circle.mean(axis=1)[:, :2]
    near = (np.abs(middles - focus[:2]) < 0.005).all(axis=1)
    assert near.sum() > 50
    assert np.linalg.norm(middles[near], axis=1) == pytest.approx(1, abs=1e-9)
    assert lengths(circle) == pytest.approx(2 * np.pi, rel=1e-2)
