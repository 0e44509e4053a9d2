"""Fixed points and closed orbits of formulas, against SymPy and SciPy.

The browser client passes the cases of ``formula_cases.json`` as well.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

import flowtex
from flowtex import FlowField
from flowtex.errors import Notice
from flowtex.field.formula.derivatives import derivative
from flowtex.field.formula.grammar import OPERATIONS, evaluate, parse

CASES = json.loads((Path(__file__).parent / "formula_cases.json").read_text(encoding="utf-8"))
#: Some where lines turn around a point, and none closes but around a centre.
WITHOUT_ORBITS = ("Hopf", "weak repelling focus", "Lotka-Volterra", "damped Duffing")


def field_of(case: dict[str, Any], resolution: int = 65) -> FlowField:
    ends = {"x": case["x"], "y": case["y"], "resolution": resolution}
    field: FlowField = flowtex.formula(*case["rates"], **ends, **case["parameters"])
    return field


def points_of(case: dict[str, Any]) -> Any:
    if not case["resting"]:
        return flowtex.critical_points(field_of(case))
    with pytest.warns(Notice) as record:
        points = flowtex.critical_points(field_of(case))
    assert any("the velocity is zero along lines" in str(each.message) for each in record)
    return points


@pytest.mark.parametrize("case", CASES, ids=[case["name"] for case in CASES])
def test_points_are_exact(case: dict[str, Any]) -> None:
    found = list(points_of(case))
    assert len(found) == len(case["points"])
    for expected in case["points"]:
        point = min(found, key=lambda p: float(np.hypot(*(p.position[:2] - expected["at"]))))
        loose = 1e-3 if expected["kind"] == "degenerate" else 1e-8
        assert np.abs(point.position[:2] - expected["at"]).max() < loose
        assert point.kind == expected["kind"]
        assert point.poincare_index == expected["index"]
        values = [complex(*value) for value in expected["eigenvalues"]]
        assert point.eigenvalues == pytest.approx(values, abs=max(1e-8, 10 * (loose - 1e-8)))


@pytest.mark.parametrize(
    "case", [case for case in CASES if case["points"]], ids=lambda case: case["name"]
)
def test_eigenvalues_are_those_of_sympy(case: dict[str, Any]) -> None:
    sympy = pytest.importorskip("sympy")
    names = {"hypot": lambda a, b: sympy.sqrt(a * a + b * b), "sign": sympy.sign}
    rates = [sympy.sympify(rate.replace("^", "**"), names) for rate in case["rates"]]
    x, y = sympy.symbols("x y")
    matrix = sympy.Matrix(rates).subs(case["parameters"]).jacobian([x, y])
    for point in case["points"]:
        at = dict(zip((x, y), point["at"], strict=True))
        values = np.linalg.eigvals(np.array(matrix.subs(at), dtype=float))
        expected = np.array([complex(*value) for value in point["eigenvalues"]])
        assert np.sort_complex(values) == pytest.approx(np.sort_complex(expected), abs=1e-8)


@pytest.mark.parametrize(
    "case",
    [case for case in CASES if case["orbits"] or case["name"] in WITHOUT_ORBITS],
    ids=lambda case: case["name"],
)
def test_periods_of_closed_orbits_are_those_of_scipy(case: dict[str, Any]) -> None:
    orbits = flowtex.closed_orbits(field_of(case))
    assert sorted(orbit.stable for orbit in orbits) == case["orbits"]
    trees = [parse(rate, ("x", "y", *case["parameters"])) for rate in case["rates"]]

    def rate(_: float, at: Any) -> Any:
        values = {**case["parameters"], "x": at[0], "y": at[1]}
        return [evaluate(tree, values) for tree in trees]

    for orbit in orbits:
        # From a place of the orbit, one turn later, both ways.
        start = orbit.points[0, :2]
        way = 1 if orbit.stable else -1
        times = (0, way * 1.5 * orbit.period)
        normal = np.array(rate(0, start)) * way

        def crosses(_: float, at: Any, start: Any = start, normal: Any = normal) -> Any:
            return (at - start) @ normal

        crosses.direction = 1  # type: ignore[attr-defined]
        found: Any = solve_ivp(rate, times, start, events=crosses, rtol=1e-10, atol=1e-12)
        periods = [abs(t) for t in found.t_events[0] if abs(t) > 0.5 * orbit.period]
        assert orbit.period == pytest.approx(periods[0], rel=1e-6)
        end = solve_ivp(rate, (0, way * orbit.period), start, rtol=1e-10, atol=1e-12).y[:, -1]
        assert np.abs(end - start).max() < 1e-4
        assert np.array_equal(orbit.points[0], orbit.points[-1])


@pytest.mark.parametrize("name", [name for name in OPERATIONS if name.isalnum()])
def test_each_function_has_its_derivative(name: str) -> None:
    count = OPERATIONS[name][1] or 3
    arguments = ["0.3 + x/3", "y", "x*y"][:count] if name != "where" else ["x < y", "x*y", "y"]
    text = f"-({arguments[0]})" if name == "neg" else f"{name}({', '.join(arguments)})"
    tree, at, h = parse(text, "xy"), {"x": 0.8, "y": 0.55}, 1e-6
    for k in "xy":
        ends = [evaluate(tree, {**at, k: at[k] + sign * h}) for sign in (1, -1)]
        slope = (ends[0] - ends[1]) / (2 * h)
        assert evaluate(derivative(tree, k), at) == pytest.approx(slope, rel=1e-8, abs=1e-9)


def test_random_polynomials_have_the_roots_of_scipy() -> None:
    random = np.random.default_rng(5)
    for _ in range(4):
        rows = random.normal(size=(2, 6)).round(3)
        terms = ("1", "x", "y", "x^2", "x*y", "y^3")
        texts = ["+".join(f"({a})*{t}" for a, t in zip(row, terms, strict=True)) for row in rows]
        field = flowtex.formula(*texts, x=(-3, 3), y=(-3, 3), resolution=33)
        found = np.array([p.position[:2] for p in flowtex.critical_points(field)]).reshape(-1, 2)

        def rates(at: Any, rows: Any = rows) -> Any:
            x, y = at
            return rows @ np.array([1, x, y, x * x, x * y, y**3])

        roots: list[Any] = []
        for start in random.uniform(-3, 3, (200, 2)):
            root, _, status, _ = fsolve(rates, start, full_output=True, xtol=1e-13)
            is_new = all(np.abs(root - other).max() > 1e-6 for other in roots)
            if status == 1 and np.abs(root).max() <= 3 and is_new:
                roots.append(root)
        assert len(found) == len(roots)
        for root in roots:
            assert np.abs(found - root).max(axis=1).min() < 1e-8


def test_separatrices_of_degenerate_points_follow_the_flow() -> None:
    def ends(*rates: str, **values: Any) -> list[tuple[bool, float, float]]:
        field = flowtex.formula(*rates, x=(-2, 2), y=(-2, 2), resolution=65, **values)
        lines = flowtex.separatrices(field)
        assert all(line.saddle.kind == "degenerate" for line in lines)
        return sorted((line.forward, *line.points[-1, :2].round(1).tolist()) for line in lines)

    # At a saddle-node, the line that leaves it, and the two beside which all others pass.
    assert ends("-x^2", "-y") == [(False, 0.0, -2.0), (False, 0.0, 2.0), (True, -2.0, 0.0)]
    # A dipole has the axis of its lobes, and a monkey saddle six lines at 60 degrees.
    assert ends("x^2 - y^2", "2*x*y") == [(False, -2.0, 0.0), (True, 2.0, 0.0)]
    monkey = ends("x^2 - y^2", "-2*x*y")
    assert [forward for forward, _, _ in monkey] == [False] * 3 + [True] * 3
    for forward, x, y in monkey:
        angle = np.degrees(np.arctan2(y, x)) + (0 if forward else 180)
        assert abs((angle + 60) % 120 - 60) < 3
    # On those of a cusp y^2 = 2 x^3 / 3.
    field = flowtex.formula("y", "x^2", x=(-2, 2), y=(-2, 2), resolution=65)
    lines = flowtex.separatrices(field)
    assert len(lines) == 2
    for line in lines:
        x, y, _ = line.points.T
        assert y**2 == pytest.approx(2 / 3 * x**3, abs=0.01)


def test_separatrices_of_a_formula_are_those_of_scipy() -> None:
    field = flowtex.formula("y", "-sin(x)", x=(-4, 4), y=(-3, 3), resolution=33)
    lines = flowtex.separatrices(field)
    assert len(lines) == 8
    for line in lines:  # of energy 1
        x, y, _ = line.points.T
        assert y**2 / 2 - np.cos(x) == pytest.approx(1, abs=2e-4)


def test_points_on_surfaces_are_exact() -> None:
    torus = flowtex.formula("sin(u)", "cos(v) - 0.5", surface="torus", resolution=33)
    points = flowtex.critical_points(torus)
    assert sorted(point.kind for point in points) == ["saddle", "saddle", "sink", "source"]
    source = points.of_kind("source")[0]
    v = -np.pi / 3
    assert source.position == pytest.approx([1 + 0.4 * np.cos(v), 0, 0.4 * np.sin(v)], abs=1e-9)
    assert source.eigenvalues == pytest.approx([1, np.sqrt(0.75)], abs=1e-8)
    # The velocity along z on a sphere that is turned: a source and a sink, off the poles.
    ball = flowtex.formula("1", "0.5", "0.25", surface="sphere", resolution=33)
    poles = flowtex.critical_points(ball)
    way = np.array([1, 0.5, 0.25]) / np.linalg.norm([1, 0.5, 0.25])
    assert [point.kind for point in poles] in (["source", "sink"], ["sink", "source"])
    for point in poles:
        sign = -1 if point.kind == "source" else 1
        assert point.position == pytest.approx(sign * way, abs=1e-9)
        growth = -sign * np.linalg.norm([1, 0.5, 0.25])
        assert point.eigenvalues == pytest.approx([growth, growth], abs=1e-8)


def test_periodic_coordinates_have_each_point_once() -> None:
    points = flowtex.critical_points(
        flowtex.formula("v", "-sin(u) - 0.2*v", surface="cylinder", resolution=33)
    )
    assert sorted(point.kind for point in points) == ["saddle", "spiral sink"]
    (saddle,) = points.of_kind("saddle")
    assert saddle.position == pytest.approx([-1, 0, 0], abs=1e-9)
    assert saddle.eigenvalues == pytest.approx(np.roots([1, 0.2, -1])[::-1], abs=1e-9)


def test_poles_of_a_sphere_have_the_part_of_the_velocity_along_it() -> None:
    for up, kind in ((0.3, "spiral sink"), (0, "centre"), (-0.3, "spiral source")):
        field = flowtex.formula("-y", "x", f"{up}*z", surface="sphere")
        points = flowtex.critical_points(field)
        assert [point.kind for point in points] == [kind] * 2
        for point in points:
            assert abs(point.position[2]) == pytest.approx(1)
            assert point.eigenvalues == pytest.approx([-up + 1j, -up - 1j], abs=1e-3)


def test_a_field_that_was_changed_is_searched_itself() -> None:
    field = flowtex.formula("y", "-sin(x)", x=(-2, 2), y=(-2, 2), resolution=33)
    moved = field.velocity[0] + [0.5, 0, 0]
    changed = FlowField.from_arrays(field.points, moved)
    kept = replace(field, velocity=changed.velocity)
    assert kept.formula is not None
    (point,) = flowtex.critical_points(kept)
    assert point.position[1] == pytest.approx(-0.5, abs=1e-6)
