"""Displacements of the nodes in space, from those in index space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats
from flowtex.field.surface import CubicMap, Surface

__all__ = ["NodeDisplacements"]


#: Nodes looked up together, so few that they stay in a processor's cache.
BLOCK = 16384
#: Tangents that differ by less than this share of the longest make a map linear.
LINEAR = 1e-9


class NodeDisplacements:
    """Map from displacements in index space to those in space, for some nodes of a surface.

    The rows of ``frame`` (C, 3) take a vector to the frame of the results; ``nodes`` are rows and
    columns of the surface.
    """

    def __init__(
        self,
        surface: Surface,
        frame: Floats,
        nodes: tuple[slice, slice] = (slice(None), slice(None)),
    ) -> None:
        self._map = CubicMap(surface, frame, surface.center)
        rows, columns = (np.arange(n)[part] for n, part in zip(surface.shape, nodes, strict=True))
        self._shape = len(rows), len(columns)
        self._j, self._i = (a.ravel() for a in np.meshgrid(rows, columns, indexing="ij"))
        self._first = self._map.tangents[..., :1]
        spread = np.abs(self._map.tangents - self._first).max()
        self._linear = bool(spread <= LINEAR * np.abs(self._first).max())
        local = (surface.points[nodes] - surface.center) @ frame.T
        self._points = np.ascontiguousarray(local.reshape(-1, len(frame)).T)

    def __call__(self, displacement: NDArray[np.floating]) -> Floats:
        """Return displacements in space (C, J, I) of those in index space, (J, I, 2) in cells."""
        rows, columns = self._shape
        along_i, along_j = (displacement[..., c].astype(float).ravel() for c in range(2))
        if self._linear:
            p, q = np.moveaxis(self._first, 1, 0)
            return np.asarray(p * along_i + q * along_j).reshape(-1, rows, columns)
        result = np.empty_like(self._points)
        for first in range(0, rows * columns, BLOCK):
            block = slice(first, first + BLOCK)
            i, j = self._i[block] + along_i[block], self._j[block] + along_j[block]
            result[:, block] = self._map.at(i, j) - self._points[:, block]
        return result.reshape(-1, rows, columns)
