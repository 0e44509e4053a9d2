"""Blocks of an array: their means, and work on large arrays by parts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flowtex._util.array_types import AnyArray, Floats

__all__ = ["block_means", "bounds", "row_blocks"]

#: Nodes of a block, so few that what is computed of them stays in a processor's cache.
BLOCK_NODES = 16384


def row_blocks(rows: int, columns: int) -> Iterator[slice]:
    """Yield slices of rows of a grid, of some thousand nodes each."""
    some = max(BLOCK_NODES // columns, 1)
    return (slice(first, min(first + some, rows)) for first in range(0, rows, some))


def bounds(points: Floats) -> Floats:
    """Least and greatest coordinates, (2, C), of points (..., C)."""
    ends = [points.min(axis=0), points.max(axis=0)]
    # One axis after the other: long rows are many times as fast as rows of C numbers.
    while ends[0].ndim > 1:
        ends = [ends[0].min(axis=0), ends[1].max(axis=0)]
    return np.stack(ends)


def block_means(data: AnyArray, factor: int, axis: int = 0) -> AnyArray:
    """Average blocks of ``factor`` x ``factor`` entries of (..., J, I, ...), with J on ``axis``.

    Lines that do not fill a block are dropped.
    """
    rows, columns = (n // factor for n in data.shape[axis : axis + 2])
    whole = (*(slice(None),) * axis, slice(rows * factor), slice(columns * factor))
    before, after = data.shape[:axis], data.shape[axis + 2 :]
    blocks = data[whole].reshape(*before, rows, factor, columns, factor, *after)
    return np.asarray(blocks.mean(axis=(axis + 1, axis + 3)))
