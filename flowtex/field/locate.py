"""Points of a surface: the one at a position in index space, and the one nearest to a point.

Values are linear in the triangles that renderers draw, and bilinear in cells that are
parallelograms, in space or, on every map, in longitude and latitude.

To find a point in space, the triangles with the nearest middles are looked up in a tree. From them
a walk leads over the surface, across the side on which the point lies as long as that leads nearer:
of cells thousands of times longer than wide, the nearest middle may be that of another one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from flowtex._util.arguments import brief, check_field, checked_array
from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex._util.cache import WeakCache
from flowtex.errors import FieldError
from flowtex.field.derived.gradient import true_positions
from flowtex.field.earth.projection import EARTH_RADIUS, GLOBE, Projection
from flowtex.field.field_data import FieldData
from flowtex.field.triangles.triangle_nodes import solid_triangles
from flowtex.field.triangles.triangle_surface import Surface

STARTS = 12  #: Number of triangles around a point at which walks begin.
#: Number of triangles that are tried where these lead nowhere, as between those around a pole.
MOST_TRIED = 4000
WALK_STEPS = 96  #: Most triangles in a walk.
FLAT_TRIANGLE = 1e-20  #: Height of a triangle over a side, squared, below which it has no area.
CURVED_TOLERANCE = 0.1  #: Tolerance in cells for points on a curved surface.
FLAT_TOLERANCE = 1e-6  #: Tolerance in cells for points on a flat surface.
EARTH_TOLERANCE = 1e-4  #: Tolerance in cells on the Earth, for inverse projections.
EARTH_SKEW = 1e-3  #: Greatest deviation from a parallelogram of a bilinear cell on the Earth.
FARTHEST = 1e100  #: Largest coordinate of a place, whose square is finite.
MOST_CELLS = 8  #: Most candidate cells for a place.
ROUNDING = 1e-9  #: Tolerance for rounding, as a share of a cell.
POLE_LATITUDE = 90 - 1e-6  #: Latitude from which on a node has the longitude of the one beside it.
EARTH = Projection(GLOBE)  #: The globe on which places of the Earth are looked up.


@dataclass(frozen=True, eq=False)
class SurfacePoint:
    """A point in a triangle, or a cell, of the surface."""

    index: tuple[float, float]  #: The point as (j, i), folded back into one period.
    nodes: Indices  #: Numbers of the K corners, (K,): j times the number of columns plus i.
    weights: Floats  #: Their shares, (K,).
    cell: int  #: Number of the cell in scalars that belong to cells: of a node, or of a triangle.

    def corners(self, nodal: AnyArray) -> Floats:
        """Return values at the corners, (K, ...), of nodal data (J, I, ...)."""
        return np.asarray(nodal.reshape(-1, *nodal.shape[2:])[self.nodes], dtype=float)

    def interpolate(self, nodal: AnyArray) -> Floats:
        """Return the value at the point, (...), of nodal data (J, I, ...)."""
        return np.asarray(np.tensordot(self.weights, self.corners(nodal), axes=1))


def surface_point(surface: Surface, index: ArrayLike) -> SurfacePoint:
    """Return the point of a surface at (j, i) in cells; a closed axis takes any number.

    Parameters
    ----------
    surface
        The surface.
    index
        Row and column with their fractions, (2,).

    Raises
    ------
    FieldError
        When the index is not two finite numbers, or lies outside of the drawn surface.
    """
    expected = "two finite numbers (j, i), in cells"
    at = checked_array("index", index, expected=expected)
    if at.shape != (2,) or not np.isfinite(at).all():
        raise FieldError(f"index is {brief(index)}; expected {expected}")
    found = surface.triangle_at(at)
    if found is None:
        last_j, last_i = surface.last_index
        raise FieldError(
            f"(j, i) is ({at[0]:g}, {at[1]:g}), not on the drawn surface; expected j from 0 to "
            f"{last_j:g} and i from 0 to {last_i:g}, in a cell without blanked nodes"
        )
    place, number, weights = found
    nodes = surface.corners_of(np.array([number]))[0]
    cell = int(surface.cells_of(np.array([number]))[0])
    return SurfacePoint((float(place[0]), float(place[1])), nodes, weights, cell)


def value_point(field: FieldData, index: ArrayLike) -> SurfacePoint:
    """Return the point at (j, i) with its cell where that is a parallelogram, else its triangle."""
    point = surface_point(field.surface, index)
    if field.triangles is None:
        cell = divmod(int(point.nodes[0]), field.shape[1])
        nodes = _cell_nodes(field, cell)
        if not _is_skew(field, _places(field, nodes)):
            t = point.index[0] - cell[0]
            s = point.index[1] - cell[1]
            weights = np.array([(1 - t) * (1 - s), (1 - t) * s, t * (1 - s), t * s])
            return SurfacePoint(point.index, nodes, weights, int(nodes[0]))
    return point


def _cell_nodes(field: FieldData, cell: Any) -> Indices:
    first = cell[0] * field.shape[1] + cell[1]
    return np.array([first, first + 1, first + field.shape[1], first + field.shape[1] + 1])


def _places(field: FieldData, nodes: Indices) -> Floats:
    """Return longitudes and latitudes of nodes of a cell, (K, 2), or positions, (K, 3)."""
    points = field.surface.points.reshape(-1, 3)[nodes]
    if field.projection is None:
        return np.asarray(points)
    return lonlats(field, points)


def lonlats(field: FieldData, points: Floats) -> Floats:
    """Return longitudes and latitudes of corners of a cell, (K, 2), continuous in it."""
    assert field.projection is not None
    lon, lat = map(np.array, field.projection.lonlat(points))
    if len(lat) == 4:
        is_pole = np.abs(lat) > POLE_LATITUDE
        for n in np.flatnonzero(is_pole):  # it has the longitude of a neighbour
            for neighbour in (n ^ 2, n ^ 1):
                if not is_pole[neighbour]:
                    lon[n] = lon[neighbour]
                    break
    return np.stack([lon[0] + turned(lon - lon[0]), lat], axis=-1)


def turned(lon: Any) -> Any:
    """Return longitudes in degrees, from -180 up to 180."""
    return (lon + 180.0) % 360.0 - 180.0


def _is_skew(field: FieldData, places: Floats) -> bool:
    a, b, c, d = places
    size = max(np.abs(b - a).max(), np.abs(c - a).max())
    if field.projection is None:
        skew = FLAT_TOLERANCE
    else:
        skew = EARTH_SKEW
    return not np.abs(a - b - c + d).max() <= skew * size


class Locator:
    """Search for points of one surface."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self._points = surface.points.reshape(-1, 3)
        corners = surface.corners_of(surface.drawn)
        solid = solid_triangles(self._points, corners)
        self._drawn = surface.drawn[solid]
        self._tree = scipy.spatial.cKDTree(self._points[corners[solid]].mean(axis=1))
        # A periodic axis goes around in space, or is repeated at a period's distance.
        far = np.logical_and(surface.periodic, np.logical_not(surface.closes))
        turns = [[0.0], [0.0]]
        for axis in np.flatnonzero(far):
            turns[axis] += [-1.0, 1.0]
        shifts = []
        for along_j, along_i in product(*turns):
            shifts.append(along_j * surface.offset[0] + along_i * surface.offset[1])
        self._shifts = np.stack(shifts)

    def nearest(self, points: Floats) -> tuple[Floats, Floats]:
        """Find the points of the drawn surface that are nearest to points (P, 3) in space.

        Returns them as (j, i), (P, 2), and their distances in sizes of their cell, (P,). On a flat
        map of one period, points in the periods beside it count as well.
        """
        starts = min(STARTS, len(self._drawn))
        at = (points[:, None] - self._shifts).reshape(-1, 3)
        at = np.clip(at, -FARTHEST, FARTHEST)
        near = np.reshape(self._tree.query(at, k=np.arange(1, starts + 1))[1], (-1, starts))
        best = np.full(len(at), np.inf)
        triangle = np.zeros(len(at), dtype=np.intp)
        shares = np.zeros((len(at), 3))
        for middle in near.T:
            self._try(at, np.arange(len(at)), self._drawn[middle], (best, triangle, shares))
        self._walk(at, (best, triangle, shares))
        corners = self._points[self.surface.corners_of(triangle)]
        # The diagonal of a cell is not its size.
        sides = np.sort(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1), axis=1)
        distance = (best / np.where(sides[:, 1] > 0, sides[:, 1], 1.0)).reshape(len(points), -1)
        chosen = np.argmin(distance, axis=1) + np.arange(len(points)) * len(self._shifts)
        index = self.surface.index_of(triangle[chosen], shares[chosen])
        return index[:, ::-1], distance.ravel()[chosen]

    def containing(self, point: Floats, tolerance: float) -> tuple[float, float] | None:
        """Return (j, i) of a point of the Earth, (3,), in one of the triangles around it."""
        count = min(MOST_TRIED, len(self._drawn))
        near = self._drawn[np.atleast_1d(self._tree.query(point, k=count)[1])]
        a, b, c = np.moveaxis(self._points[self.surface.corners_of(near)], 1, 0)
        shares = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=1) @ point
        shares = shares / shares.sum(axis=1, keepdims=True)
        best = int(np.argmax(shares.min(axis=1)))
        if not shares[best].min() >= -tolerance or a[best] @ point < 0:
            return None
        weights = np.clip(shares[best], 0, None)
        i, j = self.surface.index_of(near[best : best + 1], weights[None] / weights.sum())[0]
        return float(j), float(i)

    def _try(
        self,
        points: Floats,
        numbers: Indices,
        triangle: Indices,
        nearest: tuple[Floats, Indices, Floats],
    ) -> Indices:
        """Store the points that are nearer in their triangle, and return their numbers."""
        best, at, shares = nearest
        corners = self._points[self.surface.corners_of(triangle)]
        inside, far = closest(points[numbers], corners[:, 0], corners[:, 1], corners[:, 2])
        nearer = far < best[numbers]
        which = numbers[nearer]
        best[which] = far[nearer]
        at[which] = triangle[nearer]
        shares[which] = inside[nearer]
        return which

    def _walk(self, points: Floats, nearest: tuple[Floats, Indices, Floats]) -> None:
        """Continue across the sides on which points lie, as long as that leads nearer."""
        _, at, shares = nearest
        going = np.arange(len(points))
        for _ in range(WALK_STEPS):
            current = going
            before = at.copy()
            for corner in range(3):
                # On a side the opposite corner has no share.
                numbers = current[shares[current, corner] <= 0]
                beside = self.surface.beside(before[numbers], corner)
                inside = (beside >= 0) & self.surface.is_drawn(beside)
                self._try(points, numbers[inside], beside[inside], nearest)
            going = np.flatnonzero(at != before)
            if not len(going):
                break


