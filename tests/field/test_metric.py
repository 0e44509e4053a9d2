"""Velocity in index space, and the surface between its nodes, against maps with known answers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField
from flowtex.field.grids.grid_surface import GridSurface

Floats = NDArray[np.float64]

#: Linear maps from (i, j) to space: columns are the tangents of i and j.
LINEAR = {
    "square": [[1, 0], [0, 1], [0, 0]],
    "stretched": [[100, 0], [0, 0.01], [0, 0]],
    "sheared": [[1, 0.9], [0, 0.2], [0, 0]],
    "mirrored": [[-1, 0.3], [0, 2], [0, 0]],
    "rotated in space": [[0.8, -0.3], [0.36, 0.8], [0.48, 0.6]],
    "tiny": [[1e-9, 2e-10], [0, 1e-9], [3e-10, 0]],
    "huge": [[1e9, 2e8], [0, 1e9], [3e8, 0]],
}


def linear_map(name: str) -> Floats:
    return np.array(LINEAR[name], dtype=float)


def indices(rows: int, columns: int) -> Floats:
    """(i, j) of every node, (J, I, 2)."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.stack([i, j], axis=-1).astype(float)


def open_surface(points: Floats) -> GridSurface:
    return GridSurface(points, np.ones(points.shape[:2], bool), (False, False))


def inside(rng: np.random.Generator, rows: int, columns: int, count: int = 200) -> Floats:
    """Random positions in index space, (N, 2)."""
    return rng.random((count, 2)) * [columns - 1, rows - 1]


# --- linear maps are exact ------------------------------------------------------------------


@pytest.mark.parametrize("name", LINEAR)
def test_uniform_flow_on_a_linear_grid_is_exact(name: str) -> None:
    matrix = linear_map(name)
    points = indices(6, 9) @ matrix.T + matrix.sum(axis=1)
    wanted = np.array([0.7, -1.3])
    velocity = np.broadcast_to(matrix @ wanted, points.shape)
    field = FlowField.from_arrays(points, velocity)
    found = field.index_velocity
    np.testing.assert_allclose(found.components, np.broadcast_to(wanted, (1, 6, 9, 2)), rtol=1e-9)
    np.testing.assert_allclose(field.speed, np.linalg.norm(matrix @ wanted), rtol=1e-12)
    assert field.normal_share < 1e-7


@pytest.mark.parametrize("name", LINEAR)
@pytest.mark.parametrize(("rows", "columns"), [(6, 9), (2, 2)])
def test_a_linear_grid_is_exact_between_nodes_and_beyond(
    name: str, rows: int, columns: int
) -> None:
    matrix = linear_map(name)
    surface = open_surface(indices(rows, columns) @ matrix.T)
    at = 3 * inside(np.random.default_rng(0), rows, columns) - 5
    np.testing.assert_allclose(surface.at(at), at @ matrix.T, atol=1e-12 * np.abs(matrix).max())


# --- smooth maps converge -------------------------------------------------------------------


def smooth(s: Floats, t: Floats) -> Floats:
    """Map the unit square onto a curved, sheared piece of surface, (..., 3)."""
    x = s + 0.15 * np.sin(2 * t + 1) * s + 0.2 * s**2
    y = t + 0.3 * s * t + 0.1 * np.cos(3 * s)
    return np.stack([x, y, 0.2 * np.sin(2 * s + t)], axis=-1)


def smooth_tangents(s: Floats, t: Floats) -> tuple[Floats, Floats]:
    bent = 0.2 * np.cos(2 * s + t)
    by_s = [1 + 0.15 * np.sin(2 * t + 1) + 0.4 * s, 0.3 * t - 0.3 * np.sin(3 * s), 2 * bent]
    by_t = [0.3 * np.cos(2 * t + 1) * s, 1 + 0.3 * s, bent]
    return np.stack(by_s, axis=-1), np.stack(by_t, axis=-1)


def errors(measure: Callable[[int], float], counts: tuple[int, ...] = (17, 33, 65)) -> Floats:
    """Order of convergence between grids of these many nodes along each side."""
    found = np.array([measure(n) for n in counts])
    steps = np.array([1 / (n - 1) for n in counts])
    return np.asarray(np.diff(np.log(found)) / np.diff(np.log(steps)))


def grid(n: int) -> tuple[Floats, Floats]:
    s, t = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
    return s, t


def test_index_velocity_converges_with_order_two() -> None:
    def worst(n: int) -> float:
        s, t = grid(n)
        by_s, by_t = smooth_tangents(s, t)
        u, v = np.cos(s + t), np.sin(3 * t)
        velocity = u[..., None] * by_s + v[..., None] * by_t
        found = open_surface(smooth(s, t)).express(velocity[None]).components[0]
        return float(np.abs(found / (n - 1) - np.stack([u, v], axis=-1)).max())

    assert (errors(worst) > 1.8).all()


# --- tangents -------------------------------------------------------------------------------


@pytest.mark.parametrize("component", [0, 1])
def test_tangents_are_the_slopes_of_positions_at_the_nodes(component: int) -> None:
    surface = open_surface(smooth(*grid(9)))
    h = 1e-5
    step = np.eye(2)[component] * h
    at = indices(9, 9)
    low = np.maximum(at - step, 0.0)
    high = np.minimum(at + step, 8.0)
    width = (high - low)[..., component, None]
    slope = (surface.at(high) - surface.at(low)) / width
    # One-sided at the borders, where the error is of first order in h.
    np.testing.assert_allclose(slope, surface.tangents[component], atol=2e-5)


