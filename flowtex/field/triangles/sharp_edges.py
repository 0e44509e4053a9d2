"""Sharp edges of a surface of triangles, whose faces have velocities of other directions there.

Each face has its own nodes there, so that values of faces do not mix. A face is all triangles
around a node that are joined by edges that are not sharp. In noise, as of scanned terrain, nearly
all edges are sharp, so that faces would be single triangles; nodes stay joined there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.arrays import bounds, dot, first_places, norm, numbered, row_blocks
from flowtex.field.triangles.triangle_nodes import (
    connected_items,
    neighbours,
    touching,
    triangle_normals,
    uneven_nodes,
)

#: Cosine of the angle between two triangles from which on their edge is sharp; it is 1 in a plane.
#: The sides of a prism of ten sides are faces, and those of a cylinder in twelve parts are not.
SHARP_EDGE = 0.82
#: Cosine of half that angle: triangles that differ less from their mean have no sharp edge.
SHARP_HALF = np.sqrt((1 + SHARP_EDGE) / 2)
#: Fewest faces around a node of noise, one more than around the corner of a box.
NOISE_FACES = 4
#: Most nodes with as many faces on a surface without noise, such as the tips of pyramids, as a
#: share of all nodes.
MOST_TIPS = 0.02
#: Number up to which they are no noise: all nodes of an octahedron have four faces.
FEWEST_TIPS = 500
#: Share of such nodes among all that sharp edges connect, above which these are noise.
TIP_SHARE = 0.05
#: Fewest nodes that sharp edges connect, on a surface with noise.
LEAST_CHAIN = 20
#: The two corners after each corner of a triangle.
OTHER_CORNERS = np.array([[1, 2, 0], [2, 0, 1]])
#: Height of a triangle, as a share of the surface's extent, below which its normal is rounding.
LEAST_HEIGHT = 1e-6


class _Edges(NamedTuple):
    """Edges (E,) between two triangles each."""

    near: Indices  #: One triangle, (E,).
    far: Indices  #: The other one, (E,).
    ends: Indices  #: Nodes at both ends, (2, E).
    near_corners: Indices  #: Corners of the one triangle there, (2, E).
    far_corners: Indices  #: Corners of the other one there, (2, E).

    @classmethod
    def of(cls, triangles: Indices, beside: Indices) -> _Edges:
        flat = triangles.ravel()
        side = np.flatnonzero(beside.ravel() > np.repeat(np.arange(len(triangles)), 3))
        near = side // 3
        far = beside.ravel().take(side)
        near_corners = OTHER_CORNERS.take(side - 3 * near, axis=1)
        ends = flat.take(3 * near + near_corners)
        first = flat.take(3 * far)
        second = flat.take(3 * far + 1)
        far_corners = np.where(ends == first, 0, np.where(ends == second, 1, 2))
        return cls(near, far, ends, near_corners, far_corners)

    def sharp(self, points: Floats, crosses: Floats) -> Bools:
        """Return which are sharp, (E,), from the :func:`triangle_normals`."""
        area = norm(crosses)
        cosine = np.empty(len(self.near))
        for block in row_blocks(len(cosine), 1):
            near = crosses.take(self.near[block], axis=0)
            cosine[block] = dot(near, crosses.take(self.far[block], axis=0))
        # Two triangles that face alike pass their edge in opposite directions.
        step = self.far_corners[1] - self.far_corners[0]
        alike = (step == 2) | (step == -1)
        np.negative(cosine, out=cosine, where=~alike)
        result = cosine < SHARP_EDGE * area.take(self.near) * area.take(self.far)
        few = np.flatnonzero(result)
        length = norm(points[self.ends[1, few]] - points[self.ends[0, few]])
        least = LEAST_HEIGHT * float(np.ptp(bounds(points), axis=0).max()) * length
        lower = np.minimum(area[self.near[few]], area[self.far[few]])
        result[few] = lower > least
        return np.asarray(result)


def split_nodes(
    points: Floats,
    triangles: Indices,
    uneven: Bools | None = None,
    crosses: Floats | None = None,
) -> tuple[Indices, Indices]:
    """Give each face its own nodes at sharp edges.

    Parameters
    ----------
    points
        Positions of the nodes, (N, 3).
    triangles
        Nodes at the corners of triangles, (M, 3).
    uneven
        The nodes (N,) of :func:`uneven_nodes`, if they are known.
    crosses
        The :func:`triangle_normals`, (M, 3), if they are known.

    Returns
    -------
    triangles
        The triangles, (M, 3), with n nodes, n >= N.
    origin
        Which node each of them was, (n,); the first N keep their numbers.
    """
    count = len(points)
    if uneven is None:
        uneven = uneven_nodes(triangles, count)
    if crosses is None:
        crosses = triangle_normals(points, triangles)
    bent = uneven | _turned_nodes(triangles, crosses, count)
    if not bent.any():
        return triangles, np.arange(count)
    around = np.flatnonzero(touching(triangles, bent))
    near = triangles.take(around, axis=0)
    edges = _Edges.of(near, neighbours(points, near))
    sharp = edges.sharp(points, crosses.take(around, axis=0))
    ends = edges.ends.compress(sharp, axis=1)
    at_edge = np.zeros(count, dtype=bool)
    at_edge[ends] = True
    # As many faces as sharp edges meet in a node, and one more on a border.
    is_tip = np.bincount(ends.ravel(), minlength=count) >= NOISE_FACES
    if _in_noise(is_tip, ends, count)[at_edge].all():
        return triangles, np.arange(count)
    is_loose = at_edge.take(near).ravel()
    loose = np.flatnonzero(is_loose)  # corners
    if not len(loose):
        return triangles, np.arange(count)
    rank = np.cumsum(is_loose) - 1
    joined = at_edge[edges.ends] & ~sharp
    corners = (3 * edges.near + edges.near_corners)[joined]
    beyond = (3 * edges.far + edges.far_corners)[joined]
    face = connected_items(rank[corners], rank[beyond], len(loose))
    nodes = near.ravel()[loose[first_places(face)]]  # those of the faces
    is_tip = np.bincount(nodes, minlength=count) >= NOISE_FACES
    is_new = ~_in_noise(is_tip, ends, count)[nodes]
    is_new[first_places(numbered(nodes)[1])] = False
    number = np.where(is_new, count - 1 + np.cumsum(is_new), nodes)
    near.ravel()[loose] = number[face]
    result = triangles.copy()
    result[around] = near
    return result, np.concatenate([np.arange(count), nodes[is_new]])


def _in_noise(is_tip: Bools, ends: Indices, count: int) -> Bools:
    """Return which nodes (count,) lie in noise: many tips are there, or sharp edges end soon.

    Tips are nodes of many faces, (count,), and ``ends`` the nodes of sharp edges, (2, E).
    """
    if np.count_nonzero(is_tip) <= max(FEWEST_TIPS, MOST_TIPS * count):
        return np.zeros(count, dtype=bool)
    chain = connected_items(ends[0], ends[1], count)
    size = np.bincount(chain)
    tips = np.bincount(chain, is_tip)
    is_noise = (tips > TIP_SHARE * size) | (size < LEAST_CHAIN)
    return np.asarray(is_noise[chain])


def _turned_nodes(triangles: Indices, crosses: Floats, count: int) -> Bools:
    """Return the nodes (count,) around which triangles may be turned as far as at a sharp edge.

    Triangles that differ so far differ half as far from any third one around the node.
    """
    area = np.empty(len(triangles))
    other_of = np.empty(count, dtype=np.intp)
    for block in row_blocks(len(triangles), 1):
        area[block] = norm(crosses[block])
        other_of[triangles[block]] = np.arange(block.start, block.stop)[:, None]
    result = np.zeros(count, dtype=bool)
    for block in row_blocks(len(triangles), 1):
        corners = triangles[block]
        others = other_of.take(corners)
        alike = np.einsum("mkc,mc->mk", crosses.take(others, axis=0), crosses[block])
        turned = alike <= SHARP_HALF * area.take(others) * area[block, None]
        result[corners[turned]] = True
    return result
