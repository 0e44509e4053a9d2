"""Steps that are read late, and dates."""

from __future__ import annotations

from dataclasses import replace
from datetime import datetime
from typing import Any

import numpy as np
import pytest

from flowtex import FlowField, trace
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.dates import as_seconds, date_text, seconds_since
from flowtex.field.steps import LazySteps, map_steps
from flowtex.trace import store
from flowtex.trace.store import SliceStore

cftime: Any = pytest.importorskip("cftime")


def lazy(values: Floats) -> tuple[LazySteps, list[int]]:
    """An array as steps that are read late, and the numbers of those that were read."""
    read: list[int] = []

    def step(number: int) -> Floats:
        read.append(number)
        return np.asarray(values[number])

    return LazySteps(len(values), step), read


def test_steps_are_indexed_as_an_array() -> None:
    values = np.random.default_rng(1).normal(size=(7, 5, 6, 3))
    steps, read = lazy(values)
    j, i = np.array([1, 3]), np.array([0, 2, 5])
    keys: list[Any] = [
        0,
        -1,
        slice(2, 5),
        slice(None, None, 2),
        [1, 4],
        np.array([0, 6]),
        (slice(None), j[:, None], i),
        (slice(1, 3), 2),
        (3, 2, 1),
        (slice(None), slice(1, 3), slice(2, None), 0),
        (..., 1),
    ]
    for key in keys:
        assert np.array_equal(np.asarray(steps[key]), values[key]), key
    assert steps.shape == values.shape and steps.ndim == 4 and len(steps) == 7
    assert np.array_equal(np.asarray(map_steps(steps, np.abs)), np.abs(values))
    assert np.array_equal(map_steps(values, np.abs), np.abs(values))
    assert np.array_equal(np.stack(list(steps)), values)
    with pytest.raises(IndexError, match="step 7 does not exist: expected 0 to 6"):
        steps[7]
    other, read = lazy(values)
    view = other[2:][:, 1]
    assert not read
    assert np.array_equal(view[0], values[2, 1]) and read == [2]


def test_a_single_step_is_copied_only_if_it_is_the_same_memory() -> None:
    values = np.ones((1, 3, 4))
    made = np.zeros((3, 4))
    assert np.shares_memory(map_steps(values, lambda step: made), made)
    for mapped in (map_steps(values, np.asarray), map_steps(values, lambda step: step[::-1])):
        assert isinstance(mapped, np.ndarray)
        assert not np.shares_memory(mapped, values)


@pytest.fixture(scope="module")
def series() -> FlowField:
    """A vortex that wanders through eight steps."""
    y, x = np.mgrid[-1:1:30j, -1:1:40j]
    steps = [np.stack([-(y - 0.1 * t), x - 0.05 * t], -1) for t in range(8)]
    days = np.datetime64("2000-01-01") + np.arange(8) * np.timedelta64(1, "D")
    points = 1e5 * np.stack([x, y], -1)
    return FlowField.from_arrays(points, np.stack(steps), times=days)


@pytest.mark.parametrize("lines", ["streamlines", "pathlines"])
def test_a_series_that_is_read_late_is_traced_alike(
    series: FlowField, lines: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = np.asarray(series.velocity)
    steps, read = lazy(values)
    late = replace(series, velocity=steps)
    parameter = "arclength" if lines == "streamlines" else "time"
    one = SliceStore(series, parameter=parameter, lines=lines, compose=False)
    other = SliceStore(late, parameter=parameter, lines=lines, compose=False)
    if lines == "pathlines":
        other.lags, other.unit = one.lags, one.unit
    for step in (3, 7):
        a, b = one.at(step), other.at(step)
        assert np.allclose(a.displacement, b.displacement, atol=2e-3), step
    if lines == "streamlines":
        assert set(read) <= {0, 3, 7}
        whole, part = (trace(each, lags=[1.0, 4.0], steps=[3]) for each in (series, late))
        np.testing.assert_array_equal(whole.displacement, part.displacement)
    else:
        # This flow is linear in time, so some of the steps are enough.
        monkeypatch.setattr(store, "HELD_BYTES", 0)
        monkeypatch.setattr(store, "LEAST_HELD", 3)
        steps, read = lazy(values)
        some = SliceStore(replace(series, velocity=steps), lines=lines, compose=False)
        some.lags, some.unit = one.lags, one.unit
        assert np.allclose(some.at(3).displacement, one.at(3).displacement, atol=2e-3)
        assert 3 in read and not {2, 4} & set(read)


def test_derived_series_reads_only_the_step_in_use(series: FlowField) -> None:
    steps, read = lazy(np.asarray(series.velocity))
    vorticity = replace(series, velocity=steps).derive("vorticity")
    assert isinstance(vorticity, LazySteps)
    assert np.array_equal(vorticity[3], series.derive("vorticity")[3]) and read == [3]


def test_dates_are_those_of_their_calendar() -> None:
    dates = cftime.num2date([0, 1, 2], "days since 2000-02-28", calendar="noleap")
    seconds, unit, start = as_seconds(np.asarray(dates), "")
    assert np.asarray(seconds).tolist() == [0.0, 86400.0, 172800.0] and unit == "s"
    assert date_text(start, 86400.0, 86400.0) == "2000-03-01"
    assert seconds_since(start, "2000-03-02") == 172800.0
    assert seconds_since(start, dates[1]) == 86400.0
    assert date_text(datetime(2000, 1, 1), 5400.0, 3600.0) == "2000-01-01 01:30"
    assert date_text(datetime(2000, 1, 1), 1.0, 0.5) == "2000-01-01 00:00:01"
    assert seconds_since(None, 3) == 3.0
    with pytest.raises(ValueError, match="are not dates"):
        seconds_since(None, "2000-01-01")
    with pytest.raises(FieldError, match="no fixed length"):
        as_seconds(np.array([1], "timedelta64[M]"), "")
