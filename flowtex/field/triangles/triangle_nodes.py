"""Arguments of a field on triangles as its arrays, without parts that cannot be drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import dot, norm
from flowtex.errors import FieldError, notify, raise_faults
from flowtex.field.steps import LazySteps, Steps, first_step, map_steps
from flowtex.field.validation import (
    as_numbers,
    cell_faults,
    finite_nodes,
    nodal_faults,
    range_faults,
    scalar_steps,
    three_components,
    with_gaps,
)

#: Twice the area of a triangle over the square of its longest side, below which it is flat.
FLAT_TRIANGLE = 1e-12
SAME_NODE_SHARE = 1e-9  #: Nodes on borders closer than this share of the surface's extent are one.
#: Direction without symmetry, of at most unit length: points of usual meshes differ along it.
GENERIC = np.array([0.36787944, 0.69314718, 0.61983])
#: Edges of a triangle without area that are shorter than this share of the longest are a point.
#: Sections have them near nodes that lie in the plane up to rounding in single precision.
NEEDLE_SHARE = 1e-4
#: Cosine of the angle between the normals of a node and a triangle below which an edge is sharp.
SHARP = 0.86


def triangle_nodes(
    points: ArrayLike,
    triangles: ArrayLike,
    velocity: Any,
    times: Floats | None,
    valid: ArrayLike | None,
    scalars: Mapping[str, Any],
    cell_scalars: Mapping[str, Any],
) -> dict[str, Any]:
    """Check arrays; return the arguments of a field whose nodes are a row, (1, N).

    Nodes at one place are joined, and parts that cannot be drawn are left out.
    """
    p, masked_points = as_numbers("points", points)
    v, masked = as_numbers("velocity", first_step(velocity))
    try:
        corners = np.asarray(triangles)
    except ValueError as error:
        raise FieldError(
            f"triangles is not an array ({error}); expected three node numbers in every row"
        ) from error
    mask = None if valid is None else np.nan_to_num(with_gaps("valid", valid)) != 0
    arrays = {name: with_gaps(f"scalars[{name!r}]", first_step(s)) for name, s in scalars.items()}
    on_cells = {
        k: with_gaps(f"cell_scalars[{k!r}]", first_step(s)) for k, s in cell_scalars.items()
    }
    count = len(velocity) if v.ndim == 3 or isinstance(velocity, LazySteps) else 1
    faults = _faults(p, corners, v, count, times, mask, arrays)
    raise_faults(faults or cell_faults((len(corners),), count, on_cells, scalars))
    p = three_components(p)
    v = three_components(v)
    v = (v[None] if v.ndim == 2 else v)[:, None]  # (T, 1, N, 3)
    finite = finite_nodes(p[None])[0] & ~masked_points & finite_nodes(v)[0] & ~masked
    ok: Bools = np.asarray(finite if mask is None else finite & mask)
    v = np.asarray(np.where(ok[:, None], v, np.nan))
    raise_faults(range_faults(p[None], v, ok[None]))
    steps: Steps = v
    if isinstance(velocity, LazySteps):
        steps = velocity.map(partial(_row, ok))
    data = {
        name: scalars[name].map(_as_row)
        if isinstance(scalars[name], LazySteps)
        else scalar_steps(s, (1, len(p)))
        for name, s in arrays.items()
    }
    drawn, pairs = _usable(p, corners.astype(np.intp))
    cells, corners = len(corners), corners[drawn].astype(np.intp)
    if not (ok[corners].all(axis=1)).any():
        raise FieldError(
            f"{int(ok.sum())} of {ok.size} nodes are usable, but no triangle has three of them; "
            "check the triangles and the mask"
        )
    # Unknown positions must not take part in computations.
    p = np.where(finite_nodes(p[None])[0][:, None], p, np.mean(p[ok], axis=0))
    same = merged_nodes(p, corners, pairs)
    is_joined = same != np.arange(len(p))
    if is_joined.any():
        moved = is_joined[corners].any(axis=1)
        corners = same[corners]
        moved[moved] = ~solid_triangles(p, corners[moved])
        corners, drawn = corners[~moved], drawn[~moved]
    is_used = np.zeros(len(p), dtype=bool)
    is_used[corners] = True
    used = np.flatnonzero(is_used)
    number = np.where(is_used, np.cumsum(is_used) - 1, -1)
    if len(used) < len(p):
        ok, steps, data = _joined(number[same], len(used), ok, steps, data)
        p = p[used]
    steps = map_steps(steps, partial(_at_rest, ~ok))
    for name, s in on_cells.items():
        late = cell_scalars[name]
        if isinstance(late, LazySteps):
            data[name] = late.map(partial(_as_row, at=drawn))
        else:
            data[name] = scalar_steps(s, (1, cells))[..., drawn]
    nodes = {"points": p[None].copy("C"), "triangles": number[corners], "valid": ok[None]}
    return {**nodes, "velocity": steps, "scalars": data}


def _as_row(step: Floats, at: Any = slice(None)) -> Floats:
    """Return some values of a step, (N, ...), as a row of nodes, (1, N, ...)."""
    return step[None, at]


def _at_rest(unused: Bools, step: Floats) -> Floats:
    """Return a step, (1, N, 3), that is zero at nodes that are not in use."""
    return np.where(unused[:, None], 0.0, step)


def _row(ok: Bools, step: Floats) -> Floats:
    """Return a step (1, N, 3) of (N, 2 or 3): nodes that are not in use have NaN."""
    step = np.where(np.isfinite(step).all(axis=-1, keepdims=True), step, 0.0)
    return np.where(ok[:, None], three_components(step), np.nan)[None]


def _faults(
    p: Floats,
    corners: Any,
    v: Floats,
    steps: int,
    times: Floats | None,
    valid: Any,
    scalars: Mapping[str, Floats],
) -> list[str]:
    if p.ndim != 2 or p.shape[-1] not in (2, 3) or not len(p):
        return [f"points has shape {p.shape}; expected (N, 2) or (N, 3), one row for each node"]
    faults, count = [], len(p)
    if corners.ndim != 2 or corners.shape[-1] != 3 or corners.dtype.kind not in "iu":
        faults.append(
            f"triangles has shape {corners.shape} and type {corners.dtype}; expected whole "
            "numbers of shape (M, 3): the nodes at the corners of each triangle"
        )
    elif not len(corners):
        faults.append("triangles is empty; expected node numbers of shape (M, 3)")
    elif corners.min() < 0 or corners.max() >= count:
        wrong = int(corners.min() if corners.min() < 0 else corners.max())
        faults.append(f"triangles has node {wrong}; expected 0 to {count - 1}, the rows of points")
    return faults + nodal_faults((count,), v, steps, times, valid, scalars)


def solid_triangles(p: Floats, corners: Indices) -> Bools:
    """Return which triangles (M,) have an area."""
    a, b, c = (p[corners[:, k]] for k in range(3))
    sides = b - a, c - a, c - b
    longest = np.max([np.einsum("mc,mc->m", side, side) for side in sides], axis=0)
    area = np.linalg.norm(np.cross(*sides[:2]), axis=-1)
    return np.asarray(area > FLAT_TRIANGLE * longest)


def _usable(p: Floats, corners: Indices) -> tuple[Indices, Indices]:
    """Return numbers of solid triangles, each once, and pairs of nodes (n, 2) that needles join."""
    finite = finite_nodes(p[None])[0]
    placed = np.ones(len(corners), bool) if finite.all() else finite[corners].all(axis=1)
    good = placed.copy()
    good[placed] = solid_triangles(p, corners[placed])
    once = ~repeated(corners)
    flat = corners[placed & ~good]
    is_point = needle_edges(p, flat)
    counts = [
        (int((~is_point.any(axis=1)).sum()), "without area"),
        (int((good & ~once).sum()), "there twice"),
        (int((~placed).sum()), "at points that are not finite"),
    ]
    listed = ", ".join(f"{count:,} {reason}" for count, reason in counts if count)
    if listed:
        notify(f"triangles are left out: {listed}", UserWarning)
    return np.flatnonzero(good & once), edges_of(flat)[is_point]


def nodal_means(
    values: Steps, triangles: Indices, areas: Floats, nodes: int, known: Bools | None = None
) -> Steps:
    """Return means at the nodes, (T, N, ...), of values at triangles (T, M, ...), by area.

    Faces with up to K corners, (M, K), have -1 for missing ones. Values that are NaN, or not
    ``known`` (M,), have no weight; a node without values has NaN.
    """
    at, face = triangles.ravel(), np.repeat(np.arange(len(triangles)), triangles.shape[1])
    weights = areas if known is None else np.where(known, areas, 0.0)
    present = at >= 0
    face = face[present]
    summed = partial(sums_at, at[present], count=nodes, of=face, weights=weights[face])
    return map_steps(values, partial(known_means, summed=summed))


def sums_at(
    number: Indices, values: Floats, count: int, of: Any = slice(None), weights: Any = 1.0
) -> Floats:
    """Return sums (count, C), by number (n,), of weighted values (N, C) ``of`` some items (n,)."""
    columns = (np.bincount(number, weights * column[of], count) for column in values.T)
    return np.stack([*columns], axis=-1)


def known_means(values: Floats, summed: Callable[[Floats], Floats]) -> Floats:
    """Return means (n, ...) of finite values (N, ...), which are summed; NaN without any."""
    flat = values.reshape(len(values), -1)
    finite = np.asarray(np.isfinite(flat).all(axis=1, keepdims=True))
    sums, total = summed(np.where(finite, flat, 0.0)), summed(finite.astype(np.float64))
    means = np.divide(sums, total, out=np.full_like(sums, np.nan), where=total > 0)
    return np.asarray(means.reshape(-1, *values.shape[1:]))


def _joined(
    number: Indices, count: int, ok: Bools, v: Steps, data: Mapping[str, Floats]
) -> tuple[Bools, Floats, dict[str, Steps]]:
    """Average the values of nodes at one place; nodes with the number -1 are left out."""
    kept = np.flatnonzero(number >= 0)
    summed = partial(sums_at, number[kept], count=count, of=kept)
    mean = partial(_row_means, summed=summed)
    usable = np.bincount(number[kept], ok[kept], count) > 0
    return usable, map_steps(v, mean), {name: map_steps(s, mean) for name, s in data.items()}


def _row_means(step: Floats, summed: Callable[[Floats], Floats]) -> Floats:
    """Return :func:`known_means` of a row of nodes, (1, N, ...)."""
    return known_means(step[0], summed)[None]


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
    corners = np.sort(triangles, axis=1)
    order = np.lexsort(corners.T)
    result = np.zeros(len(corners), dtype=bool)
    result[order[1:]] = (np.diff(corners[order], axis=0) == 0).all(axis=1)
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
        pairs = np.concatenate([pairs, twins[twins[:, 0] != twins[:, 1]]])
        left = border[first]
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
    a, b, c = (points[corner] for corner in triangles.T)
    return np.cross(b - a, c - a)


def corner_ends(points: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return least and greatest coordinates of the corners of triangles, (M, 3) each."""
    a, b, c = (points[corner] for corner in triangles.T)
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def connected_parts(beside: Indices) -> Indices:
    """Return the number of the connected part of each triangle, (M,), from neighbours (M, 3)."""
    rows, corners = np.nonzero(beside >= 0)
    size = (len(beside), len(beside))
    ends = rows, beside[rows, corners]
    graph = scipy.sparse.coo_array((np.ones(len(rows)), ends), shape=size)
    parts = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
    return np.asarray(parts, np.intp)


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
    for count in np.unique(counts):
        sides = order[starts[counts == count][:, None] + np.arange(count)]
        triangle, corner = np.divmod(sides[:, :1], 3)
        begin, end = (points[triangles[triangle, (corner + k) % 3]] for k in (1, 2))
        along, away = end - begin, points[triangles.reshape(-1)[sides]] - begin
        share = dot(away, along) / np.maximum(dot(along, along), np.finfo(float).tiny)
        away -= share[..., None] * along
        away /= np.maximum(norm(away), np.finfo(float).tiny)[..., None]
        straight = away @ away.swapaxes(1, 2)
        straight[:, np.arange(count), np.arange(count)] = np.inf
        result[sides] = np.take_along_axis(sides, np.argmin(straight, axis=2), axis=1) // 3


def flipped(triangles: Indices, beside: Indices) -> Bools:
    """Return which triangles (M,) face the other way than the first one of their part."""
    result = np.zeros(len(triangles), dtype=bool)
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
