"""Positions of the blocks of a level, and their roughness, which limits the size of cells.

The next level omits every other line of nodes. Where interpolation of the other nodes replaces
them, cells may be larger on the screen than elsewhere, so flowtex traces fewer nodes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.arrays import dot, norm
from flowtex.field.triangles.triangle_nodes import neighbours, triangle_normals

if TYPE_CHECKING:
    from flowtex.field import FlowField
    from flowtex.field.steps import Nodes

#: Cells along a side of a block, the smallest part of a tile that is drawn by itself.
BLOCK_CELLS = 64
#: Greatest factor by which cells may be larger on the screen where a level is smooth.
SMOOTH_CELLS = 4.0
#: Invisible error of an interpolated velocity, as a share of the speed, or of an interpolated
#: scalar, as a share of its range.
VALUE_ERROR = 0.01
#: Invisible distance of a node from the line between its two neighbours, as a share of the line.
PLACE_ERROR = 0.03
#: Share of the greatest speed around a node that counts as its own where the flow almost rests.
REST_SPEED = 0.25
#: Lines of the square of nodes around a node.
AROUND = 16
#: Range of a scalar that is constant up to rounding, as a share of its greatest value.
SAME = 1e-6
#: Most triangles of a block whose errors are measured.
MOST_MEASURED = 500
#: Percentile of the errors, or speeds, of triangles that counts as the greatest.
MOST_SHARE = 98


def block_places(points: Floats, cells: int = BLOCK_CELLS) -> Floats:
    """Return centre, radius, and longest side of a cell of blocks, (rows, columns, 5)."""
    firsts = [np.arange(0, max(n - 1, 1), cells) for n in points.shape[:2]]
    lasts = [np.minimum(f + cells, n - 1) for f, n in zip(firsts, points.shape, strict=False)]
    center = np.zeros((len(firsts[0]), len(firsts[1]), 3))
    for rows in (firsts[0], lasts[0]):
        for columns in (firsts[1], lasts[1]):
            center += 0.25 * points[np.ix_(rows, columns)]
    side = np.zeros(points.shape[:2])
    side[:-1] = norm(np.diff(points, axis=0))
    across = norm(np.diff(points, axis=1))
    side[:, :-1] = np.maximum(side[:, :-1], across)
    size = _greatest(side, firsts, lasts)
    blocks = [
        np.minimum(np.arange(n) // cells, len(f) - 1)
        for f, n in zip(firsts, points.shape[:2], strict=True)
    ]
    distances = norm(points - center[np.ix_(*blocks)])
    radius = _greatest(distances, firsts, lasts) + size
    return np.concatenate([center, radius[..., None], size[..., None]], axis=-1)


def _greatest(values: Floats, firsts: list[Indices], lasts: list[Indices]) -> Floats:
    """Return the greatest value (J, I) in each block; a border counts for both sides."""
    for axis in (0, 1):
        inner = np.maximum.reduceat(values, firsts[axis], axis=axis)
        values = np.maximum(inner, np.take(values, lasts[axis], axis=axis))
    return values


def has_roughness(field: FlowField) -> bool:
    """Return whether the roughness of a field is known: its only step is in memory.

    A browser computes a formula at the nodes that it needs.
    """
    arrays = (field.velocity, *field.scalars.values())
    return (
        len(field.times) == 1
        and all(isinstance(values, np.ndarray) for values in arrays)
        and not field.on_cells
        and field.formula is None
    )


def enlarging(errors: Floats, most: float = SMOOTH_CELLS) -> Floats:
    """Return factors by which cells may be larger, from errors in multiples of invisible ones."""
    return most / np.clip(errors, 1.0, most)


def _extent(values: Floats) -> float:
    """Return the range of a scalar, more than rounding."""
    return max(float(np.ptp(values)), SAME * float(np.abs(values).max()))


def block_roughness(nodes: Nodes | FlowField, cells: int) -> Floats:
    """Return the greatest error in each block of ``cells`` cells of the next level.

    The errors of the first step, (rows, columns), are multiples of an invisible error in the
    largest cell of the block.
    """
    speed = around = np.where(nodes.valid, norm(nodes.velocity[0]), 0.0)
    for axis, count in enumerate(speed.shape):
        squares = np.maximum.reduceat(around, np.arange(0, count, AROUND), axis)
        around = np.repeat(squares, AROUND, axis)[(slice(None),) * axis + (slice(count),)]
    values = [(nodes.velocity[0], np.maximum(speed, REST_SPEED * around))]
    for steps in nodes.scalars.values():
        extent = _extent(steps[0][nodes.valid])
        values.append((steps[0][..., None], np.full(speed.shape, extent)))
    shape = [max(-(-(n // 2) // cells), 1) for n in speed.shape]
    greatest = np.zeros(shape)
    longest = np.full(shape, np.finfo(float).tiny)
    for row in range(shape[0]):
        rows = slice(2 * cells * row, 2 * cells * (row + 1) + 1)
        arrays = nodes.points[rows], nodes.valid[rows], [(v[rows], s[rows]) for v, s in values]
        for axis in (0, 1):
            for found, most in zip(_errors(axis, *arrays), (greatest, longest), strict=True):
                if found.size:
                    starts = np.arange(shape[1]) * (cells if axis else 2 * cells)
                    starts = np.minimum(starts, found.shape[1] - 1)
                    found = np.maximum.reduceat(found.max(axis=0), starts)
                    np.maximum(most[row], found, out=most[row])
    return greatest / longest


def _errors(
    axis: int, points: Floats, valid: Bools, values: list[tuple[Floats, Floats]]
) -> tuple[Floats, Floats]:
    """Return errors at the nodes of the omitted lines along an axis, and lengths of cells.

    Each of ``values`` has a number of components, (J, I, C), and a size to compare with, (J, I).
    Errors are multiplied by the length of the cell, because small cells are hardly seen.
    """

    def lines(array: AnyArray) -> list[AnyArray]:
        array = np.moveaxis(array, axis, 0)
        count = (len(array) - 1) // 2
        return [array[k : k + 2 * count : 2] for k in (0, 1, 2)]

    before, middle, after = lines(points)
    one = norm(middle - before)
    other = norm(after - middle)
    share = np.divide(one, one + other, where=one + other > 0, out=np.full_like(one, 0.5))
    length = norm(after - before)
    errors = np.zeros(share.shape)
    # A scalar that is NaN at some nodes, or a size of zero, gives NaN or infinity.
    with np.errstate(invalid="ignore", divide="ignore"):
        for array, size in [(points, None), *values]:
            before, middle, after = lines(array)
            error = norm(middle - before - share[..., None] * (after - before))
            if size is None:
                limit = PLACE_ERROR * length
            else:
                limit = VALUE_ERROR * np.maximum.reduce(lines(size))
            errors = np.maximum(errors, np.where(error > 0, error / limit, error))
        errors *= length
    if not valid.all():
        known = np.sum(lines(valid), axis=0)
        errors[known < 3] = np.inf
        errors[known == 0] = length[known == 0] = 0.0
    errors[np.isnan(errors)] = np.inf
    return np.moveaxis(errors, 0, axis), np.moveaxis(length, 0, axis)


def triangle_roughness(field: FlowField, triangles: Indices, parts: list[Indices]) -> Floats:
    """Return errors at the next level of a field on triangles, as :func:`block_roughness` does.

    The three nodes of a triangle extrapolate a linear function to the far node of its neighbour;
    the difference measures curvature. ``parts`` has the numbers of the triangles of each block, of
    which some are measured where they are many.
    """
    points, velocity = field.points[0], field.velocity[0, 0]
    # An odd step takes both kinds where triangles are pairs.
    some = [part[:: (len(part) // MOST_MEASURED) | 1] for part in parts]
    rows, number = np.unique(np.concatenate(some), return_inverse=True)
    beside = neighbours(points, triangles)[rows]
    row, corner = np.nonzero(beside > rows[:, None])
    here = rows[row]
    there = beside[row, corner]
    # The nodes at the corner, at both ends of the edge, and across.
    inner = [triangles[here, (corner + k) % 3] for k in range(3)]
    nodes = np.stack([*inner, triangles[there].sum(axis=1) - inner[1] - inner[2]], axis=-1)
    a, b, c, d = points[nodes.T]
    normal = triangle_normals(points, triangles[rows])[row]
    area = np.maximum(dot(normal, normal), np.finfo(float).tiny)
    second = dot(np.cross(d - a, c - a), normal) / area
    third = dot(np.cross(b - a, d - a), normal) / area
    weights = np.stack([second + third - 1, -second, -third, np.ones_like(second)], axis=-1)
    speed, length = norm(velocity), norm(c - b)
    rest = REST_SPEED * float(np.percentile(speed[field.valid[0]], MOST_SHARE))
    values = [(velocity, np.maximum(speed[nodes].max(axis=1), rest))]
    for steps in field.scalars.values():
        extent = _extent(steps[0, 0, field.valid[0]])
        values.append((steps[0, 0, :, None], np.full(len(here), extent)))
    with np.errstate(invalid="ignore", divide="ignore"):
        errors = np.abs(dot(d - a, normal)) / np.sqrt(area) / (4 * PLACE_ERROR)
        for nodal, size in values:
            # The next level doubles the distances, which quadruples deviations from a line.
            error = norm(np.einsum("nk,nkc->nc", weights, nodal[nodes])) / 2
            error = np.where(error > 0, error / (VALUE_ERROR * size), error)
            errors = np.maximum(errors, error * length)
    errors[np.isnan(errors)] = np.inf
    # A triangle without neighbours has no error.
    greatest = _greatest_by_row(errors, row, np.zeros(len(rows)))
    longest = _greatest_by_row(length, row, np.full(len(rows), np.finfo(float).tiny))
    ends = np.cumsum([len(part) for part in some])
    members = np.split(number, ends[:-1])
    return np.array([_most_error(greatest[part], longest[part]) for part in members])


def _greatest_by_row(values: Floats, row: Indices, result: Floats) -> Floats:
    """Write the greatest of the values (n,) with each number of a row, in order, into a result."""
    begins = np.flatnonzero(np.diff(row, prepend=-1))
    if len(begins):
        result[row[begins]] = np.maximum.reduceat(values, begins)
    return result


def _most_error(errors: Floats, lengths: Floats) -> float:
    """Return the error of a block by errors of its triangles, which are multiplied by lengths."""
    if not len(errors):
        return 0.0
    return float(np.percentile(errors, MOST_SHARE, method="lower") / lengths.max())
