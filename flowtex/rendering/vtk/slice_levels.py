"""Whether a view needs the mip levels of the slices.

Drivers take long to make them: one that draws with the processor compiles programs for it in each
new window, for as long as a small picture takes. Most views of small surfaces are so near that only
the finest level is read.
"""

from __future__ import annotations

import numpy as np
import pyvista as pv

from flowtex._util.array_types import Floats
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.rendering.uniforms import ViewState
from flowtex.settings import Settings
from flowtex.textures.texture_set import TextureSet

#: Cells that a pixel may cover while only the finest level is read, by the smallest cell; shaders
#: read the next level from one cell on.
FINEST_CELLS = 0.5
#: Greatest relative difference between the scales of an actor along its axes.
SCALE_ROUNDING = 1e-6


def needs_levels(
    textures: TextureSet, settings: Settings, view: ViewState, place: Floats, mesh: pv.PolyData
) -> bool:
    """Return whether pixels of a view may cover so much that shaders read coarser mip levels.

    Parameters
    ----------
    textures
        The texture set that is drawn.
    settings
        How it is drawn.
    view
        The camera, and the size of a pixel at the focal point, in the mesh's units.
    place
        Matrix of the actor, (4, 4).
    mesh
        The mesh that is drawn.
    """
    surface = textures.geometry.field.surface
    if textures.geometry.levels == 0 or not settings.lod or not isinstance(surface, GridSurface):
        return False
    squares = place[:3, :3].T @ place[:3, :3]
    off = np.abs(squares - squares[0, 0] * np.eye(3)).max()
    if off > SCALE_ROUNDING * squares[0, 0]:  # a pixel is not equally large in all directions
        return True
    if view.pixel > FINEST_CELLS * textures.cell:  # most cells are as large, and soon found
        return True
    return view.pixel * _greatest_depth(view, mesh) > FINEST_CELLS * surface.least_extent


def _greatest_depth(view: ViewState, mesh: pv.PolyData) -> float:
    """Return the greatest depth of the mesh's bounds, in depths of the focal point.

    Depth is along the line of sight. A pixel there is as many times as wide. Without perspective it
    is 1.
    """
    if not view.eye[3]:  # without perspective
        return 1.0
    ends = np.reshape(mesh.GetBounds(), (3, 2))
    corners = np.stack(np.meshgrid(*ends, indexing="ij"), axis=-1).reshape(-1, 3)
    eye = view.eye[:3]
    toward = view.focus - eye
    return float(((corners - eye) @ toward).max() / (toward @ toward))
