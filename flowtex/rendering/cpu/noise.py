"""Look-ups along paths: noise that is even in space, or an image in its place.

They follow ``noise.glsl``, ``lookup_space.glsl`` and ``lookup_image.glsl`` in ``shaders/common``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Bools, Floats, Ints
from flowtex.rendering.cpu.cell import unit
from flowtex.rendering.cpu.fragments import Fragments, Varying, footprint, on_surface
from flowtex.rendering.cpu.mipmaps import Mips
from flowtex.rendering.cpu.texture import Lookup, Sums, shared
from flowtex.rendering.even import DrawnGrains
from flowtex.rendering.shaders import const
from flowtex.rendering.uniforms import Values
from flowtex.textures.images import ImageTextures

Hashes = NDArray[np.uint32]


@dataclass(frozen=True, eq=False)
class NoiseLattice:
    """Lattice of one octave, the same for every point of the paths of N fragments."""

    start: Floats  #: The fragments, (N, 3), in cells from the lattice point nearest to the origin.
    inverse: Floats  #: Cells by length, (N,).
    key: Hashes  #: Hash of that lattice point, the octave and the seed, by axis, (N, 3).
    origin: Hashes  #: That lattice point, (N, 3), modulo 2^32.
    salt: Hashes  #: Hash of the octave and the seed, (N,).


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of the grains at N fragments, interpolated between two rates."""

    clock: Floats  #: The moment in turns, (N, 2).
    turns: Floats  #: Turns by length of path, (N, 2).
    phases: Floats  #: Turns per value of a grain at rest, (N, 2).
    shares: Floats  #: Of the two rates in a grain, (N, 2).

    def after(self, length: Floats) -> Motion:
        """Return the motion at lengths (N,) along the paths."""
        clock = self.clock + self.turns * length[:, None]
        return Motion(clock, self.turns, self.phases, self.shares)


def noise_lattice(position: Floats, octave: Ints, values: Values) -> NoiseLattice:
    """Lattice of an octave (N,) at positions (N, 3) relative to the origin of the noise."""
    odd = (octave & 1 == 1)[:, None]
    doublings = (octave >> 1)[:, None]
    shrink = np.exp2(-doublings.astype(float))
    inverse = shrink / values["u_noiseFinest"] * np.where(odd, const.SQRT_HALF, 1.0)
    cells = np.where(odd, values["u_noiseOriginOdd"], values["u_noiseOriginEven"])
    finest = np.asarray(cells, dtype=np.int64)
    shifted = finest >> doublings
    rest = (finest - (shifted << doublings) + np.where(odd, values["u_noiseRestOdd"], 0.0)) * shrink
    origin = shifted.astype(np.uint32)
    key = origin * const.AXIS_PRIMES
    seed = np.array([values["u_seed"]], np.uint32) * const.SEED_PRIME
    salt = octave.astype(np.uint32) * const.OCTAVE_PRIME + seed
    key[:, 0] += salt
    return NoiseLattice(position * inverse + rest, inverse[:, 0], key, origin, salt)


def scatter(key: Hashes) -> Hashes:
    """Scatter the keys of an axis."""
    return np.asarray((key ^ (key >> const.HASH_SHIFT)) * const.HASH_FACTORS[0], np.uint32)


def grains(key: Hashes, motion: Motion | None, shine: Bools | None = None) -> Floats:
    """Values of lattice points from their scattered keys (N, 4), even over all signed numbers.

    For streaklets ``shine`` (N, 4) says which are bright, and the others are all the same.
    """
    values = (key * const.HASH_FACTORS[1]).view(np.int32).astype(float)
    if motion is None:
        if shine is not None:
            values = const.MOST_GRAIN * np.where(shine, const.SPARSE_HIGH, -const.SPARSE_LOW)
        return np.asarray(values)
    waves = []
    for k in range(2):
        turn = values * motion.phases[:, k, None] + motion.clock[:, k, None]
        turn -= np.floor(turn)
        if shine is None:
            waves.append(_triangle(turn))
        else:
            waves.append(_dash(turn, shine))
    return np.asarray(waves[0] * motion.shares[:, :1] + waves[1] * motion.shares[:, 1:])


def block_codes(cell: Hashes, salt: Hashes, *, planar: bool) -> tuple[Hashes, Hashes]:
    """Hashes of the blocks of lattice points (N, 3), and places of the points there, by axis."""
    bits = const.BLOCK_BITS // (2 if planar else 3)
    block = cell >> bits
    key = block * const.AXIS_PRIMES
    key[:, 0] += salt
    place = (cell & (2**bits - 1)) << (bits * np.arange(3, dtype=np.uint32))
    # Every other block counts, like the black squares of a chessboard.
    colour = block & 1
    colour[:, 0] ^= salt >> 31
    return scatter(key), place | (colour << const.BLOCK_BITS)


