"""Closed orbits that are known exactly, and flows that have none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial import Delaunay

import flowtex
from flowtex import FlowField


def turning(rate: str, resolution: int = 129, **values: Any) -> FlowField:
    """Return a flow that turns at rate 1, and whose radius grows by ``rate`` of it."""
    field: FlowField = flowtex.formula(
        f"x*({rate}) - y",
        f"y*({rate}) + x",
        x=(-2, 2),
        y=(-2.1, 1.9),
        resolution=resolution,
        **values,
    )
    return field


def test_van_der_pol_has_one_orbit_of_its_period_and_amplitude() -> None:
    def rate(_: float, at: Any) -> Any:
        return at[1], (1 - at[0] ** 2) * at[1] - at[0]

    # On the axis once it has settled.
    def crosses(_: float, at: Any) -> Any:
        return at[1]

    crosses.direction = -1  # type: ignore[attr-defined]
    found: Any = solve_ivp(rate, (0, 80), (2, 0), events=crosses, rtol=1e-10, atol=1e-10)
    times, amplitude = found.t_events[0], found.y_events[0][-1, 0]
    field = flowtex.formula("y", "(1 - x**2) * y - x", x=(-3, 3), y=(-4, 4), resolution=129)
    (orbit,) = flowtex.closed_orbits(field)
    assert orbit.stable
    assert orbit.period == pytest.approx(times[-1] - times[-2], rel=1e-3)
    assert np.abs(orbit.points[:, 0]).max() == pytest.approx(amplitude, rel=1e-3)
    assert np.array_equal(orbit.points[0], orbit.points[-1])
    # In the direction of the flow, which turns clockwise.
    x, y, _ = orbit.points.T
    assert np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) < 0
    back = flowtex.formula("-y", "x - (1 - x**2) * y", x=(-3, 3), y=(-4, 4), resolution=129)
    (other,) = flowtex.closed_orbits(back)
    assert not other.stable and other.period == pytest.approx(orbit.period, rel=1e-3)


@pytest.mark.parametrize("speed", [1.0, 0.05])
def test_the_radius_of_a_hopf_orbit_is_exact(speed: float) -> None:
    (orbit,) = flowtex.closed_orbits(turning(f"{speed} * (1 - x**2 - y**2)"))
    assert orbit.stable and orbit.period == pytest.approx(2 * np.pi, rel=1e-3)
    radius = np.linalg.norm(orbit.points, axis=1)
    assert np.abs(radius - 1).max() < 2e-3


def test_an_orbit_on_triangles_is_the_same() -> None:
    points = np.random.default_rng(3).uniform(-2, 2, (4000, 2))
    x, y = points.T
    rate = 1 - x**2 - y**2
    velocity = np.stack([x * rate - y, y * rate + x], axis=-1)
    field = FlowField.from_triangles(points, Delaunay(points).simplices, velocity)
    (orbit,) = flowtex.closed_orbits(field)
    assert orbit.stable and orbit.period == pytest.approx(2 * np.pi, rel=1e-2)
    assert np.linalg.norm(orbit.points, axis=1) == pytest.approx(1, abs=2e-2)


@pytest.mark.parametrize(
    ("u", "v"),
    [
        ("-y", "x"),
        ("y", "-sin(x)"),
        ("y", "-sin(x) - 0.2*y"),
        ("x - x*y/2 + 1", "x*y - y"),
        ("-sin(2*x)", "-cos(y)"),
        ("x", "2*y"),
    ],
    ids=["centre", "pendulum", "damped", "prey", "gradient", "source"],
)
def test_centres_gradients_and_spirals_have_none(u: str, v: str) -> None:
    field = flowtex.formula(u, v, x=(-3, 3.1), y=(-3, 2.9), resolution=97)
    assert flowtex.closed_orbits(field) == []


@pytest.mark.parametrize("nodes", [17, 25, 49])
def test_a_flow_without_divergence_has_none_on_a_coarse_grid(nodes: int) -> None:
    random = np.random.default_rng(3)
    x, y = np.meshgrid(*2 * [np.linspace(0, 2 * np.pi, nodes)])
    velocity = np.zeros((nodes, nodes, 2))
    for _ in range(6):  # a stream function of waves
        a, b = random.integers(-3, 4, 2)
        wave = random.normal() * np.cos(a * x + b * y + random.uniform(0, 6.28))
        velocity += np.stack([b * wave, -a * wave], axis=-1)
    field = FlowField.from_arrays(np.stack([x, y], axis=-1), velocity)
    assert flowtex.closed_orbits(field) == []
    assert not any(line.closed for line in flowtex.separatrices(field))


def test_a_weak_orbit_on_a_coarse_grid_is_one() -> None:
    (orbit,) = flowtex.closed_orbits(turning("0.05 * (1 - x**2 - y**2)", 33))
    assert np.linalg.norm(orbit.points, axis=1) == pytest.approx(1, abs=2e-2)
