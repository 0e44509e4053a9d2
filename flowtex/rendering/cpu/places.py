"""Places at which fragments look the slices up, on a grid and on triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from flowtex._util.array_types import Floats, Indices


@dataclass(frozen=True, eq=False)
class TrianglePlaces:
    """Places of N fragments in their triangles."""

    #: Shares of the corners, and numbers of the nodes there in the texture, (N, 3) each.
    shares: Floats
    nodes: Indices
    #: Change of the shares of the second and the third corner by a vector in the surface's frame,
    #: (N, 2, 3).
    by: Floats

    def __getitem__(self, selection: slice | Indices) -> TrianglePlaces:
        """Return a part of the fragments."""
        return TrianglePlaces(self.shares[selection], self.nodes[selection], self.by[selection])

    def __len__(self) -> int:
        """Count the fragments."""
        return len(self.shares)


#: Places of N fragments: at texture coordinates (N, 2), or in triangles.
Places: TypeAlias = Floats | TrianglePlaces


def moved(places: Places, by: Floats) -> Places:
    """Return places whose coordinates, or last two shares, are larger by (N, 2)."""
    if not isinstance(places, TrianglePlaces):
        return np.asarray(places + by)
    shares = places.shares + np.concatenate([-by.sum(axis=1, keepdims=True), by], axis=1)
    return TrianglePlaces(shares, places.nodes, places.by)


def coordinates_by(dx: Floats, dy: Floats, by_x: Floats, by_y: Floats) -> Floats:
    """Return the change of coordinates by a vector, (N, 2, 3), from derivatives on the screen.

    They are those of positions, (N, 3), and of the coordinates, (N, 2).
    """
    normal = np.cross(dx, dy)
    square = np.einsum("nc,nc->n", normal, normal)[:, None]
    across = normal / np.maximum(square, np.finfo(float).tiny)
    first, second = np.cross(dy, across), np.cross(across, dx)
    return np.asarray(by_x[:, :, None] * first[:, None] + by_y[:, :, None] * second[:, None])
