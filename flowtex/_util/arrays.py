"""Arrays: work on large arrays by parts, and products of vectors."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices

#: Nodes of a block, so few that what is computed of them stays in a processor's cache.
BLOCK_NODES = 16384
#: Points that are compared with as many others at once.
LONG_ROW = 64
#: Greatest range of keys, as a multiple of their number, that are looked up in a table.
MOST_SPARSE = 16


def row_blocks(rows: int, columns: int) -> Iterator[slice]:
    """Yield slices of rows of a grid, of some thousand nodes each."""
    height = max(BLOCK_NODES // columns, 1)
    for first in range(0, rows, height):
        yield slice(first, min(first + height, rows))


def even_runs(numbers: Indices) -> Iterator[slice]:
    """Yield numbers as slices, few where they lie evenly apart, as on both sides of a seam."""
    first = 0
    while first < len(numbers):
        steps = np.diff(numbers[first:])
        if len(steps):
            step = int(steps[0])
        else:
            step = 1
        changes = np.flatnonzero(steps != step)
        if len(changes):
            count = int(changes[0])
        else:
            count = len(steps)
        if step < 1 and count < 2:
            step = 1
            count = 0
        stop = int(numbers[first + count]) + step
        if stop >= 0:
            yield slice(int(numbers[first]), stop, step)
        else:
            yield slice(int(numbers[first]), None, step)
        first += count + 1


def bounds(points: Floats) -> Floats:
    """Return the least and greatest coordinates, (2, C), of points (..., C)."""
    count = points.shape[-1]
    flat = points.reshape(-1, count)
    # Long rows are many times as fast as rows of C numbers.
    in_rows = len(flat) // LONG_ROW * LONG_ROW
    rows = flat[:in_rows].reshape(-1, LONG_ROW * count)
    last = flat[in_rows:]
    ends = []
    for reduce in (np.minimum.reduce, np.maximum.reduce):
        parts = [last]
        if len(rows):
            parts.append(reduce(rows, axis=0).reshape(-1, count))
        ends.append(reduce(np.concatenate(parts), axis=0))
    return np.stack(ends)


def rows_where(values: AnyArray, chosen: Bools) -> AnyArray:
    """Return the rows (n, C) of values (..., C) at some places (...).

    A list of numbers is several times as fast as a mask. All rows are not copied.
    """
    rows = values.reshape(-1, values.shape[-1])
    if chosen.all():
        return rows
    return np.asarray(rows.take(np.flatnonzero(chosen), axis=0))


def is_nonzero(values: AnyArray) -> bool:
    """Return whether some value is neither zero nor NaN; it is often found in the first block."""
    flat = values.reshape(-1)
    return any(np.nan_to_num(flat[block]).any() for block in row_blocks(len(flat), 1))


def numbered(keys: Indices) -> tuple[Indices, Indices]:
    """Return different keys in their order, and for each key (n,) its number among these.

    Keys that fill much of their range are found in a table, in a third of the time of sorting.
    """
    low = int(keys.min(initial=0))
    span = int(keys.max(initial=0)) - low + 1
    if span > MOST_SPARSE * len(keys):
        found, number = np.unique(keys, return_inverse=True)
        return found, number
    at = keys - low
    is_there = np.zeros(span, dtype=bool)
    is_there[at] = True
    number = (np.cumsum(is_there) - 1)[at]
    return np.flatnonzero(is_there) + low, number


def first_places(number: Indices) -> Indices:
    """Return the first place of each number from 0 to the greatest, all of which are in (n,)."""
    first = np.empty(int(number.max(initial=-1)) + 1, dtype=np.intp)
    # Of the values that are written to one place, the last one stays.
    first[number[::-1]] = np.arange(len(number))[::-1]
    return first


def dot(one: Floats, other: Floats) -> Floats:
    """Return inner products of vectors (..., C), of shape (...).

    NumPy's sums over few components are slow, and threads of a matrix product wait for each other.
    """
    shape = one.shape[:-1]
    if one.shape != other.shape or math.prod(shape) <= BLOCK_NODES:
        return _dot(one, other)
    result = np.empty(shape, np.result_type(one, other))
    for block in row_blocks(len(one), math.prod(shape[1:])):
        result[block] = _dot(one[block], other[block])
    return result


def _dot(one: Floats, other: Floats) -> Floats:
    product = one * other
    result = product[..., 0]
    for component in range(1, product.shape[-1]):
        result = result + product[..., component]
    return np.asarray(result)


def cross(one: Floats, other: Floats) -> Floats:
    """Return cross products of vectors (..., 3), in a third of the time that NumPy's takes."""
    shape = np.broadcast_shapes(one.shape, other.shape)
    result = np.empty(shape, np.result_type(one, other))
    for axis in range(3):
        ahead = (axis + 1) % 3
        behind = (axis + 2) % 3
        result[..., axis] = one[..., ahead] * other[..., behind]
        result[..., axis] -= one[..., behind] * other[..., ahead]
    return result


def smoothstep(low: float, high: float, x: Floats) -> Floats:
    """Return a smooth step from 0 at ``low`` to 1 at ``high``."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))


def norm(vectors: Floats) -> Floats:
    """Return lengths of vectors (..., C), of shape (...)."""
    return np.sqrt(dot(vectors, vectors))