def bright(block: Hashes, place: Hashes) -> Bools:
    """Return which lattice points are bright, one in a block, from the codes of all axes."""
    return np.asarray((block * const.HASH_FACTORS[1]) >> (32 - const.BLOCK_BITS) == place)


def corners(low: Hashes, high: Hashes) -> Hashes:
    """Combine codes (N, 3) by axis for the corners of cells, (N, 4), along the first two axes."""
    x, y = (np.stack([low[:, n], high[:, n]], axis=-1) for n in range(2))
    return (x[:, None, :] ^ y[:, :, None]).reshape(-1, 4)


def _dash(turn: Floats, shine: Bools) -> Floats:
    head = const.DASH_HIGH * np.maximum(1.0 - turn / const.DASH_SHARE, 0.0)
    return np.asarray(shine * head - const.DASH_LOW)


def _triangle(turn: Floats) -> Floats:
    return np.asarray(np.abs(turn * 4.0 - 2.0) - 1.0)


def octave(
    lattice: NoiseLattice,
    displacement: Floats,
    motion: Motion | None,
    *,
    planar: bool,
    sparse: bool = False,
) -> Floats:
    """One octave at displacements (N, 3), of variance 1 everywhere between the lattice points."""
    q = lattice.start + displacement * lattice.inverse[:, None]
    base = np.floor(q)
    w = q - base
    spread = 1.0 - 2.0 * w * (1.0 - w)
    cell = base.astype(np.int64).astype(np.uint32)
    key = lattice.key + cell * const.AXIS_PRIMES
    low = scatter(key)
    high = scatter(key + const.AXIS_PRIMES)
    codes = corners(low, high)
    shine: list[Bools | None] = [None, None]
    if sparse:
        shine = _shine(lattice, cell, planar=planar)
    if planar:
        values = grains(codes, motion, shine[0])
        variance = spread[:, :2].prod(axis=-1)
    else:
        below = grains(codes ^ low[:, 2:], motion, shine[0])
        above = grains(codes ^ high[:, 2:], motion, shine[1])
        values = mix(below, above, w[:, 2:])
        variance = spread.prod(axis=-1)
    rows = mix(values[:, 0::2], values[:, 1::2], w[:, :1])
    return np.asarray(
        mix(rows[:, 0], rows[:, 1], w[:, 1]) / np.sqrt(variance * const.GRAIN_VARIANCE)
    )


def _shine(lattice: NoiseLattice, cell: Hashes, *, planar: bool) -> list[Bools | None]:
    """Return which corners of cells (N, 3) are bright, (N, 4) below and, in space, above."""
    at = lattice.origin + cell
    low = block_codes(at, lattice.salt, planar=planar)
    high = block_codes(at + np.uint32(1), lattice.salt, planar=planar)
    block = corners(low[0], high[0])
    place = corners(low[1], high[1])
    if planar:
        return [bright(block, place), None]
    return [bright(block ^ z[0][:, 2:], place ^ z[1][:, 2:]) for z in (low, high)]


def mix(a: Floats, b: Floats, share: Floats | float) -> Floats:
    """Interpolate linearly from a to b."""
    return np.asarray(a + share * (b - a))


