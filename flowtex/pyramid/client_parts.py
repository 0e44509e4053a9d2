"""What a browser needs to draw a tile beside its traces: the surface, and values to colour it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from flowtex.field import FlowField
from flowtex.pyramid.layout import SURFACE, VALUES, to_write
from flowtex.rendering.webgl import ClientData, Colours, single, tile_parts
from flowtex.rendering.webgl.protocol import parts_file
from flowtex.textures import TextureSet
from flowtex.tiles import Pyramid, TileKey, widened

__all__ = ["write_surface", "write_values"]

#: What of the slices is the same in all tiles, and told by the page.
OF_ALL_TILES = ("steps", "times", "timeUnit", "dates", "pace")


def write_surface(here: Any, pyramid: Pyramid, key: TileKey, textures: TextureSet | None) -> None:
    """Write what a tile is at all times into the group of its level; a page holds the root's."""
    if key.level < pyramid.depth:
        room = here[SURFACE].shape[-1]
        file = np.frombuffer(_surface(pyramid, key, textures), np.uint8)
        here[SURFACE][key.row, key.column] = np.pad(file, (0, room - len(file)))


def write_values(here: Any, key: TileKey, textures: TextureSet, step: int) -> None:
    """Write values at the nodes of a tile at a time step into the group of its level."""
    field, (rows, columns) = textures.geometry.field, textures.geometry.drawn
    for number, name in enumerate(_names(field)):
        values = _steps_of(field, name)
        if step < len(values):
            nodal = single(values[step][rows, columns])
            at = (step, key.row, key.column, number)
            to_write(here, VALUES)[(*at, *(slice(0, n) for n in nodal.shape))] = nodal


def _surface(pyramid: Pyramid, key: TileKey, textures: TextureSet | None) -> bytes:
    """Return the parts of a tile that are the same at all times, as a file."""
    if textures is None:
        return parts_file(tile_parts(key, None))
    data = ClientData(textures, _colours(pyramid, textures.geometry.field))
    parts, header = tile_parts(key, data), data.tile_header
    told = {
        "geometry": header["geometry"],
        "slices": {k: v for k, v in header["slices"].items() if k not in OF_ALL_TILES},
        # By these the errors of the colours are measured.
        "ranges": {choice["name"]: [choice["low"], choice["high"]] for choice in _choices(pyramid)},
    }
    name = next(iter(parts))
    return parts_file({**parts, name: np.frombuffer(json.dumps(told).encode(), np.uint8)})


def _colours(pyramid: Pyramid, field: FlowField) -> Colours:
    """Return colours by the speed, with all that a person may choose in its place."""
    choices = _choices(pyramid)
    first, *others = (_steps_of(field, choice["name"]) for choice in choices)
    return Colours(
        name=choices[0]["name"],
        values=first,
        low=choices[0]["low"],
        high=choices[0]["high"],
        choices=choices,
        others=tuple(enumerate(others, start=1)),
    )


def _choices(pyramid: Pyramid) -> tuple[dict[str, Any], ...]:
    ranges = {name: widened(pyramid.ranges.get((name, False))) for name in _names(pyramid.root)}
    return tuple({"name": name, "low": low, "high": high} for name, (low, high) in ranges.items())


def _names(field: FlowField) -> tuple[str, ...]:
    return tuple(dict.fromkeys(("speed", *field.scalars)))


def _steps_of(field: FlowField, name: str) -> Any:
    if name in field.scalars:
        return field.scalars[name]
    return field.speed
