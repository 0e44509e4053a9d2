"""One pixel's look-ups written down, and what is kept to draw single pixels one after the other."""

from __future__ import annotations

import weakref
from typing import ClassVar

import numpy as np

from flowtex._util.array_types import Floats, Floats32, Indices
from flowtex.rendering.cpu.lookup import Mips
from flowtex.rendering.cpu.render import maker_of
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums
from flowtex.textures import TextureSet

__all__ = ["Kept", "Recorder", "Window"]


class Recorder(Lookup):
    """Writes down where another look-up is asked for one fragment, and what it finds.

    What it hands on to be summed counts the samples: a row of zeros with a one. The sums are
    then the weights.

    Parameters
    ----------
    inner
        The look-up that is drawn with.
    most
        More samples than there will be.

    Attributes
    ----------
    displacement, length
        What was asked for, sample by sample, (1, 3) and (1,).
    weights
        Share of each sample in the mean, (K,), once all are summed.
    noise
        What each would be by itself, (K,) or (K, 4).
    gain
        What the mean of the noise is multiplied by.
    """

    def __init__(self, inner: Lookup, most: int) -> None:
        self.inner, self.spacing, self.level = inner, inner.spacing, inner.level
        self.displacement: list[Floats] = []
        self.length: list[Floats] = []
        self._found: list[Floats] = []
        self._rows = np.eye(most)

    def move(self, slope: Floats, speed: Floats) -> None:
        """Hand on."""
        self.inner.move(slope, speed)

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Write down, and count."""
        self.displacement.append(displacement)
        self.length.append(length)
        self._found.append(self.inner.lookup(displacement, length))
        return np.asarray(self._rows[[len(self._found) - 1]])

    def blend(self, sums: Sums) -> Floats:
        """Sum what was found with the weights, and blend that."""
        blend, found = self.inner.blend, np.concatenate(self._found)
        count, weights = len(found), sums.values[:, : len(found)]
        total = float(weights.sum())
        self.weights = weights[0] / total
        # By itself, each sample is a sum of one; and a sum of ones shows what sums are scaled by.
        self.noise = blend(Sums(found, np.ones(count), np.zeros(count)))
        ones = np.ones_like(found[:1])
        all_ = blend(Sums(total * ones, sums.squares, sums.neighbours))
        self.gain = float(all_.flat[0] / blend(Sums(ones, np.ones(1), np.zeros(1))).flat[0])
        return np.asarray(blend(Sums(weights @ found, sums.squares, sums.neighbours)))


class Window(Mips):
    """A slice texture of which only what lies around one place is filtered.

    Parameters
    ----------
    texels
        (layers, H, W, C), single precision; H and W are multiples of the coarsest level's block.
    levels
        Mip levels beside the finest.
    """

    def __init__(self, texels: Floats32, levels: int) -> None:
        self._whole, self._last, self._block = texels, levels, 2**levels
        self._seen: tuple[int, ...] = ()

    @property
    def levels(self) -> int:
        """Mip levels beside the finest."""
        return self._last

    def at(self, coordinate: Floats, level: Floats, layer: int | Indices = 0) -> Floats:
        """Look texels up that lie less than a block from each other, as :meth:`Mips.at` does."""
        size = np.array(self._whole.shape[2:0:-1])
        # Filtering reaches one block of the coarsest level far.
        here = np.floor(coordinate[0] * size / self._block).astype(int)
        low = np.clip(here - 1, 0, size // self._block - 1) * self._block
        high = np.clip(here + 2, 1, size // self._block) * self._block
        if self._seen != (*low, *high):
            part = self._whole[:, low[1] : high[1], low[0] : high[0]]
            super().__init__(part, levels=self._last)
            self._seen = (*low, *high)
        return super().at((coordinate * size - low) / (high - low), level, layer)


class Kept:
    """What a renderer would load of a texture set, kept for as long as that is."""

    _all: ClassVar[weakref.WeakKeyDictionary[TextureSet, Kept]] = weakref.WeakKeyDictionary()

    def __init__(self, make: LookupMaker) -> None:
        self.make = make
        self._mips: dict[int, Window] = {}

    @classmethod
    def of(cls, textures: TextureSet) -> Kept:
        """Return what is kept of a texture set."""
        if textures not in cls._all:
            cls._all[textures] = cls(maker_of(textures))
        return cls._all[textures]

    def mips(self, textures: TextureSet, step: int) -> Mips:
        """Slice texture of one destination time; those of two times are kept."""
        if step not in self._mips:
            while len(self._mips) > 1:
                del self._mips[next(iter(self._mips))]
            self._mips[step] = Window(textures.layers(step), textures.geometry.levels)
        return self._mips[step]
