"""Sign-free fields: polarisation, principal directions, fibres; v and -v are the same.

No choice of signs is continuous everywhere: around a half-integer singularity a vector returns
reversed. The signs at the nodes are chosen to agree with their neighbours as far as possible, so
that they disagree only along a cut. The corners of each cell are given equal signs before
interpolation.

For fields with ``FlowField.sign_free`` paths are traced to both sides, corners are aligned
(:func:`corner_signs`), kernels are symmetric, and grains do not move.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.field.grids.poles import Poles

#: Additional cost of a step to a node at right angles, over that of a step to one that agrees.
TURN_COST = 10.0
#: A vector shorter than this share of the longest has no direction.
REST_SHARE = 1e-7


def sign_free_faults(v: Floats) -> list[str]:
    """Return faults in the velocity of a sign-free field."""
    if v.ndim != 4 or len(v) == 1:
        return []
    return [
        f"sign_free is True, but velocity has {len(v)} time steps; a sign-free field has no paths "
        "in time: give one step, as in velocity[-1], or make one field for each"
    ]


def oriented(velocity: Floats, valid: Bools, periodic: tuple[bool, bool]) -> Floats:
    """Turn vectors (J, I, 3) over so that neighbours agree.

    Directions spread from the middle of the domain along the shortest ways, on which steps
    between nodes that hardly agree are long.
    """
    flat = velocity.reshape(-1, 3)
    length = np.linalg.norm(flat, axis=-1, keepdims=True)
    # A vector at rest has no direction.
    valid = valid & (length > REST_SHARE * length.max()).reshape(valid.shape)
    number = np.arange(valid.size).reshape(valid.shape)
    pairs = [_along(number, valid, axis) for axis in (0, 1)]
    for axis, closed in enumerate(periodic):
        if closed:
            lines = np.swapaxes(number, 0, axis)
            is_valid = np.swapaxes(valid, 0, axis)[0]
            pairs.append(np.stack([lines[0][is_valid], lines[-1][is_valid]]))
    start, end = np.concatenate(pairs, axis=1)
    unit = flat / np.where(length > 0, length, 1.0)
    agree = np.sum(unit[start] * unit[end], axis=-1)
    cost = 1 + TURN_COST * (1 - np.abs(agree))
    graph = scipy.sparse.csr_array((cost, (start, end)), shape=(valid.size, valid.size))
    parent = _tree(graph, valid)
    sign = np.where(np.sum(unit * unit[parent], axis=-1) < 0, -1.0, 1.0)
    # Every node takes the sign of its parent, twice as far up each time.
    while (parent != parent[parent]).any():
        sign, parent = sign * sign[parent], parent[parent]
    return np.asarray((flat * sign[:, None]).reshape(velocity.shape))


def with_equal_ends(
    velocity: Floats, periodic: tuple[bool, bool] | None = None, poles: Poles | None = None
) -> Floats:
    """Turn over the vectors of last lines to agree with the first, (T, J, I, 3).

    Nodes at the same place then have the same vector: the ends of closed axes, of both axes where
    ``periodic`` is not known yet, and the nodes of a pole.
    """
    result = velocity.copy()
    for axis in (1, 2):
        if periodic is None or periodic[axis - 1]:
            lines = np.swapaxes(result, 1, axis)
            lines[:, -1] *= _sign(lines[:, 0] * lines[:, -1])
    for pole in poles or ():
        line = pole.lines(result, 1)[:, pole.line]
        line *= _sign(line * line[:, :1])
    return result


def corner_signs(vectors: AnyArray) -> NDArray[np.int8] | None:
    """Return signs that align the corners of each cell with the first one.

    Vectors are orthonormal components at the nodes, (J, I, C). Signs are -1 or 1, (4, J, I) as far
    as there is a cell, for the corners (j, i), (j, i + 1), (j + 1, i), (j + 1, i + 1); ``None``
    where all are 1.
    """
    first, *others = (vectors[:-1, :-1], vectors[:-1, 1:], vectors[1:, :-1], vectors[1:, 1:])
    signs = np.ones((4, *vectors.shape[:2]), np.int8)
    mean = np.array(first)
    for sign, corner in zip(signs[1:, :-1, :-1], others, strict=True):
        sign[np.sum(mean * corner, axis=-1) < 0] = -1
        mean += sign[..., None] * corner
    return signs if (signs < 0).any() else None


def weighted_axis(vectors: Floats, weights: Floats) -> Floats:
    """Return the weighted mean of vectors (N, C), each reversed if it opposes the first."""
    signs = np.where(vectors @ vectors[0] < 0, -1.0, 1.0)
    return np.asarray((weights * signs) @ vectors)


def products(vectors: Floats) -> Floats:
    """Return outer products of vectors, over their length, whose means are sign-free."""
    length = np.linalg.norm(vectors, axis=-1)[..., None, None]
    product = vectors[..., :, None] * vectors[..., None, :]
    product = np.divide(product, length, out=np.zeros_like(product), where=length != 0)
    return np.asarray(product.reshape(*vectors.shape[:-1], -1))


def axes(means: Floats) -> Floats:
    """Return the longest axes (..., C) of means (..., C * C) of :func:`products`."""
    finite = np.asarray(np.isfinite(means).all(axis=-1))
    size = round(means.shape[-1] ** 0.5)
    safe = np.where(finite[..., None], means, 0.0).reshape(*means.shape[:-1], size, size)
    lengths, directions = np.linalg.eigh(safe)
    longest = directions[..., -1] * lengths[..., -1:]
    return np.where(finite[..., None], longest, np.nan)


def _sign(products: Floats) -> Floats:
    """Return signs of the sums along the last axis, (..., 1)."""
    with np.errstate(invalid="ignore"):
        return np.where(np.sum(products, axis=-1, keepdims=True) < 0, -1.0, 1.0)


def _along(number: Indices, valid: Bools, axis: int) -> Indices:
    """Return pairs of neighbouring valid nodes along an axis, (2, N)."""
    n, ok = np.swapaxes(number, 0, axis), np.swapaxes(valid, 0, axis)
    pairs = ok[:-1] & ok[1:]
    return np.stack([n[:-1][pairs], n[1:][pairs]])


def _tree(graph: scipy.sparse.csr_array, valid: Bools) -> Indices:
    """Return the parent of each node, from which it takes its direction; roots are their own."""
    _, part = scipy.sparse.csgraph.connected_components(graph, directed=False)
    rows, columns = valid.shape
    j, i = np.divmod(np.arange(valid.size), columns)
    aside = np.hypot(j - (rows - 1) / 2, i - (columns - 1) / 2)
    order = np.lexsort((aside, part))
    firsts = order[np.unique(part[order], return_index=True)[1]]
    firsts = firsts[valid.ravel()[firsts]]
    _, parent, _ = scipy.sparse.csgraph.dijkstra(
        graph, directed=False, indices=firsts, return_predecessors=True, min_only=True
    )
    itself = np.arange(valid.size)
    return np.where(parent < 0, itself, parent).astype(np.intp)
