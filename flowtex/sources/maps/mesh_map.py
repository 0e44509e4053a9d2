"""Meshes on a globe or a flat map, where some of the triangles lie across the edge of the map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.earth import GLOBE, NAMES, Projection
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.maps.grid_map import TORN, projection_of, shown_positions
from flowtex.sources.models.mesh import Mesh

#: Maps around a pole, which have no edge at a meridian.
AROUND_A_POLE = ("north", "south")
#: Span in degrees of longitude from which on a triangle is around a pole, or touches it.
WIDEST = 90.0
#: Degrees by which nodes on the edge lie inside, so that rounding keeps them on their side.
INSIDE = 1e-9
#: Least share of the way from a node to one on the edge.
NEAREST_NODE = 1e-5


@dataclass(eq=False)
class MeshMap:
    """Nodes and triangles on a map, at whose edge triangles are cut."""

    projection: Projection
    points: Floats  #: (P, 3).
    triangles: Indices  #: Numbers of points, (M, 3).
    nodes: Indices  #: Two nodes of the mesh between which each point lies, (P, 2).
    share: Floats  #: Share of the way from the first to the second, (P,).
    lon: Floats
    lat: Floats
    lost: int  #: Number of triangles that are left out, as the map tears them apart.

    def at(self, values: Floats) -> Floats:
        """Return values (P,) from those at the nodes of the mesh, (N,)."""
        one, other = values[self.nodes[:, 0]], values[self.nodes[:, 1]]
        return np.asarray((1 - self.share) * one + self.share * other)

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (P, 3) of components (P,) in m/s."""
        return self.projection.vectors(self.lon, self.lat, east, north)


def mesh_on_map(mesh: Mesh, places: Places, name: str | None) -> MeshMap:
    """Put a mesh on a map, by its name; by default a flat one that suits the region."""
    projection, _ = projection_of(places, name)
    numbers = np.arange(len(mesh.a))
    nodes, share = np.stack([numbers, numbers], axis=-1), np.zeros(len(numbers))
    lon, lat, triangles = mesh.a, mesh.b, mesh.triangles
    if projection.is_globe:
        points = projection.positions(lon, lat)
        return MeshMap(projection, points, triangles, nodes, share, lon, lat, 0)
    middle = projection.center[0]
    lon = middle + (lon - middle + 180.0) % 360.0 - 180.0
    lost = 0
    if projection.family in NAMES and projection.family not in AROUND_A_POLE:
        wide = _span(lon[triangles], middle) > WIDEST
        triangles, lost = triangles[~wide], int(wide.sum())
        triangles, pairs, shares, edge_lon = _cut(lon, triangles, middle)
        lat = np.append(lat, (1 - shares) * lat[pairs[:, 0]] + shares * lat[pairs[:, 1]])
        lon = np.append(lon, edge_lon)
        nodes, share = np.concatenate([nodes, pairs]), np.append(share, shares)
    points = shown_positions(projection, lon, lat)
    finite = np.asarray(np.isfinite(points).all(axis=1))
    triangles = triangles[finite[triangles].all(axis=1)]
    if projection.family not in NAMES:
        torn = _torn(points, Projection(GLOBE).positions(lon, lat), triangles)
        triangles, lost = triangles[~torn], lost + int(torn.sum())
    return MeshMap(projection, points, triangles, nodes, share, lon, lat, lost)


def _span(lon: Floats, middle: float) -> Floats:
    """Return the spans of triangles in degrees, (M,), also across the edge of the map."""
    across = np.ptp(np.where(lon < middle, lon + 360.0, lon), axis=1)
    return np.asarray(np.minimum(np.ptp(lon, axis=1), across))


def _cut(lon: Floats, triangles: Indices, middle: float) -> tuple[Indices, Indices, Floats, Floats]:
    """Cut triangles across the edge of the map, each into one on its one side and two beyond.

    Returns triangles (M, 3) of the nodes and the new ones after them; between which nodes the new
    ones are, (Q, 2), at which share of the way, and their longitudes, (Q,).
    """
    across = np.ptp(lon[triangles], axis=1) > 180.0
    corners = triangles[across]
    west = lon[corners] < middle
    lone = np.where(west.sum(axis=1) == 1, west.argmax(axis=1), west.argmin(axis=1))
    order = (lone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(corners, order, axis=1).T
    is_west = lon[a] < middle
    pairs, shares = [], []
    for end in (b, c):
        # From the lower number to the higher: neighbours find the same place.
        pair = np.sort(np.stack([a, end], axis=-1), axis=1)
        ends = lon[pair] + 360.0 * (lon[pair] < middle)
        pairs.append(pair)
        # A node on the edge itself makes triangles without area otherwise.
        along = (middle + 180.0 - ends[:, 0]) / (ends[:, 1] - ends[:, 0])
        shares.append(np.clip(along, NEAREST_NODE, 1 - NEAREST_NODE))
    east = middle + 180.0 - INSIDE
    near_lon, far_lon = (np.where(w, east - 360.0 + 2 * INSIDE, east) for w in (is_west, ~is_west))
    first, count = len(lon), len(a)
    ab, ac, ab_far, ac_far = first + np.arange(4 * count).reshape(4, count)
    parts = [(a, ab, ac), (ab_far, b, c), (ab_far, c, ac_far)]
    cut = [np.stack(part, axis=-1) for part in parts]
    return (
        np.concatenate([triangles[~across], *cut]),
        np.concatenate([*pairs, *pairs]),
        np.concatenate([*shares, *shares]),
        np.concatenate([near_lon, near_lon, far_lon, far_lon]),
    )


def _torn(points: Floats, sphere: Floats, triangles: Indices) -> Bools:
    """Return which triangles are much larger on the map than on the sphere, (M,)."""
    far = 0.1 * np.nanmax(np.abs(points), initial=0.0)
    torn = np.zeros(len(triangles), dtype=bool)
    for k in range(3):
        one, other = triangles[:, k], triangles[:, (k + 1) % 3]
        flat, true = (np.linalg.norm(p[one] - p[other], axis=1) for p in (points, sphere))
        torn |= (flat > TORN * true) & (flat > far)
    return torn
