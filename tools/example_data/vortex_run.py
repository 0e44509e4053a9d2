"""Decaying turbulence, the example ``vortex``: how it is computed.

Random vorticity on 198 x 198 nodes is left alone until vortices have formed. Then the vorticity
of 31 instants is stored on every second node; the velocity follows from it exactly when it is
read.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from packing import pack, save
from periodic_flow import PeriodicFlow, decaying_turbulence, resample
from scipy import fft

from flowtex.examples._shipped import DATA, VORTEX

Real = NDArray[np.float64]

#: Nodes that are computed and shipped along each axis, the closing line not counted.
COMPUTED, NODES = 198, 99
VISCOSITY, SEED, WAVES = 2e-4, 3, 6.0
#: Time step; steps until vortices have formed; steps between stored instants; stored instants.
STEP, STEPS_BEFORE, STEPS_BETWEEN, INSTANTS = 0.002, 600, 20, 31


def advance(vorticity: NDArray[np.complex128], count: int) -> NDArray[np.complex128]:
    """Advance coefficients on the computed nodes by `count` time steps."""
    return PeriodicFlow(COMPUTED, VISCOSITY).advance(vorticity, STEP, count)


def at_nodes(vorticity: NDArray[np.complex128]) -> Real:
    """Vorticity (99, 99) at the shipped nodes, from coefficients on the computed ones."""
    return np.asarray(fft.irfft2(resample(vorticity, NODES), (NODES, NODES)))


def run(tell: Callable[[int], None] = lambda _: None) -> tuple[Real, Real]:
    """Compute the vorticity (31, 99, 99) and the times (31,), from the seed.

    Parameters
    ----------
    tell : callable, optional
        Called with the number of steps that were taken.
    """
    vorticity = decaying_turbulence(COMPUTED, SEED, WAVES)
    for _ in range(STEPS_BEFORE // STEPS_BETWEEN):
        vorticity = advance(vorticity, STEPS_BETWEEN)
        tell(STEPS_BETWEEN)
    instants = [at_nodes(vorticity)]
    for _ in range(INSTANTS - 1):
        vorticity = advance(vorticity, STEPS_BETWEEN)
        instants.append(at_nodes(vorticity))
        tell(STEPS_BETWEEN)
    times: Real = np.linspace(0.0, STEP * STEPS_BETWEEN * (INSTANTS - 1), INSTANTS)
    return np.array(instants), times


def write(vorticity: Real, times: Real, folder: Path | None = None) -> None:
    """Write the file."""
    packed, step = pack(vorticity, axis=(1, 2))
    save((folder or DATA) / VORTEX, {"vorticity": packed, "step": step, "times": times})
