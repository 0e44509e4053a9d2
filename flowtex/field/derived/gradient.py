"""The velocity gradient along a surface, at its nodes.

The derivative along a surface of a vector that lies in it (its covariant derivative) is the part
of its derivative in space that lies in the surface. So components in space are differentiated, on a
sphere as on a crooked grid, and no term for the curvature of coordinates is needed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.grids.poles import SAME_POINT_SHARE
from flowtex.field.triangles.triangle_surface import Surface, TriangleSurface
from flowtex.field.validation import finite_nodes

#: Below this ratio of squared area to squared lengths a cell has no area to divide by.
COLLAPSED_AREA = 1e-10
#: Below this share of the lengths beside it a cell has no length to divide by.
COLLAPSED_LENGTH = 1e-3
WIDEST_GAP = 0.5 * np.pi  #: Widest gap between nodes around a pole, as an angle.
AT_POLE = 1e-3  #: Degrees from a pole at which a node of a flat map is on it.
NEEDED_RING = 0.75  #: Least share of the circle around a pole with values.
QUADRATIC_NEIGHBOURS = 5  #: Least number of neighbours for a quadratic fit.
REGULARISATION = 1e-12  #: Regularisation of a fit, as a share of the largest entry.
#: Least eigenvalue of the correlations of the terms of a fit; nodes nearly on two lines have less.
LEAST_INDEPENDENCE = 1e-7
SUSPECT_INDEPENDENCE = 1e-5  #: Determinant of these correlations from which on it is computed.


def true_positions(points: Floats, projection: Projection | None) -> Floats:
    """Return positions (..., 3) on a flat map of the Earth as those on the sphere, others as is."""
    if projection is None or projection.is_globe:
        return points
    return Projection(GLOBE).positions(*projection.lonlat(points))


def true_velocity(velocity: Floats, points: Floats, projection: Projection | None) -> Floats:
    """Return velocity (..., 3) at points on a flat map as that on the sphere; others as is."""
    if projection is None or projection.is_globe:
        return velocity
    lon, lat = projection.lonlat(points)
    return Projection(GLOBE).vectors(lon, lat, *projection.components(lon, lat, velocity))


def node_gradient(
    surface: Surface, projection: Projection | None, known: Bools | None = None
) -> NodeGradient:
    """Return the gradient at the nodes of a surface; on a flat map it is the one on the sphere.

    ``known`` are the nodes with values, (J, I), by default all that are valid.
    """
    points = true_positions(surface.points, projection)
    valid = surface.valid
    if known is not None:
        valid = valid & known
    is_flat_map = points is not surface.points
    has_vectors = np.ones_like(valid)
    if is_flat_map and projection is not None:
        has_vectors = _has_vectors(points, projection, poles=isinstance(surface, GridSurface))
    if isinstance(surface, TriangleSurface):
        poles = point_nodes(surface, points, valid & ~has_vectors)
        gradient = _triangle_gradient(surface, points, valid & has_vectors)
        return _on_sphere(replace(gradient, poles=poles), points, projection)
    valid = valid & has_vectors
    # On the sphere one turn leads to the same place.
    if is_flat_map:
        offset = np.zeros((2, 3))
    else:
        offset = surface.offset
    gradient = _grid_gradient(points, valid, surface.periodic, offset, apart=is_flat_map)
    return _on_sphere(gradient, points, projection)


def _has_vectors(points: Floats, projection: Projection, *, poles: bool) -> Bools:
    """Return which positions (J, I, 3) on the Earth have vectors on a flat map.

    At poles they do not, and the nodes of a pole may lie apart; ``poles`` includes these.
    """
    lon, lat = Projection(GLOBE).lonlat(points)
    has_vectors = projection.has_directions(lon, lat)
    if not poles:
        has_vectors &= np.abs(lat) < 90 - AT_POLE
    return has_vectors


def _on_sphere(
    gradient: NodeGradient, points: Floats, projection: Projection | None
) -> NodeGradient:
    """Return a gradient at positions (J, I, 3) with the normals of the Earth, if it lies there."""
    if projection is None:
        return gradient
    parts = np.moveaxis(points, -1, 0)
    return replace(gradient, normal=parts / np.sqrt(_dot(parts, parts)))


@dataclass(frozen=True, eq=False)
class NodeGradient:
    """Derivatives at nodes along two orthonormal directions of the tangent plane.

    Turning from the first of the ``directions``, (2, 3, J, I), to the second is positive: seen from
    the side of a flat surface to which its largest normal component points, and from outside on any
    other. ``derivative`` takes an array (C, J, I) to its derivatives, (2, C, J, I); NaN where there
    are too few neighbours with data.
    """

    directions: Floats
    derivative: Callable[[Floats], Floats]
    poles: tuple[PointLine | PointNodes, ...] = ()
    #: Normal of the surface where it is known exactly, as on the Earth, (3, J, I).
    normal: Floats | None = None

    def with_poles(self, nodal: Floats) -> Floats:
        """Set nodes of poles, whose directions differ, to the mean around them, in place.

        It is NaN where the nodes beside them do not lie all around.
        """
        for pole in self.poles:
            ring = pole.ring_of(nodal)
            finite = np.isfinite(ring)
            share = pole.weights[finite].sum()
            mean = np.nan
            if share >= NEEDED_RING:
                mean = float(pole.weights[finite] @ ring[finite] / share)
            pole.write(nodal, mean)
        return nodal

    def of_vectors(self, vectors: Floats) -> Floats:
        """Return the change of component m along direction n, (2, 2, J, I), of (J, I, 3)."""
        one, two = self.directions
        parts = np.moveaxis(vectors, -1, 0)
        if self.normal is None:
            along = _dot(parts, one) * one
            along += _dot(parts, two) * two
        else:
            along = parts - _dot(parts, self.normal) * self.normal
        change = self.derivative(along)  # (2, C, J, I)
        gradient = np.empty((2, len(change), *change.shape[2:]))
        for m, direction in enumerate((one, two)):
            for n, part in enumerate(change):
                gradient[m, n] = _dot(direction, part)
        return gradient


class PointLine(NamedTuple):
    """A first or last line of nodes, all at one point: a pole, or the tip of a wedge."""

    axis: int  #: Axis of the lines.
    line: int  #: Its number, 0 or -1.
    beside: int  #: Number of the line beside it.
    weights: Floats  #: Shares of the nodes beside it in the mean around it; 0 at a tip.

    def ring_of(self, nodal: Floats) -> Floats:
        """Return the values at nodes, (J, I), of the line beside it."""
        return np.asarray(np.moveaxis(nodal, self.axis, 0)[self.beside])

    def write(self, nodal: Floats, value: float) -> None:
        """Give its nodes a value, in place."""
        np.moveaxis(nodal, self.axis, 0)[self.line] = value


class PointNodes(NamedTuple):
    """Nodes of triangles that are all at one pole, which a map draws as a line."""

    nodes: Indices
    beside: Indices
    weights: Floats  #: Shares of the nodes beside them in the mean around the pole.

    def ring_of(self, nodal: Floats) -> Floats:
        """Return the values at nodes, (1, N), of those beside them."""
        return np.asarray(nodal[0, self.beside])

    def write(self, nodal: Floats, value: float) -> None:
        """Give the nodes a value, in place."""
        nodal[0, self.nodes] = value


def point_nodes(surface: TriangleSurface, points: Floats, without: Bools) -> tuple[PointNodes, ...]:
    """Return the nodes at poles, of those ``without`` vectors (1, N), by places on the sphere."""
    found = []
    triangles = surface.triangles[surface.cells]
    for pole in (-1.0, 1.0):
        at_pole = without[0] & (np.sign(points[0, :, 2]) == pole)
        nodes = np.flatnonzero(at_pole)
        corners = triangles[at_pole[triangles].any(axis=1)]
        ring = np.setdiff1d(corners, nodes)
        weights = _weights_around(points[0, nodes], points[0, ring])
        if weights is not None:
            found.append(PointNodes(nodes, ring, weights))
    return tuple(found)


def point_lines(points: Floats) -> tuple[PointLine, ...]:
    """Return the first and last lines of nodes (J, I, 3) that lie at one point."""
    found = []
    for axis in (0, 1):
        lines = np.moveaxis(points, axis, 0)
        if len(lines) <= 2:
            continue
        for line, beside in ((0, 1), (-1, -2)):
            weights = _weights_around(lines[line], lines[beside])
            if weights is not None:
                found.append(PointLine(axis, line, beside, weights))
    return tuple(found)


def _weights_around(line: Floats, ring: Floats) -> Floats | None:
    """Return shares of nodes (N, 3) in the mean around a line; ``None`` if that is no point.

    They are 0 if the nodes do not lie all around it.
    """
    has_ring = finite_nodes(ring)
    weights = np.zeros(len(ring))
    ends = line[finite_nodes(line)]
    if len(ends) < 3 or has_ring.sum() < 3:
        return None
    middle = ends.mean(axis=0)
    spokes = ring[has_ring] - middle
    size = np.linalg.norm(spokes, axis=-1).min()
    if np.linalg.norm(ends - middle, axis=-1).max() > SAME_POINT_SHARE * size:
        return None
    across = np.linalg.svd(spokes, full_matrices=False)[2][:2]
    angles = np.arctan2(*(spokes @ across.T).T)
    order = np.argsort(angles, kind="stable")
    gaps = np.diff(angles[order], append=angles[order[0]] + 2 * np.pi)
    if gaps.max() <= WIDEST_GAP:
        weights[np.flatnonzero(has_ring)[order]] = (gaps + np.roll(gaps, 1)) / (4 * np.pi)
    return weights


def _has_no_length(difference: Floats) -> Bools:
    """Return where differences (3, J, I) nearly vanish, unlike those beside them."""
    square = np.nan_to_num(_dot(difference, difference))
    beside = scipy.ndimage.maximum_filter(square, size=3)
    return np.asarray(square < COLLAPSED_LENGTH**2 * beside)


def _grid_gradient(
    points: Floats, valid: Bools, periodic: tuple[bool, bool], offset: Floats, *, apart: bool
) -> NodeGradient:
    """Return differences between the nodes of a structured surface; axes are turned by offsets.

    With ``apart``, nodes at a pole are not used, as on a map their vectors have no direction.
    """
    poles = point_lines(points)
    points = np.ascontiguousarray(np.moveaxis(points, -1, 0))
    if apart:
        valid = valid.copy()
        for pole in poles:
            np.moveaxis(valid, pole.axis, 0)[pole.line] = False

    p_j, p_i = _differences(points, valid, offset, periodic)
    for pole in poles:  # it has the directions of the line beside it
        lines = np.moveaxis((p_i, p_j)[pole.axis], pole.axis + 1, 0)
        lines[pole.line] = lines[pole.beside]
    with np.errstate(invalid="ignore", divide="ignore"):
        for difference in (p_i, p_j):
            difference[:, _has_no_length(difference)] = np.nan
        length = np.sqrt(_dot(p_i, p_i))
        one = p_i / length
        skew = _dot(p_j, one)
        two = p_j - skew * one
        height = np.sqrt(_dot(two, two))
        height[~(height**2 > COLLAPSED_AREA * (height**2 + skew**2))] = np.nan
        two /= height
        # Cells per unit of length: of i and j along each direction.
        i_one = 1 / length
        j_two = 1 / height
        i_two = -skew * i_one * j_two
    if _clockwise(one, two, points, valid):
        for array in (two, i_two, j_two):
            np.negative(array, out=array)

    derivative = partial(_grid_derivative, valid, periodic, np.stack([i_one, i_two, j_two]))
    return NodeGradient(np.stack([one, two]), derivative, poles)


def _differences(
    nodal: Floats, valid: Bools, turns: Floats, periodic: tuple[bool, bool]
) -> list[Floats]:
    """Return differences along j and along i of values at nodes, (C, J, I) each.

    ``turns`` are the differences (C,) between both ends of each axis, where it is periodic.
    """
    differences = []
    for axis, is_closed in enumerate(periodic):
        turn = None
        if is_closed:
            turn = turns[axis]
        differences.append(_difference(nodal, valid, axis, turn))
    return differences


def _grid_derivative(
    valid: Bools, periodic: tuple[bool, bool], cells: Floats, nodal: Floats
) -> Floats:
    """Return derivatives (2, C, J, I) of values at nodes, (C, J, I), by the cells per length."""
    no_turns = np.zeros((2, len(nodal)))
    by_j, by_i = _differences(nodal, valid, no_turns, periodic)
    by_j *= cells[2]
    by_j += by_i * cells[1]
    by_i *= cells[0]
    return np.stack([by_i, by_j])


def _difference(nodal: Floats, valid: Bools, axis: int, turn: Floats | None) -> Floats:
    """Return the difference per cell along an axis, of second order also beside gaps."""
    result = np.zeros_like(nodal)  # the ends of an open axis are halved before they are set
    data = np.swapaxes(nodal, 1, axis + 1)
    out = np.swapaxes(result, 1, axis + 1)
    if axis:
        valid = valid.T
    is_central = np.zeros(valid.shape, dtype=bool)
    is_central[1:-1] = valid[2:] & valid[:-2] & valid[1:-1]
    np.subtract(data[:, 2:], data[:, :-2], out=out[:, 1:-1])
    if turn is not None:
        out[:, 0] = out[:, -1] = data[:, 1] + turn[:, None] - data[:, -2]
        is_central[[0, -1]] = valid[1] & valid[-2] & valid[0]
    result *= 0.5
    line, place = np.nonzero(~is_central)
    if len(line):
        out[:, line, place] = _one_sided(data, valid, line, place, turn)
    return result


def _one_sided(
    data: Floats, valid: Bools, line: Indices, place: Indices, turn: Floats | None
) -> Floats:
    """Return differences (C, N) near a border or a gap; ``turn`` is the period of a closed axis."""
    last = data.shape[1] - 1
    center = data[:, line, place]
    result = np.full((len(data), len(line)), np.nan)
    usable = valid[line, place]
    done = np.zeros(len(line), dtype=bool)
    for side in (1, -1):
        values = []
        exists = []
        for distance in (1, 2):
            number = line + side * distance
            if turn is None:
                at = np.clip(number, 0, last)
                exists.append(usable & (at == number) & valid[at, place])
                values.append(data[:, at, place])
            else:
                turns = number // last
                at = number - turns * last
                exists.append(usable & valid[at, place])
                values.append(data[:, at, place] + turns * turn[:, None])
        near, far = values
        first = exists[0] & ~done
        second = exists[0] & exists[1]
        result[:, first] = side * (near - center)[:, first]
        result[:, second] = side * (4 * near - 3 * center - far)[:, second] / 2
        done |= second
    return result


def _dot(one: Floats, two: Floats) -> Floats:
    """Return the scalar product of vectors (3, ...)."""
    return np.asarray(np.einsum("c...,c...->...", one, two))


def _triangle_gradient(surface: TriangleSurface, points: Floats, valid: Bools) -> NodeGradient:
    """Fit quadratic functions to the nodes around each node, (C, 1, N), of a surface of triangles.

    Zhang and Naga 2005, A new finite element gradient recovery method: superconvergence property.
    The fit is of second order on triangles of any shape, unlike means of the gradients of
    triangles.
    """
    if points is not surface.points or valid is not surface.valid:
        surface = TriangleSurface(points, surface.triangles, valid)
    points = surface.points[0]
    (one, two) = surface.tangents[:, 0]
    if _clockwise(one.T[:, None], two.T[:, None], points.T[:, None], surface.valid):
        two = -two
    rows, columns = _near_nodes(surface)
    count = len(points)
    offset = points[columns] - points[rows]
    x = np.einsum("ec,ec->e", offset, one[rows])
    y = np.einsum("ec,ec->e", offset, two[rows])
    degree = np.bincount(rows, minlength=count)
    size = np.sqrt(np.bincount(rows, x * x + y * y, count) / np.maximum(degree, 1))
    size[size == 0] = 1.0
    x /= size[rows]
    y /= size[rows]
    terms = np.stack([x, y, x * x, x * y, y * y])
    terms[2:, degree[rows] < QUADRATIC_NEIGHBOURS] = 0.0
    weight = 1 / (x * x + y * y + 1e-2)
    normal = _normal_matrices(rows, weight, terms, count)
    # Nodes on two lines only leave the quadratic terms open, and with them the linear ones.
    scale = np.sqrt(np.maximum(np.einsum("nkk->nk", normal), 1e-300))
    alike = _are_alike(normal / (scale[:, :, None] * scale[:, None]))
    normal[alike, 2:] = normal[alike, :, 2:] = 0.0
    largest = normal.max(axis=(1, 2))
    normal += np.maximum(largest, 1e-300)[:, None, None] * REGULARISATION * np.eye(5)
    solvable = (degree >= 2) & (np.linalg.det(normal[:, :2, :2]) > 1e-6 * largest**2)
    normal[~solvable] = np.eye(5)
    inverse = np.linalg.inv(normal)[:, :2]
    operators = []
    for share in inverse.transpose(1, 0, 2):
        entries = weight * np.einsum("ek,ke->e", share[rows], terms) / size[rows]
        matrix = scipy.sparse.csr_array((entries, (rows, columns)), (count, count))
        diagonal = np.where(solvable, -np.bincount(rows, entries, count), np.nan)
        operators.append(matrix + scipy.sparse.diags_array(diagonal))

    directions = np.stack([one, two]).transpose(0, 2, 1)[:, :, None]
    return NodeGradient(directions, partial(_applied, operators))


def _are_alike(correlations: Floats) -> Bools:
    """Return whether terms with these correlations, (N, K, K), depend on each other, (N,)."""
    alike: Bools = np.linalg.det(correlations) < SUSPECT_INDEPENDENCE
    least = np.linalg.eigvalsh(correlations[alike])[:, 0]
    alike[alike] = least < LEAST_INDEPENDENCE
    return alike


def _normal_matrices(rows: Indices, weight: Floats, terms: Floats, count: int) -> Floats:
    """Return weighted sums of the products of terms (5, E) at nodes, (count, 5, 5)."""
    normal = np.empty((count, 5, 5))
    for a in range(5):
        for b in range(a, 5):
            normal[:, a, b] = np.bincount(rows, weight * terms[a] * terms[b], count)
            normal[:, b, a] = normal[:, a, b]
    return normal


def _applied(operators: list[Any], nodal: Floats) -> Floats:
    """Return derivatives (2, C, 1, N) of values at nodes, (C, 1, N)."""
    derivatives = []
    for operator in operators:
        along = operator @ nodal[:, 0].T
        derivatives.append(along.T[:, None])
    return np.stack(derivatives)


def _near_nodes(surface: TriangleSurface) -> tuple[Indices, Indices]:
    """Return pairs of nodes at most two edges apart, the first of each pair in order."""
    corners = surface.triangles[surface.cells]
    a = corners.ravel()
    b = np.roll(corners, 1, axis=1).ravel()
    count = surface.valid.size
    ones = np.ones(2 * len(a), dtype=np.int32)
    edges = scipy.sparse.csr_array(
        (ones, (np.concatenate([a, b]), np.concatenate([b, a]))), (count, count)
    )
    near = (edges @ edges + edges).tocoo()
    apart = near.row != near.col
    rows = near.row[apart]
    columns = near.col[apart]
    order = np.argsort(rows, kind="stable")
    return rows[order].astype(np.intp), columns[order].astype(np.intp)


def _clockwise(one: Floats, two: Floats, points: Floats, valid: Bools) -> bool:
    """Return whether turning from the first direction to the second is negative."""
    normal = np.cross(one, two, axis=0)
    usable = valid & np.isfinite(normal).all(axis=0)
    if not usable.any():
        return False
    normal = normal[:, usable]
    place = points[:, usable]
    mean = normal.mean(axis=1)
    if np.linalg.norm(mean) > 1 - 1e-6:
        return bool(mean[np.argmax(np.abs(mean))] < 0)
    return bool(np.sum(normal * (place - place.mean(axis=1, keepdims=True))) < 0)
