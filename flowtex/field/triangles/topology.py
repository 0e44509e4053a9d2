"""Topology of triangles: shared points, neighbours across edges, and orientation."""

from __future__ import annotations

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices

#: Nodes on borders closer than this share of the surface's extent are one.
SAME_NODE_SHARE = 1e-9
#: Edges of a triangle without area that are shorter than this share of the longest are a point.
#: Sections have them near nodes that lie in the plane up to rounding in single precision.
NEEDLE_SHARE = 1e-4
#: Cosine of the angle between the normals of a node and a triangle below which an edge is sharp.
SHARP = 0.86
#: Greatest count of numbers of which three fit into 64 bits.
MOST_CUBED = 2**21


def edges_of(triangles: Indices) -> Indices:
    """Return the edge opposite to each corner, (M, 3, 2): its nodes, the lower number first."""
    pairs = np.stack([np.roll(triangles, -1, axis=1), np.roll(triangles, 1, axis=1)], axis=-1)
    return np.sort(pairs, axis=-1)


def _edge_keys(triangles: Indices) -> Indices:
    """Return a number for each edge, (3 M,), the same for the same nodes."""
    ahead, behind = (np.roll(triangles, by, axis=1).ravel() for by in (-1, 1))
    count = np.int64(triangles.max(initial=0)) + 1
    return np.asarray(np.minimum(ahead, behind) * count + np.maximum(ahead, behind))


def repeated(triangles: Indices) -> Bools:
    """Return which triangles (M,) have the corners of another one before them."""
    low, middle, high = np.sort(triangles, axis=1).T.astype(np.int64)
    count = int(triangles.max(initial=0)) + 1
    keys = low * count + middle
    if count > MOST_CUBED:
        keys = np.unique(keys, return_inverse=True)[1]
    keys = keys * count + high
    result = np.zeros(len(keys), dtype=bool)
    ordered = np.sort(keys)
    if (ordered[1:] == ordered[:-1]).any():
        order = np.argsort(keys, kind="stable")
        result[order[1:]] = keys[order[1:]] == keys[order[:-1]]
    return result


def merged_nodes(points: Floats, triangles: Indices, joined: Indices | tuple[()] = ()) -> Indices:
    """Return for each node (N,) the first at its place; pairs that are ``joined`` are one."""
    count = len(points)
    keys = np.sort(_edge_keys(triangles))
    differs = np.diff(keys, prepend=-1, append=-1) != 0
    lone = keys[differs[1:] & differs[:-1]]
    border = np.unique(np.divmod(lone, int(triangles.max(initial=0)) + 1))
    pairs = np.reshape(np.asarray(joined, dtype=np.intp), (-1, 2))
    if len(border):
        near = SAME_NODE_SHARE * float(np.ptp(points[border], axis=0).max(initial=0.0))
        # Exact twins first, as in most files: few remain for the tree.
        _, first, at = np.unique(points[border], axis=0, return_index=True, return_inverse=True)
        twins = np.stack([border[first[at.ravel()]], border], axis=-1)
        left = border[first]
        close: Indices = scipy.spatial.cKDTree(points[left]).query_pairs(
            near, output_type="ndarray"
        )
        pairs = np.concatenate([pairs, twins[twins[:, 0] != twins[:, 1]], left[close]])
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
    result, one, two = np.empty((len(triangles), 3)), [], []
    # Column by column, which is several times as fast.
    for column in np.ascontiguousarray(points.T):
        a, b, c = (column[triangles[:, k]] for k in range(3))
        one.append(b - a)
        two.append(c - a)
    for axis in range(3):
        result[:, axis] = one[axis - 2] * two[axis - 1] - one[axis - 1] * two[axis - 2]
    return result


def corner_ends(points: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return least and greatest coordinates of the corners of triangles, (M, 3) each."""
    low, high = np.empty((2, 3, len(triangles)))
    for axis, column in enumerate(np.ascontiguousarray(points.T)):
        a, b, c = (column[triangles[:, k]] for k in range(3))
        np.minimum(np.minimum(a, b), c, out=low[axis])
        np.maximum(np.maximum(a, b), c, out=high[axis])
    return low.T, high.T


def neighbours(points: Floats, triangles: Indices) -> Indices:
    """Return the triangle across each edge, (M, 3), -1 at a border; of several the straightest."""
    keys = _edge_keys(triangles)
    order = np.argsort(keys)
    ordered = keys[order]
    starts = np.flatnonzero(np.diff(ordered, prepend=-1))
    counts = np.diff(np.append(starts, len(ordered)))
    result = np.full(len(keys), -1, dtype=np.intp)
    shared = starts[counts == 2]
    near, far = order[shared], order[shared + 1]
    result[near], result[far] = far // 3, near // 3
    crowded = counts > 2
    if crowded.any():
        _straightest(points, triangles, order, starts[crowded], counts[crowded], result)
    return result.reshape(-1, 3)


def _straightest(
    points: Floats,
    triangles: Indices,
    order: Indices,
    starts: Indices,
    counts: Indices,
    result: Indices,
) -> None:
    """Write the neighbours across edges that more than two triangles share."""
    for first, count in zip(starts, counts, strict=True):
        sides = order[first : first + count]
        tips = points[triangles.reshape(-1)[sides]]
        ends = points[edges_of(triangles[sides[:1] // 3])[0, sides[0] % 3]]
        along = ends[1] - ends[0]
        away = tips - ends[0]
        away -= np.outer(away @ along, along) / max(float(along @ along), np.finfo(float).tiny)
        away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), np.finfo(float).tiny)
        straight = away @ away.T
        np.fill_diagonal(straight, np.inf)
        result[sides] = sides[np.argmin(straight, axis=1)] // 3


def _any_faces_otherwise(triangles: Indices, beside: Indices) -> bool:
    """Return whether any triangle and a neighbour pass their common edge in one direction."""
    columns = list(np.ascontiguousarray(triangles.T))
    for k in range(3):
        begins, ends = columns[k - 2], columns[k - 1]
        opposite = [column[beside[:, k]] for column in columns]
        for n in range(3):
            common = (opposite[n - 1] == begins) & (opposite[n] == ends)
            if (common & (beside[:, k] >= 0)).any():
                return True
    return False


def flipped(triangles: Indices, beside: Indices) -> Bools:
    """Return which triangles (M,) face the other way than the first one of their part."""
    result = np.zeros(len(triangles), dtype=bool)
    if not _any_faces_otherwise(triangles, beside):
        return result
    ahead = np.roll(triangles, -1, axis=1)  # of the edge opposite to a corner
    rows, corners = np.nonzero(beside >= 0)
    other = beside[rows, corners]
    begins = ahead[rows, corners]
    back = np.argmax(beside[other] == rows[:, None], axis=1)
    mutual = beside[other, back] == rows
    # Neighbours that face alike pass their common edge in opposite directions.
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

    They are those of the nodes there, (..., 3, 3) as the ``points`` are, and at sharp edges those
    of the triangle, so that each face is even up to its end.
    """
    across = np.cross(points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 0, :])
    alike = np.einsum("...c,...kc->...k", across, normals)
    length = np.linalg.norm(across, axis=-1)[..., None]
    sharp = np.abs(alike) < SHARP * length
    face = across / np.maximum(length, np.finfo(float).tiny)
    faced = np.where(alike < 0, -1.0, 1.0)[..., None] * face[..., None, :]
    return np.where(sharp[..., None], faced, normals)
