"""The velocity on a surface of triangles, also where that has sharp edges.

At a node of an edge the tangent plane lies between the faces, and a velocity has a greater part in
it than in either of them. The speed there is the mean of those in the faces, as it is all around.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.field.metric import IndexVelocity, to_index_space
from flowtex.field.triangles.surface import TriangleSurface

__all__ = ["velocity_on_triangles"]

#: Cosine of the angle between the normals of a node and a triangle below which there is an edge.
SHARP = 0.94


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
