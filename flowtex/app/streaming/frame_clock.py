"""When the next picture may be sent to a page, and how large: no faster than the page shows them.

A page acknowledges each picture that it has shown, with the time on its own clock. How much later
than the fastest one it was shown is the same on any clock. Smaller pictures make up for that.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from contextlib import suppress

#: Pictures on their way to a page, at most.
MOST_ON_WAY = 2
#: Seconds after which a picture that is not acknowledged counts as lost.
LOST_S = 5.0
#: Seconds by which a picture in motion may be later than the fastest one.
SLACK_S = 0.04
#: Share of its pixels that such a picture has at first.
FIRST_SHARE = 0.25
#: Least share of its pixels.
LEAST_SHARE = 0.05
#: Least factor of this share from one picture to the next.
LEAST_FACTOR = 0.5
#: Greatest factor of it.
MOST_FACTOR = 1.25
#: Part of a delay that is no longer made up for, once pictures have the least share.
GIVEN_UP = 0.25


class FrameClock:
    """The pictures on their way to a page; ``now`` returns seconds."""

    def __init__(self, now: Callable[[], float] = time.perf_counter) -> None:
        self.now = now
        self._count = 0
        self._acknowledged = asyncio.Event()
        self.restart()

    def restart(self) -> None:
        """Forget all pictures, as for a new page."""
        self.share = FIRST_SHARE  #: Share of its pixels that the next picture in motion has.
        self._on_way: dict[int, tuple[float, bool]] = {}
        self._page = ""
        self._fastest = 0.0
        self._before = 0.0
        self._acknowledged.set()

    def sent(self, *, moving: bool) -> int:
        """Return the number of a picture that is sent now, in motion or at rest."""
        self._count += 1
        self._on_way[self._count] = self.now(), moving
        return self._count

    def acknowledge(self, page: str, number: int, shown: float) -> None:
        """Count a picture, and those before it, as shown by a page, in seconds of its clock."""
        sent, moving = self._on_way.get(number, (0.0, False))
        self._on_way = {later: value for later, value in self._on_way.items() if later > number}
        self._acknowledged.set()
        if not moving:
            return
        delay = shown - sent
        if page != self._page or delay < self._fastest:
            self._page = page
            self._fastest = delay
            self._before = delay
        # One that is late alone, as in a browser that is busy, is not the connection's.
        late = min(delay, self._before) - self._fastest
        self._before = delay
        factor = max(SLACK_S / max(late, SLACK_S / MOST_FACTOR), LEAST_FACTOR)
        self.share = min(max(self.share * factor, LEAST_SHARE), 1.0)
        if self.share == LEAST_SHARE:
            self._fastest += GIVEN_UP * late

    @property
    def on_way(self) -> int:
        """Number of pictures that are sent and not yet acknowledged."""
        earliest = self.now() - LOST_S
        return sum(sent > earliest for sent, _ in self._on_way.values())

    async def until(self, most: int) -> None:
        """Wait until at most so many pictures are on their way."""
        while self.on_way > most:
            self._acknowledged.clear()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._acknowledged.wait(), LOST_S)
