"""The cells of a surface that a camera sees, pixel by pixel."""

from __future__ import annotations

import numpy as np

from flowtex.field import Surface
from flowtex.field.locate import TRIANGLES
from flowtex.rendering.cpu.camera import Camera
from flowtex.rendering.cpu.raster import Coverage, rasterise

__all__ = ["cover"]


def cover(surface: Surface, camera: Camera) -> Coverage:
    """Find the visible cells; quads are cut along the diagonal from their first corner.

    Parameters
    ----------
    surface
        The surface; cells with a node that is not valid are left out.
    camera
        From where.

    Returns
    -------
    Coverage
        Its corners count the nodes row by row: j times the number of columns, plus i.
    """
    points = (surface.points - surface.center).reshape(-1, 3)
    matrix = camera.matrix(surface.center)
    clip = points @ matrix[:, :3].T + matrix[:, 3]
    columns = surface.shape[1]
    j, i = np.nonzero(surface.cells)
    halves = np.array([j * columns + i for half in TRIANGLES for j, i in half])
    triangles = ((j * columns + i)[:, None] + halves).reshape(-1, 3)
    return rasterise(clip, triangles, camera.size)
