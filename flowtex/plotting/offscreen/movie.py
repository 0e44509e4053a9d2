"""A flow that moves, as a movie: :func:`movie`, and its pictures alone: :func:`frames`.

A steady flow streams round: its frames lie evenly in one period, and after the last one comes the
first again, bit for bit. In a short period it streams faster, because a grain stands still where
the flow does not go a whole wave in a period. A field that varies in time is shown from its first
to its last time; if these are equal, as after one period, the last time is left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.arguments import checked_flag, checked_number
from flowtex._util.array_types import Bytes
from flowtex._util.progress import stoppable, track
from flowtex.field import FlowField
from flowtex.field.options import FieldOptions, accepts_options
from flowtex.plotting.offscreen.encoders import (
    DEFAULT_QUALITY,
    MovieError,
    MovieWriter,
    check_movie,
    default_fps,
)
from flowtex.plotting.offscreen.plotter import OffscreenPlotter
from flowtex.rendering.uniforms import WAVE_PIXELS
from flowtex.scene.array_arguments import takes_arrays
from flowtex.scene.fields import read_field
from flowtex.scene.options import Appearance, Options, ViewOptions
from flowtex.scene.scene import make_scenes
from flowtex.settings import TABLE, Settings

STEP_S = 0.25  #: Seconds for each step of a run through the times of a field.
RUN_S = (5.0, 30.0)  #: Limits of the seconds of a whole run.
MAX_FRAMES = 36_000  #: Most frames of a movie.
MAX_FPS = 120.0  #: Most frames in a second.
SAME_SHARE = 1e-6  #: Velocities that differ by less than this share of the fastest are the same.


@dataclass(frozen=True)
class FrameTimes:
    """Time or clock of each frame of a movie."""

    #: Times of a field that varies, in its own unit; empty for a steady flow.
    times: tuple[float, ...]
    #: Clocks of the streaming of a steady flow, in seconds; empty for a field that varies.
    clocks: tuple[float, ...]
    fps: float  #: As for :class:`Movie`; a steady flow is as long as its ``period``.
    seconds: float
    closed: bool
    speed: float  #: The setting ``speed`` with which a steady flow moves visibly.

    def __len__(self) -> int:
        """Count the frames."""
        return len(self.times) or len(self.clocks)


def frame_times(
    field: FlowField, settings: Settings, *, fps: float, seconds: float | None = None
) -> FrameTimes:
    """Return the time or clock of each frame; :func:`flowtex.movie` has the parameters.

    For a steady flow the settings ``motion``, ``noise`` and ``period`` matter.

    Raises
    ------
    MovieError
        When a number is out of its range, or a steady flow would stand still.
    """
    expected = f"more than 0 and at most {MAX_FPS:g} frames per second"
    checked_number("fps", fps, math.ulp(0.0), MAX_FPS, expected=expected, error=MovieError)
    if field.steady:
        _check_motion(field, settings)
    duration = _seconds(field, settings, seconds)
    count = max(round(duration * fps), 1)
    if count > MAX_FRAMES:
        raise MovieError(
            f"{duration:g} seconds at {fps:g} frames per second are {count:,} frames; expected at "
            f"most {MAX_FRAMES:,}: choose fewer seconds or fewer frames per second"
        )
    if field.steady:
        clocks = tuple((duration * np.arange(count) / count).tolist())
        chosen = (settings.speed, settings.speed_in)
        speed = settings.speed
        if chosen == (TABLE["speed"].default, TABLE["speed_in"].default):
            speed = max(speed, WAVE_PIXELS / duration)
        return FrameTimes((), clocks, fps, duration, closed=True, speed=speed)
    start = np.nan_to_num(field.velocity[0])
    end = np.nan_to_num(field.velocity[-1])
    closed = bool(np.abs(end - start).max() <= SAME_SHARE * max(np.abs(start).max(), 1e-300))
    first = float(field.times[0])
    last = float(field.times[-1])
    times = np.linspace(first, last, max(count, 2), endpoint=not closed)
    return FrameTimes(tuple(map(float, times)), (), fps, duration, closed=closed, speed=0.0)


def _seconds(field: FlowField, settings: Settings, seconds: float | None) -> float:
    """Return the length of a movie in seconds."""
    if seconds is None:
        run = float(np.clip(STEP_S * (len(field.times) - 1), *RUN_S))
        if field.steady:
            return settings.period
        return run
    row = TABLE["period"]
    low = row.low or 0.0
    high = row.high or math.inf
    expected = f"a number from {low:g} to {high:g}"
    return checked_number("seconds", seconds, low, high, expected=expected, error=MovieError)


def _check_motion(field: FlowField, settings: Settings) -> None:
    """Raise a MovieError if a steady flow, of one time, would stand still."""
    if field.sign_free:
        msg = "the field is sign-free, so it cannot stream; a movie of it needs several times"
    elif settings.noise != "procedural":
        msg = f"noise is {settings.noise!r}, which cannot move; expected 'procedural' for a movie"
    elif settings.motion == "off":
        msg = (
            "motion is 'off'; expected 'speed' or 'uniform', because a steady flow has no other "
            "motion"
        )
    else:
        return
    raise MovieError(msg)


@dataclass(frozen=True)
class Movie:
    """A movie that was written.

    Attributes
    ----------
    path, nbytes
        The file, and its size.
    size
        Width and height in pixels.
    frames, fps, seconds
        Number of frames, frames per second, and duration.
    closed
        Whether the first frame follows the last one without a seam.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.airfoil_field()
    >>> movie = flowtex.movie(field, "loop.gif", size=(64, 48), seconds=0.2, samples=5)
    >>> movie.size, movie.frames, movie.closed
    ((64, 48), 4, True)
    """

    path: Path
    nbytes: int
    size: tuple[int, int]
    frames: int
    fps: float
    seconds: float
    closed: bool


@takes_arrays()
@accepts_options(FieldOptions, Appearance, ViewOptions)
def movie(
    mesh: Any,
    path: str | Path,
    *,
    size: tuple[int, int] = (1024, 768),
    seconds: float | None = None,
    fps: float | None = None,
    quality: int = DEFAULT_QUALITY,
    supersampling: int = 1,
    annotations: bool = False,
    progress: bool = True,
    cancelled: Callable[[], bool] = lambda: False,
    **options: Any,
) -> Movie:
    """Write a flow as a movie: a seamless loop, or all times of a time-varying flow.

    Parameters
    ----------
    mesh
        PyVista mesh, list of meshes in time, xarray dataset, :class:`~flowtex.FlowField`, path of a
        file, or plain arrays by position: ``x, y, u, v`` as in ``plt.streamplot``.
    path
        File to write: ``.mp4``, ``.gif`` or ``.webp``. An existing file is replaced when the new
        one is complete.
    size
        Width and height in pixels; even numbers for an MP4.
    seconds
        Duration of the movie, 0.1 to 600. A steady flow repeats after this time; the default is the
        setting ``period``. With the default ``speed`` a short movie streams faster, 96 pixels in
        its duration. The default for a time-varying field is a quarter of a second per step, but at
        least 5 and at most 30 seconds.
    fps
        Frames per second; 30 by default, and 20 in a GIF.
    quality
        Quality of the compression, 1 to 100; higher values give larger files.
    supersampling, annotations
        As for :func:`flowtex.render`.
    progress
        Whether to show a progress bar when it takes longer than a second.
    cancelled
        Called before each frame; if it returns True, the movie is cancelled and no file is written.
    {options}
    **settings
        Any setting of :class:`~flowtex.Settings`. ``motion`` is ``"speed"`` by default.

    Returns
    -------
    Movie

    Raises
    ------
    FieldError, SettingsError, OpenGLMissingError
        As for :func:`flowtex.render`.
    MovieError
        When the format is unknown, a number is out of range, or the picture would not move.
    ModuleNotFoundError
        When PyAV is missing and the file is an MP4; the text names the command that installs it.
    OSError
        When the file cannot be written; an existing file stays unchanged.
    Stopped
        When ``cancelled`` returned True.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.airfoil_field()
    >>> flowtex.movie(field, "airfoil.mp4", zoom=4, annotations=True)  # doctest: +SKIP
    """
    if fps is None:
        fps = default_fps(path)
    check_movie(path, size, fps, quality)
    checked_flag("progress", progress)
    drawing = {"size": size, "supersampling": supersampling, "annotations": annotations}
    shown, drawn = _prepare(mesh, options, fps, seconds, **drawing)
    writer = MovieWriter(path, size, fps, quality)
    with stoppable(cancelled), closing(drawn), closing(writer):
        for picture in track(drawn, len(shown), "Drawing the movie", show=progress):
            writer.add(picture)
        writer.finish()
    path = Path(path)
    count = len(shown)
    return Movie(path, path.stat().st_size, size, count, fps, count / fps, shown.closed)


def frames(
    mesh: Any,
    *,
    size: tuple[int, int] = (1024, 768),
    seconds: float | None = None,
    fps: float = 30.0,
    supersampling: int = 1,
    annotations: bool = False,
    **options: Any,
) -> Iterator[Bytes]:
    """Yield the frames of a movie, (height, width, 3) uint8, each drawn when it is requested.

    Parameters and errors are as for :func:`flowtex.movie`.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.plotting.offscreen.movie import frames
    >>> field = flowtex.examples.airfoil_field()
    >>> len(list(frames(field, size=(64, 48), fps=10, seconds=0.4, samples=5)))
    4
    """
    drawing = {"size": size, "supersampling": supersampling, "annotations": annotations}
    return _prepare(mesh, options, fps, seconds, **drawing)[1]


def _prepare(
    mesh: Any, words: dict[str, Any], fps: float, seconds: float | None, **drawing: Any
) -> tuple[FrameTimes, Generator[Bytes, None, None]]:
    """Return the times of the frames, and a generator of their pictures."""
    options = Options.split(**words)
    field = read_field(mesh, options.field)
    defaults = {}
    if field.steady:
        defaults["motion"] = "speed"
    settings = options.make_settings(field, **defaults)
    shown = frame_times(field, settings, fps=fps, seconds=seconds)
    values = dict(options.settings)
    if field.steady:
        values |= {"motion": settings.motion, "period": shown.seconds, "speed": shown.speed}
    options = replace(options, field=FieldOptions(), settings=values)

    def draw() -> Generator[Bytes, None, None]:
        scenes = make_scenes(field, options)
        with closing(OffscreenPlotter(scenes, options.view, **drawing)) as plotter:
            for number in range(len(shown)):
                if shown.times:
                    yield plotter.picture(time=shown.times[number])
                else:
                    yield plotter.picture(clock=shown.clocks[number])

    return shown, draw()
