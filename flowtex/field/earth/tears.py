"""Where a map tears the Earth open, and lines that are cut there."""

from __future__ import annotations

from functools import partial

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.field.earth.projection import GLOBE, Projection

BENT = 0.05  #: A piece may be torn if it bends by more than this share of its length.
MOST_BENT = 0.2  #: Share beyond which it is torn, as along the outline of a map.
LEAST_TEAR = 0.02  #: Share of a torn piece that its tear is wide, at least.
HALVINGS = 14  #: Halvings of a piece in the search of a tear: to some 10 m on the Earth.


def tears(
    projection: Projection, first: Floats, last: Floats, *, straight: bool = False
) -> tuple[Bools, Floats, Floats]:
    """Find the pieces between longitudes and latitudes, (N, 2), that a map tears apart.

    A piece leads the shorter way around the Earth, or is ``straight`` as a great circle. Returns
    which pieces are torn, (N,), with ends on opposite sides of a map or one end outside it, and of
    these the shares just before and just after the tear, (T,).
    """
    place = partial(between, straight=straight)
    start = projection.positions(*place(first, last, np.full(len(first), 0.0)).T)
    middle = projection.positions(*place(first, last, np.full(len(first), 0.5)).T)
    stop = projection.positions(*place(first, last, np.full(len(first), 1.0)).T)
    length = np.linalg.norm(stop - start, axis=1)
    bend = np.linalg.norm(middle - (start + stop) / 2, axis=1)
    missing = np.isnan([start[:, 0], stop[:, 0]])
    torn = ~missing.all(axis=0) & ~(bend <= BENT * length)
    first = first[torn]
    last = last[torn]
    length = length[torn]
    bend = bend[torn]
    a = start[torn]
    b = stop[torn]
    low = np.zeros(len(first))
    high = np.ones(len(first))
    for _ in range(HALVINGS):
        half = (low + high) / 2
        m = projection.positions(*place(first, last, half).T)
        missing = np.isnan([a[:, 0], m[:, 0], b[:, 0]])
        to_low = np.linalg.norm(m - a, axis=1)
        to_high = np.linalg.norm(m - b, axis=1)
        is_low = np.where(missing.any(axis=0), missing[1] == missing[0], to_low < to_high)
        low = np.where(is_low, half, low)
        high = np.where(is_low, high, half)
        a = np.where(is_low[:, None], m, a)
        b = np.where(is_low[:, None], b, m)
    wide = ~(np.linalg.norm(b - a, axis=1) <= LEAST_TEAR * length) | (bend > MOST_BENT * length)
    torn[torn] = wide
    return torn, low[wide], high[wide]


def between(first: Floats, last: Floats, share: Floats, *, straight: bool) -> Floats:
    """Return places (N, 2) at shares, (N,), of pieces as in :func:`tears`."""
    share = share[:, None]
    if straight:
        globe = Projection(GLOBE)
        one = globe.positions(*first.T)
        other = globe.positions(*last.T)
        place = np.stack(globe.lonlat((1 - share) * one + share * other), axis=-1)
    else:
        steps = last - first
        steps[:, 0] = (steps[:, 0] + 180) % 360 - 180
        place = first + share * steps
    # The ends themselves may lie on a meridian where a map is torn.
    return np.where(share == 0, first, np.where(share == 1, last, place))
