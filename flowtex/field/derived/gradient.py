"""The velocity gradient along a surface, at its nodes.

The derivative along a surface of a vector that lies in it (its covariant derivative) is the part
of its derivative in space that lies in the surface. So components in space are differentiated, on a
sphere as on a crooked grid, and no term for the curvature of coordinates is needed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.earth import GLOBE, Projection
from flowtex.field.grids.poles import find_poles
from flowtex.field.triangles.triangle_surface import Surface, TriangleSurface
from flowtex.field.validation import finite_nodes

#: Below this ratio of squared area to squared lengths a cell has no area to divide by.
COLLAPSED_AREA = 1e-10
QUADRATIC_NEIGHBOURS = 5  #: Least number of neighbours for a quadratic fit.
REGULARISATION = 1e-12  #: Regularisation of a fit, as a share of the largest entry.
LEAST_INDEPENDENCE = 1e-9  #: Determinant of the correlations of the terms of a fit, at least.


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
    points, valid = true_positions(surface.points, projection), surface.valid
    valid = valid if known is None else valid & known
    if isinstance(surface, TriangleSurface):
        return _triangle_gradient(surface, points, valid)
    # On the sphere one turn leads to the same place.
    offset = surface.offset if points is surface.points else np.zeros((2, 3))
    return _grid_gradient(points, valid, surface.periodic, offset)


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
    poles: tuple[tuple[int, int], ...] = ()

    def with_poles(self, nodal: Floats) -> Floats:
        """Set nodes of poles, whose directions differ, to the mean beside them, in place."""
        for axis, line in self.poles:
            lines = np.moveaxis(nodal, axis, 0)
            beside = lines[abs(line - 1), :-1]  # the first or the last line but one
            finite = np.isfinite(beside)
            lines[line] = beside[finite].mean() if finite.any() else np.nan
        return nodal

    def of_vectors(self, vectors: Floats) -> Floats:
        """Return the change of component m along direction n, (2, 2, J, I), of (J, I, 3)."""
        one, two = self.directions
        parts = np.moveaxis(vectors, -1, 0)
        along = _dot(parts, one) * one
        along += _dot(parts, two) * two
        change = self.derivative(along)
        return np.asarray([[_dot(d, part) for part in change] for d in (one, two)])


def _grid_gradient(
    points: Floats, valid: Bools, periodic: tuple[bool, bool], offset: Floats
) -> NodeGradient:
    """Return differences between the nodes of a structured surface; axes are turned by offsets."""
    known = finite_nodes(points)
    found = find_poles(points, known, known, periodic)
    poles = tuple((1 - pole.component, pole.line) for pole in found or ())
    points = np.ascontiguousarray(np.moveaxis(points, -1, 0))

    turns = [turn if is_closed else None for turn, is_closed in zip(offset, periodic, strict=True)]
    p_i, p_j = (_difference(points, valid, axis, turns[axis]) for axis in (1, 0))
    for axis, line in poles:  # a pole has the directions of the line beside it
        lines = np.moveaxis((p_i, p_j)[axis], axis + 1, 0)
        lines[line] = lines[abs(line - 1)]
    with np.errstate(invalid="ignore", divide="ignore"):
        length = np.sqrt(_dot(p_i, p_i))
        one = p_i / length
        skew = _dot(p_j, one)
        two = p_j - skew * one
        height = np.sqrt(_dot(two, two))
        height[~(height**2 > COLLAPSED_AREA * (height**2 + skew**2))] = np.nan
        two /= height
        # Cells per unit of length: of i and j along each direction.
        i_one, j_two = 1 / length, 1 / height
        i_two = -skew * i_one * j_two
    if _clockwise(one, two, points, valid):
        for array in (two, i_two, j_two):
            np.negative(array, out=array)

    derivative = partial(_grid_derivative, valid, periodic, np.stack([i_one, i_two, j_two]))
    return NodeGradient(np.stack([one, two]), derivative, poles)


def _grid_derivative(
    valid: Bools, periodic: tuple[bool, bool], cells: Floats, nodal: Floats
) -> Floats:
    """Return derivatives (2, C, J, I) of values at nodes, (C, J, I), by the cells per length."""
    turns = [np.zeros(len(nodal)) if is_closed else None for is_closed in periodic]
    by_i, by_j = (_difference(nodal, valid, axis, turns[axis]) for axis in (1, 0))
    by_j *= cells[2]
    by_j += by_i * cells[1]
    by_i *= cells[0]
    return np.stack([by_i, by_j])


def _difference(nodal: Floats, valid: Bools, axis: int, turn: Floats | None) -> Floats:
    """Return the difference per cell along an axis, of second order also beside gaps."""
    result = np.zeros_like(nodal)  # the ends of an open axis are halved before they are set
    data, out = (np.swapaxes(a, 1, axis + 1) for a in (nodal, result))
    valid = valid.T if axis else valid
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
    center, result = data[:, line, place], np.full((len(data), len(line)), np.nan)
    usable, done = valid[line, place], np.zeros(len(line), dtype=bool)
    for side in (1, -1):
        values, exists = [], []
        for distance in (1, 2):
            number = line + side * distance
            turns = np.zeros_like(number) if turn is None else number // last
            at = np.clip(number, 0, last) if turn is None else number - turns * last
            exists.append(usable & (at == number if turn is None else True) & valid[at, place])
            shift = 0.0 if turn is None else turns * turn[:, None]
            values.append(data[:, at, place] + shift)
        near, far = values
        first, second = exists[0] & ~done, exists[0] & exists[1]
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
    points, (one, two) = surface.points[0], surface.tangents[:, 0]
    if _clockwise(one.T[:, None], two.T[:, None], points.T[:, None], surface.valid):
        two = -two
    rows, columns = _near_nodes(surface)
    count = len(points)
    offset = points[columns] - points[rows]
    x, y = (np.einsum("ec,ec->e", offset, d[rows]) for d in (one, two))
    degree = np.bincount(rows, minlength=count)
    size = np.sqrt(np.bincount(rows, x * x + y * y, count) / np.maximum(degree, 1))
    size[size == 0] = 1.0
    x, y = x / size[rows], y / size[rows]
    terms = np.stack([x, y, x * x, x * y, y * y])
    terms[2:, degree[rows] < QUADRATIC_NEIGHBOURS] = 0.0
    weight = 1 / (x * x + y * y + 1e-2)
    normal = np.empty((count, 5, 5))
    for a in range(5):
        for b in range(a, 5):
            normal[:, a, b] = np.bincount(rows, weight * terms[a] * terms[b], count)
            normal[:, b, a] = normal[:, a, b]
    # Nodes on two lines only leave the quadratic terms open, and with them the linear ones.
    scale = np.sqrt(np.maximum(np.einsum("nkk->nk", normal), 1e-300))
    alike = np.linalg.det(normal / (scale[:, :, None] * scale[:, None])) < LEAST_INDEPENDENCE
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


def _applied(operators: list[Any], nodal: Floats) -> Floats:
    columns = nodal[:, 0].T
    return np.stack([(operator @ columns).T[:, None] for operator in operators])


def _near_nodes(surface: TriangleSurface) -> tuple[Indices, Indices]:
    """Return pairs of nodes at most two edges apart, the first of each pair in order."""
    corners = surface.triangles[surface.cells]
    a, b = corners.ravel(), np.roll(corners, 1, axis=1).ravel()
    count = surface.valid.size
    ones = np.ones(2 * len(a), dtype=np.int32)
    edges = scipy.sparse.csr_array(
        (ones, (np.concatenate([a, b]), np.concatenate([b, a]))), (count, count)
    )
    near = (edges @ edges + edges).tocoo()
    apart = near.row != near.col
    rows, columns = near.row[apart], near.col[apart]
    order = np.argsort(rows, kind="stable")
    return rows[order].astype(np.intp), columns[order].astype(np.intp)


def _clockwise(one: Floats, two: Floats, points: Floats, valid: Bools) -> bool:
    """Return whether turning from the first direction to the second is negative."""
    normal = np.stack([one[a] * two[b] - one[b] * two[a] for a, b in ((1, 2), (2, 0), (0, 1))])
    usable = valid & np.isfinite(normal).all(axis=0)
    if not usable.any():
        return False
    normal, place = normal[:, usable], points[:, usable]
    mean = normal.mean(axis=1)
    if np.linalg.norm(mean) > 1 - 1e-6:
        return bool(mean[np.argmax(np.abs(mean))] < 0)
    return bool(np.sum(normal * (place - place.mean(axis=1, keepdims=True))) < 0)
