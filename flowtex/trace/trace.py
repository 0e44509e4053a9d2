"""FlowField to TraceSlices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.field import FlowField
from flowtex.trace.compose import landings
from flowtex.trace.integrate import Paths, integrate
from flowtex.trace.lags import choose_lags, lag_unit
from flowtex.trace.sampler import LengthSampler, Sampler, TimeSampler
from flowtex.trace.slices import TraceSlices
from flowtex.trace.work import Work

__all__ = ["paths", "trace"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

#: Error allowed in one step, in cells.
TOLERANCE = 1e-3


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
        Whether a steady field is followed forward too. One without a sign always is.
    tolerance
        Error allowed in one step of the integration, in cells.
    steps
        Destination times to trace, as indices into ``field.times``; all by default.
    compose
        Whether long lags are put together from short ones (see :mod:`flowtex.trace.compose`)
        instead of being integrated. By default they are when the lags are chosen automatically.
        In a field that varies this takes equal time steps, of which all are traced; otherwise
        all lags are integrated, as they are in a field without a sign.
    progress
        Whether to show a progress bar when the work takes longer than a second.

    Returns
    -------
    TraceSlices

    Raises
    ------
    ValueError
        When the lags are not positive and increasing, ``parameter`` is unknown, or the unit or
        the tolerance is not positive; or a field without a sign is to be followed to one side,
        or composed.
    IndexError
        When there is no such time step.
    """
    parameter = _parameter(field, parameter)
    _check_signs(field, two_sided=two_sided, compose=compose)
    wanted = choose_lags(field, parameter) if lags is None else _checked_lags(lags)
    units = lag_unit(field, parameter) if unit is None else np.asarray(unit, dtype=float)
    units = np.array(np.broadcast_to(units, field.shape), dtype=float)
    if not (np.isfinite(units).all() and (units > 0).all()):
        msg = f"unit has values from {units.min():g} to {units.max():g}; expected positive numbers"
        raise ValueError(msg)
    if not tolerance > 0:
        msg = f"tolerance is {tolerance!r}; expected a positive number of cells, such as 1e-3"
        raise ValueError(msg)
    chosen = _chosen(field, steps)
    sides = (-1.0, 1.0) if field.steady and two_sided else (-1.0,)
    work = Work(field, _samplers(field, chosen, parameter), wanted, units, tolerance, progress)
    composed = lags is None and not field.sign_free if compose is None else compose
    landing = _landing(field, wanted, units, chosen) if composed else None
    found = work.follow(sides, landing)
    both = len(sides) > 1
    return TraceSlices(
        lags=wanted,
        unit=units,
        displacement=found[-1.0].displacement,
        forward=found[1.0].displacement if both else None,
        rate=work.rate,
        reach=found[-1.0].reach,
        forward_reach=found[1.0].reach if both else None,
        nodes=work.nodes,
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

    Returns
    -------
    Paths
        Positions (M, N, 2) in index space, and the lag at which each path ended, (N,), infinite
        where it goes on beyond the last lag.

    Raises
    ------
    ValueError
        When the lags are not positive and increasing, or ``parameter`` is unknown.
    IndexError
        When there is no such time step.
    """
    parameter = _parameter(field, parameter)
    begin = np.array(start, dtype=float).reshape(-1, 2)
    sampler = _samplers(field, _chosen(field, [step]), parameter)[0]
    return integrate(
        sampler,
        begin,
        _checked_lags(lags),
        np.ones(len(begin)),
        direction=1.0 if forward else -1.0,
        tolerance=tolerance,
    )


def _check_signs(field: FlowField, *, two_sided: bool, compose: bool | None) -> None:
    """Refuse what has no meaning in a field without a sign."""
    if field.sign_free and not two_sided:
        msg = "two_sided is False; expected True: a field without a sign has two sides alike"
        raise ValueError(msg)
    if field.sign_free and compose:
        msg = (
            "compose is True; expected False or None: between nodes that point either way paths "
            "of a field without a sign cannot be looked up"
        )
        raise ValueError(msg)


def _chosen(field: FlowField, steps: Sequence[int] | None) -> list[int]:
    """Destination times as indices from 0."""
    count = len(field.times)
    for step in () if steps is None else steps:
        if not -count <= step < count:
            msg = f"time step {step} does not exist: expected 0 to {count - 1}"
            raise IndexError(msg)
    return list(range(count)) if steps is None else [int(step) % count for step in steps]


def _landing(field: FlowField, lags: Floats, unit: Floats, steps: list[int]) -> Indices | None:
    """Time steps that the lags span, where paths can be composed, else ``None``."""
    whole = field.steady or steps == list(range(len(field.times)))
    return landings(field, lags, unit) if whole else None


def _samplers(field: FlowField, steps: list[int], parameter: str) -> list[Sampler]:
    if parameter == "arclength":
        return [LengthSampler(field)]
    sampler = TimeSampler(field)
    return [sampler.since(float(field.times[step])) for step in steps]


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
