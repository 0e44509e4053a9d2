"""Components along the rows and columns of a curvilinear grid, turned to those of the Earth."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.earth import GLOBE, Projection
from flowtex.field.datasets.places import Places, over_sphere


def turned(places: Places, ahead: tuple[int, int], u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return components eastward and northward, or along x and y, of those along rows and columns.

    ``ahead`` tells the ways of (rows, columns), 1 or -1.
    """
    flat = np.stack([places.a, places.b], axis=-1)
    p = over_sphere(places) if places.is_earth else flat
    ahead_j, ahead_i = ahead
    along_i, along_j = ahead_i * _unit(_along(p, 1)), ahead_j * _unit(_along(p, 0))
    vector = u[..., None] * along_i + v[..., None] * along_j
    if places.is_earth:
        return Projection(GLOBE).components(places.a, places.b, vector)
    return vector[..., 0], vector[..., 1]


def _along(p: Floats, axis: int) -> Floats:
    """Return differences of positions along an axis, one-sided where a neighbour is not known."""
    p = np.swapaxes(p, 0, axis)
    ahead = np.full_like(p, np.nan)
    ahead[:-1] = p[1:] - p[:-1]
    behind = np.full_like(p, np.nan)
    behind[1:] = ahead[:-1]
    both = np.where(np.isnan(ahead), behind, np.where(np.isnan(behind), ahead, ahead + behind))
    return np.swapaxes(both, 0, axis)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1.0))
