"""A flow, its camera and its colours, in one pane or in two beside each other.

Two panes show the same flow from the same camera with other settings.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import Bytes, Floats
from flowtex._util.colours import DEFAULT_CMAP
from flowtex.app.streaming.reprojection import plane_to_view
from flowtex.app.streaming.window import OffscreenWindow, Rect
from flowtex.camera import Camera
from flowtex.field import FlowField
from flowtex.options import PLAIN_COLOR
from flowtex.plotting.handle import FlowHandle
from flowtex.settings import Settings
from flowtex.textures.images import as_image

__all__ = ["BACKGROUNDS", "GAP_PX", "Pane", "Rect", "Viewport"]

#: Colours behind the surface, by theme.
BACKGROUNDS = {"dark": "#12161c", "light": "#eef1f4"}
#: Pixels between two panes.
GAP_PX = 2
#: Entries of a colour map.
COLOUR_ENTRIES = 256
#: Point array that holds the colours.
COLOUR_ARRAY = "flowtex colour"
#: Zoom and focus of the whole surface.
WHOLE: tuple[float, tuple[float, ...] | None] = (1.0, None)


class Pane:
    """One of the views beside each other: a texture with settings of its own."""

    def __init__(self, handle: FlowHandle, viewport: Viewport) -> None:
        self.handle = handle
        self._viewport = viewport
        self._mapper = handle.actor.mapper

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a whole picture, in pixels."""
        return self._viewport.pane_size

    @property
    def mesh(self) -> Any:
        """The surface, as PyVista's mesh."""
        return self._mapper.dataset

    def plane_view(self) -> Floats | None:
        """Affine map from the surface's plane to the view, (3, 3); ``None`` when it has none."""
        return self._viewport.plane_view()

    def draw(self, width: int, height: int, part: Rect | None = None) -> Bytes:
        """Draw this pane alone; :meth:`OffscreenWindow.draw` has the parameters."""
        for other in self._viewport.panes:
            other.handle.actor.SetVisibility(other is self)
        self.handle.draw_for(self.size[1] if part is None else part[3])
        return self._viewport.window.draw(width, height, part)

    def colour_by(self, name: str, table: Any, span: tuple[float, float], plain: Any) -> None:
        """Colour by a scalar with a lookup table, or plainly for an empty name."""
        self._mapper.scalar_visibility = bool(name)
        if not name:
            self.handle.actor.prop.color = plain
            return
        self._mapper.SetLookupTable(table)
        self._mapper.scalar_range = span
        self._mapper.SelectColorArray(COLOUR_ARRAY)
        self.handle.set_scalars(COLOUR_ARRAY, name)


