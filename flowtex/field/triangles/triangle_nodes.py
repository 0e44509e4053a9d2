"""Triangles between nodes: their sides, normals and neighbours, and means at the nodes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import bounds, cross, dot, norm, row_blocks
from flowtex.field.steps import Steps, map_steps

#: Twice the area of a triangle over the square of its longest side, below which it is flat.
FLAT_TRIANGLE = 1e-12
SAME_NODE_SHARE = 1e-9  #: Nodes on borders closer than this share of the surface's extent are one.
#: Direction without symmetry, of at most unit length: points of usual meshes differ along it.
GENERIC = np.array([0.36787944, 0.69314718, 0.61983])
#: Edges of a triangle without area that are shorter than this share of the longest are a point.
#: Sections have them near nodes that lie in the plane up to rounding in single precision.
NEEDLE_SHARE = 1e-4
#: Range of random numbers of nodes, whose sums fit into 64 bits, also as floating-point numbers.
MOST_RANDOM = 2**50
#: Slots of a table for each number that is looked up in it.
SLOTS = 3
#: Slots of a table for the triangles of which a node is the lowest corner: about two.
SLOTS_OF_NODE = 8
#: An odd number, from the golden ratio, of which products with even numbers differ in all bits.
ODD_FACTOR = 0x9E3779B97F4A7C15
#: Corners that 32 bits can number.
MOST_SMALL = 2**31
#: Cosine of the angle between the normals of a node and a triangle below which an edge is sharp.
SHARP = 0.86


def solid_triangles(p: Floats, corners: Indices) -> Bools:
    """Return which triangles (M,) have an area."""
    return solid_normals(p, corners)[0]


def solid_normals(p: Floats, corners: Indices) -> tuple[Bools, Floats]:
    """Return which triangles (M,) have an area, and :func:`triangle_normals`."""
    normals = triangle_normals(p, corners)
    # No side is longer than the surface.
    extent = 0.0
    if len(p):
        extent = float(norm(np.ptp(bounds(p), axis=0)))
    solid = norm(normals) > FLAT_TRIANGLE * extent**2
    unsure = np.flatnonzero(~solid)
    a, b, c = p.take(corners[unsure].T, axis=0)
    longest = np.maximum.reduce([dot(side, side) for side in (b - a, c - a, c - b)])
    solid[unsure] = norm(normals[unsure]) > FLAT_TRIANGLE * longest
    return solid, normals


def nodal_means(
    values: Steps, triangles: Indices, areas: Floats, nodes: int, known: Bools | None = None
) -> Steps:
    """Return means at the nodes, (T, N, ...), of values at triangles (T, M, ...), by area.

    Faces with up to K corners, (M, K), have -1 for missing ones. Values that are NaN, or not
    ``known`` (M,), have no weight; a node without values has NaN.
    """
    at = triangles.ravel()
    face = np.repeat(np.arange(len(triangles)), triangles.shape[1])
    if known is None:
        weights = areas
    else:
        weights = np.where(known, areas, 0.0)
    present = at >= 0
    face = face[present]
    summed = partial(sums_at, at[present], count=nodes, of=face, weights=weights[face])
    return map_steps(values, partial(known_means, summed=summed))


def incidence(triangles: Indices, count: int, weights: Floats | None = None) -> Any:
    """Return a sparse matrix (M, count) with weights (M, K), or ones, at the corners of faces.

    Multiply it by values at nodes to sum them at faces, and its transpose by values at faces to sum
    them at nodes. This is several times as fast as ``numpy.bincount``.
    """
    if weights is None:
        weights = np.ones(triangles.size)
    begins = np.arange(0, triangles.size + 1, triangles.shape[1])
    entries = np.ravel(weights), np.ravel(triangles), begins
    return scipy.sparse.csr_array(entries, shape=(len(triangles), count))


def sums_at(
    number: Indices,
    values: Floats,
    count: int,
    of: Indices | None = None,
    weights: Floats | None = None,
) -> Floats:
    """Return sums of values by target, (count, C).

    Row k is the sum of ``weights[m] * values[of[m]]``, or of ``weights[m] * values[m]`` without
    ``of``, over all m with ``number[m] == k``.

    Parameters
    ----------
    number
        Target of each summand, (n,).
    values
        Values, (N, C).
    count
        Number of targets.
    of
        Number of the value of each summand, (n,); by default they are in order.
    weights
        Weight of each summand, (n,); 1 by default.
    """
    if of is not None:
        values = values.take(of, axis=0)
    return np.asarray(incidence(number[:, None], count, weights).T @ values)


def nodal_sums(
    triangles: Indices, values: Floats, count: int, weights: Floats | None = None
) -> Floats:
    """Return sums at the nodes, (count, C), of values at triangles, (M, C), maybe weighted."""
    return np.asarray(incidence(triangles, count, weights).T @ values)


def known_means(values: Floats, summed: Callable[[Floats], Floats]) -> Floats:
    """Return means (n, ...) of finite values (N, ...), which are summed; NaN without any."""
    flat = values.reshape(len(values), -1)
    finite = np.ones((len(flat), 1), dtype=bool)
    if not np.isfinite(flat).all():
        finite = np.asarray(np.isfinite(flat).all(axis=1, keepdims=True))
        flat = np.where(finite, flat, 0.0)
    sums = summed(flat)
    total = summed(finite.astype(np.float64))
    means = np.divide(sums, total, out=np.full_like(sums, np.nan), where=total > 0)
    return np.asarray(means.reshape(-1, *values.shape[1:]))


def edges_of(triangles: Indices) -> Indices:
    """Return the edge opposite to each corner, (M, 3, 2): its nodes, the lower number first."""
    pairs = np.stack([np.roll(triangles, -1, axis=1), np.roll(triangles, 1, axis=1)], axis=-1)
    return np.sort(pairs, axis=-1)


def _edge_keys(triangles: Indices) -> Indices:
    """Return a number for each edge, (3 M,), the same for the same nodes."""
    count = np.int64(triangles.max(initial=0)) + 1
    keys = np.empty(triangles.shape, dtype=np.int64)
    for corner in range(3):
        begin = triangles[:, corner - 2]
        end = triangles[:, corner - 1]
        keys[:, corner] = np.minimum(begin, end) * count + np.maximum(begin, end)
    return keys.ravel()


def _has_equal(numbers: Indices) -> bool:
    """Return whether two of some numbers are equal, in half of the time of sorting.

    Each is written to a slot of a table. Of several in one slot the last one stays: those that were
    overwritten are equal to it, or go to the slots of another table.
    """
    left = numbers.view(np.uint64)
    factor = ODD_FACTOR
    while len(left):
        bits = (SLOTS * len(left)).bit_length()
        slot = left * np.uint64(factor)
        slot >>= np.uint64(64 - bits)
        item = np.arange(len(left), dtype=_smallest_type(len(left)))
        table = np.empty(1 << bits, item.dtype)
        table[slot] = item
        stayed = table.take(slot.view(np.int64))
        lost = np.flatnonzero(stayed != item)
        if (left[lost] == left[stayed[lost]]).any():
            return True
        left = left[lost]
        factor = factor * ODD_FACTOR % 2**64
    return False


def _has_repeated(triangles: Indices) -> bool:
    """Return whether two triangles have the same corners, found by sums of random numbers of these.

    Triangles with the same lowest corner share some slots of a table, where neighbours lie close
    together, which takes a third of the time of :func:`_has_equal`; few are overwritten.
    """
    count = int(triangles.max(initial=0)) + 1
    # Sums are rarely equal by chance.
    random = np.random.default_rng(0).integers(0, MOST_RANDOM, count)
    sums = np.empty(len(triangles), np.int64)
    slots = np.empty(len(triangles), _smallest_type(count * SLOTS_OF_NODE))
    table = np.empty(count * SLOTS_OF_NODE, _smallest_type(len(triangles)))
    for block in row_blocks(len(triangles), 1):
        a, b, c = triangles[block].T
        sums[block] = random.take(a) + random.take(b) + random.take(c)
        slot = sums[block].view(np.uint64) * np.uint64(ODD_FACTOR)
        slot %= np.uint64(SLOTS_OF_NODE)
        slots[block] = slot
        slots[block] += SLOTS_OF_NODE * np.minimum(np.minimum(a, b), c)
        table[slots[block]] = np.arange(block.start, block.stop)
    overwritten = []
    for block in row_blocks(len(triangles), 1):
        item = np.arange(block.start, block.stop)
        stayed = table.take(slots[block])
        lost = np.flatnonzero(stayed != item)
        if (sums[item[lost]] == sums[stayed[lost]]).any():
            return True
        overwritten.append(sums[item[lost]])
    return len(overwritten) > 0 and _has_equal(np.concatenate(overwritten))


def repeated(triangles: Indices) -> Bools:
    """Return which triangles (M,) have the corners of another one before them."""
    result = np.zeros(len(triangles), dtype=bool)
    if not _has_repeated(triangles):
        return result
    corners = np.sort(triangles, axis=1)
    order = np.lexsort(corners.T)
    result[order[1:]] = (np.diff(corners[order], axis=0) == 0).all(axis=1)
    return result


def once(corners: Indices) -> tuple[Indices, Indices]:
    """Return triangles with three different corners, each once, without pairs face to face.

    The second value has their numbers among all.
    """
    a, b, c = corners.T
    solid = np.flatnonzero((a != b) & (b != c) & (a != c))
    corners = corners[solid]
    low, middle, high = np.sort(corners, axis=1).T
    # Whether the corners, from the lowest on, go up.
    ahead = corners[np.arange(len(corners)), (np.argmin(corners, axis=1) + 1) % 3] == middle
    order = np.lexsort((high, middle, low))
    begins = np.flatnonzero(
        np.diff(low[order], prepend=-1)
        | np.diff(middle[order], prepend=-1)
        | np.diff(high[order], prepend=-1)
    )
    if not len(begins):
        return corners, solid
    turns = np.add.reduceat(np.where(ahead, 1, -1)[order], begins)
    low = low[order[begins]]
    middle = middle[order[begins]]
    high = high[order[begins]]
    up = np.stack([low, middle, high], axis=-1)
    up[turns < 0] = up[turns < 0][:, [0, 2, 1]]
    return up[turns != 0], solid[order[begins]][turns != 0]


def uneven_nodes(triangles: Indices, count: int) -> Bools:
    """Return nodes (count,) on borders, or on edges that triangles pass in the same direction.

    Around any other node, each neighbour follows in one triangle and precedes in another one.
    """
    random = np.random.default_rng(0).integers(0, MOST_RANDOM, count)
    total = np.zeros(count, dtype=np.int64)
    for block in row_blocks(len(triangles), 1):
        nodes = triangles[block].T.ravel()
        numbers = random.take(nodes).reshape(3, -1)
        turns = numbers[[1, 2, 0]] - numbers[[2, 0, 1]]
        np.add.at(total, nodes, turns.ravel())
    return np.asarray(total != 0)


def _border_nodes(triangles: Indices, uneven: Bools) -> Indices:
    """Return the nodes at sides that belong to one triangle, from :func:`uneven_nodes`."""
    triangles = _with_two(triangles, uneven)
    keys = np.sort(_edge_keys(triangles))
    differs = np.diff(keys, prepend=-1, append=-1) != 0
    lone = keys[differs[1:] & differs[:-1]]
    return np.unique(np.divmod(lone, int(triangles.max(initial=0)) + 1))


def _with_two(triangles: Indices, nodes: Bools) -> Indices:
    """Return the triangles (m, 3) with two or three of some nodes (N,)."""
    if not nodes.any():
        return triangles[:0]
    a, b, c = nodes.take(triangles).T
    return np.asarray(triangles[(a & b) | (b & c) | (a & c)])


def touching(triangles: Indices, nodes: Bools) -> Bools:
    """Return which triangles (M,) have at least one of some nodes (N,)."""
    a, b, c = nodes.take(triangles).T
    return np.asarray(a | b | c)


def _twins(points: Floats, nodes: Indices) -> Indices:
    """Return the first of some nodes (n,) at the exact place of each of them, (n,)."""
    _, first, at = np.unique(points[nodes], axis=0, return_index=True, return_inverse=True)
    return np.asarray(nodes[first[at.ravel()]])


def same_places(points: Floats, triangles: Indices) -> Indices:
    """Return the first node on a border at the exact place of each node, (N,)."""
    result = np.arange(len(points))
    border = _border_nodes(triangles, uneven_nodes(triangles, len(points)))
    if len(border):
        result[border] = _twins(points, border)
    return result


def merged_nodes(
    points: Floats, triangles: Indices, uneven: Bools, joined: Indices | tuple[()] = ()
) -> Indices:
    """Return for each node (N,) the first at its place, from the nodes of :func:`uneven_nodes`.

    Pairs of nodes (n, 2) that are ``joined`` are one.
    """
    count = len(points)
    border = _border_nodes(triangles, uneven)
    pairs = np.reshape(np.asarray(joined, dtype=np.intp), (-1, 2))
    if len(border):
        near = SAME_NODE_SHARE * float(np.ptp(points[border], axis=0).max(initial=0.0))
        # Exact twins first, as in most files: few remain for the tree.
        first = _twins(points, border)
        twins = np.stack([first, border], axis=-1)
        pairs = np.concatenate([pairs, twins[twins[:, 0] != twins[:, 1]]])
        left = border[first == border]
        # Along this line hardly any two are as close.
        if (np.diff(np.sort((points[left] - points[left[0]]) @ GENERIC)) <= near).any():
            tree = scipy.spatial.cKDTree(points[left])
            pairs = np.concatenate([pairs, left[tree.query_pairs(near, output_type="ndarray")]])
    if not len(pairs):
        return np.arange(count)
    graph = scipy.sparse.coo_array((np.ones(len(pairs)), pairs.T), shape=(count, count))
    place = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
    return np.asarray(np.unique(place, return_index=True)[1][place])


def needle_edges(points: Floats, triangles: Indices) -> Bools:
    """Return which edges (M, 3), opposite to the corners, are single points beside the others."""
    ends = points[edges_of(triangles)]
    lengths = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=-1)
    return np.asarray(lengths <= NEEDLE_SHARE * lengths.max(axis=1, initial=0.0, keepdims=True))


def triangle_normals(points: Floats, triangles: Indices) -> Floats:
    """Return the cross product of two sides, (M, 3): the normal, as long as twice the area."""
    result = np.empty((len(triangles), 3), points.dtype)
    for block in row_blocks(len(triangles), 1):
        a, b, c = points.take(triangles[block].T, axis=0)
        result[block] = cross(b - a, c - a)
    return result


def corner_angles(points: Floats, triangles: Indices) -> Floats:
    """Return the angles at the corners of triangles, (M, 3)."""
    result = np.empty(triangles.shape)
    for block in row_blocks(len(triangles), 1):
        a, b, c = points.take(triangles[block].T, axis=0)
        one = b - a
        two = c - b
        three = a - c
        area = norm(cross(one, two))
        result[block, 0] = np.arctan2(area, -dot(three, one))
        result[block, 1] = np.arctan2(area, -dot(one, two))
        result[block, 2] = np.arctan2(area, -dot(two, three))
    return result


def corner_ends(points: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return least and greatest coordinates of the corners of triangles, (M, 3) each."""
    low, high = np.empty((2, len(triangles), points.shape[1]), points.dtype)
    for block in row_blocks(len(triangles), 1):
        a, b, c = points.take(triangles[block].T, axis=0)
        low[block] = np.minimum(np.minimum(a, b), c)
        high[block] = np.maximum(np.maximum(a, b), c)
    return low, high


