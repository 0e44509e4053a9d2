"""The player's controls: time, pace, and stepping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flowtex.app.controllers.part import Part
from flowtex.app.server.untrusted import number

__all__ = ["PACES", "Clockwork"]

#: How many times faster than usual time may go by.
PACES = (0.25, 0.5, 1.0, 2.0, 4.0)
#: Stops of the time slider between two steps of the field.
STOPS = 8
#: A unit of time with more letters than this is left out beside the slider.
LONGEST_UNIT = 8


class Clockwork(Part):
    """Time on the page."""

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {"playing": False, "pace": 1.0, **self._times()}

    def watch(self) -> None:
        """Listen to the page."""
        self.state.on("time")(self.take_time)
        self.state.on("playing")(self.take_playing)
        self.state.on("pace")(self.take_pace)
        self.area.timed.append(self.show_time)

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self.state.set(**self._times())

    def take_time(self) -> None:
        """Show the time that the page asks for."""
        wanted = number(self.state.get("time"))
        if wanted is not None and wanted != self.scene.handle.time:
            self.area.player.seek(wanted)
        self.state.set(time=self.scene.handle.time)

    def show_time(self) -> None:
        """Let the page show the time."""
        self.state.send(time=self.scene.handle.time, moment=self._moment())

    def take_playing(self) -> None:
        """Let time go by, or stop it."""
        self.area.player.playing = playing = bool(self.state.get("playing"))
        self.state.set(playing=playing, set_motion=self.area.settings.motion)

    def take_pace(self) -> None:
        """Let time go by faster or slower."""
        pace = self.state.get("pace")
        if number(pace) in PACES:
            self.area.player.pace = float(pace)
        self.state.set(pace=self.area.player.pace)

    def step(self, count: Any) -> None:
        """Go to the next step, 1, or the one before, -1."""
        if number(count) not in (-1.0, 1.0):
            return
        self.state.set(playing=False)
        self.area.player.playing = False
        self.area.player.step(int(count))

    def describe(self) -> dict[str, Any]:
        """Return what a link needs to know."""
        return {} if self.scene.field.steady else {"time": self.scene.handle.time}

    def restore(self, said: Mapping[str, Any]) -> None:
        """Take over what a link says."""
        if "time" in said and not self.scene.field.steady:
            self.area.player.go_to(float(said["time"]))

    def _times(self) -> dict[str, Any]:
        times = self.scene.field.times
        first, last = float(times[0]), float(times[-1])
        return {
            "steady": self.scene.field.steady,
            "first": first,
            "last": last,
            "tick": (last - first) / max((len(times) - 1) * STOPS, 1),
            "time": self.scene.handle.time,
            "moment": self._moment(),
        }

    def _moment(self) -> str:
        unit = self.scene.field.time_unit
        shown = f" {unit}" if 0 < len(unit) <= LONGEST_UNIT else ""
        return f"t = {self.scene.handle.time:.2f}{shown}"
