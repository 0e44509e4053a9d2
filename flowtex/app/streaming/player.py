"""The time shown, and the state of the animation, which runs on the page."""

from __future__ import annotations

import asyncio
from contextlib import suppress

from flowtex.app.server.page import Signal, running_loop, start_task
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError


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
                if pane.handle.settings.motion == "off":
                    pane.handle.settings.motion = "speed"
        self.playing_changed.emit()
        self._stream.moved()

    @property
    def time(self) -> float:
        """The time shown, or the requested one that is being read."""
        return self._viewport.handle.time if self._requested is None else self._requested

    def go_to(self, time: float, page: str = "") -> None:
        """Show a time, or the nearest one; the animation stops if that cannot be read.

        Lazy steps are read in a thread: until then the time shown stays.
        """
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
            self._reading = start_task(self._read(), "a time step cannot be read")

    async def _read(self) -> None:
        """Read the latest requested time, and show it."""
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
