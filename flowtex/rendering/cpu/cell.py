"""Paths beside a critical point: ``shaders/common/cell.glsl`` for many fragments at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering import constants as const
from flowtex.rendering.cpu.path import Slices

__all__ = ["CellPath"]


class CellPath:
    """Paths of N fragments that follow the velocity of the four nodes around each.

    Parameters
    ----------
    slices
        The slice texture.
    coordinate, reach
        Texture coordinates (N, 2), and lengths of a side of the paths, (N,).
    values
        The uniforms.

    Attributes
    ----------
    share
        Share of these paths in those of the fragments, (N,).
    """

    def __init__(
        self, slices: Slices, coordinate: Floats, reach: Floats, values: Mapping[str, Any]
    ) -> None:
        size = np.array(values["u_slicesSize"])
        at = coordinate * size - 0.5
        f, finest = at - np.floor(at), np.zeros(len(at))
        (x, y), one = f.T, np.ones(len(at))
        # Factors of 1, x, y and x y, node by node.
        about = np.array(
            [
                [(1 - x) * (1 - y), y - 1, x - 1, one],
                [x * (1 - y), 1 - y, -x, -one],
                [(1 - x) * y, -y, 1 - x, -one],
                [x * y, y, x, one],
            ]
        )
        both = np.zeros((len(at), 5, 4))
        speed, rate = np.zeros((2, len(at)))
        for right, weights in zip(((0, 0), (1, 0), (0, 1), (1, 1)), about, strict=True):
            node = (np.floor(at) + right + 0.5) / size
            tangent, turn = (slices.layer(node, n, finest) for n in (0, values["u_rateLayer"]))
            moved = tangent[:, :3] * turn[:, 3:]
            cells = turn[:, :2] * (turn[:, 3:] / (tangent[:, 3:] * values["u_cell"]))
            both += np.concatenate([moved, cells], axis=1)[:, :, None] * weights.T[:, None]
            speed += weights[0] * np.linalg.norm(moved, axis=1)
            rate += weights[0] * np.linalg.norm(cells, axis=1)
        speed = np.maximum(speed, const.LEAST_SPEED)
        agreed = np.linalg.norm(both[:, :3, 0], axis=1) / speed
        far = _smoothstep(const.NEAR_CELLS, const.FAR_CELLS, reach * rate / speed)
        self.share = (1 - _smoothstep(const.PARTING, const.AGREED, agreed)) * (1 - far)
        # Only where it is wanted.
        self._some = np.flatnonzero(self.share)
        self._both = both[self._some] / speed[self._some, None, None]
        self.leave()

    def leave(self) -> None:
        """Begin a side of the paths."""
        self._at, self._alive = np.zeros((len(self._some), 5)), np.ones(len(self._some))

    def go_on(self, length: Floats, alive: Floats) -> Floats:
        """Go on by lengths (N,); return what is left of the weights (N,)."""
        step = length[self._some]
        first = self._velocity(self._at)
        square = np.maximum(_dot(first, first), const.LEAST_SQUARE)
        middle = self._velocity(self._at + (0.5 * step / np.sqrt(square))[:, None] * first)
        speed = np.sqrt(np.maximum(_dot(middle, middle), const.LEAST_SQUARE))
        self._at += (step / speed)[:, None] * middle
        lost = 2.0 * np.maximum(square - _dot(first, middle), const.LEAST_SQUARE)
        self._alive = np.where(self._alive < 1, 0.0, np.minimum(square / lost, 1.0))
        return self._mix(alive, self._alive)

    def mixed(self, displacement: Floats) -> Floats:
        """Displacements (N, 3) with those of these paths mixed in."""
        return self._mix(displacement, self._at[:, :3])

    def _mix(self, values: Floats, own: Floats) -> Floats:
        result, share = values.copy(), self.share[self._some]
        result[self._some] += (share * (own - result[self._some]).T).T
        return np.asarray(result)

    def _velocity(self, at: Floats) -> Floats:
        """Velocity in space and in cells, (n, 5), at points given as both."""
        x, y = at[:, 3:].T
        factors = np.stack([np.ones_like(x), x, y, x * y])
        return np.asarray(np.einsum("nck,kn->nc", self._both, factors))


def _dot(a: Floats, b: Floats) -> Floats:
    """Products of velocities in space, (n,)."""
    return np.asarray(np.einsum("nc,nc->n", a[:, :3], b[:, :3]))


def _smoothstep(low: float, high: float, x: Floats) -> Floats:
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t))