# --- seams ----------------------------------------------------------------------------------


def cylinder(lines: int = 25, columns: int = 6) -> GridSurface:
    angle = np.linspace(0, 2 * np.pi, lines)[:, None]
    height = np.linspace(0.5, 1, columns)[None] ** 2
    points = np.stack(np.broadcast_arrays(np.cos(angle), np.sin(angle), height), axis=-1)
    return GridSurface(points, np.ones((lines, columns), bool), (True, False))


def test_a_whole_turn_comes_back() -> None:
    surface = cylinder()
    at = inside(np.random.default_rng(3), 25, 6)
    for turns in (-2, -1, 1, 3):
        np.testing.assert_allclose(
            surface.at(at + np.array([0, 24 * turns])), surface.at(at), atol=1e-12
        )
    np.testing.assert_allclose(
        surface.at(surface.wrap(at + np.array([0, 48]))), surface.at(at), atol=1e-12
    )


def test_a_turn_of_a_flat_map_goes_on() -> None:
    x, y = np.meshgrid(np.arange(0.0, 361, 10), np.linspace(-90, 90, 19))
    points = np.stack([x, y], axis=-1)
    surface = FlowField.from_arrays(points, np.ones_like(points)).surface
    assert surface.periodic == (False, True)
    at = inside(np.random.default_rng(4), 19, 37)
    np.testing.assert_allclose(
        surface.at(at + np.array([36, 0])), surface.at(at) + np.array([360, 0, 0]), atol=1e-11
    )


# --- what is lost ---------------------------------------------------------------------------


def sphere(n: int = 41) -> FlowField:
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, n), np.linspace(0.3, np.pi - 0.3, n))
    points = np.stack([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)], axis=-1)
    return FlowField.from_arrays(points, np.cross([0, 0, 1.0], points))


def test_flow_along_a_sphere_is_kept() -> None:
    field = sphere()
    assert field.normal_share < 1e-2
    assert field.periodic == (False, True)
    u = field.index_velocity.components[0]
    # One turn of 40 cells takes 2 pi units of time.
    np.testing.assert_allclose(u[..., 0], 40 / (2 * np.pi), rtol=5e-3)
    np.testing.assert_allclose(u[..., 1], 0, atol=1e-2)


def test_uniform_flow_over_a_cylinder_is_projected() -> None:
    surface = cylinder(97)
    velocity = np.broadcast_to([1.0, 0, 0], surface.points.shape)
    found = surface.express(velocity[None])
    angle = np.linspace(0, 2 * np.pi, 97)
    wanted = -np.sin(angle) * 96 / (2 * np.pi)
    np.testing.assert_allclose(found.components[0, :, 2, 1], wanted, atol=0.02)
    np.testing.assert_allclose(found.components[0, ..., 0], 0, atol=1e-12)
    np.testing.assert_allclose(found.speed[0, :, 3], np.abs(np.sin(angle)), atol=1e-12)
    # The mean of cos^2 over nodes, of which the seam counts twice.
    assert found.normal_share == pytest.approx(np.sqrt(np.mean(np.cos(angle) ** 2)), abs=1e-9)


# --- collapsed and blanked ------------------------------------------------------------------


def test_fill_values_of_blanked_nodes_bend_nothing() -> None:
    matrix = linear_map("sheared")
    points = indices(8, 9) @ matrix.T
    valid = np.ones((8, 9), bool)
    valid[3, 4] = valid[0, 0] = False
    broken = points.copy()
    broken[3, 4] = 1e20
    broken[0, 0] = np.nan
    velocity = np.broadcast_to(matrix @ [1.0, 2.0], points.shape)
    field = FlowField.from_arrays(broken, velocity, valid=valid)
    u = field.index_velocity.components[0]
    np.testing.assert_allclose(u[valid], np.broadcast_to([1.0, 2.0], u[valid].shape), rtol=1e-9)
    assert field.surface.extent < 20


def test_cell_size_follows_the_smaller_side() -> None:
    surface = open_surface(indices(5, 5) @ linear_map("stretched").T)
    np.testing.assert_allclose(surface.cell_size, np.sqrt(2 / (1e-4 + 1e4)), rtol=0.5)
    assert surface.cell_size.min() == pytest.approx(surface.cell_size.max())


def test_cells_collapsed_to_a_line_have_the_velocity_once() -> None:
    """Both tangents lie along one line, and their components add up to the velocity."""
    points = indices(9, 12) @ linear_map("sheared").T
    collapsed = slice(0, 4)
    points[:, collapsed, 1] = 0.0
    points[:, collapsed, 0] = np.add.outer(0.5 * np.arange(9), np.arange(4.0) - 20.0)
    velocity = np.broadcast_to([2.0, 1.0, 0.0], points.shape)
    field = FlowField.from_arrays(points, velocity, periodic="")
    inner = (0, slice(2, -2), 1)
    found = field.index_velocity
    np.testing.assert_allclose(found.speed[inner], 2.0, rtol=1e-6)
    p_i, p_j = field.surface.tangents
    u = found.components[inner]
    along = u[..., :1] * p_i[2:-2, 1] + u[..., 1:] * p_j[2:-2, 1]
    np.testing.assert_allclose(along, np.broadcast_to([2.0, 0.0, 0.0], along.shape), atol=1e-6)
