"""The finest level of a large field near a place; only the tiles there are read."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.derived.gradient import true_positions
from flowtex.field.earth.projection import Projection
from flowtex.field.finer import FinePart, Finest, finest_of
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.locate import EARTH, Locator
from flowtex.pyramid.source import RegionSource
from flowtex.textures.tiles.grid_levels import level_lines
from flowtex.textures.tiles.grid_pyramid import GridPyramid

LINES_AROUND = 6  #: Lines on each side of a place that are read.
NEAR_BORDER = 1.5  #: Distance in cells from the border of what is read, below which it is moved.
MOST_MOVES = 16  #: Most moves at one level.


class FinestOfLevels:
    """The finest level of a pyramid, found from the coarsest one level by level."""

    def __init__(
        self,
        pyramid: GridPyramid,
        coarse: FlowField,
        positions: Callable[..., tuple[Floats, Bools]],
        opened: Callable[[], FlowField],
    ) -> None:
        self._pyramid = pyramid
        self._positions = positions
        self._opened = opened
        # Not the field itself, which has this object.
        self._points = coarse.points
        self._known = coarse.has_position

    def __reduce__(self) -> tuple[Any, ...]:
        return _reopened, (self._opened,)

    @cached_property
    def _root(self) -> Locator:
        return _locator(self._points, self._known, self._pyramid.field.projection)

    def near(self, place: Floats) -> FinePart:
        """Return the nodes around a place (3,) in space, on the Earth on the globe."""
        pyramid = self._pyramid
        index = self._root.nearest(place[None])[0][0]
        for level in range(pyramid.depth - 1, -1, -1):
            index = self._finer_index(index, level + 1)
            index = self._moved(index, level, place)
        rows, columns = self._lines(index, 0)
        part = pyramid.lines_at(0, rows, columns)
        return FinePart(part, lambda found: self._coarse_index((rows, columns), found))

    def _finer_index(self, index: Floats, level: int) -> Floats:
        """Return (j, i) of a level as the one of the next finer level."""
        finer = []
        for at, count in zip(index, self._pyramid.nodes, strict=True):
            finer.append(_renumbered(at, count, level, level - 1))
        return np.array(finer)

    def _coarse_index(
        self, lines: tuple[Indices, Indices], found: tuple[float, float]
    ) -> tuple[float, float]:
        """Return (j, i) in the coarsest level of one among lines of the finest."""
        index = []
        for numbers, at, count in zip(lines, found, self._pyramid.nodes, strict=True):
            number = np.interp(at, np.arange(len(numbers)), numbers)
            index.append(_renumbered(float(number), count, 0, self._pyramid.depth))
        return index[0], index[1]

    def _lines(self, index: Floats, level: int) -> tuple[Indices, Indices]:
        """Return the rows and columns around (j, i), also beyond the ends of a closed axis."""
        lines = []
        shape = self._pyramid.shape(level)
        closed = self._pyramid.field.periodic
        for at, count, is_closed in zip(index, shape, closed, strict=True):
            around = np.arange(-LINES_AROUND, LINES_AROUND + 2) + int(at)
            if not is_closed:
                around = around[(around >= 0) & (around < count)]
            elif len(around) >= count:
                around = np.arange(count)
            lines.append(around)
        return lines[0], lines[1]

    def _moved(self, index: Floats, level: int, place: Floats) -> Floats:
        """Return (j, i) of the point of a level that is nearest to a place, near another one."""
        shape = self._pyramid.shape(level)
        closed = self._pyramid.field.periodic
        for _ in range(MOST_MOVES):
            lines = self._lines(index, level)
            inside = []
            for numbers, count, is_closed in zip(lines, shape, closed, strict=True):
                if is_closed:
                    numbers = numbers % (count - 1)
                inside.append(numbers)
            points = self._positions(level, *inside)[0]
            finder = _locator(points, None, self._pyramid.field.projection)
            found = finder.nearest(place[None])[0][0]
            index = np.array([line[0] for line in lines]) + found
            ends = np.array([len(line) - 1 for line in lines])
            is_near = (found < NEAR_BORDER) | (found > ends - NEAR_BORDER)
            borders = (index <= NEAR_BORDER) | (index >= np.array(shape) - 1 - NEAR_BORDER)
            if not (is_near & (~borders | np.array(closed))).any():
                break
        return index


def _reopened(opened: Callable[[], FlowField]) -> Finest | None:
    """Return what reads the finest level of a field that is opened again."""
    return finest_of(opened())


def _locator(points: Floats, known: Bools | None, projection: Projection | None) -> Locator:
    """Return the locator of nodes (J, I, 3), also without data, on the globe or in space."""
    places = true_positions(points, projection)
    has_place: Bools = np.asarray(np.isfinite(places).all(axis=-1))
    if known is not None:
        has_place &= known
    return Locator(GridSurface(places, has_place, (False, False)))


def _renumbered(number: float, count: int, level: int, other: int) -> float:
    """Return the number of a line of a level, of ``count`` at the finest, in another level."""
    here = level_lines(count, level)
    there = level_lines(count, other)
    if number > len(here) - 1 or number < 0:
        turns = np.floor(number / (len(here) - 1))
    else:
        turns = 0.0
    within = number - turns * (len(here) - 1)
    finest = np.interp(within, np.arange(len(here)), here)
    found = np.interp(finest, there, np.arange(len(there)))
    return float(found + turns * (len(there) - 1))


class FinestOfRegions:
    """All nodes of a dataset, for a field that has only some of its lines."""

    def __init__(self, source: RegionSource, coarse: FlowField) -> None:
        self._source = source
        self._lines = coarse_lines(coarse)

    def near(self, place: Floats) -> FinePart:
        """Return the nodes around a place (3,) in space, on the Earth on the globe."""
        lines = self._source.regions.lines
        x = float(place[0])
        y = float(place[1])
        period = np.inf
        if lines.projection is not None:
            x, y = map(float, EARTH.lonlat(place))
            period = 360.0
        columns = _around(lines.a, x, period)
        rows = _around(lines.b, y, np.inf)
        part = self._part(rows, columns)
        places = lines.a[columns], lines.b[rows]

        def coarse_index(found: tuple[float, float]) -> tuple[float, float]:
            j = np.interp(found[0], np.arange(len(rows)), places[1])
            i = np.interp(found[1], np.arange(len(columns)), places[0])
            return _index_in(self._lines[1], float(j)), _index_in(self._lines[0], float(i))

        return FinePart(part, coarse_index)

    def _part(self, rows: Indices, columns: Indices) -> FlowField:
        """Return some rows and columns of the field, whose steps are read late."""
        kept_rows = slice(int(rows[0]), int(rows[-1]) + 1)
        kept_columns = slice(int(columns[0]), int(columns[-1]) + 1)
        return self._source.part(kept_rows, kept_columns, (False, False))


def coarse_lines(field: FlowField) -> tuple[Floats, Floats]:
    """Return longitudes or x of the columns of a field, and latitudes or y of its rows."""
    if field.projection is None:
        return field.points[0, :, 0], field.points[:, 0, 1]
    lon, lat = field.projection.lonlat(field.points)
    middle_row = field.shape[0] // 2
    middle_column = field.shape[1] // 2
    return lon[middle_row], lat[:, middle_column]


def _around(line: Floats, value: float, period: float) -> Indices:
    """Return the numbers of the lines around a value."""
    distance = line - value
    if np.isfinite(period):
        distance -= period * np.rint(distance / period)
    nearest = int(np.nanargmin(np.abs(distance)))
    first = max(nearest - LINES_AROUND, 0)
    return np.arange(first, min(nearest + LINES_AROUND + 1, len(line)))


def _index_in(line: Floats, value: float) -> float:
    """Return where a value is on a line that increases or decreases."""
    numbers = np.arange(len(line), dtype=float)
    order = np.argsort(line)
    return float(np.interp(value, line[order], numbers[order]))
