"""Zarr in a folder, versions 2 and 3: what its metadata declares fits into memory.

Lines of coordinates are read when it is opened, and of all others at least a chunk at a time.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from flowtex.field.io.inspection.limits import check_memory

#: Documents of one array, and of all of them.
DOCUMENTS = ("zarr.json", ".zarray", ".zmetadata")
#: Bytes of a number, at most.
NUMBER_BYTES = 8


def check_zarr(folder: Path) -> None:
    """Refuse a line of coordinates, or a chunk, that does not fit into memory."""
    for name, array in _arrays(folder):
        with suppress(TypeError, KeyError, IndexError, AttributeError):  # Zarr says what is wrong
            shape, chunk = list(map(int, array["shape"])), _chunk(array)
            sizes = [math.prod(chunk)] + ([math.prod(shape)] if len(shape) < 2 else [])
            check_memory(max(sizes) * NUMBER_BYTES, f"the variable {name}")


def _arrays(folder: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield what documents say of arrays, each of which may occur in several documents."""
    for kind in DOCUMENTS:
        for path in folder.rglob(kind):
            with suppress(ValueError, OSError):
                told = json.loads(path.read_bytes())
                name = path.parent.relative_to(folder).as_posix()
                if isinstance(told, dict):
                    yield from _described(name, told)


def _described(name: str, told: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    if "shape" in told:
        yield name, told
    inside = told.get("consolidated_metadata") or told
    many = inside.get("metadata") if isinstance(inside, dict) else None
    for key, one in many.items() if isinstance(many, dict) else ():
        if isinstance(one, dict) and "shape" in one:
            yield key.removesuffix("/.zarray"), one


def _chunk(array: dict[str, Any]) -> list[int]:
    """Return the shape of what is unpacked at once."""
    if "chunks" in array:
        return list(map(int, array["chunks"]))
    first = array["codecs"][0]
    grid = array["chunk_grid"]["configuration"]
    inner = first["configuration"] if first.get("name") == "sharding_indexed" else grid
    return list(map(int, inner["chunk_shape"]))
