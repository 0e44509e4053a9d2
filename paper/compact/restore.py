"""Compressed slices as slices again."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.trace.slices import TraceSlices
from paper.compact.blocks import WAYS, histories, slope_coding
from paper.compact.coding import Bounded, Coding, Exact
from paper.compact.predict import Geometry
from paper.compact.residuals import Reader
from paper.compact.tables import layout, next_array

__all__ = ["checksum", "restored"]

Header = dict[str, Any]
Arrays = dict[str, NDArray[Any]]


def checksum(slices: Iterable[NDArray[Any]]) -> int:
    """Return a number that tells whether slices came out as they went in."""
    number = 0
    for one in slices:
        number = zlib.crc32(one.astype(one.dtype.newbyteorder("<")).tobytes(), number)
    return number


def restored(header: Header, main: bytes, rest: bytes) -> TraceSlices:
    """Put slices together from their header, the slices' part and the rest.

    Raises
    ------
    ValueError
        When the bytes are not what the header says, or exact slices fail their check.
    """
    reader = Reader(rest, [layout(row) for row in header["rest"]])
    arrays = {row[0]: next_array(reader, row) for row in header["rest"]}
    dtype = np.dtype(header["dtype"])
    shape = (2, *arrays["reach"].shape)
    size = dtype.itemsize if header["bound"] is None else np.dtype(np.uint32).itemsize
    numbers = [(size, shape)] * len(header["blocks"])
    reader = Reader(main, [*(layout(row) for row in header["beside"]), *numbers])
    beside = {row[0]: next_array(reader, row) for row in header["beside"]}
    coding = _codings(header, dtype, arrays, beside)
    slices = list(_slices(header, reader, coding, arrays, beside))
    if header["check"] is not None and checksum(slices) != header["check"]:
        msg = "the slices differ from those that were written: they are damaged"
        raise ValueError(msg)
    count = len(header["lags"])
    forward = np.stack(slices[count:], axis=1) if len(slices) > count else None
    return TraceSlices(
        lags=np.array(header["lags"]),
        times=np.array(header["times"]),
        parameter=str(header["parameter"]),
        displacement=np.stack(slices[:count], axis=1),
        forward=forward,
        forward_reach=arrays.pop("forward_reach", None),
        **arrays,
    )


def _codings(header: Header, dtype: np.dtype[Any], arrays: Arrays, beside: Arrays) -> Coding:
    """Coding of the slices; the rates at lag zero are put in their place."""
    if header["bound"] is None:
        return Exact(dtype)
    coding = Bounded(dtype, exponent=beside["exponent"])
    if header["shift"] is not None:
        slope = slope_coding(coding, int(header["shift"]))
        arrays["rate"] = slope.values(arrays["rate"], np.zeros(arrays["rate"].shape))
    return coding


def _slices(
    header: Header, reader: Reader, coding: Coding, arrays: Arrays, beside: Arrays
) -> Iterator[NDArray[Any]]:
    """Slices (T, J, I, 2), those backward first."""
    lags, times = np.array(header["lags"]), np.array(header["times"])
    geometry = Geometry.of(lags, arrays["unit"], times, arrays["nodes"], header["parameter"])
    reaches = (arrays["reach"], arrays.get("forward_reach"))
    rows, size = iter(header["blocks"]), 2 * arrays["reach"].size
    for side, history in enumerate(histories(geometry, arrays["rate"], reaches)):
        for number in range(side * len(lags), (side + 1) * len(lags)):
            way, axes = next(rows)
            left = np.ascontiguousarray(np.moveaxis(reader.next(int(axes)), 0, -1))
            found = coding.values(left, history.predict(WAYS[way]))
            first, last = np.searchsorted(beside["where"], [number * size, (number + 1) * size])
            where = beside["where"][first:last] - number * size
            found.reshape(-1)[where] = beside["raw"][first:last]
            history.add(found)
            yield found
