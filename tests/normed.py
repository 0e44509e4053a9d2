"""A scalar that grows along x, norms of all kinds for it, and the colours that matplotlib gives."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import (
    AsinhNorm,
    BoundaryNorm,
    CenteredNorm,
    FuncNorm,
    LogNorm,
    Normalize,
    PowerNorm,
    SymLogNorm,
    TwoSlopeNorm,
)

from flowtex import FlowField
from flowtex._util.array_types import Floats

#: Values at the ends of the surface, and its height over its width.
LOW, HIGH, HEIGHT = -20.0, 80.0, 0.5
#: Colours alone, without the texture.
PLAIN: dict[str, Any] = {"scalars": "p", "strength": 0.0, "lighting": False}
NORMS: dict[str, Any] = {
    "even": lambda: Normalize(0, 50),
    "power": lambda: PowerNorm(0.5, LOW, HIGH),
    "steep power": lambda: PowerNorm(0.25, LOW, HIGH),
    "log": lambda: LogNorm(0.01, HIGH),
    "symlog": lambda: SymLogNorm(0.01, vmin=LOW, vmax=HIGH),
    "asinh": lambda: AsinhNorm(0.1, LOW, HIGH),
    "centred": lambda: CenteredNorm(10, 40),
    "two slopes": lambda: TwoSlopeNorm(0, LOW, HIGH),
    "function": lambda: FuncNorm((np.cbrt, lambda y: y**3), LOW, HIGH),
    "boundaries": lambda: BoundaryNorm([LOW, -10, 0, 5, 7, 60, HIGH], 256),
    "open boundaries": lambda: BoundaryNorm([-10, 0, 5, 7, 60], 256, extend="both"),
}


@cache
def ramp() -> FlowField:
    """Return a sheet from (0, 0) to (1, 0.5) with a scalar that is linear in x."""
    x, y = np.linspace(0, 1, 41), np.linspace(0, HEIGHT, 21)
    velocity = np.stack([np.ones((21, 41)), 0.3 * np.cos(6 * x) + 0 * y[:, None]], axis=-1)
    values = LOW + (HIGH - LOW) * np.broadcast_to(x, (21, 41))
    return FlowField.from_arrays((x, y), velocity, scalars={"p": values})


def differences(row: Any, x: Floats, norm: Any, cmap: str = "viridis") -> Floats:
    """Return how far a row of pixels is from the colours of matplotlib at x, in grey levels.

    The best within a twentieth of a pixel counts, as a border of two colours may lie at a pixel.
    Values without a logarithm have the colour below the range.
    """
    values = LOW + (HIGH - LOW) * x
    aside = 0.05 * (values[1] - values[0])
    with np.errstate(all="ignore"):
        wanted = [
            255 * colormaps[cmap](np.ma.filled(norm(values + d), -1))[:, :3]
            for d in (-aside, 0, aside)
        ]
    off = [np.abs(np.asarray(row, dtype=float) - colours).max(axis=-1) for colours in wanted]
    return np.asarray(np.min(off, axis=0))
