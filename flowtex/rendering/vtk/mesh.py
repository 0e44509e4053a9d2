"""The surface as PyVista draws it, with the vertex attributes that the shader reads."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from flowtex._util.array_types import Floats32
from flowtex.textures import TextureSet

__all__ = [
    "COORDINATE",
    "NOISE",
    "NORMAL",
    "POSITION",
    "set_attributes",
    "set_position",
    "surface_mesh",
]

#: Names of the point arrays that become vertex attributes.
POSITION, COORDINATE, NOISE = "flowtex position", "flowtex coordinate", "flowtex noise"
NORMAL = "Normals"


def surface_mesh(textures: TextureSet) -> pv.PolyData:
    """Return the visible cells of the surface, with normals and the shader's attributes."""
    field = textures.geometry.field
    rows, columns = field.shape
    grid = pv.StructuredGrid()
    grid.points = field.points.reshape(-1, 3)
    grid.dimensions = (columns, rows, 1)
    j, i = np.nonzero(field.surface.cells)
    corner = j * columns + i
    quads = np.stack([corner, corner + 1, corner + columns + 1, corner + columns], axis=-1)
    mesh = pv.PolyData.from_regular_faces(grid.points, quads)
    mesh.point_data[NORMAL] = textures.geometry.normal.reshape(-1, 3)
    mesh.point_data.active_normals_name = NORMAL
    set_attributes(mesh, textures)
    return mesh


def set_position(mesh: pv.PolyData, position: Floats32) -> None:
    """Write the nodes' positions in the surface's frame, (J, I, 3), relative to any anchor."""
    mesh.point_data[POSITION] = position.reshape(-1, 3)


def set_attributes(mesh: pv.PolyData, textures: TextureSet) -> None:
    """Write the vertex attributes of a texture set to its mesh."""
    geometry = textures.geometry
    set_position(mesh, geometry.position)
    mesh.point_data[COORDINATE] = geometry.coordinate.reshape(-1, 2)
    if textures.paper is not None:
        mesh.point_data[NOISE] = textures.paper.coordinate.reshape(-1, 2)
