"""Pictures of a pane: a quick one for motion, and the full one a tile at a time.

The quick one is the full picture where that is fast enough. Otherwise, when only the camera
moved over a flat surface, it is the last full picture moved to its new place, and else a draft of
fewer pixels and samples.
"""

from __future__ import annotations

import math
import time
from collections.abc import Generator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from flowtex.app.streaming.canvas import Rect
from flowtex.app.streaming.pane import Pane
from flowtex.app.streaming.quality import Cost, Quality
from flowtex.app.streaming.warp import Shot, coverage, shifted, warp

__all__ = ["Painter"]

Pixels = NDArray[np.uint8]

#: A picture that was drawn serves a moved view while its pixels grow less, or shrink less, than
#: this; beyond it a draft tells more.
STRETCH, SHRINK = 4.0, 0.3
#: A draft that lies beneath a moved picture shows this many times its width, so that it serves
#: for some way.
WIDER = 1.7


class Painter:
    """Draws a pane as well as the time allows.

    Parameters
    ----------
    pane
        What is drawn.
    cost
        What pictures cost here, where it is known; learnt from the pictures.

    Attributes
    ----------
    pane
        What is drawn.
    cost
        What pictures cost here.
    complete
        Whether the last picture that was drawn is at full quality.
    drafting
        Whether a setting is changed for the moment, for a draft.
    """

    def __init__(self, pane: Pane, cost: Cost | None = None) -> None:
        self.pane = pane
        self.cost = cost or Cost()
        self.complete = False
        self.drafting = False
        self._shot: Shot | None = None
        self._under: Shot | None = None
        self._last: Pixels | None = None
        self._state = 0

    def forget(self) -> None:
        """Draw anew: what was drawn does not show the present state any more."""
        self._shot = self._under = None
        self.complete = False
        self._state += 1

    @property
    def _samples(self) -> int:
        return self.pane.handle.settings.samples

    def quick(self, budget: float) -> Pixels:
        """Return a picture within about ``budget`` seconds, (h, w, 3) uint8."""
        self._last = self._quick(budget)
        return self._last

    def _quick(self, budget: float) -> Pixels:
        width, height = self.pane.size
        quality = self.cost.choose(width * height, self._samples, budget)
        view = self.pane.plane_view()
        self.complete = quality.scale >= 1.0 and quality.samples == self._samples
        if self.complete:
            pixels = self._draw(width, height)
            self._shot = None if view is None else Shot(pixels, view, sharp=True)
            return pixels
        if self._shot is not None and view is not None:
            share, stretch = coverage(self._shot, view)
            if SHRINK <= stretch <= STRETCH and share > 0.2:
                under = None if share >= 1.0 else self._beneath(view, quality)
                return warp(self._shot, view, (width, height), under)
        return self._draft(quality)

    def _beneath(self, view: NDArray[np.float64], quality: Quality) -> Shot:
        """Return a draft that covers the view and what lies around it."""
        if self._under is not None:
            share, stretch = coverage(self._under, view)
            if share >= 1.0 and stretch < STRETCH / quality.scale:
                return self._under
        width, height = self.pane.size
        around = (round(width * (1 - WIDER) / 2), round(height * (1 - WIDER) / 2))
        part = (*around, width - 2 * around[0], height - 2 * around[1])
        wider = np.diag([width / part[2], height / part[3], 1.0]) @ view
        self._under = Shot(self._draft(quality, part), wider)
        return self._under

    def full(self) -> Generator[Pixels, None, None]:
        """Draw the full picture over the quick one, a tile at a time.

        Yields
        ------
        numpy.ndarray
            The picture so far, (H, W, 3) uint8, after each tile. The array is the same one each
            time. Between two tiles the pane may be left for good, and the drawing given up.
        """
        width, height = self.pane.size
        view, state = self.pane.plane_view(), self._state
        begun = self.quick(0.0) if self._last is None else self._last
        canvas = self._enlarged(begun, width, height)
        kept = self._keep(canvas, view)
        wanted = [(0, 0, width, height)] if kept is None else _around(kept, width, height)
        spent, drawn, complete = 0.0, 0, False
        try:
            for left, top, wide, high in self._tiles(wanted, width, height):
                started = time.perf_counter()
                tile = self.pane.draw(wide, high, (left, top, wide, high))
                canvas[top : top + high, left : left + wide] = tile
                spent += time.perf_counter() - started
                drawn += wide * high
                yield canvas
            if not drawn:
                yield canvas
            self.complete = complete = state == self._state
            # All tiles together: one at the rim of the surface may be empty and cost nothing.
            if kept is None:
                self.cost.learn(spent, drawn, self._samples)
        finally:
            # Half of a full picture serves a moved view better than none, but not than a sharp one.
            if view is not None and state == self._state and (complete or kept is None):
                self._shot = Shot(canvas.copy(), view, sharp=complete)

    def _keep(self, canvas: Pixels, view: NDArray[np.float64] | None) -> Rect | None:
        """Put what is sharp already in its new place; return the rectangle that it fills.

        A drag over a flat surface shifts the picture by whole pixels, and most of it stays.
        """
        if view is None or self._shot is None or not self._shot.sharp:
            return None
        if self._shot.pixels.shape != canvas.shape or (by := shifted(self._shot, view)) is None:
            return None
        height, width = canvas.shape[:2]
        left, top = max(by[0], 0), max(by[1], 0)
        wide, high = width - abs(by[0]), height - abs(by[1])
        x, y = max(-by[0], 0), max(-by[1], 0)
        canvas[top : top + high, left : left + wide] = self._shot.pixels[y : y + high, x : x + wide]
        return left, top, wide, high

    def _tiles(self, areas: list[Rect], width: int, height: int) -> list[Rect]:
        """Tiles of about the same size, from the middle of the view outwards."""
        side = self.cost.tile(self._samples)
        tiles = []
        for left, top, wide, high in areas:
            xs, ys = _cuts(left, wide, side), _cuts(top, high, side)
            tiles += [
                (x, y, right - x, below - y)
                for y, below in pairwise(ys)
                for x, right in pairwise(xs)
            ]

        def far(tile: Rect) -> float:
            left, top, wide, high = tile
            return math.hypot(left + wide / 2 - width / 2, top + high / 2 - height / 2)

        return sorted(tiles, key=far)

    def _draft(self, quality: Quality, part: Rect | None = None) -> Pixels:
        width, height = self.pane.size
        settings = self.pane.handle.settings
        self.drafting = True
        chosen, settings.samples = settings.samples, quality.samples
        try:
            return self._draw(
                max(round(width * quality.scale), 16), max(round(height * quality.scale), 16), part
            )
        finally:
            settings.samples = chosen
            self.drafting = False

    def _draw(self, width: int, height: int, part: Rect | None = None) -> Pixels:
        started = time.perf_counter()
        pixels = self.pane.draw(width, height, part)
        self.cost.learn(time.perf_counter() - started, width * height, self._samples)
        return pixels

    @staticmethod
    def _enlarged(pixels: Pixels, width: int, height: int) -> Pixels:
        if pixels.shape[:2] == (height, width):
            return pixels.copy()
        from PIL import Image

        smooth = Image.Resampling.BILINEAR
        return np.array(Image.fromarray(pixels).resize((width, height), smooth))


def _around(kept: Rect, width: int, height: int) -> list[Rect]:
    """Rectangles that a picture has besides one that reaches to two of its borders."""
    left, top, wide, high = kept
    above = (0, 0, width, top) if top else (0, high, width, height - high)
    beside = (0, top, left, high) if left else (wide, top, width - wide, high)
    return [area for area in (above, beside) if area[2] > 0 and area[3] > 0]


def _cuts(start: int, length: int, side: int) -> list[int]:
    """Places at which to cut a length into parts of about one size; even distances but the last.

    Derivatives are taken in blocks of 2 x 2 pixels.
    """
    count = math.ceil(length / side)
    return [start + 2 * round(length * n / count / 2) for n in range(count)] + [start + length]
