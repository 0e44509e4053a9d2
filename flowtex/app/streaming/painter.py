"""Pictures of a viewport: drafts in motion where the processor draws, full ones at rest.

A graphics card draws everything at full quality at once. A processor takes too long for that, so
what moves is a draft of fewer pixels and samples, over which the full picture is drawn a tile at a
time.
"""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from flowtex._util.array_types import Bytes
from flowtex.app.server.validation import clipped
from flowtex.app.streaming.viewport import GAP_PX, Pane, Rect, Viewport
from flowtex.rendering.diagnostics import opengl_report

#: Pixels of a picture, at most: a screen of 2,560 x 1,600.
MOST_PIXELS = 4_100_000
#: Sides of a picture in pixels, and pixels for one of CSS, at least and at most.
SIDES_PX, PIXEL_RATIOS = (16.0, 8192.0), (0.25, 8.0)
#: Pixels and samples of a draft, at most: a processor draws it in about a fifteenth of a second.
#: Its pixels are larger, so its streaks are as long with fewer samples.
DRAFT_PIXELS, DRAFT_SAMPLES = 80_000, 9
#: About the side in pixels of a tile, which a processor draws in about a tenth of a second.
TILE_PX = 224
#: Grey of the line between two panes.
LINE_GREY = 128


def view_pixels(size: Mapping[str, Any]) -> tuple[int, int]:
    """Return the size in pixels of a view of CSS pixels ``w``, ``h`` times ``p``."""
    ratio = clipped(size.get("p"), 1.0, *PIXEL_RATIOS)
    width, height = (
        min(max(clipped(size.get(side), SIDES_PX[0], *SIDES_PX) * ratio, SIDES_PX[0]), SIDES_PX[1])
        for side in ("w", "h")
    )
    shrink = min(1.0, (MOST_PIXELS / (width * height)) ** 0.5)
    return round(width * shrink), round(height * shrink)


class ViewPainter:
    """Draws all panes of a viewport, which may come and go."""

    def __init__(self, viewport: Viewport) -> None:
        self._viewport = viewport
        self.slow = opengl_report().software  #: Whether drafts are drawn in motion.
        self.complete = False  #: Whether the last picture that was drawn is at full quality.
        self.drafting = False  #: Whether a setting is changed for the moment, for a draft.
        self._last: list[Bytes] = []
        self._state = 0

    def forget(self) -> None:
        """Discard the drawn picture, which no longer shows the present state."""
        self.complete = False
        self._state += 1

    def quick(self) -> Bytes:
        """Return a picture as good as there is time for in motion, (h, w, 3) uint8."""
        panes = self._viewport.panes
        self.complete = True
        self._last = [self._quick(pane, DRAFT_PIXELS / len(panes)) for pane in panes]
        return self._joined(self._last)

    def _quick(self, pane: Pane, most: float) -> Bytes:
        width, height = pane.size
        settings = pane.handle.settings
        scale = min(math.sqrt(most / max(width * height, 1)), 1.0)
        if not self.slow or (scale == 1.0 and settings.samples <= DRAFT_SAMPLES):
            return pane.draw(width, height)
        self.complete = False
        self.drafting = True
        chosen, settings.samples = settings.samples, min(DRAFT_SAMPLES, settings.samples)
        try:
            return pane.draw(max(round(width * scale), 16), max(round(height * scale), 16))
        finally:
            settings.samples = chosen
            self.drafting = False

    def full(self) -> Generator[Bytes, None, None]:
        """Draw the full picture over the quick one; yield it after each tile, to cancel there."""
        state, panes = self._state, list(self._viewport.panes)
        if len(self._last) != len(panes):
            self.quick()
        pairs = zip(self._last, panes, strict=True)
        canvases = [_resized(last, *pane.size).copy() for last, pane in pairs]
        for canvas, pane in zip(canvases, panes, strict=True):
            for left, top, wide, high in _tiles(canvas.shape[1], canvas.shape[0]):
                tile = pane.draw(wide, high, (left, top, wide, high))
                canvas[top : top + high, left : left + wide] = tile
                yield self._joined(canvases)
        self.complete = state == self._state

    def _joined(self, pictures: list[Bytes]) -> Bytes:
        """Put pictures side by side, a line between them."""
        if len(pictures) == 1:
            return pictures[0]
        height, width = (max(p.shape[axis] for p in pictures) for axis in (0, 1))
        gap = max(round(GAP_PX * width / self._viewport.pane_size[0]), 1)
        joined = np.full((height, len(pictures) * (width + gap) - gap, 3), LINE_GREY, np.uint8)
        for number, picture in enumerate(pictures):
            left = number * (width + gap)
            joined[:, left : left + width] = _resized(picture, width, height)
        return joined


def _tiles(width: int, height: int) -> list[Rect]:
    """Return tiles of about the same size, from the middle of the view outwards."""
    tiles = [
        (x, y, right - x, below - y)
        for y, below in pairwise(_cuts(height, TILE_PX))
        for x, right in pairwise(_cuts(width, TILE_PX))
    ]

    def distance(tile: Rect) -> float:
        left, top, wide, high = tile
        return math.hypot(left + wide / 2 - width / 2, top + high / 2 - height / 2)

    return sorted(tiles, key=distance)


def _resized(pixels: Bytes, width: int, height: int) -> Bytes:
    if pixels.shape[:2] == (height, width):
        return pixels
    from PIL import Image

    smooth = Image.Resampling.BILINEAR
    return np.asarray(Image.fromarray(pixels).resize((width, height), smooth))


def _cuts(length: int, side: int) -> list[int]:
    """Return the ends of about equal parts, even, as derivatives need 2 x 2 pixels."""
    count = math.ceil(length / side)
    return [2 * round(length * n / count / 2) for n in range(count)] + [length]
