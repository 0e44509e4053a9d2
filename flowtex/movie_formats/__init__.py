"""How a movie is written: MP4 by PyAV, GIF and animated WebP by Pillow.

::

    add(picture) ... add(picture), finish()     the file is there
    abandon()                                   nothing is there
"""

from __future__ import annotations

from flowtex.movie_formats.mp4 import MP4Writer
from flowtex.movie_formats.pillow import GIFWriter, WebPWriter
from flowtex.movie_formats.writer import MovieWriter

__all__ = ["FORMATS", "MovieWriter"]

#: Writers by the suffix of the file.
FORMATS: dict[str, type[MovieWriter]] = {
    ".mp4": MP4Writer,
    ".gif": GIFWriter,
    ".webp": WebPWriter,
}
