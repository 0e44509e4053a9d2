"""Particles on their way, and one step of theirs, as arrays whose last axis is the particles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Particles", "Step", "join"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]
Bools = NDArray[np.bool_]
Numbers = NDArray[np.int8]


@dataclass
class Particles:
    """Particles still under way; the last axis is theirs.

    Where there are poles, ``chart`` is what ``y`` is given on, and ``index`` the same in index
    space; elsewhere both are None.
    """

    which: Indices
    unit: Floats
    rest: Floats
    y: Floats
    lag: Floats
    step: Floats
    rate: Floats
    next: Indices
    chart: Numbers | None
    index: Floats | None

    def pick(self, mask: Bools) -> Particles:
        """Return some of them."""
        return Particles(*_picked(self, mask))


@dataclass
class Step:
    """Steps of some particles, from (y0, k0) at lag0 to (y1, k1); the last axis is theirs."""

    y0: Floats
    k0: Floats
    y1: Floats
    k1: Floats
    lag0: Floats
    h: Floats
    chart: Numbers | None = None
    index: Floats | None = None

    def pick(self, mask: Bools | Indices) -> Step:
        """Return the steps of some of them."""
        return Step(*_picked(self, mask))

    def at(self, s: Floats) -> Floats:
        """Position at a fraction of each step, by the cubic through both ends and slopes."""
        r = 1 - s
        start = r * r * (self.y0 + s * (2 * self.y0 + self.h * self.k0))
        return np.asarray(start + s * s * (self.y1 + r * (2 * self.y1 - self.h * self.k1)))


def join(one: Particles, two: Particles) -> Particles:
    """Put some particles behind others."""
    pairs = ((getattr(one, f.name), getattr(two, f.name)) for f in fields(Particles))
    joined: Iterator[Any] = (
        None if a is None else np.concatenate([a, b], axis=-1) for a, b in pairs
    )
    return Particles(*joined)


def _picked(these: Particles | Step, mask: Bools | Indices) -> Iterator[Any]:
    parts = (getattr(these, f.name) for f in fields(these))
    return (None if part is None else part[..., mask] for part in parts)
