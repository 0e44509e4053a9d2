"""Known formulas show their points and orbits for all values of their parameters."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import flowtex
from flowtex._util.array_types import Floats
from flowtex.errors import Notice
from flowtex.field.formula.make import KNOWN, line_arguments

Values = dict[str, float]

#: Points at rest by the values of the parameters.
POINTS: dict[str, Callable[[Values], list[tuple[float, float]]]] = {
    "pendulum": lambda _: [(n * np.pi, 0.0) for n in range(-2, 3)],
    "van_der_pol": lambda _: [(0.0, 0.0)],
    "lotka_volterra": lambda p: [(0.0, 0.0), (p["c"] / p["d"], p["a"] / p["b"])],
    "duffing": lambda _: [(-1.0, 0.0), (0.0, 0.0), (1.0, 0.0)],
    "dipole": lambda _: [],
    "saddle_node": lambda p: [(s * np.sqrt(max(-p["r"], 0)), 0.0) for s in (-1, 1) if p["r"] < 0],
}


def ranges(name: str) -> tuple[Floats, dict[str, tuple[float, float]]]:
    """Return the plane, (2, 2), and the least and the greatest value of each parameter."""
    arguments = line_arguments(KNOWN[name][1])[1]
    plane = np.array([arguments.pop("x"), arguments.pop("y")])
    return plane, {key: (values[1], values[2]) for key, values in arguments.items()}


@pytest.mark.parametrize("name", KNOWN)
def test_points_are_in_the_plane_and_found(name: str) -> None:
    plane, parameters = ranges(name)
    ends = [{low, (low + high) / 2, high} for low, high in parameters.values()]
    if len(parameters) > 1:
        ends = [{low, high} for low, high in parameters.values()]
    for values in itertools.product(*ends):
        chosen: dict[str, Any] = dict(zip(parameters, values, strict=True))
        wanted = np.array(POINTS[name](chosen)).reshape(-1, 2)
        assert ((wanted >= plane[:, 0]) & (wanted <= plane[:, 1])).all(), chosen
        if chosen.get("r") == 0:
            continue  # both are one, which is degenerate
        field = flowtex.formula(name, resolution=65, **chosen)
        found = np.array([point.position[:2] for point in flowtex.critical_points(field)])
        order = [
            np.lexsort(points.T) for points in (found.reshape(-1, 2).round(6), wanted.round(6))
        ]
        got = found.reshape(-1, 2)[order[0]]
        np.testing.assert_allclose(got, wanted[order[1]], atol=1e-6, err_msg=str(chosen))


@pytest.mark.parametrize("mu", [0.1, 1.0, 2.15, 3.0, 4.0])
def test_the_orbit_of_van_der_pol_is_in_the_plane_and_found(mu: float) -> None:
    plane, parameters = ranges("van_der_pol")
    assert parameters["mu"] == (0.0, 4.0)
    start = [2.0, 0.0]
    path = solve_ivp(
        lambda _, p: [p[1], mu * (1 - p[0] ** 2) * p[1] - p[0]], (0, 60), start, max_step=0.02
    )
    greatest = np.abs(path.y[:, path.t > 40]).max(axis=1)
    assert (greatest < 0.95 * plane[:, 1]).all()
    (orbit,) = flowtex.closed_orbits(flowtex.formula("van_der_pol", mu=mu))
    assert orbit.stable
    assert np.abs(orbit.points[:, :2]).max(axis=0) == pytest.approx(greatest, rel=0.01)


def test_parameters_beyond_the_plane_are_told() -> None:
    for mu in (5.0, (1.0, 0.0, 9.0)):
        with pytest.warns(Notice, match=r"mu is .*, beyond 0 to 4, .*; pass x=\(low, high\)"):
            flowtex.formula("van_der_pol", mu=mu, resolution=33)
    flowtex.formula("van_der_pol", mu=5.0, y=(-12, 12), resolution=33)
