"""Arguments of a field on triangles as its arrays, without parts that cannot be drawn."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError, notify, raise_faults
from flowtex.field.checked_nodes import CheckedNodes
from flowtex.field.field_arrays import TriangleArrays
from flowtex.field.steps import LazySteps, Steps, first_step, map_steps
from flowtex.field.triangles.triangle_nodes import (
    edges_of,
    known_means,
    merged_nodes,
    needle_edges,
    repeated,
    solid_normals,
    solid_triangles,
    sums_at,
    touching,
    uneven_nodes,
)
from flowtex.field.triangles.triangle_surface import TriangleSurface
from flowtex.field.validation import (
    Checked,
    as_numbers,
    cell_faults,
    finite_nodes,
    nodal_faults,
    range_faults,
    scalar_steps,
    three_components,
    with_gaps,
)

#: Parts of :func:`triangle_nodes`, of which each takes a second for some million triangles.
READING_PARTS = 4


def triangle_nodes(
    arrays: TriangleArrays, own: Checked, *, on_globe: bool
) -> Generator[None, None, CheckedNodes]:
    """Check the arrays of triangles, whose nodes become a row, (1, N).

    It yields before each of the :data:`READING_PARTS`, so that they can be shown and cancelled.
    Nodes at one place are joined, but at sharp edges each face has its own; parts that cannot be
    drawn are left out. The arrays are described at :meth:`flowtex.FlowField.from_triangles`;
    ``own`` has the velocity and the scalars without gaps.

    Raises
    ------
    FieldError
        When shapes or types do not fit together, values exceed the range of computations, or no
        triangle has three nodes with data. The error lists all faults of the arrays.
    """
    yield
    p, masked_points = as_numbers("points", arrays.points)
    v, masked = as_numbers("velocity", first_step(own.velocity))
    corners = _corners_of(arrays.triangles)
    mask = _mask_of(arrays.valid)
    at_nodes = _first_values("scalars", own.scalars)
    on_cells = _first_values("cell_scalars", arrays.cell_scalars)
    count = _step_count(own.velocity, v)
    faults = _faults(p, corners, v, count, own.times, mask, at_nodes)
    raise_faults(faults or cell_faults((len(corners),), count, on_cells, own.scalars))
    p = three_components(p)
    v = three_components(v)
    v = v.reshape(-1, 1, len(p), 3)
    ok: Bools = finite_nodes(p[None])[0] & ~masked_points & finite_nodes(v)[0] & ~masked
    if mask is not None:
        ok = ok & mask
    if not ok.all():
        v = np.where(ok[:, None], v, np.nan)
    raise_faults(range_faults(p[None], v, ok[None]))
    steps: Steps = v
    if isinstance(own.velocity, LazySteps):
        steps = own.velocity.map(partial(_row, ok))
    data = _rows(own.scalars, at_nodes, len(p))
    yield
    drawn, pairs, crosses = _usable(p, corners.astype(np.intp, copy=False))
    solid = _rows_of(corners, drawn)
    _check_any_usable(ok, solid)
    yield
    placed = _placed(_known(p, ok), solid, crosses, pairs, ok, on_globe=on_globe)
    yield
    surface = placed.surface
    drawn = drawn[placed.kept]
    if not placed.unchanged:
        steps = placed.means(steps)
        data = {name: placed.means(nodal) for name, nodal in data.items()}
    steps = map_steps(steps, partial(_at_rest, ~surface.valid[0]))
    data |= _rows(arrays.cell_scalars, on_cells, len(corners), drawn)
    return CheckedNodes(surface, steps, data, triangles=surface.triangles)


def _mask_of(valid: ArrayLike | None) -> Bools | None:
    """Return the mask of nodes with data, which may have another shape than (N,)."""
    if valid is None:
        return None
    return np.asarray(np.nan_to_num(with_gaps("valid", valid)) != 0)


def _step_count(velocity: Any, values: Floats) -> int:
    """Return the number of steps of a velocity, whose first or all ``values`` are known."""
    if values.ndim == 3 or isinstance(velocity, LazySteps):
        return len(velocity)
    return 1


def _corners_of(triangles: ArrayLike) -> AnyArray:
    """Return triangles as an array, which may have another shape than (M, 3)."""
    try:
        return np.asarray(triangles)
    except ValueError as error:
        raise FieldError(
            f"triangles is not an array ({error}); expected three node numbers in every row"
        ) from error


def _known(p: Floats, ok: Bools) -> Floats:
    """Return a copy of positions (N, 3); unknown ones must not take part in computations."""
    finite = finite_nodes(p[None])[0]
    if finite.all():
        return p.copy()
    return np.where(finite[:, None], p, np.mean(p[ok], axis=0))


def _check_any_usable(ok: Bools, corners: Indices) -> None:
    """Check that some triangle (M, 3) has three usable nodes."""
    if ok.all() and len(corners):
        return
    if not np.logical_and.reduce(ok.take(corners.T)).any():
        raise FieldError(
            f"{int(ok.sum())} of {ok.size} nodes are usable, but no triangle has three of them; "
            "check the triangles and the mask"
        )


def _rows(
    scalars: Mapping[str, Any], arrays: Mapping[str, Floats], count: int, at: Any = slice(None)
) -> dict[str, Any]:
    """Return scalars at some of ``count`` nodes or triangles as a row, (T or 1, 1, n).

    ``arrays`` have their values, of scalars that are read later only the first step.
    """
    rows: dict[str, Any] = {}
    for name, values in arrays.items():
        late = scalars[name]
        if isinstance(late, LazySteps):
            rows[name] = late.map(partial(_as_row, at=at))
        else:
            rows[name] = scalar_steps(values, (1, count))[..., at]
    return rows


def _first_values(argument: str, scalars: Mapping[str, Any]) -> dict[str, Floats]:
    """Return the values of scalars, of those that are read later the first step."""
    values = {}
    for name, steps in scalars.items():
        values[name] = with_gaps(f"{argument}[{name!r}]", first_step(steps))
    return values


@dataclass(frozen=True, eq=False)
class _Placed:
    """A surface whose nodes have the means of the given ones at their places, in their faces."""

    surface: TriangleSurface
    kept: Bools  #: Triangles that have an area with these nodes, (M,).
    given: Indices  #: Numbers of given nodes, (n,), in the order of those that they belong to.
    node: Indices  #: The node of the surface that each of them belongs to, (n,).
    unchanged: bool  #: Whether all given nodes are those of the surface.

    def means(self, steps: Steps) -> Steps:
        """Return means (1, N, ...) of the steps of given nodes."""
        summed = partial(sums_at, self.node, count=self.surface.shape[1], of=self.given)
        return map_steps(steps, partial(_row_means, summed=summed))


def _rows_of(corners: Indices, chosen: Indices) -> Indices:
    """Return some triangles (m, 3) by their numbers (m,), without a copy if these are all."""
    if len(chosen) < len(corners):
        corners = corners[chosen]
    return corners.astype(np.intp, copy=False)


def _row_means(step: Floats, summed: Callable[[Floats], Floats]) -> Floats:
    """Return :func:`known_means` of a row of nodes, (1, N, ...)."""
    return known_means(step[0], summed)[None]


def _placed(
    p: Floats, corners: Indices, crosses: Floats, pairs: Indices, ok: Bools, *, on_globe: bool
) -> _Placed:
    """Join given nodes (N,) at one place, and pairs of them, unless they belong to two faces."""
    uneven = uneven_nodes(corners, len(p))
    same = merged_nodes(p, corners, uneven, pairs)
    is_joined = same != np.arange(len(p))
    kept = np.ones(len(corners), dtype=bool)
    used = corners
    if is_joined.any():
        kept = ~touching(corners, is_joined)
        kept[~kept] = solid_triangles(p, same[corners[~kept]])
        corners = _rows_of(corners, np.flatnonzero(kept))
        used = same[corners]
    is_used = np.zeros(len(p), dtype=bool)
    is_used[used] = True
    if is_used.all() and not is_joined.any():
        number = given = np.arange(len(p))
        valid = ok
    else:
        number = np.where(is_used, np.cumsum(is_used) - 1, -1)[same]
        given = np.flatnonzero(number >= 0)
        valid = np.bincount(number[given], ok[given]) > 0
    if is_used.all():
        joined = TriangleSurface(p[None], corners.copy(), valid[None], on_globe=on_globe)
        joined.__dict__["uneven"] = uneven
    else:
        points = p[is_used][None]
        joined = TriangleSurface(points, number[corners], valid[None], on_globe=on_globe)
    joined.__dict__["places"] = np.arange(joined.shape[1])
    if kept.all() and not is_joined.any():
        joined.__dict__["own_crosses"] = crosses
    surface, origin = joined.with_faces()
    unchanged = bool(is_used.all()) and surface is joined
    if surface is joined:
        return _Placed(surface, kept, given, number[given], unchanged)
    is_split = (np.bincount(origin) > 1)[origin]
    given = given[~is_split[number[given]]]
    faced = is_split[surface.triangles]
    own = np.unique(np.stack([surface.triangles[faced], corners[faced]], axis=-1), axis=0)
    given, node = np.append(given, own[:, 1]), np.append(number[given], own[:, 0])
    surface.valid = np.bincount(node, ok[given])[None] > 0
    return _Placed(surface, kept, given, node, unchanged)


def _as_row(step: Floats, at: Any = slice(None)) -> Floats:
    """Return some values of a step, (N, ...), as a row of nodes, (1, N, ...)."""
    return step[None, at]


def _at_rest(unused: Bools, step: Floats) -> Floats:
    """Return a step, (1, N, 3), that is zero at nodes that are not in use."""
    if not unused.any():
        return step.copy()
    return np.where(unused[:, None], 0.0, step)


def _row(ok: Bools, step: Floats) -> Floats:
    """Return a step (1, N, 3) of (N, 2 or 3): nodes that are not in use have NaN."""
    step = np.where(np.isfinite(step).all(axis=-1, keepdims=True), step, 0.0)
    return np.where(ok[:, None], three_components(step), np.nan)[None]


def _faults(
    p: Floats,
    corners: Any,
    v: Floats,
    steps: int,
    times: Floats | None,
    valid: Any,
    scalars: Mapping[str, Floats],
) -> list[str]:
    """Return faults in the shapes of arrays on triangles."""
    if p.ndim != 2 or p.shape[-1] not in (2, 3) or not len(p):
        return [f"points has shape {p.shape}; expected (N, 2) or (N, 3), one row for each node"]
    faults = []
    count = len(p)
    if corners.ndim != 2 or corners.shape[-1] != 3 or corners.dtype.kind not in "iu":
        faults.append(
            f"triangles has shape {corners.shape} and type {corners.dtype}; expected whole "
            "numbers of shape (M, 3): the nodes at the corners of each triangle"
        )
    elif not len(corners):
        faults.append("triangles is empty; expected node numbers of shape (M, 3)")
    elif corners.min() < 0 or corners.max() >= count:
        wrong = int(corners.min())
        if wrong >= 0:
            wrong = int(corners.max())
        faults.append(f"triangles has node {wrong}; expected 0 to {count - 1}, the rows of points")
    return faults + nodal_faults((count,), v, steps, times, valid, scalars)


def _usable(p: Floats, corners: Indices) -> tuple[Indices, Indices, Floats]:
    """Return numbers (m,) of solid triangles, each once, and normals (m, 3) as long as their areas.

    Between them are the pairs of nodes (n, 2) that needles join.
    """
    finite = finite_nodes(p[None])[0]
    if finite.all():
        placed = np.ones(len(corners), bool)
    else:
        placed = finite[corners].all(axis=1)
    good = placed.copy()
    good[placed], crosses = solid_normals(p, _rows_of(corners, np.flatnonzero(placed)))
    once = ~repeated(corners)
    flat = corners[placed & ~good]
    is_point = needle_edges(p, flat)
    reasons = []
    for is_left_out, reason in (
        (~is_point.any(axis=1), "without area"),
        (good & ~once, "there twice"),
        (~placed, "at points that are not finite"),
    ):
        if is_left_out.any():
            reasons.append(f"{np.count_nonzero(is_left_out):,} {reason}")
    if reasons:
        notify(f"triangles are left out: {', '.join(reasons)}", UserWarning)
    usable = good & once
    if not usable.all():
        crosses = crosses[usable[placed]]
    return np.flatnonzero(usable), edges_of(flat)[is_point], crosses
