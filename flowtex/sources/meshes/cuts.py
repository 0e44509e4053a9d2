"""The drawn surface of a mesh: its surface, a plane through a volume, or a contour of it.

A cut is given as text, ``slice="x=0.5"`` or ``contour="pressure=101325"``, or as numbers.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import brief, near_names
from flowtex._util.array_types import Floats, Indices
from flowtex._util.arrays import norm
from flowtex.errors import FieldError
from flowtex.field.triangles.sharp_edges import split_nodes
from flowtex.field.triangles.triangle_nodes import (
    needle_edges,
    nodal_means,
    solid_triangles,
    triangle_normals,
)
from flowtex.remedies import Remedy
from flowtex.sources.meshes import vectors
from flowtex.sources.meshes.vectors import MeshArray, Sheet
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import pyvista as pv

_AXIS = re.compile(r"\s*(?P<axis>[xyz])\s*(=\s*(?P<at>[^\s=]+)\s*)?", re.IGNORECASE)
#: Flags of VTK's ghost arrays for cells that are not drawn, also of other pieces, which would
#: coincide with these.
_NOT_DRAWN = 1 | 8 | 32
#: Point array that marks hidden points during filters.
HIDDEN = "flowtex hidden"

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Slice:
    """A plane with this normal, through a point or the middle of the mesh; ``text`` as given."""

    normal: Vector
    point: Vector | None
    text: str

    def of(self, mesh: pv.DataSet) -> pv.PolyData:
        """Return the section of a volume.

        Raises
        ------
        FieldError
            When the plane does not cut the mesh.
        """
        # Polygons would be torn where some of their points nearly coincide.
        middle = self.point or mesh.center
        cut = mesh.slice(normal=self.normal, origin=middle, generate_triangles=True)
        if not cut.n_cells:
            ends = zip("xyz", np.reshape(mesh.bounds, (3, 2)), strict=True)
            spans = ", ".join(f"{axis} from {low:g} to {high:g}" for axis, (low, high) in ends)
            raise FieldError(f"slice is {self.text}, which does not cut the mesh; it has {spans}")
        return cut


@dataclass(frozen=True)
class Contour:
    """The places where an array has a value; ``text`` as given."""

    name: str
    value: float
    text: str

    def of(self, mesh: pv.DataSet) -> pv.PolyData:
        """Return the contour in a volume whose array is on points.

        Raises
        ------
        FieldError
            When the array never has the value.
        """
        cut = mesh.contour([self.value], scalars=self.name)
        if not cut.n_cells:
            low, high = mesh.get_data_range(self.name)
            span = f"expected a value of {self.name} from {low:g} to {high:g}"
            raise FieldError(f"contour is {self.text}; {span}")
        return cut


Cut = Slice | Contour


def slice_of(raw: Any) -> Slice:
    """Return a plane from a text, such as ``"x=0.5"``, a normal, or a pair (normal, point).

    Raises
    ------
    FieldError
        When the value has another form, or the normal is zero.
    """
    normal: Any = raw
    point: Any = None
    if isinstance(raw, str):
        first, through, second = raw.partition("through")
        normal = first.split(",")
        if through:
            point = second.split(",")
        else:
            point = None
        if match := _AXIS.fullmatch(raw):
            normal = [float(axis == match["axis"].lower()) for axis in "xyz"]
            point = match["at"] and [_number(match["at"]) * on for on in normal]
    elif _is_pair(raw):
        normal, point = raw
        if isinstance(normal, str) and normal in "xyz":
            normal = np.arange(3) == "xyz".index(normal)
    direction = _vector(normal)
    if point is None:
        middle = None
    else:
        middle = _vector(point)
    if direction is None or not any(direction) or (point is not None and middle is None):
        raise FieldError(
            f'slice is {brief(raw)}; expected a text such as "x=0.5", "1,1,0" or "1,1,0 through '
            '0.5,0.5,0.2", or a pair (normal, point) of three numbers each'
        )
    return Slice(direction, middle, repr(raw))


def contour_of(raw: Any) -> Contour:
    """Return a contour from a text, such as ``"pressure=101325"``, or a pair (name, value).

    Raises
    ------
    FieldError
        When it is neither, or the value is not finite.
    """
    pair = raw
    if isinstance(raw, str):
        pair = raw.rpartition("=")[::2]
    if isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str):
        name = pair[0].strip()
        value = _number(pair[1])
        if name and math.isfinite(value):
            return Contour(name, value, repr(raw))
    expected = 'expected an array and its value, as in contour="pressure=101325"'
    raise FieldError(f"contour is {brief(raw)}; {expected}")


def _is_pair(raw: Any) -> bool:
    is_list = isinstance(raw, (list, tuple))
    is_matrix = isinstance(raw, np.ndarray) and raw.ndim == 2
    return (is_list or is_matrix) and len(raw) == 2


def _vector(raw: Any) -> Vector | None:
    try:
        x, y, z = map(_number, raw)
    except (TypeError, ValueError):
        return None
    if math.isfinite(x + y + z):
        return (x, y, z)
    return None


def _number(raw: Any) -> float:
    try:
        return float(raw)
    except (TypeError, ValueError):
        return math.nan


def check_cut(mesh: pv.DataSet, cut: Cut | None) -> None:
    """Check that a mesh has a surface, or that a cut of it has one.

    Raises
    ------
    FieldError
        When the mesh has no cells with an area, is a surface already, or lacks the array of the
        contour.
    """
    dimension = mesh.max_cell_dimensionality
    if not mesh.n_cells:
        raise FieldError("the mesh has no cells; check the file or filter that made it")
    if dimension < 2:
        raise FieldError(
            "the mesh has only points or lines; expected a surface, or a volume. Join points of a "
            "surface, as in flowtex.show(mesh.delaunay_2d())"
        )
    if cut is not None and dimension == 2:
        name = type(cut).__name__.lower()
        raise FieldError(f"{name} is {cut.text}, but the mesh is already a surface; omit {name}")
    names = dict.fromkeys(
        a.name for a in vectors.catalogue(mesh) if a.numeric and a.components == 1
    )
    if isinstance(cut, Contour) and cut.name not in names:
        text = f"contour is {cut.text}, but the mesh has no array {cut.name!r} of one component"
        raise FieldError(f"{text}; {near_names(cut.name, names)}")


def surface_sheet(mesh: Any, cut: Cut | None, velocity: MeshArray, record: Record) -> Sheet:
    """Return the nodes of the surface of a mesh, (N,), which :func:`check_cut` has checked."""
    surface, triangles, cells = _surface_of(mesh, cut, velocity, record)
    points = np.asarray(surface.points, dtype=np.float64)
    origin: Indices | slice = slice(None)
    if velocity.where == "cells" and cut is None:
        # A mean over cells must belong to one face.
        triangles, origin = split_nodes(points, triangles)
        points = points[origin]

    def nodes(array: MeshArray) -> Floats:
        if array.where == "points" or cut is not None:
            on_points = replace(array, where="points")
            return vectors.values_of(surface, on_points)[origin].astype(np.float64)
        values = vectors.values_of(surface, array).astype(np.float64)
        areas = np.nan_to_num(norm(triangle_normals(points, triangles)) / 2)
        finite = np.asarray(np.isfinite(values.reshape(len(values), -1)).all(axis=1))
        return nodal_means(values[None], triangles, areas, len(points), finite)[0]

    def flat(array: MeshArray) -> Floats:
        return np.asarray(vectors.values_of(surface, array)[cells], dtype=np.float64)

    return Sheet(
        points=points,
        shown=np.asarray(surface.point_data[HIDDEN])[origin] <= 0,
        arrays=[a for a in vectors.catalogue(mesh) if a.name in vectors.data_of(surface, a.where)],
        nodes=nodes,
        flat=flat,
        triangles=triangles,
    )


def _surface_of(
    mesh: Any, cut: Cut | None, velocity: MeshArray, record: Record
) -> tuple[pv.PolyData, Indices, Indices]:
    """Return a PolyData with the data of the mesh, the triangles of its surface, and their cells.

    These are (M, 3) nodes and (M,) cells of the PolyData. A velocity on the cells of a volume is
    interpolated to its points before a cut. :data:`HIDDEN` is above zero at points that depend on
    hidden ones.
    """
    import pyvista as pv

    mesh = _shown_cells(mesh)
    if isinstance(mesh, pv.UnstructuredGrid):
        kinds = mesh.distinct_cell_types
        flat = cut is None and any(kind.dimension == 2 for kind in kinds)
        if cut is None and any(kind.dimension == 3 for kind in kinds):
            if flat:
                text = "cells of two dimensions are"
            else:
                text = "outer surface of the volume is"
            record("surface", f"the {text} drawn", *_other_cuts(mesh), notable=True)
        drawn_kinds = [kind for kind in kinds if kind.dimension == (2 if flat else 3)]
        drawn: Any = np.isin(mesh.celltypes, drawn_kinds)
        if not (drawn.all()):
            mesh = mesh.extract_cells(drawn, pass_cell_ids=False)
    if cut is not None:
        if isinstance(cut, Contour):
            name = "isosurface"
        else:
            name = "slice"
        record("surface", f"{name} {cut.text.strip(chr(39))}")
        mesh = cut.of(_exact(_on_points(mesh, velocity, cut)))
    elif not isinstance(mesh, pv.PolyData):
        mesh = mesh.extract_surface(
            pass_pointid=False, pass_cellid=False, algorithm="dataset_surface"
        )
    if not mesh.is_all_triangles or mesh.n_cells != mesh.GetNumberOfPolys():
        mesh = mesh.triangulate()
    triangles = np.asarray(mesh.regular_faces, dtype=np.intp)
    cells = np.arange(len(triangles))
    if cut is not None:
        # A plane through the corners of cells has triangles without area. Those with a short side
        # show which points nearly coincide; others are left out.
        points = np.asarray(mesh.points, dtype=np.float64)
        kept = solid_triangles(points, triangles) | needle_edges(points, triangles).any(axis=1)
        triangles = triangles[kept]
        cells = cells[kept]
    return mesh, triangles, cells


def _other_cuts(mesh: pv.DataSet) -> list[Remedy]:
    """Return the arguments that cut a volume in its middle, by a plane or an isosurface."""
    bounds = np.reshape(mesh.bounds, (3, 2))
    axis = int(np.argmin(np.ptp(bounds, axis=1)))
    plane = f"{'xyz'[axis]}={bounds[axis].mean():.4g}"
    cuts = [Remedy("slice", plane, "to cut the volume, use")]
    for array in vectors.catalogue(mesh):
        if not array.real or array.components != 1 or array.name == HIDDEN:
            continue
        values = vectors.values_of(mesh, array)
        middle = (np.nanmin(values) + np.nanmax(values)) / 2
        if np.nanmin(values) < middle < np.nanmax(values):
            cuts.append(Remedy("contour", f"{array.name}={middle:.4g}", "or"))
            return cuts
    return cuts


def _shown_cells(mesh: pv.DataSet) -> pv.DataSet:
    hidden = vectors.hidden_nodes(mesh)
    ghosts = mesh.cell_data.get("vtkGhostType", np.zeros(mesh.n_cells, np.uint8))
    mesh = mesh.copy(deep=False)
    for data in (mesh.point_data, mesh.cell_data):
        for name in set(vectors.BLANKING) & set(data):
            del data[name]
    mesh.point_data[HIDDEN] = hidden.astype(np.float64)
    shown = (np.asarray(ghosts) & _NOT_DRAWN) == 0
    if not shown.any():
        raise FieldError("all cells of the mesh are hidden; show some of them")
    if shown.all():
        return mesh
    return mesh.extract_cells(shown, pass_cell_ids=False, pass_point_ids=False)


def _exact(mesh: Any) -> pv.DataSet:
    """Return a volume in double precision; in single, slivers of a cut have random normals."""
    import pyvista as pv

    if isinstance(mesh, (pv.ImageData, pv.RectilinearGrid)):
        mesh = mesh.cast_to_structured_grid()
    if np.asarray(mesh.points).dtype != np.float64:
        # Not by assignment, which would change the positions of the user's mesh.
        mesh.SetPoints(pv.vtk_points(np.asarray(mesh.points, dtype=np.float64)))
    return mesh


def _on_points(mesh: pv.DataSet, velocity: MeshArray, cut: Cut) -> pv.DataSet:
    """Return a volume with the velocity and the array of a contour on its points.

    It keeps its numbers on cells, and may be the changed mesh.
    """
    if velocity.where == "cells":
        moved = set(velocity.parts or (velocity.name,))
    else:
        moved = set()
    if isinstance(cut, Contour) and cut.name not in mesh.point_data:
        moved.add(cut.name)
    cells = mesh.copy(deep=False)
    cells.clear_data()
    for array in vectors.catalogue(mesh):
        if array.where == "points":
            continue
        if array.name in moved:
            cells.cell_data[array.name] = np.asarray(mesh.cell_data[array.name], dtype=np.float64)
        if not array.numeric:
            del mesh.cell_data[array.name]
    for name, values in cells.cell_data_to_point_data().point_data.items() if moved else ():
        mesh.point_data[name] = values
    return mesh
