"""Displacements of the nodes in space, from those in index space.

The same interpolation as :meth:`flowtex.field.surface.Surface.at`, written for millions of
look-ups: each coordinate is an array of its own, and blocks stay in a processor's cache.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats
from flowtex.field.interpolation import cell_of, cubic_weights
from flowtex.field.surface import Surface

__all__ = ["NodeDisplacements"]


#: Nodes looked up together.
BLOCK = 16384
#: Tangents that differ by less than this share of the longest make a map linear.
LINEAR = 1e-9


class NodeDisplacements:
    """Map from displacements in index space to those in space, for all nodes of a surface.

    The rows of ``frame`` (C, 3) take a vector to the frame of the results.
    """

    def __init__(self, surface: Surface, frame: Floats) -> None:
        self._surface = surface
        self._width = surface.shape[1] + 2
        local = np.moveaxis(surface.tangents @ frame.T, -1, 0)
        #: Tangents by component, (C, 2, J * I).
        self._tangents = np.ascontiguousarray(local).reshape(len(frame), 2, -1)
        first = self._tangents[..., :1]
        spread = np.abs(self._tangents - first).max()
        self._linear = bool(spread <= LINEAR * np.abs(first).max())
        self._points = self._components(surface.points, frame)
        self._padded = self._components(surface.padded, frame)
        self._offset = surface.offset @ frame.T

    def __call__(self, displacement: NDArray[np.floating]) -> Floats:
        """Return displacements in space (C, J, I) of those in index space, (J, I, 2) in cells."""
        rows, columns = self._surface.shape
        along_i, along_j = (displacement[..., c].astype(float).ravel() for c in range(2))
        if self._linear:
            p, q = self._tangents[..., 0].T[..., None]
            return np.asarray(p * along_i + q * along_j).reshape(-1, rows, columns)
        result = np.empty_like(self._points)
        for first in range(0, rows * columns, BLOCK):
            block = slice(first, first + BLOCK)
            node = np.arange(rows * columns)[block]
            j, i = np.divmod(node.astype(float), columns)
            i += along_i[block]
            j += along_j[block]
            result[:, block] = self._at(i, j) - self._points[:, block]
        return result.reshape(-1, rows, columns)

    def _at(self, i: Floats, j: Floats) -> Floats:
        """Positions in the frame, (C, N)."""
        rows, columns = self._surface.shape
        closed_j, closed_i = self._surface.periodic
        if self._surface.poles is not None:
            i, j = self._surface.poles.fold(np.stack([i, j]))
        i0, si, beyond_i, turns_i = cell_of(i, columns, periodic=closed_i)
        j0, sj, beyond_j, turns_j = cell_of(j, rows, periodic=closed_j)
        wi, wj = cubic_weights(si), cubic_weights(sj)
        corner = j0 * self._width + i0
        result = np.zeros((len(self._padded), len(i)))
        for b in range(4):
            at = [corner + (b * self._width + a) for a in range(4)]
            for out, nodes in zip(result, self._padded, strict=True):
                row = wi[0] * nodes.take(at[0], mode="clip")
                for a in range(1, 4):
                    row += wi[a] * nodes.take(at[a], mode="clip")
                row *= wj[b]
                out += row
        if beyond_i.any() or beyond_j.any():
            near_i = np.clip(np.rint(i), 0, columns - 1).astype(np.intp)
            near_j = np.clip(np.rint(j), 0, rows - 1).astype(np.intp)
            tangents = self._tangents[..., near_j * columns + near_i]
            result += beyond_i * tangents[:, 0] + beyond_j * tangents[:, 1]
        if closed_i or closed_j:
            result += turns_i * self._offset[1][:, None] + turns_j * self._offset[0][:, None]
        return result

    def _components(self, points: Floats, frame: Floats) -> Floats:
        """Coordinates in the frame, relative to the middle of the surface, (C, nodes)."""
        local = (points - self._surface.center) @ frame.T
        return np.ascontiguousarray(local.reshape(-1, len(frame)).T)