def connected_nodes(triangles: Indices, count: int) -> Indices:
    """Return the number of the connected part of each node, (count,)."""
    part = connected_items(triangles[:, 0], triangles[:, 1], count)
    # One side of every triangle connects nearly all.
    first, _, third = part.take(triangles.T)
    apart = first != third
    if apart.any():
        part = connected_items(first[apart], third[apart], int(part.max()) + 1)[part]
    return part


def connected_items(begins: Indices, ends: Indices, count: int) -> Indices:
    """Return the number of the connected part of each of ``count`` items, from links (n,)."""
    kind = _smallest_type(count)
    begins = begins.astype(kind)
    ends = ends.astype(kind)
    links = np.ones(len(begins), bool), (begins, ends)
    graph = scipy.sparse.coo_array(links, shape=(count, count))
    return np.asarray(scipy.sparse.csgraph.connected_components(graph, directed=False)[1], np.intp)


def _smallest_type(count: int) -> type[np.int32 | np.int64]:
    """Return the smallest type of the numbers up to ``count``."""
    if count < MOST_SMALL:
        return np.int32
    return np.int64


def _sorting(numbers: Indices, count: int) -> Indices:
    """Return the order (n,) that sorts numbers from 0 to ``count``, equal ones as they are.

    A sparse matrix with an entry in each row is sorted by columns without comparisons.
    """
    begins = np.arange(len(numbers) + 1, dtype=numbers.dtype)
    entries = np.ones(len(numbers), np.int8), numbers, begins
    matrix = scipy.sparse.csr_array(entries, shape=(len(numbers), count))
    return np.asarray(matrix.tocsc().indices)


