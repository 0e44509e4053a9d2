"""The Python side of ``<flowtex-view>``: the data sent to the page, and the user's actions there.

The page asks for files of parts: of the whole surface, and of tiles, at some times;
:mod:`flowtex.host.view` says what is in them. The page says which of two painters draws: the
browser with WebGL2, or VTK here, whose pictures a stream sends. With VTK it has only the parts for
controls and legend.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from functools import partial
from typing import Any

from flowtex._util.progress import Stopped
from flowtex.app.server.files import Content, Routes
from flowtex.app.server.page import PageState, mapping, name_among, number, running_loop
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.host.view import CHOSEN, PART_GROUPS, TileSource, WebView, client_module
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.camera import Camera, CameraError
from flowtex.rendering.webgl.marks import MARK_PARTS
from flowtex.rendering.webgl.protocol import Header, parts_file
from flowtex.rendering.webgl.velocity import PREFIX
from flowtex.settings import TABLE, Signal
from flowtex.textures.tiles.pyramid import TileKey

_log = logging.getLogger(__name__)
_numbers = itertools.count(1)
#: Painters.
PAINTERS = ("server", "browser")
#: Name of the whole surface in place of a tile.
WHOLE = "whole"


class HandedScene:
    """A scene for the page: its header, and files of its parts at its own address."""

    def __init__(self, routes: Routes) -> None:
        self._routes, self._stem = routes, ""
        self._source: TileSource | None = None

    def update(self, pane: FlowHandle, background: object, **values: object) -> Header:
        """Replace the scene by that of a pane, or by the same in other colours.

        Return the header, with further values of the pane, and the address of the parts.
        """
        data = WebView(pane.scene, background=background).data()
        # VTK draws no legend into its pictures.
        data = data.recoloured(replace(data.colours, bar=True))
        source = self._source = TileSource.of(data, self._source)
        self._routes.withdraw(self._stem)
        self._stem = f"parts-{next(_numbers)}"
        header = source.scene.header(pane.settings, time=pane.time, clock=pane.clock)
        return {
            "header": {**header, "generation": source.generation, **values},
            "parts": self._routes.give(self._stem, partial(self._content, source)) + ".",
        }

    async def _content(self, source: TileSource, name: str) -> Content:
        place, *numbers = name.split(".")
        steps = [int(number) for number in numbers]
        kind = place if place in (*PART_GROUPS, *MARK_PARTS.values()) else ""
        key = None
        if place != WHOLE and not kind:
            level, row, column = map(int, place.split(","))
            key = TileKey(level, row, column)
        if not all(0 <= step < source.scene.steps for step in steps):
            raise LookupError(name)
        try:
            parts = await asyncio.wrap_future(source.ask(key, steps, kind=kind))
        except Stopped:  # the scene is no longer shown
            parts = {}
        except Exception as error:
            # Coarser tiles replace it.
            part = "the surface" if key is None else f"tile {tuple(key)}"
            _log.warning("%s could not be made: %s", part, error)
            raise FileNotFoundError(name) from error
        # Packing takes a while, and the loop has other pages to serve.
        body = await asyncio.get_running_loop().run_in_executor(None, parts_file, parts)
        return body, "application/octet-stream", None

    def close(self) -> None:
        """Stop serving the parts."""
        self._routes.withdraw(self._stem)
        if self._source is not None:
            self._source.close()
        self._source = None


class Element:
    """The view of a viewport on a page, and the user's actions there."""

    def __init__(
        self,
        state: PageState,
        viewport: Viewport,
        stream: FrameStream,
        player: Player,
        axes: str | None = None,
    ) -> None:
        self.painter = ""  #: ``"server"`` or ``"browser"``; empty before a page begins.
        #: Names of the panes, where they differ from those of their fields.
        self.names: tuple[str, ...] = ()
        #: Signals with the error of a user's action, and after a change of the painter.
        self.failed, self.painter_changed = Signal(), Signal()
        self.parameter_asked = Signal()
        self.ref = state.key("element")
        self._server, self._viewport, self._stream = state.server, viewport, stream
        self._player, self._axes = player, axes
        self._routes = Routes.of(state.server)
        script = self._routes.give(
            "client", lambda _rest: (client_module().encode(), "text/javascript", None)
        )
        self._client = f"{script}.js"
        self._scenes: list[HandedScene] = []
        self._shown: tuple[object, ...] = ()
        self._sent: Header = {}
        self._due: asyncio.Handle | None = None
        #: Name of the page whose message is being handled.
        self._by = ""
        player.time_changed.connect(self._follow_time)
        player.playing_changed.connect(self.follow)

    # --- messages to the page ------------------------------------------------------------------

    def begin(self, painter: object) -> Header:
        """Return all values that a new page needs, or a page with another painter."""
        self.painter = painter if name_among(painter, PAINTERS) else PAINTERS[0]
        self._stream.paused, self._stream.fits = self.painter == "browser", False
        self.painter_changed.emit()
        self._stream.reset()
        self._sent = self._present()
        area = self._stream.area_name
        return {"client": self._client, "area": area, "scenes": self._hand_over(), **self._sent}

    def follow(self) -> None:
        """Send changes to the page; other scenes after all pending changes."""
        if not self.painter or self._due is not None:
            return
        loop = running_loop()
        if loop is not None and self._shown != self._appearances():
            self._due = loop.call_soon(self._send_changes)
        else:
            self._send_changes()

    def _follow_time(self) -> None:
        with self._changed_by(self._player.page):
            self.follow()

    def _send_changes(self) -> None:
        self._due = None
        changes: Header = {}
        if self._shown != self._appearances():
            changes["scenes"] = self._hand_over()
        present = self._present()
        changes |= {k: v for k, v in present.items() if v != self._sent.get(k)}
        self._sent = present
        if changes:
            self.call("take", {**changes, "by": self._by})

    def repeat(self) -> None:
        """Send the current values to the page again, to replace invalid ones."""
        self._shown, self._sent = (), {}
        self.follow()

    def call(self, method: str, *values: object) -> None:
        """Call a method of the element on the page."""
        self._server.js_call(self.ref, method, *values)

    def _present(self) -> Header:
        viewport = self._viewport
        return {
            "settings": dict(viewport.settings),
            "camera": None if viewport.sees_all else viewport.camera.to_dict(),
            "time": viewport.handle.time,
            "timeBeside": viewport.time_beside if viewport.time_shift is None else None,
            "clock": viewport.clock,
            "playing": self._player.playing,
        }

    def _appearances(self) -> tuple[object, ...]:
        return (
            self._viewport.background,
            self.names,
            *(_appearance(pane) for pane in self._viewport.panes),
        )

    def _hand_over(self) -> list[Header]:
        viewport, present = self._viewport, self._present()
        panes, changes = viewport.panes, viewport.differences
        for scene in self._scenes[len(panes) :]:
            scene.close()
        self._scenes = self._scenes[: len(panes)]
        self._scenes += [HandedScene(self._routes) for _ in panes[len(self._scenes) :]]
        settings = {name: value for name, value in changes.items() if name in TABLE}
        result = []
        for n, (scene, pane) in enumerate(zip(self._scenes, panes, strict=True)):
            values = {"camera": present["camera"], "axes": self._axes, "differs": list(settings)}
            if n:
                values |= {"own": settings, "timeShift": viewport.time_shift}
            if n < len(self.names):
                values["name"] = self.names[n]
            result.append(scene.update(pane, viewport.background, **values))
        self._shown = self._appearances()
        return result

    # --- messages from the page ------------------------------------------------------------------

    @contextmanager
    def _changed_by(self, page: object) -> Iterator[None]:
        """Send changes by one page to all others."""
        self._by = page if isinstance(page, str) else ""
        try:
            yield
        except FieldError as error:
            self._by = ""
            self.failed.emit(error)
            self.repeat()
        finally:
            self._by = ""

    def take_camera(self, values: Any, page: object = "") -> bool:
        """Set a camera sent by a page; return whether it is valid."""
        viewport = self._viewport
        try:
            camera = Camera.from_dict(values, viewport.camera)
        except CameraError:
            return False
        near = camera.is_near(viewport.field.surface)
        if near:
            with self._changed_by(page):
                viewport.camera = camera
                self.follow()
            self._stream.changed()
        return near

    def take_time(self, time: object, page: object = "") -> None:
        """Show a time of the field."""
        checked = number(time, *map(float, self._viewport.field.times[[0, -1]]))
        if checked is not None:
            self._player.go_to(checked, page if isinstance(page, str) else "")

    def take_clock(self, clock: object, page: object = "") -> None:
        """Show a moment of the streaming of a steady flow."""
        checked = number(clock, 0, 1e9)
        if checked is not None:
            with self._changed_by(page):
                self._viewport.clock = checked
                self.follow()
            self._stream.changed()

    def take_playing(self, playing: object, page: object = "") -> None:
        """Start or stop the animation, as on the page."""
        with self._changed_by(page):
            self._player.playing = bool(playing)

    def take_setting(self, pair: object, page: object = "") -> None:
        """Set the setting that the page requests, or report an error."""
        if not (isinstance(pair, list) and len(pair) == 2):
            return
        name, value = pair[0], number(pair[1], -1e300, 1e300)
        if isinstance(name, str) and name.startswith(PREFIX) and value is not None:
            self.parameter_asked.emit(name.removeprefix(PREFIX), value)
        elif name_among(pair[0], TABLE):
            with self._changed_by(page):
                self._viewport.settings.update(**{pair[0]: pair[1]})

    def take_colours(self, choice: object, page: object = "") -> None:
        """Set the colours that the page requests, or report an error."""
        del page  # which receives the colours as well
        changes = {name: value for name, value in mapping(choice).items() if name in CHOSEN}
        scene = self._viewport.scene
        with self._changed_by(""), suppress(KeyError, TypeError):
            scene.appearance = scene.appearance.changed(**changes)

    def close(self) -> None:
        """Stop serving the parts."""
        self.painter = ""
        if self._due is not None:
            self._due.cancel()
        for scene in self._scenes:
            scene.close()


