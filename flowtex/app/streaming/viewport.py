"""A flow, its camera and its colours, in one pane or in two side by side.

Two panes have the same camera. They show the same flow with different settings, or two flows with
the same settings.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from itertools import product
from typing import Any, cast

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from flowtex._util.array_types import Bytes, Floats
from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.field.derived.quantities import steps_of
from flowtex.field.interpolation import steps_around
from flowtex.field.steps import LazySteps
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.camera import Camera, apply_camera, face_alike
from flowtex.rendering.vtk.area import PicturePart
from flowtex.rendering.vtk.passes import DeferredPasses
from flowtex.scene.options import Options
from flowtex.scene.scene import Scene, link_scenes, make_scenes
from flowtex.settings import Settings
from flowtex.textures.images import as_image, averaged

#: Colours behind the surface, by theme.
BACKGROUNDS = {"dark": "#12161c", "light": "#eef1f4"}
#: Pixels between two panes.
GAP_PX = 2
#: Side of a tile in pixels, which a processor draws in about a tenth of a second. It is even, as
#: derivatives need 2 x 2 pixels.
TILE_PX = 224
Rect = tuple[int, int, int, int]
#: Longest side of a window, in pixels.
LONGEST_SIDE_PX = 1 << 15


class Viewport:
    """A flow texture, its camera, and pictures; options are those of ``plotter.flowtex.add``."""

    def __init__(
        self,
        field: FlowField,
        *,
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
        **options: Any,
    ) -> None:
        from flowtex.plotting.component import FlowtexComponent

        self.plotter = pv.Plotter(off_screen=True, lighting="light kit")
        self.plotter.disable_anti_aliasing()
        #: Pixels of the window along a side, at most: it may be smaller than a picture in tiles.
        self.longest_side = LONGEST_SIDE_PX
        #: The colour behind the surface.
        self.background: Any = self.plotter.background_color
        #: Width and height of the whole view, in pixels.
        self.size = (640, 400)
        self._component = FlowtexComponent(self.plotter)
        #: Differences of the second pane, as for :meth:`compare`; empty without one.
        self.differences: dict[str, Any] = {}
        self._stop_following: Callable[[], None] = lambda: None
        self._tile_ready: Callable[[], None] | None = None
        first = Options.split("appearance", **{**options, "show_scalar_bar": False})
        self._still = True
        #: The textures of the views side by side, one or two.
        self.panes: list[FlowHandle] = [self._pane(make_scenes(field, first)[0])]
        self.handle = self.panes[0]  #: The texture of the first pane.
        # Only draw() renders: a texture requests a picture at each change.
        self.plotter.suppress_rendering = True
        self._set_picture(*self.pane_size)
        self.home(zoom=zoom, focus=focus)

    @property
    def settings(self) -> Settings:
        """The settings of the first pane, live."""
        return self.handle.settings

    @property
    def field(self) -> FlowField:
        """The flow."""
        return self.handle.field

    @property
    def flat(self) -> bool:
        """Whether the surface lies in a plane."""
        return self.handle.scene.whole.surface.frame is not None

    @property
    def pane_size(self) -> tuple[int, int]:
        """Width and height of one pane, in pixels."""
        width, height = self.size
        if len(self.panes) > 1:
            width = max((width - GAP_PX) // 2, 1)
        return width, height

    @property
    def aspect(self) -> float:
        """Width of a pane over its height."""
        return self.pane_size[0] / max(self.pane_size[1], 1)

    @property
    def scene(self) -> Scene:
        """Scene of the first pane, whose appearance all panes share."""
        return self.handle.scene

    def _pane(self, scene: Scene) -> FlowHandle:
        handle = self._component.add_scene(scene, reset_camera=False)
        handle.surface.view.still = self._still
        if self._tile_ready is not None:
            handle.load_in_background(self._tile_ready)
        return handle

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw with the tiles that are ready, as :meth:`FlowHandle.load_in_background` does."""
        self._tile_ready = notify
        for pane in self.panes:
            pane.load_in_background(notify)

    @property
    def busy(self) -> bool:
        """Whether tiles of a large surface are still being made."""
        return any(pane.busy for pane in self.panes)

    def close(self) -> None:
        """Free the graphics card."""
        self._stop_following()
        for pane in self.panes:
            pane.remove(render=False)
        self.plotter.close()

    def copy(self) -> Viewport:
        """Return a viewport with its own window that shows the same."""
        options = {**vars(self.scene.appearance), **dict(self.settings), "image": None}
        if self.settings.noise == "image" and self.scene.image is not None:
            options["image"] = as_image(self.scene.image)
        other = Viewport(self.field, **options)
        if self.differences:
            other.compare(self.differences)
        other.camera = self.camera
        other.set_background(self.background)
        other.set_time(self.handle.time)
        other.clock = self.clock
        return other

    def show(
        self,
        field: FlowField,
        *,
        keep_view: bool = False,
        keep_range: bool = False,
        keep_clim: bool = False,
        keep_time: bool = False,
    ) -> None:
        """Show another flow with the same settings.

        Parameters
        ----------
        field
            The flow.
        keep_view
            Whether the camera stays, if the surfaces are oriented alike.
        keep_range
            Whether the colour range stays, as for another part of the same data. A range that was
            not chosen becomes the range of the volume where the flow knows it.
        keep_clim
            Whether a chosen colour range stays, and only such a range.
        keep_time
            Whether the time stays, as far as the flow has it.

        Raises
        ------
        FieldError
            When the flow cannot be drawn; the panes then show the flow before.
        """
        camera = self.camera
        surface = self.scene.whole.surface
        time = first_time(self.scene, field, keep=keep_time)
        if keep_range or keep_clim:
            changes: dict[str, Any] = {}
        else:
            changes = {"clim": None}
        flows = [field, self.differences.get("field", field)]
        scenes: list[Scene] = []
        try:
            for pane, flow in zip(self.panes, flows, strict=False):
                make = partial(pane.scene.showing, flow, keep_range=keep_range, same_data=True)
                scenes.append(_fitting(pane.scene, make, changes))
                _ = scenes[-1].textures  # tracing may fail
        except BaseException:
            for scene in scenes:
                scene.close()
            raise
        for pane, scene in zip(self.panes, scenes, strict=True):
            pane.show_scene(scene)
        self.set_time(time)
        self.home()
        if keep_view and face_alike(surface, self.scene.whole.surface):
            self.camera = camera

    def compare(self, changes: Mapping[str, Any] | None) -> None:
        """Show a second pane that differs, or one pane again for ``None`` or after an error."""
        panes = self.panes[:1]
        first = self.scene
        changes = dict(changes or {})
        if changes:
            looks = {}
            for n, value in changes.items():
                if n not in ("time", "field"):
                    looks[n] = value
            beside = partial(first.beside, field=changes.get("field", first.field))
            scene = _fitting(first, beside, looks)
            scene.time = _time_beside(first, changes)
            panes.append(self._pane(scene))
        self._stop_following()
        self._stop_following = lambda: None
        for pane in self.panes[1:]:
            pane.remove(render=False)
        self.panes = panes
        self.differences = changes
        if len(panes) > 1:
            left, right = panes
            self._stop_following = link_scenes(
                lambda: left.scene, lambda: right.scene, self.differences
            )
            self.clock = self.handle.clock
        self.resize(*self.size)

    # --- colours -----------------------------------------------------------------------------

    def set_background(self, colour: Any) -> None:
        """Take the colour behind the surface: a theme's, or any that PyVista knows."""
        if isinstance(colour, str):
            colour = BACKGROUNDS.get(colour, colour)
        self.background = colour
        self.plotter.renderer.set_background(colour)

    # --- time --------------------------------------------------------------------------------

    def set_still(self, *, still: bool) -> None:
        """Let the grains of a field that varies stand still, as while no time goes by."""
        self._still = still
        for pane in self.panes:
            pane.surface.view.still = still

    def set_time(self, time: float) -> None:
        """Show another time of a field that varies in time."""
        self.handle.time = time
        for pane in self.panes[1:]:
            pane.time = self.time_beside

    @property
    def time_beside(self) -> float:
        """Time of the second pane, which may be its own."""
        return _time_beside(self.scene, self.differences)

    @time_beside.setter
    def time_beside(self, time: float) -> None:
        self.differences["time"] = time
        self.set_time(self.handle.time)

    @property
    def time_shift(self) -> float | None:
        """Difference of the second pane's time; ``None`` if that is its own."""
        if "time" in self.differences:
            return None
        other = self.differences.get("field", self.field)
        with suppress(TypeError, ValueError):  # no dates, or of two calendars
            return float((self.field.start - other.start).total_seconds())
        return 0.0

    @property
    def reads_late(self) -> bool:
        """Whether a flow has lazy steps, whose reading may take long."""
        return any(isinstance(p.scene.field.velocity, LazySteps) for p in self.panes)

    def trace(self, time: float | None = None) -> None:
        """Read and trace the steps for a time, by default the one shown, in any thread.

        Then neither :meth:`set_time` nor drawing wait for them. Raises a FieldError when a step
        cannot be read.
        """
        if time is None:
            time = self.handle.time
        for pane in self.panes:
            scene = pane.scene
            times = scene.field.times
            name = scene.appearance.scalar_name
            before, after, _ = steps_around(times, float(np.clip(time, times[0], times[-1])))
            for step in {before, after}:
                scene.store.at(step)
                if name is not None:
                    values = steps_of(scene.field, name)
                    _ = values[min(step, len(values) - 1)]  # which caches it

    @property
    def clock(self) -> float:
        """Clock of the animation of a steady flow, in seconds."""
        return self.handle.clock

    @clock.setter
    def clock(self, seconds: float) -> None:
        for pane in self.panes:
            pane.clock = seconds

    # --- camera ------------------------------------------------------------------------------

    @property
    def camera(self) -> Camera:
        """The camera of all panes."""
        return self._camera

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._camera = camera
        apply_camera(camera, self.plotter.camera)

    def resize(self, width: int, height: int, *, fits: bool = True) -> None:
        """Change the size of the whole view; the camera of :meth:`home` may fit it again."""
        at_home = self.chosen_camera is None
        self.size = (width, height)
        self._set_picture(*self.pane_size)
        if fits and at_home:
            self.home(**self.look)

    def _set_picture(self, *size: int) -> None:
        self._picture = size
        self.plotter.window_size = np.minimum(size, self.longest_side).tolist()

    def home(self, **look: Any) -> None:
        """Look at the whole surface; ``look`` are arguments of :meth:`Camera.fit`, kept as that."""
        self.look = look
        self.camera = self._home = Camera.fit(self.scene.whole.surface, self.aspect, **look)

    @property
    def chosen_camera(self) -> Camera | None:
        """The camera; ``None`` for the camera of :meth:`home`."""
        if self.camera == self._home:
            return None
        return self.camera

    @property
    def sees_all(self) -> bool:
        """Whether the camera shows the whole surface from the default direction."""
        is_near = self.look.get("focus") or self.look.get("zoom", 1.0) != 1.0
        return self.camera == self._home and not (is_near or self.look.get("toward"))

    def surface_point(self, x: float, y: float, pane: int = 0) -> Floats | None:
        """Return the point of a pane's surface at (x, y) from -1 to 1; ``None`` beside it.

        A flat surface has a point everywhere in its plane.
        """
        start, direction = self.camera.ray(x, y, self.aspect)
        surface = self.panes[pane].scene.whole.surface
        if surface.frame is None:
            reach = self.camera.distance + 2 * surface.extent
            # The drawn mesh has only the triangles of the last part.
            corners: Any = surface.corners_of(surface.drawn)
            points = surface.points.reshape(-1, 3)
            make = partial(pv.PolyData.from_regular_faces, points, corners)
            mesh = _meshes.get("mesh", make, owner=surface)
            hit, _ = mesh.ray_trace(start, start + direction * reach, first_point=True)
            if len(hit):
                return np.asarray(hit, dtype=float)
            return None
        normal = np.cross(*surface.frame)
        slope = float(direction @ normal)
        if abs(slope) < 1e-9:
            return None
        distance = float((surface.center - start) @ normal) / slope
        if distance > 0:
            return start + distance * direction
        return None

    def draw(
        self, width: int, height: int, part: Rect | None = None, *, pane: FlowHandle | None = None
    ) -> Bytes:
        """Return a picture of a pane, by default the first, (height, width, 3), row 0 at the top.

        It is at most as large as a whole one, and may show a ``part`` of that: left, top, width and
        height in pixels. It is drawn into the lower left corner of a window that keeps its size, so
        nothing is allocated from one to the next.
        """
        pane = pane or self.handle
        for other in self.panes:
            other.actor.SetVisibility(other is pane and other.visible)
        (left, top, across, down) = part or (0, 0, *self._picture)
        (wide, high) = self._picture
        pane.surface.full_height = down
        pane.surface.whole_height = high
        camera = self.plotter.camera
        window = cast("Any", self.plotter.render_window)
        self.plotter.renderer.SetViewport(
            0, 0, *np.divide((width, height), self.plotter.window_size)
        )
        self.plotter.renderer.ResetCameraClippingRange()
        # The camera is narrowed to the part.
        camera.SetWindowCenter((2 * left + across - wide) / across, (high - 2 * top - down) / down)
        camera.SetParallelScale(self.camera.parallel_scale * down / high)
        half = np.radians(self.camera.view_angle) / 2
        camera.SetViewAngle(float(np.degrees(2 * np.arctan(np.tan(half) * down / high))))
        passes = DeferredPasses.of(self.plotter.renderer)
        if part is not None:
            scale = width / across
            box = np.array([left, high - top - down, wide, high]) * scale
            passes.part = PicturePart(*np.rint(box).astype(int).tolist())
        try:
            window.Render()
        finally:
            passes.part = None
        camera.SetWindowCenter(0, 0)
        apply_camera(self.camera, camera)
        values = vtkUnsignedCharArray()
        window.GetPixelData(0, 0, width - 1, height - 1, 0, values, 0)
        rows = np.asarray(vtk_to_numpy(values), dtype=np.uint8).reshape(height, width, 3)
        return np.ascontiguousarray(rows[::-1])

    def draw_tiles(
        self, canvas: Bytes, gap: int, *, side: int = TILE_PX, times: int = 1
    ) -> Iterator[float]:
        """Draw all panes into a picture, side by side, and yield the share done after each tile.

        The tiles of a pane come from its middle outwards. For a pixel of the picture, ``times`` are
        drawn along each side.
        """
        panes = list(self.panes)
        done = 0
        (height, width) = canvas.shape[:2]
        wide = (width - (len(panes) - 1) * gap) // len(panes)
        for n, pane in enumerate(panes):
            first = n * (wide + gap)
            view = canvas[:, first:]
            if n < len(panes) - 1:
                view = view[:, :wide]
            across = view.shape[1]
            self._set_picture(across * times, height * times)
            corners = product(range(0, height, side), range(0, across, side))
            middle = (height - side) / 2, (across - side) / 2
            for top, left in sorted(corners, key=partial(math.dist, middle)):
                tile = view[top : top + side, left : left + side]
                size = times * tile.shape[1], times * tile.shape[0]
                part = (times * left, times * top, *size)
                tile[:] = averaged(self.draw(*size, part, pane=pane), times)
                done += tile.shape[0] * tile.shape[1]
                yield done / (width * height)


