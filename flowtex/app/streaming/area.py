"""The view as its own component, for any trame application.

It is ``<flowtex-view>``, with its controls: drawn by the browser where that has WebGL2 and a
graphics card, and else here, as pictures. Whatever is changed through :attr:`FlowArea.settings`,
or of the appearance, such as ``area.cmap = "magma"``, is drawn at once.
"""

from __future__ import annotations

import asyncio
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import trame_rca.module
from trame_client.widgets.core import AbstractElement

from flowtex.app.server.files import Routes
from flowtex.app.server.page import PageState, mapping, name_among, number, running_loop
from flowtex.app.streaming.element import PAINTERS, HandedScene, Player
from flowtex.app.streaming.points import PointReader
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.options import FieldOptions, option_names
from flowtex.host.view import client_module, is_choice
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.camera import Camera, CameraError
from flowtex.rendering.webgl.protocol import Header
from flowtex.rendering.webgl.velocity import PREFIX
from flowtex.scene.fields import read_field
from flowtex.scene.options import AppearanceAttributes, ViewOptions
from flowtex.scene.scene import Change, Scene
from flowtex.settings import TABLE, Signal

#: Events of the element on the page.
EVENTS = ("camera", "time", "clock", "playing", "setting", "colours")


class _Client(AbstractElement):
    """The element that ``client/src/app`` makes."""

    def __init__(self, name: str, **attributes: Any) -> None:
        super().__init__(name, **attributes)
        self._attr_names += ["begin", "read"]
        self._event_names += EVENTS


