"""The frame clock over simulated connections: in simulated time, so that nothing is measured."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

pytest.importorskip("trame_rca")

from flowtex.app.streaming.frame_clock import MOST_ON_WAY, FrameClock

#: Bytes of a picture of full size in motion, and seconds that it takes to draw.
FULL_BYTES, DRAW_S = 215_000, 0.03


@dataclass
class Simulation:
    """A server that draws as often as its clock allows, and a page at the end of a connection."""

    round_trip_s: float
    bytes_per_s: float
    offset_s: float = 0.0  #: What the page's own clock is ahead.
    time: float = 0.0
    free: float = 0.0  #: When the connection has passed on all that was sent.
    delays: list[float] = field(default_factory=list)
    most: int = 0

    def __post_init__(self) -> None:
        self.clock = FrameClock(now=lambda: self.time)
        self._coming: list[tuple[float, int, float]] = []

    def drag(self, seconds: float) -> float:
        """Draw for some time, and return pictures per second."""
        end, before = self.time + seconds, len(self.delays)
        while self.time < end:
            self.rest(DRAW_S)
            while self.clock.on_way >= MOST_ON_WAY:
                self.rest(self._coming[0][0] - self.time)
            self._send()
        return (len(self.delays) - before) / seconds

    def rest(self, seconds: float) -> None:
        self.time += seconds
        self._receive()

    def _send(self) -> None:
        number = self.clock.sent(moving=True)
        self.most = max(self.most, self.clock.on_way)
        content = FULL_BYTES * self.clock.share
        self.free = max(self.free, self.time) + content / self.bytes_per_s
        shown = self.free + self.round_trip_s / 2
        self.delays.append(shown - self.time)
        self._coming.append((shown + self.round_trip_s / 2, number, shown))

    def _receive(self) -> None:
        while self._coming and self._coming[0][0] <= self.time:
            _, number, shown = self._coming.pop(0)
            self.clock.acknowledge("page", number, shown + self.offset_s)


@pytest.mark.parametrize("offset", [0.0, 1e6, -1e6])
def test_slow_connection_gets_smaller_pictures(offset: float) -> None:
    page = Simulation(round_trip_s=0.08, bytes_per_s=1.25e6, offset_s=offset)
    page.drag(2.0)
    rate = page.drag(5.0)
    # Pictures of full size would be 5.8 in a second, and each at least 0.21 s old.
    assert rate > 12.0
    assert max(page.delays[-50:]) < 0.21
    assert page.most == MOST_ON_WAY
    assert 0.1 < page.clock.share < 0.5


@pytest.mark.parametrize("round_trip", [0.001, 0.08, 0.6])
def test_fast_connection_gets_whole_pictures_however_far(round_trip: float) -> None:
    page = Simulation(round_trip, bytes_per_s=1.25e8)
    page.drag(4.0)
    assert page.clock.share == 1.0


def test_size_follows_connection_that_changes() -> None:
    page = Simulation(round_trip_s=0.08, bytes_per_s=1.25e8)
    page.drag(2.0)
    page.bytes_per_s = 1.25e6
    page.drag(3.0)
    assert page.clock.share < 0.5
    page.bytes_per_s = 1.25e8
    page.drag(3.0)
    assert page.clock.share == 1.0
    # A longer way is soon known not to come from the size.
    page.round_trip_s = 0.4
    page.drag(30.0)
    assert page.clock.share == 1.0


def test_picture_at_rest_does_not_change_size() -> None:
    page = Simulation(round_trip_s=0.08, bytes_per_s=1.25e8)
    page.drag(3.0)
    page.rest(1.0)
    number = page.clock.sent(moving=False)
    page.clock.acknowledge("page", number, page.time + 10.0)
    assert page.clock.share == 1.0 and page.clock.on_way == 0
