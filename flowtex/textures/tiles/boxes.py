"""Nested boxes of about as many nodes each, and the triangles that reach into them.

A k-d tree divides space at medians, along the longest side of its content. Two cuts after another
make 2 x 2 boxes of one, in rows and columns, so that boxes of a depth are a square of blocks as
those of a structured surface are. A box holds all of its space: its outer sides are open.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats, Indices


class Boxes:
    """Boxes from ``steps`` divisions, each of one box into 2 x 2, at medians of points (N, 3).

    Boxes of a depth are numbered in the order of their cuts: the last two bits of a number are row
    and column in the parent box, the two before those of the parent in its own.
    """

    def __init__(self, points: Floats, steps: int) -> None:
        self.steps = steps
        self.axes = [np.zeros(1 << n, dtype=np.intp) for n in range(2 * steps)]
        self.values = [np.zeros(1 << n) for n in range(2 * steps)]
        parts = [np.arange(len(points))]
        for axes, values in zip(self.axes, self.values, strict=True):
            halves = []
            for n, part in enumerate(parts):
                axes[n], values[n] = _cut(points[part])
                ahead = points[part, axes[n]] >= values[n]
                halves += [part[~ahead], part[ahead]]
            parts = halves

    def places(self, steps: int) -> tuple[Indices, Indices]:
        """Return the row and column of each box of a depth, (4^steps,)."""
        number = np.arange(4**steps)
        bits = [(number >> 2 * n) & 3 for n in range(steps)]
        row = sum((b >> 1) << n for n, b in enumerate(bits))
        column = sum((b & 1) << n for n, b in enumerate(bits))
        return np.asarray(row), np.asarray(column)

    def members(self, low: Floats, high: Floats, steps: int) -> list[Indices]:
        """Return the numbers of the items from corners ``low`` to ``high``, (M, 3), in each box."""
        parts = [np.arange(len(low))]
        lows, highs = (np.ascontiguousarray(corner.T) for corner in (low, high))
        for axes, values in zip(self.axes[: 2 * steps], self.values, strict=False):
            halves = []
            for part, axis, value in zip(parts, axes, values, strict=True):
                halves += [part[lows[axis][part] < value], part[highs[axis][part] >= value]]
            parts = halves
        return parts

    def bounds(self, steps: int) -> tuple[Floats, Floats]:
        """Return lower and upper corners of the boxes of a depth, (4^steps, 3) each."""
        low, high = np.full((1, 3), -np.inf), np.full((1, 3), np.inf)
        for axes, values in zip(self.axes[: 2 * steps], self.values, strict=False):
            low, high = np.repeat(low, 2, axis=0), np.repeat(high, 2, axis=0)
            number = np.arange(len(axes))
            high[2 * number, axes] = values
            low[2 * number + 1, axes] = values
        return low, high


def _cut(points: Floats) -> tuple[int, float]:
    """Return axis and value of a cut, with points on both sides unless all coincide."""
    if not len(points):
        return 0, 0.0
    low, high = points.min(axis=0), points.max(axis=0)
    axis = int(np.argmax(high - low))
    along = points[:, axis]
    middle = float(np.partition(along, len(along) // 2)[len(along) // 2])
    if middle <= low[axis] < high[axis]:
        middle = float(along[along > middle].min())
    return axis, middle
