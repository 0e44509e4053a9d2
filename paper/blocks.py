"""Means of blocks, as in mip levels."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import AnyArray


def block_means(data: AnyArray, factor: int, axis: int = 0) -> AnyArray:
    """Average blocks of ``factor`` x ``factor`` whole entries of (..., J, I, ...)."""
    rows, columns = (n // factor for n in data.shape[axis : axis + 2])
    whole = (*(slice(None),) * axis, slice(rows * factor), slice(columns * factor))
    before, after = data.shape[:axis], data.shape[axis + 2 :]
    blocks = data[whole].reshape(*before, rows, factor, columns, factor, *after)
    return np.asarray(blocks.mean(axis=(axis + 1, axis + 3)))
