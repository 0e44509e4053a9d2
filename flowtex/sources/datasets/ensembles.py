"""The members of an ensemble as one velocity: their mean and their spread."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache

import numpy as np

from flowtex._util.array_types import Floats

#: The components u and v at the nodes, (J, I) each, of a step by its number.
Steps = Callable[[int], tuple[Floats, Floats]]
#: Steps whose sums are kept, as the mean and the spread use the same.
MOST_READ = 4


def mean_and_spread(members: Sequence[Steps]) -> tuple[Steps, Callable[[int], Floats]]:
    """Return functions that read the mean velocity of members, and their spread from 0 to 1.

    The spread is the standard deviation of the velocity, of both components together, over the
    length of its mean; it is 1 where that is more.
    """

    @lru_cache(MOST_READ)
    def sums(number: int) -> Floats:
        total = np.zeros(())
        for read in members:
            u, v = (np.asarray(part, dtype=float) for part in read(number))
            total = total + np.stack([u, v, u * u + v * v])
        return total / len(members)

    def mean(number: int) -> tuple[Floats, Floats]:
        u, v, _ = sums(number)
        return u, v

    def spread(number: int) -> Floats:
        u, v, square = sums(number)
        length = u * u + v * v
        with np.errstate(invalid="ignore", divide="ignore"):
            # Nodes at rest in all members have no spread.
            share = np.where(square > 0, np.sqrt(np.maximum(square / length - 1, 0)), 0.0)
        return np.where(np.isnan(square), np.nan, np.minimum(share, 1.0))

    return mean, spread
