"""Triangles on a globe or a flat map, which cuts them along its edge."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.field.earth.tears import tears
from flowtex.field.grids.grid_nodes import find_closure
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.map_poles import MeshPlaces, around_pole, open_pole, torn_poles
from flowtex.sources.maps import (
    INSIDE,
    LATITUDES,
    ROUNDED,
    data_gaps,
    projection_of,
    shown_positions,
    stretches,
)
from flowtex.sources.tripolar import (
    SAME_NODE,
    cells_across,
    folded_columns,
    is_joined,
    merged_nodes,
)

#: Greatest width of a tear, as a share of the side across it, where it may begin in a triangle.
NARROW = 0.6
OBLIQUE = "+proj=ob_tran"  #: What the definitions of maps have whose poles lie elsewhere.
HALF_TURN = 180.0  #: In degrees.
#: Halvings of a side in the search for the latitude where a map ends.
HALVINGS = 40


@dataclass(eq=False)
class MeshMap:
    """Nodes and triangles on a map, at whose edge triangles are cut."""

    projection: Projection
    points: Floats  #: (P, 3).
    triangles: Indices  #: Numbers of points, (M, 3).
    #: Number of the triangle of a mesh, or of the cell of a grid, of which each is a part, (M,).
    members: Indices
    nodes: Indices  #: Three nodes of the mesh between which each point lies, (P, 3).
    weights: Floats  #: Their shares, (P, 3).
    lon: Floats
    lat: Floats
    lost: int  #: Number of triangles that are left out, as the map tears them apart.
    count: int  #: Number of nodes of the mesh, which are the first points.

    def at(self, values: Floats) -> Floats:
        """Return values (P,) from values at the nodes of the mesh, (N,), or of a grid, (J, I)."""
        values = values.reshape(-1)
        others = self.nodes[self.count :]
        mixed = np.sum(self.weights[self.count :] * values[others], axis=1)
        return np.concatenate([values, mixed])

    def components(self, values: Floats) -> Floats:
        """Return eastward and northward components, (2, P), from components at the nodes, (2, N).

        Between nodes vectors are interpolated in space, as near a pole directions differ.
        """
        values = values.reshape(2, -1)
        count = self.count
        if len(self.nodes) == count:
            return values
        others = self.nodes[count:]
        used, number = np.unique(others, return_inverse=True)
        globe = Projection(GLOBE)
        vectors = globe.vectors(self.lon[used], self.lat[used], *values[:, used])
        mixed = np.zeros((len(others), 3))
        for k, part in enumerate(number.reshape(others.shape).T):
            mixed += self.weights[count:, k, None] * vectors[part]
        moved = np.stack(globe.components(self.lon[count:], self.lat[count:], mixed))
        return np.concatenate([values, moved], axis=1)

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (P, 3) of components (P,) in m/s."""
        return self.projection.vectors(self.lon, self.lat, east, north)


def mesh_on_map(
    lon: Floats, lat: Floats, triangles: Indices, places: Places, name: str | None
) -> MeshMap:
    """Put triangles on a map, by its name; by default a flat one that suits the places.

    ``lon`` and ``lat`` are the coordinates of the nodes in degrees, (N,).
    """
    projection = projection_of(places, name)
    if projection.is_globe:
        return _on_globe(projection, lon, lat, triangles, np.arange(len(triangles)))
    return _on_flat_map(projection, lon, lat, triangles, np.arange(len(triangles)))


