"""The values of the two components at a step: without missing data, and in one unit.

All choices are made before, so that any process reads any step and region by itself, the same bit
for bit. Only names of files, and arrays that are read late, are sent to it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import even_runs
from flowtex.errors import FieldError
from flowtex.field.grids.grid_nodes import find_closure
from flowtex.field.steps import Nodes, examined_steps, typical_steps
from flowtex.remedies import sentence
from flowtex.sources import maps
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.directions import in_components
from flowtex.sources.datasets.masks import DRAW_ALL, Mask, undeclared_fills, valid_range
from flowtex.sources.datasets.staggered import Sides, centred
from flowtex.sources.maps import Lines, NodeLines
from flowtex.sources.notices import Record, notify
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Numbers of rows and columns; ``None`` for all.
Chosen: TypeAlias = tuple[Indices, Indices] | None
#: Words for the share of a variable that has a fill value, by the value and the step.
FillWords: TypeAlias = dict[tuple[float, int], list[str]]
#: Values of a step that are examined.
MOST_EXAMINED = 4_000_000
#: Share of nodes without data at some times from which on a notice is issued.
NOTABLE_GAPS = 0.01
#: Lines of each of the nine parts of a larger one.
PART_LINES = 200
#: Values beyond this are missing data, even without an attribute.
LARGEST_VALUE = 1e15


def numbers_in(array: xr.DataArray | xr.Variable) -> Floats:
    """Return the values of a variable as float64; missing data are NaN.

    Raises
    ------
    FieldError
        When the values are not numbers.
    """
    values = values_in(array)
    if values.dtype.kind not in "fiub":
        raise FieldError(
            f"{getattr(array, 'name', 'a variable')!r} has type {values.dtype}; expected numbers"
        )
    values = values.astype(float)
    # Fill values that no attribute names.
    values[np.abs(values) > LARGEST_VALUE] = np.nan
    return values


def read_step(variable: xr.Variable, step: int, lines: Chosen = None, *, axes: int = 2) -> Floats:
    """Return a step of a variable ([time], ...) with this many axes, or some rows and columns."""
    if variable.ndim > axes:
        part = variable[step]
    else:
        part = variable
    if lines is None:
        return numbers_in(part)
    below = []
    for first in even_runs(lines[0]):
        beside = [part[first, second] for second in even_runs(lines[1])]
        # The reader may be a task of a cluster, which must not wait for other tasks.
        below.append([numbers_in(p.compute(scheduler="synchronous")) for p in beside])
    return np.concatenate([np.concatenate(parts, axis=1) for parts in below])


@dataclass(frozen=True, eq=False)
class Component:
    """A variable of the velocity, ([time], J, I) or ([time], N), and its valid values."""

    variable: xr.Variable
    factor: float  #: From its unit to the first component's unit, or to radians.
    valid: tuple[float, float] | None = None
    #: Values that mean missing data, though no attribute names them; ``None`` draws all values.
    fills: tuple[float, ...] | None = ()
    #: Further values of that kind at steps that were not examined at first.
    late_fills: dict[int, tuple[float, ...]] = field(default_factory=dict)
    name: str = ""

    def read(self, step: int, lines: Chosen, *, axes: int) -> Floats:
        """Return a step, with NaN for missing data."""
        values = read_step(self.variable, step, lines, axes=axes)
        with np.errstate(invalid="ignore"):
            for fill in (*(self.fills or ()), *self._late_fills(step, axes)):
                values[values == fill] = np.nan
            if self.valid is not None:
                values[(values < self.valid[0]) | (values > self.valid[1])] = np.nan
        return values * self.factor

    def sample(self, step: int, axes: int) -> Floats:
        """Return the values of a step to examine, (N,), without those known to be missing."""
        places = examined(self.variable, axes)
        parts = [read_step(self.variable, step, at, axes=axes).ravel() for at in places]
        flat = np.concatenate(parts)
        if self.valid is None:
            return flat
        return flat[~((flat < self.valid[0]) | (flat > self.valid[1]))]

    def _late_fills(self, step: int, axes: int) -> tuple[float, ...]:
        if self.fills is None:
            return ()
        if step not in self.late_fills:
            values = self.sample(step, axes)
            found = undeclared_fills(values, self.fills)
            if found and not any(self.late_fills.values()):
                words = [f"{np.mean(values == found[0]):.0%} of {self.name}"]
                text = sentence(masked_text(words, found[0], step), [DRAW_ALL])
                notify(text, [DRAW_ALL])
            self.late_fills[step] = found
        return self.late_fills[step]


def checked_component(
    array: xr.DataArray,
    factor: float,
    axes: int,
    wanted: Any,
    record: Record,
    fills_found: FillWords,
    *,
    limits: tuple[float, float] | None = None,
) -> Component:
    """Return a component without values that are no data, as its steps and attributes tell.

    Values outside the ``limits`` are codes, if no attribute declares a range. ``fills_found``
    receives the words for undeclared fill values.
    """
    part = Component(array.variable, factor, valid_range(array) or limits, name=str(array.name))
    sample = [read_step(part.variable, 0, at, axes=axes) for at in examined(array, axes)]
    flat = np.concatenate([values.ravel() for values in sample])
    if unknown := np.isnan(flat).mean():
        record("mask", f"{unknown:.0%} of {array.name} is missing")
    if part.valid is not None:
        outside = (flat < part.valid[0]) | (flat > part.valid[1])
        if outside.any():
            ends = f"{part.valid[0]:.6g} to {part.valid[1]:.6g}"
            record("mask", f"{outside.mean():.0%} of {array.name} masked: outside {ends}")
    if wanted is False:
        return replace(part, fills=None)
    fills: tuple[float, ...] = ()
    steps = steps_to_examine(array.variable, axes)
    for step in steps:
        values = part.sample(step, axes)
        found = undeclared_fills(values, fills)
        fills += found
        for fill in found:
            words = f"{np.mean(values == fill):.0%} of {array.name}"
            fills_found.setdefault((fill, step), []).append(words)
    return replace(part, fills=fills, late_fills=dict.fromkeys(steps, ()))


def record_fills(found: FillWords, record: Record) -> None:
    """Record undeclared fill values once for all components."""
    for (fill, step), words in found.items():
        record("mask", masked_text(words, fill, step), DRAW_ALL, notable=True)


def masked_text(words: list[str], fill: float, step: int) -> str:
    """Return the notice about an undeclared fill value in shares of variables at a step."""
    text = f"{' and '.join(words)} masked"
    if step:
        text += f" at step {step}"
    return f"{text}: {fill:g}, which is far from all other values, is taken as missing"


def steps_to_examine(variable: xr.Variable, axes: int) -> list[int]:
    """Return the steps of a variable that are examined; the first one of a task graph."""
    if variable.ndim == axes or variable.chunks is not None:
        return [0]
    return examined_steps(variable.shape[0], int(np.prod(variable.shape[1:])))


def examined(array: xr.DataArray | xr.Variable, axes: int) -> list[Any]:
    """Return rows and columns of a step to examine: all, or nine parts of a large one."""
    shape = array.shape[-axes:]
    if axes == 1 or np.prod(shape, dtype=float) <= MOST_EXAMINED:
        return [None]
    lines = []
    for n in shape:
        lines.append(
            [np.arange(n)[max(first, 0) :][:PART_LINES] for first in (0, n // 2, n - PART_LINES)]
        )
    found = []
    for rows in lines[0]:
        for columns in lines[1]:
            found.append((rows, columns))
    return found


@dataclass(frozen=True, eq=False)
class Values:
    """Reads both components at the nodes, in one unit."""

    components: tuple[Component, Component]
    kind: str  #: How the variables give the components, as in :class:`Pair`.
    axes: int = 2  #: Number of axes of the nodes.
    angle: Floats | None = None  #: Angle of polar components, (J, I).
    swapped: bool = False  #: Whether the second component is along the columns.
    masks: tuple[tuple[xr.Variable, Mask], ...] = ()  #: In the middle of cells.
    rows: Sides | None = None  #: Sides of cells on which the components lie.
    columns: Sides | None = None
    land: Bools | None = None  #: Cells that are land, (J, I).

    def read(self, step: int, lines: Chosen = None) -> tuple[Floats, Floats]:
        """Return the components at all nodes, or at some rows and columns."""
        u, v = (part.read(step, lines, axes=self.axes) for part in self.components)
        staggered = self.rows is not None or self.columns is not None
        u, v = centred(u, v, self.rows, self.columns)
        if staggered:  # near a wall only one of them may be known
            missing = np.isnan(u) & np.isnan(v)
            u = np.where(missing, np.nan, np.nan_to_num(u))
            v = np.where(missing, np.nan, np.nan_to_num(v))
        if self.swapped:
            u, v = v, u
        u, v = in_components(self.kind, u, v, self.angle)
        missing = np.isnan(u) | np.isnan(v)
        for variable, mask in self.masks:
            marks = read_step(variable, step, lines, axes=self.axes)
            missing |= ~mask.is_data(self.at_cells(marks))
        if self.land is not None:
            missing |= self.land
        u[missing] = v[missing] = np.nan
        return u, v

    def at_cells(self, values: Floats) -> Floats:
        """Return values in the middle of all cells where these have all sides."""
        if self.rows is not None:
            values = values[self.rows.cells]
        if self.columns is None:
            return values
        return values[:, self.columns.cells]


@dataclass(eq=False)
class LateGaps:
    """Reads the components of a step, and tells once where a late one lacks data.

    The nodes of the first step are compared with those of others when these are read.
    """

    read: Callable[[int], Floats]
    first: Bools | None = None  #: Nodes with data in the first step.
    is_told: bool = False

    def __call__(self, step: int) -> Floats:
        """Return the components of a step, (2, ...)."""
        values = self.read(step)
        known = np.asarray(np.isfinite(values).all(axis=0))
        if step == 0:
            self.first = known
        elif self.first is not None and not self.is_told:
            lacking = self.first & ~known
            if lacking.mean() >= NOTABLE_GAPS:
                self.is_told = True
                notify(gap_text(int(lacking.sum()), lacking.size, step))
        return values


def gap_text(count: int, size: int, step: int) -> str:
    """Return the notice about nodes that lack data at some steps."""
    return (
        f"{count:,} of {size:,} nodes lack data at some times, such as step {step}, when they are "
        "drawn without streaks"
    )


@dataclass(frozen=True, eq=False)
class Regions:
    """A dataset on lines of coordinates."""

    words: Mapping[str, Any]  #: Names, units and times, as arguments of a :class:`FlowField`.
    lines: NodeLines  #: Places of the nodes.
    values: Values  #: The velocity.
    factor: float  #: From its unit to the units of length and time.
    scalars: Mapping[str, xr.Variable]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the scalars, among them the speed on the Earth."""
        projection = self.lines.projection
        drawn = projection is not None and not projection.is_globe
        if drawn:
            return (*self.scalars, "speed")
        return tuple(self.scalars)

    def nodes(self, step: int, rows: Lines, columns: Lines, valid: Bools | None = None) -> Nodes:
        """Read some rows and columns at a time step; ``valid`` is that of all, if known."""
        u, v = self.components(step, rows, columns)
        velocity = self.lines.vectors(u, v, rows, columns) * self.factor
        finite = np.isfinite(velocity).all(axis=-1)
        if valid is None:
            valid = np.zeros_like(finite)
            for other in typical_steps(len(self.words["times"])):
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
        variable = self.scalars[name]
        return self._between(lambda at: [read_step(variable, step, at)], rows, columns)[0]

    def _between(self, read: Callable[[Any], Any], rows: Lines, columns: Lines) -> list[Floats]:
        """Return what is read of some rows and columns; those on the edge of a map lie between."""
        lines = self.lines
        chosen = lines.rows[rows]
        numbers = lines.columns[:, columns]
        share = lines.share[columns]
        parts = list(read((chosen, numbers[0])))
        if (moved := np.flatnonzero(share)).size:
            others = read((chosen, numbers[1][moved]))
            for part, other in zip(parts, others, strict=True):
                part[:, moved] = (1 - share[moved]) * part[:, moved] + share[moved] * other
        return parts


