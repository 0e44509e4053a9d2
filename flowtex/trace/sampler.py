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
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Floats
from flowtex.field import FlowField
from flowtex.field.interpolation import bracket, fill_blanked
from flowtex.trace.charts import Charts, Patch, cap
from flowtex.trace.node_grid import LEAST_ROOM_CELLS, NodeGrid

#: A particle slower than this share of the greatest speed has stopped.
STOPPED_SPEED = 1e-7
#: Pairs of tangents whose products make the metric.
METRIC = ((0, 0), (0, 1), (1, 1))
#: By arc length, a particle this slow, in cells over one unit of lag, is at a critical point.
RESTING_CELLS = 1e-3
#: By time, a particle is at rest that goes no further than this, in cells, until the last lag.
STILL_CELLS = 1e-5


class Sampler(ABC):
    """What the integrator asks of a field.

    Positions and rates are (2, N): as (i, j), or on the charts (N,) that are given with them. The
    data are components along i and j, and anything else that is interpolated, (T, J, I, C).
    """

    #: Longest step in units of lag, so that no change in time is jumped over.
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
        chart: NDArray[np.int8] | None = None,
        ahead: Floats | None = None,
    ) -> Floats:
        """Rate of change of positions by lag for particles that have come ``lag`` (N,).

        In a sign-free field, that of the two which leads ``ahead`` (2, N), where it is given,
        whatever the direction.
        """
        if chart is None or not chart.any():
            result = self._rate(self._patches[0], position, lag, direction)
        else:
            result = np.empty_like(position)
            for number, patch in enumerate(self._patches):
                some = np.flatnonzero(chart == number)
                if len(some):
                    result[:, some] = self._rate(patch, position[:, some], lag[some], direction)
        if self._poles is not None and chart is not None:
            # Beyond a pole index space runs the other way.
            turned = (chart == 0) & self._poles.mirrored(position)
            result[self._poles.component, turned] *= -1
        if self._axes is not None and ahead is not None:
            result *= self._axes.sign(position, result, ahead, chart)
            return result
        return np.negative(result, out=result) if direction < 0 else result

    def room(self, position: Floats) -> AnyArray | int:
        """Cells that particles may move at once, the same for all or (N,)."""
        return self.grid.room_at(position) if self.charts is None else LEAST_ROOM_CELLS

    def span(self, direction: float) -> float:
        """Lag up to which the flow changes in time: to the first time step, or to the last."""
        return float(direction * (self.times[0 if direction < 0 else -1] - self.destination))

    @abstractmethod
    def rest(self, unit: Floats, last: float) -> Floats:
        """Rate (N,) below which a particle stands still, for lags up to ``last * unit``."""

    @abstractmethod
    def _rate(self, patch: Patch, position: Floats, lag: Floats, direction: float) -> Floats:
        """Rate on one chart, forward."""


class _Axes:
    """Choice between the two directions of a velocity whose sign means nothing."""

    def __init__(self, field: FlowField, grid: NodeGrid) -> None:
        p = field.surface.tangents
        self._grid, self._poles = grid, field.surface.poles
        self._metric = [np.sum(p[a] * p[b], axis=-1).ravel() for a, b in METRIC]

    def sign(
        self, position: Floats, one: Floats, two: Floats, chart: NDArray[np.int8] | None
    ) -> Floats:
        """Sign of the angle between rates (2, N) in space, -1 where it is more than 90 degrees."""
        along = one[0] * two[0] + one[1] * two[1]
        flat = slice(None) if chart is None else np.flatnonzero(chart == 0)
        here, (a, b), (c, d) = position[:, flat], one[:, flat], two[:, flat]
        at = self._grid.corners(here).at
        ii, ij, jj = (part[at] for part in self._metric)
        if self._poles is not None:
            ij = np.where(self._poles.mirrored(here), -ij, ij)
        along[flat] = ii * a * c + ij * (a * d + b * c) + jj * b * d
        return np.where(along < 0, -1.0, 1.0)


class LengthSampler(Sampler):
    """A steady field by arc length: the direction of the flow, at unit speed in space.

    Beside a critical point the speed that divides is that of the nodes around it, so a path
    comes to rest there instead of jumping across.
    """

    def __init__(self, field: FlowField) -> None:
        flow = field.index_velocity
        speed = flow.speed[..., None]
        super().__init__(field, np.concatenate([flow.components, speed], axis=-1))
        self.floor = max(STOPPED_SPEED * float(speed.max()), np.finfo(float).tiny)

    def _rate(self, patch: Patch, position: Floats, lag: Floats, direction: float) -> Floats:
        """Direction for one unit of length."""
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
        """Rate below which a particle has come to rest: those that move cover a cell a unit."""
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
        """Velocity at time destination + direction * lag."""
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
        """Rate at which a particle gets nowhere; in a flow that varies none stays at rest."""
        return np.full(len(unit), 0.0 if len(self.times) > 1 else STILL_CELLS) / (unit * last)
