"""Coastlines, meridians and parallels as lines on a globe or a flat map."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.field.earth.tears import between, tears

COASTS = Path(__file__).with_name("coastlines.npz")  #: File of the coastlines.
STEPS_PER_DEGREE = 100  #: Stored steps of a degree, as in tools/coastlines.py.
LONGEST_PIECE = 1.0  #: Longest piece of a line in degrees.
MOST_STRETCHED = 20.0  #: Scale beyond which a map has no lines: they go to infinity, as at a pole.
#: Least length of a thinned line in spacings: islands of that length are some pixels wide.
FEWEST_SPACINGS = 4
#: Possible spacings of a graticule in degrees.
STEPS = (30, 15, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
MOST_LINES = 6  #: Most graticule lines across a map.
#: Places along each side of the box where longitude and latitude are looked up.
LOOKS = {True: 25, False: 65}
FEWEST_PIECES = 8  #: Least pieces of a line between two that cross it.


@dataclass(frozen=True)
class MapLines:
    """Lines on a map."""

    points: Floats  #: Positions in metres, (N, 3).
    #: Where each line begins, (L + 1,): line k is ``points[starts[k]:starts[k + 1]]``.
    starts: Indices

    def and_(self, other: MapLines) -> MapLines:
        """Return these lines and the others."""
        starts = np.append(self.starts[:-1], other.starts + len(self.points))
        return MapLines(np.concatenate([self.points, other.points]), starts)

    def within(self, inside: Bools) -> MapLines:
        """Return the pieces with at least one end among some of the points, (N,)."""
        first = np.delete(np.arange(len(self.points)), self.starts[1:] - 1)
        first = first[inside[first] | inside[first + 1]]
        return _assembled(self.points[first], self.points[first + 1], first, first + 1)

    def thinned(self, spacing: float) -> MapLines:
        """Return lines with a point about every ``spacing`` metres, without small islands."""
        lines = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        steps = np.linalg.norm(np.diff(self.points, axis=0, prepend=self.points[:1]), axis=1)
        first = np.zeros(len(self.points), dtype=bool)
        first[self.starts[:-1]] = True
        along = np.cumsum(np.where(first, 0.0, steps))
        along -= along[self.starts[lines]]
        lengths = along[self.starts[1:] - 1]
        places = np.floor(along / spacing)
        keep = first | (np.diff(places, prepend=0.0) > 0)
        keep[self.starts[1:] - 1] = True
        keep &= lengths[lines] >= FEWEST_SPACINGS * spacing
        counts = np.bincount(lines[keep], minlength=len(lengths))
        return MapLines(self.points[keep], np.append(0, np.cumsum(counts[counts > 0])))


def coastlines(
    projection: Projection, box: Floats | None = None, coast: Coast | None = None
) -> MapLines:
    """Return the coasts of land, larger islands and lakes in a box of the map, (2, 3).

    The lines of a ``coast`` replace those of the package.
    """
    if coast is None:
        lonlat, joined = coast_points()
    else:
        lonlat = coast.lonlat
        joined = coast.joined
    return _mapped(projection, lonlat, joined, box)


def graticule(projection: Projection, box: Floats | None = None) -> MapLines:
    """Return meridians and parallels in a box, at round numbers of degrees."""
    lon, lat = _places(projection, box)
    if not len(lon):
        return MapLines(np.zeros((0, 3)), np.zeros(1, dtype=np.intp))
    steps = _steps(lon, lat)
    meridians = _grid_lines(lon, lat, steps, 0)
    parallels = _grid_lines(lon, lat, steps, 1)
    lonlat = np.concatenate([meridians[0], parallels[0]])
    joined = np.concatenate([meridians[1], parallels[1]])
    return _mapped(projection, lonlat, joined[:-1], box)


@cache
def coast_points() -> tuple[Floats, Bools]:
    """Return longitude and latitude of all coasts, and which points are joined to the next."""
    with np.load(COASTS, allow_pickle=False) as file:
        steps = file["steps"]
        lengths = file["lengths"]
    lonlat = np.cumsum(steps, axis=0, dtype=np.int16) / STEPS_PER_DEGREE
    joined = np.ones(len(lonlat) - 1, dtype=bool)
    joined[np.cumsum(lengths)[:-1] - 1] = False
    # Some islands are cut at the date line, which is not a coast.
    at_date_line = np.abs(lonlat[:, 0]) == 180
    joined &= ~(at_date_line[:-1] & at_date_line[1:])
    return lonlat, joined


def _steps(lon: Floats, lat: Floats) -> tuple[float, float]:
    """Choose the degrees between meridians and between parallels."""
    around = np.unique(lon)
    width = 360 - float(np.diff(around, append=around[0] + 360).max())
    height = float(np.ptp(lat))
    middle = math.radians(float(lat.max() + lat.min()) / 2)
    span = math.sqrt(height * width * math.cos(middle))
    # Meridians are closer to each other near a pole, and many of them would meet there.
    narrowest = max(math.cos(math.radians(float(np.abs(lat).max()))), 1e-3)
    return _step_for(span / narrowest), _step_for(span)


def _step_for(length: float) -> float:
    """Return the smallest step in degrees with which few enough lines lie in a length."""
    for step in reversed(STEPS):
        if length <= MOST_LINES * step:
            return step
    return STEPS[0]


def _places(projection: Projection, box: Floats | None) -> tuple[Floats, Floats]:
    """Return longitude and latitude of places all over a box."""
    if box is None:
        lon, lat = np.meshgrid(np.arange(-180.0, 180.0), np.arange(-89.5, 90.0))
        return lon.ravel(), lat.ravel()
    count = LOOKS[projection.is_globe]
    axes = []
    for low, high in box.T:
        if high > low:
            axes.append(np.linspace(low, high, count))
        else:
            axes.append(np.array([low]))
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    lon, lat = projection.lonlat(points)
    finite = np.isfinite(lon) & np.isfinite(lat)
    return lon[finite], lat[finite]


def _grid_lines(
    lon: Floats, lat: Floats, steps: tuple[float, float], kind: int
) -> tuple[Floats, Bools]:
    """Return meridians (0) or parallels (1) around places, and which points are joined."""
    order = slice(None, None, 1 - 2 * kind)
    degrees, along = (lon, lat)[order]
    step = steps[kind]
    length = steps[1 - kind]
    cells = np.unique(np.floor(degrees / step).astype(int))
    values = np.union1d(cells, cells + 1) * step
    if kind == 0:
        values = values[values < 180]
    else:
        values = values[np.abs(values) < 90]
    pieces = max(math.ceil(length / LONGEST_PIECE), FEWEST_PIECES)
    cells = np.unique(np.floor(along / length).astype(int)) * pieces
    marks = np.unique(cells[:, None] + np.arange(pieces + 1))
    places = marks / pieces * length
    if kind == 0:
        places = np.clip(places, -90, 90)
    joined = np.append(np.diff(marks) == 1, False)
    grid = np.stack(np.meshgrid(values, places, indexing="ij"), axis=-1)[..., order]
    return grid.reshape(-1, 2), np.tile(joined, len(values))


def _mapped(projection: Projection, lonlat: Floats, joined: Bools, box: Floats | None) -> MapLines:
    """Project lines, cut where the map is torn, in a box; ``joined`` marks joined points."""
    first, last, place = _pieces(lonlat, joined)
    torn, *sides = tears(projection, first, last)
    ends = first[torn], last[torn]
    before = between(*ends, sides[0], straight=False)
    after = between(*ends, sides[1], straight=False)
    # Both parts of a torn piece follow each other, and are joined to pieces that are not torn.
    gap = np.full(int(torn.sum()), np.nan)
    (left, right) = place[~torn].T
    (torn_left, torn_right) = place[torn].T
    order = np.argsort(np.concatenate([left, torn_left, torn_left]), kind="stable")
    first = np.concatenate([first[~torn], first[torn], after])
    last = np.concatenate([last[~torn], before, last[torn]])
    left = np.concatenate([left, torn_left, gap])
    right = np.concatenate([right, gap, torn_right])
    first = first[order]
    last = last[order]
    left = left[order]
    right = right[order]
    starts = projection.positions(*first.T)
    stops = projection.positions(*last.T)
    begin = Projection(GLOBE).positions(*first.T)
    end = Projection(GLOBE).positions(*last.T)
    length = np.linalg.norm(stops - starts, axis=1)
    true = np.linalg.norm(end - begin, axis=1)
    keep = length <= MOST_STRETCHED * true
    if box is not None:
        outside = ((starts < box[0]) & (stops < box[0])) | ((starts > box[1]) & (stops > box[1]))
        keep &= ~outside.any(axis=1)
    return _assembled(starts[keep], stops[keep], left[keep], right[keep])


def _pieces(lonlat: Floats, joined: Bools) -> tuple[Floats, Floats, Floats]:
    """Return both ends of short pieces of lines, (N, 2) each, and their places along lines."""
    index = np.flatnonzero(joined)
    start = lonlat[index]
    steps = lonlat[index + 1] - lonlat[index]
    steps[:, 0] = (steps[:, 0] + 180) % 360 - 180
    counts = np.maximum(np.ceil(np.abs(steps).max(axis=1) / LONGEST_PIECE).astype(int), 1)
    segment = np.repeat(np.arange(len(index)), counts)
    number = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
    part = np.stack([number, number + 1], axis=1) / counts[segment, None]
    first = start[segment] + steps[segment] * part[:, 0, None]
    last = start[segment] + steps[segment] * part[:, 1, None]
    return first, last, index[segment, None] + part


def _assembled(starts: Floats, stops: Floats, left: AnyArray, right: AnyArray) -> MapLines:
    """Join successive pieces, of which ``right`` of one is ``left`` of the next."""
    new = np.append(True, right[:-1] != left[1:])[: len(starts)]
    at = np.arange(len(starts)) + np.cumsum(new) - 1
    points = np.empty((len(starts) + int(new.sum()), 3))
    points[at + 1] = stops
    points[at] = starts
    return MapLines(points, np.append(at[new], len(points)))
