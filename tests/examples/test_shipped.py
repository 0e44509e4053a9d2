"""The shipped flows: the files, and what was computed from them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy import fft

from flowtex.examples import _shipped


def test_the_shipped_period_closes() -> None:
    points, velocity, times = _shipped.cylinder_arrays()
    assert points.shape == (65, 161, 2)
    assert velocity.shape == (31, 65, 161, 2)
    np.testing.assert_allclose(np.diff(times), times[1], rtol=1e-9)
    assert np.abs(velocity[-1] - velocity[0]).max() < 5e-4
    assert np.abs(velocity[15] - velocity[0]).max() > 0.5
    assert not velocity[:, 0].any()
    # Half a period later the wake is its own mirror image.
    mirrored = velocity[15, :, ::-1] * [1.0, -1.0]
    assert np.abs(mirrored - velocity[0]).max() < 2e-3


def test_vorticity_of_a_rigid_rotation_and_of_a_point_vortex() -> None:
    points, _, _ = _shipped.cylinder_arrays()
    turned = np.stack([-points[..., 1], points[..., 0]], axis=-1)
    squared = np.sum(points**2, axis=-1, keepdims=True)
    found = _shipped.polar_vorticity(points, np.stack([turned, turned / squared]))
    np.testing.assert_allclose(found[0], 2.0, atol=1e-6)
    np.testing.assert_allclose(found[1], 0.0, atol=1e-9)


def test_the_shipped_flow_sheds_and_drags_as_published() -> None:
    # Reynolds number 100: Strouhal number 0.164 to 0.167, mean drag 1.32 to 1.36, lift up to
    # 0.31 to 0.34 (Park, Kwon and Choi 1998; Williamson 1989 for the frequency).
    facts = _shipped.load(_shipped.CYLINDER)
    assert facts["reynolds"] == 100.0
    assert 0.163 < facts["strouhal"] < 0.168
    assert 1.31 < facts["drag"] < 1.37
    assert 0.31 < facts["lift"] < 0.34
    assert facts["strouhal"] == pytest.approx(1.0 / facts["times"][-1])
    drag, lift = facts["forces"][:-1].T
    assert facts["drag"] == pytest.approx(drag.mean(), rel=1e-3)
    # Both sides shed alike: lift swings once in the period, drag twice.
    assert np.abs(fft.rfft(lift))[1:].argmax() == 0
    assert np.abs(fft.rfft(drag - drag.mean()))[1:].argmax() == 1
    assert abs(lift.mean()) < 1e-3


def test_the_shipped_vortices_are_strong_and_move() -> None:
    _, velocity, vorticity, times = _shipped.vortex_arrays()
    speed = np.linalg.norm(velocity, axis=-1)
    # A fast particle travels from a twentieth to a tenth of the box between two instants.
    assert 0.05 < speed.max() * times[1] < 0.1
    # Gaussian noise has a kurtosis of 3; lone vortices in quiet surroundings have far more.
    for w in vorticity[:, :-1, :-1]:
        assert np.mean(w**4) / np.mean(w**2) ** 2 > 5.0
    assert np.corrcoef(vorticity[0].ravel(), vorticity[1].ravel())[0, 1] > 0.8
    assert np.corrcoef(vorticity[0].ravel(), vorticity[30].ravel())[0, 1] < 0.3


def test_a_missing_file_says_how_to_make_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(_shipped, "DATA", tmp_path)
    with pytest.raises(FileNotFoundError, match=r"vortex\.npz.*tools/example_data/build\.py"):
        _shipped.vortex_arrays()
