"""The surface as PyVista draws it: its mesh, the shader's vertex attributes, and its mapper."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from pyvista.plotting.mapper import _BaseDataSetMapper
from pyvista.plotting.themes import Theme
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkConstants import VTK_ID_TYPE
from vtkmodules.vtkCommonDataModel import vtkCellArray
from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

from flowtex._util.array_types import Floats32, Indices
from flowtex.textures import TextureSet

#: Extents from the origin from which on VTK draws points relative to another one; nearer by it
#: takes them to single precision as they are.
FAR_EXTENTS = 1e3
#: Point arrays of the mesh.
POSITION, COORDINATE, NOISE = "flowtex position", "flowtex coordinate", "flowtex noise"
CORNERS = "flowtex corners"
NORMAL = "Normals"
#: Those that the shader reads, by the names of its vertex attributes.
ATTRIBUTES = {
    "flowtexPosition": POSITION,
    "flowtexCoordinate": COORDINATE,
    "flowtexNormal": NORMAL,
    "flowtexNoise": NOISE,
    "flowtexCorners": CORNERS,
}


def surface_mesh(textures: TextureSet) -> pv.PolyData:
    """Return the visible cells of the surface, with normals and the shader's attributes."""
    geometry = textures.geometry
    points = np.ascontiguousarray(geometry.at_vertices(geometry.points))
    near = np.abs(geometry.center).max() < FAR_EXTENTS * geometry.extent
    if near and geometry.corners is not None:
        points = points.astype(np.float32)  # there are six times as many vertices as nodes
    faces: Any = geometry.faces
    mesh = pv.PolyData.from_regular_faces(points, faces)
    mesh.point_data[NORMAL] = geometry.vertex_normals
    mesh.point_data.active_normals_name = NORMAL
    set_attributes(mesh, textures)
    return mesh


def set_position(mesh: pv.PolyData, position: Floats32) -> None:
    """Write the vertices' positions in the surface's frame, (V, 3), relative to any anchor."""
    mesh.point_data[POSITION] = position


def set_triangles(mesh: pv.PolyData, triangles: Indices) -> None:
    """Draw other triangles, (N, 3), of the mesh's points."""
    cells = vtkCellArray()
    cells.SetData(3, numpy_to_vtk(triangles.ravel(), deep=True, array_type=VTK_ID_TYPE))
    mesh.SetPolys(cells)


def set_attributes(mesh: pv.PolyData, textures: TextureSet) -> None:
    """Write the vertex attributes of a texture set to its mesh."""
    geometry = textures.geometry
    set_position(mesh, geometry.at_vertices(geometry.position))
    mesh.point_data[COORDINATE] = geometry.coordinate.reshape(-1, 2)
    if (corners := geometry.corners) is not None:
        mesh.point_data[CORNERS] = corners
    if textures.paper is not None:
        mesh.point_data[NOISE] = textures.paper.coordinate.reshape(-1, 2)


def vertex_attributes(textures: TextureSet) -> dict[str, str]:
    """Return the point arrays that the shader of a texture set reads, by vertex attribute."""
    needed = {POSITION, COORDINATE}
    if not textures.geometry.planar:
        needed.add(NORMAL)
    if textures.geometry.corners is not None:
        needed.add(CORNERS)
    if textures.paper is not None:
        needed.add(NOISE)
    return {name: array for name, array in ATTRIBUTES.items() if array in needed}


class FlowMapper(_BaseDataSetMapper, vtkPolyDataMapper):
    """PyVista's mapper properties on ``vtkPolyDataMapper``.

    PyVista's own mapper hides the polygon mapper inside ``vtkDataSetMapper``, where neither
    vertex attributes nor the event before a draw can be reached.
    """

    def __init__(self, dataset: pv.PolyData, theme: Theme | None = None) -> None:
        super().__init__(theme=theme)
        self.SetInputData(dataset)


def use_flow_mapper(actor: pv.Actor, mesh: pv.PolyData) -> FlowMapper:
    """Give an actor a polygon mapper that is coloured by a point array of its mesh by name.

    PyVista's mapper relies on the active array of its own mesh instead.
    """
    mapper = FlowMapper(mesh)
    mapper.ShallowCopy(actor.mapper)
    mapper.SetInputData(mesh)
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SetInterpolateScalarsBeforeMapping(True)
    actor.SetMapper(mapper)
    return mapper
