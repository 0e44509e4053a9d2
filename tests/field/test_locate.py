"""Points of a surface: from a point in space to an index and back."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Callable

import numpy as np
import pytest

from flowtex import FlowField
from flowtex.field.locate import locate, locator, surface_point
from flowtex.field.quantities import values_at


def flat(rows: int = 9, columns: int = 13) -> FlowField:
    """A sheared plane whose cells grow fourfold along j."""
    t, s = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 2, columns), indexing="ij")
    points = np.stack([s + 0.3 * t, t**2 + 0.2 * t], axis=-1)
    return FlowField.from_arrays(points, np.ones_like(points), periodic="")


def sphere() -> FlowField:
    lon, lat = np.meshgrid(np.linspace(0, 2 * np.pi, 37), np.linspace(0, np.pi, 19))
    points = np.stack([np.sin(lat) * np.cos(lon), np.sin(lat) * np.sin(lon), np.cos(lat)], axis=-1)
    east = np.stack([-points[..., 1], points[..., 0], 0 * lon], axis=-1)
    return FlowField.from_arrays(points, east)


def world() -> FlowField:
    """A flat map, one period wide."""
    x, y = np.meshgrid(np.arange(0.0, 361.0, 10.0), np.arange(-60.0, 61.0, 10.0))
    return FlowField.from_arrays(np.stack([x, y], -1), np.ones((*x.shape, 2)), periodic="i")


def boundary_layer() -> FlowField:
    """An O-grid whose cells at the body are 10,000 times as long as they are high."""
    angle = np.linspace(0, 2 * np.pi, 33)
    radius = 1 + np.concatenate([[0], np.geomspace(2e-5, 5, 40)])
    points = radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return FlowField.from_arrays(points, np.ones_like(points))


@pytest.mark.parametrize("make", [flat, sphere, world, boundary_layer])
def test_a_point_of_the_surface_is_found(
    make: Callable[[], FlowField], rng: np.random.Generator
) -> None:
    field = make()
    rows, columns = field.shape
    # Next to a pole an index says little: positions are compared.
    for _ in range(60):
        at = rng.uniform(0, 1, 2) * [rows - 1, columns - 1]
        point = surface_point(field.surface, at).interpolate(field.surface.points)
        found = locate(field, point)
        assert found is not None
        there = surface_point(field.surface, found).interpolate(field.surface.points)
        assert np.abs(there - point).max() < 1e-9 * field.surface.extent


def test_an_index_beyond_a_pole_is_on_its_far_side(rng: np.random.Generator) -> None:
    surface = sphere().surface
    # A path that goes over a pole ends there.
    for j, i in rng.uniform([18.0, 0.0], [34.0, 36.0], (20, 2)):
        point = surface_point(surface, (j, i))
        nodes = surface_point(surface, (36.0 - j, i + 18.0))
        assert point.interpolate(surface.points) == pytest.approx(
            nodes.interpolate(surface.points), abs=1e-9
        )
        assert point.interpolate(surface.points) == pytest.approx(
            surface.at(np.array([i, j])), abs=0.02
        )


def test_a_point_off_the_surface_has_no_index() -> None:
    plane, ball = flat(), sphere()
    assert locate(plane, (-0.5, 0.5)) is None
    assert locate(plane, (1.0, 0.5, 3.0)) is None
    assert locate(ball, (0.0, 0.0, 0.0)) is None
    assert locate(ball, (0.0, 2.0, 0.0)) is None
    # As far outside the surface as is requested.
    assert locate(plane, (1.0, -0.01)) == pytest.approx((0.0, 6.0), abs=0.1)
    assert locate(plane, (1.0, -0.01), tolerance=1e-3) is None
    assert locate(ball, (0.0, 1.01, 0.0), tolerance=1e-3) is None


def test_a_blanked_cell_has_no_index() -> None:
    points = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), axis=-1)
    valid = np.ones((5, 6), dtype=bool)
    valid[2, 2] = False
    field = FlowField.from_arrays(points, np.ones_like(points), valid=valid)
    assert locate(field, (1.5, 1.5)) is None
    assert locate(field, (3.5, 1.5)) == pytest.approx((1.5, 3.5))
    with pytest.raises(ValueError, match=r"\(1\.5, 1\.5\), not on the drawn surface"):
        values_at(field, (1.5, 1.5))
    # A node beside it belongs to other cells too.
    assert values_at(field, (3, 2)).position == pytest.approx([2, 3, 0])


def test_a_seam_is_no_border() -> None:
    ball, flat_map = sphere(), world()
    for y, i in ((-1e-3, 36 - 0.00573), (1e-3, 0.00573)):
        assert locate(ball, (1.0, y, 0.0)) == pytest.approx((9, i), abs=1e-4)
    # A point in the next period is the one in this.
    assert locate(flat_map, (365.0, 5.0)) == pytest.approx((6.5, 0.5))
    assert locate(flat_map, (-5.0, 5.0)) == pytest.approx((6.5, 35.5))
    assert values_at(flat_map, (6.5, 36.5)).position == pytest.approx([5, 5, 0])


def test_the_tree_lives_as_long_as_its_field() -> None:
    field = flat()
    kept: weakref.ref[object] = weakref.ref(locator(field))
    assert locator(field) is kept()
    del field
    gc.collect()
    assert kept() is None
