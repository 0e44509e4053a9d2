"""A structured surface in space: nodes, tangents, and positions between the nodes.

Tangents at the nodes are central differences, and :meth:`GridSurface.at` interpolates with
Catmull-Rom cubics of the same slopes, so displacements in index space and in space agree to second
order however much the cells are stretched. Both use ghost lines of nodes on each side: the periodic
image, the far side of a pole, or a quadratic extrapolation where the axis ends.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.arrays import bounds, norm, row_blocks, rows_where
from flowtex.field.grids.creases import has_creases
from flowtex.field.grids.poles import Pole, Poles, find_poles
from flowtex.field.interpolation import cell_of, cubic_weights, fill_blanked
from flowtex.field.node_surface import IndexVelocity, NodeSurface, to_index_space
from flowtex.field.validation import finite_nodes

#: Corners of the two triangles of a cell, as (j, i) from its first corner.
CORNERS = np.array((((0, 0), (0, 1), (1, 1)), ((0, 0), (1, 1), (1, 0))))
#: Steps (j, i) to the cells across the edges opposite to these corners.
ACROSS = np.array((((0, 1), (0, 0), (-1, 0)), ((1, 0), (0, -1), (0, 0))))
LARGE_NODES = 200_000  #: Nodes from which the normal share is measured at some rows.
MEASURED_NODES = 50_000  #: Least nodes at which it is measured.
LEAST_ROWS = 32  #: Least rows at which it is measured.
POLE_LINES = 8  #: Lines from a pole over which the size of the cells turns into their length.


class GridSurface(NodeSurface):
    """Nodes of a structured surface, (J, I, 3), in the mesh's own units.

    ``valid`` (J, I) marks nodes that carry data. Where the (j, i) axis is ``periodic``, its last
    line of nodes is the first one again, displaced by ``offset`` on a flat map. ``on_globe`` is
    whether it lies on a globe around the origin, with north at +z.
    """

    #: Index of each corner of the cells in arrays over the nodes.
    cell_corners = tuple(product((slice(None, -1), slice(1, None)), repeat=2))

    def __init__(
        self, points: Floats, valid: Bools, periodic: tuple[bool, bool], *, on_globe: bool = False
    ) -> None:
        self.valid = valid
        self.periodic = periodic
        self.on_globe = on_globe
        #: Nodes with a known position, (J, I); the others have the position of the nearest one.
        self.has_position = known_positions(points, valid)
        self.points = fill_blanked(points, self.has_position)
        #: Displacement by one period of index j, or i, (2, 3).
        self.offset = np.stack(
            [
                np.mean(self.points[-1] - self.points[0], axis=0) * periodic[0],
                np.mean(self.points[:, -1] - self.points[:, 0], axis=0) * periodic[1],
            ]
        )

    @cached_property
    def poles(self) -> Poles | None:
        """The lines that have collapsed to a point with the surface closed around it, if any."""
        return find_poles(self.points, self.has_position, self.valid, self.periodic)

    @property
    def last_index(self) -> tuple[float, float]:
        """Greatest position (j, i) in index space."""
        return self.shape[0] - 1, self.shape[1] - 1

    def nodes_of(self, cells: Bools) -> Indices:
        """Return the nodes around some cells, (M, 4), counted row by row."""
        return faces_of(cells)

    @property
    def cell_lengths(self) -> Floats:
        """Length of each cell, (J - 1, I - 1): the diagonal of its longest sides."""
        j = norm(np.diff(self.points, axis=0))
        i = norm(np.diff(self.points, axis=1))
        longest = np.maximum(j[:, :-1], j[:, 1:]), np.maximum(i[:-1], i[1:])
        return np.asarray(np.hypot(*longest))

    @cached_property
    def least_extent(self) -> float:
        """Lower bound of the extents of cells in any direction; 0 where one has no area."""
        j = np.diff(self.points, axis=0)
        i = np.diff(self.points, axis=1)
        least = np.inf
        for up, across in product((j[:, :-1], j[:, 1:]), (i[:-1], i[1:])):
            area = norm(np.cross(up, across))[self.cells]
            length = np.hypot(norm(up), norm(across))[self.cells]
            extents = area / np.maximum(length, np.finfo(float).tiny)
            least = min(least, float(extents.min(initial=np.inf)))
        return least

    def in_cells(self, vectors: Floats) -> Floats:
        """Return vectors (J - 1, I - 1, 3) as they are: a cell need not be flat."""
        return vectors

    @property
    def is_closed(self) -> bool:
        """Whether all nodes have positions, and lines collapse to poles at both ends."""
        return bool(self.has_position.all()) and len(tuple(self.poles or ())) == 2

    @cached_property
    def is_folded(self) -> bool:
        """Whether some cells lie at a sharp angle to the cells beside them."""
        if self.frame is not None or self.on_globe:
            return False
        return has_creases(self.points, self.cells, self.closes)

    @cached_property
    def drawn(self) -> Indices:
        """Numbers of the triangles that are drawn: two of each cell, along its first diagonal."""
        first = 2 * np.flatnonzero(self.cells)
        return np.stack([first, first + 1], axis=-1).ravel()

    def is_drawn(self, number: Indices) -> Bools:
        """Return whether triangles (N,) are drawn."""
        return np.asarray(self.cells.ravel()[number >> 1])

    def corners_of(self, number: Indices) -> Indices:
        """Return nodes (N, 3) at the corners of triangles (N,), counted row by row."""
        row, column = np.divmod(number >> 1, self.shape[1] - 1)
        j, i = np.moveaxis(CORNERS[number & 1], -1, 0)
        return np.asarray((row[:, None] + j) * self.shape[1] + column[:, None] + i)

    def cells_of(self, number: Indices) -> Indices:
        """Return the first nodes of the cells of triangles (N,), counted row by row."""
        return self.corners_of(number)[:, 0]

    def beside(self, number: Indices, corner: int) -> Indices:
        """Return triangles (N,) across the edges opposite to a corner, -1 at a border."""
        lines = self.shape[0] - 1, self.shape[1] - 1
        cell = [*np.divmod(number >> 1, lines[1])]
        outside = np.zeros(len(number), dtype=bool)
        for axis, count in enumerate(lines):
            neighbour = cell[axis] + ACROSS[number & 1, corner, axis]
            if not self.closes[axis]:
                outside |= (neighbour < 0) | (neighbour >= count)
            cell[axis] = neighbour % count
        return np.where(outside, -1, 2 * (cell[0] * lines[1] + cell[1]) + 1 - (number & 1))

    def index_of(self, number: Indices, weights: Floats) -> Floats:
        """Return positions (N, 2) as (i, j) of shares (N, 3) of corners of triangles (N,)."""
        place = np.einsum("nk,nkc->nc", weights, CORNERS[number & 1])
        return np.asarray(place + np.stack(np.divmod(number >> 1, self.shape[1] - 1), -1))[:, ::-1]

    def triangle_at(self, index: Floats) -> tuple[Floats, int, Floats] | None:
        """Return a position (j, i) within one period, its drawn triangle, and shares of corners."""
        i, j = map(float, self.wrap(index[::-1]))
        rows, columns = self.shape
        inside = 0 <= j <= rows - 1 and 0 <= i <= columns - 1
        for row, column in product(_cells_at(j, rows), _cells_at(i, columns)):
            if inside and self.cells[row, column]:
                b = j - row
                a = i - column
                number = 2 * (row * (columns - 1) + column) + int(a < b)
                if a >= b:
                    shares = (1 - a, a - b, b)
                else:
                    shares = (1 - b, a, b - a)
                return np.array([j, i]), number, np.array(shares)
        return None

    @cached_property
    def padded(self) -> Floats:
        """Nodes with one ghost line on each side, (J + 2, I + 2, 3)."""
        good = self.has_position
        padded = np.empty((self.shape[0] + 2, self.shape[1] + 2, 3))
        rows = padded[:, 1:-1]
        columns = np.swapaxes(padded, 0, 1)
        rows[1:-1] = self.points
        rows[0], rows[-1] = _ghosts(rows[1:-1], good, self.offset[0], periodic=self.periodic[0])
        good = np.pad(good, ((1, 1), (0, 0)), mode="edge").T
        ghosts = _ghosts(columns[1:-1], good, self.offset[1], periodic=self.periodic[1])
        columns[0], columns[-1] = ghosts
        for pole in self.poles or ():
            lines = pole.lines(padded)
            if pole.inward > 0:
                ghost = 0
                ring = 2
            else:
                ghost = -1
                ring = -3
            lines[ghost] = _over(lines[ring], pole)
        return padded

    @cached_property
    def tangents(self) -> Floats:
        """Derivatives of position by i and by j at the nodes, (2, J, I, 3), per cell."""
        return self._tangents_of(slice(None))

    def _tangents_of(self, rows: slice) -> Floats:
        """Return the tangents of some rows of nodes."""
        good = np.pad(self.has_position, 1, constant_values=True)
        p = self.padded
        middle = p[1:-1, 1:-1][rows]
        result = np.empty((2, *middle.shape))
        sides = (
            (p[1:-1, :-2], p[1:-1, 2:], good[1:-1, :-2], good[1:-1, 2:]),
            (p[:-2, 1:-1], p[2:, 1:-1], good[:-2, 1:-1], good[2:, 1:-1]),
        )
        for out, (before, after, known, further) in zip(result, sides, strict=True):
            near = before[rows]
            far = after[rows]
            good_near = known[rows]
            good_far = further[rows]
            for b in row_blocks(*middle.shape[:2]):
                _difference(near[b], middle[b], far[b], good_near[b], good_far[b], out[b])
        return fill_blanked(result, self.has_position[rows], axis=1)

    def express(self, velocity: Floats) -> IndexVelocity:
        """Express a velocity (T, J, I, 3), zero at nodes that are not valid, in index space."""
        return to_index_space(self.tangents, self.valid, self.poles, velocity)

    @property
    def is_large(self) -> bool:
        """Whether :meth:`normal_share` represents all of the surface well."""
        return self.valid.size > LARGE_NODES

    def normal_share(self, velocity: Floats) -> float:
        """Return the normal share of a velocity (T, J, I, 3), sampled at some rows of nodes."""
        apart = min(self.valid.size // MEASURED_NODES, self.shape[0] // LEAST_ROWS)
        rows = slice(0, None, max(apart, 1))
        if not self.valid[rows].any():
            return self.express(velocity).normal_share
        tangents = self._tangents_of(rows)
        return to_index_space(tangents, self.valid[rows], None, velocity[:, rows]).normal_share

    @cached_property
    def cell_size(self) -> Floats:
        """Smooth measure of the size of the cells around each node, (J, I).

        The smaller extent dominates, but towards a pole, where cells have no width, their length.
        """
        inverse = np.zeros(self.shape)
        lengths = np.sqrt(np.einsum("djic,djic->dji", self.tangents, self.tangents))
        known = lengths
        if not self.valid.all():
            known = lengths[:, self.valid]
        typical = float(np.median(known)) or 1.0
        for pole in self.poles or ():
            near = np.maximum(
                1 - np.abs(np.arange(self.shape[1 - pole.component]) - pole.line) / POLE_LINES, 0
            )
            if pole.component:
                share = near[:, None]
            else:
                share = near
            lengths[1 - pole.component] = np.hypot(
                lengths[1 - pole.component], share * lengths[pole.component]
            )
        for length in lengths:
            inverse += 1 / np.square(np.maximum(length, 1e-9 * typical))
        return np.maximum(np.sqrt(2.0 / inverse), 1e-4 * typical)

    def node_near(self, index: Sequence[float]) -> tuple[int, int]:
        """Return the node (j, i) next to a position (j, i)."""
        j, i = index
        rows, columns = self.shape
        return min(round(float(j)), rows - 1), min(round(float(i)), columns - 1)

    def wrap(self, index: Floats) -> Floats:
        """Return positions in index space, (..., 2) as (i, j), within one period and the poles."""
        folded = index.copy()
        if self.poles is not None:
            folded = self.poles.fold(index.reshape(-1, 2).T).T.reshape(index.shape).copy()
        for component, axis in ((0, 1), (1, 0)):
            if self.periodic[axis]:
                folded[..., component] = np.mod(folded[..., component], self.shape[axis] - 1)
        return folded

    def at(self, index: Floats) -> Floats:
        """Return positions in space (..., 3) of positions (..., 2) as (i, j) in index space.

        Beyond a pole the surface continues on its far side, and straight on beyond the border of
        another axis that does not close.
        """
        i, j = index.reshape(-1, 2).T
        return self._positions.at(i, j).T.reshape(*index.shape[:-1], 3)

    @cached_property
    def _positions(self) -> CubicMap:
        return CubicMap(self, np.eye(3), np.zeros(3))


class CubicMap:
    """Positions of a surface relative to ``origin`` (3,), along the rows of ``frame`` (C, 3).

    For millions of look-ups each coordinate is a separate array. Catmull-Rom's cubic is the line
    between two nodes, and -s (1 - s) / 2 times that between their second differences, which are not
    looked up where they are too small to matter.

    Parameters
    ----------
    surface
        Surface of J x I nodes; nodes without a position have a finite one nearby.
    frame
        C unit vectors, (C, 3), along which positions are given.
    origin
        Point in space, (3,), from which positions are measured.
    dtype
        Type of the numbers.
    """

    def __init__(
        self, surface: GridSurface, frame: Floats, origin: Floats, dtype: type = np.float64
    ) -> None:
        self._shape = surface.shape
        self._periodic = surface.periodic
        self._poles = surface.poles
        local = np.moveaxis(surface.tangents @ frame.T, -1, 0)
        #: Tangents by component, (C, 2, J * I).
        self.tangents: AnyArray = np.ascontiguousarray(local, dtype).reshape(len(frame), 2, -1)
        self._offset: AnyArray = (surface.offset @ frame.T).astype(dtype)
        nodes = np.moveaxis((surface.padded - origin) @ frame.T, -1, 0)
        # Beside a node without a position the surface is straight.
        known = np.pad(surface.has_position, 1, mode="edge")
        by_i = np.diff(nodes, 2, axis=2) * (known[:, 2:] & known[:, 1:-1] & known[:, :-2])
        by_j = np.diff(nodes, 2, axis=1) * (known[2:] & known[1:-1] & known[:-2])
        by_both = np.diff(by_i, 2, axis=1)
        #: Nodes, and their second differences by i, by j, and by both, (C, J * I) each.
        self._parts: list[AnyArray] = []
        for part in (nodes[:, 1:-1, 1:-1], by_i[:, 1:-1], by_j[:, :, 1:-1], by_both):
            self._parts.append(np.ascontiguousarray(part, dtype).reshape(len(frame), -1))
        #: Greatest shifts of a point in a cell by the second differences, (C,) each: s (1 - s) / 2
        #: is at most 1/8, and for both axes 1/64.
        self._most: list[AnyArray] = []
        for part, most in zip(self._parts[1:], (1 / 8, 1 / 8, 1 / 64), strict=True):
            self._most.append(np.abs(part).max(axis=1, initial=0) * most)

    @property
    def nodes(self) -> AnyArray:
        """Positions of the nodes, (C, J * I)."""
        return self._parts[0]

    def at(
        self, i: AnyArray, j: AnyArray, start: tuple[Any, Any] = (0, 0), error: float = 0.0
    ) -> AnyArray:
        """Return positions (C, N) at (N,) each in cells from the nodes ``start``, to an error."""
        rows, columns = self._shape
        closed_j, closed_i = self._periodic
        if self._poles is not None:
            position = np.stack([i + start[0], j + start[1]])
            folded = self._poles.fold(position)
            if folded is not position:
                i, j = (folded - np.stack(np.broadcast_arrays(*start, i)[:2])).astype(i.dtype)
        i0, s, beyond_i, turns_i = cell_of(i, columns, periodic=closed_i, start=start[0])
        j0, t, beyond_j, turns_j = cell_of(j, rows, periodic=closed_j, start=start[1])
        result = self._cubic(j0 * columns + i0, s, t, error)
        outside = np.flatnonzero((beyond_i != 0) | (beyond_j != 0))
        if len(outside):
            node_i = i0[outside] + np.rint(s[outside]).astype(np.intp)
            node_j = j0[outside] + np.rint(t[outside]).astype(np.intp)
            by_i, by_j = np.moveaxis(self.tangents[..., node_j * columns + node_i], 1, 0)
            result[:, outside] += beyond_i[outside] * by_i + beyond_j[outside] * by_j
        for turns, offset in ((turns_j, self._offset[0]), (turns_i, self._offset[1])):
            if offset.any():
                result += turns * offset[:, None]
        return result

    def _cubic(self, at: Indices, s: AnyArray, t: AnyArray, error: float) -> AnyArray:
        """Interpolate between 16 nodes each, given the lower corners and fractions of the cells."""
        a = 0.5 * s * (s - 1)
        b = 0.5 * t * (t - 1)
        shares = (a, b, a * b)
        result = np.empty((len(self.nodes), len(at)), s.dtype)
        for c, out in enumerate(result):
            bends = []
            for part, share, most in zip(self._parts[1:], shares, self._most, strict=True):
                if most[c] > error:
                    bends.append((part[c], share))
            corners = []
            for first in (0, 1, self._shape[1], self._shape[1] + 1):
                value = self.nodes[c, first:].take(at, mode="clip")
                for part, share in bends:
                    value += share * part[first:].take(at, mode="clip")
                corners.append(value)
            low, right, high, across = corners
            low += s * (right - low)
            high += s * (across - high)
            np.add(low, t * (high - low), out=out)
        return result


def faces_of(cells: Bools) -> Indices:
    """Return the nodes around some cells (J - 1, I - 1) of a grid, (M, 4), counted row by row."""
    columns = cells.shape[1] + 1
    j, i = np.nonzero(cells)
    first = j * columns + i
    return np.stack([first, first + 1, first + columns + 1, first + columns], axis=-1)


def known_positions(points: Floats, valid: Bools) -> Bools:
    """Return nodes with trusted coordinates; blanked ones often hold a fill value."""
    finite = finite_nodes(points)
    # If all nodes with coordinates are valid, or none, nothing has to be distinguished.
    if not (valid & finite).any() or not (finite & ~valid).any():
        return finite
    low, high = bounds(rows_where(points, valid & finite))
    margin = (high - low).max()
    with np.errstate(invalid="ignore"):
        near = ((points > low - margin) & (points < high + margin)).all(axis=-1)
    return np.asarray(finite & (valid | near))


def _ghosts(p: Floats, good: Bools, offset: Floats, *, periodic: bool) -> tuple[Floats, Floats]:
    if periodic:
        return p[-2] - offset, p[1] + offset
    return _beyond(p[:3], good[:3]), _beyond(p[:-4:-1], good[:-4:-1])


def _over(ring: Floats, pole: Pole) -> Floats:
    """Return the line beyond a pole, (n + 3, 3), from that before it; both with ghost nodes."""
    opposite = pole.opposite(np.arange(pole.cells, dtype=float))
    k, s = np.divmod(opposite, 1.0)
    first = k.astype(np.intp)
    nodes = ring[1:-2]
    line = np.zeros((pole.cells, 3))
    for n, weights in enumerate(cubic_weights(s)):
        line += weights[:, None] * nodes[(first + n - 1) % pole.cells]
    return line[np.arange(-1, pole.cells + 2) % pole.cells]


def _cells_at(position: float, lines: int) -> list[int]:
    """Return the cells along an axis at a position: two at a line of nodes, the later one first."""
    return sorted({min(int(position), lines - 2), max(math.ceil(position) - 1, 0)}, reverse=True)


def _beyond(p: Floats, good: Bools) -> Floats:
    """Return one line of nodes before the first, from the first lines.

    The continuation is quadratic, but bends the slope by half at most: through cells that grow
    threefold, a parabola turns back on itself.
    """
    step = p[1] - p[0]
    if len(p) < 3:
        return np.asarray(p[0] - step)
    bend = np.where(np.asarray(good[:3].all(axis=0))[:, None], 2 * p[1] - p[0] - p[2], 0.0)
    length = np.linalg.norm(bend, axis=-1, keepdims=True)
    most = np.linalg.norm(step, axis=-1, keepdims=True)
    bend *= most / np.maximum(np.maximum(length, most), np.finfo(float).tiny)
    return np.asarray(p[0] - step - bend)


def _difference(
    before: Floats, nodes: Floats, after: Floats, good_before: Bools, good_after: Bools, out: Floats
) -> None:
    """Write central differences, one-sided beside a node without trusted coordinates."""
    if good_before.all() and good_after.all():
        np.subtract(after, before, out=out)
        out *= 0.5
        return
    backward = np.where(good_before[..., None], nodes - before, 0.0)
    forward = np.where(good_after[..., None], after - nodes, 0.0)
    count = np.maximum(good_before.astype(float) + good_after, 1.0)
    np.divide(backward + forward, count[..., None], out=out)
