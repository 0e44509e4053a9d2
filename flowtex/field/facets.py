"""The triangles that a surface is drawn with, and one of them by a place in index space.

Every renderer cuts a cell along the diagonal from its first corner (j, i) to (j + 1, i + 1), and
what lies between the nodes is linear in the two triangles. Whoever reads a value at a place of the
picture has to do the same.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.field.surface import Surface

__all__ = ["HALVES", "Facet", "facet"]

Floats = NDArray[np.float64]

#: Corners of the two triangles of a cell, as (j, i) from its first corner.
HALVES = (((0, 0), (0, 1), (1, 1)), ((0, 0), (1, 1), (1, 0)))


@dataclass(frozen=True, eq=False)
class Facet:
    """A place on a triangle of the surface.

    Attributes
    ----------
    index
        The place as (j, i), folded back into one period.
    nodes
        Numbers of the three corners, (3,): j times the number of columns, plus i.
    weights
        Share of each corner, (3,); they sum to one.
    """

    index: tuple[float, float]
    nodes: NDArray[np.intp]
    weights: Floats

    def corners(self, nodal: NDArray[np.floating]) -> Floats:
        """Values at the corners of nodal data (J, I, ...), (3, ...)."""
        return np.asarray(nodal.reshape(-1, *nodal.shape[2:])[self.nodes], dtype=float)

    def mix(self, nodal: NDArray[np.floating]) -> Floats:
        """Value at the place of nodal data (J, I, ...), (...)."""
        return np.asarray(np.tensordot(self.weights, self.corners(nodal), axes=1))


def facet(surface: Surface, index: ArrayLike) -> Facet:
    """Find the triangle at a place in index space.

    Parameters
    ----------
    surface
        The surface.
    index
        (j, i) in cells. An axis that closes on itself takes any number.

    Raises
    ------
    ValueError
        When it is no pair of numbers, or lies outside the surface or in a cell that is not drawn.
    """
    at = np.asarray(index, dtype=float)
    if at.shape != (2,) or not np.isfinite(at).all():
        msg = f"the place is {index!r}; expected two finite numbers (j, i), in cells"
        raise ValueError(msg)
    j, i = (float(x) for x in surface.wrap(at[::-1])[::-1])
    rows, columns = surface.shape
    if not (0 <= j <= rows - 1 and 0 <= i <= columns - 1):
        msg = (
            f"(j, i) is ({j:g}, {i:g}), outside the surface; expected j from 0 to {rows - 1} and "
            f"i from 0 to {columns - 1}"
        )
        raise ValueError(msg)
    for row, column in product(_cells(j, rows), _cells(i, columns)):
        if surface.cells[row, column]:
            return _in_cell((j, i), row, column, columns)
    msg = (
        f"(j, i) is ({j:g}, {i:g}), in a cell with a blanked node; expected a place where the "
        "surface is drawn"
    )
    raise ValueError(msg)


def _cells(x: float, nodes: int) -> Iterator[int]:
    """Cells of one axis that a place belongs to: two, where it is on a line of nodes."""
    cell = min(int(x), nodes - 2)
    yield cell
    if x == cell and cell > 0:
        yield cell - 1


def _in_cell(index: tuple[float, float], row: int, column: int, columns: int) -> Facet:
    b, a = index[0] - row, index[1] - column
    half = HALVES[0] if a >= b else HALVES[1]
    weights = (1 - a, a - b, b) if a >= b else (1 - b, a, b - a)
    nodes = [(row + j) * columns + column + i for j, i in half]
    return Facet(index, np.array(nodes, dtype=np.intp), np.array(weights))
