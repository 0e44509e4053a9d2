"""Noise that is even in space: ``shaders/common/noise.glsl`` for many points at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flowtex._util.array_types import Floats, Ints

__all__ = ["Lattice", "Motion", "lattice", "mix", "octave"]

Hashes = NDArray[np.uint32]

PRIMES = np.array([0x8DA6B343, 0xD8163841, 0xCB1AB31F], dtype=np.uint32)
#: Keys of the corners of a cell that differ in their first two coordinates, (4,).
CORNERS = (
    np.array([0, 1, 0, 1], np.uint32) * PRIMES[0] + np.array([0, 0, 1, 1], np.uint32) * PRIMES[1]
)


@dataclass(frozen=True, eq=False)
class Lattice:
    """What is the same for every point of the paths of N fragments.

    Attributes
    ----------
    here
        The fragments, (N, 3), in cells from the lattice point nearest to the origin.
    inverse
        Cells by length, (N,).
    key
        Hash of that lattice point, the octave and the seed, by axis, (N, 3).
    """

    here: Floats
    inverse: Floats
    key: Hashes


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of the grains at N fragments: two rates, and how far it is between them.

    Attributes
    ----------
    clock
        The moment in turns, (N, 2).
    turns
        Turns by length of path, (N, 2).
    phases
        Which phases of a grain belong to the rates, (N, 2).
    late
        From 0, the first rate, to 1, the second, (N,).
    """

    clock: Floats
    turns: Floats
    phases: Floats
    late: Floats

    def after(self, length: Floats) -> Motion:
        """Return the motion a length (N,) along the paths."""
        clock = self.clock + self.turns * length[:, None]
        return Motion(clock, self.turns, self.phases, self.late)


def lattice(position: Floats, octave: Ints, values: Mapping[str, Any]) -> Lattice:
    """Lattice of an octave (N,) at positions (N, 3) relative to the origin of the noise."""
    odd, doublings = (octave & 1 == 1)[:, None], (octave >> 1)[:, None]
    shrink = np.exp2(-doublings.astype(float))
    inverse = shrink / values["u_noiseFinest"] * np.where(odd, np.sqrt(0.5), 1.0)
    finest = np.where(odd, values["u_noiseOriginOdd"], values["u_noiseOriginEven"]).astype(np.int64)
    origin = finest >> doublings
    rest = (finest - (origin << doublings) + np.where(odd, values["u_noiseRestOdd"], 0.0)) * shrink
    key = origin.astype(np.uint32) * PRIMES
    seed = np.array([values["u_seed"]], np.uint32) * np.uint32(0x85EBCA6B)
    key[:, 0] += octave.astype(np.uint32) * np.uint32(0x9E3779B9) + seed
    return Lattice(position * inverse + rest, inverse[:, 0], key)


def grains(h: Hashes, motion: Motion | None) -> Floats:
    """Values of lattice points from their keys (N, 4), uniform in -1 ... 1."""
    h = (h ^ (h >> np.uint32(15))) * np.uint32(0x2C1B3C6D)
    h = (h ^ (h >> np.uint32(13))) * np.uint32(0x297A2D39)
    phase = (h >> np.uint32(8)) * (1.0 / 16777216.0)
    if motion is None:
        return np.asarray(phase * 2.0 - 1.0)
    slow, fast = (
        _triangle(phase * motion.phases[:, k, None] + motion.clock[:, k, None]) for k in range(2)
    )
    late = motion.late[:, None]
    return np.asarray(mix(slow, fast, late) / np.sqrt(1.0 - 2.0 * late * (1.0 - late)))


def _triangle(turn: Floats) -> Floats:
    return np.asarray(np.abs((turn - np.floor(turn)) * 4.0 - 2.0) - 1.0)


def octave(lat: Lattice, displacement: Floats, motion: Motion | None, *, planar: bool) -> Floats:
    """One octave at displacements (N, 3), of variance 1 everywhere between the lattice points."""
    q = lat.here + displacement * lat.inverse[:, None]
    base = np.floor(q)
    w = q - base
    spread = 1.0 - 2.0 * w * (1.0 - w)
    k = lat.key + base.astype(np.int64).astype(np.uint32) * PRIMES
    corners = (k[:, 0] + k[:, 1] + k[:, 2])[:, None] + CORNERS
    values = grains(corners, motion)
    variance = spread[:, 0] * spread[:, 1]
    if not planar:
        values = mix(values, grains(corners + PRIMES[2], motion), w[:, 2:])
        variance = variance * spread[:, 2]
    rows = mix(values[:, 0::2], values[:, 1::2], w[:, :1])
    return np.asarray(mix(rows[:, 0], rows[:, 1], w[:, 1]) / np.sqrt(variance / 3.0))


def mix(a: Floats, b: Floats, share: Floats | float) -> Floats:
    """Linear between a and b."""
    return np.asarray(a + share * (b - a))
