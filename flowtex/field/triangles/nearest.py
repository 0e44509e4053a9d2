"""The point of a surface of triangles that is nearest to a point in space."""

from __future__ import annotations

import numpy as np
import scipy

from flowtex._util.array_types import Floats, Indices
from flowtex.field.triangles.surface import TriangleSurface

#: Nodes around a point that cells are walked from.
START_NODES = 4
#: Distance from a triangle, in sizes of its cell, within which a point lies on it.
ON_SURFACE = 1e-9
#: Height of a triangle over a side, squared, below which it has no area.
FLAT_TRIANGLE = 1e-20
#: Triangles that a walk goes over, at most.
WALK_STEPS = 24


class TriangleLocator:
    """Finds points on one surface.

    From the triangles around the nearest nodes a walk leads to the neighbour in which the point
    would lie if the present triangle went on, as structured surfaces are walked.
    """

    def __init__(self, surface: TriangleSurface) -> None:
        self._surface = surface
        self._points = surface.points[0]
        drawn = np.flatnonzero(surface.cells)
        nodes = surface.triangles[drawn].ravel()
        order = np.argsort(nodes, kind="stable")
        self._around = np.repeat(drawn, 3)[order]
        self._nodes, self._first, self._count = np.unique(
            nodes[order], return_index=True, return_counts=True
        )
        self._tree = scipy.spatial.cKDTree(self._points[self._nodes])

    def nearest(self, points: Floats) -> tuple[Floats, Floats]:
        """Find the points of the surface that are nearest to points (P, 3) in space.

        Returns them as (j, i), (P, 2), and how far they are in sizes of their triangle, (P,).
        """
        starts = min(START_NODES, len(self._nodes))
        near = np.reshape(self._tree.query(points, k=np.arange(1, starts + 1))[1], (-1, starts))
        best = np.full(len(points), np.inf)
        triangle = np.zeros(len(points), dtype=np.intp)
        shares = np.zeros((len(points), 3))
        for node in near.T:
            for turn in range(int(self._count[node].max())):
                some = np.flatnonzero(self._count[node] > turn)
                beside = self._around[self._first[node[some]] + turn]
                self._try(points, some, beside, (best, triangle, shares))
        self._walk(points, (best, triangle, shares))
        size = np.ptp(self._points[self._surface.triangles[triangle]], axis=1).max(axis=-1)
        return self._surface.index_of(triangle, shares)[:, ::-1], best / size

    def _try(
        self,
        points: Floats,
        some: Indices,
        triangle: Indices,
        found: tuple[Floats, Indices, Floats],
    ) -> Indices:
        """Write those of some points that are nearer in a triangle, and return which they are."""
        best, at, shares = found
        corners = self._points[self._surface.triangles[triangle]]
        inside, far = closest(points[some], corners[:, 0], corners[:, 1], corners[:, 2])
        nearer = far < best[some]
        which = some[nearer]
        best[which], at[which], shares[which] = far[nearer], triangle[nearer], inside[nearer]
        return which

    def _walk(self, points: Floats, found: tuple[Floats, Indices, Floats]) -> None:
        """Go on across the sides on which points lie, while that leads nearer."""
        _, at, shares = found
        going = np.arange(len(points))
        for _ in range(WALK_STEPS):
            here, before = going, at.copy()
            for corner in range(3):
                # On a side the opposite corner has no share.
                some = here[shares[here, corner] <= 0]
                beside = self._surface.neighbours[before[some], corner]
                inside = (beside >= 0) & self._surface.cells[beside]
                self._try(points, some[inside], beside[inside], found)
            going = np.flatnonzero(at != before)
            if not len(going):
                break


def closest(at: Floats, a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """Shares of the corners (N, 3) at the nearest points of triangles, and how far, (N,).

    A triangle without area is infinitely far: the one beside it has the same points.
    """
    u, v, w = b - a, c - a, at - a
    uu, vv, uv, wu = (np.einsum("nc,nc->n", p, q) for p, q in ((u, u), (v, v), (u, v), (w, u)))
    # What v has across u: long triangles lose no digits by it.
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
    """Shares of the corners (N, 3) at the nearest points of the triangles' sides."""
    best, result = np.full(len(at), np.inf), np.zeros((len(at), 3))
    for k, n in ((0, 1), (1, 2), (2, 0)):
        side, away = nodes[:, n] - nodes[:, k], at - nodes[:, k]
        length = np.maximum(np.sum(side * side, axis=-1), np.finfo(float).tiny)
        share = np.clip(np.sum(away * side, axis=-1) / length, 0.0, 1.0)
        far = np.sum((away - share[:, None] * side) ** 2, axis=-1)
        closer = far < best
        best = np.where(closer, far, best)
        result[closer] = 0.0
        result[closer, k], result[closer, n] = 1 - share[closer], share[closer]
    return result
