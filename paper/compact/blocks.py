"""Slice by slice through all of them: each as what its prediction from those before has left."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.trace.slices import TraceSlices
from paper.compact.coding import FINE, Bounded, Coding, Exact
from paper.compact.predict import BY_LAG, COMPOSED, Geometry, History
from paper.compact.residuals import Thinned, thinned
from paper.compact.texels import Texels

__all__ = ["WAYS", "Block", "Start", "encoded", "histories", "slope_coding"]

Floats = NDArray[np.float64]
Values = NDArray[np.floating[Any]]

#: Ways to predict, by the number that is written.
WAYS = (*BY_LAG, COMPOSED)
#: Share of the bound that the slope at lag zero may make up at the first lag.
SLOPE = 1 / 8


@dataclass(frozen=True, eq=False)
class Block:
    """One slice as it is written.

    Attributes
    ----------
    way
        How it was predicted.
    left
        What the prediction has left, for each way that was tried, (2, T, J, I).
    where, raw
        Entries that are kept as they are: flat indices in (T, J, I, 2), and their values.
    restored
        The slice as it will be read, (T, J, I, 2).
    """

    way: str
    left: dict[str, Thinned]
    where: NDArray[np.intp]
    raw: Values
    restored: Values


def encoded(data: Values, history: History, coding: Coding) -> Iterator[Block]:
    """Write the slices (T, M, J, I, 2) of one side, from the shortest lag up.

    Parameters
    ----------
    data
        The slices.
    history
        The state before the first one; every slice is added to it as it will be read.
    coding
        Exact, or within a bound.
    """
    for lag in range(data.shape[1]):
        values = np.ascontiguousarray(data[:, lag])
        predicted = {way: history.predict(way) for way in history.ways()}
        numbers = {way: coding.numbers(values, found) for way, found in predicted.items()}
        tried = {way: thinned(np.moveaxis(left, -1, 0)) for way, left in numbers.items()}
        way = min(tried, key=lambda name: tried[name].cost)
        restored = coding.values(numbers[way], predicted[way])
        where = coding.missed(values, restored)
        restored.reshape(-1)[where] = values.reshape(-1)[where]
        history.add(restored)
        yield Block(way, tried, where, values.reshape(-1)[where], restored)


def histories(geometry: Geometry, rate: Floats, reaches: Sequence[Values | None]) -> list[History]:
    """Return what is known of each side before its first slice: backward, and forward if any.

    Parameters
    ----------
    geometry
        Where and when the slices are.
    rate
        Derivative of the forward displacement by lag at lag zero, (T, J, I, 2).
    reaches
        Where paths end, (T, J, I), on each side.
    """
    pairs = zip((-1.0, 1.0), reaches, strict=True)
    return [History(geometry, sign * rate, reach) for sign, reach in pairs if reach is not None]


@dataclass(frozen=True, eq=False)
class Start:
    """How slices are going to be written.

    Attributes
    ----------
    coding
        Exact, or within a bound.
    slope
        The rates at lag zero as they are written, (T, J, I, 2): themselves, or in steps.
    rate
        The same as they will be read.
    shift
        Steps of the slope by those of the slices, as a difference of logarithms; ``None`` where
        it is written exactly.
    """

    coding: Coding
    slope: NDArray[Any]
    rate: Floats
    shift: int | None

    @classmethod
    def of(
        cls,
        slices: TraceSlices,
        bound: float | None,
        texels: ArrayLike,
        periodic: tuple[bool, bool],
    ) -> Start:
        """Decide it; see :func:`paper.compact.compact`."""
        dtype, rate = slices.displacement.dtype, slices.rate
        if bound is None:
            return cls(Exact(dtype), rate, rate, None)
        if not 0 < bound < np.inf:
            msg = f"bound is {bound!r}; expected a positive number of texels, or None for exact"
            raise ValueError(msg)
        # Half for either component, as the ways along both are added.
        allowed = bound / 2 / Texels(texels, slices, periodic).most(slices)
        coding = Bounded(dtype, allowed=allowed)
        shift = int(np.floor(FINE * np.log2(SLOPE / slices.lags[0])))
        own = slope_coding(coding, shift)
        numbers = own.numbers(rate, np.zeros(rate.shape))
        restored = own.values(numbers, np.zeros(rate.shape))
        if (
            not np.isfinite(rate).all()
            or (np.abs(restored - rate) * slices.lags[0] > SLOPE * allowed).any()
        ):
            return cls(coding, rate, rate, None)
        return cls(coding, numbers, np.asarray(restored, dtype=float), shift)

    def encoded(self, slices: TraceSlices) -> Iterator[Iterator[Block]]:
        """Write the slices of each side."""
        geometry = Geometry.of(
            slices.lags, slices.unit, slices.times, slices.nodes, slices.parameter
        )
        known = histories(geometry, self.rate, (slices.reach, slices.forward_reach))
        for data, history in zip((slices.displacement, slices.forward), known, strict=False):
            if data is not None:
                yield encoded(data, history, self.coding)


def slope_coding(coding: Bounded, shift: int) -> Bounded:
    """Coding of the slope at lag zero that goes with one of slices."""
    return Bounded(np.dtype(float), exponent=(coding.exponent + shift).astype(np.int16))
