"""Fill values without a declaration are found; values of a flow never are."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import property_test

from flowtex.sources.datasets.masks import undeclared_fill

FILLS = (-999.0, -9999.0, 9999.0, -99.99, -999.9, -32768.0, -8888.0, -(2.0**31), -1e10, 1e20, 1e35)


def winds(seed: int, count: int = 2000, size: float = 10.0) -> np.ndarray:
    """Random velocities of a smooth distribution."""
    return np.random.default_rng(seed).normal(size=(count, 2)) * size


@property_test(30)
@given(
    st.integers(0, 2**31),
    st.sampled_from(FILLS),
    st.floats(0.01, 0.99),
    st.sampled_from([np.float32, np.float64]),
)
def test_fill_values_of_any_share_are_found(
    seed: int, fill: float, share: float, kind: type[np.floating]
) -> None:
    values = winds(seed)
    values[np.random.default_rng(seed + 1).random(len(values)) < share] = fill
    values[-1], values[0] = 3.0, fill
    found = undeclared_fill(values.astype(kind))
    assert found == float(kind(fill))


def test_several_fill_values_are_found_one_after_the_other() -> None:
    values = winds(0)
    values[:40], values[40:90], values[90:95] = -999, 1e20, np.nan
    assert undeclared_fill(values) == 1e20
    values[values == 1e20] = np.nan
    assert undeclared_fill(values) == -999
    values[values == -999] = np.nan
    assert undeclared_fill(values) is None


def test_few_nodes_suffice_where_there_are_few() -> None:
    assert undeclared_fill(np.array([1.0, 2, -999, -999])) == -999
    assert undeclared_fill(np.array([1.0, 2, 3, -999])) is None


@property_test(60)
@given(st.integers(0, 2**31), st.floats(-1e4, 1e4), st.floats(0, 1), st.floats(1e-3, 1e3))
def test_flows_have_no_fill_value(seed: int, level: float, share: float, size: float) -> None:
    """Clipped, constant and piecewise flows, and lids and inlets in a fluid nearly at rest."""
    flow = winds(seed, size=size)
    top = float(np.quantile(np.abs(flow), 0.5 + share / 2))
    for values in (
        np.clip(flow, -top, top),
        np.full(100, round(level, 1)),
        np.where(np.arange(2000) < 2000 * share, round(level) % 90, 0.0),
        np.where(np.arange(4000) < 4000 * share, 100.0, flow.ravel() * 1e-6),
        np.where(np.arange(4000) < 4000 * share, 2.9e10, 0.0),
        np.where(np.abs(flow) < top, 0.0, flow),
        flow,
    ):
        assert undeclared_fill(values) is None


@pytest.mark.parametrize(
    "values",
    [np.zeros(9), np.array([]), np.full(5, np.nan), np.full(9, -999.0), np.array([np.inf, 1.0])],
)
def test_arrays_without_others_have_no_fill_value(values: np.ndarray) -> None:
    assert undeclared_fill(values) is None


def test_a_usual_fill_value_within_the_range_is_a_value() -> None:
    values = np.linspace(-2000, 2000, 4001)
    values[:2] = values.min()
    assert undeclared_fill(values) is None
    assert undeclared_fill(np.r_[np.linspace(-999, 0, 500), np.full(20, -999.0)]) is None
