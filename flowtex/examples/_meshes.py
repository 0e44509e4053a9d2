"""The examples as PyVista meshes, one for each instant."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.arguments import checked_number
from flowtex._util.extras import require_pyvista
from flowtex.examples._double_gyre import EPSILON, nodes
from flowtex.examples._fields import (
    airfoil_field,
    cylinder_field,
    delta_wing_field,
    double_gyre_at,
    double_gyre_field,
    liquid_oxygen_post_field,
    vortex_field,
)
from flowtex.field import FlowField

if TYPE_CHECKING:
    import pyvista as pv


def _mesh(make: Callable[[], FlowField], nodes: int) -> Callable[[], pv.StructuredGrid]:
    """Return the function that makes the mesh of an example, with this many nodes."""
    name = make.__name__.removesuffix("_field")

    def mesh() -> pv.StructuredGrid:
        return to_grid(make())

    mesh.__name__ = mesh.__qualname__ = name
    mesh.__doc__ = f"""Return the flow of :func:`~flowtex.examples.{name}_field`, at its last time.

    Returns
    -------
    pyvista.StructuredGrid
        The nodes with the point array ``velocity`` and the scalar of the field, and the field data
        ``TimeValue`` if the flow varies in time.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.{name}().n_points
    {nodes}
    """
    return mesh


def _series(make: Callable[[], FlowField], times: int) -> Callable[[], list[pv.StructuredGrid]]:
    """Return the function that makes the meshes of an example at all of this many times."""
    name = make.__name__.removesuffix("_field")

    def series() -> list[pv.StructuredGrid]:
        return to_series(make())

    series.__name__ = series.__qualname__ = f"{name}_series"
    series.__doc__ = f"""Return the flow of :func:`~flowtex.examples.{name}_field` at all times.

    Returns
    -------
    list of pyvista.StructuredGrid
        One for each time, as from :func:`~flowtex.examples.{name}`.

    Examples
    --------
    >>> import flowtex
    >>> len(flowtex.examples.{name}_series())
    {times}
    """
    return series


cylinder, cylinder_series = _mesh(cylinder_field, 10_465), _series(cylinder_field, 31)
vortex, vortex_series = _mesh(vortex_field, 10_000), _series(vortex_field, 31)
airfoil, delta_wing = _mesh(airfoil_field, 12_545), _mesh(delta_wing_field, 3_224)


def double_gyre(time: float = 0.0) -> pv.StructuredGrid:
    """Return the double gyre at one time of its period of 10.

    Parameters
    ----------
    time : float, default: 0.0
        Any time; at 0 the two gyres have the same size, as in the steady flow.

    Returns
    -------
    pyvista.StructuredGrid
        201 x 101 x 1 nodes on [0, 2] x [0, 1], with point arrays ``velocity`` and
        ``vorticity``.

    Raises
    ------
    FieldError
        When the time is not a finite number.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.double_gyre(time=2.5)["velocity"].shape
    (20301, 3)
    """
    most = sys.float_info.max
    time = checked_number("time", time, -most, most, expected="a finite number such as 2.5")
    return to_grid(double_gyre_at(np.array([time]), nodes((101, 201)), EPSILON))


def double_gyre_series() -> list[pv.StructuredGrid]:
    """Return one period of the double gyre.

    Returns
    -------
    list of pyvista.StructuredGrid
        41 times, as from :func:`~flowtex.examples.double_gyre`, with ``TimeValue`` from 0 to 10.

    Examples
    --------
    >>> import flowtex
    >>> float(flowtex.examples.double_gyre_series()[-1].field_data["TimeValue"][0])
    10.0
    """
    return to_series(double_gyre_field(time_varying=True))


def liquid_oxygen_post(folder: str | Path | None = None, plane: str = "k=20") -> pv.StructuredGrid:
    """Return the flow around NASA's liquid-oxygen post on one plane.

    Returns
    -------
    pyvista.StructuredGrid
        The nodes of the plane, with the point array ``velocity`` and the scalars of the file.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.examples.liquid_oxygen_post("~/data", plane="j=10")  # doctest: +SKIP
    """
    return to_grid(liquid_oxygen_post_field(folder, plane))


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
        grid.point_data[name] = values[step if len(values) > 1 else 0].ravel()
    if not field.steady:
        grid.field_data["TimeValue"] = np.array([field.times[step]])
    if not field.valid.all():
        grid.hide_points((~field.valid).ravel().tolist())
    return grid


def to_series(field: FlowField) -> list[pv.StructuredGrid]:
    """Return every time step of a field as a mesh.

    Returns
    -------
    list of pyvista.StructuredGrid
        In order of time, each as from :func:`~flowtex.examples.to_grid`.

    Examples
    --------
    >>> import flowtex
    >>> len(flowtex.examples.to_series(flowtex.examples.cylinder_field()))
    31
    """
    return [to_grid(field, step) for step in range(len(field.times))]
