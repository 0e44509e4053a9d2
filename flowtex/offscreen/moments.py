"""Which moments of a flow a movie shows.

A steady flow streams round: its frames lie evenly in one period, and after the last one comes the
first again, bit for bit. A field that varies in time is shown from its first to its last time;
where that is a period of its own, the last time is left out, because it is the first again.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from flowtex.field import FlowField
from flowtex.settings import TABLE, Settings

__all__ = ["LONGEST", "SHORTEST", "Moments", "MovieError", "choose_moments", "run_seconds"]

#: Seconds for one run through the times of a field: so many for each step, within limits.
STEP_SECONDS, SHORTEST, LONGEST = 0.25, 5.0, 30.0
#: Frames of a movie and frames in a second, at most.
MOST_FRAMES, FASTEST = 36_000, 120.0
#: Velocities that differ by less than this share of the fastest are the same.
SAME = 1e-6


class MovieError(ValueError):
    """A movie cannot be made so; the text says why and what to do."""


@dataclass(frozen=True)
class Moments:
    """The moments of a movie, one for each frame.

    Attributes
    ----------
    times
        Times of a field that varies, in its own unit; empty for a steady flow.
    clocks
        Clocks of the streaming of a steady flow, in seconds; empty for a field that varies.
    fps
        Frames in a second.
    seconds
        How long the movie is, which for a steady flow is its ``period``.
    closed
        Whether the first frame follows upon the last one without a seam.
    """

    times: tuple[float, ...]
    clocks: tuple[float, ...]
    fps: float
    seconds: float
    closed: bool

    def __len__(self) -> int:
        """Count the frames."""
        return len(self.times) or len(self.clocks)


def choose_moments(
    field: FlowField, settings: Settings, *, fps: float, seconds: float | None = None
) -> Moments:
    """Return the moments of a movie.

    Parameters
    ----------
    field
        The flow.
    settings
        How it is drawn: ``motion``, ``noise`` and ``period`` of a steady flow.
    fps
        Frames in a second.
    seconds
        How long the movie is; the ``period`` of a steady flow, and for a field that varies a
        quarter of a second a step, but at least 5 and at most 30 seconds.

    Raises
    ------
    MovieError
        When a number is out of its range, or a steady flow would stand still.
    """
    if not 0 < fps <= FASTEST:
        msg = f"fps is {fps!r}; expected more than 0 and at most {FASTEST:g} frames a second"
        raise MovieError(msg)
    if field.steady:
        _must_move(field, settings)
    whole = _seconds(field, settings, seconds)
    count = max(round(whole * fps), 1)
    if count > MOST_FRAMES:
        msg = (
            f"{whole:g} seconds of {fps:g} frames are {count:,} frames; expected at most "
            f"{MOST_FRAMES:,}: choose fewer seconds or fewer frames a second"
        )
        raise MovieError(msg)
    if field.steady:
        clocks = tuple(whole * n / count for n in range(count))
        return Moments((), clocks, fps, whole, closed=True)
    closed = _comes_back(field)
    first, last = float(field.times[0]), float(field.times[-1])
    times = np.linspace(first, last, max(count, 2), endpoint=not closed)
    return Moments(tuple(map(float, times)), (), fps, whole, closed=closed)


def run_seconds(times: int) -> float:
    """Seconds for one run through so many times of a field, in a movie and on a page."""
    return min(max(STEP_SECONDS * (times - 1), SHORTEST), LONGEST)


def _seconds(field: FlowField, settings: Settings, seconds: float | None) -> float:
    if seconds is None:
        if field.steady:
            return settings.period
        return run_seconds(len(field.times))
    row = TABLE["period"]
    low, high = row.low or 0.0, row.high or math.inf
    if not low <= seconds <= high:
        msg = f"seconds is {seconds!r}; expected a number from {low:g} to {high:g}"
        raise MovieError(msg)
    return float(seconds)


def _must_move(field: FlowField, settings: Settings) -> None:
    """Refuse a steady flow that would stand still."""
    if field.sign_free:
        msg = "the field has no sign, so it does not stream; a movie of it needs several times"
    elif settings.noise != "procedural":
        msg = f"noise is {settings.noise!r}, which stands still; expected 'procedural' for a movie"
    elif settings.motion == "off":
        msg = "motion is 'off'; expected 'speed' or 'uniform', as a steady flow has no other motion"
    else:
        return
    raise MovieError(msg)


def _comes_back(field: FlowField) -> bool:
    """Tell whether the velocity of the last time is that of the first."""
    first, last = (np.nan_to_num(field.velocity[step]) for step in (0, -1))
    return bool(np.abs(last - first).max() <= SAME * max(np.abs(first).max(), 1e-300))
