"""A flow, its camera and its colours, in one pane or in two beside each other.

Two panes show the same flow from the same camera with other settings.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.aim import hit, plane_view
from flowtex.app.streaming.canvas import Canvas, Rect
from flowtex.app.streaming.coloured import Coloured
from flowtex.app.streaming.navigate import Navigator
from flowtex.app.streaming.pane import Pane
from flowtex.field import FlowField
from flowtex.first_look import first_look
from flowtex.settings import Settings
from flowtex.textures.images import as_image

__all__ = ["BACKGROUNDS", "GAP", "Rect", "Scene"]

#: Colours behind the surface, by theme.
BACKGROUNDS = {"dark": "#12161c", "light": "#eef1f4"}
#: Pixels between two panes.
GAP = 2
#: Zoom and focus of the whole surface.
WHOLE: tuple[float, tuple[float, ...] | None] = (1.0, None)


class Scene(Coloured):
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
    field
        The flow.
    colour, cmap
        Name of what the surface is coloured by, empty for nothing, and of the colour map.
    plain
        Colour of the surface where it is coloured by nothing.
    lighting
        Whether the surface is lit; ``None`` for curved ones only.
    panes
        The views beside each other, one or two.
    navigator
        What moves the camera.
    """

    def __init__(
        self,
        field: FlowField,
        *,
        zoom: float = 1.0,
        focus: tuple[float, ...] | None = None,
        **options: Any,
    ) -> None:
        from flowtex._util.colours import DEFAULT_CMAP
        from flowtex.options import PLAIN_COLOR
        from flowtex.plotting.component import FlowtexComponent

        self.canvas = Canvas(640, 400)
        wanted = options.pop("scalars", None)
        self.colour = "" if wanted is False else ("speed" if wanted in (None, True) else wanted)
        self.cmap = options.pop("cmap", None) or DEFAULT_CMAP
        self.plain = options.pop("color", PLAIN_COLOR)
        clim = options.pop("clim", None)
        self._clims = {} if clim is None else {self.colour: (float(clim[0]), float(clim[1]))}
        self._first = (zoom, focus)
        self._size = self.canvas.size
        self._component = FlowtexComponent(self.canvas.plotter)
        self._beside: dict[str, Any] = {}
        self._end_following = lambda: None
        self.panes: list[Pane] = [self._pane(field, options)]
        self.lighting = options.get("lighting")
        self.canvas.hush()
        self._begin()
        self.first_look()

    @property
    def flat(self) -> bool:
        """Whether the surface lies in a plane."""
        return self.field.surface.frame is not None

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the whole view, in pixels."""
        return self._size

    @property
    def pane_size(self) -> tuple[int, int]:
        """Width and height of one pane, in pixels."""
        width, height = self._size
        return (width if len(self.panes) == 1 else max((width - GAP) // 2, 1)), height

    @property
    def beside(self) -> dict[str, Any]:
        """What is different in the second pane; empty where there is one pane."""
        return dict(self._beside)

    def _pane(
        self, field: FlowField, options: Mapping[str, Any], picture: Any | None = None
    ) -> Pane:
        """Add a pane; with the texels of a picture, when there is one, whatever its noise is."""
        given = dict(options)
        if picture is not None:
            given["noise"] = "procedural"
        handle = self._component.add(
            field, scalars="speed", show_scalar_bar=False, reset_camera=False, **given
        )
        if picture is not None:
            handle.set_image(as_image(picture))
            handle.settings.noise = options["noise"]
        return Pane(handle, self._draw, lambda: self.pane_size, self.plane_view)

    def _begin(self) -> None:
        """Make ready for a field."""
        self.navigator = Navigator(self.canvas.plotter.camera, flat=self.flat, hit=self.hit)
        if self.colour not in ("", *self.colours):
            self.colour = "speed"
        self.colour_by(self.colour)
        self.resize(*self._size)

    def close(self) -> None:
        """Free the graphics card."""
        self._end_following()
        for pane in self.panes:
            pane.handle.remove(render=False)
        self.canvas.close()

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
        settings, image, beside = dict(self.handle.settings), self.handle.scene.image, self._beside
        self._first = WHOLE
        camera, clock, flat = self.canvas.camera(), self.handle.clock, self.flat
        times, time = self.field.times, self.handle.time
        self.compare(None)
        old = self.handle
        self.panes[0] = self._pane(field, {**settings, "lighting": self.lighting}, image)
        old.remove(render=False)
        if not keep_range:
            self._clims.clear()
        self._begin()
        if keep_range and np.array_equal(times, field.times):
            self.set_time(time)
        self.home()
        if keep_view and flat == self.flat:
            self.canvas.set_camera(camera)
        self.clock = clock
        if beside:
            self.compare(beside)

    def compare(self, changes: Mapping[str, Any] | None) -> None:
        """Show a second pane in which some settings differ, or one pane again for ``None``.

        Raises
        ------
        SettingsError
            When a setting is unknown or out of range; the panes stay as they are.
        """
        wanted = {**dict(self.handle.settings), **(changes or {})}
        Settings().update(**wanted)
        self._end_following()
        self._end_following = lambda: None
        for pane in self.panes[1:]:
            pane.handle.remove(render=False)
        del self.panes[1:]
        self._beside = dict(changes or {})
        if changes:
            self._add_beside(wanted)
        self.colour_by(self.colour)
        self.resize(*self._size)

    def _add_beside(self, wanted: dict[str, Any]) -> None:
        options = {**wanted, "lighting": self.lighting}
        self.panes.append(self._pane(self.field, options, self.handle.scene.image))
        self._end_following = self.handle.settings.observe(self._follow)
        self.set_time(self.handle.time)
        self.clock = self.handle.clock

    def _follow(self, name: str, value: Any) -> None:
        """Change a setting of the second pane as that of the first one changes."""
        if name not in self._beside:
            self.panes[1].handle.settings.update(**{name: value})

    def lay_image(self, image: Any) -> None:
        """Lay an image on the surface in place of the noise, where that is no difference kept.

        Raises
        ------
        ImageError
            When it cannot be used; nothing is changed then.
        """
        # The first pane is followed by the second, which has to have the image by then.
        for pane in reversed(self.panes):
            pane.handle.set_image(image)
        if "noise" in self._beside:
            self.panes[1].handle.settings.noise = self._beside["noise"]

    def resize(self, width: int, height: int) -> None:
        """Change the size of the whole view."""
        self._size = (width, height)
        self.canvas.size = self.pane_size
        self.navigator.aspect = self.pane_size[0] / max(self.pane_size[1], 1)

    def home(self, zoom: float = 1.0, focus: tuple[float, ...] | None = None) -> None:
        """Look at the whole surface, or closer at a point of it."""
        aspect = self.navigator.aspect
        self.canvas.place(first_look(self.field, aspect))
        self.navigator.settle()
        self._home_camera = self.canvas.camera()
        if zoom != 1.0 or focus is not None:
            self.canvas.place(first_look(self.field, aspect, zoom=zoom, focus=focus))

    @property
    def at_home(self) -> bool:
        """Whether the camera stands where :meth:`home` has put it."""
        return self.canvas.camera() == self._home_camera

    def look(self, camera: Mapping[str, Any]) -> None:
        """Look from a camera, and not from where was asked for when the scene was made."""
        self._first = WHOLE
        self.canvas.set_camera(camera)

    def first_look(self) -> None:
        """Look at what was asked for when the scene was made."""
        self.home(*self._first)
        if self._first[0] == 1.0:
            self._home_camera = self.canvas.camera()

    def set_background(self, colour: str) -> None:
        """Take the colour behind the surface: a theme's, or any that PyVista knows."""
        self.canvas.set_background(BACKGROUNDS.get(colour, colour))

    def set_time(self, time: float) -> None:
        """Show another time of a field that varies in time."""
        for pane in self.panes:
            pane.handle.time = time
            if self.colour:
                pane.write_colours(self.colour)

    @property
    def clock(self) -> float:
        """Clock of the animation of a steady flow, in seconds."""
        return self.handle.clock

    @clock.setter
    def clock(self, seconds: float) -> None:
        for pane in self.panes:
            pane.handle.clock = seconds

    def draw(self, width: int, height: int, part: Rect | None = None) -> NDArray[np.uint8]:
        """Draw the first pane, or a part of it; :meth:`Canvas.draw` has the parameters."""
        return self.panes[0].draw(width, height, part)

    def _draw(self, pane: Pane, width: int, height: int, part: Rect | None) -> NDArray[np.uint8]:
        for other in self.panes:
            other.show(visible=other is pane)
        return self.canvas.draw(width, height, part)

    def plane_view(self) -> NDArray[np.float64] | None:
        """Affine map from the surface's plane to the view, (3, 3); ``None`` when it has none."""
        return plane_view(self.field.surface, self.navigator)

    def hit(self, x: float, y: float) -> NDArray[np.float64] | None:
        """Point of the surface at a place of the view, from -1 to 1, right and up."""
        return hit(self.panes[0].mesh, self.field.surface.extent, self.navigator, x, y)