def torn_grid(places: Places, name: str | None) -> MeshMap | None:
    """Put a grid on a map as triangles, if a flat map cuts its cells, or it has a fold.

    It is ``None`` where the cells of the grid remain whole. Of a grid on lines most maps leave
    whole cells in parts; oblique ones have tears across both rows and columns.
    """
    projection = projection_of(places, name)
    mirrored = None
    if is_joined(places):
        mirrored = folded_columns(places)
    if min(places.a.shape) < 2 or (projection.is_globe and mirrored is None):
        return None
    if places.is_line and OBLIQUE not in projection.name:
        return None
    columns = np.arange(places.a.shape[1])
    if find_closure(np.swapaxes(places.positions, 0, 1))[1] is not None:
        columns = np.append(columns, 0)
    lon = places.a.reshape(-1)
    lat = places.b.reshape(-1)
    nodes = np.arange(len(lon)).reshape(places.a.shape)[:, columns]
    rows = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=-1)
    lines = np.stack([nodes[:-1], nodes[1:]], axis=-1)
    sides = np.concatenate([rows.reshape(-1, 2), lines.reshape(-1, 2)])
    if mirrored is None and not _is_cut(projection, lon, lat, sides):
        return None
    gap_i = data_gaps(places.a[:, columns], places.b[:, columns])
    gap_j = data_gaps(places.a[:, columns].T, places.b[:, columns].T).T
    has_gap = gap_i[:-1] | gap_i[1:] | gap_j[:, :-1] | gap_j[:, 1:]
    cells = np.flatnonzero(~has_gap)
    a, b, c, d = (
        corner.reshape(-1)[cells]
        for corner in (nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1])
    )
    triangles = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    row, column = np.divmod(cells, len(columns) - 1)
    number = row * (places.a.shape[1] - 1) + np.minimum(column, places.a.shape[1] - 2)
    is_known = np.isfinite(lon[[a, b, c, d]] + lat[[a, b, c, d]]).all(axis=0)
    is_known = np.tile(is_known, 2)
    triangles = triangles[is_known]
    members = np.tile(number, 2)[is_known]
    if mirrored is not None:
        triangles, members = _across_fold(places, nodes, mirrored[columns], triangles, members)
    if projection.is_globe:
        return _on_globe(projection, lon, lat, triangles, members)
    return _on_flat_map(projection, lon, lat, triangles, members)


def _across_fold(
    places: Places, nodes: Indices, mirrored: Indices, triangles: Indices, members: Indices
) -> tuple[Indices, Indices]:
    """Return triangles with those across a fold; nodes that are there twice become one."""
    a, b, c, d = cells_across(nodes, mirrored).T
    more = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)])
    p = places.positions.reshape(-1, 3)
    known = np.isfinite(p[more]).all(axis=(1, 2))
    triangles = np.concatenate([triangles, more[known]])
    members = np.concatenate([members, np.full(known.sum(), members.max(initial=0))])
    # Lines are there twice at the fold, and where the columns close.
    edge = np.unique(np.concatenate([nodes[-1], nodes[:, 0], nodes[:, -1], nodes[:, -2]]))
    edge = edge[np.isfinite(p[edge]).all(axis=-1)]
    cell = np.nanmedian(np.linalg.norm(np.diff(places.positions[-1], axis=0), axis=-1))
    same = merged_nodes(p, edge, SAME_NODE * float(cell))
    triangles = same[triangles]
    whole = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    return triangles[whole], members[whole]


def _on_globe(
    projection: Projection, lon: Floats, lat: Floats, triangles: Indices, members: Indices
) -> MeshMap:
    """Put triangles on a globe, which cuts none of them."""
    mesh = MeshPlaces.of_nodes(lon, lat, -HALF_TURN)
    points = projection.positions(lon, lat)
    cut = triangles, members, mesh.nodes, mesh.weights
    return MeshMap(projection, points, *cut, lon, lat, 0, len(lon))


def _is_cut(projection: Projection, lon: Floats, lat: Floats, sides: Indices) -> bool:
    """Return whether a map cuts some sides of cells, (K, 2)."""
    least, most = LATITUDES.get(projection.family, (-90.0, 90.0))
    with np.errstate(invalid="ignore"):
        is_shown = (lat >= least - ROUNDED) & (lat <= most + ROUNDED)
    ends = is_shown[sides]
    if (ends[:, 0] != ends[:, 1])[np.isfinite(lat[sides]).all(axis=1)].any():
        return True
    points = shown_positions(projection, lon, lat)
    far = sides[stretches(lon, lat, points, sides)[0]]
    one, other = np.moveaxis(np.stack([lon, lat], axis=-1)[far], 1, 0)
    return bool(tears(projection, one, other, straight=True)[0].any())


