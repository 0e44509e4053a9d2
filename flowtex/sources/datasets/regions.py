"""A dataset on lines of longitude and latitude, or of x and y, any region of which is read alone.

Properties of the whole are determined before: the two variables, the map, the order of its columns.
A region is then the same, bit for bit, in every process, and nothing else is read for it. It needs
only names of files, and arrays that are read late, so a process on another machine can read it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.blocks import even_runs
from flowtex.errors import FieldError
from flowtex.field.earth import Projection
from flowtex.field.grids.periodic import find_closure
from flowtex.field.steps import Nodes, typical_steps
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.inspection.limits import values_in
from flowtex.sources.maps.grid_map import (
    CYLINDERS,
    lines_on_map,
    projection_of,
    shown_positions,
    shown_rows,
)

if TYPE_CHECKING:
    import xarray as xr

#: Rows or columns, by numbers or as a slice.
Lines: TypeAlias = Indices | slice
#: Values beyond this are missing data, even without an attribute.
LARGEST_VALUE = 1e15


@dataclass(frozen=True, eq=False)
class RegionLines:
    """Places of the nodes: two lines of coordinates, and their numbers in the data."""

    a: Floats  #: Longitude of each column, (I,), or x.
    b: Floats  #: Latitude of each row, (J,), or y.
    rows: Indices  #: Numbers in the data.
    columns: Indices  #: Numbers in the data between which each column lies, (2, I).
    share: Floats  #: Share of the way from the first to the second, (I,).
    projection: Projection | None  #: The map; ``None`` in a plane.
    closed: bool  #: Whether the last column repeats the first.

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return len(self.rows), len(self.share)

    def points(self, rows: Lines, columns: Lines) -> Floats:
        """Return positions (J, I, 3) of some rows and columns."""
        a, b = np.broadcast_arrays(self.a[columns], self.b[rows][:, None])
        if self.projection is None:
            return np.stack([a, b, np.zeros(a.shape)], axis=-1)
        if self.projection.is_globe:
            return self.projection.positions(a, b)
        return shown_positions(self.projection, a, b)

    def vectors(self, u: Floats, v: Floats, rows: Lines, columns: Lines) -> Floats:
        """Return vectors (J, I, 3) of components at some rows and columns."""
        if self.projection is None:
            return np.stack([u, v, np.zeros(u.shape)], axis=-1)
        a, b = np.broadcast_arrays(self.a[columns], self.b[rows][:, None])
        return self.projection.vectors(a, b, u, v)


@dataclass(frozen=True)
class Words:
    """Names, units and times as in a :class:`FlowField`."""

    name: str
    length_unit: str
    times: Floats
    start: Any
    units: Mapping[str, str] = field(default_factory=dict)
    long_names: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Regions:
    """A dataset on lines of coordinates."""

    words: Words
    lines: RegionLines  #: Places of the nodes.
    #: Variables of the velocity, ([time,] row, column).
    components: tuple[xr.Variable, xr.Variable]
    factor: float  #: Their unit in m/s.
    mask: xr.Variable | None  #: Positive where there are data, (row, column).
    scalars: Mapping[str, xr.Variable]
    numbers: tuple[int, ...]  #: Time steps in the variables.

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the scalars, that of the speed on the Earth among them."""
        projection = self.lines.projection
        drawn = projection is not None and not projection.is_globe
        return (*self.scalars, "speed") if drawn else tuple(self.scalars)

    def nodes(self, step: int, rows: Lines, columns: Lines, valid: Bools | None = None) -> Nodes:
        """Read some rows and columns at a time step; ``valid`` is that of all, if known."""
        number = self.numbers[step]
        u, v = self._components(number, rows, columns)
        velocity = self.lines.vectors(u, v, rows, columns)
        finite = np.isfinite(velocity).all(axis=-1)
        if valid is None:
            valid = np.zeros_like(finite)
            for other in typical_steps(len(self.numbers)):
                if valid.all():  # the others are read only where a step has gaps
                    break
                if other != step:
                    a, b = self._components(self.numbers[other], rows, columns)
                    valid |= np.isfinite(self.lines.vectors(a, b, rows, columns)).all(axis=-1)
                else:
                    valid |= finite
        velocity[~(valid & finite)] = 0.0
        scalars = {k: self.read(s, number, rows, columns) for k, s in self.scalars.items()}
        if len(self.names) > len(scalars):
            scalars["speed"] = np.hypot(u, v)
        points = self.lines.points(rows, columns)
        return Nodes(points, valid, velocity, scalars)

    def _components(self, number: int, rows: Lines, columns: Lines) -> list[Floats]:
        parts = [self.read(part, number, rows, columns, self.factor) for part in self.components]
        if self.mask is None:
            return parts
        wet = self.read(self.mask, number, rows, columns) > 0
        return [np.where(wet, part, np.nan) for part in parts]

    def read(
        self, variable: xr.Variable, number: int, rows: Lines, columns: Lines, factor: float = 1.0
    ) -> Floats:
        """Return some rows and columns of a variable, at a number in it, times a factor."""
        step = variable[number] if variable.ndim > 2 else variable
        numbers, share = self.lines.columns[:, columns], self.lines.share[columns]
        values = _read(step, self.lines.rows[rows], numbers[0]) * factor
        if (moved := np.flatnonzero(share)).size:
            other = _read(step, self.lines.rows[rows], numbers[1][moved]) * factor
            values[:, moved] = (1 - share[moved]) * values[:, moved] + share[moved] * other
        return values


