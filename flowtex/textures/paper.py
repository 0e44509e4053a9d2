"""The paper's own textures: noise on the surface's parameters, and the step size with it.

The noise texture lies on the parameters of the surface (section 3.2), and any picture can take
its place. Laid evenly over the cells it is stretched with them. *Corrected* for the distribution
of the cells (figure 6), a noise coordinate grows with the length of the grid lines instead of
their number, and where the texels are nevertheless longer than wide, each takes the value of a
pattern in space at its own position. A texel that is too long for a detail takes a coarser one, so
that what is drawn is even wherever the texels allow.

The step texture holds, for every texel of the noise, the lag in which the flow crosses it
(equation 3). Level n of it counts 2^n times as much, because its texels are twice as wide at
every level (section 4.1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Floats32, Ints
from flowtex._util.arrays import block_means
from flowtex.errors import FieldError
from flowtex.field import FlowField
from flowtex.field.interpolation import along_line, between_nodes, fill_blanked, inverse_along_line
from flowtex.settings import Settings
from flowtex.trace.store import SliceStore

#: Longest step in units of lag: half precision ends soon after.
LONGEST_STEP = 6e4
#: Deviations that a shader has room for: at every level and half-way to the next.
HALF_LEVELS = 32
#: Points at which the levels are looked up.
DEVIATION_POINTS = 16_384
#: A level of fewer texels than this has too few to be judged by.
FEWEST_TEXELS = 256


@dataclass(frozen=True, eq=False)
class PaperTextures:
    """Noise, or a picture in its place, and step size over the parameters of the surface."""

    #: Of mean zero and unit variance, (H, W); or a picture, grey (H, W) or coloured (H, W, 4) as
    #: from :func:`~flowtex.textures.images.as_picture`, averaged along the flow. Row 0 is at j = 0.
    noise: Floats32
    #: Lag in which the flow crosses a texel, in multiples of the unit of lag, (H, W); noise has the
    #: same texels, a picture has its own.
    step: Floats32
    along_i: Floats  #: Noise coordinates of the lines of nodes, (I,) and (J,), from 0 to 1.
    along_j: Floats
    repeat: tuple[bool, bool]  #: Whether the noise goes around along (v, u).
    corrected: bool  #: Whether it is even on the surface instead of in the texture.
    grain: float = 1.0  #: Width of grains in texels.
    picture: bool = False

    @classmethod
    def build(
        cls, store: SliceStore, settings: Settings, image: Floats32 | None = None
    ) -> PaperTextures:
        """Make both textures of a flow, with a picture (H, W, 4) for ``noise="image"``."""
        field, corrected, seed = store.field, settings.noise_correction, settings.seed
        along_i, along_j = lines = _coordinates(field, correction=corrected)
        counts = _size(field, settings.resolution)
        middles = [
            np.interp((np.arange(count) + 0.5) / count, line, np.arange(len(line)))
            for line, count in zip(lines, counts, strict=True)
        ]
        index = np.stack(np.meshgrid(*middles), axis=-1)
        # Cells by texel.
        size = np.empty_like(index)
        for axis, (line, count) in enumerate(zip(lines, counts, strict=True)):
            cell = np.clip(index[..., axis].astype(np.intp), 0, len(line) - 2)
            size[..., axis] = 1 / (np.diff(line)[cell] * count)
        if settings.noise == "image" and image is not None:
            noise = image
        elif settings.noise != "texture":
            raise FieldError(
                f"pattern is {settings.noise!r}; expected 'texture', or 'image' with an image"
            )
        elif corrected:
            noise = _unit(_even_noise(field, index, size, seed))
        else:
            noise = _unit(np.random.default_rng(seed).standard_normal(index.shape[:2]))
        return cls(
            noise=noise,
            step=np.minimum(_steps(store, index, size), LONGEST_STEP).astype(np.float32),
            along_i=along_i,
            along_j=along_j,
            repeat=field.periodic,
            corrected=corrected,
            picture=settings.noise == "image",
        )

    def with_image(self, image: Floats32) -> PaperTextures:
        """Return the same textures with a picture (H, W, 4) in place of the noise."""
        return replace(self, noise=image, grain=1.0, picture=True)

    @cached_property
    def deviations(self) -> list[float]:
        """Deviation of the noise at each mip level and half-way to the next."""
        return [1.0] * HALF_LEVELS if self.picture else _deviations(self.noise)

    @property
    def noise_texels(self) -> Floats32:
        """The noise, or the picture, as a texture array of one layer, (1, H, W, C)."""
        return self.noise.reshape(1, *self.noise.shape[:2], -1)

    @property
    def noise_repeat(self) -> tuple[bool, bool]:
        """Whether :attr:`noise_texels` go around along (v, u): a picture always does."""
        return (True, True) if self.picture else self.repeat

    @property
    def step_texels(self) -> Floats32:
        """The step size as a texture array of one layer, (1, H, W, 1)."""
        return self.step[None, :, :, None]

    @property
    def coordinate(self) -> Floats32:
        """Noise coordinates of the nodes, (J, I, 2)."""
        return np.stack(np.meshgrid(self.along_i, self.along_j), axis=-1).astype(np.float32)

    def at(self, index: Floats) -> Floats:
        """Return noise coordinates of positions in index space, (..., 2), linear beyond ends."""
        return self._by_axis(along_line, index)

    def index(self, coordinate: Floats) -> Floats:
        """Return positions in index space of noise coordinates, (..., 2), inverse to :meth:`at`."""
        return self._by_axis(inverse_along_line, coordinate)

    def _by_axis(self, function: Callable[..., Floats], places: Floats) -> Floats:
        i = function(self.along_i, places[..., 0], periodic=self.repeat[1])
        j = function(self.along_j, places[..., 1], periodic=self.repeat[0])
        return np.stack([i, j], axis=-1)

    def by_cell(self) -> Floats:
        """Return derivatives of the noise coordinates by index at the nodes, (J, I, 2)."""
        slopes = [np.gradient(line) for line in (self.along_i, self.along_j)]
        return np.stack(np.meshgrid(*slopes), axis=-1)


def _coordinates(field: FlowField, *, correction: bool) -> tuple[Floats, Floats]:
    """Return the noise coordinate of each line of nodes along i and along j."""
    p_i, p_j = (np.linalg.norm(t, axis=-1) for t in field.surface.tangents)
    lines = []
    for lengths in (p_i.mean(axis=0), p_j.mean(axis=1)):
        steps = (lengths[1:] + lengths[:-1]) / 2
        if not (correction and steps.any()):
            steps = np.ones(len(steps))
        ends = np.concatenate([[0.0], np.cumsum(np.maximum(steps, 1e-9 * steps.max()))])
        lines.append(ends / ends[-1])
    return lines[0], lines[1]


def _size(field: FlowField, resolution: int) -> tuple[int, ...]:
    """Return the width and height, powers of two in about the proportion of the surface."""
    tangents = (np.linalg.norm(t, axis=-1)[field.valid].mean() for t in field.surface.tangents)
    lengths = [t * (n - 1) for t, n in zip(tangents, field.shape[::-1], strict=True)]
    shares = np.maximum(lengths / np.max(lengths), 1 / 8) * resolution
    return tuple(int(2 ** np.ceil(np.log2(max(n, 8)))) for n in shares)


def _unit(noise: Floats) -> Floats32:
    return np.asarray((noise - noise.mean()) / (noise.std() or 1.0), np.float32)


def _steps(store: SliceStore, index: Floats, texel: Floats) -> Floats:
    """Return the lag in which the flow crosses one texel (equation 3), by interpolated speeds."""
    field = store.field
    speed = np.abs(field.index_velocity.components).max(axis=0)
    if store.parameter == "arclength":
        # Cells crossed in a unit of length; nodes at rest take that of the nearest one.
        pace = field.index_velocity.speed[0]
        moving = field.valid & (pace > 1e-7 * pace.max())
        by_length = speed / np.where(moving, pace, 1.0)[..., None]
        speed = fill_blanked(by_length, moving) if moving.any() else np.zeros_like(speed)
    speed = speed * store.unit[..., None]
    crossed = (
        np.stack([between_nodes(speed[..., axis], index) for axis in range(2)], axis=-1) / texel
    )
    return np.asarray(1 / np.maximum(crossed.max(axis=-1), 1 / float(store.lags[-1])))


def _deviations(noise: Floats32) -> list[float]:
    """Return the deviation of a noise (H, W) as it is looked up at level n / 2, n = 0, 1, ..."""
    points = np.random.default_rng(0).random((2, DEVIATION_POINTS))
    level = noise.astype(np.float64)
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
