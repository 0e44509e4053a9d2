"""Look-ups along paths in a mipmapped noise texture: ``lookup_noise_texture.glsl`` in NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.noise import covered_texels, mip_level
from flowtex.rendering.cpu.texture import Lookup, LookupMaker, Sums, shared
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values
from flowtex.textures.noise_textures import HALF_LEVELS, NoiseTextures


class NoiseImages:
    """The noise and the step size with their mip levels."""

    def __init__(self, textures: NoiseTextures) -> None:
        self.textures = textures
        self.noise = Mips(textures.texels[None], repeat=textures.repeated)
        self.step = Mips(textures.step[None, :, :, None], repeat=textures.repeat)

    @property
    def lookup(self) -> LookupMaker:
        """Maker of the look-up of fragments."""
        return lambda fragments, values: NoiseLookup(fragments, values, self)


class NoiseLookup(Lookup):
    """The noise along the paths of fragments that have noise coordinates.

    The level is the one that mipmapping chooses for the noise at the fragment (section 4), and the
    step is looked up at the same level, where its values count 2^level times (section 4.1). What
    averaging takes of the contrast is known and made up for. Corrected noise has grains as long as
    the longer side of a texel, so the level can be finer than the longest side of the footprint
    asks for.

    ``values`` are the uniforms. ``start`` (N, 2) are the noise coordinates of the fragments, and
    ``spacing`` (N,) are the lags between two samples.
    """

    def __init__(self, fragments: Fragments, values: Values, images: NoiseImages) -> None:
        coordinate = fragments.image
        assert coordinate is not None
        self._images = images
        self._values = values
        self.start = coordinate.value
        textures = images.textures
        size: Any = np.asarray(values["u_imageSize"])
        texels = covered_texels(coordinate, size, longest=not textures.corrected)
        self.level = mip_level(texels, values)
        # The deviation is known at every level and half-way to the next.
        half_levels = np.minimum(2.0 * self.level, const.LAST_HALF_LEVEL)
        deviation = np.interp(half_levels, np.arange(HALF_LEVELS), textures.deviations)
        self._gain = 1.0 / deviation[:, None]
        lag_across_texel = images.step.at(self.start, self.level)[:, 0]
        self.spacing = lag_across_texel * np.exp2(self.level) * values["u_spacing"]

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
