"""Time that goes by: the steps of a flow that varies, or the streaming of a steady one."""

from __future__ import annotations

import asyncio
import logging
import time
from contextlib import suppress

import numpy as np

from flowtex.app.server.page import Signal, start_task
from flowtex.app.streaming.stream import FrameStream
from flowtex.app.streaming.viewport import Viewport
from flowtex.errors import FieldError
from flowtex.offscreen.movie import run_seconds

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
        self._wanted: float | None = None
        self._reading: asyncio.Task[None] | None = None

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

    @property
    def time(self) -> float:
        """The time that is shown, or that will be once it is read."""
        return self._viewport.handle.time if self._wanted is None else self._wanted

    def go_to(self, time: float) -> None:
        """Show a time, or the nearest there is; time stands where that cannot be read.

        Steps that are read when they are asked for are read beside the event loop: until then the
        time that is shown stays.
        """
        times = self._viewport.field.times
        nearest = min(max(float(time), float(times[0])), float(times[-1]))
        if nearest == self.time:
            return
        if not (self._viewport.reads_late and _in_a_loop()):
            self._show(nearest)
            return
        self._wanted = nearest
        if self._reading is None or self._reading.done():
            self._reading = start_task(self._read(), "a time cannot be read")

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
        self.playing = False
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
        at = self.time
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
        self.go_to(first + (self.time - first + span * seconds / run) % span)

    def close(self) -> None:
        """Show no time any more that is still being read."""
        if self._reading is not None:
            self._reading.cancel()

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


def _in_a_loop() -> bool:
    """Whether this runs in an event loop; a script may use an application as well."""
    with suppress(RuntimeError):
        asyncio.get_running_loop()
        return True
    return False
