"""Lines and closed orbits of a formula, integrated from the formula itself; nullclines."""

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
#: A component is zero up to this share of its quantile at the other: beside a pole it is huge.
ROUNDING, USUAL_SHARE = 1e-12, 0.9
#: Halvings of a side of a triangle that a line crosses, and the greatest remaining share of a value
#: that goes to zero there; at a pole and at a jump more remains.
HALVINGS, LEFT = 12, 0.25
#: Cells along the longer side of what is searched in a formula, and along the other one at least.
CELLS, LEAST_CELLS = 256, 8
#: Size of a window over that of the view, at least, and steps of its middle over its size.
WINDOW_VIEWS, WINDOW_STEPS = 2.0, 4


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


def nullclines(field: FlowField, window: Floats | None = None) -> tuple[Floats, Floats]:
    """Return the zeros of the components of a steady flow; a curved surface has no such lines.

    The components are those along the axes of a flat surface, x and y in the plane of these. They
    are linear in the drawn triangles; those of a formula in the plane are its own zeros, and not
    its poles, and finer in a ``window``, (2, 2) as the ends of x and y. Returns the straight pieces
    of both lines, (S, 2, 3) each, in no order.
    """
    surface, rates = field.surface, plane_rates(field)
    if surface.frame is None:
        return np.empty((0, 2, 3)), np.empty((0, 2, 3))
    if rates is not None:
        coarse = _of_formula(rates, rates.ends)
        if window is None:
            return coarse
        middle, half = window.mean(axis=1), np.ptp(window, axis=1) / 2
        one, two = (
            np.concatenate([p[(abs(p.mean(axis=1)[:, :2] - middle) > half).any(axis=1)], q])
            for p, q in zip(coarse, _of_formula(rates, window), strict=True)
        )
        return one, two
    corners = surface.corners_of(surface.drawn)
    points = surface.points.reshape(-1, 3)[corners]
    values = (field.velocity[0].reshape(-1, 3) @ surface.frame.T)[corners]
    return _zero_pieces(points, values[..., 0])[0], _zero_pieces(points, values[..., 1])[0]


def view_window(field: FlowField, focus: Floats, visible: float) -> Floats | None:
    """Return the part of a formula's plane around a view, (2, 2), or ``None`` for all of it.

    ``focus`` is the middle of the view, and ``visible`` its larger side. Windows of views beside
    each other are often the same.
    """
    formula = field.formula
    if formula is None or formula.surface or not visible > 0:
        return None
    ends = np.array(list(formula.ranges.values()))
    side = np.ptp(ends, axis=1).max()
    level = np.floor(np.log2(side / (WINDOW_VIEWS * visible)))
    if level < 1:
        return None
    size = side / 2**level
    step = size / WINDOW_STEPS
    middle = ends[:, 0] + step * np.rint((focus[:2] - ends[:, 0]) / step)
    window = np.clip(np.stack([middle - size / 2, middle + size / 2], axis=1), *ends.T[..., None])
    return window if (np.ptp(window, axis=1) > 0).all() else None


def _of_formula(rates: Rates, window: Floats) -> tuple[Floats, Floats]:
    sides = np.ptp(window, axis=1)
    counts = np.maximum(np.round(CELLS * sides / sides.max()), LEAST_CELLS).astype(int)
    x, y = (np.linspace(window[k, 0], window[k, 1], counts[k] + 1) for k in range(2))
    nodes = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1)
    number = np.arange(len(x) * len(y)).reshape(len(y), len(x))
    a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, :-1], number[1:, 1:]
    corners = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, d), (a, d, c))])
    points = nodes.reshape(-1, 3)
    values = rates.at(points[:, :2])
    lines = []
    for k in range(2):
        known = np.isfinite(values[corners, k]).all(axis=1)
        sides = _zero_pieces(points[corners[known]], values[corners[known], k])[1]
        rate = partial(_rate, rates, k)
        ends, vanishes = zip(*(_crossing(rate, sides[:, m]) for m in range(2)), strict=True)
        lines.append(np.stack(ends, axis=1)[vanishes[0] & vanishes[1]])
    return lines[0], lines[1]


def _rate(rates: Rates, component: int, points: Floats) -> Floats:
    return rates.at(points[:, :2])[:, component]


def _crossing(rate: Callable[[Floats], Floats], sides: Floats) -> tuple[Floats, Bools]:
    """Return where a rate changes sign along sides (S, 2, 3), or ends at 0, and without a jump."""
    ends = [sides[:, 0], sides[:, 1]]
    values = [rate(end) for end in ends]
    first = np.maximum(*np.abs(values))
    for _ in range(HALVINGS):
        middle = 0.5 * (ends[0] + ends[1])
        value = rate(middle)
        like_first = (value > 0) == (values[0] > 0)
        for n, moves in enumerate((like_first, ~like_first)):
            ends[n] = np.where(moves[:, None], middle, ends[n])
            values[n] = np.where(moves, value, values[n])
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.nan_to_num(values[0] / (values[0] - values[1]), nan=0.5)[:, None]
        vanishes = np.maximum(*np.abs(values)) < LEFT * first
    return ends[0] + share * (ends[1] - ends[0]), np.asarray(vanishes)


def _zero_pieces(points: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return pieces (S, 2, 3) where values (M, 3) are zero, and their sides (S, 2, 2, 3)."""
    least = ROUNDING * np.quantile(np.abs(values), USUAL_SHARE) if len(values) else 0.0
    differs = np.abs(values) > least
    # A side along which the component is zero is a piece, perhaps a wall with one triangle.
    is_side = differs.sum(axis=1) == 1
    above = np.where(is_side[:, None], differs, values > least)
    count = above.sum(axis=1)
    crossed = np.flatnonzero((count == 1) | (count == 2))
    points, values = points[crossed], values[crossed]
    # The corner that differs from the other two, and both sides of the triangle that meet there.
    alone = np.argmax(above[crossed] == (count[crossed] == 1)[:, None], axis=1)
    row = np.arange(len(crossed))
    ends, sides = [], []
    for k in (1, 2):
        other = (alone + k) % 3
        share = values[row, alone] / (values[row, alone] - values[row, other])
        start, end = points[row, alone], points[row, other]
        ends.append(start + share[:, None] * (end - start))
        sides.append(np.stack([start, end], axis=1))
    return np.stack(ends, axis=1), np.stack(sides, axis=1)
