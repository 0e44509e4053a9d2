"""Fixed points, lines and closed orbits of a formula, from the formula itself; nullclines.

Fixed points are zeros, by Newton's method with the gradient. Their lengths are in search cells, of
which there are CELLS along the longer side, and each rate is a share of its largest value near the
cell from which the search starts. The browser does the same in ``client/src/fixedpoints.ts``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.lib.stride_tricks import sliding_window_view

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field import FlowField
from flowtex.field.formula.rates import Rates
from flowtex.trace.integrate import Paths
from flowtex.trace.trace import paths

CELLS = 160  #: Search cells along the longer side.
LEAST_CELLS = 8  #: Least number of search cells along the other side.
STEPS = 100  #: Most steps of Newton's method.
FAR = 3.0  #: Greatest distance from the start of Newton's method, in cells.
LAST_STEP = 1e-6  #: Greatest last step to a zero, in cells.
LEFT = 1e-11  #: Greatest remaining rate at a zero.
BEYOND = 1e-6  #: Greatest distance of a zero beyond the border.
SAME = 1e-6  #: Least distance between two zeros, in cells.
SAME_DEGENERATE = 0.05  #: Least distance between two degenerate zeros, which are less precise.
CHANGE = 1e-2  #: Step of the finite differences of the determinant, in cells.
DEGENERATE = 1e-5  #: Greatest distance from a zero of the determinant at a degenerate point.
SINGULAR = 1e-13  #: Determinant that counts as zero, relative to the gradient.
ROUNDING = 1e-9  #: Trace that counts as zero, relative to the gradient.
AROUND = 0.1  #: Distance from a degenerate point at which the search for others begins.
ON_LINE = 0.02  #: Greatest distance from there to another one on the same line of rest.
POLE_AREA = 1e-6  #: Area of a cell of a surface at its poles, as a share of that in the middle.
RADIUS = 0.05  #: Radius of the circle around a point for its index.
CIRCLE = 720  #: Points on this circle.
MOST_DIRECTIONS = 24  #: Most directions at a degenerate point.
TURN_RADIUS = 2.0  #: Radius of the turn around a possible centre.
TURN_STEPS = 400  #: Steps of this turn.
RETURNED = 1e-7  #: Least growth of the radius that is no error.
_SIDES = np.array([(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)], float)
STEP = 1 / 700  #: Longest step along a line, as a share of the diagonal.
ALMOST = 0.8  #: Least share of the estimated period after which an orbit may return.
TURNS = 12  #: Most turns until an orbit closes.
CLOSED = 1e-7  #: Greatest gap of a closed orbit, as a share of the diagonal.
POINTS = 4000  #: Points of an orbit in the integration.
TOLERANCE = 1e-10  #: Tolerance of this integration.
LEAST_GROWTH = 1e-6  #: Least exponent of growth in a turn beside an orbit.
ZERO_SHARE = 1e-12  #: A component counts as zero up to this share of its usual value.
USUAL_SHARE = 0.9  #: Quantile of the usual value, because values beside a pole are huge.
HALVINGS = 12  #: Bisections on the side of a triangle for the crossing of a line.
#: Greatest share of a value that remains at a zero; at a pole or a jump more remains.
LEFT_SHARE = 0.25
LINE_CELLS = 256  #: Cells along the longer side in the search for nullclines of a formula.
WINDOW_VIEWS = 2.0  #: Least ratio of the size of a window to the view.
WINDOW_STEPS = 4  #: Steps of the middle of a window per size.


def formula_rates(field: FlowField) -> Rates | None:
    """Return the rates of the formula from which a steady field was made, if they are known."""
    formula = field.formula
    valid = field.valid
    if formula is None or field.triangles is not None:
        return None
    u, v = formula.coordinates(field.shape)
    points = formula.points(u, v)
    velocity = formula.velocity(u, v, float(field.times[0]))
    for own, other in ((field.points, points), (field.velocity[0], velocity)):
        flat = np.zeros((*field.shape, 3 - other.shape[-1]))
        if not np.allclose(own[valid], np.concatenate([other, flat], axis=-1)[valid]):
            return None
    rates = Rates(formula, float(field.times[0]))
    if rates.is_known:
        return rates
    return None


class Zeros(NamedTuple):
    """Isolated zeros of rates: places (K, 2), gradients (K, 2, 2), and Poincare indices (K,).

    ``growth`` (K,) is the growth of the radius in a turn around points with imaginary eigenvalues.
    ``lines`` says whether there are lines of rest.
    """

    places: Floats
    gradient: Floats
    indices: Indices
    is_degenerate: Bools
    growth: Floats
    lines: bool


def zeros(rates: Rates) -> Zeros:
    """Return the isolated zeros of rates in their ranges."""
    start, scale, cell = _starts(rates)
    found, left = _newton(rates, start, scale, cell)
    with np.errstate(invalid="ignore"):
        inside = (np.abs(found - np.clip(found, *rates.ends.T)) <= BEYOND * cell).all(axis=1)
    area = rates.area(np.concatenate([rates.ends.mean(axis=1)[None], found]))
    inside &= area[1:] > POLE_AREA * area[0]
    places = np.clip(found[inside], *rates.ends.T)
    scale = scale[inside]
    degenerate = _are_degenerate(rates, places, scale, cell)
    kept = _distinct(places / cell, degenerate, left[inside])
    places = places[kept]
    scale = scale[kept]
    degenerate = degenerate[kept]
    on_line = degenerate.copy()
    on_line[degenerate] = _on_lines(rates, places[degenerate], scale[degenerate], cell)
    places = places[~on_line]
    degenerate = degenerate[~on_line]
    places[np.abs(places) < LEFT * cell] = 0.0
    gradient = rates.lowered(rates.gradient(places), places)
    indices = np.sign(np.linalg.det(gradient)).astype(np.intp)
    gaps = np.linalg.norm((places[:, None] - places) / cell, axis=-1)
    np.fill_diagonal(gaps, np.inf)
    free = gaps.min(axis=1, initial=np.inf)
    for n in np.flatnonzero(degenerate):
        circle = places[n] + min(RADIUS, 0.3 * free[n]) * cell * _circle()[0]
        values = rates.at(circle)
        angle = np.unwrap(np.arctan2(values[:, 1], values[:, 0]))
        turns = (angle[-1] - angle[0]) / (2 * np.pi)
        indices[n] = 0
        if np.isfinite(turns):
            indices[n] = round(turns)
    growth = np.zeros(len(places))
    trace = np.trace(gradient, axis1=1, axis2=2)
    size = np.abs(gradient).max(axis=(1, 2), initial=0)
    turning = (indices == 1) & ~degenerate & (np.abs(trace) <= ROUNDING * size)
    radius = np.minimum(TURN_RADIUS, 0.2 * free[turning])
    growth[turning] = _growth(rates, places[turning], gradient[turning], radius, cell)
    return Zeros(places, gradient, indices, degenerate, growth, bool(on_line.any()))


def _starts(rates: Rates) -> tuple[Floats, Floats, Floats]:
    """Return the middles of cells that may have a zero, (S, 2), and the largest rates near them.

    Each rate must change by as much around the cell as it is in it. Also returns the size of a
    cell, (2,).
    """
    sides = np.ptp(rates.ends, axis=1)
    counts = np.maximum(np.round(CELLS * sides / sides.max()), LEAST_CELLS).astype(int)
    lines = []
    for low, side, n in zip(rates.ends[:, 0], sides, counts, strict=True):
        lines.append(low + side / n * np.arange(n + 1))
    nodes = np.stack(np.meshgrid(*lines), axis=-1)
    values = rates.at(nodes.reshape(-1, 2)).reshape(nodes.shape)
    values[~np.isfinite(values)] = np.nan
    around = sliding_window_view(np.pad(values, ((1, 1), (1, 1), (0, 0)), "edge"), (4, 4), (0, 1))
    top = np.fmax.reduce(around, axis=(-2, -1))
    bottom = np.fmin.reduce(around, axis=(-2, -1))
    least = np.fmin.reduce(np.abs(around[..., 1:3, 1:3]), axis=(-2, -1))
    scale = np.maximum(np.abs(top), np.abs(bottom))
    chosen = (least <= top - bottom).all(axis=-1)
    row, column = np.nonzero(chosen & (scale > 0).any(axis=-1))
    cell = sides / counts
    middle = rates.ends[:, 0] + cell * (np.stack([column, row], axis=-1) + 0.5)
    return middle, np.where(scale > 0, scale, 1.0)[row, column], cell


def _step(rates: Rates, at: Floats, scale: Floats, cell: Floats) -> tuple[Floats, Floats, Floats]:
    """Return the largest rate (N,), Newton's step (N, 2), and the determinant's share (N,)."""
    value = rates.at(at) / scale
    (a, b), (c, d) = np.moveaxis(rates.gradient(at) * cell / scale[..., None], 0, -1)
    size = a * a + b * b + c * c + d * d
    determinant = a * d - b * c
    with np.errstate(all="ignore"):
        u, v = value.T
        step = np.stack([b * v - d * u, c * u - a * v], axis=-1) / determinant[:, None]
        share = np.abs(determinant) / size
        # Along a line of zeros the shortest step.
        shortest = -np.stack([a * u + c * v, b * u + d * v], axis=-1) / size[:, None]
    step = np.where((share > 0.1 * SINGULAR)[:, None], step, shortest)
    return np.abs(value).max(axis=1, initial=0), step, share


def _newton(rates: Rates, start: Floats, scale: Floats, cell: Floats) -> tuple[Floats, Floats]:
    """Return the nearest zero of each place (N, 2), NaN if none is near, and the rates left."""
    best = np.full(start.shape, np.nan)
    least = np.full(len(start), np.inf)
    at = start.copy()
    going = np.arange(len(start))
    for _ in range(STEPS):
        left, step, _ = _step(rates, at[going], scale[going], cell)
        better = left < least[going]
        best[going[better]], least[going[better]] = at[going[better]], left[better]
        length = np.abs(step).max(axis=1, initial=0)
        at[going] += cell * step / np.maximum(length, 1.0)[:, None]
        with np.errstate(invalid="ignore"):
            is_near = (np.abs(at[going] - start[going]) <= FAR * cell).all(axis=1)
            going = going[is_near & (length > SINGULAR)]
        if not len(going):
            break
    left, step, share = _step(rates, best, scale, cell)
    with np.errstate(invalid="ignore"):
        is_regular = (np.abs(step).max(axis=1, initial=0) < LAST_STEP) & (share > SINGULAR)
        best[~((left <= LEFT) | is_regular)] = np.nan
    return best, left


def _are_degenerate(rates: Rates, places: Floats, scale: Floats, cell: Floats) -> Bools:
    """Return whether the determinant is zero at places, or so near that rounding hides it."""
    near = places[:, None] + CHANGE * cell * np.concatenate([np.zeros((1, 2)), _SIDES])
    scale = np.repeat(scale, len(_SIDES) + 1, axis=0)
    gradient = rates.gradient(near.reshape(-1, 2)) * cell / scale[..., None]
    determinant = np.linalg.det(gradient).reshape(-1, len(_SIDES) + 1)
    size = (gradient**2).sum(axis=(1, 2)).reshape(-1, len(_SIDES) + 1)[:, 0]
    change = np.abs(determinant - determinant[:, :1])
    here = np.abs(determinant[:, 0])
    change = np.where(np.isfinite(change), change, 0).max(axis=1, initial=0)
    return np.asarray(~((here > SINGULAR * size) & (here * CHANGE >= DEGENERATE * change)))


def _distinct(places: Floats, degenerate: Bools, left: Floats) -> Indices:
    """Return the numbers of different places, (K, 2) in cells."""
    order = np.lexsort([left, ~degenerate])
    kept = np.ones(len(places), dtype=bool)
    if len(places):
        pairs = scipy.spatial.KDTree(places[order]).query_pairs(SAME_DEGENERATE)
        for first, second in sorted(pairs):
            one = order[first]
            other = order[second]
            if degenerate[one]:
                apart = SAME_DEGENERATE
            else:
                apart = SAME
            if kept[one] and kept[other]:
                kept[other] = np.abs(places[one] - places[other]).max() >= apart
    return np.flatnonzero(kept)


def _on_lines(rates: Rates, places: Floats, scale: Floats, cell: Floats) -> Bools:
    """Return which degenerate zeros have others beside them, and so belong to a line of zeros."""
    around = places[:, None] + AROUND * cell * _SIDES
    scales = np.repeat(scale, len(_SIDES), axis=0)
    others = _newton(rates, around.reshape(-1, 2), scales, cell)[0].reshape(around.shape)
    with np.errstate(invalid="ignore"):
        return np.asarray((np.abs((others - places[:, None]) / cell) > ON_LINE).any(axis=(1, 2)))


def _circle() -> tuple[Floats, Floats]:
    """Return unit vectors around a circle, the last one again the first, and their angles."""
    # No usual direction is exactly one of these.
    angle = 0.3 + np.linspace(0, 2 * np.pi, CIRCLE + 1)
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1), angle


def directions(rates: Rates, place: Floats) -> tuple[Floats, Bools]:
    """Return the directions of the separatrices of a degenerate zero, (D, 2), and which leave it.

    These are the directions in which lines enter or leave it, at borders of its sectors: between
    two lines that both leave it, or both come, others do the same.
    """
    sides = np.ptp(rates.ends, axis=1)
    radius = RADIUS * sides.max() / CELLS
    _, angle = _circle()

    def radial(angle: Floats) -> tuple[Floats, Floats]:
        way = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
        u, v = rates.lowered(rates.at(place + radius * way), place + radius * way).T
        return way[:, 0] * v - way[:, 1] * u, way[:, 0] * u + way[:, 1] * v

    across = radial(angle)[0]
    first = np.flatnonzero(across[:-1] * across[1:] < 0)
    if not 0 < len(first) <= MOST_DIRECTIONS:
        return np.empty((0, 2)), np.empty(0, dtype=bool)
    low = angle[first]
    high = angle[first + 1]
    for _ in range(50):
        middle = 0.5 * (low + high)
        is_low = radial(middle)[0] * across[first] > 0
        low = np.where(is_low, middle, low)
        high = np.where(is_low, high, middle)
    leaves = radial(low)[1] > 0
    kept = (leaves != np.roll(leaves, 1)) | (leaves != np.roll(leaves, -1))
    return np.stack([np.cos(low), np.sin(low)], axis=-1)[kept], leaves[kept]


def _growth(rates: Rates, places: Floats, gradient: Floats, radius: Floats, cell: Floats) -> Floats:
    """Return the growth of the radius (N,) in a turn around places with imaginary eigenvalues."""
    (a, b), (c, _) = np.moveaxis(gradient, 0, -1)
    turn = np.sqrt(np.maximum(-a * a - b * c, 0))
    # In w = (x, (a x + b y) / turn) the linear flow turns on circles.
    radius = radius / np.maximum(1 / cell[0], (turn + np.abs(a)) / np.abs(b) / cell[1])

    def rate(w: Floats) -> Floats:
        at = places + np.stack([w[:, 0], (turn * w[:, 1] - a * w[:, 0]) / b], axis=-1)
        u, v = rates.lowered(rates.at(at), at).T
        return np.stack([u, (a * u + b * v) / turn], axis=-1)

    w = np.stack([radius, 0 * radius], axis=-1)
    step = 2 * np.pi / TURN_STEPS / turn
    with np.errstate(all="ignore"):
        for n in range(TURN_STEPS + 4):
            if n >= TURN_STEPS:  # to the ray from which it began
                step = w[:, 1] / (turn * w[:, 0])
            w = runge_kutta(rate, w, step[:, None])
        growth = w[:, 0] / radius - 1
    return np.where(np.abs(growth) > RETURNED, growth, 0.0)


def runge_kutta(rate: Callable[[Floats], Floats], at: Floats, step: Any) -> Floats:
    """Return places after a step of fourth order."""
    one = rate(at)
    two = rate(at + step / 2 * one)
    three = rate(at + step / 2 * two)
    return np.asarray(at + step / 6 * (one + 2 * two + 2 * three + rate(at + step * three)))


def plane_rates(field: FlowField) -> Rates | None:
    """Return the rates of a formula in the plane, if that is how a steady field was made."""
    is_plane = field.formula is not None and not field.formula.surface
    if is_plane:
        return formula_rates(field)
    return None


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
    low = rates.ends[:, 0]
    sides = np.ptp(rates.ends, axis=1)
    middle = low + sides / 2
    cell = sides / np.subtract(shape[::-1], 1)
    sign = 1.0
    if not forward:
        sign = -1.0

    def rate(at: Floats) -> Floats:
        value = rates.at(at)
        speed = np.hypot(value[:, 0], value[:, 1])
        return np.asarray(value / (sign * speed)[:, None])

    at = low + begin * cell
    before = 0.0
    positions = np.empty((len(lags), *begin.shape))
    reach = np.full(len(begin), np.inf)
    for n, lag in enumerate(lags):
        if np.isfinite(reach).all():
            positions[n:] = positions[n - 1]
            break
        count = int(np.ceil((lag - before) / (STEP * np.hypot(*sides))))
        for k in range(count):
            going = np.flatnonzero(np.isinf(reach))
            with np.errstate(invalid="ignore", divide="ignore"):
                ahead = runge_kutta(rate, at[going], (lag - before) / count)
                is_inside = (np.abs(ahead - middle) <= sides / 2).all(axis=1)
            at[going[is_inside]] = ahead[is_inside]
            reach[going[~is_inside]] = before + (lag - before) * k / count
        positions[n] = (at - low) / cell
        if within is not None:
            reach[np.isinf(reach) & ~within(positions[n].T)] = lag
        before = lag
    is_gone = np.isfinite(reach)
    nothing = np.zeros(len(reach), dtype=bool)
    return Paths(positions, reach, nothing, is_gone, nothing)


def formula_orbit(
    rates: Rates, start: Floats, period: float, *, forward: bool
) -> tuple[Floats, float, bool] | None:
    """Return the closed orbit near a place (2,): points (N, 2), period, and whether it is stable.

    ``period`` is about the right one, and ``forward`` the direction in which lines come nearer. The
    place moves along a section across the flow, by Newton's method with the growth of distances in
    a turn: the divergence, integrated over its time. Where it is 0, all lines close.
    """
    way = 1.0
    if not forward:
        way = -1.0
    section = _Section(rates, start, way)
    at = start
    for _ in range(TURNS):
        turn = section.turn(at, period)
        if turn is None:
            return None
        times, points = turn
        period = float(times[-1])
        divergence = way * np.trace(rates.gradient(points), axis1=1, axis2=2)
        growth = float(scipy.integrate.simpson(divergence, x=times))
        if not abs(growth) > LEAST_GROWTH:
            return None
        moved = float((points[-1] - at) @ section.along)
        if abs(moved) < CLOSED * section.diagonal:
            points = _evenly_spaced(points, POINTS // 4)
            points[-1] = points[0]
            if not forward:
                points = points[::-1]
            return points, period, (growth < 0) == forward
        at = at + section.along * moved / (1 - np.exp(min(growth, 1.0)))
    return None


class _Section:
    """A straight line across the flow through a place (2,), to which lines return."""

    def __init__(self, rates: Rates, start: Floats, way: float) -> None:
        self._rates = rates
        self._start = start
        self._way = way
        normal = self._rate(0.0, start)
        self._normal = normal / np.linalg.norm(normal)
        #: Unit vector along the section, (2,).
        self.along = np.array([-self._normal[1], self._normal[0]])
        self.diagonal = np.hypot(*np.ptp(rates.ends, axis=1))

    def _rate(self, _: float, at: Floats) -> Floats:
        return np.asarray(self._way * self._rates.at(at[None])[0])

    def turn(self, at: Floats, period: float) -> tuple[Floats, Floats] | None:
        """Return times (N,) and points (N, 2) of a line until it crosses the section again.

        ``period`` is about the time that this takes. Returns ``None`` if the line does not return.
        """

        def crosses(_: float, place: Floats) -> float:
            return float((place - self._start) @ self._normal)

        crosses.terminal = True  # type: ignore[attr-defined]
        crosses.direction = 1.0  # type: ignore[attr-defined]
        options: Any = {"method": "LSODA", "rtol": TOLERANCE, "dense_output": True}
        options["atol"] = TOLERANCE * self.diagonal
        solve = scipy.integrate.solve_ivp
        most: Any = solve(self._rate, (0, ALMOST * period), at, **options)
        begin = most.y[:, -1]
        rest: Any = solve(self._rate, (most.t[-1], 3 * period), begin, events=crosses, **options)
        crossings = rest.t_events[0]
        if not len(crossings):
            return None
        times = np.linspace(0, float(crossings[0]), POINTS)
        is_first = times <= most.t[-1]
        points = np.concatenate([most.sol(times[is_first]).T, rest.sol(times[~is_first]).T])
        return times, points


def _evenly_spaced(points: Floats, count: int) -> Floats:
    """Return points (count, 2) at equal distances along a line of points (N, 2)."""
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    along = np.concatenate([[0], np.cumsum(lengths)])
    even = np.linspace(0, along[-1], count)
    x = np.interp(even, along, points[:, 0])
    y = np.interp(even, along, points[:, 1])
    return np.stack([x, y], axis=-1)


def nullclines(field: FlowField, window: Floats | None = None) -> tuple[Floats, Floats]:
    """Return the zeros of the components of a steady flow; a curved surface has no such lines.

    The components point along the axes of the flat surface. They are linear in the drawn triangles.
    For a formula in the plane its own zeros are found, without its poles, and with finer lines in a
    ``window``, (2, 2) as the ends of x and y. Returns the straight pieces of both lines, (S, 2, 3)
    each, in no order.
    """
    surface = field.surface
    rates = plane_rates(field)
    if surface.frame is None:
        return np.empty((0, 2, 3)), np.empty((0, 2, 3))
    if rates is not None:
        coarse = _of_formula(rates, rates.ends)
        if window is None:
            return coarse
        middle = window.mean(axis=1)
        half = np.ptp(window, axis=1) / 2
        lines = []
        for pieces, finer in zip(coarse, _of_formula(rates, window), strict=True):
            is_outside = (abs(pieces.mean(axis=1)[:, :2] - middle) > half).any(axis=1)
            lines.append(np.concatenate([pieces[is_outside], finer]))
        return lines[0], lines[1]
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
    if (np.ptp(window, axis=1) > 0).all():
        return np.asarray(window)
    return None


def _of_formula(rates: Rates, window: Floats) -> tuple[Floats, Floats]:
    """Return the zeros of both rates of a formula in a window, (S, 2, 3) each."""
    sides = np.ptp(window, axis=1)
    counts = np.maximum(np.round(LINE_CELLS * sides / sides.max()), LEAST_CELLS).astype(int)
    x = np.linspace(window[0, 0], window[0, 1], counts[0] + 1)
    y = np.linspace(window[1, 0], window[1, 1], counts[1] + 1)
    nodes = np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1)
    number = np.arange(len(x) * len(y)).reshape(len(y), len(x))
    a = number[:-1, :-1]
    b = number[:-1, 1:]
    c = number[1:, :-1]
    d = number[1:, 1:]
    lower = np.stack([a, b, d], axis=-1).reshape(-1, 3)
    upper = np.stack([a, d, c], axis=-1).reshape(-1, 3)
    corners = np.concatenate([lower, upper])
    points = nodes.reshape(-1, 3)
    values = rates.at(points[:, :2])
    lines = []
    for k in range(2):
        known = np.isfinite(values[corners, k]).all(axis=1)
        sides = _zero_pieces(points[corners[known]], values[corners[known], k])[1]
        first, first_vanishes = _crossing(rates, k, sides[:, 0])
        second, second_vanishes = _crossing(rates, k, sides[:, 1])
        pieces = np.stack([first, second], axis=1)
        lines.append(pieces[first_vanishes & second_vanishes])
    return lines[0], lines[1]


def _crossing(rates: Rates, component: int, sides: Floats) -> tuple[Floats, Bools]:
    """Return where a rate changes sign along sides (S, 2, 3), or ends at 0, and without a jump."""
    ends = [sides[:, 0], sides[:, 1]]
    values = list(rates.at(np.concatenate(ends)[:, :2])[:, component].reshape(2, -1))
    first = np.maximum(*np.abs(values))
    for _ in range(HALVINGS):
        middle = 0.5 * (ends[0] + ends[1])
        value = rates.at(middle[:, :2])[:, component]
        like_first = (value > 0) == (values[0] > 0)
        for n, moves in enumerate((like_first, ~like_first)):
            ends[n] = np.where(moves[:, None], middle, ends[n])
            values[n] = np.where(moves, value, values[n])
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.nan_to_num(values[0] / (values[0] - values[1]), nan=0.5)[:, None]
        vanishes = np.maximum(*np.abs(values)) < LEFT_SHARE * first
    return ends[0] + share * (ends[1] - ends[0]), np.asarray(vanishes)


def _zero_pieces(points: Floats, values: Floats) -> tuple[Floats, Floats]:
    """Return pieces (S, 2, 3) where values (M, 3) are zero, and their sides (S, 2, 2, 3)."""
    if len(values):
        least = ZERO_SHARE * np.quantile(np.abs(values), USUAL_SHARE)
    else:
        least = 0.0
    differs = np.abs(values) > least
    # A side along which the component is zero is a piece, perhaps a wall with one triangle.
    is_side = differs.sum(axis=1) == 1
    above = np.where(is_side[:, None], differs, values > least)
    count = above.sum(axis=1)
    crossed = np.flatnonzero((count == 1) | (count == 2))
    points = points[crossed]
    values = values[crossed]
    # The corner that differs from the other two, and both sides of the triangle that meet there.
    alone = np.argmax(above[crossed] == (count[crossed] == 1)[:, None], axis=1)
    row = np.arange(len(crossed))
    ends = []
    sides = []
    for k in (1, 2):
        other = (alone + k) % 3
        share = values[row, alone] / (values[row, alone] - values[row, other])
        start = points[row, alone]
        end = points[row, other]
        ends.append(start + share[:, None] * (end - start))
        sides.append(np.stack([start, end], axis=1))
    return np.stack(ends, axis=1), np.stack(sides, axis=1)
