"""Ranges of values for colours: whole, or without outliers."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex._util.arrays import norm
from flowtex.field import FlowField
from flowtex.textures.tiles.shared import has_pyramid

#: Percentiles at the ends of a range without outliers.
ROBUST_PERCENTILES = (2, 98)
#: Length of a tail that colours leave out by default, in robust ranges. The greatest of a million
#: values of a normal distribution is 0.7 beyond, of an exponential one 2.5.
LONG_TAIL = 1.0
#: Least share of a robust range in the whole one, for colours to have the robust one by default.
LEAST_SHARE = 1e-9
#: Values that differ by less than this share of the greatest are the same.
SAME_VALUE_SHARE = 1e-9
#: The same for speeds of stored velocities, which have half precision.
SAME_HALVES_SHARE = 2.0**-9
#: Share of such a value by which its range is widened.
WIDENED_SHARE = 0.05


def ends_of(values: Floats, *, robust: bool) -> tuple[float, float] | None:
    """Return the least and the greatest finite value, or the ends of a robust range."""
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    if robust:
        low, high = np.percentile(values, ROBUST_PERCENTILES)
    else:
        low, high = np.array([values.min(), values.max()])
    return float(low), float(high)


def usual_ends(whole: tuple[float, float], robust: tuple[float, float]) -> tuple[float, float]:
    """Return the whole range, without a tail that is longer than the robust range.

    Where nearly all values are the same, it is the whole range.
    """
    (least, most) = whole
    (low, high) = robust
    tail = LONG_TAIL * (high - low)
    if tail < LEAST_SHARE * (most - least):
        return whole
    return low if low - least > tail else least, high if most - high > tail else most


def range_rules() -> dict[str, object]:
    """Return the numbers by which :func:`usual_ends` and :func:`widened` find a range, by name."""
    return {
        "percentiles": list(ROBUST_PERCENTILES),
        "tail": LONG_TAIL,
        "leastShare": LEAST_SHARE,
        "same": SAME_VALUE_SHARE,
        "widening": WIDENED_SHARE,
    }


def widened(ends: tuple[float, float] | None, field: FlowField, name: str) -> tuple[float, float]:
    """Return a range for colours, also for equal values up to rounding, and for none."""
    halves = name == "speed" and name not in field.scalars and has_pyramid(field)
    if halves:
        same = SAME_HALVES_SHARE
    else:
        same = SAME_VALUE_SHARE
    if ends is None:
        return 0.0, 1.0
    low, high = ends
    size = max(abs(low), abs(high))
    if high - low > same * size:
        return low, high
    if size > 0:
        return (low - WIDENED_SHARE * size, high + WIDENED_SHARE * size)
    return (0.0, 1.0)


def valued_places(field: FlowField, name: str) -> Bools:
    """Return where a scalar has values on the surface, as an index of one of its steps.

    Triangles have a value each; a cell of a grid has the place of its first node.
    """
    if name in field.on_cells and field.triangles is not None:
        return field.surface.cells[None]
    return field.valid


def drawn_speeds(field: FlowField, root: FlowField) -> Floats:
    """Return speeds of valid nodes, (T, N); in space, where hardly any flow leaves the surface."""
    if root.leaves_surface:
        steps = field.index_velocity.speed
    else:
        steps = norm(field.velocity)
    return np.asarray(steps)[:, field.valid] * field.speed_scale
