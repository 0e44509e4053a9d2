"""The player's controls: time, pace, and stepping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.context import Context, Controller
from flowtex.app.server.validation import number
from flowtex.offscreen.annotations import time_text

#: How many times faster than usual time may go by.
PACES = (0.25, 0.5, 1.0, 2.0, 4.0)
#: Stops of the time slider between two steps of the field.
STOPS_PER_STEP = 8


class Playback(Controller):
    """Time on the page."""

    def __init__(self, context: Context) -> None:
        super().__init__(context)
        self.player = self.area.player
        self.state.set(playing=False, pace=1.0)
        self.show_times()
        self.state.on("time")(self.take_time)
        self.state.on("playing")(self.take_playing)
        self.state.on("pace")(self.take_pace)
        context.time_changed.connect(self.show_time)
        context.field_changed.connect(self.show_times)
        context.step_requested.connect(self.step)

    def take_time(self) -> None:
        """Show the time that the page asks for."""
        time = number(self.state.get("time"))
        if time is not None and time != self.player.time:
            self.player.seek(time)
        self.state.set(time=self.player.time)

    def show_time(self) -> None:
        """Let the page show the time."""
        self.state.send(time=self.player.time, moment=self._time_text())

    def take_playing(self) -> None:
        """Let time go by, or stop it."""
        self.player.playing = playing = bool(self.state.get("playing"))
        self.state.set(playing=playing, set_motion=self.settings.motion)

    def take_pace(self) -> None:
        """Let time go by faster or slower."""
        pace = self.state.get("pace")
        if number(pace) in PACES:
            self.player.pace = float(pace)
        self.state.set(pace=self.player.pace)

    def step(self, count: Any) -> None:
        """Go to the next step, 1, or the one before, -1."""
        if number(count) not in (-1.0, 1.0):
            return
        self.state.set(playing=False)
        self.player.playing = False
        self.player.step(int(count))

    def show_times(self) -> None:
        """Let the page show the range of times, and the present one."""
        field = self.viewport.field
        first, last = float(field.times[0]), float(field.times[-1])
        self.state.set(
            steady=field.steady,
            first=first,
            last=last,
            tick=(last - first) / max((len(field.times) - 1) * STOPS_PER_STEP, 1),
            time=self.player.time,
            moment=self._time_text(),
        )

    def describe(self) -> dict[str, Any]:
        """Return the time, where it makes a difference."""
        return {} if self.viewport.field.steady else {"time": self.player.time}

    def restore(self, saved: Mapping[str, Any]) -> None:
        """Go to a saved time."""
        if "time" in saved and not self.viewport.field.steady:
            self.player.go_to(float(saved["time"]))

    def _time_text(self) -> str:
        return time_text(self.viewport.field, self.viewport.handle.time)
