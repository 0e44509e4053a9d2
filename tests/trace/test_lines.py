"""Which lines a field that varies is drawn along: both sides of pathlines, and streamlines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import AnyArray
from flowtex.examples import cylinder_field, double_gyre_field, vortex_field
from flowtex.field.scalars import Scalars
from flowtex.scene.scene import Scene
from flowtex.trace.store import changing_share, chosen_lines


def mirrored(field: FlowField) -> FlowField:
    """The same flow, run backward."""
    times = field.times[-1] - field.times[::-1]
    return replace(field, velocity=-field.velocity[::-1], times=times, scalars=Scalars())


def ahead_of(slices: TraceSlices) -> AnyArray:
    """Slices to the forward side, which there are."""
    assert slices.forward is not None
    return slices.forward


def waving(rate: float, columns: int = 30) -> FlowField:
    """A stream to the right that swings up and down, ever in the same way if the rate is 0."""
    times = np.linspace(0.0, 1.0, 9)
    x, y = np.meshgrid(np.linspace(0.0, 4.0, columns), np.linspace(0.0, 1.0, 10))
    up = [0.5 * np.sin(3.0 * x - rate * t) for t in times]
    velocity = np.stack([np.stack([np.ones_like(x), v], axis=-1) for v in up])
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, times=times, periodic="")


@pytest.mark.parametrize("compose", [False, True])
def test_forward_paths_are_those_of_the_flow_run_backward(compose: bool) -> None:
    field = double_gyre_field(shape=(11, 21), time_varying=True).at_steps(range(17))
    ahead = trace(field, lags=[0.25, 0.5, 1.0, 2.0, 4.0], compose=compose)
    back = trace(mirrored(field), lags=[0.25, 0.5, 1.0, 2.0, 4.0], compose=compose)
    np.testing.assert_allclose(ahead_of(ahead)[::-1], back.displacement, atol=2e-3)
    assert ahead.forward_reach is not None
    np.testing.assert_allclose(ahead.forward_reach[::-1], back.reach, rtol=1e-3)


def test_what_changes_within_a_streak_has_streamlines() -> None:
    for field in (cylinder_field(), vortex_field(), waving(30.0)):
        assert chosen_lines(field) == Scene(field).lines == "streamlines"
        assert chosen_lines(field, "pathlines") == "pathlines"
    assert chosen_lines(waving(0.2)) == "pathlines"
    assert changing_share(waving(0.0)) == 0.0
    assert changing_share(vortex_field().at_step(0)) == 0.0


def test_neither_nodes_nor_steps_change_the_choice() -> None:
    field = waving(6.0, 120)
    share = changing_share(field)
    assert 0.01 < share < 0.99
    assert changing_share(field.downsample(2)) == pytest.approx(share, abs=0.05)
    fewer = replace(field, velocity=field.velocity[::2], times=field.times[::2])
    assert changing_share(fewer) == pytest.approx(share, abs=0.05)
