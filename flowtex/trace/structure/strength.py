"""Strengths of critical points: which of them belong to noise."""

from __future__ import annotations

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField

#: Speeds at which regions are compared, by the share of the nodes that are slower.
SHARES = np.geomspace(1e-3, 1.0, 32)


def strengths(field: FlowField, nodes: Indices, signs: Indices, steepness: Floats) -> Floats:
    """Return the strengths of critical points of a steady field as speeds, (K,).

    The strength is the change of velocity that makes a point vanish. Two points of opposite index
    vanish together once the velocity between them is changed by as much as the speed there (their
    robustness: Wang, Rosen, Skraba, Bhatia and Pascucci, 2013). So it is the least speed below
    which a region contains the point and a partner. Points of noise are pairs separated by a low
    speed. A partner may lie beyond a border: without one, the least speed below which a region
    contains the point and any other remaining one.

    ``nodes`` are nodes beside the points, counted row by row, and ``signs`` their Poincare indices.
    Where several have one partner, the steepest remain.
    """
    speed, valid = field.index_velocity.speed[0].ravel(), field.valid.ravel()
    result = np.full(len(nodes), float(speed[valid].max(initial=0.0)))
    if len(nodes) < 2:
        return result
    edges = _edges(field)
    edges = edges[valid[edges].all(axis=1)]
    needed = speed[edges].max(axis=1)
    order = np.argsort(needed)
    edges, needed = edges[order], needed[order]
    remaining, met = np.argsort(-steepness), np.zeros(len(nodes), dtype=bool)
    for level in np.quantile(speed[valid], SHARES):
        slower = edges[: int(np.searchsorted(needed, level, side="right"))]
        graph = scipy.sparse.coo_array(
            (np.ones(len(slower), bool), slower.T), shape=(speed.size, speed.size)
        )
        region = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
        regions = region[nodes[remaining]].astype(np.intp)
        paired = _paired(regions, signs[remaining])
        result[remaining[paired]] = level
        remaining, regions = remaining[~paired], regions[~paired]
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
