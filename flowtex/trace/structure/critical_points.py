"""Critical points: zeros of the velocity, classified by the flow around them."""

from __future__ import annotations

import itertools
from collections import Counter, UserList
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from flowtex._util.arguments import check_field, checked_count
from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.progress import track
from flowtex.errors import FieldError, notify
from flowtex.field import FlowField
from flowtex.field.derived.gradient import node_gradient
from flowtex.field.formula.rates import Rates
from flowtex.field.grids.poles import Pole
from flowtex.field.interpolation import between_nodes
from flowtex.field.locate import surface_point
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.trace.structure.cells import (
    bilinear_zeros,
    folded,
    linear_zeros,
    strengths,
    triangle_indices,
)
from flowtex.trace.structure.formula_lines import Zeros, directions, formula_rates, zeros

if TYPE_CHECKING:
    import pyvista as pv

#: Kinds of critical points, for tables and legends.
KINDS = ("saddle", "source", "sink", "centre", "spiral source", "spiral sink", "degenerate")
POINCARE_INDICES = {"saddle": -1, "degenerate": 0}  #: On surfaces of nodes; 1 for other kinds.
ROUNDING = 1e-9  #: Greatest ratio to the other eigenvalue of one that counts as zero.
REAL_SHARE = 1e-6  #: Greatest imaginary part of a real eigenvalue, as a share of it.
SPIRAL_SHARE = 0.25  #: Least ratio of growth to rotation of a spiral on any grid.
#: Error of the velocity's gradient, in its change over a cell: in a cell the interpolated gradient
#: is that of its middle, half a cell away.
ERROR_CELLS = 0.5
SAME_POINT_CELLS = 1e-3  #: Points closer than this, in cells, that have the same index are one.
REST_SHARE = 1e-12  #: Speed as a share of the largest at which a node is at rest.
LEAST_SHARE = 1e-7  #: Share of a neighbour's velocity that replaces one that is zero.


def steady_parts(field: FlowField, steps: Sequence[int] | None, text: str) -> Iterator[FlowField]:
    """Return the fields of some time steps, or of all, with a progress bar of this text."""
    if steps is None:
        numbers = list(range(len(field.times)))
    else:
        numbers = list(map(field.step_number, steps))
    return map(field.at_step, track(numbers, len(numbers), text))


@dataclass(frozen=True, eq=False)
class CriticalPoint:
    """A point where the velocity is zero.

    Attributes
    ----------
    position
        Where it lies, (3,), in the mesh's units.
    kind
        ``"saddle"``, ``"source"``, ``"sink"``, ``"centre"``, ``"spiral source"``, ``"spiral sink"``
        or ``"degenerate"``: the determinant of the velocity gradient is zero.
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
    poincare_index
        Turns of the velocity on a small circle around the point: -1 for a saddle, any number for a
        degenerate point, and 1 for other kinds. On a sphere they sum to 2.
    directions
        Unit vectors along which separatrices of a degenerate point begin, (3,) each, and whether
        the flow leaves it there.
    """

    position: Floats
    kind: str
    eigenvalues: AnyArray
    eigenvectors: AnyArray
    time: float
    index: tuple[float, float]
    lonlat: tuple[float, float] | None = None
    strength: float = np.nan
    poincare_index: int = 1
    directions: tuple[tuple[Floats, bool], ...] = ()

    def ways(self, *, forward: bool) -> list[Floats]:
        """Return unit vectors along which separatrices leave the point, or come to it."""
        if self.kind == "saddle":
            if forward:
                way = self.eigenvectors[0].real
            else:
                way = self.eigenvectors[1].real
            return [way, -way]
        ways = []
        for way, leaves in self.directions:
            if leaves == forward:
                ways.append(way)
        return ways


