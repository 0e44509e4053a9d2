"""Zeros of a velocity that is interpolated in cells and triangles, and their strengths."""

from __future__ import annotations

from typing import cast

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.grids.grid_nodes import neighbour_pairs
from flowtex.field.triangles.triangle_surface import TriangleSurface

#: How far beyond its cell a zero may lie, in cells: it must not be lost between two of them.
ROUNDING_CELLS = 1e-9
#: Speeds at which regions are compared, by the share of the nodes that are slower.
SHARES = np.geomspace(1e-3, 1.0, 32)


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
    a = v[:, 0]
    b = v[:, 1] - v[:, 0]
    c = v[:, 2] - v[:, 0]
    d = v[:, 3] - v[:, 2] - b
    numbers = []
    places = []
    # v = a + b s + c t + d s t is zero where (a + b s) and (c + d s) are parallel.
    square = _cross(b, d)
    linear = _cross(a, d) + _cross(b, c)
    constant = _cross(a, c)
    with np.errstate(invalid="ignore", divide="ignore"):
        q = -0.5 * (linear + np.copysign(np.sqrt(linear * linear - 4 * square * constant), linear))
        roots = q / square, constant / q
    for s in roots:
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            first = a + b * s[:, None]
            slope = c + d * s[:, None]
            t = -np.einsum("nc,nc->n", first, slope) / np.einsum("nc,nc->n", slope, slope)
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
    the sense of the normals. Angles are measured against the edges in each tangent plane, so two
    triangles agree about their edge, and on a closed surface indices sum to Euler's characteristic.
    """
    turned = np.full(len(triangles), 2 * np.pi)
    for k in range(3):
        start = triangles[:, k % 3]
        end = triangles[:, (k + 1) % 3]
        last = triangles[:, (k + 2) % 3]
        edge = points[end] - points[start]
        at_start = _angle(velocity[start], edge, normals[start])
        at_end = _angle(velocity[end], edge, normals[end])
        turned += folded(at_end - at_start)
        # The edges themselves turn once; what is missing from that is curvature.
        turned -= folded(_angle(points[last] - points[end], edge, normals[end]))
    return np.rint(turned / (2 * np.pi)).astype(np.intp)


def _angle(vector: Floats, reference: Floats, normal: Floats) -> Floats:
    """Return the angle (N,) from one vector to another about normals, (N, 3) each."""
    along = np.einsum("nc,nc->n", vector, reference) - np.einsum(
        "nc,nc,nd,nd->n", vector, normal, reference, normal
    )
    across = np.einsum("nc,nc->n", np.cross(reference, vector), normal)
    return np.asarray(np.arctan2(across, along))


def folded(angle: Floats) -> Floats:
    """Return angles as ones from -pi to pi."""
    return np.asarray(angle - 2 * np.pi * np.rint(angle / (2 * np.pi)))


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


def strengths(field: FlowField, nodes: Indices, signs: Indices, steepness: Floats) -> Floats:
    """Return the strengths of critical points of a steady field as speeds, (K,).

    Two points of opposite index vanish together once the velocity between them is changed by as
    much as the speed there (their robustness: Wang, Rosen, Skraba, Bhatia and Pascucci, 2013). So
    it is the least speed below which a region contains the point and a partner; without one, which
    may lie beyond a border, that for any other remaining point. ``nodes`` lie beside the points,
    and ``signs`` are their Poincare indices. Where several have one partner, the steepest remain.
    """
    speed = field.index_velocity.speed[0].ravel()
    valid = field.valid.ravel()
    result = np.full(len(nodes), float(speed[valid].max(initial=0.0)))
    if len(nodes) < 2:
        return result
    if field.triangles is None:
        edges = neighbour_pairs(field.shape, field.periodic)
    else:
        first, second, third = field.triangles.T
        sides = [(first, second), (second, third), (third, first)]
        edges = np.concatenate(list(map(np.transpose, sides)))
        places = cast("TriangleSurface", field.surface).places
        twins = np.flatnonzero(places != np.arange(len(places)))
        edges = np.concatenate([edges, np.stack([places[twins], twins], axis=-1)])
    edges = edges[valid[edges].all(axis=1)]
    needed = speed[edges].max(axis=1)
    order = np.argsort(needed)
    edges = edges[order]
    needed = needed[order]
    remaining = np.argsort(-steepness)
    met = np.zeros(len(nodes), dtype=bool)
    for level in np.quantile(speed[valid], SHARES):
        slower = edges[: int(np.searchsorted(needed, level, side="right"))]
        graph = scipy.sparse.coo_array(
            (np.ones(len(slower), bool), slower.T), shape=(speed.size, speed.size)
        )
        region = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
        regions = region[nodes[remaining]].astype(np.intp)
        paired = _paired(regions, signs[remaining])
        result[remaining[paired]] = level
        remaining = remaining[~paired]
        regions = regions[~paired]
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
