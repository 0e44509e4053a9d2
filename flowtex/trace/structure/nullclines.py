"""Nullclines: the lines in a plane along which one component of the velocity is zero."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.field import FlowField
from flowtex.field.formula.rates import Rates
from flowtex.trace.structure.formula_lines import plane_rates

#: A component is zero up to this share of its quantile at the other: beside a pole it is huge.
ROUNDING, USUAL_SHARE = 1e-12, 0.9
#: Halvings of a side of a triangle that a line crosses, and the greatest remaining share of a value
#: that goes to zero there; at a pole and at a jump more remains.
HALVINGS, LEFT = 12, 0.25
#: Cells along the longer side of what is searched in a formula, and along the other one at least.
CELLS, LEAST_CELLS = 256, 8
#: Size of a window over that of the view, at least, and steps of its middle over its size.
WINDOW_VIEWS, WINDOW_STEPS = 2.0, 4


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
