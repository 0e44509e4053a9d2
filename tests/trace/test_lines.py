"""Which lines a field that varies is drawn along: both sides of pathlines, and streamlines."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pytest

from flowtex import FlowField, TraceSlices, trace
from flowtex._util.array_types import AnyArray
from flowtex.examples import cylinder_field, double_gyre_field, vortex_field
from flowtex.field.steps import LazySteps
from flowtex.scene.scene import Scene
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.trace.store import SliceStore, changing_share, chosen_lines


def mirrored(field: FlowField) -> FlowField:
    """The same flow, run backward."""
    times = field.times[-1] - field.times[::-1]
    return replace(field, velocity=-field.velocity[::-1], times=times, scalars={})


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


def test_composed_forward_paths_agree_with_integrated_ones() -> None:
    field = cylinder_field().downsample(2)
    composed = trace(field)
    direct = trace(field, lags=composed.lags, compose=False, steps=[10, 28])
    assert direct.forward_reach is not None
    for n, step in enumerate((10, 28)):
        for m, lag in enumerate(direct.lags):
            going = direct.forward_reach[n] >= lag
            away = ahead_of(composed)[step, m] - ahead_of(direct)[n, m]
            length = np.linalg.norm(ahead_of(direct)[n, m], axis=-1)
            assert np.linalg.norm(away, axis=-1)[going].mean() < 0.02 * length[going].mean()


def test_the_flow_stays_as_it_is_after_the_last_step() -> None:
    field = double_gyre_field(shape=(21, 41), time_varying=True)
    lags = [0.25, 1.0, 4.0]
    varying = trace(field, lags=lags, steps=[-1], tolerance=1e-6)
    steady = trace(field.at_step(-1), lags=lags, parameter="time", tolerance=1e-6)
    np.testing.assert_allclose(ahead_of(varying), ahead_of(steady), atol=2e-3)


@pytest.mark.parametrize("parameter", ["arclength", "time"])
def test_streamlines_are_those_of_each_step_alone(parameter: str) -> None:
    field = double_gyre_field(shape=(11, 21), time_varying=True)
    store = SliceStore(field, parameter=parameter, lines="streamlines")
    assert store.parameter == parameter
    assert store.two_sided
    for step in (3, 17):
        slices = store.at(step)
        options = {"unit": store.unit, "parameter": parameter, "compose": True}
        alone = trace(field.at_step(step), lags=store.lags, **options)  # type: ignore[arg-type]
        assert slices.times == field.times[step]
        np.testing.assert_allclose(slices.displacement, alone.displacement)
        np.testing.assert_allclose(ahead_of(slices), ahead_of(alone))


def test_only_steps_that_are_shown_are_traced() -> None:
    field = double_gyre_field(shape=(11, 21), time_varying=True)
    store = SliceStore(field, lines="streamlines")
    one = store.at(5).nbytes
    assert store.nbytes == one


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


def test_a_scene_follows_the_setting() -> None:
    scene = Scene(double_gyre_field(shape=(11, 21), time_varying=True))
    assert scene.store.streamlines
    scene.settings.lines = "pathlines"
    assert not scene.store.streamlines
    assert scene.store.parameter == "time"
    assert scene.textures.sides == 2
    assert not scene.coarsened(100).store.streamlines


def test_tiles_have_the_lines_of_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("flowtex.textures.tiles.pyramid.ROOT_NODES", 30_000)
    field = waving(30.0)
    rows, columns = np.linspace(0, 1, 300), np.linspace(0, 4, 350)
    x, y = np.meshgrid(columns, rows)
    up = [0.5 * np.sin(3.0 * x - 30.0 * t) for t in field.times[:2]]
    velocity = np.stack([np.stack([np.ones_like(x), v], axis=-1) for v in up])
    large = FlowField.from_arrays(
        np.stack([x, y], axis=-1), velocity, times=field.times[:2], periodic=""
    )
    for lines in ("pathlines", "streamlines"):
        textures = Pyramid(large, lines=lines).textures(TileKey(0, 0, 0))
        assert textures is not None
        assert textures.store.streamlines == (lines == "streamlines")
        assert textures.store.at(1).forward is not None


def test_of_many_steps_that_paths_meet_some_are_held(monkeypatch: pytest.MonkeyPatch) -> None:
    """Between steps the flow is a mean of both, and this one changes as a line does."""
    times = np.arange(60.0)
    x, y = np.meshgrid(np.linspace(0.0, 4.0, 30), np.linspace(0.0, 1.0, 10))
    steps = np.stack([np.stack([np.full_like(x, 0.02), y * t * 1e-4], axis=-1) for t in times])
    whole = FlowField.from_arrays(np.stack([x, y], axis=-1), steps, times=times, periodic="")
    velocity = np.asarray(whole.velocity)
    late = replace(whole, velocity=LazySteps(60, lambda step: velocity[step]))
    every = SliceStore(late, lines="pathlines").at(30)
    held: list[int] = []
    at_steps = FlowField.at_steps

    def counted(self: FlowField, steps: list[int]) -> FlowField:
        held.append(len(steps))
        return at_steps(self, steps)

    monkeypatch.setattr(FlowField, "at_steps", counted)
    monkeypatch.setattr(sys.modules["flowtex.trace.store"], "HELD_BYTES", 10 * 72 * 300)
    some = SliceStore(late, lines="pathlines").at(30)
    assert held[-1] < 13
    np.testing.assert_allclose(some.displacement, every.displacement, atol=2e-3)
