"""Mipmapped noise over the parameters of a surface, as in the paper (section 3.2).

Laid evenly over the cells it is stretched with them. *Corrected* for the distribution of the cells
(figure 6), a noise coordinate grows with the length of the grid lines instead of their number, and
where the texels are nevertheless longer than wide, each takes the value of a pattern in space at
its own position. A texel that is too long for a detail takes a coarser one, so that what is drawn
is even wherever the texels allow. Steps are those of a texture of the same size (section 4.1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Ints
from flowtex.field import FlowField
from flowtex.field.interpolation import between_nodes
from flowtex.textures.images import ImageTextures, coordinates, steps_of, texel_places
from flowtex.trace.store import SliceStore

HALF_LEVELS = 32  #: Known deviations: at every level and half-way to the next.
DEVIATION_POINTS = 16_384  #: Points at which the levels are looked up.
FEWEST_TEXELS = 256  #: A level with fewer texels has too few for an estimate.
LEAST_DEVIATION = 1e-6


@dataclass(frozen=True, eq=False)
class NoiseTextures(ImageTextures):
    """Noise of mean zero and unit variance, (H, W, 1), in place of the image, and its step size."""

    corrected: bool = True  #: Whether it is even on the surface instead of in the texture.

    @classmethod
    def of(
        cls, store: SliceStore, resolution: int, seed: int, *, corrected: bool = True
    ) -> NoiseTextures:
        """Return noise laid over the parameters of a surface, for ``noise="texture"``.

        Its step size is, for each texel, the lag in which the flow crosses it.

        Parameters
        ----------
        store
            The trace slices of the flow, which have its surface as well.
        resolution
            Number of texels along the longer side of the surface.
        seed
            Seed of the random numbers.
        corrected
            Whether the noise is even in space; otherwise it is as dense as the cells.
        """
        field = store.field
        lines = coordinates(field, even=corrected)
        index, cells = texel_places(field, lines, resolution)
        if corrected:
            noise = _even_noise(field, index, cells, seed)
        else:
            noise = np.random.default_rng(seed).standard_normal(index.shape[:2])
        unit = (noise - noise.mean()) / (noise.std() or 1.0)
        texels = np.asarray(unit[..., None], np.float32)
        return cls(texels, steps_of(store, index, cells), *lines, field.periodic, corrected)

    @property
    def repeated(self) -> tuple[bool, bool]:
        """Whether the texels are repeated along (v, u): where the surface goes around."""
        return self.repeat

    @property
    def is_noise(self) -> bool:
        """Whether the texels are noise: yes."""
        return True

    @cached_property
    def deviations(self) -> list[float]:
        """Deviation of the noise at each mip level and half-way to the next."""
        points = np.random.default_rng(0).random((2, DEVIATION_POINTS))
        level = self.texels[..., 0].astype(np.float64)
        values = _bilinear(level, points)
        found = []
        while level.size >= 4 * FEWEST_TEXELS and min(level.shape) > 1:
            level = _halved(level)
            coarser = _bilinear(level, points)
            half_way = 0.5 * (values + coarser)
            found += [float(values.std()), float(half_way.std())]
            values = coarser
        found.append(float(values.std()))
        while len(found) < HALF_LEVELS:
            found.append(found[-1] / 2.0**0.5)
        return [max(deviation, LEAST_DEVIATION) for deviation in found[:HALF_LEVELS]]


def _halved(level: Floats) -> Floats:
    """Return the next mip level, the means of 2 x 2 texels; sizes are powers of two."""
    rows, columns = level.shape
    blocks = level.reshape(rows // 2, 2, columns // 2, 2)
    return np.asarray(blocks.mean(axis=(1, 3)))


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
    sides = []
    for axis, tangent in enumerate(surface.tangents):
        cell_length = between_nodes(np.linalg.norm(tangent, axis=-1), index)
        sides.append(cell_length * size[..., axis])
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
