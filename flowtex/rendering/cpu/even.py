"""The local mean of a texture: ``shaders/common/even.glsl``."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.even import EvenBlocks


def local_mean(texture: Floats, grain: float) -> Floats:
    """Return the mean of a texture (H, W) around each pixel, for a grain in pixels.

    Row 0 is at the top, and NaN, off the surface, counts as zero.
    """
    height, width = texture.shape
    blocks = EvenBlocks.of(grain, (0, width, 0, height))
    # Blocks begin at the lower left.
    values = np.nan_to_num(texture[::-1])
    means = _weights(blocks, 1, height) @ values @ _weights(blocks, 0, width).T
    by_row = _interpolated(means, height, blocks.side)
    return _interpolated(by_row.T, width, blocks.side).T[::-1]


def _weights(blocks: EvenBlocks, axis: int, count: int) -> Floats:
    """Return the weights of pixels of a row or column in the means, (M, count)."""
    beyond = int(np.ceil(blocks.reach)) + blocks.side
    pixels = np.arange(-beyond, count + 2 * beyond) + 0.5
    middles = (np.arange(blocks.size[axis]) - 0.5) * blocks.side
    away = pixels - middles[:, None]
    weights = np.exp(-0.5 * away**2 / blocks.variance) * (np.abs(away) <= blocks.reach)
    weights /= weights.sum(axis=1, keepdims=True)
    return weights[:, beyond : beyond + count]


def _interpolated(means: Floats, count: int, side: int) -> Floats:
    """Return means (M, ...) of blocks, the first before the picture, at its pixels, (N, ...)."""
    at = (np.arange(count) + 0.5) / side + 0.5
    block = at.astype(int)
    part = (at - block)[:, None]
    return np.asarray((1.0 - part) * means[block] + part * means[block + 1])
