"""The slices found so far, looked up anywhere.

Beside its data every slice has a judgement: whether it is smooth enough, for its length, to be
looked up between the nodes of a cell. Paths that come right beside a pole never are, because
their neighbours pass it on the other side: a slice is used up to the lag at which they do.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.trace.lattice import Corners, Lattice

__all__ = ["CLOSE", "Known", "Piece"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]
Bools = NDArray[np.bool_]

#: Error of a look-up that is allowed, as a share of the path's length, and in cells.
SHARE, CELLS = 0.002, 0.003
#: Lags closer to a slice than this share are taken from it.
CLOSE = np.float32(1e-4)


class Piece(NamedTuple):
    """Continuations of n paths."""

    moved: Singles  #: displacement, (2, n)
    gone: Singles  #: lag that they cover
    reached: Singles | None  #: lag after which they end, beyond ``gone`` where they do not
    steps: Indices | int  #: time steps that they go back


class Known:
    """The slices found so far, looked up anywhere."""

    def __init__(
        self,
        field: FlowField,
        lags: Floats,
        unit: Floats,
        slices: Singles,
        reach: Singles,
        landing: Indices,
        polar: Bools,
    ) -> None:
        self.lattice = Lattice.of(field)
        self.knots = np.concatenate([[0.0], lags]).astype(np.float32)
        # What is stored at lag zero is the slope itself.
        self._inverse = np.concatenate([[1.0], 1 / lags]).astype(np.float32)
        self.landing = np.concatenate([[0], landing])
        self.unit = unit.ravel().astype(np.float32)
        self._even = bool(np.ptp(self.unit) <= CLOSE * self.unit[0])
        self.unsteady = not field.steady
        self.slices = slices.reshape(2, len(self.knots), -1)
        self.reach = reach.reshape(-1)
        i, j = np.meshgrid(np.arange(self.lattice.columns), np.arange(self.lattice.rows))
        self.nodes = np.stack([i, j]).reshape(2, -1).astype(np.float32)
        self._grids = slices
        self._pace = np.abs(slices[:, 0]).max(axis=0)
        self._trust = np.zeros(reach.shape, np.float32)
        self._longest = self._capped = np.empty(0, np.float32)
        self._endless = False
        self._first = np.float32(0)
        #: Which nodes have a path that has come right beside a pole, (T, J, I).
        self.polar = polar

    def judge(self, m: int, *, always: bool) -> None:
        """Note where slice m is smooth enough to be looked up, and make ready to look up.

        Where it is not, the longest slice that is, is used; ``always`` accepts it everywhere.
        """
        if always:
            self._trust[:] = np.where(self.polar, 0, self.knots[m])
            self._first = self.knots[m]
        else:
            grid = self._grids[:, m]
            error = (_bend(grid, 2) + _bend(grid, 3)).max(axis=0)
            good = error <= 8 * (SHARE * self.knots[m] * self._pace + CELLS)
            good &= (self._trust == self.knots[m - 1]) & ~self.polar
            self._trust[good] = self.knots[m]
        # A cell may use what is good at its four nodes.
        trust = np.minimum(self._trust[:, :-1], self._trust[:, 1:])
        trust = np.minimum(trust[:, :, :-1], trust[:, :, 1:])
        self._longest = np.pad(trust, ((0, 0), (0, 1), (0, 1))).ravel()
        # So far on that a path counts as ended only between nodes whose paths all end.
        self._capped = np.minimum(self.reach, 1e4 * self.knots[m])
        self._endless = bool(np.isinf(self.reach).all())

    def continued(self, position: Singles, left: Singles, step: Indices, most: Any) -> Piece:
        """Continue paths from positions (2, n) by up to ``left`` of lag."""
        corners = self.lattice.corners(position)
        base = step * self.lattice.size if self.unsteady else 0
        unit = self.unit[:1] if self._even else self.lattice.blend(self.unit, corners)
        longest = self._longest[corners.at + base] if most is None else most
        lag: NDArray[Any] = np.minimum(left / unit, longest)
        if self.lattice.poles is not None and not self.unsteady:
            # Past a pole an index turns so quickly that nothing can be interpolated between lags.
            whole = self.knots[np.searchsorted(self.knots, lag * (1 + CLOSE), side="right") - 1]
            lag = np.where(whole > self._first, np.minimum(whole, lag), lag)
        if lag.min() == lag.max():
            # Even cells, smooth slices: one slice for all.
            lag = lag[:1]
        if self.unsteady:
            m = np.searchsorted(self.knots * (1 - CLOSE), lag, side="right") - 1
            lag = self.knots[m]
        else:
            m = np.maximum(np.searchsorted(self.knots, lag * (1 - CLOSE)), 1)
        moved = self._displaced(corners, base, m, lag)
        self._mirror(moved, position)
        reached = None
        if not self._endless:
            reached = self.lattice.blend(self._capped, corners, base) * unit
        gone = np.broadcast_to(lag * unit, left.shape)
        return Piece(moved, gone, reached, self.landing[m])

    def stuck(self, position: Floats | Singles, step: Indices | int = 0) -> Bools:
        """Whether positions (2, n) are so close to a pole that nothing can be looked up, (n,)."""
        base = step * self.lattice.size if self.unsteady else 0
        return np.asarray(self._longest[self.lattice.corners(position).at + base] == 0)

    def displaced(self, position: Singles, lag: Singles, step: Indices) -> Singles:
        """Displacements (2, n) of paths from positions (2, n) at any lags up to the last slice."""
        corners = self.lattice.corners(position)
        base = step * self.lattice.size if self.unsteady else 0
        units: Any = lag / (self.unit[:1] if self._even else self.lattice.blend(self.unit, corners))
        m = np.clip(np.searchsorted(self.knots, units), 1, len(self.knots) - 1)
        moved = self._displaced(corners, base, m, units)
        self._mirror(moved, position)
        return moved

    def _mirror(self, moved: Singles, position: Singles) -> None:
        """Turn displacements from positions beyond a pole to run as index space does there."""
        poles = self.lattice.poles
        if poles is not None:
            moved[poles.component, poles.mirrored(position)] *= -1

    def _displaced(
        self, corners: Corners, base: Indices | int, m: Indices, lag: Singles
    ) -> Singles:
        """Displacements at lags (n,) or (1,), between the slices m - 1 and m."""
        late = (lag - self.knots[m - 1]) / (self.knots[m] - self.knots[m - 1])
        exact = bool((late > 1 - 10 * CLOSE).all())
        if len(m) == 1:
            m = m[0]
        result = np.empty((2, len(corners.at)), np.float32)
        stride = self.slices.shape[2]
        for out, data in zip(result, self.slices.reshape(2, -1), strict=True):
            slope = self.lattice.blend(data, corners, base + m * stride) * self._inverse[m]
            if not exact:
                before = self.lattice.blend(data, corners, base + (m - 1) * stride)
                before *= self._inverse[m - 1]
                slope = before + late * (slope - before)
            np.multiply(slope, lag, out=out)
        return result


def _bend(grid: Singles, axis: int) -> Singles:
    """Size of second differences along an axis of (2, T, J, I), as beside it at the border."""
    if grid.shape[axis] < 3:
        return np.zeros_like(grid)
    bend = np.abs(np.diff(grid, 2, axis=axis))
    return np.pad(bend, [(int(a == axis),) * 2 for a in range(grid.ndim)], mode="edge")