def _read(step: xr.Variable, rows: Indices, columns: Indices) -> Floats:
    below = []
    for first in even_runs(rows):
        beside = [step[first, second] for second in even_runs(columns)]
        # The reader may be a task of a cluster, which must not wait for other tasks.
        below.append([numbers_in(part.compute(scheduler="synchronous")) for part in beside])
    return np.concatenate([np.concatenate(parts, axis=1) for parts in below])


def region_lines(places: Places, name: str | None) -> RegionLines | None:
    """Return the places of nodes; ``None`` where regions cannot be read separately."""
    if not places.is_line or not all(_is_ordered(line) for line in places.lines):
        return None
    a, b = places.lines
    if not places.is_earth:
        ends = [np.broadcast_arrays(a, b[[0, -1], None]), np.broadcast_arrays(a[[0, -1], None], b)]
        grids = [np.stack([*pair, np.zeros(pair[0].shape)], axis=-1) for pair in ends]
        if any(find_closure(np.swapaxes(grid, 0, 1)).periodic for grid in grids):
            return None
        columns = np.tile(np.arange(len(a)), (2, 1))
        return RegionLines(a, b, np.arange(len(b)), columns, np.zeros(len(a)), None, closed=False)
    projection, _ = projection_of(places, name)
    if not (projection.is_globe or projection.family in CYLINDERS):
        return None
    lines = lines_on_map(places, projection)
    if not (np.isfinite(lines.lon).all() and np.isfinite(lines.lat).all()):
        return None
    kept = slice(None)
    if not projection.is_globe:
        kept = shown_rows(shown_positions(projection, lines.lon[:1], lines.lat[:, None]))
    closed, chosen = lines.periodic == "i", (lines.columns, lines.share)
    return RegionLines(lines.lon, lines.lat[kept], lines.rows[kept], *chosen, projection, closed)


def numbers_in(array: xr.DataArray | xr.Variable) -> Floats:
    """Return the values of a variable as float64; missing data are NaN."""
    values = values_in(array)
    if values.dtype.kind not in "fiub":
        msg = f"{getattr(array, 'name', 'a variable')!r} has type {values.dtype}; expected numbers"
        raise FieldError(msg)
    values = values.astype(float)
    # Fill values that no attribute names.
    values[np.abs(values) > LARGEST_VALUE] = np.nan
    return values


def _is_ordered(line: Floats) -> bool:
    steps = np.diff(line)
    return len(line) > 1 and bool((steps > 0).all() or (steps < 0).all())
