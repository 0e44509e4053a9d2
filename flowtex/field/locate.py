"""Points of a surface: the one at a position in index space, and the one nearest to a point.

On a surface of triangles a position is a triangle and shares of its corners
(:mod:`flowtex.field.triangles.surface`). On a structured one every renderer cuts a cell along the
diagonal from its first corner (j, i) to (j + 1, i + 1), and what lies between the nodes is linear
in the two triangles; so is what this module returns.

To find a point in space, the nearest nodes are looked up in a tree, which is cached with the
field. From each of them a walk leads over the cells, each step to the cell in which the point
would lie if the present one went on straight; that also finds the way over cells that are
thousands of times longer than wide, where the nearest node is no corner of the right cell. Of all
triangles on the way, the closest one counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy
from numpy.typing import ArrayLike

from flowtex._util.arguments import check_field, checked_array
from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.cache import WeakCache
from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.surface import Surface
from flowtex.field.triangles.nearest import ON_SURFACE, START_NODES, TriangleLocator, closest
from flowtex.field.triangles.surface import TriangleSurface

#: Nodes closer than this share of the surface's extent lie at one point.
SAME_POINT_SHARE = 1e-12
#: Steps of a walk, and cells along an axis that one of them goes, at most.
WALK_STEPS, STRIDE_CELLS = 24, 4
#: Squared sine of the angle between two sides of a cell, below which they are one.
FLAT_CELL = 1e-14
#: Offsets (j, i) of a cell and of those around it.
NEIGHBOURS = np.stack(np.meshgrid([-1, 0, 1], [-1, 0, 1]), axis=-1).reshape(-1, 2)
#: Corners of the two triangles of a cell, as (j, i) from its first corner.
TRIANGLES = (((0, 0), (0, 1), (1, 1)), ((0, 0), (1, 1), (1, 0)))


@dataclass(frozen=True, eq=False)
class SurfacePoint:
    """A point on a triangle of the surface.

    ``index`` is the point as (j, i), folded back into one period; ``nodes`` (3,) are the numbers of
    the corners, j times the number of columns plus i; ``weights`` (3,) are their shares.
    """

    index: tuple[float, float]
    nodes: Indices
    weights: Floats

    def corners(self, nodal: AnyArray) -> Floats:
        """Values at the corners of nodal data (J, I, ...), (3, ...)."""
        return np.asarray(nodal.reshape(-1, *nodal.shape[2:])[self.nodes], dtype=float)

    def interpolate(self, nodal: AnyArray) -> Floats:
        """Value at the point of nodal data (J, I, ...), (...)."""
        return np.asarray(np.tensordot(self.weights, self.corners(nodal), axes=1))


def surface_point(surface: Surface, index: ArrayLike) -> SurfacePoint:
    """Return the point of a surface at (j, i) in cells; an axis that closes takes any number.

    Raises a FieldError when the index is no pair of numbers, or outside the surface or in a cell
    that is not drawn.
    """
    expected = "two finite numbers (j, i), in cells"
    at = checked_array("index", index, expected=expected)
    if at.shape != (2,) or not np.isfinite(at).all():
        msg = f"index is {index!r}; expected {expected}"
        raise FieldError(msg)
    if isinstance(surface, TriangleSurface):
        return _in_triangle(surface, at)
    j, i = (float(x) for x in surface.wrap(at[::-1])[::-1])
    rows, columns = surface.shape
    if not (0 <= j <= rows - 1 and 0 <= i <= columns - 1):
        msg = (
            f"(j, i) is ({j:g}, {i:g}), outside the surface; expected j from 0 to {rows - 1} and "
            f"i from 0 to {columns - 1}"
        )
        raise FieldError(msg)
    for row, column in product(_cells(j, rows), _cells(i, columns)):
        if surface.cells[row, column]:
            return _in_cell((j, i), row, column, columns)
    msg = (
        f"(j, i) is ({j:g}, {i:g}), in a cell with a blanked node; expected a point where the "
        "surface is drawn"
    )
    raise FieldError(msg)


def _in_triangle(surface: TriangleSurface, index: Floats) -> SurfacePoint:
    j, i = map(float, index)
    count = len(surface.triangles)
    if not (0 <= j < count and 0 <= i <= 1):
        msg = (
            f"(j, i) is ({j:g}, {i:g}), outside the surface; expected a j from 0 to {count}, the "
            "number of the triangle plus the share of its second corner, and the share of its "
            "third as i"
        )
        raise FieldError(msg)
    if not surface.cells[int(j)]:
        msg = f"(j, i) is ({j:g}, {i:g}), in a triangle with a blanked node; expected another"
        raise FieldError(msg)
    nodes, weights = surface.corners_at(np.array([i, j]))
    return SurfacePoint((j, i), nodes, weights)


def _cells(x: float, nodes: int) -> Iterator[int]:
    """Cells of one axis that a position belongs to: two on a line of nodes."""
    cell = min(int(x), nodes - 2)
    yield cell
    if x == cell and cell > 0:
        yield cell - 1


def _in_cell(index: tuple[float, float], row: int, column: int, columns: int) -> SurfacePoint:
    b, a = index[0] - row, index[1] - column
    triangle = TRIANGLES[0] if a >= b else TRIANGLES[1]
    weights = (1 - a, a - b, b) if a >= b else (1 - b, a, b - a)
    nodes = [(row + j) * columns + column + i for j, i in triangle]
    return SurfacePoint(index, np.array(nodes, dtype=np.intp), np.array(weights))


class Locator:
    """Finds points on one surface."""

    def __init__(self, surface: Surface) -> None:
        self._surface = surface
        self._nodes = surface.points.reshape(-1, 3)
        self._number = np.flatnonzero(_starts(surface))
        self._tree = scipy.spatial.cKDTree(self._nodes[self._number])
        self._last = np.array(surface.shape) - 2
        # An axis goes around in space, or ends and is repeated a period farther.
        away = np.linalg.norm(surface.offset, axis=-1) > 1e-6 * surface.extent
        self._around = np.array(surface.periodic) & ~away
        turns = [(0.0, -1.0, 1.0) if far else (0.0,) for far in away]
        self._shifts = np.stack(
            [m * surface.offset[0] + n * surface.offset[1] for m in turns[0] for n in turns[1]]
        )

    def nearest(self, points: Floats) -> tuple[Floats, Floats]:
        """Find the points of the surface as it is drawn that are nearest to points (P, 3) in space.

        Returns them as (j, i), (P, 2), and how far they are in sizes of their cell, (P,). On a flat
        map of one period, points in the periods beside it count as well.
        """
        starts = min(START_NODES, len(self._number))
        targets = (points[:, None] - self._shifts).reshape(-1, 3)
        _, nodes = self._tree.query(targets, k=np.arange(1, starts + 1))
        row, column = np.divmod(self._number[nodes.ravel()], self._surface.shape[1])
        first = np.minimum(np.stack([row, column], axis=-1), self._last)
        index, distance = self._walk(np.repeat(targets, starts, axis=0), first)
        distance = distance.reshape(len(points), -1)
        best = np.argmin(distance, axis=1)
        rows = np.arange(len(points))
        return index.reshape(len(points), -1, 2)[rows, best], distance[rows, best]

    def _walk(self, at: Floats, cell: Indices) -> tuple[Floats, Floats]:
        """Walk from cells (N, 2) towards points (N, 3)."""
        index, distance = np.zeros((len(at), 2)), np.full(len(at), np.inf)
        on, cell = np.arange(len(at)), cell.copy()
        for _ in range(WALK_STEPS):
            corners = self._corners(cell[on])
            self._update(index, distance, on, cell[on], self._place(at[on], cell[on], corners))
            next_ = self._inside(cell[on] + _step(at[on], corners))
            going = (next_ != cell[on]).any(axis=-1) & (distance[on] > ON_SURFACE)
            on = on[going]
            if not len(on):
                break
            cell[on] = next_[going]
        aside = np.flatnonzero(distance > ON_SURFACE)
        if len(aside):
            known = np.isfinite(distance[aside, None])
            middle = np.where(
                known, np.minimum(index[aside].astype(np.intp), self._last), cell[aside]
            )
            self._search_around(index, distance, at, aside, middle)
        return index, distance

    def _search_around(
        self, index: Floats, distance: Floats, at: Floats, aside: Indices, middle: Indices
    ) -> None:
        """Search the cells around those (M, 2) of the points that lie beside the surface."""
        near = self._inside(middle + NEIGHBOURS[:, None]).reshape(-1, 2)
        inside, far = self._place(
            np.tile(at[aside], (len(NEIGHBOURS), 1)), near, self._corners(near)
        )
        nearest = np.argmin(far.reshape(len(NEIGHBOURS), -1), axis=0)
        best = nearest * len(aside) + np.arange(len(aside))
        self._update(index, distance, aside, near[best], (inside[best], far[best]))

    @staticmethod
    def _update(
        index: Floats, distance: Floats, some: Indices, cell: Indices, places: tuple[Floats, Floats]
    ) -> None:
        """Write those places that are closer than before."""
        inside, far = places
        closer = far < distance[some]
        index[some[closer]] = (cell + inside)[closer]
        distance[some[closer]] = far[closer]

    def _inside(self, cell: Indices) -> Indices:
        return np.where(
            self._around, np.mod(cell, self._last + 1), np.clip(cell, 0, self._last)
        ).astype(np.intp)

    def _corners(self, cell: Indices) -> Floats:
        """Nodes (j, j + 1) by (i, i + 1) of cells, (N, 2, 2, 3)."""
        columns = self._surface.shape[1]
        first = cell[:, 0] * columns + cell[:, 1]
        return np.asarray(self._nodes[first[:, None, None] + [[0, 1], [columns, columns + 1]]])

    def _place(self, at: Floats, cell: Indices, corners: Floats) -> tuple[Floats, Floats]:
        """Places (N, 2) as (j, i) in cells, and how far they are in sizes of the cell, (N,)."""
        sides = [corners[:, :, 1] - corners[:, :, 0], corners[:, 1] - corners[:, 0]]
        size = np.sqrt(np.max([np.sum(s * s, axis=-1) for s in sides], axis=(0, 2)))
        place, distance = np.zeros((len(at), 2)), np.full(len(at), np.inf)
        for triangle in TRIANGLES:
            shares, far = closest(at, *(corners[:, j, i] for j, i in triangle))
            closer = far < distance
            place[closer] = shares[closer] @ np.array(triangle, dtype=float)
            distance[closer] = far[closer]
        distance /= np.where(size > 0, size, 1.0)
        distance[~self._surface.cells[cell[:, 0], cell[:, 1]]] = np.inf
        return place, distance


def _starts(surface: Surface) -> Bools:
    """Nodes to walk from, (J, I): those of the cells that are drawn.

    Where many nodes lie at one point, those nearest to a point beside it may be on the far side;
    the nodes of the next line do better.
    """
    drawn = np.zeros(surface.shape, dtype=bool)
    one = drawn.copy()
    ends = (slice(None, -1), slice(1, None))
    for j in ends:
        for i in ends:
            drawn[j, i] |= surface.cells
    for axis in (0, 1):
        lines, same = np.swapaxes(surface.points, 0, axis), np.swapaxes(one, 0, axis)
        together = (
            np.linalg.norm(np.diff(lines, axis=0), axis=-1) <= SAME_POINT_SHARE * surface.extent
        )
        same[:-1] |= together
        same[1:] |= together
    for pole in surface.poles or ():
        pole.lines(one)[pole.line] = True
    return drawn & ~one if (drawn & ~one).any() else drawn


def _step(at: Floats, corners: Floats) -> Indices:
    """Cells from those of the corners to where points would lie if they went on straight."""
    e_j = (corners[:, 1] - corners[:, 0]).mean(axis=1)
    e_i = (corners[:, :, 1] - corners[:, :, 0]).mean(axis=1)
    away = at - corners.mean(axis=(1, 2))
    jj, ii, ij, dj, di = (
        np.einsum("nc,nc->n", a, b)
        for a, b in ((e_j, e_j), (e_i, e_i), (e_j, e_i), (away, e_j), (away, e_i))
    )
    area = jj * ii - ij * ij
    solid = area > FLAT_CELL * jj * ii
    safe = np.where(solid, area, 1.0)
    tiny = np.finfo(float).tiny
    alone = np.stack([dj / np.maximum(jj, tiny), di / np.maximum(ii, tiny)], axis=-1)
    both = np.stack([(ii * dj - ij * di) / safe, (jj * di - ij * dj) / safe], axis=-1)
    steps = np.where(solid[:, None], both, np.clip(alone, -1, 1))
    return np.asarray(np.rint(np.clip(steps, -STRIDE_CELLS, STRIDE_CELLS)), dtype=np.intp)


_locators: WeakCache[Locator | TriangleLocator] = WeakCache()


def locator(field: FlowField) -> Locator | TriangleLocator:
    """Return the locator of a field's surface, which is cached as long as the field lives."""

    def make() -> Locator | TriangleLocator:
        surface = field.surface
        if isinstance(surface, TriangleSurface):
            return TriangleLocator(surface)
        return Locator(surface)

    return _locators.get("locator", make, owner=field)


