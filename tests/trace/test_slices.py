"""Trace slices, and the store of a field."""

from __future__ import annotations

import numpy as np
import pytest

from flowtex import TraceSlices, trace
from flowtex.examples import double_gyre_field, vortex_field
from flowtex.trace.slices import choose_lags
from flowtex.trace.store import SliceStore


@pytest.fixture(scope="module")
def slices() -> TraceSlices:
    return trace(double_gyre_field(shape=(21, 41)), lags=[0.25, 1.0, 4.0])


# --- one set of slices ----------------------------------------------------------------------


def test_positions_at_the_slices_are_the_slices(slices: TraceSlices) -> None:
    inside = slices.reach[0] >= 4.0
    for m, lag in enumerate(slices.lags):
        expected = slices.nodes + slices.displacement[0, m]
        np.testing.assert_allclose(slices.positions(lag)[inside], expected[inside], atol=1e-5)
    assert inside.sum() > 500
    np.testing.assert_array_equal(slices.positions(0.0), slices.nodes)


# --- arguments ------------------------------------------------------------------------------


def test_automatic_lags_of_a_time_varying_field_reach_its_steps() -> None:
    for field in (vortex_field(), double_gyre_field(True, shape=(21, 41))):
        slices = trace(field, steps=[0])
        lags = slices.lags
        assert slices.parameter == "time"
        step = np.diff(field.times)[0]
        np.testing.assert_allclose(np.log2(lags / step) % 1, 0, atol=1e-6)
        assert lags[0] <= step < lags[-1]


# --- progress, and the store ----------------------------------------------------------------


def test_store_gives_each_step_once() -> None:
    field = double_gyre_field(True, shape=(11, 21))
    store = SliceStore(field)
    one = store.at(5)
    assert store.at(5) is one
    assert one.times.tolist() == [field.times[5]]
    np.testing.assert_allclose(one.displacement, trace(field).at_step(5).displacement, atol=1e-6)


def test_only_chosen_nodes_are_followed() -> None:
    field = double_gyre_field(True, shape=(21, 41))
    nodes = np.zeros(field.shape, bool)
    nodes[5:12, 7:30] = True
    store = SliceStore(field, compose=False, nodes=nodes, longest=0.2)
    some = store.at(9)
    all_ = trace(field, lags=store.lags, unit=store.unit, steps=[9], compose=False)
    np.testing.assert_array_equal(some.displacement[:, :, nodes], all_.displacement[:, :, nodes])
    np.testing.assert_array_equal(some.reach[:, nodes], all_.reach[:, nodes])
    assert not some.reach[:, ~nodes].any()
    # The others move as the nearest one does.
    np.testing.assert_array_equal(some.displacement[:, :, 0, 10], some.displacement[:, :, 5, 10])


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_the_greatest_length_decides_how_many_lags_there_are(parameter: str) -> None:
    field = double_gyre_field(shape=(21, 41))
    quarter = choose_lags(field, parameter)
    np.testing.assert_array_equal(
        quarter, choose_lags(field, parameter, longest=field.surface.extent / 4)
    )
    whole = SliceStore(field, parameter=parameter)
    shorter = SliceStore(field, parameter=parameter, longest=field.surface.extent / 16)
    np.testing.assert_array_equal(shorter.lags[:-1], whole.lags[: len(shorter.lags) - 1])
    np.testing.assert_array_equal(shorter.unit, whole.unit)
    assert (
        shorter.at(0).displacement.shape[1]
        == len(shorter.lags)
        in (len(whole.lags) - k for k in (2, 3))
    )
    if parameter == "arclength":
        longest = shorter.lags[-1] * shorter.unit / (field.surface.extent / 16)
        assert ((longest >= 1) & (longest < 1.125)).all()
        part = SliceStore(field, longest=0.3, cell=3 * whole.unit[0, 0])
        np.testing.assert_allclose(part.unit, 0.75 * whole.unit)
