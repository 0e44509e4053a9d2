"""One flow in an off-screen window, drawn whole or a rectangle at a time.

Pictures are drawn into the lower left corner of a window that keeps its size: a draft is the
whole view in a small corner, a tile a part of the view at full size. Nothing is allocated between
one and the next, and a tile has the same pixels as the whole picture has there.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.app.navigate import Navigator
from flowtex.field import FlowField

__all__ = ["BACKGROUNDS", "Scene"]

#: Colours behind the surface, by theme.
BACKGROUNDS = {"dark": "#12161c", "light": "#eef1f4"}

#: Point array that holds the colours.
COLOUR = "flowtex colour"

Rect = tuple[int, int, int, int]


class Scene:
    """A flow texture, its camera, and pictures of them.

    Parameters
    ----------
    field
        The flow.
    zoom, focus
        How far in, and on what point of the mesh, the first look is.
    **options
        Arguments and settings of ``plotter.flowtex.add``.
    """

    def __init__(
        self,
        field: FlowField,
        *,
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
        **options: Any,
    ) -> None:
        import pyvista as pv

        from flowtex.plotter import FlowtexComponent

        self.field = field
        self.plotter = pv.Plotter(off_screen=True, window_size=[640, 400], lighting="light kit")
        self.plotter.disable_anti_aliasing()
        wanted = options.pop("scalars", None)
        self.colour = "" if wanted is False else (wanted or "speed")
        clim = options.get("clim")
        self.handle = FlowtexComponent(self.plotter).add(
            field, scalars=self.colour or None, show_scalar_bar=False, **options
        )
        # The handle asks for a picture at each change; here it is the stream that knows when.
        self.plotter.suppress_rendering = True
        self._clim = (self.colour, clim) if clim is not None else None
        self._mapper = self.handle.actor.mapper
        self._mesh = self._mapper.dataset
        self.navigator = Navigator(self.plotter.camera, flat=self.flat, hit=self._hit)
        self.colour_by(self.colour)
        self._first = (zoom, focus)
        self.resize(640, 400)
        self.first_look()

    @property
    def flat(self) -> bool:
        """Whether the surface lies in a plane."""
        return self.field.surface.frame is not None

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a whole picture, in pixels."""
        width, height = self.plotter.window_size
        return int(width), int(height)

    @property
    def colours(self) -> tuple[str, ...]:
        """Names of what the surface can be coloured by."""
        return tuple(dict.fromkeys(("speed", *self.field.scalars)))

    @property
    def _window(self) -> Any:
        return self.plotter.render_window

    def close(self) -> None:
        """Free the graphics card."""
        self.handle.remove()
        self.plotter.close()

    def resize(self, width: int, height: int) -> None:
        """Change the size of whole pictures."""
        self.plotter.window_size = [width, height]
        self.navigator.aspect = width / max(height, 1)

    def home(self) -> None:
        """Look at the whole surface."""
        from flowtex.camera import look

        look(self.plotter, self.field)
        self.navigator.settle()

    def first_look(self) -> None:
        """Look at what was asked for when the scene was made."""
        from flowtex.camera import look

        self.home()
        zoom, focus = self._first
        look(self.plotter, self.field, zoom=zoom, focus=focus)

    def set_background(self, theme: str) -> None:
        """Take the colour behind the surface from a theme."""
        self.plotter.renderer.set_background(BACKGROUNDS[theme])

    def colour_by(self, name: str) -> None:
        """Colour by a scalar, or plainly for an empty name."""
        from flowtex.plotter import PLAIN

        self.colour = name
        self._mapper.scalar_visibility = bool(name)
        if not name:
            self.handle.actor.prop.color = PLAIN
            return
        self._mapper.scalar_range = self.colour_range
        self._mapper.SelectColorArray(COLOUR)
        self._write_colours()

    @property
    def colour_range(self) -> tuple[float, float]:
        """Values at the ends of the colour bar."""
        if self._clim is not None and self._clim[0] == self.colour:
            return self._clim[1]
        return self.handle.view.scalar_range(self.colour)

    def colour_stops(self, count: int = 17) -> list[str]:
        """Colours along the bar, from low to high, as ``#rrggbb``."""
        table = self._mapper.lookup_table
        low, high = self.colour_range
        stops = []
        for value in np.linspace(low, high, count):
            rgb: list[float] = [0.0, 0.0, 0.0]
            table.GetColor(float(value), rgb)
            stops.append("#" + "".join(f"{round(255 * c):02x}" for c in rgb))
        return stops

    def set_time(self, time: float) -> None:
        """Show another time of a field that varies in time."""
        self.handle.time = time
        if self.colour:
            self._write_colours()

    def _write_colours(self) -> None:
        self._mesh.point_data[COLOUR] = self.handle.view.scalar(self.colour).ravel()

    def draw(self, width: int, height: int, part: Rect | None = None) -> NDArray[np.uint8]:
        """Draw the view, or a part of it.

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

    def plane_view(self) -> NDArray[np.float64] | None:
        """Affine map from the surface's plane to the view, (3, 3); ``None`` when it has none."""
        frame = self.field.surface.frame
        if frame is None or not self.plotter.camera.parallel_projection:
            return None
        right, up, _ = self.navigator.axes
        scale = np.array([self.navigator.aspect, 1.0])[:, None] * self.navigator.height
        view = np.eye(3)
        view[:2, :2] = np.stack([right, up]) @ frame.T / scale
        offset = self.field.surface.center - np.asarray(self.plotter.camera.focal_point)
        view[:2, 2] = np.stack([right, up]) @ offset / scale[:, 0]
        # A plane seen edge on cannot be moved to another view.
        return view if abs(np.linalg.det(view[:2, :2])) > 1e-12 * np.abs(view).max() ** 2 else None

    def _hit(self, x: float, y: float) -> NDArray[np.float64] | None:
        """Point of the surface at a place of the view."""
        camera, navigator = self.plotter.camera, self.navigator
        right, up, ahead = navigator.axes
        position, focus = np.asarray(camera.position), np.asarray(camera.focal_point)
        at = focus + (right * x * navigator.aspect + up * y) * navigator.height
        start = at - ahead * camera.distance if camera.parallel_projection else position
        along = (at - start) / np.linalg.norm(at - start)
        reach = camera.distance + 2 * self.field.surface.extent
        points, _ = self._mesh.ray_trace(start, start + along * reach, first_point=True)
        return np.asarray(points, dtype=float) if len(points) else None
