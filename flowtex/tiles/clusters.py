"""A field on triangles with fewer nodes: those in one bin are one, with means of what they have.

Bins are cubes whose side is about twice the edges where they lie, and twice as long at each
next level, so that a mesh of very different cells loses three nodes of four everywhere. Nodes on
borders are apart from the others, which keeps outlines, and so are nodes of two sides of a thin
sheet. Triangles are left where their corners lie in three bins.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import csr_array

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.steps import Steps, map_steps
from flowtex.field.triangles.surface import TriangleSurface
from flowtex.field.triangles.topology import flipped, repeated, triangle_normals

__all__ = ["Clusters"]

#: Side of the first bins in edges there.
FIRST_EDGES = 2.0
#: Passes in which the edge of a node becomes that of its surroundings.
SMOOTHING = 3
#: Bins along the surface's extent, at most; three numbers of them have room in one of 64 bits.
MOST_BINS = 2**18


@dataclass(frozen=True, eq=False)
class Clusters:
    """Nodes of a level, each of which stands for some nodes of the field.

    Attributes
    ----------
    field
        The field at this level.
    triangles
        Its triangles that are drawn, (M, 3), which face alike.
    number
        For each node of the whole field that it is in, the node of this level, else -1, (N,).
    sides
        Side of the bins that nodes are joined in next, (n,), a power of two times the first.
    border
        Nodes on the border of what is drawn, (n,).
    normals
        Unit normals, or sums of them, (n, 3); ``None`` on a flat surface.
    """

    field: FlowField
    triangles: Indices
    number: Indices
    sides: Floats
    border: Bools
    normals: Floats | None

    @classmethod
    def of(cls, field: FlowField) -> Clusters:
        """Return the nodes of a field themselves."""
        surface = field.surface
        if not isinstance(surface, TriangleSurface):
            msg = "this field has no triangles; expected one of FlowField.from_triangles"
            raise TypeError(msg)
        triangles, beside = surface.triangles, surface.neighbours
        open_sides = (beside < 0) | ~surface.cells[beside]
        open_sides[~surface.cells] = False
        border = np.zeros(field.shape[1], dtype=bool)
        for k in range(3):
            for at in (1, 2):
                border[triangles[open_sides[:, k], (k + at) % 3]] = True
        turned = flipped(triangles, beside)
        if turned.any():
            triangles = triangles.copy()
            triangles[turned] = triangles[turned, ::-1]
        if not surface.cells.all():
            triangles = triangles[surface.cells]
        flat = surface.frame is not None
        return cls(
            field,
            triangles,
            np.arange(field.shape[1]),
            _sides(surface.points[0], triangles, surface.extent),
            border,
            None if flat else surface.normals[0],
        )

    def coarser(self) -> Clusters:
        """Return the next level; it has no triangles where all are smaller than the bins."""
        cluster = self._bins()
        corners = cluster[self.triangles]
        a, b, c = corners.T
        corners = corners[(a != b) & (b != c) & (a != c)]
        corners = corners[~repeated(corners)]
        used = np.zeros(int(cluster.max(initial=-1)) + 1, dtype=bool)
        used[corners] = True
        count = int(used.sum())
        fresh = np.where(used, np.cumsum(used) - 1, -1)
        cluster = fresh[cluster]
        number = np.where(self.number >= 0, cluster[self.number], -1)
        kept = cluster >= 0
        sides, border = np.zeros(count), np.zeros(count, dtype=bool)
        sides[cluster[kept]] = 2 * self.sides[kept]
        border[cluster[kept]] = self.border[kept]
        normals = None
        if self.normals is not None:
            normals = _sums(self.normals[kept], cluster[kept], count)
        return Clusters(self.field, fresh[corners], number, sides, border, normals)

    def averaged(self, field: FlowField) -> Clusters:
        """Return the same with the means of what a whole field has at the nodes it is made of."""
        kept, count = np.flatnonzero(self.number >= 0), len(self.sides)
        members = np.bincount(self.number[kept], minlength=count)
        weights = 1 / members[self.number[kept]]
        matrix = csr_array((weights, (self.number[kept], kept)), shape=(count, len(self.number)))
        data = {name: _means(steps, matrix) for name, steps in field.scalars.items()}
        level = replace(
            field,
            points=(matrix @ field.points[0])[None],
            velocity=_means(field.velocity, matrix),
            valid=np.ones((1, count), dtype=bool),
            scalars=data,
            has_position=None,
            triangles=self.triangles,
        )
        return replace(self, field=level)

    def _bins(self) -> Indices:
        """Return the cluster of each node, (n,); -1 where nothing is drawn."""
        used = np.zeros(len(self.sides), dtype=bool)
        used[self.triangles] = True
        points, sides = self.field.points[0][used], self.sides[used]
        at = ((points - points.min(axis=0)) / sides[:, None]).astype(np.int64)
        size = np.rint(np.log2(sides / sides.min())).astype(np.int64)
        key = 2 * size + self.border[used]
        for axis in range(3):
            key = key * (int(at[:, axis].max()) + 1) + at[:, axis]
        _, first, cluster = np.unique(key, return_index=True, return_inverse=True)
        if self.normals is not None:
            normals = self.normals[used]
            away = np.einsum("nc,nc->n", normals, normals[first][cluster]) < 0
            cluster = 2 * cluster + away
            cluster = _dense(cluster)
        result = np.full(len(used), -1, dtype=np.intp)
        result[used] = cluster
        return result


def _sides(points: Floats, triangles: Indices, extent: float) -> Floats:
    """Side of the first bins of each node, (N,): so many times the typical edge around it.

    A triangle counts by its area: needles, as beside the hull of points at random, are no edges.
    """
    count = len(points)
    size = np.sqrt(np.linalg.norm(triangle_normals(points, triangles), axis=-1))
    share = np.bincount(triangles.ravel(), minlength=count)
    for _ in range(SMOOTHING):
        total = sum(np.bincount(triangles[:, k], size, count) for k in range(3))
        nodal = np.divide(total, share, out=np.zeros(count), where=share > 0)
        size = nodal[triangles].mean(axis=1)
    # Nodes of cells of about one size must not fall on both sides of a power of two.
    least = extent / MOST_BINS / FIRST_EDGES
    typical = max(float(np.median(nodal[share > 0])), least)
    steps = np.rint(np.log2(np.maximum(nodal, least) / typical))
    return np.asarray(FIRST_EDGES * typical * 2.0**steps)


def _dense(numbers: Indices) -> Indices:
    """Return numbers from 0 on, without those that none has."""
    used = np.zeros(int(numbers.max(initial=-1)) + 1, dtype=bool)
    used[numbers] = True
    return np.asarray((np.cumsum(used) - 1)[numbers])


def _sums(values: Floats, number: Indices, count: int) -> Floats:
    return np.stack([np.bincount(number, column, count) for column in values.T], axis=-1)


def _means(steps: Steps, matrix: csr_array) -> Steps:
    """Means of nodal values (T, 1, N, ...) of those that are known, by rows of a matrix."""

    def mean(step: Floats) -> Floats:
        flat = step.reshape(step.shape[1], -1)
        known = np.isfinite(flat)
        if known.all():
            result = matrix @ flat
        else:
            weights = matrix @ known.astype(float)
            result = np.divide(
                matrix @ np.where(known, flat, 0.0),
                weights,
                out=np.full_like(weights, np.nan),
                where=weights > 0,
            )
        return np.asarray(result).reshape(1, -1, *step.shape[2:])

    return map_steps(steps, mean)
