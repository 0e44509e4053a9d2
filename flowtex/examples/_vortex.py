"""The shipped stretch of decaying turbulence: how it is computed, and file to arrays.

Random vorticity on 198 x 198 nodes is left alone until vortices have formed. Then the vorticity
of 31 instants is kept on every second node; the velocity follows from it exactly when it is read.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from flowtex.examples import _store
from flowtex.examples._periodic_flow import PeriodicFlow, decaying_turbulence, resample

Real = NDArray[np.float64]

__all__ = ["FILE", "NODES", "advance", "arrays", "run", "stored", "write"]

FILE = "vortex.npz"
#: Nodes that are computed and shipped along each axis, the closing line not counted.
COMPUTED, NODES = 198, 99
VISCOSITY, SEED, WAVES = 2e-4, 3, 6.0
#: Time step; steps until vortices have formed; steps between kept instants; kept instants.
STEP, BEFORE, BETWEEN, KEPT = 0.002, 600, 20, 31


def advance(vorticity: NDArray[np.complex128], count: int) -> NDArray[np.complex128]:
    """Advance coefficients on the computed nodes by `count` time steps."""
    return PeriodicFlow(COMPUTED, VISCOSITY).advance(vorticity, STEP, count)


def stored(vorticity: NDArray[np.complex128]) -> Real:
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
    for _ in range(BEFORE // BETWEEN):
        vorticity = advance(vorticity, BETWEEN)
        tell(BETWEEN)
    kept = [stored(vorticity)]
    for _ in range(KEPT - 1):
        vorticity = advance(vorticity, BETWEEN)
        kept.append(stored(vorticity))
        tell(BETWEEN)
    times: Real = np.linspace(0.0, STEP * BETWEEN * (KEPT - 1), KEPT)
    return np.array(kept), times


def write(vorticity: Real, times: Real, folder: Path = _store.DATA) -> None:
    """Write the file."""
    packed, step = _store.pack(vorticity, axis=2)
    _store.save(folder / FILE, {"vorticity": packed, "step": step, "times": times})


def arrays() -> tuple[Real, Real, Real, Real]:
    """Points (100, 100, 2), velocity (31, 100, 100, 2), vorticity (31, 100, 100), times (31,).

    The last row and column repeat the first, one box further on.
    """
    file = _store.load(FILE)
    vorticity = _store.unpack(file["vorticity"], float(file["step"]), axis=2)
    flow = PeriodicFlow(NODES, VISCOSITY)
    velocity = np.array([flow.velocity(fft.rfft2(w)) for w in vorticity])
    axis = np.linspace(0.0, 1.0, NODES + 1)
    points = np.stack(np.meshgrid(axis, axis), axis=-1)
    joined = np.arange(NODES + 1) % NODES
    return (
        points,
        velocity[:, joined][:, :, joined],
        vorticity[:, joined][:, :, joined],
        file["times"],
    )
