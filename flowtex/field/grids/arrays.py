"""Arguments of a field on a structured surface as its arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError, raise_faults
from flowtex.field.grids.periodic import NodalArrays, close_axes
from flowtex.field.grids.signs import oriented, sign_free_faults, with_equal_ends
from flowtex.field.grids.surface import GridSurface, known_positions
from flowtex.field.steps import LazySteps, Steps, first_step
from flowtex.field.validation import (
    as_numbers,
    cell_faults,
    finite_nodes,
    node_faults,
    node_positions,
    range_faults,
    scalar_steps,
    shape_faults,
    three_components,
    with_gaps,
)


@dataclass(frozen=True, eq=False)
class GridNodes:
    """Nodes that make a field, their geometry, and if any ``moves`` at a time in memory."""

    surface: GridSurface
    velocity: Steps
    valid: Bools
    periodic: tuple[bool, bool]
    scalars: dict[str, Steps]
    moves: bool


def grid_nodes(
    points: ArrayLike,
    velocity: Any,
    times: Floats | None,
    valid: ArrayLike | None,
    periodic: str | None,
    scalars: Mapping[str, Any],
    cell_scalars: Mapping[str, Any],
    *,
    sign_free: bool,
    on_globe: bool,
) -> GridNodes:
    """Check arrays, and convert them for a field; of late steps the first is read."""
    if not isinstance(scalars, Mapping):
        msg = f"scalars is a {type(scalars).__name__}; expected a mapping of arrays by name"
        raise FieldError(msg)
    p, masked_points = as_numbers("points", node_positions(points))
    v, masked_velocity = as_numbers("velocity", first_step(velocity))
    late = {name: steps for name, steps in scalars.items() if isinstance(steps, LazySteps)}
    in_memory = {k: with_gaps(f"scalars[{k!r}]", s) for k, s in scalars.items() if k not in late}
    on_cells = {k: with_gaps(f"cell_scalars[{k!r}]", s) for k, s in cell_scalars.items()}
    mask = None if valid is None else with_gaps("valid", valid)
    count = len(velocity) if isinstance(velocity, LazySteps) or v.ndim == 4 else 1
    faults = shape_faults(p, v, count, times, mask, periodic, in_memory)
    cells = tuple(max(n - 1, 0) for n in p.shape[:2])
    faults = faults or cell_faults(cells, count, on_cells, scalars)
    raise_faults(faults + (sign_free_faults(v) if sign_free else []))
    v = v[None] if v.ndim == 3 else v
    # Arguments are copied once, and not changed.
    p, v = (three_components(a) if a.shape[-1] == 2 else a.copy("C") for a in (p, v))
    ok = finite_nodes(p) & ~masked_points
    ok &= finite_nodes(v) & ~masked_velocity
    if mask is not None:
        ok &= np.nan_to_num(mask) != 0
    # Fill values must not take part in computations.
    v[:, ~ok] = np.nan
    raise_faults(range_faults(p, v, ok) or node_faults(p, ok))
    p[~known_positions(p, ok)] = np.nan
    v = with_equal_ends(v) if sign_free else v
    data = {key: scalar_steps(values, p.shape[:2]) for key, values in in_memory.items()}
    for key, values in on_cells.items():
        ends = ((0, 0), (0, 1), (0, 1))
        data[key] = np.pad(scalar_steps(values, cells), ends, constant_values=np.nan)
    nodal, closed = close_axes(NodalArrays(p, v, ok, data), periodic)
    v, ok = nodal.velocity, nodal.valid
    surface = GridSurface(nodal.points, ok, closed, on_globe=on_globe)
    if sign_free:
        v = oriented(np.where(ok[..., None], v[0], 0.0), ok, closed)
        v = with_equal_ends(v[None], closed, surface.poles)
    v[:, ~ok] = 0.0
    appended = [n - m for n, m in zip(ok.shape, p.shape[:2], strict=True)]

    def closed_as_nodes(step: Floats) -> Floats:
        for axis, lines in enumerate(appended):
            if lines:
                step = np.concatenate([step, np.take(step, [0], axis=axis)], axis=axis)
        return step

    def moving(step: Floats) -> Floats:
        step = closed_as_nodes(three_components(step))
        return np.where((ok & finite_nodes(step))[..., None], step, 0.0)

    steps = velocity.map(moving) if isinstance(velocity, LazySteps) else v
    read = {name: scalar.map(closed_as_nodes) for name, scalar in late.items()}
    ordered = {name: {**nodal.scalars, **read}[name] for name in (*scalars, *on_cells)}
    return GridNodes(surface, steps, ok, closed, ordered, bool(v.any()))
