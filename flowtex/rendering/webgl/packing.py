"""Slices in half precision for the client, packed once for all views of the same textures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flowtex._util.array_types import AnyArray, Halves
from flowtex._util.cache import ByteCache, WeakCache
from flowtex.textures import TextureSet
from flowtex.textures.texture_set import UNCERTAIN_LAYER

#: Greatest number in half precision.
HALF_MAX = 65504.0
#: Bytes of packed steps that are cached, and how many steps at least.
CACHE_BYTES, LEAST_STEPS = 64_000_000, 2


@dataclass(frozen=True, eq=False)
class PackedStep:
    """Slopes of one destination time, (layers, H, W, channels), and ``extra``, (n, H, W)."""

    slopes: Halves
    extra: Halves

    @property
    def nbytes(self) -> int:
        """Size of the slopes, which are nearly all of it."""
        return self.slopes.nbytes


class Packing:
    """Packed slices of a texture set; those requested last are cached.

    A slope has so many ``channels``, two in a plane and in noise coordinates. ``extra`` are the
    layers whose fourth channel says something: unit, reach, speed, how far the direction is not
    known, reach forward, that again, and speed again.
    """

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        self.channels = 2 if textures.geometry.planar or textures.paper is not None else 4
        unknown = [UNCERTAIN_LAYER] if textures.geometry.field.uncertainty else []
        ahead = [len(textures.lags) + n for n in (1, *unknown)] if textures.sides == 2 else []
        last = [textures.count - 1] if textures.in_cells else []
        self.extra = [0, 1, 2, *unknown, *ahead, *last]
        self._steps: ByteCache[int, PackedStep] = ByteCache(CACHE_BYTES, min_count=LEAST_STEPS)

    def step(self, step: int) -> PackedStep:
        """Return a step, which is traced if necessary."""
        return self._steps.get(step, lambda: self._packed(step))

    @property
    def nbytes(self) -> int:
        """Size of the steps that are cached."""
        return self._steps.nbytes

    def _packed(self, step: int) -> PackedStep:
        layers = self._textures.layers(step)
        parts = layers[..., : self.channels], layers[self.extra, :, :, 3]
        return PackedStep(*(np.ascontiguousarray(part, dtype="<f2") for part in parts))


_packings: WeakCache[Packing] = WeakCache()


def packing_of(textures: TextureSet) -> Packing:
    """Return the packing of a texture set, shared by all views that draw it."""
    # A packing keeps its textures alive, so their number is its own while it lives.
    return _packings.get(id(textures), lambda: Packing(textures))


def half(values: AnyArray) -> Halves:
    """Round to half precision, clipped to its greatest number."""
    return np.ascontiguousarray(np.clip(values, -HALF_MAX, HALF_MAX), dtype="<f2")
