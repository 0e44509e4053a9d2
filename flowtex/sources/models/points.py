"""Scattered points on the Earth or in a plane: triangles between neighbours, none across gaps."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field.triangles.topology import triangle_normals

#: Fewest points of a surface; fewer are stations.
FEWEST = 30
#: Circumradius, in those of typical triangles nearby, from which on a triangle spans a gap: times
#: the ninth decile of all, as random points are less even than those of a grid; and at most.
GAP, WIDEST_GAP = 2.4, 4.0
#: Shortest edge of a typical triangle in its circumradius, below which points lie along a line.
THIN = 0.08
#: Cosine of the angle around their middle within which points on the sphere fit into a plane.
WITHIN = 0.2


def join_points(positions: Floats, *, on_sphere: bool) -> Indices:
    """Return triangles between neighbours, (M, 3), of points (N, 3) on a sphere or in a plane."""
    return _joined(np.ascontiguousarray(positions, dtype=float).tobytes(), on_sphere)


@lru_cache(maxsize=4)
def _joined(data: bytes, on_sphere: bool) -> Indices:  # noqa: FBT001
    p = np.frombuffer(data).reshape(-1, 3)
    used = np.flatnonzero(np.isfinite(p).all(axis=1))
    p = p[used]
    if len(p) < FEWEST:
        msg = (
            f"there are {len(p)} points with a position; expected at least {FEWEST} points, "
            "between which triangles make a surface. Interpolate the values of stations to a grid"
        )
        raise FieldError(msg)
    p = p / np.linalg.norm(p, axis=1, keepdims=True) if on_sphere else p
    triangles = _on_sphere(p) if on_sphere else _in_plane(p[:, :2])
    if len(triangles):
        shortest, radii = _sizes(p, triangles)
        if np.median(shortest / radii) >= THIN:
            triangles = triangles[~_across_gaps(triangles, radii, len(p))]
            if 2 * len(np.unique(triangles)) > len(p):
                return used[triangles]
    msg = (
        f"the {len(p):,} points lie along lines, or in groups far from each other, so no triangles "
        "between neighbours make a surface. Flowtex draws surfaces, not trajectories or "
        "stations; interpolate the values to a grid"
    )
    raise FieldError(msg)


def _on_sphere(p: Floats) -> Indices:
    """Join unit vectors (N, 3), as Delaunay triangles of the sphere, with outward normals."""
    from scipy.spatial import ConvexHull, QhullError

    middle = p.mean(axis=0)
    middle /= max(float(np.linalg.norm(middle)), np.finfo(float).tiny)
    if (p @ middle).min() > WITHIN:
        # Stereographic maps keep circles, so these are the triangles of the sphere.
        axes = np.linalg.svd(middle[None])[2]
        axes[2] *= np.sign(np.linalg.det(axes) * (axes[0] @ middle))
        return _in_plane((p - middle) @ axes[1:].T / (1 + p @ middle)[:, None])
    try:
        triangles = ConvexHull(p).simplices.astype(np.int64)
    except QhullError:  # on one circle
        return np.zeros((0, 3), dtype=np.intp)
    inward = (triangle_normals(p, triangles) * p[triangles[:, 0]]).sum(axis=1) < 0
    triangles[inward] = triangles[inward, ::-1]
    return triangles


def _in_plane(p: Floats) -> Indices:
    """Join points (N, 2) by Delaunay triangles, counterclockwise."""
    from scipy.spatial import Delaunay, QhullError

    # Without units, as lengths along both axes may be of any size.
    p = (p - p.mean(axis=0)) / max(float(np.abs(np.ptp(p, axis=0)).max()), np.finfo(float).tiny)
    try:
        return np.asarray(Delaunay(p).simplices.astype(np.int64))
    except QhullError:  # on one line
        return np.zeros((0, 3), dtype=np.intp)


def _sizes(p: Floats, triangles: Indices) -> tuple[Floats, Floats]:
    """Return the shortest edges and the circumradii of triangles, (M,) each."""
    edges = np.linalg.norm(p[triangles] - p[np.roll(triangles, 1, axis=1)], axis=-1)
    doubled = np.linalg.norm(triangle_normals(p, triangles), axis=1)
    tiny = np.finfo(float).tiny
    return edges.min(axis=1), np.maximum(edges.prod(axis=1) / np.maximum(2 * doubled, tiny), tiny)


def _across_gaps(triangles: Indices, radii: Floats, count: int) -> Bools:
    """Return which triangles are much larger than those around their nodes, (M,)."""
    corners = triangles.ravel()
    number = np.maximum(np.bincount(corners, minlength=count), 1)
    share = 1 / radii
    for _ in range(2):  # harmonic means, to which triangles across gaps add little
        typical = np.bincount(corners, np.repeat(share, 3), count) / number
        share = typical[triangles].mean(axis=1)
    ratio = radii * share
    limit = min(GAP * float(np.quantile(ratio, 0.9)), WIDEST_GAP)
    return np.asarray(ratio > limit)
