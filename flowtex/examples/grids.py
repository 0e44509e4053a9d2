"""Example flows as meshes of PyVista."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import checked_number
from flowtex.errors import require_pyvista
from flowtex.field import FlowField

if TYPE_CHECKING:
    import pyvista as pv
from flowtex.examples.analytic import EPSILON, gyre_nodes
from flowtex.examples.fields import (
    airfoil_field,
    cylinder_field,
    delta_wing_field,
    double_gyre_at,
    double_gyre_field,
    vortex_field,
)


def double_gyre(time: float = 0.0) -> pv.StructuredGrid:
    """Return the double gyre at one time of its period of 10.

    Parameters
    ----------
    time : float, default: 0.0
        Any time; at 0 the two gyres have the same size, as in the steady flow.

    Returns
    -------
    pyvista.StructuredGrid
        201 x 101 x 1 nodes on [0, 2] x [0, 1] with arrays ``velocity`` and ``vorticity``.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.double_gyre(time=2.5)["velocity"].shape
    (20301, 3)
    """
    most = sys.float_info.max
    time = checked_number("time", time, -most, most, expected="a finite number such as 2.5")
    return to_grid(double_gyre_at(np.array([time]), gyre_nodes((101, 201)), EPSILON))


def double_gyre_series() -> list[pv.StructuredGrid]:
    """Return one period of :func:`~flowtex.examples.double_gyre`, 41 times from 0 to 10.

    Returns
    -------
    list of pyvista.StructuredGrid

    Examples
    --------
    >>> import flowtex
    >>> float(flowtex.examples.double_gyre_series()[-1].field_data["TimeValue"][0])
    10.0
    """
    return to_series(double_gyre_field(time_varying=True))


def to_grid(field: FlowField, step: int = -1) -> pv.StructuredGrid:
    """Return one time step of a field as a mesh.

    Parameters
    ----------
    field : FlowField
        Surface and velocity.
    step : int, default: -1
        Index of the time step; the last by default.

    Returns
    -------
    pyvista.StructuredGrid
        I x J x 1 nodes with the point array ``velocity``, the field's scalars, and the field
        data ``TimeValue`` if the field is time-varying. Nodes without data are hidden.

    Examples
    --------
    >>> import flowtex
    >>> field = flowtex.examples.cylinder_field()
    >>> flowtex.examples.to_grid(field, step=0).save("first.vts")
    """
    require_pyvista("a mesh")
    import pyvista as pv

    rows, columns = field.shape
    grid = pv.StructuredGrid()
    grid.points = field.points.reshape(-1, 3)
    grid.dimensions = (columns, rows, 1)
    grid.point_data["velocity"] = field.velocity[step].reshape(-1, 3)
    for name, values in field.scalars.items():
        step_values = values[step if len(values) > 1 else 0]
        if name in field.on_cells:
            grid.cell_data[name] = step_values[:-1, :-1].ravel()
        else:
            grid.point_data[name] = step_values.ravel()
    if not field.steady:
        grid.field_data["TimeValue"] = np.array([field.times[step]])
    if not field.valid.all():
        grid.hide_points((~field.valid).ravel().tolist())
    return grid


def to_series(field: FlowField) -> list[pv.StructuredGrid]:
    """Return every time step of a field, each as from :func:`~flowtex.examples.to_grid`.

    Returns
    -------
    list of pyvista.StructuredGrid

    Examples
    --------
    >>> import flowtex
    >>> len(flowtex.examples.to_series(flowtex.examples.cylinder_field()))
    31
    """
    return [to_grid(field, step) for step in range(len(field.times))]


_DOC = """Return {times} of :func:`~flowtex.examples.{field}`, {form}.

Returns
-------
pyvista.StructuredGrid or list of pyvista.StructuredGrid

Examples
--------
>>> import flowtex
>>> made = flowtex.examples.{name}()
"""


def _made(field: Callable[..., FlowField], convert: Callable[[FlowField], Any]) -> Any:
    """Return the function of an example that converts its field to meshes."""

    def make() -> Any:
        return convert(field())

    times = "the last time"
    form = "as from :func:`~flowtex.examples.to_grid`"
    suffix = ""
    if convert is to_series:
        times = "all times"
        form = "as from :func:`~flowtex.examples.to_series`"
        suffix = "_series"
    make.__name__ = make.__qualname__ = name = field.__name__.replace("_field", suffix)
    make.__doc__ = _DOC.format(times=times, field=field.__name__, form=form, name=name)
    return make


cylinder: Callable[[], pv.StructuredGrid] = _made(cylinder_field, to_grid)
cylinder_series: Callable[[], list[pv.StructuredGrid]] = _made(cylinder_field, to_series)
vortex: Callable[[], pv.StructuredGrid] = _made(vortex_field, to_grid)
vortex_series: Callable[[], list[pv.StructuredGrid]] = _made(vortex_field, to_series)
airfoil: Callable[[], pv.StructuredGrid] = _made(airfoil_field, to_grid)
delta_wing: Callable[[], pv.StructuredGrid] = _made(delta_wing_field, to_grid)
