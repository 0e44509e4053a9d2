"""Triangles of a structured surface, in the number that a view needs.

A surface is cut into blocks of :data:`BLOCK_CELLS` cells a side. Each is drawn with every 2^l-th
node, as few as keep the error on the screen below :data:`MAX_ERROR_PIXELS`: triangles smaller than
a few pixels are shaded several times over. Along the border of two blocks, also of tiles of
different levels, the finer one moves its extra nodes to those of the coarser one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices, Ints
from flowtex._util.arrays import dot, norm
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.blocks import BLOCK_CELLS, block_places
from flowtex.textures.triangle_geometry import TriangleGeometry

MAX_ERROR_PIXELS = 0.05  #: Distance on the screen between a node and the triangle that replaces it.
OUTLINE_SHARE = 0.2  #: Weight of an error of the outline: a quarter of a pixel across it.
PLACED_SHARE = 0.0125  #: Weight of an error along the surface: four pixels.
HEIGHT_SHARE = 0.1  #: Weight of an error across the surface: half a pixel.
MAX_SIDE_HEIGHTS = 2.0  #: Longest side of a triangle, in heights of the view.
LEAST_DISTANCE = 1e-3  #: Nearest that a block is taken to be, as a share of its radius.


class MeshLevels:
    """The levels of a surface's mesh, and the triangles that a view needs.

    Nodes are (J, I, 3), and cells that are drawn (J - 1, I - 1); along a periodic axis, j or i, the
    first line of nodes lies where the last one does. ``slide`` and ``height`` are the weights of
    errors along the surface and across it, from 0 to 1.
    """

    def __init__(
        self,
        points: Floats,
        cells: Bools,
        periodic: tuple[bool, bool] = (False, False),
        slide: float = 0.1,
        height: float = 1.0,
    ) -> None:
        self._shape: tuple[int, int] = points.shape[0], points.shape[1]
        self._cells = cells
        self._periodic = periodic
        self._slide = slide
        self._height = height
        points = np.where(np.isfinite(points), points, 0.0)
        #: Greatest distance of a node from the triangles of each level, (L, rows, columns) of
        #: blocks; of its outline, and along the surface, shares of it.
        self.error = self._errors(points)
        size = [BLOCK_CELLS, BLOCK_CELLS]
        #: Blocks of which something is drawn, (rows, columns).
        self._has_cells = _in_blocks(cells, size)
        # No coarse cell covers blanked cells and others, nor lies beside blanked ones of the next
        # block: where sides of drawn cells there are moved along the border, gaps would open.
        edges: Any = ["wrap" if closed else "nearest" for closed in periodic]
        near_blank = scipy.ndimage.maximum_filter(~cells, 3, mode=edges)
        self.error[1:, self._has_cells & _in_blocks(near_blank, size)] = np.inf
        #: Blocks with blanked cells and others along their border, (rows, columns).
        self.ragged = self._has_cells & _in_blocks(~cells & _beside_borders(cells.shape), size)
        #: Centre, radius, and longest side of a cell of each block, (rows, columns, 5) of blocks.
        self.blocks = block_places(points)

    def levels(self, eye: Floats | None, half_height: float, pixels: int) -> Ints:
        """Return the level of each block, (block rows, block columns): 0 has every node.

        Blocks without cells have -1. The eye is (3,), or ``None`` where all rays are parallel; half
        the height of what is seen is a length then, and else for a distance of one. The picture is
        so many ``pixels`` high.
        """
        radius = self.blocks[..., 3]
        cell_size = self.blocks[..., 4]
        distance = np.ones(radius.shape)
        if eye is not None:
            distance = np.linalg.norm(self.blocks[..., :3] - eye, axis=-1) - radius
            distance = np.maximum(distance, LEAST_DISTANCE * radius)
        with np.errstate(all="ignore"):  # where numbers end, every node is drawn
            scale = 0.5 * pixels / (half_height * distance)
            side = cell_size * scale * 2.0 ** np.arange(len(self.error))[:, None, None]
            exact = self.error * scale <= MAX_ERROR_PIXELS
        # Cells within a pixel may be left out, however rough they are.
        fits = exact | (np.isfinite(self.error) & (side <= 1.0))
        fits &= side <= MAX_SIDE_HEIGHTS * pixels
        fits[0] = True
        levels: Ints = np.argmin(fits, axis=0) - 1 + len(fits) * fits.all(axis=0)
        # They are no neighbours of others, whose outline keeps its nodes.
        levels[~self._has_cells] = -1
        return levels

    def triangles(self, levels: Ints, joins: Ints | None = None) -> Indices:
        """Return the nodes of the triangles, (N, 3), numbered row by row.

        A level of -1 leaves a block out. Joins are the levels of the borders below, above, left and
        right of each block, (4, block rows, block columns); by default the coarser one of both
        sides.
        """
        if joins is None:
            whole = Region(0, 0, 0, levels)
            joins = join([whole], (levels.shape[0], levels.shape[1]), self._periodic)[0]
        parts = []
        for level in np.unique(levels[levels >= 0]):
            parts.append(self._triangles_of(np.nonzero(levels == level), int(level), joins))
        return np.concatenate(parts or [np.empty((0, 3), np.intp)])

    def _triangles_of(self, blocks: tuple[Indices, ...], level: int, border: Ints) -> Indices:
        step = 1 << level
        places = np.arange(BLOCK_CELLS // step + 1) * step
        first_row, first_column = (BLOCK_CELLS * at for at in blocks)
        rows = np.minimum(places, (self._shape[0] - 1 - first_row)[:, None])
        columns = np.minimum(places, (self._shape[1] - 1 - first_column)[:, None])
        row = np.broadcast_to(rows[:, :, None], (len(rows), len(places), len(places))).copy()
        column = np.broadcast_to(columns[:, None, :], (len(rows), len(places), len(places))).copy()
        below = border[0][blocks]
        above = border[1][blocks]
        left = border[2][blocks]
        right = border[3][blocks]
        column[:, 0] = _snapped(columns, below)
        column[:, -1] = _snapped(columns, above)
        row[:, :, 0] = _snapped(rows, left)
        row[:, :, -1] = _snapped(rows, right)
        width = self._shape[1]
        node = (row + first_row[:, None, None]) * width + column + first_column[:, None, None]
        drawn = self._cells[
            np.minimum(rows[:, :-1, None] + first_row[:, None, None], self._shape[0] - 2),
            np.minimum(columns[:, None, :-1] + first_column[:, None, None], width - 2),
        ]
        corners = (node[:, :-1, :-1], node[:, :-1, 1:], node[:, 1:, 1:], node[:, 1:, :-1])
        a, b, c, d = (corner[drawn] for corner in corners)
        halves = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=1)
        flat = halves.reshape(-1, 3)
        distinct = (flat[:, 0] != flat[:, 1]) & (flat[:, 1] != flat[:, 2])
        triangles: Indices = flat[distinct & (flat[:, 0] != flat[:, 2])]
        return triangles

    def _errors(self, values: Floats) -> Floats:
        """Return the greatest error of nodes (J, I, 3) in each block at each level, (L, ., .).

        A level leaves out every second line of the one before. Its error is at most that of the
        one before plus the deviation of the omitted lines from their neighbours.
        """
        directions = _directions(values)
        per_block = [BLOCK_CELLS, BLOCK_CELLS]
        lines = [np.arange(n) for n in self._shape]
        errors = [np.zeros(_in_blocks(self._cells, per_block).shape)]
        while max(per_block) > 1:
            error = errors[-1]
            for axis in (0, 1):
                off = self._weighted(_deviation(values, lines[axis], axis), directions, 1 - axis)
                error = error + _in_blocks(_at_cells(off), per_block)
                kept = np.append(np.arange(0, len(lines[axis]) - 1, 2), len(lines[axis]) - 1)
                values = values.take(kept, axis)
                lines[axis] = lines[axis][kept]
                directions = directions.take(kept, axis + 1)
                per_block[axis] //= 2
            twist = values[1:, 1:] + values[:-1, :-1] - values[1:, :-1] - values[:-1, 1:]
            off = self._weighted(twist / 4, directions[:, :-1, :-1])
            errors.append(error + _in_blocks(off, per_block))
        return np.stack(errors)

    def _weighted(self, error: Floats, directions: Floats, border: int | None = None) -> Floats:
        """Return the weighted sizes (J, I) of errors (J, I, 3), on two sides of the outline too."""
        sizes = self._height * np.abs(dot(error, directions[0]))
        np.maximum(sizes, self._slide * norm(error), out=sizes)
        if border is not None:
            ends = (slice(None),) * border + ([0, -1],)
            along = dot(error[ends], directions[1 + border][ends])
            aside = np.sqrt(np.maximum(norm(error[ends]) ** 2 - along**2, 0))
            sizes[ends] = np.maximum(sizes[ends], OUTLINE_SHARE * aside)
        return sizes


def _at_cells(values: Floats) -> Floats:
    values = np.maximum(values[1:], values[:-1])
    return np.maximum(values[:, 1:], values[:, :-1])


def _in_blocks(values: AnyArray, per_block: Sequence[int], most: np.ufunc = np.maximum) -> AnyArray:
    """Return the greatest value (J, I) of cells in each block of so many rows and columns."""
    for axis, count in enumerate(per_block):
        values = most.reduceat(values, np.arange(0, values.shape[axis], count), axis=axis)
    return values


def _beside_borders(shape: tuple[int, ...]) -> Bools:
    """Return which cells (J, I) lie along the borders of blocks."""
    row = np.arange(shape[0]) % BLOCK_CELLS
    column = np.arange(shape[1]) % BLOCK_CELLS
    ends = [0, BLOCK_CELLS - 1]
    return np.asarray(np.isin(row, ends)[:, None] | np.isin(column, ends))


def _directions(points: Floats) -> Floats:
    """Return normals and directions of lines at nodes, (3, J, I, 3), zero where missing."""
    # Only directions count, so no number is too large to be squared.
    points = points / max(float(np.abs(points).max()), np.finfo(float).tiny)
    along_i = np.gradient(points, axis=1)
    along_j = np.gradient(points, axis=0)
    directions = np.stack([np.cross(along_i, along_j), along_i, along_j])
    length = norm(directions)[..., None]
    return np.asarray(directions / np.where(length > 0, length, 1.0))


def _deviation(values: Floats, lines: Indices, axis: int) -> Floats:
    """Return how every second line of values, except the ends, differs from its neighbours."""
    result = np.zeros_like(values)
    at = (slice(None),) * axis
    low = slice(0, len(lines) - 2, 2)
    left = slice(1, len(lines) - 1, 2)
    high = slice(2, len(lines), 2)
    share = (lines[left] - lines[low]) / (lines[high] - lines[low])
    across = values[(*at, high)] - values[(*at, low)]
    omitted = values[(*at, left)] - values[(*at, low)]
    result[(*at, left)] = omitted - np.expand_dims(share, (1 - axis, 2)) * across
    return result


NOT_DRAWN = 99  #: Marks blocks that are not drawn: more doublings than any block has.


class Region(NamedTuple):
    """Where a part of a surface lies among the blocks of its finest nodes, and how it is drawn."""

    step: int  #: Its nodes are every 2^step-th, as are its blocks.
    row: int  #: The block at which it begins.
    column: int
    levels: Ints  #: Of its own blocks; -1 where another part covers them.
    ragged: Bools | None = None  #: As :attr:`MeshLevels.ragged`; ``None`` for none.


def join(
    parts: Sequence[Region], blocks: tuple[int, int], periodic: tuple[bool, bool] = (False, False)
) -> list[Ints]:
    """Return the levels of the borders of each part's blocks, so that no crack opens.

    Levels of the parts are made finer in place, where a neighbour is so much finer that its corner
    would lie inside of a side, and beside finer nodes with blanked cells. ``blocks`` are rows and
    columns of blocks of the finest nodes; along a periodic axis, j or i, the first line of blocks
    follows on the last one.
    """
    # Doublings from the finest nodes to those of each block; blocks not drawn are no neighbours.
    nodes = np.full(blocks, NOT_DRAWN)
    for part in parts:
        _put(nodes, part, np.full_like(part.levels, part.step))
    edges: Any = ["wrap" if closed else "nearest" for closed in periodic]
    finest = scipy.ndimage.minimum_filter(nodes, 3, mode=edges)
    limits = _beside_holes(parts, blocks, edges)
    strides = np.zeros(blocks, dtype=np.int64)  # doublings to the nodes that are drawn
    for part in parts:
        size = 1 << part.step
        least = _in_blocks(_covered(finest, part), [size] * 2, np.minimum)
        limit = least + BLOCK_CELLS.bit_length() - 1 - part.step
        np.minimum(part.levels, limit, out=part.levels)
        doublings = _in_blocks(_covered(limits, part), [size] * 2, np.minimum) - part.step
        np.minimum(part.levels, np.maximum(doublings, 0), out=part.levels)
        _put(strides, part, part.levels + part.step)
    # Lines between blocks, (2, rows + 1, columns + 1): below them, and left of them.
    below = np.pad(strides, ((0, 1), (0, 0))), np.pad(strides, ((1, 0), (0, 0)))
    left = np.pad(strides, ((0, 0), (0, 1))), np.pad(strides, ((0, 0), (1, 0)))
    lines = [np.maximum(*below), np.maximum(*left)]
    while True:
        for axis in (0, 1):
            if axis == 0:
                line = lines[axis]
            else:
                line = lines[axis].T
            if periodic[axis]:
                line[0] = line[-1] = np.maximum(line[0], line[-1])
        joins = []
        before = [line.copy() for line in lines]
        for part in parts:
            joins.append(_joined(part, lines))
        if all(np.array_equal(*pair) for pair in zip(before, lines, strict=True)):
            return joins


def _beside_holes(parts: Sequence[Region], blocks: tuple[int, int], edges: Any) -> Ints:
    """Return the most doublings of nodes in each of the finest blocks, beside holes of others.

    Where finer nodes have blanked cells along the border of a coarser block, that and all blocks
    around it have no larger sides.
    """
    ragged = np.full(blocks, NOT_DRAWN)
    for part in parts:
        if part.ragged is not None:
            _put(ragged, part, np.where(part.ragged, part.step, NOT_DRAWN))
    ragged = scipy.ndimage.minimum_filter(ragged, 3, mode=edges)
    limits = np.full(blocks, NOT_DRAWN)
    for part in parts:
        size = 1 << part.step
        finest = _in_blocks(_covered(ragged, part), [size] * 2, np.minimum)
        _put(limits, part, np.where(finest < part.step, part.step, NOT_DRAWN))
    return np.asarray(scipy.ndimage.minimum_filter(limits, 3, mode=edges))


def _joined(part: Region, lines: list[Ints]) -> Ints:
    """Give each side of a part's blocks one level, the coarsest along it, and return them."""
    size = 1 << part.step
    rows, columns = part.levels.shape
    drawn = part.levels >= 0
    result = np.empty((4, rows, columns), dtype=np.int64)
    for side in range(4):
        axis, is_far = divmod(side, 2)
        if axis == 0:
            line = lines[axis]
            counts = (rows, columns)
            first = (part.row, part.column)
            shown = drawn
        else:
            line = lines[axis].T
            counts = (columns, rows)
            first = (part.column, part.row)
            shown = drawn.T
        picks = np.minimum(first[0] + (np.arange(counts[0]) + is_far) * size, len(line) - 1)
        width = line.shape[1]
        along = first[1] + np.arange(counts[1] * size)
        values = line[np.ix_(picks, np.minimum(along, width - 1))]
        coarsest = values.reshape(counts[0], counts[1], size).max(axis=2)
        spread = np.where(np.repeat(shown, size, axis=1), np.repeat(coarsest, size, axis=1), values)
        inside = along < width
        line[np.ix_(picks, along[inside])] = spread[:, inside]
        result[side] = (coarsest if axis == 0 else coarsest.T) - part.step
    return result


