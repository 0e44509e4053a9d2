"""Paths over the poles: of a rotation about any axis, of a uniform flow on a disc, of a wind."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
import pytest
from measures import streaks
from scipy.spatial.transform import Rotation

import flowtex
from flowtex import FlowField, TraceSlices
from flowtex._util.array_types import AnyArray, Floats
from flowtex.trace.trace import trace

X, Z, TILTED = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.6, 0.0, 0.8)


def frames(rows: int, columns: int) -> tuple[Floats, Floats, Floats]:
    """Nodes of a unit sphere, a meridian short of closing, and what points east and north."""
    longitude, latitude = np.meshgrid(
        np.arange(columns) * 2 * np.pi / columns, np.linspace(1, -1, rows) * np.pi / 2
    )
    c, s, cc, ss = (f(a) for a in (longitude, latitude) for f in (np.cos, np.sin))
    up = np.stack([cc * c, cc * s, ss], axis=-1)
    return up, np.stack([-s, c, 0 * c], axis=-1), np.stack([-ss * c, -ss * s, cc], axis=-1)


def rotation(
    axis: tuple[float, ...], rows: int = 37, columns: int = 72, *, turned: bool = False
) -> FlowField:
    """Solid rotation of a sphere by one radian in a unit of time."""
    points = frames(rows, columns)[0]
    if turned:
        points = np.swapaxes(points, 0, 1)
    return FlowField.from_arrays(points, np.cross(axis, points))


def exact(field: FlowField, axis: tuple[float, ...], lag: float, *, forward: bool) -> Floats:
    angle = lag if forward else -lag
    turned = Rotation.from_rotvec(angle * np.array(axis)).apply(field.points.reshape(-1, 3))
    return np.asarray(turned.reshape(field.points.shape))


def places(field: FlowField, slices: TraceSlices, m: int, *, forward: bool = False) -> Floats:
    moved = slices.forward if forward else slices.displacement
    assert moved is not None
    return field.surface.at(slices.nodes + moved[0, m])


# --- against the exact rotation -------------------------------------------------------------


@pytest.mark.parametrize("compose", [False, True])
@pytest.mark.parametrize(("columns", "turned"), [(72, False), (72, True), (71, False)])
def test_a_rotation_goes_round_in_circles_over_the_poles(
    columns: int, turned: bool, compose: bool
) -> None:
    field = rotation(X, columns=columns, turned=turned)
    row = np.pi / 36
    lags = row * 0.25 * 2.0 ** np.arange(7)
    slices = trace(field, lags=lags, parameter="time", compose=compose)
    assert slices.forward_reach is not None
    # All paths continue but those of the nodes on the axis, on the equator.
    ended = np.isfinite(slices.reach[0]) | np.isfinite(slices.forward_reach[0])
    assert ended.sum() <= 4
    assert np.abs(field.points[ended] @ X).min(initial=1) > 0.99
    for m, lag in enumerate(lags):
        for forward in (False, True):
            there = exact(field, X, lag, forward=forward)
            away = np.linalg.norm(places(field, slices, m, forward=forward) - there, axis=-1) / row
            assert np.quantile(away, 0.99) < 0.01 + 0.004 * lag / row
            assert away.max() < 0.02 + 0.01 * lag / row


def test_a_rotation_that_varies_is_composed_over_the_poles() -> None:
    points = frames(37, 72)[0]
    times = np.linspace(0, 1, 17)
    pace = 1 + 0.5 * times
    field = FlowField.from_arrays(
        points, np.cross(X, points) * pace[:, None, None, None], times=times
    )
    slices = trace(field, lags=times[1] * 2.0 ** np.arange(-1, 4), compose=True)
    row = np.pi / 36
    for step, m in ((16, 4), (9, 3)):
        lag = slices.lags[m]
        angle = lag + 0.25 * (times[step] ** 2 - (times[step] - lag) ** 2)
        there = exact(field, X, angle, forward=False)
        moved = slices.displacement[step, m]
        away = np.linalg.norm(field.surface.at(slices.nodes + moved) - there, axis=-1) / row
        assert np.quantile(away, 0.99) < 0.06
        assert away.max() < 0.1


# --- few paths are integrated beside a pole -------------------------------------------------


@pytest.fixture
def followed(monkeypatch: pytest.MonkeyPatch) -> list[Floats]:
    """Starts (N, 2) of the paths that are integrated, by call."""
    module = import_module("flowtex.trace.trace")
    integrate = module.integrate
    starts: list[Floats] = []

    def recorded(sampler: Any, start: Floats, *rest: Any, **options: Any) -> Any:
        starts.append(start)
        return integrate(sampler, start, *rest, **options)

    monkeypatch.setattr(module, "integrate", recorded)
    return starts


def test_most_paths_around_a_pole_lie_between_those_that_are_integrated(
    followed: list[Floats],
) -> None:
    field = rotation(Z, rows=73, columns=288)
    row = np.pi / 72
    lags = row * 0.25 * 2.0 ** np.arange(8)
    slices = trace(field, lags=lags, parameter="time", compose=True, two_sided=False)
    first, *later = followed
    assert len(first) == field.valid.size
    # Ten lines of 288 nodes are close to the poles.
    assert later
    assert max(map(len, later)) < 0.2 * 10 * 288
    for m, lag in enumerate(lags):
        there = exact(field, Z, lag, forward=False)
        away = np.linalg.norm(places(field, slices, m) - there, axis=-1) / row
        assert np.max(away[[*range(6), *range(-6, 0)]]) < 0.01 + 0.004 * lag / row


def test_paths_that_circle_in_a_pole_are_integrated_once(followed: list[Floats]) -> None:
    points = frames(37, 72)[0]
    # The centre of the rotation lies a little beside the pole.
    field = FlowField.from_arrays(points, np.cross((1e-5, 0.0, 1.0), points))
    trace(field, compose=True, two_sided=False)
    first, *later = followed
    at_poles = [np.isin(starts[:, 1], [0.0, 36.0]).sum() for starts in (first, *later)]
    assert at_poles[0] == 2 * 73
    assert len(later) > 3
    assert sum(at_poles[1:]) <= 2


# --- other ways over a pole -----------------------------------------------------------------


@pytest.mark.parametrize("reverse", [False, True])
def test_a_uniform_flow_crosses_a_disc_and_ends_at_its_rim(reverse: bool) -> None:
    angle = np.linspace(0, 2 * np.pi, 49)[:-1]
    r, a = np.meshgrid(np.linspace(0, 1, 17), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    points = points[::-1] if reverse else points
    wind = np.array([0.8, 0.6])
    field = FlowField.from_arrays(points, np.broadcast_to(wind, points.shape))
    slices = trace(field, lags=0.05 * 2.0 ** np.arange(6), unit=1.0)
    p = field.points[..., :2]
    along, across = p @ wind, p @ [-0.6, 0.8]
    chord = np.sqrt(np.maximum(1 - across**2, 0))
    whole = np.abs(across) < 0.97
    for found, expected in (
        (slices.reach[0], chord + along),
        (slices.forward_reach, chord - along),
    ):
        assert found is not None
        reach = np.minimum(found.reshape(field.shape), 1.6)
        np.testing.assert_allclose(reach[whole], np.minimum(expected, 1.6)[whole], atol=0.03)
    for m in (2, 4):
        inside = slices.reach[0] > slices.lags[m]
        there = p - slices.lags[m] * wind
        np.testing.assert_allclose(
            places(field, slices, m)[inside][:, :2], there[inside], atol=1e-2
        )


# --- pictures -------------------------------------------------------------------------------


def over_the_pole(field: FlowField, zoom: float, up: float = 1.0) -> AnyArray:
    """Picture of a pole from straight above, y upwards."""
    camera = [(0.0, 0.0, up * (1 + 2.2 / zoom)), (0.0, 0.0, up), (0.0, 1.0, 0.0)]
    return flowtex.render(field, size=(140, 140), camera=camera, scalars=False, lighting=False)


@pytest.mark.parametrize(("zoom", "up"), [(4, 1.0), (16, -1.0), (64, 1.0)])
def test_streaks_go_straight_through_the_pole(opengl: Any, zoom: float, up: float) -> None:
    picture = over_the_pole(rotation(X, 61, 120), zoom, up)
    mask = np.zeros(picture.shape[:2], bool)
    mask[12:-12, 12:-12] = True
    ones = np.ones(mask.shape)
    for part in (mask, mask & (np.hypot(*(np.indices(mask.shape) - 69.5)) < 30)):
        found = streaks(picture, 0 * ones, ones, part)
        assert found["angle"] < 3.0
        assert found["coherence"] > 0.85


def test_paths_of_both_directions_pass_the_poles_together(monkeypatch: pytest.MonkeyPatch) -> None:
    module = import_module("flowtex.trace.trace")
    integrate = module.integrate
    calls: list[Floats] = []

    def recorded(*arguments: Any, direction: Any, **options: Any) -> Any:
        calls.append(np.unique(direction))
        return integrate(*arguments, direction=direction, **options)

    monkeypatch.setattr(module, "integrate", recorded)
    field = rotation(TILTED)
    both = trace(field)
    assert sum(len(directions) == 2 for directions in calls) > 2
    in_both = len(calls)
    calls.clear()
    one = trace(field, two_sided=False)
    assert in_both < 1.5 * len(calls)
    np.testing.assert_array_equal(both.displacement, one.displacement)
    np.testing.assert_array_equal(both.reach, one.reach)