class SpaceNoise(Lookup):
    """Two octaves of noise along the paths of fragments."""

    def __init__(self, fragments: Fragments, values: Values, *, planar: bool) -> None:
        self._values = values
        self._planar = planar
        self._motion: Motion | None = None
        position = fragments.position
        if fragments.normal is not None:
            position = on_surface(position, fragments.normal, np.asarray(values["u_eye"]))
        texel = values["u_texel"]
        self._position = position
        longest, shortest = footprint(position.dx, position.dy)
        self._area = longest * shortest
        self._pixel = np.sqrt(longest * np.maximum(shortest, const.LEAST_ROUND * longest))
        if not values["u_lod"]:
            self._pixel = np.full(len(fragments), texel / values["u_grain"])
        self._set_grain()

    def _set_grain(self) -> None:
        """Choose the octaves for grains of pixels of this size."""
        values = self._values
        texel = values["u_texel"]
        grain = self._pixel * values["u_grain"]
        if values["u_fixed"]:
            grain = np.maximum(grain, texel)
        self.level = np.log2(grain / texel)
        self.spacing = values["u_spacing"] * grain
        octaves = np.clip(2.0 * np.log2(grain / values["u_noiseFinest"]), 0.0, const.LAST_OCTAVE)
        octave_numbers = octaves.astype(np.int64)
        self._late = octaves - octave_numbers
        offset = self._position.value - np.asarray(values["u_noiseOrigin"])
        self._fine, self._coarse = (
            noise_lattice(offset, octave_numbers + k, values) for k in range(2)
        )

    def face(self, tangent: Floats) -> DrawnGrains:
        """Make grains larger whose streaks would be finer than pixels, along an outline."""
        values = self._values
        position = self._position
        usual = super().face(tangent)
        if not values["u_lod"]:
            return usual
        normal = unit(np.cross(position.dx, position.dy))
        across = unit(np.cross(normal, tangent))
        by_x = np.einsum("nc,nc->n", position.dx, across)
        by_y = np.einsum("nc,nc->n", position.dy, across)
        side = np.hypot(by_x, by_y)
        self._pixel = np.maximum(self._pixel, const.LEAST_ACROSS * side)
        self._set_grain()
        if values["u_fixed"]:
            return usual
        has_direction = side > 0
        side = np.where(has_direction, side, self._pixel)
        along = np.where(has_direction, self._pixel * side / self._area, 1.0)
        return DrawnGrains(self._pixel / side, along)

    def move(self, slope: Floats, speed: Floats) -> None:
        """Choose the two rates between which the motion of each fragment lies."""
        values = self._values
        if not values["moving"]:
            return
        travel = values["u_travel"] * np.ones(len(speed))
        travel *= self._pixel if values["u_travelInPixels"] else 1.0
        travel *= speed if values["u_travelBySpeed"] else 1.0
        rate = np.log2(np.maximum(travel / (values["u_wave"] * self._pixel), const.LEAST_RATE))
        rates = np.floor(rate)[:, None] + [0.0, 1.0]
        turns = np.exp2(rates) * (rates >= 0)
        coarse, rest = values["u_clock"]
        even = np.mod(rates[:, :1], 2.0) < 0.5
        many = const.MANY_PHASES
        late = rate - rates[:, 0]
        shares = np.stack([1.0 - late, late], axis=-1)
        shares *= const.MOST_GRAIN / np.linalg.norm(shares, axis=-1, keepdims=True)
        self._motion = Motion(
            clock=np.mod(turns * coarse, 1.0) + turns * rest,
            turns=turns * (slope / np.maximum(travel, const.LEAST_TRAVEL))[:, None],
            phases=np.where(even, [1.0, many], [many, 1.0]) / (2.0 * const.MOST_GRAIN),
            shares=shares,
        )

    def lookup(self, displacement: Floats, length: Floats) -> Floats:
        """Both octaves, (N, 2)."""
        if self._motion is None:
            motion = None
        else:
            motion = self._motion.after(length)
        octaves = (
            octave(each, displacement, motion, planar=self._planar, sparse=self._values["sparse"])
            for each in (self._fine, self._coarse)
        )
        return np.stack(list(octaves), axis=-1)

    def blend(self, sums: Sums) -> Floats:
        """Return the mixture (N,) of the sums of both octaves, brought to unit variance.

        The share of the coarser octave is how far the level of detail lies between both. The
        variance of a sum follows from the spacing of its samples in grains and from the overlap of
        neighbouring weights.
        """
        overlap = sums.neighbours / sums.squares
        spacing = self._values["u_spacing"] * np.exp2(0.5 * self._late)
        mixed = np.zeros(len(overlap))
        variance = np.zeros(len(overlap))
        for k, w in enumerate((1.0 - self._late, self._late)):
            mixed += w * sums.values[:, k]
            variance += w * w * shared(spacing * 0.5 ** (k / 2), overlap)
        return np.asarray(mixed / np.sqrt(sums.squares * variance))


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
        self._mips = mips
        self._values = values
        self._start = coordinate.value
        size, step_size = (np.asarray(values[name]) for name in ("u_imageSize", "u_stepSize"))
        self.level = mip_level(covered_texels(coordinate, size), values)
        self._inset = np.minimum(0.5 * np.exp2(np.ceil(self.level))[:, None] / size, 0.5)
        covered = covered_texels(coordinate, step_size)
        # A step must not skip a texel of the image.
        least = min(float(np.min(step_size / size)), 1.0)
        width = np.full_like(covered, least)
        if values["u_lod"]:
            width = np.maximum(covered, least)
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
    if longest:
        return long
    return np.sqrt(long * short)


def mip_level(texels: Floats, values: Values) -> Floats:
    """Return the mip level at which a texel is as wide as that many of the finest level."""
    if not values["u_lod"]:
        return np.zeros(len(texels))
    return np.asarray(np.maximum(np.log2(np.maximum(texels, const.LEAST_TEXELS)), 0.0))