def _put(blocks: Ints, part: Region, values: Ints) -> None:
    """Write values of a part's blocks to the finest blocks below them, where they are drawn."""
    size = 1 << part.step
    spread = np.repeat(np.repeat(values, size, axis=0), size, axis=1)
    drawn = np.repeat(np.repeat(part.levels >= 0, size, axis=0), size, axis=1)
    covered = _covered(blocks, part)
    rows, columns = covered.shape
    np.copyto(covered, spread[:rows, :columns], where=drawn[:rows, :columns])


def _covered(blocks: Ints, part: Region) -> Ints:
    """Return the finest blocks below those of a part."""
    rows = part.levels.shape[0] << part.step
    columns = part.levels.shape[1] << part.step
    return blocks[part.row : part.row + rows, part.column : part.column + columns]


def _snapped(places: Ints, level: Ints) -> Ints:
    """Move places along borders, (N, M), to those of their levels, (N,); the ends stay."""
    step = (1 << level)[:, None]
    return np.where(places == places[:, -1:], places, places // step * step)


class TriangleBlocks:
    """The triangles of a surface without rows and columns, drawn by blocks as a whole."""

    ragged = None  #: Its blocks share their triangles.

    def __init__(self, geometry: TriangleGeometry) -> None:
        #: Centre, radius and longest side of a triangle of each block, (rows, columns, 5).
        self.blocks = geometry.block_places
        self._masks = geometry.blocks

    def levels(self, eye: Floats | None, half_height: float, pixels: int) -> Ints:
        """Return the level of each block, (block rows, block columns): 0, which has every node."""
        del eye, half_height, pixels
        return np.zeros(self.blocks.shape[:2], dtype=np.int64)

    def triangles(self, levels: Ints, joins: Ints | None = None) -> Indices:
        """Return the vertices of the triangles, (N, 3), in blocks with a level of 0 or more."""
        del joins
        mask = np.bitwise_or.reduce(1 << np.flatnonzero(levels.ravel() >= 0), initial=0)
        drawn = np.flatnonzero(self._masks & np.uint16(mask))
        return 3 * drawn[:, None] + np.arange(3)


def mesh_levels_of(textures: TextureSet) -> MeshLevels | TriangleBlocks:
    """Return the triangles of a texture set's surface, by level and block."""
    geometry = textures.geometry
    if isinstance(geometry, TriangleGeometry):
        return TriangleBlocks(geometry)
    # An image lies on the nodes and moves with them; noise is looked up between them.
    if textures.image is None:
        shares = (PLACED_SHARE, HEIGHT_SHARE)
    else:
        shares = (1.0, 1.0)
    return MeshLevels(geometry.points, geometry.cells, geometry.periodic, *shares)
