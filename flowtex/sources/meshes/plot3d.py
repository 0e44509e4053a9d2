"""PLOT3D: the layout of a file, its solution, and reading both with VTK.

A PLOT3D file does not describe itself: text or binary, byte order, Fortran's record marks, one grid
or several, two or three dimensions, single or double precision, blanking or none. All of these
change the length of the file, so the layout is the one whose length fits. It is determined before
VTK opens the file, because VTK takes any number in a broken header for a size.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.inspection.limits import check_count, check_memory

if TYPE_CHECKING:
    import pyvista as pv

#: VTK's number for the function that makes ``Velocity`` from density and momentum.
VELOCITY = 200

#: Usual suffixes of PLOT3D grids.
GRID_SUFFIXES = (".xyz", ".x", ".g", ".p3d", ".grd", ".bin", ".dat", ".fmt")
#: Most grids in one file; a header with more is invalid.
MOST_GRIDS = 100_000
#: Bytes in memory of one byte of text: a number has at least two, and its word takes some 50.
TEXT_GROWTH = 25
_TEXT = frozenset(b"0123456789+-.eEdD \t\r\n,")


@dataclass(frozen=True)
class Layout:
    """The layout of a grid file; ``dimensions`` has 2 or 3 numbers for each grid."""

    dimensions: tuple[tuple[int, ...], ...]
    multiple: bool
    blanked: bool
    binary: bool = True
    big_endian: bool = False
    record_marks: bool = False
    double: bool = False

    @property
    def length(self) -> int:
        """Length of such a file: bytes when binary, otherwise numbers."""
        axes = len(self.dimensions[0])
        word = 4 if self.binary else 1
        real = word * (2 if self.double and self.binary else 1)
        marks = 8 if self.record_marks else 0
        header = word * axes * len(self.dimensions) + marks + (word + marks) * self.multiple
        each = axes * real + word * self.blanked
        return header + sum(math.prod(grid) * each + marks for grid in self.dimensions)


def find_layout(path: Path) -> Layout | None:
    """Return the layout of a grid file, or ``None`` if it is no PLOT3D grid."""
    with path.open("rb") as file:
        head = file.read(4 * (3 * MOST_GRIDS + 4))
    if not head:
        return None
    if set(head[:256]) <= _TEXT:
        return _text_layout(path)
    size = path.stat().st_size
    for order, marks, multiple, axes in product(("<", ">"), (False, True), (False, True), (3, 2)):
        dimensions = _binary_header(head, order, axes, marks=marks, multiple=multiple)
        for double, blanked in product((False, True), (False, True)):
            layout = Layout(
                dimensions,
                multiple=multiple,
                blanked=blanked,
                big_endian=order == ">",
                record_marks=marks,
                double=double,
            )
            if dimensions and layout.length == size:
                return layout
    return None


def _binary_header(
    head: bytes, order: str, axes: int, *, marks: bool, multiple: bool
) -> tuple[tuple[int, ...], ...]:
    """Return the dimensions in a header of this form; empty if they are not plausible."""
    words = np.frombuffer(head[: len(head) // 4 * 4], dtype=f"{order}i4")
    # A record mark stands before and after each record.
    count, first = 1, int(marks)
    if multiple:
        count, first = int(words[first : first + 1].sum()), 3 * first + 1
    return _grids(words[first : first + axes * count].tolist(), count, axes)


def _text_layout(path: Path) -> Layout | None:
    check_memory(TEXT_GROWTH * path.stat().st_size, "the file")
    words = path.read_bytes().replace(b",", b" ").split()
    for multiple, axes in product((False, True), (3, 2)):
        try:
            count = int(words[0]) if multiple else 1
            numbers = [int(word) for word in words[multiple : multiple + axes * count]]
        except ValueError:
            continue
        dimensions = _grids(numbers, count, axes)
        for blanked in (False, True):
            layout = Layout(dimensions, multiple=multiple, blanked=blanked, binary=False)
            if dimensions and layout.length == len(words):
                return layout
    return None


def _grids(numbers: list[int], count: int, axes: int) -> tuple[tuple[int, ...], ...]:
    plausible = 0 < count <= MOST_GRIDS and len(numbers) == axes * count
    if not plausible or not all(0 < n < 2**31 for n in numbers):
        return ()
    return tuple(tuple(numbers[n * axes : n * axes + axes]) for n in range(count))


def find_solution(grid: Path) -> Path:
    """Find the solution beside a grid: ``xyz`` in its name gives ``q``, or its suffix does."""
    names = list(dict.fromkeys(_solution_names(grid)))
    for name in names:
        if (grid.parent / name).is_file():
            return grid.parent / name
    msg = (
        f"{grid} is a PLOT3D grid, but its solution, which contains the velocity, is not in the "
        f"same folder (tried {', '.join(names)}); put it there under one of these names"
    )
    raise FieldError(msg)


def find_grid(solution: Path) -> Path | None:
    """Find the grid beside a solution, or ``None`` where this is not a solution."""
    if "q" not in solution.name.lower():
        return None
    beside = solution.parent.iterdir()
    grids = sorted(p for p in beside if p.suffix.lower() in GRID_SUFFIXES and p != solution)
    return next((p for p in grids if solution.name in _solution_names(p)), None)


def _solution_names(grid: Path) -> Iterator[str]:
    for old, new in (("xyz", "q"), ("XYZ", "Q")):
        if old in grid.name:
            before, after = grid.name.rsplit(old, 1)
            yield before + new + after
    yield grid.stem + (".Q" if grid.suffix.isupper() else ".q")


def _check_solution(layout: Layout, solution: Path) -> None:
    """Raise a FieldError for a solution that is cut, or of other grids."""
    if not layout.binary:
        return
    axes, grids = len(layout.dimensions[0]), layout.dimensions
    size = solution.stat().st_size
    with solution.open("rb") as file:
        head = file.read(4 * (3 * len(grids) + 4))
    # A grid of three dimensions that is cut may be as long as one of two.
    for rank in (axes, 5 - axes):
        sizes = _binary_header(
            head,
            ">" if layout.big_endian else "<",
            rank,
            marks=layout.record_marks,
            multiple=layout.multiple,
        )
        fits = rank == axes or size == _solution_length(layout, sizes, rank)
        if sizes and fits and sizes != grids:
            msg = (
                f"{solution.name} has grids of {sizes[:3]} nodes, but the grid file has "
                f"{grids[:3]}; the grid file is truncated, or the solution belongs to another grid"
            )
            raise FieldError(msg)
        check_count(size, _solution_length(layout, grids, axes), solution.name)
        if size == _solution_length(layout, grids, axes):
            break


def _solution_length(layout: Layout, grids: tuple[tuple[int, ...], ...], axes: int) -> int:
    real, mark = 8 if layout.double else 4, 8 * layout.record_marks
    header = 4 * axes * len(grids) + mark + (4 + mark) * layout.multiple
    # Four numbers of the flow, then density, momentum and energy at each node.
    return header + sum((4 + (axes + 2) * math.prod(grid)) * real + 2 * mark for grid in grids)


def read_plot3d(grid: Path, layout: Layout, solution: Path) -> pv.MultiBlock:
    """Read a grid with its solution into a PyVista MultiBlock whose blocks have ``Velocity``."""
    _check_solution(layout, solution)
    import pyvista as pv
    from vtkmodules.vtkIOParallel import vtkMultiBlockPLOT3DReader

    reader = vtkMultiBlockPLOT3DReader()
    reader.AutoDetectFormatOff()
    reader.SetBinaryFile(layout.binary)
    reader.SetByteOrder(reader.FILE_BIG_ENDIAN if layout.big_endian else reader.FILE_LITTLE_ENDIAN)
    reader.SetHasByteCount(layout.record_marks)
    reader.SetMultiGrid(layout.multiple)
    reader.SetIBlanking(layout.blanked)
    reader.SetDoublePrecision(layout.double)
    reader.SetTwoDimensionalGeometry(len(layout.dimensions[0]) == 2)
    reader.SetXYZFileName(str(grid))
    reader.SetQFileName(str(solution))
    reader.AddFunction(VELOCITY)
    reader.Update()
    blocks: pv.MultiBlock = pv.wrap(reader.GetOutput())
    return blocks
