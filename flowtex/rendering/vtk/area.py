"""Where a renderer draws, and the margin of a frame that is a part of a larger picture.

The local mean of a texture depends on pixels around it. In a tile of a large picture some of these
are beyond its edges, so the passes draw more than the frame shows, and tiles join without a seam.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkCamera
from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLRenderWindow

from flowtex._util.array_types import Floats, Ints


class PicturePart(NamedTuple):
    """A frame as a part of a picture, in pixels of the frame."""

    left: int  #: Pixels of the picture to the left of the frame,
    low: int  #: and below it.
    width: int  #: Of the whole picture.
    height: int


@dataclass(frozen=True, eq=False)
class PassArea:
    """Pixels of the passes' textures into which the pixels of a renderer are drawn."""

    corner: Ints  #: Lower left pixel of the renderer with its margin, (2,).
    size: Ints  #: Width and height with the margin, (2,).
    margin: int  #: Pixels on each side that the frame does not show.
    view: Floats  #: From the world to the renderer with its margin, (4, 4).
    projection: Floats  #: The same from the camera's coordinates.
    shift: tuple[int, int]  #: From pixels of the textures to those of the whole picture.
    end: tuple[int, int]  #: Pixel of the textures that follows the whole picture.

    @classmethod
    def of(cls, renderer: pv.Renderer, part: PicturePart | None, margin: int) -> PassArea:
        """Return the area of a renderer whose frame may be a part of a picture."""
        window = renderer.GetRenderWindow()
        camera = renderer.GetActiveCamera()
        corner, size = part_of(window, renderer)
        if part is None:
            margin = 0
            part = PicturePart(0, 0, *window.GetActualSize())
        wider = size + 2 * margin
        smaller = np.diag([*(size / wider), 1.0, 1.0])
        aspect = renderer.GetTiledAspectRatio()
        whole = camera.GetCompositeProjectionTransformMatrix(aspect, -1, 1)
        projection = camera.GetProjectionTransformMatrix(aspect, -1, 1)
        shift = (part.left - margin, part.low - margin)
        return cls(
            corner=corner,
            size=wider,
            margin=margin,
            view=smaller @ pv.array_from_vtkmatrix(whole),
            projection=smaller @ pv.array_from_vtkmatrix(projection),
            shift=shift,
            end=(part.width - shift[0], part.height - shift[1]),
        )

    def camera(self, camera: vtkCamera) -> vtkCamera:
        """Return a camera that sees the margin, too."""
        if not self.margin:
            return camera
        wider = vtkCamera()
        wider.DeepCopy(camera)
        wider.SetExplicitProjectionTransformMatrix(pv.vtkmatrix_from_array(self.projection))
        wider.UseExplicitProjectionTransformMatrixOn()
        return wider


def tile_of(window: vtkOpenGLRenderWindow) -> PicturePart | None:
    """Return the part that VTK draws of a picture that is larger than the window, if it does."""
    if tuple(window.GetTileScale()) == (1, 1):
        return None
    width, height = window.GetSize()
    left, low = window.GetTileViewport()[:2]
    return PicturePart(round(left * width), round(low * height), width, height)


def part_of(window: vtkOpenGLRenderWindow, renderer: pv.Renderer) -> tuple[Ints, Ints]:
    """Return corner and size of a renderer in the pixels of the window's present part, (2,)."""
    whole = np.array(window.GetSize())
    tile = np.reshape(window.GetTileViewport(), (2, 2))
    shown = np.clip(np.reshape(renderer.GetViewport(), (2, 2)), tile[0], tile[1]) - tile[0]
    low, high = np.floor(shown * whole + 0.5).astype(int)
    return low, high - low
