"""A trace slice as its neighbours foretell it.

Two ways. Along one path: the positions at earlier lags are continued by a polynomial, in the
displacement or in the mean velocity since lag zero. From path to path: whoever has come half the
way is where another path begins, and that one's first half is known, so a slice is put together
from earlier ones: S(Td, Ts) (x) = S(Td', Ts) (S(Td, Td') (x)). Where the units of lag differ, it
may take more than two pieces.

A prediction decides how many bytes a slice takes and never what is restored, so what the slices
do not tell is guessed: which axes go around, and how a path goes on beyond its end.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex.field.interpolation import bracket

__all__ = ["BY_LAG", "COMPOSED", "Geometry", "History"]

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]

#: Ways to predict: polynomials by degree, and composition.
BY_LAG = ("mean 0", "mean 1", "mean 2", "path 1", "path 2", "path 3")
COMPOSED = "composed"
#: Pieces that a path is put together from, at most, and a share of its lag that is nothing.
PIECES, CLOSE = 4, 1e-6


@dataclass(frozen=True)
class Geometry:
    """What is known of slices before any of them.

    Attributes
    ----------
    lags, unit, times
        As in :class:`~flowtex.trace.TraceSlices`.
    origin, spacing
        Index (i, j) of the first entry, and from one entry to the next, (2,).
    moving
        Whether the destination times lie apart by lags, so that paths go from one to the other.
    """

    lags: Floats
    unit: Floats
    times: Floats
    origin: Floats
    spacing: Floats
    moving: bool

    @classmethod
    def of(
        cls, lags: Floats, unit: Floats, times: Floats, nodes: Floats, parameter: str
    ) -> Geometry:
        """Read the geometry from the attributes of slices."""
        ends = nodes[-1, -1] - nodes[0, 0]
        spacing = ends / np.maximum(np.array(unit.shape[::-1]) - 1, 1)
        return cls(
            lags,
            unit,
            times,
            nodes[0, 0],
            np.where(spacing > 0, spacing, 1.0),
            parameter == "time" and len(times) > 1,
        )


class History:
    """Slices of one side that are known so far, from the shortest lag up.

    Parameters
    ----------
    geometry
        Where and when they are.
    rate
        Derivative of the displacement by lag at lag zero on this side, (T, J, I, 2).
    reach
        Lag at which paths end, (T, J, I).
    """

    def __init__(self, geometry: Geometry, rate: Floats, reach: NDArray[np.floating]) -> None:
        self._geometry = geometry
        self._knots = np.concatenate([[0.0], geometry.lags])
        self._slices = [np.zeros_like(rate)]
        self._means = [_finite(rate)]
        self._reach = reach

    def add(self, displacement: NDArray[np.floating]) -> None:
        """Add the next slice, (T, J, I, 2)."""
        known = _finite(displacement)
        self._means.append(known / self._knots[len(self._slices)])
        self._slices.append(known)

    def ways(self) -> tuple[str, ...]:
        """Ways in which the next slice can be predicted."""
        count = len(self._slices)
        by_lag = tuple(way for way in BY_LAG if int(way[-1]) < count)
        return (*by_lag, COMPOSED) if count > 1 else by_lag

    def predict(self, way: str) -> Floats:
        """Predict the next slice, (T, J, I, 2)."""
        if way == COMPOSED:
            return self._composed()
        kind, degree = way.split()
        if kind == "path":
            return self._continued(self._slices, int(degree))
        return np.asarray(
            self._continued(self._means, int(degree)) * self._knots[len(self._slices)]
        )

    def _continued(self, values: list[Floats], degree: int) -> Floats:
        """Polynomial through the last known values, at the next lag."""
        last, at = len(self._slices), self._knots[len(self._slices)]
        some = range(last - degree - 1, last)
        total = np.zeros_like(values[0])
        for k in some:
            others = [self._knots[n] for n in some if n != k]
            weight = float(np.prod([(at - x) / (self._knots[k] - x) for x in others]))
            total += weight * values[k]
        return total

    def _composed(self) -> Floats:
        """Put the next slice together from the last one and what came before it."""
        g, last = self._geometry, len(self._slices) - 1
        half, whole = self._knots[last : last + 2]
        total = self._slices[-1].copy()
        means = np.stack(self._means).reshape(-1, 2)
        gone = np.broadcast_to(half * g.unit, total.shape[:3]).copy()
        for piece in range(1, PIECES + 1):
            left = whole * g.unit - gone
            if (left <= CLOSE * whole * g.unit).all():
                break
            moved, lag = self._piece(means, total, gone, left, np.inf if piece == PIECES else half)
            total += moved
            gone += lag
        ended = self._reach < half
        if ended.any():
            straight = self._continued(self._slices, 1)
            total[ended] = straight[ended]
        return total

    def _piece(
        self, means: Floats, moved: Floats, gone: Floats, left: Floats, longest: float
    ) -> tuple[Floats, Floats]:
        """Go on from where paths have come to; how far, and for what lag in the field's units."""
        g = self._geometry
        steps, rows, columns, _ = moved.shape
        corners = _corners(moved / g.spacing, self._around())
        unit = np.zeros(left.shape)
        for corner, share in corners:
            unit += share * g.unit.ravel()[corner]
        lag = np.minimum(left / unit, longest)
        total = np.zeros(moved.shape)
        before, late = self._steps(gone)
        for corner, share in corners:
            for step, part in ((before, 1 - late), (np.minimum(before + 1, steps - 1), late)):
                if part.any():
                    entry = step * (rows * columns) + corner
                    found = self._looked_up(means, entry, lag, steps * rows * columns)
                    total += (part * share)[..., None] * found
        return total, lag * unit

    def _steps(self, gone: Floats) -> tuple[Ints, Floats]:
        """Destination time that lies a lag before each, (T, J, I), as step and fraction."""
        g = self._geometry
        count = len(g.times)
        here = np.arange(count).reshape(-1, 1, 1)
        if not g.moving:
            return np.broadcast_to(here, gone.shape), np.zeros(gone.shape)
        then = np.clip(g.times.reshape(-1, 1, 1) - gone, g.times[0], g.times[-1])
        return bracket(g.times, then)

    def _looked_up(self, means: Floats, entry: Ints, lag: Floats, slice_size: int) -> Floats:
        """Displacements at entries of the known slices and at any lag, (T, J, I, 2)."""
        last = len(self._slices) - 1
        knots = self._knots[: last + 1]
        m, late = bracket(knots, lag)
        at = m * slice_size + entry
        one, two = means[at], means[at + slice_size]
        return np.asarray(lag[..., None] * (one + (two - one) * late[..., None]))

    def _around(self) -> tuple[bool, bool]:
        """Whether the (j, i) axis seems to go around: its first and last line are equal."""
        last = self._slices[-1]
        pairs = ((last[:, 0], last[:, -1]), (last[:, :, 0], last[:, :, -1]))
        over_j, over_i = (bool(np.allclose(a, b, rtol=1e-3, atol=1e-3)) for a, b in pairs)
        return over_j, over_i


def _corners(moved: Floats, around: tuple[bool, bool]) -> list[tuple[Ints, Floats]]:
    """Entries around each entry moved by so many entries, and their bilinear shares."""
    rows, columns = moved.shape[1:3]
    parts = []
    for axis, count in ((1, rows), (0, columns)):
        own = np.arange(count).reshape((-1, 1) if axis else (1, -1))
        x = own + moved[..., axis]
        if count == 1:
            parts.append([(np.zeros(x.shape, np.intp), np.ones(x.shape))])
            continue
        cells = count - 1
        x = x - cells * np.floor(x / cells) if around[1 - axis] else np.clip(x, 0, cells)
        low = np.clip(np.floor(x).astype(np.intp), 0, cells - 1)
        parts.append([(low, 1 - (x - low)), (low + 1, x - low)])
    return [(j * columns + i, a * b) for j, a in parts[0] for i, b in parts[1]]


def _finite(values: NDArray[np.floating]) -> Floats:
    return np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
