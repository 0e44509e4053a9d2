"""Paths that leave the domain, meet a mask or stop; fields that are hardly fields."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.trace.integrate import _Run
from flowtex.trace.trace import paths, trace


def plane(rows: int, columns: int) -> Floats:
    return np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).astype(float)


def wind(rows: int, columns: int, velocity: tuple[float, float], **options: object) -> FlowField:
    points = plane(rows, columns)
    v = np.broadcast_to(np.array(velocity), points.shape)
    return FlowField.from_arrays(points, v, periodic="", **options)  # type: ignore[arg-type]


def test_reach_is_the_lag_to_the_border() -> None:
    slices = trace(wind(11, 21, (1.0, 0.0)), lags=[1.0, 5.0, 25.0])
    expected = np.broadcast_to(np.arange(21.0), (11, 21))
    np.testing.assert_allclose(slices.reach[0], expected, atol=1e-4)
    assert slices.forward_reach is not None
    np.testing.assert_allclose(slices.forward_reach[0], expected[:, ::-1], atol=1e-4)


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6])
def test_path_around_a_small_vortex_takes_few_steps(
    monkeypatch: pytest.MonkeyPatch, tolerance: float
) -> None:
    points = plane(21, 21) - 10.0
    field = FlowField.from_arrays(points, points[..., ::-1] * [-1, 1], periodic="")
    radius, steps, advance = 2 * tolerance, [0], _Run.advance

    def count(run: _Run) -> None:
        steps[0] += 1
        advance(run)

    monkeypatch.setattr(_Run, "advance", count)
    near = paths(field, [[10 + radius, 10]], [1.0, 1000.0], tolerance=tolerance)
    assert np.abs(near.positions - 10).max() < 10 * tolerance
    assert np.isinf(near.reach).all()
    assert steps[0] < 200
    # A circle of a tenth of a cell is followed to the end.
    far = paths(field, [[10.1, 10]], np.linspace(0.05, 9, 60), tolerance=1e-6).positions[:, 0] - 10
    np.testing.assert_allclose(np.hypot(*far.T), 0.1, atol=1e-3)
    assert np.hypot(*np.diff(far, axis=0).T).min() > 0.02


def test_a_path_ends_where_it_meets_a_mask() -> None:
    valid = np.ones((11, 31), bool)
    valid[3:8, 10:13] = False
    slices = trace(wind(11, 31, (1.0, 0.0), valid=valid), lags=[1.0, 4.0, 40.0])
    # The cells whose four nodes are valid end at column 13.
    np.testing.assert_allclose(slices.reach[0, 5, 13:], np.arange(18.0), atol=1e-4)
    np.testing.assert_allclose(slices.reach[0, 0], np.arange(31.0), atol=1e-4)
    assert (slices.reach[0, ~valid] == 0).all()
    assert np.isfinite(slices.displacement).all()


@pytest.mark.parametrize("tilt", [1e-14, -1e-14])
def test_rounding_does_not_push_a_path_over_the_border_it_follows(tilt: float) -> None:
    slices = trace(wind(5, 21, (1.0, tilt)), lags=[1.0, 8.0])
    np.testing.assert_allclose(slices.reach[0, 0], slices.reach[0, 2], atol=1e-4)
    np.testing.assert_allclose(slices.reach[0, -1], slices.reach[0, 2], atol=1e-4)


def test_a_path_into_a_critical_point_stops_there() -> None:
    points = plane(21, 21) - 10.5
    field = FlowField.from_arrays(points, -points, periodic="")
    slices = trace(field, lags=2.0 ** np.arange(6))
    assert slices.forward_reach is not None
    distance = np.hypot(*np.moveaxis(points, -1, 0))
    assert np.isfinite(slices.forward_reach[0, 5, 5])
    assert slices.forward_reach[0, 5, 5] >= distance[5, 5] - 0.5
    np.testing.assert_allclose(
        slices.positions(32.0, forward=True), np.full((21, 21, 2), 10.5), atol=1.0
    )


@pytest.mark.filterwarnings("ignore:The velocity is zero")
@pytest.mark.parametrize("parameter", ["arclength", "time"])
@pytest.mark.parametrize("steps", [1, 3])
def test_nothing_moves(parameter: str, steps: int) -> None:
    points = plane(6, 7)
    field = FlowField.from_arrays(
        points, np.zeros((steps, 6, 7, 2)), times=np.arange(steps), periodic=""
    )
    slices = trace(field, parameter=parameter)
    assert not slices.displacement.any()
    assert not slices.rate.any()
    if steps == 1:
        assert not slices.reach.any()


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_a_collapsed_edge_gives_numbers(parameter: str) -> None:
    angle = np.linspace(0, np.pi, 13)
    r, a = np.meshgrid(np.linspace(0, 1, 9), angle, indexing="ij")
    points = np.stack([r * np.cos(a), r * np.sin(a)], axis=-1)
    field = FlowField.from_arrays(points, np.broadcast_to([1.0, 0.3], points.shape), periodic="")
    slices = trace(field, parameter=parameter)
    assert np.isfinite(slices.displacement).all()
    assert not np.isnan(slices.reach).any()
    # Away from the pole the path is the straight one, as long as it stays away.
    moved = field.surface.at(slices.nodes + slices.displacement[0, 0]) - field.points
    lag = slices.lags[0] * slices.unit
    speed = 1.0 if parameter == "arclength" else np.hypot(1, 0.3)
    expected = -np.array([1.0, 0.3]) / np.hypot(1, 0.3) * speed
    np.testing.assert_allclose(moved[4:-1, 2:-2, :2], lag[4:-1, 2:-2, None] * expected, atol=5e-3)
