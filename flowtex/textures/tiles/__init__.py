"""A surface as a pyramid of tiles, each at the detail that a view asks for."""

from __future__ import annotations

from flowtex.textures.tiles.clusters import levels_of
from flowtex.textures.tiles.loader import Tile, TileLoader
from flowtex.textures.tiles.pyramid import (
    BLOCK_CELLS,
    PATH_CELLS,
    TILE_BLOCKS,
    TILE_CELLS,
    Pyramid,
    TileKey,
    block_places,
)
from flowtex.textures.tiles.shared import (
    attach_pyramid,
    coarsened_field,
    drawn_speeds,
    ends_of,
    has_pyramid,
    shared_pyramid,
    usual_ends,
    widened,
)
from flowtex.textures.tiles.structure import STRUCTURE, Structure, check_structure, shared_structure
from flowtex.textures.tiles.triangle_pyramid import TrianglePyramid

__all__ = [
    "BLOCK_CELLS",
    "PATH_CELLS",
    "STRUCTURE",
    "TILE_BLOCKS",
    "TILE_CELLS",
    "Pyramid",
    "Structure",
    "Tile",
    "TileKey",
    "TileLoader",
    "TrianglePyramid",
    "attach_pyramid",
    "block_places",
    "check_structure",
    "coarsened_field",
    "drawn_speeds",
    "ends_of",
    "has_pyramid",
    "levels_of",
    "shared_pyramid",
    "shared_structure",
    "usual_ends",
    "widened",
]
