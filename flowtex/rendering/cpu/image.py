"""An image in place of the noise, as in ``shaders/common/lookup_image.glsl``."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.fragments import Fragments, Varying, footprint
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.texture import Lookup, Sums
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values
from flowtex.textures.images import ImageTextures


class ImageMips:
    """The image and the step size, with their mip levels."""

    def __init__(self, image: ImageTextures) -> None:
        self.image = Mips(image.texels[None], repeat=(True, True))
        self.step = Mips(image.step[None, :, :, None], repeat=image.repeat)


class ImageLookup(Lookup):
    """The mean colours of an image along the paths of fragments that have image coordinates."""

    def __init__(self, fragments: Fragments, values: Values, mips: ImageMips) -> None:
        coordinate = fragments.image
        assert coordinate is not None
        self._mips, self._values, self._start = mips, values, coordinate.value
        size, step_size = (np.asarray(values[name]) for name in ("u_imageSize", "u_stepSize"))
        self.level = mip_level(covered_texels(coordinate, size), values)
        self._inset = np.minimum(0.5 * np.exp2(np.ceil(self.level))[:, None] / size, 0.5)
        covered = covered_texels(coordinate, step_size)
        # No texel of the image may be passed over.
        least = min(float(np.min(step_size / size)), 1.0)
        width = np.maximum(covered, least) if values["u_lod"] else least
        step = mips.step.at(self._start, mip_level(covered, values))[:, 0]
        self.spacing = step * width * values["u_spacing"]

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Red, green and blue times opacity, opacity, and one, (N, 5)."""
        del length
        values = self._values
        coordinate = self._start + displacement[:, :2]
        # The repetition beyond the image's edge must not be visible where the surface ends.
        inside = np.clip(coordinate, self._inset, 1.0 - self._inset)
        coordinate = np.where(values["u_imageRound"], coordinate, inside)
        channels = self._mips.image.at(coordinate * values["u_tiles"], self.level)
        return np.concatenate([channels, np.ones((len(coordinate), 1))], axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Mean colours times opacity, and opacity, (N, 4)."""
        return np.asarray(sums.values[:, :4] / sums.values[:, 4:])


def covered_texels(coordinate: Varying, size: Floats, *, longest: bool = False) -> Floats:
    """Return the width of a pixel's footprint in texels, the mean or the longest one, (N,)."""
    long, short = footprint(coordinate.dx * size, coordinate.dy * size)
    return long if longest else np.sqrt(long * short)


def mip_level(texels: Floats, values: Values) -> Floats:
    """Return the mip level at which a texel is as wide as that many of the finest level."""
    if not values["u_lod"]:
        return np.zeros(len(texels))
    return np.asarray(np.maximum(np.log2(np.maximum(texels, const.LEAST_TEXELS)), 0.0))
