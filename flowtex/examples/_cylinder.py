"""The shipped period of vortex shedding: file to arrays and back."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.interpolate import CubicSpline

from flowtex.examples import _store
from flowtex.examples._cylinder_flow import CylinderFlow
from flowtex.examples._cylinder_run import FULL, Shedding, node_radii

Real = NDArray[np.float64]

__all__ = ["FILE", "RESTART", "arrays", "facts", "restart", "vorticity", "write"]

#: Velocities and forces; and the state from which the run can be taken up.
FILE, RESTART = "cylinder.npz", "cylinder_restart.npz"


def write(shedding: Shedding, folder: Path = _store.DATA) -> None:
    """Write both files."""
    packed, step = _store.pack(shedding.velocity, axis=2)
    setup = shedding.setup
    facts = {
        "times": shedding.times,
        "radii": node_radii(),
        "forces": shedding.forces.astype(np.float32),
        "reynolds": setup.reynolds,
        "strouhal": shedding.strouhal,
        "drag": shedding.forces[1:, 0].mean(),
        "lift": np.abs(shedding.forces[:, 1]).max(),
    }
    _store.save(folder / FILE, {"velocity": packed, "step": step, **facts})
    start = shedding.start.astype(np.complex64)
    _store.save(folder / RESTART, {"vorticity": start, "step": setup.step})


def facts() -> dict[str, Any]:
    """Read what the shipped file says of the run: Reynolds and Strouhal number, drag, forces."""
    return {k: v for k, v in _store.load(FILE).items() if k not in {"velocity", "step", "radii"}}


def arrays() -> tuple[Real, Real, Real]:
    """Points (65, 161, 2), velocity (31, 65, 161, 2), and times (31,)."""
    file = _store.load(FILE)
    velocity = _store.unpack(file["velocity"], float(file["step"]), axis=2)
    columns = velocity.shape[2]
    theta = 2.0 * np.pi * np.arange(columns) / columns
    points = file["radii"][:, None, None] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
    closed = [np.concatenate([a, a[..., :1, :]], axis=-2) for a in (points, velocity)]
    return closed[0], closed[1], file["times"]


def vorticity(points: Real, velocity: Real) -> Real:
    """Vorticity of a flow on the polar grid.

    Parameters
    ----------
    points : ndarray, shape (J, I, 2)
        Nodes on circles around the origin, evenly spaced on each, the last column the first.
    velocity : ndarray, shape (T, J, I, 2)
        Velocity at the nodes.

    Returns
    -------
    ndarray, shape (T, J, I)
        Spectral derivatives around, cubic splines outwards.
    """
    radii = np.hypot(points[:, 0, 0], points[:, 0, 1])
    open_points, open_velocity = points[:, :-1], velocity[:, :, :-1]
    cosine, sine = np.moveaxis(open_points / radii[:, None, None], -1, 0)
    u, v = np.moveaxis(open_velocity, -1, 0)
    outward, around = u * cosine + v * sine, v * cosine - u * sine
    count = cosine.shape[1]
    modes = fft.rfft(outward, axis=-1) * 1j * np.arange(count // 2 + 1)
    slope = CubicSpline(radii, radii[:, None] * around, axis=1)(radii, 1)
    result = (slope - fft.irfft(modes, count, axis=-1)) / radii[:, None]
    return np.concatenate([result, result[..., :1]], axis=-1)


def restart() -> CylinderFlow:
    """Return the flow at the first shipped instant, ready to advance."""
    file = _store.load(RESTART)
    setup = replace(FULL, step=float(file["step"]))
    return CylinderFlow(setup, file["vorticity"].astype(np.complex128))
