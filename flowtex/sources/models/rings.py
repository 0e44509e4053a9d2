"""Triangles between rings of latitude that go around the globe, without a search for neighbours."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats, Indices

#: Distance along the axis of the globe, in radii, up to which points lie on one ring.
SAME_RING = 1e-11
#: Fewest rings, and fewest points of a ring.
FEWEST = 3
#: Greatest gap in a ring as a multiple of the mean one.
MOST_UNEVEN = 1.01
#: Least radius of a ring, in radii of the globe.
SMALLEST = 1e-6


class Ring(NamedTuple):
    """Points around the globe, from west to east."""

    numbers: Indices  #: Numbers of the points.
    angles: Floats  #: Longitudes in radians, from 0 to 2 pi.


def whole_rings(p: Floats) -> list[Ring] | None:
    """Return the rings of unit vectors (N, 3), from the north; ``None`` for other points."""
    height = p[:, 2]
    order = np.argsort(-height, kind="stable")
    first = np.flatnonzero(np.diff(height[order]) < -SAME_RING) + 1
    if not FEWEST <= len(first) + 1 <= len(p) // FEWEST:
        return None
    angles = np.arctan2(p[:, 1], p[:, 0]) % (2 * np.pi)
    rings = []
    for numbers in np.split(order, first):
        numbers = numbers[np.argsort(angles[numbers], kind="stable")]
        ring = Ring(numbers, angles[numbers])
        if not _is_whole(ring, p):
            return None
        rings.append(ring)
    return rings


def _is_whole(ring: Ring, p: Floats) -> bool:
    """Return whether the points of a ring are even, and go around the globe."""
    count = len(ring.numbers)
    radius = np.hypot(*p[ring.numbers[0], :2])
    gaps = np.diff(ring.angles, append=ring.angles[0] + 2 * np.pi)
    most = MOST_UNEVEN * 2 * np.pi / count
    return bool(count >= FEWEST and radius > SMALLEST and 0 < gaps.min() <= gaps.max() <= most)


def join_rings(rings: list[Ring]) -> Indices:
    """Return triangles (M, 3) with outward normals that cover the globe.

    Parameters
    ----------
    rings
        At least two rings, from the north.
    """
    triangles = [_fan(rings[0].numbers)]
    for north, south in pairwise(rings):
        triangles.append(_above(north, south))
        triangles.append(_below(north, south))
    triangles.append(_fan(rings[-1].numbers)[:, ::-1])
    return np.concatenate(triangles)


def _fan(numbers: Indices) -> Indices:
    """Return the triangles inside a ring around a pole."""
    apex = np.full(len(numbers) - 2, numbers[0])
    return np.stack([apex, numbers[1:-1], numbers[2:]], axis=1)


def _above(north: Ring, south: Ring) -> Indices:
    """Return the triangles of the edges of the northern ring with the nearest southern points."""
    apex = south.numbers[_after(_middles(south), _middles(north), side="left")]
    return np.stack([north.numbers, apex, np.roll(north.numbers, -1)], axis=1)


def _below(north: Ring, south: Ring) -> Indices:
    """Return the triangles of the edges of the southern ring with the nearest northern points."""
    apex = north.numbers[_after(_middles(north), _middles(south), side="right")]
    return np.stack([south.numbers, np.roll(south.numbers, -1), apex], axis=1)


def _middles(ring: Ring) -> Floats:
    """Return the longitudes of the middles of edges, each from its point to the next one."""
    following = np.roll(ring.angles, -1)
    following[-1] += 2 * np.pi
    return np.asarray((ring.angles + following) / 2 % (2 * np.pi))


def _after(middles: Floats, at: Floats, side: Literal["left", "right"]) -> Indices:
    """Return the numbers of the points that follow the last middle before some longitudes."""
    order = np.argsort(middles, kind="stable")
    passed = np.searchsorted(middles[order], at, side=side)
    return np.asarray((order[passed - 1] + 1) % len(middles))
