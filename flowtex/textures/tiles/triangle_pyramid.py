"""A field on triangles at every level of detail, cut into tiles.

Level 0 has all nodes, each next one about a quarter of them: those of :class:`Clusters`, down to a
field of moderate size that is traced whole, the root. Tiles are boxes of a k-d tree, so that each
holds about as many nodes however these are spread. Nested connected parts, such as isosurfaces, are
separated before space is divided, because the outer ones hide the inner ones. A tile draws the
triangles that reach into its box: those of two levels overlap where they meet, and no crack shows
between them. Its paths are traced in the triangles around it, as far as they are long.

A tile has 2 x 2 blocks, and so has the root; in each lies one tile of the next level.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.arrays import bounds
from flowtex.field import FlowField
from flowtex.field.scalars import Scalars
from flowtex.field.steps import Steps
from flowtex.field.triangles.triangle_nodes import corner_ends
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.blocks import enlarging, has_roughness, triangle_roughness
from flowtex.textures.tiles.clusters import Clusters, Levels, part_extents
from flowtex.textures.tiles.pyramid import PATH_CELLS, Pyramid, TileKey
from flowtex.textures.triangle_geometry import TriangleGeometry
from flowtex.trace.store import SliceStore

#: Most nodes of a field that is traced whole.
ROOT_NODES = 25_000
#: Most nodes from which boxes are computed.
MOST_MEASURED = 100_000
#: First lag of a tile's paths in cells.
FIRST_CELLS = 0.25
#: Most lags of a tile's paths.
MOST_LAGS = 24
#: Share of the side of bins that counts as the size of their cells: finer ones than a few pixels
#: are drawn no sooner, for a triangle costs as much as the pixels beside it.
BIN_SHARE = 1 / 3
#: Greatest factor by which cells, which are large already, may be larger where a level is smooth.
SMOOTH_CELLS = 2.0
#: Quantile of the sizes of the triangles of a block that counts as the size of all.
MOST_SHARE = 0.95
#: Most nodes of a window for each of its tile with composed paths: composing follows all of them.
MOST_AROUND = 2.0
#: Mean extent of connected parts, as a share of the whole extent, from which they count as nested.
NESTED_SHARE = 0.55
#: Greatest width of the window around a tile, in lengths of even paths.
MOST_WIDE = 4.0


class TrianglePyramid(Pyramid):
    """The levels of a field on triangles and their tiles; parameters are those of a pyramid."""

    tile_blocks = 2
    most_grouped = 100_000

    def __init__(
        self, field: FlowField, parameter: str = "arclength", lines: str = "pathlines"
    ) -> None:
        self._clusters = Levels(field, ROOT_NODES)
        depth = len(self._clusters) - 1
        super().__init__(field, parameter, lines, nodes=field.shape, depth=depth)
        self._roughness: dict[int, Floats] = {}
        self._parts: dict[int, list[Indices]] = {}

    def at_level(self, level: int) -> FlowField:
        """Return the whole field at a level."""
        return self._clusters[level].field

    def shape(self, level: int) -> tuple[int, int]:
        """Return the number of nodes (1, N) of a level, about it where it is not yet made."""
        return 1, self._clusters.nodes(level)

    @property
    def blocks(self) -> tuple[int, int]:
        """Rows and columns of blocks at level 0."""
        return (2 ** self._steps(0),) * 2

    def places(self, level: int) -> Floats:
        """Return centre, radius, and cell size of blocks, (J, I, 5), of triangles of level 0."""
        low, high, size = self._extents
        for _ in range(level):
            low, high = (
                reduce.reduce(corner.reshape(-1, 4, 3), axis=1)
                for reduce, corner in ((np.minimum, low), (np.maximum, high))
            )
            size = 2 * size.reshape(-1, 4).max(axis=1)
        empty = size <= 0
        center = np.where(empty[:, None], 0.0, (low + high) / 2)
        radius = np.where(empty, -np.inf, np.linalg.norm(high - center, axis=-1))
        steps = self._steps(level)
        places = np.empty((2**steps, 2**steps, 5))
        places[self._boxes.places(steps)] = np.column_stack([center, radius, size])
        return places

    def enlarged(self, level: int) -> Floats:
        """Return factors by which cells may be larger, as for structured surfaces."""
        factors = np.ones((2 ** self._steps(level),) * 2)
        if level and has_roughness(self.field):
            if level not in self._roughness:
                clusters = self._clusters[level - 1]
                parts = self._members(level - 1)
                errors = triangle_roughness(clusters.field, clusters.triangles, parts)
                self._roughness[level] = errors.reshape(-1, 4).max(axis=1)
            places = self._boxes.places(self._steps(level))
            factors[places] = enlarging(self._roughness[level], SMOOTH_CELLS)
        return factors

    def visible_blocks(self, places: Floats32) -> Bools:
        """Return which blocks of level 0 have some of the places, as of structured surfaces."""
        geometry = self.root_geometry
        triangles = geometry.triangles[np.unique(places[:, 2].astype(np.intp))]
        corners = self._points(self.depth)[triangles]
        points = np.concatenate([*corners.swapaxes(0, 1), corners.mean(axis=1)])
        # In the coarse root, a hidden part may lie above the visible one.
        beside = np.array([0.0, 0.0, 0.0, 1.0])
        seen = self._boxes.members(points - beside, points + beside, self._steps(0))
        ends = corner_ends(self._points(self.depth), geometry.triangles)
        whole = self._boxes.members(*ends, self._steps(0))
        # Where the root has no triangles, finer levels may have some.
        parts = [len(part) > 0 or not len(all_) for part, all_ in zip(seen, whole, strict=True)]
        visible = np.zeros(self.blocks, dtype=bool)
        visible[self._boxes.places(self._steps(0))] = parts
        return visible

    def children(self, key: TileKey | None) -> list[TileKey]:
        """Return tiles of the next level that cover a tile, or the root for ``None``."""
        if key is None:
            level = self.depth
        else:
            level = key.level
        if level == 0:
            return []
        row, column = (0, 0) if key is None else (2 * at for at in key[1:])
        found = []
        for j in (0, 1):
            for i in (0, 1):
                found.append(TileKey(level - 1, row + j, column + i))
        return found

    @cached_property
    def root_geometry(self) -> TriangleGeometry:
        """The root as it is drawn, in as many blocks as there are tiles in the level before it."""
        root = self.root
        if not self.depth:
            return TriangleGeometry.of(root)
        members, masks = self._triangles(TileKey(self.depth, 0, 0))
        return TriangleGeometry.of_tile(
            root,
            np.arange(root.shape[1]),
            self._clusters[-1].triangles[members],
            members,
            root.surface,
            (masks, self.places(self.depth)),
        )

    def region(
        self, keys: Sequence[TileKey], widening: int = 1
    ) -> dict[TileKey, TextureSet | None]:
        """Return the textures of tiles of a level, as for structured surfaces.

        Parameters
        ----------
        keys
            Tiles of one level.
        widening
            Factor of the width of the halo around a tile.

        Raises
        ------
        KeyError
            When a tile does not exist.
        """
        number = keys[0].level
        count = 2 ** (self._steps(number) - 1)
        for key in keys:
            if not (0 <= key.level < self.depth and all(0 <= at < count for at in key[1:])):
                raise KeyError(
                    f"tile {tuple(key)} does not exist; expected a level from 0 to {self.depth - 1}"
                )
        level = self._clusters[number]
        made: dict[TileKey, TextureSet | None] = dict.fromkeys(keys)
        parts = {key: part for key in keys if len((part := self._triangles(key))[0])}
        if not parts:
            return made
        places = {key: self.places(number)[self.blocks_of(key)] for key in parts}
        longest = self._longest(np.stack(list(places.values())))
        near = []
        for members, _ in parts.values():
            nodes = np.unique(level.triangles[members])
            near.append(
                self._around(number, nodes, widening * longest * self._stretch(number, nodes))
            )
        around = np.unique(np.concatenate(near))
        window, numbers = _window(level, around)
        followed, geometries = np.zeros(window.shape, dtype=bool), {}
        for key, (members, masks) in parts.items():
            triangles = level.triangles[members]
            geometries[key] = TriangleGeometry.of_tile(
                window,
                numbers[np.unique(triangles)],
                numbers[triangles],
                np.searchsorted(around, members),
                self.root.surface,
                (masks, places[key]),
            )
            followed[geometries[key].texels] = True
        store = SliceStore(
            window,
            parameter=self.parameter,
            lines=self.lines,
            compose=window.shape[1] <= MOST_AROUND * followed.sum(),
            longest=longest,
            nodes=followed,
        )
        if store.parameter == "arclength":
            store.lags, store.unit = _lags(window.surface.cell_size, followed, longest)
        for key, geometry in geometries.items():
            made[key] = TextureSet(geometry, store, whole_speed=self.whole_speed, longest=longest)
        return made

    def _longest(self, places: Floats) -> float:
        """Return the length of paths in blocks (..., 5)."""
        return 0.75 * PATH_CELLS * float(places[..., 4].max())

    def _nodes_of(self, keys: Sequence[TileKey]) -> int:
        number = keys[0].level
        places = np.concatenate(
            [self.places(number)[self.blocks_of(k)].reshape(-1, 5) for k in keys]
        )
        reach = places[:, 3:4] + self._longest(places)
        ends = np.full((len(places), 1), np.inf)
        low = np.hstack([places[:, :3] - reach, -ends])
        high = np.hstack([places[:, :3] + reach, ends])
        near = self._boxes.members(low, high, self._steps(number))
        parts = self._members(number)
        return sum(len(part) for part, hit in zip(parts, near, strict=True) if len(hit)) // 2

    def _steps(self, level: int) -> int:
        """Return the steps of the k-d tree to the blocks of a level."""
        return self.depth - level + 1

    @cached_property
    def _boxes(self) -> Boxes:
        nodes = np.flatnonzero(self._used)
        nodes = nodes[:: -(-len(nodes) // MOST_MEASURED)]
        points = np.column_stack([self.field.points[0, nodes], self._clusters[0].part[nodes]])
        return Boxes(points, self._steps(0))

    @cached_property
    def _used(self) -> Bools:
        """Nodes of the field that are corners of drawn triangles, (N,)."""
        used = np.zeros(self.field.shape[1], dtype=bool)
        used[self._clusters[0].triangles] = True
        return used

    def _points(self, level: int) -> Floats:
        """Return positions of the nodes of a level, and their connected part, (N, 4)."""
        clusters = self._clusters[level]
        return np.column_stack([clusters.field.points[0], clusters.part])

    def _members(self, level: int) -> list[Indices]:
        with self._lock:
            if level not in self._parts:
                clusters = self._clusters[level]
                low, high = corner_ends(self._points(level), clusters.triangles)
                self._parts[level] = self._boxes.members(low, high, self._steps(level))
            return self._parts[level]

    def _triangles(self, key: TileKey) -> tuple[Indices, NDArray[np.uint16]]:
        """Return triangles of a tile, or of the root, and in which of its blocks they lie."""
        rows, columns = self._boxes.places(self._steps(key.level) - 1)
        number = int(np.flatnonzero((rows == key.row) & (columns == key.column))[0])
        parts = self._members(key.level)[4 * number : 4 * number + 4]
        members, at = np.unique(np.concatenate(parts), return_inverse=True)
        masks = np.zeros(len(members), np.uint16)
        bits = np.repeat(np.array([1, 2, 4, 8], np.uint16), [len(part) for part in parts])
        np.bitwise_or.at(masks, at, bits)
        return members, masks

    @cached_property
    def _extents(self) -> tuple[Floats, Floats, Floats]:
        """Corners of the content of the blocks of level 0, and the size of cells there.

        They are those of the last level but one, and of what it omits, with a margin.
        """
        ends, sides = self._outlines
        parts = self._boxes.members(*ends, self._steps(0))
        filled = np.array([len(part) > 0 for part in parts])
        items = np.concatenate(parts)
        first = np.cumsum([0, *(len(part) for part in parts)])[:-1][filled]
        low, high = self._boxes.bounds(self._steps(0))
        inner = [np.full((len(low), 3), np.inf), np.full((len(low), 3), -np.inf)]
        size = np.zeros(len(parts))
        if len(first):
            for corner, end, reduce in zip(inner, ends, (np.minimum, np.maximum), strict=True):
                corner[filled] = reduce.reduceat(end[items, :3], first)
            # At the next level the size is twice as much, a share of the bins.
            size[filled] = [BIN_SHARE / 2 * _most(p) for p in np.split(sides[items], first[1:])]
        low = low[:, :3]
        high = high[:, :3]
        return np.maximum(low, inner[0]), np.minimum(high, inner[1]), size

    @property
    def _outlines(self) -> tuple[tuple[Floats, Floats], Floats]:
        """Corners (m, 4) of boxes that hold the surface, and sides of bins of level 0 there."""
        level = max(self.depth - 1, 0)
        clusters = self._clusters[level]
        low, high = corner_ends(self._points(level), clusters.triangles)
        sides = np.maximum.reduce([clusters.sides[clusters.triangles[:, k]] for k in range(3)])
        if level == 0:
            return (low, high), sides
        # Parts smaller than the bins of that level have no triangles there.
        lost = np.flatnonzero(self._used & (clusters.number < 0))
        finest = self._clusters[0]
        places = np.column_stack([self.field.points[0, lost], finest.part[lost]])
        # Nodes of a level lie in bins of half its sides.
        margin = np.append(sides / 2, finest.sides[lost])[:, None] * [1.0, 1.0, 1.0, 0.0]
        ends = np.concatenate([low, places]) - margin, np.concatenate([high, places]) + margin
        return ends, np.append(sides / 2**level, finest.sides[lost])

    def _stretch(self, level: int, nodes: Indices) -> float:
        """Return the length of the paths of some nodes relative to even paths."""
        is_even = self.field.steady or self.lines == "streamlines"
        if is_even and self.parameter == "arclength":
            return 1.0
        velocity = self.at_level(level).typical.velocity[:, 0, nodes]
        fast = np.percentile(np.linalg.norm(velocity, axis=-1), 99)
        return float(np.clip(fast / self.whole_speed, 1.0, MOST_WIDE))

    def _around(self, level: int, nodes: Indices, width: float) -> Indices:
        """Return triangles of a level, among them all within ``width`` of some nodes."""
        clusters = self._clusters[level]
        points = self._points(level)
        reach = np.array([width, width, width, 0])
        low = points[nodes].min(axis=0) - reach
        high = points[nodes].max(axis=0) + reach
        near = self._boxes.members(low[None], high[None], self._steps(level))
        parts = self._members(level)
        nearby = np.concatenate([part for part, hit in zip(parts, near, strict=True) if len(hit)])
        least, most = corner_ends(points, clusters.triangles[nearby])
        inside = (most >= low).all(axis=1) & (least <= high).all(axis=1)
        return np.unique(nearby[inside])


def _most(values: Floats) -> float:
    """Return the value that all but a few do not exceed."""
    at = int(MOST_SHARE * (len(values) - 1))
    return float(np.partition(values, at)[at])


def _lags(size: Floats, nodes: Bools, longest: float) -> tuple[Floats, Floats]:
    """Return lags (M,) up to the greatest length, and their one unit at nodes (1, N)."""
    unit = float(np.percentile(size[nodes], 5))
    count = int(np.clip(np.ceil(np.log2(longest / unit / FIRST_CELLS)), 1, MOST_LAGS - 1))
    lags = longest / unit * 2.0 ** np.arange(-count, 1)
    return np.asarray(lags, dtype=float), np.full_like(size, unit)


def _window(level: Clusters, members: Indices) -> tuple[FlowField, Indices]:
    """Return a field of some triangles, and the numbers of nodes in it, -1 for the others."""
    field = level.field
    triangles = level.triangles[members]
    nodes = np.unique(triangles)
    cells = level.cells[members]
    number = np.full(field.shape[1], -1, dtype=np.intp)
    number[nodes] = np.arange(len(nodes))
    scalars: Scalars[Steps] = Scalars()
    for name, steps in field.scalars.items():
        if name in field.on_cells:
            scalars[name] = steps[:, :, cells]
        else:
            scalars[name] = steps[:, :, nodes]
    part = replace(
        field,
        points=field.points[:, nodes],
        velocity=field.velocity[:, :, nodes],
        valid=np.ones((1, len(nodes)), dtype=bool),
        scalars=scalars,
        triangles=number[triangles],
    )
    return part, number


class Boxes:
    """Boxes from ``steps`` divisions, each of one box into 2 x 2, at medians of points (N, 4).

    A k-d tree divides space at medians, along the longest side of its content, or the numbers of
    connected parts, the fourth coordinate, where these are nested. Two cuts after another make 2 x
    2 boxes of one, in rows and columns, so that boxes of a depth are a square of blocks as those
    of a structured surface are. A box holds all of its space: its outer sides are
    open.

    Boxes of a depth are numbered in the order of their cuts: the last two bits of a number are row
    and column in the parent box, the two before those of the parent in its own.
    """

    def __init__(self, points: Floats, steps: int) -> None:
        self.steps = steps
        self.axes = [np.zeros(1 << n, dtype=np.intp) for n in range(2 * steps)]
        self.values = [np.zeros(1 << n) for n in range(2 * steps)]
        parts = [np.arange(len(points))]
        for axes, values in zip(self.axes, self.values, strict=True):
            halves = []
            for n, part in enumerate(parts):
                axes[n], values[n] = _cut(points[part])
                ahead = points[part, axes[n]] >= values[n]
                halves += [part[~ahead], part[ahead]]
            parts = halves

    def places(self, steps: int) -> tuple[Indices, Indices]:
        """Return the row and column of each box of a depth, (4^steps,)."""
        number = np.arange(4**steps)
        bits = [(number >> 2 * n) & 3 for n in range(steps)]
        row = sum((b >> 1) << n for n, b in enumerate(bits))
        column = sum((b & 1) << n for n, b in enumerate(bits))
        return np.asarray(row), np.asarray(column)

    def members(self, low: Floats, high: Floats, steps: int) -> list[Indices]:
        """Return the numbers of the items from corners ``low`` to ``high``, (M, 4), in each box."""
        parts = [np.arange(len(low))]
        lows, highs = (np.ascontiguousarray(corner.T) for corner in (low, high))
        for axes, values in zip(self.axes[: 2 * steps], self.values, strict=False):
            halves = []
            for part, axis, value in zip(parts, axes, values, strict=True):
                halves += [part[lows[axis][part] < value], part[highs[axis][part] >= value]]
            parts = halves
        return parts

    def bounds(self, steps: int) -> tuple[Floats, Floats]:
        """Return lower and upper corners of the boxes of a depth, (4^steps, 4) each."""
        low = np.full((1, 4), -np.inf)
        high = np.full((1, 4), np.inf)
        for axes, values in zip(self.axes[: 2 * steps], self.values, strict=False):
            low = np.repeat(low, 2, axis=0)
            high = np.repeat(high, 2, axis=0)
            number = np.arange(len(axes))
            high[2 * number, axes] = values
            low[2 * number + 1, axes] = values
        return low, high


def _cut(points: Floats) -> tuple[int, float]:
    """Return axis and value of a cut, with points on both sides unless all coincide."""
    if not len(points):
        return 0, 0.0
    low, high = bounds(points)
    axis = int(np.argmax((high - low)[:3]))
    if high[3] > low[3]:
        part = np.unique(points[:, 3], return_inverse=True)[1]
        if part_extents(points[:, :3], part)[part].mean() > NESTED_SHARE * (high - low)[axis]:
            axis = 3
    along = points[:, axis]
    middle = float(np.partition(along, len(along) // 2)[len(along) // 2])
    if middle <= low[axis] < high[axis]:
        middle = float(along[along > middle].min())
    return axis, middle
