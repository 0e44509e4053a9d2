"""Stores of other programs, of which each view reads the level that it needs.

Nodes of every level lie on lines of the finest one, as in a pyramid of flowtex. Their values come
from a level of the store that is at least as fine, by linear interpolation where its nodes lie
elsewhere, such as in the middle of four. ::

    finest    o  o  o  o  o  o  o  o  o
    coarser     x     x     x     x         means of two
    level 1   o     o     o     o     o     values between those means
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError, Notice, notify
from flowtex.field import FlowField
from flowtex.field.field_data import FINEST, OPENED, WHOLE_SHAPE
from flowtex.field.options import FieldOptions
from flowtex.field.steps import Nodes
from flowtex.pyramid.finest import FinestOfRegions
from flowtex.pyramid.places import PyramidError
from flowtex.pyramid.source import WHOLE_NODES, RegionSource, datasets_at, source_of
from flowtex.sources.datasets.values import Regions
from flowtex.sources.maps import Lines
from flowtex.sources.read_fields import field_of_dataset
from flowtex.textures.tiles.grid_levels import level_lines, level_shape
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.shared import attach_pyramid

#: Share of known values around a node from which on it has one.
LEAST_KNOWN = 0.5
#: Distance in cells beyond the last line of a level up to which values are extrapolated: the first
#: mean of two nodes lies half a cell inside.
MOST_BEYOND = 0.5
#: Ratio of the spacing of a level to that of the nodes that are wanted, up to which it suffices.
SAME_SPACING = 1.05


def open_other(place: str, options: FieldOptions) -> FlowField:
    """Open a store of another program as a field.

    Parameters
    ----------
    place
        A local folder or a URL.
    options
        Options of datasets.

    Returns
    -------
    FlowField
        The whole data, or the finest level with at most ``WHOLE_NODES`` nodes; pictures read finer
        ones where the view needs them.

    Raises
    ------
    FieldError
        When the store cannot be read, has no velocity or does not fit the options.
    ModuleNotFoundError
        When a package that reads the store is missing.
    """
    with _faults(place):
        name = Path(place).stem
        finest, *coarser = datasets_at(place, options)
        source = source_of(finest, name=name, **options.given)
        if not isinstance(source, RegionSource):
            return source.field
        if math.prod(source.shape) <= WHOLE_NODES:
            return field_of_dataset(finest, options, name=name)
        stored = [source]
        for dataset in coarser:
            level = _coarser_level(source, dataset, options)
            if level is not None:
                stored.append(level)
        return _field_of_levels(place, options, stored)


@contextmanager
def _faults(place: str) -> Iterator[None]:
    """Raise a PyramidError for errors of libraries, as where metadata or attributes are absurd."""
    try:
        yield
    except (FieldError, ImportError, KeyboardInterrupt):
        raise
    except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError, OSError) as error:
        raise PyramidError(
            f"{place} cannot be read: its content is invalid ({type(error).__name__}: {error}); "
            "check its metadata, or open it with xarray and pass the dataset"
        ) from error


def _coarser_level(
    finest: RegionSource, dataset: Any, options: FieldOptions
) -> RegionSource | None:
    """Return a coarser level; ``None`` for one that lacks times or scalars of the finest one."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)  # as those of the finest level
        source = source_of(dataset, **options.given)
    if not isinstance(source, RegionSource):
        return None
    is_smaller = math.prod(source.shape) < math.prod(finest.shape)
    has_times = np.array_equal(source.field.times, finest.field.times)
    if is_smaller and has_times and {*finest.scalars} <= {*source.scalars}:
        return source
    return None


def _field_of_levels(
    place: str, options: FieldOptions, stored: Sequence[RegionSource]
) -> FlowField:
    """Return the finest level of moderate size as a field, with a pyramid of all levels."""
    finest = stored[0]
    finer = []
    level = 0
    while math.prod(level_shape(finest.shape, level)) > WHOLE_NODES:
        finer.append(finest.with_regions(_regions_at(stored, level)))
        level += 1
    if math.prod(_source_at(stored, level).shape) > WHOLE_NODES:
        notify(
            f"{place} has no level of at most {WHOLE_NODES:,} nodes, so a view of the whole reads "
            f"all of its nodes; `flowtex pyramid {place} -o flow.zarr` builds a store with levels"
        )
    coarse = finest.with_regions(_regions_at(stored, level))
    rows, columns = coarse.shape
    field = coarse.part(np.arange(rows), np.arange(columns), finest.field.periodic)

    def pyramid(field: FlowField, parameter: str, lines: str) -> OtherPyramid:
        return OtherPyramid(finer, field, parameter, lines)

    attach_pyramid(field, pyramid)
    opened = partial(open_other, place, options)
    finest_nodes = FinestOfRegions(finest, field)
    field.__dict__.update({WHOLE_SHAPE: finest.shape, OPENED: opened, FINEST: finest_nodes})
    return field


def _source_at(stored: Sequence[RegionSource], level: int) -> RegionSource:
    """Return the coarsest level of a store whose nodes are as close as those of a level here."""
    for source in reversed(stored):
        spacing = math.sqrt(math.prod(stored[0].shape) / math.prod(source.shape))
        if spacing <= SAME_SPACING * 2**level:
            return source
    return stored[0]


