"""The data of a tile for browsers: files of its surface, of its flow, and of its values.

The flow is the velocity where the client can trace it. Where it cannot, along pathlines, the flow
is slices, with a halo that is wide enough for the first, middle and last step.
"""

from __future__ import annotations

import json
from collections.abc import Sequence

import numpy as np

from flowtex._util.array_types import Floats, Floats32
from flowtex.field import FlowField
from flowtex.field.derived import steps_of
from flowtex.field.steps import typical_steps
from flowtex.pyramid.layout import (
    FILE_BYTES,
    FILE_CHUNK,
    FLOW,
    SURFACE,
    VALUES,
    Arrays,
    value_names,
)
from flowtex.pyramid.places import PyramidError
from flowtex.pyramid.stored import StoredPyramid
from flowtex.rendering.webgl import ClientData, Colours, can_trace, single, tile_parts
from flowtex.rendering.webgl.protocol import Parts, parts_file
from flowtex.textures import TextureSet
from flowtex.textures.tiles import TileKey, widened
from flowtex.trace import SliceStore

#: Entries of the slices that are the same in all tiles, and in the header of the page.
OF_ALL_TILES = ("steps", "times", "timeUnit", "dates", "pace")
#: Error of a value as a share of the range that most of them have.
VALUE_SHARE = 2.0**-17


def write_tile(array: Arrays, pyramid: StoredPyramid, key: TileKey, steps: Sequence[int]) -> None:
    """Write the data of a tile for browsers at some steps; with step 0 also its surface."""
    fingerprint = pyramid.about["fingerprint"]
    textures = _textures(pyramid, key)
    data, at = None, key[1:]
    if textures is not None:
        colours = _colours(pyramid, textures.geometry.field)
        # A page of a store may have some of its steps, which pathlines lead through.
        data = ClientData(textures, colours, traces=textures.store.streamlines)
    if 0 in steps and key.level < pyramid.depth:  # a page has the surface of the root
        _write(array, f"{key.level}/{SURFACE}", at, fingerprint, _surface(pyramid, key, data))
    prefix = f"tile/{key.level}/{key.row}/{key.column}"
    for step in steps:
        parts: Parts = {}
        if data is not None:
            for number, values in _values(pyramid, data, step).items():
                file = {f"{prefix}/scalars/{step}/{number}": values}
                _write(array, f"{key.level}/{VALUES}", (step, *at, number), fingerprint, file)
            parts_at_step = data.step(step).items()
            parts = {f"{prefix}/{k}": v for k, v in parts_at_step if not k.startswith("scalars/")}
            data.textures.forget()
        # The last file: its presence shows that a tile is complete.
        _write(array, f"{key.level}/{FLOW}", (step, *at), fingerprint, parts)


def _textures(pyramid: StoredPyramid, key: TileKey) -> TextureSet | None:
    """Return the textures of a tile, of which those that a browser traces are not traced here."""
    if key.level == pyramid.depth:
        store = SliceStore(pyramid.root, parameter=pyramid.parameter, lines=pyramid.lines)
        return pyramid.root_textures(store)
    textures = pyramid.textures(key)
    if textures is None or (textures.store.streamlines and can_trace(textures)):
        return textures
    return pyramid.tile(key, typical_steps(len(pyramid.root.times)))


def _write(array: Arrays, name: str, at: Sequence[int], fingerprint: str, parts: Parts) -> None:
    """Write a file of parts, as whole chunks."""
    owner = np.frombuffer(fingerprint.encode(), np.uint8)
    file = np.frombuffer(parts_file({"of": owner, **parts}, planes=True), np.uint8)
    size = -(-len(file) // FILE_CHUNK) * FILE_CHUNK
    if size > FILE_BYTES:
        msg = (
            f"{name} of tile {tuple(at)} takes {size:,} bytes; expected {FILE_BYTES:,} at "
            "most. Build with lines='streamlines', or with fewer nodes"
        )
        raise PyramidError(msg)
    array(name)[(*at, slice(0, size))] = np.pad(file, (0, size - len(file)))


def _surface(pyramid: StoredPyramid, key: TileKey, data: ClientData | None) -> Parts:
    """Return the parts of a tile that are the same at all times."""
    parts = tile_parts(key, data)
    if data is not None:
        header = data.tile_header
        shared = {
            "geometry": header["geometry"],
            "slices": {k: v for k, v in header["slices"].items() if k not in OF_ALL_TILES},
        }
        parts[next(iter(parts))] = np.frombuffer(json.dumps(shared).encode(), np.uint8)
    return parts


def _values(pyramid: StoredPyramid, data: ClientData, step: int) -> dict[int, Floats32]:
    """Return the values that colour a tile at a step, rounded by less than colours show."""
    result: dict[int, Floats32] = {}
    rows, columns = data.textures.grid.drawn
    for number, name in enumerate(value_names(pyramid.about)):
        steps = steps_of(data.field, name)
        # The speed follows from the flow.
        is_derived = data.traced and name not in data.field.scalars
        if is_derived or step >= len(steps):
            continue
        values: Floats = np.asarray(steps[step])[rows, columns]
        low, high = pyramid.ranges.get((name, True), (0.0, 0.0))
        if 0 < (unit := 2 * VALUE_SHARE * (high - low)) < np.inf:
            unit = 2.0 ** np.floor(np.log2(unit))
            values = np.rint(values / unit) * unit
        result[number] = single(values)
    return result


def _colours(pyramid: StoredPyramid, field: FlowField) -> Colours:
    """Return colours by the speed, and all scalars as further choices."""
    ranges = _ranges(pyramid)
    choices = tuple({"name": k, "low": low, "high": high} for k, (low, high) in ranges.items())
    first, *others = (steps_of(field, name) for name in ranges)
    low, high = ranges["speed"]
    numbered = tuple(enumerate(others, start=1))
    return Colours("speed", values=first, low=low, high=high, choices=choices, others=numbered)


def _ranges(pyramid: StoredPyramid) -> dict[str, tuple[float, float]]:
    names = value_names(pyramid.about)
    return {name: widened(pyramid.ranges.get((name, False)), pyramid.field, name) for name in names}
