"""Whole numbers as few bytes: differences of neighbours, planes of bytes, LZMA.

All arithmetic is of unsigned numbers that wrap, so what was taken apart is put together again
exactly. A negative number -n is written as 2n - 1 and another as 2n: small ones of either sign
have zeros in all bytes but the lowest, and bytes of one weight are written together.
"""

from __future__ import annotations

import lzma
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Reader", "Thinned", "Writer", "bits_each", "from_ordered", "ordered", "thinned"]

Ints = NDArray[Any]

#: Axes of (T, J, I), as bits, along which differences are tried: none, i, j, both, t, all.
AXES = (0, 1, 2, 3, 4, 7)
#: Bytes of one weight follow each other, so their neighbours tell more than their alignment. A
#: longer search for repeats takes three times as long and saves a hundredth.
FILTERS = [
    {
        "id": lzma.FILTER_LZMA2,
        "preset": 6,
        "lc": 4,
        "lp": 0,
        "pb": 0,
        "mf": lzma.MF_HC4,
        "nice_len": 64,
        "depth": 4,
    }
]


def ordered(values: NDArray[np.floating[Any]]) -> Ints:
    """Floats as unsigned numbers of the same size in the same order, NaN and signs of zero too."""
    bits = np.ascontiguousarray(values).view(f"u{values.dtype.itemsize}")
    top = bits.dtype.type(1 << (8 * bits.dtype.itemsize - 1))
    return np.asarray(np.where(bits & top, ~bits, bits | top))


def from_ordered(numbers: Ints, dtype: np.dtype[Any]) -> NDArray[Any]:
    """Floats of :func:`ordered` numbers."""
    top = numbers.dtype.type(1 << (8 * numbers.dtype.itemsize - 1))
    return np.asarray(np.where(numbers & top, numbers ^ top, ~numbers)).view(dtype)


@dataclass(frozen=True, eq=False)
class Thinned:
    """Numbers that are ready to be written.

    Attributes
    ----------
    cost
        Bits that they have from their first one on, in all.
    axes
        Axes along which neighbours were subtracted, as bits: 1 for i, 2 for j, 4 for t.
    folded
        The differences, small ones of either sign as small numbers.
    """

    cost: float
    axes: int
    folded: Ints


def thinned(numbers: Ints) -> Thinned:
    """Subtract neighbours along the axes where that leaves least.

    Parameters
    ----------
    numbers
        Unsigned, (..., T, J, I); fewer axes will do.
    """
    return min(
        (_tried(numbers, axes) for axes in AXES if _apply(axes, numbers)), key=lambda one: one.cost
    )


def _apply(axes: int, numbers: Ints) -> bool:
    """Whether an array has all of these axes, with more than one entry."""
    wanted = [bit for bit in range(3) if axes >> bit & 1]
    return all(bit < numbers.ndim and numbers.shape[-1 - bit] > 1 for bit in wanted)


def _tried(numbers: Ints, axes: int) -> Thinned:
    for bit in range(3):
        if axes >> bit & 1:
            numbers = np.diff(numbers, axis=-1 - bit, prepend=numbers.dtype.type(0))
    folded = _fold(numbers)
    return Thinned(float(np.log2(folded + 1.0).sum()), axes, folded)


def _summed(numbers: Ints, axes: int) -> Ints:
    for bit in reversed(range(3)):
        if axes >> bit & 1:
            numbers = np.cumsum(numbers, axis=-1 - bit, dtype=numbers.dtype)
    return numbers


def _fold(numbers: Ints) -> Ints:
    size = numbers.dtype.itemsize
    sign = (numbers.view(f"i{size}") >> (8 * size - 1)).view(numbers.dtype)
    return np.asarray((numbers << 1) ^ sign)


def _unfold(folded: Ints) -> Ints:
    one = folded.dtype.type(1)
    return np.asarray((folded >> one) ^ (~(folded & one) + one))


def _planes(folded: Ints) -> NDArray[np.uint8]:
    """Bytes by weight, (bytes, N), the lowest first."""
    little = np.ascontiguousarray(folded).astype(folded.dtype.newbyteorder("<"))
    return little.view(np.uint8).reshape(-1, folded.dtype.itemsize).T


def bits_each(folded: Ints) -> float:
    """Entropy of the numbers in bits: that of each of their bytes by itself, summed."""
    total = 0.0
    for plane in _planes(folded):
        share = np.bincount(plane, minlength=256) / plane.size
        share = share[share > 0]
        total -= float((share * np.log2(share)).sum())
    return total


class Writer:
    """Gathers arrays of numbers."""

    def __init__(self) -> None:
        self._arrays: list[NDArray[np.uint8]] = []

    def add(self, folded: Ints) -> None:
        """Write what :func:`thinned` returned."""
        self._arrays.append(_planes(folded))

    def packed(self) -> bytes:
        """Return all as bytes."""
        most = max((len(planes) for planes in self._arrays), default=0)
        data = b"".join(
            planes[k].tobytes() for k in range(most) for planes in self._arrays if k < len(planes)
        )
        return lzma.compress(data, format=lzma.FORMAT_XZ, filters=FILTERS)


class Reader:
    """Gives arrays back in the order in which they were written.

    Parameters
    ----------
    data
        What :meth:`Writer.packed` returned.
    arrays
        Bytes of a number, and shape, of each array.

    Raises
    ------
    ValueError
        When the bytes do not hold these arrays.
    """

    def __init__(self, data: bytes, arrays: list[tuple[int, tuple[int, ...]]]) -> None:
        counts = [int(np.prod(shape, dtype=np.int64)) for _, shape in arrays]
        expected = sum(size * n for (size, _), n in zip(arrays, counts, strict=True))
        stream = lzma.LZMADecompressor(lzma.FORMAT_XZ)
        try:
            # A stream that would grow beyond what is expected is not followed.
            raw = stream.decompress(data, expected + 1)
        except lzma.LZMAError as error:
            msg = f"the compressed part is damaged: {error}"
            raise ValueError(msg) from error
        if len(raw) != expected or not stream.eof or stream.unused_data:
            msg = f"the compressed part holds {len(raw)} bytes; expected a whole one of {expected}"
            raise ValueError(msg)
        buffers = [
            np.empty((n, size), np.uint8) for (size, _), n in zip(arrays, counts, strict=True)
        ]
        start = 0
        for k in range(max((size for size, _ in arrays), default=0)):
            for buffer, n in zip(buffers, counts, strict=True):
                if k < buffer.shape[1]:
                    buffer[:, k] = np.frombuffer(raw, np.uint8, n, start)
                    start += n
        self._arrays = self._read(buffers, arrays)

    @staticmethod
    def _read(
        buffers: list[NDArray[np.uint8]], arrays: list[tuple[int, tuple[int, ...]]]
    ) -> Iterator[Ints]:
        for buffer, (size, shape) in zip(buffers, arrays, strict=True):
            yield buffer.view(f"<u{size}").astype(f"u{size}").reshape(shape)

    def next(self, axes: int) -> Ints:
        """Return the next array; ``axes`` are those of its differences."""
        return _summed(_unfold(next(self._arrays)), axes)
