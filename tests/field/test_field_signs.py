"""Fields without a sign: how their nodes are brought into line, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.field.grids.grid_nodes import axes, corner_signs, products

Floats = NDArray[np.float64]


def grid(count: int = 21) -> Floats:
    """Nodes around the origin, which lies inside a cell, (J, I, 2)."""
    x = np.linspace(-1, 1, count) + 0.37 / count
    return np.stack(np.meshgrid(x, x), axis=-1)


def directions(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def half(points: Floats) -> Floats:
    """Directions around a singularity of index 1/2."""
    return directions(np.arctan2(points[..., 1], points[..., 0]) / 2)


def flipped(v: Floats, seed: int = 0) -> Floats:
    return np.asarray(v * np.random.default_rng(seed).choice([-1.0, 1.0], v.shape[:-1])[..., None])


def cut(field: FlowField) -> int:
    """Number of cells whose corners do not all agree."""
    signs = corner_signs(field.velocity[0])
    return 0 if signs is None else int((signs < 0).any(axis=0).sum())


# --- orientation ----------------------------------------------------------------------------


def test_a_field_that_can_be_oriented_is() -> None:
    points = grid()
    smooth = directions(1.5 * points[..., 0] - 0.8 * points[..., 1] ** 2)
    field = FlowField.from_arrays(points, flipped(smooth), sign_free=True)
    assert cut(field) == 0
    sign = field.velocity[0, ..., :2] / smooth
    np.testing.assert_allclose(sign, sign[0, 0, 0])


@pytest.mark.parametrize("count", [21, 41])
def test_around_half_a_turn_a_single_cut_is_left(count: int) -> None:
    points = grid(count)
    field = FlowField.from_arrays(points, flipped(half(points)), sign_free=True)
    assert count / 2 - 1 <= cut(field) <= count


def test_the_closing_line_agrees_with_the_first() -> None:
    angle = np.linspace(0, 2 * np.pi, 41)
    r, a = np.meshgrid(np.linspace(1, 2, 9), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    points[:, -1] = points[:, 0]
    field = FlowField.from_arrays(points, flipped(directions(a / 2)), sign_free=True)
    assert field.periodic == (False, True)
    np.testing.assert_array_equal(field.velocity[0, :, 0], field.velocity[0, :, -1])
    np.testing.assert_allclose(np.linalg.norm(field.velocity, axis=-1), 1)
    assert 8 <= cut(field) <= 12


def test_a_pole_has_one_direction() -> None:
    longitude, latitude = np.meshgrid(
        np.arange(36) * np.pi / 18, np.linspace(1, -1, 19) * np.pi / 2
    )
    x, y = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    points = np.stack([x, y, np.sin(latitude)], axis=-1)
    v = np.cross([1.0, 0, 0], points)
    field = FlowField.from_arrays(points, flipped(v), sign_free=True)
    plain = FlowField.from_arrays(points, v)
    np.testing.assert_allclose(field.speed, plain.speed, atol=1e-12)
    # Around the two points at rest directions differ by more than can be told from a sign.
    assert cut(field) <= 8


# --- means ----------------------------------------------------------------------------------


def test_means_of_directions_do_not_cancel() -> None:
    vectors = np.array([[2.0, 0.1, 0], [-2.0, 0.1, 0]])
    mean = axes(products(vectors).mean(axis=0))
    np.testing.assert_allclose(np.abs(mean), [2.0, 0, 0], atol=0.01)
    assert np.isnan(axes(np.full(9, np.nan))).all()
    np.testing.assert_array_equal(products(np.zeros((2, 3))), 0)


def test_vectors_on_cells_come_to_the_nodes() -> None:
    import pyvista as pv

    mesh = pv.ImageData(dimensions=(9, 7, 1))
    mesh.cell_data["axis"] = flipped(np.tile([0.6, 0.8, 0.0], (48, 1)))
    field = FlowField.from_pyvista(mesh, vectors="axis", sign_free=True)
    np.testing.assert_allclose(np.abs(field.velocity[0]), np.broadcast_to([0.6, 0.8, 0], (7, 9, 3)))
    assert cut(field) == 0
