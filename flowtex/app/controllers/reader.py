"""Reading the picture: a tip under the pointer, and the path through a point that was clicked.

A path is read in a thread: with new textures it takes as long as a renderer takes to load them.
What is clicked next makes an end of what was read before.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from flowtex.app.controllers.part import Part
from flowtex.app.controllers.reading import Hover, PathCard
from flowtex.app.server.background import begin
from flowtex.app.server.untrusted import number
from flowtex.app.streaming.places import camera_of
from flowtex.app.streaming.pointer import Place
from flowtex.app.streaming.stream import Figures
from flowtex.probe import Probe, probe

__all__ = ["Reader"]

#: Seconds between two tips.
PATIENCE = 0.06


class Reader(Part):
    """What the page tells about points of the surface.

    Parameters
    ----------
    app
        The application.
    """

    def __init__(self, app: Any) -> None:
        super().__init__(app)
        self._hover = self._made_hover()
        self._at: tuple[float, float] | None = None
        self._card: PathCard | None = None
        self._looked = 0.0
        self._later: asyncio.TimerHandle | None = None
        self._asked = 0
        self._worker = ThreadPoolExecutor(1, thread_name_prefix="flowtex reading")
        self._reading: asyncio.Task[None] | None = None

    @property
    def busy(self) -> bool:
        """Whether a path is being read."""
        return self._reading is not None and not self._reading.done()

    def _made_hover(self) -> Hover:
        return Hover(self.scene.handle.scene, self.scene.navigator, self.scene.hit)

    def values(self) -> dict[str, Any]:
        """Return what the page begins with."""
        return {"tip": None, "card": None, "over": None}

    def watch(self) -> None:
        """Listen to the pointer."""
        self.area.stream.pointer.pointed = self.point
        self.area.stream.pointer.clicked = self.click
        self.area.reports.append(self.follow)

    def refresh(self) -> None:
        """Follow another flow that is shown."""
        self._hover = self._made_hover()
        self.leave()
        self.close_card()

    def point(self, place: Place | None) -> None:
        """Tell what is under the pointer, a few times in a second."""
        if self._later is not None:
            self._later.cancel()
            self._later = None
        if place is None:
            self.leave()
            return
        wait = self._looked + PATIENCE - time.monotonic()
        if wait <= 0:
            self._tell(place)
        else:
            self._later = asyncio.get_running_loop().call_later(wait, self._tell, place)

    def _tell(self, place: Place) -> None:
        self._looked = time.monotonic()
        lines = self._hover(*place)
        side = self.area.stream.pointer.side / len(self.scene.panes)
        x = side + (place[0] + 1) / 2 / len(self.scene.panes)
        tip = {"lines": lines, "x": 100 * x, "y": 50 - 50 * place[1]}
        self.state.send(tip=tip if lines else None)

    def leave(self) -> None:
        """Tell nothing."""
        if self._later is not None:
            self._later.cancel()
            self._later = None
        if self.state.get("tip") is not None:
            self.state.send(tip=None)

    def click(self, place: Place) -> None:
        """Show the path through what was clicked; beside the surface, none."""
        self.show_path(self._hover.index(*place))

    def take_place(self, place: Any) -> None:
        """Tell what is under the pointer of the browser's client, (x, y) from -1 to 1."""
        numbers = [number(v, -1, 1) for v in place] if _is_pair(place) else [None, None]
        x, y = numbers
        self.point(None if x is None or y is None else (x, y))

    def take_point(self, index: Any) -> None:
        """Show the path through a point that the browser's client tells, (i, j)."""
        rows, columns = self.scene.field.shape
        if _is_pair(index):
            i, j = number(index[0], 0, columns - 1), number(index[1], 0, rows - 1)
            if i is not None and j is not None:
                self.show_path((j, i))

    def show_path(self, at: tuple[float, float] | None) -> None:
        """Show the path through a point (j, i) of the surface."""
        self._at = at
        self._asked += 1
        if at is None:
            self.close_card()
            return
        try:
            asyncio.get_running_loop()
        except RuntimeError:  # a script, which waits
            self._show(self._reader(at)())
            return
        if not self.busy:
            self._reading = begin(self._read(), "a path could not be read")

    async def _read(self) -> None:
        """Read the path through what was asked for last, until nothing else is asked for."""
        asked, loop = -1, asyncio.get_running_loop()
        while self._at is not None and asked != self._asked:
            asked = self._asked
            found = await loop.run_in_executor(self._worker, self._reader(self._at))
            if asked == self._asked:
                self._show(found)

    def _reader(self, at: tuple[float, float]) -> Callable[[], Probe | None]:
        """Return what reads the path through a point as things are now, if it is in view."""
        view, clock = self.scene.handle.scene.copy(), self.scene.clock
        camera = camera_of(self.scene.navigator)
        size = self.scene.pane_size

        def read() -> Probe | None:
            try:
                return probe(view, at, pixel=camera, size=size, clock=clock)
            except ValueError:
                return None

        return read

    def _show(self, found: Probe | None) -> None:
        if found is None:
            self.close_card()
            return
        self._card = PathCard(found)
        lines = [list(line) for line in self._card.lines()]
        self.state.send(card={"lines": lines, "bars": self._card.bars()}, over=self._over())

    def close_card(self) -> None:
        """Show no path."""
        self._at = self._card = None
        self._asked += 1
        if self.state.get("card") is not None:
            self.state.send(card=None, over=None)

    def follow(self, figures: Figures) -> None:
        """Keep the path where it belongs as the camera moves, and its samples as they are drawn."""
        if self._card is None:
            return
        if figures.sharp:
            self.show_path(self._at)
        else:
            self.follow_camera()

    def follow_camera(self) -> None:
        """Keep the path where it belongs as the camera moves."""
        if self._card is not None:
            self.state.send(over=self._over())

    def _over(self) -> dict[str, Any] | None:
        if self._card is None:
            return None
        navigator, panes = self.scene.navigator, len(self.scene.panes)
        return {**self._card.over(navigator), "panes": panes, "aspect": navigator.aspect}

    def close(self) -> None:
        """End what goes on."""
        self._at = self._card = None
        if self._later is not None:
            self._later.cancel()
        if self._reading is not None:
            self._reading.cancel()
        self._worker.shutdown(wait=False, cancel_futures=True)


def _is_pair(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 2
