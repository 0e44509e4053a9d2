"""Ranges of values over a large field, by which it is coloured."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field import FlowField

#: Percentiles at the ends of a range without outliers.
ROBUST_PERCENTILES = (2, 98)
#: Values that differ by less than this share of the greatest are the same.
SAME_VALUE_SHARE = 1e-9
#: Share of such a value by which its range is widened.
WIDENED_SHARE = 0.05


def ends_of(values: Floats, *, robust: bool) -> tuple[float, float] | None:
    """Return the least and the greatest value that is known, or those of a robust range."""
    values = values[np.isfinite(values)]
    if not values.size:
        return None
    low, high = (
        np.percentile(values, ROBUST_PERCENTILES)
        if robust
        else np.array([values.min(), values.max()])
    )
    return float(low), float(high)


def widened(ends: tuple[float, float] | None) -> tuple[float, float]:
    """Return a range to colour by, where all values may be the same but for rounding, or none."""
    if ends is None:
        return 0.0, 1.0
    low, high = ends
    size = max(abs(low), abs(high))
    if high - low > SAME_VALUE_SHARE * size:
        return low, high
    return (low - WIDENED_SHARE * size, high + WIDENED_SHARE * size) if size > 0 else (0.0, 1.0)


def drawn_speeds(field: FlowField, root: FlowField) -> Floats:
    """Return the speeds of the valid nodes of a field whose coarsest level is the root, (T, N).

    Those in space are quicker to have, and the same where hardly any flow leaves the surface.
    """
    steps = field.speed if root.leaves_surface else np.linalg.norm(field.velocity, axis=-1)
    return np.asarray(np.asarray(steps)[:, field.valid])
