"""Check of a mesh before any filter of VTK sees it: filters trust each number of its cells.

A number of a point that does not exist, or a cell that is too short for its type, makes a filter
read outside of its memory.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Indices
from flowtex.errors import FieldError

#: Least number of points of cells of any length, by the number of their type.
LEAST = {2: 1, 4: 2, 6: 3, 7: 3, 36: 6, 41: 1, 42: 4}
#: First type whose order, and so the number of points, is free.
FIRST_HIGHER_ORDER = 68
#: Kinds of cells of a surface, and the least number of points of each.
KINDS = {"Verts": 1, "Lines": 2, "Polys": 3, "Strips": 3}
REMEDY = "; the file or the mesh is damaged, write or copy it again"


def check_mesh(mesh: Any) -> None:
    """Raise a FieldError for cells, or arrays, that do not match the points of a mesh.

    Parameters
    ----------
    mesh
        A mesh of PyVista's, or a tree of blocks.

    Raises
    ------
    FieldError
        When a cell refers to a point that does not exist, has too few or too many points for its
        type, or when the length of an array differs from the number of points or cells.
    """
    import pyvista as pv

    if isinstance(mesh, (pv.MultiBlock, pv.PartitionedDataSet)):
        for block in mesh:
            check_mesh(block)
    elif isinstance(mesh, pv.UnstructuredGrid):
        _check_unstructured(mesh)
    elif isinstance(mesh, pv.PolyData):
        for kind, least in KINDS.items():
            sizes = _checked_sizes(getattr(mesh, f"Get{kind}")(), mesh.n_points)
            _check_least(sizes, least, kind.lower())
    elif isinstance(mesh, pv.StructuredGrid):
        sides = mesh.dimensions
        count = len(mesh.points)
        if count and math.prod(sides) != count:
            raise FieldError(f"the dimensions are {sides}, but there are {count:,} points{REMEDY}")
    if isinstance(mesh, pv.DataSet):
        _check_lengths(mesh)


def _check_lengths(mesh: Any) -> None:
    """Raise a FieldError for an array with more or fewer values than points or cells."""
    places = (
        (mesh.GetPointData(), mesh.n_points, "points"),
        (mesh.GetCellData(), mesh.n_cells, "cells"),
    )
    for data, count, where in places:
        for number in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(number)
            if array.GetNumberOfTuples() != count:
                raise FieldError(
                    f"the array {array.GetName()!r} has {array.GetNumberOfTuples():,} values for "
                    f"{count:,} {where}{REMEDY}"
                )


def _check_unstructured(mesh: Any) -> None:
    import pyvista as pv

    sizes = _checked_sizes(mesh.GetCells(), mesh.n_points)
    if len(sizes):
        types = np.asarray(mesh.celltypes)
    else:
        types = np.empty(0, np.uint8)
    if len(types) != len(sizes):
        raise FieldError(f"there are {len(sizes):,} cells, but {len(types):,} types{REMEDY}")
    for kind in np.unique(types):
        own = sizes[types == kind]
        exact = _points_of_type(int(kind))
        if exact is None:
            _check_least(own, LEAST.get(int(kind), 1), f"cells of type {kind}")
        elif (own != exact).any():
            wrong = own[own != exact][0]
            raise FieldError(f"a cell of type {kind} has {wrong} points; expected {exact}{REMEDY}")
    if pv.CellType.POLYHEDRON in types:
        _check_polyhedra(mesh, types == pv.CellType.POLYHEDRON)


def _check_polyhedra(mesh: Any, is_polyhedron: AnyArray) -> None:
    """Raise a FieldError for polyhedra whose faces do not exist, or refer to other points."""
    faces = mesh.GetPolyhedronFaces()
    places = mesh.GetPolyhedronFaceLocations()
    if faces is None or places is None:
        raise FieldError(f"polyhedra have no faces{REMEDY}")
    _check_least(_checked_sizes(faces, mesh.n_points), 3, "faces of polyhedra")
    counts = _checked_sizes(places, faces.GetNumberOfCells(), "polyhedra", "faces")
    if len(counts) != len(is_polyhedron):
        raise FieldError(
            f"there are {len(is_polyhedron):,} cells, but faces of {len(counts):,}{REMEDY}"
        )
    _check_least(counts[is_polyhedron], 4, "polyhedra", "faces")


def _checked_sizes(cells: Any, count: int, what: str = "cells", parts: str = "points") -> Indices:
    """Return the number of points of each cell, if all refer to ``count`` points."""
    import pyvista as pv

    if cells is None or not cells.GetNumberOfCells():
        return np.empty(0, np.int64)
    if not cells.IsValid():
        raise FieldError(f"the offsets of its {what} are not in order{REMEDY}")
    connectivity = pv.convert_array(cells.GetConnectivityArray())
    if len(connectivity):
        low = int(connectivity.min())
        high = int(connectivity.max())
        if low < 0 or high >= count:
            raise FieldError(
                f"its {what} refer to {parts} {low} to {high}, but there are {count:,}{REMEDY}"
            )
    return np.diff(pv.convert_array(cells.GetOffsetsArray()))


def _check_least(sizes: Indices, least: int, what: str, parts: str = "points") -> None:
    if len(sizes) and sizes.min() < least:
        raise FieldError(
            f"the least of the {what} has {sizes.min()} {parts}; expected {least} or more{REMEDY}"
        )


@cache
def _points_of_type(kind: int) -> int | None:
    """Return the number of points of a type of cells; ``None`` where it varies."""
    from vtkmodules.vtkCommonDataModel import vtkGenericCell

    if kind in LEAST or kind >= FIRST_HIGHER_ORDER:
        return None
    cell = vtkGenericCell.InstantiateCell(kind)
    if cell is None:
        raise FieldError(f"cells have the type {kind}, which VTK does not know{REMEDY}")
    return int(cell.GetNumberOfPoints())
