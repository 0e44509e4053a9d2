"""The paper's mipmapped noise and step textures: ``shaders/common/lookup_paper.glsl``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.constants import LAST_HALF_LEVEL, LEAST_TEXELS
from flowtex.rendering.cpu.fragments import Varying
from flowtex.rendering.cpu.levels import footprint
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.noise import mix
from flowtex.rendering.cpu.texture import Lookup, Sums, shared
from flowtex.textures import PaperTextures

Values = Mapping[str, Any]


class PaperImages:
    """The noise, or the picture in its place, and the step size, with their mip levels."""

    def __init__(self, paper: PaperTextures) -> None:
        self.noise = Mips(paper.noise_texels, repeat=paper.noise_repeat)
        self.step = Mips(paper.step_texels, repeat=paper.repeat)


class PaperNoise(Lookup):
    """The noise texture along the paths of fragments with some noise coordinates."""

    def __init__(self, noise: Varying, images: PaperImages, values: Values) -> None:
        self._images, self._values, self._here = images, values, noise.value
        texels = _covered(noise, "u_noiseSize", values)
        self._mip = _level(texels, values)
        self.level = self._mip
        width = np.exp2(self._mip)
        halves = np.asarray(values["u_noiseDeviation"])
        self._gain = 1.0 / np.interp(
            np.minimum(2.0 * self._mip, LAST_HALF_LEVEL), np.arange(len(halves)), halves
        )
        self._grains = width / np.sqrt(values["u_noiseGrain"] ** 2 + width**2 - 1.0)
        step = images.step.at(self._here, self._mip)[:, 0]
        self.spacing = step * self._width(noise, width, texels) * values["u_spacing"]

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Noise, (N, 1)."""
        del length
        at = self._here + displacement[:, :2]
        return np.asarray(self._images.noise.at(at, self._mip) * self._gain[:, None])

    def blend(self, sums: Sums) -> Floats:
        """Bring the sum to unit variance."""
        apart = self._values["u_spacing"] * self._grains
        variance = sums.squares * shared(apart, sums.neighbours / sums.squares)
        return np.asarray(sums.values[:, 0] / np.sqrt(variance))

    def _width(self, noise: Varying, width: Floats, texels: Floats) -> Floats:
        """Width of a step in texels of the step texture, (N,)."""
        del noise, texels
        return width


class PaperPicture(PaperNoise):
    """A picture in place of the noise: the mean of its colours along the paths."""

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Red, green and blue times opacity, opacity, and one, (N, 5)."""
        del length
        values = self._values
        at = self._here + displacement[:, :2]
        # Beyond its edge the picture is repeated, which must not be seen where the surface ends.
        inside = np.clip(at, self._inset, 1.0 - self._inset)
        at = mix(inside, at, np.asarray(values["u_pictureRound"]))
        seen = self._images.noise.at(at * values["u_tiles"], self._picture_mip)
        one = np.ones((len(at), 1))
        if values["u_pictureGrey"]:
            return np.concatenate([seen, seen, seen, one, one], axis=-1)
        return np.concatenate([seen, one], axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Mean colours times opacity, and opacity, (N, 4)."""
        return np.asarray(sums.values[:, :4] / sums.values[:, 4:])

    def _width(self, noise: Varying, width: Floats, texels: Floats) -> Floats:
        """Choose the picture's own level; no texel of the picture may be passed over."""
        values = self._values
        size = np.asarray(values["u_pictureSize"])
        self._picture_mip = _level(_covered(noise, "u_pictureSize", values), values)
        self.level = self._picture_mip
        self._inset = np.minimum(0.5 * np.exp2(np.ceil(self._picture_mip))[:, None] / size, 0.5)
        least = min(float(np.min(np.asarray(values["u_noiseSize"]) / size)), 1.0)
        return np.maximum(texels, least) if values["u_lod"] else np.full(len(width), least)


def _covered(noise: Varying, size: str, values: Values) -> Floats:
    """Width of a pixel's footprint in texels, for the choice of the level, (N,)."""
    scale = np.asarray(values[size])
    longest, shortest = footprint(noise.dx * scale, noise.dy * scale)
    return np.sqrt(longest * shortest) if values["u_noiseCorrected"] else longest


def _level(texels: Floats, values: Values) -> Floats:
    """Mip level at which a texel is as wide as that many of the finest level."""
    if not values["u_lod"]:
        return np.zeros(len(texels))
    return np.maximum(np.log2(np.maximum(texels, LEAST_TEXELS)), 0.0)
