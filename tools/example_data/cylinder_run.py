"""Vortex shedding, the example ``cylinder``: how it is computed, and in which form it is stored.

The run has four stages: a coarse grid from rest until the wake sheds; the full grid until the
coarse wake has left it; a few periods to measure the period; and, with a step that divides it,
one whole period of which every 40th step is stored: velocities on an O-grid that ends
inside the computed domain, in 16-bit steps of the largest component, and the vorticity of the
first of them in full, from which the run can be taken up again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from cylinder_flow import RADIUS, CylinderFlow, CylinderSetup
from numpy.typing import NDArray
from packing import pack, save
from scipy import fft
from scipy.interpolate import CubicSpline, make_interp_spline

from flowtex.examples._shipped import CYLINDER, DATA, unpack

Real = NDArray[np.float64]

#: The state from which the run can be taken up.
RESTART = Path(__file__).parent / "cylinder_restart.npz"

#: Grid and Reynolds number of the shipped run; its step is then set to divide the period.
FULL = CylinderSetup()
COARSE = replace(FULL, modes=64, intervals=128, step=0.01)
#: Time from rest on the coarse grid, on the full one until it settles, and to find the period.
DURATIONS = (120.0, 45.0, 20.0)
#: Time steps from one stored instant to the next, and stored instants less one in a period.
STEPS, INSTANTS = 40, 30
#: Nodes outwards, and around without the closing one.
ROWS, COLUMNS = 65, 160
#: Radius at which the shipped grid ends; the computed one continues to ``FULL.outer``.
EDGE = 15.0


@dataclass(frozen=True)
class Shedding:
    """One period of shedding.

    Attributes
    ----------
    velocity : ndarray, shape (31, 65, 160, 2)
        Velocity at the nodes, in free-stream speeds; the closing column is left out.
    times : ndarray, shape (31,)
        Times from the first instant, in diameters over the free stream.
    forces : ndarray, shape (1201, 2)
        Drag and lift coefficient at each time step.
    setup : CylinderSetup
        Grid and time step of the run.
    start : ndarray, shape (modes, intervals + 1)
        Fourier coefficients of the vorticity at the first instant.
    """

    velocity: Real
    times: Real
    forces: Real
    setup: CylinderSetup
    start: NDArray[np.complex128]

    @property
    def strouhal(self) -> float:
        """Shedding frequency in free-stream speeds per diameter."""
        return float(1.0 / self.times[-1])


def node_radii() -> Real:
    """Radii of the shipped grid (65,): cells of 0.02 diameters at the wall, of 0.43 outside."""
    s = np.linspace(-3.0, 3.0, ROWS)
    rise = np.logaddexp(0.0, s)
    return np.asarray(RADIUS + (EDGE - RADIUS) * (rise - rise[0]) / (rise[-1] - rise[0]))


def node_velocity(flow: CylinderFlow) -> Real:
    """Velocity (65, 160, 2) along x and y at the nodes of the shipped grid."""
    xi = np.log(node_radii() / RADIUS)
    outward, around = (
        fft.irfft(
            make_interp_spline(flow.setup.xi, part, k=5, axis=1)(xi),
            COLUMNS,
            axis=0,
            norm="forward",
        ).T
        for part in flow.polar_velocity()
    )
    theta = 2.0 * np.pi * np.arange(COLUMNS) / COLUMNS
    cosine, sine = np.cos(theta), np.sin(theta)
    velocity = np.stack(
        [outward * cosine - around * sine, outward * sine + around * cosine], axis=-1
    )
    velocity[0] = 0.0
    return velocity


def polar_vorticity(velocity: Real) -> Real:
    """Vorticity (T, 65, 160) of velocities (T, 65, 160, 2) on the shipped grid.

    Derivatives are spectral around, and by cubic splines outwards.
    """
    radii, count = node_radii(), velocity.shape[2]
    theta = 2.0 * np.pi * np.arange(count) / count
    u, v = np.moveaxis(velocity, -1, 0)
    cosine, sine = np.cos(theta), np.sin(theta)
    outward, around = u * cosine + v * sine, v * cosine - u * sine
    modes = fft.rfft(outward, axis=-1) * 1j * np.arange(count // 2 + 1)
    slope = CubicSpline(radii, radii[:, None] * around, axis=1)(radii, 1)
    return np.asarray((slope - fft.irfft(modes, count, axis=-1)) / radii[:, None])


def refine(flow: CylinderFlow, setup: CylinderSetup) -> CylinderFlow:
    """Return the same instant on another grid of the same extent."""
    old = flow.vorticity
    spline = make_interp_spline(flow.setup.xi, old, k=5, axis=1)
    vorticity = np.zeros((setup.modes, setup.intervals + 1), dtype=np.complex128)
    count = min(setup.modes, flow.setup.modes)
    vorticity[:count] = spline(setup.xi)[:count]
    return CylinderFlow(setup, vorticity, flow.time)


def _advance(flow: CylinderFlow, count: int, tell: Callable[[float], None]) -> Real:
    """Advance by `count` steps; time, drag and lift (count, 3) after each."""
    history = []
    for _ in range(count):
        flow.advance()
        history.append((flow.time, *flow.forces()))
        if not np.isfinite(history[-1]).all():
            message = (
                f"the flow grew without bound before time {flow.time:g}; choose a time step "
                f"smaller than {flow.setup.step}"
            )
            raise ArithmeticError(message)
        tell(flow.setup.step)
    return np.array(history)


def _period(history: Real) -> float:
    """Mean time between the upward zeros of the lift."""
    time, lift = history[:, 0], history[:, 2]
    before = np.flatnonzero((lift[:-1] < 0.0) & (lift[1:] >= 0.0))
    if before.size < 2:
        message = f"the lift rises through zero {before.size} times; the wake is not shedding yet"
        raise ArithmeticError(message)
    share = -lift[before] / (lift[before + 1] - lift[before])
    zeros = time[before] + share * (time[before + 1] - time[before])
    return float((zeros[-1] - zeros[0]) / (zeros.size - 1))


def run(
    tell: Callable[[float], None] = lambda _: None,
    *,
    durations: tuple[float, float, float] = DURATIONS,
    coarse: CylinderSetup = COARSE,
    full: CylinderSetup = FULL,
) -> Shedding:
    """Compute one period of shedding from rest.

    Parameters
    ----------
    tell : callable, optional
        Called with the time that was advanced, after each step.
    durations : tuple of float
        Length of the first three stages; two periods more follow.
    coarse, full : CylinderSetup
        The two grids; `full` is the one whose solution is kept.

    Returns
    -------
    Shedding
        The period, beginning where the lift was last found to rise through zero or soon after.

    Raises
    ------
    ArithmeticError
        When the wake does not shed after these durations, or a time step is too large.
    """
    rest, settle, measure = durations
    flow = CylinderFlow(coarse)
    _advance(flow, round(rest / coarse.step), tell)
    flow = refine(flow, full)
    _advance(flow, round(settle / full.step), tell)
    period = _period(_advance(flow, round(measure / full.step), tell))
    flow = refine(flow, replace(full, step=period / (STEPS * INSTANTS)))
    _advance(flow, STEPS * INSTANTS, tell)
    start = flow.vorticity
    velocity, forces = [node_velocity(flow)], [flow.forces()]
    for _ in range(INSTANTS):
        forces.extend((drag, lift) for _, drag, lift in _advance(flow, STEPS, tell))
        velocity.append(node_velocity(flow))
    times: Real = np.linspace(0.0, INSTANTS * STEPS * flow.setup.step, INSTANTS + 1)
    return Shedding(np.array(velocity), times, np.array(forces), flow.setup, start)


def write(shedding: Shedding, folder: Path | None = None) -> None:
    """Write the example's file, and the state from which the run can be taken up."""
    packed, step = pack(shedding.velocity, axis=(0, 1, 2))
    # Of the velocity as it is read.
    vorticity = pack(polar_vorticity(unpack(packed, step, (0, 1, 2))), axis=(0, 1, 2))
    setup = shedding.setup
    facts = {
        "vorticity": vorticity[0],
        "vorticity_step": vorticity[1],
        "times": shedding.times,
        "radii": node_radii(),
        "forces": shedding.forces.astype(np.float32),
        "reynolds": setup.reynolds,
        "strouhal": shedding.strouhal,
        "drag": shedding.forces[1:, 0].mean(),
        "lift": np.abs(shedding.forces[:, 1]).max(),
    }
    save((folder or DATA) / CYLINDER, {"velocity": packed, "step": step, **facts})
    start = shedding.start.astype(np.complex64)
    save((folder or RESTART.parent) / RESTART.name, {"vorticity": start, "step": setup.step})


def restart(file: Path = RESTART) -> CylinderFlow:
    """Return the flow at the first stored instant, ready to advance."""
    with np.load(file, allow_pickle=False) as arrays:
        setup = replace(FULL, step=float(arrays["step"]))
        return CylinderFlow(setup, arrays["vorticity"].astype(np.complex128))
