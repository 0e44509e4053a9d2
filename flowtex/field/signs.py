"""Fields without a sign: polarisation, principal directions, fibres; v and -v are the same.

Such a field has no direction everywhere at once: around a half-integer singularity it comes back
turned over. Its nodes are given directions that agree with their neighbours as far as can be, so
that only a cut is left where they do not. In the cells of the cut, and in all others alike, the
directions at the corners are brought into line before anything is interpolated.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from flowtex.field.poles import Poles

__all__ = ["corner_signs", "mean_directions", "oriented", "with_equal_ends"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: How much dearer a step to a node at right angles is than to one that agrees.
RELUCTANCE = 10.0


def oriented(velocity: Floats, valid: Bools, periodic: tuple[bool, bool]) -> Floats:
    """Turn vectors over so that neighbours agree.

    Directions spread from the middle of the domain along the shortest ways, on which steps
    between nodes that hardly agree are long.

    Parameters
    ----------
    velocity
        Vectors, (J, I, 3).
    valid
        Nodes that carry data, (J, I).
    periodic
        Whether the last line along (j, i) is the first one again.
    """
    number = np.arange(valid.size).reshape(valid.shape)
    pairs = [_along(number, valid, axis) for axis in (0, 1)]
    for axis, closed in enumerate(periodic):
        if closed:
            lines = np.swapaxes(number, 0, axis)
            pairs.append(np.stack([lines[0], lines[-1]]))
    one, two = np.concatenate(pairs, axis=1)
    flat = velocity.reshape(-1, 3)
    unit = flat / np.maximum(np.linalg.norm(flat, axis=-1, keepdims=True), np.finfo(float).tiny)
    agree = np.sum(unit[one] * unit[two], axis=-1)
    cost = 1 + RELUCTANCE * (1 - np.abs(agree))
    graph = sparse.csr_array((cost, (one, two)), shape=(valid.size, valid.size))
    parent = _tree(graph, valid)
    sign = np.where(np.sum(unit * unit[parent], axis=-1) < 0, -1.0, 1.0)
    # Every node takes over what its parent has gathered, twice as far up each time.
    while (parent != parent[parent]).any():
        sign, parent = sign * sign[parent], parent[parent]
    sign = sign * sign[parent]
    return np.asarray((flat * sign[:, None]).reshape(velocity.shape))


def with_equal_ends(
    velocity: Floats, periodic: tuple[bool, bool] | None = None, poles: Poles | None = None
) -> Floats:
    """Turn over the vectors of last lines to agree with the first, (T, J, I, 3).

    Nodes that lie at the same place then have the same vector: the two ends of an axis that
    closes, all of both axes where it is not known yet, and the nodes of a pole.
    """
    result = velocity.copy()
    for axis in (1, 2):
        if periodic is None or periodic[axis - 1]:
            lines = np.swapaxes(result, 1, axis)
            with np.errstate(invalid="ignore"):
                against = np.sum(lines[:, 0] * lines[:, -1], axis=-1) < 0
            lines[:, -1][against] *= -1
    for pole in poles or ():
        line = pole.lines(result, 1)[:, pole.line]
        line[np.sum(line * line[:, :1], axis=-1) < 0] *= -1
    return result


def corner_signs(vectors: NDArray[Any]) -> NDArray[np.int8] | None:
    """Signs that bring the corners of each cell into line with the first.

    Parameters
    ----------
    vectors
        Vectors at the nodes in orthonormal components, (J, I, C).

    Returns
    -------
    numpy.ndarray or None
        For the corners (j, i), (j, i + 1), (j + 1, i), (j + 1, i + 1) of each cell, -1 or 1,
        (4, J, I), as far as there is a cell; ``None`` where all are 1.
    """
    first, *others = (vectors[:-1, :-1], vectors[:-1, 1:], vectors[1:, :-1], vectors[1:, 1:])
    signs = np.ones((4, *vectors.shape[:2]), np.int8)
    mean = np.array(first)
    for sign, corner in zip(signs[1:, :-1, :-1], others, strict=True):
        sign[np.sum(mean * corner, axis=-1) < 0] = -1
        mean += sign[..., None] * corner
    return signs if (signs < 0).any() else None


def mean_directions(vectors: Floats) -> Floats:
    """Products of each vector with itself, whose mean has a meaning, (..., 3) to (..., 9).

    Their sum has the mean direction as its longest axis: see :func:`axes`.
    """
    length = np.linalg.norm(vectors, axis=-1)[..., None, None]
    product = vectors[..., :, None] * vectors[..., None, :]
    with np.errstate(invalid="ignore"):
        product = np.divide(product, length, out=np.zeros_like(product), where=length != 0)
    return np.asarray(product.reshape(*vectors.shape[:-1], 9))


def axes(products: Floats) -> Floats:
    """Longest axes of means of products, (..., 9) to (..., 3), as long as the vectors were."""
    known = np.isfinite(products).all(axis=-1)
    safe = np.where(known[..., None], products, 0.0).reshape(*products.shape[:-1], 3, 3)
    lengths, directions = np.linalg.eigh(safe)
    found = directions[..., -1] * lengths[..., -1:]
    return np.where(known[..., None], found, np.nan)


def _along(number: NDArray[np.intp], valid: Bools, axis: int) -> NDArray[np.intp]:
    """Pairs of neighbouring valid nodes along an axis, (2, N)."""
    n, ok = np.swapaxes(number, 0, axis), np.swapaxes(valid, 0, axis)
    both = ok[:-1] & ok[1:]
    return np.stack([n[:-1][both], n[1:][both]])


def _tree(graph: Any, valid: Bools) -> NDArray[np.intp]:
    """Node that each node takes its direction from; itself for the first of each part."""
    parts, part = sparse.csgraph.connected_components(graph, directed=False)
    del parts
    rows, columns = valid.shape
    j, i = np.divmod(np.arange(valid.size), columns)
    aside = np.hypot(j - (rows - 1) / 2, i - (columns - 1) / 2)
    order = np.lexsort((aside, part))
    firsts = order[np.unique(part[order], return_index=True)[1]]
    firsts = firsts[valid.ravel()[firsts]]
    _, parent, _ = dijkstra(
        graph, directed=False, indices=firsts, return_predecessors=True, min_only=True
    )
    itself = np.arange(valid.size)
    return np.where(parent < 0, itself, parent).astype(np.intp)
