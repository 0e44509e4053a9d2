"""Values between nodes and between time steps, and at nodes without a value."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, TypeVar, cast

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices

A = TypeVar("A", bound=AnyArray)


def nearest_known(known: Bools) -> tuple[Indices, Indices]:
    """Return row and column of the nearest node that is known, for each node of (J, I)."""
    rows, columns = scipy.ndimage.distance_transform_edt(
        ~known, return_distances=False, return_indices=True
    )
    return rows, columns


def fill_blanked(data: A, known: Bools, axis: int = 0) -> A:
    """Return (..., J, I, ...) with the nearest known value at nodes not ``known``, (J, I)."""
    if known.all():
        return data
    index: Any = (*[slice(None)] * axis, *nearest_known(known))
    return cast("A", data[index])


def bracket(
    line: Floats, values: Any, *, side: Literal["left", "right"] = "right"
) -> tuple[Any, Any]:
    """Find the interval of an increasing line (N,) in which values of any shape lie.

    Returns its number, 0 to N - 2, and the distance from its start in lengths of the interval.
    Values beyond an end belong to the first or the last one, a value equal to a number of the line
    to the interval that begins there, with ``side="left"`` to that before it.
    """
    interval = np.clip(np.searchsorted(line, values, side=side) - 1, 0, len(line) - 2)
    return interval, (values - line[interval]) / (line[interval + 1] - line[interval])


def steps_around(times: Floats, time: float) -> tuple[int, int, float]:
    """Return the two time steps around a time, the same where there is one, and its share."""
    if len(times) == 1:
        return 0, 0, 0.0
    step, share = bracket(times, time)
    return int(step), int(step) + 1, float(share)


def nearer_step(moment: tuple[int, int, float]) -> tuple[int, int, float]:
    """Return the moment of the nearer of two steps, the later one half-way."""
    before, after, share = moment
    if share < 0.5:
        after = before
    return after, after, 0.0


def at_moment(
    steps: Any,
    moment: tuple[int, int, float],
    part: Callable[[Floats], Floats] = np.asarray,
) -> Floats:
    """Return values between two steps of (T or 1, ...), or a part of them.

    ``moment`` comes from :func:`steps_around`. Where one step has no value, NaN, the value of the
    nearer step is taken.
    """
    before, after, share = moment
    if len(steps) == 1:
        return part(steps[0])
    if share in (0.0, 1.0):
        return part(steps[before + int(share) * (after - before)])
    earlier = part(steps[before])
    later = part(steps[after])
    mixed = earlier * (1 - share) + later * share
    nearer = later
    if share < 0.5:
        nearer = earlier
    return np.where(np.isnan(mixed), nearer, mixed)


def cell_of(
    index: Floats, count: int, *, periodic: bool, start: Indices | int = 0
) -> tuple[Indices, Floats, Floats, Floats]:
    """Find the cells of positions (N,), given in cells, along an axis of ``count`` nodes.

    They are counted from the nodes ``start``, so that their digits are not lost. Returns (N,) each:
    number of the cell; fraction of it that lies before the position; distance beyond the nearer
    end, signed, where the axis is not periodic; whole periods, where it is.
    """
    whole = np.floor(index)
    cells = count - 1
    cell = whole.astype(np.intp) + start
    share = index - whole
    if periodic:
        turns = cell // cells
        return cell - turns * cells, share, np.zeros_like(share), turns.astype(share.dtype)
    zeros = np.zeros_like(share)
    if not cell.size or (cell.min() >= 0 and cell.max() < cells):
        return cell, share, zeros, zeros
    inside = np.clip(cell, 0, cells - 1)
    share += (cell - inside).astype(share.dtype)
    within = np.clip(share, 0, 1)
    return inside, within, share - within, zeros


def cubic_weights(t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """Return the Catmull-Rom weights of the four nodes around a fraction of a cell."""
    t2 = t * t
    t3 = t * t * t
    return (
        0.5 * (-t3 + 2 * t2 - t),
        0.5 * (3 * t3 - 5 * t2 + 2),
        0.5 * (-3 * t3 + 4 * t2 + t),
        0.5 * (t3 - t2),
    )


def between_nodes(nodal: AnyArray, index: Floats) -> Floats:
    """Interpolate nodal values (J, I) linearly at (..., 2) as (i, j); constant beyond a border."""
    at = [index[..., 1], index[..., 0]]
    return np.asarray(
        scipy.ndimage.map_coordinates(nodal.astype(float), at, order=1, mode="nearest")
    )


def along_line(line: Floats, index: Floats, *, periodic: bool) -> Floats:
    """Interpolate increasing values (N,) at any index; they continue straight, or by a period."""
    last = len(line) - 1
    turns = np.zeros_like(index)
    if periodic:
        turns = np.floor(index / last)
    inside = scipy.interpolate.make_interp_spline(np.arange(last + 1.0), line, k=1)
    return np.asarray(inside(index - turns * last) + turns * (line[-1] - line[0]))


def inverse_along_line(line: Floats, values: Floats, *, periodic: bool) -> Floats:
    """Return the index at which :func:`along_line` has these values, for a line from zero."""
    last = len(line) - 1
    if periodic:
        turns = np.floor(values / line[-1])
    else:
        turns = 0.0
    inside = scipy.interpolate.make_interp_spline(line, np.arange(last + 1.0), k=1)
    return np.asarray(inside(values - turns * line[-1]) + turns * last)
