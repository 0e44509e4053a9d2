"""A field on a grid at every level of detail, cut into tiles.

Levels have every second line of the level before, with velocities averaged over the lines that are
left out. The halo around a tile is as wide as its paths are long: the same number of cells at every
level.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.arrays import norm
from flowtex.field import FlowField
from flowtex.field.scalars import Scalars
from flowtex.field.steps import Nodes, Steps, map_steps
from flowtex.textures.geometry import SurfaceGeometry
from flowtex.textures.texture_set import TextureSet
from flowtex.textures.tiles.blocks import (
    BLOCK_CELLS,
    block_places,
    block_roughness,
    enlarging,
    has_roughness,
)
from flowtex.textures.tiles.grid_levels import (
    averaged,
    beside,
    level_lines,
    level_shape,
    root_level,
)
from flowtex.textures.tiles.pyramid import PATH_CELLS, Pyramid, TileKey
from flowtex.trace.slices import FIRST_CELLS, small_cell
from flowtex.trace.store import SliceStore
from flowtex.trace.trace import paths

#: Fewest nodes of the root of a smooth field.
SMOOTH_NODES = 5_000
#: Share of the blocks of a level whose cells may be twice as large in a smooth field.
SMOOTH_SHARE = 0.75
#: Blocks along a side of a tile.
TILE_BLOCKS = 4
TILE_CELLS = BLOCK_CELLS * TILE_BLOCKS
#: First lag in cells where a finer level is drawn before cells cover more than a few pixels: the
#: parabolas up to there are off by hundredths of a pixel.
COARSE_FIRST_CELLS = 1.0
#: Width of a halo in lengths of the paths, for cells that grow smaller beyond a tile.
HALO_SHARE = 1.2
#: Additional lines of a halo.
HALO_SPARE = 3
#: Greatest width of a halo in lines.
MOST_HALO = 512
#: Most nodes of a window; halos are narrower where there would be more.
MOST_WINDOW = 600_000
#: Most nodes of a window around a pole for composed paths: in a larger one all are traced.
MOST_COMPOSED = 500_000
#: Share of a path's length that must not be cut.
NEEDED_SHARE = 0.75
#: Most cut paths as a share of the paths of a tile.
MOST_CUT_SHARE = 5e-3
#: Step between the lines that are sampled for cut paths.
SAMPLED_LINES = 8


class _Level(NamedTuple):
    """Lines of nodes of a level, numbered as in the field, and the velocity at their nodes."""

    rows: Indices
    columns: Indices
    velocity: Steps


class GridPyramid(Pyramid):
    """The levels of a field on a grid and their tiles; parameters are those of a pyramid.

    By default ``nodes`` are those of the field, and ``depth`` follows from them and from how smooth
    the field is.
    """

    tile_blocks = TILE_BLOCKS
    most_grouped = 400_000

    def __init__(
        self,
        field: FlowField,
        parameter: str = "arclength",
        lines: str = "pathlines",
        *,
        nodes: tuple[int, int] | None = None,
        depth: int | None = None,
    ) -> None:
        nodes = nodes or field.shape
        is_depth_known = depth is not None
        if depth is None:
            depth = root_level(nodes)
        super().__init__(field, parameter, lines, nodes=nodes, depth=depth)
        self._places: dict[int, Floats] = {}
        rows, columns = map(np.arange, field.shape)
        self._levels = [_Level(rows, columns, field.velocity)]
        self._roughness: dict[int, Floats] = {}
        self._has_roughness = not is_depth_known and has_roughness(field)
        while self._has_roughness and math.prod(self.shape(self.depth + 1)) >= SMOOTH_NODES:
            if np.mean(self.enlarged(self.depth + 1) >= 2) < SMOOTH_SHARE:
                break
            self.depth += 1

    @cached_property
    def root_geometry(self) -> SurfaceGeometry:
        """The root as it is drawn."""
        return SurfaceGeometry.of(self.root)

    def at_level(self, level: int) -> FlowField:
        """Return the whole field at a level."""
        rows, columns = (np.arange(n) for n in self.shape(level))
        return self._part(level, rows, columns, self.field.periodic)

    def lines_at(self, level: int, rows: Indices, columns: Indices) -> FlowField:
        """Return some successive lines of a level, also beyond the ends of a closed axis."""
        return self._part(level, rows, columns, (False, False))

    @property
    def blocks(self) -> tuple[int, int]:
        """Rows and columns of blocks at level 0."""
        rows = max(-(-(self.nodes[0] - 1) // BLOCK_CELLS), 1)
        columns = max(-(-(self.nodes[1] - 1) // BLOCK_CELLS), 1)
        return rows, columns

    def visible_blocks(self, places: Floats32) -> Bools:
        """Return which blocks of level 0 have some of the places of a pass."""
        geometry = self.root_geometry
        size = np.array(geometry.size[::-1])
        before = geometry.padding[::-1]
        cell = (places[:, :2] * size - 0.5 - before) * (1 << self.depth) // BLOCK_CELLS
        column, row = np.clip(cell.astype(int), 0, np.array(self.blocks[::-1]) - 1).T
        visible = np.zeros(self.blocks, dtype=bool)
        visible[row, column] = True
        # Where the root has no cells, as along a coast, finer levels may have some.
        ends = [((np.argwhere(~geometry.cells) + n << self.depth) - n) for n in (0, 1)]
        first, last = (np.minimum(end // BLOCK_CELLS, np.array(self.blocks) - 1) for end in ends)
        for j, i in np.ndindex(*(np.max(last - first, axis=0, initial=0) + 1)):
            visible[tuple(np.minimum(first + np.array([j, i]), last).T)] = True
        return visible

    def places(self, level: int) -> Floats:
        """Return where the blocks of a level lie, as :func:`block_places` does, from the root.

        So the place of a tile is known before its nodes are read.
        """
        if level not in self._places:
            finer = self.depth - level
            places = block_places(self.root.surface.points, BLOCK_CELLS >> finer)
            places[..., 4] /= 1 << finer
            self._places[level] = places
        return self._places[level]

    def enlarged(self, level: int) -> Floats:
        """Return factors by which cells of blocks may be larger, (rows, columns)."""
        if not (level and self._has_roughness):
            return np.ones(self.places(level).shape[:2])
        greatest = np.zeros(())
        for coarser in range(max(level - 1, 1), level + 1):
            if coarser not in self._roughness:
                lines = map(np.arange, self.shape(coarser - 1))
                nodes: FlowField | Nodes
                if coarser == 1:
                    nodes = self.field
                else:
                    nodes = self._nodes(coarser - 1, *lines)
                self._roughness[coarser] = block_roughness(nodes, BLOCK_CELLS)
            errors = self._roughness[coarser]
            if coarser < level:
                for axis, count in enumerate(errors.shape):
                    errors = np.maximum.reduceat(errors, np.arange(0, count, 2), axis)
            greatest = np.maximum(greatest, errors)
        return enlarging(greatest)

    def shape(self, level: int) -> tuple[int, int]:
        """Return the number of nodes (J, I) of a level."""
        return level_shape(self.nodes, level)

    def line_numbers(self, level: int) -> tuple[Indices, Indices]:
        """Return the numbers of the rows and columns of a level in level 0."""
        rows = level_lines(self.nodes[0], level)
        columns = level_lines(self.nodes[1], level)
        return rows, columns

    def children(self, key: TileKey | None) -> list[TileKey]:
        """Return tiles of the next level that cover a tile, or the root for ``None``."""
        if (self.depth if key is None else key.level) == 0:
            return []
        if key is None:
            level = self.depth - 1
            rows, columns = (range(-(-(n - 1) // TILE_CELLS)) for n in self.shape(level))
        else:
            level = key.level - 1
            counts = (-(-(n - 1) // TILE_CELLS) for n in self.shape(level))
            rows, columns = (
                range(2 * at, min(2 * at + 2, count))
                for at, count in zip(key[1:], counts, strict=True)
            )
        found = []
        for j in rows:
            for i in columns:
                found.append(TileKey(level, j, i))
        return found

    def _nodes_of(self, keys: Sequence[TileKey]) -> int:
        """Return about how many nodes are traced for tiles of a level."""
        (first, last) = self._box(keys)
        halo = int(HALO_SHARE * PATH_CELLS) + HALO_SPARE
        shape = self.shape(keys[0].level)
        return math.prod(
            min(b - a + 2 * halo, n) for a, b, n in zip(first, last, shape, strict=True)
        )

    def _box(self, keys: Sequence[TileKey]) -> tuple[list[int], list[int]]:
        """Return the first and the last lines of nodes of tiles of a level."""
        first = [TILE_CELLS * min(at) for at in tuple(zip(*keys, strict=True))[1:]]
        last = [TILE_CELLS * (max(at) + 1) for at in tuple(zip(*keys, strict=True))[1:]]
        return first, [min(b, n - 1) for b, n in zip(last, self.shape(keys[0].level), strict=True)]

    def is_cut(self, textures: TextureSet, step: int) -> bool:
        """Return whether paths of a tile end where its window does, though the surface continues.

        Slices may have longer lags than are needed: they double. The last part of a path weighs
        little.
        """
        return is_cut(textures, step)

    @cached_property
    def _cell(self) -> float:
        return small_cell(self.root)

    def region(
        self, keys: Sequence[TileKey], widening: int = 1
    ) -> dict[TileKey, TextureSet | None]:
        """Return the textures of tiles, each with a halo around it.

        Raises
        ------
        KeyError
            When a tile does not exist.
        """
        level = keys[0].level
        shape = self.shape(level) if 0 <= level < self.depth else (0, 0)
        for key in keys:
            if not all(0 <= at * TILE_CELLS < n - 1 for at, n in zip(key[1:], shape, strict=True)):
                raise KeyError(
                    f"tile {tuple(key)} does not exist; expected a level from 0 to {self.depth - 1}"
                )
        first, last = self._box(keys)
        points, valid = self._positions(
            level, *(np.arange(a, b + 1) for a, b in zip(first, last, strict=True))
        )
        cells = valid[:-1, :-1] & valid[1:, :-1] & valid[:-1, 1:] & valid[1:, 1:]
        made: dict[TileKey, TextureSet | None] = dict.fromkeys(keys)
        boxes = {key: self._box([key]) for key in keys}
        starts = {key: np.subtract(box[0], first) for key, box in boxes.items()}
        shown = [k for k, (j, i) in starts.items() if cells[j:, i:][:TILE_CELLS, :TILE_CELLS].any()]
        if not shown:
            return made
        longest, widths = _reach(points, valid)
        halo = _within_window(
            [b - a + 1 for a, b in zip(first, last, strict=True)],
            [min(widening * width, MOST_HALO) for width in widths],
        )
        lines, closed, is_small = self._window(level, first, last, halo)
        sides = [
            (not c and (p or int(line[0]) > 0), not c and (p or int(line[-1]) < n - 1))
            for c, p, line, n in zip(closed, self.field.periodic, lines, shape, strict=True)
        ]
        field = self._part(level, lines[0], lines[1], closed)
        nodes = np.zeros(field.shape, dtype=bool)
        geometries = {}
        for key in shown:
            rows, columns = (
                slice(a - int(line[0]), b - int(line[0]) + 1)
                for a, b, line in zip(*boxes[key], lines, strict=True)
            )
            geometries[key] = SurfaceGeometry.of_tile(
                field, (rows, columns), self.root.surface, (sides[0], sides[1])
            )
            nodes[geometries[key].texels] = True
        store = SliceStore(
            field,
            parameter=self.parameter,
            lines=self.lines,
            compose=(field.steady or self.lines == "streamlines") and is_small,
            longest=longest,
            first_cells=COARSE_FIRST_CELLS if level else FIRST_CELLS,
            cell=self._cell,
            nodes=nodes,
        )
        for key, geometry in geometries.items():
            made[key] = TextureSet(geometry, store, whole_speed=self.whole_speed, longest=longest)
        return made

    def _window(
        self, level: int, first: list[int], last: list[int], halo: list[int]
    ) -> tuple[list[Indices], tuple[bool, bool], bool]:
        """Return the lines around a tile, whether each axis closes, and if paths are composed."""
        shape = self.shape(level)
        lines = [np.arange(a - h, b + h + 1) for a, b, h in zip(first, last, halo, strict=True)]
        around = self._around_pole(lines, shape)
        closed = [around == axis for axis in (0, 1)]
        for axis, (count, cells) in enumerate(zip(shape, np.subtract(last, first), strict=True)):
            if axis == around:
                # A particle that passes a pole comes out on its far side: it needs all of the ring.
                aside = min(max(count - 1 - cells, 0) // 2, BLOCK_CELLS)
                lines[axis] = _ring(cells + 2 * aside, count) + first[axis] - aside
            elif self.field.periodic[axis] and len(lines[axis]) >= count:
                aside = min((count - 1 - cells) // 2, BLOCK_CELLS)
                lines[axis] = np.arange(count) + first[axis] - aside
                closed[axis] = True
            elif not self.field.periodic[axis]:
                lines[axis] = lines[axis][(lines[axis] >= 0) & (lines[axis] < count)]
        is_small = around is None or len(lines[0]) * len(lines[1]) <= MOST_COMPOSED
        return lines, (closed[0], closed[1]), is_small

    def _around_pole(self, lines: list[Indices], shape: tuple[int, int]) -> int | None:
        """Return the axis that goes around a pole, if some lines lie beyond that pole."""
        for pole in self.root.surface.poles or ():
            axis = 1 - pole.component
            if lines[axis][0] < 0 if pole.inward > 0 else lines[axis][-1] >= shape[axis]:
                return pole.component
        return None

    def _part(
        self, level: int, rows: Indices, columns: Indices, periodic: tuple[bool, bool]
    ) -> FlowField:
        """Return some lines of a level, which may lie beyond a period on axes not ``periodic``."""
        (turns_j, rows), (turns_i, columns) = (
            np.divmod(lines, count - 1) if closed else (np.zeros_like(lines), lines)
            for lines, count, closed in zip(
                (rows, columns), self.shape(level), self.field.periodic, strict=True
            )
        )
        nodes = self._nodes(level, rows, columns)
        points = nodes.points
        for axis, turns in ((0, turns_j[:, None, None]), (1, turns_i[None, :, None])):
            if turns.any():
                points = points + turns * self.periods[axis]
        return replace(
            self.field,
            points=points,
            velocity=map_steps(nodes.velocity, lambda v: np.where(nodes.valid[..., None], v, 0.0)),
            valid=nodes.valid,
            periodic=periodic,
            has_position=nodes.has_position,
            scalars=Scalars(nodes.scalars),
            formula=None,
        )

    def _positions(self, level: int, rows: Indices, columns: Indices) -> tuple[Floats, Bools]:
        """Return where nodes of a level are, (J, I, 3), and which of them are valid, (J, I)."""
        j, i = self.line_numbers(level)
        at = np.ix_(j[rows], i[columns])
        return self.field.points[at], self.field.valid[at]

    def _nodes(self, level: int, rows: Indices, columns: Indices) -> Nodes:
        """Return the data at some lines of a level, by their numbers within it."""
        stored = self._level(level)
        field = self.field
        at = np.ix_(stored.rows[rows], stored.columns[columns])
        within = np.ix_(rows, columns)
        return Nodes(
            field.points[at],
            field.valid[at],
            stored.velocity[:, within[0], within[1]],
            {k: s[:, at[0], at[1]] for k, s in field.scalars.items()},
            None if field.has_position is None else field.has_position[at],
        )

    @cached_property
    def periods(self) -> tuple[Floats, Floats]:
        """Vectors from the first line of an axis to the last, (3,), for both axes."""
        p = self.field.points
        rows = np.mean(np.take(p, -1, axis=0) - np.take(p, 0, axis=0), axis=0)
        columns = np.mean(np.take(p, -1, axis=1) - np.take(p, 0, axis=1), axis=0)
        return rows, columns

    def _level(self, level: int) -> _Level:
        """Return a level, making those before it first."""
        with self._lock:
            while len(self._levels) <= level:
                fine = self._levels[-1]
                picks = self.line_numbers(len(self._levels))
                valid = self.field.valid[np.ix_(fine.rows, fine.columns)]
                rows, columns = (
                    beside(np.searchsorted(lines, new), len(lines), closed=closed)
                    for lines, new, closed in zip(fine[:2], picks, self.field.periodic, strict=True)
                )
                mean = partial(averaged, valid=valid, rows=rows, columns=columns)
                self._levels.append(_Level(*picks, map_steps(fine.velocity, mean)))
            return self._levels[level]


def is_cut(textures: TextureSet, step: int) -> bool:
    """Return whether paths of a tile end where its window does, though the surface continues.

    Slices may have longer lags than are needed: they double. The last part of a path weighs little.
    """
    store = textures.store
    field = textures.geometry.field
    needed = NEEDED_SHARE * textures.longest / textures.pace
    first = step
    last = step + 1
    if not store.streamlines:
        near = np.flatnonzero(np.abs(field.times - field.times[step]) <= needed)
        first = max(int(near[0]) - 1, 0)
        last = min(int(near[-1]) + 2, len(field.times))
    moment = field.at_steps(range(first, last))
    j, i = (np.arange(n)[p] for n, p in zip(field.shape, textures.geometry.texels, strict=True))
    # The greatest velocity bounds the lengths of all paths.
    flow = moment.index_velocity
    is_open = np.array(textures.grid.open_sides)
    if store.parameter == "arclength":
        speed = np.maximum(flow.speed, np.finfo(float).tiny)
    else:
        speed = 1.0
    rate = np.abs(np.asarray(flow.components)) / np.asarray(speed)[..., None]
    room = np.array([(k[0], n - 1 - k[-1]) for k, n in zip((j, i), field.shape, strict=True)])
    if (room > needed * rate.max(axis=(0, 1, 2))[::-1, None])[is_open].all():
        return False
    start = np.stack(np.meshgrid(i[::SAMPLED_LINES], j[::SAMPLED_LINES]), axis=-1).reshape(-1, 2)
    start = start[field.valid[start[:, 1], start[:, 0]]]
    for forward in (False, True):
        followed = paths(
            moment, start, [needed], step=step - first, parameter=store.parameter, forward=forward
        )
        outside = np.zeros(len(start), dtype=bool)
        for axis, (before, after) in enumerate(textures.grid.open_sides):
            at = followed.positions[0, :, 1 - axis]
            end = field.shape[axis] - 1
            outside |= (before & (at < 0)) | (after & (at > end))
        if (outside & (followed.reach < needed)).sum() > MOST_CUT_SHARE * len(start):
            return True
    return False


def _reach(points: Floats, valid: Bools) -> tuple[float, tuple[int, int]]:
    """Return the path length in a tile (J, I, 3), and the rows and columns of its halo."""
    sides = []
    for axis in (0, 1):
        nodes = np.moveaxis(valid, axis, 0)
        size = norm(np.diff(points, axis=axis))
        lengths = np.moveaxis(size, axis, 0)[nodes[1:] & nodes[:-1]]
        sides.append(np.percentile(lengths[lengths > 0], (5, 95)) if lengths.any() else np.ones(2))
    # A little less, so that rounding does not double the lag for even cells.
    longest = 0.99 * PATH_CELLS * max(float(most) for _, most in sides)
    rows, columns = (int(HALO_SHARE * longest / least) + HALO_SPARE for least, _ in sides)
    return longest, (rows, columns)


def _within_window(tile: list[int], halo: list[int]) -> list[int]:
    """Return halos along rows and columns, narrower where the window has too many nodes."""
    while any(halo) and (tile[0] + 2 * halo[0]) * (tile[1] + 2 * halo[1]) > MOST_WINDOW:
        widest = int(halo[1] > halo[0])
        halo[widest] -= -(-halo[widest] // 8)
    return halo


def _ring(near: int, count: int) -> Indices:
    """Return numbers of the lines around a pole, from 0 to the one that repeats the first.

    They are all of those up to ``near``. Beyond, the spacing doubles with the distance from the
    tile: a path comes so far only where lines are so close together that it is at most a long cell.
    """
    last = near + count - 1
    ahead = [near]
    step = 1
    while ahead[-1] + 1.5 * step <= last / 2:
        ahead.append(ahead[-1] + step)
        step = 1 << int(math.log2((ahead[-1] - near + BLOCK_CELLS) / PATH_CELLS))
    return np.unique([*range(near), *ahead, last // 2, *(last - line for line in ahead)])
