"""The uncertainty of the direction of a flow: where it is high, streaks are shorter and fainter.

It is a scalar of the field: the standard deviation of the velocity over its magnitude. From 1 on
no direction is drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from operator import itemgetter
from typing import Any

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import Floats
from flowtex._util.arrays import norm
from flowtex.errors import FieldError
from flowtex.field.field_data import Data, FieldData
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.interpolation import fill_blanked
from flowtex.field.steps import LazySteps, Steps, map_steps
from flowtex.field.triangles.triangle_nodes import nodal_means

CORNERS = ((0, 0), (0, 1), (1, 0), (1, 1))  #: Offsets of the cells around a node.
UNCERTAINTY = "uncertainty"  #: Name of the scalar of an uncertainty that is an array.


def spread_name(dim: str) -> str:
    """Return the name of the scalar that has the spread over a dimension."""
    return f"spread over {dim}"


def with_uncertainty(field: Data, value: Any) -> Data:
    """Return a field whose streaks show the uncertainty of its direction.

    ``value`` is the name of a scalar of the field, averaged to the nodes if it is on cells; or of
    the dimension over which a dataset was averaged; or an array, (J, I) or (T, J, I), on triangles
    (N,) or (T, N): the standard deviation of the velocity over its magnitude; or ``None``.

    Raises
    ------
    FieldError
        When the field has no such scalar, the array has another shape, or a value is negative.
    """
    if value is None:
        return field
    scalars: Mapping[str, Steps] = field.scalars
    if not isinstance(value, str):
        steps = nodal_steps(field, value, "uncertainty", "the name of a scalar, or ")
        scalars = {**scalars, UNCERTAINTY: steps}
        value = UNCERTAINTY
    if value not in scalars and spread_name(value) in scalars:
        value = spread_name(value)
    if value not in scalars:
        raise FieldError(
            f"uncertainty is {value!r}, which is not a scalar; {near_names(value, scalars)}"
        )
    steps = scalars[value]
    on_cells = tuple(name for name in field.on_cells if name != value)
    if value in field.on_cells:
        steps = _at_nodes(field, steps)
        scalars = {**scalars, value: steps}
    if not isinstance(steps, LazySteps) and (least := np.min(steps, initial=0, where=steps < 0)):
        raise FieldError(
            f"uncertainty is {least:g} at a node; expected 0 where the direction is known, up to 1 "
            "where it is not, such as a standard deviation over the speed"
        )
    return field.same_flow(scalars=scalars, uncertainty=value, on_cells=on_cells)


def nodal_steps(field: FieldData, value: Any, name: str, other: str = "") -> Floats:
    """Return an array of an argument as nodal values of a field, (T or 1, J, I).

    Parameters
    ----------
    field
        The field.
    value
        Numbers, (J, I), (T, J, I), or with the nodes in one axis, (N,) or (T, N).
    name
        Name of the argument, for the error.
    other
        What else the argument accepts, for the error; ends with ``"or "``.

    Raises
    ------
    FieldError
        When the value is not numeric, or has another shape.
    """
    nodes = int(np.prod(field.shape))
    shapes: set[tuple[int, ...]] = {field.shape, (nodes,)}
    for count in (1, len(field.times)):
        shapes |= {(count, *field.shape), (count, nodes)}
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    # Another shape with as many values, such as one with exchanged axes, is no order of the nodes.
    if array.shape not in shapes:
        shape: Any = np.shape(value)
        if isinstance(value, (bool, dict)):
            shape = repr(value)
        raise FieldError(
            f"{name} is {shape}; expected {other}an array of the shape {field.shape}, or "
            f"{(len(field.times), *field.shape)}"
        )
    return array.reshape(-1, *field.shape)


def _at_nodes(field: FieldData, steps: Steps) -> Steps:
    """Return means at the nodes, (T, J, I), of values that belong to cells."""
    surface = field.surface
    if isinstance(surface, GridSurface):
        return map_steps(steps, _corner_means)
    areas = norm(surface.crosses)
    count = field.shape[1]
    flat = map_steps(steps, itemgetter(0))
    return map_steps(nodal_means(flat, surface.triangles, areas, count), itemgetter(None))


def _corner_means(step: Floats) -> Floats:
    """Return means at the nodes of values at cells, (J, I), each at its first node."""
    cells = np.pad(step[:-1, :-1], 1, constant_values=np.nan)
    around = []
    for j, i in CORNERS:
        around.append(cells[j : j + len(step), i : i + step.shape[1]])
    return np.asarray(np.ma.masked_invalid(around).mean(axis=0).filled(np.nan))


def unknown_share(field: FieldData, step: int) -> Floats:
    """Return the uncertainty of the direction at a step, (J, I) from 0 to 1."""
    steps = field.scalars[field.uncertainty]
    if len(steps) == 1:
        step = 0
    values = np.asarray(steps[step], dtype=float)
    share = np.clip(np.nan_to_num(values, nan=1.0, posinf=1.0), 0.0, 1.0)
    return fill_blanked(share, field.valid)
