"""Lines of a grid at every level, and velocities averaged over the lines that are left out.

Level 0 has all nodes, level l every 2^l-th line of them and the last one.
"""

from __future__ import annotations

import math

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices

#: Most nodes, of one time, of a field that is traced whole.
ROOT_NODES = 100_000
ROWS = 256  #: Rows that are averaged together.


def root_level(nodes: tuple[int, int]) -> int:
    """Return the coarsest level of a field with this many nodes (J, I), which is traced whole."""
    level = 0
    while math.prod(level_shape(nodes, level)) > ROOT_NODES:
        level += 1
    return level


def level_shape(nodes: tuple[int, int], level: int) -> tuple[int, int]:
    """Return the number of nodes (J, I) of a level."""
    rows, columns = (len(level_lines(n, level)) for n in nodes)
    return rows, columns


def level_lines(count: int, level: int) -> Indices:
    """Return every 2^level-th of this many lines, and the last one."""
    lines = np.arange(0, count, 1 << level)
    if lines[-1] == count - 1:
        return lines
    return np.append(lines, count - 1)


def averaged(velocity: Floats, valid: Bools, rows: Indices, columns: Indices) -> Floats:
    """Return the velocity (J, I, C) at rows and columns, averaged with the lines beside them.

    Their numbers (3, N) are those of :func:`beside`. Weights are a quarter, a half and a
    quarter along each axis, of the nodes that are valid.
    """
    count = rows.shape[1], columns.shape[1]
    result = np.empty((*count, velocity.shape[2]))
    whole = bool(valid.all())
    for first in range(0, count[0], ROWS):
        block = rows[:, first : first + ROWS]
        # All lines of the block and those beside them, which follow each other.
        low = int(block.min())
        near = slice(low, int(block.max()) + 1)
        values = velocity[near]
        if whole:
            result[first : first + ROWS] = _mean_beside(values, block - low, columns)
            continue
        known = valid[near][..., None].astype(np.float64)
        total = _mean_beside(values * known, block - low, columns)
        weights = _mean_beside(known, block - low, columns)
        result[first : first + ROWS] = total / np.where(weights > 0, weights, 1.0)
    return result


def _mean_beside(values: Floats, rows: Indices, columns: Indices) -> Floats:
    """Return means (K, L, C) of values (J, I, C) at rows (3, K) and columns (3, L)."""
    for axis, lines in ((0, rows), (1, columns)):
        before, middle, after = (values.take(line, axis=axis) for line in lines)
        # In place: these are copies.
        middle *= 2
        middle += before
        middle += after
        middle *= 0.25
        values = middle
    return values


def beside(lines: Indices, count: int, *, closed: bool) -> Indices:
    """Return the numbers of lines and of those before and after, (3, N); a border repeats."""
    around = lines + np.array([[-1], [0], [1]])
    return np.asarray(np.mod(around, count - 1) if closed else np.clip(around, 0, count - 1))