def neighbours(points: Floats, triangles: Indices) -> Indices:
    """Return the triangle across each edge, (M, 3), -1 at a border; of several the straightest."""
    count = int(triangles.max(initial=0)) + 1
    small = triangles.astype(_smallest_type(triangles.size))
    begin = np.roll(small, -1, axis=1).ravel()
    end = np.roll(small, 1, axis=1).ravel()
    low = np.minimum(begin, end)
    high = np.maximum(begin, end)
    order = _sorting(high, count)
    order = order[_sorting(low[order], count)]
    low = low[order]
    high = high[order]
    # Whether each side has the edge of the next one, and of the one before.
    ahead = np.append((low[1:] == low[:-1]) & (high[1:] == high[:-1]), False)
    back = np.append(False, ahead[:-1])
    is_first = ahead & ~back
    has_third = is_first[:-1] & ahead[1:]
    result = np.full(len(order), -1, dtype=np.intp)
    shared = np.flatnonzero(is_first)
    if has_third.any():
        starts = np.flatnonzero(~back)
        counts = np.diff(np.append(starts, len(order)))
        crowded = counts > 2
        _straightest(points, triangles, order, starts[crowded], counts[crowded], result)
        shared = starts[counts == 2]
    near = order[shared]
    far = order[shared + 1]
    result[near], result[far] = far // 3, near // 3
    return result.reshape(-1, 3)


