"""The state of a file that was read: its path, size, time of change and number on the disk.

It includes the files to which the file leads: members of a list, vectors and solutions beside a
mesh, all files in the folder of an EnSight case, and those below an OpenFOAM case or a Zarr store.
It misses changes of the same size within the resolution of the disk's clock, targets of links in
CGNS and HDF5 files, and changes among more than :data:`MOST_FILES` files.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path

from flowtex.sources.meshes import beside, plot3d

#: Path, number on the disk, size and time of change in nanoseconds of each file; zeros if it does
#: not exist.
Identity = tuple[tuple[str, int, int, int], ...]

#: Endings of files that list others, the pattern of members, and bytes that are read of a list.
LISTS, MEMBER, LIST_BYTES = (
    (".pvd", ".vtm", ".vtmb", ".pvts", ".pvtr", ".pvti", ".pvtu", ".pvtp"),
    re.compile(r'(?:file|Source)\s*=\s*"([^"]+)"'),
    4_000_000,
)
#: Levels of lists that are followed, and most files that are examined.
LIST_DEPTH, MOST_FILES = 3, 10_000
#: Endings of files whose data may be in others of the same name.
WITH_OTHERS = (*beside.SUFFIXES, *plot3d.GRID_SUFFIXES, ".q")


def file_identity(paths: Iterable[Path]) -> Identity:
    """Return the state of files, and of those that are read with them."""
    files = (file for path in paths for file in _files(path.expanduser().absolute(), 0))
    return tuple(_state(file) for file in islice(files, MOST_FILES))


def members_of(path: Path) -> list[Path]:
    """Return the files that a series or a collection lists."""
    if path.suffix.lower() not in LISTS:
        return []
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            names = MEMBER.findall(file.read(LIST_BYTES))
    except OSError:
        return []
    return [path.parent / name for name in dict.fromkeys(names)]


def _files(path: Path, depth: int) -> Iterator[Path]:
    yield path
    suffix = path.suffix.lower()
    if path.is_dir():
        yield from _below(path)
    elif suffix == ".foam":
        yield from _below(path.parent)
    elif suffix == ".case":
        yield from sorted(other for other in path.parent.iterdir() if other.is_file())
    elif suffix in WITH_OTHERS and path.parent.is_dir():
        yield from sorted(other for other in path.parent.iterdir() if other.stem == path.stem)
    elif depth < LIST_DEPTH:
        for member in members_of(path):
            yield from _files(member, depth + 1)


def _below(folder: Path) -> Iterator[Path]:
    for path, folders, names in os.walk(folder):
        folders.sort()
        yield from (Path(path, name) for name in sorted(names))


def _state(path: Path) -> tuple[str, int, int, int]:
    try:
        state = path.stat()
    except (OSError, ValueError):
        return str(path), 0, 0, 0
    return str(path), state.st_ino, state.st_size, state.st_mtime_ns
