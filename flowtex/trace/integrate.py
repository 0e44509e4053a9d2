"""Paths of many particles at once, each with its own step.

The scheme is the embedded Runge-Kutta pair of order 3(2) by Bogacki and Shampine (1989), whose
last stage is the first of the next step. Every particle keeps its own step size, which follows
its own error; the arrays hold the particles still under way and shrink as paths come to their
end. Positions at the wanted lags come from the cubic Hermite polynomial through a step's two
ends, of the order of the scheme, so the lags do not shorten the steps.

A path that leaves the domain, enters a blanked cell or stops is ended there. Its reach is kept,
and beyond it the path goes on straight: interpolation between a path that has ended and its
neighbour that has not then stays true up to the reach.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex.trace.sampler import Sampler

__all__ = ["Paths", "integrate"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Longest step in cells: a path cannot jump over a blanked cell unseen.
LONGEST = 1.0
#: A step may grow or shrink by these factors.
SHRINK, GROW, SAFETY = 0.2, 4.0, 0.9
#: A particle this slow, in cells over a whole unit of its own lag, stands still.
STILL = 1e-5
#: Bisections that find where inside a step a path ends.
BISECTIONS = 12


@dataclass(frozen=True)
class Paths:
    """Positions (M, N, 2) at the wanted lags, and the lag (N,) at which each path ended."""

    positions: Floats
    reach: Floats


@dataclass
class _State:
    """Particles still under way."""

    which: Indices
    y: Floats
    lag: Floats
    step: Floats
    rate: Floats
    next: Indices

    def keep(self, mask: NDArray[np.bool_]) -> None:
        for name in ("which", "y", "lag", "step", "rate", "next"):
            setattr(self, name, getattr(self, name)[mask])


def integrate(
    sampler: Sampler,
    start: Floats,
    lags: Floats,
    unit: Floats,
    *,
    direction: float,
    tolerance: float,
    most_steps: int = 20_000,
) -> Paths:
    """Follow particles and return where they are at the wanted lags.

    Parameters
    ----------
    sampler
        The field.
    start
        Starting positions in index space, (N, 2) as (i, j).
    lags
        Wanted lags in units of each particle's ``unit``, (M,), positive and increasing.
    unit
        Length of one unit of lag for each particle, (N,).
    direction
        -1 to follow backward, +1 forward.
    tolerance
        Error allowed in one step, in cells.
    most_steps
        Rounds after which the paths that are left are ended where they are.
    """
    count = len(start)
    out = np.repeat(start[None], len(lags), axis=0)
    reach = np.full(count, np.inf)
    rate = sampler.rate(start, np.zeros(count), direction)
    state = _State(
        which=np.arange(count),
        y=start.copy(),
        lag=np.zeros(count),
        step=np.minimum(lags[0] * unit, 0.25 / _speed(rate)),
        rate=rate,
        next=np.zeros(count, dtype=np.intp),
    )
    _end_still(state, reach, unit)
    for _ in range(most_steps):
        if not len(state.which):
            break
        _advance(state, sampler, out, reach, lags, unit, direction, tolerance)
    reach[state.which] = state.lag
    _go_straight(state, state.y, state.rate, state.lag, out, lags, unit)
    return Paths(out, reach / unit)


def _advance(
    state: _State,
    sampler: Sampler,
    out: Floats,
    reach: Floats,
    lags: Floats,
    unit: Floats,
    direction: float,
    tolerance: float,
) -> None:
    """One step of every particle: try it, keep it where its error is small enough."""
    h = np.minimum(state.step, LONGEST / _speed(state.rate))
    after, rate, error = _try(sampler, state, h, direction)
    size = np.maximum(np.abs(error).max(axis=1) / tolerance, 1e-12)
    accepted = size <= 1.0
    state.step = h * np.clip(SAFETY * size ** (-1 / 3), SHRINK, GROW)
    if not accepted.any():
        return
    done = np.flatnonzero(accepted)
    before = (state.y[done], state.rate[done], state.lag[done])
    late = state.lag[done] + h[done]
    gone = ~sampler.alive(after[done])
    end = late.copy()
    if gone.any():
        g = np.flatnonzero(gone)
        end[g] = _border(sampler, [b[g] for b in before], after[done][g], rate[done][g], h[done][g])
    _record(state, done, before, after[done], rate[done], h[done], end, out, lags, unit)
    ended = done[gone]
    if len(ended):
        reach[state.which[ended]] = end[gone]
        _leave(state, ended, before, after, rate, h, end[gone], gone, out, lags, unit)
    state.y[done], state.rate[done], state.lag[done] = after[done], rate[done], late
    finished = state.next >= len(lags)
    finished[ended] = True
    if finished.any():
        state.keep(~finished)
    _end_still(state, reach, unit, out, lags)


def _try(
    sampler: Sampler, state: _State, h: Floats, direction: float
) -> tuple[Floats, Floats, Floats]:
    """One Bogacki-Shampine step: positions, rates there, and the estimated error."""
    y, k1, lag, w = state.y, state.rate, state.lag, h[:, None]
    k2 = sampler.rate(y + w * (0.5 * k1), lag + 0.5 * h, direction)
    k3 = sampler.rate(y + w * (0.75 * k2), lag + 0.75 * h, direction)
    after = y + w * (2 / 9 * k1 + 1 / 3 * k2 + 4 / 9 * k3)
    k4 = sampler.rate(after, lag + h, direction)
    error = w * (-5 / 72 * k1 + 1 / 12 * k2 + 1 / 9 * k3 - 1 / 8 * k4)
    return after, k4, error


def _hermite(
    s: Floats, h: Floats, y0: Floats, k0: Floats, y1: Floats, k1: Floats
) -> Floats:
    """Position at the fraction s of a step of length h from (y0, k0) to (y1, k1)."""
    s, h = s[:, None], h[:, None]
    a = (1 + 2 * s) * (1 - s) ** 2
    b = s * (1 - s) ** 2
    c = s * s * (3 - 2 * s)
    d = s * s * (s - 1)
    return np.asarray(a * y0 + b * h * k0 + c * y1 + d * h * k1)


def _record(
    state: _State,
    done: Indices,
    before: tuple[Floats, Floats, Floats],
    after: Floats,
    rate: Floats,
    h: Floats,
    end: Floats,
    out: Floats,
    lags: Floats,
    unit: Floats,
) -> None:
    """Write the positions at the lags that the accepted steps have passed."""
    y0, k0, lag0 = before
    which = state.which[done]
    while True:
        pointer = state.next[done]
        wanted = lags[np.minimum(pointer, len(lags) - 1)] * unit[which]
        due = (pointer < len(lags)) & (wanted <= end)
        if not due.any():
            return
        d = np.flatnonzero(due)
        s = (wanted[d] - lag0[d]) / h[d]
        out[pointer[d], which[d]] = _hermite(s, h[d], y0[d], k0[d], after[d], rate[d])
        state.next[done[d]] += 1


def _border(
    sampler: Sampler, before: list[Floats], after: Floats, rate: Floats, h: Floats
) -> Floats:
    """Lag at which a step that ends outside leaves the domain, by bisection."""
    y0, k0, lag0 = before
    low, high = np.zeros(len(h)), np.ones(len(h))
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        inside = sampler.alive(_hermite(middle, h, y0, k0, after, rate))
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return np.asarray(lag0 + low * h)


def _leave(
    state: _State,
    ended: Indices,
    before: tuple[Floats, Floats, Floats],
    after: Floats,
    rate: Floats,
    h: Floats,
    end: Floats,
    gone: NDArray[np.bool_],
    out: Floats,
    lags: Floats,
    unit: Floats,
) -> None:
    """Continue paths that have left straight on from where they left."""
    y0, k0, lag0 = (b[gone] for b in before)
    s = (end - lag0) / h[ended]
    y = _hermite(s, h[ended], y0, k0, after[ended], rate[ended])
    k = k0 + s[:, None] * (rate[ended] - k0)
    part = _State(state.which[ended], y, end, h[ended], k, state.next[ended])
    _go_straight(part, y, k, end, out, lags, unit)


def _go_straight(
    state: _State, y: Floats, rate: Floats, end: Floats, out: Floats, lags: Floats, unit: Floats
) -> None:
    """Fill the lags that are left with the straight continuation of each path."""
    which = state.which
    for m in range(len(lags)):
        left = state.next <= m
        w = which[left]
        further = lags[m] * unit[w] - end[left]
        out[m, w] = y[left] + further[:, None] * rate[left]


def _end_still(
    state: _State,
    reach: Floats,
    unit: Floats,
    out: Floats | None = None,
    lags: Floats | None = None,
) -> None:
    """End the paths that do not move any more."""
    still = np.abs(state.rate).max(axis=1, initial=0.0) * unit[state.which] < STILL
    if not still.any():
        return
    reach[state.which[still]] = state.lag[still]
    if out is not None and lags is not None:
        part = _State(*(getattr(state, n)[still] for n in _State.__dataclass_fields__))
        _go_straight(part, part.y, np.zeros_like(part.y), part.lag, out, lags, unit)
    state.keep(~still)


def _speed(rate: Floats) -> Floats:
    """Greatest component of a rate, never quite zero."""
    return np.maximum(np.abs(rate).max(axis=1, initial=0.0), 1e-300)
