"""Pictures of a viewport as good as the time allows: quick ones in motion, the full one at rest.

A texture costs time for each pixel and each sample. :class:`Cost` learns that price from the
drawn pictures, so a graphics card draws everything at full quality at once. Where that is too slow,
as on a processor, the quick picture is a draft of fewer pixels and samples; the full picture is
drawn over it a tile at a time.
"""

from __future__ import annotations

import math
import time
from collections.abc import Generator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from flowtex._util.array_types import Bytes
from flowtex.app.server.validation import clipped
from flowtex.app.streaming.viewport import GAP_PX, Pane, Rect, Viewport

#: Seconds that a picture may take in motion, while playing, and for one tile at rest.
MOVING_S, PLAYING_S, TILE_S = 0.06, 0.14, 0.1
#: Seconds that any picture takes, and the cost of a pixel in addition to its samples, in samples.
FIXED_S, BASE_SAMPLES = 0.006, 8
#: Seconds for one sample of one pixel: a guess until the first picture.
FIRST_PRICE_S = 4e-8
#: Pixels of a picture, at most: a screen of 2,560 x 1,600.
MOST_PIXELS = 4_100_000
#: Sides of a picture in pixels, and pixels for one of CSS, at least and at most.
SIDES_PX, PIXEL_RATIOS = (16.0, 8192.0), (0.25, 8.0)
#: Samples of a draft. Its pixels are larger, so its streaks are as long with fewer samples.
DRAFT_SAMPLES = 9
#: A draft is never smaller than this share of the view's width.
COARSEST_DRAFT = 0.2
#: A tile is never smaller than this, in pixels along a side.
SMALLEST_TILE_PX = 64
#: Grey of the line between two panes.
LINE_GREY = 128


@dataclass(frozen=True)
class Quality:
    """Size of a picture, as a share of the view's width, and samples for each pixel."""

    scale: float
    samples: int


