"""Components along the rows and columns of a curvilinear grid, turned to those of the Earth."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field.datasets.places import Places, over_sphere

__all__ = ["turned"]


def turned(places: Places, ahead: tuple[int, int], u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """Return components eastward and northward, or along x and y, of those along rows and columns.

    ``ahead`` tells the ways of (rows, columns), 1 or -1.
    """
    if not places.is_earth:
        p = np.stack([places.a, places.b], axis=-1)
        basis = [np.array([1.0, 0.0]), np.array([0.0, 1.0])]
    else:
        p = over_sphere(places)
        lon, lat = np.radians(places.a), np.radians(places.b)
        zero = np.zeros_like(lon)
        basis = [
            np.stack([-np.sin(lon), np.cos(lon), zero], axis=-1),
            np.stack(
                [-np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), np.cos(lat)], axis=-1
            ),
        ]
    ahead_j, ahead_i = ahead
    along_i, along_j = ahead_i * _unit(_along(p, 1)), ahead_j * _unit(_along(p, 0))
    vector = u[..., None] * along_i + v[..., None] * along_j
    east, north = (
        np.einsum("jic,...c->ji" if b.ndim == 1 else "jic,jic->ji", vector, b) for b in basis
    )
    return east, north


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
