"""The vortices: the solver against exact solutions and identities, the file against the solver."""

from __future__ import annotations

from pathlib import Path

import build
import numpy as np
import pytest
import vortex_run
from numpy.typing import NDArray
from periodic_flow import PeriodicFlow, resample
from scipy import fft

from flowtex.examples import _shipped


def coordinates(size: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    y, x = np.mgrid[:size, :size] / size
    return x, y


def test_taylor_green_vortices_decay_as_the_exact_solution() -> None:
    flow = PeriodicFlow(32, viscosity=0.01)
    x, y = coordinates(32)
    wave = 2.0 * np.pi
    start = fft.rfft2(2.0 * wave * np.sin(wave * x) * np.sin(wave * y))
    decay = np.exp(-2.0 * 0.01 * wave**2 * 0.5)
    later = flow.advance(start, 0.01, 50)
    np.testing.assert_allclose(later, decay * start, atol=1e-9)
    exact = decay * np.stack(
        [np.sin(wave * x) * np.cos(wave * y), -np.cos(wave * x) * np.sin(wave * y)], axis=-1
    )
    np.testing.assert_allclose(flow.velocity(later), exact, atol=1e-12)


def test_the_shipped_vortices_are_periodic_and_free_of_divergence() -> None:
    points, velocity, vorticity, times = _shipped.vortex_arrays()
    assert points.shape == (100, 100, 2)
    assert velocity.shape == (31, 100, 100, 2)
    assert vorticity.shape == (31, 100, 100)
    np.testing.assert_allclose(times, 0.04 * np.arange(31), atol=1e-12)
    np.testing.assert_array_equal(velocity[:, 0], velocity[:, -1])
    np.testing.assert_array_equal(velocity[:, :, 0], velocity[:, :, -1])
    ky, kx = PeriodicFlow(99, 0.0).wavenumbers
    u, v = np.moveaxis(velocity[:, :-1, :-1], -1, 0)
    divergence = fft.irfft2(1j * kx * fft.rfft2(u) + 1j * ky * fft.rfft2(v), (99, 99))
    assert np.abs(divergence).max() < 1e-9 * np.abs(vorticity).max()


@pytest.mark.parametrize("instant", [0, 20])
def test_the_code_still_makes_the_shipped_vortices(instant: int) -> None:
    _, _, vorticity, _ = _shipped.vortex_arrays()
    nodes = fft.rfft2(vorticity[instant, :-1, :-1])
    later = vortex_run.advance(resample(nodes, vortex_run.COMPUTED), vortex_run.STEPS_BETWEEN)
    difference = vortex_run.at_nodes(later) - vorticity[instant + 1, :-1, :-1]
    # The file lacks the waves that its nodes cannot carry, hence not the rounding error alone.
    assert np.abs(difference).max() < 0.02 * np.abs(vorticity[instant]).max()
    assert np.sqrt(np.mean(difference**2)) < 5e-3 * np.sqrt(np.mean(vorticity[instant] ** 2))


def test_the_build_command_writes_what_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(vortex_run, "COMPUTED", 99)
    monkeypatch.setattr(vortex_run, "STEPS_BEFORE", 20)
    monkeypatch.setattr(vortex_run, "INSTANTS", 3)
    build.main(["vortex", "--folder", str(tmp_path)])
    assert "vortex.npz" in capsys.readouterr().out
    monkeypatch.setattr(_shipped, "DATA", tmp_path)
    _, velocity, _, times = _shipped.vortex_arrays()
    assert velocity.shape == (3, 100, 100, 2)
    np.testing.assert_allclose(times, [0.0, 0.04, 0.08])
