"""What a browser is handed of a tile: files of its surface, of its flow, and of its values.

The flow is the velocity, from which the client traces, where it can. Where it cannot, along
pathlines, it is slices, with a halo that does for the first, middle and last step.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats, Floats32
from flowtex.field import FlowField
from flowtex.field.steps import typical_steps
from flowtex.pyramid.layout import FILE_BYTES, FILE_CHUNK, FLOW, SURFACE, VALUES
from flowtex.pyramid.places import PyramidError
from flowtex.rendering.webgl import ClientData, Colours, can_trace, single, tile_parts
from flowtex.rendering.webgl.protocol import Parts, parts_file
from flowtex.textures import TextureSet
from flowtex.tiles import Pyramid, TileKey, widened
from flowtex.trace import SliceStore

#: What of the slices is the same in all tiles, and told by the page.
OF_ALL_TILES = ("steps", "times", "timeUnit", "dates", "pace")
#: Error of a value as a share of the range that most of them have.
VALUE_SHARE = 2.0**-17
#: Steps of a rate, which is about one along the flow.
RATE_STEPS = 512


def write_tile(here: Any, pyramid: Pyramid, key: TileKey, steps: Sequence[int], of: str) -> None:
    """Write what a browser is handed of a tile at some times into the group of its level.

    ``of`` tells of which field it is. That of the first step has the surface as well.
    """
    textures = _textures(pyramid, key)
    data, at = None, key[1:]
    if textures is not None:
        data = ClientData(textures, _colours(pyramid, textures.geometry.field))
        # A page of a store may have some of its steps, which pathlines lead through.
        data = replace(data, traces=textures.store.streamlines)
    if 0 in steps and key.level < pyramid.depth:  # a page has the surface of the root
        _write(here[SURFACE], at, of, _surface(pyramid, key, data))
    prefix = f"tile/{key.level}/{key.row}/{key.column}"
    for step in steps:
        parts: Parts = {}
        if data is not None:
            for number, values in enumerate(_values(pyramid, data, step)):
                if values is not None:
                    file = {f"{prefix}/scalars/{step}/{number}": values}
                    _write(here[VALUES], (step, *at, number), of, file)
            named = data.step(step).items()
            flow = {k: v for k, v in named if not k.startswith("scalars/")}
            parts = {
                f"{prefix}/{k}": _shortened(v) if k.startswith("flow/") else v
                for k, v in flow.items()
            }
            data.textures.forget()
        # The last one: by it a tile is known to be whole.
        _write(here[FLOW], (step, *at), of, parts)


def _textures(pyramid: Pyramid, key: TileKey) -> TextureSet | None:
    """Return the textures of a tile, of which those that a browser traces are not traced here."""
    if key.level == pyramid.depth:
        store = SliceStore(pyramid.root, parameter=pyramid.parameter, lines=pyramid.lines)
        return pyramid.root_textures(store)
    textures = pyramid.textures(key)
    if textures is None or (textures.store.streamlines and can_trace(textures)):
        return textures
    return pyramid.tile(key, typical_steps(len(pyramid.root.times)))


def _write(array: Any, at: Sequence[int], of: str, parts: Parts) -> None:
    """Write a file of parts, as whole chunks."""
    told = np.frombuffer(of.encode(), np.uint8)
    file = np.frombuffer(parts_file({"of": told, **parts}, planes=True), np.uint8)
    size = -(-len(file) // FILE_CHUNK) * FILE_CHUNK
    if size > FILE_BYTES:
        msg = (
            f"{array.path} of tile {tuple(at)} takes {size:,} bytes, and a store has room for "
            f"{FILE_BYTES:,}; build with lines='streamlines', or of fewer nodes"
        )
        raise PyramidError(msg)
    array[(*at, slice(0, size))] = np.pad(file, (0, size - len(file)))


def _surface(pyramid: Pyramid, key: TileKey, data: ClientData | None) -> Parts:
    """Return the parts of a tile that are the same at all times."""
    parts = tile_parts(key, data)
    if data is not None:
        header = data.tile_header
        told = {
            "geometry": header["geometry"],
            "slices": {k: v for k, v in header["slices"].items() if k not in OF_ALL_TILES},
            # By these the errors of the colours are measured.
            "ranges": {
                choice["name"]: [choice["low"], choice["high"]] for choice in _choices(pyramid)
            },
        }
        parts[next(iter(parts))] = np.frombuffer(json.dumps(told).encode(), np.uint8)
    return parts


def _values(pyramid: Pyramid, data: ClientData, step: int) -> list[Floats32 | None]:
    """Return the values that a tile is coloured by, rounded to what no colour shows, at a time."""
    result: list[Floats32 | None] = []
    rows, columns = data.textures.grid.drawn
    for name in _names(data.field):
        steps = _steps_of(data.field, name)
        # The flow tells the speed.
        is_derived = data.traced and name not in data.field.scalars
        if is_derived or step >= len(steps):
            result.append(None)
            continue
        values: Floats = np.asarray(steps[step])[rows, columns]
        low, high = pyramid.ranges.get((name, True), (0.0, 0.0))
        if 0 < (unit := 2 * VALUE_SHARE * (high - low)) < np.inf:
            unit = 2.0 ** np.floor(np.log2(unit))
            values = np.rint(values / unit) * unit
        result.append(single(values))
    return result


def _shortened(flow: AnyArray) -> AnyArray:
    """Round velocities (J, I, 3 or 4) to what paths and colours need, so that gzip packs more."""
    result = np.rint(flow * RATE_STEPS) / RATE_STEPS
    bits = np.ascontiguousarray(flow[..., 2:]).view(np.uint16)
    result[..., 2:] = ((bits + 2) & ~np.uint16(3)).view(np.float16)
    return np.asarray(result, "<f2")


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
