"""Slices as the client takes them, packed once for all that show the same textures."""

from __future__ import annotations

import threading
import weakref
from collections import OrderedDict

import numpy as np
from numpy.typing import NDArray

from flowtex.rendering.webgl.header import half
from flowtex.textures import TextureSet

__all__ = ["Packing", "packing_of"]

Halves = NDArray[np.float16]

#: Bytes of packed steps that are kept, and how many steps at least.
KEPT, FEWEST = 64_000_000, 2


class Packing:
    """Packed slices of some textures; those asked for last are kept.

    Attributes
    ----------
    channels
        Components of a slope: two in a plane and in noise coordinates.
    extra
        Layers whose fourth channel says something: unit, reach, speed, and reach forward.
    """

    def __init__(self, textures: TextureSet) -> None:
        self._textures = textures
        self.channels = 2 if textures.geometry.planar or textures.paper is not None else 4
        ahead = [1 + len(textures.lags)] if textures.sides == 2 else []
        self.extra = [0, 1, 2, *ahead]
        self._steps: OrderedDict[int, tuple[Halves, Halves]] = OrderedDict()
        self._lock = threading.Lock()

    def step(self, step: int) -> tuple[Halves, Halves]:
        """Return slopes (layers, H, W, channels) and what ``extra`` names (n, H, W) of a step.

        What is not yet traced is traced.
        """
        with self._lock:
            if step not in self._steps:
                layers = self._textures.layers(step)
                self._steps[step] = (
                    half(layers[..., : self.channels]),
                    half(layers[self.extra, :, :, 3]),
                )
            self._steps.move_to_end(step)
            packed = self._steps[step]
            while len(self._steps) > max(FEWEST, KEPT // packed[0].nbytes):
                self._steps.popitem(last=False)
            return packed


_shared: weakref.WeakValueDictionary[int, Packing] = weakref.WeakValueDictionary()
_lock = threading.Lock()


def packing_of(textures: TextureSet) -> Packing:
    """Return the packing of some textures, one for all scenes that draw with them."""
    with _lock:
        # A packing keeps its textures alive, so their number is their own while it lives.
        found = _shared.get(id(textures))
        if found is None:
            found = _shared[id(textures)] = Packing(textures)
        return found
