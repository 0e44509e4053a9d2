"""Reading the picture: a tip under the pointer, and the path through a point that was clicked."""

from __future__ import annotations

import asyncio
import time
from typing import Any

from flowtex.app.part import Part
from flowtex.app.places import camera_of
from flowtex.app.pointer import Place
from flowtex.app.reading import Hover, PathCard
from flowtex.app.stream import Figures
from flowtex.probe import probe

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

    def _made_hover(self) -> Hover:
        return Hover(self.scene.handle.view, self.scene.navigator, self.scene.hit)

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
        if isinstance(place, list) and len(place) == 2:
            x, y = place
            if isinstance(x, (int, float)) and isinstance(y, (int, float)):
                self.point((float(x), float(y)))
                return
        self.point(None)

    def take_point(self, index: Any) -> None:
        """Show the path through a point that the browser's client tells, (i, j)."""
        rows, columns = self.scene.field.shape
        if isinstance(index, list) and len(index) == 2:
            i, j = index
            numbers = isinstance(i, (int, float)) and isinstance(j, (int, float))
            if numbers and 0 <= i <= columns - 1 and 0 <= j <= rows - 1:
                self.show_path((float(j), float(i)))

    def show_path(self, at: tuple[float, float] | None) -> None:
        """Show the path through a point (j, i) of the surface."""
        self._at = at
        if at is None:
            self.close_card()
            return
        try:
            read = probe(
                self.scene.handle.view,
                at,
                pixel=camera_of(self.scene.navigator, self.scene.pane_size),
                clock=self.scene.clock,
            )
        except ValueError:  # it is not in view
            self.close_card()
            return
        self._card = PathCard(read)
        told = {"lines": [list(line) for line in self._card.lines()], "bars": self._card.bars()}
        self.state.send(card=told, over=self._over())

    def close_card(self) -> None:
        """Show no path."""
        self._at = self._card = None
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
        return {**self._card.over(self.scene.navigator), "panes": len(self.scene.panes)}

    def close(self) -> None:
        """End what goes on."""
        if self._later is not None:
            self._later.cancel()
