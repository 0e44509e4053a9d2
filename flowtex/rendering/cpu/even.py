"""The local mean of a texture: ``shaders/common/even.glsl``."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import convolve1d

from flowtex._util.array_types import Floats
from flowtex.rendering.even import EvenBlocks


def local_mean(texture: Floats, grain: float) -> Floats:
    """Return the mean of a texture (H, W) around each pixel, for a grain in pixels.

    Row 0 is at the top, and NaN, off the surface, counts as zero.
    """
    height, width = texture.shape
    blocks = EvenBlocks.of(grain, (0, width, 0, height))
    side = blocks.side
    columns, rows = blocks.size
    padded = np.zeros((rows * side, columns * side))
    # Blocks begin at the lower left.
    padded[side : side + height, side : side + width] = np.nan_to_num(texture[::-1])
    means = padded.reshape(rows, side, columns, side).mean(axis=(1, 3))
    offsets = np.arange(-blocks.reach, blocks.reach + 1)
    weights = np.exp(-0.5 * offsets**2 / blocks.variance)
    weights /= weights.sum()
    for axis in (1, 0):
        means = convolve1d(means, weights, axis=axis, mode="constant")
    by_row = _interpolated(means, height, side)
    return _interpolated(by_row.T, width, side).T[::-1]


def _interpolated(means: Floats, count: int, side: int) -> Floats:
    """Return means (M, ...) of blocks, the first before the picture, at its pixels, (N, ...)."""
    at = (np.arange(count) + 0.5) / side + 0.5
    block = at.astype(int)
    part = (at - block)[:, None]
    return np.asarray((1.0 - part) * means[block] + part * means[block + 1])
