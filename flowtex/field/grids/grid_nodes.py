"""Arguments of a field on a structured surface as its arrays, and signs of sign-free ones.

Around a half-integer singularity a vector without a sign returns reversed. So signs at nodes agree
with their neighbours except along a cut, and the corners of each cell are given equal signs
(:func:`corner_signs`) before interpolation.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar, cast

import numpy as np
import scipy
from numpy.typing import NDArray

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.arrays import bounds, rows_where
from flowtex.errors import raise_faults
from flowtex.field.checked_nodes import CheckedNodes
from flowtex.field.field_arrays import GridArrays
from flowtex.field.grids.grid_surface import GridSurface, known_positions
from flowtex.field.grids.poles import Poles
from flowtex.field.steps import LazySteps, first_step
from flowtex.field.triangles.triangle_nodes import solid_triangles
from flowtex.field.validation import (
    LENGTHS,
    Checked,
    as_numbers,
    cell_faults,
    finite_nodes,
    largest,
    node_faults,
    node_positions,
    range_faults,
    scalar_steps,
    shape_faults,
    three_components,
    with_gaps,
)

A = TypeVar("A", bound=AnyArray)

SAME_LINE_EXTENT = 1e-6  #: Lines closer than this share of the extent of the mesh coincide.
SAME_LINE_CELLS = 1e-2  #: So do lines closer than this share of the cells beside them.
MIN_RING_LINES = 8  #: Least number of lines of a ring with a gap.
#: Additional cost of a step to a node at right angles, relative to a step to a parallel one.
TURN_COST = 10.0
REST_SHARE = 1e-7  #: A vector shorter than this share of the longest has no direction.
AREA_BLOCK = 10_000  #: Cells in which one with an area is looked for at a time.


def close_axes(
    points: Floats, velocity: Floats, valid: Bools, scalars: dict[str, Floats], periodic: str | None
) -> tuple[Floats, Floats, Bools, dict[str, Floats], tuple[bool, bool]]:
    """Close the axes that ``periodic`` names, or those found: append a line, or join two.

    Returns the arrays, (J, I, 3), (T, J, I, 3), (J, I), (T or 1, J, I), and which axes are closed.
    """
    closed = [False, False]
    for axis, letter in ((0, "j"), (1, "i")):
        lines = np.swapaxes(points, 0, axis)
        if periodic is None:
            known = np.swapaxes(valid, 0, axis)[..., None]
            known_lines = lines
            if not known.all():
                known_lines = np.where(known, lines, np.nan)
            close, line = find_closure(known_lines)
        elif letter in periodic:
            close, line = _requested_closure(lines, np.swapaxes(velocity, 1, axis + 1))
        else:
            close = False
            line = None
        closed[axis] = close
        if line is not None:
            points = np.swapaxes(np.concatenate([lines, line]), 0, axis)
            velocity = _repeat_first(velocity, axis + 1)
            valid = _repeat_first(valid, axis)
            closed_scalars = {}
            for name, values in scalars.items():
                closed_scalars[name] = _repeat_first(values, axis + 1)
            scalars = closed_scalars
        elif close:
            _join_ends(velocity, valid, axis)
    return points, velocity, valid, scalars, (closed[0], closed[1])


def find_closure(points: Floats) -> tuple[bool, Floats | None]:
    """Return whether the first axis of (N, M, 3) nodes closes, and the line to append, if any."""
    # Values that cannot be lengths are missing data.
    if largest(points) > LENGTHS[1]:
        points = np.where(np.abs(points) <= LENGTHS[1], points, np.nan)
    finite = finite_nodes(points)
    if not finite.any() or len(points) < 3:
        return False, None
    if finite.all():
        low, high = bounds(points)
    else:
        low, high = bounds(rows_where(points, finite))
    extent = float(np.linalg.norm(high - low))
    if extent == 0.0:
        return False, None
    if _coincide(points, extent):
        return True, None
    turn = _longitude(points)
    if turn is not None:
        return turn
    if len(points) >= MIN_RING_LINES and _one_cell_short(points):
        return True, points[:1]
    return False, None


def _requested_closure(points: Floats, velocity: Floats) -> tuple[bool, Floats | None]:
    """Close the first axis on request, by a line unless the last one has the first's values."""
    found = find_closure(points)
    if found[0]:
        return found
    fastest = float(np.nanmax(np.abs(velocity), initial=0.0))
    repeats = np.allclose(
        velocity[:, 0], velocity[:, -1], rtol=0, atol=1e-6 * fastest, equal_nan=True
    )
    if repeats and fastest > 0:
        return True, None
    return True, 2 * points[-1:] - points[-2:-1]


