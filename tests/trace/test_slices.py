"""Trace slices: the paper's figures 3 and 4, reading and writing, and what callers get wrong."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
import pytest
from scipy.ndimage import map_coordinates

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats
from flowtex.examples import cylinder_field, double_gyre_field, vortex_field
from flowtex.trace.slices import choose_lags
from flowtex.trace.store import SliceStore


@pytest.fixture(scope="module")
def slices() -> TraceSlices:
    return trace(double_gyre_field(shape=(21, 41)), lags=[0.25, 1.0, 4.0])


# --- figures 3 and 4 ------------------------------------------------------------------------

FIGURES: dict[str, tuple[Callable[[], FlowField], float, int]] = {
    "vortex": (vortex_field, 0.04, 10),
    "double gyre": (lambda: double_gyre_field(True, shape=(51, 101)), 0.5, 30),
    "cylinder": (cylinder_field, 0.2, 30),
}


def displacements(field: FlowField, lags: Floats, step: int) -> Floats:
    """Integrated slices (M, J, I, 2) of one step."""
    slices = trace(field, lags=lags, parameter="time", steps=[step], compose=False)
    return np.asarray(slices.displacement[0], dtype=float)


@cache
def compared(name: str, factor: int) -> dict[str, Floats]:
    """Mean errors in cells for lags of 1 to 10 steps, against the slices of the whole field.

    "slices" keeps every ``factor``-th entry of the slices, "field" traces the field of every
    ``factor``-th node; "at nodes" compares at the entries that are left, "everywhere" at all
    nodes, interpolated.
    """
    make, step_length, step = FIGURES[name]
    field, lags = make(), np.linspace(step_length, 10 * step_length, 10)
    full = displacements(field, lags, step)
    coarse = displacements(field.downsample(factor), lags, step) * factor
    rows, columns = ((n - 1) // factor * factor + 1 for n in field.shape)
    full, kept = full[:, :rows, :columns], full[:, :rows:factor, :columns:factor]
    coarse = coarse[:, : kept.shape[1], : kept.shape[2]]
    j, i = np.meshgrid(np.arange(rows) / factor, np.arange(columns) / factor, indexing="ij")

    def everywhere(data: Floats) -> Floats:
        return np.stack(
            [[map_coordinates(d[..., c], [j, i], order=1) for c in range(2)] for d in data]
        )

    exact = np.moveaxis(full, -1, 1)
    return {
        "field, at nodes": np.linalg.norm(coarse - kept, axis=-1).mean(axis=(1, 2)),
        "field, everywhere": np.linalg.norm(everywhere(coarse) - exact, axis=1).mean(axis=(1, 2)),
        "slices, everywhere": np.linalg.norm(everywhere(kept) - exact, axis=1).mean(axis=(1, 2)),
    }


@pytest.mark.parametrize("factor", [2, 4])
@pytest.mark.parametrize("name", FIGURES)
def test_figures_3_and_4(name: str, factor: int) -> None:
    """Slices are true wherever an entry is left, at any lag; traces of a coarse field drift off."""
    found = compared(name, factor)
    drift, by_field, by_slices = found.values()
    # At the entries that are left slices have no error, and the field's accumulates.
    assert (np.diff(drift) > 0).all()
    assert drift[-1] > 4 * drift[0]
    # Between them slices have the error of interpolation; the field's has its drift on top.
    assert (by_slices < 0.95 * by_field).all()
    assert by_field[-1] - by_slices[-1] > 2 * (by_field[0] - by_slices[0])


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
