"""Trace slices on triangles, whose displacements are in space."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, cast

import numpy as np

from flowtex._util.array_types import Bools, Floats, Floats32, Indices
from flowtex._util.arrays import dot, norm
from flowtex._util.progress import check, track
from flowtex.field import FlowField
from flowtex.field.triangles.triangle_nodes import incidence
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.trace.compose import ERROR_CELLS, ERROR_SHARE, MOST_PIECES, Map
from flowtex.trace.integrate import MOST_CELLS, Paths
from flowtex.trace.slices import TraceSlices, small_cell
from flowtex.trace.triangles.motion import (
    BEHIND,
    ChangingMotion,
    Motion,
    SteadyMotion,
    TriangleMesh,
    speed_floor,
)
from flowtex.trace.triangles.triangle_paths import TrianglePaths, all_shares, begin, integrate

#: Particles followed together.
BLOCK = 65536
DIRECT_CELLS = 8.0  #: Greatest length of integrated paths, in small cells.
LEAST_DIRECT = 2  #: Least number of slices that are integrated.
#: Rounds of steps for these, twice those that meshes need; more are circles about a node.
DIRECT_STEPS = 75
#: Paths that are continued together.
PIECE_BLOCK = 32768
#: Most edges crossed in search of a point: beside a large cell may lie as many thin ones.
MOST_CROSSED = 500
#: Share of a triangle, and of a lag, by which rounding may miss it.
ROUNDING = 1e-9
#: Lags that stand for the reach of endless paths, so that a path ends only beside ending paths.
FAR = 1e4
#: Share of a lag by which the ends of a triangle's three paths may lie apart to be interpolated.
ENDS_SHARE = 0.25


def triangle_slices(
    field: FlowField,
    steps: list[int],
    parameter: str,
    lags: Floats,
    unit: Floats,
    chosen: Bools,
    *,
    two_sided: bool,
    tolerance: float,
    compose: bool,
    run: Map,
    progress: bool,
) -> TraceSlices:
    """Follow the paths through some nodes, ``chosen`` (1, N); others have reach and path 0.

    Composition needs the paths around them: all are followed then. Lags (M,) are in
    multiples of ``unit`` (1, N), and ``run`` maps a function over blocks.
    """
    mesh, points, direct = _mesh(field), field.points[0], len(lags)
    if compose and len(steps) == 1:
        direct = _direct_lags(field, parameter, lags, unit)
    followed = chosen if direct == len(lags) else field.valid
    at = np.flatnonzero(followed[0] & (mesh.last > mesh.first))
    sides = (-1.0, 1.0) if two_sided else (-1.0,)
    displacement = np.zeros((len(sides), len(steps), len(lags), *field.points.shape), np.float32)
    reach = np.zeros((len(sides), len(steps), *field.shape), np.float32)
    motions = [_motions(field, steps, parameter, side) for side in sides]
    compositions: list[Composition] = []
    if direct < len(lags):
        compositions = [
            Composition(cast("SteadyMotion", motion[0]), points, lags * unit.flat[0], direct, moved)
            for motion, moved in zip(motions, displacement[:, 0, :, 0], strict=True)
        ]

    starts = [[*run(partial(begin, nodes=at), side)] if len(at) else [] for side in motions]

    def work(job: tuple[int, int, slice]) -> None:
        side, step, block = job
        motion = motions[side][step]
        nodes = at[block]
        corners, ended = starts[side][step]
        triangle, corner = np.divmod(corners[block], 3)
        shares = np.stack([corner == 1, corner == 2]).astype(float)
        units = unit[0, nodes]
        due = lags[:direct, None] * units
        options: dict[str, Any] = {"tolerance": tolerance, "last": float(lags[-1]) * units}
        options["ended"] = ended[block]
        if compositions:
            options["most_steps"] = DIRECT_STEPS
        paths = integrate(motion, points, triangle, shares, due, **options)
        start = points[nodes]
        for m in range(direct):
            moved = paths.positions(mesh, points, m) - start
            displacement[side, step, m, 0, nodes] = np.clip(moved, -MOST_CELLS, MOST_CELLS)
        reach[side, step, 0, nodes] = paths.reach / units
        if compositions:
            compositions[side].begin(nodes, paths)

    blocks = [slice(first, first + BLOCK) for first in range(0, len(at), BLOCK)]
    jobs = [(a, b, c) for a in range(len(sides)) for b in range(len(steps)) for c in blocks]
    for _ in track(run(work, jobs), len(jobs), "Tracing", show=progress):
        pass
    if compositions:
        search = _Search(mesh, points)
        bends = _Bends(mesh, points)
    for side, composition in enumerate(compositions):
        composition.complete(at, search, bends, run)
        reach[side, 0, 0] = composition.reach / unit[0]
    return TraceSlices(
        lags=lags,
        unit=unit,
        displacement=displacement[0],
        forward=displacement[1] if two_sided else None,
        rate=_rates(field, steps, parameter) * unit[..., None],
        reach=reach[0],
        forward_reach=reach[1] if two_sided else None,
        nodes=field.points,
        times=field.times[steps],
        parameter=parameter,
    )


def _direct_lags(field: FlowField, parameter: str, lags: Floats, unit: Floats) -> int:
    """Return how many of the lags are integrated; the others are composed."""
    if not field.steady or field.sign_free or not np.all(unit == unit.flat[0]):
        return len(lags)
    speed = field.index_velocity.speed[0][field.valid]
    moving = speed[speed > 0]
    if parameter == "time" and len(moving):
        pace = float(np.median(moving))
    else:
        pace = 1.0
    cells = lags * (pace * float(unit.flat[0]) / small_cell(field))
    direct = max(int(np.searchsorted(cells, DIRECT_CELLS, side="right")), LEAST_DIRECT)
    # Each has to be twice the one before.
    doubled = np.allclose(lags[1:], 2 * lags[:-1], rtol=ROUNDING, atol=0)
    if direct < len(lags) and doubled:
        return direct
    return len(lags)


def triangle_paths(
    field: FlowField,
    start: Floats,
    lags: Floats,
    *,
    step: int,
    parameter: str,
    direction: float,
    tolerance: float,
) -> Paths:
    """Return what :func:`flowtex.trace.paths` does; a path that has ended stays at its end."""
    surface = cast("TriangleSurface", field.surface)
    mesh = _mesh(field)
    motion = _motions(field, [step], parameter, direction)[0]
    triangle = np.clip(np.floor(start[:, 1]).astype(np.intp), 0, len(mesh.corners) - 1)
    second = np.clip(start[:, 1] - triangle, 0.0, 1.0)
    shares = np.stack([second, np.clip(start[:, 0], 0.0, 1.0 - second)])
    usable = surface.cells[triangle]
    due = np.broadcast_to(lags[:, None], (len(lags), int(usable.sum()))).copy()
    paths = integrate(
        motion, field.points[0], triangle[usable], shares[:, usable], due, tolerance=tolerance
    )
    positions = np.repeat(start[None], len(lags), axis=0)
    reach = np.zeros(len(start))
    two = np.moveaxis(paths.shares, 1, -1)
    weights = np.concatenate([1 - two.sum(axis=-1, keepdims=True), two], axis=-1)
    positions[:, usable] = surface.index_of(paths.triangle, weights)
    reach[usable] = paths.reach
    nothing = np.zeros(len(start), dtype=bool)
    return Paths(positions, reach, nothing, nothing, nothing)


def _mesh(field: FlowField) -> TriangleMesh:
    return TriangleMesh.of(cast("TriangleSurface", field.surface))


def _motions(
    field: FlowField, steps: Sequence[int], parameter: str, direction: float
) -> list[Motion]:
    """Return one motion for each destination time."""
    if field.steady:
        return [SteadyMotion(field, direction, by_length=parameter == "arclength")] * len(steps)
    components = np.ascontiguousarray(field.index_velocity.components).reshape(-1, 2)
    mesh = _mesh(field)
    times = field.times
    return [ChangingMotion(mesh, components, times, float(times[n]), direction) for n in steps]


def _rates(field: FlowField, steps: Sequence[int], parameter: str) -> Floats:
    """Return velocities at the nodes, (T, 1, N, 2), by arc length of unit length."""
    flow = field.index_velocity
    rate = np.asarray(flow.components[list(steps)])
    if parameter == "arclength":
        speed = flow.speed[0]
        floor = speed_floor(speed)
        rate = np.divide(
            rate, speed[..., None], out=np.zeros_like(rate), where=(speed > floor)[..., None]
        )
    return np.where(field.valid[..., None], rate, 0.0)


class Composition:
    """Long paths of one direction through N nodes, put together from short ones.

    It is done as in :mod:`flowtex.trace.compose`. A path in a triangle continues as the mean of the
    paths of its three corners, to a point in space, perhaps outside the surface; its triangle is
    found by walking over edges from the one in which the path of a corner ends. Where paths of
    neighbours part, second differences of a slice across edges are large for its length, and paths
    are continued in shorter pieces; so they are where the paths of only some corners have ended.

    Lags (M,) are those of the motion. Displacements ``moved`` (M, N, 3) of the first ``direct`` are
    filled, and the others are completed in place.
    """

    def __init__(
        self, motion: SteadyMotion, points: Floats, lags: Floats, direct: int, moved: Floats32
    ) -> None:
        self.motion = motion
        self.mesh = motion.mesh
        self.points = points
        self.lags = lags
        self.direct = direct
        self.moved = moved
        self._moved_in_row = moved.reshape(-1, 3)
        count = len(points)
        #: Lag at which each path ends, (N,); 0 for nodes that are not followed.
        self.reach = np.zeros(count)
        #: Triangles by lag, (M, N), and the shares of their second and third corner at the last.
        self._triangle = np.zeros((len(lags), count), np.int32)
        self._shares = np.zeros((2, count))
        self._ahead = np.zeros((3, count))
        #: Nodes at the corners, (3, T).
        self._corners = np.ascontiguousarray(self.mesh.corners.T)
        #: Number of the longest slice by which paths are continued from each triangle.
        self._longest = np.full(len(self.mesh.corners), direct - 1)

    def begin(self, nodes: Indices, paths: TrianglePaths) -> None:
        """Take the integrated paths of some nodes (n,)."""
        self._triangle[: self.direct, nodes] = paths.triangle
        self._shares[:, nodes], self._ahead[:, nodes] = paths.shares[-1], paths.ahead
        # A step across a large triangle may find an end beyond the last integrated slice, where the
        # particle has not come yet.
        found = paths.reach <= self.lags[self.direct - 1]
        self.reach[nodes] = np.where(found, paths.reach, np.inf)

    def complete(self, nodes: Indices, search: _Search, bends: _Bends, run: Map) -> None:
        """Fill the long slices at the nodes (n,) that are followed."""
        with np.errstate(all="ignore"):
            for m in range(self.direct, len(self.lags)):
                check()
                self._judge(m - 1, bends, search.normals)
                self._triangle[m] = self._triangle[m - 1]
                going = nodes[np.isinf(self.reach[nodes])]
                blocks = [going[k : k + PIECE_BLOCK] for k in range(0, len(going), PIECE_BLOCK)]
                list(run(partial(self._follow, m, search), blocks))
                corners = self._corners.take(self._triangle[m, nodes], axis=1)
                place = _blend(all_shares(self._shares[:, nodes]), self.points, corners)
                beyond = np.maximum(self.lags[m] - self.reach[nodes], 0.0)
                moved = place + self._ahead[:, nodes] * beyond - self.points[nodes].T
                self.moved[m, nodes] = np.clip(moved.T, -MOST_CELLS, MOST_CELLS)

    def _judge(self, j: int, bends: _Bends, normals: Floats) -> None:
        """Find the triangles in which slice j continues paths."""
        reach = self.reach[self._corners]
        first = reach.min(axis=0)
        last = reach.max(axis=0)
        apart = (last > self.lags[j]) | (last - first > ENDS_SHARE * self.lags[j])
        good = (first > self.lags[j]) | ~apart
        if j < self.direct:
            self._longest[~good] = j - 1
            return
        # Lags by time are converted into lengths by the fastest corner.
        table = self.motion.table
        stretch: Floats | float = 1.0
        if not self.motion.by_length:
            stretch = table[:, 9] / table[:, 10]
        bend = bends.of(self.points + self.moved[j], self._triangle[j], normals)
        good &= bend <= 8 * (ERROR_SHARE * self.lags[j] * stretch + ERROR_CELLS * self.mesh.size)
        self._longest[good & (self._longest == j - 1)] = j

    # Threads do not inherit the error state.
    @np.errstate(all="ignore")
    def _follow(self, m: int, search: _Search, nodes: Indices) -> None:
        """Continue the paths of some nodes, piece by piece, to lag m from the one before."""
        triangle = self._triangle[m - 1, nodes]
        shares = self._shares[:, nodes]
        lag = np.full(len(nodes), self.lags[m - 1])
        pieces = 0
        most = np.full(len(nodes), m)
        while len(nodes):
            left = (self.lags[m] - lag) * (1 + ROUNDING)
            number = np.searchsorted(self.lags, left, side="right") - 1
            if pieces < MOST_PIECES:
                number = np.minimum(number, self._longest.take(triangle))
            number = np.minimum(number, most)
            pieces += 1
            begin, target, ends = self._piece(m, nodes, number, triangle, shares)
            found, at, outside = search.find(begin, target)
            span = self.lags.take(number)
            # Beside a border that bends, the chord of paths that continue may lie outside, as it
            # does where a path ends that its neighbours pass: a shorter piece shows which.
            unclear = outside & np.isfinite(ends)
            again = unclear & (ends > span) & (number > 0) & (pieces < MOST_PIECES)
            most = np.where(again, number - 1, m)
            triangle = np.where(again, triangle, found)
            shares = np.where(again, shares, at)
            ended = ~again & ((ends <= span) | unclear)
            self.reach[nodes[ended]] = (lag + np.minimum(ends, span))[ended]
            lag += np.where(again, 0.0, span)
            is_left = ~ended & (lag < self.lags[m] * (1 - ROUNDING))
            done = np.flatnonzero(~is_left)
            if not len(done):
                continue
            self._triangle[m, nodes[done]] = triangle[done]
            self._shares[:, nodes[done]] = shares[:, done]
            on = np.flatnonzero(is_left)
            nodes = nodes[on]
            triangle = triangle[on]
            shares = shares[:, on]
            lag = lag[on]
            most = most[on]

    def _piece(
        self, m: int, nodes: Indices, number: Indices, triangle: Indices, shares: Floats
    ) -> tuple[Indices, Floats, Floats]:
        """Continue paths (n,) by the slices of these numbers, as means of their corners' paths.

        Returns triangles to begin the search at, target positions (3, n), perhaps outside the
        surface, and the lags from here (n,) at which paths end: infinite where no corner's path
        does, and more than that of the slice where only some do.
        """
        corners = self._corners.take(triangle, axis=1)
        weights = all_shares(shares)
        reach = self.reach.take(corners)
        span = self.lags.take(number)
        ended = reach <= span
        # Nodes of all slices in a row.
        rows = number * len(self.points) + corners
        target = _blend(weights, self.points, corners)
        target += _blend(weights, self._moved_in_row, rows)
        best = np.where(ended, -1.0, weights)
        nearest = np.where(best[0] >= np.maximum(best[1], best[2]), 0, 1 + (best[2] > best[1]))
        row = rows[nearest, np.arange(len(nodes))]
        begin = self._triangle.take(row).astype(np.intp)
        ends = np.full(len(nodes), np.inf)
        near = np.flatnonzero(ended.any(axis=0))
        if len(near):
            part = weights[:, near] * ended[:, near]
            ahead = np.einsum("kn,ckn->cn", part, self._ahead[:, corners[:, near]])
            self._ahead[:, nodes[near]] = ahead = np.nan_to_num(ahead / part.sum(axis=0))
            # Ends of other paths that are found at the same time do not count.
            last = np.where(reach[:, near] <= self.lags[m - 1], reach[:, near], FAR * self.lags[m])
            ends[near] = end = np.einsum("kn,kn->n", weights[:, near], last)
            target[:, near] -= ahead * np.maximum(span[near] - end, 0.0)
        return begin, target, ends


class _Search:
    """Search for the points of a surface nearest to positions in space."""

    def __init__(self, mesh: TriangleMesh, points: Floats) -> None:
        self._across = mesh.across
        first, second, third = points[mesh.corners].transpose(1, 0, 2)
        e = second - first
        f = third - first
        with np.errstate(all="ignore"):
            ee = np.einsum("mc,mc->m", e, e)[:, None]
            ef = np.einsum("mc,mc->m", e, f)[:, None]
            ff = np.einsum("mc,mc->m", f, f)[:, None]
            slopes = [ff * e - ef * f, ee * f - ef * e] / (ee * ff - ef * ef)
            normals = np.cross(e, f)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        #: First corner, and slopes of the shares of the other two, (T, 9).
        self._table = np.concatenate([first, *slopes], axis=1)
        #: Unit normals of the triangles, (T, 3).
        self.normals = normals

    def find(self, triangle: Indices, place: Floats) -> tuple[Indices, Floats, Bools]:
        """Return triangles (n,), shares (2, n), and if positions (3, n) lie beyond a border, (n,).

        The search begins at some triangles (n,).
        """
        current = self._shares(triangle, place)
        result = triangle.copy()
        shares = current.copy()
        outside = np.zeros(len(triangle), dtype=bool)
        which = np.arange(len(triangle))
        before = triangle
        # Triangles in which the search was at a power of two of rounds.
        mark = triangle
        for crossed in range(MOST_CROSSED):
            if crossed & (crossed - 1) == 0:
                mark = triangle
            out = np.flatnonzero(np.minimum(np.minimum(*current[:2]), current[2]) < -ROUNDING)
            code = self._across.take(3 * triangle[out] + current[:, out].argmin(axis=0))
            outside[which[out[code < 0]]] = True
            # Over a ridge the search would go to and fro, and about a corner round and round.
            ahead = code >> 3
            on = (code >= 0) & (ahead != before[out]) & (ahead != mark[out])
            out = out[on]
            if not len(out):
                break
            before = triangle[out]
            mark = mark[out]
            which = which[out]
            triangle = ahead[on]
            place = place[:, out]
            current = self._shares(triangle, place)
            result[which] = triangle
            shares[:, which] = current
        np.fmin(np.fmax(shares, 0.0, out=shares), 1.0, out=shares)
        total = shares.sum(axis=0)
        return result, np.asarray(shares[1:] / np.where(total > 0, total, 1.0)), outside

    def _shares(self, triangle: Indices, place: Floats) -> Floats:
        """Return the shares (3, n) of the corners of triangles (n,) at positions (3, n)."""
        row = np.ascontiguousarray(self._table.take(triangle, axis=0).T)
        away = place - row[:3]
        shares = np.empty(away.shape)
        np.einsum("cn,cn->n", row[3:6], away, out=shares[1])
        np.einsum("cn,cn->n", row[6:9], away, out=shares[2])
        shares[0] = 1 - shares[1] - shares[2]
        return shares


class _Bends:
    """Second differences across the inner edges of a surface, each unfolded."""

    def __init__(self, mesh: TriangleMesh, points: Floats) -> None:
        near = np.flatnonzero(mesh.across >= 0)
        near = near[near // 3 < mesh.across[near] >> 3]
        code = mesh.across[near]
        (triangle, k) = np.divmod(near, 3)
        far = 3 * (code >> 3) + BEHIND[code & 7]
        flat = mesh.corners.ravel()
        #: Edges by the corners opposite to them, in the triangles on both sides.
        self._sides = (near, far)
        self._count = len(mesh.corners)
        tips = flat[np.stack(self._sides)]
        ends = mesh.corners[triangle, (k + np.array([[1], [2]])) % 3]
        begin, end = points[ends]
        along = end - begin
        away = points[tips] - begin
        with np.errstate(all="ignore"):
            foot = np.einsum("sec,ec->se", away, along) / np.einsum("ec,ec->e", along, along)
            height = np.linalg.norm(away - foot[..., None] * along, axis=-1)
            # Share of the near tip in the far one, and share of the second end.
            share = -height[1] / height[0]
            second = foot[1] - share * foot[0]
            #: By the smaller of the two triangles.
            self._scale = np.minimum(height[0] / height[1], 1.0)
        weights = np.stack([np.ones(len(near)), -share, share + second - 1, -second], axis=-1)
        nodes = np.stack([tips[1], tips[0], *ends], axis=-1)
        #: Second differences of values at the nodes, (E, N).
        self._differences = incidence(nodes, len(points), weights)
        #: Nodes opposite to the edges, on one side.
        self._far = tips[1]

    def of(self, place: Floats, triangle: Indices, normals: Floats) -> Floats:
        """Return the greatest second difference of positions (N, 3) at each triangle's edges, (T,).

        Components normal to the triangles (N,) of the positions are left out: they are due to the
        bend of the surface.
        """
        bend = self._differences @ place
        normal = normals.take(triangle.take(self._far), axis=0)
        bend -= dot(bend, normal)[:, None] * normal
        size = norm(bend) * self._scale
        result = np.zeros(3 * self._count)
        for side in self._sides:
            result[side] = size
        return np.maximum(np.maximum(result[::3], result[1::3]), result[2::3])


def _blend(weights: Floats, nodal: Floats | Floats32, corners: Indices) -> Floats:
    """Return the mean (3, n) of nodal vectors (N, 3) at corners (3, n), by weights (3, n)."""
    result = np.zeros((corners.shape[1], 3))
    for weight, at in zip(weights, corners, strict=True):
        result += weight[:, None] * nodal.take(at, axis=0)
    return result.T
