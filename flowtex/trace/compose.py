"""Long paths of a steady field put together from short ones.

A path by a steady field does not depend on when it is followed, so the path of lag 2 s is the
path of lag s, continued by the path of lag s from where that one ends (hierarchical line
integration, Hlawatsch, Sadlo and Weiskopf 2011). Each doubling costs two look-ups for each node,
whatever the length, where integration would cost as many steps as the path has cells.

The error of a look-up is that of bilinear interpolation in a slice, the same that drawing makes
for every pixel between the nodes; it grows with the lag, but so does the size of the pixels at
which a lag that long is seen.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField

__all__ = ["compose"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]

#: Look-ups in one doubling: paths that run into far smaller cells need more than two.
MOST_HOPS = 48


class _Short:
    """The slices found so far, looked up anywhere at any lag up to the last of them."""

    def __init__(
        self, field: FlowField, lags: Floats, unit: Floats, mean: Singles, reach: Singles
    ) -> None:
        self._rows, self._columns = field.shape
        self._periodic = field.periodic
        self._knots = np.concatenate([[0.0], lags]).astype(np.float32)
        self._unit = unit.reshape(-1).astype(np.float32)
        self._mean = mean.reshape(len(lags) + 1, -1, 2)
        self._reach = np.minimum(reach.reshape(-1), np.float32(lags[-1] * 4))

    def corners(self, y: Singles) -> tuple[Indices, Singles, Singles]:
        x = self._fold(y[:, 0], self._columns - 1, closed=self._periodic[1])
        z = self._fold(y[:, 1], self._rows - 1, closed=self._periodic[0])
        i = np.minimum(x.astype(np.intp), self._columns - 2)
        j = np.minimum(z.astype(np.intp), self._rows - 2)
        return j * self._columns + i, x - i, z - j

    def blend(self, nodes: NDArray[np.float32], at: Indices, s: Singles, t: Singles) -> Singles:
        if nodes.ndim > 1:
            s, t = s[:, None], t[:, None]
        up = at + self._columns
        low = nodes[at] * (1 - s) + nodes[at + 1] * s
        return np.asarray(low * (1 - t) + (nodes[up] * (1 - s) + nodes[up + 1] * s) * t)

    def hop(self, y: Singles, wanted: Singles) -> tuple[Singles, Singles, Singles]:
        """Follow the path from y for up to ``wanted`` of lag: displacement, lag done, reach."""
        at, s, t = self.corners(y)
        unit = self.blend(self._unit, at, s, t)
        lag = np.minimum(wanted / unit, self._knots[-1])
        m = np.clip(np.searchsorted(self._knots, lag) - 1, 0, len(self._knots) - 2)
        late = ((lag - self._knots[m]) / (self._knots[m + 1] - self._knots[m]))[:, None]
        nodes = self._mean.shape[1]
        flat = self._mean.reshape(-1, 2)
        before = self.blend(flat, at + m * nodes, s, t)
        after = self.blend(flat, at + (m + 1) * nodes, s, t)
        displacement = lag[:, None] * (before * (1 - late) + after * late)
        return displacement, lag * unit, self.blend(self._reach, at, s, t) * unit

    @staticmethod
    def _fold(x: Singles, period: int, *, closed: bool) -> Singles:
        return np.asarray(np.mod(x, period) if closed else np.clip(x, 0, period))


def compose(
    field: FlowField,
    lags: Floats,
    unit: Floats,
    rate: Floats,
    displacement: Singles,
    reach: Singles,
    known: int,
) -> None:
    """Fill the slices from number ``known`` on, in place.

    Parameters
    ----------
    field
        The steady flow.
    lags
        All lags, (M,), each at most about twice the one before, in multiples of ``unit``.
    unit
        One unit of lag at each node, (J, I).
    rate
        Derivative of the displacement by lag at lag zero, (J, I, 2).
    displacement
        Slices, (M, J, I, 2); the first ``known`` are given.
    reach
        Lag at which each path ended, (J, I), infinite where it did not within what is known.
    known
        How many slices are given.
    """
    size = unit.size
    mean = np.empty((len(lags) + 1, size, 2), np.float32)
    mean[0] = rate.reshape(-1, 2)
    columns = field.shape[1]
    nodes = np.arange(size)
    start = np.stack([nodes % columns, nodes // columns], axis=-1).astype(np.float32)
    units = unit.ravel().astype(np.float32)
    for m in range(len(lags)):
        if m >= known:
            done = _Short(field, lags[:m], unit, mean[: m + 1], reach)
            moved, end = _double(done, start, units, lags, m, mean, reach.ravel())
            displacement[m] = moved.reshape(displacement[m].shape)
            reach[...] = end.reshape(reach.shape)
        mean[m + 1] = displacement[m].reshape(-1, 2) / np.float32(lags[m])


def _double(
    done: _Short,
    start: Singles,
    units: Singles,
    lags: Floats,
    m: int,
    mean: Singles,
    reach: Singles,
) -> tuple[Singles, Singles]:
    """Displacements at lag number m, and how far the paths reach now."""
    first = np.float32(lags[m - 1])
    moved = mean[m] * first
    left = np.float32(lags[m] - lags[m - 1]) * units
    end = reach.copy()
    which = np.arange(len(start))
    for _ in range(MOST_HOPS):
        step, gone, reached = done.hop(start[which] + moved[which], left[which])
        travelled = np.float32(lags[m]) * units[which] - left[which]
        stops = np.isinf(end[which]) & (reached < gone)
        end[which[stops]] = ((travelled + reached) / units[which])[stops]
        moved[which] += step
        left[which] -= gone
        which = which[left[which] > 1e-4 * units[which] * first]
        if not len(which):
            break
    return moved, end
