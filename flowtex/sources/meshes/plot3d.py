"""Meshes with data in a file beside them: PLOT3D, and surfaces that cannot store vectors.

A PLOT3D file does not describe itself: text or binary, byte order, Fortran's record marks, one grid
or several, two or three dimensions, single or double precision, blanking or none. All of these
change the length of the file, so the layout is the one whose length fits. It is determined before
VTK opens the file, because VTK takes any number in a broken header for a size.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError
from flowtex.sources.meshes.parts import TimeStep, read_checked
from flowtex.sources.meshes.vectors import candidates
from flowtex.sources.reader_errors import check_count

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
_BOTH = (False, True)

Dimensions = tuple[tuple[int, ...], ...]
#: Endings of such files.
SURFACE_SUFFIXES = (".obj", ".ply", ".stl")
#: Name of the vectors.
NAME = "velocity"


@dataclass(frozen=True)
class Layout:
    """The layout of a grid file; ``dimensions`` has 2 or 3 numbers for each grid."""

    dimensions: Dimensions
    multiple: bool
    blanked: bool
    binary: bool = True
    big_endian: bool = False
    record_marks: bool = False
    double: bool = False

    def length(self, *, solution: bool = False) -> int:
        """Return the length of such a file, or of its solution: bytes if binary, else numbers."""
        axes = len(self.dimensions[0])
        if self.binary:
            word = 4
        else:
            word = 1
        real = word * (1 + (self.double and self.binary))
        marks = 8 * self.record_marks
        header = word * axes * len(self.dimensions) + marks + (word + marks) * self.multiple
        # A solution has four numbers of the flow, then density, momentum and energy at each node.
        if solution:
            each = (axes + 2) * real
            rest = 4 * real + 2 * marks
        else:
            each = axes * real + word * self.blanked
            rest = marks
        return header + sum(math.prod(grid) * each + rest for grid in self.dimensions)


def find_layout(path: Path) -> Layout | None:
    """Return the layout of a grid file, or ``None`` if it is no PLOT3D grid."""
    head = _head(path)
    size = path.stat().st_size
    is_text = set(head[:256]) <= _TEXT
    if is_text:
        check_memory(TEXT_GROWTH * size, "the file")
        words = path.read_bytes().replace(b",", b" ").split()
        size = len(words)
    choices = product(_BOTH, _BOTH, _BOTH, (3, 2), _BOTH, _BOTH)
    for is_big, marks, multiple, axes, double, blanked in choices:
        if is_text and (is_big or marks or double):
            continue
        if is_text:
            numbers = words
        else:
            numbers = _integers(head, big_endian=is_big)
        if dimensions := _dimensions(numbers, axes, marks=marks, multiple=multiple):
            layout = Layout(dimensions, multiple, blanked, not is_text, is_big, marks, double)
            if layout.length() == size:
                return layout
    return None


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(4 * (3 * MOST_GRIDS + 4))


def _integers(head: bytes, *, big_endian: bool) -> Any:
    return np.frombuffer(head[: len(head) // 4 * 4], dtype=">i4" if big_endian else "<i4")


def _dimensions(words: Sequence[Any], axes: int, *, marks: bool, multiple: bool) -> Dimensions:
    """Return the dimensions in a header of this form; empty if they are not plausible."""
    # A record mark stands before and after each record.
    count = 1
    first = int(marks)
    try:
        if multiple:
            count = int(words[first])
            first = 3 * first + 1
        numbers = [int(word) for word in words[first : first + axes * max(count, 0)]]
    except (IndexError, ValueError):
        return ()
    plausible = 0 < count <= MOST_GRIDS and len(numbers) == axes * count
    if not plausible or not all(0 < n < 2**31 for n in numbers):
        return ()
    return tuple(tuple(numbers[n : n + axes]) for n in range(0, len(numbers), axes))


def find_solution(grid: Path) -> Path:
    """Find the solution beside a grid: ``xyz`` in its name gives ``q``, or its suffix does.

    Raises
    ------
    FieldError
        When the folder of the grid has no file with one of these names.
    """
    names = list(dict.fromkeys(_solution_names(grid)))
    for name in names:
        if (grid.parent / name).is_file():
            return grid.parent / name
    raise FieldError(
        f"{grid} is a PLOT3D grid, but its solution, which contains the velocity, is not in the "
        f"same folder (tried {', '.join(names)}); put it there under one of these names"
    )


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
            yield new.join(grid.name.rsplit(old, 1))
    yield grid.stem + (".Q" if grid.suffix.isupper() else ".q")


def _check_solution(layout: Layout, solution: Path) -> None:
    if not layout.binary:
        return
    size = solution.stat().st_size
    words = _integers(_head(solution), big_endian=layout.big_endian)
    for rank in (2, 3):  # a grid of three dimensions that is cut may look like one of two
        form = {"marks": layout.record_marks, "multiple": layout.multiple}
        sizes = _dimensions(words, rank, **form)
        other = replace(layout, dimensions=sizes or layout.dimensions)
        if other != layout and other.length(solution=True) == size:
            raise FieldError(
                f"{solution.name} has {sizes[:3]} nodes, and {layout.dimensions[:3]} are expected; "
                "the grid file is truncated, or the solution belongs to another grid"
            )
    check_count(size, layout.length(solution=True), solution.name)


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


def read_with_vectors(file: Path) -> tuple[Any, str | None, str]:
    """Return the mesh of a file, or its time steps, with vectors, their name, and the problem.

    They are in ``NAME.npy``, in the order of points or triangles of the reader; points of an STL
    may be three for each triangle, as in the file, or one for each place, as in PyVista.
    """
    import pyvista as pv

    reader: Any = pv.get_reader(str(file))
    mesh = read_checked(reader)
    if candidates(mesh):
        return mesh, None, ""
    path = file.with_suffix(".npy")
    is_stl = file.suffix.lower() == ".stl"
    points = mesh.n_points
    cells = mesh.n_cells
    vectors, problem = _vectors(path)
    if vectors.shape[-2] == 3 * cells != points and is_stl:
        reader.reader.SetMerging(0)
        mesh = read_checked(reader)
    if not problem and vectors.shape[-2] not in (mesh.n_points, cells):
        problem = f"{path.name} has shape {vectors.shape}"
    if problem:
        text = f"{problem}; expected vectors in {path.name} in the same folder, written by "
        text += (
            f"numpy.save: numbers of shape ({points}, 3) for the points or ({cells}, 3) for the "
        )
        return mesh, None, f"{text}faces, in the order of the file, or (T, ..., 3) for times"

    def with_vectors(step: AnyArray) -> Any:
        copy = mesh.copy(deep=False)
        if len(step) == mesh.n_points:
            data = copy.point_data
        else:
            data = copy.cell_data
        data[NAME] = step
        return copy

    if vectors.ndim == 2:
        return with_vectors(vectors), NAME, ""
    steps = [TimeStep(with_vectors(v), float(n), f"step {n}") for n, v in enumerate(vectors)]
    return steps, NAME, ""


def _vectors(path: Path) -> tuple[AnyArray, str]:
    """Return the array beside a file, (N, 2 or 3) or (T, N, 2 or 3), and the problem with it."""
    nothing = np.empty((0, 3))
    if not path.is_file():
        return nothing, "the file has no vectors, because its format cannot store them"
    try:
        # Mapped first: NumPy allocates the declared size even if the file is shorter.
        vectors = np.load(path, mmap_mode="r", allow_pickle=False)
        if vectors.ndim in (2, 3) and vectors.shape[-1] in (2, 3) and vectors.dtype.kind in "fiu":
            return np.array(vectors), ""
    except (ValueError, EOFError, OSError, AttributeError) as error:  # the last of an archive
        return nothing, f"{path.name} is not a NumPy array ({error})"
    return nothing, f"{path.name} has shape {vectors.shape} and type {vectors.dtype}"
