"""The levels of a field and their tiles, whatever the surface consists of.

Level 0 is the whole field. The coarsest level is a field of moderate size that is traced whole, the
root; a tile of a finer level is traced in a window of its level around it. A streak is a fixed
number of pixels, so the cost of a tile does not depend on the size of the surface.

::

    level 2  (root)      level 1                  level 0
    ┌───────┐            ┌───────┬───────┐        ┌───┬───┬───┬───┐
    │       │            │       │       │        │   │   │   │   │   a tile covers a quarter of one
    └───────┘            └───────┴───────┘        └───┴───┴───┴───┘   tile of the level above it

:mod:`~flowtex.textures.tiles.grid_pyramid` and :mod:`~flowtex.textures.tiles.triangle_pyramid` have
the two kinds.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from functools import cached_property
from types import MappingProxyType
from typing import ClassVar, NamedTuple

from flowtex._util.array_types import Bools, Floats, Floats32
from flowtex._util.forks import ProcessLock
from flowtex.field import FlowField
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.triangle_geometry import TriangleGeometry
from flowtex.trace.slices import typical_speed
from flowtex.trace.store import SliceStore

#: Length of the paths in cells, by their longer side.
PATH_CELLS = 28
#: Widths of the halo that are tried one after the other, where paths are cut by it.
WIDENINGS = (1, 2, 4)


class TileKey(NamedTuple):
    """Which tile: its level, and its row and column among the tiles of that level."""

    level: int
    row: int
    column: int

    @property
    def parent(self) -> TileKey:
        """The tile that this one refines; at the depth of the root it is the root."""
        return TileKey(self.level + 1, self.row // 2, self.column // 2)


class Pyramid(ABC):
    """The levels of a field and their tiles.

    Parameters
    ----------
    field
        The field at level 0.
    parameter, lines
        As for :class:`~flowtex.trace.store.SliceStore`.
    nodes
        Numbers of nodes (J, I) at level 0.
    depth
        Level of the root; 0 where the whole field is the root.
    """

    tile_blocks: ClassVar[int]  #: Blocks along a side of a tile.
    most_grouped: ClassVar[int]  #: Most nodes of a window of several tiles.
    #: Ends of scalars and of the speed at level 0, by name and whether robust, where they do not
    #: follow from the field itself.
    ranges: Mapping[tuple[str, bool], tuple[float, float]] = MappingProxyType({})

    def __init__(
        self, field: FlowField, parameter: str, lines: str, *, nodes: tuple[int, int], depth: int
    ) -> None:
        self.field = field
        self.parameter = parameter
        self.lines = lines
        self.nodes = nodes
        self.depth = depth
        self._lock = ProcessLock()

    @cached_property
    def root(self) -> FlowField:
        """The field at the coarsest level."""
        return self.at_level(self.depth)

    @property
    @abstractmethod
    def root_geometry(self) -> SurfaceGeometry | TriangleGeometry:
        """The root as it is drawn."""

    def root_textures(self, store: SliceStore) -> TextureSet:
        """Return the textures of the root, with the traces of a store of slices."""
        return TextureSet(self.root_geometry, store)

    @abstractmethod
    def at_level(self, level: int) -> FlowField:
        """Return the whole field at a level."""

    @abstractmethod
    def shape(self, level: int) -> tuple[int, int]:
        """Return the number of nodes (J, I) of a level; J is 1 for triangles."""

    @property
    @abstractmethod
    def blocks(self) -> tuple[int, int]:
        """Rows and columns of blocks at level 0."""

    @abstractmethod
    def visible_blocks(self, places: Floats32) -> Bools:
        """Return which blocks of level 0, (rows, columns), have some of the places of a pass.

        Those are (N, 4): a coordinate in the root's textures, or shares of a triangle, its number,
        and one more.
        """

    @abstractmethod
    def places(self, level: int) -> Floats:
        """Return centre, radius and cell size of the blocks of a level, (rows, columns, 5)."""

    def smooth_places(self, level: int) -> Floats:
        """Return :meth:`places` with cell sizes divided by :meth:`enlarged`."""
        places = self.places(level).copy()
        places[..., 4] /= self.enlarged(level)
        return places

    @abstractmethod
    def enlarged(self, level: int) -> Floats:
        """Return factors by which cells of blocks may be larger, (rows, columns)."""

    def blocks_of(self, key: TileKey | None) -> tuple[slice, slice]:
        """Return the rows and columns of a tile's blocks among those of its level."""
        if key is None:
            return slice(0, None), slice(0, None)
        size = self.tile_blocks
        row, column = (size * at for at in key[1:])
        return slice(row, row + size), slice(column, column + size)

    @abstractmethod
    def children(self, key: TileKey | None) -> list[TileKey]:
        """Return tiles of the next level that cover a tile, or the root for ``None``."""

    def groups(self, keys: Sequence[TileKey]) -> list[list[TileKey]]:
        """Return tiles in groups, each traced in one window with fewer nodes than theirs."""
        groups: list[list[TileKey]] = []
        # Paths that are integrated need no halo.
        composed = self.field.steady or self.lines == "streamlines"
        for key in keys:
            group = [key]
            for other in list(groups) if composed else ():
                if other[0].level == key.level:
                    most = min(self.most_grouped, self._nodes_of(group) + self._nodes_of(other))
                    if self._nodes_of(other + group) <= most:
                        groups.remove(other)
                        group = other + group
            groups.append(group)
        return groups

    @abstractmethod
    def _nodes_of(self, keys: Sequence[TileKey]) -> int:
        """Return about how many nodes are traced for tiles of a level."""

    def tile(self, key: TileKey, steps: Sequence[int]) -> TextureSet | None:
        """Trace a tile as :meth:`tiles` does."""
        return self.tiles([key], steps)[key]

    def tiles(
        self, keys: Sequence[TileKey], steps: Sequence[int]
    ) -> dict[TileKey, TextureSet | None]:
        """Trace tiles of a level, again with a wider halo where paths were cut at some steps."""
        for widening in WIDENINGS:
            made = self.region(keys, widening)
            if widening == WIDENINGS[-1]:
                break
            shown = []
            for textures in made.values():
                if textures is not None:
                    shown.append(textures)
            steps = [step for step in steps if any(self.is_cut(part, step) for part in shown)]
            if not steps:
                break
        return made

    def is_cut(self, textures: TextureSet, step: int) -> bool:
        """Return whether paths of a tile end where its window does, though the surface continues.

        The surroundings of a tile of triangles are as wide as its paths are long.
        """
        del textures, step
        return False

    @cached_property
    def whole_speed(self) -> float:
        """Typical speed of the flow on the whole surface."""
        return typical_speed(self.root)

    def textures(self, key: TileKey) -> TextureSet | None:
        """Return the textures of a tile, as :meth:`region` does."""
        return self.region([key])[key]

    @abstractmethod
    def region(
        self, keys: Sequence[TileKey], widening: int = 1
    ) -> dict[TileKey, TextureSet | None]:
        """Return the textures of tiles of a level, which are traced together on request.

        Parameters
        ----------
        keys
            Tiles of one level.
        widening
            Width of the surroundings of a tile, as a multiple of the width that paths of even speed
            need; :meth:`is_cut` returns whether that was enough.

        Returns
        -------
        dict
            Textures by tile; ``None`` for a tile of which nothing is drawn.

        Raises
        ------
        KeyError
            When a tile does not exist.
        """
