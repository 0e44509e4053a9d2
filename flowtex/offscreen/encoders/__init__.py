"""How a movie is written: MP4 by PyAV, GIF and animated WebP by Pillow.

::

    add(picture) ... add(picture), finish()     the file is there
    abandon()                                   nothing is there
"""

from __future__ import annotations

from flowtex.offscreen.encoders.mp4 import MP4Writer
from flowtex.offscreen.encoders.pillow import GIFWriter, WebPWriter
from flowtex.offscreen.encoders.writer import MovieWriter

__all__ = ["FORMATS", "MovieWriter"]

#: Writers by the suffix of the file.
FORMATS: dict[str, type[MovieWriter]] = {
    ".mp4": MP4Writer,
    ".gif": GIFWriter,
    ".webp": WebPWriter,
}
