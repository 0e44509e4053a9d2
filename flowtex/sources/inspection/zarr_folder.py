"""Zarr in a folder, versions 2 and 3: the arrays in its metadata fit into memory.

Lines of coordinates are read when it is opened, and all others in chunks.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from flowtex.sources.inspection.limits import check_memory

#: Documents of one array, and of all of them.
DOCUMENTS = ("zarr.json", ".zarray", ".zmetadata")
#: Most bytes of a number.
NUMBER_BYTES = 8


def check_zarr(folder: Path) -> None:
    """Raise a FieldError for a line of coordinates, or a chunk, that does not fit into memory."""
    for name, array in _arrays(folder):
        with suppress(TypeError, KeyError, IndexError, AttributeError):  # Zarr reports the fault
            shape, chunk = list(map(int, array["shape"])), _chunk(array)
            sizes = [math.prod(chunk)] + ([math.prod(shape)] if len(shape) < 2 else [])
            check_memory(max(sizes) * NUMBER_BYTES, f"the variable {name}")


def _arrays(folder: Path) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the metadata of arrays, each of which may occur in several documents."""
    for kind in DOCUMENTS:
        for path in folder.rglob(kind):
            with suppress(ValueError, OSError):
                document = json.loads(path.read_bytes())
                name = path.parent.relative_to(folder).as_posix()
                if isinstance(document, dict):
                    yield from _array_metadata(name, document)


def _array_metadata(name: str, document: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    if "shape" in document:
        yield name, document
    consolidated = document.get("consolidated_metadata") or document
    entries = consolidated.get("metadata") if isinstance(consolidated, dict) else None
    for key, entry in entries.items() if isinstance(entries, dict) else ():
        if isinstance(entry, dict) and "shape" in entry:
            yield key.removesuffix("/.zarray"), entry


def _chunk(array: dict[str, Any]) -> list[int]:
    """Return the shape of the part that is unpacked at once."""
    if "chunks" in array:
        return list(map(int, array["chunks"]))
    first = array["codecs"][0]
    grid = array["chunk_grid"]["configuration"]
    inner = first["configuration"] if first.get("name") == "sharding_indexed" else grid
    return list(map(int, inner["chunk_shape"]))
