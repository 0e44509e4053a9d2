"""Choice of the tiles that a view needs.

From the root down, a block is replaced by finer ones where its cells cover too many pixels, and
where it is in view.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import norm
from flowtex.settings import Settings
from flowtex.textures.tiles.pyramid import PATH_CELLS, Pyramid, TileKey

CELL_PIXELS = 4.0  #: Pixels of the longer side of a cell above which the next level is drawn.


@dataclass(frozen=True)
class TileView:
    """The numbers of a view by which tiles are chosen."""

    eye: Floats | None  #: Position of the camera, (3,); ``None`` where rays are parallel.
    half_height: float  #: Half the height of what is seen: a length, or for a distance of 1.
    pixels: float  #: Height of the picture in pixels, as the settings count them.
    planes: Floats  #: Planes around what is seen, (N, 4): inside p . (x, y, z, 1) >= 0.
    cell_pixels: float = CELL_PIXELS  #: Pixels of a cell above which the next level is drawn.
    visible: Bools | None = None  #: Blocks of level 0 that nothing hides, if known.

    def sees(self, points: Floats, reach: Floats) -> Bools:
        """Return which balls around points (..., 3) of a mesh, with radii (...), may be in view."""
        slack = reach[..., None] * norm(self.planes[:, :3])
        inside = points @ self.planes[:, :3].T + self.planes[:, 3] >= -slack
        return np.asarray(inside.all(axis=-1))

    def distances(self, points: Floats) -> Floats:
        """Return distances of points (..., 3) from the eye, or 1 where rays are parallel."""
        if self.eye is None:
            return np.ones(points.shape[:-1])
        return norm(points - self.eye)

    def pixel(self, distance: Floats) -> Floats:
        """Return the length that a pixel covers at distances from the eye."""
        return 2 * self.half_height / self.pixels * distance

    def cell_sizes(self, blocks: Floats) -> Floats:
        """Return the greatest size of the cells of blocks (J, I, 5), in pixels."""
        radius = blocks[..., 3]
        size = blocks[..., 4]
        distance = self.distances(blocks[..., :3])
        if self.eye is not None:
            distance = np.maximum(distance - radius, size)
        return np.asarray(size / self.pixel(distance))


def cell_pixels(settings: Settings) -> float:
    """Return the pixels of a cell above which the next level is drawn; it cuts no streaks."""
    streak = 0.5 * settings.samples * settings.spacing * settings.grain
    return CELL_PIXELS * max(1.0, 2 * streak / (CELL_PIXELS * PATH_CELLS))


@dataclass
class Choice:
    """The cells of a tile, or of the root, that a view needs."""

    needed: bool  #: Whether some of its own cells are to be shown.
    pixels: float  #: Size of the largest of those cells in pixels.
    finer: list[TileKey]  #: The tiles that are to be shown in place of its larger cells.


Choices = dict[TileKey | None, Choice]  #: By tile, coarse ones first; ``None`` is the root.


def choose_tiles(pyramid: Pyramid, view: TileView) -> Choices:
    """Return the choice of a view for each tile that is in it."""
    chosen: Choices = {}
    waiting: list[TileKey | None] = [None]
    while waiting:
        key = waiting.pop(0)
        if key is None:
            level = pyramid.depth
        else:
            level = key.level
        rows, columns = pyramid.blocks_of(key)
        places = pyramid.places(level)[rows, columns]
        seen = view.sees(places[..., :3], places[..., 3])
        pixels = view.cell_sizes(places)
        if (visible := view.visible) is not None:
            for axis, count in enumerate(visible.shape):
                visible = np.logical_or.reduceat(visible, np.arange(0, count, 1 << level), axis)
            seen &= visible[rows, columns]
        if level:
            coarse = seen & (pixels > view.cell_pixels)
        else:
            coarse = np.zeros_like(seen)
        if coarse.any():
            pixels = view.cell_sizes(pyramid.smooth_places(level)[rows, columns])
            coarse &= pixels > view.cell_pixels
        shown = seen & ~coarse
        if coarse.any():
            children = pyramid.children(key)
        else:
            children = []
        finer = []
        for child in children:
            if coarse[finer_part(pyramid, child, key)].any():
                finer.append(child)
        chosen[key] = Choice(bool(shown.any()), float(pixels[shown].max(initial=0.0)), finer)
        waiting += finer
    return chosen


def finer_part(pyramid: Pyramid, child: TileKey, above: TileKey | None) -> tuple[slice, slice]:
    """Return the blocks of a tile, or of the root, that a tile of the next level covers."""
    half = pyramid.tile_blocks // 2
    row, column = (
        half * index - pyramid.tile_blocks * place
        for index, place in zip(child[1:], above[1:] if above else (0, 0), strict=True)
    )
    return slice(row, row + half), slice(column, column + half)


def wanted_tiles(chosen: Choices) -> list[TileKey]:
    """Return the tiles that have cells to show, the largest cells first."""
    wanted = [key for key, choice in chosen.items() if key is not None and choice.needed]
    return sorted(wanted, key=lambda key: -chosen[key].pixels)


def cover(chosen: Choices, ready: Callable[[TileKey], bool]) -> dict[TileKey | None, list[TileKey]]:
    """Return the tiles to show among the ready ones, and the parts of each that others cover.

    A tile is replaced by finer ones where these cover all of it that is in view; until then the
    tiles of a coarser level are shown. The root is always ready.
    """
    shown: dict[TileKey | None, list[TileKey]] = {}

    def covered(key: TileKey | None) -> bool:
        """Show a tile, by itself or by finer ones, and return whether that is possible."""
        choice = chosen[key]
        ready_children = [child for child in choice.finer if covered(child)]
        if key is not None and not choice.needed and len(ready_children) == len(choice.finer):
            return True
        if key is not None and not ready(key):
            for child in ready_children:
                _hide(child)
            return False
        shown[key] = ready_children
        return True

    def _hide(key: TileKey) -> None:
        shown.pop(key, None)
        for child in chosen[key].finer:
            _hide(child)

    covered(None)
    return dict(sorted(shown.items(), key=lambda item: item[0] is not None and -item[0].level))
