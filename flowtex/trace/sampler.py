"""The velocity between the nodes and between the time steps.

A sampler gives the rate of change of a particle's position in index space, (di, dj) per unit of
lag, anywhere: bilinear in space, linear in time, constant beyond the border of the domain and
before the first time step. Blanked nodes take the velocity of the nearest valid one, so a path
that grazes a blanked region bends as its neighbours do until it is ended there.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from flowtex.field import FlowField
from flowtex.trace.lattice import Corners, Lattice

__all__ = ["LengthSampler", "Sampler", "TimeSampler"]

Floats = NDArray[np.float64]

#: A particle slower than this share of the greatest speed has stopped.
STOPPED = 1e-7
#: By arc length, a particle this slow, in cells over one unit of lag, is at a critical point.
RESTING = 1e-3


class Sampler(Protocol):
    """What the integrator asks of a field. Positions and rates are (2, N), as (i, j)."""

    #: Longest step in units of lag, so that no change in time is jumped over.
    longest: float

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Rate of change of (i, j) by lag for particles that have come ``lag`` (N,)."""
        ...

    def alive(self, position: Floats, edge: float = ...) -> NDArray[np.bool_]:
        """Whether particles are inside the domain, in a cell that is not blanked, (N,)."""
        ...

    def rest(self, unit: Floats, last: float) -> Floats:
        """Rate (N,) below which a particle stands still, for lags up to ``last * unit``."""
        ...


class LengthSampler(Lattice):
    """A steady field by arc length: the direction of the flow, at unit speed in space.

    Beside a critical point the speed that divides is that of the nodes around it, so a path
    comes to rest there instead of jumping across.
    """

    longest = np.inf

    def __init__(self, field: FlowField) -> None:
        super().__init__(field.shape, field.periodic, field.surface.cells)
        flow = field.index_velocity
        speed = flow.speed[0]
        self._floor = max(STOPPED * float(speed.max()), np.finfo(float).tiny)
        data = np.concatenate([flow.components[0], speed[..., None]], axis=-1)
        self._i, self._j, self._speed = _spread(data, field)

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Index-space direction for one unit of length."""
        del lag
        corners = self.corners(position)
        speed = self.blend(self._speed, corners)
        still = speed <= self._floor
        speed[still] = np.inf
        result = np.empty_like(position)
        np.divide(self.blend(self._i, corners), speed, out=result[0])
        np.divide(self.blend(self._j, corners), speed, out=result[1])
        return np.negative(result, out=result) if direction < 0 else result

    def rest(self, unit: Floats, last: float) -> Floats:
        """Rate below which a particle has come to rest: those that move cover a cell a unit."""
        del last
        return RESTING / unit


class TimeSampler(Lattice):
    """A field by its own time; lags count from the time of step number ``step``."""

    def __init__(self, field: FlowField) -> None:
        super().__init__(field.shape, field.periodic, field.surface.cells)
        self._times = field.times
        self._i, self._j = _spread(field.index_velocity.components, field)
        self._destination = float(field.times[-1])
        self.longest = np.inf if field.steady else float(np.diff(field.times).max())

    def since(self, destination: float) -> TimeSampler:
        """Return this sampler with lags counted from another destination time."""
        other = object.__new__(TimeSampler)
        other.__dict__.update(self.__dict__, _destination=destination)
        return other

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Index-space velocity at time destination + direction * lag."""
        corners = self.corners(position)
        if len(self._times) == 1:
            result = np.stack([self.blend(self._i, corners), self.blend(self._j, corners)])
        else:
            result = self._at_time(corners, self._destination + direction * lag)
        return np.negative(result, out=result) if direction < 0 else result

    def rest(self, unit: Floats, last: float) -> Floats:
        """Rate at which a particle gets nowhere; in a flow that varies none stays at rest."""
        return np.full(len(unit), 0.0 if len(self._times) > 1 else 1e-5) / (unit * last)

    def _at_time(self, corners: Corners, time: Floats) -> Floats:
        step = np.searchsorted(self._times, time) - 1
        np.clip(step, 0, len(self._times) - 2, out=step)
        width = self._times[step + 1] - self._times[step]
        late = np.clip((time - self._times[step]) / width, 0, 1)
        result = np.empty((2, len(time)))
        base = step * self.size
        for row, data in zip(result, (self._i, self._j), strict=True):
            before = self.blend(data, corners, base)
            row[:] = self.blend(data, corners, base + self.size)
            row -= before
            row *= late
            row += before
        return result


def _spread(data: Floats, field: FlowField) -> list[Floats]:
    """Components of (..., J, I, C) data, each flat; blanked nodes get their neighbours' value."""
    if not field.valid.all():
        nearest = ndimage.distance_transform_edt(
            ~field.valid, return_distances=False, return_indices=True
        )
        data = data[(..., *tuple(nearest), slice(None))]
    return [np.ascontiguousarray(data[..., c]).ravel() for c in range(data.shape[-1])]
