"""Meshes on a globe or a flat map, where some of the triangles lie across the edge of the map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.earth import EARTH_RADIUS, NAMES, Projection
from flowtex.field.datasets.maps import CYLINDERS, TORN, projection_of, shown_positions
from flowtex.field.datasets.meshes.mesh import Mesh
from flowtex.field.datasets.places import Places

__all__ = ["MeshMap", "mesh_on_map"]

#: Maps around a pole, which have no edge at a meridian.
AROUND_A_POLE = ("north", "south")
#: Degrees of longitude from which on a triangle is around a pole, or touches it.
WIDEST = 90.0


@dataclass(frozen=True, eq=False)
class MeshMap:
    """Nodes and triangles on a map.

    ``points`` are (P, 3), ``triangles`` (M, 3) their numbers, and ``nodes`` (P,) the nodes of the
    mesh that they are: one has two places where triangles lie across the edge of the map. ``lost``
    counts the triangles that the map tears apart.
    """

    projection: Projection
    points: Floats
    triangles: Indices
    nodes: Indices
    lon: Floats
    lat: Floats
    lost: int

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (P, 3) of components (N,) in m/s at the nodes of the mesh."""
        return self.projection.vectors(self.lon, self.lat, east[self.nodes], north[self.nodes])


def mesh_on_map(mesh: Mesh, places: Places, name: str | None) -> MeshMap:
    """Put a mesh on a map, by its name; by default a flat one that suits the region."""
    projection, _ = projection_of(places, name)
    triangles, nodes = mesh.triangles, np.arange(len(mesh.a))
    lon, lat = mesh.a, mesh.b
    if projection.is_globe:
        points = projection.positions(lon, lat)
        return MeshMap(projection, points, triangles, nodes, lon, lat, 0)
    middle = projection.center[0]
    lon = middle + (lon - middle + 180.0) % 360.0 - 180.0
    turns = np.zeros(len(lon), dtype=np.intp)
    if projection.name in CYLINDERS:
        triangles, nodes, turns = _turned(lon, triangles, middle)
        lon, lat = lon[nodes], lat[nodes]
    points = shown_positions(projection, lon, lat)
    points[:, 0] += turns * 2 * projection.positions(np.array(middle + 180.0), np.array(0.0))[0]
    lon = lon + 360.0 * turns
    finite = np.asarray(np.isfinite(points).all(axis=1))
    shown = finite[triangles].all(axis=1)
    if projection.name in NAMES and projection.name not in AROUND_A_POLE:
        torn = np.ptp(lon[triangles], axis=1) > WIDEST
    else:
        torn = _torn(points, mesh.positions[nodes], triangles)
    torn &= shown
    return MeshMap(projection, points, triangles[shown & ~torn], nodes, lon, lat, int(torn.sum()))


def _turned(lon: Floats, triangles: Indices, middle: float) -> tuple[Indices, Indices, Indices]:
    """Give triangles across the edge nodes of their own, a turn further.

    Returns
    -------
    triangles, nodes, turns
        Numbers among the nodes with these copies, (M, 3), and for each of them, (P,), which node it
        is, and by how many turns it is further.
    """
    corners = lon[triangles]
    across = np.ptp(corners, axis=1) > 180.0
    west = corners < middle
    # Most of such a triangle lies at the side where two of its corners are.
    eastern = (west.sum(axis=1) == 1)[:, None]
    turn = np.where(across[:, None], np.where(eastern, west * 1, (~west) * -1), 0)
    pairs, at = np.unique(
        np.stack([turn[turn != 0], triangles[turn != 0]], axis=-1), axis=0, return_inverse=True
    )
    changed = triangles.copy()
    changed[turn != 0] = len(lon) + at.ravel()
    nodes = np.concatenate([np.arange(len(lon)), pairs[:, 1]]).astype(np.intp)
    turns = np.concatenate([np.zeros(len(lon), dtype=np.intp), pairs[:, 0]])
    return changed, nodes, turns


def _torn(points: Floats, sphere: Floats, triangles: Indices) -> Bools:
    """Which triangles are much larger on the map than on the sphere, (M,)."""
    far = 0.1 * np.nanmax(np.abs(points), initial=0.0)
    torn = np.zeros(len(triangles), dtype=bool)
    for k in range(3):
        one, other = triangles[:, k], triangles[:, (k + 1) % 3]
        flat = np.linalg.norm(points[one] - points[other], axis=1)
        true = EARTH_RADIUS * np.linalg.norm(sphere[one] - sphere[other], axis=1)
        with np.errstate(invalid="ignore"):
            torn |= (flat > TORN * true) & (flat > far)
    return torn
