"""``textureLod``: textures in half precision with their mip levels, filtered linearly."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import AnyArray, Floats, Floats32, Indices


class Mips:
    """A texture array, or an image as an array of one layer, with its mip levels.

    The texels are (layers, H, W, C). A coarser level is the finer one, filtered linearly down to
    half its size, in half precision. There are ``levels`` besides the finest, by default all. The
    texture is periodic along (v, u) where ``repeat`` is true, and otherwise clamped at its edges.
    """

    def __init__(
        self,
        texels: AnyArray,
        *,
        levels: int | None = None,
        repeat: tuple[bool, bool] = (False, False),
    ) -> None:
        layers, height, width, channels = texels.shape
        if levels is None:
            last = max(height, width).bit_length() - 1
        else:
            last = levels
        chain = [_half(texels)]
        for _ in range(last):
            chain.append(_half(_reduced(chain[-1])))
        sizes = np.array([level.shape[1:3] for level in chain])
        self._texels = np.concatenate([level.reshape(-1, channels) for level in chain])
        self._heights, self._widths = sizes.T
        self._starts = np.concatenate([[0], np.cumsum(layers * sizes.prod(axis=1))])
        self._repeat = repeat

    @property
    def levels(self) -> int:
        """Mip levels besides the finest."""
        return len(self._heights) - 1

    def at(self, coordinate: Floats, level: Floats, layer: int | Indices = 0) -> Floats:
        """Look up channels, (N, C), at (u, v) from 0 to 1, (N, 2), between mip levels (N,)."""
        clamped = np.clip(level, 0, self.levels)
        base = clamped.astype(np.intp)
        late = clamped - base
        layers = np.broadcast_to(layer, base.shape)
        result = self._bilinear(coordinate, base, layers)
        between = np.flatnonzero(late > 0)
        if len(between):
            next_ = self._bilinear(coordinate[between], base[between] + 1, layers[between])
            result[between] += late[between, None] * (next_ - result[between])
        return result

    def fetch(self, texel: Indices, layer: int | Indices = 0) -> Floats:
        """Look up texels of the finest level, numbered row by row, (N, C)."""
        return np.asarray(self._texels[layer * (self._heights[0] * self._widths[0]) + texel])

    def _bilinear(self, coordinate: Floats, level: Indices, layer: Indices) -> Floats:
        height = self._heights[level]
        width = self._widths[level]
        left, right, u = _neighbours(coordinate[:, 0], width, repeat=self._repeat[1])
        low, high, v = _neighbours(coordinate[:, 1], height, repeat=self._repeat[0])
        first = self._starts[level] + layer * (height * width)
        low = first + low * width
        high = first + high * width
        before = 1 - u
        a = self._rows(low + left) * before + self._rows(low + right) * u
        b = self._rows(high + left) * before + self._rows(high + right) * u
        return np.asarray(a * (1 - v) + b * v)

    def _rows(self, texel: Indices) -> Floats32:
        """Channels of texels; ``take`` copies rows in a third of the time that brackets need."""
        return self._texels.take(texel, axis=0)


def _neighbours(
    coordinate: Floats, count: Indices, *, repeat: bool
) -> tuple[Indices, Indices, Floats]:
    """Return the texels on both sides of a coordinate, and its share of the second, (N, 1)."""
    x = coordinate * count - 0.5
    base = np.floor(x)
    before = base.astype(np.intp)
    after = before + 1
    if repeat:
        before = np.mod(before, count)
        after = np.mod(after, count)
    else:
        last = count - 1
        before = np.minimum(np.maximum(before, 0), last)
        after = np.minimum(np.maximum(after, 0), last)
    return before, after, (x - base)[:, None]


def _half(texels: AnyArray) -> Floats32:
    return texels.astype(np.float16).astype(np.float32)


def _reduced(texels: Floats32) -> Floats32:
    """Halve both axes, rounded down, by linear filtering: means of two where that is exact."""
    for axis in (1, 2):
        count = texels.shape[axis]
        if count > 1:
            x = (np.arange(count // 2) + 0.5) * (count / (count // 2)) - 0.5
            base = np.floor(x).astype(np.intp)
            late = (x - base).astype(np.float32).reshape([-1 if a == axis else 1 for a in range(4)])
            before = texels.take(base, axis=axis)
            after = texels.take(base + 1, axis=axis)
            texels = before * (1 - late) + after * late
    return texels