def locate(
    field: FlowField, point: ArrayLike, *, tolerance: float = 0.1
) -> tuple[float, float] | None:
    """Return (j, i), in cells, of a point (3,), or (2,) with z = 0, in the mesh's own coordinates.

    ``None`` where no surface is drawn within ``tolerance`` sizes of the nearest cell: another
    program's triangles may cut a curved cell the other way. The surface consists of triangles as
    renderers draw it, so points of a picture are exact. The first call for a field builds a tree of
    its nodes; the next ones take about a millisecond. Raises a FieldError when the point is not two
    or three finite numbers.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.probe import locate
    >>> field = flowtex.examples.double_gyre_field()  # 101 x 201 nodes on [0, 2] x [0, 1]
    >>> [round(number, 6) for number in locate(field, (0.5, 0.25))]
    [25.0, 50.0]
    """
    check_field(field, FlowField)
    expected = "two or three finite coordinates in the mesh's units"
    at = checked_array("point", point, expected=expected)
    if at.shape not in ((2,), (3,)) or not np.isfinite(at).all():
        msg = f"point is {point!r}; expected {expected}"
        raise FieldError(msg)
    whole = np.zeros((1, 3))
    whole[0, : len(at)] = at
    index, distance = locator(field).nearest(whole)
    if distance[0] > tolerance:
        return None
    return float(index[0, 0]), float(index[0, 1])
