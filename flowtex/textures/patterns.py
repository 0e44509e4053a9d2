"""Patterns that are laid on the noise texture: even noise, the spots of Spot Noise, squares.

Corrected for the distribution of the cells (figure 6), a pattern is a function of the position in
space, and each texel takes its value where the texel lies on the surface. A texel that is too
long for a detail takes a coarser one, so that what is drawn is even wherever the texels allow.
Without the correction a pattern lies evenly on the texels and is stretched with the cells.

Spots: van Wijk, *Spot Noise*, Computer Graphics 25(4), 1991.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Ints
from flowtex.field import FlowField
from flowtex.field.interpolation import between_nodes

#: Texels from one spot to the next, and the width of squares of noise that averages as spots do.
SPOT, SPOT_GRAIN = 8, 7.2
#: Radius of a spot, and width of its soft edge, as shares of the way to the next one.
RADIUS, EDGE = 0.5, 0.2
#: A spot takes this many texels, along their longer side, from it to the next one.
COARSEST = 4
#: Squares of a checkerboard along the longer side of the surface.
SQUARES = 16


@dataclass(frozen=True, eq=False)
class TexelMap:
    """Where the texels of a texture lie on a surface."""

    field: FlowField
    index: Floats  #: Middle of each texel as (i, j), (H, W, 2).
    size: Floats  #: Size of each texel in cells, (H, W, 2).
    corrected: bool  #: Whether a pattern is even on the surface, not on the texels.

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width, in texels."""
        return self.index.shape[0], self.index.shape[1]

    @property
    def lengths(self) -> Floats:
        """Sides of the texels in space, (H, W, 2) along i and along j."""
        tangents = (np.linalg.norm(t, axis=-1) for t in self.field.surface.tangents)
        return np.stack(
            [
                between_nodes(p, self.index) * self.size[..., axis]
                for axis, p in enumerate(tangents)
            ],
            axis=-1,
        )

    @property
    def positions(self) -> Floats:
        """Middles of the texels relative to that of the surface, (H, W, 2), or 3 when curved."""
        surface = self.field.surface
        local = surface.at(self.index) - surface.center
        return local if surface.frame is None else np.asarray(local @ surface.frame.T)


def even_noise(texels: TexelMap, seed: int) -> Floats:
    """Return noise (H, W) from 0 to 1, at each texel as coarse as the texel is long.

    A texel takes the random number of the cube of a lattice in space in which it lies. The
    lattice is that power of two of the finest which is nearest to the texel's longer side.
    """
    surface = texels.field.surface
    size = texels.lengths.max(axis=-1)
    octave = np.rint(np.log2(np.maximum(size, surface.extent * 1e-7))).astype(np.int64)
    position = surface.at(texels.index) - surface.center
    cell = np.floor(position / (2.0**octave)[..., None]).astype(np.int64)
    return _hash(cell, octave, seed).astype(np.float64) / 2.0**64


def spots(texels: TexelMap, seed: int) -> Floats:
    """Return discs at random places and of random sign, (H, W).

    Every cell of a lattice holds one disc at a random place inside it. The lattice is that in
    space, :data:`SPOT` texels wide, or as much wider by a power of two as a long texel needs;
    without the correction it is that of the texels.
    """
    if texels.corrected:
        place, octave = _places_in_space(texels)
        wrap = None
    else:
        height, width = texels.shape
        middles = (np.arange(width) + 0.5, np.arange(height) + 0.5)
        place = np.stack(np.meshgrid(*middles), axis=-1) / SPOT
        octave = np.zeros(texels.shape, np.int64)
        wrap = np.array([max(width // SPOT, 1), max(height // SPOT, 1)])
    base = np.floor(place).astype(np.int64)
    total = np.zeros(texels.shape)
    for offset in itertools.product((-1, 0, 1), repeat=place.shape[-1]):
        cell = base + np.array(offset)
        number = _hash(cell if wrap is None else np.mod(cell, wrap), octave, seed)
        total += _disc(place - cell, number)
    return total


def _places_in_space(texels: TexelMap) -> tuple[Floats, Ints]:
    """Return texels in cells of the lattice of spots, (H, W, 2 or 3), and its octave, (H, W)."""
    long_ = texels.lengths.max(axis=-1)
    width = SPOT * float(np.median(long_))
    octave = np.ceil(np.log2(np.maximum(COARSEST * long_ / width, 1.0)) - 1e-9).astype(np.int64)
    return texels.positions / (width * 2.0**octave)[..., None], octave


def _disc(place: Floats, number: NDArray[np.uint64]) -> Floats:
    """Return the value of a cell's disc, whose number holds its middle and sign, at a place."""
    away = np.zeros(number.shape)
    for axis in range(place.shape[-1]):
        middle = (number >> np.uint64(16 * axis) & np.uint64(0xFFFF)) / 65536.0
        away += (place[..., axis] - middle) ** 2
    disc = np.clip((RADIUS - np.sqrt(away)) / EDGE + 0.5, 0.0, 1.0)
    return np.where(number >> np.uint64(63), disc, -disc)


def checkerboard(texels: TexelMap, tiles: int) -> Floats:
    """Return black and white squares, (H, W) from 0 to 1, with edges as wide as a texel.

    Squares lie in the plane of a flat surface when corrected, and on the parameters otherwise.
    :data:`SQUARES` times ``tiles`` of them go along the longer side.
    """
    count = SQUARES * tiles
    if texels.corrected and texels.field.surface.frame is not None:
        nodes = texels.field.points[texels.field.valid] - texels.field.surface.center
        local = nodes @ texels.field.surface.frame.T
        start, span = local.min(axis=0), float(np.ptp(local, axis=0).max())
        place = (texels.positions - start) * (count / span)
        wide = np.broadcast_to(texels.lengths.max(axis=-1)[..., None] * (count / span), place.shape)
    else:
        counts = _counts(texels.field, count)
        middles = [(np.arange(n) + 0.5) / n for n in texels.shape[::-1]]
        place = np.stack(np.meshgrid(*middles), axis=-1) * counts
        wide = np.broadcast_to(counts / np.array(texels.shape[::-1]), place.shape)
    return np.asarray(0.5 + 0.5 * np.prod(_wave(place, wide), axis=-1))


def side_lengths(field: FlowField) -> Floats:
    """Return lengths of a surface along i and along j, (2,)."""
    tangents = (np.linalg.norm(t, axis=-1)[field.valid].mean() for t in field.surface.tangents)
    return np.array([t * (n - 1) for t, n in zip(tangents, field.shape[::-1], strict=True)])


def _counts(field: FlowField, count: int) -> Floats:
    """Return squares along i and along j; whole pairs around an axis that closes on itself."""
    lengths = side_lengths(field)
    counts = np.asarray(count * lengths / lengths.max())
    closed = np.array(field.periodic[::-1])
    return np.where(closed, 2 * np.maximum(np.rint(counts / 2), 1), counts)


def _wave(x: Floats, wide: Floats) -> Floats:
    """Return the square wave of period 2, above zero in 0 ... 1, with steps of the given width."""
    inside = 0.5 - np.abs(np.mod(x + 0.5, 2.0) - 1.0)  # distance to the nearest step, signed
    return np.asarray(np.clip(inside * (2.0 / np.maximum(wide, 1e-9)), -1.0, 1.0))


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
