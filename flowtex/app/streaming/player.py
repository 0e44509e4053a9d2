"""Time that goes by: the steps of a flow that varies, or the streaming of a steady one."""

from __future__ import annotations

import asyncio
import logging
import time
from contextlib import suppress

import numpy as np

from flowtex.app.server.page import Signal
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.offscreen.movie import run_seconds

__all__ = ["Player"]

#: Pictures in a second while playing, at most.
RATE_HZ = 20.0
#: Seconds that one picture may let go by, however long it takes.
LONGEST_STEP_S = 0.5
#: Seconds that time stands after somebody has moved it by hand.
HOLD_S = 0.4

_log = logging.getLogger(__name__)


class Player:
    """Lets the time of a viewport go by, as fast as a stream draws it.

    Attributes
    ----------
    pace
        How many times faster than usual.
    time_changed
        Signal after a change of the time that is shown.
    """

    def __init__(self, viewport: Viewport, stream: FrameStream) -> None:
        self.pace = 1.0
        self.time_changed = Signal()
        self._viewport = viewport
        self._stream = stream
        self._held_until = 0.0

    @property
    def playing(self) -> bool:
        """Whether time goes by."""
        return self._stream.playing

    @playing.setter
    def playing(self, playing: bool) -> None:
        self._stream.playing = bool(playing)
        if playing and self._viewport.field.steady:
            for pane in self._viewport.panes:
                if pane.handle.settings.motion == "off":
                    pane.handle.settings.motion = "speed"
        self._stream.moved()

    def go_to(self, time: float) -> None:
        """Show a time, or the nearest there is; time stands where that cannot be read."""
        times, before = self._viewport.field.times, self._viewport.handle.time
        nearest = min(max(float(time), float(times[0])), float(times[-1]))
        if nearest == before:
            return
        try:
            self._viewport.set_time(nearest)
        except FieldError as error:
            self.playing = False
            with suppress(FieldError):
                self._viewport.set_time(before)
            self._stream.data_failed.emit(error)
        self.time_changed.emit()
        self._stream.changed()

    def seek(self, time_: float) -> None:
        """Go to a time for a person, whose slider must not run away under the hand."""
        self._held_until = time.monotonic() + HOLD_S
        self.go_to(time_)

    def step(self, count: int) -> None:
        """Go so many steps of the field on, or back; round and round."""
        times = self._viewport.field.times
        if len(times) == 1:
            self._viewport.clock += count / RATE_HZ
            self._stream.changed()
            return
        at = self._viewport.handle.time
        after = np.searchsorted(times, at, side="right" if count > 0 else "left")
        self.go_to(float(times[(after - (count > 0) + count) % len(times)]))

    def advance(self, seconds: float) -> None:
        """Go on by so many seconds of the person's own time."""
        seconds *= self.pace
        field = self._viewport.field
        if field.steady:
            self._viewport.clock += seconds
            self._stream.changed()
            return
        first, span = float(field.times[0]), float(np.ptp(field.times))
        run = run_seconds(len(field.times))
        # After the last time comes the first: a period goes round, anything else begins again.
        self.go_to(first + (self._viewport.handle.time - first + span * seconds / run) % span)

    async def play(self) -> None:
        """Let time go by while playing, no faster than pictures are drawn."""
        before = time.perf_counter()
        while True:
            now = time.perf_counter()
            passed, before = now - before, now
            on_hold = time.monotonic() < self._held_until
            if self.playing and not (on_hold or self._stream.paused) and self._stream.watched():
                self._go_on(min(passed, LONGEST_STEP_S))
                await self._stream.next_picture()
            await asyncio.sleep(max(1 / RATE_HZ - (time.perf_counter() - now), 0.005))

    def _go_on(self, seconds: float) -> None:
        """Advance; where that fails time stands, and the log tells why."""
        try:
            self.advance(seconds)
        except Exception:
            _log.exception("time cannot go on")
            self.playing = False
