"""Prediction of slices from slices of shorter lag, and the redundancy that it shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats
from flowtex.examples import airfoil_field, cylinder_field, double_gyre_field
from paper.redundancy import Redundancy, error_in_texels, redundancy
from paper.redundancy.prediction import Predictor, SliceGrid


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


# --- prediction -----------------------------------------------------------------------------


@pytest.mark.parametrize("degree", [1, 2, 3])
def test_a_polynomial_in_lag_is_predicted_exactly(degree: int, rng: np.random.Generator) -> None:
    slices = slices_of("steady gyre")
    lags = slices.lags
    factors = rng.normal(size=(degree, *slices.rate.shape))
    rate = factors[0]
    data = [sum(f * lag ** (n + 1) for n, f in enumerate(factors)) for lag in lags]
    predictor = Predictor(SliceGrid.of(slices), rate, slices.reach)
    ways = (f"path {degree}", f"mean {degree - 1}")
    checked = 0
    for displacement in data:
        for way in set(ways) & set(predictor.ways()):
            np.testing.assert_allclose(predictor.predict(way), displacement, atol=1e-9)
            checked += 1
        predictor.add(np.asarray(displacement))
    assert checked >= 2 * (len(lags) - degree)


# --- exactly --------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [lambda s: s, halved, lambda s: s.downsample(3)])
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


def test_texels_count_where_the_paths_lead() -> None:
    """Noise with a hundred times as many texels on the right: paths that end there matter."""
    slices = slices_of("steady gyre")
    i = slices.nodes[..., 0]
    texels = np.stack([np.where(i > 40, 100.0, 1.0)] * 2, axis=-1)
    bound = 0.5
    even, uneven = (redundancy(slices, bound, texels=t) for t in (1.0, texels))
    assert uneven.by_neighbours.mean() > even.by_neighbours.mean()

    def worst(decoded: TraceSlices) -> float:
        largest = 0.0
        for true, error in zip(
            sides(slices).reshape(-1, *i.shape, 2),
            off_by(slices, decoded).reshape(-1, *i.shape, 2),
            strict=True,
        ):
            a, b = np.moveaxis(slices.nodes + true, -1, 0)
            density = map_coordinates(texels[..., 0], [b, a], order=1, mode="nearest")
            largest = max(largest, float((error.sum(axis=-1) * density).max()))
        return largest

    assert worst(uneven.decoded) <= bound
    assert worst(even.decoded) > 10 * bound
    error = error_in_texels(slices, even.decoded, texels)
    assert error == pytest.approx(worst(even.decoded))


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


def test_noise_predicts_nothing_of_its_neighbours(rng: np.random.Generator) -> None:
    slices = slices_of("gyre")
    data = rng.normal(size=slices.displacement.shape).astype(np.float32)
    measured = redundancy(replace(slices, displacement=data))
    assert measured.share < 0.05
    assert measured.by_neighbours.min() > 22
