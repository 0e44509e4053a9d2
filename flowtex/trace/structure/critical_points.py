"""Critical points: zeros of the velocity, classified by the flow around them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import scipy

from flowtex._util.arguments import check_field, checked_count
from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.grids.poles import Pole
from flowtex.field.triangles.surface import TriangleSurface
from flowtex.trace.structure.records import Records, steady_parts

if TYPE_CHECKING:
    import pyvista as pv

#: Kinds of critical points, for tables and legends.
KINDS = ("saddle", "source", "sink", "centre", "spiral source", "spiral sink")
#: Growth of a spiral, as a share of its rotation, up to which it is a centre.
CENTRE_SHARE = 0.01
#: Points closer than this, in cells, that have the same index are one.
SAME_POINT_CELLS = 1e-3
#: Speed as a share of the largest at which a node is at rest.
REST_SHARE = 1e-12
#: Share of a neighbour's velocity that replaces one that is zero.
LEAST_SHARE = 1e-7
#: Speeds at which regions are compared, by the share of the nodes that are slower.
SHARES = np.geomspace(1e-3, 1.0, 32)
#: How far beyond its cell a zero may lie, in cells: it must not be lost between two of them.
ROUNDING_CELLS = 1e-9


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """A point where the velocity is zero.

    Attributes
    ----------
    position
        Where it lies, (3,), in the mesh's units.
    kind
        ``"saddle"``, ``"source"``, ``"sink"``, ``"centre"``, ``"spiral source"`` or
        ``"spiral sink"``.
    eigenvalues
        Of the velocity gradient there, (2,), complex, in 1 over the unit of time, the one with the
        larger real part first.
    eigenvectors
        The unit vectors that belong to them, (2, 3); complex for spirals and centres.
    time
        When, in the unit of time of the field.
    index
        The place in index space as (j, i), as :func:`flowtex.field.locate` returns it.
    lonlat
        Longitude and latitude in degrees, for a field of the Earth.
    strength
        Change of the velocity, as a speed, with which it vanishes together with others: little
        for points of noise. It is known to a few per cent.
    """

    position: Floats
    kind: str
    eigenvalues: AnyArray
    eigenvectors: AnyArray
    time: float
    index: tuple[float, float]
    lonlat: tuple[float, float] | None = None
    strength: float = np.nan

    @property
    def poincare_index(self) -> int:
        """-1 for a saddle, 1 for any other kind; on a sphere they sum to 2."""
        return -1 if self.kind == "saddle" else 1


class CriticalPoints(Records, Sequence[CriticalPoint]):
    """Critical points of a field, in the order of times and places.

    A sequence of records with ``position`` (3,), ``kind``, ``eigenvalues`` (2,), ``eigenvectors``
    (2, 3), ``time``, ``index`` as (j, i), ``strength``, and ``lonlat`` for a field of the Earth.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
    >>> point = flowtex.critical_points(field).of_kind("centre")[0]
    >>> point.kind, [round(float(x), 2) for x in point.position]
    ('centre', [0.5, 0.5, 0.0])
    """

    def __init__(self, points: Sequence[CriticalPoint]) -> None:
        self._points = tuple(points)

    @overload
    def __getitem__(self, key: int) -> CriticalPoint: ...
    @overload
    def __getitem__(self, key: slice) -> CriticalPoints: ...
    def __getitem__(self, key: int | slice) -> CriticalPoint | CriticalPoints:
        if isinstance(key, slice):
            return CriticalPoints(self._points[key])
        return self._points[key]

    def __len__(self) -> int:
        return len(self._points)

    def __iter__(self) -> Iterator[CriticalPoint]:
        return iter(self._points)

    def of_kind(self, *kinds: str) -> CriticalPoints:
        """Return the points of the given kinds."""
        for kind in kinds:
            if kind not in KINDS:
                msg = f"kind {kind!r} does not exist; expected one of {', '.join(KINDS)}"
                raise FieldError(msg)
        return CriticalPoints([p for p in self._points if p.kind in kinds])

    def strongest(self, count: int) -> CriticalPoints:
        """Return at most ``count`` points, the strongest first."""
        count = checked_count("count", count, expected="a number of points, 0 or more", low=0)
        return CriticalPoints(sorted(self._points, key=lambda p: -p.strength)[:count])

    def records(self) -> list[dict[str, Any]]:
        """Return a dictionary of numbers and strings for each point."""
        rows = []
        for p in self._points:
            row: dict[str, Any] = {"kind": p.kind, "time": p.time, "strength": p.strength}
            row |= dict(zip("xyz", (float(x) for x in p.position), strict=True))
            if p.lonlat is not None:
                row |= {"lon": p.lonlat[0], "lat": p.lonlat[1]}
            for n, value in enumerate(p.eigenvalues, 1):
                row |= {f"real_{n}": float(value.real), f"imaginary_{n}": float(value.imag)}
            rows.append(row)
        return rows

    def _geometries(self) -> list[dict[str, Any] | None]:
        places = (point.lonlat for point in self._points)
        return [place and {"type": "Point", "coordinates": list(place)} for place in places]

    def to_pyvista(self) -> pv.PolyData:
        """Return a ``pyvista.PolyData`` of the points.

        It has the arrays ``kind`` (index into ``KINDS``), ``time`` and ``strength``.
        """
        import pyvista as pv

        mesh = pv.PolyData(np.array([p.position for p in self._points]).reshape(-1, 3))
        mesh["kind"] = np.array([KINDS.index(p.kind) for p in self._points], dtype=np.uint8)
        mesh["time"] = np.array([p.time for p in self._points])
        mesh["strength"] = np.array([p.strength for p in self._points])
        return mesh

    def __repr__(self) -> str:
        counts = [(kind, sum(p.kind == kind for p in self._points)) for kind in KINDS]
        found = ", ".join(f"{count} x {kind}" for kind, count in counts if count)
        return f"CriticalPoints({found or 'no points'})"


def critical_points(field: FlowField, *, steps: Sequence[int] | None = None) -> CriticalPoints:
    """Find the points where the velocity is zero, and classify them.

    Parameters
    ----------
    field
        The flow.
    steps
        Indices of the time steps to search; all by default.

    Returns
    -------
    CriticalPoints

    Raises
    ------
    FieldError
        When the field is sign-free, or a step does not exist.

    Notes
    -----
    The velocity is bilinear in the cells of a structured surface and linear in triangles. Regions
    at rest, and walls where the velocity is zero, contain no critical points.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
    >>> flowtex.critical_points(field).of_kind("centre")
    CriticalPoints(2 x centre)
    """
    check_field(field, FlowField)
    if field.sign_free:
        msg = "critical points need a direction, but this field is sign-free"
        raise FieldError(msg)
    points: list[CriticalPoint] = []
    for part in steady_parts(field, steps, "Finding critical points"):
        search = _on_grid if part.triangles is None else _on_triangles
        points += _with_strength(search(part), part)
    return CriticalPoints(points)


def _on_grid(field: FlowField) -> list[CriticalPoint]:
    """Find the critical points of one step on a structured surface."""
    u, valid = field.index_velocity.components[0], field.valid
    rows, columns = field.shape
    speed = field.index_velocity.speed[0]
    rest = speed <= REST_SHARE * speed.max(initial=0)
    corners = [(slice(a, rows - 1 + a), slice(b, columns - 1 + b)) for a in (0, 1) for b in (0, 1)]
    usable = np.logical_and.reduce([valid[c] for c in corners])
    # A single node at rest may be a critical point; several are a wall or a region at rest.
    several = rest & (
        scipy.ndimage.convolve(rest.astype(int), np.ones((3, 3), int), mode="constant") > 1
    )
    usable &= ~np.logical_or.reduce([several[c] for c in corners])
    poles = tuple(field.surface.poles or ())
    for pole in poles:
        lines = usable if pole.component else usable.T
        lines[0 if pole.inward > 0 else -1] = False
    j, i = np.nonzero(usable)
    cell, place = bilinear_zeros(np.stack([u[c][j, i] for c in corners], axis=1))
    j, i, (s, t) = j[cell], i[cell], place.T
    at = [u[j + a, i + b] for a in (0, 1) for b in (0, 1)]
    by_i = (at[1] - at[0]) * (1 - t[:, None]) + (at[3] - at[2]) * t[:, None]
    by_j = (at[2] - at[0]) * (1 - s[:, None]) + (at[3] - at[1]) * s[:, None]
    gradient = np.stack([by_i, by_j], axis=-1)
    index = np.stack([i + s, j + t], axis=-1)
    position = field.surface.at(index)
    tangents = [_blend(tangent, j, i, s, t) for tangent in field.surface.tangents]
    found = _points(field, position, gradient, np.stack(tangents, axis=1), index)
    for pole in poles:
        found += _at_pole(field, pole)
    return _distinct(found, field)


def _blend(nodal: Floats, j: Indices, i: Indices, s: Floats, t: Floats) -> Floats:
    """Return nodal values (J, I, C) within cells, (K, C)."""
    s, t = s[:, None], t[:, None]
    low = nodal[j, i] * (1 - s) + nodal[j, i + 1] * s
    high = nodal[j + 1, i] * (1 - s) + nodal[j + 1, i + 1] * s
    return np.asarray(low * (1 - t) + high * t)


def _at_pole(field: FlowField, pole: Pole) -> list[CriticalPoint]:
    """Find the critical points in the cells around a pole, as triangles in the plane there."""
    points, velocity = (pole.lines(a) for a in (field.points, field.velocity[0]))
    ring = pole.line + pole.inward
    center, near = points[pole.line, 0], points[ring]
    plane = (near - center) @ pole.plane.T
    vectors = velocity[ring] @ pole.plane.T
    middle = velocity[pole.line, :-1].mean(axis=0) @ pole.plane.T
    count = len(near) - 1
    corners = np.zeros((count, 3, 2))
    corners[:, 1], corners[:, 2] = plane[:-1], plane[1:]
    flow = np.stack([np.broadcast_to(middle, (count, 2)), vectors[:-1], vectors[1:]], axis=1)
    weights, gradient = linear_zeros(corners, flow)
    with np.errstate(invalid="ignore"):
        inside = (weights >= -1e-9).all(axis=1)
    number = np.flatnonzero(inside)
    if not len(number):
        return []
    # One point in the middle of the cap is found by all triangles.
    w = weights[number]
    position = w[:, :1] * center + w[:, 1:2] * near[number] + w[:, 2:] * near[number + 1]
    around = number + np.divide(w[:, 2], 1 - w[:, 0], out=np.zeros(len(w)), where=w[:, 0] < 1)
    index = np.empty((len(w), 2))
    index[:, 1 - pole.component] = around
    index[:, pole.component] = pole.line + pole.inward * (1 - w[:, 0])
    tangents = np.broadcast_to(pole.plane, (len(w), 2, 3))
    return _points(field, position, gradient[number], tangents, index)


def _on_triangles(field: FlowField) -> list[CriticalPoint]:
    """Find the critical points of one step on a surface of triangles."""
    surface = field.surface
    assert isinstance(surface, TriangleSurface)
    normals, points = surface.normals[0], field.points[0]
    velocity = field.velocity[0, 0]
    velocity = velocity - np.einsum("nc,nc->n", velocity, normals)[:, None] * normals
    speed = np.linalg.norm(velocity, axis=1)
    rest = speed <= REST_SHARE * speed.max(initial=0)
    resting = rest[surface.triangles].sum(axis=1)
    several = np.zeros(len(points), dtype=bool)
    several[surface.triangles[resting > 1]] = True
    number = np.flatnonzero(surface.cells & ~(several & rest)[surface.triangles].any(axis=1))
    triangles, crosses = surface.triangles[number], surface.crosses[number]
    # A single node at rest gets the least of its neighbours' velocities: one triangle has the zero.
    alone = triangles[rest[triangles].any(axis=1)]
    corner = np.argmax(rest[alone], axis=1)
    first, second = (
        velocity[np.take_along_axis(alone, (corner[:, None] + k) % 3, 1)[:, 0]] for k in (1, 2)
    )
    resting_nodes = np.take_along_axis(alone, corner[:, None], 1)[:, 0]
    velocity[resting_nodes] = LEAST_SHARE * (0.62 * first + 0.38 * second)
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flipped = np.einsum("mc,mc->m", normal, crosses) < 0
    facing = np.where(flipped[:, None], triangles[:, ::-1], triangles)
    turning = triangle_indices(points, normals, velocity, facing)
    chosen = turning != 0
    number, triangles = number[chosen], triangles[chosen]
    normal = crosses[chosen] / np.linalg.norm(crosses[chosen], axis=1, keepdims=True)
    corners = points[triangles]
    first = corners[:, 1] - corners[:, 0]
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    frame = np.stack([first, np.cross(normal, first)], axis=1)
    flat = np.einsum("mkc,mfc->mkf", corners - corners[:, :1], frame)
    flow = np.einsum(
        "mkc,mfc->mkf", _turned(velocity[triangles], normals[triangles], normal), frame
    )
    weights, gradient = linear_zeros(flat, flow)
    weights = np.where(np.isfinite(weights), weights, 1 / 3)
    weights = np.clip(weights, 0, None)
    weights /= weights.sum(axis=1, keepdims=True)
    position = np.einsum("mk,mkc->mc", weights, corners)
    return _points(field, position, gradient, frame, surface.index_of(number, weights))


def _turned(vectors: Floats, normals: Floats, normal: Floats) -> Floats:
    """Return tangent vectors at corners, (M, 3, 3), turned into the plane of their triangles."""
    n = normal[:, None]
    axis = np.cross(normals, n)
    cosine = np.einsum("mkc,mkc->mk", normals, np.broadcast_to(n, normals.shape))[..., None]
    along = np.einsum("mkc,mkc->mk", axis, vectors)[..., None]
    return np.asarray(
        vectors * cosine + np.cross(axis, vectors) + axis * along / np.maximum(1 + cosine, 1e-6)
    )


def _points(
    field: FlowField, position: Floats, gradient: Floats, tangents: Floats, index: Floats
) -> list[CriticalPoint]:
    """Make records of points (K, 3), gradients (K, 2, 2) and tangents (K, 2, 3) there."""
    finite = np.isfinite(gradient).all(axis=(1, 2)) & (np.abs(gradient).max(axis=(1, 2)) > 0)
    values, vectors = np.linalg.eig(np.where(finite[:, None, None], gradient, np.eye(2)))
    lonlat = None if field.projection is None else field.projection.lonlat(position)
    result = []
    for n in np.flatnonzero(finite):
        order = np.argsort(-values[n].real, kind="stable")
        value, directions = values[n][order].astype(complex), vectors[n].T[order] @ tangents[n]
        size = np.linalg.norm(directions, axis=1, keepdims=True)
        place = None if lonlat is None else (float(lonlat[0][n]), float(lonlat[1][n]))
        result.append(
            CriticalPoint(
                position=position[n],
                kind=_kind(value),
                eigenvalues=value,
                eigenvectors=directions / np.maximum(size, np.finfo(float).tiny),
                time=float(field.times[0]),
                index=(float(index[n, 1]), float(index[n, 0])),
                lonlat=place,
            )
        )
    return result


def _kind(values: AnyArray) -> str:
    real, imaginary = values.real, abs(values[0].imag)
    if not imaginary:
        return "saddle" if real[0] * real[1] < 0 else "source" if real.sum() > 0 else "sink"
    if abs(real[0]) <= CENTRE_SHARE * imaginary:
        return "centre"
    return "spiral source" if real[0] > 0 else "spiral sink"


def _distinct(points: list[CriticalPoint], field: FlowField) -> list[CriticalPoint]:
    """Drop points that were found in two cells, or at both ends of a closed axis."""
    if len(points) < 2:
        return points
    size = field.surface.cell_size
    at = (
        tuple(np.minimum(np.rint(p.index).astype(int), np.subtract(size.shape, 1))) for p in points
    )
    near = SAME_POINT_CELLS * np.array([size[node] for node in at])
    positions = np.array([point.position for point in points])
    kept = np.ones(len(points), dtype=bool)
    for first, second in sorted(scipy.spatial.KDTree(positions).query_pairs(near.max())):
        if kept[first] and points[first].poincare_index == points[second].poincare_index:
            kept[second] &= np.linalg.norm(positions[first] - positions[second]) >= near[second]
    return [point for point, is_kept in zip(points, kept, strict=True) if is_kept]


def _with_strength(points: list[CriticalPoint], field: FlowField) -> list[CriticalPoint]:
    """Return the points of one step with their strengths."""
    columns = field.shape[1]
    nodes = [int(j * columns + i) for j, i in (field.surface.node_near(p.index) for p in points)]
    signs = np.array([point.poincare_index for point in points], dtype=np.intp)
    steepness = np.array([abs(np.prod(point.eigenvalues)) for point in points])
    found = strengths(field, np.array(nodes, dtype=np.intp), signs, steepness)
    return [replace(p, strength=float(s)) for p, s in zip(points, found, strict=True)]


def strengths(field: FlowField, nodes: Indices, signs: Indices, steepness: Floats) -> Floats:
    """Return the strengths of critical points of a steady field as speeds, (K,).

    The strength is the change of velocity that makes a point vanish. Two points of opposite index
    vanish together once the velocity between them is changed by as much as the speed there (their
    robustness: Wang, Rosen, Skraba, Bhatia and Pascucci, 2013). So it is the least speed below
    which a region contains the point and a partner. Points of noise are pairs separated by a low
    speed. A partner may lie beyond a border: without one, the least speed below which a region
    contains the point and any other remaining one.

    ``nodes`` are nodes beside the points, counted row by row, and ``signs`` their Poincare indices.
    Where several have one partner, the steepest remain.
    """
    speed, valid = field.index_velocity.speed[0].ravel(), field.valid.ravel()
    result = np.full(len(nodes), float(speed[valid].max(initial=0.0)))
    if len(nodes) < 2:
        return result
    edges = _edges(field)
    edges = edges[valid[edges].all(axis=1)]
    needed = speed[edges].max(axis=1)
    order = np.argsort(needed)
    edges, needed = edges[order], needed[order]
    remaining, met = np.argsort(-steepness), np.zeros(len(nodes), dtype=bool)
    for level in np.quantile(speed[valid], SHARES):
        slower = edges[: int(np.searchsorted(needed, level, side="right"))]
        graph = scipy.sparse.coo_array(
            (np.ones(len(slower), bool), slower.T), shape=(speed.size, speed.size)
        )
        region = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
        regions = region[nodes[remaining]].astype(np.intp)
        paired = _paired(regions, signs[remaining])
        result[remaining[paired]] = level
        remaining, regions = remaining[~paired], regions[~paired]
        meets = (np.bincount(regions, minlength=1)[regions] > 1) & ~met[remaining]
        result[remaining[meets]], met[remaining[meets]] = level, True
    return result


def _paired(region: Indices, signs: Indices) -> Bools:
    """Return which points (K,) have a partner in their region; surplus ones are the first."""
    kind = 2 * region + (signs > 0)
    counts = np.bincount(kind, minlength=2 * int(region.max(initial=0)) + 2)
    order = np.argsort(kind, kind="stable")
    rank = np.empty(len(kind), dtype=np.intp)
    rank[order] = np.arange(len(kind)) - (np.cumsum(counts) - counts)[kind[order]]
    return np.asarray(rank >= counts[kind] - counts[kind ^ 1])


def _edges(field: FlowField) -> Indices:
    """Return pairs of neighbouring nodes, (E, 2), counted row by row."""
    if field.triangles is not None:
        corners = np.asarray(field.triangles)
        return np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    number = np.arange(field.valid.size).reshape(field.shape)
    pairs = [(number[:, :-1], number[:, 1:]), (number[:-1], number[1:])]
    if field.periodic[1]:
        pairs.append((number[:, :1], number[:, -1:]))
    if field.periodic[0]:
        pairs.append((number[:1], number[-1:]))
    return np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in pairs])


def bilinear_zeros(corners: Floats) -> tuple[Indices, Floats]:
    """Find the zeros of a velocity in cells.

    ``corners`` are velocities at (j, i), (j, i + 1), (j + 1, i) and (j + 1, i + 1), (N, 4, 2).
    Returns the number of each cell with a zero, (K,), and its place in the cell, (K, 2) from 0 to 1
    as (i, j). A cell may have two.
    """
    near = ROUNDING_CELLS * np.abs(corners).max(axis=(1, 2), initial=0)[:, None]
    crossed = ((corners.max(axis=1) >= -near) & (corners.min(axis=1) <= near)).all(axis=1)
    cells = np.flatnonzero(crossed)
    v = corners[cells]
    v = v / np.maximum(np.abs(v).max(axis=(1, 2), keepdims=True), np.finfo(float).tiny)
    a, b, c = v[:, 0], v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]
    d = v[:, 3] - v[:, 2] - b
    numbers, places = [], []
    # v = a + b s + c t + d s t is zero where (a + b s) and (c + d s) are parallel.
    for s in _roots(_cross(b, d), _cross(a, d) + _cross(b, c), _cross(a, c)):
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            first, slope = a + b * s[:, None], c + d * s[:, None]
            square = np.einsum("nc,nc->n", slope, slope)
            t = -np.einsum("nc,nc->n", first, slope) / square
        inside = _inside(s) & _inside(t)
        numbers.append(cells[inside])
        places.append(np.clip(np.stack([s[inside], t[inside]], axis=-1), 0.0, 1.0))
    return np.concatenate(numbers), np.concatenate(places)


def linear_zeros(points: Floats, vectors: Floats) -> tuple[Floats, Floats]:
    """Return where a linear velocity is zero, and its gradient.

    Corners of triangles in a plane, and velocities there, are (N, 3, 2). The zero is given as
    shares of the corners, (N, 3), not finite where there is no single one; the gradient is the
    change of component m along direction n, (N, 2, 2).
    """
    edges = np.swapaxes(points[:, 1:] - points[:, :1], 1, 2)
    change = np.swapaxes(vectors[:, 1:] - vectors[:, :1], 1, 2)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        gradient = change @ _inverse(edges)
        shares = -np.einsum("nmk,nk->nm", _inverse(change), vectors[:, 0])
    return np.concatenate([1 - shares.sum(axis=1, keepdims=True), shares], axis=1), gradient


def triangle_indices(
    points: Floats, normals: Floats, velocity: Floats, triangles: Indices
) -> Indices:
    """Return the Poincare index of each triangle, (M,): 1, 0, or -1 for a saddle.

    Positions, unit normals and tangent velocities of nodes are (N, 3) each, triangles (M, 3), in
    the sense of the normals. Angles are measured at each node against the edges in its tangent
    plane, so two triangles agree about the edge they share, and on a closed surface the indices sum
    to its Euler characteristic.
    """
    turned = np.full(len(triangles), 2 * np.pi)
    for k in range(3):
        start, end, last = (triangles[:, (k + n) % 3] for n in range(3))
        edge = points[end] - points[start]
        at_start, at_end = (_angle(velocity[n], edge, normals[n]) for n in (start, end))
        turned += _folded(at_end - at_start)
        # The edges themselves turn once; what is missing from that is curvature.
        turned -= _folded(_angle(points[last] - points[end], edge, normals[end]))
    return np.rint(turned / (2 * np.pi)).astype(np.intp)


def _angle(vector: Floats, reference: Floats, normal: Floats) -> Floats:
    """Return the angle (N,) from one vector to another about normals, (N, 3) each."""
    along = np.einsum("nc,nc->n", vector, reference) - np.einsum(
        "nc,nc,nd,nd->n", vector, normal, reference, normal
    )
    across = np.einsum("nc,nc->n", np.cross(reference, vector), normal)
    return np.asarray(np.arctan2(across, along))


def _folded(angle: Floats) -> Floats:
    return np.asarray(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))


def _roots(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Return the real roots of a x^2 + b x + c, NaN or infinite where there are fewer."""
    with np.errstate(invalid="ignore", divide="ignore"):
        q = -0.5 * (b + np.copysign(np.sqrt(b * b - 4 * a * c), b))
        return q / a, c / q


def _inside(share: Floats) -> Bools:
    with np.errstate(invalid="ignore"):
        return np.asarray((share >= -ROUNDING_CELLS) & (share <= 1 + ROUNDING_CELLS))


def _cross(one: Floats, two: Floats) -> Floats:
    return np.asarray(one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0])


def _inverse(matrix: Floats) -> Floats:
    """Return the inverses of matrices (N, 2, 2), not finite for singular ones."""
    (a, b), (c, d) = np.moveaxis(matrix, 0, -1)
    adjugate = np.stack([np.stack([d, -b], axis=-1), np.stack([-c, a], axis=-1)], axis=1)
    return np.asarray(adjugate / (a * d - b * c)[:, None, None])
