"""Tiles of a large surface as a client in a browser is handed them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

from flowtex._util.progress import track
from flowtex.rendering.webgl import ClientData, Colours, tile_parts
from flowtex.rendering.webgl.protocol import Parts
from flowtex.scene import steps_of
from flowtex.textures import TextureSet
from flowtex.tiles import Pyramid, Tile, TileKey, TileLoader

__all__ = ["all_tiles", "packed_tile", "tile_loader"]

#: Colours of the whole, and what is handed over of a tile in them.
Prepared = tuple[Colours, ClientData]

#: Tiles that are made together where all of them are.
TOGETHER = 4


def tile_loader(whole: ClientData, pyramid: Pyramid, **options: Any) -> TileLoader:
    """Return what makes the tiles of a flow; the options are those of :class:`TileLoader`."""

    def prepare(textures: TextureSet) -> Prepared:
        return whole.colours, whole.tile(textures, partial(steps_of, textures.geometry.field))

    return TileLoader(pyramid, prepare=prepare, traces=whole.traced, **options)


def packed_tile(whole: ClientData, tile: Tile, steps: Sequence[int]) -> Parts:
    """Return the arrays of a tile that has been made for these steps, in colours of the whole."""
    data = None
    if tile.prepared is not None:
        colours, data = tile.prepared
        if colours is not whole.colours:
            data = data.recoloured(whole.tile_colours(partial(steps_of, data.field)))
            tile.prepared = whole.colours, data
    for source in map(whole.source, steps):
        if data is not None and tile.layers[source] is not None:
            data.packing.take(source, tile.take(source))
    return tile_parts(tile.key, data, *steps)


def all_tiles(whole: ClientData) -> Iterator[Parts]:
    """Give the arrays of all tiles that a client is handed without asking, coarse ones first."""
    pyramid, steps = whole.pyramid, range(whole.steps)
    if pyramid is None:
        return
    keys: list[TileKey] = []
    level = pyramid.children(None)
    while level and level[0].level >= whole.finest:
        keys += level
        level = (
            [child for key in level for child in pyramid.children(key)] if level[0].level else []
        )
    if whole.traced:
        for key in track(keys, len(keys), "Packing tiles"):
            yield tile_parts(key, _untraced(whole, pyramid, key), *steps)
        return
    sources = [whole.source(step) for step in steps]
    loader = tile_loader(whole, pyramid)
    for n in track(range(0, len(keys), TOGETHER), -(-len(keys) // TOGETHER), "Packing tiles"):
        some = keys[n : n + TOGETHER]
        loader.request(some, sources)
        loader.wait()
        # A page has nobody to ask again.
        for error in loader.errors.values():
            raise error
        for key in some:
            tile = loader.get(key, sources)
            if tile is not None:
                yield packed_tile(whole, tile, steps)
    loader.close()


def _untraced(whole: ClientData, pyramid: Pyramid, key: TileKey) -> ClientData | None:
    """Return what is handed over of a tile that the client traces."""
    textures = pyramid.textures(key)
    if textures is None:
        return None
    return whole.tile(textures, partial(steps_of, textures.geometry.field))
