"""How well a picture can be drawn in the time that there is.

A texture costs time for each pixel and each sample. :class:`Cost` learns that price from the
pictures that were drawn, so a graphics card draws everything at its best at once, while a
processor draws a coarse picture in motion and the full one, in tiles, at rest.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from flowtex.app.server.untrusted import clipped

__all__ = ["MOVING", "PLAYING", "TILE", "Cost", "Quality", "view_pixels"]

#: Seconds that a picture may take in motion, while playing, and for one tile at rest.
MOVING, PLAYING, TILE = 0.06, 0.14, 0.1

#: Seconds that a picture takes however small it is, and what a pixel costs beside its samples,
#: in samples.
FIXED, BASE = 0.006, 8

#: Pixels of a picture, at most: a screen of 2,560 x 1,600.
MOST_PIXELS = 4_100_000
#: Sides of a picture in pixels, and pixels for one of CSS, at least and at most.
SIDES, RATIOS = (16.0, 8192.0), (0.25, 8.0)
#: Samples of a draft. Its pixels are larger, so its streaks are as long with fewer samples.
DRAFT = 9
#: A draft is never smaller than this share of the view's width.
COARSEST = 0.2
#: A tile is never smaller than this, in pixels along a side.
SMALLEST_TILE = 64


@dataclass(frozen=True)
class Quality:
    """Size of a picture, as a share of the view's width, and samples for each pixel."""

    scale: float
    samples: int


class Cost:
    """Price of a picture, learnt from those that were drawn."""

    def __init__(self) -> None:
        self._price = 4e-8  # seconds for one sample of one pixel: a guess until the first picture

    def learn(self, seconds: float, pixels: int, samples: int) -> None:
        """Take account of a picture that took ``seconds``."""
        price = max(seconds - FIXED, 1e-5) / max(pixels * (samples + BASE), 1)
        # Slower is believed at once, faster by and by: a picture that is late is felt.
        self._price += (price - self._price) * (0.7 if price > self._price else 0.3)

    def seconds(self, pixels: float, samples: int) -> float:
        """Time that a picture will take."""
        return FIXED + self._price * pixels * (samples + BASE)

    def choose(self, pixels: int, samples: int, budget: float) -> Quality:
        """Return the best quality that can be had within ``budget`` seconds.

        Parameters
        ----------
        pixels
            Pixels of the whole view.
        samples
            Samples at full quality.
        budget
            Seconds.
        """
        if self.seconds(pixels, samples) <= budget:
            return Quality(1.0, samples)
        fewer = min(DRAFT, samples)
        room = max(budget - FIXED, 1e-3) / (self._price * (fewer + BASE))
        scale = math.sqrt(room / max(pixels, 1))
        return Quality(min(max(scale, COARSEST), 1.0), fewer)

    def tile(self, samples: int) -> int:
        """Side of a square tile, in pixels, that takes no longer than a tile may."""
        side = math.sqrt((TILE - FIXED) / (self._price * (samples + BASE)))
        # An even number keeps the 2 x 2 blocks in which derivatives are taken.
        return max(int(side) // 2 * 2, SMALLEST_TILE)


def view_pixels(size: Mapping[str, Any]) -> tuple[int, int]:
    """Width and height in pixels of a view of so many CSS pixels ``w``, ``h`` times ``p``."""
    ratio = clipped(size.get("p"), 1.0, *RATIOS)
    width, height = (
        min(max(clipped(size.get(side), SIDES[0], *SIDES) * ratio, SIDES[0]), SIDES[1])
        for side in ("w", "h")
    )
    shrink = min(1.0, (MOST_PIXELS / (width * height)) ** 0.5)
    return round(width * shrink), round(height * shrink)
