"""Nullclines: the lines in a plane along which one component of the velocity is zero."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField

#: A component is zero up to this share of its greatest value.
ROUNDING = 1e-12


def nullclines(field: FlowField) -> tuple[Floats, Floats]:
    """Return where the components of a steady flow are zero; a curved surface has no such lines.

    The components are those along the axes of a flat surface, x and y in the plane of these. They
    are linear in the triangles that are drawn. Returns the straight pieces of both lines,
    (S, 2, 3) each, in no order.
    """
    surface = field.surface
    if surface.frame is None:
        return np.empty((0, 2, 3)), np.empty((0, 2, 3))
    corners = surface.corners_of(surface.drawn)
    points = surface.points.reshape(-1, 3)[corners]
    values = (field.velocity[0].reshape(-1, 3) @ surface.frame.T)[corners]
    one, two = (_zero_pieces(points, values[..., k]) for k in range(2))
    return one, two


def _zero_pieces(points: Floats, values: Floats) -> Floats:
    """Return the pieces in triangles (M, 3, 3) along which values (M, 3) are zero, (S, 2, 3)."""
    least = ROUNDING * np.abs(values).max(initial=0.0)
    differs = np.abs(values) > least
    # A side along which it is zero is a piece, and may be a wall, with a triangle on one side only.
    is_side = differs.sum(axis=1) == 1
    above = np.where(is_side[:, None], differs, values > least)
    count = above.sum(axis=1)
    some = np.flatnonzero((count == 1) | (count == 2))
    points, values = points[some], values[some]
    # The corner that differs from the other two, and both sides of the triangle that meet there.
    alone = np.argmax(above[some] == (count[some] == 1)[:, None], axis=1)
    row = np.arange(len(some))
    ends = []
    for k in (1, 2):
        other = (alone + k) % 3
        share = values[row, alone] / (values[row, alone] - values[row, other])
        start = points[row, alone]
        ends.append(start + share[:, None] * (points[row, other] - start))
    return np.stack(ends, axis=1)
