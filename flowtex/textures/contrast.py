"""How much the mip levels of a noise lose of its contrast.

Averaging over texels, and interpolating between them, takes the noise closer to its mean. The
deviation that is left at each level is measured once, so that a renderer can make up for it and
the contrast is the same at every level, whatever the noise.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats, Floats32, Indices

__all__ = ["HALF_LEVELS", "deviations"]


#: Deviations that a shader has room for: at every level and half-way to the next.
HALF_LEVELS = 32
#: Points at which the levels are looked up.
POINTS = 16_384
#: A level of fewer texels than this has too few to be judged by.
FEWEST = 256


def deviations(noise: Floats32) -> list[float]:
    """Return the deviation of a noise (H, W) as it is looked up at level n / 2, n = 0, 1, ...

    Between the texels of a level and between two levels the look-up is linear, and the noise
    goes around. Levels too coarse to be judged lose half from one to the next, as white noise.
    """
    at = np.random.default_rng(0).random((2, POINTS))
    level = noise.astype(np.float64)
    values, found = _bilinear(level, at), []
    while level.size >= 4 * FEWEST and min(level.shape) > 1:
        rows, columns = level.shape
        level = level.reshape(rows // 2, 2, columns // 2, 2).mean(axis=(1, 3))
        coarser = _bilinear(level, at)
        found += [float(values.std()), float((0.5 * (values + coarser)).std())]
        values = coarser
    found.append(float(values.std()))
    while len(found) < HALF_LEVELS:
        found.append(found[-1] / np.sqrt(2.0))
    return [max(value, 1e-6) for value in found[:HALF_LEVELS]]


def _bilinear(level: Floats, at: Floats) -> Floats:
    """Values at coordinates (2, N) from 0 to 1, texels in the middle of their squares."""
    rows, columns = level.shape
    (j0, j1, t), (i0, i1, s) = _around(at[0], rows), _around(at[1], columns)
    low = level[j0, i0] * (1 - s) + level[j0, i1] * s
    high = level[j1, i0] * (1 - s) + level[j1, i1] * s
    return np.asarray(low * (1 - t) + high * t)


def _around(x: Floats, count: int) -> tuple[Indices, Indices, Floats]:
    place = x * count - 0.5
    first = np.floor(place).astype(np.intp)
    return first % count, (first + 1) % count, place - first