class Viewport:
    """A flow texture, its camera, and pictures of them.

    Parameters
    ----------
    field
        The flow.
    zoom, focus
        How far in, and on what point of the mesh, the first look is.
    **options
        Arguments and settings of ``plotter.flowtex.add``.

    Attributes
    ----------
    window, panes
        Where it is drawn, and the views beside each other, one or two.
    colour, cmap
        Name of what the surface is coloured by, empty for nothing, and of the colour map.
    plain
        Colour of the surface where it is coloured by nothing.
    lighting, background
        Whether the surface is lit, ``None`` for curved ones only, and the colour behind it.
    whole
        The camera that shows the whole surface, from which zoom counts.
    """

    whole: Camera

    def __init__(
        self,
        field: FlowField,
        *,
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
        **options: Any,
    ) -> None:
        from flowtex.plotting.component import FlowtexComponent

        self.window = OffscreenWindow(640, 400)
        scalars = options.pop("scalars", None)
        self.colour = "" if scalars is False else ("speed" if scalars in (None, True) else scalars)
        self.cmap = options.pop("cmap", None) or DEFAULT_CMAP
        self.plain = options.pop("color", PLAIN_COLOR)
        clim = options.pop("clim", None)
        self._clims = {} if clim is None else {self.colour: (float(clim[0]), float(clim[1]))}
        self.background: Any = self.window.plotter.background_color
        self._first = (zoom, focus)
        self._size = self.window.size
        self._component = FlowtexComponent(self.window.plotter)
        self._beside: dict[str, Any] = {}
        self._stop_following: Callable[[], None] = lambda: None
        self._tile_ready: Callable[[], None] | None = None
        self.panes: list[Pane] = [self._pane(field, options)]
        self.lighting = options.get("lighting")
        self.window.suppress_rendering()
        self._prepare()
        self.first_look()

    @property
    def handle(self) -> FlowHandle:
        """The texture of the first pane."""
        return self.panes[0].handle

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
    def size(self) -> tuple[int, int]:
        """Width and height of the whole view, in pixels."""
        return self._size

    @property
    def pane_size(self) -> tuple[int, int]:
        """Width and height of one pane, in pixels."""
        width, height = self._size
        return (width if len(self.panes) == 1 else max((width - GAP_PX) // 2, 1)), height

    @property
    def aspect(self) -> float:
        """Width of a pane over its height."""
        return self.pane_size[0] / max(self.pane_size[1], 1)

    def _pane(self, field: FlowField, options: Mapping[str, Any], image: Any | None = None) -> Pane:
        """Add a pane; with the texels of an image, when there is one, whatever its noise is."""
        arguments = dict(options)
        if image is not None:
            arguments["noise"] = "procedural"
        handle = self._component.add(
            field, scalars="speed", show_scalar_bar=False, reset_camera=False, **arguments
        )
        if image is not None:
            handle.set_image(as_image(image))
            handle.settings.noise = options["noise"]
        if self._tile_ready is not None:
            handle.load_in_background(self._tile_ready)
        return Pane(handle, self)

    def load_in_background(self, notify: Callable[[], None]) -> None:
        """Draw large surfaces with what is there; as :meth:`FlowHandle.load_in_background`."""
        self._tile_ready = notify
        for pane in self.panes:
            pane.handle.load_in_background(notify)

    @property
    def busy(self) -> bool:
        """Whether more of a large surface is on its way."""
        return any(pane.handle.busy for pane in self.panes)

    def _prepare(self) -> None:
        """Make ready for a field."""
        if self.colour not in ("", *self.colours):
            self.colour = "speed"
        self.colour_by(self.colour)
        self.resize(*self._size)

    def close(self) -> None:
        """Free the graphics card."""
        self._stop_following()
        for pane in self.panes:
            pane.handle.remove(render=False)
        self.window.close()

    def copy(self) -> Viewport:
        """Return a viewport with a window of its own that shows the same."""
        options: dict[str, Any] = dict(self.settings)
        image = self.handle.scene.image
        if image is not None and self.settings.noise == "image":
            options["image"] = as_image(image)
        other = Viewport(
            self.field,
            scalars=self.colour or False,
            cmap=self.cmap,
            clim=self.chosen_range,
            color=self.plain,
            lighting=self.handle.actor.prop.lighting,
            **options,
        )
        if self._beside:
            other.compare(self._beside)
        other.camera = self.camera
        other.set_background(self.background)
        other.set_time(self.handle.time)
        other.clock = self.clock
        return other

    def show(self, field: FlowField, *, keep_view: bool = False, keep_range: bool = False) -> None:
        """Show another flow with the same settings.

        Parameters
        ----------
        field
            The flow.
        keep_view
            Whether the camera stays where it is.
        keep_range
            Whether the ends of the colour map that somebody chose stay, and the time that is
            shown where the flow has the same times: it is another part of the same data.
        """
        settings, image, beside = dict(self.settings), self.handle.scene.image, self._beside
        self._first = WHOLE
        camera, clock, flat = self.camera, self.clock, self.flat
        times, time = self.field.times, self.handle.time
        self.compare(None)
        old = self.handle
        self.panes[0] = self._pane(field, {**settings, "lighting": self.lighting}, image)
        old.remove(render=False)
        if not keep_range:
            self._clims.clear()
        self._prepare()
        if keep_range and np.array_equal(times, field.times):
            self.set_time(time)
        self.home()
        if keep_view and flat == self.flat:
            self.camera = camera
        self.clock = clock
        if beside:
            self.compare(beside)

    def compare(self, changes: Mapping[str, Any] | None) -> None:
        """Show a second pane in which some settings differ, or one pane again for ``None``.

        The panes stay as they are when a setting is unknown or out of range.
        """
        settings = {**dict(self.settings), **(changes or {})}
        Settings().update(**settings)
        self._stop_following()
        self._stop_following = lambda: None
        for pane in self.panes[1:]:
            pane.handle.remove(render=False)
        del self.panes[1:]
        self._beside = dict(changes or {})
        if changes:
            options = {**settings, "lighting": self.lighting}
            self.panes.append(self._pane(self.field, options, self.handle.scene.image))
            self._stop_following = self.settings.observe(self._follow)
            self.set_time(self.handle.time)
            self.clock = self.handle.clock
        self.colour_by(self.colour)
        self.resize(*self._size)

    def _follow(self, name: str, value: Any) -> None:
        """Change a setting of the second pane as that of the first one changes."""
        if name not in self._beside:
            self.panes[1].handle.settings.update(**{name: value})

    def lay_image(self, image: Any) -> None:
        """Lay an image on the surface in place of the noise, except where panes differ in noise.

        Nothing is changed when it cannot be used.
        """
        # The first pane is followed by the second, which has to have the image by then.
        for pane in reversed(self.panes):
            pane.handle.set_image(image)
        if "noise" in self._beside:
            self.panes[1].handle.settings.noise = self._beside["noise"]

    # --- colours -----------------------------------------------------------------------------

    @property
    def colours(self) -> tuple[str, ...]:
        """Names of what the surface can be coloured by."""
        return tuple(dict.fromkeys(("speed", *self.field.scalars)))

    def colour_by(
        self,
        name: str,
        *,
        cmap: str | None = None,
        clim: tuple[float, float] | None = None,
    ) -> None:
        """Colour by one of :attr:`colours`, or plainly for an empty name.

        ``clim``, the values at the ends of the colour map, stays with this scalar.
        """
        import pyvista as pv

        self.colour = name
        self.cmap = cmap or self.cmap
        if clim is not None:
            self._clims[name] = (float(clim[0]), float(clim[1]))
        self._table = pv.LookupTable(self.cmap, n_values=COLOUR_ENTRIES)
        self._table.scalar_range = self.colour_range
        for pane in self.panes:
            pane.colour_by(name, self._table, self.colour_range, self.plain)

    def forget_range(self) -> None:
        """Let the colours go from the least value to the greatest again."""
        self._clims.pop(self.colour, None)
        self.colour_by(self.colour)

    @property
    def colour_range(self) -> tuple[float, float]:
        """Values at the ends of the colour bar."""
        if not self.colour:
            return 0.0, 1.0
        return self._clims.get(self.colour) or self.handle.scene.scalar_range(self.colour)

    @property
    def chosen_range(self) -> tuple[float, float] | None:
        """The same, where somebody has chosen them."""
        return self._clims.get(self.colour)

    def colour_stops(self, count: int = 17) -> list[str]:
        """Colours along the bar, from low to high, as ``#rrggbb``."""
        colours = [self._table.map_value(v) for v in np.linspace(*self.colour_range, count)]
        return ["#" + "".join(f"{round(255 * c):02x}" for c in rgb[:3]) for rgb in colours]

    def set_background(self, colour: Any) -> None:
        """Take the colour behind the surface: a theme's, or any that PyVista knows."""
        colour = BACKGROUNDS.get(colour, colour) if isinstance(colour, str) else colour
        self.background = colour
        self.window.set_background(colour)

    # --- time --------------------------------------------------------------------------------

    def set_time(self, time: float) -> None:
        """Show another time of a field that varies in time."""
        for pane in self.panes:
            pane.handle.time = time

    def trace(self) -> None:
        """Trace what the time that is shown needs, so that drawing need not wait for it."""
        for pane in self.panes:
            before, after, _ = pane.handle.scene.moment
            for step in {before, after}:
                pane.handle.scene.store.at(step)

    @property
    def clock(self) -> float:
        """Clock of the animation of a steady flow, in seconds."""
        return self.handle.clock

    @clock.setter
    def clock(self, seconds: float) -> None:
        for pane in self.panes:
            pane.handle.clock = seconds

    # --- camera ------------------------------------------------------------------------------

    @property
    def camera(self) -> Camera:
        """Where the flow is seen from."""
        return self._camera

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self._camera = camera
        self.window.place(camera)

    @property
    def zoom(self) -> float:
        """How far in: 1 shows the whole surface."""
        return self.whole.height / self.camera.height

    def resize(self, width: int, height: int) -> None:
        """Change the size of the whole view."""
        self._size = (width, height)
        self.window.size = self.pane_size

    def home(self, zoom: float = 1.0, focus: tuple[float, ...] | None = None) -> None:
        """Look at the whole surface, or closer at a point of it."""
        surface, aspect = self.handle.scene.whole.surface, self.aspect
        self.whole = self._home = Camera.fit(surface, aspect)
        near = zoom != 1.0 or focus is not None
        self.camera = Camera.fit(surface, aspect, zoom=zoom, focus=focus) if near else self.whole

    @property
    def at_home(self) -> bool:
        """Whether the camera stands where :meth:`home` has put it."""
        return self.camera == self._home

    def first_look(self) -> None:
        """Look at what was asked for when the viewport was made."""
        self.home(*self._first)
        if self._first[0] == 1.0:
            self._home = self.camera

    def look(self, camera: Camera) -> None:
        """Look from a camera, and not from where was asked for when the viewport was made."""
        self._first = WHOLE
        self.camera = camera

    def look_from(self, toward: tuple[float, float, float], up: tuple[float, float, float]) -> None:
        """Look at the whole of a curved surface from a side."""
        self.home()
        surface = self.handle.scene.whole.surface
        self.camera = self.whole = Camera.fit(surface, self.aspect, toward=toward, up=up)

    def pan(self, dx: float, dy: float) -> None:
        """Move what is seen by a part of the view."""
        self.camera = self.camera.pan(dx, dy, self.aspect)

    def rotate(self, dx: float, dy: float) -> None:
        """Go around the focal point, as a drag by a part of the view asks."""
        self.camera = self.camera.rotate(dx, dy, self.aspect)

    def zoom_by(self, factor: float, x: float = 0.0, y: float = 0.0) -> None:
        """Zoom in by a factor; the point at (x, y) of the view stays where it is."""
        target = None if self.flat else self.surface_point(x, y)
        self.camera = self.camera.zoom_by(
            factor, x, y, aspect=self.aspect, whole=self.whole, target=target
        )

    def plane_view(self) -> Floats | None:
        """Affine map from the surface's plane to the view, (3, 3); ``None`` when it has none."""
        return plane_to_view(self.handle.scene.whole.surface, self.camera, self.aspect)

    def surface_point(self, x: float, y: float) -> Floats | None:
        """Point of the surface at a place of the view, from -1 to 1; ``None`` beside it.

        A flat surface has a point everywhere in its plane.
        """
        start, direction = self.camera.ray(x, y, self.aspect)
        surface = self.handle.scene.whole.surface
        if surface.frame is None:
            reach = self.camera.distance + 2 * surface.extent
            points, _ = self.panes[0].mesh.ray_trace(
                start, start + direction * reach, first_point=True
            )
            return np.asarray(points, dtype=float) if len(points) else None
        normal = np.cross(*surface.frame)
        slope = float(direction @ normal)
        if abs(slope) < 1e-9:
            return None
        distance = float((surface.center - start) @ normal) / slope
        return start + distance * direction if distance > 0 else None

    def draw(self, width: int, height: int, part: Rect | None = None) -> Bytes:
        """Draw the first pane; :meth:`OffscreenWindow.draw` has the parameters."""
        return self.panes[0].draw(width, height, part)
