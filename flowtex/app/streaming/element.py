"""What a view has on a page: files of its parts, and its time.

The page asks for files of parts: of the whole surface, and of tiles, at some times;
:mod:`flowtex.host.view` says what is in them. With VTK it has only those for controls and legend.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial

from flowtex._util.progress import Stopped
from flowtex.app.server.files import Content, Routes
from flowtex.app.server.page import running_loop
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.host.view import PART_GROUPS, TileSource, WebView
from flowtex.plotting.handle import FlowHandle
from flowtex.rendering.webgl.marks import MARK_PARTS
from flowtex.rendering.webgl.protocol import Header, parts_file
from flowtex.settings import Signal
from flowtex.textures.tiles.pyramid import TileKey

_log = logging.getLogger(__name__)
_numbers = itertools.count(1)
#: Painters.
PAINTERS = ("server", "browser")
#: Name of the whole surface in place of a tile.
WHOLE = "whole"
#: Requests for steps of the whole that are answered at once, the last ones: a page has four at a
#: time, and drops those that a moving slider has left behind.
MOST_STEPS_ASKED = 8


def _never() -> bool:
    return False


class HandedScene:
    """A scene for the page: its header, and files of its parts at its own address."""

    def __init__(self, routes: Routes) -> None:
        self._routes = routes
        self._stem = ""
        self._source: TileSource | None = None
        #: Number of requests for steps of the whole.
        self._asked = 0

    def update(self, pane: FlowHandle, background: object, **values: object) -> Header:
        """Replace the scene by the scene of a pane, or by the same scene in other colours.

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
        """Return the parts of a scene that a page requests by name, as a file."""
        place, *numbers = name.split(".")
        steps = list(map(int, numbers))
        if place in (*PART_GROUPS, *MARK_PARTS.values()):
            kind = place
        else:
            kind = ""
        key = None
        if place != WHOLE and not kind:
            level, row, column = map(int, place.split(","))
            key = TileKey(level, row, column)
        for step in steps:
            if not 0 <= step < source.scene.steps:
                raise LookupError(name)
        if place == WHOLE and steps:
            is_over = self._next_request()
        else:
            is_over = _never
        try:
            parts = await asyncio.wrap_future(source.ask(key, steps, is_over, kind))
        except Stopped:  # neither the scene nor the step is shown any more
            parts = {}
        except Exception as error:
            # Coarser tiles replace it.
            if key is None:
                part = "the surface"
            else:
                part = f"tile {tuple(key)}"
            _log.warning("%s could not be made: %s", part, error)
            raise FileNotFoundError(name) from error
        # Packing takes a while, and the loop has other pages to serve.
        body = await asyncio.get_running_loop().run_in_executor(None, parts_file, parts)
        return body, "application/octet-stream", None

    def _next_request(self) -> Callable[[], bool]:
        """Count a request for steps; return whether many others have followed."""
        self._asked += 1
        number = self._asked
        return lambda: self._asked >= number + MOST_STEPS_ASKED

    def close(self) -> None:
        """Stop serving the parts."""
        self._routes.withdraw(self._stem)
        if self._source is not None:
            self._source.close()
        self._source = None


class Player:
    """The time of a viewport."""

    def __init__(self, viewport: Viewport, stream: FrameStream) -> None:
        #: Signals after a change of the time shown, and after the animation starts or stops.
        self.time_changed = Signal()
        self.playing_changed = Signal()
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
        if self._requested is None:
            return self._viewport.handle.time
        return self._requested

    @property
    def is_reading(self) -> bool:
        """Whether a requested time is being read."""
        return self._reading is not None and not self._reading.done()

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
        if not self.is_reading:
            self._reading = asyncio.create_task(self._read())

    async def _read(self) -> None:
        """Trace the requested time in a thread, then show it; again while others are requested."""
        while (time := self._requested) is not None:
            fault = None
            field = self._viewport.field
            try:
                await asyncio.to_thread(self._viewport.trace, time)
            except FieldError as error:
                fault = error
            if field is not self._viewport.field:
                self._requested = None
            elif time == self._requested:
                self._requested = None
                if fault:
                    self._stop(fault)
                else:
                    self._show(time)

    def _show(self, time: float) -> None:
        """Show a time, or the present one again if it cannot be drawn."""
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
        self.playing = False
        self.page = ""
        self._stream.data_failed.emit(error)
        self.time_changed.emit()
        self._stream.changed()

    def close(self) -> None:
        """Cancel the time that is being read."""
        if self._reading is not None:
            self._reading.cancel()
