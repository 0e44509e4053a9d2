"""Nullclines: the lines in a plane along which one component of the velocity is zero."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.field import FlowField
from flowtex.field.formula import Formula

#: A component is zero up to this share of its quantile at the other: beside a pole it is huge.
ROUNDING, USUAL_SHARE = 1e-12, 0.9
#: Halvings of a side of a triangle that a line crosses, and the greatest remaining share of a value
#: that goes to zero there; at a pole and at a jump more remains.
HALVINGS, LEFT = 12, 0.25


def nullclines(field: FlowField) -> tuple[Floats, Floats]:
    """Return the zeros of the components of a steady flow; a curved surface has no such lines.

    The components are those along the axes of a flat surface, x and y in the plane of these. They
    are linear in the drawn triangles; those of a formula are not, which distinguishes a zero from a
    pole. Returns the straight pieces of both lines, (S, 2, 3) each, in no order.
    """
    surface, formula = field.surface, field.formula
    if surface.frame is None:
        return np.empty((0, 2, 3)), np.empty((0, 2, 3))
    corners = surface.corners_of(surface.drawn)
    points = surface.points.reshape(-1, 3)[corners]
    values = (field.velocity[0].reshape(-1, 3) @ surface.frame.T)[corners]
    lines = []
    for k in range(2):
        pieces, sides = _zero_pieces(points, values[..., k])
        if formula is not None and not formula.surface:
            rate = partial(_rate, formula, float(field.times[0]), k)
            pieces = pieces[_vanishes(rate, sides[:, 0]) & _vanishes(rate, sides[:, 1])]
        lines.append(pieces)
    return lines[0], lines[1]


def _rate(formula: Formula, time: float, component: int, points: Floats) -> Floats:
    x, y, _ = points.T
    return formula.velocity(x, y, time)[:, component]


def _vanishes(rate: Callable[[Floats], Floats], sides: Floats) -> Bools:
    """Return whether a rate changes sign along sides (S, 2, 3), or ends at 0, without a jump."""
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
    return np.asarray(np.maximum(*np.abs(values)) < LEFT * first)


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
