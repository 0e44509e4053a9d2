"""An off-screen window with a camera, drawn whole or a rectangle at a time.

Pictures are drawn into the lower left corner of a window that keeps its size: a draft is the
whole view in a small corner, a tile a part of the view at full size. Nothing is allocated from one
to the next, and a tile has the same pixels as the whole picture at its place. So the window may be
smaller than a picture that it draws in tiles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Bytes
from flowtex.plotting.vtk_camera import apply_camera
from flowtex.rendering.camera import Camera

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingCore import vtkCamera

Rect = tuple[int, int, int, int]
#: Longest side of a window, in pixels.
LONGEST_SIDE_PX = 1 << 15


class OffscreenWindow:
    """Draws the actors of a PyVista plotter, only on request."""

    def __init__(self, width: int, height: int) -> None:
        import pyvista as pv

        self._size = width, height
        self.longest_side = LONGEST_SIDE_PX  #: Pixels of the window along a side, at most.
        self.plotter = pv.Plotter(
            off_screen=True, window_size=[width, height], lighting="light kit"
        )
        self.plotter.disable_anti_aliasing()

    @property
    def _window(self) -> Any:
        return self.plotter.render_window

    def suppress_rendering(self) -> None:
        """Draw only in :meth:`draw`: a texture requests a picture at each change."""
        self.plotter.suppress_rendering = True

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a whole picture, in pixels."""
        return self._size

    @size.setter
    def size(self, size: tuple[int, int]) -> None:
        self._size = size
        self.plotter.window_size = [min(side, self.longest_side) for side in size]

    def close(self) -> None:
        """Free the graphics card."""
        self.plotter.close()

    def place(self, camera: Camera) -> None:
        """Look from a camera."""
        apply_camera(camera, self.plotter.camera)

    def set_background(self, colour: Any) -> None:
        """Set the background colour."""
        self.plotter.renderer.set_background(colour)

    def draw(self, width: int, height: int, part: Rect | None = None) -> Bytes:
        """Return a picture of what is visible, (height, width, 3), row 0 at the top.

        It is at most as large as a whole one, and may show a ``part`` of that: left, top, width and
        height in pixels.
        """
        camera, renderer = self.plotter.camera, self.plotter.renderer
        renderer.SetViewport(0, 0, *np.divide((width, height), self.plotter.window_size))
        renderer.ResetCameraClippingRange()
        saved = (camera.GetWindowCenter(), camera.GetParallelScale(), camera.GetViewAngle())
        if part is not None:
            self._narrow(camera, part)
        self._window.Render()
        camera.SetWindowCenter(*saved[0])
        camera.SetParallelScale(saved[1])
        camera.SetViewAngle(saved[2])
        return self._read(width, height)

    def _narrow(self, camera: vtkCamera, part: Rect) -> None:
        """Narrow the VTK camera to a part of the view."""
        left, top, width, height = part
        whole_width, whole_height = self.size
        camera.SetWindowCenter(
            (2 * left + width - whole_width) / width, (whole_height - 2 * top - height) / height
        )
        share = height / whole_height
        camera.SetParallelScale(camera.GetParallelScale() * share)
        half = np.radians(camera.GetViewAngle()) / 2
        camera.SetViewAngle(float(np.degrees(2 * np.arctan(np.tan(half) * share))))

    def _read(self, width: int, height: int) -> Bytes:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

        values = vtkUnsignedCharArray()
        self._window.GetPixelData(0, 0, width - 1, height - 1, 0, values, 0)
        rows = np.asarray(vtk_to_numpy(values), dtype=np.uint8).reshape(height, width, 3)
        return np.ascontiguousarray(rows[::-1])
