"""Differences from a prediction as integers, exactly or within a bound, and their entropy.

All arithmetic is of unsigned integers that wrap, so that nothing is lost. A negative number -n is
folded to 2n - 1 and another to 2n: small ones of either sign have zeros in all bytes but the
lowest.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Floats, Indices

#: Any precision of floats.
Values = NDArray[np.floating[Any]]

#: Share of the bound that is used, so that rounding does not exceed it.
BOUND_SHARE = 0.999
#: Widths of steps are powers of two with this many in an octave.
WIDTHS_PER_OCTAVE = 8
#: Number of steps from the prediction beyond which a value is stored as it is.
MAX_STEPS = 1 << 30
#: Axes of (T, J, I), as bits, along which differences are tried: none, i, j, both, t, all.
AXES = (0, 1, 2, 3, 4, 7)


class Coding(Protocol):
    """Takes the difference of values from their prediction to unsigned integers, and back."""

    def encode(self, values: Values, predicted: Floats) -> AnyArray:
        """Return unsigned integers of the values' shape."""

    def decode(self, numbers: AnyArray, predicted: Floats) -> Values:
        """Return the values of numbers."""

    def escapes(self, values: Values, decoded: Values) -> Indices:
        """Return flat indices of the values that have to be stored as they are."""


class ExactCoding:
    """Differences of the bits of floats, in the order of the numbers that they stand for.

    Parameters
    ----------
    dtype
        Floats of the values.
    """

    def __init__(self, dtype: np.dtype[Any]) -> None:
        self._dtype = dtype

    def encode(self, values: Values, predicted: Floats) -> AnyArray:
        """Return how many floats lie between value and prediction."""
        return np.asarray(_ordered(values) - self._rounded(predicted))

    def decode(self, numbers: AnyArray, predicted: Floats) -> Values:
        """Return the same bits again."""
        return _from_ordered(numbers + self._rounded(predicted), self._dtype)

    def escapes(self, values: Values, decoded: Values) -> Indices:
        """Return none."""
        del values, decoded
        return np.zeros(0, np.intp)

    def _rounded(self, predicted: Floats) -> AnyArray:
        largest = float(np.finfo(self._dtype).max)
        return _ordered(np.clip(predicted, -largest, largest).astype(self._dtype))


class BoundedCoding:
    """Whole numbers of steps, each twice as wide as the error that is allowed.

    Parameters
    ----------
    dtype
        Floats of the values.
    allowed
        Greatest error of each value, of a shape that values broadcast with.
    """

    def __init__(self, dtype: np.dtype[Any], allowed: Floats) -> None:
        self._dtype, self._allowed = dtype, allowed
        #: Widths of the steps.
        self.width = power_below(2 * BOUND_SHARE * allowed)

    def encode(self, values: Values, predicted: Floats) -> AnyArray:
        """Return the nearest numbers of steps; zero where a value is not finite or far off."""
        steps = np.zeros(values.shape)
        np.subtract(values, predicted, out=steps, where=np.isfinite(values), dtype=float)
        steps = np.rint(steps / self.width)
        steps[np.abs(steps) > MAX_STEPS] = 0
        return steps.astype(np.int32).view(np.uint32)

    def decode(self, numbers: AnyArray, predicted: Floats) -> Values:
        """Return the values that this many steps lead to."""
        values = predicted + numbers.view(np.int32) * self.width
        largest = float(np.finfo(self._dtype).max)
        return np.clip(values, -largest, largest).astype(self._dtype)

    def escapes(self, values: Values, decoded: Values) -> Indices:
        """Return those off by more than is allowed, and those that are not finite."""
        error = np.full(values.shape, np.inf)
        np.subtract(decoded, values, out=error, where=np.isfinite(values), dtype=float)
        return np.flatnonzero(np.abs(error) > self._allowed)


def power_below(width: Floats) -> Floats:
    """Round widths down to powers of two, eight of them in an octave."""
    exponent = np.floor(WIDTHS_PER_OCTAVE * np.log2(width))
    return np.asarray(np.exp2(exponent / WIDTHS_PER_OCTAVE))


@dataclass(frozen=True, eq=False)
class Differences:
    """Integers after neighbours were subtracted.

    Attributes
    ----------
    cost
        Bits of the numbers, each from its first one on, in all.
    folded
        The differences, small ones of either sign as small numbers.
    """

    cost: float
    folded: AnyArray

    @property
    def entropy(self) -> float:
        """Bits for each number: the entropy of each of its bytes by itself, summed."""
        little = np.ascontiguousarray(self.folded).astype(self.folded.dtype.newbyteorder("<"))
        total = 0.0
        for plane in little.view(np.uint8).reshape(-1, self.folded.dtype.itemsize).T:
            share = np.bincount(plane, minlength=256) / plane.size
            share = share[share > 0]
            total -= float((share * np.log2(share)).sum())
        return total


def differences(numbers: AnyArray) -> Differences:
    """Subtract neighbours along the axes where that leaves least.

    Parameters
    ----------
    numbers
        Unsigned, (..., T, J, I); fewer axes will do.
    """
    candidates = (_subtracted(numbers, axes) for axes in AXES if _has_axes(numbers, axes))
    return min(candidates, key=lambda candidate: candidate.cost)


def _has_axes(numbers: AnyArray, axes: int) -> bool:
    """Whether an array has all of these axes, with more than one entry."""
    bits = [bit for bit in range(3) if axes >> bit & 1]
    return all(bit < numbers.ndim and numbers.shape[-1 - bit] > 1 for bit in bits)


def _subtracted(numbers: AnyArray, axes: int) -> Differences:
    for bit in range(3):
        if axes >> bit & 1:
            numbers = np.diff(numbers, axis=-1 - bit, prepend=numbers.dtype.type(0))
    size = numbers.dtype.itemsize
    sign = (numbers.view(f"i{size}") >> (8 * size - 1)).view(numbers.dtype)
    folded = np.asarray((numbers << 1) ^ sign)
    return Differences(float(np.log2(folded + 1.0).sum()), folded)


def _ordered(values: Values) -> AnyArray:
    """Floats as unsigned integers of the same size in the same order, NaN and -0 too."""
    bits = np.ascontiguousarray(values).view(f"u{values.dtype.itemsize}")
    top = bits.dtype.type(1 << (8 * bits.dtype.itemsize - 1))
    return np.asarray(np.where(bits & top, ~bits, bits | top))


def _from_ordered(numbers: AnyArray, dtype: np.dtype[Any]) -> AnyArray:
    """Floats of :func:`_ordered` numbers."""
    top = numbers.dtype.type(1 << (8 * numbers.dtype.itemsize - 1))
    return np.asarray(np.where(numbers & top, numbers ^ top, ~numbers)).view(dtype)
