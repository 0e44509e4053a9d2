"""How a pyramid lies in a Zarr group.

::

    zarr.json              attributes: what the field is, "flowtex", and its levels, "multiscales"
    0/ 1/ 2/ ...           levels, 0 the finest and the last one the root
        velocity           (time, j, i, component)
        x, y or points     nodes: two axes of a rectilinear grid, or (j, i, component)
        valid              (j, i), and has_position where some are unknown
        scalars/NAME       (time, j, i)
        traces             (time, tile row, tile column, layer, H, W, 4), half floats
        values             (time, tile row, tile column, scalar, Y, X), single precision
        surface            (tile row, tile column, byte), below the root
        halos              (time, tile row, tile column, 2) of a series; see tasks.py
        digests            (time, part row, part column, byte), of the values of each part
    samples                of the values at level 0; see samples.py

The root is one tile, traced whole. Velocities and scalars are float32, positions float64. Values
and surface are there where traces are, for browsers: with them and the traces a page draws a tile
without knowing the nodes of its level. The first scalar is the speed.

Arrays over nodes lie in chunks of a tile, several in a shard. A shard of traces is one tile at one
destination time, and each layer a chunk. Layer 0 tells about the tile: a JSON text, whose bytes are
followed by zeros. The layers of :class:`~flowtex.textures.TextureSet` follow. A chunk of values is
one scalar of a tile at one time, and an object of its own, so that a browser takes what it shows
with one request. A surface is a file of parts as clients are handed them, followed by zeros. All is
packed by gzip, which browsers undo themselves, and has check sums. A part is a shard of the arrays
over nodes; a hash of all digests of level 0 tells which field it is.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np

from flowtex._util.array_types import AnyArray, Floats32
from flowtex._util.extras import import_extra
from flowtex._version import __version__
from flowtex.earth import Projection
from flowtex.field import FlowField
from flowtex.pyramid.checks import sealed
from flowtex.pyramid.places import FORMAT
from flowtex.pyramid.source import Source
from flowtex.textures.geometry import TILE_LEVELS, Padding, paddings
from flowtex.tiles import BLOCK_CELLS, TILE_BLOCKS
from flowtex.tiles.pyramid import root_level

__all__ = [
    "DIGESTS",
    "HALOS",
    "MOST_HELD",
    "SURFACE",
    "TILE_CELLS",
    "TRACES",
    "VALUES",
    "Part",
    "about_source",
    "attributes_of",
    "create_array",
    "create_level",
    "empty_field",
    "has_halos",
    "parts_along",
    "parts_of",
    "read_header",
    "shard_texels",
    "tiles_of",
    "to_write",
    "value_names",
]

TILE_CELLS = BLOCK_CELLS * TILE_BLOCKS
#: Rows and columns of chunks in a shard of nodes: 8 MB of velocities with two components.
SHARD_CHUNKS = (2, 4)
#: Layers that a shard of traces has room for; those that a tile has not take no room.
MOST_LAYERS = 64
#: Time steps of a series up to which a reader holds all of them.
MOST_HELD = 8
#: How hard is tried to pack; more takes longer and gains little.
GZIP_LEVEL = 1
TRACES, HALOS, VALUES, SURFACE = "traces", "halos", "values", "surface"
DIGESTS, DIGEST_BYTES = "digests", 16
#: Bytes of a surface for each node: its place, whether a cell is drawn, and a normal where it is
#: curved; and for what is told of it.
PLACE_BYTES, NORMAL_BYTES, TOLD_BYTES = 13, 6, 16_384
#: Texels along a side in which what is told of a tile has room, however small that is.
LEAST_TEXELS = 32
CONVENTION = {
    "schema_url": (
        "https://raw.githubusercontent.com/zarr-conventions/multiscales/refs/tags/v1/schema.json"
    ),
    "spec_url": "https://github.com/zarr-conventions/multiscales/blob/v1/README.md",
    "uuid": "d35379db-88df-4056-af3a-620245f8e347",
    "name": "multiscales",
    "description": "Multiscale layout of zarr datasets",
}


class Part(NamedTuple):
    """One shard of the arrays over nodes of a level, at one time step."""

    level: int
    step: int
    row: int
    column: int

    def lines(self, shape: tuple[int, int]) -> tuple[slice, slice]:
        """Return the rows and columns of a level with so many nodes."""
        first, second = (
            slice(at * many * TILE_CELLS, min((at + 1) * many * TILE_CELLS, n))
            for at, many, n in zip((self.row, self.column), SHARD_CHUNKS, shape, strict=True)
        )
        return first, second


def parts_of(level: int, shape: tuple[int, int], steps: int) -> list[Part]:
    """Return the parts of a level."""
    rows, columns = (range(n) for n in parts_along(shape))
    return [Part(level, t, j, i) for t in range(steps) for j in rows for i in columns]


def parts_along(shape: tuple[int, int]) -> tuple[int, int]:
    """Return how many parts a level with so many nodes (J, I) has along both axes."""
    rows, columns = (
        -(-n // (many * TILE_CELLS)) for n, many in zip(shape, SHARD_CHUNKS, strict=True)
    )
    return rows, columns


def tiles_of(
    level: int, shape: tuple[int, int], about: Mapping[str, Any]
) -> tuple[tuple[int, int], tuple[int, int]]:
    """Return how many tiles a level has, and texels the largest of them, along both axes."""
    if level == about["depth"]:
        _, *both = paddings(shape, (about["periodic"][0], about["periodic"][1]))
        size = [max(padding.size, LEAST_TEXELS) for padding in both]
        return (1, 1), (size[0], size[1])
    rows, columns = (-(-(n - 1) // TILE_CELLS) for n in shape)
    nodes = TILE_CELLS + 1
    largest = Padding.of(nodes, TILE_LEVELS, periodic=False, drawn=slice(0, nodes)).size
    return (rows, columns), (largest, largest)


def value_names(about: Mapping[str, Any]) -> tuple[str, ...]:
    """Return what the surface can be coloured by: the speed, and the scalars of the field."""
    return tuple(dict.fromkeys(("speed", *about["scalars"])))


def about_source(source: Source, parameter: str, lines: str, levels: str) -> dict[str, Any]:
    """Return what is told of a field and its pyramid, as it is kept in the store."""
    field, projection = source.field, source.field.projection
    depth = root_level(source.shape)
    corner = source.points(np.array([0]), np.array([0]))
    return {
        "format": FORMAT,
        "version": __version__,
        "name": field.name,
        "length_unit": field.length_unit,
        "time_unit": field.time_unit,
        "times": field.times.tolist(),
        "start": _date_words(field.start),
        "projection": None
        if projection is None
        else [projection.name, list(projection.center), projection.half_height],
        "nodes": list(source.shape),
        "periodic": list(field.periodic),
        "periods": [some.tolist() for some in source.periods],
        "depth": depth,
        "tile_cells": TILE_CELLS,
        "parameter": parameter,
        "lines": lines,
        "traced": sorted({*range(0 if levels == "all" else 1, depth), depth}),
        "components": 2 if source.flat else 3,
        "height": float(corner[0, 0, 2]),
        "axes": source.rectilinear,
        "late": source.late or len(field.times) > MOST_HELD,
        "has_position": source.has_position is not None,
        "scalars": dict(source.scalars),
        "units": dict(field.units),
        "long_names": dict(field.long_names),
        "fingerprint": "",
        "source": source.identity(),
    }


def attributes_of(about: Mapping[str, Any]) -> dict[str, Any]:
    """Return the attributes of the group: the field, and its levels as others read them."""
    layout: list[dict[str, Any]] = [{"asset": "0", "transform": {"scale": [1.0, 1.0]}}]
    for level in range(1, about["depth"] + 1):
        step = {"scale": [2.0, 2.0], "translation": [0.0, 0.0]}
        layout.append({"asset": str(level), "derived_from": str(level - 1), "transform": step})
    return {
        "zarr_conventions": [CONVENTION],
        "multiscales": {"layout": layout, "resampling_method": "average"},
        "flowtex": sealed(about),
    }


def create_level(group: Any, level: int, shape: tuple[int, int], about: Mapping[str, Any]) -> None:
    """Describe the arrays of a level."""
    here = group.require_group(str(level))
    steps, components = len(about["times"]), about["components"]
    chunk = (TILE_CELLS, TILE_CELLS)
    shard = (SHARD_CHUNKS[0] * TILE_CELLS, SHARD_CHUNKS[1] * TILE_CELLS)

    def nodal(where: Any, name: str, steps: int, last: tuple[int, ...], kind: str) -> None:
        before = (steps,) if steps else ()
        ones = (1,) * len(before)
        names = [*["time"] * len(ones), "j", "i", *["component"] * len(last)]
        create_array(
            where,
            name,
            (*before, *shape, *last),
            (*ones, *chunk, *last),
            (*ones, *shard, *last),
            kind,
            names,
        )

    nodal(here, "velocity", steps, (components,), "float32")
    nodal(here, "valid", 0, (), "bool")
    if about["has_position"]:
        nodal(here, "has_position", 0, (), "bool")
    if about["axes"]:
        for name, count, axis in (("x", shape[1], "i"), ("y", shape[0], "j")):
            create_array(here, name, (count,), (count,), None, "float64", [axis])
    else:
        nodal(here, "points", 0, (components,), "float64")
    create_array(
        here,
        DIGESTS,
        (steps, *parts_along(shape), DIGEST_BYTES),
        (1, 1, 1, DIGEST_BYTES),
        None,
        "uint8",
        ["time", "row", "column", "byte"],
    )
    for name, count in about["scalars"].items():
        nodal(here.require_group("scalars"), name, count, (), "float32")
    if level in about["traced"]:
        tiles, size = tiles_of(level, shape, about)
        create_array(
            here,
            TRACES,
            (steps, *tiles, MOST_LAYERS, *size, 4),
            (1, 1, 1, 1, *size, 4),
            (1, 1, 1, MOST_LAYERS, *size, 4),
            "float16",
            ["time", "row", "column", "layer", "y", "x", "channel"],
        )
        if has_halos(about, level):
            # A task makes so many steps, and a chunk is written by one task.
            several, names = (MOST_HELD, 1, 1, 2), ["time", "row", "column", "halo"]
            create_array(here, HALOS, (steps, *tiles, 2), several, None, "uint8", names)
        _create_client_arrays(here, level, shape, tiles, about)


def _create_client_arrays(
    here: Any,
    level: int,
    shape: tuple[int, int],
    tiles: tuple[int, int],
    about: Mapping[str, Any],
) -> None:
    """Describe the arrays of a level that a browser needs beside the traces."""
    is_root = level == about["depth"]
    nodes = shape if is_root else (TILE_CELLS + 1, TILE_CELLS + 1)
    create_array(
        here,
        VALUES,
        (len(about["times"]), *tiles, len(value_names(about)), *nodes),
        (1, 1, 1, 1, *nodes),
        None,
        "float32",
        ["time", "row", "column", "scalar", "j", "i"],
    )
    if not is_root:
        each = PLACE_BYTES + (NORMAL_BYTES if about["components"] == 3 else 0)
        room = nodes[0] * nodes[1] * each + TOLD_BYTES
        names = ["row", "column", "byte"]
        create_array(here, SURFACE, (*tiles, room), (1, 1, room), None, "uint8", names)


def has_halos(about: Mapping[str, Any], level: int) -> bool:
    """Whether tiles of a level are told the halos of their steps."""
    return len(about["times"]) > 1 and level in about["traced"] and level < about["depth"]


def create_array(
    where: Any,
    name: str,
    shape: tuple[int, ...],
    chunks: tuple[int, ...],
    shards: tuple[int, ...] | None,
    kind: str,
    names: list[str],
) -> None:
    """Describe an array."""
    codecs = import_extra("zarr.codecs", "store")
    where.create_array(
        name,
        shape=shape,
        chunks=chunks,
        shards=shards,
        dtype=kind,
        compressors=[codecs.GzipCodec(level=GZIP_LEVEL), codecs.Crc32cCodec()],
        fill_value=0,
        dimension_names=names,
    )


def to_write(group: Any, name: str) -> Any:
    """Return an array to write values into, zeros as well.

    What is there has an object, by which it is known that nothing is missing; of itself Zarr leaves
    chunks of zeros out, which land is.
    """
    zarr, array = import_extra("zarr", "store"), group[name]
    config = {"write_empty_chunks": True}
    return zarr.Array(zarr.AsyncArray(array.metadata, array.store_path, config))


def empty_field(about: Mapping[str, Any]) -> FlowField:
    """Return a field that has all but its nodes."""
    projection = about["projection"]
    return FlowField(
        points=np.zeros((1, 1, 3)),
        velocity=np.zeros((1, 1, 1, 3)),
        times=np.array(about["times"], dtype=float),
        valid=np.zeros((1, 1), dtype=bool),
        periodic=(about["periodic"][0], about["periodic"][1]),
        name=about["name"],
        length_unit=about["length_unit"],
        time_unit=about["time_unit"],
        units=about["units"],
        long_names=about["long_names"],
        start=_date_of(about["start"]),
        projection=None
        if projection is None
        else Projection(
            projection[0], (projection[1][0], projection[1][1]), half_height=projection[2]
        ),
    )


def shard_texels(
    about: Mapping[str, Any], layers: Floats32 | None, shape: tuple[int, ...]
) -> AnyArray:
    """Return a shard of traces: what is told of a tile, and its layers (L, H, W, 4)."""
    shard = np.zeros(shape, np.float16)
    text = json.dumps(about).encode()
    shard[0].reshape(-1).view(np.uint8)[: len(text)] = np.frombuffer(text, np.uint8)
    if layers is not None:
        count, height, width = layers.shape[:3]
        shard[1 : 1 + count, :height, :width] = layers
        # Zeros have one sign, so that the bits of a tile do not depend on who computed it.
        shard[1 : 1 + count] += 0
    return shard


def read_header(texels: AnyArray) -> dict[str, Any] | None:
    """Return what is told of a tile by its layer 0; nothing where there is no tile."""
    text = np.ascontiguousarray(texels).reshape(-1).view(np.uint8).tobytes().rstrip(b"\0")
    about: dict[str, Any] | None = json.loads(text) if text else None
    return about


def _date_words(start: Any) -> list[Any] | None:
    """Return a date as numbers, and its calendar where it is not that of ``datetime``."""
    if start is None:
        return None
    parts = ("year", "month", "day", "hour", "minute", "second", "microsecond")
    return [[int(getattr(start, part)) for part in parts], getattr(start, "calendar", "")]


def _date_of(words: list[Any] | None) -> Any:
    if words is None:
        return None
    if not words[1]:
        return datetime(*words[0])
    return import_extra("cftime", "xarray").datetime(*words[0], calendar=words[1])
