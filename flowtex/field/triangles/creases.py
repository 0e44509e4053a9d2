"""Sharp edges of surfaces of triangles: the velocity there, and the normals beside them.

At a node of an edge the tangent plane lies between the faces, and a velocity has a greater part in
it than in either of them. The speed there is the mean of those in the faces, as it is all around.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.metric import IndexVelocity, to_index_space
from flowtex.field.triangles.surface import TriangleSurface

#: Cosine of the angle between the normals of a node and a triangle below which there is an edge.
SHARP = 0.86


def normals_at_corners(points: Floats, normals: Floats) -> Floats:
    """Return normals at the corners of triangles, (..., 3, 3), as light and views are to have them.

    They are those of the nodes there, (..., 3, 3) as the ``points`` are, and where these belong to
    a sharp edge that of the triangle, so that every face is even up to its end.
    """
    across = np.cross(points[..., 1, :] - points[..., 0, :], points[..., 2, :] - points[..., 0, :])
    alike = np.einsum("...c,...kc->...k", across, normals)
    length = np.linalg.norm(across, axis=-1)[..., None]
    sharp = np.abs(alike) < SHARP * length
    own = across / np.maximum(length, np.finfo(float).tiny)
    faced = np.where(alike < 0, -1.0, 1.0)[..., None] * own[..., None, :]
    return np.where(sharp[..., None], faced, normals)


def velocity_on_triangles(surface: TriangleSurface, velocity: Floats) -> IndexVelocity:
    """Express a velocity (T, 1, N, 3) in the tangent planes, as :func:`to_index_space` does."""
    flow = to_index_space(surface, velocity)
    triangle, corner = _at_edges(surface)
    if not len(triangle):
        return flow
    nodes = surface.triangles[triangle, corner]
    some, at = np.unique(nodes, return_inverse=True)
    unit = surface.crosses[triangle]
    unit = unit / np.maximum(np.linalg.norm(unit, axis=1, keepdims=True), np.finfo(float).tiny)
    count = np.bincount(at)
    components, speed = flow.components.copy(), flow.speed.copy()
    for step in range(len(velocity)):
        v = velocity[step, 0, nodes]
        within = np.linalg.norm(v - np.sum(v * unit, axis=1, keepdims=True) * unit, axis=1)
        mean = np.bincount(at, within) / count
        whole = speed[step, 0, some]
        share = np.divide(mean, whole, out=np.zeros_like(mean), where=whole > 0).clip(max=1.0)
        speed[step, 0, some] *= share
        components[step, 0, some] *= share[:, None]
    return replace(flow, components=components, speed=speed)


def _at_edges(surface: TriangleSurface) -> tuple[Indices, Indices]:
    """Triangles and their corners (K,) that lie at sharp edges."""
    length = np.linalg.norm(surface.crosses, axis=1)
    sharp = np.zeros(surface.shape[1], dtype=bool)
    for k in range(3):
        nodes = surface.triangles[:, k]
        alike = np.einsum("mc,mc->m", surface.crosses, surface.normals[0, nodes])
        sharp[nodes[alike < SHARP * length]] = True
    return np.nonzero(sharp[surface.triangles])  # type: ignore[return-value]
