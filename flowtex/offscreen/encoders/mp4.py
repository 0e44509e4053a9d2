"""MP4, written picture by picture with PyAV: H.264 as every browser plays it.

Matrix, primaries, curve and range of the colours stand in the file, so that players show those
that were drawn.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.extras import install_extra
from flowtex.offscreen.encoders.writer import MovieWriter, Pixels, Size
from flowtex.offscreen.moments import MovieError

__all__ = ["MP4Writer"]

#: Pixels of a picture at the highest level of H.264.
MOST_PIXELS = 139_264 * 256
#: Numbers of ITU-T H.273: matrix and primaries of BT.709, curve of sRGB, range from 16 to 235.
BT709, SRGB_CURVE, LIMITED = 1, 13, 1


class MP4Writer(MovieWriter):
    """Writes H.264 with PyAV."""

    @classmethod
    def fault(cls, size: Size, fps: float) -> str:
        """Say why such a movie cannot be written; even sides are what 4:2:0 asks for."""
        width, height = size
        shown = f"size is {width} x {height}"
        if width % 2 or height % 2:
            return f"{shown}; MP4 wants even sides, such as {width // 2 * 2} x {height // 2 * 2}"
        if width * height > MOST_PIXELS:
            return f"{shown}; MP4 has at most {MOST_PIXELS:,} pixels: choose fewer"
        return super().fault(size, fps)

    @classmethod
    def need(cls) -> None:
        """Ask for PyAV."""
        _pyav()

    def _begin(self, part: Path) -> None:
        av = _pyav()
        from av.video.reformatter import Interpolation

        self._av = av
        self._exact = Interpolation.AREA | Interpolation.ACCURATE_RND
        self._movie = av.open(str(part), "w", format="mp4", options={"movflags": "+faststart"})
        rate = Fraction(self._fps).limit_denominator(1001)
        # Half as many steps of the quantizer again for each tenth: 80 is a rate factor of 18.
        factor = {"crf": f"{50 - 0.4 * self._quality:g}", "preset": "medium"}
        self._stream = self._movie.add_stream("libx264", rate=rate, options=factor)
        self._stream.width, self._stream.height = self._size
        self._stream.pix_fmt = "yuv420p"
        codec = self._stream.codec_context
        codec.colorspace, codec.color_primaries = BT709, BT709
        codec.color_trc, codec.color_range = SRGB_CURVE, LIMITED

    def _add(self, picture: Pixels) -> None:
        frame = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")
        made = frame.reformat(
            format="yuv420p",
            src_color_range="JPEG",
            dst_color_range="MPEG",
            dst_colorspace="ITU709",
            interpolation=self._exact,
        )
        self._movie.mux(self._stream.encode(made))

    def _finish(self, unwanted: Callable[[], bool]) -> None:
        del unwanted
        self._movie.mux(self._stream.encode(None))
        self._close()

    def _close(self) -> None:
        self._movie.close()


def _pyav() -> Any:
    """Return PyAV, which must be there and know H.264."""
    try:
        import av
    except ModuleNotFoundError as error:
        msg = (
            "an MP4 needs PyAV, not installed here; a GIF does without. To mend it:\n"
            f"  {install_extra('movie')}"
        )
        raise ModuleNotFoundError(msg) from error
    if "libx264" not in av.codecs_available:
        msg = "PyAV was built without libx264 here; install its own wheel, or write a GIF"
        raise MovieError(msg)
    return av