_meshes: WeakCache[pv.PolyData] = WeakCache()


def _time_beside(first: Scene, changes: Mapping[str, Any]) -> float:
    if "field" in changes:
        return time_in(first, changes["field"])
    earliest, latest = first.field.times[[0, -1]]
    return float(np.clip(changes.get("time", first.time), earliest, latest))


def first_time(scene: Scene, field: FlowField, *, keep: bool) -> float:
    """Return the time at which another flow is shown first, or the nearest to keep.

    That is the first time at which something moves.
    """
    if not keep:
        return field.first_time
    first = float(field.times[0])
    return min(max(scene.time, first), float(field.times[-1]))


def time_in(scene: Scene, field: FlowField) -> float:
    """Return the time of a scene in another field; the last one if that has no such time."""
    time = scene.time
    (first, last) = map(float, field.times[[0, -1]])
    with suppress(TypeError, ValueError):  # no dates, or of two calendars
        time += (scene.field.start - field.start).total_seconds()
    if first <= time <= last and not scene.field.steady:
        return time
    return last


def _fitting(
    first: Scene, make: Callable[[dict[str, Any]], Scene], changes: dict[str, Any]
) -> Scene:
    """Return the scene that ``make`` makes, without norm and limits if these do not fit."""
    try:
        return make(changes)
    except ValueError:
        if not (first.appearance.log_scale or first.appearance.norm):
            raise
        return make({**changes, "log_scale": False, "norm": None, "clim": None})
