"""How a pyramid lies in a Zarr group.

::

    zarr.json              attributes: what the field is, "flowtex", and its levels, "multiscales"
    0/ 1/ 2/ ...           levels, 0 the finest and the last one the root
        velocity           (time, j, i, component)
        x, y or points     nodes: two axes of a rectilinear grid, or (j, i, component)
        valid              (j, i), and has_position where some are unknown
        scalars/NAME       (time, j, i)
        surface            (tile row, tile column, byte), below the root
        flow               (time, tile row, tile column, byte)
        values             (time, tile row, tile column, scalar, byte)
        digests            (time, part row, part column, byte), of the values of each part

Velocities and scalars are float32, positions float64. Arrays over nodes lie in chunks of a tile,
several in a shard. Browsers read the last files, gzipped: the surface of a tile, its flow at a time
(the velocity, or slices), and the values of a scalar; number 0 is the speed.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from functools import cache, partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np

from flowtex._util import __version__
from flowtex._util.array_types import AnyArray, Floats, Floats32
from flowtex._util.cache import digest
from flowtex._util.json_checks import (
    MOST_NAMES,
    Check,
    by_name,
    either,
    is_flag,
    is_number,
    is_text,
    list_of,
    or_none,
    whole,
)
from flowtex.errors import import_extra
from flowtex.field import FlowField
from flowtex.field.dates import date_of, written_date
from flowtex.field.earth.projection import Projection
from flowtex.field.steps import Nodes
from flowtex.pyramid.places import FORMAT, DamageError, PyramidError
from flowtex.pyramid.source import NodeSource, periods_of
from flowtex.textures.tiles.blocks import BLOCK_CELLS
from flowtex.textures.tiles.grid_levels import level_shape, root_level
from flowtex.textures.tiles.grid_pyramid import TILE_BLOCKS

if TYPE_CHECKING:
    from zarr import Group
    from zarr.abc.store import Store

TILE_CELLS = BLOCK_CELLS * TILE_BLOCKS
SHARD_CHUNKS = (2, 4)  #: Rows and columns of chunks in a shard of nodes: 8 MB of velocities.
FILE_BYTES = 1 << 28  #: Most bytes of a file of parts.
FILE_CHUNK = 1 << 20  #: Bytes of a chunk of such a file.
MOST_HELD = 8  #: Time steps of a series up to which a reader holds all of them.
GZIP_LEVEL = 4  #: Level of gzip; a higher one takes longer and gains little.
ZSTD_LEVEL = 3  #: The same of Zstandard.
VELOCITY_BITS = 11  #: Bits of velocities: the error is 2^-12 of themselves, as in halves.
FLOW = "flow"  #: Array of the files with the flow of tiles.
VALUES = "values"  #: Array of the files with the values that colour tiles.
SURFACE = "surface"  #: Array of the files with the surface of tiles.
DIGESTS = "digests"  #: Array of the hashes of parts.
DIGEST_BYTES = 16  #: Bytes of a hash.
#: Texts of a field that a store keeps.
TEXTS = ("name", "length_unit", "time_unit", "velocity_unit", "vectors", "uncertainty")
CONVENTION = {
    "schema_url": (
        "https://raw.githubusercontent.com/zarr-conventions/multiscales/refs/tags/v1/schema.json"
    ),
    "spec_url": "https://github.com/zarr-conventions/multiscales/blob/v1/README.md",
    "uuid": "d35379db-88df-4056-af3a-620245f8e347",
    "name": "multiscales",
    "description": "Multiscale layout of zarr datasets",
}
MOST_NODES = 10**7  #: Most nodes along an axis.
MOST_STEPS = 10**6  #: Most time steps.
MOST_LEVELS = 40  #: Most levels.
MOST_ROOT_NODES = 1_000_000  #: Nodes of the coarsest level, which is read whole, at most.

#: The description of a field and its pyramid, as the store has it; ``_ABOUT`` lists its entries.
#: Its seal, a hash, reveals accidental damage. A wrong one may have a valid seal, so types and
#: sizes, which decide how much memory is taken, are checked as well.
About: TypeAlias = Mapping[str, Any]


class Part(NamedTuple):
    """One shard of the arrays over nodes of a level, at one time step."""

    level: int
    step: int
    row: int
    column: int

    def lines(self, shape: tuple[int, int]) -> tuple[slice, slice]:
        """Return the rows and columns of a level with this many nodes."""
        first = slice(
            self.row * SHARD_CHUNKS[0] * TILE_CELLS,
            min((self.row + 1) * SHARD_CHUNKS[0] * TILE_CELLS, shape[0]),
        )
        second = slice(
            self.column * SHARD_CHUNKS[1] * TILE_CELLS,
            min((self.column + 1) * SHARD_CHUNKS[1] * TILE_CELLS, shape[1]),
        )
        return first, second


def parts_of(level: int, shape: tuple[int, int], steps: int) -> list[Part]:
    """Return the parts of a level."""
    rows, columns = parts_along(shape)
    return [Part(level, *numbers) for numbers in np.ndindex(steps, rows, columns)]


def parts_along(shape: tuple[int, int]) -> tuple[int, int]:
    """Return how many parts a level with this many nodes (J, I) has along both axes."""
    rows = -(-shape[0] // (SHARD_CHUNKS[0] * TILE_CELLS))
    columns = -(-shape[1] // (SHARD_CHUNKS[1] * TILE_CELLS))
    return rows, columns


def tiles_of(level: int, shape: tuple[int, int], about: About) -> tuple[int, int]:
    """Return how many tiles a level with this many nodes (J, I) has along both axes."""
    if level == about["depth"]:
        return 1, 1
    rows = -(-(shape[0] - 1) // TILE_CELLS)
    columns = -(-(shape[1] - 1) // TILE_CELLS)
    return rows, columns


def value_names(about: About) -> tuple[str, ...]:
    """Return the names of values that can colour the surface: the speed, and the scalars."""
    return tuple(dict.fromkeys(("speed", *about["scalars"])))


def about_source(source: NodeSource, parameter: str, lines: str) -> dict[str, Any]:
    """Return the description of a field and its pyramid, as the store keeps it."""
    field = source.field
    depth = root_level(source.shape)
    corner = source.points(np.array([0]), np.array([0]))
    texts = {name: getattr(field, name) for name in TEXTS}
    components = 3
    if source.flat:
        components = 2
    return {
        "format": FORMAT,
        "version": __version__,
        **texts,
        "times": field.times.tolist(),
        "start": written_date(field.start),
        "projection": field.projection and field.projection.written,
        "nodes": list(source.shape),
        "periodic": list(field.periodic),
        "periods": np.stack(periods_of(source)).tolist(),
        "depth": depth,
        "tile_cells": TILE_CELLS,
        "parameter": parameter,
        "lines": lines,
        "components": components,
        "height": float(corner[0, 0, 2]),
        "axes": source.rectilinear,
        "late": source.late or len(field.times) > MOST_HELD,
        "has_position": source.has_position is not None,
        "scalars": dict(source.scalars),
        "on_cells": list(field.on_cells),
        "units": dict(field.units),
        "long_names": dict(field.long_names),
        "fingerprint": "",
    }


def described(about: About, levels: Iterable[int] | None = None) -> Group:
    """Return a group in memory with the arrays of levels, by default all, as they are written."""
    layout: list[dict[str, Any]] = [{"asset": "0", "transform": {"scale": [1.0, 1.0]}}]
    for level in range(1, about["depth"] + 1):
        step = {"scale": [2.0, 2.0], "translation": [0.0, 0.0]}
        layout.append({"asset": str(level), "derived_from": str(level - 1), "transform": step})
    attributes = {
        "zarr_conventions": [CONVENTION],
        "multiscales": {"layout": layout, "resampling_method": "average"},
        "flowtex": sealed(about),
    }
    zarr = import_extra("zarr", "store")
    group: Group = zarr.group(zarr.storage.MemoryStore(), attributes=attributes, zarr_format=3)
    if levels is None:
        levels = range(about["depth"] + 1)
    for level in levels:
        _create_level(group, level, about)
    return group


def _create_level(group: Group, level: int, about: About) -> None:
    """Create the arrays of a level."""
    shape = level_shape((about["nodes"][0], about["nodes"][1]), level)
    subgroup = group.require_group(str(level))
    steps = len(about["times"])
    nodes = {}
    for axis, count, chunks in zip("ji", shape, SHARD_CHUNKS, strict=True):
        nodes[axis] = (count, TILE_CELLS, chunks * TILE_CELLS)
    vectors = {**nodes, "component": (about["components"],) * 3}
    nodal = partial(create_array, nodal=True)
    nodal(subgroup, "velocity", "float32", {"time": (steps, 1, 1), **vectors})
    nodal(subgroup, "valid", "bool", nodes)
    if about["has_position"]:
        nodal(subgroup, "has_position", "bool", nodes)
    if about["axes"]:
        for name, axis, count in (("x", "i", shape[1]), ("y", "j", shape[0])):
            create_array(subgroup, name, "float64", {axis: (count, count)})
    else:
        nodal(subgroup, "points", "float64", vectors)
    part_rows, part_columns = parts_along(shape)
    digests = {
        "time": (steps, 1),
        "part_row": (part_rows, 1),
        "part_column": (part_columns, 1),
        "digest_byte": (DIGEST_BYTES, DIGEST_BYTES),
    }
    create_array(subgroup, DIGESTS, "uint8", digests)
    for name, count in about["scalars"].items():
        series = {"time": (count, 1, 1), **nodes}
        nodal(subgroup.require_group("scalars"), name, "float32", series)
    tiles = dict(zip(("row", "column"), tiles_of(level, shape, about), strict=True))
    by_time = {"time": steps, **tiles}
    files = {FLOW: by_time, VALUES: {**by_time, "scalar": len(value_names(about))}}
    if level < about["depth"]:  # a page holds that of the root
        files[SURFACE] = tiles
    for name, axes in files.items():
        one_each = {axis: (n, 1, 1) for axis, n in axes.items()}
        byte = (FILE_BYTES, FILE_CHUNK, FILE_BYTES)
        create_array(subgroup, name, "uint8", {**one_each, "byte": byte})


def create_array(
    group: Group, name: str, dtype: str, axes: Mapping[str, tuple[int, ...]], *, nodal: bool = False
) -> None:
    """Create an array by axes: sizes of it, of a chunk and, if any, of a shard."""
    codecs = import_extra("zarr.codecs", "store")
    packer = codecs.GzipCodec(level=GZIP_LEVEL)
    if nodal:
        packer = codecs.BloscCodec(cname="zstd", clevel=ZSTD_LEVEL, shuffle="bitshuffle")
    shape, chunks, *shards = zip(*axes.values(), strict=True)
    last = len(axes) - 1
    filters = []
    if nodal and "component" in axes:
        filters.append(codecs.TransposeCodec(order=(last, *range(last))))
    group.create_array(
        name,
        shape=shape,
        chunks=chunks,
        shards=next(iter(shards), None),
        dtype=dtype,
        filters=filters,
        compressors=[packer, codecs.Crc32cCodec()],
        fill_value=0,
        dimension_names=list(axes),
    )


def rounded(velocity: Floats) -> Floats32:
    """Return velocities as they are written."""
    share, exponent = np.frexp(velocity)
    whole = np.rint(np.ldexp(share, VELOCITY_BITS))
    return np.asarray(np.ldexp(whole, exponent - VELOCITY_BITS), np.float32)


Arrays: TypeAlias = Callable[[str], Any]  #: A function that returns the array of a name.


def to_write(store: Store) -> Arrays:
    """Return a function that opens arrays for writing, zeros too, so that gaps are recognised."""
    zarr = import_extra("zarr", "store")

    def opened(name: str) -> Any:
        array = zarr.open_array(store, path=name, mode="r+")
        config = {"write_empty_chunks": True}
        return zarr.Array(zarr.AsyncArray(array.metadata, array.store_path, config))

    return cache(opened)


def empty_field(about: About) -> FlowField:
    """Return a field without nodes, with all that describes it."""
    texts: dict[str, Any] = {name: about.get(name) or "" for name in TEXTS}
    return FlowField(
        points=np.zeros((1, 1, 3)),
        velocity=np.zeros((1, 1, 1, 3)),
        times=np.array(about["times"], dtype=float),
        valid=np.zeros((1, 1), dtype=bool),
        periodic=(about["periodic"][0], about["periodic"][1]),
        **texts,
        units=about["units"],
        long_names=about["long_names"],
        start=date_of(about["start"]),
        projection=Projection.of(about["projection"]),
        on_cells=tuple(about.get("on_cells") or ()),
    )


def sealed(about: About) -> dict[str, Any]:
    """Return the description of a pyramid with its seal; a dictionary without one is rejected."""
    return {**about, "seal": _seal(about)}


def _seal(about: About) -> str:
    """Return a hash of all entries of a description."""
    sealed_entries = dict(about)
    sealed_entries.pop("seal", None)
    text = json.dumps(sealed_entries, sort_keys=True)
    return digest(words=(text,)).hex()


def _date(value: Any) -> bool:
    parts = list_of(whole(0, 100_000), 7)
    return isinstance(value, list) and len(value) == 2 and parts(value[0]) and is_text(value[1])


def _projection(value: Any) -> bool:
    if not (isinstance(value, list) and len(value) == 3):
        return False
    return is_text(value[0]) and list_of(is_number, 2)(value[1]) and is_number(value[2])


def is_scalar_name(name: str) -> bool:
    """Return whether a name is a valid path of an array in its group."""
    return bool(name) and "/" not in name and name not in (".", "..", "zarr.json")


_ENDS = list_of(list_of(is_number, 2), 2)
#: Required entries of the description of a pyramid; more are allowed.
_ABOUT: dict[str, Check] = {
    **dict.fromkeys(("name", "length_unit", "time_unit", "version", "fingerprint"), is_text),
    **dict.fromkeys(("axes", "late", "has_position"), is_flag),
    "levels_done": or_none(is_flag),
    "nodes": list_of(whole(2, MOST_NODES), 2),
    "times": lambda v: list_of(is_number, 1, MOST_STEPS)(v) and all(a < b for a, b in pairwise(v)),
    "start": or_none(_date),
    "projection": or_none(_projection),
    "periodic": list_of(is_flag, 2),
    "periods": list_of(list_of(is_number, 3), 2),
    "depth": whole(0, MOST_LEVELS),
    "tile_cells": whole(1, 4096),
    "parameter": either("arclength", "time"),
    "lines": either("pathlines", "streamlines"),
    "components": either(2, 3),
    "height": is_number,
    "scalars": lambda v: by_name(whole(1, MOST_STEPS))(v) and all(map(is_scalar_name, v)),
    **dict.fromkeys(("uncertainty", "velocity_unit", "vectors"), or_none(is_text)),
    "units": by_name(is_text),
    "long_names": by_name(is_text),
    "on_cells": or_none(list_of(is_text, 0, MOST_NAMES)),
    "ranges": or_none(by_name(_ENDS)),
}


def check_about(about: Any, place: str) -> dict[str, Any]:
    """Return the checked description of a pyramid.

    Parameters
    ----------
    about
        Content of its attributes, as read.
    place
        Address of the store, for errors.

    Raises
    ------
    PyramidError
        When the attributes are missing, or another version wrote them.
    DamageError
        When they are not as they were written.
    """
    if isinstance(about, dict):
        version = about.get("format")
    else:
        version = None
    if version != FORMAT:
        raise PyramidError(
            f"{place} has format {str(version)[:40]!r}; expected {FORMAT!r}. Build it again"
        )
    wrong = []
    for name, check in _ABOUT.items():
        if not check(about.get(name)):
            wrong.append(name)
    if not wrong and math.prod(level_shape(about["nodes"], about["depth"])) > MOST_ROOT_NODES:
        wrong = ["depth"]
    if not wrong and about.get("uncertainty") and about["uncertainty"] not in about["scalars"]:
        wrong = ["uncertainty"]
    if wrong or about.get("seal") != _seal(about):
        if wrong:
            names = f" ({', '.join(wrong)})"
        else:
            names = ""
        raise DamageError(f"the metadata of {place} are damaged{names}; build it again")
    result: dict[str, Any] = about
    return result


def part_digest(nodes: Nodes, about: About, step: int) -> bytes:
    """Return a hash of the values of a part of a level, as they are written."""
    scalars = {}
    for k, v in sorted(nodes.scalars.items()):
        if step < about["scalars"][k]:
            scalars[k] = v
    arrays: list[AnyArray] = []
    for values in (nodes.velocity[..., : about["components"]], *scalars.values()):
        arrays.append(np.asarray(values, np.float32))
    if step == 0:
        arrays += [nodes.points, nodes.valid]
        if nodes.has_position is not None:
            arrays.append(nodes.has_position)
    return digest(*arrays, words=scalars)
