"""Long paths composed of short ones.

A path of lag 2 s is the path of lag s, continued by the path of lag s from where, and when, that
one ends (hierarchical line integration, Hlawatsch, Sadlo and Weiskopf 2011). Doubling the lags
costs one look-up for each node, where integration would cost as many steps as the path has cells.

A look-up between the nodes is bilinear, corrected by the mean second differences around its cell.
Around a centre or near a separatrix long paths of neighbours part: where the change of the second
differences in a cell is large for the slice's length, the path is continued in shorter, smooth
pieces. The remaining error is of the order of the bilinear velocity's error. Displacements are
complex numbers, i + j sqrt(-1), so that one gather takes both components.

A flow that varies is composed only when its lags are whole numbers of its equal time steps, so that
each piece begins at a time for which there are slices. Close to a pole paths are integrated, as
those of neighbours pass it on either side; few of them are, by :mod:`flowtex.trace.pole_rings`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Complexes, Floats, Floats32, Indices
from flowtex._util.progress import check
from flowtex.field import FlowField
from flowtex.trace.integrate import Inside
from flowtex.trace.pole_rings import PoleRings
from flowtex.trace.sampler import Corners, NodeGrid

#: Most pieces of a path, after which the rest is looked up at once despite its error.
MOST_PIECES = 64
#: Pieces after which all paths that are stuck at a pole are integrated past it.
TOGETHER = MOST_PIECES // 2
#: Paths looked up together.
BLOCK = 65536
#: Cells beyond a border to which look-ups may displace a path that follows it.
BORDER_CELLS = 1e-2
SEARCH_PARTS = 16  #: Parts of a piece in the search for its end.
SEARCH_BISECTIONS = 6  #: Bisections of the part with the end.
ERROR_SHARE = 0.002  #: Tolerance of a look-up, as a share of the path's length.
ERROR_CELLS = 0.003  #: Tolerance of a look-up in cells, added to this share.
#: Typical error of a look-up over the range of the second differences at the corners of its cell.
ERROR_CHANGE = 1 / 64
#: Factor of the allowed error in the first composed slice, whose pieces are many.
ROUGH = 4
#: Lags closer to a slice than this share are taken from it.
LAG_ROUNDING = np.float32(1e-4)
NO_PATHS = np.empty(0, np.intp)  #: Numbers of none.


A = TypeVar("A")
B = TypeVar("B")
#: Numbers of paths.
Selection = slice | Indices


class Map(Protocol):
    """A function that maps another one over blocks, perhaps in threads."""

    def __call__(self, work: Callable[[A], B], blocks: Iterable[A], /) -> Iterable[B]:
        """Return the results in order."""


#: Follows paths from positions (2, n), by lags (n,), from time steps (n,), in directions (n,), as
#: long as they are inside: displacements (2, n), lags covered, lags at which they end, infinite if
#: they do not, and which paths circle in one place.
Integrate = Callable[
    [Floats32, Floats, Indices, Floats, Inside | None], tuple[Floats32, Floats, Floats, Bools]
]


def landings(field: FlowField, lags: Floats, unit: Floats) -> Indices | None:
    """Return the time steps that each lag of a time-varying field spans, 0 for a part of one, (M,).

    ``None`` when paths cannot be composed: the steps are not equal, or the lags are not multiples
    of the first one that is a whole number of them; or the field is sign-free, or on triangles.
    """
    if field.sign_free or field.triangles is not None:
        return None
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
    # Beyond the first time step there is nowhere to land.
    whole = np.minimum(whole, len(field.times))
    return np.where(exact, whole, 0).astype(np.intp)


@dataclass(frozen=True, eq=False)
class SideSlices:
    """Slices of one direction, (M + 1, T, J, I, 2), the first of them the slope at lag zero.

    Their reach, which paths have come close to a pole, and which circle in one place, are (T, J,
    I). While paths are integrated, the nodes of all are one axis.
    """

    slices: Floats32
    reach: Floats32
    polar: Bools
    circling: Bools

    @property
    def displacement(self) -> Floats32:
        """The slices beyond lag zero as (T, M, J, I, 2)."""
        return np.swapaxes(self.slices[1:], 0, 1)


def compose(
    field: FlowField,
    lags: Floats,
    unit: Floats,
    sides: dict[float, SideSlices],
    direct: int,
    landing: Indices,
    run: Map,
    integrate: Integrate,
    longest: float | Floats = np.inf,
) -> None:
    """Fill the long slices of some directions, -1 backward and 1 forward, in place.

    The slices of the first ``direct`` of all lags (M,) are filled already, and ``reach`` is
    infinite for paths that did not end within these lags. ``landing`` comes from :func:`landings`,
    ``run`` maps a function over blocks of paths, and ``integrate`` follows paths close to a pole,
    which are then marked as polar. Paths end, and stay, at the first slice whose lag, times the
    unit, is ``longest`` or more: one number, or one for each node.
    """
    counts = np.maximum(np.searchsorted(lags, longest / unit) + 1, direct)
    lookups = []
    for direction, side in sides.items():
        lookups.append(_SliceLookup(field, lags, unit, side, direction, landing, counts))
    poles = field.surface.poles
    beside = None
    rings = None
    if poles is not None:
        beside = integrate
        if lookups[0].grid.endless:
            rings = PoleRings.of(poles, field.shape)
    for m in range(1, len(lags) + 1):
        if m > direct:
            _double(lookups, m, run, beside, rings)
        if m == len(lags):
            break
        if m <= direct:
            share = np.inf
        elif m == direct + 1:
            share = ROUGH
        else:
            share = 1
        for lookup in lookups:
            lookup.judge(m, share)
    ends = np.where(counts < len(lags), lookups[0].knots[np.minimum(counts, len(lags))], np.inf)
    for side in sides.values():
        np.minimum(side.reach, ends, out=side.reach)


class _Piece(NamedTuple):
    """Continuations of n paths."""

    moved: Complexes  #: displacement, (n,)
    covered: Floats32  #: lag that they cover
    ends: Floats32 | None  #: lag at which they end, beyond ``covered`` where they do not
    steps: Indices | int  #: time steps that they continue, negative backward


class _SliceLookup:
    """The slices that are filled so far, and look-ups in them at any position.

    It judges where each slice is smooth enough, for its length, to be interpolated between nodes.
    """

    def __init__(
        self,
        field: FlowField,
        lags: Floats,
        unit: Floats,
        side: SideSlices,
        direction: float,
        landing: Indices,
        counts: Indices,
    ) -> None:
        self.direction = direction
        #: Number of slices of each node whose paths are followed, (J, I).
        self.counts = counts
        self.grid = NodeGrid.of(field)
        self.knots = np.concatenate([[0.0], lags]).astype(np.float32)
        # At lag zero the slope itself is stored.
        self._inverse = np.concatenate([[1.0], 1 / lags]).astype(np.float32)
        self.landing = np.concatenate([[0], landing * int(direction)])
        #: Measure of the units here, a power of two, so that single precision holds them.
        self.scale = float(2.0 ** np.rint(np.log2(np.median(unit))))
        self.unit = (unit.ravel() / self.scale).astype(np.float32)
        #: Whether all nodes have one unit.
        self.even = bool(np.ptp(self.unit) <= LAG_ROUNDING * self.unit[0])
        self.unsteady = not field.steady
        self.slices = side.slices.view(np.complex64).reshape(len(self.knots), -1)
        self.reach = side.reach.reshape(-1)
        i, j = np.meshgrid(np.arange(self.grid.columns), np.arange(self.grid.rows))
        self.nodes = (i + 1j * j).ravel().astype(np.complex64)
        self._grids = side.slices
        #: Mean second differences along j and i around each cell, at its lower corner.
        self._bends = np.zeros((2, *side.slices.shape[:-1]), np.complex64)
        self._pace = _corners(np.minimum, _greatest(np.abs(side.slices[0])))
        self._trust = np.zeros(self._pace.shape, np.float32)
        self._filled = _filled(counts)
        self._longest = self._capped = np.empty(0, np.float32)
        self._endless = False
        #: Which nodes have a path that has come close to a pole, (T, J, I).
        self.polar = side.polar
        self.circling = side.circling.reshape(-1)  #: Which paths stay in one place, (T * J * I,).

    def judge(self, m: int, share: float) -> None:
        """Find the cells where the error of slice m is ``share`` times that allowed."""
        error: AnyArray = np.zeros((), np.float32)
        for axis, means in zip((1, 2), self._bends[:, m], strict=True):
            bend = _bend(self._grids[m], axis)
            means[:, :-1, :-1] = _corners(np.add, bend.view(np.complex64)[..., 0]) / 4
            if np.isfinite(share):
                error = error + (_corners(np.maximum, bend) - _corners(np.minimum, bend))
        good = ~_corners(np.logical_or, self.polar) & (m <= self._filled)
        if np.isfinite(share):
            limit = share * (ERROR_SHARE * self.knots[m] * self._pace + ERROR_CELLS)
            good &= (ERROR_CHANGE * _greatest(error) <= limit) & (self._trust == self.knots[m - 1])
        self._trust[good] = self.knots[m]
        self._longest = np.pad(self._trust, ((0, 0), (0, 1), (0, 1))).ravel()
        # Endless paths count as so long that a path ends only between nodes whose paths all end.
        self._capped = np.minimum(self.reach, 1e4 * self.knots[m])
        self._endless = bool(np.isinf(self.reach).all())

    def continued(
        self, position: Floats32, corners: Corners, left: Floats32, step: Indices | int, most: Any
    ) -> _Piece:
        """Continue paths from positions (2, n), in these cells, by up to ``left`` of lag.

        A piece is a whole slice or a part of the first: between long slices errors are larger.
        """
        base = self._base(step)
        unit = self._unit_in(corners)
        if most is None:
            longest = self._longest[corners.at + base]
        else:
            longest = most
        lag: AnyArray = np.minimum(left / unit, longest)
        if lag.min() == lag.max():
            # Even cells, smooth slices: one slice for all.
            lag = lag[:1]
        m = np.maximum(self._below(lag), 1)
        moved = self._blend(corners, base, m)
        part = lag < self.knots[1] * (1 - LAG_ROUNDING)
        if part.any():
            moved *= np.where(part, lag / self.knots[1], 1)
        lag = np.where(part, lag, self.knots[m])
        self._mirror(moved, position)
        ends = None
        if not self._endless:
            ends = self.grid.blend(self._capped, corners, base) * unit
        covered = np.broadcast_to(lag * unit, left.shape)
        return _Piece(moved, covered, ends, self.landing[m])

    def is_stuck(self, corners: Corners, step: Indices | int = 0) -> Bools:
        """Return whether positions in these cells are too close to a pole for interpolation, (n,).

        They are at a time step, or at one each.
        """
        return np.asarray(self._longest[corners.at + self._base(step)] == 0)

    def displaced(self, position: Floats32, lag: Floats32, step: Indices) -> Complexes:
        """Return displacements (n,) of paths from positions (2, n) at lags up to the last slice."""
        corners = self.grid.corners(position)
        base = self._base(step)
        span: AnyArray = lag / self._unit_in(corners)
        m = self._below(span * (1 - 2 * LAG_ROUNDING))
        late = (span - self.knots[m]) / (self.knots[m + 1] - self.knots[m])
        before = self._blend(corners, base, m) * self._inverse[m]
        after = self._blend(corners, base, m + 1) * self._inverse[m + 1]
        moved = np.asarray((before + late * (after - before)) * span)
        self._mirror(moved, position)
        return moved

    def clipped(self, step: Indices) -> Indices:
        """Return steps, those beyond the first or last one clipped: there the flow is constant."""
        return np.clip(step, 0, len(self._trust) - 1)

    def _unit_in(self, corners: Corners) -> Floats32:
        """Return the unit at positions in these cells, (n,), or (1,) if all are equal."""
        if self.even:
            return self.unit[:1]
        # Between very different units rounding may give zero.
        return np.asarray(np.maximum(self.grid.blend(self.unit, corners), self.unit.min()))

    def _base(self, step: Indices | int) -> Indices | int:
        """Return the number of the first node of a step, counting the nodes of all steps."""
        if self.unsteady:
            return step * self.grid.size
        return 0

    def _mirror(self, moved: Complexes, position: Floats32) -> None:
        """Turn displacements from positions beyond a pole to run as index space does there."""
        poles = self.grid.poles
        if poles is None:
            return
        if poles.component:
            component = moved.imag
        else:
            component = moved.real
        component[poles.mirrored(position)] *= -1

    def _below(self, lag: Floats32) -> Indices:
        """Return the number of the longest slice up to each lag; comparing beats a search."""
        longer = lag >= self.knots[1:, None] * (1 - LAG_ROUNDING)
        return np.asarray(longer.view(np.int8).sum(axis=0, dtype=np.int8), np.intp)

    def _blend(self, corners: Corners, base: Indices | int, m: Indices) -> Complexes:
        """Return displacements (n,) by the slices m, (n,) or (1,)."""
        corners = Corners(corners.at + (base + m * self.slices.shape[1]), *corners[1:])
        result = self.grid.blend(self.slices.ravel(), corners)
        for bend, inside in zip(self._bends, (corners.t, corners.s), strict=True):
            weight: AnyArray = (inside * (1 - inside) / 2).astype(np.complex64)
            weight *= bend.ravel().take(corners.at, mode="clip")
            result -= weight
        return np.asarray(result)


class _Doubling:
    """Continuation of paths, (T * J * I,) of them, from one slice to the next."""

    def __init__(
        self,
        lookup: _SliceLookup,
        m: int,
        rings: PoleRings | None,
        *,
        passes: bool,
    ) -> None:
        count = len(lookup.reach)
        nodes = lookup.grid.size
        before = lookup.knots[m - 1]
        lag = lookup.knots[m]
        self.lookup = lookup
        self._lag = lag
        self._before = before
        self._moved = lookup.slices[m]
        self._moved[:] = lookup.slices[m - 1]
        #: Paths that are followed, ``None`` for all; the others stay where they are.
        self._which = _followed(lookup, m, rings)
        self._whole = lag * lookup.unit
        self._left = np.tile((lag - before) * lookup.unit, count // nodes)
        #: Whether paths close to a pole are integrated past it.
        self._passes = passes
        self._rings = rings
        self._blocks = self._first_blocks()
        self._stuck: list[Indices] = []
        self._suspects: list[tuple[AnyArray, ...]] = []
        self._step = lookup.clipped(np.arange(count) // nodes + lookup.landing[m - 1])

    def _first_blocks(self) -> list[Selection]:
        """Return blocks of all paths that are followed."""
        if self._which is not None:
            return _parts(self._which)
        count = len(self._left)
        return [slice(first, min(first + BLOCK, count)) for first in range(0, count, BLOCK)]

    @property
    def is_going(self) -> bool:
        """Whether some paths can go on by look-ups."""
        return bool(self._blocks)

    def go_on(self, run: Map, *, final: bool) -> None:
        """Continue all paths by a piece, those that are ``final`` by the longest slice."""
        longest = None
        if final:
            longest = self._before
        unfinished = list(run(partial(self.follow, longest=longest), self._blocks))
        self._blocks = _parts(np.concatenate([NO_PATHS, *unfinished]))

    def take_stuck(self) -> Indices:
        """Return the paths that are stuck at a pole, which go on after :meth:`passed`."""
        stuck = np.concatenate([NO_PATHS, *self._stuck])
        self._stuck = []
        return stuck

    def finish(self) -> None:
        """Find where paths end, and fill those that were not followed."""
        if self._suspects:
            self._find_ends()
        if self._rings is not None:
            size = self.lookup.grid.size
            sets = self._moved.reshape(-1, size), self.lookup.reach.reshape(-1, size)
            for moved, reach in zip(*sets, strict=True):
                self._rings.fill(moved, reach)

    def follow(self, selection: Selection, longest: np.float32 | None) -> Indices:
        """Continue some paths by a piece, and return those that must go further."""
        lookup = self.lookup
        position = self._positions(selection)
        corners = lookup.grid.corners(position)
        if self._passes:
            stuck = lookup.is_stuck(corners, self._at(selection))
            if stuck.any():
                self._stuck.append(_numbers(selection, np.flatnonzero(stuck)))
                free = np.flatnonzero(~stuck)
                selection = _numbers(selection, free)
                position = position[:, free]
                corners = Corners(*(part[free] for part in corners))
        left = self._left[selection]
        if not len(left):
            return np.empty(0, np.intp)
        piece = lookup.continued(position, corners, left, self._at(selection), longest)
        if lookup.even:
            whole = self._whole[:1]
        else:
            whole = self._whole[self._node(selection)]
        self._suspect(selection, position, piece)
        self._moved[selection] += piece.moved
        left -= piece.covered
        self._left[selection] = left
        if lookup.unsteady:
            self._step[selection] = lookup.clipped(self._step[selection] + piece.steps)
        return _numbers(selection, np.flatnonzero(left > LAG_ROUNDING * whole))

    def _node(self, selection: Selection) -> Selection:
        """Return nodes at which some paths begin."""
        if not self.lookup.unsteady:
            return selection
        return np.asarray(np.arange(len(self._left))[selection] % self.lookup.grid.size)

    def _at(self, selection: Selection) -> Indices | int:
        """Return the time steps at which some paths are."""
        if self.lookup.unsteady:
            return self._step[selection]
        return 0

    def _positions(self, selection: Selection) -> Floats32:
        """Return current positions of some paths, (2, n)."""
        return _rows(self.lookup.nodes[self._node(selection)] + self._moved[selection])

    def rest(self, which: Indices) -> tuple[Floats32, Floats, Indices, Floats]:
        """Return positions (2, n), lags left, time steps and directions of some paths."""
        lag = self._left[which].astype(float) * self.lookup.scale
        ways = np.full(len(which), self.lookup.direction)
        return self._positions(which), lag, self._step[which], ways

    def passed(
        self, which: Indices, moved: Floats32, covered: Floats, ends: Floats, circling: Bools
    ) -> None:
        """Take what ``Integrate`` returns for some paths, which may have to go further."""
        lookup = self.lookup
        left = self._left[which]
        covered = covered / lookup.scale
        ends = ends / lookup.scale
        self._moved[which] += moved[0] + 1j * moved[1]
        self._left[which] = left - covered
        lookup.polar.reshape(-1)[which] = True
        lookup.circling[which] = circling
        new = np.isinf(lookup.reach[which]) & np.isfinite(ends)
        whole = self._whole[self._node(which)]
        lookup.reach[which[new]] = self._lag * (1 - (left - ends)[new] / whole[new])
        on = np.flatnonzero(self._left[which] > LAG_ROUNDING * whole)
        self._blocks += _parts(which[on])

    def _suspect(self, selection: Selection, position: Floats32, piece: _Piece) -> None:
        """List the paths that seem to end within their piece."""
        lookup = self.lookup
        if piece.ends is None and lookup.grid.endless:
            return
        ending = ~lookup.grid.alive(position + _rows(piece.moved), BORDER_CELLS)
        rest = np.full(1, np.inf, np.float32)
        if piece.ends is not None:
            rest = piece.ends
            ending |= rest < piece.covered
        if ending.any():
            ended = np.flatnonzero(ending)
            ended = ended[np.isinf(lookup.reach[_numbers(selection, ended)])]
            which = _numbers(selection, ended)
            rest = np.broadcast_to(rest, ending.shape)[ended]
            left = self._left[which]
            parts = which, position[:, ended], piece.covered[ended], rest, left, self._step[which]
            self._suspects.append(parts)

    def _find_ends(self) -> None:
        """Find where the suspects end: they leave the domain, or come to rest as all around."""
        which, start, length, rest, left, step = (
            np.concatenate(part, axis=-1) for part in zip(*self._suspects, strict=True)
        )
        # Pieces are in order, and only the first in which a path ends counts.
        which, first = np.unique(which, return_index=True)
        start = start[..., first]
        length = length[..., first]
        rest = rest[..., first]
        left = left[..., first]
        step = step[..., first]
        shares = np.linspace(0, 1, SEARCH_PARTS + 1, dtype=np.float32)[1:]
        lags = np.outer(shares, length).ravel()
        outside = self._outside(np.tile(start, SEARCH_PARTS), lags, np.tile(step, SEARCH_PARTS))
        outside = outside.reshape(SEARCH_PARTS, -1)
        leaves = outside.any(axis=0)
        high = np.where(leaves, shares[outside.argmax(axis=0)], 0)
        low = np.maximum(high - shares[0], 0)
        for _ in range(SEARCH_BISECTIONS):
            middle = (low + high) / 2
            outside = self._outside(start, middle * length, step)
            low = np.where(outside, low, middle)
            high = np.where(outside, middle, high)
        further = np.where(leaves, low * length, np.where(rest < length, rest, np.inf))
        whole = self._whole[which % self.lookup.grid.size]
        self.lookup.reach[which] = self._lag * (1 - (left - further) / whole)

    def _outside(self, start: Floats32, lag: Floats32, step: Indices) -> Bools:
        moved = self.lookup.displaced(start, lag, step)
        return ~self.lookup.grid.alive(start + _rows(moved), BORDER_CELLS)


def _double(
    lookups: list[_SliceLookup],
    m: int,
    run: Map,
    integrate: Integrate | None,
    rings: PoleRings | None,
) -> None:
    """Fill slice m of all directions: follow all paths to their end, piece by piece."""
    passes = integrate is not None
    doublings = []
    for lookup in lookups:
        doublings.append(_Doubling(lookup, m, rings, passes=passes))
    for number in range(2 * MOST_PIECES):
        if not any(doubling.is_going for doubling in doublings):
            break
        check()
        final = number >= MOST_PIECES
        for doubling in doublings:
            doubling.go_on(run, final=final)
        is_any = any(doubling.is_going for doubling in doublings)
        if integrate is not None and (not is_any or (number + 1) % TOGETHER == 0):
            _pass(doublings, run, integrate, final=final)
    for doubling in doublings:
        doubling.finish()


def _pass(doublings: list[_Doubling], run: Map, integrate: Integrate, *, final: bool) -> None:
    """Integrate the stuck paths of all directions past a pole, or to their end.

    They are followed together: each round of steps has an overhead.
    """
    lookups = []
    stuck = []
    rests = []
    for doubling in doublings:
        which = doubling.take_stuck()
        lookups.append(doubling.lookup)
        stuck.append(which)
        rests.append(doubling.rest(which))
    owner = np.repeat(np.arange(len(stuck)), list(map(len, stuck)))
    if not len(owner):
        return
    rest = _joined(rests)

    def work(part: Selection) -> tuple[AnyArray, ...]:
        inside = None
        if not (final or lookups[0].unsteady):
            inside = partial(_are_stuck, lookups, owner[part])
        position, lag, step, ways = _picked(rest, part)
        return integrate(position, lag, step, ways, inside)

    passed = _joined(list(run(work, _parts(np.arange(len(owner))))))
    for number, doubling in enumerate(doublings):
        doubling.passed(stuck[number], *_picked(passed, owner == number))


def _joined(groups: Sequence[Sequence[AnyArray]]) -> list[AnyArray]:
    """Return the arrays (..., n) of groups of paths as those of all."""
    return [np.concatenate(parts, axis=-1) for parts in zip(*groups, strict=True)]


def _picked(values: Sequence[AnyArray], which: Selection | Bools) -> list[AnyArray]:
    """Return the values of some paths from arrays (..., n)."""
    return [array[..., which] for array in values]


def _are_stuck(
    lookups: list[_SliceLookup], owner: Indices, position: Floats, which: Indices
) -> Bools:
    """Return which paths (n,), by their numbers, are too close to a pole for interpolation."""
    corners = lookups[0].grid.corners(position)
    owner = owner[which]
    result = np.empty(len(which), bool)
    for number, lookup in enumerate(lookups):
        own = owner == number
        result[own] = lookup.is_stuck(corners)[own]
    return result


def _followed(lookup: _SliceLookup, m: int, rings: PoleRings | None) -> Indices | None:
    """Return the paths that are followed to slice m, ``None`` for all."""
    going = lookup.counts.ravel() >= m
    if rings is not None:
        going &= rings.followed
    going = np.tile(going, len(lookup.reach) // len(going)) & ~lookup.circling
    if going.all():
        return None
    return np.flatnonzero(going)


def _numbers(selection: Selection, which: Indices) -> Indices:
    """Return numbers of paths from their positions in a selection."""
    if isinstance(selection, slice):
        return np.asarray(which + selection.start)
    return selection[which]


def _parts(which: Indices) -> list[Selection]:
    return [which[k : k + BLOCK] for k in range(0, len(which), BLOCK)]


def _rows(numbers: Complexes) -> Floats32:
    """Return complex numbers (n,) as rows (2, n)."""
    return np.stack([numbers.real, numbers.imag])


def _bend(grid: Floats32, axis: int) -> Floats32:
    """Return second differences of (T, J, I, 2) along an axis, repeated at the borders."""
    if grid.shape[axis] < 3:
        return np.zeros_like(grid)
    width = [(0, 0)] * grid.ndim
    width[axis] = (1, 1)
    return np.pad(np.diff(grid, 2, axis=axis), width, mode="edge")


def _filled(counts: Indices) -> Indices:
    """Return the numbers of slices (1, J - 1, I - 1) around cells, by those of nodes (J, I)."""
    # The second differences at the corners of a cell take the nodes beside them.
    around = np.pad(counts, 1, mode="edge")[None]
    least = _corners(np.minimum, around)
    return np.asarray(_corners(np.minimum, _corners(np.minimum, least)))


def _greatest(parts: AnyArray) -> AnyArray:
    """Return the greater of two components (..., 2)."""
    return np.asarray(np.maximum(parts[..., 0], parts[..., 1]))


def _corners(combine: np.ufunc, nodal: AnyArray) -> AnyArray:
    """Combine values at the four nodes of each cell, (T, J, I, ...) to (T, J - 1, I - 1, ...)."""
    sides = combine(nodal[:, :-1], nodal[:, 1:])
    return np.asarray(combine(sides[:, :, :-1], sides[:, :, 1:]))
