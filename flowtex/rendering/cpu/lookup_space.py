"""Noise that is even in space, at the level of the fragment: ``lookup_space.glsl``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.rendering.cpu.fragments import Fragments
from flowtex.rendering.cpu.levels import footprint, on_surface
from flowtex.rendering.cpu.noise import Motion, lattice, octave
from flowtex.rendering.cpu.texture import Lookup, Sums, shared

__all__ = ["SpaceNoise"]


class SpaceNoise(Lookup):
    """Two octaves of noise along the paths of some fragments."""

    def __init__(self, fragments: Fragments, values: Mapping[str, Any], *, planar: bool) -> None:
        self._values, self._planar = values, planar
        self._motion: Motion | None = None
        position = fragments.position
        if fragments.normal is not None:
            position = on_surface(position, fragments.normal, np.asarray(values["u_eye"]))
        texel = values["u_texel"]
        self._pixel = footprint(position.dx, position.dy)[0]
        if not values["u_lod"]:
            self._pixel = np.full(len(fragments), texel / values["u_grain"])
        grain = self._pixel * values["u_grain"]
        if values["u_fixed"]:
            grain = np.maximum(grain, texel)
        self.level = np.log2(grain / texel)
        self.spacing = values["u_spacing"] * grain
        octaves = np.clip(2.0 * np.log2(grain / values["u_noiseFinest"]), 0.0, 58.99)
        whole = octaves.astype(np.int64)
        self._late = octaves - whole
        here = position.value - np.asarray(values["u_noiseOrigin"])
        self._fine, self._coarse = (lattice(here, whole + k, values) for k in range(2))

    def move(self, slope: Floats, speed: Floats) -> None:
        """Choose the two rates between which the motion of each fragment lies."""
        values = self._values
        if not values["u_moving"]:
            return
        travel = values["u_travel"] * np.ones(len(speed))
        travel *= self._pixel if values["u_travelInPixels"] else 1.0
        travel *= speed if values["u_travelBySpeed"] else 1.0
        rate = np.log2(np.maximum(travel / (values["u_wave"] * self._pixel), 0.25))
        rates = np.floor(rate)[:, None] + [0.0, 1.0]
        turns = np.exp2(rates) * (rates >= 0)
        coarse, rest = values["u_clock"]
        even = np.mod(rates[:, :1], 2.0) < 0.5
        self._motion = Motion(
            clock=np.mod(turns * coarse, 1.0) + turns * rest,
            turns=turns * (slope / np.maximum(travel, 1e-30))[:, None],
            phases=np.where(even, [1.0, 64.0], [64.0, 1.0]),
            late=rate - rates[:, 0],
        )

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Both octaves, (N, 2)."""
        motion = None if self._motion is None else self._motion.after(length)
        two = (
            octave(at, displacement, motion, planar=self._planar)
            for at in (self._fine, self._coarse)
        )
        return np.stack(list(two), axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Mix the octaves by the level, and bring the mixture to unit variance."""
        near = sums.neighbours / sums.squares
        apart = self._values["u_spacing"] * np.exp2(0.5 * self._late)
        mixed = np.zeros(len(near))
        variance = np.zeros(len(near))
        for k, w in enumerate((1.0 - self._late, self._late)):
            mixed += w * sums.values[:, k]
            variance += w * w * shared(apart * 0.5 ** (k / 2), near)
        return np.asarray(mixed / np.sqrt(sums.squares * variance))
