"""Prediction of slices from slices of shorter lag, and the redundancy that it shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field
from paper.redundancy import Redundancy, error_in_texels, redundancy


def some_times(field: FlowField, count: int) -> FlowField:
    return replace(field, velocity=field.velocity[:count], times=field.times[:count])


#: As the paper follows those of a flow that varies in time.
PATHLINES: dict[str, Any] = {"two_sided": False, "progress": False}
FLOWS: dict[str, Callable[[], TraceSlices]] = {
    "steady gyre": lambda: trace(double_gyre_field(shape=(31, 61)), progress=False),
    "gyre": lambda: trace(some_times(double_gyre_field(True, shape=(21, 41)), 9), **PATHLINES),
    "cylinder": lambda: trace(some_times(cylinder_field().downsample(4), 6), **PATHLINES),
    "airfoil, ended paths": lambda: trace(airfoil_field((25, 65)), progress=False),
}


@cache
def slices_of(name: str) -> TraceSlices:
    return FLOWS[name]()


def halved(slices: TraceSlices) -> TraceSlices:
    half = np.float16
    forward = None if slices.forward is None else slices.forward.astype(half)
    return replace(slices, displacement=slices.displacement.astype(half), forward=forward)


def sides(slices: TraceSlices) -> NDArray[np.floating]:
    backward, forward = slices.displacement, slices.forward
    return np.stack([backward] if forward is None else [backward, forward])


def off_by(one: TraceSlices, other: TraceSlices) -> Floats:
    """Error of each entry along i and j, in cells, (S, T, M, J, I, 2)."""
    return np.asarray(np.abs(sides(one).astype(float) - sides(other).astype(float)))


# --- exactly --------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [lambda s: s, halved])
@pytest.mark.parametrize("name", FLOWS)
def test_without_a_bound_slices_are_decoded_to_the_last_bit(
    name: str, make: Callable[[TraceSlices], TraceSlices]
) -> None:
    slices = make(slices_of(name))
    decoded = redundancy(slices).decoded
    assert sides(decoded).dtype == sides(slices).dtype
    assert sides(decoded).tobytes() == sides(slices).tobytes()


@pytest.mark.parametrize("bound", [None, 0.1])
def test_values_that_are_not_finite_or_far_off_are_decoded(bound: float | None) -> None:
    slices = slices_of("steady gyre")
    strange = np.array([np.nan, np.inf, -np.inf, -0.0, 1e-42, 3e38, -3e38], np.float32)
    data = slices.displacement.copy()
    data[0, 2, 5, 3:10, 0] = data[0, 5, 20, 3:10, 1] = data[0, -1, -1, -7:, 1] = strange
    odd = replace(slices, displacement=data, reach=np.where(slices.reach > 1, np.nan, slices.reach))
    decoded = redundancy(odd, bound).decoded
    if bound is None:
        assert decoded.displacement.tobytes() == data.tobytes()
    finite = np.isfinite(data)
    np.testing.assert_array_equal(decoded.displacement[~finite], data[~finite])
    np.testing.assert_allclose(
        decoded.displacement[finite].astype(float), data[finite].astype(float), atol=0.1, rtol=0
    )
    assert error_in_texels(odd, decoded, 1.0) <= (bound or 0)


# --- within a bound -------------------------------------------------------------------------


@pytest.mark.parametrize("bound", [0.5, 0.02])
@pytest.mark.parametrize("name", FLOWS)
def test_no_entry_is_off_by_more_than_the_bound(name: str, bound: float) -> None:
    slices, texels = slices_of(name), np.array([12.0, 5.0])
    decoded = redundancy(slices, bound, texels=texels).decoded
    error = (off_by(slices, decoded) * texels).sum(axis=-1).max()
    assert 0.5 * bound < error <= bound
    assert error_in_texels(slices, decoded, texels) == pytest.approx(error)
    assert decoded.displacement.dtype == slices.displacement.dtype


# --- the redundancy -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "exact", "bounded"),
    [
        ("steady gyre", 2.1, 35),
        ("gyre", 2.1, 60),
        ("cylinder", 2.7, 70),
        ("airfoil, ended paths", 1.9, 19),
    ],
)
def test_fewer_bits_are_left(name: str, exact: float, bounded: float) -> None:
    """So many times fewer than in memory, in single and in half precision."""
    slices = slices_of(name)

    def factor(measured: Redundancy) -> float:
        return measured.raw / float(measured.by_neighbours.mean())

    assert factor(redundancy(slices)) > exact
    assert factor(redundancy(slices, 0.1)) > bounded
    assert redundancy(halved(slices)).by_neighbours.mean() < 4.5