def _straightest(
    points: Floats,
    triangles: Indices,
    order: Indices,
    starts: Indices,
    counts: Indices,
    result: Indices,
) -> None:
    for count in np.unique(counts):
        sides = order[starts[counts == count][:, None] + np.arange(count)]
        triangle, corner = np.divmod(sides[:, :1], 3)
        begin = points[triangles[triangle, (corner + 1) % 3]]
        end = points[triangles[triangle, (corner + 2) % 3]]
        along = end - begin
        away = points[triangles.reshape(-1)[sides]] - begin
        share = dot(away, along) / np.maximum(dot(along, along), np.finfo(float).tiny)
        away -= share[..., None] * along
        away /= np.maximum(norm(away), np.finfo(float).tiny)[..., None]
        straight = away @ away.swapaxes(1, 2)
        straight[:, np.arange(count), np.arange(count)] = np.inf
        result[sides] = np.take_along_axis(sides, np.argmin(straight, axis=2), axis=1) // 3


def face_alike(triangles: Indices, uneven: Bools) -> bool:
    """Return whether all triangles face as their neighbours do, from :func:`uneven_nodes`."""
    count = len(uneven)
    near = _with_two(triangles, uneven)
    # Neighbours that face alike pass their common edge in opposite directions.
    ahead = np.roll(near, -1, axis=1)
    return not _has_equal((ahead * np.int64(count) + near).ravel())


