"""Predict a slice from slices of shorter lag.

Two ways. Along one path: a polynomial through the positions at shorter lags, or through the mean
velocities since lag zero, is continued to the next lag. From path to path: a particle that has
gone half the lag is where another path begins, whose first half is known, so a slice is composed
of shorter ones: S(Td, Ts)(x) = S(Td', Ts)(S(Td, Td')(x)). Where the units of lag differ it may
take more than two pieces.

Slices do not tell which axes are periodic and how a path continues beyond its end. Both are
guessed: a wrong guess makes a prediction worse and never a result wrong.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Indices
from flowtex.field.interpolation import bracket
from flowtex.trace.slices import TraceSlices

#: Ways to predict: polynomials by degree, and composition.
BY_LAG = ("mean 0", "mean 1", "mean 2", "path 1", "path 2", "path 3")
COMPOSED = "composed"
#: Most pieces that a path is composed of, and the share of its lag that may be missing.
MAX_PIECES, LAG_TOLERANCE = 4, 1e-6
#: Largest difference, in cells, between the first and last line of a periodic axis.
SEAM_TOLERANCE = 1e-3


@dataclass(frozen=True)
class SliceGrid:
    """Entries, lags and times of slices.

    Attributes
    ----------
    lags, unit, times
        As in :class:`~flowtex.TraceSlices`.
    spacing
        Index (i, j) from one entry to the next, (2,).
    moving
        Whether the destination times lie apart by lags, so that paths lead from one to another.
    """

    lags: Floats
    unit: Floats
    times: Floats
    spacing: Floats
    moving: bool

    @classmethod
    def of(cls, slices: TraceSlices) -> SliceGrid:
        """Return the grid of slices."""
        size = slices.nodes[-1, -1] - slices.nodes[0, 0]
        spacing = size / np.maximum(np.array(slices.shape[::-1]) - 1, 1)
        return cls(
            slices.lags,
            slices.unit,
            slices.times,
            np.where(spacing > 0, spacing, 1.0),
            slices.parameter == "time" and len(slices.times) > 1,
        )


class Predictor:
    """Predicts the next slice of one side from those added so far, from the shortest lag up.

    Parameters
    ----------
    grid
        Entries, lags and times of the slices.
    rate
        Derivative of the displacement by lag at lag zero on this side, (T, J, I, 2).
    reach
        Lag at which paths end, (T, J, I).
    """

    def __init__(self, grid: SliceGrid, rate: Floats, reach: NDArray[np.floating[Any]]) -> None:
        self._grid = grid
        self._knots = np.concatenate([[0.0], grid.lags])
        self._slices = [np.zeros_like(rate)]
        self._means = [_finite(rate)]
        self._reach = reach

    def add(self, displacement: NDArray[np.floating[Any]]) -> None:
        """Add the next slice, (T, J, I, 2)."""
        values = _finite(displacement)
        self._means.append(values / self._knots[len(self._slices)])
        self._slices.append(values)

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
            return self._extrapolated(self._slices, int(degree))
        mean = self._extrapolated(self._means, int(degree))
        return np.asarray(mean * self._knots[len(self._slices)])

    def _extrapolated(self, values: list[Floats], degree: int) -> Floats:
        """Continue the polynomial through the last values to the next lag."""
        count, lag = len(self._slices), self._knots[len(self._slices)]
        support = range(count - degree - 1, count)
        total = np.zeros_like(values[0])
        for k in support:
            others = [self._knots[n] for n in support if n != k]
            weight = float(np.prod([(lag - x) / (self._knots[k] - x) for x in others]))
            total += weight * values[k]
        return total

    def _composed(self) -> Floats:
        """Compose the next slice of the last one and those before it."""
        grid, last = self._grid, len(self._slices) - 1
        half, whole = self._knots[last : last + 2]
        total = self._slices[-1].copy()
        means = np.stack(self._means).reshape(-1, 2)
        elapsed = np.broadcast_to(half * grid.unit, total.shape[:3]).copy()
        for piece in range(1, MAX_PIECES + 1):
            missing = whole * grid.unit - elapsed
            if (missing <= LAG_TOLERANCE * whole * grid.unit).all():
                break
            longest = np.inf if piece == MAX_PIECES else half
            offset, lag = self._piece(means, total, elapsed, missing, longest)
            total += offset
            elapsed += lag
        ended = self._reach < half
        if ended.any():
            total[ended] = self._extrapolated(self._slices, 1)[ended]
        return total

    def _piece(
        self, means: Floats, offset: Floats, elapsed: Floats, missing: Floats, longest: float
    ) -> tuple[Floats, Floats]:
        """Go on from the ends of paths: displacement, and lag in the field's units."""
        grid = self._grid
        steps, rows, columns, _ = offset.shape
        corners = _corners(offset / grid.spacing, self._periodic())
        unit = np.zeros(missing.shape)
        for corner, share in corners:
            unit += share * grid.unit.ravel()[corner]
        lag = np.minimum(missing / unit, longest)
        total = np.zeros(offset.shape)
        before, fraction = self._steps(elapsed)
        after = np.minimum(before + 1, steps - 1)
        for corner, share in corners:
            for step, part in ((before, 1 - fraction), (after, fraction)):
                if part.any():
                    entry = step * (rows * columns) + corner
                    values = self._interpolated(means, entry, lag, steps * rows * columns)
                    total += (part * share)[..., None] * values
        return total, lag * unit

    def _steps(self, elapsed: Floats) -> tuple[Indices, Floats]:
        """Destination time that lies so much before each, (T, J, I), as step and fraction."""
        grid = self._grid
        count = len(grid.times)
        own = np.arange(count).reshape(-1, 1, 1)
        if not grid.moving:
            return np.broadcast_to(own, elapsed.shape), np.zeros(elapsed.shape)
        then = np.clip(grid.times.reshape(-1, 1, 1) - elapsed, grid.times[0], grid.times[-1])
        return bracket(grid.times, then)

    def _interpolated(self, means: Floats, entry: Indices, lag: Floats, slice_size: int) -> Floats:
        """Displacements of the known slices at entries and at any lag, (T, J, I, 2)."""
        last = len(self._slices) - 1
        knots = self._knots[: last + 1]
        m, fraction = bracket(knots, lag)
        at = m * slice_size + entry
        low, high = means[at], means[at + slice_size]
        return np.asarray(lag[..., None] * (low + (high - low) * fraction[..., None]))

    def _periodic(self) -> tuple[bool, bool]:
        """Whether the (j, i) axis seems to be periodic: its first and last line are equal."""
        last = self._slices[-1]
        pairs = ((last[:, 0], last[:, -1]), (last[:, :, 0], last[:, :, -1]))
        over_j, over_i = (
            bool(np.allclose(a, b, rtol=SEAM_TOLERANCE, atol=SEAM_TOLERANCE)) for a, b in pairs
        )
        return over_j, over_i


def _corners(offset: Floats, periodic: tuple[bool, bool]) -> list[tuple[Indices, Floats]]:
    """Entries around each entry moved by so many entries, and their bilinear shares."""
    rows, columns = offset.shape[1:3]
    parts = []
    for axis, count in ((1, rows), (0, columns)):
        own = np.arange(count).reshape((-1, 1) if axis else (1, -1))
        x = own + offset[..., axis]
        if count == 1:
            parts.append([(np.zeros(x.shape, np.intp), np.ones(x.shape))])
            continue
        cells = count - 1
        x = x - cells * np.floor(x / cells) if periodic[1 - axis] else np.clip(x, 0, cells)
        low = np.clip(np.floor(x).astype(np.intp), 0, cells - 1)
        parts.append([(low, 1 - (x - low)), (low + 1, x - low)])
    return [(j * columns + i, a * b) for j, a in parts[0] for i, b in parts[1]]


def _finite(values: NDArray[np.floating[Any]]) -> Floats:
    return np.nan_to_num(values.astype(np.float64), nan=0.0, posinf=0.0, neginf=0.0)
