"""A surface as a pyramid of tiles, each at the detail that a view asks for."""

from __future__ import annotations

from flowtex.tiles.loader import Tile, TileLoader
from flowtex.tiles.pyramid import (
    BLOCK_CELLS,
    PATH_CELLS,
    TILE_BLOCKS,
    Pyramid,
    TileKey,
    block_places,
    shared_pyramid,
)

__all__ = [
    "BLOCK_CELLS",
    "PATH_CELLS",
    "TILE_BLOCKS",
    "Pyramid",
    "Tile",
    "TileKey",
    "TileLoader",
    "block_places",
    "shared_pyramid",
]