def _appearance(pane: FlowHandle) -> tuple[object, ...]:
    scene = pane.scene
    settings = scene.settings
    built = [getattr(settings, row.name) for row in TABLE.values() if row.affects != "uniform"]
    baked = () if settings.noise == "procedural" else (settings.seed, settings.tiles)
    return (*built, *baked, scene.field, scene.appearance, id(scene.image))


class Player:
    """The time of a viewport."""

    def __init__(self, viewport: Viewport, stream: FrameStream) -> None:
        #: Signals after a change of the time shown, and after the animation starts or stops.
        self.time_changed, self.playing_changed = Signal(), Signal()
        #: Name of the page that requested the time shown; empty for a request of the server.
        self.page = ""
        self._viewport = viewport
        self._stream = stream
        self._requested: float | None = None
        self._reading: asyncio.Task[None] | None = None

    @property
    def playing(self) -> bool:
        """Whether the animation runs."""
        return self._stream.playing

    @playing.setter
    def playing(self, playing: bool) -> None:
        self._stream.playing = bool(playing)
        self._viewport.set_still(still=not playing)
        if playing and self._viewport.field.steady:
            for pane in self._viewport.panes:
                if pane.settings.motion == "off":
                    pane.settings.motion = "speed"
        self.playing_changed.emit()
        self._stream.changed()

    @property
    def time(self) -> float:
        """The time shown, or the requested one that is being read."""
        return self._viewport.handle.time if self._requested is None else self._requested

    def go_to(self, time: float, page: str = "") -> None:
        """Show a time, or the nearest one; lazy steps are first read in a thread."""
        times = self._viewport.field.times
        nearest = min(max(float(time), float(times[0])), float(times[-1]))
        if nearest == self.time:
            return
        self.page = page
        if running_loop() is None or not self._viewport.reads_late:
            self._show(nearest)
            return
        self._requested = nearest
        if self._reading is None or self._reading.done():
            self._reading = asyncio.create_task(self._read())

    async def _read(self) -> None:
        while (time := self._requested) is not None:
            fault, field = None, self._viewport.field
            try:
                await asyncio.to_thread(self._viewport.trace, time)
            except FieldError as error:
                fault = error
            if field is not self._viewport.field:
                self._requested = None
            elif time == self._requested:
                self._requested = None
                self._stop(fault) if fault else self._show(time)

    def _show(self, time: float) -> None:
        before = self._viewport.handle.time
        try:
            self._viewport.set_time(time)
        except FieldError as error:
            with suppress(FieldError):
                self._viewport.set_time(before)
            self._stop(error)
            return
        self.time_changed.emit()
        self._stream.changed()

    def _stop(self, error: FieldError) -> None:
        """Stop at the time shown, as another one cannot be read."""
        self.playing, self.page = False, ""
        self._stream.data_failed.emit(error)
        self.time_changed.emit()
        self._stream.changed()

    def close(self) -> None:
        """Cancel the time that is being read."""
        if self._reading is not None:
            self._reading.cancel()