class FlowArea(AppearanceAttributes):
    """A view of a flow as part of a trame page, with its controls.

    Parameters
    ----------
    flow
        A :class:`~flowtex.FlowField` or a mesh.
    server
        The trame server of the page.
    state
        The state of the page; new names by default.
    **options
        Arguments and settings of ``plotter.flowtex.add``, and ``zoom``, ``focus`` and ``axes`` as
        for :func:`flowtex.show`.

    Attributes
    ----------
    viewport, stream, player
        The view as it is drawn, the stream of pictures to the page, and the animation.
    points
        The values at points.
    scalars, cmap, clim, log_scale, color, opacity, visible, lighting
        Arguments of ``plotter.flowtex.add``, which can be changed.

    Raises
    ------
    FieldError, SettingsError
        When the mesh or a setting is invalid.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.app import FlowArea
    >>> from trame.app import get_server
    >>> area = FlowArea(flowtex.examples.airfoil_field(), server=get_server("a page"), samples=9)
    >>> area.compare({"lod": False})
    >>> area.close()
    """

    def __init__(
        self, flow: Any, *, server: Any, state: PageState | None = None, **options: Any
    ) -> None:
        self.server = server
        self.state = state or PageState(server)
        names = option_names(FieldOptions)
        self._reading = FieldOptions.of(**{k: options.pop(k, None) for k in names})
        self._axes = ViewOptions(axes=options.pop("axes", None)).axes
        self.viewport = Viewport(read_field(flow, self._reading), **options)
        self.stream = FrameStream(self.state.key("view"), self.viewport)
        self.player = Player(self.viewport, self.stream)
        self.points = PointReader(self.viewport)
        self.painter = ""  #: ``"server"`` or ``"browser"``; empty before a page begins.
        #: Names of the panes, where they differ from those of their fields.
        self.names: tuple[str, ...] = ()
        #: Signals with the error of a user's action, and after a change of the painter.
        self.failed = Signal()
        self.painter_changed = Signal()
        self.parameter_asked = Signal()
        self.ref = self.state.key("element")
        self._routes = Routes.of(server)
        self._client = _client_script(self._routes)
        self._scenes: list[HandedScene] = []
        self._handed: tuple[object, ...] = ()
        self._sent: Header = {}
        self._due: asyncio.Handle | None = None
        #: Number of the place that pages look at: cameras and times of another one are late.
        self._place = 0
        #: Name of the page whose message is being handled.
        self._by = ""
        self.player.time_changed.connect(self._follow_time)
        self.player.playing_changed.connect(self.follow)
        self._tasks: list[asyncio.Task[None]] = []
        settings = self.settings.observe(lambda name, value: self._changed())
        self._ends = (settings, self.scene.observe(self._scene_changed))
        self._is_made = True
        if server.running:
            self._on_ready()
        else:
            server.controller.on_server_ready.add(self._on_ready)

    @property
    def scene(self) -> Scene:
        """The field, its appearance and its textures."""
        return self.viewport.scene

    @property
    def field(self) -> FlowField:
        """The flow. Assign another flow or mesh to show it with the same camera."""
        return self.viewport.field

    @field.setter
    def field(self, mesh: Any) -> None:
        if isinstance(mesh, FlowField):
            reading = FieldOptions()
        else:
            reading = self._reading
        self.show(read_field(mesh, reading), keep_view=True, keep_clim=True, keep_time=True)

    def ui(self, **attributes: Any) -> Any:
        """Add the view to the open layout; ``attributes`` are attributes of the HTML element."""
        server = self.server
        server.enable_module(trame_rca.module)
        server.enable_module(
            {
                "serve": {"__flowtex": str(Path(__file__).parents[1] / "ui" / "static")},
                "styles": ["__flowtex/flowtex.css"],
                "scripts": ["__flowtex/flowtex.js"],
                "vue_use": ["flowtex_page"],
            }
        )
        attributes["style"] = "width: 100%; height: 100%; " + attributes.get("style", "")
        for name in EVENTS:
            take = getattr(self, f"take_{name}")
            attributes[name] = (take, "[$event.value, $event.page, $event.place]")
        return _Client(
            "flowtex-client",
            ref=self.ref,
            begin=server.trigger_name(self.begin),
            read=server.trigger_name(self.points.read),
            **attributes,
        )

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
            Whether the camera stays where it is.
        keep_range
            Whether the colour range stays, as for another part of the same data.
        keep_clim
            Whether a chosen colour range stays, while an automatic one is that of the flow.
        keep_time
            Whether the time stays, as far as the flow has it.
        """
        before = self.viewport.camera
        self.viewport.show(
            field,
            keep_view=keep_view,
            keep_range=keep_range,
            keep_clim=keep_clim,
            keep_time=keep_time,
        )
        if self.viewport.camera != before:
            self._place += 1
        self.changed()

    def compare(self, changes: Mapping[str, Any] | None) -> None:
        """Show a second pane with the given differences, or a single pane for ``None``.

        Parameters
        ----------
        changes
            Settings, and ``scalars``, ``time`` and ``field`` of the second pane, where they differ.
        """
        self.viewport.compare(changes)
        self.changed()

    def look(self, camera: object) -> None:
        """Set the camera, unless it sees nothing."""
        if self.take_camera(camera):
            self.repeat()

    def reset_camera(self) -> None:
        """Show the whole surface again."""
        self.viewport.home()
        self.changed()

    def changed(self) -> None:
        """Draw after a change, and notify the page."""
        self.follow()
        self.stream.changed()

    def close(self) -> None:
        """End the tasks and free the graphics memory."""
        self.stream.close()
        for task in self._tasks:
            task.cancel()
        self._tasks.clear()
        self.player.close()
        self.painter = ""
        if self._due is not None:
            self._due.cancel()
        for scene in self._scenes:
            scene.close()
        self.points.close()
        for end in self._ends:
            end()
        self.viewport.close()

    # --- messages to the page ------------------------------------------------------------------

    def begin(self, painter: object) -> Header:
        """Return all values that a new page needs, or a page with another painter."""
        if name_among(painter, PAINTERS):
            self.painter = painter
        else:
            self.painter = PAINTERS[0]
        self.stream.paused = self.painter == "browser"
        self.stream.fits = False
        self.painter_changed.emit()
        self.stream.reset()
        self._sent = self._present()
        area = self.stream.area_name
        return {"client": self._client, "area": area, "scenes": self._hand_over(), **self._sent}

    def follow(self) -> None:
        """Send changes to the page; other scenes after all pending changes."""
        if not self.painter or self._due is not None:
            return
        loop = running_loop()
        if loop is not None and self._handed != self._appearances():
            self._due = loop.call_soon(self._send_changes)
        else:
            self._send_changes()

    def _follow_time(self) -> None:
        with self._changed_by(self.player.page):
            self.follow()

    def _send_changes(self) -> None:
        """Send to the page what has changed since the last message."""
        self._due = None
        changes: Header = {}
        if self._handed != self._appearances():
            changes["scenes"] = self._hand_over()
        present = self._present()
        for name, value in present.items():
            if value != self._sent.get(name):
                changes[name] = value
        self._sent = present
        if changes:
            self.call("take", {**changes, "by": self._by})

    def repeat(self) -> None:
        """Send the current values to the page again, to replace invalid ones."""
        self._handed = ()
        self._sent = {}
        self.follow()

    def call(self, method: str, *values: object) -> None:
        """Call a method of the element on the page."""
        self.server.js_call(self.ref, method, *values)

    def _present(self) -> Header:
        """Return the settings, the camera and the times that are shown."""
        viewport = self.viewport
        camera = None
        if not viewport.sees_all:
            camera = viewport.camera.to_dict()
        time_beside = None
        if viewport.time_shift is None:
            time_beside = viewport.time_beside
        return {
            "settings": dict(viewport.settings),
            "camera": camera,
            "time": viewport.handle.time,
            "timeBeside": time_beside,
            "clock": viewport.clock,
            "playing": self.player.playing,
        }

    def _appearances(self) -> tuple[object, ...]:
        return (self.viewport.background, self.names, *map(_appearance, self.viewport.panes))

    def _hand_over(self) -> list[Header]:
        """Give each pane's scene to the page, and return their headers."""
        viewport = self.viewport
        present = self._present()
        panes = viewport.panes
        changes = viewport.differences
        for scene in self._scenes[len(panes) :]:
            scene.close()
        self._scenes = self._scenes[: len(panes)]
        while len(self._scenes) < len(panes):
            self._scenes.append(HandedScene(self._routes))
        settings = {}
        for name, value in changes.items():
            if name in TABLE:
                settings[name] = value
        result = []
        for n, (scene, pane) in enumerate(zip(self._scenes, panes, strict=True)):
            values = {"camera": present["camera"], "axes": self._axes, "differs": list(settings)}
            values["place"] = self._place
            if n:
                values |= {"own": settings, "timeShift": viewport.time_shift}
            if n < len(self.names):
                values["name"] = self.names[n]
            result.append(scene.update(pane, viewport.background, **values))
        self._handed = self._appearances()
        return result

    # --- messages from the page ------------------------------------------------------------------

    @contextmanager
    def _changed_by(self, page: object) -> Iterator[None]:
        """Send changes by one page to all others."""
        if isinstance(page, str):
            self._by = page
        else:
            self._by = ""
        try:
            yield
        except FieldError as error:
            self._by = ""
            self.failed.emit(error)
            self.repeat()
        finally:
            self._by = ""

    def _is_late(self, place: object) -> bool:
        """Return whether a page sent a message before it was shown the present place."""
        return place is not None and place != self._place

    def take_camera(self, values: Any, page: object = "", place: object = None) -> bool:
        """Set a camera sent by a page; return whether it is valid."""
        viewport = self.viewport
        if self._is_late(place):
            return False
        try:
            camera = Camera.from_dict(values, viewport.camera)
        except CameraError:
            return False
        near = camera.is_near(viewport.field.surface)
        if near:
            with self._changed_by(page):
                viewport.camera = camera
                self.follow()
            self.stream.changed()
        return near

    def take_time(self, time: object, page: object = "", place: object = None) -> None:
        """Show a time of the field."""
        checked = number(time, *map(float, self.viewport.field.times[[0, -1]]))
        if checked is not None and not self._is_late(place):
            if not isinstance(page, str):
                page = ""
            self.player.go_to(checked, page)

    def take_clock(self, clock: object, page: object = "", place: object = None) -> None:
        """Show a moment of the streaming of a steady flow."""
        checked = number(clock, 0, 1e9)
        if checked is not None and not self._is_late(place):
            with self._changed_by(page):
                self.viewport.clock = checked
                self.follow()
            self.stream.changed()

    def take_playing(self, playing: object, page: object = "", place: object = None) -> None:
        """Start or stop the animation, as on the page."""
        del place  # which all of them share
        with self._changed_by(page):
            self.player.playing = bool(playing)

    def take_setting(self, pair: object, page: object = "", place: object = None) -> None:
        """Set the setting that the page requests, or report an error."""
        del place  # which all of them share
        if not (isinstance(pair, list) and len(pair) == 2):
            return
        name = pair[0]
        value = number(pair[1], -1e300, 1e300)
        if isinstance(name, str) and name.startswith(PREFIX) and value is not None:
            self.parameter_asked.emit(name.removeprefix(PREFIX), value)
        elif name_among(pair[0], TABLE):
            with self._changed_by(page):
                self.viewport.settings.update(**{pair[0]: pair[1]})

    def take_colours(self, choice: object, page: object = "", place: object = None) -> None:
        """Set the colours that the page requests, or report an error."""
        del page, place  # which receives the colours as well
        changes = {}
        for name, value in mapping(choice).items():
            if is_choice(name, value):
                changes[name] = value
        scene = self.viewport.scene
        with self._changed_by(""), suppress(KeyError, TypeError):
            scene.change(changes)

    def _scene_changed(self, affects: Change) -> None:
        if affects == "appearance":
            self._changed()

    def _changed(self) -> None:
        if not self.stream.painter.drafting:
            self.changed()

    def _on_ready(self, **_: object) -> None:
        """Begin to send pictures once the server runs."""
        if self._tasks:  # a page can trigger this again
            return
        self.server.controller.rc_area_register(self.stream)
        self._tasks.append(asyncio.create_task(self.stream.run()))


def _client_script(routes: Routes) -> str:
    """Give the browser client to pages, and return its address."""

    def answer(_rest: object) -> tuple[bytes, str, None]:
        return client_module().encode(), "text/javascript", None

    address = routes.give("client", answer)
    return f"{address}.js"


def _appearance(pane: FlowHandle) -> tuple[object, ...]:
    """Return what a browser cannot change by itself: all that its arrays depend on."""
    scene = pane.scene
    settings = scene.settings
    built = []
    for row in TABLE.values():
        if row.affects != "uniform":
            built.append(getattr(settings, row.name))
    baked: tuple[Any, ...] = ()
    if settings.noise != "procedural":
        baked = (settings.seed, settings.tiles, settings.resolution)
    look = scene.appearance, scene.scalar_limits
    return (*built, *baked, scene.field, *look, id(scene.image))
