"""The velocity between the nodes and between the time steps.

A sampler gives the rate of change of a particle's position in index space, (di, dj) per unit of
lag, anywhere: bilinear in space, linear in time, constant beyond the border of the domain and
before the first time step. Blanked nodes take the velocity of the nearest valid one, so a path
that grazes a blanked region bends as its neighbours do until it is ended there. Next to a pole it
gives the same in the plane there (see :mod:`flowtex.trace.charts`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex.field import FlowField
from flowtex.field.interpolation import bracket, fill_blanked
from flowtex.trace.charts import LEAST_ROOM_CELLS, Charts, NodeGrid, Numbers, Patch, cap

#: A particle slower than this share of the greatest speed has stopped.
STOPPED_SPEED = 1e-7
#: Pairs of tangents whose products make the metric.
METRIC = ((0, 0), (0, 1), (1, 1))
#: By arc length, a particle this slow, in cells over one unit of lag, is at a critical point.
RESTING_CELLS = 1e-3
#: By time, a particle is at rest that goes no further than this, in cells, until the last lag.
STILL_CELLS = 1e-5


class Sampler(ABC):
    """The field as the integrator samples it.

    Positions and rates are (2, N): as (i, j), or on the charts (N,) that are given with them. The
    data are components along i and j, and other values to interpolate, (T, J, I, C).
    """

    #: Longest step in units of lag, so that no change in time is missed.
    longest = np.inf
    #: Times of the data, and the one from which lags count.
    times = np.zeros(1)
    destination = 0.0
    #: Speed up to which a particle has stopped.
    floor = 0.0

    def __init__(self, field: FlowField, data: Floats) -> None:
        data = fill_blanked(data, field.valid, data.ndim - 3)
        parts = [np.ascontiguousarray(data[..., c]).ravel() for c in range(data.shape[-1])]
        grid = NodeGrid.of(field)
        self._poles = poles = field.surface.poles
        #: The charts of a surface that has poles.
        self.charts = None if poles is None else Charts(poles)
        #: Whether particles are inside the domain, in a cell that is not blanked.
        self.alive = grid.alive
        self.grid = grid
        self._patches = [Patch(grid, parts)]
        if poles is not None and self.charts is not None:
            self._patches += [cap(pole, grid, parts, self.charts.near) for pole in poles]
        self._axes: _Axes | None = None
        if field.sign_free:
            self._axes = _Axes(field, grid)
            flat, *caps = self._patches
            flat = flat.without_sign(fill_blanked(field.velocity[0], field.valid))
            self._patches = [flat, *(patch.without_sign() for patch in caps)]

    def rate(
        self,
        position: Floats,
        lag: Floats,
        direction: float,
        chart: Numbers | None = None,
        ahead: Floats | None = None,
    ) -> Floats:
        """Return rates of change of positions by lag for particles at ``lag`` (N,).

        In a sign-free field with ``ahead`` (2, N) it is the one of both rates that leads ahead,
        in either direction.
        """
        if chart is None or not chart.any():
            result = self._rate(self._patches[0], position, lag, direction)
        else:
            result = np.empty_like(position)
            for number, patch in enumerate(self._patches):
                at = np.flatnonzero(chart == number)
                if len(at):
                    result[:, at] = self._rate(patch, position[:, at], lag[at], direction)
        if self._poles is not None and chart is not None:
            # Beyond a pole index space runs the other way.
            turned = (chart == 0) & self._poles.mirrored(position)
            result[self._poles.component, turned] *= -1
        if self._axes is not None and ahead is not None:
            result *= self._axes.sign(position, result, ahead, chart)
            return result
        return np.negative(result, out=result) if direction < 0 else result

    def room(self, position: Floats) -> AnyArray | int:
        """Return the cells that particles may move at once, for all or (N,)."""
        return self.grid.room_at(position) if self.charts is None else LEAST_ROOM_CELLS

    def span(self, direction: float) -> float:
        """Return the lag to the first or last time step, beyond which the flow is constant."""
        return float(direction * (self.times[0 if direction < 0 else -1] - self.destination))

    @abstractmethod
    def rest(self, unit: Floats, last: float) -> Floats:
        """Return rates (N,) below which a particle is at rest, for lags up to ``last * unit``."""

    @abstractmethod
    def _rate(self, patch: Patch, position: Floats, lag: Floats, direction: float) -> Floats:
        """Return the rate on one chart, forward."""


class _Axes:
    """Choice between the two directions of a sign-free velocity."""

    def __init__(self, field: FlowField, grid: NodeGrid) -> None:
        p = field.surface.tangents
        self._grid, self._poles = grid, field.surface.poles
        self._metric = [np.sum(p[a] * p[b], axis=-1).ravel() for a, b in METRIC]

    def sign(self, position: Floats, one: Floats, two: Floats, chart: Numbers | None) -> Floats:
        """Return 1, or -1 where rates (2, N) form an angle above 90 degrees in space, (N,)."""
        along = one[0] * two[0] + one[1] * two[1]
        flat = slice(None) if chart is None else np.flatnonzero(chart == 0)
        flat_position, (a, b), (c, d) = position[:, flat], one[:, flat], two[:, flat]
        at = self._grid.corners(flat_position).at
        ii, ij, jj = (part[at] for part in self._metric)
        if self._poles is not None:
            ij = np.where(self._poles.mirrored(flat_position), -ij, ij)
        along[flat] = ii * a * c + ij * (a * d + b * c) + jj * b * d
        return np.where(along < 0, -1.0, 1.0)


class LengthSampler(Sampler):
    """A steady field by arc length: the direction of the flow, at unit speed in space.

    Beside a critical point the velocity is divided by the interpolated speed of the nodes, so a
    path comes to rest there instead of passing it.
    """

    def __init__(self, field: FlowField) -> None:
        flow = field.index_velocity
        speed = flow.speed[..., None]
        super().__init__(field, np.concatenate([flow.components, speed], axis=-1))
        self.floor = max(STOPPED_SPEED * float(speed.max()), np.finfo(float).tiny)

    def _rate(self, patch: Patch, position: Floats, lag: Floats, direction: float) -> Floats:
        """Return the direction for one unit of length."""
        del lag, direction
        corners = patch.corners(position)
        speed = patch.blend(2, corners)
        still = speed <= self.floor
        speed[still] = np.inf
        result = np.empty_like(position)
        np.divide(patch.blend(0, corners), speed, out=result[0])
        np.divide(patch.blend(1, corners), speed, out=result[1])
        return result

    def rest(self, unit: Floats, last: float) -> Floats:
        """Return rates below which a particle is at rest; moving ones cover a cell per unit."""
        del last
        return RESTING_CELLS / unit


class TimeSampler(Sampler):
    """A field by its own time; lags count from the time of step number ``step``."""

    def __init__(self, field: FlowField) -> None:
        super().__init__(field, field.index_velocity.components)
        self.times = field.times
        self.destination = float(field.times[-1])
        self.longest = np.inf if field.steady else float(np.diff(field.times).max())

    def since(self, destination: float) -> TimeSampler:
        """Return this sampler with lags counted from another destination time."""
        other = object.__new__(TimeSampler)
        other.__dict__.update(self.__dict__, destination=destination)
        return other

    def _rate(self, patch: Patch, position: Floats, lag: Floats, direction: float) -> Floats:
        """Return the velocity at time destination + direction * lag."""
        corners = patch.corners(position)
        if len(self.times) == 1:
            return np.stack([patch.blend(0, corners), patch.blend(1, corners)])
        step, late = bracket(self.times, self.destination + direction * lag, side="left")
        np.clip(late, 0, 1, out=late)
        result = np.empty((2, len(lag)))
        for component, row in enumerate(result):
            before = patch.blend(component, corners, step)
            row[:] = patch.blend(component, corners, step + 1)
            row -= before
            row *= late
            row += before
        return result

    def rest(self, unit: Floats, last: float) -> Floats:
        """Return rates below which a particle is at rest; in a time-varying flow none stays so."""
        return np.full(len(unit), 0.0 if len(self.times) > 1 else STILL_CELLS) / (unit * last)
