"""Arrays by name inside compressed slices: floats exactly, and whole numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from paper.compact.residuals import Reader, Writer, from_ordered, ordered, thinned

__all__ = ["add_array", "layout", "next_array"]

#: Name, type, shape, and axes of the differences.
Row = list[Any]


def add_array(writer: Writer, name: str, array: NDArray[Any]) -> Row:
    """Write an array, and return the row that says how to read it.

    Components, the last axis of (..., J, I, 2), are written one after the other.
    """
    numbers = np.ascontiguousarray(np.moveaxis(array, -1, 0) if _parts(array.shape) else array)
    kept = ordered(numbers) if array.dtype.kind == "f" else numbers.view(_unsigned(array.dtype))
    found = thinned(kept)
    writer.add(found.folded)
    return [name, array.dtype.str, list(array.shape), found.axes]


def layout(row: Row) -> tuple[int, tuple[int, ...]]:
    """Bytes of a number and shape in which :func:`add_array` wrote it."""
    _, dtype, shape, _ = row
    return np.dtype(dtype).itemsize, _written(tuple(shape))


def next_array(reader: Reader, row: Row) -> NDArray[Any]:
    """Read the array of a row."""
    _, name, shape, axes = row
    dtype = np.dtype(name)
    if dtype.kind not in "fiu":
        msg = f"an array is said to be of type {name!r}; expected floats or whole numbers"
        raise ValueError(msg)
    numbers = reader.next(int(axes))
    native = dtype.newbyteorder("=")
    array = from_ordered(numbers, native) if dtype.kind == "f" else numbers.view(native)
    return np.ascontiguousarray(np.moveaxis(array, 0, -1) if _parts(tuple(shape)) else array)


def _parts(shape: tuple[int, ...]) -> bool:
    return len(shape) > 2 and shape[-1] == 2


def _written(shape: tuple[int, ...]) -> tuple[int, ...]:
    return (shape[-1], *shape[:-1]) if _parts(shape) else shape


def _unsigned(dtype: np.dtype[Any]) -> np.dtype[Any]:
    return np.dtype(f"u{dtype.itemsize}")
