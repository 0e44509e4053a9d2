"""Triangles of a surface that has no rows and columns, by the blocks that they lie in.

Its levels of detail are other surfaces, so all of a block is drawn or nothing. A triangle may lie
in several blocks, and is drawn where one of them is.
"""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats, Indices, Ints
from flowtex.rendering.mesh_levels import MeshLevels
from flowtex.textures import TextureSet, TriangleGeometry


class TriangleBlocks:
    """The triangles that a view needs, as :class:`MeshLevels` has those of a structured surface."""

    def __init__(self, geometry: TriangleGeometry) -> None:
        #: Centre, radius and longest side of a triangle of each block, (rows, columns, 5).
        self.blocks, self._masks = geometry.block_places, geometry.blocks

    @property
    def records(self) -> Floats:
        """The places of blocks, by which a client chooses, (rows, columns, 5)."""
        return self.blocks

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


def mesh_levels_of(textures: TextureSet, *, placed: bool = False) -> MeshLevels | TriangleBlocks:
    """Return the triangles of a texture set's surface, by level and block.

    ``placed`` says that fragments correct their place between the nodes.
    """
    if isinstance(textures.geometry, TriangleGeometry):
        return TriangleBlocks(textures.geometry)
    return MeshLevels.of(textures, placed=placed)