def closest(at: Floats, a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Return shares of corners (N, 3) at nearest points of triangles, and distances, (N,).

    The distance is infinite for triangles without area.
    """
    u = b - a
    v = c - a
    w = at - a
    uu = np.einsum("nc,nc->n", u, u)
    vv = np.einsum("nc,nc->n", v, v)
    uv = np.einsum("nc,nc->n", u, v)
    wu = np.einsum("nc,nc->n", w, u)
    # By the part of v across u long triangles lose no digits.
    lean = uv / np.where(uu > 0, uu, 1.0)
    across = v - lean[:, None] * u
    height = np.einsum("nc,nc->n", across, across)
    solid = (height > FLAT_TRIANGLE * vv) & (uu > FLAT_TRIANGLE * vv)
    t = np.einsum("nc,nc->n", w, across) / np.where(solid, height, 1.0)
    s = wu / np.where(uu > 0, uu, 1.0) - lean * t
    shares = np.stack([1 - s - t, s, t], axis=-1)
    aside = np.flatnonzero((shares < 0).any(axis=-1))
    if len(aside):
        nodes = np.stack([a, b, c], axis=1)[aside]
        shares[aside] = _on_border(at[aside], nodes)
    foot = shares[:, :1] * a + shares[:, 1:2] * b + shares[:, 2:] * c
    return shares, np.where(solid, np.linalg.norm(at - foot, axis=-1), np.inf)


def _on_border(at: Floats, nodes: Floats) -> Floats:
    """Return shares of the corners (N, 3) at the nearest points of the triangles' sides."""
    best = np.full(len(at), np.inf)
    result = np.zeros((len(at), 3))
    for k, n in ((0, 1), (1, 2), (2, 0)):
        side = nodes[:, n] - nodes[:, k]
        away = at - nodes[:, k]
        length = np.maximum(np.sum(side * side, axis=-1), np.finfo(float).tiny)
        share = np.clip(np.sum(away * side, axis=-1) / length, 0.0, 1.0)
        far = np.sum((away - share[:, None] * side) ** 2, axis=-1)
        closer = far < best
        best = np.where(closer, far, best)
        result[closer] = 0.0
        result[closer, k] = 1 - share[closer]
        result[closer, n] = share[closer]
    return result


_locators: WeakCache[Locator] = WeakCache()


def locator(field: FieldData) -> Locator:
    """Return the locator of a field's surface, which is cached as long as the field lives."""
    return _locators.get("locator", lambda: Locator(field.surface), owner=field)


def locate(
    field: FieldData, point: ArrayLike, *, tolerance: float = 0.1
) -> tuple[float, float] | None:
    """Return (j, i), in cells, of a point (3,), or (2,) with z = 0, in the mesh's own coordinates.

    The result is ``None`` if the surface is farther than ``tolerance`` times the size of the
    nearest cell: another program may divide a curved cell into other triangles.

    Raises
    ------
    FieldError
        When the point is not two or three finite numbers.

    Examples
    --------
    >>> import flowtex
    >>> from flowtex.scene.probe import locate
    >>> field = flowtex.examples.double_gyre_field()  # 101 x 201 nodes on [0, 2] x [0, 1]
    >>> [round(number, 6) for number in locate(field, (0.5, 0.25))]
    [25.0, 50.0]
    """
    check_field(field, FieldData)
    expected = "two or three finite coordinates in the mesh's units"
    at = checked_array("point", point, expected=expected)
    if at.shape not in ((2,), (3,)) or not np.isfinite(at).all():
        raise FieldError(f"point is {brief(point)}; expected {expected}")
    target = np.zeros((1, 3))
    target[0, : len(at)] = at
    if field.projection is not None:
        lon, lat = map(float, field.projection.lonlat(target[0]))
        near = max(tolerance, CURVED_TOLERANCE)
        if field.projection.is_globe and locator(field).nearest(target)[1][0] > near:
            return None
        return locate_lonlat(field, lon, lat, tolerance=tolerance)
    index, distance = locator(field).nearest(target)
    if distance[0] > tolerance:
        return None
    return float(index[0, 0]), float(index[0, 1])


def locate_lonlat(
    field: FieldData, lon: float, lat: float, *, tolerance: float = EARTH_TOLERANCE
) -> tuple[float, float] | None:
    """Return (j, i), in cells, of a longitude and latitude in degrees; ``None`` outside the data.

    It is the same on every map.
    """
    if not np.isfinite([lon, lat]).all():
        return None
    found = _nearest_lonlat(field, lon, lat, tolerance)
    if found is None and field.triangles is not None:
        target = EARTH.positions(np.array(lon), np.array(lat))
        found = _earth_locator(field).containing(target, tolerance)
    return found


def _nearest_lonlat(
    field: FieldData, lon: float, lat: float, tolerance: float
) -> tuple[float, float] | None:
    """Return (j, i) of a place in the triangle to which walks lead."""
    surface = (finder := _earth_locator(field)).surface
    target = EARTH.positions(np.array(lon), np.array(lat))
    index, distance = finder.nearest(target[None])
    found = surface.triangle_at(index[0])
    if found is None or not distance[0] <= max(tolerance, CURVED_TOLERANCE):
        return None
    nodes = surface.corners_of(np.array([found[1]]))[0]
    if field.triangles is None:
        try:
            return _in_parallelogram(field, int(nodes[0]), (lon, lat), tolerance)
        except np.linalg.LinAlgError:
            pass
    # In triangles of great circles.
    corners = surface.points.reshape(-1, 3)[nodes]
    try:
        weights = np.linalg.solve(corners.T, target)
    except np.linalg.LinAlgError:  # two corners are at one point, as at a pole
        weights = np.linalg.lstsq(corners.T, target)[0]
    weights /= weights.sum()
    sag = np.ptp(corners, axis=0).max() / EARTH_RADIUS / 4
    if weights.min() < -max(tolerance, sag):
        return None
    weights = np.clip(weights, 0, None) / np.clip(weights, 0, None).sum()
    i, j = surface.index_of(np.array([found[1]]), weights[None])[0]
    return float(j), float(i)


def _earth_locator(field: FieldData) -> Locator:
    """Return the locator of a field's nodes on the globe; the locator is cached with the field."""
    if field.projection == EARTH:
        return locator(field)

    def on_globe() -> Locator:
        points = true_positions(field.surface.points, field.projection)
        return Locator(replace(field, points=points, projection=EARTH).surface)

    return _locators.get("earth", on_globe, owner=field)


def _in_parallelogram(
    field: FieldData, first: int, at: tuple[float, float], tolerance: float
) -> tuple[float, float] | None:
    """Return (j, i) of a place in a cell from a node on; LinAlgError if no parallelogram."""
    surface = field.surface
    counts = np.array(field.shape) - 1
    cell = np.array(divmod(first, field.shape[1]))
    for _ in range(MOST_CELLS):
        places = _places(field, _cell_nodes(field, cell))
        if _is_skew(field, places):
            raise np.linalg.LinAlgError
        start = places[0]
        sides = places[[2, 1]] - places[0]
        offset = np.array([turned(at[0] - start[0]), at[1] - start[1]])
        within = np.linalg.solve(sides.T, offset)
        beside = cell + np.floor(within).astype(int) * (np.abs(within - 0.5) > 0.5 + ROUNDING)
        beside = np.where(surface.periodic, beside % counts, np.clip(beside, 0, counts - 1))
        if (beside == cell).all() or not surface.cells[tuple(beside)]:
            break
        cell = beside
    inside = np.clip(within, 0, 1)
    if np.abs(within - inside).max() > tolerance:
        return None
    j, i = cell + inside
    return float(j), float(i)