class Cost:
    """Price of a picture, learnt from those that were drawn."""

    def __init__(self) -> None:
        self._price = FIRST_PRICE_S

    def learn(self, seconds: float, pixels: int, samples: int) -> None:
        """Update the price from a picture that took ``seconds``."""
        price = max(seconds - FIXED_S, 1e-5) / max(pixels * (samples + BASE_SAMPLES), 1)
        # A slower measurement counts at once, a faster one gradually: users notice a late picture.
        self._price += (price - self._price) * (0.7 if price > self._price else 0.3)

    def seconds(self, pixels: float, samples: int) -> float:
        """Return the time that a picture will take."""
        return FIXED_S + self._price * pixels * (samples + BASE_SAMPLES)

    def choose(self, pixels: int, samples: int, budget: float) -> Quality:
        """Return the best quality within ``budget`` seconds, at most all pixels and samples."""
        if self.seconds(pixels, samples) <= budget:
            return Quality(1.0, samples)
        fewer = min(DRAFT_SAMPLES, samples)
        room = max(budget - FIXED_S, 1e-3) / (self._price * (fewer + BASE_SAMPLES))
        scale = math.sqrt(room / max(pixels, 1))
        return Quality(min(max(scale, COARSEST_DRAFT), 1.0), fewer)

    def tile(self, samples: int, budget: float = TILE_S) -> int:
        """Return the side in pixels of a square tile that takes ``budget`` seconds at most."""
        side = math.sqrt((budget - FIXED_S) / (self._price * (samples + BASE_SAMPLES)))
        # An even number keeps the 2 x 2 blocks in which derivatives are taken.
        return max(int(side) // 2 * 2, SMALLEST_TILE_PX)


def view_pixels(size: Mapping[str, Any]) -> tuple[int, int]:
    """Return the size in pixels of a view of CSS pixels ``w``, ``h`` times ``p``."""
    ratio = clipped(size.get("p"), 1.0, *PIXEL_RATIOS)
    width, height = (
        min(max(clipped(size.get(side), SIDES_PX[0], *SIDES_PX) * ratio, SIDES_PX[0]), SIDES_PX[1])
        for side in ("w", "h")
    )
    shrink = min(1.0, (MOST_PIXELS / (width * height)) ** 0.5)
    return round(width * shrink), round(height * shrink)


class PanePainter:
    """Draws a pane as well as the time allows."""

    def __init__(self, pane: Pane, cost: Cost | None = None) -> None:
        self.pane = pane
        self.cost = cost or Cost()  #: Price of pictures, learnt from them.
        self.complete = False  #: Whether the last picture that was drawn is at full quality.
        self.drafting = False  #: Whether a setting is changed for the moment, for a draft.
        self._last: Bytes | None = None
        self._state = 0

    def forget(self) -> None:
        """Discard the drawn picture, which no longer shows the present state."""
        self.complete = False
        self._state += 1

    @property
    def _samples(self) -> int:
        return self.pane.handle.settings.samples

    def quick(self, budget: float) -> Bytes:
        """Return a picture within about ``budget`` seconds, (h, w, 3) uint8."""
        width, height = self.pane.size
        quality = self.cost.choose(width * height, self._samples, budget)
        self.complete = quality.scale >= 1.0 and quality.samples == self._samples
        self._last = self._draw(width, height) if self.complete else self._draft(quality)
        return self._last

    def full(self) -> Generator[Bytes, None, None]:
        """Draw the full picture over the quick one; yield the picture after each tile.

        The array is the same one each time. Drawing may be cancelled between two tiles.
        """
        width, height = self.pane.size
        state, spent = self._state, 0.0
        start = self.quick(0.0) if self._last is None else self._last
        canvas = _resized(start, width, height).copy()
        for left, top, wide, high in self._tiles(width, height):
            started = time.perf_counter()
            tile = self.pane.draw(wide, high, (left, top, wide, high))
            canvas[top : top + high, left : left + wide] = tile
            spent += time.perf_counter() - started
            yield canvas
        self.complete = state == self._state
        # For all tiles together, as one beside the surface is empty and costs nothing.
        self.cost.learn(spent, width * height, self._samples)

    def _tiles(self, width: int, height: int) -> list[Rect]:
        """Return tiles of about the same size, from the middle of the view outwards."""
        side = self.cost.tile(self._samples)
        tiles = [
            (x, y, right - x, below - y)
            for y, below in pairwise(_cuts(height, side))
            for x, right in pairwise(_cuts(width, side))
        ]

        def distance(tile: Rect) -> float:
            left, top, wide, high = tile
            return math.hypot(left + wide / 2 - width / 2, top + high / 2 - height / 2)

        return sorted(tiles, key=distance)

    def _draft(self, quality: Quality) -> Bytes:
        width, height = self.pane.size
        settings = self.pane.handle.settings
        self.drafting = True
        chosen, settings.samples = settings.samples, quality.samples
        try:
            return self._draw(*(max(round(side * quality.scale), 16) for side in (width, height)))
        finally:
            settings.samples = chosen
            self.drafting = False

    def _draw(self, width: int, height: int) -> Bytes:
        started = time.perf_counter()
        pixels = self.pane.draw(width, height)
        self.cost.learn(time.perf_counter() - started, width * height, self._samples)
        return pixels


def _resized(pixels: Bytes, width: int, height: int) -> Bytes:
    if pixels.shape[:2] == (height, width):
        return pixels
    from PIL import Image

    smooth = Image.Resampling.BILINEAR
    return np.asarray(Image.fromarray(pixels).resize((width, height), smooth))


def _cuts(length: int, side: int) -> list[int]:
    """Return the ends of parts of about equal length, even numbers except the last.

    Derivatives are taken in blocks of 2 x 2 pixels.
    """
    count = math.ceil(length / side)
    return [2 * round(length * n / count / 2) for n in range(count)] + [length]


class ViewPainter:
    """Draws all panes of a viewport, which may come and go, as well as the time allows."""

    def __init__(self, viewport: Viewport) -> None:
        self._viewport = viewport
        self.painters: list[PanePainter] = []
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
        """Discard the drawn pictures, which no longer show the present state."""
        for painter in self._follow():
            painter.forget()

    def quick(self, budget: float) -> Bytes:
        """Return a picture within about ``budget`` seconds, (h, w, 3) uint8."""
        painters = self._follow()
        return self._joined([painter.quick(budget / len(painters)) for painter in painters])

    def full(self) -> Generator[Bytes, None, None]:
        """Draw the full picture over the quick one, as :meth:`PanePainter.full` does."""
        painters = self._follow()
        if len(painters) == 1:
            yield from painters[0].full()
            return
        drawing = {number: painter.full() for number, painter in enumerate(painters)}
        pictures: dict[int, Bytes] = {}
        try:
            while drawing:
                for number, tiles in list(drawing.items()):
                    picture = next(tiles, None)
                    if picture is None:
                        del drawing[number]
                    else:
                        pictures[number] = picture
                yield self._joined([pictures[number] for number in sorted(pictures)])
        finally:
            for tiles in drawing.values():
                tiles.close()

    def _follow(self) -> list[PanePainter]:
        """Return the painters of the present panes; the price that was learnt stays."""
        panes = self._viewport.panes
        if [painter.pane for painter in self.painters] != panes:
            painters = {id(painter.pane): painter for painter in self.painters}
            cost = self.painters[0].cost if self.painters else None
            self.painters = [painters.get(id(pane)) or PanePainter(pane, cost) for pane in panes]
        return self.painters

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
