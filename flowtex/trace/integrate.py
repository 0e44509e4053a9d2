"""Paths of many particles at once, each with its own step.

The scheme is the embedded Runge-Kutta pair of order 3(2) by Bogacki and Shampine (1989), whose
last stage is the first of the next step. Positions at the lags come from the cubic Hermite
polynomial through a step's two ends, of the order of the scheme, so the lags do not shorten steps.

A path that leaves the domain, enters a blanked cell or stops is ended there. That lag is its reach,
and beyond it the path continues straight: so interpolation between it and a neighbour that has not
ended stays true up to the reach. Next to a pole a particle is followed in the plane there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.trace.sampler import Numbers, Sampler

STEP_SHRINK = 0.2  #: Least ratio of a step to the one before.
STEP_GROWTH = 4.0  #: Greatest ratio of a step to the one before.
STEP_SAFETY = 0.9  #: Safety factor of the step size.
#: Bisections that find where inside a step a path ends.
BISECTIONS = 20
#: Most steps per line of nodes: paths that circle within few cells would never end.
STEPS_PER_LINE = 50
LEAST_STEPS = 1_000  #: Least limit of the number of steps.
MOST_STEPS = 20_000  #: Greatest limit of the number of steps.
#: Steps after which a path in a steady flow ends if it has hardly moved.
CIRCLE_STEPS = 48
CIRCLE_ERRORS = 20.0  #: Least displacement in these steps, in multiples of the tolerance.
#: Share of a step by which rounding may miss a lag.
LAG_ROUNDING = 1e-9
#: Displacement in cells that single precision holds, also in computations.
MOST_CELLS = 1e30
#: Returns whether paths (n,), by their numbers, are followed at positions (2, n) in index space.
Inside = Callable[[Floats, Indices], Bools]


@dataclass(frozen=True)
class Paths:
    """Positions at the lags, and how far the paths lead."""

    positions: Floats  #: Positions in index space, (M, N, 2) as (i, j).
    reach: Floats  #: Lag at which each path ended, (N,), infinite where it continues.
    polar: Bools  #: Which paths came close to a pole, (N,).
    #: Which paths left the region in which they are followed, (N,): ``reach`` is the lag at which
    #: they did, and all later positions are the one where they did.
    interrupted: Bools
    circling: Bools  #: Which paths stay within a small part of a cell, (N,), with infinite reach.


def integrate(
    sampler: Sampler,
    start: Floats,
    lags: Floats,
    unit: Floats,
    *,
    direction: float | Floats,
    tolerance: float,
    within: Inside | None = None,
) -> Paths:
    """Follow particles from positions (N, 2) as (i, j) and return where they are at the lags (M,).

    Lags are positive and increasing, in multiples of each particle's ``unit`` (N,). Direction -1 is
    backward, 1 forward, for all or (N,); the tolerance is the error allowed in one step, in cells.
    A path that is not ``within`` the positions where it is followed is interrupted.
    """
    run = _Run(sampler, np.ascontiguousarray(start.T), lags, unit, direction, tolerance, within)
    lines = sampler.grid.rows + sampler.grid.columns
    for number in range(min(max(STEPS_PER_LINE * lines, LEAST_STEPS), MOST_STEPS)):
        run.end_resting()
        if not len(run.state.which):
            break
        if number % CIRCLE_STEPS == 0 and not np.isfinite(sampler.longest):
            run.end_circling()
        run.advance()
    run.go_straight(run.state, run.state.rate)
    positions = np.moveaxis(run.out, 1, 2)
    return Paths(positions, run.reach / unit, run.polar, run.interrupted, run.circling)


@dataclass
class Columns:
    """Base of groups of arrays whose last axis counts particles; some of them may be None."""

    def joined(self, other: Self) -> Self:
        """Return these particles and others."""
        parts: list[Any] = []
        for own, others in zip(vars(self).values(), vars(other).values(), strict=True):
            if own is None:
                parts.append(None)
            else:
                parts.append(np.concatenate([own, others], axis=-1))
        return type(self)(*parts)

    def pick(self, mask: Bools | Indices) -> Self:
        """Return some of the particles."""
        # Numbers are several times as fast as a mask where there is more than one row.
        at = mask
        if mask.dtype == bool:
            at = np.flatnonzero(mask)
        parts: list[Any] = []
        for part in vars(self).values():
            if part is None:
                parts.append(None)
            else:
                parts.append(part.take(at, axis=-1))
        return type(self)(*parts)


@dataclass
class _Particles(Columns):
    """Particles still under way; the last axis is theirs."""

    which: Indices
    unit: Floats
    rest: Floats
    y: Floats
    lag: Floats
    step: Floats
    rate: Floats
    next: Indices
    chart: Numbers | None  #: Charts of ``y``, on a surface with poles.
    index: Floats | None  #: The same in index space.
    direction: Floats  #: -1 for particles that are followed backward, 1 forward.


@dataclass
class IntegrationStep(Columns):
    """Steps of some particles, from (y0, k0) at lag0 to (y1, k1); the last axis is theirs."""

    y0: Floats
    k0: Floats
    y1: Floats
    k1: Floats
    lag0: Floats
    h: Floats
    chart: Numbers | None = None
    index: Floats | None = None

    def at(self, s: Floats) -> Floats:
        """Return positions at fractions of the steps, by the cubic through both ends and slopes."""
        r = 1 - s
        start = r * r * (self.y0 + s * (2 * self.y0 + self.h * self.k0))
        return np.asarray(start + s * s * (self.y1 + r * (2 * self.y1 - self.h * self.k1)))


class _Run:
    """State of one call of :func:`integrate`."""

    def __init__(
        self,
        sampler: Sampler,
        start: Floats,
        lags: Floats,
        unit: Floats,
        direction: float | Floats,
        tolerance: float,
        within: Inside | None = None,
    ) -> None:
        count = start.shape[1]
        self.sampler = sampler
        self.tolerance = tolerance
        self.charts = sampler.charts
        self.within = within
        self.lags = lags
        self.before = np.full(start.shape, np.inf)
        #: The lags and one that is never reached, for particles that have passed all.
        self.next_lags = np.append(lags, np.inf)
        self.out = np.repeat(start[None], len(lags), axis=0)
        self.reach = np.full(count, np.inf)
        self.polar, self.interrupted, self.circling = np.zeros((3, count), dtype=bool)
        if self.charts is not None:
            self.polar |= self.charts.close(start)
        self.state = self._first_state(start, unit, direction)

    def _first_state(self, start: Floats, unit: Floats, direction: float | Floats) -> _Particles:
        """Return particles that begin at positions (2, N) in index space."""
        count = start.shape[1]
        last = float(self.lags[-1])
        chart = None
        index = None
        y = start
        ways = np.broadcast_to(np.asarray(direction, dtype=float), (count,))
        if self.charts is not None:
            chart = self.charts.choose(start)
            index = start
            y = self.charts.enter(start, chart)
        return _Particles(
            which=np.arange(count),
            unit=unit,
            rest=self.sampler.rest(unit, last),
            y=y,
            lag=np.zeros(count),
            step=last * unit,
            rate=self.sampler.rate(y, np.zeros(count), ways, chart),
            next=np.zeros(count, dtype=np.intp),
            chart=chart,
            index=index,
            direction=ways,
        )

    def end_resting(self) -> None:
        """End the paths that are at rest."""
        resting = _speed(self.state.rate) < self.state.rest
        if resting.any():
            ended = self.state.pick(resting)
            self.go_straight(ended, np.zeros_like(ended.y))
            self.state = self.state.pick(~resting)

    def end_circling(self) -> None:
        """End paths that circle within a small part of a cell."""
        state = self.state
        circling = _speed(state.y - self.before[:, state.which]) < CIRCLE_ERRORS * self.tolerance
        self.before[:, state.which] = state.y
        if circling.any():
            self.go_straight(state.pick(circling), np.zeros((2, circling.sum())))
            self.reach[state.which[circling]] = np.inf
            self.circling[state.which[circling]] = True
            self.state = state.pick(~circling)

    def advance(self) -> None:
        """Try one step of every particle, and accept it where its error is small enough."""
        state = self.state
        rest = self.lags[-1] * state.unit - state.lag
        # A step must not pass a blanked cell unnoticed.
        longest = self.sampler.room(state.y) / np.maximum(_speed(state.rate), 1e-300)
        h = np.minimum(np.minimum(state.step, longest), rest)
        if np.isfinite(self.sampler.longest):
            # Before the first time step nothing changes.
            changing = state.lag < self._span(state.direction)
            h = np.where(changing, np.minimum(h, self.sampler.longest), h)
        step, error = self._try(h)
        size = np.maximum(error * (1 / self.tolerance), 1e-9)
        state.step = h * np.clip(STEP_SAFETY / np.cbrt(size), STEP_SHRINK, STEP_GROWTH)
        good = size <= 1.0
        if good.all():
            self._accept(state, step)
            self.state = state
        elif good.any():
            moved = state.pick(good)
            self._accept(moved, step.pick(good))
            self.state = moved.joined(state.pick(~good))
        if (finished := self.state.next >= len(self.lags)).any():
            self.state = self.state.pick(~finished)

    def _span(self, direction: Floats) -> Floats:
        """Return lags (N,) to the first or last time step, beyond which the flow is constant."""
        sampler = self.sampler
        ahead = sampler.times[-1] - sampler.destination
        behind = sampler.destination - sampler.times[0]
        return np.asarray(np.where(direction < 0, behind, ahead))

    def _try(self, h: Floats) -> tuple[IntegrationStep, Floats]:
        """Return one Bogacki-Shampine step, and its estimated error in cells, (N,)."""
        state = self.state
        y = state.y
        k1 = state.rate
        lag = state.lag
        k2 = self._rate(y + (0.5 * h) * k1, lag + 0.5 * h, k1)
        k3 = self._rate(y + (0.75 * h) * k2, lag + 0.75 * h, k2)
        after = y + h * (2 / 9 * k1 + 1 / 3 * k2 + 4 / 9 * k3)
        k4 = self._rate(after, lag + h, k3)
        error = h * _speed(-5 / 72 * k1 + 1 / 12 * k2 + 1 / 9 * k3 - 1 / 8 * k4)
        return IntegrationStep(y, k1, after, k4, lag, h, state.chart, state.index), error

    def _rate(self, position: Floats, lag: Floats, ahead: Floats) -> Floats:
        state = self.state
        return self.sampler.rate(position, lag, state.direction, state.chart, ahead)

    def _index(self, position: Floats, along: IntegrationStep | _Particles) -> Floats:
        """Return positions in index space of positions on the charts of a step or state."""
        if self.charts is None or along.chart is None:
            return position
        return self.charts.index(position, along.chart, along.index)

    def _accept(self, state: _Particles, step: IntegrationStep) -> None:
        """Move particles by their step; those that leave the domain are ended on the way."""
        index = self._index(step.y1, step)
        outside = ~self.sampler.alive(index)
        share = np.ones(len(outside))
        if outside.any():
            share[outside] = self._border(step.pick(outside))
        self._record(state, step, share)
        if outside.any():
            out = step.pick(outside)
            s = share[outside]
            ended = state.pick(outside)
            ended.y = out.at(s)
            ended.lag = out.lag0 + s * out.h
            self.go_straight(ended, out.k0 + s * (out.k1 - out.k0))
            state.next[outside] = len(self.lags)
        state.y = step.y1
        state.rate = step.k1
        state.lag = step.lag0 + step.h
        self._interrupt(state, index, outside)
        if state.chart is not None:
            before = state.index
            state.index = index
            self._change_chart(state, before)

    def _interrupt(self, state: _Particles, index: Floats, outside: Bools) -> None:
        """Stop the paths that have left the region in which they are followed."""
        if self.within is None:
            return
        now = ~(self.within(index, state.which) | outside) & (state.next < len(self.lags))
        if not now.any():
            return
        which = state.which[now]
        self.interrupted[which], self.reach[which] = True, state.lag[now]
        for m in range(len(self.lags)):
            due = now & (state.next <= m)
            self.out[m][:, state.which[due]] = index[:, due]
        state.next[now] = len(self.lags)

    def _change_chart(self, state: _Particles, before: Floats | None) -> None:
        """Continue in the plane of a pole that is close, or in index space again."""
        if self.charts is None or state.chart is None or state.index is None or before is None:
            return
        self.polar[state.which[self.charts.close(state.index)]] = True
        chart = self.charts.choose(state.index, state.chart)
        new = np.flatnonzero(chart != state.chart)
        if len(new):
            state.chart = chart
            charts = chart[new]
            state.y[:, new] = y = self.charts.enter(state.index[:, new], charts)
            ahead = y - self.charts.enter(before[:, new], charts)
            ways = state.direction[new]
            state.rate[:, new] = self.sampler.rate(y, state.lag[new], ways, charts, ahead)

    def _record(self, state: _Particles, step: IntegrationStep, share: Floats) -> None:
        """Write the positions at the lags that the first ``share`` of the steps has passed."""
        while True:
            s = (self.next_lags[state.next] * state.unit - step.lag0) / step.h
            due = s <= share + LAG_ROUNDING
            if not due.any():
                return
            if due.all() and (state.next == state.next[0]).all():
                self.out[state.next[0]][:, state.which] = self._index(step.at(s), step)
                state.next += 1
                continue
            d = np.flatnonzero(due)
            if len(d) == len(s):
                due_step = step
            else:
                due_step = step.pick(d)
            positions = self._index(due_step.at(s[d]), due_step)
            self.out[state.next[d], :, state.which[d]] = positions.T
            state.next[d] += 1

    def _border(self, step: IntegrationStep) -> Floats:
        """Return the share of a step to the outside that is still inside, by bisection."""
        low = np.zeros(len(step.h))
        high = np.ones(len(step.h))
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            inside = self.sampler.alive(self._index(step.at(middle), step))
            low = np.where(inside, middle, low)
            high = np.where(inside, high, middle)
        return low

    def go_straight(self, state: _Particles, rate: Floats) -> None:
        """End paths at their positions, and fill the remaining lags straight ahead."""
        self.reach[state.which] = state.lag
        m, n = np.nonzero(np.arange(len(self.lags))[:, None] >= state.next)
        if len(n):
            later = state.pick(n)
            ahead = later.y + (self.lags[m] * later.unit - later.lag) * rate[:, n]
            self.out[m, :, later.which] = self._index(ahead, later).T


def _speed(rate: Floats) -> Floats:
    """Return the greatest component of a rate, (N,)."""
    size = np.abs(rate)
    return np.asarray(np.maximum(size[0], size[1]))
