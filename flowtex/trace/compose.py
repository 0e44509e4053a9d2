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

Right beside a pole nothing can be looked up between nodes, whose paths pass it on either side.
There, and only there, paths are integrated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.progress import check
from flowtex.field import FlowField
from flowtex.trace.known import CLOSE, Known, Piece

__all__ = ["compose", "landings"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]

#: Pieces of a path, at most, before the rest is looked up in one whatever its error.
MOST_PIECES = 64
#: Paths looked up together.
BLOCK = 16384
#: Cells beyond a border where a path that follows it may be put by its look-ups.
BESIDE = 1e-2
#: Parts of a piece in which its end is looked for, and how often one is halved then.
SEARCHED, BISECTIONS = 16, 6

Some = slice | Indices
#: Runs a function over blocks, perhaps in threads, and gives the results in order.
Map = Callable[[Callable[[Any], Any], Iterable[Any]], Iterable[Any]]
#: Whether positions (2, n) are where paths are to be followed, (n,).
Within = Callable[[Floats], NDArray[np.bool_]]
#: Follows paths from positions (2, n), by lags (n,), from time steps (n,), as long as they are
#: there: displacements (2, n), lags covered, and lags at which they end, infinite if they do not.
Integrate = Callable[[Singles, Singles, Indices, Within | None], tuple[Singles, Singles, Singles]]


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
    polar: NDArray[np.bool_] | None = None,
    integrate: Integrate | None = None,
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
    polar
        Which paths have come right beside a pole within what is known, (T, J, I); more of them
        are marked.
    integrate
        Follows paths right beside a pole.
    """
    polar = np.zeros(reach.shape, bool) if polar is None else polar
    store = Known(field, lags, unit, slices, reach, landing, polar)
    beside = None if field.surface.poles is None else integrate
    for m in range(known + 1, len(lags) + 1):
        store.judge(m - 1, always=m - 1 == known)
        _Doubling(store, m, beside).run(run)


class _Doubling:
    """Paths on their way from one slice to the next, (T * J * I,) of them."""

    def __init__(self, store: Known, m: int, integrate: Integrate | None) -> None:
        count, nodes = len(store.reach), store.lattice.size
        before, lag = store.knots[m - 1], store.knots[m]
        self._store, self._lag, self._before = store, lag, before
        self._moved = store.slices[:, m]
        self._moved[:] = store.slices[:, m - 1]
        self._whole = lag * store.unit
        self._left = np.tile((lag - before) * store.unit, count // nodes)
        self._integrate = integrate
        self._stuck: list[Indices] = []
        self._suspects: list[tuple[NDArray[Any], ...]] = []
        self._step = np.maximum(np.arange(count) // nodes - store.landing[m - 1], 0)

    def run(self, run: Map) -> None:
        """Follow all paths to their end, piece by piece."""
        count = len(self._left)
        blocks: list[Some] = [slice(k, min(k + BLOCK, count)) for k in range(0, count, BLOCK)]
        for number in range(2 * MOST_PIECES):
            check()
            longest = self._before if number >= MOST_PIECES else None
            more = np.concatenate(list(run(partial(self.follow, longest=longest), blocks)))
            if not len(more) and self._stuck:
                # All at once: they are few, and each call has its price.
                stuck, self._stuck = np.concatenate(self._stuck), []
                work = partial(self._pass, final=number >= MOST_PIECES)
                more = np.concatenate(list(run(work, _parts(stuck))))
            if not len(more):
                break
            blocks = _parts(more)
        if self._suspects:
            self._find_ends()

    def follow(self, some: Some, longest: np.float32 | None) -> Indices:
        """Continue some paths by a piece, and return those that must go further."""
        store = self._store
        if self._integrate is not None:
            some = self._without_stuck(some)
        left = self._left[some]
        if not len(left):
            return np.empty(0, np.intp)
        node, position = self._where(some)
        piece = store.continued(position, left, self._step[some], longest)
        whole = self._whole[node]
        self._suspect(some, position, piece)
        for row, part in zip(self._moved, piece.moved, strict=True):
            row[some] += part
        left -= piece.gone
        self._left[some] = left
        if store.unsteady:
            self._step[some] = np.maximum(self._step[some] - piece.steps, 0)
        return _numbers(some, np.flatnonzero(left > CLOSE * whole))

    def _where(self, some: Some) -> tuple[Some, Singles]:
        """Nodes at which some paths begin, and where they have come, (2, n)."""
        node = some
        if self._store.unsteady:
            node = np.arange(len(self._left))[some] % self._store.lattice.size
        return node, self._store.nodes[:, node] + self._moved[:, some]

    def _without_stuck(self, some: Some) -> Some:
        """Put aside the paths that have come right beside a pole."""
        stuck = self._store.stuck(self._where(some)[1], self._step[some])
        if not stuck.any():
            return some
        self._stuck.append(_numbers(some, np.flatnonzero(stuck)))
        return _numbers(some, np.flatnonzero(~stuck))

    def _pass(self, which: Indices, *, final: bool) -> Indices:
        """Integrate paths by a pole, or to their end, and return those that must go further."""
        store, left, step = self._store, self._left[which], self._step[which]
        if self._integrate is None:
            return which
        node, position = self._where(which)
        within = None if store.unsteady or final else store.stuck
        moved, gone, ends = self._integrate(position, left, step, within)
        self._moved[:, which] += moved
        self._left[which] = left - gone
        store.polar.reshape(-1)[which] = True
        new = np.isinf(store.reach[which]) & np.isfinite(ends)
        whole = self._whole[node]
        store.reach[which[new]] = self._lag * (1 - (left - ends)[new] / whole[new])
        return _numbers(which, np.flatnonzero(self._left[which] > CLOSE * whole))

    def _suspect(self, some: Some, position: Singles, piece: Piece) -> None:
        """Note the paths that seem to end within their piece."""
        store = self._store
        gone = ~store.lattice.alive(position + piece.moved, BESIDE)
        rest = np.full(1, np.inf, np.float32)
        if piece.reached is not None:
            rest = piece.reached
            gone |= rest < piece.gone
        gone &= np.isinf(store.reach[some])
        if gone.any():
            g = np.flatnonzero(gone)
            which = _numbers(some, g)
            rest = np.broadcast_to(rest, gone.shape)[g]
            self._suspects.append(
                (which, position[:, g], piece.gone[g], rest, self._left[which], self._step[which])
            )

    def _find_ends(self) -> None:
        """Find where the suspects end: they leave the domain, or come to rest as all around."""
        which, start, length, rest, left, step = (
            np.concatenate(part, axis=-1) for part in zip(*self._suspects, strict=True)
        )
        # Pieces come in order, and only the first in which a path ends counts.
        which, once = np.unique(which, return_index=True)
        start, length, rest, left, step = (p[..., once] for p in (start, length, rest, left, step))
        first = np.full(len(which), np.inf, np.float32)
        for share in np.linspace(1, 0, SEARCHED, endpoint=False, dtype=np.float32):
            first[self._outside(start, share * length, step)] = share
        leaves = np.isfinite(first)
        high = np.where(leaves, first, 0)
        low = np.maximum(high - np.float32(1 / SEARCHED), 0)
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            outside = self._outside(start, middle * length, step)
            low, high = np.where(outside, low, middle), np.where(outside, middle, high)
        further = np.where(leaves, low * length, np.where(rest < length, rest, np.inf))
        whole = self._whole[which % self._store.lattice.size]
        self._store.reach[which] = self._lag * (1 - (left - further) / whole)

    def _outside(self, start: Singles, lag: Singles, step: Indices) -> NDArray[np.bool_]:
        moved = self._store.displaced(start, lag, step)
        return ~self._store.lattice.alive(start + moved, BESIDE)


def _numbers(some: Some, which: Indices) -> Indices:
    """Numbers of paths of which numbers among some are given."""
    if isinstance(some, slice):
        return np.asarray(which + some.start)
    return some[which]


def _parts(which: Indices) -> list[Some]:
    return [which[k : k + BLOCK] for k in range(0, len(which), BLOCK)]
