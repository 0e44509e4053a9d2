"""The time that is shown, and whether time goes by, which the page sees to."""

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
        #: Signals after a change of the time that is shown, and of whether time goes by.
        self.time_changed, self.playing_changed = Signal(), Signal()
        #: Name of the page that requested the time that is shown; empty where it comes from here.
        self.page = ""
        self._viewport = viewport
        self._stream = stream
        self._wanted: float | None = None
        self._reading: asyncio.Task[None] | None = None

    @property
    def playing(self) -> bool:
        """Whether time goes by."""
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
        """The time that is shown, or that will be once it is read."""
        return self._viewport.handle.time if self._wanted is None else self._wanted

    def go_to(self, time: float, page: str = "") -> None:
        """Show a time, or the nearest there is; time stands where that cannot be read.

        Steps that are read when they are requested are read beside the event loop: until then the
        time that is shown stays.
        """
        times = self._viewport.field.times
        nearest = min(max(float(time), float(times[0])), float(times[-1]))
        if nearest == self.time:
            return
        self.page = page
        if running_loop() is None or not self._viewport.reads_late:
            self._show(nearest)
            return
        self._wanted = nearest
        if self._reading is None or self._reading.done():
            self._reading = start_task(self._read(), "a time step cannot be read")

    async def _read(self) -> None:
        """Read the time that is wanted, the latest only, and show it."""
        while (wanted := self._wanted) is not None:
            fault, field = None, self._viewport.field
            try:
                await asyncio.to_thread(self._viewport.trace, wanted)
            except FieldError as error:
                fault = error
            if field is not self._viewport.field:
                self._wanted = None
            elif wanted == self._wanted:
                self._wanted = None
                self._stand(fault) if fault else self._show(wanted)

    def _show(self, time: float) -> None:
        before = self._viewport.handle.time
        try:
            self._viewport.set_time(time)
        except FieldError as error:
            with suppress(FieldError):
                self._viewport.set_time(before)
            self._stand(error)
            return
        self.time_changed.emit()
        self._stream.changed()

    def _stand(self, error: FieldError) -> None:
        """Stay at the time that is shown, as another one cannot be read."""
        self.playing, self.page = False, ""
        self._stream.data_failed.emit(error)
        self.time_changed.emit()
        self._stream.changed()

    def close(self) -> None:
        """Show no time any more that is still being read."""
        if self._reading is not None:
            self._reading.cancel()
