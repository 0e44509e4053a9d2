"""Which tiles a view asks for.

From the root down, a tile is replaced by those of the next level where its cells cover too many
pixels, and where it is in view. Only what is known of a tile that is there is used, so nothing has
to be read of those that are not.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.rendering.mesh_levels import MeshLevels
from flowtex.settings import Settings
from flowtex.tiles import PATH_CELLS, Pyramid, TileKey

__all__ = ["TileView", "choose_tiles"]

#: Pixels of the longer side of a cell above which the next level is drawn.
CELL_PIXELS = 2.0


@dataclass(frozen=True)
class TileView:
    """What decides on tiles.

    Attributes
    ----------
    eye
        Where the camera is, (3,), in the coordinates of the mesh; ``None`` where rays are parallel.
    half_height
        Half the height of what is seen: a length where rays are parallel, else for a distance of 1.
    pixels
        Height of the picture in pixels, as the settings count them.
    planes
        Planes around what is seen, (N, 4): a point is inside where p . (x, y, z, 1) >= 0.
    cell_pixels
        Pixels of a cell above which the next level is drawn.
    """

    eye: Floats | None
    half_height: float
    pixels: float
    planes: Floats
    cell_pixels: float = CELL_PIXELS

    def sees(self, blocks: Floats) -> Bools:
        """Which blocks (J, I, 5) of a mesh may be in view."""
        center, radius = blocks[..., :3], blocks[..., 3]
        length = np.linalg.norm(self.planes[:, :3], axis=1)
        inside = center @ self.planes[:, :3].T + self.planes[:, 3] >= -radius[..., None] * length
        return np.asarray(inside.all(axis=-1))

    def too_coarse(self, blocks: Floats) -> tuple[Bools, Floats]:
        """Which blocks (J, I, 5) of a mesh want finer ones, and how large their cells are."""
        center, radius, size = blocks[..., :3], blocks[..., 3], blocks[..., 4]
        distance = np.ones(radius.shape)
        if self.eye is not None:
            distance = np.linalg.norm(center - self.eye, axis=-1) - radius
            distance = np.maximum(distance, size)
        pixels = size * 0.5 * self.pixels / (self.half_height * distance)
        return self.sees(blocks) & (pixels > self.cell_pixels), pixels


def cell_pixels(settings: Settings) -> float:
    """Pixels of a cell above which the next level is drawn, where streaks are no longer cut."""
    streak = 0.5 * settings.samples * settings.spacing * settings.grain
    return CELL_PIXELS * max(1.0, 2 * streak / (CELL_PIXELS * PATH_CELLS))


def choose_tiles(
    pyramid: Pyramid,
    view: TileView,
    mesh_of: Callable[[TileKey | None], MeshLevels | None],
) -> list[TileKey]:
    """Return the tiles that a view asks for, each after the one that it refines.

    ``mesh_of`` returns the mesh of a tile, or of the root for ``None``; and ``None`` where there is
    none yet, so that what lies below it waits.
    """
    chosen: list[TileKey] = []
    level: list[TileKey | None] = [None]
    while level:
        found: list[tuple[float, TileKey]] = []
        for key in level:
            mesh = mesh_of(key)
            if mesh is None or (pyramid.depth if key is None else key.level) == 0:
                continue
            wanted, pixels = view.too_coarse(mesh.blocks)
            for child in pyramid.children(key):
                row, column = (
                    2 * (at - (0 if key is None else 2 * parent))
                    for at, parent in zip(child[1:], key[1:] if key else (0, 0), strict=True)
                )
                part = (slice(row, row + 2), slice(column, column + 2))
                if wanted[part].any():
                    found.append((float(pixels[part][wanted[part]].max()), child))
        found.sort(key=lambda pair: -pair[0])
        level = [key for _, key in found]
        chosen += [key for _, key in found]
    return chosen
