"""The cylinder: the solver against exact and published results, the file against the solver."""

from __future__ import annotations

from pathlib import Path

import cylinder_run
import numpy as np
import packing
import pytest
from cylinder_flow import CylinderFlow, CylinderSetup
from scipy import fft

from flowtex.examples import _shipped

SMALL = CylinderSetup(modes=24, intervals=64, step=0.02)


def test_without_vorticity_the_flow_is_the_potential_flow() -> None:
    setup = CylinderSetup(modes=8, intervals=128, outer=30.0, sponge=20.0)
    flow = CylinderFlow(setup, np.zeros((8, 129), dtype=np.complex128))
    outward, around = flow.polar_velocity()
    theta = 2.0 * np.pi * np.arange(16) / 16
    found = fft.irfft(outward, 16, axis=0, norm="forward")
    exact = (1.0 - 0.25 / setup.radii**2) * np.cos(theta)[:, None]
    np.testing.assert_allclose(found, exact, atol=2e-6)
    found = fft.irfft(around, 16, axis=0, norm="forward")
    exact = -(1.0 + 0.25 / setup.radii**2) * np.sin(theta)[:, None]
    # At the wall the solver states that nothing moves, whatever the streamfunction says.
    np.testing.assert_allclose(found[:, 1:], exact[:, 1:], atol=2e-4)


def test_the_steady_wake_at_reynolds_number_40_is_the_published_one() -> None:
    # Drag 1.50 to 1.56, separation angle 53 to 54 degrees from the rear (Dennis and Chang 1970,
    # Fornberg 1980, and many since).
    setup = CylinderSetup(reynolds=40.0, modes=24, intervals=96, step=0.02)
    flow = CylinderFlow(setup, np.zeros((24, 97), dtype=np.complex128))
    for _ in range(1200):
        flow.advance()
    assert flow.forces()[0] == pytest.approx(1.53, abs=0.04)
    wall = fft.irfft(flow.vorticity[:, 0], 720, norm="forward")
    turns = np.flatnonzero(np.sign(wall[1:180]) != np.sign(wall[2:181]))
    assert turns.size == 1
    assert (turns[0] + 1.5) / 2.0 == pytest.approx(53.5, abs=1.5)


def test_the_shipped_wake_is_resolved() -> None:
    """The shortest waves around carry next to nothing on any circle, so nothing wiggles."""
    _, velocity, _, _ = _shipped.cylinder_arrays()
    waves = np.abs(fft.rfft(velocity[:, :, :-1], axis=2, norm="forward"))
    assert waves[:, :, 10].max() > 5e-3
    assert waves[:, :, 70:].max() < 1e-4
    state = np.abs(cylinder_run.restart().vorticity)
    assert state[-8:].max() < 1e-3 * state.max()


def test_the_code_still_makes_the_shipped_flow() -> None:
    _, velocity, _, times = _shipped.cylinder_arrays()
    flow = cylinder_run.restart()
    np.testing.assert_allclose(cylinder_run.node_velocity(flow), velocity[0, :, :-1], atol=5e-5)
    for _ in range(cylinder_run.STEPS):
        flow.advance()
    assert flow.time == pytest.approx(times[1])
    # 16 bits leave 2.3e-5; the first step, of first order, about as much.
    np.testing.assert_allclose(cylinder_run.node_velocity(flow), velocity[1, :, :-1], atol=1e-4)


def test_a_whole_run_in_small_is_written_and_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[float] = []
    monkeypatch.setattr(cylinder_run, "STEPS", 10)
    shedding = cylinder_run.run(told.append, durations=(2.0, 2.0, 20.0), coarse=SMALL, full=SMALL)
    assert shedding.velocity.shape == (31, 65, 160, 2)
    assert shedding.forces.shape == (301, 2)
    assert sum(told) == pytest.approx(24.0 + 2.0 * shedding.times[-1], abs=1e-6)
    cylinder_run.write(shedding, tmp_path)
    monkeypatch.setattr(_shipped, "DATA", tmp_path)
    _, velocity, _, times = _shipped.cylinder_arrays()
    step = np.abs(shedding.velocity).max() / packing.STEPS
    np.testing.assert_allclose(velocity[:, :, :-1], shedding.velocity, atol=0.51 * step)
    np.testing.assert_array_equal(times, shedding.times)
