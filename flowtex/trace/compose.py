"""Long paths put together from short ones.

A path of lag 2 s is the path of lag s, continued by the path of lag s from where, and when, that
one ends (hierarchical line integration, Hlawatsch, Sadlo and Weiskopf 2011). Doubling the lags
costs one look-up for each node, whatever the length, where integration would cost as many steps
as the path has cells.

A look-up between the nodes is as good as the slice is smooth there. Around a centre or beside a
separatrix long paths of neighbours part, so each slice's second differences are held against its
length, and where they are large the path is continued in shorter pieces that are smooth. What is
left is of the order of the error that bilinear velocity has itself.

A flow that varies is composed only when its lags are whole numbers of its equal time steps, from
one step up: then each piece begins at a time for which there are slices.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from flowtex.field import FlowField
from flowtex.trace.lattice import Lattice

__all__ = ["compose", "landings"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]

#: Error of a look-up that is allowed, as a share of the path's length, and in cells.
SHARE, CELLS = 0.005, 0.01
#: Pieces of a path, at most, before the rest is looked up in one whatever its error.
MOST_PIECES = 64
#: Paths looked up together.
BLOCK = 16384
#: Lags closer to a slice than this share are taken from it.
CLOSE = np.float32(1e-4)

Some = slice | Indices
#: Runs a function over blocks, perhaps in threads, and gives the results in order.
Map = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]


def landings(field: FlowField, lags: Floats, unit: Floats) -> Indices | None:
    """Time steps that each lag of a time-varying field spans, 0 for a part of one, (M,).

    ``None`` when paths cannot be composed: the steps are not equal, or the lags are not multiples
    of the first one that is a whole number of them.
    """
    if field.steady:
        return np.zeros(len(lags), dtype=np.intp)
    steps = np.diff(field.times)
    spans = lags * unit.flat[0] / steps[0]
    whole = np.rint(spans)
    exact = (whole > 0) & (np.abs(spans - whole) < 1e-6)
    even = np.allclose(steps, steps[0], rtol=1e-6) and np.all(unit == unit.flat[0])
    if not even or not exact.any():
        return None
    first = int(np.argmax(exact))
    if not exact[first:].all() or np.any(whole[first:] % whole[first]):
        return None
    return np.where(exact, whole, 0).astype(np.intp)


def compose(
    field: FlowField,
    lags: Floats,
    unit: Floats,
    slices: Singles,
    reach: Singles,
    known: int,
    landing: Indices,
    run: Map = map,
) -> None:
    """Fill the long slices of one direction in place.

    Parameters
    ----------
    field
        The flow.
    lags
        All lags, (M,), in multiples of ``unit``.
    unit
        One unit of lag at each node, (J, I).
    slices
        Derivative of the displacement by lag at lag zero, and the displacements,
        (2, M + 1, T, J, I), of which those of the first ``known`` lags are given.
    reach
        Lag at which each path ended, (T, J, I), infinite where it did not within what is known.
    known
        How many slices are given.
    landing
        What :func:`landings` gives.
    run
        Maps a function over blocks of paths.
    """
    store = _Store(field, lags, unit, slices, reach, landing)
    for m in range(known + 1, len(lags) + 1):
        store.judge(m - 1, always=m - 1 == known)
        _Doubling(store, m).run(run)


class _Piece(NamedTuple):
    """Continuations of n paths."""

    moved: tuple[Singles, Singles]  #: displacement along i and j
    gone: Singles  #: lag that they cover
    reached: Singles | None  #: lag after which they end, beyond ``gone`` where they do not
    steps: Indices | int  #: time steps that they go back


class _Store:
    """The slices found so far, looked up anywhere."""

    def __init__(
        self,
        field: FlowField,
        lags: Floats,
        unit: Floats,
        slices: Singles,
        reach: Singles,
        landing: Indices,
    ) -> None:
        self.lattice = Lattice(field.shape, field.periodic)
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

    def judge(self, m: int, *, always: bool) -> None:
        """Note where slice m is smooth enough to be looked up, and make ready to look up.

        Where it is not, the longest slice that is, is used; ``always`` accepts it everywhere.
        """
        if always:
            self._trust[:] = self.knots[m]
        else:
            grid = self._grids[:, m]
            error = (_bend(grid, 2) + _bend(grid, 3)).max(axis=0)
            good = error <= 8 * (SHARE * self.knots[m] * self._pace + CELLS)
            good &= self._trust == self.knots[m - 1]
            self._trust[good] = self.knots[m]
        # A cell may use what is good at its four nodes.
        trust = np.minimum(self._trust[:, :-1], self._trust[:, 1:])
        trust = np.minimum(trust[:, :, :-1], trust[:, :, 1:])
        self._longest = np.pad(trust, ((0, 0), (0, 1), (0, 1))).ravel()
        # A path that is not known to end goes on for a cell: perhaps more, but this way those
        # that start between it and one that does end are found to end where they should.
        further = self.knots[m] + 1 / np.maximum(self._pace.ravel(), 1 / self.knots[m])
        self._capped = np.minimum(self.reach, further)
        self._endless = bool(np.isinf(self.reach).all())

    def continued(self, position: Singles, left: Singles, step: Indices, most: Any) -> _Piece:
        """Continue paths from positions (2, n) by up to ``left`` of lag."""
        corners = self.lattice.corners(position)
        base = step * self.lattice.size if self.unsteady else 0
        unit = self.unit[:1] if self._even else self.lattice.blend(self.unit, corners)
        longest = self._longest[corners.at + base] if most is None else most
        lag = np.minimum(left / unit, longest)
        same = bool(lag.min() == lag.max())
        m, late = self._between(lag[:1] if same else lag)
        if self.unsteady:
            lag = self.knots[m] if not same else np.full_like(lag, self.knots[m[0]])
        m = m[0] if same else m
        stride = self.slices.shape[2]
        moved = []
        for data in self.slices.reshape(2, -1):
            slope = self.lattice.blend(data, corners, base + m * stride) * self._inverse[m]
            if late is not None:
                before = self.lattice.blend(data, corners, base + (m - 1) * stride)
                before *= self._inverse[m - 1]
                slope = before + late * (slope - before)
            moved.append(lag * slope)
        reached = None
        if not self._endless:
            reached = self.lattice.blend(self._capped, corners, base) * unit
        return _Piece((moved[0], moved[1]), lag * unit, reached, self.landing[m])

    def _between(self, lag: Singles) -> tuple[Indices, Singles | None]:
        """Slice at or after a lag, and where between it and the one before the lag lies."""
        if self.unsteady:
            return np.searchsorted(self.knots * (1 - CLOSE), lag, side="right") - 1, None
        m = np.maximum(np.searchsorted(self.knots, lag * (1 - CLOSE)), 1)
        late = (lag - self.knots[m - 1]) / (self.knots[m] - self.knots[m - 1])
        return m, None if (late > 1 - 10 * CLOSE).all() else late


class _Doubling:
    """Paths on their way from one slice to the next, (T * J * I,) of them."""

    def __init__(self, store: _Store, m: int) -> None:
        count, nodes = len(store.reach), store.lattice.size
        before, lag = store.knots[m - 1], store.knots[m]
        self._store, self._lag, self._before = store, lag, before
        self._moved = store.slices[:, m]
        self._moved[:] = store.slices[:, m - 1]
        self._whole = lag * store.unit
        self._left = np.tile((lag - before) * store.unit, count // nodes)
        self._step = np.maximum(np.arange(count) // nodes - store.landing[m - 1], 0)

    def run(self, run: Map) -> None:
        """Follow all paths to their end, piece by piece."""
        count = len(self._left)
        blocks: list[Some] = [slice(k, min(k + BLOCK, count)) for k in range(0, count, BLOCK)]
        for number in range(2 * MOST_PIECES):
            longest = self._before if number >= MOST_PIECES else None
            more = np.concatenate(list(run(partial(self.follow, longest=longest), blocks)))
            if not len(more):
                return
            blocks = [more[k : k + BLOCK] for k in range(0, len(more), BLOCK)]

    def follow(self, some: Some, longest: np.float32 | None) -> Indices:
        """Continue some paths by a piece, and return those that must go further."""
        store, left = self._store, self._left[some]
        node: Some = some
        if store.unsteady:
            node = np.arange(len(self._left))[some] % store.lattice.size
        position = store.nodes[:, node] + self._moved[:, some]
        piece = store.continued(position, left, self._step[some], longest)
        whole = self._whole[node]
        if piece.reached is not None:
            end = store.reach[some]
            stops = np.isinf(end) & (piece.reached < piece.gone)
            at = self._lag * (1 - (left - piece.reached) / whole)
            store.reach[some] = np.where(stops, at, end)
        for row, part in zip(self._moved, piece.moved, strict=True):
            row[some] += part
        left -= piece.gone
        self._left[some] = left
        if store.unsteady:
            self._step[some] = np.maximum(self._step[some] - piece.steps, 0)
        more = np.flatnonzero(left > CLOSE * whole)
        return more + some.start if isinstance(some, slice) else some[more]


def _bend(grid: Singles, axis: int) -> Singles:
    """Size of second differences along an axis of (2, T, J, I), as beside it at the border."""
    if grid.shape[axis] < 3:
        return np.zeros_like(grid)
    bend = np.abs(np.diff(grid, 2, axis=axis))
    return np.pad(bend, [(int(a == axis),) * 2 for a in range(grid.ndim)], mode="edge")