def flipped(triangles: Indices, beside: Indices) -> Bools:
    """Return which triangles (M,) face the other way than the first one of their part."""
    result = np.zeros(len(triangles), dtype=bool)
    ahead = np.roll(triangles, -1, axis=1)  # of the edge opposite to a corner
    rows, corners = np.nonzero(beside >= 0)
    other = beside[rows, corners]
    begins = ahead[rows, corners]
    back = np.argmax(beside[other] == rows[:, None], axis=1)
    mutual = beside[other, back] == rows
    turned = mutual & (ahead[other, back] == begins)
    if not turned.any():
        return result
    # Triangles that face alike are one patch; those an odd number of turns away face otherwise.
    size = (len(triangles), len(triangles))
    alike = mutual & ~turned
    graph = scipy.sparse.coo_array((np.ones(alike.sum()), (rows[alike], other[alike])), shape=size)
    count, patch = scipy.sparse.csgraph.connected_components(graph, directed=False)
    ends = patch[rows[turned]], patch[other[turned]]
    turns = scipy.sparse.csr_array((np.ones(turned.sum()), ends), shape=(count, count))
    _, part = scipy.sparse.csgraph.connected_components(turns, directed=False)
    firsts = np.unique(part, return_index=True)[1]
    steps = scipy.sparse.csgraph.dijkstra(
        turns, directed=False, indices=firsts, unweighted=True, min_only=True
    )
    return np.asarray(steps[patch] % 2 == 1)


def normals_at_corners(points: Floats, normals: Floats) -> Floats:
    """Return normals at the corners of triangles, (..., 3, 3), for lighting.

    ``normals`` and ``points`` belong to the nodes at the corners, (..., 3, 3). At sharp edges the
    normal of the triangle replaces the normal of the node, so that faces are even up to their end.
    """
    across = np.cross(points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 0, :])
    alike = np.einsum("...c,...kc->...k", across, normals)
    length = np.linalg.norm(across, axis=-1)[..., None]
    sharp = np.abs(alike) < SHARP * length
    face = across / np.maximum(length, np.finfo(float).tiny)
    faced = np.where(alike < 0, -1.0, 1.0)[..., None] * face[..., None, :]
    return np.where(sharp[..., None], faced, normals)
