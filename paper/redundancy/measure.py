"""Redundancy of trace slices, which the paper leaves to future work.

Measured is the entropy of what a prediction leaves of a slice, in bits for each number (each byte
of a number by itself, which is what a simple coder reaches):

alone
    from the slice itself: every entry from the entries beside it;
by_lag
    from slices of shorter lag at the same entry too;
by_neighbours
    also from these at the other entries and destination times that the paths pass.

All three may subtract neighbouring entries, and take the best of their ways, so the difference is
what the other slices add. The result depends on what counts: down to the last bit of a float,
most of which is the error of the integration, or within a bound.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex._util.array_types import Floats
from flowtex.trace.slices import TraceSlices
from paper.redundancy.prediction import BY_LAG, Predictor, SliceGrid
from paper.redundancy.residuals import (
    BoundedCoding,
    Coding,
    Differences,
    ExactCoding,
    differences,
    power_below,
)
from paper.redundancy.texels import TexelDensity

Values = NDArray[np.floating[Any]]

#: Share of the bound that the slope at lag zero may make up at the first lag.
RATE_SHARE = 1 / 8


@dataclass(frozen=True, eq=False)
class Redundancy:
    """Bits for each number of trace slices.

    Attributes
    ----------
    lags
        Lags of the slices, (M,).
    raw
        Bits of a number in memory.
    alone, by_lag, by_neighbours
        Bits that are left when the slice is predicted from itself, from shorter lags, and from
        all neighbours, (S, M): S is 1 for backward slices, and 2 with forward ones.
    decoded
        The slices as the predictions and what is left of each give them: the same bits, or
        within the bound.
    """

    lags: Floats
    raw: int
    alone: Floats
    by_lag: Floats
    by_neighbours: Floats
    decoded: TraceSlices

    @property
    def share(self) -> float:
        """Share of the bits left of a slice by itself that its neighbours predict."""
        alone = float(self.alone.mean())
        return 1 - float(self.by_neighbours.mean()) / alone if alone else 0.0

    @property
    def predicted(self) -> float:
        """Share of the bits in memory that are predicted."""
        return 1 - float(self.by_neighbours.mean()) / self.raw


def redundancy(
    slices: TraceSlices,
    bound: float | None = None,
    *,
    texels: ArrayLike = 1.0,
    periodic: tuple[bool, bool] = (False, False),
) -> Redundancy:
    """Measure how much of trace slices follows from their neighbours.

    Parameters
    ----------
    slices
        The slices; give them half precision to measure that.
    bound
        Error of a position that does not count, in texels of the noise, the way along i and that
        along j added; ``None`` to count every bit. Between two lags that double, interpolation
        adds an eighth at most.
    texels, periodic
        Texels per cell, and whether the (j, i) axis is periodic; see
        :class:`paper.redundancy.texels.TexelDensity`. Without a bound they do not count.

    Raises
    ------
    ValueError
        When the bound or a number of texels is not positive.
    """
    coding, grid = _coding(slices, bound, texels, periodic), SliceGrid.of(slices)
    rate = _rate(slices, coding)
    bits, decoded = [], []
    for sign, data, reach in (
        (-1.0, slices.displacement, slices.reach),
        (1.0, slices.forward, slices.forward_reach),
    ):
        if data is None or reach is None:
            continue
        predictor = Predictor(grid, sign * rate, reach)
        parts = list(_predicted(data, predictor, coding))
        bits.append([part[0] for part in parts])
        decoded.append(np.stack([part[1] for part in parts], axis=1))
    alone, by_lag, by_neighbours = np.moveaxis(np.minimum.accumulate(bits, axis=-1), -1, 0)
    return Redundancy(
        slices.lags,
        8 * slices.displacement.dtype.itemsize,
        alone,
        by_lag,
        by_neighbours,
        replace(slices, displacement=decoded[0], forward=(*decoded, None)[1]),
    )


def _coding(
    slices: TraceSlices, bound: float | None, texels: ArrayLike, periodic: tuple[bool, bool]
) -> Coding:
    dtype = slices.displacement.dtype
    if bound is None:
        return ExactCoding(dtype)
    if not 0 < bound < np.inf:
        msg = f"bound is {bound!r}; expected a positive number of texels, or None for every bit"
        raise ValueError(msg)
    # Half of it for either component, as the ways along both are added.
    density = TexelDensity(texels, slices, periodic).most(slices)
    return BoundedCoding(dtype, bound / 2 / density)


def _rate(slices: TraceSlices, coding: Coding) -> Floats:
    """Slope of the displacements at lag zero, no more precise than the bound makes of it."""
    if not isinstance(coding, BoundedCoding):
        return slices.rate
    width = coding.width * power_below(np.asarray(RATE_SHARE / slices.lags[0]))
    return np.asarray(np.rint(slices.rate / width) * width)


def _predicted(
    data: Values, predictor: Predictor, coding: Coding
) -> Iterator[tuple[list[float], Values]]:
    """Predict the slices (T, M, J, I, 2) of one side, from the shortest lag up.

    Yields
    ------
    bits
        Bits left for each number: alone, by lag, by all neighbours.
    decoded
        The slice as its prediction and what is left of it give it, (T, J, I, 2).
    """
    for lag in range(data.shape[1]):
        values = np.ascontiguousarray(data[:, lag])
        predictions = {way: predictor.predict(way) for way in predictor.ways()}
        numbers = {way: coding.encode(values, p) for way, p in predictions.items()}
        residuals = {way: _differences(n) for way, n in numbers.items()}
        alone = _differences(coding.encode(values, np.zeros(values.shape)))
        by_lag = _best([*(residuals[way] for way in residuals if way in BY_LAG), alone])
        best = min(residuals, key=lambda way: residuals[way].cost)
        decoded = coding.decode(numbers[best], predictions[best])
        escapes = coding.escapes(values, decoded)
        decoded.reshape(-1)[escapes] = values.reshape(-1)[escapes]
        predictor.add(decoded)
        yield [r.entropy for r in (alone, by_lag, _best([by_lag, residuals[best]]))], decoded


def _differences(numbers: NDArray[Any]) -> Differences:
    return differences(np.moveaxis(numbers, -1, 0))


def _best(candidates: list[Differences]) -> Differences:
    return min(candidates, key=lambda candidate: candidate.cost)
