"""A pyramid whose levels and tiles are read from a store."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.field_data import FINEST, OPENED, WHOLE_SHAPE
from flowtex.field.options import FieldOptions
from flowtex.field.steps import Nodes
from flowtex.field.uncertainty import spread_name
from flowtex.pyramid.finest import FinestOfLevels
from flowtex.pyramid.layout import VELOCITY_BITS, About
from flowtex.pyramid.levels import Levels
from flowtex.pyramid.others import open_other
from flowtex.pyramid.places import PyramidError, is_store, place_text
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.grid_levels import averaged
from flowtex.textures.tiles.grid_pyramid import GridPyramid
from flowtex.textures.tiles.pyramid import Pyramid, TileKey
from flowtex.textures.tiles.shared import attach_pyramid


def open_store(store: str | Path, *, uncertainty: Any = None, **options: Any) -> FlowField:
    """Open a pyramid in a store as a field.

    ``flowtex.render``, ``flowtex.show`` and the widget read only the tiles in view. The arrays of
    the field are those of the coarsest level, while ``field.at`` reads the nodes of the finest one
    around a point. What is derived needs all nodes: derive it before you build the store.

    Parameters
    ----------
    store
        A local folder, or a URL: ``s3://bucket/path`` and other object storage, or ``https://``.
        Endpoint and credentials come from the environment. It may also be written by other
        programs: a Zarr dataset, or a group of several levels, as of ndpyramid and topozarr.
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
        When a large store of another program has no coarse level.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.open_store("gyre.zarr").shape
    (21, 41)
    """
    if not is_store(store):
        given = {**options, "uncertainty": uncertainty}
        return open_other(place_text(store), FieldOptions.of_dataset(given))
    if options:
        raise FieldError(f"{', '.join(options)} applies to the source of a pyramid; omit it")
    levels = Levels(store)
    if not levels.about.get("levels_done"):
        raise PyramidError(
            f"{levels.place} is incomplete: its coarsest level is missing; build it again"
        )
    stored = levels.template.uncertainty
    if isinstance(uncertainty, str):
        requested = uncertainty
    else:
        requested = "an array"
    if uncertainty is not None and requested not in (stored, stored.removeprefix(spread_name(""))):
        raise FieldError(
            f"uncertainty is {requested}, but {levels.place} was built with {stored or 'none'}"
        )
    root = root_of(levels)

    def pyramid(field: FlowField, parameter: str, lines: str) -> Pyramid:
        return StoredPyramid(levels, field, parameter, lines)

    attach_pyramid(root, pyramid)
    opened = partial(open_store, store, uncertainty=uncertainty)
    root.__dict__.update({WHOLE_SHAPE: tuple(levels.about["nodes"]), OPENED: opened})
    if levels.about["depth"]:
        finest = StoredPyramid(levels, levels.template)
        root.__dict__[FINEST] = FinestOfLevels(finest, root, levels.positions, opened)
    return root


def root_of(levels: Levels) -> FlowField:
    """Return the coarsest level as a field."""
    pyramid = StoredPyramid(levels, levels.template)
    return pyramid.at_level(pyramid.depth)


class StoredPyramid(GridPyramid):
    """The levels of a pyramid in a store, whose ``field`` is the coarsest of them."""

    def __init__(
        self,
        levels: Levels,
        field: FlowField,
        parameter: str | None = None,
        lines: str | None = None,
    ) -> None:
        self._stored = levels
        self.about: About = levels.about  #: The description of the field and its pyramid.
        about = self.about
        super().__init__(
            field,
            parameter or about["parameter"],
            lines or about["lines"],
            nodes=(about["nodes"][0], about["nodes"][1]),
            depth=about["depth"],
        )
        self.ranges = {}
        for name, (whole, robust) in (about.get("ranges") or {}).items():
            self.ranges[name, False] = (whole[0], whole[1])
            self.ranges[name, True] = (robust[0], robust[1])

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
        """Return the textures of tiles, traced from their nodes.

        Raises
        ------
        PyramidError
            When data cannot be read, or nodes of a tile are not those of the level above, as where
            files of two builds are mixed.
        """
        made = super().tiles(keys, steps)
        for key, textures in made.items():
            if textures is not None:
                self._check_nodes(key, textures, steps)
        return made

    def _check_nodes(self, key: TileKey, textures: TextureSet, steps: Sequence[int]) -> None:
        """Raise a PyramidError where nodes of a tile differ from the level above."""
        stored = self._stored
        field = textures.geometry.field
        drawn = textures.grid.drawn
        valid = field.valid[drawn]
        above = []
        lines = []
        for number, count in zip(key[1:], valid.shape, strict=True):
            first = number * self.about["tile_cells"]
            coarse_lines = np.arange(first // 2 + 1, (first + count) // 2)
            above.append(coarse_lines)
            lines.append(2 * coarse_lines - first)
        if not all(map(len, above)):
            return
        rows = lines[0] + np.array([[-1], [0], [1]])
        columns = lines[1] + np.array([[-1], [0], [1]])
        at = np.ix_(*lines)
        coarse = stored.nodes(key.level + 1, *above, velocities=False)
        pairs = [(field.points[drawn][at], coarse.points), (valid[at], coarse.valid)]
        for name, values in coarse.scalars.items():
            fine = field.scalars[name]
            for step in steps:
                if step < len(values):
                    pairs.append((fine[step][drawn][at], values[step]))
        for step in steps:
            velocity = stored.velocity(key.level + 1, step, *above)[coarse.valid]
            mean = averaged(np.asarray(field.velocity[step])[drawn], valid, rows, columns)
            pairs.append((mean[coarse.valid][:, : velocity.shape[-1]], velocity))
        for values, reference in pairs:
            if not _agree(values, reference):
                raise PyramidError(
                    f"tile {tuple(key)} of {stored.place} does not match the level above; build "
                    "again"
                )

    def _positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        return self._stored.positions(level, rows, columns)

    def _nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        return self._stored.nodes(level, rows, columns)


def _agree(values: AnyArray, reference: AnyArray) -> bool:
    size = np.abs(np.nan_to_num(reference)).max(initial=0.0)
    return bool(np.allclose(values, reference, 2.0**-VELOCITY_BITS, 1e-6 * size, equal_nan=True))
