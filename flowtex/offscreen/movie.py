"""A flow that moves, as a movie: :func:`movie`, and its pictures alone: :func:`frames`."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.progress import track
from flowtex.offscreen.moments import Moments, choose_moments
from flowtex.offscreen.movie_files import QUALITY, check_movie, default_fps, write_movie
from flowtex.offscreen.studio import Studio
from flowtex.plotting.component import FIELD_ARGUMENTS, as_field
from flowtex.settings import TABLE, Settings

__all__ = ["Movie", "frames", "movie"]


@dataclass(frozen=True)
class Movie:
    """What was written.

    Attributes
    ----------
    path
        The file.
    nbytes
        Its size.
    size
        Width and height in pixels.
    frames
        Number of pictures.
    fps
        Pictures in a second.
    seconds
        How long it is.
    closed
        Whether the first picture follows upon the last one without a seam.
    """

    path: Path
    nbytes: int
    size: tuple[int, int]
    frames: int
    fps: float
    seconds: float
    closed: bool


def movie(
    mesh: Any,
    path: str | Path,
    *,
    size: tuple[int, int] = (1024, 768),
    seconds: float | None = None,
    fps: float | None = None,
    quality: int = QUALITY,
    progress: bool = True,
    cancelled: Callable[[], bool] = lambda: False,
    **options: Any,
) -> Movie:
    """Write a flow as a movie: a seamless loop of a steady one, or all times of one that varies.

    Parameters
    ----------
    mesh
        What ``plotter.flowtex.add`` takes.
    path
        File to write: ``.mp4``, ``.gif`` or ``.webp``. One that is there already is replaced,
        once the new one is whole.
    size
        Width and height in pixels; even numbers for an MP4.
    seconds
        How long the movie is, 0.1 to 600. A steady flow begins again after as long; by default
        that is the setting ``period``. A field that varies in time takes a quarter of a second
        for a step by default, but at least 5 and at most 30 seconds.
    fps
        Pictures in a second; 30 by default, and 20 in a GIF.
    quality
        1 to 100: the more, the truer and the larger the file.
    progress
        Whether to show a progress bar when it takes longer than a second.
    cancelled
        Asked before each picture; once it is true nothing is left behind.
    **options
        Further arguments of :func:`flowtex.render`, such as ``zoom``, ``supersampling`` or
        ``beside``, and settings. ``motion`` is ``"speed"`` unless it is given.

    Returns
    -------
    Movie

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError
        As for :func:`flowtex.render`.
    MovieError
        When there is no such format, a number is out of range, or the flow would stand still.
    ModuleNotFoundError
        When an MP4 is asked for without PyAV; the text names the command that installs it.
    OSError
        When the file cannot be written; what was there before is left as it was.
    Stopped
        When it was cancelled.
    """
    fps = default_fps(path) if fps is None else fps
    check_movie(path, size, fps, quality)
    mesh, moments, options = _prepared(mesh, fps, seconds, options)
    pictures = _drawn(mesh, moments, size=size, **options)
    try:
        shown = track(pictures, len(moments), "Drawing the movie", show=progress)
        write_movie(path, shown, fps, quality, cancelled=cancelled)
    finally:
        pictures.close()
    path = Path(path)
    nbytes = path.stat().st_size
    return Movie(path, nbytes, size, len(moments), fps, len(moments) / fps, moments.closed)


def frames(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    seconds: float | None = None,
    fps: float = 30.0,
    **options: Any,
) -> Iterator[NDArray[np.uint8]]:
    """Draw the pictures of a movie one by one.

    Parameters
    ----------
    mesh, size, seconds, fps
        As for :func:`movie`.
    **options
        Further arguments of :func:`flowtex.render`, and settings, as for :func:`movie`.

    Returns
    -------
    Iterator
        Pictures (height, width, 3) uint8, row 0 at the top. Each is drawn when it is asked for.

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError, MovieError
        As for :func:`movie`.
    """
    mesh, moments, options = _prepared(mesh, fps, seconds, options)
    return _drawn(mesh, moments, size=size, **options)


def _prepared(
    mesh: Any, fps: float, seconds: float | None, options: dict[str, Any]
) -> tuple[Any, Moments, dict[str, Any]]:
    """Return the field, the moments to draw, and the options with the motion in them."""
    field = as_field(mesh, **{k: options.pop(k, None) for k in FIELD_ARGUMENTS})
    settings = Settings()
    given = {name: value for name, value in options.items() if name in TABLE}
    if field.steady:
        given = {"motion": "speed", **given}
    if options.get("image") is not None:
        given["noise"] = "image"
    settings.update(**given)
    moments = choose_moments(field, settings, fps=fps, seconds=seconds)
    if field.steady:
        options = {**options, "motion": settings.motion, "period": moments.seconds}
    return field, moments, options


def _drawn(mesh: Any, moments: Moments, **options: Any) -> Generator[NDArray[np.uint8], None, None]:
    with Studio(mesh, **options) as studio:
        for time in moments.times:
            yield studio.picture(time=time)
        for clock in moments.clocks:
            yield studio.picture(clock=clock)