def region_lines(places: Places, name: str | None) -> NodeLines | None:
    """Return the places of nodes; ``None`` where regions cannot be read separately."""
    steps = [np.diff(line) for line in places.lines]
    ordered = all(len(s) and ((s > 0).all() or (s < 0).all()) for s in steps)
    if not places.is_line or not ordered:
        return None
    a, b = places.lines
    if not places.is_earth:
        ends = [np.broadcast_arrays(a, b[[0, -1], None]), np.broadcast_arrays(a[[0, -1], None], b)]
        grids = [np.stack([*pair, np.zeros(pair[0].shape)], axis=-1) for pair in ends]
        if any(find_closure(np.swapaxes(grid, 0, 1))[0] for grid in grids):
            return None
        columns = np.tile(np.arange(len(a)), (2, 1))
        return NodeLines(a, b, np.arange(len(b)), columns, np.zeros(len(a)), None, "")
    projection = maps.projection_of(places, name)
    if not (projection.is_globe or projection.family in maps.CYLINDERS):
        return None
    lines = maps.lines_on_map(places, projection)
    if not (np.isfinite(lines.a).all() and np.isfinite(lines.b).all()):
        return None
    if projection.is_globe:
        return lines
    kept = maps.shown_rows(maps.shown_positions(projection, lines.a[:1], lines.b[:, None]))
    return replace(lines, b=lines.b[kept], rows=lines.rows[kept])
