"""Detection of axes that close on themselves, and closing of their arrays.

Meshes close in three ways: the last line of nodes repeats the first (an O-grid in PLOT3D), the
last line stops one cell short of the first (a sphere or ring without the repeated line), or the
axis is global longitude on a flat map, where the first line comes back 360 degrees further on.
In a field the last line always repeats the first one. A line is appended where it is missing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar, cast

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex._util.blocks import bounds
from flowtex.field.validation import LENGTHS, finite_nodes, largest

A = TypeVar("A", bound=AnyArray)

#: Lines closer than this share of the extent of the mesh coincide.
SAME_LINE_EXTENT = 1e-6
#: So do lines closer than this share of the cells beside them.
SAME_LINE_CELLS = 1e-2
#: Least number of lines of a ring with a gap.
MIN_RING_LINES = 8


@dataclass(frozen=True)
class Closure:
    """Whether one axis closes, and the line to append, or ``None``."""

    periodic: bool
    line: Floats | None = None


@dataclass(frozen=True)
class NodalArrays:
    """Nodal arrays as :meth:`FlowField.from_arrays` takes them, all dimensions present.

    Points are (J, I, 3), velocity (T, J, I, 3), valid (J, I), and scalars (T or 1, J, I) each.
    """

    points: Floats
    velocity: Floats
    valid: Bools
    scalars: Mapping[str, Floats]


def close_axes(nodal: NodalArrays, periodic: str | None) -> tuple[NodalArrays, tuple[bool, bool]]:
    """Close the axes that ``periodic`` names, or those found: append a line, or join two."""
    closed = [False, False]
    for axis, letter in ((0, "j"), (1, "i")):
        lines = np.swapaxes(nodal.points, 0, axis)
        if periodic is None:
            valid = np.swapaxes(nodal.valid, 0, axis)[..., None]
            closure = find_closure(lines if valid.all() else np.where(valid, lines, np.nan))
        elif letter in periodic:
            closure = _requested_closure(lines, np.swapaxes(nodal.velocity, 1, axis + 1))
        else:
            closure = Closure(periodic=False)
        closed[axis] = closure.periodic
        if closure.line is not None:
            nodal = NodalArrays(
                points=np.swapaxes(np.concatenate([lines, closure.line]), 0, axis),
                velocity=_repeat_first(nodal.velocity, axis + 1),
                valid=_repeat_first(nodal.valid, axis),
                scalars={k: _repeat_first(s, axis + 1) for k, s in nodal.scalars.items()},
            )
        elif closure.periodic:
            _join_ends(nodal, axis)
    return nodal, (closed[0], closed[1])


def find_closure(points: Floats) -> Closure:
    """Decide from the geometry whether the first axis of (N, M, 3) nodes closes."""
    # Values that cannot be lengths are missing data.
    if largest(points) > LENGTHS[1]:
        points = np.where(np.abs(points) <= LENGTHS[1], points, np.nan)
    extent = _extent(points)
    if extent == 0.0 or len(points) < 3:
        return Closure(periodic=False)
    if _coincide(points, extent):
        return Closure(periodic=True)
    turn = _longitude(points)
    if turn is not None:
        return turn
    if len(points) >= MIN_RING_LINES and _one_cell_short(points):
        return Closure(periodic=True, line=points[:1])
    return Closure(periodic=False)


def _requested_closure(points: Floats, velocity: Floats) -> Closure:
    """Close the first axis on request, by a line unless the last one has the first's values."""
    closure = find_closure(points)
    if closure.periodic:
        return closure
    fastest = float(np.nanmax(np.abs(velocity), initial=0.0))
    repeats = np.allclose(
        velocity[:, 0], velocity[:, -1], rtol=0, atol=1e-6 * fastest, equal_nan=True
    )
    if repeats and fastest > 0:
        return Closure(periodic=True)
    return Closure(periodic=True, line=2 * points[-1:] - points[-2:-1])


