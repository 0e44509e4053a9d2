"""A folder that is looked through for files that can be opened."""

from __future__ import annotations

from pathlib import Path

__all__ = ["SUFFIXES", "search"]

#: Endings of files that a folder is searched for.
SUFFIXES = frozenset(
    [
        *(".vts", ".vtr", ".vti", ".vtk", ".vtm", ".pvd", ".pvts", ".pvtr", ".pvti"),
        *(".xyz", ".x", ".g", ".foam", ".case", ".cgns", ".ex2"),
    ]
)
#: Folders below the one that was given that are looked into, and files that are listed.
DEEPEST, MOST_FILES = 4, 500


def search(folder: Path) -> list[tuple[str, Path]]:
    """Find files below a folder; what a link leads to outside of it is left out."""
    found: list[tuple[str, Path]] = []
    waiting = [(folder, 0)]
    while waiting and len(found) < MOST_FILES:
        here, depth = waiting.pop(0)
        try:
            inside = sorted(here.iterdir())
        except OSError:
            continue
        for path in inside:
            if path.name.startswith(".") or not path.resolve().is_relative_to(folder):
                continue
            if path.is_dir() and not path.is_symlink() and depth < DEEPEST:
                waiting.append((path, depth + 1))
            elif path.is_file() and path.suffix.lower() in SUFFIXES | {".bin"}:
                found.append((path.relative_to(folder).as_posix(), path))
    return [(name, path) for name, path in found[:MOST_FILES] if not _is_solution(path)]


def _is_solution(path: Path) -> bool:
    """Whether this is the part of a PLOT3D pair that is opened along with its grid."""
    from flowtex.field.io import plot3d

    return path.suffix.lower() == ".bin" and plot3d.find_grid(path) not in (None, path)
