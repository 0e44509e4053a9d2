"""Slices of any field are finite and soon there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import field_arguments, field_of, property_test

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.trace.slices import TraceSlices
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import paths, trace

WAYS = st.sampled_from(["arclength", "time"])


def check(slices: TraceSlices) -> None:
    """No slice has a number that is not finite, and no reach is negative."""
    for data in (slices.lags, slices.unit, slices.rate, slices.displacement, slices.forward):
        assert data is None or np.isfinite(data).all()
    for reach in (slices.reach, slices.forward_reach):
        assert reach is None or (reach >= 0).all()


@property_test(40, fuzz=80)
@given(field_arguments(), WAYS)
def test_slices_of_any_field(arguments: dict[str, Any], parameter: str) -> None:
    field = field_of(arguments)
    if field is None:
        return
    store = SliceStore(field, parameter=parameter)
    for step in range(store.steps):
        check(store.at(step))


@property_test(25)
@given(field_arguments(), WAYS, st.lists(st.floats(), min_size=1, max_size=3), st.booleans())
def test_any_lags(
    arguments: dict[str, Any], parameter: str, lags: list[float], compose: bool
) -> None:
    field = field_of(arguments)
    if field is None:
        return
    try:
        check(trace(field, lags=lags, parameter=parameter, compose=compose, steps=[-1]))
        found = paths(field, [[0.5, 0.5]], lags, parameter=parameter)
        assert np.isfinite(found.positions).all()
    except ValueError as error:
        assert "expected" in str(error)


def plane(rows: int, columns: int) -> Floats:
    return np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).astype(float)


def turning(size: int = 4) -> tuple[Floats, Floats]:
    """A vortex, in which paths do not end."""
    points = plane(size, size) - (size - 1) / 2
    return points, points[..., ::-1] * [-1, 1]


def test_a_change_in_time_is_not_jumped_over_on_the_way_forward() -> None:
    points, _ = turning(9)
    gust = np.zeros((9, *points.shape))
    gust[4] = [1.0, 0.0]
    field = FlowField.from_arrays(points, gust)
    found = paths(field, [[2.0, 4.0]], [8.0], step=0, forward=True)
    np.testing.assert_allclose(found.positions[0], [[3.0, 4.0]], atol=0.02)


@pytest.mark.parametrize("speed", [1e-90, 1e-41, 1e-20, 1e20, 1e41, 1e90])
@pytest.mark.parametrize("steps", [1, 3])
def test_slices_do_not_depend_on_the_unit_of_time(speed: float, steps: int) -> None:
    points, velocity = turning(6)
    times = np.arange(3.0)[:steps]
    one, other = (
        SliceStore(
            FlowField.from_arrays(points, np.stack([velocity * s] * steps), times=times / s),
            parameter="time",
        ).at(0)
        for s in (1.0, speed)
    )
    np.testing.assert_allclose(other.displacement, one.displacement, rtol=1e-2, atol=1e-2)
    # Half precision holds the reach.
    assert 0.1 < other.lags[0] < other.lags[-1] < 1e4
