"""GIF and animated WebP, written by Pillow.

Pillow wants all pictures at once: until then they wait in a temporary file on the disk.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import IO, Any

import numpy as np

from flowtex._util.progress import Stopped
from flowtex.offscreen.encoders.writer import MovieWriter, Pixels, Size
from flowtex.offscreen.moments import MovieError

__all__ = ["GIFWriter", "WebPWriter"]

#: Pixels of all the pictures of a movie, at most.
MOST_PIXELS = 1_000_000_000
#: Browsers slow down a GIF that shows a picture for less than two hundredths of a second.
FASTEST_GIF = 50.0
#: Pictures of which a palette is made, and about how many pixels of each along a side.
PALETTE_PICTURES, PALETTE_SIDE = 8, 256


class PillowWriter(MovieWriter):
    """Keeps pictures on the disk until Pillow writes them."""

    def _begin(self, part: Path) -> None:
        self._part = part
        self._count = 0
        self._kept: IO[bytes] = tempfile.TemporaryFile()  # noqa: SIM115 closed by _close

    def _add(self, picture: Pixels) -> None:
        if (self._count + 1) * picture.shape[0] * picture.shape[1] > MOST_PIXELS:
            kind = self._part.suffix[1:].upper()
            msg = f"a {kind} takes at most {MOST_PIXELS:,} pixels in all; write an MP4, or less"
            raise MovieError(msg)
        self._kept.write(np.ascontiguousarray(picture).tobytes())
        self._count += 1

    def _close(self) -> None:
        self._kept.close()

    def _picture(self, number: int) -> Any:
        from PIL import Image

        width, height = self._size
        self._kept.seek(number * width * height * 3)
        return Image.frombytes("RGB", self._size, self._kept.read(width * height * 3))

    def _pictures(self, unwanted: Callable[[], bool]) -> Iterator[Any]:
        for number in range(self._count):
            if unwanted():
                raise Stopped
            yield self._picture(number)

    def _durations(self, unit: int) -> list[int]:
        """Milliseconds of each picture, in whole units, whose sum is that of the movie."""
        ends = [round(1000 * n / self._fps / unit) * unit for n in range(self._count + 1)]
        return [after - before for before, after in pairwise(ends)]

    def _save(self, pictures: Iterator[Any], unit: int, **options: Any) -> None:
        first = next(pictures)
        durations = self._durations(unit)
        first.save(
            self._part,
            save_all=True,
            append_images=pictures,
            duration=durations if len(durations) > 1 else durations[0],
            loop=0,
            **options,
        )
        self._close()


class GIFWriter(PillowWriter):
    """Writes a GIF whose pictures share one palette, without dithering: nothing flickers."""

    @classmethod
    def fault(cls, size: Size, fps: float) -> str:
        """Say why such a movie cannot be written."""
        if fps > FASTEST_GIF:
            return f"fps is {fps:g}; a GIF shows at most {FASTEST_GIF:g} a second, an MP4 more"
        return super().fault(size, fps)

    def _finish(self, unwanted: Callable[[], bool]) -> None:
        from PIL import Image

        palette, plain = self._palette(), Image.Dither.NONE
        pictures = (p.quantize(palette=palette, dither=plain) for p in self._pictures(unwanted))
        self._save(pictures, unit=10, optimize=False, disposal=1)

    def _palette(self) -> Any:
        """Make one palette of pictures from the whole movie, seen coarsely."""
        from PIL import Image

        chosen = np.linspace(0, self._count - 1, min(self._count, PALETTE_PICTURES)).round()
        step = max(min(self._size) // PALETTE_SIDE, 1)
        seen = [np.asarray(self._picture(int(n)))[::step, ::step] for n in chosen]
        colours = max(round(256 * self._quality / 100), 2)
        return Image.fromarray(np.vstack(seen)).quantize(
            colours, Image.Quantize.MEDIANCUT, kmeans=2, dither=Image.Dither.NONE
        )


class WebPWriter(PillowWriter):
    """Writes an animated WebP."""

    def _finish(self, unwanted: Callable[[], bool]) -> None:
        self._save(self._pictures(unwanted), unit=1, quality=self._quality, method=2)
