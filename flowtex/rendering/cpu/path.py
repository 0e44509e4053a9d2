"""Paths from the slice texture: ``shaders/common/path.glsl`` for many fragments at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex._util.arrays import norm
from flowtex.rendering.cpu.mipmaps import Mips


@dataclass(frozen=True, eq=False)
class Slices:
    """The slice texture at one moment: one destination time, or two and what is between them."""

    before: Mips
    after: Mips | None = None
    between: float = 0.0
    uncertain: bool = False  #: Whether it has the uncertainty of the direction.

    def layer(self, coordinate: Places, layer: int | Indices, level: Floats) -> Floats:
        """Channels of one layer, (N, 4), at texture coordinates (N, 2) and mip levels (N,)."""
        assert not isinstance(coordinate, TrianglePlaces)
        value = self.before.at(coordinate, level, layer)
        if self.after is None:
            return value
        return value + self.between * (self.after.at(coordinate, level, layer) - value)


class TriangleSlices(Slices):
    """The slice texture of a surface of triangles: a texel for each node, and one level."""

    def layer(self, coordinate: Places, layer: int | Indices, level: Floats) -> Floats:
        """Channels of one layer, (N, 4), at places in triangles."""
        del level
        assert isinstance(coordinate, TrianglePlaces)
        fetched = (
            share[:, None] * self.at_node(node, layer)
            for share, node in zip(coordinate.shares.T, coordinate.nodes.T, strict=True)
        )
        return np.asarray(sum(fetched))

    def at_node(self, node: Indices, layer: int | Indices) -> Floats:
        """Return the channels of one layer, (N, 4), at nodes (N,)."""
        value = self.before.fetch(node, layer)
        if self.after is None:
            return value
        return value + self.between * (self.after.fetch(node, layer) - value)


@dataclass(frozen=True, eq=False)
class AxisSlices(Slices):
    """The finest slices of a field without sign: texels against the others are reversed."""

    size: tuple[float, float] = (1.0, 1.0)
    lags: int = 0

    def layer(self, coordinate: Places, layer: int | Indices, level: Floats) -> Floats:
        """Channels of one layer, (N, 4), at texture coordinates (N, 2)."""
        del level
        assert not isinstance(coordinate, TrianglePlaces)
        texels = coordinate * np.array(self.size) - 0.5
        base = np.floor(texels)
        s, t = (texels - base).T
        weights = ((1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t)
        # The other side, from which a reversed texel is taken.
        other = np.asarray(layer) + np.where(np.asarray(layer) > self.lags, -1, 1) * self.lags
        other = np.where(np.asarray(layer) == 0, 0, other)
        mean = np.zeros((len(s), 3))
        result = np.zeros((len(s), 4))
        for weight, right in zip(weights, ((0, 0), (1, 0), (0, 1), (1, 1)), strict=True):
            place = (base + right + 0.5) / self.size
            finest = np.zeros(len(s))
            tangent = self.before.at(place, finest, 0)[:, :3]
            turned = np.einsum("nc,nc->n", mean, tangent) < 0
            sign = np.where(turned, -1.0, 1.0)[:, None]
            mean += sign * tangent
            texel = self.before.at(place, finest, np.where(turned, other, layer))
            texel[:, :3] *= sign
            result += weight[:, None] * texel
        return result


class Path:
    """Paths followed outward from lag zero, one side at a time.

    The N fragments are at texture coordinates (N, 2), or places in triangles, and mip levels (N,);
    ``ends`` are slopes at lag zero and at the first lag, (N, 3) each. ``first`` is the layer before
    the side's first slice, and ``lags`` are those of the slices.
    """

    def __init__(
        self,
        slices: Slices,
        coordinate: Places,
        level: Floats,
        ends: tuple[Floats, Floats],
        first: int,
        lags: Floats,
    ) -> None:
        self._slices = slices
        self._coordinate = coordinate
        self._level = level
        self._first = first
        self._lags = lags
        self._segment = np.zeros(len(coordinate), dtype=np.intp)
        self.before = ends[0].copy()
        self._after = ends[1].copy()
        self._from = np.zeros(len(coordinate))
        self._to = np.full(len(coordinate), lags[0])

    def follow(self, lag: Floats) -> Floats:
        """Return displacements (N, 3) at lags (N,) not smaller than those of the previous call."""
        while True:
            on = np.flatnonzero((lag > self._to) & (self._segment < len(self._lags) - 1))
            if not len(on):
                break
            self._segment[on] += 1
            segment = self._segment[on]
            self.before[on] = self._after[on]
            layer = self._first + segment + 1
            channels = self._slices.layer(self._coordinate[on], layer, self._level[on])
            self._after[on] = channels[:, :3]
            self._from[on] = self._to[on]
            self._to[on] = self._lags[segment]
        late = (lag - self._from) / (self._to - self._from)
        slope = self.before + late[:, None] * (self._after - self.before)
        return np.asarray(lag[:, None] * slope)

    def speed(self, lag: Floats) -> Floats:
        """Speed of the particles at that lag, (N,): the length of d(lag * slope) / d lag."""
        along = self.before + self._bends * (2.0 * lag - self._from)[:, None]
        return np.asarray(norm(along))

    @property
    def bend(self) -> Floats:
        """Change of the slopes with lag, (N,), where the particles are."""
        return np.asarray(norm(self._bends))

    @property
    def _bends(self) -> Floats:
        return np.asarray((self._after - self.before) / (self._to - self._from)[:, None])


@dataclass(frozen=True, eq=False)
class TrianglePlaces:
    """Places of N fragments in their triangles."""

    shares: Floats  #: Shares of the corners, (N, 3).
    nodes: Indices
    by: Floats  #: Change of the last two shares by a vector, (N, 2, 3).

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
