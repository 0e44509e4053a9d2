"""How strong critical points are: the change of velocity that makes them vanish.

Two points of opposite index vanish together once the velocity between them is changed by as much
as the speed there (their robustness: Wang, Rosen, Skraba, Bhatia and Pascucci, 2013). So a point
is as strong as the least speed below which a region has it and a partner. Points of noise come in
pairs that little speed parts. Partners of points at a border may lie beyond it: a point without one
is as strong as the least speed below which a region has it and any other that is left.
"""

from __future__ import annotations

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField

#: Speeds at which regions are compared, by the share of the nodes that are slower.
SHARES = np.geomspace(1e-3, 1.0, 32)


def strengths(field: FlowField, nodes: Indices, signs: Indices, steepness: Floats) -> Floats:
    """Return the strengths of critical points of a steady field as speeds, (K,).

    Of each point there is a node beside it, counted row by row, and its Poincare index, (K,) each.
    Where several have one partner, the steepest, (K,), are left.
    """
    speed, valid = field.speed[0].ravel(), field.valid.ravel()
    result = np.full(len(nodes), float(speed[valid].max(initial=0.0)))
    if len(nodes) < 2:
        return result
    edges = _edges(field)
    edges = edges[valid[edges].all(axis=1)]
    needed = speed[edges].max(axis=1)
    order = np.argsort(needed)
    edges, needed = edges[order], needed[order]
    left, met = np.argsort(-steepness), np.zeros(len(nodes), dtype=bool)
    for level in np.quantile(speed[valid], SHARES):
        some = edges[: int(np.searchsorted(needed, level, side="right"))]
        graph = scipy.sparse.coo_array(
            (np.ones(len(some), bool), some.T), shape=(speed.size, speed.size)
        )
        region = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
        here = region[nodes[left]].astype(np.intp)
        gone = _paired(here, signs[left])
        result[left[gone]] = level
        left, here = left[~gone], here[~gone]
        meets = (np.bincount(here, minlength=1)[here] > 1) & ~met[left]
        result[left[meets]], met[left[meets]] = level, True
    return result


def _paired(region: Indices, signs: Indices) -> Bools:
    """Return which points (K,) have a partner in their region, the last ones where not all have."""
    kind = 2 * region + (signs > 0)
    counts = np.bincount(kind, minlength=2 * int(region.max(initial=0)) + 2)
    order = np.argsort(kind, kind="stable")
    rank = np.empty(len(kind), dtype=np.intp)
    rank[order] = np.arange(len(kind)) - (np.cumsum(counts) - counts)[kind[order]]
    return np.asarray(rank >= counts[kind] - counts[kind ^ 1])


def _edges(field: FlowField) -> Indices:
    """Return pairs of neighbouring nodes, (E, 2), counted row by row."""
    if field.triangles is not None:
        corners = np.asarray(field.triangles)
        return np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    number = np.arange(field.valid.size).reshape(field.shape)
    pairs = [(number[:, :-1], number[:, 1:]), (number[:-1], number[1:])]
    if field.periodic[1]:
        pairs.append((number[:, :1], number[:, -1:]))
    if field.periodic[0]:
        pairs.append((number[:1], number[-1:]))
    return np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in pairs])
