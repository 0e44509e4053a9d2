"""Paths of sign-free fields, against exact field lines, and the pictures of them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from measures import grey, streaks

import flowtex
from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import Floats
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import paths

SIZE = (200, 200)


def grid(count: int = 41, sheared: bool = False) -> Floats:
    x = np.linspace(-1, 1, count) + 0.37 / count
    points = np.stack(np.meshgrid(x, x), axis=-1)
    return points @ np.array([[1.0, 0.0], [0.6, 0.08]]) if sheared else points


def angle(points: Floats, index: float) -> Floats:
    """Direction of a line field around a singularity of this index."""
    return np.asarray(index * np.arctan2(points[..., 1], points[..., 0]))


def line_field(points: Floats, index: float, seed: int = 0) -> FlowField:
    a = angle(points, index)
    flips = np.random.default_rng(seed).choice([-1.0, 1.0], a.shape)
    v = np.stack([np.cos(a), np.sin(a)], axis=-1) * flips[..., None]
    return FlowField.from_arrays(points, v, sign_free=True, periodic="")


def turned_over(field: FlowField, seed: int = 3) -> FlowField:
    """Turn vectors over at random, behind the back of what brings them into line."""
    flips = np.random.default_rng(seed).choice([-1.0, 1.0], field.shape)
    return replace(field, velocity=field.velocity * flips[..., None])


def ends(field: FlowField, slices: TraceSlices, m: int) -> Floats:
    """Positions on both sides, (2, J, I, 3)."""
    assert slices.forward is not None
    pair = (slices.displacement[0, m], slices.forward[0, m])
    return np.stack([field.surface.at(slices.nodes + moved) for moved in pair])


# --- paths ----------------------------------------------------------------------------------


@pytest.mark.parametrize("sheared", [False, True])
@pytest.mark.parametrize("index", [0.5, -0.5])
def test_lines_around_half_a_turn_are_parabolas_or_their_like(index: float, sheared: bool) -> None:
    """Along a line r^(1 - index) sin((1 - index) phi) is constant, of the same sign or not."""
    points = grid(41, sheared)
    field = turned_over(line_field(points, index))
    lags = np.array([0.05, 0.2, 0.5])
    slices = trace(field, lags=lags, unit=1.0)
    reach = np.stack([slices.reach[0], slices.forward_reach[0]])  # type: ignore[index]
    n = 1 - index

    def constant(p: Floats) -> Floats:
        r, phi = np.hypot(p[..., 0], p[..., 1]), np.arctan2(p[..., 1], p[..., 0])
        return np.asarray(r**n * np.abs(np.sin(n * phi)))

    for m, lag in enumerate(lags):
        there = ends(field, slices, m)
        whole = (reach > lag) & (np.hypot(*np.moveaxis(points, -1, 0)) > lag + 0.15)
        assert whole.mean() > 0.05
        error = np.abs(constant(there) - constant(points))
        # Away from the line into the singularity the path is long and smooth.
        assert error[whole].max() < 0.01


def test_a_field_with_a_sign_has_the_same_lines() -> None:
    points = grid(61)
    v = np.stack([np.cos(2 * points[..., 1]), np.sin(2 * points[..., 0])], axis=-1)
    field = FlowField.from_arrays(points, v)
    other = turned_over(replace(field, sign_free=True))
    lags = [1.0, 4.0, 12.0]
    one, two = (trace(f, lags=lags, compose=False) for f in (field, other))
    for m in range(3):
        a, b = ends(field, one, m), ends(other, two, m)
        apart = np.minimum(np.abs(a - b).max(axis=(0, -1)), np.abs(a - b[::-1]).max(axis=(0, -1)))
        # In the cells of a critical point directions turn by more than can be told from a sign.
        assert (apart < 1e-6).mean() > 0.97


def test_lines_go_over_a_pole() -> None:
    longitude, latitude = np.meshgrid(
        np.arange(72) * np.pi / 36, np.linspace(1, -1, 37) * np.pi / 2
    )
    x, y = np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude)
    points = np.stack([x, y, np.sin(latitude)], axis=-1)
    plain = FlowField.from_arrays(points, np.cross([1.0, 0, 0], points))
    field = turned_over(replace(plain, sign_free=True))
    field.velocity[:, :, -1] = field.velocity[:, :, 0]
    field.velocity[:, [0, -1]] = plain.velocity[:, [0, -1]]
    start = np.array([[20.2, 5.3], [50.0, 1.0], [9.0, 12.0], [31.0, 0.4]])
    lags = [0.1, 0.4, 0.8]
    found = [
        field.surface.at(paths(field, start, lags, forward=side).positions)
        for side in (True, False)
    ]
    wanted = [
        plain.surface.at(paths(plain, start, lags, forward=side).positions)
        for side in (True, False)
    ]
    for n in range(len(start)):
        apart = [
            max(np.abs(found[a][:, n] - wanted[b][:, n]).max() for a, b in pairs)
            for pairs in (((0, 0), (1, 1)), ((0, 1), (1, 0)))
        ]
        assert min(apart) < 2e-3


# --- what has no meaning --------------------------------------------------------------------


def test_what_tells_forward_from_backward_is_refused() -> None:
    field = line_field(grid(11), 0.5)
    with pytest.raises(ValueError, match="two_sided is False; expected True"):
        trace(field, two_sided=False)
    with pytest.raises(ValueError, match="compose is True; expected False or None"):
        trace(field, compose=True)
    plain = replace(field, sign_free=False)
    with pytest.raises(ValueError, match="needs both"):
        SliceStore(field, slices=trace(plain, two_sided=False))


# --- pictures -------------------------------------------------------------------------------


def drawn(field: FlowField, **options: Any) -> Floats:
    return grey(flowtex.render(field, size=SIZE, scalars=False, lighting=False, **options))


@pytest.mark.parametrize("index", [0.5, -0.5])
def test_no_cut_is_seen(opengl: Any, index: float) -> None:
    field = line_field(grid(), index)
    pictures = [drawn(field), drawn(turned_over(field))]
    x = (np.arange(200) - 99.5) / 200 * 2 / 0.92 + 0.37 / 41
    points = np.stack(np.meshgrid(x, -x + 0.74 / 41), axis=-1)
    a = angle(points, index)
    mask = (np.abs(points).max(axis=-1) < 0.8) & (np.hypot(*np.moveaxis(points, -1, 0)) > 0.2)
    for picture in pictures:
        found = streaks(picture, np.cos(a), np.sin(a), mask)
        assert found["angle"] < 4.0
        assert found["coherence"] > 0.9
    # Wherever the cut is, and even where every other node is turned over.
    assert np.abs(pictures[0] - pictures[1])[mask].mean() < 0.5
