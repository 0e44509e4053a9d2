"""Lines and closed orbits of a formula in the plane, integrated from the formula itself."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats
from flowtex.field import FlowField
from flowtex.field.formula.rates import Rates
from flowtex.trace.integrate import Paths
from flowtex.trace.structure.critical_points import formula_rates
from flowtex.trace.structure.formula_points import runge_kutta
from flowtex.trace.trace import paths

#: Longest step along a line, as a share of the diagonal.
STEP = 1 / 700
#: Share of the period after which an orbit is at its section again at the earliest; turns until it
#: closes; its greatest remaining displacement, as a share of the diagonal; points of it.
ALMOST, TURNS, CLOSED, POINTS = 0.8, 12, 1e-7, 4000
#: Tolerance of the integration, and least growth in a turn beside an orbit, as an exponent.
TOLERANCE, LEAST_GROWTH = 1e-10, 1e-6


def plane_rates(field: FlowField) -> Rates | None:
    """Return the rates of a formula in the plane, if that is how a steady field was made."""
    is_plane = field.formula is not None and not field.formula.surface
    return formula_rates(field) if is_plane else None


def follower(field: FlowField, rates: Rates | None) -> Callable[..., Paths]:
    """Return what follows the lines of a steady field, of its formula if it has rates."""
    if rates is None:
        return partial(paths, field, parameter="arclength")
    return partial(formula_paths, rates, field.shape)


def formula_paths(
    rates: Rates,
    shape: tuple[int, ...],
    begin: Floats,
    lags: Floats,
    *,
    forward: bool,
    within: Callable[[Floats], Bools] | None = None,
) -> Paths:
    """Follow lines from (N, 2), as (i, j) of nodes, to lengths (M,), as :func:`paths` does."""
    low, sides = rates.ends[:, 0], np.ptp(rates.ends, axis=1)
    cell = sides / np.subtract(shape[::-1], 1)

    def rate(at: Floats) -> Floats:
        value = rates.at(at)
        with np.errstate(invalid="ignore", divide="ignore"):
            sign = 1.0 if forward else -1.0
            return np.asarray(sign * value / np.linalg.norm(value, axis=1, keepdims=True))

    at, before = low + begin * cell, 0.0
    positions, reach = np.empty((len(lags), *begin.shape)), np.full(len(begin), np.inf)
    for n, lag in enumerate(lags):
        if np.isfinite(reach).all():
            positions[n:] = positions[n - 1]
            break
        count = int(np.ceil((lag - before) / (STEP * np.hypot(*sides))))
        for k in range(count):
            going = np.flatnonzero(np.isinf(reach))
            ahead = runge_kutta(rate, at[going], (lag - before) / count)
            with np.errstate(invalid="ignore"):
                is_inside = (np.abs(ahead - low - sides / 2) <= sides / 2).all(axis=1)
            at[going[is_inside]] = ahead[is_inside]
            reach[going[~is_inside]] = before + (lag - before) * k / count
        positions[n] = (at - low) / cell
        if within is not None:
            reach[np.isinf(reach) & ~within(positions[n].T)] = lag
        before = lag
    is_gone = np.isfinite(reach)
    return Paths(positions, reach, np.zeros(len(reach), dtype=bool), is_gone)


def formula_orbit(
    rates: Rates, start: Floats, period: float, *, forward: bool
) -> tuple[Floats, float, bool] | None:
    """Return the closed orbit near a place (2,): points (N, 2), period, and whether it is stable.

    ``period`` is about the right one, and ``forward`` the direction in which lines come nearer. The
    place moves along a section across the flow, by Newton's method with the factor by which
    distances beside an orbit grow in a turn: the exponential of the divergence, integrated over its
    time. Where that factor is 1, all lines close, and none is an orbit.
    """
    diagonal, way = np.hypot(*np.ptp(rates.ends, axis=1)), 1.0 if forward else -1.0
    normal = rates.at(start[None])[0] * way
    normal /= np.linalg.norm(normal)
    section = np.array([-normal[1], normal[0]])

    def rate(_: float, at: Floats) -> Floats:
        return np.asarray(way * rates.at(at[None])[0])

    def crosses(_: float, at: Floats) -> float:
        return float((at - start) @ normal)

    crosses.terminal, crosses.direction = True, 1.0  # type: ignore[attr-defined]
    options: Any = {"method": "LSODA", "rtol": TOLERANCE, "dense_output": True}
    options["atol"] = TOLERANCE * diagonal
    solve, at = scipy.integrate.solve_ivp, start
    for _ in range(TURNS):
        most: Any = solve(rate, (0, ALMOST * period), at, **options)
        begin = most.y[:, -1]
        rest: Any = solve(rate, (most.t[-1], 3 * period), begin, events=crosses, **options)
        if not len(rest.t_events[0]):
            return None
        period = float(rest.t_events[0][0])
        times = np.linspace(0, period, POINTS)
        is_first = times <= most.t[-1]
        points = np.concatenate([most.sol(times[is_first]).T, rest.sol(times[~is_first]).T])
        divergence = way * np.trace(rates.gradient(points), axis1=1, axis2=2)
        growth = float(scipy.integrate.simpson(divergence, x=times))
        if not abs(growth) > LEAST_GROWTH:
            return None
        moved = float((points[-1] - at) @ section)
        if abs(moved) < CLOSED * diagonal:
            lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
            along = np.concatenate([[0], np.cumsum(lengths)])
            even = np.linspace(0, along[-1], POINTS // 4)
            points = np.stack([np.interp(even, along, x) for x in points.T], axis=-1)
            points[-1] = points[0]
            return points[:: 1 if forward else -1], period, (growth < 0) == forward
        at = at + section * moved / (1 - np.exp(min(growth, 1.0)))
    return None
