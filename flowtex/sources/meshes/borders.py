"""Structured surfaces that meet at their borders, as the zones of one surface do."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats

if TYPE_CHECKING:
    import pyvista as pv

#: Distance of two nodes, as a share of the extent of the blocks, up to which they are the same.
SAME_NODE_SHARE = 1e-6
#: Fewest nodes that two neighbours have in common.
FEWEST_COMMON = 2


def meet(blocks: list[Any]) -> bool:
    """Return whether each structured surface has two nodes of its border in common with another.

    Surfaces that overlap, such as those of overset grids, do not merely meet: they have nodes in
    common that are not on the borders of both.
    """
    borders = [_on_border(block) for block in blocks]
    if any(border is None for border in borders):
        return False
    points = np.concatenate([np.asarray(block.points, dtype=float) for block in blocks])
    on_border = np.concatenate([border for border in borders if border is not None])
    numbers = np.repeat(np.arange(len(blocks)), [block.n_points for block in blocks])
    near = _tolerance(points)
    if not np.isfinite(near):
        return False
    common = np.zeros(len(blocks), dtype=int)
    for number in range(len(blocks)):
        own = numbers == number
        others = scipy.spatial.cKDTree(points[~own])
        distance, nearest = others.query(points[own], distance_upper_bound=near)
        found = np.isfinite(np.asarray(distance))
        theirs = on_border[~own][np.asarray(nearest)[found]]
        if not (on_border[own][found].all() and theirs.all()):
            return False
        common[number] = found.sum()
    return bool((common >= FEWEST_COMMON).all())


def joined(whole: pv.UnstructuredGrid) -> pv.UnstructuredGrid:
    """Return blocks as one mesh; nodes at the same place become one, with the means of values."""
    near = _tolerance(np.asarray(whole.points, dtype=float))
    return whole.clean(tolerance=near, average_point_data=True, remove_unused_points=False)


def _tolerance(points: Floats) -> float:
    """Return the distance up to which two nodes are the same."""
    return SAME_NODE_SHARE * float(np.ptp(points, axis=0).max())


def _on_border(block: Any) -> Bools | None:
    """Return which nodes of a structured surface are on its border; ``None`` for other meshes."""
    import pyvista as pv

    if not isinstance(block, (pv.StructuredGrid, pv.RectilinearGrid, pv.ImageData)):
        return None
    if block.max_cell_dimensionality != 2:
        return None
    inside = np.zeros(block.dimensions[::-1], dtype=bool)
    core = [slice(1, -1) if count > 1 else slice(None) for count in inside.shape]
    inside[tuple(core)] = True
    return ~inside.ravel()
