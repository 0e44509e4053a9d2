"""From a field to the meshes that PyVista users hold: one mesh for each instant."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flowtex.field import FlowField

if TYPE_CHECKING:
    import pyvista as pv

__all__ = ["to_grid", "to_series"]


def to_grid(field: FlowField, step: int = -1) -> pv.StructuredGrid:
    """One instant of a field as a mesh.

    Parameters
    ----------
    field : FlowField
        Surface and velocity.
    step : int, default: -1
        Which instant; the default is the last.

    Returns
    -------
    pyvista.StructuredGrid
        I x J x 1 nodes with the point array ``velocity``, the field's scalars, and the field
        data ``TimeValue`` where the field varies in time. Nodes without data are hidden.
    """
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
    """Every instant of a field as a mesh.

    Parameters
    ----------
    field : FlowField
        Surface and velocity.

    Returns
    -------
    list of pyvista.StructuredGrid
        In order of time, each as from :func:`to_grid`.
    """
    return [to_grid(field, step) for step in range(len(field.times))]
