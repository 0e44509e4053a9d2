"""From values and what was predicted to whole numbers, and back: exactly, or within a bound."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from paper.compact.residuals import from_ordered, ordered

__all__ = ["Bounded", "Coding", "Exact"]

Floats = NDArray[np.float64]
Values = NDArray[np.floating[Any]]
Ints = NDArray[Any]

#: Share of the bound that rounding may not take up.
SAFE = 0.999
#: Steps are powers of two with this many in an octave.
FINE = 8
#: Steps off a prediction beyond which a value is kept as it is.
FAR = 1 << 30


class Coding(Protocol):
    """How the difference of values from their prediction is written as whole numbers."""

    def numbers(self, values: Values, predicted: Floats) -> Ints:
        """Unsigned numbers that wrap, of the values' shape."""

    def values(self, numbers: Ints, predicted: Floats) -> Values:
        """Values of numbers."""

    def missed(self, values: Values, restored: Values) -> NDArray[np.intp]:
        """Flat indices of the values that have to be kept as they are."""


class Exact:
    """Differences of the bits, in the order of the numbers that they stand for.

    Parameters
    ----------
    dtype
        Floats of the values.
    """

    def __init__(self, dtype: np.dtype[Any]) -> None:
        self._dtype = dtype

    def numbers(self, values: Values, predicted: Floats) -> Ints:
        """Return how many floats lie between."""
        return np.asarray(ordered(values) - self._rounded(predicted))

    def values(self, numbers: Ints, predicted: Floats) -> Values:
        """Return the same bits again."""
        return from_ordered(numbers + self._rounded(predicted), self._dtype)

    def missed(self, values: Values, restored: Values) -> NDArray[np.intp]:
        """Return none."""
        del values, restored
        return np.zeros(0, np.intp)

    def _rounded(self, predicted: Floats) -> Ints:
        most = float(np.finfo(self._dtype).max)
        return ordered(np.clip(predicted, -most, most).astype(self._dtype))


class Bounded:
    """Whole numbers of steps.

    Parameters
    ----------
    allowed
        Greatest error of each value, of a shape that values broadcast with.
    exponent
        Instead, what :attr:`exponent` was.
    dtype
        Floats of the values.
    """

    def __init__(
        self,
        dtype: np.dtype[Any],
        *,
        allowed: Floats | None = None,
        exponent: NDArray[np.int16] | None = None,
    ) -> None:
        if exponent is None:
            wide = 2 * SAFE * (np.ones(1) if allowed is None else allowed)
            exponent = np.floor(FINE * np.log2(wide)).astype(np.int16)
        #: Logarithm of the steps.
        self.exponent: NDArray[np.int16] = exponent
        self._allowed = np.full(1, np.inf) if allowed is None else allowed
        self._dtype = dtype
        self._step = np.exp2(exponent.astype(float) / FINE)

    def numbers(self, values: Values, predicted: Floats) -> Ints:
        """Return the nearest numbers of steps; zero where a value is no number or far off."""
        finite = np.isfinite(values)
        off = np.zeros(values.shape)
        np.subtract(values, predicted, out=off, where=finite, dtype=float)
        off = np.rint(off / self._step)
        off[np.abs(off) > FAR] = 0
        return off.astype(np.int32).view(np.uint32)

    def values(self, numbers: Ints, predicted: Floats) -> Values:
        """Return what so many steps lead to."""
        found = predicted + numbers.view(np.int32) * self._step
        most = float(np.finfo(self._dtype).max)
        return np.clip(found, -most, most).astype(self._dtype)

    def missed(self, values: Values, restored: Values) -> NDArray[np.intp]:
        """Return those off by more than is allowed, and those that are no numbers."""
        off = np.full(values.shape, np.inf)
        np.subtract(restored, values, out=off, where=np.isfinite(values), dtype=float)
        return np.flatnonzero(np.abs(off) > self._allowed)
