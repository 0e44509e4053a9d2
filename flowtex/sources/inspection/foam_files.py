"""Check of the cells of OpenFOAM: VTK makes as many cells as the greatest number of one."""

from __future__ import annotations

import gzip
import re
import warnings
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError

#: Endings of files that mark a case.
ENDINGS = (".foam", ".openfoam")
#: Contents of the folder of a case, of which one is there.
CONTENTS = ("constant/polyMesh", "system/controlDict", "processor0/constant")
#: Folders of meshes in a case: of times and of regions, also of parts of a decomposed case.
MESHES = ("*/polyMesh", "*/*/polyMesh", "*/*/*/polyMesh")
#: Brackets at the end of a list, by those before it.
CLOSING = {b"(": b")", b"{": b"}"}
NOTHING = np.empty(0)
#: Header of a file: a dictionary, perhaps after comments.
_HEADER = re.compile(rb"FoamFile\s*\{[^}]*\}")
_BINARY = re.compile(rb"\bformat\s+binary\b")
#: Labels of 64 bits; others have 32.
_WIDE = re.compile(rb"label\s*=\s*64")
_GAP = rb"(?:\s|//[^\n]*|/\*(?s:.*?)\*/)*"
#: Number of entries of a list, and the bracket before them: a brace for one that all have.
_LIST = re.compile(_GAP + rb"(\d+)" + _GAP + rb"([({])")
#: A cell outside of the mesh, beyond its boundary, as old versions write it.
OUTSIDE = -1


def case_of(path: Path) -> Path | None:
    """Return the folder of a case by a file in it or itself; ``None`` for other paths."""
    if path.suffix.lower() in ENDINGS and not path.is_dir():
        return path.parent
    if path.is_dir() and any((path / part).exists() for part in CONTENTS):
        return path
    return None


def check_foam(case: Path) -> None:
    """Raise a FieldError for a face of a cell whose number is negative or too large.

    A cell has several faces, so there are fewer cells than faces.
    """
    for mesh in _meshes(case):
        owner = mesh / "owner"
        neighbour = mesh / "neighbour"
        cells = _labels(owner)
        _check(owner, cells, 0, len(cells))
        _check(neighbour, _labels(neighbour), OUTSIDE, len(cells))


def _check(path: Path, cells: AnyArray, least: int, faces: int) -> None:
    """Raise a FieldError if a cell number is less than ``least`` or not less than ``faces``."""
    if not cells.size:
        return
    for cell in (int(cells.min()), int(cells.max())):
        if not least <= cell < faces:
            raise FieldError(
                f"{path}: the file is damaged: a face has the cell {cell}, but the mesh has "
                f"{faces:,} faces; write or copy it again"
            )


def _meshes(case: Path) -> Iterator[Path]:
    for pattern in MESHES:
        yield from sorted(case.glob(pattern))


def _labels(path: Path) -> AnyArray:
    """Return the numbers of cells in a file; empty where VTK must say what is wrong with it."""
    data = _content(path)
    header = _HEADER.search(data)
    if header is None:
        return NOTHING
    found = _LIST.match(data, header.end())
    if found is None:
        return NOTHING
    if _BINARY.search(header[0]):
        kind: np.dtype[Any] = np.dtype(np.int32)
        if _WIDE.search(header[0]):
            kind = np.dtype(np.int64)
        present = (len(data) - found.end()) // kind.itemsize
        cells: AnyArray = np.frombuffer(data, kind, min(_count(found), present), found.end())
    else:
        cells = _numbers(data, found)
    if found[2] == b"{":
        return np.broadcast_to(cells[:1], (_count(found),))
    return cells


def _content(path: Path) -> bytes:
    try:
        if path.is_file():
            return path.read_bytes()
        return gzip.decompress(path.with_name(f"{path.name}.gz").read_bytes())
    except (OSError, EOFError, zlib.error):
        return b""


def _count(found: re.Match[bytes]) -> int:
    count = int(found[1])
    check_memory(8 * count, "a list of cells")
    return count


def _numbers(data: bytes, found: re.Match[bytes]) -> AnyArray:
    """Return the numbers of a list in a text."""
    end = data.find(CLOSING[found[2]], found.end())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(data[found.end() : end], sep=" ")
        except (ValueError, DeprecationWarning):  # what follows is no number
            return NOTHING
