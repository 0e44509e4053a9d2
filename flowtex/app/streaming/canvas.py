"""An off-screen window with a camera, drawn whole or a rectangle at a time.

Pictures are drawn into the lower left corner of a window that keeps its size: a draft is the
whole view in a small corner, a tile a part of the view at full size. Nothing is allocated between
one and the next, and a tile has the same pixels as the whole picture has there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.first_look import FirstLook

__all__ = ["Canvas", "Rect", "checked_camera"]

#: Names of a camera's own numbers, as a widget's camera has them.
PARALLEL, SCALE, ANGLE = "parallel", "parallel_scale", "view_angle"
POINTS = ("position", "focal_point", "up")

Rect = tuple[int, int, int, int]


class Canvas:
    """Where a scene is drawn.

    Attributes
    ----------
    plotter
        PyVista's plotter, which draws only when it is told to.
    """

    def __init__(self, width: int, height: int) -> None:
        import pyvista as pv

        self.plotter = pv.Plotter(
            off_screen=True, window_size=[width, height], lighting="light kit"
        )
        self.plotter.disable_anti_aliasing()

    @property
    def _window(self) -> Any:
        return self.plotter.render_window

    def hush(self) -> None:
        """Draw only when told to: a texture asks for a picture at each change."""
        self.plotter.suppress_rendering = True

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a whole picture, in pixels."""
        width, height = self.plotter.window_size
        return int(width), int(height)

    @size.setter
    def size(self, size: tuple[int, int]) -> None:
        self.plotter.window_size = list(size)

    def close(self) -> None:
        """Free the graphics card."""
        self.plotter.close()

    def place(self, look: FirstLook) -> None:
        """Put the camera somewhere."""
        self.set_camera(
            {
                "position": look.position,
                "focal_point": look.focal_point,
                "up": look.up,
                PARALLEL: look.parallel,
                SCALE: look.parallel_scale,
                ANGLE: look.view_angle,
            }
        )

    def camera(self) -> dict[str, Any]:
        """Return the camera, as a widget's ``camera`` has it."""
        camera = self.plotter.camera
        return {
            "position": list(camera.GetPosition()),
            "focal_point": list(camera.GetFocalPoint()),
            "up": list(camera.GetViewUp()),
            PARALLEL: bool(camera.GetParallelProjection()),
            SCALE: float(camera.GetParallelScale()),
            ANGLE: float(camera.GetViewAngle()),
        }

    def set_camera(self, camera: Mapping[str, Any]) -> None:
        """Take a camera; what is left out stays as it was."""
        made, own = {**self.camera(), **camera}, self.plotter.camera
        own.SetPosition(*made["position"])
        own.SetFocalPoint(*made["focal_point"])
        own.SetViewUp(*made["up"])
        own.SetParallelProjection(bool(made[PARALLEL]))
        own.SetParallelScale(made[SCALE])
        own.SetViewAngle(made[ANGLE])

    def set_background(self, colour: Any) -> None:
        """Take another colour behind what is drawn."""
        self.plotter.renderer.set_background(colour)

    def draw(self, width: int, height: int, part: Rect | None = None) -> NDArray[np.uint8]:
        """Draw what is visible, or a part of it.

        Parameters
        ----------
        width, height
            Size of the picture, at most that of a whole one.
        part
            Left, top, width and height of the part within a whole picture, in pixels.

        Returns
        -------
        numpy.ndarray
            (height, width, 3) uint8, row 0 at the top.
        """
        whole_width, whole_height = self.size
        camera, renderer = self.plotter.camera, self.plotter.renderer
        renderer.SetViewport(0, 0, width / whole_width, height / whole_height)
        renderer.ResetCameraClippingRange()
        kept = (camera.GetWindowCenter(), camera.GetParallelScale(), camera.GetViewAngle())
        if part is not None:
            self._aim(camera, part)
        self._window.Render()
        camera.SetWindowCenter(*kept[0])
        camera.SetParallelScale(kept[1])
        camera.SetViewAngle(kept[2])
        return self._read(width, height)

    def _aim(self, camera: Any, part: Rect) -> None:
        """Narrow the camera to a part of the view."""
        left, top, width, height = part
        whole_width, whole_height = self.size
        camera.SetWindowCenter(
            (2 * left + width - whole_width) / width,
            (whole_height - 2 * top - height) / height,
        )
        share = height / whole_height
        camera.SetParallelScale(camera.GetParallelScale() * share)
        half = np.radians(camera.GetViewAngle()) / 2
        camera.SetViewAngle(float(np.degrees(2 * np.arctan(np.tan(half) * share))))

    def _read(self, width: int, height: int) -> NDArray[np.uint8]:
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

        values = vtkUnsignedCharArray()
        self._window.GetPixelData(0, 0, width - 1, height - 1, 0, values, 0)
        rows = np.asarray(vtk_to_numpy(values), dtype=np.uint8).reshape(height, width, 3)
        return np.ascontiguousarray(rows[::-1])


def checked_camera(given: Any, present: Mapping[str, Any]) -> dict[str, Any]:
    """Return a camera that somebody sent, as plain numbers; what it leaves out stays.

    Raises
    ------
    ValueError
        When it is no camera, or one that sees nothing.
    """
    if not isinstance(given, Mapping) or not set(given) <= set(present):
        msg = f"camera is {given!r}; expected a mapping with some of {', '.join(present)}"
        raise ValueError(msg)
    made = {**present, **given}
    try:
        points = {name: [float(v) for v in made[name]] for name in POINTS}
        scale, angle = float(made[SCALE]), float(made[ANGLE])
    except (TypeError, ValueError) as error:
        msg = f"camera is {given!r}; expected points of three numbers, and numbers"
        raise ValueError(msg) from error
    good = all(len(point) == 3 and np.isfinite(point).all() for point in points.values())
    with np.errstate(over="ignore", invalid="ignore"):
        ahead = np.subtract(points["focal_point"], points["position"]) if good else np.zeros(3)
        good = good and 0 < float(np.linalg.norm(np.cross(ahead, points["up"]))) < np.inf
    if not (good and np.isfinite([scale, angle]).all() and scale > 0 and 0 < angle < 180):
        msg = f"camera is {given!r}; expected one that looks at something"
        raise ValueError(msg)
    return {**points, PARALLEL: bool(made[PARALLEL]), SCALE: scale, ANGLE: angle}