def _on_flat_map(
    projection: Projection, lon: Floats, lat: Floats, triangles: Indices, members: Indices
) -> MeshMap:
    """Put triangles on a flat map; ``members`` are the numbers that their parts keep."""
    count = len(lon)
    places = MeshPlaces.of_nodes(lon, lat, projection.center[0] - 180.0)
    mesh = triangles, members
    poles: dict[int, int] = {}
    for sign in torn_poles(projection):
        mesh, pole = around_pole(places, *mesh, sign)
        if pole is not None:
            poles[sign] = pole
    mesh = _within_latitudes(places, *mesh, projection)
    mesh, lost = _along_tears(places, *mesh, projection, list(poles.values()))
    for sign, pole in poles.items():
        mesh = open_pole(places, *mesh, pole, sign)
    points = shown_positions(projection, places.lon, places.lat)
    triangles, members = mesh
    corners = points[triangles]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    wide = stretches(places.lon, places.lat, points, _sides(triangles))[1].any(axis=1)
    with np.errstate(invalid="ignore"):
        has_area = np.abs(area) > 0
    drawn = has_area & ~wide
    lost += int((has_area & wide).sum())
    cut = triangles[drawn], members[drawn], places.nodes, places.weights
    return MeshMap(projection, points, *cut, places.lon, places.lat, lost, count)


