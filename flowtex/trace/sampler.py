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

__all__ = ["LengthSampler", "Sampler", "TimeSampler"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: A particle slower than this share of the greatest speed has stopped.
STOPPED = 1e-7


class Sampler(Protocol):
    """What the integrator asks of a field."""

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Rate of change of (i, j) by lag for particles (N, 2) that have come ``lag`` (N,)."""
        ...

    def alive(self, position: Floats) -> NDArray[np.bool_]:
        """Whether particles (N, 2) are inside the domain, in a cell that is not blanked."""
        ...


class _Grid:
    """Bilinear look-ups in nodal arrays of a field, flattened to (J * I, components)."""

    def __init__(self, field: FlowField) -> None:
        self._rows, self._columns = field.shape
        self._periodic = field.periodic
        self._cells = field.surface.cells.ravel()

    def corners(self, position: Floats) -> tuple[Indices, Floats, Floats]:
        """Lower corner of each particle's cell, and the fractions inside it."""
        x = self._fold(position[:, 0], self._columns - 1, closed=self._periodic[1])
        y = self._fold(position[:, 1], self._rows - 1, closed=self._periodic[0])
        i = np.minimum(x.astype(np.intp), self._columns - 2)
        j = np.minimum(y.astype(np.intp), self._rows - 2)
        return j * self._columns + i, x - i, y - j

    def bilinear(self, data: Floats, at: Indices, s: Floats, t: Floats) -> Floats:
        """Interpolate (J * I, C) data at the corners found by :meth:`corners`, (N, C)."""
        s, t = s[:, None], t[:, None]
        low = data[at] * (1 - s) + data[at + 1] * s
        above = at + self._columns
        return np.asarray(low * (1 - t) + (data[above] * (1 - s) + data[above + 1] * s) * t)

    def alive(self, position: Floats) -> NDArray[np.bool_]:
        x, y = position[:, 0], position[:, 1]
        inside = np.ones(len(x), dtype=bool)
        if not self._periodic[1]:
            inside &= (x >= 0) & (x <= self._columns - 1)
        if not self._periodic[0]:
            inside &= (y >= 0) & (y <= self._rows - 1)
        at, _, _ = self.corners(position)
        j, i = np.divmod(at, self._columns)
        return np.asarray(inside & self._cells[j * (self._columns - 1) + i])

    @staticmethod
    def _fold(x: Floats, period: int, *, closed: bool) -> Floats:
        return np.asarray(np.mod(x, period) if closed else np.clip(x, 0, period))


class LengthSampler(_Grid):
    """A steady field by arc length: the direction of the flow, at unit speed in space.

    Beside a critical point the speed that divides is that of the nodes around it, so a path
    comes to rest there instead of jumping across.
    """

    def __init__(self, field: FlowField) -> None:
        super().__init__(field)
        flow = field.index_velocity
        speed = flow.speed[0]
        self._floor = max(STOPPED * float(speed.max()), np.finfo(float).tiny)
        data = np.concatenate([flow.components[0], speed[..., None]], axis=-1)
        self._data = _spread(data, field).reshape(-1, 3)

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Index-space direction for one unit of length."""
        del lag
        v = self.bilinear(self._data, *self.corners(position))
        speed = v[:, 2]
        moving = speed > self._floor
        scale = np.where(moving, direction / np.where(moving, speed, 1.0), 0.0)
        return np.asarray(v[:, :2] * scale[:, None])


class TimeSampler(_Grid):
    """A field by its own time, seen from the destination time ``destination``."""

    def __init__(self, field: FlowField, destination: float) -> None:
        super().__init__(field)
        self._times = field.times
        self._destination = destination
        steps = field.index_velocity.components
        self._data = [_spread(step, field).reshape(-1, 2) for step in steps]
        if len(self._data) > 1:
            self._stacked = np.concatenate(self._data)

    def rate(self, position: Floats, lag: Floats, direction: float) -> Floats:
        """Index-space velocity at time destination + direction * lag."""
        at, s, t = self.corners(position)
        if len(self._data) == 1:
            return direction * self.bilinear(self._data[0], at, s, t)
        time = self._destination + direction * lag
        step = np.clip(np.searchsorted(self._times, time) - 1, 0, len(self._times) - 2)
        width = self._times[step + 1] - self._times[step]
        late = np.clip((time - self._times[step]) / width, 0, 1)[:, None]
        nodes = len(self._data[0])
        before = self.bilinear(self._stacked, at + step * nodes, s, t)
        after = self.bilinear(self._stacked, at + (step + 1) * nodes, s, t)
        return np.asarray(direction * (before * (1 - late) + after * late))


def _spread(data: Floats, field: FlowField) -> Floats:
    """Give blanked nodes the value of the nearest valid one."""
    if field.valid.all():
        return data
    nearest = ndimage.distance_transform_edt(
        ~field.valid, return_distances=False, return_indices=True
    )
    return np.asarray(data[tuple(nearest)])
