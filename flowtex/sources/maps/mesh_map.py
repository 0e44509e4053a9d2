"""Meshes on a globe or a flat map, whose triangles are cut where the map is torn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.earth import Projection
from flowtex.field.earth.lines import between, tears
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.maps.grid_map import projection_of, shown_positions, stretches
from flowtex.sources.models.mesh import Mesh

#: Degrees from a pole at which a node is on it.
AT_POLE = 1e-3


@dataclass(eq=False)
class MeshMap:
    """Nodes and triangles on a map, at whose edge triangles are cut."""

    projection: Projection
    points: Floats  #: (P, 3).
    triangles: Indices  #: Numbers of points, (M, 3).
    members: Indices  #: Numbers of the mesh's triangles, of which these are parts, (M,).
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
    west = projection.center[0] - 180.0
    lon, lat, triangles = mesh.a, mesh.b, mesh.triangles
    if projection.is_globe:
        points = projection.positions(lon, lat)
        members = np.arange(len(triangles))
        return MeshMap(projection, points, triangles, members, nodes, share, lon, lat, 0)
    lon = west + (lon - west) % 360.0  # a node on the edge of a map lies on its western side
    points = shown_positions(projection, lon, lat)
    members = np.flatnonzero(np.isfinite(points[triangles, 0]).all(axis=1))
    triangles = triangles[members]
    ends = np.sort(_sides(triangles), axis=-1)
    far = np.nonzero(stretches(lon, lat, points, ends)[0])
    pairs, number = np.unique(ends[far], axis=0, return_inverse=True)
    one, other = np.moveaxis(np.stack([lon, lat], axis=-1)[pairs], 1, 0)
    torn, *shares = tears(projection, one, other, straight=True)
    more = [between(one[torn], other[torn], part, straight=True).T for part in shares]
    # East and north have no meaning at a pole.
    poles = np.abs(lat[pairs[torn]]) > 90 - AT_POLE
    near = np.where(poles, pairs[torn, ::-1], pairs[torn])
    nodes, share = np.concatenate([nodes, near, near]), np.concatenate([share, *shares])
    # The number of the tear of each side.
    tear = np.full(triangles.shape, -1)
    tear[far] = np.where(torn, np.cumsum(torn) - 1, -1)[number.reshape(-1)]
    lost = (tear >= 0).sum(axis=1) % 2 == 1  # a pole lies inside
    triangles, parts = _cut(triangles[~lost], tear[~lost], pairs[torn], len(lon))
    members = members[~lost][parts]
    lon, lat = np.concatenate([np.stack([lon, lat]), *more], axis=1)
    points = shown_positions(projection, lon, lat)
    corners = points[triangles]
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]
    triangles, members = triangles[np.abs(area) > 0], members[np.abs(area) > 0]
    wide = stretches(lon, lat, points, _sides(triangles))[1].any(axis=1)
    count = int(lost.sum() + wide.sum())
    drawn = triangles[~wide], members[~wide]
    return MeshMap(projection, points, *drawn, nodes, share, lon, lat, count)


def _sides(triangles: Indices) -> Indices:
    """Return the nodes at the ends of the sides of triangles, (M, 3, 2)."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1)


def _cut(triangles: Indices, tear: Indices, pairs: Indices, first: int) -> tuple[Indices, Indices]:
    """Cut triangles, two of whose sides are torn, each into one before and two beyond the tears.

    The second value has the numbers of the triangles of which the results are parts.

    ``tear`` has the numbers of the tears of the three sides, (M, 3), or -1. Of tear t, between the
    nodes of ``pairs``, the place just before it is the node ``first + t``, and that just after it
    comes as many later as there are tears.
    """
    across = (tear >= 0).any(axis=1)
    lone = (np.argmin(tear[across], axis=1) + 2) % 3
    order = (lone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(triangles[across], order, axis=1).T
    to_b, _, to_c = np.take_along_axis(tear[across], order, axis=1).T

    def beside(node: Indices, tear: Indices) -> Indices:
        return first + tear + len(pairs) * (pairs[tear, 1] == node)

    far_b, far_c = beside(b, to_b), beside(c, to_c)
    parts = (a, beside(a, to_b), beside(a, to_c)), (far_b, b, c), (far_b, c, far_c)
    cut = [np.stack(part, axis=-1) for part in parts]
    numbers = [np.flatnonzero(~across), *[np.flatnonzero(across)] * 3]
    return np.concatenate([triangles[~across], *cut]), np.concatenate(numbers)
