"""The fold of tripolar grids: their last row meets itself, the other way around.

It lies on the fold, where each node of it is there twice, or half a cell beside it.
"""

from __future__ import annotations

import numpy as np
import scipy

from flowtex._util.array_types import Floats, Indices
from flowtex.sources.datasets.coordinates import Places

#: Most nodes of a grid whose fold is joined, as it becomes triangles.
MOST_FOLDED = 2_000_000
#: Distance of nodes across a fold, in steps to it, up to which cells go on there.
NEAR = 1.5
#: Distance of two nodes, in steps, up to which they are one.
SAME_NODE = 0.01
#: Share of the nodes of a row that must have their neighbour where the fold has it.
AGREEING = 0.6
#: Fewest columns of a grid with a fold.
FEWEST = 16


def is_joined(places: Places) -> bool:
    """Return whether a grid is small enough for its fold to be joined."""
    return places.a.size <= MOST_FOLDED


def folded_columns(places: Places) -> Indices | None:
    """Return the column that each node of the last row meets across a fold; ``None`` without one.

    A grid of lines has no fold.
    """
    rows, columns = places.a.shape
    if not places.is_earth or places.is_line or rows < 3 or columns < FEWEST:
        return None
    below, last = places.part(np.s_[-2:]).positions
    step = last - below
    length = np.linalg.norm(step, axis=-1)
    known = np.flatnonzero(np.isfinite(last + step).all(axis=-1) & (length > 0))
    if len(known) < FEWEST:
        return None
    # Repeated columns are one.
    count = columns
    if np.linalg.norm(last[0] - last[-1]) < SAME_NODE * length[known].mean():
        count -= 1
    found = _mirrored(last, step, length, known[known < count])
    sums, votes = np.unique(found.sum(axis=0) % count, return_counts=True)
    if not len(votes) or votes.max() < AGREEING * (known < count).sum():
        return None
    return (sums[np.argmax(votes)] - np.arange(columns)) % count


def _mirrored(last: Floats, step: Floats, length: Floats, known: Indices) -> Indices:
    """Return columns of the last row and those nearest to them across the fold, (2, N)."""
    tree = scipy.spatial.cKDTree(last[known])
    pairs = []
    for target, most in ((last, SAME_NODE), (last + step, NEAR / 2)):
        distance, near = map(np.asarray, tree.query(target[known], k=2))
        other = known[near]
        # A node on the fold is its own nearest neighbour, and the second one is its copy.
        number = (other[:, 0] == known).astype(int)
        rows = np.arange(len(known))
        chosen = other[rows, number]
        close = distance[rows, number] <= most * length[known]
        pairs.append(np.stack([known[close], chosen[close]]))
    on_fold, beside = pairs
    if len(on_fold[0]) > len(beside[0]) / 2:
        return on_fold
    return beside


def cells_across(nodes: Indices, mirrored: Indices) -> Indices:
    """Return the corners of cells between the last row and itself, (N, 4), of numbers (J, I)."""
    last = nodes[-1]
    beyond = last[mirrored]
    corners = np.stack([last[:-1], last[1:], beyond[1:], beyond[:-1]], axis=-1)
    # Each cell would be there twice.
    first = last[:-1] < beyond[1:]
    return corners[first & (corners[:, 0] != corners[:, 3])]


def merged_nodes(positions: Floats, numbers: Indices, near: float) -> Indices:
    """Return numbers of nodes, (N,), where those at one place have the number of the first."""
    own = np.arange(len(positions))
    tree = scipy.spatial.cKDTree(positions[numbers])
    pairs = tree.query_pairs(near, output_type="ndarray")
    one, other = np.sort(numbers[pairs], axis=1).T
    order = np.argsort(-one, kind="stable")
    own[other[order]] = one[order]
    return own[own]