def _coincide(points: Floats, extent: float) -> bool:
    """Return whether the last line lies on the first one, and the lines between do not."""
    across = np.linalg.norm(points[len(points) // 2] - points[0], axis=-1)
    across = across[np.isfinite(across)]
    if len(across):
        middle = float(across.max())
    else:
        middle = np.inf
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
    first = np.linalg.norm(points[1] - points[0], axis=-1)
    last = np.linalg.norm(points[-1] - points[-2], axis=-1)
    gap = np.linalg.norm(points[-1] - points[0], axis=-1)
    finite = np.isfinite(gap)
    with np.errstate(invalid="ignore"):
        near = gap <= 1.5 * np.maximum(first, last)
    if not ((gap[finite] > 0).any() and near[finite].all()):
        return False
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    with np.errstate(invalid="ignore"):
        around = np.nansum(steps, axis=0) >= 0.75 * len(steps) * gap
    return bool(around[finite].all())


def _longitude(points: Floats) -> tuple[bool, Floats | None] | None:
    """Recognise global longitude in degrees along the first axis of a flat map."""
    x = points[..., 0]
    y = points[..., 1]
    if not np.isfinite(x[:, 0]).all():
        return None
    # One line is enough to exclude most other meshes.
    steps = np.diff(x[:, 0])
    even = len(steps) > 3 and np.ptp(steps) <= 1e-3 * abs(steps[0]) and steps[0] != 0
    span = abs(x[-1, 0] - x[0, 0])
    step = abs(steps[0])
    repeats = abs(span - 360) <= 1e-3 * step
    ends_short = abs(span + step - 360) <= 1e-2 * step
    if not (even and (repeats or ends_short)):
        return None
    if not np.isfinite(points).all() or np.ptp(points[..., 2]) > 0:
        return None
    same = np.ptp(x, axis=1).max() <= 1e-6 * 360
    if not (same and np.abs(y).max() <= 90.01 and np.ptp(y) > 0):
        return None
    if repeats:
        return True, None
    return True, 2 * points[-1:] - points[-2:-1]


def _repeat_first(a: A, axis: int) -> A:
    return cast("A", np.concatenate([a, np.take(a, [0], axis=axis)], axis=axis))


def _join_ends(velocity: Floats, valid: Bools, axis: int) -> None:
    """Give two coinciding lines one velocity, in place; data may differ across the seam."""
    v = np.swapaxes(velocity, 1, axis + 1)
    ok = np.swapaxes(valid, 0, axis)
    first = ok[0].copy()
    last = ok[-1].copy()
    mean = (v[:, 0] + v[:, -1]) / 2
    only = np.where(first[:, None], v[:, 0], v[:, -1])
    v[:, 0] = v[:, -1] = np.where((first & last)[:, None], mean, only)
    ok[0] = ok[-1] = first | last


def grid_nodes(arrays: GridArrays, own: Checked, *, on_globe: bool) -> CheckedNodes:
    """Check the arrays of a grid. Of those that are read late, one step is read.

    The arrays are described at :meth:`flowtex.FlowField.from_arrays`; ``own`` has the velocity and
    the scalars without gaps.

    Raises
    ------
    FieldError
        When shapes or types do not fit together, values exceed the range of computations, or fewer
        nodes than a surface needs have data. The error lists all faults.
    """
    p, masked_points = as_numbers("points", node_positions(arrays.points))
    v, masked_velocity = as_numbers("velocity", first_step(own.velocity))
    late, in_memory = _late_and_in_memory(own.scalars)
    on_cells = _with_gaps_by_name("cell_scalars", arrays.cell_scalars)
    mask = None
    if arrays.valid is not None:
        mask = with_gaps("valid", arrays.valid)
    count = _step_count(own.velocity, v)
    faults = shape_faults(p, v, count, own.times, mask, arrays.periodic, in_memory)
    cells = tuple(max(n - 1, 0) for n in p.shape[:2])
    faults = faults or cell_faults(cells, count, on_cells, own.scalars)
    if arrays.sign_free:
        faults += _time_faults(v)
    raise_faults(faults)
    if v.ndim == 3:
        v = v[None]
    # Arguments are copied once, and not changed.
    p = _copied_in_space(p)
    v = _copied_in_space(v)
    ok = _usable_nodes(p, v, ~(masked_points | masked_velocity), mask)
    shape = p.shape[:2]
    data: dict[str, Any] = _scalars_of_nodes(in_memory, on_cells, shape)
    if arrays.sign_free:
        v = with_equal_ends(v)
    p, v, ok, data, closed = close_axes(p, v, ok, data, arrays.periodic)
    surface = GridSurface(p, ok, closed, on_globe=on_globe)
    raise_faults(_area_faults(surface))
    if arrays.sign_free:
        v = _oriented_on(surface, v)
    v[:, ~ok] = 0.0
    closed_as_nodes = partial(_closed, np.greater(ok.shape, shape).tolist())
    steps: Any = v
    if isinstance(own.velocity, LazySteps):
        steps = own.velocity.map(partial(_moving, ok, closed_as_nodes))
    all_scalars = data | _mapped(late, closed_as_nodes)
    ordered = {name: all_scalars[name] for name in (*own.scalars, *on_cells)}
    position = surface.has_position
    return CheckedNodes(surface, steps, ordered, position, arrays.sign_free, arrays.section)


def _area_faults(surface: GridSurface) -> list[str]:
    """Return the fault of a surface of which no cell has an area, as with one row given twice."""
    points = surface.points.reshape(-1, 3)
    cells = np.flatnonzero(surface.cells)
    for start in range(0, len(cells), AREA_BLOCK):
        first = 2 * cells[start : start + AREA_BLOCK]
        corners = surface.corners_of(np.append(first, first + 1))
        if solid_triangles(points, corners).any():
            return []
    return [
        "no cell has an area, because the nodes of each lie on one line; expected a surface: check "
        "the coordinates, and whether a row or column is there twice"
    ]


def _oriented_on(surface: GridSurface, v: Floats) -> Floats:
    """Return a sign-free velocity (1, J, I, 3) that agrees between neighbours where it can."""
    ok = surface.valid
    one = oriented(np.where(ok[..., None], v[0], 0.0), ok, surface.periodic)
    return with_equal_ends(one[None], surface.periodic, surface.poles)


def _time_faults(v: Floats) -> list[str]:
    """Return the fault of a sign-free velocity, (J, I, C), that has several time steps."""
    if v.ndim < 4 or len(v) == 1:
        return []
    return [
        f"sign_free is True, but velocity has {len(v)} time steps; a sign-free field has no "
        "paths in time: give one step, as in velocity[-1], or make one field for each"
    ]


def _mapped(
    scalars: Mapping[str, LazySteps], function: Callable[[Floats], Floats]
) -> dict[str, Any]:
    """Return scalars to which a function is applied when they are read."""
    return {name: steps.map(function) for name, steps in scalars.items()}


def _usable_nodes(p: Floats, v: Floats, shown: Bools, mask: Floats | None) -> Bools:
    """Return the nodes with data, (J, I); elsewhere values become NaN in place.

    ``shown`` are the nodes that no masked array hides, and ``mask`` is 0 where a user has none.
    """
    ok: Bools = finite_nodes(p) & finite_nodes(v) & shown
    if mask is not None:
        ok &= np.nan_to_num(mask) != 0
    # Fill values must not take part in computations.
    v[:, ~ok] = np.nan
    raise_faults(range_faults(p, v, ok) or node_faults(p, ok))
    p[~known_positions(p, ok)] = np.nan
    return ok


def _step_count(velocity: Any, first: Floats) -> int:
    """Return the number of time steps of a velocity, whose first steps are read."""
    if isinstance(velocity, LazySteps) or first.ndim == 4:
        return len(velocity)
    return 1


def _with_gaps_by_name(argument: str, scalars: Mapping[str, Any]) -> dict[str, Floats]:
    """Return the values of the scalars of an argument, NaN where they are masked."""
    values = {}
    for name, given in scalars.items():
        values[name] = with_gaps(f"{argument}[{name!r}]", given)
    return values


def _late_and_in_memory(
    scalars: Mapping[str, Any],
) -> tuple[dict[str, LazySteps], dict[str, Floats]]:
    """Return the scalars that are read later, and the values of the others."""
    late = {}
    given = {}
    for name, values in scalars.items():
        if isinstance(values, LazySteps):
            late[name] = values
        else:
            given[name] = values
    return late, _with_gaps_by_name("scalars", given)


def _copied_in_space(vectors: Floats) -> Floats:
    """Return a copy of vectors (..., 2 or 3) that has three components."""
    if vectors.shape[-1] == 2:
        return three_components(vectors)
    return vectors.copy("C")


def _scalars_of_nodes(
    nodal: Mapping[str, Floats], on_cells: Mapping[str, Floats], shape: tuple[int, int]
) -> dict[str, Floats]:
    """Return scalars at all nodes, (T or 1, J, I), those of cells at their first corners."""
    scalars = {}
    for name, values in nodal.items():
        scalars[name] = scalar_steps(values, shape)
    for name, values in on_cells.items():
        at_cells = scalar_steps(values, (shape[0] - 1, shape[1] - 1))
        last_line = ((0, 0), (0, 1), (0, 1))
        scalars[name] = np.pad(at_cells, last_line, constant_values=np.nan)
    return scalars


def _closed(appended: Sequence[bool], step: Floats) -> Floats:
    """Return a step with its first line appended at the end along these axes."""
    for axis, is_appended in enumerate(appended):
        if is_appended:
            step = np.concatenate([step, np.take(step, [0], axis=axis)], axis=axis)
    return step


def _moving(ok: Bools, closed: Callable[[Floats], Floats], step: Floats) -> Floats:
    """Return a step of a velocity, zero at nodes without data."""
    step = closed(three_components(step))
    return np.where((ok & finite_nodes(step))[..., None], step, 0.0)


def oriented(velocity: Floats, valid: Bools, periodic: tuple[bool, bool]) -> Floats:
    """Turn vectors (J, I, 3) over so that neighbours agree.

    Directions spread from the middle on the shortest ways; steps to nodes that disagree are long.
    """
    flat = velocity.reshape(-1, 3)
    length = np.linalg.norm(flat, axis=-1, keepdims=True)
    # A vector at rest has no direction.
    valid = valid & (length > REST_SHARE * length.max()).reshape(valid.shape)
    pairs = neighbour_pairs(valid.shape, periodic)
    start, end = pairs[valid.ravel()[pairs].all(axis=1)].T
    unit = flat / np.where(length > 0, length, 1.0)
    agree = np.sum(unit[start] * unit[end], axis=-1)
    cost = 1 + TURN_COST * (1 - np.abs(agree))
    graph = scipy.sparse.csr_array((cost, (start, end)), shape=(valid.size, valid.size))
    parent = _tree(graph, valid)
    sign = np.where(np.sum(unit * unit[parent], axis=-1) < 0, -1.0, 1.0)
    # Every node takes the sign of its parent, twice as far up each time.
    while (parent != parent[parent]).any():
        sign = sign * sign[parent]
        parent = parent[parent]
    return np.asarray((flat * sign[:, None]).reshape(velocity.shape))


def with_equal_ends(
    velocity: Floats, periodic: tuple[bool, bool] | None = None, poles: Poles | None = None
) -> Floats:
    """Turn over the vectors of last lines to agree with the first, (T, J, I, 3).

    Nodes at the same place then have the same vector: the ends of closed axes, of both axes where
    ``periodic`` is not known yet, and the nodes of a pole.
    """
    result = velocity.copy()
    for axis in (1, 2):
        if periodic is None or periodic[axis - 1]:
            lines = np.swapaxes(result, 1, axis)
            lines[:, -1] *= _sign(lines[:, 0] * lines[:, -1])
    for pole in poles or ():
        line = pole.lines(result, 1)[:, pole.line]
        line *= _sign(line * line[:, :1])
    return result


def corner_signs(vectors: AnyArray) -> NDArray[np.int8] | None:
    """Return signs that align the corners of each cell, of vectors (J, I, C), with the first one.

    They are -1 or 1, (4, J, I), for the corners (j, i), (j, i + 1), (j + 1, i), (j + 1, i + 1), as
    far as there is a cell; ``None`` where all are 1.
    """
    first, *others = (vectors[:-1, :-1], vectors[:-1, 1:], vectors[1:, :-1], vectors[1:, 1:])
    signs = np.ones((4, *vectors.shape[:2]), np.int8)
    mean = np.array(first)
    for sign, corner in zip(signs[1:, :-1, :-1], others, strict=True):
        sign[np.sum(mean * corner, axis=-1) < 0] = -1
        mean += sign[..., None] * corner
    if (signs < 0).any():
        return signs
    return None


def weighted_axis(vectors: Floats, weights: Floats) -> Floats:
    """Return the weighted mean of vectors (N, C), each reversed if it opposes the first."""
    signs = np.where(vectors @ vectors[0] < 0, -1.0, 1.0)
    return np.asarray((weights * signs) @ vectors)


def products(vectors: Floats) -> Floats:
    """Return outer products of vectors, over their length, whose means are sign-free."""
    length = np.linalg.norm(vectors, axis=-1)[..., None, None]
    product = vectors[..., :, None] * vectors[..., None, :]
    product = np.divide(product, length, out=np.zeros_like(product), where=length != 0)
    return np.asarray(product.reshape(*vectors.shape[:-1], -1))


def axes(means: Floats) -> Floats:
    """Return the longest axes (..., C) of means (..., C * C) of :func:`products`."""
    finite = np.asarray(np.isfinite(means).all(axis=-1))
    size = round(means.shape[-1] ** 0.5)
    safe = np.where(finite[..., None], means, 0.0).reshape(*means.shape[:-1], size, size)
    lengths, directions = np.linalg.eigh(safe)
    longest = directions[..., -1] * lengths[..., -1:]
    return np.where(finite[..., None], longest, np.nan)


def _sign(products: Floats) -> Floats:
    """Return signs of the sums along the last axis, (..., 1)."""
    with np.errstate(invalid="ignore"):
        return np.where(np.sum(products, axis=-1, keepdims=True) < 0, -1.0, 1.0)


def neighbour_pairs(shape: tuple[int, ...], periodic: tuple[bool, bool]) -> Indices:
    """Return pairs of neighbouring nodes, (E, 2), counted row by row."""
    number = np.arange(np.prod(shape)).reshape(shape)
    pairs = [(number[:, :-1], number[:, 1:]), (number[:-1], number[1:])]
    pairs += [(number[:, :1], number[:, -1:])] * periodic[1]
    pairs += [(number[:1], number[-1:])] * periodic[0]
    flat_pairs = [np.stack([first.ravel(), second.ravel()], axis=1) for first, second in pairs]
    return np.concatenate(flat_pairs)


def _tree(graph: scipy.sparse.csr_array, valid: Bools) -> Indices:
    """Return the parent of each node, from which it takes its direction; roots are their own."""
    _, part = scipy.sparse.csgraph.connected_components(graph, directed=False)
    rows, columns = valid.shape
    j, i = np.divmod(np.arange(valid.size), columns)
    aside = np.hypot(j - (rows - 1) / 2, i - (columns - 1) / 2)
    order = np.lexsort((aside, part))
    firsts = order[np.unique(part[order], return_index=True)[1]]
    firsts = firsts[valid.ravel()[firsts]]
    _, parent, _ = scipy.sparse.csgraph.dijkstra(
        graph, directed=False, indices=firsts, return_predecessors=True, min_only=True
    )
    itself = np.arange(valid.size)
    return np.where(parent < 0, itself, parent).astype(np.intp)