def _extent(points: Floats) -> float:
    finite = finite_nodes(points)
    if not finite.any():
        return 0.0
    low, high = bounds(points if finite.all() else points[finite])
    return float(np.linalg.norm(high - low))


def _coincide(points: Floats, extent: float) -> bool:
    """Return whether the last line lies on the first one, and the lines between do not."""
    middle = _greatest_length(points[len(points) // 2] - points[0])
    gap = np.linalg.norm(points[-1] - points[0], axis=-1)
    ends = np.stack([points[1] - points[0], points[-1] - points[-2]])
    steps = np.linalg.norm(ends, axis=-1).max(axis=0)
    # Coordinates far from the origin, or of few digits, differ by more than a share of the extent.
    with np.errstate(invalid="ignore"):
        close = gap <= np.fmax(SAME_LINE_EXTENT * extent, SAME_LINE_CELLS * steps)
    finite = np.isfinite(gap)
    return bool(finite.any()) and bool(close[finite].all()) and SAME_LINE_EXTENT * extent < middle


def _one_cell_short(points: Floats) -> bool:
    """Return whether the gap between the last line and the first is one cell among others."""
    first, last, gap = (
        np.linalg.norm(points[a] - points[b], axis=-1) for a, b in ((1, 0), (-1, -2), (-1, 0))
    )
    finite = np.isfinite(gap)
    with np.errstate(invalid="ignore"):
        near = gap <= 1.5 * np.maximum(first, last)
    if not ((gap[finite] > 0).any() and near[finite].all()):
        return False
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    with np.errstate(invalid="ignore"):
        around = np.nansum(steps, axis=0) >= 0.75 * len(steps) * gap
    return bool(around[finite].all())


def _longitude(points: Floats) -> Closure | None:
    """Recognise global longitude in degrees along the first axis of a flat map."""
    x, y = points[..., 0], points[..., 1]
    if not np.isfinite(x[:, 0]).all():
        return None
    # One line is enough to exclude most other meshes.
    steps = np.diff(x[:, 0])
    even = len(steps) > 3 and np.ptp(steps) <= 1e-3 * abs(steps[0]) and steps[0] != 0
    span, step = abs(x[-1, 0] - x[0, 0]), abs(steps[0])
    repeats, ends_short = abs(span - 360) <= 1e-3 * step, abs(span + step - 360) <= 1e-2 * step
    if not (even and (repeats or ends_short)):
        return None
    if not np.isfinite(points).all() or np.ptp(points[..., 2]) > 0:
        return None
    same = np.ptp(x, axis=1).max() <= 1e-6 * 360
    if not (same and np.abs(y).max() <= 90.01 and np.ptp(y) > 0):
        return None
    return Closure(periodic=True, line=None if repeats else 2 * points[-1:] - points[-2:-1])


def _greatest_length(difference: Floats) -> float:
    lengths = np.linalg.norm(difference, axis=-1)
    lengths = lengths[np.isfinite(lengths)]
    return float(lengths.max()) if len(lengths) else float("inf")


def _repeat_first(a: A, axis: int) -> A:
    """Append the first line of an axis behind its last."""
    return cast("A", np.concatenate([a, np.take(a, [0], axis=axis)], axis=axis))


def _join_ends(nodal: NodalArrays, axis: int) -> None:
    """Give two coinciding lines one velocity, in place; data may differ across the seam."""
    velocity, valid = nodal.velocity, nodal.valid
    v, ok = np.swapaxes(velocity, 1, axis + 1), np.swapaxes(valid, 0, axis)
    first, last = ok[0].copy(), ok[-1].copy()
    mean = (v[:, 0] + v[:, -1]) / 2
    only = np.where(first[:, None], v[:, 0], v[:, -1])
    v[:, 0] = v[:, -1] = np.where((first & last)[:, None], mean, only)
    ok[0] = ok[-1] = first | last
