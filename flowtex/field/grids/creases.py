"""Sharp angles between neighbouring cells of a structured surface."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.arrays import cross, dot, row_blocks
from flowtex.field.triangles.sharp_edges import SHARP_EDGE


def has_creases(points: Floats, cells: Bools, closes: tuple[bool, bool]) -> bool:
    """Return whether a line of sides at which neighbouring cells lie at a sharp angle parts faces.

    Two such sides at a node, or one at the border, are a line. A single side between
    other nodes ends in a surface that goes around it.

    Parameters
    ----------
    points
        Nodes, (J, I, 3).
    cells
        Cells that are drawn, (J - 1, I - 1).
    closes
        Whether the last line of nodes along (j, i) lies on the first one.
    """
    normals = _normals(points, cells)
    sides = np.zeros(points.shape[:2], dtype=np.int8)  # sharp ones at each node
    for axis in (0, 1):
        lines = np.swapaxes(sides, 0, axis)
        sharp = _sharp_sides(np.swapaxes(normals, 0, axis), closes=closes[axis])
        lines[:, :-1] += sharp
        lines[:, 1:] += sharp
    if not sides.any():
        return False
    for axis in (0, 1):
        cells = _with_ends(cells, axis, closes=closes[axis])
    corners = cells[:-1, :-1], cells[:-1, 1:], cells[1:, :-1], cells[1:, 1:]
    at_border = ~np.logical_and.reduce(corners)
    return bool((sides + at_border > 1).any())


def _normals(points: Floats, cells: Bools) -> Floats:
    """Return unit normals of cells, (J - 1, I - 1, 3), zero for those that are not drawn."""
    normals = np.zeros((*cells.shape, 3))
    for rows in row_blocks(*cells.shape):
        before = points[:-1][rows]
        after = points[1:][rows]
        across = cross(after[:, 1:] - before[:, :-1], after[:, :-1] - before[:, 1:])
        length = np.sqrt(dot(across, across))[..., None]
        is_solid = (length > 0) & cells[rows][..., None]
        np.divide(across, length, out=normals[rows], where=is_solid)
    return normals


def _sharp_sides(normals: Floats, *, closes: bool) -> Bools:
    """Return which sides along each line of nodes, (J, I - 1), are sharp."""
    lines = _with_ends(normals, 0, closes=closes)
    is_drawn = dot(lines, lines) > 0.5
    is_sharp = dot(lines[:-1], lines[1:]) < SHARP_EDGE
    return np.asarray(is_drawn[:-1] & is_drawn[1:] & is_sharp)


def _with_ends(values: AnyArray, axis: int, *, closes: bool) -> AnyArray:
    """Return values of cells with those beyond both ends of an axis, or zero."""
    width = [(0, 0)] * values.ndim
    width[axis] = (1, 1)
    if closes:
        return np.pad(values, width, mode="wrap")
    return np.pad(values, width)
