"""Triangles between scattered points, without those across gaps."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.triangles.triangle_nodes import triangle_normals
from flowtex.sources.models.rings import join_rings, whole_rings

#: A length, and perhaps its unit.
LENGTH = re.compile(
    r"(?P<number>[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)\s*(?P<unit>[^\W\d].*)?", re.IGNORECASE
)
#: Fewest points of a surface; fewer are stations.
FEWEST = 30
#: Circumradius, in those of typical triangles nearby, from which on a triangle spans a gap: times
#: the ninth decile of all, as random points are less even than those of a grid.
GAP = 2.4
#: Circumradius from which on any triangle spans a gap.
WIDEST_GAP = 4.0
#: Shortest edge of a typical triangle in its circumradius, below which points lie along a line.
THIN = 0.08
#: Cosine of the angle around their middle within which points on the sphere fit into a plane.
WITHIN = 0.2


def edge_length(text: Any, unit: str, *, default: str) -> float:
    """Return a length such as ``50`` or ``"50 km"`` in a unit.

    A number without a unit is in the ``default`` one.

    Raises
    ------
    FieldError
        When the value is not a positive length, or its unit is not one of length.
    """
    found = LENGTH.fullmatch(str(text).strip())
    own = default
    if found is not None and found["unit"]:
        own = found["unit"]
    factor = 1.0
    if own != unit:
        factor = units.factor(own, unit) or np.nan
    length = np.nan
    if found is not None and not isinstance(text, bool):
        length = float(found["number"]) * factor
    if not (np.isfinite(length) and length > 0):
        raise FieldError(
            f"max_edge is {text!r}; expected the length of the longest edge, a positive number in "
            f"{default or 'the unit of the positions'}, or with a unit, as in '50 km'"
        )
    return float(length)


def join_points(positions: Floats, *, on_sphere: bool, max_edge: float | None = None) -> Indices:
    """Return triangles between neighbours, (M, 3), of points (N, 3) on a sphere or in a plane.

    Triangles across gaps are left out: those with an edge longer than ``max_edge``, along the
    sphere, or without it those that are much larger than others nearby. Raises a FieldError if no
    surface is left.
    """
    return _joined(np.ascontiguousarray(positions, dtype=float).tobytes(), on_sphere, max_edge)


@lru_cache(maxsize=4)
def _joined(data: bytes, on_sphere: bool, max_edge: float | None) -> Indices:  # noqa: FBT001
    p = np.frombuffer(data).reshape(-1, 3)
    used = np.flatnonzero(np.isfinite(p).all(axis=1))
    p = p[used]
    if len(p) < FEWEST:
        raise FieldError(
            f"there are {len(p)} points with a position; expected at least {FEWEST} points, "
            "between which triangles make a surface. Interpolate the values of stations to a grid"
        )
    radius = 1.0
    if on_sphere:
        radius = float(np.linalg.norm(p[0]))
        p = p / np.linalg.norm(p, axis=1, keepdims=True)
        triangles = _on_sphere(p)
    else:
        triangles = _in_plane(p[:, :2])
    if max_edge is not None and len(triangles):
        kept = _with_short_edges(p, triangles, radius, max_edge, on_sphere=on_sphere)
        return used[kept]
    if len(triangles):
        edges = np.linalg.norm(p[triangles] - p[np.roll(triangles, 1, axis=1)], axis=-1)
        doubled = np.linalg.norm(triangle_normals(p, triangles), axis=1)
        tiny = np.finfo(float).tiny
        radii = np.maximum(edges.prod(axis=1) / np.maximum(2 * doubled, tiny), tiny)
        if np.median(edges.min(axis=1) / radii) >= THIN:
            triangles = triangles[~_across_gaps(triangles, radii, len(p))]
            if 2 * len(np.unique(triangles)) > len(p):
                return used[triangles]
    raise FieldError(
        f"the {len(p):,} points lie along lines, or in groups far from each other, so no triangles "
        "between neighbours make a surface; interpolate the values to a grid"
    )


def _on_sphere(p: Floats) -> Indices:
    """Join unit vectors (N, 3), as Delaunay triangles of the sphere, with outward normals.

    Whole rings of latitude, as of HEALPix and reduced Gaussian grids, are joined one by one.
    """
    rings = whole_rings(p)
    if rings is not None:
        return join_rings(rings)
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


def _with_short_edges(
    p: Floats, triangles: Indices, radius: float, max_edge: float, *, on_sphere: bool
) -> Indices:
    """Return the triangles without an edge that is longer, along the sphere on one."""
    edges = np.linalg.norm(p[triangles] - p[np.roll(triangles, 1, axis=1)], axis=-1)
    unit = ""
    if on_sphere:
        edges = 2 * np.arcsin(np.minimum(edges / 2, 1.0))
        unit = " m"
    longest = radius * edges.max(axis=1)
    kept = triangles[longest <= max_edge]
    if not len(kept):
        raise FieldError(
            f"max_edge is {max_edge:.4g}{unit}, and every triangle between neighbours has a longer "
            f"edge; in half of them it is up to {np.median(longest):.4g}{unit}. Increase max_edge"
        )
    return kept
