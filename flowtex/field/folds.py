"""Structured surfaces that are folded: their cells turn sharply along lines of nodes.

A node of a fold has one tangent plane, between both faces, so that velocities and speeds of the
faces would mix over one cell. As triangles, each face has nodes of its own there.
"""

from __future__ import annotations

from functools import partial

from flowtex._util.array_types import Floats, Indices
from flowtex.field.field_arrays import TriangleArrays
from flowtex.field.field_data import FieldData
from flowtex.field.finer import finest_of
from flowtex.field.grids.grid_surface import GridSurface
from flowtex.field.steps import map_steps
from flowtex.field.triangles.triangle_nodes import repeated, solid_triangles

#: Most nodes of a grid that becomes triangles; larger ones are drawn in tiles of a grid.
MOST_NODES = 1_000_000
#: Attributes of a field that its nodes do not change.
TEXTS = (
    "name",
    "length_unit",
    "time_unit",
    "units",
    "long_names",
    "start",
    "section",
    "reading",
    "velocity_unit",
    "volume_values",
    "vectors",
)
#: What a picture of a grid with folds lacks.
FOLDED = (
    "cells of this grid turn by 35 degrees or more, and the values of both sides mix over one cell "
    "there; expected triangles, as FlowField.from_pyvista makes of a StructuredGrid of up to "
    f"{MOST_NODES:,} nodes, or FlowField.from_triangles"
)

#: How a folded mesh is drawn by what needs a grid.
ROWS_OF_FOLDS = (
    "A StructuredGrid that is folded is read as triangles; "
    "FlowField.from_arrays(points, velocity) keeps its rows and columns"
)


def mixes_at_folds(field: FieldData) -> bool:
    """Return whether a field on a grid mixes the values of faces at folds."""
    surface = field.surface
    if not isinstance(surface, GridSurface) or field.projection is not None:
        return False
    return finest_of(field) is None and surface.is_folded


def faces_of(field: FieldData) -> TriangleArrays | None:
    """Return the arrays of a folded grid as triangles, two for each cell.

    Returns
    -------
    TriangleArrays or None
        Without texts and units. ``None`` for surfaces that have no folds, and for sign-free fields
        and grids of more than :data:`MOST_NODES` nodes, which stay grids.
    """
    if field.sign_free or field.valid.size > MOST_NODES or not mixes_at_folds(field):
        return None
    surface = field.surface
    numbers = surface.drawn
    corners = surface.corners_of(numbers)
    points = surface.points.reshape(-1, 3)
    is_drawn = solid_triangles(points, corners) & ~repeated(corners)
    numbers = numbers[is_drawn]
    nodal = {}
    on_cells = {}
    for name, steps in {**field.scalars, **field.parts}.items():
        if name in field.on_cells:
            on_cells[name] = map_steps(steps, partial(_as_row, at=surface.cells_of(numbers)))
        else:
            nodal[name] = map_steps(steps, _as_row)
    return TriangleArrays(
        points=points,
        triangles=corners[is_drawn],
        velocity=map_steps(field.velocity, _as_row),
        times=field.times,
        valid=field.valid.ravel(),
        scalars=nodal,
        cell_scalars=on_cells,
        parts=tuple(field.parts),
    )


def _as_row(step: Floats, at: Indices | slice = slice(None)) -> Floats:
    """Return some values of a step (J, I, ...) as a row, (N, ...)."""
    return step.reshape(-1, *step.shape[2:])[at]