def _within_latitudes(
    places: MeshPlaces, triangles: Indices, members: Indices, projection: Projection
) -> tuple[Indices, Indices]:
    """Cut triangles at the latitudes where a map ends."""
    for limit, sign in zip(LATITUDES.get(projection.family, ()), (-1.0, 1.0), strict=False):
        outside = (sign * places.lat > sign * limit + ROUNDED)[triangles]
        crossed = outside.any(axis=1) & ~outside.all(axis=1)
        if not outside.any():
            continue
        part = triangles[crossed]
        owner = members[crossed]
        # One corner is on the other side than two.
        is_lone = outside[crossed] == (outside[crossed].sum(axis=1) == 1)[:, None]
        order = (np.argmax(is_lone, axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(part, order, axis=1).T
        lone_outside = outside[crossed].sum(axis=1) == 1
        sides = np.sort(np.stack([np.stack([a, b], -1), np.stack([a, c], -1)]), axis=-1)
        pairs, number = np.unique(sides.reshape(-1, 2), axis=0, return_inverse=True)
        new = _at_latitude(places, pairs, limit)
        to_b, to_c = new[number.reshape(2, -1)]
        inner = np.stack([a, to_b, to_c], axis=-1)[~lone_outside]
        one = np.stack([to_b, b, c], axis=-1)[lone_outside]
        other = np.stack([to_b, c, to_c], axis=-1)[lone_outside]
        whole = ~outside.any(axis=1)
        triangles = np.concatenate([triangles[whole], inner, one, other])
        beyond = owner[lone_outside]
        members = np.concatenate([members[whole], owner[~lone_outside], beyond, beyond])
    return triangles, members


def _at_latitude(places: MeshPlaces, pairs: Indices, limit: float) -> Indices:
    """Add the places where sides, (K, 2), cross a latitude, and return their numbers."""
    one, other = np.moveaxis(places.positions[pairs], 1, 0)
    globe = Projection(GLOBE)
    low = np.zeros(len(pairs))
    high = np.ones(len(pairs))
    above = places.lat[pairs[:, 0]] > limit
    for _ in range(HALVINGS):
        half = (low + high) / 2
        lon, lat = globe.lonlat((1 - half[:, None]) * one + half[:, None] * other)
        is_low = (lat > limit) == above
        low = np.where(is_low, half, low)
        high = np.where(is_low, high, half)
    lon = places.west + (lon - places.west) % 360.0
    return places.append_between(pairs, half, (lon, np.full(len(pairs), limit)))


def _along_tears(
    places: MeshPlaces,
    triangles: Indices,
    members: Indices,
    projection: Projection,
    poles: list[int],
) -> tuple[tuple[Indices, Indices], int]:
    """Cut triangles where a map tears them; also return the number of those that it leaves out."""
    points = shown_positions(projection, places.lon, places.lat)
    points[poles] = 0.0
    is_shown = np.isfinite(points[triangles, 0]).all(axis=1)
    triangles = triangles[is_shown]
    members = members[is_shown]
    ends = np.sort(_sides(triangles), axis=-1)
    ends_there = np.isin(ends, poles).any(axis=-1)
    points[poles] = np.nan
    far = np.nonzero(stretches(places.lon, places.lat, points, ends)[0] & ~ends_there)
    pairs, number = np.unique(ends[far], axis=0, return_inverse=True)
    one, other = np.moveaxis(np.stack([places.lon, places.lat], axis=-1)[pairs], 1, 0)
    torn, *shares = tears(projection, one, other, straight=True)
    new = [places.append_between(pairs[torn], share) for share in shares]
    for part, end in zip(new, pairs[torn].T, strict=True):
        _move_to_side(places, part, end)
    # A great circle between two places on the last parallel leads beyond it.
    places.lat = np.clip(places.lat, *LATITUDES.get(projection.family, (-90.0, 90.0)))
    tear = np.full(triangles.shape, -1)
    tear[far] = np.where(torn, np.cumsum(torn) - 1, -1)[number.reshape(-1)]
    has_pole = np.isin(triangles, poles).any(axis=1)
    is_odd = ((tear >= 0).sum(axis=1) % 2 == 1) & ~has_pole
    # A tear that begins in a triangle is narrow there, and the triangle remains whole.
    before, after = (shown_positions(projection, *places.lonlat(part)) for part in new)
    length = np.linalg.norm(np.diff(points[pairs[torn]], axis=1)[:, 0], axis=1)
    width = np.append(np.linalg.norm(after - before, axis=1) / length, 0.0)
    is_narrow = is_odd & (width[tear].max(axis=1) < NARROW)
    tear[is_narrow] = -1
    lost = is_odd & ~is_narrow
    cut, parts = _cut(triangles[~lost], tear[~lost], pairs[torn], np.stack(new))
    return (cut, members[~lost][parts]), int(lost.sum())


def _move_to_side(places: MeshPlaces, numbers: Indices, ends: Indices) -> None:
    """Move places on the edge of a map to its eastern side where the end beside them lies there.

    A place on the edge lies on the western side.
    """
    edge = places.lon[numbers] - places.west < INSIDE
    is_east = edge & (places.lon[ends] - places.west > HALF_TURN)
    places.lon[numbers[is_east]] = places.west + 2 * HALF_TURN - INSIDE


def _sides(triangles: Indices) -> Indices:
    """Return the nodes at the ends of the sides of triangles, (M, 3, 2)."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1)


def _cut(
    triangles: Indices, tear: Indices, pairs: Indices, new: Indices
) -> tuple[Indices, Indices]:
    """Cut triangles at tears, and return them with the number of the triangle that each was.

    One with two torn sides becomes one triangle before the tears and two beyond. One with a torn
    side opposite to a pole becomes two, which meet at the pole. ``tear`` has the numbers of the
    tears of the three sides, (M, 3), or -1. Of tear t, between the nodes of ``pairs``, the places
    just before and just after it are the nodes ``new[:, t]``.
    """

    def beside(node: Indices, tear: Indices) -> Indices:
        return new[(pairs[tear, 1] == node).astype(int), tear]

    torn_sides = (tear >= 0).sum(axis=1)
    across = torn_sides >= 2
    lone = (np.argmin(tear[across], axis=1) + 2) % 3
    order = (lone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(triangles[across], order, axis=1).T
    to_b, _, to_c = np.take_along_axis(tear[across], order, axis=1).T
    far_b = beside(b, to_b)
    far_c = beside(c, to_c)
    parts = [(a, beside(a, to_b), beside(a, to_c)), (far_b, b, c), (far_b, c, far_c)]
    single = torn_sides == 1
    order = (np.argmax(tear[single], axis=1)[:, None] + np.arange(3)) % 3
    a, b, pole = np.take_along_axis(triangles[single], order, axis=1).T
    opposite = tear[single].max(axis=1)
    parts += [(a, beside(a, opposite), pole), (beside(b, opposite), b, pole)]
    cut = [np.stack(part, axis=-1) for part in parts]
    numbers = [np.flatnonzero(torn_sides == 0), *[np.flatnonzero(across)] * 3]
    numbers += [np.flatnonzero(single)] * 2
    return np.concatenate([triangles[torn_sides == 0], *cut]), np.concatenate(numbers)
