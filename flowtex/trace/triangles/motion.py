"""Motion of particles inside the triangles of a surface, and across edges.

The velocity of each corner is turned out of the tangent plane of the node into the plane of the
triangle, by the smallest rotation; so the surface is unfolded at its edges. In between it is
linear, so the shares of the corners, at which a particle is, change by a linear law too.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import cast

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex._util.cache import WeakCache
from flowtex.field import FlowField
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.trace.integrate import Columns
from flowtex.trace.sampler import RESTING_CELLS, STILL_CELLS, STOPPED_SPEED

#: Relative velocity out of a border that counts as zero.
BORDER_ROUNDING = 1e-6
#: Relative velocity over a sharp edge up to which a flow goes along it, unless that behind the edge
#: continues it. So it does around a disc, although the straight sides turn away from it by half the
#: angle between two.
GRAZING = 0.15
AWAY = 0.35  #: Relative velocity away from an edge from which on a flow does not continue another.
#: Triangles whose geometry is computed at once.
BLOCK_TRIANGLES = 65536
#: Columns of the table of a steady motion.
COLUMNS = 14
#: Ratio of the rates at which particles approach a line in a triangle and move along it, from which
#: on they count as on the line.
STIFF = 4.0
OFF_LINE = 1e-3  #: Greatest distance from the line, in sizes of the triangle.


@dataclass(frozen=True, eq=False)
class TriangleMesh:
    """The geometry of a surface of M triangles."""

    corners: Indices  #: Nodes, (M, 3).
    #: For the edge opposite to each corner, (3 M,): the triangle behind it times eight, plus how
    #: its corners are those of this one, an index of :data:`BEHIND`; or -1 where paths end.
    across: Indices
    #: For each of these edges, the greatest velocity out of the triangle, over the speed, with
    #: which a particle may slide along it: at borders, and at sharp edges; -1 at others, (3 M,).
    slip: Floats
    #: Rates at which the second and the third share change, by components of the velocity at each
    #: corner, (M, 12) as (corner, share, component).
    rates: Floats
    #: Products of the sides from the first corner to the others, over the square of the size,
    #: (M, 3), those of the first, of both, and of the second.
    metric: Floats
    heights: Floats  #: Distance from each corner to the edge opposite, over the size, (M, 3).
    size: Floats  #: Mean length of the sides, (M,).
    #: Corners by place and by node: numbers of triangles times three plus that of the corner, those
    #: of node n from ``first[n]`` to ``last[n]``; only of triangles with data.
    around: Indices
    first: Indices
    last: Indices
    #: The same for all nodes at the place of each, which are several at sharp edges.
    place_first: Indices
    place_last: Indices

    @classmethod
    def of(cls, surface: TriangleSurface) -> TriangleMesh:
        """Return the mesh of a surface, made once."""
        return _meshes.get("mesh", lambda: cls._made(surface), owner=surface)

    @classmethod
    def _made(cls, surface: TriangleSurface) -> TriangleMesh:
        count = len(surface.triangles)
        rates = np.empty((count, 3, 2, 2))
        metric = np.empty((count, 3))
        heights = np.empty((count, 3))
        size = np.empty(count)
        for start in range(0, count, BLOCK_TRIANGLES):
            block = slice(start, start + BLOCK_TRIANGLES)
            _measure(surface, block, rates[block], metric[block], heights[block], size[block])
        across = _across(surface)
        shown = np.flatnonzero(surface.cells)
        place = surface.places
        rank = np.empty(surface.shape[1], dtype=np.intp)
        # Nodes at one place follow each other.
        rank[np.argsort(place, kind="stable")] = np.arange(len(rank))
        nodes = rank[surface.triangles[shown].ravel()]
        order = np.argsort(nodes, kind="stable")
        ends = np.searchsorted(nodes[order], np.arange(len(rank) + 1))
        first = ends[rank]
        last = ends[rank + 1]
        place_last = last.copy()
        np.maximum.at(place_last, place, last)
        return cls(
            corners=surface.triangles,
            across=across,
            slip=_slip(surface, across),
            rates=rates.reshape(count, 12),
            metric=metric,
            heights=heights,
            size=size,
            around=(3 * shown[:, None] + np.arange(3)).ravel()[order],
            first=first,
            last=last,
            place_first=first[place],
            place_last=place_last[place],
        )


_meshes: WeakCache[TriangleMesh] = WeakCache()


def _measure(
    surface: TriangleSurface,
    block: slice,
    rates: Floats,
    metric: Floats,
    heights: Floats,
    size: Floats,
) -> None:
    """Write the values of a block of triangles."""
    nodes = surface.triangles[block]
    p = surface.points[0][nodes]
    one = p[:, 1] - p[:, 0]
    two = p[:, 2] - p[:, 0]
    sides = np.linalg.norm([p[:, 2] - p[:, 1], two, one], axis=-1)
    size[:] = sides.mean(axis=0)
    # In sizes of the triangle, so that no square is too large or too small.
    e = one / size[:, None]
    f = two / size[:, None]
    normal = np.cross(e, f)
    area = np.linalg.norm(normal, axis=1, keepdims=True)
    heights[:] = (area[:, 0] / (sides / size)).T
    metric[:] = np.stack([_dot(e, e), _dot(e, f), _dot(f, f)], axis=-1)
    normal /= area
    slopes = np.stack([np.cross(f, normal), np.cross(normal, e)]) / (area * size[:, None])
    for k in range(3):
        at = nodes[:, k]
        away = surface.normals[0, at]
        cosine = _dot(away, normal)
        # The surface has two sides: a triangle may face the other way than its node.
        away = np.where(cosine[:, None] < 0, -away, away)
        for component in range(2):
            tangent = surface.tangents[component, 0, at]
            turn = _dot(tangent, normal) / (1 + np.abs(cosine))
            turned = tangent - turn[:, None] * away
            for share in range(2):
                rates[:, k, share, component] = _dot(slopes[share], turned)


def _dot(one: Floats, two: Floats) -> Floats:
    return np.asarray(np.einsum("mc,mc->m", one, two))


def _across(surface: TriangleSurface) -> Indices:
    corners = surface.joined
    beside = surface.neighbours
    result = np.full(beside.shape, -1, dtype=np.intp)
    for k in range(3):
        near = np.flatnonzero((beside[:, k] >= 0) & surface.cells)
        near = near[surface.cells[beside[near, k]]]
        far = beside[near, k]
        ends = [corners[near, (k + step) % 3] for step in (1, 2)]
        at = [np.argmax(corners[far] == end[:, None], axis=1) for end in ends]
        result[near, k] = 8 * far + 2 * at[0] + ((at[1] - at[0]) % 3 - 1)
    return result.ravel()


def _slip(surface: TriangleSurface, across: Indices) -> Floats:
    result = np.where(across < 0, BORDER_ROUNDING, -1.0).reshape(-1, 3)
    if not surface.at_edge.any():
        return result.ravel()
    has_edge = surface.at_edge[0, surface.triangles].any(axis=1)
    for k in range(3):
        near = np.flatnonzero(has_edge & (across.reshape(-1, 3)[:, k] >= 0))
        beside = surface.triangles[surface.neighbours[near, k]]
        ends = [surface.triangles[near, (k + step) % 3] for step in (1, 2)]
        is_own = [(beside == end[:, None]).any(axis=1) for end in ends]
        result[near[~(is_own[0] | is_own[1])], k] = GRAZING
    return result.ravel()


#: By the last three bits of :attr:`TriangleMesh.across`: the corner of the other triangle that is
#: not on the edge.
BEHIND = np.array([3 - m - (m + step) % 3 for m in range(3) for step in (1, 2)], dtype=np.intp)
#: Whether its second and third shares, (2, 6), belong to the next corner here.
NEXT = np.array([[m == k for m in range(3) for _ in (1, 2)] for k in (1, 2)], dtype=float)
#: Whether they belong to the corner after the next.
AFTER = np.array([[(m + s) % 3 == k for m in range(3) for s in (1, 2)] for k in (1, 2)], float)


@dataclass
class Derivatives(Columns):
    """Motion of particles at one moment, each in time and length units of its triangle."""

    first: Floats  #: Derivatives of the second and third share by time, (2, N).
    second: Floats
    third: Floats
    bend: Floats  #: Part of the second derivative due to the change of place, (2, N).
    metric: Floats  #: As :attr:`TriangleMesh.metric`, (3, N).
    #: Length of a unit of length, and lag of a unit of time, (N,).
    size: Floats
    pace: Floats
    rest: Floats  #: Square of the speed up to which a particle stands still, (N,).
    until: Floats | None = None  #: Lag at which the law becomes another, (N,), or ``None``.

    def put(self, at: Indices, values: Derivatives) -> None:
        """Write the derivatives of some particles (n,) in place."""
        for part in fields(self):
            target = getattr(self, part.name)
            source = getattr(values, part.name)
            if target is not None and part.name != "bend":
                target[..., at] = source
        if self.bend is not self.second:
            self.bend[:, at] = values.bend


def dot(metric: Floats, one: Floats, two: Floats) -> Floats:
    """Return products of vectors (2, N) that are changes of the second and third share."""
    across = one[0] * two[1] + one[1] * two[0]
    return np.asarray(
        metric[0] * (one[0] * two[0]) + metric[1] * across + metric[2] * (one[1] * two[1])
    )


class Motion(ABC):
    """A field as the integrator uses it, in one direction."""

    #: Whether lags are lengths of paths.
    by_length = False

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh

    @abstractmethod
    def at(self, triangle: Indices, shares: Floats, lag: Floats, last: Floats) -> Derivatives:
        """Return derivatives at shares (2, N) of the second and third corner of triangles (N,).

        The particles are at ``lag`` (N,), and are followed until ``last`` (N,).
        """

    def at_corner(self, corner: int) -> Floats:
        """Return changes of the second and third share, by length, at a corner of each triangle."""
        count = len(self.mesh.corners)
        shares = np.zeros((3, count))
        still = np.zeros(count)
        shares[corner] = 1
        now = self.at(np.arange(count), shares[1:], still, still + 1)
        return now.first * (now.size / now.pace)


class SteadyMotion(Motion):
    """A field that does not change, by the length of path or by time."""

    def __init__(self, field: FlowField, direction: float, *, by_length: bool) -> None:
        super().__init__(TriangleMesh.of(cast("TriangleSurface", field.surface)))
        self.by_length = by_length
        self.direction = direction
        flow = field.index_velocity
        self.floor = floor = speed_floor(flow.speed) if by_length else 0.0
        speed = np.where(flow.speed[0, 0] > floor, flow.speed[0, 0], 0.0)
        self.table = _table(self.mesh, flow.components[0, 0], speed)
        #: Rates at which particles approach a line in each triangle, and move along it, (2, T);
        #: equal ones mean no line.
        law = direction * self.table[:, 2:6].T
        middle = (law[0] + law[3]) / 2
        apart = np.sqrt(np.maximum(middle**2 - law[0] * law[3] + law[1] * law[2], 0.0))
        near, along = middle - apart, middle + apart  # eigenvalues
        self.pulls = np.where(-near > STIFF * np.abs(along), [near, along], 0.0)
        self._has_line = self.pulls[0] != self.pulls[1]

    def at(self, triangle: Indices, shares: Floats, lag: Floats, last: Floats) -> Derivatives:
        """Return derivatives, see :meth:`Motion.at`."""
        part = np.ascontiguousarray(self.table.take(triangle, axis=0, mode="clip").T)
        if self.direction < 0:
            np.negative(part[:6], out=part[:6])
        one = part[2:4]
        two = part[4:6]
        first = part[:2] + one * shares[0] + two * shares[1]
        second = one * first[0] + two * first[1]
        third = one * second[0] + two * second[1]
        size = part[9]
        pace = part[10]
        self._lead_along(triangle, part[6:9], first, second, third)
        if self.by_length:
            rest = RESTING_CELLS * (part[11] + part[12] * shares[0] + part[13] * shares[1])
        else:
            rest = STILL_CELLS * pace / last
        return Derivatives(first, second, third, second, part[6:9], size, pace, rest * rest)

    def at_corner(self, corner: int) -> Floats:
        """Return changes of the shares at a corner, see :meth:`Motion.at_corner`."""
        rates = self.table[:, :2] + (self.table[:, 2 * corner : 2 * corner + 2] if corner else 0)
        return (rates * (self.direction * self.table[:, 9] / self.table[:, 10])[:, None]).T

    def _lead_along(
        self, triangle: Indices, metric: Floats, first: Floats, second: Floats, third: Floats
    ) -> None:
        """Let particles on an attracting line, to which they decay fast, move along it."""
        at = np.flatnonzero(self._has_line[triangle])
        near, along = self.pulls[:, triangle[at]]
        slow = (second[:, at] - near * first[:, at]) / (along - near)
        off = first[:, at] - slow
        on = dot(metric[:, at], off, off) < (OFF_LINE * near) ** 2
        at = at[on]
        slow = slow[:, on]
        along = along[on]
        first[:, at], second[:, at], third[:, at] = slow, along * slow, along**2 * slow


def speed_floor(speed: Floats) -> float:
    """Return the speed up to which a particle has stopped."""
    return max(STOPPED_SPEED * float(speed.max()), np.finfo(float).tiny)


def _table(mesh: TriangleMesh, components: Floats, speed: Floats) -> Floats:
    """Return the change of shares in each triangle, (M, COLUMNS), in its time and length units.

    Columns are rates (2) at the first corner, their changes by the second and by the third share
    (2, 2), metric (3), size, pace, and the speed (3) as the rates, plus a floor.
    """
    result = np.empty((len(mesh.corners), COLUMNS))
    for start in range(0, len(result), BLOCK_TRIANGLES):
        block = slice(start, start + BLOCK_TRIANGLES)
        corners = mesh.corners[block]
        part = result[block]
        speeds = speed[corners]
        most = speeds.max(axis=1)
        pace = mesh.size[block] / np.where(most > 0, most, 1.0)
        velocity = np.where(speeds[..., None] > 0, components[corners], 0.0) * pace[:, None, None]
        rates = np.einsum("mksc,mkc->mks", mesh.rates[block].reshape(-1, 3, 2, 2), velocity)
        part[:, :2] = rates[:, 0]
        part[:, 2:4], part[:, 4:6] = rates[:, 1] - rates[:, 0], rates[:, 2] - rates[:, 0]
        part[:, 6:9], part[:, 9], part[:, 10] = mesh.metric[block], mesh.size[block], pace
        speeds = speeds / np.where(most > 0, most, 1.0)[:, None]
        # A path into a region at rest becomes slower and slower; it ends at the floor.
        part[:, 11] = speeds[:, 0] + STOPPED_SPEED / RESTING_CELLS
        part[:, 12:] = speeds[:, 1:] - speeds[:, :1]
    return result


class ChangingMotion(Motion):
    """A time-varying field, linear between its steps and constant beyond them.

    Lags count from ``destination``, a time; ``components`` (T * N, 2) are those of all steps.
    """

    def __init__(
        self, mesh: TriangleMesh, components: Floats, times: Floats, destination: float, side: float
    ) -> None:
        super().__init__(mesh)
        self.components = components
        self.direction = side
        lags = side * (times - destination)
        #: Lags of the time steps, increasing, and the first node of each.
        if side > 0:
            self.levels = lags
        else:
            self.levels = lags[::-1].copy()
        first = np.arange(len(times)) * (len(components) // len(times))
        if side > 0:
            self.steps = first
        else:
            self.steps = first[::-1].copy()

    def at(self, triangle: Indices, shares: Floats, lag: Floats, last: Floats) -> Derivatives:
        """Return derivatives, see :meth:`Motion.at`."""
        velocity, change, until = self._corners(self.mesh.corners.take(triangle, axis=0), lag)
        rates = np.ascontiguousarray(self.mesh.rates.take(triangle, axis=0).T)
        law = _linear(rates.reshape(3, 2, 2, -1), velocity)
        later = _linear(rates.reshape(3, 2, 2, -1), change)
        first = law[0] + law[1] * shares[0] + law[2] * shares[1]
        bend = law[1] * first[0] + law[2] * first[1]
        second = bend + later[0] + later[1] * shares[0] + later[2] * shares[1]
        third = law[1] * second[0] + law[2] * second[1]
        third += 2 * (later[1] * first[0] + later[2] * first[1])
        metric = self.mesh.metric.take(triangle, axis=0).T
        size = self.mesh.size.take(triangle)
        # In a time-varying flow no particle stays at rest.
        pace = np.ones(len(lag))
        rest = np.full(len(lag), -1.0)
        return Derivatives(
            first, second, third, bend, metric, size, pace, rest, np.minimum(until, last)
        )

    def _corners(self, nodes: Indices, lag: Floats) -> tuple[Floats, Floats, Floats]:
        """Return velocity of nodes (N, 3), its change by lag, (3, 2, N), and until when, (N,)."""
        after = np.searchsorted(self.levels, lag, side="right")
        early = np.maximum(after - 1, 0)
        late = np.minimum(after, len(self.levels) - 1)
        begin = self.levels[early]
        end = self.levels[late]
        span = np.where(end > begin, end - begin, 1.0)
        before, following = (
            self.components.take(nodes + self.steps[at][:, None], axis=0).transpose(1, 2, 0)
            for at in (early, late)
        )
        change = (following - before) * (self.direction / span)
        velocity = self.direction * before + change * np.maximum(lag - begin, 0.0)
        return velocity, change, np.where(end > lag, end, np.inf)


def _linear(rates: Floats, corners: Floats) -> Floats:
    """Return rates at the first corner, and their changes by the other shares, (3, 2, N)."""
    result = rates[:, :, 0] * corners[:, None, 0] + rates[:, :, 1] * corners[:, None, 1]
    result[1:] -= result[0]
    return np.asarray(result)
