"""Displacements of the nodes in space, from those in index space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Floats32
from flowtex.field.grids.surface import CubicMap, GridSurface

#: Nodes looked up together, so few that they stay in a processor's cache.
BLOCK = 16384
#: Tangents that differ by less than this share of the longest make a map linear.
LINEAR = 1e-6


class NodeDisplacements:
    """Map from displacements in index space to those in space, for some nodes of a surface.

    The rows of ``frame`` (C, 3) take a vector to the frame of the results; ``nodes`` are rows and
    columns of the surface.
    """

    def __init__(
        self,
        surface: GridSurface,
        frame: Floats,
        nodes: tuple[slice, slice] = (slice(None), slice(None)),
    ) -> None:
        # Counted from the middle and from the nodes, single precision does.
        self._map = CubicMap(surface, frame, surface.center, np.float32)
        rows, columns = (np.arange(n)[part] for n, part in zip(surface.shape, nodes, strict=True))
        self._shape = len(rows), len(columns)
        self._j, self._i = (a.ravel() for a in np.meshgrid(rows, columns, indexing="ij"))
        self._points = self._map.nodes[:, self._j * surface.shape[1] + self._i]
        self._first = self._map.tangents[..., :1]
        spread = np.abs(self._map.tangents - self._first).max()
        self._linear = bool(spread <= LINEAR * np.abs(self._first).max())

    def __call__(self, displacement: NDArray[np.floating], error: float = 0.0) -> Floats32:
        """Return displacements in space (C, J, I) of those in index space, (J, I, 2) in cells.

        Such an error is allowed in what is left out of the cubics.
        """
        rows, columns = self._shape
        along_i, along_j = (displacement[..., c].astype(np.float32).ravel() for c in range(2))
        if self._linear:
            p, q = np.moveaxis(self._first, 1, 0)
            return np.asarray(p * along_i + q * along_j).reshape(-1, rows, columns)
        result = np.empty_like(self._points)
        for first in range(0, rows * columns, BLOCK):
            block = slice(first, first + BLOCK)
            start = self._i[block], self._j[block]
            result[:, block] = self._map.at(along_i[block], along_j[block], start, error)
        result -= self._points
        return result.reshape(-1, rows, columns)
