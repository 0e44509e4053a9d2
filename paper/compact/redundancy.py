"""How much of trace slices their neighbours tell: the redundancy of the paper's future work.

Measured is the entropy of what is left of a slice when it is predicted, in bits for each number
(each byte of a number counted by itself, which is what a simple coder reaches):

alone
    from the slice itself: every entry from the entries beside it;
by_lag
    from slices of shorter lags at the same entry too;
given
    also from these at the other entries and destination times that the paths come by.

All three may subtract entries beside each other, and take the best of their ways, so the
difference is what the neighbouring slices add. What is measured depends on what counts: down to
the last bit of a float, most of which is the error of the integration, or to a bound.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.trace.slices import TraceSlices
from paper.compact.blocks import Start
from paper.compact.coding import Coding
from paper.compact.predict import BY_LAG
from paper.compact.residuals import Thinned, bits_each, thinned

__all__ = ["Redundancy", "redundancy"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Redundancy:
    """Bits for each number of trace slices.

    Attributes
    ----------
    lags
        Lags of the slices, (M,).
    raw
        Bits of a number as it stands in memory.
    alone, by_lag, given
        Bits that are left when the slice is predicted from itself, from shorter lags, and from
        all neighbours, (S, M): S is 1 for backward slices, and 2 with forward ones.
    """

    lags: Floats
    raw: int
    alone: Floats
    by_lag: Floats
    given: Floats

    @property
    def share(self) -> float:
        """Share of the bits, beyond what a slice tells of itself, that its neighbours tell."""
        alone = float(self.alone.mean())
        return 1 - float(self.given.mean()) / alone if alone else 0.0

    @property
    def predicted(self) -> float:
        """Share of the bits in memory that need not be kept."""
        return 1 - float(self.given.mean()) / self.raw


def redundancy(
    slices: TraceSlices,
    bound: float | None = None,
    *,
    texels: ArrayLike = 1.0,
    periodic: tuple[bool, bool] = (False, False),
) -> Redundancy:
    """Measure what neighbouring slices tell of each other.

    Parameters
    ----------
    slices
        The slices; give them half precision to measure that.
    bound, texels, periodic
        As for :func:`paper.compact.compact`: errors within the bound do not count.

    Raises
    ------
    ValueError
        When the bound or a number of texels is not positive.
    """
    start = Start.of(slices, bound, texels, periodic)
    rows = []
    for data, blocks in zip(
        (slices.displacement, slices.forward), start.encoded(slices), strict=False
    ):
        if data is None:
            continue
        for lag, block in enumerate(blocks):
            alone = _alone(data[:, lag], start.coding)
            by_lag = min(
                (*(left for way, left in block.left.items() if way in BY_LAG), alone), key=_cost
            )
            given = min(by_lag, block.left[block.way], key=_cost)
            rows.append([bits_each(left.folded) for left in (alone, by_lag, given)])
    parts = np.array(rows).reshape(-1, len(slices.lags), 3)
    alone, by_lag, given = np.moveaxis(np.minimum.accumulate(parts, axis=-1), -1, 0)
    return Redundancy(slices.lags, 8 * slices.displacement.dtype.itemsize, alone, by_lag, given)


def _alone(values: NDArray[np.floating], coding: Coding) -> Thinned:
    values = np.ascontiguousarray(values)
    return thinned(np.moveaxis(coding.numbers(values, np.zeros(values.shape)), -1, 0))


def _cost(left: Thinned) -> float:
    return left.cost
