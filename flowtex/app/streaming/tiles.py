"""A picture of a scene of any size, drawn a tile at a time through a small window.

The window is as large as a tile, however large the picture. What it shows of the view is given in
pixels of the window, with fractions, as though the whole picture had its height.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import cast

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.pane import Pane
from flowtex.app.streaming.quality import Cost
from flowtex.app.streaming.scene import GAP, Rect, Scene

__all__ = ["Sheet"]

Pixels = NDArray[np.uint8]

#: Seconds that a tile may take, and its sides in pixels.
TILE, SMALLEST, LARGEST = 0.05, 32, 512
#: Grey of the line between two panes.
LINE = 128


class Sheet:
    """Draws pictures of one size.

    Parameters
    ----------
    scene
        What is drawn; its window is taken for the tiles.
    size
        Width and height of the picture in pixels.
    density
        Pixels of the picture for one that the settings speak of.
    supersampling
        Pixels that are drawn, along each side, for one of the picture.
    """

    def __init__(
        self,
        scene: Scene,
        size: tuple[int, int],
        *,
        density: float = 1.0,
        supersampling: int = 1,
    ) -> None:
        self.size, self._scene, self._times = size, scene, supersampling
        self._cost = Cost()
        self._side = SMALLEST
        count = len(scene.panes)
        self._gap = 0 if count == 1 else max(round(GAP * density), 1)
        scene.resize(count * LARGEST + (count - 1) * GAP, LARGEST)
        for pane in scene.panes:
            pane.handle.density = density * supersampling

    def draw(self) -> Iterator[tuple[Pixels, float]]:
        """Draw a picture.

        Yields
        ------
        numpy.ndarray, float
            The picture so far, (height, width, 3) uint8, and the share of it that is drawn, after
            each tile. The array is the same one each time.
        """
        width, height = self.size
        canvas = np.full((height, width, 3), LINE, np.uint8)
        count = len(self._scene.panes)
        wide = (width - (count - 1) * self._gap) // count
        done = 0
        for number, pane in enumerate(self._scene.panes):
            first = number * (wide + self._gap)
            here = wide if number < count - 1 else width - first
            for rows, columns in self._tiles(here, height):
                tile = self._tile(pane, (here, height), rows, columns)
                canvas[rows, first + columns.start : first + columns.stop] = tile
                done += tile.shape[0] * tile.shape[1]
                yield canvas, done / (width * height)

    def _tiles(self, width: int, height: int) -> Iterator[tuple[slice, slice]]:
        """Rows of tiles that are as large as the time allows by then."""
        top = 0
        while top < height:
            side = max(self._side // self._times, 1)
            bottom = min(top + side, height)
            for left in range(0, width, side):
                yield slice(top, bottom), slice(left, min(left + side, width))
            top = bottom

    def _tile(self, pane: Pane, whole: tuple[int, int], rows: slice, columns: slice) -> Pixels:
        wide, high = columns.stop - columns.start, rows.stop - rows.start
        shrink = LARGEST / whole[1]
        part = (
            LARGEST / 2 + (columns.start - whole[0] / 2) * shrink,
            rows.start * shrink,
            wide * shrink,
            high * shrink,
        )
        started = time.perf_counter()
        # Fractions are what a picture larger than its window needs.
        drawn = pane.draw(wide * self._times, high * self._times, cast("Rect", part))
        samples = pane.handle.settings.samples
        self._cost.learn(time.perf_counter() - started, drawn.shape[0] * drawn.shape[1], samples)
        self._side = self._affordable(samples)
        return _averaged(drawn, self._times)

    def _affordable(self, samples: int) -> int:
        """Side of a tile, in pixels that are drawn, that takes no longer than it may."""
        side = SMALLEST
        while side < LARGEST and self._cost.seconds(4.0 * side * side, samples) < TILE:
            side *= 2
        return side


def _averaged(drawn: Pixels, times: int) -> Pixels:
    """Take the mean of every so many pixels along each side."""
    if times == 1:
        return drawn
    from PIL import Image

    return np.asarray(Image.fromarray(drawn).reduce(times))
