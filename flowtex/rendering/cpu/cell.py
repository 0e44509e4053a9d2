"""Paths near a critical point: ``shaders/common/cell.glsl`` for many fragments at once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex._util.arrays import norm, smoothstep
from flowtex.rendering.cpu.path import Places, Slices, TrianglePlaces, TriangleSlices
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values


class CellPath:
    """Paths (N,) that follow the velocity of the nodes around; ``reach`` is a side's length."""

    def __init__(self, slices: Slices, coordinate: Places, reach: Floats, values: Values) -> None:
        if isinstance(coordinate, TrianglePlaces):
            assert isinstance(slices, TriangleSlices)
            factors, nodes = _triangle(slices, coordinate, values)
        else:
            factors, nodes = _square(slices, coordinate, values)
        coefficients = np.zeros((len(reach), 5, len(factors)))
        speed, rate, sine_off, alone = np.zeros((4, len(reach)))
        together = np.zeros((len(reach), 3))
        for weights, (in_space, in_cells, lengths, sine) in zip(factors, nodes, strict=True):
            coefficients += (
                np.concatenate([in_space, in_cells], axis=1)[:, :, None] * weights.T[:, None]
            )
            speed += weights[0] * lengths[0]
            rate += weights[0] * lengths[1]
            together += in_space
            alone += lengths[0]
            sine_off = np.maximum(sine_off, sine)
        speed = np.maximum(speed, const.LEAST_SPEED)
        if isinstance(coordinate, TrianglePlaces):
            rate = np.minimum(rate, const.SLIVER_CELLS * speed * _sliver(coordinate))
        agreed = norm(coefficients[:, :3, 0]) / speed
        # Also of all nodes alike: paths part between two that agree beside a third that does not.
        alike = norm(together) / np.maximum(alone, const.LEAST_SPEED)
        agreed = np.minimum(agreed, alike)
        edge = smoothstep(const.ALONG_PLANE, const.OFF_PLANE, sine_off)
        cells = reach * rate / speed / (1 + (const.EDGE_CELLS - 1) * edge)
        far = smoothstep(const.NEAR_CELLS, const.FAR_CELLS, cells)
        #: Share with which these paths are mixed into the paths of the fragments, (N,).
        self.share = np.maximum(1 - smoothstep(const.PARTING, const.AGREED, agreed), edge)
        self.share *= 1 - far
        self._near = np.flatnonzero(self.share)
        self._coefficients = coefficients[self._near] / speed[self._near, None, None]
        self.leave()

    def leave(self) -> None:
        """Return to the fragments, to follow a side of the paths."""
        self._at = np.zeros((len(self._near), 5))
        self._alive = np.ones(len(self._near))

    def go_on(self, length: Floats, alive: Floats) -> Floats:
        """Follow the paths by lengths (N,); return the weights (N,) that remain."""
        step = length[self._near]
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

    def direction(self, direction: Floats, offset: Floats) -> Floats:
        """Directions (N, 3) with those of these paths, ``offset`` cells (N, 2) away, mixed in."""
        at = np.zeros_like(self._at)
        at[:, 3:] = offset[self._near]
        return self._mix(direction, unit(self._velocity(at)[:, :3]))

    def _mix(self, values: Floats, cell_values: Floats) -> Floats:
        result = values.copy()
        share = self.share[self._near]
        result[self._near] += (share * (cell_values - result[self._near]).T).T
        return np.asarray(result)

    def _velocity(self, at: Floats) -> Floats:
        """Velocity in space and in cells, (n, 5), at points given as both."""
        x, y = at[:, 3:].T
        factors = np.stack([np.ones_like(x), x, y, x * y])[: self._coefficients.shape[2]]
        return np.asarray(np.einsum("nck,kn->nc", self._coefficients, factors))


def _sliver(places: TrianglePlaces) -> Floats:
    """Return inverses of the longest sides of triangles times the sines of the angles opposite."""
    one = places.by[:, 0]
    two = places.by[:, 1]
    # Heights, over the area, are as the sides.
    sides = norm(np.stack([one, two, one + two]))
    return np.asarray(sides.prod(axis=0) / np.square(sides.max(axis=0)))


#: A node's velocity in space, (N, 3), in cells, (N, 2), its lengths in both, (N,) each, and the
#: sine of the angle by which it or its paths leave the plane of the cell, (N,).
_Node = tuple[Floats, Floats, tuple[Floats, Floats], Floats]


def _square(slices: Slices, coordinate: Floats, values: Values) -> tuple[Floats, Iterator[_Node]]:
    """Return the factors (4, 4, N) of 1, x, y and x y of each of four nodes, and the nodes."""
    size = np.array(values["u_slicesSize"])
    texel = coordinate * size - 0.5
    f = texel - np.floor(texel)
    finest = np.zeros(len(texel))
    (x, y) = f.T
    one = np.ones(len(texel))
    factors = np.array(
        [
            [(1 - x) * (1 - y), y - 1, x - 1, one],
            [x * (1 - y), 1 - y, -x, -one],
            [(1 - x) * y, -y, 1 - x, -one],
            [x * y, y, x, one],
        ]
    )

    def node(right: tuple[int, int]) -> _Node:
        position = (np.floor(texel) + right + 0.5) / size
        tangent = slices.layer(position, 0, finest)
        turn = slices.layer(position, values["u_rateLayer"], finest)
        by = turn[:, :2] * (turn[:, 3:] / (tangent[:, 3:] * values["u_cell"]))
        moved = tangent[:, :3] * turn[:, 3:]
        return moved, by, (norm(moved), norm(by)), 0 * one

    return factors, map(node, ((0, 0), (1, 0), (0, 1), (1, 1)))


def _triangle(
    slices: TriangleSlices, places: TrianglePlaces, values: Values
) -> tuple[Floats, Iterator[_Node]]:
    """Return the factors (3, 3, N) of 1, x and y of each of three nodes, and the nodes."""
    one = np.ones(len(places))
    none = np.zeros(len(places))
    normal = np.cross(places.by[:, 0], places.by[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    a, b, c = places.shares.T
    factors = np.array([[a, -one, -one], [b, one, none], [c, none, one]])

    def node(number: Indices) -> _Node:
        tangent = slices.at_node(number, 0)
        turn = slices.at_node(number, values["u_rateLayer"])
        moved = tangent[:, :3] * turn[:, 3:]
        by = np.einsum("nkc,nc->nk", places.by, moved)
        lengths = norm(moved), np.sqrt((by**2).sum(axis=1) + by[:, 0] * by[:, 1])
        height = np.einsum("nc,nc->n", normal, moved)
        off = np.abs(height) / np.maximum(lengths[0], const.LEAST_SPEED)
        off = np.maximum(off, turn[:, 2])
        for side in range(values["u_sides"]):
            slope = slices.at_node(number, 1 + side * len(values["u_lags"]))[:, :3]
            length = np.maximum(norm(slope), const.LEAST_SPEED)
            off = np.maximum(off, np.abs(np.einsum("nc,nc->n", normal, slope)) / length)
        return moved - height[:, None] * normal, by, lengths, off

    return factors, map(node, places.nodes.T)


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray(np.einsum("nc,nc->n", a[:, :3], b[:, :3]))


def unit(vector: Floats) -> Floats:
    """Normalise vectors (n, 3); zero vectors stay zero."""
    return np.asarray(
        vector / np.sqrt(np.maximum(_dot(vector, vector), const.LEAST_SQUARE))[:, None]
    )
