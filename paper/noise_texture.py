"""The paper's own noise: a mipmapped texture over the parameters of the surface (section 3.2).

Laid evenly over the cells it is stretched with them. *Corrected* for the distribution of the cells
(figure 6), a noise coordinate grows with the length of the grid lines instead of their number, and
where the texels are nevertheless longer than wide, each takes the value of a pattern in space at
its own position. A texel that is too long for a detail takes a coarser one, so that what is drawn
is even wherever the texels allow. Steps are those of a texture of the same size (section 4.1).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Ints
from flowtex.field import FlowField
from flowtex.field.interpolation import between_nodes
from flowtex.rendering.cpu.fragments import Fragments, Varying
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.noise import covered_texels, mip_level
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums, shared
from flowtex.textures.images import ImageTextures, coordinates, steps_of, texel_places
from flowtex.trace.store import SliceStore
from paper.blocks import block_means

Values = Mapping[str, Any]

#: Deviations that are known: at every level and half-way to the next.
HALF_LEVELS = 32
#: Points at which the levels are looked up.
DEVIATION_POINTS = 16_384
#: A level of fewer texels than this has too few to be judged by.
FEWEST_TEXELS = 256


@dataclass(frozen=True, eq=False)
class NoiseTextures(ImageTextures):
    """Noise of mean zero and unit variance, (H, W), in place of the image, and its step size."""

    corrected: bool = True  #: Whether it is even on the surface instead of in the texture.

    @classmethod
    def of(
        cls, store: SliceStore, resolution: int, seed: int, *, corrected: bool = True
    ) -> NoiseTextures:
        """Make both textures of a flow, with so many texels along the surface."""
        field = store.field
        lines = coordinates(field, even=corrected)
        index, cells = texel_places(field, lines, resolution)
        if corrected:
            noise = _even_noise(field, index, cells, seed)
        else:
            noise = np.random.default_rng(seed).standard_normal(index.shape[:2])
        unit = np.asarray((noise - noise.mean()) / (noise.std() or 1.0), np.float32)
        return cls(unit, steps_of(store, index, cells), *lines, field.periodic, corrected)

    @cached_property
    def deviations(self) -> list[float]:
        """Deviation of the noise at each mip level and half-way to the next."""
        points = np.random.default_rng(0).random((2, DEVIATION_POINTS))
        level = self.texels.astype(np.float64)
        values, result = _bilinear(level, points), []
        while level.size >= 4 * FEWEST_TEXELS and min(level.shape) > 1:
            level = block_means(level, 2)
            coarser = _bilinear(level, points)
            result += [float(values.std()), float((0.5 * (values + coarser)).std())]
            values = coarser
        result.append(float(values.std()))
        while len(result) < HALF_LEVELS:
            result.append(result[-1] / np.sqrt(2.0))
        return [float(max(value, 1e-6)) for value in result[:HALF_LEVELS]]


class NoiseImages:
    """The noise and the step size with their mip levels."""

    def __init__(self, textures: NoiseTextures) -> None:
        self.textures = textures
        self.noise = Mips(textures.texels[None, :, :, None], repeat=textures.repeat)
        self.step = Mips(textures.step[None, :, :, None], repeat=textures.repeat)

    @property
    def lookup(self) -> LookupMaker:
        """Maker of the look-up of fragments."""
        return lambda fragments, values: NoiseLookup(fragments, values, self)


class NoiseLookup(Lookup):
    """The noise along the paths of fragments that have image coordinates.

    The level is the one that mipmapping chooses for the noise at the fragment (section 4), and the
    step is looked up at the same level, where its values count 2^level times (section 4.1). What
    averaging takes of the contrast is known and made up for. Corrected noise has grains as long as
    the longer side of a texel, so the level can be finer than the longest side of the footprint
    asks for.
    """

    def __init__(self, fragments: Fragments, values: Values, images: NoiseImages) -> None:
        noise: Varying | None = fragments.image
        assert noise is not None
        self._images, self._values, self.start = images, values, noise.value
        textures = images.textures
        size = np.asarray(values["u_stepSize"])
        self.level = mip_level(covered_texels(noise, size, longest=not textures.corrected), values)
        half_levels = np.minimum(2.0 * self.level, HALF_LEVELS - 1.01)
        gain = 1.0 / np.interp(half_levels, np.arange(HALF_LEVELS), textures.deviations)
        self._gain = gain[:, None]
        step = images.step.at(self.start, self.level)[:, 0]
        self.spacing = step * np.exp2(self.level) * values["u_spacing"]

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Noise, (N, 1)."""
        del length
        coordinate = self.start + displacement[:, :2]
        return np.asarray(self._images.noise.at(coordinate, self.level) * self._gain)

    def blend(self, sums: Sums) -> Floats:
        """Bring the sum to unit variance."""
        spacing = self._values["u_spacing"]
        variance = sums.squares * shared(spacing, sums.neighbours / sums.squares)
        return np.asarray(sums.values[:, 0] / np.sqrt(variance))


def _bilinear(level: Floats, at: Floats) -> Floats:
    """Return values at coordinates (2, N) from 0 to 1, texels in the middle of their squares."""
    at = at * np.array(level.shape)[:, None] - 0.5
    return np.asarray(scipy.ndimage.map_coordinates(level, at, order=1, mode="grid-wrap"))


def _even_noise(field: FlowField, index: Floats, size: Floats, seed: int) -> Floats:
    """Return noise (H, W) from 0 to 1, at each texel as coarse as the texel is long.

    Texels are at ``index``, (H, W, 2) as (i, j), of a ``size`` in cells, (H, W, 2). A texel takes
    the random number of the cube of a lattice in space in which it lies. The lattice is that power
    of two of the finest which is nearest to the texel's longer side.
    """
    surface = field.surface
    tangents = (np.linalg.norm(t, axis=-1) for t in surface.tangents)
    sides = [between_nodes(p, index) * size[..., axis] for axis, p in enumerate(tangents)]
    longest = np.maximum(np.max(sides, axis=0), surface.extent * 1e-7)
    octave = np.rint(np.log2(longest)).astype(np.int64)
    position = surface.at(index) - surface.center
    cell = np.floor(position / (2.0**octave)[..., None]).astype(np.int64)
    return _hash(cell, octave, seed).astype(np.float64) / 2.0**64


def _hash(cell: Ints, octave: Ints, seed: int) -> NDArray[np.uint64]:
    """Return the uniform random whole number of a lattice cell (..., 2 or 3)."""
    primes = np.array([0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D], dtype=np.uint64)
    h = np.zeros(octave.shape, np.uint64)
    for axis in range(cell.shape[-1]):
        h ^= cell[..., axis].astype(np.uint64) * primes[axis]
    h ^= octave.astype(np.uint64) * np.uint64(0x27D4EB2F165667C5) + np.uint64(seed)
    for shift, factor in ((33, 0xFF51AFD7ED558CCD), (33, 0xC4CEB9FE1A85EC53)):
        h ^= h >> np.uint64(shift)
        h *= np.uint64(factor)
    h ^= h >> np.uint64(33)
    return h
