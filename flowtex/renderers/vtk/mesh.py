"""The surface as PyVista draws it, with the vertex attributes that the shader reads."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from numpy.typing import NDArray

from flowtex.field import Surface
from flowtex.textures import TextureSet

__all__ = ["COORDINATE", "NOISE", "POSITION", "set_attributes", "surface_mesh"]

#: Names of the point arrays that become vertex attributes.
POSITION, COORDINATE, NOISE = "flowtex position", "flowtex coordinate", "flowtex noise"


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
    mesh.point_data["Normals"] = _normals(field.surface)
    mesh.point_data.active_normals_name = "Normals"
    set_attributes(mesh, textures)
    return mesh


def set_attributes(mesh: pv.PolyData, textures: TextureSet) -> None:
    """Write the vertex attributes of a texture set to its mesh."""
    geometry = textures.geometry
    mesh.point_data[POSITION] = geometry.position.reshape(-1, 3)
    mesh.point_data[COORDINATE] = geometry.coordinate.reshape(-1, 2)
    if textures.paper is not None:
        mesh.point_data[NOISE] = textures.paper.coordinate.reshape(-1, 2)


def _normals(surface: Surface) -> NDArray[np.float32]:
    """Return unit normals at the nodes; at a collapsed one, that of the line beside it."""
    normal = np.cross(*surface.tangents)
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    small = length[..., 0] <= 1e-9 * max(float(np.median(length)), 1e-300)
    if small.any() and not small.all():
        for row, beside in ((0, 1), (-1, -2)):
            normal[row][small[row]] = normal[beside][small[row]].mean(axis=0)
        for column, beside in ((0, 1), (-1, -2)):
            bad = small[:, column]
            normal[bad, column] = normal[bad, beside]
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.where(length > 0, normal / np.where(length > 0, length, 1.0), [0.0, 0.0, 1.0])
    return normal.reshape(-1, 3).astype(np.float32)
