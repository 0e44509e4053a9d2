"""Paths against exact solutions, and against a solver of much higher order."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.examples import double_gyre_field, double_gyre_velocity
from flowtex.trace.trace import paths

#: Linear flows v = A x: bilinear interpolation has no error in them.
FLOWS = {
    "rotation": [[0.0, -1.0], [1.0, 0.0]],
    "shear": [[0.0, 1.0], [0.0, 0.0]],
    "saddle": [[1.0, 0.0], [0.0, -1.0]],
    "spiral": [[-0.3, -1.0], [1.0, -0.3]],
}
#: Maps from (i, j), counted from the middle, to space.
MAPS = {
    "square": [[0.1, 0.0], [0.0, 0.1]],
    "stretched": [[0.1, 0.0], [0.0, 0.02]],
    "sheared": [[0.1, 0.05], [0.0, 0.08]],
    "mirrored": [[-0.1, 0.0], [0.02, 0.1]],
}


def grid(rows: int, columns: int) -> Floats:
    """(i, j) of each node, counted from the middle, (J, I, 2)."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    return np.stack([i - (columns - 1) / 2, j - (rows - 1) / 2], axis=-1)


def linear_field(flow: str, shape: str = "square", count: int = 41) -> FlowField:
    points = grid(count, count) @ np.array(MAPS[shape]).T
    return FlowField.from_arrays(points, points @ np.array(FLOWS[flow]).T, periodic="")