def _regions_at(stored: Sequence[RegionSource], level: int) -> Regions:
    """Return the data at every 2^level-th line of the finest level of a store."""
    finest = stored[0].regions
    source = _source_at(stored, level).regions
    rows, columns = (level_lines(count, level) for count in stored[0].shape)
    lines = finest.lines.some(rows, columns)
    if source is finest:
        return replace(finest, lines=lines)
    return ResampledRegions(
        finest.words, lines, finest.values, source.factor, finest.scalars, source=source
    )


@dataclass(frozen=True, eq=False)
class ResampledRegions(Regions):
    """Nodes whose values are interpolated between those of a ``source`` with other nodes."""

    source: Regions

    def components(self, step: int, rows: Lines, columns: Lines) -> tuple[Floats, Floats]:
        """Return the components of some rows and columns, NaN where there are no data."""
        place = self._place(rows, columns)
        u, v = self.source.components(step, *place.lines)
        return place.values(u), place.values(v)

    def scalar(self, name: str, step: int, rows: Lines, columns: Lines) -> Floats:
        """Return some rows and columns of a scalar."""
        place = self._place(rows, columns)
        return place.values(self.source.scalar(name, step, *place.lines))

    def _place(self, rows: Lines, columns: Lines) -> _Place:
        """Return where some nodes lie among those of the source."""
        lines = self.source.lines
        if lines.projection is None:
            period = np.inf
        else:
            period = 360.0
        return _Place(
            _beside(lines.b, self.lines.b[rows], np.inf),
            _beside(lines.a, self.lines.a[columns], period),
        )


class _Beside(NamedTuple):
    """Where values lie between the lines of an axis that are read."""

    lines: Indices  #: Numbers of the lines that are read, (L,).
    one: Indices  #: Of two lines beside each value, the places among these, (N,).
    other: Indices
    share: Floats  #: Share of the way from one to the other, (N,).

    def between(self, values: Floats, axis: int) -> Floats:
        """Return what lies between values of the lines that are read."""
        share = np.expand_dims(self.share, 1 - axis)
        one = np.take(values, self.one, axis)
        other = np.take(values, self.other, axis)
        return np.asarray((1 - share) * one + share * other)


class _Place(NamedTuple):
    """Where nodes lie between rows and columns of other nodes."""

    rows: _Beside
    columns: _Beside

    @property
    def lines(self) -> tuple[Indices, Indices]:
        """Rows and columns that are read."""
        return self.rows.lines, self.columns.lines

    def values(self, read: Floats) -> Floats:
        """Return values at the nodes from those that are read; NaN where most are missing."""
        known = np.isfinite(read)
        total = self._between(np.where(known, read, 0.0))
        if known.all():
            return total
        share = self._between(known.astype(float))
        has_value = share >= LEAST_KNOWN
        return np.where(has_value, total / np.where(has_value, share, 1.0), np.nan)

    def _between(self, values: Floats) -> Floats:
        return self.columns.between(self.rows.between(values, 0), 1)


def _beside(line: Floats, values: Floats, period: float) -> _Beside:
    """Return where values lie on a line, (M,), that increases or decreases and may have gaps.

    Values without a place get that of the first line.
    """
    numbers = np.flatnonzero(np.isfinite(line))
    numbers = numbers[np.argsort(line[numbers])]
    sorted_line = line[numbers]
    places = np.where(np.isfinite(values), values, sorted_line[0])
    if np.isfinite(period):
        middle = (sorted_line[0] + sorted_line[-1]) / 2
        places = middle + (places - middle + period / 2) % period - period / 2
    first = np.clip(np.searchsorted(sorted_line, places, "right") - 1, 0, len(numbers) - 2)
    start = sorted_line[first]
    share = (places - start) / (sorted_line[first + 1] - start)
    share = np.clip(share, -MOST_BEYOND, 1 + MOST_BEYOND)
    read, position = np.unique([numbers[first], numbers[first + 1]], return_inverse=True)
    one, other = position.reshape(2, -1)
    return _Beside(read, one, other, share)


class OtherPyramid(GridPyramid):
    """The levels of a store of another program: a coarse field, and finer levels, read in parts.

    Parameters
    ----------
    finer
        Levels that are finer than the field, the finest first.
    field
        The finest level that is in memory.
    parameter, lines
        As for :class:`~flowtex.textures.tiles.pyramid.Pyramid`.
    """

    def __init__(
        self, finer: Sequence[RegionSource], field: FlowField, parameter: str, lines: str
    ) -> None:
        self._finer = finer
        self._in_memory = GridPyramid(field, parameter, lines)
        depth = len(finer) + self._in_memory.depth
        super().__init__(field, parameter, lines, nodes=finer[0].shape, depth=depth)

    def _positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        nodes = self._nodes(level, rows, columns)
        return nodes.points, nodes.valid

    def _nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        if level < len(self._finer):
            return self._finer[level].late_nodes(rows, columns)
        return self._in_memory._nodes(level - len(self._finer), rows, columns)
