"""Bilinear look-ups between the nodes of a structured surface.

Every component is its own array: one gather of scalars costs a tenth of a gather of short rows, and
look-ups are most of what tracing does.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Bools, Bytes, Indices
from flowtex.field import FlowField
from flowtex.field.grids.poles import Poles

#: Cells that rounding may carry a path over a border that it follows.
BORDER_ROUNDING_CELLS = 1e-6
#: Cells that a particle may move at once: where nothing is blanked, and next to a blanked cell.
MOST_ROOM_CELLS, LEAST_ROOM_CELLS = 4, 1


class Corners(NamedTuple):
    """Where particles lie: lower corner of the cell, and the fractions along i and j, (N,)."""

    at: Indices
    s: AnyArray
    t: AnyArray


class NodeGrid:
    """The nodes of a surface in index space, (J, I), continued beyond its poles.

    ``cells`` (J - 1, I - 1) are those that are not blanked.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        periodic: tuple[bool, bool],
        cells: Bools,
        poles: Poles | None = None,
    ) -> None:
        self.rows, self.columns = shape
        self.periodic = periodic
        self.poles = poles
        # One entry for each lower corner, so that Corners.at finds it.
        self._open = None if cells.all() else np.pad(cells, ((0, 1), (0, 1))).ravel()

    @classmethod
    def of(cls, field: FlowField) -> NodeGrid:
        """Make the grid of a field's nodes."""
        surface = field.surface
        return NodeGrid(field.shape, field.periodic, surface.cells, surface.poles)

    @property
    def size(self) -> int:
        """Number of nodes."""
        return self.rows * self.columns

    @cached_property
    def endless(self) -> bool:
        """Whether no path can leave the domain: there are neither borders nor blanked cells."""
        borders = {axis for axis, closed in enumerate(self.periodic) if not closed}
        if self.poles is not None and self.poles.both:
            borders -= {1 - self.poles.component}
        return self._open is None and not borders

    def corners(self, position: AnyArray) -> Corners:
        """Return the cells of positions (2, N); those beyond a border are moved onto it."""
        if self.poles is not None:
            position = self.poles.fold(position)
        i, s = _cell(position[0], self.columns - 1, closed=self.periodic[1])
        j, t = _cell(position[1], self.rows - 1, closed=self.periodic[0])
        j *= self.columns
        j += i
        return Corners(j, s, t)

    @cached_property
    def room(self) -> Bytes:
        """Cells that a particle may move at once from each cell, (J * I,), 0 if it is blanked.

        In longer steps it might pass a blanked cell unnoticed.
        """
        shape = (self.rows, self.columns)
        if self._open is None:
            return np.full(self.size, MOST_ROOM_CELLS, np.uint8)
        around = MOST_ROOM_CELLS
        cells = self._open.reshape(shape)[:-1, :-1]
        for axis, closed in enumerate(self.periodic):
            width = [(around * (a == axis),) * 2 for a in range(2)]
            cells = np.pad(cells, width, mode="wrap" if closed else "edge")
        far = scipy.ndimage.distance_transform_cdt(cells, "chessboard")[
            around:-around, around:-around
        ]
        room = np.minimum(far, MOST_ROOM_CELLS)
        return np.pad(room, ((0, 1), (0, 1))).astype(np.uint8).ravel()

    def room_at(self, position: AnyArray) -> AnyArray | int:
        """Return the cells that particles at positions (2, N) may move at once, for all or (N,)."""
        if self._open is None:
            return MOST_ROOM_CELLS
        return np.maximum(self.room[self.corners(position).at], LEAST_ROOM_CELLS)

    def blend(self, data: AnyArray, corners: Corners, base: Indices | int = 0) -> AnyArray:
        """Interpolate nodal data of consecutive sets, (sets * J * I,).

        The set of each particle begins at index ``base``.
        """
        at, first = (corners.at + base, 0) if np.ndim(base) else (corners.at, int(base))
        # Products of complex numbers with complex ones are several times as fast.
        s, t = (share.astype(data.dtype, copy=False) for share in (corners.s, corners.t))
        low = _between(data[first:], at, s)
        high = _between(data[first + self.columns :], at, s)
        high -= low
        high *= t
        high += low
        return high

    def alive(self, position: AnyArray, edge: float = BORDER_ROUNDING_CELLS) -> Bools:
        """Return whether positions (2, N) are inside the domain, in a cell that is not blanked.

        ``edge`` cells beyond a border still count as inside.
        """
        result = np.ones(position.shape[1], dtype=bool)
        if self.poles is not None:
            position = self.poles.fold(position)
        for x, cells, closed in zip(
            position, (self.columns - 1, self.rows - 1), self.periodic[::-1], strict=True
        ):
            if not closed:
                result &= (x >= -edge) & (x <= cells + edge)
        if self._open is not None:
            result &= self._open[self.corners(position).at]
        return result


def _cell(x: AnyArray, cells: int, *, closed: bool) -> tuple[Indices, AnyArray]:
    """Return the number of the cell along one axis, and the fraction inside it."""
    if closed:
        inside = x - cells * np.floor(x * x.dtype.type(1 / cells))
        # Rounding can leave the result outside, by more the further away the position is.
        np.clip(inside, 0, cells, out=inside)
    else:
        inside = np.clip(x, 0, cells)
    number = inside.astype(np.intp)
    np.minimum(number, cells - 1, out=number)
    inside -= number.astype(x.dtype)
    return number, inside


def _between(data: AnyArray, at: Indices, s: AnyArray) -> AnyArray:
    """Interpolate between each node and the next one along i."""
    # The indices are in range by construction; "clip" only spares NumPy's own check.
    low = data.take(at, mode="clip")
    high = data[1:].take(at, mode="clip")
    high -= low
    high *= s
    high += low
    return high