class CriticalPoints(UserList[CriticalPoint]):
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

    def of_kind(self, *kinds: str) -> CriticalPoints:
        """Return the points of the given kinds.

        Parameters
        ----------
        kinds
            One or more kinds, such as ``"saddle"`` or ``"spiral sink"``.

        Raises
        ------
        FieldError
            When a kind does not exist.
        """
        for kind in kinds:
            if kind not in KINDS:
                raise FieldError(
                    f"kind {kind!r} does not exist; expected one of {', '.join(KINDS)}"
                )
        return CriticalPoints([p for p in self if p.kind in kinds])

    def strongest(self, count: int) -> CriticalPoints:
        """Return at most ``count`` points, the strongest first."""
        count = checked_count("count", count, expected="a number of points, 0 or more", low=0)
        return CriticalPoints(sorted(self, key=lambda p: -p.strength)[:count])

    def records(self) -> list[dict[str, Any]]:
        """Return a dictionary of numbers and strings for each point."""
        rows = []
        for p in self:
            row: dict[str, Any] = {"kind": p.kind, "poincare_index": p.poincare_index}
            row |= {"time": p.time, "strength": p.strength}
            row |= dict(zip("xyz", p.position.tolist(), strict=True))
            row |= dict(zip(("lon", "lat"), p.lonlat or (), strict=False))
            for n, value in enumerate(p.eigenvalues, 1):
                row |= {f"real_{n}": float(value.real), f"imaginary_{n}": float(value.imag)}
            rows.append(row)
        return rows

    def to_pyvista(self) -> pv.PolyData:
        """Return a ``pyvista.PolyData`` of the points.

        It has the arrays ``kind`` (index into ``KINDS``), ``time`` and ``strength``.
        """
        import pyvista as pv

        mesh = pv.PolyData(np.reshape(self._each("position"), (-1, 3)))
        mesh["kind"] = np.array(list(map(KINDS.index, self._each("kind"))), dtype=np.uint8)
        mesh["time"] = np.array(self._each("time"))
        mesh["strength"] = np.array(self._each("strength"))
        return mesh

    def _each(self, name: str) -> list[Any]:
        """Return an attribute of each point."""
        return [getattr(point, name) for point in self]

    def __repr__(self) -> str:
        counts = Counter(self._each("kind"))
        found = []
        for kind in KINDS:
            if counts[kind]:
                found.append(f"{counts[kind]} x {kind}")
        return f"CriticalPoints({', '.join(found) or 'no points'})"


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
    The velocity is bilinear in the cells of a structured surface and linear in triangles. A point
    is a centre if the real part of its eigenvalues vanishes within the interpolation error. For a
    field from :func:`flowtex.formula` the points are roots of the formula itself, with its exact
    gradient; a centre also needs lines that close. Regions at rest, walls and lines where the
    velocity is zero contain no critical points.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.double_gyre_field(shape=(41, 81))
    >>> flowtex.critical_points(field).of_kind("centre")
    CriticalPoints(2 x centre)
    """
    check_field(field, FlowField)
    if field.sign_free:
        raise FieldError("critical points need a direction, but this field is sign-free")
    points: list[CriticalPoint] = []
    for part in steady_parts(field, steps, "Finding critical points"):
        rates = formula_rates(part)
        if rates is not None:
            found = _of_formula(part, rates)
        elif part.triangles is None:
            found = _on_grid(part)
        else:
            found = _on_triangles(part)
        points += _with_strength(found, part)
    return CriticalPoints(points)


def _of_formula(field: FlowField, rates: Rates) -> list[CriticalPoint]:
    """Return the critical points of a formula: zeros of its rates, and those at poles."""
    found = zeros(rates)
    if found.lines:
        notify(f"{field.name}: the velocity is zero along lines; points there are not marked")
    places = found.places
    low = rates.ends[:, 0]
    index = (places - low) / np.ptp(rates.ends, axis=1) * np.subtract(field.shape[::-1], 1)
    position = rates.positions(places)
    tangents = rates.tangents(places)
    points = _points(field, position, found.gradient, tangents, index, found=found)
    for n in np.flatnonzero(found.is_degenerate):
        ways, leaves = directions(rates, places[n])
        ways = ways @ tangents[n]
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        pairs = tuple(zip(ways, leaves.tolist(), strict=True))
        points[n] = replace(points[n], directions=pairs)
    for pole in field.surface.poles or ():
        away = np.abs(index[:, pole.component] - pole.line) > 1
        points = list(itertools.compress(points, away))
        points += _resolved(_distinct(_at_pole(field, pole), field), field)
        index = np.array([point.index[::-1] for point in points]).reshape(-1, 2)
    if any(field.periodic):
        return _distinct(points, field)
    return points


def _on_grid(field: FlowField) -> list[CriticalPoint]:
    """Return the critical points in the cells of a structured surface, also around its poles."""
    j, i = np.nonzero(_searched_cells(field))
    at_corners = _at_corners(field.index_velocity.components[0], j, i)
    cell, place = bilinear_zeros(np.stack(at_corners, axis=1))
    low_left, low_right, high_left, high_right = np.stack(at_corners)[:, cell]
    s, t = np.moveaxis(place[..., None], 1, 0)
    by_i = (low_right - low_left) * (1 - t) + (high_right - high_left) * t
    by_j = (high_left - low_left) * (1 - s) + (high_right - low_right) * s
    gradient = np.stack([by_i, by_j], axis=-1)
    index = np.stack([i[cell], j[cell]], axis=-1) + place
    position = field.surface.at(index)
    at_nodes = field.surface.tangents  # (2, J, I, 3)
    tangents = np.empty((len(index), 2, 3))
    for axis, component in np.ndindex(2, 3):
        tangents[:, axis, component] = between_nodes(at_nodes[axis, ..., component], index)
    found = _points(field, position, gradient, tangents, index)
    for pole in field.surface.poles or ():
        found += _at_pole(field, pole)
    return _resolved(_distinct(found, field), field)


def _searched_cells(field: FlowField) -> Bools:
    """Return the cells that may contain critical points: not at walls, nor beside poles."""
    speed = field.index_velocity.speed[0]
    rest = speed <= REST_SHARE * speed.max(initial=0)
    # A single node at rest may be a critical point; several are a wall or a region at rest.
    counts = scipy.ndimage.convolve(rest.astype(int), np.ones((3, 3), int), mode="constant")
    several = rest & (counts > 1)
    usable = field.surface.cells.copy()
    for corner in field.surface.cell_corners:
        usable &= ~several[corner]
    for pole in field.surface.poles or ():
        if pole.component:
            lines = usable
        else:
            lines = usable.T
        if pole.inward > 0:
            lines[0] = False
        else:
            lines[-1] = False
    return usable


def _at_corners(nodal: Floats, j: Indices, i: Indices) -> list[Floats]:
    """Return nodal values (J, I, 2) at the corners of cells (N,), row by row, (N, 2) each."""
    return [nodal[j, i], nodal[j, i + 1], nodal[j + 1, i], nodal[j + 1, i + 1]]


def _at_pole(field: FlowField, pole: Pole) -> list[CriticalPoint]:
    """Find the critical points in the cells around a pole, as triangles in the plane there."""
    # Without the part across the surface, which is small at the pole but not its change.
    along, across = field.surface.tangents
    normal = np.cross(along, across)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), np.finfo(float).tiny)
    flow = field.velocity[0] - (field.velocity[0] * normal).sum(axis=-1, keepdims=True) * normal
    points = pole.lines(field.points)
    velocity = pole.lines(flow)
    ring = pole.line + pole.inward
    center = points[pole.line, 0]
    near = points[ring]
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
    """Return the critical points in the triangles of a surface."""
    surface = field.surface
    assert isinstance(surface, TriangleSurface)
    points = field.points[0]
    number, velocity = _searched_triangles(field, surface)
    triangles = surface.triangles[number]
    crosses = surface.crosses[number]
    corners = points[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flipped = np.einsum("mc,mc->m", normal, crosses) < 0
    facing = np.where(flipped[:, None], triangles[:, ::-1], triangles)
    turning = triangle_indices(points, surface.normals[0], velocity, facing)
    chosen = turning != 0
    number = number[chosen]
    triangles = triangles[chosen]
    normal = crosses[chosen] / np.linalg.norm(crosses[chosen], axis=1, keepdims=True)
    corners = points[triangles]
    first = corners[:, 1] - corners[:, 0]
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    frame = np.stack([first, np.cross(normal, first)], axis=1)
    flat = np.einsum("mkc,mfc->mkf", corners - corners[:, :1], frame)
    flow = np.einsum("mkc,mfc->mkf", velocity[triangles], frame)
    weights, gradient = linear_zeros(flat, flow)
    weights = np.where(np.isfinite(weights), weights, 1 / 3)
    weights = np.clip(weights, 0, None)
    weights /= weights.sum(axis=1, keepdims=True)
    position = np.einsum("mk,mkc->mc", weights, corners)
    index = surface.index_of(number, weights)
    found = _points(field, position, gradient, frame, index)
    return _resolved(found, field)


def _searched_triangles(field: FlowField, surface: TriangleSurface) -> tuple[Indices, Floats]:
    """Return the triangles that may contain critical points, (M,), and the velocity, (N, 3).

    The velocity is that along the surface. A single node at rest gets the least of its neighbours'
    velocities, so that one triangle has the zero; several are a wall or a region at rest.
    """
    normals = surface.normals[0]
    velocity = field.velocity[0, 0]
    velocity = velocity - np.einsum("nc,nc->n", velocity, normals)[:, None] * normals
    speed = np.linalg.norm(velocity, axis=1)
    rest = speed <= REST_SHARE * speed.max(initial=0)
    resting = rest[surface.triangles].sum(axis=1)
    several = np.zeros(len(normals), dtype=bool)
    several[surface.triangles[resting > 1]] = True
    number = np.flatnonzero(surface.cells & ~(several & rest)[surface.triangles].any(axis=1))
    triangles = surface.triangles[number]
    alone = triangles[rest[triangles].any(axis=1)]
    corner = np.argmax(rest[alone], axis=1)
    rows = np.arange(len(alone))
    first = velocity[alone[rows, (corner + 1) % 3]]
    second = velocity[alone[rows, (corner + 2) % 3]]
    velocity[alone[rows, corner]] = LEAST_SHARE * (0.62 * first + 0.38 * second)
    return number, velocity


def _points(
    field: FlowField,
    position: Floats,
    gradient: Floats,
    tangents: Floats,
    index: Floats,
    found: Zeros | None = None,
) -> list[CriticalPoint]:
    """Make records of points (K, 3), gradients (K, 2, 2) and tangents (K, 2, 3) there."""
    finite = np.isfinite(gradient).all(axis=(1, 2))
    finite &= (np.abs(gradient).max(axis=(1, 2)) > 0) | (found is not None)
    values, vectors = np.linalg.eig(np.where(finite[:, None, None], gradient, np.eye(2)))
    if field.projection is None:
        lonlat = None
    else:
        lonlat = field.projection.lonlat(position)
    result = []
    for n in np.flatnonzero(finite):
        order = np.argsort(-values[n].real, kind="stable")
        value = values[n][order].astype(complex)
        directions = vectors[n].T[order] @ tangents[n]
        size = np.linalg.norm(directions, axis=1, keepdims=True)
        if lonlat is None:
            place = None
        else:
            place = (float(lonlat[0][n]), float(lonlat[1][n]))
        if found is None:
            kind = _kind(value, 0.0)
        elif found.is_degenerate[n]:
            kind = "degenerate"
        else:
            kind = _kind(value, float(found.growth[n]))
        if found is None:
            poincare_index = POINCARE_INDICES.get(kind, 1)
        else:
            poincare_index = int(found.indices[n])
        result.append(
            CriticalPoint(
                position=position[n],
                kind=kind,
                eigenvalues=value,
                eigenvectors=directions / np.maximum(size, np.finfo(float).tiny),
                time=float(field.times[0]),
                index=(float(index[n, 1]), float(index[n, 0])),
                lonlat=place,
                poincare_index=poincare_index,
            )
        )
    return result


def _kind(values: AnyArray, growth: float = 0.0, error: float = 0.0) -> str:
    """Return the kind of a point by its eigenvalues, (2,), whose real parts have an ``error``.

    Within the error, ``growth`` decides: how much farther away a line is after a turn.
    """
    real = values.real
    imaginary = abs(values[0].imag)
    size = np.abs(values).max()
    if imaginary <= REAL_SHARE * size:
        if np.abs(values).min() <= ROUNDING * size:
            return "degenerate"
        if real[0] * real[1] < 0:
            return "saddle"
        if real.sum() > 0:
            return "source"
        return "sink"
    if abs(real[0]) > max(error, ROUNDING * size):
        growth = float(real[0])
    if growth > 0:
        return "spiral source"
    if growth < 0:
        return "spiral sink"
    return "centre"


def gradient_and_error(field: FlowField) -> tuple[Floats, Floats]:
    """Return the velocity gradient of a steady field at the nodes, (2, 2, J, I), and its error."""
    surface = field.surface
    gradient = node_gradient(surface, None)
    first = gradient.of_vectors(field.velocity[0])
    second = gradient.derivative(first.reshape(4, *surface.shape))
    return first, ERROR_CELLS * surface.cell_size * np.sqrt((second**2).sum(axis=(0, 1)))


def _resolved(points: list[CriticalPoint], field: FlowField) -> list[CriticalPoint]:
    """Return points on a grid as far as it resolves them.

    A spiral that grows by less than the error of the gradient is a centre, and points of the same
    index in one cell are a degenerate point.
    """
    weak = []
    for n, point in enumerate(points):
        value = point.eigenvalues[0]
        if abs(value.real) <= SPIRAL_SHARE * abs(value.imag):
            weak.append(n)
    if weak:
        _, error = gradient_and_error(field)
        for n in weak:
            values = points[n].eigenvalues
            near = float(surface_point(field.surface, points[n].index).interpolate(error))
            near = max(near, REAL_SHARE * abs(values[0]))
            points[n] = replace(points[n], kind=_kind(values, error=near))
    if len(points) < 2:
        return points
    size = cell_sizes(points, field)
    positions = np.array([point.position for point in points])
    pairs = scipy.spatial.KDTree(positions).query_pairs(size.max(), output_type="ndarray")
    lengths = np.asarray(np.linalg.norm(np.subtract(*positions[pairs.T]), axis=1))
    pairs = pairs[lengths < size[pairs[:, 0]]]
    graph = scipy.sparse.coo_array((np.ones(len(pairs), bool), pairs.T), shape=2 * (len(points),))
    group = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
    total = np.bincount(group, [point.poincare_index for point in points])
    result = []
    for n, point in enumerate(points):
        turns = round(total[group[n]])
        if abs(turns) < 2:
            result.append(point)
        elif n == np.argmax(group == group[n]):
            result.append(replace(point, kind="degenerate", poincare_index=turns))
    return result


def cell_sizes(points: Sequence[CriticalPoint], field: FlowField) -> Floats:
    """Return the size of the cell around each point, (K,)."""
    surface = field.surface
    sizes = [surface.cell_size[surface.node_near(point.index)] for point in points]
    return np.array(sizes, dtype=float)


def _distinct(points: list[CriticalPoint], field: FlowField) -> list[CriticalPoint]:
    """Drop points that were found in two cells, or at both ends of a closed axis.

    Where cells around a node disagree, or a determinant is zero, the point is degenerate.
    """
    near = SAME_POINT_CELLS * cell_sizes(points, field)
    kept = np.ones(len(points), dtype=bool)
    pairs: set[tuple[int, int]] = set()
    if points:
        positions = np.array([point.position for point in points])
        pairs = scipy.spatial.KDTree(positions).query_pairs(near.max())
    for first, second in sorted(pairs):
        apart = np.linalg.norm(positions[first] - positions[second])
        if kept[first] and kept[second] and apart < near[second]:
            kept[second] = False
            if points[first].poincare_index != points[second].poincare_index:
                points[first] = replace(points[first], kind="degenerate")
    result = list(itertools.compress(points, kept))
    for n, point in enumerate(result):
        if point.kind == "degenerate":
            result[n] = replace(point, poincare_index=_ring_index(field, point))
    return result


def _ring_index(field: FlowField, point: CriticalPoint) -> int:
    """Return the turns of the velocity around the node at a point, 0 at a border."""
    j, i = field.surface.node_near(point.index)
    rows, columns = np.array(
        [(-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0), (1, -1), (0, -1)]
    ).T
    rows = rows + j
    columns = columns + i
    inside = (rows >= 0) & (rows < field.shape[0]) & (columns >= 0) & (columns < field.shape[1])
    if not inside.all():
        return 0
    u, v = field.index_velocity.components[0][rows, columns].T
    angle = np.arctan2(v, u)
    return round(float(folded(np.roll(angle, -1) - angle).sum()) / (2 * np.pi))


def _with_strength(points: list[CriticalPoint], field: FlowField) -> list[CriticalPoint]:
    """Return critical points with their strengths."""
    columns = field.shape[1]
    nodes = []
    signs = np.empty(len(points), dtype=np.intp)
    steepness = np.empty(len(points))
    for n, point in enumerate(points):
        j, i = field.surface.node_near(point.index)
        nodes.append(int(j * columns + i))
        signs[n] = point.poincare_index
        steepness[n] = abs(np.prod(point.eigenvalues))
    # A point of index 0 needs no partner to vanish.
    found = np.zeros(len(points))
    paired = signs != 0
    found[paired] = strengths(
        field, np.array(nodes, dtype=np.intp)[paired], signs[paired], steepness[paired]
    )
    strong = []
    for point, strength in zip(points, found.tolist(), strict=True):
        strong.append(replace(point, strength=strength))
    return strong
