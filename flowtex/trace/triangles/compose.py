"""Long paths on triangles put together from short ones, as :mod:`flowtex.trace.compose` does it.

A path that has come into a triangle continues as the paths of its three corners do, by its shares
of them. That leads to a point in space, outside the surface where it is curved; its triangle is
found by walking over edges from the one that the path of a corner has come to.

Where paths of neighbours part, second differences of a slice across edges are large for its length,
and paths are continued in shorter pieces. Where the paths of only some corners have ended, pieces
are half as long as what was integrated, so that it is known how soon the others end.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.progress import check
from flowtex.trace.compose import ERROR_CELLS, ERROR_SHARE, MOST_PIECES, Map
from flowtex.trace.integrate import MOST_CELLS
from flowtex.trace.triangles.integrate import TrianglePaths, all_shares
from flowtex.trace.triangles.motion import BEHIND, SteadyMotion, TriangleMesh

#: Length in small cells up to which paths are integrated, and least number of such slices.
DIRECT_CELLS, LEAST_DIRECT = 8.0, 2
#: Rounds of steps for these, of which any mesh takes half: what goes on circles about a node.
DIRECT_STEPS = 150
#: Paths that are continued together.
BLOCK = 8192
#: Edges crossed in search of a point: beyond a ridge there may be no triangle that has it.
MOST_CROSSED = 24
#: Share of a triangle, and of a lag, by which rounding may miss it.
ROUNDING = 1e-9
#: Lags after which a path ends that continues, so that one between ends beside those alone that do.
FAR = 1e4
#: Share of a lag by which the ends of a triangle's three paths may lie apart to be interpolated.
ENDS_SHARE = 0.25


def known_lags(lags: Floats, cells: float) -> int:
    """Return how many of lags (M,), of this many small cells a unit, are to be integrated.

    All, unless each is twice the one before.
    """
    known = int(np.searchsorted(lags * cells, DIRECT_CELLS, side="right"))
    known = max(known, LEAST_DIRECT)
    doubled = np.allclose(lags[1:], 2 * lags[:-1], rtol=ROUNDING, atol=0)
    return known if known < len(lags) and doubled else len(lags)


class Composition:
    """Paths of one direction through N nodes.

    Lags (M,) are those of the motion. Displacements ``moved`` (M, N, 3) of the first ``known`` are
    filled, and the others are completed in place.
    """

    def __init__(
        self, motion: SteadyMotion, points: Floats, lags: Floats, known: int, moved: Floats32
    ) -> None:
        self.motion, self.mesh, self.points = motion, motion.mesh, points
        self.lags, self.known, self.moved = lags, known, moved
        count = len(points)
        #: Lag at which each path ends, (N,); 0 for nodes that are not followed.
        self.reach = np.zeros(count)
        #: Triangles by lag, (M, N), and the shares of their second and third corner at the last.
        self._triangle, self._shares = np.zeros((len(lags), count), np.int32), np.zeros((2, count))
        self._ahead = np.zeros((3, count))
        #: Nodes at the corners, (3, T).
        self._corners = np.ascontiguousarray(self.mesh.corners.T)
        #: Number of the longest slice by which paths are continued from each triangle.
        self._longest = np.full(len(self.mesh.corners), known - 1)

    def begin(self, nodes: Indices, paths: TrianglePaths) -> None:
        """Take what was integrated of some nodes (n,)."""
        self._triangle[: self.known, nodes] = paths.triangle
        self._shares[:, nodes], self._ahead[:, nodes] = paths.shares[-1], paths.ahead
        self.reach[nodes] = paths.reach

    def complete(self, nodes: Indices, run: Map) -> None:
        """Fill the long slices at the nodes (n,) that are followed."""
        search, self._bends = _Search(self.mesh, self.points), _Bends(self.mesh, self.points)
        with np.errstate(all="ignore"):
            for m in range(self.known, len(self.lags)):
                check()
                self._judge(m - 1, search.normals)
                self._triangle[m] = self._triangle[m - 1]
                going = nodes[np.isinf(self.reach[nodes])]
                blocks = [going[k : k + BLOCK] for k in range(0, len(going), BLOCK)]
                list(run(partial(self._follow, m, search), blocks))
                corners = self._corners.take(self._triangle[m, nodes], axis=1)
                place = _blend(all_shares(self._shares[:, nodes]), self.points, corners)
                beyond = np.maximum(self.lags[m] - self.reach[nodes], 0.0)
                moved = place + self._ahead[:, nodes] * beyond - self.points[nodes].T
                self.moved[m, nodes] = np.clip(moved.T, -MOST_CELLS, MOST_CELLS)

    def _judge(self, j: int, normals: Floats) -> None:
        """Find the triangles from which slice j continues paths; the first does where it can."""
        reach = self.reach[self._corners]
        first, last = reach.min(axis=0), reach.max(axis=0)
        apart = (last > self.lags[j]) | (last - first > ENDS_SHARE * self.lags[j])
        good = (first > self.lags[j]) | ~apart
        if j < self.known:
            self._longest[~good] = j - 1
            return
        # Lags by time are as long as the fastest corner goes.
        table = self.motion.table
        haste = 1.0 if self.motion.by_length else table[:, 9] / table[:, 10]
        bend = self._bends.of(self.points + self.moved[j], self._triangle[j], normals)
        good &= bend <= 8 * (ERROR_SHARE * self.lags[j] * haste + ERROR_CELLS * self.mesh.size)
        self._longest[good & (self._longest == j - 1)] = j

    # Threads do not take over what was set where they began.
    @np.errstate(all="ignore")
    def _follow(self, m: int, search: _Search, nodes: Indices) -> None:
        """Continue the paths of some nodes, piece by piece, to lag m from the one before."""
        triangle, shares = self._triangle[m - 1, nodes], self._shares[:, nodes]
        lag, pieces = np.full(len(nodes), self.lags[m - 1]), 0
        while len(nodes):
            left = (self.lags[m] - lag) * (1 + ROUNDING)
            number = np.searchsorted(self.lags, left, side="right") - 1
            if pieces < MOST_PIECES:
                number = np.minimum(number, self._longest[triangle])
            pieces += 1
            begin, target, ends = self._piece(m, nodes, number, triangle, shares)
            triangle, shares, outside = search.find(begin, target)
            self._triangle[m, nodes], self._shares[:, nodes] = triangle, shares
            # Beside a border that bends, the chord of paths that continue may lie outside.
            span = self.lags[number]
            ended = (ends <= span) | (outside & np.isfinite(ends))
            self.reach[nodes[ended]] = (lag + np.minimum(ends, span))[ended]
            lag += span
            on = ~ended & (lag < self.lags[m] * (1 - ROUNDING))
            nodes, triangle, shares, lag = nodes[on], triangle[on], shares[:, on], lag[on]

    def _piece(
        self, m: int, nodes: Indices, number: Indices, triangle: Indices, shares: Floats
    ) -> tuple[Indices, Floats, Floats]:
        """Where paths (n,) lead by the slices of these numbers, as their corners' paths do.

        Returns triangles to begin the search at, positions (3, n) outside the surface, and the lags
        from here (n,) at which paths end: infinite where no corner's path does, and more than that
        of the slice where only some do.
        """
        corners, weights = self._corners.take(triangle, axis=1), all_shares(shares)
        reach, span = self.reach[corners], self.lags[number]
        ended = reach <= span
        target = _blend(weights, self.points, corners)
        for weight, nodal in zip(weights, corners, strict=True):
            target += weight * self.moved[number, nodal].T
        best = np.where(ended, -1.0, weights)
        nearest = np.where(best[0] >= np.maximum(best[1], best[2]), 0, 1 + (best[2] > best[1]))
        nodal = corners[nearest, np.arange(len(nodes))]
        begin = self._triangle[number, nodal].astype(np.intp)
        ends = np.full(len(nodes), np.inf)
        some = np.flatnonzero(ended.any(axis=0))
        if len(some):
            part = weights[:, some] * ended[:, some]
            ahead = np.einsum("kn,ckn->cn", part, self._ahead[:, corners[:, some]])
            self._ahead[:, nodes[some]] = ahead = np.nan_to_num(ahead / part.sum(axis=0))
            # What is found at the same time, of other paths, does not count.
            last = np.where(reach[:, some] <= self.lags[m - 1], reach[:, some], FAR * self.lags[m])
            ends[some] = end = np.einsum("kn,kn->n", weights[:, some], last)
            target[:, some] -= ahead * np.maximum(span[some] - end, 0.0)
        return begin, target, ends


class _Search:
    """Finds the points of a surface that positions in space are nearest to."""

    def __init__(self, mesh: TriangleMesh, points: Floats) -> None:
        self._across = mesh.across
        first, second, third = points[mesh.corners].transpose(1, 0, 2)
        e, f = second - first, third - first
        with np.errstate(all="ignore"):
            ee, ef, ff = (
                np.einsum("mc,mc->m", *pair)[:, None] for pair in ((e, e), (e, f), (f, f))
            )
            slopes = [ff * e - ef * f, ee * f - ef * e] / (ee * ff - ef * ef)
            normals = np.cross(e, f)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        #: First corner, and slopes of the shares of the other two, (T, 9).
        self._table = np.concatenate([first, *slopes], axis=1)
        #: Unit normals of the triangles, (T, 3).
        self.normals = normals

    def find(self, triangle: Indices, place: Floats) -> tuple[Indices, Floats, Bools]:
        """Triangles (n,), shares (2, n), and whether positions (3, n) lie beyond a border, (n,).

        The search begins at some triangles (n,).
        """
        found, outside = triangle.copy(), np.zeros(len(triangle), dtype=bool)
        shares, which, before = np.empty((3, len(triangle))), np.arange(len(triangle)), triangle
        for _ in range(MOST_CROSSED):
            row = np.ascontiguousarray(self._table.take(triangle, axis=0).T)
            away = place - row[:3]
            second, third = (np.einsum("cn,cn->n", row[k : k + 3], away) for k in (3, 6))
            here = np.stack([1 - second - third, second, third])
            found[which], shares[:, which] = triangle, here
            out = np.flatnonzero(np.minimum(np.minimum(*here[:2]), here[2]) < -ROUNDING)
            code = self._across[3 * triangle[out] + here[:, out].argmin(axis=0)]
            outside[which[out[code < 0]]] = True
            # Over a ridge it would go to and fro.
            on = (code >= 0) & (code >> 3 != before[out])
            out, before = out[on], triangle[out[on]]
            which, triangle, place = which[out], code[on] >> 3, place[:, out]
            if not len(which):
                break
        np.fmin(np.fmax(shares, 0.0, out=shares), 1.0, out=shares)
        total = shares.sum(axis=0)
        return found, np.asarray(shares[1:] / np.where(total > 0, total, 1.0)), outside


class _Bends:
    """Second differences across the inner edges of a surface, each unfolded."""

    def __init__(self, mesh: TriangleMesh, points: Floats) -> None:
        here = np.flatnonzero(mesh.across >= 0)
        here = here[here // 3 < mesh.across[here] >> 3]
        code, (triangle, k) = mesh.across[here], np.divmod(here, 3)
        there = 3 * (code >> 3) + BEHIND[code & 7]
        flat = mesh.corners.ravel()
        #: Edges by the corners opposite to them, in the triangles on both sides.
        self._sides, self._count = (here, there), len(mesh.corners)
        #: Nodes there, (2, E), and at the ends of the edges, (2, E).
        self._tips = flat[np.stack(self._sides)]
        self._ends = mesh.corners[triangle, (k + np.array([[1], [2]])) % 3]
        one, two = points[self._ends]
        along = two - one
        away = points[self._tips] - one
        with np.errstate(all="ignore"):
            foot = np.einsum("sec,ec->se", away, along) / np.einsum("ec,ec->e", along, along)
            height = np.linalg.norm(away - foot[..., None] * along, axis=-1)
            #: Share of the near tip in the far one, and that of the second end.
            self._near = -height[1] / height[0]
            self._second = foot[1] - self._near * foot[0]
            #: By the smaller of the two triangles.
            self._scale = np.minimum(height[0] / height[1], 1.0)

    def of(self, place: Floats, triangle: Indices, normals: Floats) -> Floats:
        """Greatest second difference of positions (N, 3) at each triangle's edges, (T,).

        What is across the triangles (N,) in which positions lie is due to the surface's own bend.
        """
        near, second = self._near[:, None], self._second[:, None]
        (tip, far), (one, two) = place[self._tips], place[self._ends]
        bend = far - one - near * (tip - one) - second * (two - one)
        normal = normals[triangle[self._tips[1]]]
        bend -= np.einsum("ec,ec->e", bend, normal)[:, None] * normal
        size = np.sqrt(np.einsum("ec,ec->e", bend, bend)) * self._scale
        result = np.zeros(3 * self._count)
        for side in self._sides:
            result[side] = size
        return np.maximum(np.maximum(result[::3], result[1::3]), result[2::3])


def _blend(weights: Floats, nodal: Floats, corners: Indices) -> Floats:
    """Mean (3, n) of nodal vectors (N, 3) at corners (3, n), by weights (3, n)."""
    return np.asarray(sum(w * nodal[at].T for w, at in zip(weights, corners, strict=True)))
