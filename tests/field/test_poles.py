"""Poles of a sphere and of a disc: what index space is beyond them, and the plane beside them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.grids.poles import Pole

Floats = NDArray[np.float64]


def sphere(rows: int = 19, columns: int = 36, *, turned: bool = False, bent: float = 0.0) -> Floats:
    """Nodes of a unit sphere from pole to pole, (J, I, 3); its first column is its last.

    ``turned`` has latitude along i, and ``bent`` spaces the meridians unevenly.
    """
    s = np.linspace(0, 2 * np.pi, columns + 1)
    longitude, latitude = np.meshgrid(s + bent * np.sin(s), np.linspace(1, -1, rows) * np.pi / 2)
    x, y = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    points = np.stack([x, y, np.sin(latitude)], axis=-1)
    points[:, -1] = points[:, 0]
    return np.swapaxes(points, 0, 1) if turned else points


def disc(rows: int = 9, columns: int = 32) -> Floats:
    angle = np.linspace(0, 2 * np.pi, columns + 1)
    r, a = np.meshgrid(np.linspace(0, 1, rows), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a), 0 * r], axis=-1)
    points[:, -1] = points[:, 0]
    return points


def surface(points: Floats, **options: object) -> GridSurface:
    field = FlowField.from_arrays(points, np.ones_like(points), **options)  # type: ignore[arg-type]
    assert isinstance(field.surface, GridSurface)
    return field.surface


def poles(points: Floats, **options: object) -> list[Pole]:
    return list(surface(points, **options).poles or ())


def somewhere(rows: int, columns: int, count: int = 300) -> Floats:
    """Positions (2, N) inside index space."""
    return np.random.default_rng(1).random((2, count)) * [[columns], [rows - 1]]


# --- which lines are poles ------------------------------------------------------------------


@pytest.mark.parametrize("turned", [False, True])
def test_a_sphere_has_two_poles(turned: bool) -> None:
    first, last = poles(sphere(turned=turned))
    assert (first.line, first.inward, last.line, last.inward) == (0, 1, 18, -1)
    assert first.component == last.component == int(not turned)
    assert first.cells == 36
    np.testing.assert_allclose(np.abs(np.cross(*first.plane)), [0, 0, 1], atol=1e-12)
    assert first.size == pytest.approx(np.sin(np.pi / 18))


def test_a_disc_has_one() -> None:
    (pole,) = poles(disc())
    assert (pole.line, pole.component, pole.inward) == (0, 1, 1)
    (pole,) = poles(disc()[::-1])
    assert (pole.line, pole.inward) == (8, -1)


def test_what_is_no_pole() -> None:
    assert not poles(disc()[:, :17])  # a wedge
    assert not poles(disc()[1:])  # a ring
    longitude, latitude = np.meshgrid(np.arange(36) * 10.0, np.linspace(90, -90, 19))
    assert not poles(np.stack([longitude, latitude], axis=-1))  # a flat map
    tube = sphere()
    tube[..., :2] = disc(19, 36)[-1:, :, :2]
    assert not poles(tube)
    wake = disc(9, 32)
    wake[..., 0] += 1
    wake[0] = np.linspace(-1, 1, 33)[:, None] ** 2 * [1.0, 0, 0]
    assert not poles(wake)  # a line folded onto itself
    partly = disc()
    partly[0, 8:] = 0.5 * partly[1, 8:]
    assert not poles(partly)


def test_a_blanked_pole_is_a_hole() -> None:
    points = sphere()
    valid = np.ones(points.shape[:2], bool)
    valid[0, 5] = False
    assert [pole.line for pole in poles(points, valid=valid)] == [18]


# --- index space continues --------------------------------------------------------------------


@pytest.mark.parametrize("columns", [36, 37])
def test_beyond_a_pole_lies_the_other_side(columns: int) -> None:
    found = surface(sphere(columns=columns))
    i, j = somewhere(19, columns)
    np.testing.assert_allclose(
        found.at(np.stack([i, -j], axis=-1)), found.at(np.stack([i + columns / 2, j], axis=-1))
    )
    np.testing.assert_allclose(
        found.at(np.stack([i, 36 - j], axis=-1)), found.at(np.stack([i + columns / 2, j], axis=-1))
    )
    np.testing.assert_allclose(
        found.at(np.stack([i, j - 36], axis=-1)), found.at(np.stack([i, j], axis=-1)), atol=1e-12
    )


@pytest.mark.parametrize("bent", [0.0, 0.3])
@pytest.mark.parametrize("turned", [False, True])
def test_a_line_over_the_pole_goes_straight_on(turned: bool, bent: float) -> None:
    found = surface(sphere(bent=bent, turned=turned))
    t = np.linspace(-3, 3, 61)
    for i in (5.0, 5.5, 30.25):
        index = np.stack([np.full_like(t, i), t], axis=-1)
        position = found.at(index[:, ::-1] if turned else index)
        # In one plane with the axis, and at even angles on one circle around the middle.
        side = np.cross(position[0], [0, 0, 1])
        side /= np.linalg.norm(side)
        np.testing.assert_allclose(position @ side, 0, atol=2e-3)
        angle = np.unwrap(np.arctan2(position @ np.cross([0, 0, 1], side), position[:, 2]))
        np.testing.assert_allclose(np.abs(angle), np.abs(t) * np.pi / 18, atol=4e-3)


# --- the plane ------------------------------------------------------------------------------


@pytest.mark.parametrize("bent", [0.0, 0.3])
@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("end", [0, 1])
def test_to_the_plane_and_back(end: int, turned: bool, bent: float) -> None:
    pole = poles(sphere(turned=turned, bent=bent))[end]
    there = somewhere(6, 36)
    there[1] = pole.line + pole.inward * there[1]
    there = there if pole.component else there[::-1]
    place = pole.place(there)
    np.testing.assert_allclose(pole.index(place), there, atol=1e-9)
    assert np.linalg.norm(place, axis=0).max() < 6.5
    np.testing.assert_allclose(pole.depth(pole.index(np.zeros((2, 1)))), 0)


# --- velocity -------------------------------------------------------------------------------


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("end", [0, 1])
def test_one_point_has_one_velocity(end: int, turned: bool) -> None:
    points = sphere(bent=0.2, turned=turned)
    velocity = np.broadcast_to([0.3, -1.1, 5.0], points.shape)
    field = FlowField.from_arrays(points, velocity)
    pole = list(field.surface.poles or ())[end]
    speed = pole.lines(field.speed[0])[pole.line]
    np.testing.assert_allclose(speed, np.hypot(0.3, 1.1))
    along = pole.lines(field.index_velocity.components[0])[pole.line, :, pole.component]
    np.testing.assert_allclose(pole.vector(along) @ pole.plane, [0.3, -1.1, 0], atol=1e-12)


def test_lines_around_a_round_pole_need_no_table(monkeypatch: pytest.MonkeyPatch) -> None:
    even = poles(sphere())[0]
    uneven = poles(sphere(bent=0.3))[0]
    searched: list[int] = []
    interp = np.interp

    def recorded(x: Floats, xp: Floats, fp: Floats) -> Floats:
        searched.append(len(x))
        return np.asarray(interp(x, xp, fp))

    monkeypatch.setattr(np, "interp", recorded)
    position = np.array([[0.0, 3.2, 35.9], [0.5, 2.0, 4.0]])
    np.testing.assert_allclose(even.index(even.place(position)), position, atol=1e-9)
    assert searched == []
    np.testing.assert_allclose(uneven.index(uneven.place(position)), position, atol=1e-9)
    assert searched
