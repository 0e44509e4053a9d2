"""Compressed slices: the same again or within the bound, and smaller by what neighbours tell."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import fields, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from flowtex import FlowField, TraceSlices, trace
from flowtex.examples import (
    airfoil_field,
    cylinder_field,
    double_gyre_field,
    liquid_oxygen_post_field,
)
from paper.compact import CompactSlices, compact, error_in_texels, redundancy

Floats = NDArray[np.float64]


def some_times(field: FlowField, count: int) -> FlowField:
    return replace(field, velocity=field.velocity[:count], times=field.times[:count])


FLOWS: dict[str, Callable[[], TraceSlices]] = {
    "steady gyre": lambda: trace(double_gyre_field(shape=(31, 61)), progress=False),
    "gyre": lambda: trace(some_times(double_gyre_field(True, shape=(21, 41)), 9), progress=False),
    "cylinder": lambda: trace(some_times(cylinder_field().downsample(4), 6), progress=False),
    "airfoil, ended paths": lambda: trace(airfoil_field((25, 65)), progress=False),
}


@cache
def slices_of(name: str) -> TraceSlices:
    return FLOWS[name]()


def halved(slices: TraceSlices) -> TraceSlices:
    half = np.float16
    forward = None if slices.forward is None else slices.forward.astype(half)
    return replace(slices, displacement=slices.displacement.astype(half), forward=forward)


def assert_same(one: TraceSlices, other: TraceSlices, *names: str) -> None:
    """Compare attributes by their bits."""
    for name in names or [field.name for field in fields(one)]:
        a, b = getattr(one, name), getattr(other, name)
        if isinstance(a, np.ndarray):
            assert a.dtype == b.dtype, name
            assert a.shape == b.shape, name
            assert a.tobytes() == b.tobytes(), name
        else:
            assert a == b, name


def sides(slices: TraceSlices) -> NDArray[np.floating]:
    found = (
        [slices.displacement] if slices.forward is None else [slices.displacement, slices.forward]
    )
    return np.stack(found)


def off_by(one: TraceSlices, other: TraceSlices) -> Floats:
    """Error of each entry along i and j, in cells, (S, T, M, J, I, 2)."""
    return np.asarray(np.abs(sides(one).astype(float) - sides(other).astype(float)))


# --- exactly --------------------------------------------------------------------------------


@pytest.mark.parametrize("make", [lambda s: s, halved, lambda s: s.downsample(3)])
@pytest.mark.parametrize("name", FLOWS)
def test_exact_slices_are_the_same_to_the_last_bit(
    name: str, make: Callable[[TraceSlices], TraceSlices]
) -> None:
    slices = make(slices_of(name))
    packed = compact(slices)
    assert packed.bound is None
    assert_same(slices, CompactSlices(bytes(packed.data)).restore())


@pytest.mark.parametrize("bound", [None, 0.1])
def test_what_is_no_number_is_kept(bound: float | None) -> None:
    slices = slices_of("steady gyre")
    strange = np.array([np.nan, np.inf, -np.inf, -0.0, 1e-42, 3e38, -3e38], np.float32)
    data = slices.displacement.copy()
    data[0, 2, 5, 3:10, 0] = data[0, 5, 20, 3:10, 1] = data[0, -1, -1, -7:, 1] = strange
    odd = replace(slices, displacement=data, reach=np.where(slices.reach > 1, np.nan, slices.reach))
    restored = compact(odd, bound).restore()
    assert_same(odd, restored, "reach", "forward_reach", "unit", "nodes", "times", "lags")
    if bound is None:
        assert_same(odd, restored)
    numbers = np.isfinite(data)
    np.testing.assert_array_equal(restored.displacement[~numbers], data[~numbers])
    np.testing.assert_allclose(
        restored.displacement[numbers].astype(float), data[numbers].astype(float), atol=0.1, rtol=0
    )
    assert error_in_texels(odd, restored, 1.0) <= (bound or 0)


# --- within a bound -------------------------------------------------------------------------


@pytest.mark.parametrize("bound", [0.5, 0.02])
@pytest.mark.parametrize("name", FLOWS)
def test_no_entry_is_off_by_more_than_the_bound(name: str, bound: float) -> None:
    slices, texels = slices_of(name), np.array([12.0, 5.0])
    packed = compact(slices, bound, texels=texels)
    restored = packed.restore()
    assert packed.bound == bound
    error = (off_by(slices, restored) * texels).sum(axis=-1).max()
    assert 0.5 * bound < error <= bound
    assert error_in_texels(slices, restored, texels) == pytest.approx(error)
    assert_same(slices, restored, "reach", "forward_reach", "unit", "nodes", "times", "lags")
    assert restored.displacement.dtype == slices.displacement.dtype


@pytest.mark.parametrize("name", ["steady gyre", "cylinder"])
def test_between_the_lags_an_eighth_is_added_at_most(name: str) -> None:
    slices, bound = slices_of(name), 0.2
    restored = compact(slices, bound).restore()
    for lag in np.geomspace(slices.lags[0] / 20, slices.lags[-1], 60):
        error = np.abs(slices.positions(lag) - restored.positions(lag)).sum(axis=-1)
        assert error.max() <= 1.125 * bound + 1e-5


def test_texels_count_where_the_paths_lead() -> None:
    """Noise with a hundred times as many texels on the right: paths that end there matter."""
    slices = slices_of("steady gyre")
    i = slices.nodes[..., 0]
    texels = np.stack([np.where(i > 40, 100.0, 1.0)] * 2, axis=-1)
    bound = 0.5
    even, uneven = (compact(slices, bound, texels=t) for t in (1.0, texels))
    assert uneven.nbytes > even.nbytes

    def worst(restored: TraceSlices) -> float:
        found = 0.0
        for true, error in zip(
            sides(slices).reshape(-1, *i.shape, 2),
            off_by(slices, restored).reshape(-1, *i.shape, 2),
            strict=True,
        ):
            a, b = np.moveaxis(slices.nodes + true, -1, 0)
            here = map_coordinates(texels[..., 0], [b, a], order=1, mode="nearest")
            found = max(found, float((error.sum(axis=-1) * here).max()))
        return found

    assert worst(uneven.restore()) <= bound
    assert worst(even.restore()) > 10 * bound
    assert error_in_texels(slices, even.restore(), texels) == pytest.approx(worst(even.restore()))


def test_texels_go_around_with_a_closed_axis() -> None:
    slices = slices_of("cylinder")
    texels = np.ones((*slices.shape, 2))
    texels[:, :4] = texels[:, -4:] = 50.0
    restored = compact(slices, 0.5, texels=texels, periodic=(False, True)).restore()
    assert error_in_texels(slices, restored, texels, (False, True)) <= 0.5


# --- smaller --------------------------------------------------------------------------------


def raw(slices: TraceSlices) -> bytes:
    return sides(slices).tobytes()


@pytest.mark.parametrize(
    ("name", "exact", "bounded"),
    [
        ("steady gyre", 4, 45),
        ("gyre", 2.5, 40),
        ("cylinder", 3.2, 55),
        ("airfoil, ended paths", 2.3, 16),
    ],
)
def test_slices_become_smaller(name: str, exact: float, bounded: float) -> None:
    """So many times smaller in single precision; deflate alone at most half."""
    slices = slices_of(name)
    bytes_ = len(raw(slices))
    assert len(zlib.compress(raw(slices))) > 0.5 * bytes_
    assert compact(slices).slice_bytes < bytes_ / exact
    assert compact(slices, 0.1).slice_bytes < bytes_ / bounded
    assert compact(halved(slices)).slice_bytes < bytes_ / 2 / exact


def test_the_post_becomes_smaller(data_dir: Path) -> None:
    slices = trace(liquid_oxygen_post_field(data_dir), progress=False)
    assert_same(slices, compact(slices).restore())
    packed = compact(slices, 0.1)
    assert off_by(slices, packed.restore()).sum(axis=-1).max() <= 0.1
    assert packed.slice_bytes < len(raw(slices)) / 14


# --- the redundancy -------------------------------------------------------------------------


@pytest.mark.parametrize("bound", [None, 0.05])
@pytest.mark.parametrize("name", FLOWS)
def test_neighbouring_slices_tell_much_of_each_other(name: str, bound: float | None) -> None:
    found = redundancy(slices_of(name), bound)
    assert found.alone.shape == (len(sides(slices_of(name))), len(found.lags))
    assert (found.given <= found.by_lag).all()
    assert (found.by_lag <= found.alone).all()
    assert found.given.max() < found.raw == 32
    assert found.share > 0.2
    assert found.predicted > 0.4


def test_a_flow_that_is_the_same_everywhere_is_told_by_one_slice() -> None:
    points = np.stack(np.meshgrid(np.arange(40.0), np.arange(30.0)), axis=-1)
    field = FlowField.from_arrays(points, np.broadcast_to([1.0, 0.5], points.shape), periodic="")
    slices = trace(field, lags=[1.0, 2.0, 4.0, 8.0], compose=False, progress=False)
    found = redundancy(slices, 0.01)
    assert found.by_lag[:, 1:].max() < 0.05
    assert compact(slices, 0.01).slice_bytes < 2000


def test_noise_tells_nothing_of_its_neighbours(rng: np.random.Generator) -> None:
    slices = slices_of("gyre")
    data = rng.normal(size=slices.displacement.shape).astype(np.float32)
    found = redundancy(replace(slices, displacement=data))
    assert found.share < 0.05
    assert found.given.min() > 22


# --- what goes wrong ------------------------------------------------------------------------


def test_damage_is_found(rng: np.random.Generator) -> None:
    data = compact(slices_of("steady gyre")).data
    for bad in (b"", b"PK\x03\x04", data[:10], data[:60], data[:-1], data[: len(data) // 2]):
        with pytest.raises(ValueError, match=r"expected|damaged|holds"):
            CompactSlices(bad).restore()
    start = data.index(b"}") + 1
    for at in rng.integers(start, len(data), 20):
        changed = bytearray(data)
        changed[at] ^= 0x55
        try:
            restored = CompactSlices(bytes(changed)).restore()
        except ValueError:
            continue
        assert_same(slices_of("steady gyre"), restored)


@pytest.mark.parametrize("part", [b'"lags"', b'"times"', b'"blocks"', b'"rest"', b'"length"'])
def test_a_header_that_lacks_a_part_is_refused(part: bytes) -> None:
    data = compact(slices_of("gyre"), 0.5).data
    with pytest.raises(ValueError, match="damaged"):
        CompactSlices(data.replace(part, part.upper(), 1)).restore()


def test_what_is_wrong_is_said() -> None:
    slices = slices_of("steady gyre")
    for bound in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="expected a positive number of texels"):
            compact(slices, bound)
    with pytest.raises(ValueError, match=r"texels has shape \(3,\); expected .*\(31, 61, 2\)"):
        compact(slices, 0.1, texels=[1, 2, 3])
    with pytest.raises(ValueError, match="texels goes from 0 to 0"):
        compact(slices, 0.1, texels=0)
    assert "within 0.1 texels" in repr(compact(slices, 0.1))
