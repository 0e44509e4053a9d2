"""The procedural noise: nothing repeats, nothing pops, and its variance is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.noise import Motion, noise_lattice, octave
from flowtex.rendering.cpu.texture import shared
from flowtex.rendering.shaders import const

VALUES: dict[str, Any] = {
    "u_noiseFinest": 1.0,
    "u_noiseOriginEven": (512.0, -1024.0, 0.0),
    "u_noiseOriginOdd": (0.0, -1024.0, 0.0),
    "u_noiseRestOdd": (362.04, 299.9, 0.0),
    "u_seed": 0,
}


def noise(
    position: Floats,
    level: int,
    *,
    planar: bool = True,
    motion: Any = None,
    sparse: bool = False,
    seed: int = 0,
) -> Floats:
    """One octave at positions (N, 3)."""
    levels = np.full(len(position), level)
    found = noise_lattice(position, levels, VALUES | {"u_seed": seed})
    return octave(found, np.zeros_like(position), motion, planar=planar, sparse=sparse)


@pytest.mark.parametrize("level", [0, 1, 7])
def test_no_part_of_a_large_lattice_is_like_another(level: int) -> None:
    width = 2.0 ** (level / 2)
    j, i = np.indices((768, 768)) * width
    values = noise(np.stack([i, j, 0 * i], -1).reshape(-1, 3), level).reshape(j.shape)
    power = np.abs(np.fft.fft2(values - values.mean())) ** 2
    agree = np.fft.ifft2(power).real
    agree /= agree[0, 0]
    # Values of neighbours agree where the points lie between those of the lattice.
    agree[:2, :2] = agree[-1, :2] = agree[:2, -1] = agree[-1, -1] = 0.0
    assert np.abs(agree).max() < 0.012


def test_octaves_are_independent(rng: np.random.Generator) -> None:
    p = rng.uniform(-500, 500, (40_000, 3)) * [1, 1, 0]
    octaves = np.stack([noise(p, level) for level in range(6)])
    assert np.abs(np.corrcoef(octaves) - np.eye(6)).max() < 0.03


@pytest.mark.parametrize("planar", [True, False])
def test_the_variance_is_one_everywhere_in_a_cell(rng: np.random.Generator, planar: bool) -> None:
    whole = rng.integers(-(2**20), 2**20, (30_000, 3)).astype(float)
    for inside in ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5), (0.2, 0.9, 0.5)):
        values = noise(whole + inside, 0, planar=planar)
        assert values.var() == pytest.approx(1.0, abs=0.03)
        assert values.mean() == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("moment", [0.0, 0.37])
def test_motion_keeps_mean_and_variance(rng: np.random.Generator, moment: float) -> None:
    p = rng.uniform(-500, 500, (30_000, 3))
    n = np.ones((len(p), 1))
    clock = n * [moment, 2 * moment]
    shares = n * [0.6, 0.4] * const.MOST_GRAIN / np.hypot(0.6, 0.4)
    motion = Motion(clock, 0 * clock, n * [1.0, 64.0] / (2 * const.MOST_GRAIN), shares)
    values = noise(p, 0, motion=motion)
    assert values.var() == pytest.approx(1.0, abs=0.04)
    assert values.mean() == pytest.approx(0.0, abs=0.03)


@pytest.mark.parametrize("seed", [0, 7])
@pytest.mark.parametrize(("shape", "side"), [((64, 96, 1), 16), ((32, 32, 24), 8)])
def test_each_part_has_as_many_bright_grains(
    shape: tuple[int, int, int], side: int, seed: int
) -> None:
    points: Floats = np.moveaxis(np.indices(shape), 0, -1).reshape(-1, 3).astype(float) - 32.0
    planar = shape[2] == 1
    values = noise(points, 0, planar=planar, sparse=True, seed=seed)
    bright = (values > 1.0).reshape(shape)
    parts = [range(0, n, side) for n in shape]
    counts = np.add.reduceat(bright.astype(int), parts[0], axis=0)
    counts = np.add.reduceat(counts, parts[1], axis=1)
    counts = np.add.reduceat(counts, parts[2], axis=2)
    grains = bright.size // counts.size
    assert (counts == grains // 128).all()
    # Places in a block are all used.
    taken = np.unique(points[bright.ravel()] % (side // 2), axis=0)
    assert len(taken) > 30


def test_no_place_is_dark_for_all_seeds() -> None:
    points = np.array([[0.0, 0.0, 0.0], [8.0, 0.0, 0.0]])
    found = [noise(points, 0, sparse=True, seed=seed) > 1.0 for seed in range(500)]
    assert np.any(found, axis=0).all()


@pytest.mark.parametrize("apart", [0.3, 0.7, 1.0, 2.5])
@pytest.mark.parametrize("samples", [5, 49])
def test_the_variance_of_a_sum_is_known(
    rng: np.random.Generator, apart: float, samples: int
) -> None:
    # A Hann kernel along straight lines in all directions, as in a fragment's path.
    k = np.arange(samples) - samples // 2
    weight = 0.5 + 0.5 * np.cos(2 * np.pi * k / (samples + 1))
    start, turn = rng.uniform(-5000, 5000, (8000, 3)), rng.uniform(0, 2 * np.pi, 8000)
    along = np.stack([np.cos(turn), np.sin(turn), 0 * turn], -1)
    total = sum(w * noise(start + n * apart * along, 0) for w, n in zip(weight, k, strict=True))
    squares = float((weight**2).sum())
    near = float((weight[1:] * weight[:-1]).sum()) / squares
    known = squares * float(np.ravel(shared(np.array([apart]), np.array([near])))[0])
    assert np.var(total) == pytest.approx(known, rel=0.08)


def test_the_variance_of_a_sum_is_that_of_its_series() -> None:
    # Bells of the noise and of the weights, over all samples beside one.
    apart, near = np.meshgrid([0.1, 0.35, 0.7, 1.0, 1.3, 4.0], [1e-9, 0.5, 0.9, 0.99, 0.9999])
    squares = np.arange(1, 60)[:, None, None] ** 2
    away = squares * apart**2
    terms = near**squares * np.exp(-away * (const.BELL + const.BELL_BEND * away))
    assert shared(apart, near) == pytest.approx(1 + 2 * terms.sum(axis=0), rel=3e-3)


def test_the_mixture_of_neighbouring_octaves_has_the_grain_of_either(
    rng: np.random.Generator,
) -> None:
    p = rng.uniform(-2000, 2000, (60_000, 3)) * [1, 1, 0]
    turn = rng.uniform(0, 2 * np.pi, len(p))
    step = 0.65 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], -1)
    found = []
    for late in (0.0, 0.25, 0.5, 0.75, 1.0):
        # The wanted grain is 1, so the finer octave is the smaller by how late it is.
        scale = 2.0 ** (late / 2)
        here, there = (
            (1 - late) * noise(q * scale, 0) + late * noise(q * scale, 1) for q in (p, p + step)
        )
        found.append(np.corrcoef(here, there)[0, 1])
    assert max(found) - min(found) < 0.09  # octaves a factor of two apart: 0.2
    assert 0.5 < np.mean(found) < 0.7
