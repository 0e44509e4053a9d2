"""A dataset on lines of longitude and latitude, or of x and y, any region of which is read alone.

Properties of the whole are determined before: the two variables, the map, the order of its columns.
A region is then the same, bit for bit, in every process, and nothing else is read for it. It needs
only names of files, and arrays that are read late, so a process on another machine can read it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.arrays import Reading
from flowtex.field.earth import Projection
from flowtex.field.grids.periodic import find_closure
from flowtex.field.steps import Nodes, typical_steps
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.values import Values, read_step
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
    time_unit: str
    velocity_unit: str
    times: Floats
    start: Any
    reading: Reading
    units: Mapping[str, str] = field(default_factory=dict)
    long_names: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Regions:
    """A dataset on lines of coordinates."""

    words: Words
    lines: RegionLines  #: Places of the nodes.
    values: Values  #: The velocity.
    factor: float  #: From its unit to that of length and time.
    scalars: Mapping[str, xr.Variable]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the scalars, that of the speed on the Earth among them."""
        projection = self.lines.projection
        drawn = projection is not None and not projection.is_globe
        return (*self.scalars, "speed") if drawn else tuple(self.scalars)

    def nodes(self, step: int, rows: Lines, columns: Lines, valid: Bools | None = None) -> Nodes:
        """Read some rows and columns at a time step; ``valid`` is that of all, if known."""
        u, v = self.components(step, rows, columns)
        velocity = self.lines.vectors(u, v, rows, columns) * self.factor
        finite = np.isfinite(velocity).all(axis=-1)
        if valid is None:
            valid = np.zeros_like(finite)
            for other in typical_steps(len(self.words.times)):
                if valid.all():  # the others are read only where a step has gaps
                    break
                if other != step:
                    a, b = self.components(other, rows, columns)
                    valid |= np.isfinite(self.lines.vectors(a, b, rows, columns)).all(axis=-1)
                else:
                    valid |= finite
        velocity[~(valid & finite)] = 0.0
        scalars = {name: self.scalar(name, step, rows, columns) for name in self.scalars}
        if len(self.names) > len(scalars):
            scalars["speed"] = np.hypot(u, v)
        points = self.lines.points(rows, columns)
        return Nodes(points, valid, velocity, scalars)

    def components(self, step: int, rows: Lines, columns: Lines) -> tuple[Floats, Floats]:
        """Return the components of some rows and columns, NaN where there are no data."""
        u, v = self._between(partial(self.values.read, step), rows, columns)
        return u, v

    def scalar(self, name: str, step: int, rows: Lines, columns: Lines) -> Floats:
        """Return some rows and columns of a scalar."""
        return self._between(
            lambda lines: (read_step(self.scalars[name], step, lines),), rows, columns
        )[0]

    def _between(
        self,
        read: Callable[[tuple[Indices, Indices]], Sequence[Floats]],
        rows: Lines,
        columns: Lines,
    ) -> list[Floats]:
        """Return what is read of some rows and columns; those on the edge of a map lie between."""
        lines = self.lines
        chosen, numbers, share = lines.rows[rows], lines.columns[:, columns], lines.share[columns]
        parts = list(read((chosen, numbers[0])))
        if (moved := np.flatnonzero(share)).size:
            others = read((chosen, numbers[1][moved]))
            for part, other in zip(parts, others, strict=True):
                part[:, moved] = (1 - share[moved]) * part[:, moved] + share[moved] * other
        return parts


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


def _is_ordered(line: Floats) -> bool:
    steps = np.diff(line)
    return len(line) > 1 and bool((steps > 0).all() or (steps < 0).all())
