"""A pyramid whose levels and tiles are read from a store."""

from __future__ import annotations

import threading
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex.field import FlowField
from flowtex.pyramid.layout import empty_field
from flowtex.pyramid.levels import Levels, StoredTile
from flowtex.pyramid.places import PyramidError
from flowtex.textures import TextureSet
from flowtex.tiles import Pyramid, TileKey, have_pyramid
from flowtex.tiles.pyramid import Nodes
from flowtex.trace import SliceStore

__all__ = ["StoredPyramid", "open_store", "root_of"]


def open_store(store: str | Path) -> FlowField:
    """Open a pyramid in a store as a field.

    Drawing it reads the tiles that are in view, as ``flowtex.render``, ``flowtex.show`` and the
    widget do. The field's own arrays are those of the coarsest level.

    Parameters
    ----------
    store
        A local folder, or a URL: ``s3://bucket/path`` and other object storage, or ``https://``.
        Endpoint and credentials come from the environment.

    Returns
    -------
    FlowField

    Raises
    ------
    FieldError
        When there is no pyramid, or it cannot be read.
    ModuleNotFoundError
        When what reads it is missing; the text names the extra.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(21, 41))
    >>> built = flowtex.pyramid.build(field, "gyre.zarr", progress=False)
    >>> flowtex.pyramid.open_store("gyre.zarr").shape
    (21, 41)
    """
    levels = Levels(store)
    if not levels.about.get("levels_done"):
        msg = (
            f"{levels.place} was not built to its end, and its coarsest level is missing; run "
            "flowtex.pyramid.build again, which makes what is missing"
        )
        raise PyramidError(msg)
    root = root_of(levels)

    def pyramid(field: FlowField, parameter: str, lines: str) -> Pyramid:
        return StoredPyramid(levels, field, parameter, lines)

    have_pyramid(root, pyramid)
    return root


def root_of(levels: Levels) -> FlowField:
    """Return the coarsest level as a field."""
    template = StoredPyramid(levels, empty_field(levels.about))
    return template.at_level(template.depth)


class StoredPyramid(Pyramid):
    """The levels of a pyramid in a store, whose ``field`` is the coarsest of them.

    Tiles are read where they were made with the same parameter and along the same lines; others
    are traced in what the store has of their surroundings.
    """

    def __init__(
        self,
        levels: Levels,
        field: FlowField,
        parameter: str | None = None,
        lines: str | None = None,
    ) -> None:
        about = levels.about
        self.field, self._stored = field, levels
        self.parameter = about["parameter"] if parameter is None else parameter
        self.lines = about["lines"] if lines is None else lines
        self.nodes = (about["nodes"][0], about["nodes"][1])
        self.depth = about["depth"]
        self.ranges = {
            (name, robust): (ends[0], ends[1])
            for name, both in about.get("ranges", {}).items()
            for robust, ends in zip((False, True), both, strict=True)
        }
        self._lock = threading.Lock()
        self._places = {}

    @cached_property
    def root(self) -> FlowField:
        """The field at the coarsest level."""
        return self.field

    @cached_property
    def periods(self) -> tuple[Floats, Floats]:
        """What leads from the first line of an axis to the last, (3,), for both axes."""
        rows, columns = (np.array(some) for some in self._stored.about["periods"])
        return rows, columns

    def made(self, key: TileKey) -> bool:
        """Whether tiles like this one are in the store, and not traced when they are asked for."""
        about = self._stored.about
        same = (self.parameter, self.lines) == (about["parameter"], about["lines"])
        return same and key.level in about["traced"]

    def tile(self, key: TileKey, steps: Sequence[int]) -> TextureSet | None:
        """Return the textures of a tile; errors are those of :meth:`Levels.tile`."""
        if not self.made(key):
            return super().tile(key, steps)
        read = {step: self._stored.tile(key, step) for step in steps}
        about = read[steps[0]].about
        if about["empty"]:
            return None
        textures = self.textures(key, about["spare"])
        if textures is None or textures.lags.tolist() != about["lags"]:
            msg = f"tile {tuple(key)} of {self._stored.place} does not fit its level; build it anew"
            raise PyramidError(msg)
        return self._read(textures, key, read)

    def root_textures(self, store: SliceStore) -> TextureSet:
        """Return the textures of the root; it is traced where the store has not what is asked."""
        textures, key = super().root_textures(store), TileKey(self.depth, 0, 0)
        if not self.made(key):
            return textures
        try:
            tile = self._stored.tile(key, 0)
        except PyramidError as error:
            warnings.warn(f"the whole surface is traced anew, for {error}", stacklevel=2)
            return textures
        if textures.lags.tolist() != tile.about["lags"]:
            return textures
        return self._read(textures, key, {0: tile})

    def _read(self, textures: TextureSet, key: TileKey, read: dict[int, StoredTile]) -> TextureSet:
        parts = {name: getattr(textures, name) for name in TextureSet.__dataclass_fields__}
        return _StoredTextures(**parts, levels=self._stored, key=key, read=read)

    def _positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        return self._stored.positions(level, rows, columns)

    def _nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        return self._stored.nodes(level, rows, columns)


@dataclass(frozen=True, eq=False)
class _StoredTextures(TextureSet):
    """Textures whose layers are read. Those at hand already are handed over once."""

    levels: Levels = field(kw_only=True)
    key: TileKey = field(kw_only=True)
    read: dict[int, StoredTile] = field(default_factory=dict)

    def layers(self, step: int = 0) -> Floats32:
        """Texels of the slice texture for one destination time, (layers, H, W, 4)."""
        tile = self.read.pop(step, None)
        if tile is not None:
            return tile.layers
        try:
            return self.levels.tile(self.key, step).layers
        except PyramidError:
            if self.key.level < self.levels.about["depth"]:
                raise
            # There is nothing coarser to show, and what it is made from is at hand.
            return super().layers(step)
