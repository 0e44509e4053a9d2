"""Movies in files, made of pictures that come one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from flowtex._util.progress import Stopped
from flowtex.offscreen.encoders import FORMATS, MovieWriter
from flowtex.offscreen.moments import MovieError

__all__ = ["QUALITY", "check_movie", "default_fps", "movie_writer", "write_movie"]

Pixels = NDArray[np.uint8]

#: Quality where none is asked for.
QUALITY = 80


def default_fps(path: str | Path) -> float:
    """Return frames in a second where none are asked for; a GIF counts whole hundredths."""
    return 20.0 if Path(path).suffix.lower() == ".gif" else 30.0


def check_movie(
    path: str | Path, size: tuple[int, int], fps: float, quality: int = QUALITY
) -> None:
    """Refuse a movie that cannot be written, before anything is drawn.

    Parameters
    ----------
    path, size, fps, quality
        As for :func:`movie_writer`.

    Raises
    ------
    MovieError
        When it cannot be; the text says how it can.
    ModuleNotFoundError
        When an MP4 is asked for without PyAV; the text names the command that installs it.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        what = f"{path.suffix!r} is no format" if suffix else "no suffix is no format"
        msg = f"{path}: {what} that movies are written in; use {', '.join(FORMATS)}"
    elif not 1 <= quality <= 100:
        msg = f"quality is {quality!r}; expected a number from 1 to 100, such as {QUALITY}"
    elif not fps > 0:
        msg = f"fps is {fps!r}; expected a positive number of frames a second, such as 30"
    else:
        msg = FORMATS[suffix].fault(size, fps)
    if msg:
        raise MovieError(msg)
    FORMATS[suffix].need()


def movie_writer(
    path: str | Path, size: tuple[int, int], fps: float, quality: int = QUALITY
) -> MovieWriter:
    """Begin a movie.

    Parameters
    ----------
    path
        File to write: ``.mp4``, ``.gif`` or ``.webp``.
    size
        Width and height in pixels; even numbers for an MP4.
    fps
        Frames in a second; at most 50 for a GIF.
    quality
        1 to 100: the more, the truer and the larger. A GIF has so many hundredths of 256 colours.

    Returns
    -------
    MovieWriter
        ``add`` takes pictures, ``finish`` puts the file in its place, ``abandon`` leaves nothing.

    Raises
    ------
    MovieError
        When it cannot be written so.
    ModuleNotFoundError
        When an MP4 is asked for without PyAV; the text names the command that installs it.
    OSError
        When there is no such folder, or no right to write there.
    """
    check_movie(path, size, fps, quality)
    path = Path(path)
    return FORMATS[path.suffix.lower()](path, size, fps, quality)


def write_movie(
    path: str | Path,
    frames: Iterable[Pixels],
    fps: float,
    quality: int = QUALITY,
    *,
    cancelled: Callable[[], bool] = lambda: False,
) -> None:
    """Write pictures as a movie; the file is there whole or not at all.

    Parameters
    ----------
    path, fps, quality
        As for :func:`movie_writer`.
    frames
        Pictures (H, W, 3) uint8, all of one size; each is taken when the one before is written.
    cancelled
        Asked before each picture; once it is true nothing is left behind.

    Raises
    ------
    MovieError, ModuleNotFoundError, OSError
        As for :func:`movie_writer`, and when there are no pictures or one differs in size.
    Stopped
        When it was cancelled.
    """
    writer: MovieWriter | None = None
    try:
        for picture in frames:
            if cancelled():
                raise Stopped
            if writer is None:
                height, width = picture.shape[:2]
                writer = movie_writer(path, (width, height), fps, quality)
            writer.add(picture)
        if writer is None:
            msg = f"{path}: there are no pictures to make a movie of; expected one or more"
            raise MovieError(msg)
        writer.finish(cancelled)
    finally:
        if writer is not None:
            writer.abandon()
