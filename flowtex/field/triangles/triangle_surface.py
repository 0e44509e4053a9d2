"""A surface of triangles in space: its nodes, normals, sizes of cells, and points on it.

Its tangents at the nodes are two orthonormal vectors of the tangent plane, so that computations
with tangents hold for both kinds of surfaces. A point of the surface is (i, j), as on a structured
one: j is the number of the triangle plus the share of its second corner, i that of its third.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import dot, norm
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.node_surface import IndexVelocity, NodeSurface, to_index_space
from flowtex.field.triangles.sharp_edges import split_nodes
from flowtex.field.triangles.triangle_nodes import (
    SHARP,
    corner_angles,
    face_alike,
    flipped,
    neighbours,
    nodal_sums,
    same_places,
    triangle_normals,
    uneven_nodes,
)

#: Greatest coordinate of a second corner, just below the next triangle's number.
MOST_SHARE = 1 - 1e-7
LEAST_BESIDE = 0.2  #: Least size of cells at a node over that at the nodes beside it.

#: Most triangles at which the part of the flow out of the surface is measured.
MOST_MEASURED = 50_000


class TriangleSurface(NodeSurface):
    """Nodes of a surface of triangles, (1, N, 3), in the mesh's own units.

    ``triangles`` (M, 3) are numbers of nodes, and ``valid`` (1, N) marks nodes that carry data.
    """

    def __init__(
        self, points: Floats, triangles: Indices, valid: Bools, *, on_globe: bool = False
    ) -> None:
        self.points = points
        self.triangles = triangles
        self.valid = valid
        self.on_globe = on_globe
        self.periodic = (False, False)
        self.has_position = np.ones(valid.shape, dtype=bool)
        self.offset = np.zeros((2, 3))
        self.cell_corners = [(0, nodes) for nodes in triangles.T]

    @property
    def last_index(self) -> tuple[float, float]:
        """Greatest position (j, i): the last triangle and its second corner, and a third corner."""
        return len(self.triangles) - 1 + MOST_SHARE, 1.0

    def nodes_of(self, cells: Bools) -> Indices:
        """Return the nodes at the corners of some triangles, (M, 3)."""
        return np.asarray(self.triangles[cells])

    @property
    def cell_lengths(self) -> Floats:
        """Length of each triangle, (M,), by its longest side."""
        corners = self.points[0][self.triangles]
        side = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
        # No path of a unit of shares is longer.
        return np.asarray(side * (2 / np.sqrt(3)))

    def in_cells(self, vectors: Floats) -> Floats:
        """Return the parts of vectors (M, 3) that lie in the planes of the triangles."""
        normal = self.crosses
        height = dot(vectors, normal) / dot(normal, normal)
        return np.asarray(vectors - height[:, None] * normal)

    @property
    def is_closed(self) -> bool:
        """Whether every triangle has another one at each side."""
        return bool((self.neighbours >= 0).all())

    @cached_property
    def neighbours(self) -> Indices:
        """The triangle across the edge opposite to each corner, (M, 3), -1 at a border."""
        return neighbours(self.points[0], self.joined)

    @cached_property
    def places(self) -> Indices:
        """First node at the place of each node, (N,): sharp edges have nodes for each face."""
        return same_places(self.points[0], self.triangles)

    @cached_property
    def at_edge(self) -> Bools:
        """Nodes of sharp edges, (1, N), beside other nodes at the same place for other faces."""
        return (np.bincount(self.places)[self.places] > 1)[None]

    @cached_property
    def node_lengths(self) -> Floats:
        """Length of the longest triangle at each node, (1, N)."""
        result = np.zeros(self.shape)
        for corner in self.triangles.T:
            np.maximum.at(result[0], corner, self.cell_lengths)
        return result

    @property
    def joined(self) -> Indices:
        """Nodes at the corners, (M, 3), the same ones for all faces at a sharp edge."""
        if self.has_faces:
            return np.asarray(self.places[self.triangles])
        return self.triangles

    @cached_property
    def has_faces(self) -> bool:
        """Whether some nodes lie at the same place, for different faces."""
        return bool((self.places != np.arange(len(self.places))).any())

    @cached_property
    def uneven(self) -> Bools:
        """The :func:`uneven_nodes`, (N,), among the first nodes at all places."""
        return uneven_nodes(self.joined, self.shape[1])

    @cached_property
    def faces_alike(self) -> bool:
        """Whether all triangles face as their neighbours do."""
        return face_alike(self.joined, self.uneven)

    @cached_property
    def flipped(self) -> Bools:
        """Triangles that face the other way than the first one of their part, (M,)."""
        if self.faces_alike:
            return np.zeros(len(self.triangles), dtype=bool)
        return flipped(self.joined, self.neighbours)

    def with_faces(self) -> tuple[TriangleSurface, Indices]:
        """Return the surface with nodes for each face at sharp edges, and which each was, (n,)."""
        if self.frame is not None:
            return self, np.arange(self.shape[1])
        points = self.points[0]
        triangles, origin = split_nodes(points, self.triangles, self.uneven, self.own_crosses)
        if len(origin) == len(points):
            return self, origin
        valid = self.valid[:, origin]
        surface = TriangleSurface(self.points[:, origin], triangles, valid, on_globe=self.on_globe)
        surface.__dict__["places"] = origin
        new = np.zeros(len(origin) - len(points), dtype=bool)
        surface.__dict__["own_crosses"] = self.own_crosses
        surface.__dict__["uneven"] = np.append(self.uneven, new)
        return surface, origin

    @cached_property
    def crosses(self) -> Floats:
        """Normals of the triangles, (M, 3), as long as twice their areas; neighbours face alike."""
        crosses = self.own_crosses
        if self.flipped.any():
            crosses = np.where(self.flipped[:, None], -crosses, crosses)
        return crosses

    @cached_property
    def own_crosses(self) -> Floats:
        """Normals of the triangles as their corners are ordered, (M, 3)."""
        return triangle_normals(self.points[0], self.triangles)

    @cached_property
    def _plane_normal(self) -> Floats | None:
        """The normal of all triangles where they lie in one plane and face alike, (3,)."""
        if self.frame is None or not self.valid.all():
            return None
        normal = np.cross(*self.frame)
        along = self.crosses @ normal
        if along.min() >= 0:
            return normal
        if along.max() <= 0:
            return -normal
        return None

    @cached_property
    def normals(self) -> Floats:
        """Unit normals at the nodes, (1, N, 3): means by the angles of the triangles there."""
        if self._plane_normal is not None:
            return np.tile(self._plane_normal, (1, self.shape[1], 1))
        length = norm(self.crosses)[:, None]
        unit = np.divide(self.crosses, length, out=np.zeros_like(self.crosses), where=length > 0)
        angles = corner_angles(self.points[0], self.triangles)
        total = nodal_sums(self.triangles, unit, self.shape[1], angles)
        size = norm(total)[:, None]
        away = np.divide(total, size, out=np.zeros_like(total), where=size > 1e-12)
        away[size[:, 0] <= 1e-12] = (0.0, 0.0, 1.0)
        return np.asarray(away[None])

    @cached_property
    def tangents(self) -> Floats:
        """Two orthonormal vectors of the tangent plane at each node, (2, 1, N, 3)."""
        n = self.normals[0]
        # Duff et al. 2017, Building an orthonormal basis, revisited.
        sign = np.where(n[:, 2] < 0, -1.0, 1.0)
        a = -1.0 / (sign + n[:, 2])
        b = n[:, 0] * n[:, 1] * a
        first = np.stack([1 + sign * n[:, 0] ** 2 * a, sign * b, -sign * n[:, 0]], axis=-1)
        second = np.stack([b, sign + n[:, 1] ** 2 * a, -n[:, 1]], axis=-1)
        return np.asarray(np.stack([first, second])[:, None])

    @cached_property
    def cell_size(self) -> Floats:
        """Mean length of the edges at each node, (1, N), or a share of those beside it."""
        corners = self.points[0][self.triangles]
        length = norm(np.roll(corners, -1, axis=1) - corners).ravel()
        ends = np.concatenate([self.triangles, np.roll(self.triangles, -1, axis=1)]).ravel()
        count = np.bincount(ends, minlength=self.shape[1])
        size = np.bincount(ends, np.tile(length, 2), self.shape[1]) / np.maximum(count, 1)
        # Slivers, as in a cut close to nodes, are not cells, whose sizes change gradually.
        beside = np.zeros_like(size)
        np.maximum.at(beside, self.triangles, size[self.triangles].max(axis=1, keepdims=True))
        size = np.maximum(size, LEAST_BESIDE * beside)
        typical = float(np.median(size[self.valid[0]])) or 1.0
        return np.asarray(np.maximum(size, 1e-4 * typical)[None])

    @cached_property
    def drawn(self) -> Indices:
        """Numbers of the triangles that are drawn."""
        return np.flatnonzero(self.cells)

    def is_drawn(self, number: Indices) -> Bools:
        """Return whether triangles (N,) are drawn."""
        return np.asarray(self.cells[number])

    def corners_of(self, number: Indices) -> Indices:
        """Return nodes (N, 3) at the corners of triangles (N,)."""
        return np.asarray(self.triangles[number])

    def cells_of(self, number: Indices) -> Indices:
        """Return the numbers of triangles (N,)."""
        return number

    def beside(self, number: Indices, corner: int) -> Indices:
        """Return triangles (N,) across the edges opposite to a corner, -1 at a border."""
        return np.asarray(self.neighbours[number, corner])

    def triangle_at(self, index: Floats) -> tuple[Floats, int, Floats] | None:
        """Return a position (j, i), its drawn triangle, and shares of the corners, (3,)."""
        j, i = map(float, index)
        if not (0 <= j < len(self.triangles) and 0 <= i <= 1 and self.cells[int(j)]):
            return None
        return index, int(j), self.corners_at(index[::-1])[1]

    def node_near(self, index: Sequence[float]) -> tuple[int, int]:
        """Return the first node of the triangle at a position (j, i)."""
        return 0, int(self.triangles[int(index[0])][0])

    def wrap(self, index: Floats) -> Floats:
        """Return positions (..., 2) as (i, j) as they are: nothing repeats."""
        return index

    def corners_at(self, index: Floats) -> tuple[Indices, Floats]:
        """Return nodes (..., 3) and their shares (..., 3) at positions (..., 2) as (i, j)."""
        number = np.clip(np.floor(index[..., 1]).astype(np.intp), 0, len(self.triangles) - 1)
        second = index[..., 1] - number
        third = index[..., 0]
        return self.triangles[number], np.stack([1 - second - third, second, third], axis=-1)

    def index_of(self, number: Indices, weights: Floats) -> Floats:
        """Return positions (..., 2) as (i, j) of shares (..., 3) of corners of triangles (...)."""
        second = np.clip(weights[..., 1], 0, MOST_SHARE)
        return np.stack([np.clip(weights[..., 2], 0, 1), number + second], axis=-1)

    def at(self, index: Floats) -> Floats:
        """Return positions in space (..., 3) of positions (..., 2) as (i, j)."""
        nodes, weights = self.corners_at(index)
        return np.asarray(np.einsum("...k,...kc->...c", weights, self.points[0][nodes]))

    def express(self, velocity: Floats) -> IndexVelocity:
        """Express a velocity (T, 1, N, 3) in the tangent planes.

        At a node of a sharp edge, the tangent plane lies between the faces, so the velocity along
        it is greater than along each face. There the speed is the mean of the speeds in the faces.
        """
        flow = to_index_space(self.tangents, self.valid, None, velocity)
        if not self.sharp.any():
            return flow
        triangle, corner = np.nonzero(self.sharp[0][self.triangles])
        nodes = self.triangles[triangle, corner]
        edge_nodes, at = np.unique(nodes, return_inverse=True)
        unit = self.crosses[triangle]
        unit = unit / np.maximum(np.linalg.norm(unit, axis=1, keepdims=True), np.finfo(float).tiny)
        count = np.bincount(at)
        components = flow.components.copy()
        speed = flow.speed.copy()
        for step in range(len(velocity)):
            v = velocity[step, 0, nodes]
            within = np.linalg.norm(v - np.sum(v * unit, axis=1, keepdims=True) * unit, axis=1)
            mean = np.bincount(at, within) / count
            total = speed[step, 0, edge_nodes]
            share = np.divide(mean, total, out=np.zeros_like(mean), where=total > 0).clip(max=1.0)
            speed[step, 0, edge_nodes] *= share
            components[step, 0, edge_nodes] *= share[:, None]
        return replace(flow, components=components, speed=speed)

    @property
    def is_large(self) -> bool:
        """Whether :meth:`normal_share` represents all of the surface well."""
        return len(self.triangles) > MOST_MEASURED

    def normal_share(self, velocity: Floats) -> float:
        """Return the normal share of a velocity (1, N, 3), sampled at some of the triangles."""
        drawn = self.drawn
        corners = self.triangles[drawn[:: -(-len(drawn) // MOST_MEASURED)]]
        normal = triangle_normals(self.points[0], corners)
        flow = velocity[0, corners].mean(axis=1)
        out = dot(flow, normal) / norm(normal)
        total = np.vdot(flow, flow)
        if total > 0:
            return float(np.sqrt(min(np.vdot(out, out) / total, 1.0)))
        return 0.0

    @cached_property
    def sharp(self) -> Bools:
        """Nodes at tips, (1, N), which several triangles meet at an angle."""
        sharp = np.zeros(self.shape[1], dtype=bool)
        if self._plane_normal is not None:
            return sharp[None]
        least = SHARP * norm(self.crosses)
        normals = self.normals[0]
        for nodes in self.triangles.T:
            turned = dot(self.crosses, normals.take(nodes, axis=0)) < least
            sharp[self.triangles[turned]] = True
        return sharp[None]


Surface: TypeAlias = GridSurface | TriangleSurface  #: A surface of either kind.
