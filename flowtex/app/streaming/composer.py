"""The whole picture: that of one pane, or those of two beside each other."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from flowtex.app.streaming.painter import Painter, Pixels
from flowtex.app.streaming.scene import GAP, Scene

__all__ = ["Composer"]

#: Grey of the line between two panes.
LINE = 128


class Composer:
    """Draws all panes of a scene, as well as the time allows.

    Parameters
    ----------
    scene
        What is drawn; its panes may come and go.

    Attributes
    ----------
    painters
        What draws each pane.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self.painters: list[Painter] = []
        self._follow()

    @property
    def complete(self) -> bool:
        """Whether the last picture that was drawn is at full quality."""
        return all(painter.complete for painter in self._follow())

    @property
    def drafting(self) -> bool:
        """Whether a setting is changed for the moment, for a draft."""
        return any(painter.drafting for painter in self.painters)

    def forget(self) -> None:
        """Draw anew: what was drawn does not show the present state any more."""
        for painter in self._follow():
            painter.forget()

    def quick(self, budget: float) -> Pixels:
        """Return a picture within about ``budget`` seconds, (h, w, 3) uint8."""
        painters = self._follow()
        return self._joined([painter.quick(budget / len(painters)) for painter in painters])

    def full(self) -> Generator[Pixels, None, None]:
        """Draw the full picture over the quick one, as :meth:`Painter.full` does."""
        painters = self._follow()
        if len(painters) == 1:
            yield from painters[0].full()
            return
        drawing = {number: painter.full() for number, painter in enumerate(painters)}
        shown: dict[int, Pixels] = {}
        try:
            while drawing:
                for number, tiles in list(drawing.items()):
                    found = next(tiles, None)
                    if found is None:
                        del drawing[number]
                    else:
                        shown[number] = found
                yield self._joined([shown[number] for number in sorted(shown)])
        finally:
            for tiles in drawing.values():
                tiles.close()

    def _follow(self) -> list[Painter]:
        """Painters of the panes that there are; what one has learnt of its price stays."""
        panes = self._scene.panes
        if [painter.pane for painter in self.painters] != panes:
            known = {id(painter.pane): painter for painter in self.painters}
            cost = self.painters[0].cost if self.painters else None
            self.painters = [known.get(id(pane)) or Painter(pane, cost) for pane in panes]
        return self.painters

    def _joined(self, pictures: list[Pixels]) -> Pixels:
        """Put pictures beside each other, a line between them."""
        if len(pictures) == 1:
            return pictures[0]
        from PIL import Image

        height, width = (max(p.shape[axis] for p in pictures) for axis in (0, 1))
        gap = max(round(GAP * width / self._scene.pane_size[0]), 1)
        joined = np.full((height, len(pictures) * (width + gap) - gap, 3), LINE, np.uint8)
        for number, picture in enumerate(pictures):
            if picture.shape[:2] != (height, width):
                smooth = Image.Resampling.BILINEAR
                picture = np.asarray(Image.fromarray(picture).resize((width, height), smooth))
            left = number * (width + gap)
            joined[:, left : left + width] = picture
        return joined