def ring(rows: int, columns: int, speed: Callable[[Floats], Floats]) -> FlowField:
    """Rotation about the origin on a ring of radii 1 to 2 whose first column is its last."""
    angle = np.linspace(0, 2 * np.pi, columns)
    r, a = np.meshgrid(np.linspace(1, 2, rows), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    points[:, -1] = points[:, 0]
    tangent = np.stack([-np.sin(a), np.cos(a)], axis=-1)
    return FlowField.from_arrays(points, tangent * speed(r)[..., None])


def error_of(
    field: FlowField, matrix: Floats, start: Floats, lag: float, tolerance: float
) -> float:
    """Greatest distance, in cells, to the exact solution of v = A x."""
    spacing = np.array(MAPS["square"])[0, 0]
    found = paths(field, start, [lag], parameter="time", tolerance=tolerance).positions[0]
    middle = (field.shape[0] - 1) / 2
    exact = ((start - middle) * spacing) @ expm(-lag * matrix).T / spacing + middle
    return float(np.abs(found - exact).max())


# --- linear flows ---------------------------------------------------------------------------


@pytest.mark.parametrize("shape", MAPS)
@pytest.mark.parametrize("flow", FLOWS)
@pytest.mark.parametrize("forward", [False, True])
def test_linear_flows_are_followed_to_the_tolerance(flow: str, shape: str, forward: bool) -> None:
    field = linear_field(flow, shape)
    start = np.array([[25.0, 18.0], [20.3, 23.1], [17.7, 20.4]])
    lags = [0.1, 0.35, 0.6]
    found = paths(field, start, lags, parameter="time", forward=forward, tolerance=1e-7)
    jacobian, matrix = np.array(MAPS[shape]), np.array(FLOWS[flow])
    sign = 1 if forward else -1
    for lag, position in zip(lags, found.positions, strict=True):
        exact = ((start - 20) @ jacobian.T) @ expm(sign * lag * matrix).T
        np.testing.assert_allclose((position - 20) @ jacobian.T, exact, atol=1e-6)
    assert np.isinf(found.reach).all()


@pytest.mark.parametrize("flow", ["rotation", "spiral"])
def test_error_follows_the_tolerance_as_a_scheme_of_third_order_does(flow: str) -> None:
    field, start = linear_field(flow), np.array([[30.0, 20.0], [20.0, 27.0], [14.0, 25.0]])
    errors = [
        error_of(field, np.array(FLOWS[flow]), start, 1.0, tolerance) for tolerance in (1e-5, 1e-8)
    ]
    # Steps go with the cube root of the tolerance, the whole error with the cube of the step.
    order = 3 * np.log(errors[0] / errors[1]) / np.log(1e3)
    assert errors[0] < 1e-3
    assert 2.7 < order < 3.5


def test_arc_length_is_length() -> None:
    field = linear_field("rotation")
    start = np.array([[30.0, 20.0], [20.0, 25.0]])
    radius = np.array([1.0, 0.5])
    lags = np.array([0.2, 0.7, 1.5])
    found = paths(field, start, lags, tolerance=1e-6).positions
    begin = np.array([0.0, np.pi / 2])
    for lag, position in zip(lags, found, strict=True):
        angle = begin - lag / radius
        exact = np.stack([np.cos(angle), np.sin(angle)], axis=-1) * radius[:, None]
        # The speed, unlike the velocity, is not linear between the nodes: O(h^2) of its bend.
        np.testing.assert_allclose((position - 20) * 0.1, exact, atol=6e-3)


# --- curved maps: second order in the cell size ---------------------------------------------


@pytest.mark.parametrize("parameter", ["time", "arclength"])
def test_ring_is_of_second_order_and_crosses_its_seam(parameter: str) -> None:
    def error(columns: int) -> float:
        rows = columns // 4 + 1
        field = ring(rows, columns + 1, lambda r: 2 / r)
        assert field.periodic == (False, True)
        start = np.array([[0.05 * columns, 0.37 * (rows - 1)]])
        radius = 1 + 0.37
        # One and a half turns, against the first column.
        length = 3 * np.pi * radius
        lag = length if parameter == "arclength" else length / (2 / radius)
        found = paths(field, start, [lag], parameter=parameter, tolerance=1e-7)
        assert np.isinf(found.reach).all()
        return float(
            abs((found.positions[0, 0, 0] - start[0, 0]) / columns + 1.5)
            + abs(found.positions[0, 0, 1] - start[0, 1]) / (rows - 1)
        )

    coarse, fine = error(32), error(64)
    assert fine < 4e-3
    assert 3 < coarse / fine < 6


# --- the double gyre, against a high-order solver -------------------------------------------


def reference(start: Floats, lag: float, time: float, epsilon: float) -> Floats:
    """Positions in space (N, 2) by a scheme of order 8 in the exact velocity."""

    def rate(s: float, y: Floats) -> Floats:
        v = double_gyre_velocity(y.reshape(-1, 2), time - s, epsilon=epsilon)
        return -v.ravel()

    found = solve_ivp(rate, (0, lag), start.ravel(), method="DOP853", rtol=1e-12, atol=1e-12)
    return np.asarray(found.y[:, -1].reshape(-1, 2))


@pytest.mark.parametrize("time_varying", [False, True])
def test_double_gyre_is_of_second_order(time_varying: bool) -> None:
    start = np.array([[0.4, 0.3], [1.1, 0.52], [1.7, 0.8], [0.9, 0.2]])

    def error(cells: int) -> float:
        field = double_gyre_field(time_varying, shape=(cells + 1, 2 * cells + 1))
        step = 28 if time_varying else 0
        found = paths(
            field, start * cells, [5.0], step=step, parameter="time", tolerance=1e-6
        ).positions[0]
        exact = reference(start, 5.0, float(field.times[step]), 0.25 if time_varying else 0.0)
        return float(np.abs(found / cells - exact).max())

    coarse, fine = error(20), error(40)
    assert fine < 0.01
    # Velocities 0.25 apart in time leave an error that does not shrink with the cells.
    assert 2.5 < coarse / fine < 6


# --- flows that vary in time ----------------------------------------------------------------


def uniform(times: Floats, velocity: Floats, count: int = 41) -> FlowField:
    """Flow the same everywhere, (T, 2)."""
    points = grid(count, count) * 0.1
    field = np.broadcast_to(velocity[:, None, None], (len(times), count, count, 2))
    return FlowField.from_arrays(points, field, times=times, periodic="")


def test_velocity_is_linear_between_the_steps() -> None:
    times = np.array([0.0, 0.3, 1.0, 1.4])
    speed = np.array([[0.0, 0.2], [1.0, -0.1], [-0.5, 0.3], [0.7, 0.0]])
    lags = np.array([0.1, 0.4, 0.9, 1.4])
    found = paths(uniform(times, speed), [[20.0, 20.0]], lags, step=3, tolerance=1e-9)
    fine = np.linspace(0, 1.4, 14001)
    for lag, position in zip(lags, found.positions[:, 0], strict=True):
        t = fine[fine >= 1.4 - lag - 1e-9]
        moved = [np.trapezoid(np.interp(t, times, speed[:, c]), t) for c in range(2)]
        np.testing.assert_allclose(position, 20 - np.array(moved) / 0.1, atol=1e-5)
