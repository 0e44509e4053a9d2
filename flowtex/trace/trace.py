"""FlowField to TraceSlices.

Particles are followed in blocks small enough to stay in a processor's cache, several blocks at a
time in threads: NumPy lets go of the interpreter inside its loops.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.field import FlowField
from flowtex.progress import track
from flowtex.trace.compose import compose as compose_slices
from flowtex.trace.integrate import Paths, integrate
from flowtex.trace.lags import choose_lags, lag_unit
from flowtex.trace.sampler import LengthSampler, Sampler, TimeSampler
from flowtex.trace.slices import TraceSlices

__all__ = ["paths", "trace"]

Floats = NDArray[np.float64]

#: Particles followed together.
BLOCK = 8192
#: Error allowed in one step, in cells.
TOLERANCE = 1e-3
#: Automatic lags of a steady field that are integrated; longer ones are composed.
DIRECT = 6


@dataclass(frozen=True)
class _Job:
    """One block of particles to follow towards one destination time."""

    step: int
    block: slice
    direction: float


def trace(
    field: FlowField,
    *,
    lags: Sequence[float] | ArrayLike | None = None,
    unit: ArrayLike | None = None,
    parameter: str = "arclength",
    two_sided: bool = True,
    tolerance: float = TOLERANCE,
    steps: Sequence[int] | None = None,
    compose: bool | None = None,
    progress: bool = True,
) -> TraceSlices:
    """Follow the path through every node and keep it at a handful of lags.

    Paper section 3.1: from every node a particle is followed backward from the destination time
    Td, and its positions at the release times Td - lag make the trace slices. A steady field is
    followed along its streamlines, forward too; a time-varying one along pathlines, with
    velocities interpolated linearly in time and held constant before the first step.

    Parameters
    ----------
    field
        The flow.
    lags
        Lags to keep, (M,), positive and increasing, in multiples of ``unit``. By default
        they double from a quarter of a cell to a quarter of the surface.
    unit
        One unit of lag at each node, (J, I), or one number. By default the local cell size for
        paths by arc length, one unit of time else.
    parameter
        ``"arclength"`` or ``"time"``; a time-varying field is always followed by time.
    two_sided
        Whether a steady field is followed forward too.
    tolerance
        Error allowed in one step of the integration, in cells.
    steps
        Destination times to trace, as indices into ``field.times``; all by default.
    compose
        Whether the long lags of a steady field are put together from short ones (see
        :mod:`flowtex.trace.compose`) instead of being integrated. By default they are when the
        lags are chosen automatically.
    progress
        Whether to show a progress bar when the work takes longer than a second.

    Returns
    -------
    TraceSlices

    Raises
    ------
    ValueError
        When the lags are not positive and increasing, or ``parameter`` is unknown.
    """
    parameter = _parameter(field, parameter)
    wanted = choose_lags(field, parameter) if lags is None else _checked_lags(lags)
    units = lag_unit(field, parameter) if unit is None else np.asarray(unit, dtype=float)
    units = np.array(np.broadcast_to(units, field.shape), dtype=float)
    chosen = list(range(len(field.times))) if steps is None else [int(s) for s in steps]
    samplers = _samplers(field, chosen, parameter)
    sides = (-1.0, 1.0) if field.steady and two_sided else (-1.0,)
    composed = field.steady and (lags is None if compose is None else compose)
    known = min(DIRECT, len(wanted)) if composed else len(wanted)
    found = _follow(field, samplers, wanted, known, units, sides, tolerance, progress)
    nodes, rate = _rates(field, samplers, units)
    if known < len(wanted):
        for side, (displacement, reach) in found.items():
            compose_slices(field, wanted, units, side * rate[0], displacement[0], reach[0], known)
    both = len(sides) > 1
    return TraceSlices(
        lags=wanted,
        unit=units,
        displacement=found[-1.0][0],
        forward=found[1.0][0] if both else None,
        rate=rate,
        reach=found[-1.0][1],
        forward_reach=found[1.0][1] if both else None,
        nodes=nodes,
        times=field.times[chosen],
        parameter=parameter,
    )


def paths(
    field: FlowField,
    start: ArrayLike,
    lags: ArrayLike,
    *,
    step: int = 0,
    parameter: str = "arclength",
    forward: bool = False,
    tolerance: float = TOLERANCE,
) -> Paths:
    """Follow particles from chosen positions in index space.

    Parameters
    ----------
    field
        The flow.
    start
        Starting positions, (N, 2) as (i, j).
    lags
        Lags to keep, (M,), in units of length or time.
    step
        Which destination time.
    parameter, forward, tolerance
        As for :func:`trace`.
    """
    parameter = _parameter(field, parameter)
    begin = np.array(start, dtype=float).reshape(-1, 2)
    sampler = _samplers(field, [step], parameter)[0]
    return integrate(
        sampler,
        begin,
        _checked_lags(lags),
        np.ones(len(begin)),
        direction=1.0 if forward else -1.0,
        tolerance=tolerance,
    )


def _follow(
    field: FlowField,
    samplers: list[Sampler],
    lags: Floats,
    known: int,
    units: Floats,
    sides: tuple[float, ...],
    tolerance: float,
    progress: bool,
) -> dict[float, tuple[NDArray[np.float32], NDArray[np.float32]]]:
    """Displacement (T, M, J, I, 2) and reach (T, J, I) for each direction."""
    rows, columns = field.shape
    at = np.flatnonzero(field.valid)
    start = np.stack([at % columns, at // columns], axis=-1).astype(float)
    unit = units.ravel()[at]
    shape = (len(samplers), len(lags), rows * columns)
    found = {
        side: (np.zeros((*shape, 2), np.float32), np.zeros(shape[::2], np.float32))
        for side in sides
    }

    def work(job: _Job) -> None:
        block = at[job.block]
        result = integrate(
            samplers[job.step],
            start[job.block],
            lags[:known],
            unit[job.block],
            direction=job.direction,
            tolerance=tolerance,
        )
        displacement, reach = found[job.direction]
        displacement[job.step, :known, block] = np.swapaxes(result.positions - start[job.block], 0, 1)
        reach[job.step, block] = result.reach

    jobs = [
        _Job(step, slice(first, first + BLOCK), side)
        for step in range(len(samplers))
        for side in sides
        for first in range(0, len(at), BLOCK)
    ]
    _run(work, jobs, progress)
    grid = (rows, columns)
    return {
        side: (d.reshape(*shape[:2], *grid, 2), r.reshape(shape[0], *grid))
        for side, (d, r) in found.items()
    }


def _rates(
    field: FlowField, samplers: list[Sampler], units: Floats
) -> tuple[Floats, Floats]:
    """Nodes (J, I, 2) in index space, and the rates (T, J, I, 2) at which paths leave them."""
    rows, columns = field.shape
    nodes = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).astype(float)
    flat, still = nodes.reshape(-1, 2), np.zeros(rows * columns)
    rate = np.stack([sampler.rate(flat, still, 1.0) for sampler in samplers])
    rate = rate.reshape(-1, rows, columns, 2) * units[..., None]
    rate[:, ~field.valid] = 0.0
    return nodes, rate


def _run(work: Callable[[_Job], None], jobs: list[_Job], progress: bool) -> None:
    """Do the jobs in threads, with a progress bar."""
    with ThreadPoolExecutor(max_workers=min(os.cpu_count() or 1, 8)) as pool:
        for _ in track(pool.map(work, jobs), len(jobs), "Tracing", show=progress):
            pass


def _samplers(field: FlowField, steps: list[int], parameter: str) -> list[Sampler]:
    if parameter == "arclength":
        return [LengthSampler(field)]
    return [TimeSampler(field, float(field.times[step])) for step in steps]


def _parameter(field: FlowField, parameter: str) -> str:
    if parameter not in ("arclength", "time"):
        msg = f'parameter is {parameter!r}; expected "arclength" or "time"'
        raise ValueError(msg)
    return parameter if field.steady else "time"


def _checked_lags(lags: ArrayLike) -> Floats:
    wanted = np.atleast_1d(np.asarray(lags, dtype=float))
    good = wanted.ndim == 1 and len(wanted) and wanted[0] > 0 and (np.diff(wanted) > 0).all()
    if not good or not np.isfinite(wanted).all():
        msg = f"lags is {lags!r}; expected positive numbers in increasing order"
        raise ValueError(msg)
    return wanted
