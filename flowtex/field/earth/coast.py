"""Lines of a user in place of the coasts of the package."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats

LONGEST_PIECE_DEGREES = 0.5  #: Longest piece of a line between two of its points.

SAME_PLACE_DEGREES = 1e-6  #: Distance up to which two ends of a line are one.
#: Share of the points in lines that close, from which on the lines are borders of land.
MOSTLY = 0.9


@dataclass(frozen=True, eq=False)
class Coast:
    """Lines on the Earth, which are drawn as the coasts unless they are hidden."""

    lonlat: Floats  #: Longitudes and latitudes in degrees, (N, 2).
    joined: Bools  #: Whether each point is joined to the next, (N - 1,).
    shown: bool = True
    is_closed: bool = False  #: Whether the lines close, so that land lies within them.

    @classmethod
    def of(cls, lines: list[Floats]) -> Coast:
        """Return the coast of lines (M, 2) of longitudes and latitudes, with short pieces."""
        fine = [with_short_pieces(line) for line in lines]
        lonlat = np.concatenate(fine)
        joined = np.ones(len(lonlat) - 1, dtype=bool)
        joined[np.cumsum([len(line) for line in fine])[:-1] - 1] = False
        # A piece that goes around the Earth crosses the date line.
        joined &= np.abs(np.diff(lonlat[:, 0])) < 180
        closed = [len(line) for line in lines if _ends_where_it_began(line)]
        is_closed = sum(closed) >= MOSTLY * sum(map(len, lines))
        return cls(lonlat, joined, is_closed=is_closed)

    @property
    def extent(self) -> Floats:
        """Least and greatest longitude and latitude, (2, 2)."""
        return np.stack([self.lonlat.min(axis=0), self.lonlat.max(axis=0)])

    def __bool__(self) -> bool:
        """Whether it is drawn."""
        return self.shown


def _ends_where_it_began(line: Floats) -> bool:
    return len(line) > 3 and bool(np.allclose(line[0], line[-1], atol=SAME_PLACE_DEGREES))


def with_short_pieces(line: Floats) -> Floats:
    """Return a line (M, 2) with points between those that are far from each other."""
    steps = np.abs(np.diff(line, axis=0)).max(axis=1)
    counts = np.maximum(np.ceil(steps / LONGEST_PIECE_DEGREES), 1)
    # Pieces across the date line are not drawn.
    counts[steps > 180] = 1
    places = np.append(0.0, np.cumsum(counts))
    fine = np.arange(places[-1] + 1)
    return np.stack([np.interp(fine, places, column) for column in line.T], axis=-1)
