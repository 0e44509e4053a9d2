"""Planes of nodes through several structured volumes, such as the zones of CGNS and PLOT3D."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import FieldError
from flowtex.sources.meshes import vectors, volume
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import pyvista as pv

#: Name of an array that is 1 at shown points; flags would be averaged where zones meet.
SHOWN_POINTS = "IBlank"
#: Flag of VTK's ghost array for hidden cells.
HIDDEN_CELL = 32


def planes_of(zones: dict[str, Any], plane: str, record: Record) -> dict[str, pv.DataSet]:
    """Return the same plane of each zone as a structured surface, by the names of the zones.

    Zones that are too small for it are left out.

    Raises
    ------
    FieldError
        When no zone has the plane.
    """
    found: dict[str, pv.DataSet] = {}
    fault: FieldError | None = None
    lacking = []
    for name, zone in zones.items():
        try:
            chosen = volume.find_plane(zone, plane, Record())
        except FieldError as error:
            fault = fault or error
            lacking.append(name)
            continue
        found[name] = _surface(zone, chosen)
    if not found and fault is not None:
        raise fault
    record("select", f"plane {plane} of {', '.join(found)}")
    if lacking:
        text = f"{', '.join(lacking)} has no plane {plane}, and is not drawn"
        record("select", text, notable=True)
    return found


def _surface(zone: Any, plane: volume.Plane) -> pv.StructuredGrid:
    """Return a plane of a zone with its arrays; those of cells are means of both sides."""
    import pyvista as pv

    points = volume.plane_positions(zone, plane)
    rows, columns = points.shape[:2]
    surface = pv.StructuredGrid()
    surface.points = points.reshape(-1, 3)
    surface.dimensions = (columns, rows, 1)
    visible = plane.cells(vectors.visible_cells(zone))
    for array in vectors.catalogue(zone):
        if not array.numeric or array.parts or array.name in vectors.BLANKING:
            continue
        values = vectors.values_of(zone, array)
        if array.where == "points":
            whole = plane.nodes(values)
            surface.point_data[array.name] = whole.reshape(rows * columns, *whole.shape[2:])
        else:
            mean = _mean(plane.cells(values).astype(np.float64), visible)
            surface.cell_data[array.name] = mean.reshape(-1, *mean.shape[2:])
    hidden = plane.nodes(vectors.hidden_nodes(zone)).ravel()
    if hidden.any():
        surface.point_data[SHOWN_POINTS] = (~hidden).astype(np.int32)
    shown = visible.any(axis=0).ravel()
    if not shown.all():
        surface.cell_data["vtkGhostType"] = (~shown).astype(np.uint8) * HIDDEN_CELL
    return surface


def _mean(layers: Floats, visible: AnyArray) -> Floats:
    """Return the mean of the visible ones of one or two layers of cells, (J, I, ...)."""
    seen = visible.reshape(*visible.shape, *[1] * (layers.ndim - 3))
    count = np.maximum(seen.sum(axis=0), 1)
    return np.asarray(np.where(seen, layers, 0.0).sum(axis=0) / count)
