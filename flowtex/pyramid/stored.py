"""A pyramid whose levels and tiles are read from a store."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError, Notice, notify
from flowtex.field import FlowField
from flowtex.field.field import OPENED, WHOLE_SHAPE
from flowtex.field.options import FieldOptions
from flowtex.field.steps import LazySteps, Nodes, Steps
from flowtex.field.uncertainty import spread_name
from flowtex.pyramid.layout import VELOCITY_BITS, About
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.places import PyramidError, ReadFault, fault_words, is_store, place_text
from flowtex.pyramid.source import WHOLE_NODES, RegionSource, datasets_at, periods_of, source_of
from flowtex.sources.datasets.read_datasets import read_datasets
from flowtex.sources.datasets.values import Regions
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.pyramid import (
    ROOT_NODES,
    Pyramid,
    TileKey,
    averaged,
    level_lines,
    root_level,
)
from flowtex.textures.tiles.shared import attach_pyramid

#: Nodes of a level may be so many times as far apart as those that are drawn.
WIDER = 1.5
#: Bytes of a chunk beyond which users have to wait.
SLOW_BYTES = 8_000_000
#: Nodes of the coarsest level beyond which users have to wait.
SLOW_NODES = 16 * ROOT_NODES
#: Bytes of the steps of a tile that are kept.
KEPT_BYTES = 64_000_000


def open_store(store: str | Path, *, uncertainty: Any = None, **options: Any) -> FlowField:
    """Open a pyramid in a store as a field.

    ``flowtex.render``, ``flowtex.show`` and the widget read only the tiles in view. The arrays of
    the field are those of the coarsest level.

    Parameters
    ----------
    store
        A local folder, or a URL: ``s3://bucket/path`` and other object storage, or ``https://``.
        Endpoint and credentials come from the environment. It may also be written by other
        programs: a multiscale group of xarray datasets, as of ndpyramid and topozarr, or a Zarr
        dataset.
    uncertainty
        As for :meth:`flowtex.FlowField.from_xarray`. A store that flowtex built uses the
        uncertainty with which it was built, and refuses another one.
    **options
        For stores of other programs: arguments of :meth:`flowtex.FlowField.from_xarray`, such as
        ``u``, ``v``, ``globe`` or ``level``.

    Returns
    -------
    FlowField

    Raises
    ------
    FieldError
        When the store contains no pyramid, or cannot be read.
    ModuleNotFoundError
        When a package that reads the store is missing; the text names the extra.

    Warns
    -----
    Notice
        When large chunks or missing coarse levels make the store of another program slow.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.open_store("gyre.zarr").shape
    (21, 41)
    """
    opened = partial(open_store, store, uncertainty=uncertainty, **options)
    if not is_store(store):
        given = {**options, "uncertainty": uncertainty}
        others = levels_of_others(place_text(store), FieldOptions.of_dataset(given))
        return others if isinstance(others, FlowField) else _field_of(others, opened)
    if options:
        raise FieldError(f"{', '.join(options)} applies to the source of a pyramid; omit it")
    levels = Levels(store)
    if not levels.about.get("levels_done"):
        raise PyramidError(
            f"{levels.place} is incomplete, and its coarsest level is missing; run "
            "flowtex.pyramid.build again to build the missing parts"
        )
    stored = levels.template.uncertainty
    requested = uncertainty if isinstance(uncertainty, str) else "an array"
    if uncertainty is not None and requested not in (stored, stored.removeprefix(spread_name(""))):
        raise FieldError(
            f"uncertainty is {requested}, but {levels.place} was built with {stored or 'none'}; "
            "set it when you build the store"
        )
    return _field_of(levels, opened)


def _field_of(levels: Levels | OtherLevels, opened: Callable[[], FlowField]) -> FlowField:
    """Return the coarsest level as a field that has the others."""
    root = root_of(levels)

    def pyramid(field: FlowField, parameter: str, lines: str) -> Pyramid:
        return StoredPyramid(levels, field, parameter, lines)

    attach_pyramid(root, pyramid)
    root.__dict__.update({WHOLE_SHAPE: tuple(levels.about["nodes"]), OPENED: opened})
    return root


def root_of(levels: Levels | OtherLevels) -> FlowField:
    """Return the coarsest level as a field."""
    pyramid = StoredPyramid(levels, levels.template)
    return pyramid.at_level(pyramid.depth)


class StoredPyramid(Pyramid):
    """The levels of a pyramid in a store, whose ``field`` is the coarsest of them."""

    def __init__(
        self,
        levels: Levels | OtherLevels,
        field: FlowField,
        parameter: str | None = None,
        lines: str | None = None,
    ) -> None:
        self._stored = levels
        #: The description of the field and its pyramid.
        self.about: About = levels.about
        about = self.about
        super().__init__(
            field,
            parameter or about["parameter"],
            lines or about["lines"],
            nodes=(about["nodes"][0], about["nodes"][1]),
            depth=about["depth"],
        )
        self.ranges = {
            (name, robust): (ends[0], ends[1])
            for name, both in (about.get("ranges") or {}).items()
            for robust, ends in zip((False, True), both, strict=True)
        }

    @cached_property
    def root(self) -> FlowField:
        """The field at the coarsest level."""
        return self.field

    @cached_property
    def periods(self) -> tuple[Floats, Floats]:
        """Vectors from the first line of an axis to the last, (3,), for both axes."""
        rows, columns = map(np.array, self.about["periods"])
        return rows, columns

    def tiles(
        self, keys: Sequence[TileKey], steps: Sequence[int]
    ) -> dict[TileKey, TextureSet | None]:
        """Return the textures of tiles; a PyramidError names data that cannot be read."""
        made = super().tiles(keys, steps)
        for key, textures in made.items():
            if textures is not None and isinstance(self._stored, Levels):
                self._check_nodes(self._stored, key, textures, steps)
        return made

    def _check_nodes(
        self, stored: Levels, key: TileKey, textures: TextureSet, steps: Sequence[int]
    ) -> None:
        """Raise a PyramidError where nodes of a tile are not those of the level above."""
        field, drawn = textures.geometry.field, textures.grid.drawn
        valid = field.valid[drawn]
        first = [at * self.about["tile_cells"] for at in key[1:]]
        above = [
            np.arange(a // 2 + 1, (a + n) // 2) for a, n in zip(first, valid.shape, strict=True)
        ]
        if not all(map(len, above)):
            return
        lines = [2 * line - a for line, a in zip(above, first, strict=True)]
        rows, columns = (line + np.array([[-1], [0], [1]]) for line in lines)
        at = np.ix_(*lines)
        coarse = stored.nodes(key.level + 1, *above, velocities=False)
        pairs = [(field.points[drawn][at], coarse.points), (valid[at], coarse.valid)]
        for name, values in coarse.scalars.items():
            fine = field.scalars[name]
            pairs += [(fine[t][drawn][at], values[t]) for t in steps if t < len(values)]
        for step in steps:
            velocity = stored.velocity(key.level + 1, step, *above)[coarse.valid]
            mean = averaged(np.asarray(field.velocity[step])[drawn], valid, rows, columns)
            pairs.append((mean[coarse.valid][:, : velocity.shape[-1]], velocity))
        if not all(_agree(values, reference) for values, reference in pairs):
            raise PyramidError(
                f"the nodes of tile {tuple(key)} of {stored.place} do not match those of the "
                "level above it; build the store again"
            )

    def _positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        return self._stored.positions(level, rows, columns)

    def _nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        return self._stored.nodes(level, rows, columns)


def _agree(values: AnyArray, reference: AnyArray) -> bool:
    """Return whether values are the same up to the rounding of stored velocities."""
    size = np.abs(np.nan_to_num(reference)).max(initial=0.0)
    return bool(np.allclose(values, reference, 2.0**-VELOCITY_BITS, 1e-6 * size, equal_nan=True))


def levels_of_others(place: str, options: FieldOptions) -> OtherLevels | FlowField:
    """Open a store of others; one that is small, or on curved lines, is a whole field."""
    datasets = datasets_at(place, options)
    name, arguments = Path(place).stem, options.given
    finest = source_of(datasets[0], name=name, **arguments)
    if not isinstance(finest, RegionSource):
        return finest.field
    if math.prod(finest.shape) <= WHOLE_NODES:
        return FlowField.from_xarray(datasets[0], name=name, **arguments)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Notice)  # those of the finest level were issued
        coarser = [
            read_datasets(d, replace(options, uncertainty=None), name=name, regions=True)
            for d in datasets[1:]
        ]
    sources = [RegionSource(part) for part in coarser if isinstance(part, Regions)]
    if len(sources) < len(coarser):
        raise FieldError(
            f"{place}: a coarser level is not on rows and columns, as the finest one is"
        )
    return OtherLevels(place, [finest, *sources])


class OtherLevels:
    """The levels of a store of other programs, the finest first, read as those of flowtex.

    It is a multiscale group of xarray datasets, or one dataset in chunks. A level of a pyramid here
    has every 2^l-th line of the finest one. Others average blocks of nodes, so theirs lie between
    those lines: values are interpolated from the level of theirs with about as many nodes, or
    picked from the lines of a finer level where no level of theirs is as coarse.
    """

    def __init__(self, place: str, sources: list[RegionSource]) -> None:
        self.place = place
        self._regions = [source.regions for source in sources]
        finest = sources[0]
        self.template, nodes = finest.field, finest.shape
        self.about: dict[str, Any] = {
            "place": place,
            "nodes": list(nodes),
            "depth": root_level(nodes),
            "periods": periods_of(finest),
            "parameter": "arclength",
            "lines": "streamlines",
        }
        for words in self._slow_properties():
            notify(words)

    def _slow_properties(self) -> list[str]:
        """Return sentences about properties of a store that make it slow, with the remedy."""
        build = f"`flowtex pyramid {self.place} -o flow.zarr` builds a faster store"
        component = self._regions[0].values.components[0].variable
        shape = self._regions[-1].lines.shape
        chunks = component.encoding.get("chunks") or component.shape
        nbytes = math.prod(chunks) * component.dtype.itemsize
        words = []
        if nbytes > SLOW_BYTES:
            size = " × ".join(map(str, chunks))
            words.append(
                f"each tile reads complete chunks of {size} values ({nbytes / 1e6:.0f} MB), which "
                f"is slow; better are chunks of one time step and 256 to 512 nodes a side; {build}"
            )
        if math.prod(shape) > SLOW_NODES:
            words.append(
                f"the coarsest level has {shape[1]:,} × {shape[0]:,} nodes, which are read for "
                f"the first picture of each time step, so this is slow; {build}"
            )
        return words

    def positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        """Return where nodes are, (J, I, 3), and which of them are valid, (J, I)."""
        fine, (u, _) = self._lines(level, rows, columns), self._components(0, level, rows, columns)
        return self._regions[0].lines.points(*fine), np.isfinite(u)

    def nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        """Return the data at some lines of a level."""
        points, valid = self.positions(level, rows, columns)
        finest, count = self._regions[0], len(self.template.times)
        fine = self._lines(level, rows, columns)

        def velocity(step: int) -> Floats:
            u, v = self._components(step, level, rows, columns)
            return np.nan_to_num(finest.lines.vectors(u, v, *fine))

        def scalar(name: str, step: int) -> Floats:
            if name not in finest.scalars:
                return np.hypot(*self._components(step, level, rows, columns))
            regions = self._regions[self._nearest(level)]
            return self._values(
                regions, lambda rows, columns: (regions.scalar(name, step, rows, columns),), fine
            )[0]

        return Nodes(
            points,
            valid,
            _steps(count, velocity),
            {name: _steps(count, partial(scalar, name)) for name in finest.names},
        )

    def _lines(self, level: int, rows: Indices, columns: Indices) -> tuple[Indices, Indices]:
        """Return the numbers of lines of a level in the finest one."""
        first, second = (
            level_lines(n, level)[chosen]
            for n, chosen in zip(self.about["nodes"], (rows, columns), strict=True)
        )
        return first, second

    def _nearest(self, level: int) -> int:
        """Return the number of their coarsest level that has enough nodes for a level."""
        finest = math.prod(self._regions[0].lines.shape)
        spacings = [math.sqrt(finest / math.prod(level.lines.shape)) for level in self._regions]
        return max(n for n, spacing in enumerate(spacings) if spacing <= WIDER * 2**level)

    def _components(
        self, step: int, level: int, rows: Indices, columns: Indices
    ) -> tuple[Floats, Floats]:
        """Return the components of the velocity, (J, I) each, NaN where there are no data."""
        regions, fine = self._regions[self._nearest(level)], self._lines(level, rows, columns)
        u, v = self._values(regions, partial(regions.components, step), fine)
        missing = np.isnan(u) | np.isnan(v)
        u[missing] = v[missing] = np.nan
        return u * regions.factor, v * regions.factor

    def _values(
        self,
        regions: Regions,
        read: Callable[[Indices, Indices], tuple[Floats, ...]],
        fine: tuple[Indices, Indices],
    ) -> list[Floats]:
        """Interpolate values at lines of a level of theirs at lines of the finest one."""
        lines, theirs = self._regions[0].lines, regions.lines
        turn = 360.0 if lines.projection is not None else None
        (below, down), (beside, across) = (
            _between(lines.b[fine[0]], theirs.b, None),
            _between(lines.a[fine[1]], theirs.a, turn),
        )
        rows, columns = np.unique(below), np.unique(beside)
        at = np.searchsorted(rows, below), np.searchsorted(columns, beside)
        try:
            parts = read(rows, columns)
        except Exception as error:
            words = str(error) if isinstance(error, ReadFault) else fault_words(error)
            raise PyramidError(f"{self.place} cannot be read: {words}") from None
        return [_interpolated(values, at, (down, across)) for values in parts]


def _steps(count: int, read: Callable[[int], AnyArray]) -> Steps:
    """Return the steps; those of a series are read on request."""
    return read(0)[None] if count == 1 else LazySteps(count, read, kept=KEPT_BYTES)


def _between(places: Floats, line: Floats, turn: float | None) -> tuple[Indices, Floats]:
    """Return the two nodes of a line around each place, (2, N), and shares of the second, (N,).

    Beside places that lie farther apart than nodes both are the nearest one, so evenly spaced.
    """
    if turn is not None:
        line = np.unwrap(line, period=turn)
        middle = (line[0] + line[-1]) / 2
        places = middle + (places - middle + turn / 2) % turn - turn / 2
    numbers = np.arange(len(line), dtype=float)
    direction = 1 if line[-1] > line[0] else -1
    at = np.interp(places, line[::direction], numbers[::direction])
    if len(at) > 1 and np.median(np.abs(np.diff(at))) > WIDER:
        near = np.rint(at).astype(np.intp)
        return np.stack([near, near]), np.zeros(len(at))
    first = np.minimum(at.astype(np.intp), len(line) - 2)
    share = at - first
    return np.stack([first, first + 1]), share


def _interpolated(
    values: Floats, at: tuple[Indices, Indices], shares: tuple[Floats, Floats]
) -> Floats:
    """Interpolate (J, I) between lines; NaN has no weight, and results where half is missing."""
    finite = np.isfinite(values)
    total, weight = (np.zeros((at[0].shape[1], at[1].shape[1])) for _ in range(2))
    for a, down in enumerate((1 - shares[0], shares[0])):
        for b, across in enumerate((1 - shares[1], shares[1])):
            nodes = np.ix_(at[0][a], at[1][b])
            share = down[:, None] * across * finite[nodes]
            total += share * np.where(finite[nodes], values[nodes], 0.0)
            weight += share
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(weight > 0.5 - 1e-9, total / weight, np.nan)
