"""From PyVista's meshes to a field.

Each time step gives one plane of nodes (:mod:`flowtex.field.io.planes`): positions, vectors, other
single-component arrays, and what is hidden. Vectors on cells become vectors on nodes. The steps
are then stacked and handed to :meth:`FlowField.from_arrays`, which checks the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from flowtex.errors import FieldError, raise_faults
from flowtex.field.field import FlowField
from flowtex.field.io import mesh_arrays
from flowtex.field.io.mesh_arrays import MeshArray
from flowtex.field.io.meshes import Step, steps
from flowtex.field.io.planes import (
    Plane,
    choose_plane,
    count_nodes,
    nodes_to_keep,
    plane_faults,
    spread,
)
from flowtex.field.periodic import find_closure
from flowtex.field.signs import axes, products

__all__ = ["from_pyvista"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

#: Nodes of two steps closer than this share of the extent of the mesh are the same.
SAME = 1e-6


@dataclass
class _Sheet:
    """One plane at one time: what it takes from the mesh, still as it lies there."""

    points: Floats
    vectors: Floats
    shown: Bools
    """Nodes that the mesh does not hide, (J, I)."""
    cells: Bools | None
    """Cells that it shows, (J - 1, I - 1), where it says so or the vectors are theirs."""
    wrap: tuple[bool, bool]
    scalars: dict[str, Floats] = field(default_factory=dict)


def from_pyvista(
    mesh: Any,
    *,
    vectors: str | None = None,
    plane: str | None = None,
    times: ArrayLike | None = None,
    periodic: str | None = None,
    name: str = "",
    sign_free: bool = False,
) -> FlowField:
    """Make a field from a structured PyVista mesh, or from a series of them.

    Parameters
    ----------
    mesh
        A StructuredGrid, RectilinearGrid or ImageData. A MultiBlock with one structured block
        stands for that block. A list or tuple of meshes, a MultiBlock of several grids with the
        same nodes, and a PyVista reader with time values are time steps.
    vectors
        Name of the velocity on points or cells, with 2 or 3 components. By default the only
        array that can be the velocity, or the one that the mesh marks as its active vectors.
    plane
        Surface to draw from a mesh of three dimensions: ``"k=20"``, ``"j=0"`` or ``"i=-1"``,
        counted from the end when negative. On a k-plane the surface's (i, j) are the mesh's
        (i, j), on a j-plane (i, k), on an i-plane (j, k). A mesh with one flat index direction
        needs none, and follows the same table.
    times
        Time of each step, (T,). By default the reader's time values, or ``TimeValue`` in the
        field data of every step, or 0, 1, 2, ...
    periodic
        Axes of the surface that close on themselves, see :meth:`FlowField.from_arrays`.
    name
        A word for captions.
    sign_free
        Whether v and -v mean the same, see :meth:`FlowField.from_arrays`.

    Returns
    -------
    FlowField
        Positions in the mesh's units. Arrays with one component become ``scalars``; those on
        cells, and vectors on cells, become means of the visible cells around each node.

    Raises
    ------
    FieldError
        When the mesh is not structured, when the plane or the vectors have to be chosen or do
        not exist, when the steps of a series differ in their nodes, and for what
        :meth:`FlowField.from_arrays` refuses.

    Notes
    -----
    Hidden are points and cells that VTK's ghost arrays hide, points with ``IBlank`` 0 (PLOT3D),
    and points that a sampling filter marked in ``vtkValidPointMask``. The mesh is not changed.
    """
    sheets: list[_Sheet] = []
    found: list[float | None] = []
    chosen: tuple[Plane, MeshArray] | None = None
    for step in steps(mesh):
        if chosen is None:
            chosen = _choose(step.grid, plane, vectors)
        _check_step(step, *chosen)
        sheets.append(_sheet(step.grid, *chosen, periodic, sign_free=sign_free))
        found.append(step.time)
        _check_nodes(sheets[0], sheets[-1], step.label)
    known = [t for t in found if t is not None]
    if times is None and len(known) == len(sheets):
        times = known
    shown = np.logical_and.reduce([sheet.shown for sheet in sheets])
    seen = [sheet.cells for sheet in sheets if sheet.cells is not None]
    if seen:
        shown &= nodes_to_keep(np.logical_and.reduce(seen), sheets[0].wrap)
    return FlowField.from_arrays(
        sheets[0].points,
        np.stack([sheet.vectors for sheet in sheets]),
        times=times,
        valid=shown,
        periodic=periodic,
        scalars=_stacked(sheets),
        name=name,
        sign_free=sign_free,
    )


def _choose(grid: Any, plane: str | None, vectors: str | None) -> tuple[Plane, MeshArray]:
    """Find the plane and the vectors in the first step, telling all faults at once."""
    faults = plane_faults(tuple(grid.dimensions), plane)
    if min(grid.dimensions) > 0:
        faults += mesh_arrays.vector_faults(grid, vectors)
    raise_faults(faults)
    return choose_plane(tuple(grid.dimensions), plane), mesh_arrays.choose_vectors(grid, vectors)


def _check_step(step: Step, plane: Plane, vectors: MeshArray) -> None:
    """Refuse a step that is shaped otherwise than the first, or lacks its vectors."""
    dimensions = tuple(step.grid.dimensions)
    if dimensions != plane.dimensions:
        msg = (
            f"{step.label} has {count_nodes(dimensions)} and the first step has "
            f"{count_nodes(plane.dimensions)}; expected the same nodes in every step. If these "
            "are parts of one mesh and not time steps, give one of them: mesh[0], or block=0 "
            "for a file"
        )
        raise FieldError(msg)
    arrays = [str(array) for array in mesh_arrays.catalogue(step.grid)]
    if str(vectors) not in arrays:
        msg = (
            f"{step.label} has no array {vectors}, which the first step has; expected it in every "
            f"step. Its arrays, with their components: {', '.join(arrays) or 'none'}"
        )
        raise FieldError(msg)


def _check_nodes(first: _Sheet, sheet: _Sheet, label: str) -> None:
    """Refuse a mesh that moves."""
    if first is sheet:
        return
    before, after = first.points, sheet.points
    known = first.shown & sheet.shown & np.isfinite(before).all(-1) & np.isfinite(after).all(-1)
    moved = float(np.max(np.abs(after[known] - before[known]), initial=0.0))
    if moved > 0 and moved > SAME * float(np.ptp(before[known], axis=0).max()):
        msg = (
            f"the nodes of {label} are up to {moved:.3g} away from those of the first step; moving "
            "meshes are not supported: sample all steps onto one mesh with mesh.sample(step). If "
            "these are parts of one mesh and not time steps, give one of them: mesh[0], or "
            "block=0 for a file"
        )
        raise FieldError(msg)
    sheet.points = first.points


def _sheet(
    grid: Any, plane: Plane, vectors: MeshArray, periodic: str | None, *, sign_free: bool
) -> _Sheet:
    """Take one plane out of one grid."""
    points = _positions(grid, plane)
    hidden = mesh_arrays.hidden_nodes(grid)
    shown = np.ones(points.shape[:2], bool) if hidden is None else ~plane.nodes(hidden)
    wrap = _wrap(np.where(shown[..., None], points, np.nan), periodic)
    flags = mesh_arrays.visible_cells(grid)
    visible = None if flags is None else plane.cells(flags)
    values = mesh_arrays.values_of(grid, vectors)
    if vectors.where == "cells":
        layers = plane.cells(values).astype(np.float64)
        known = np.asarray(np.isfinite(layers).all(axis=-1))
        visible = known if visible is None else known & visible
        if sign_free:
            velocity = axes(spread(products(layers), visible, wrap))
        else:
            velocity = spread(layers, visible, wrap)
    else:
        velocity = plane.nodes(values).astype(np.float64)
    cells = None if visible is None else np.asarray(visible.any(axis=0))
    sheet = _Sheet(points, velocity, shown, cells, wrap)
    for array in mesh_arrays.catalogue(grid):
        if array.numeric and array.components == 1 and array != vectors:
            # Points come first in the catalogue, and win over cells of the same name.
            sheet.scalars.setdefault(array.name, _scalar(grid, plane, array, wrap))
    return sheet


def _scalar(grid: Any, plane: Plane, array: MeshArray, wrap: tuple[bool, bool]) -> Floats:
    """One single-component array on the nodes of a plane, (J, I)."""
    values = mesh_arrays.values_of(grid, array).reshape(-1)
    if array.where == "points":
        return plane.nodes(values).astype(np.float64)
    layers = plane.cells(values).astype(np.float64)
    flags = mesh_arrays.visible_cells(grid)
    seen = np.isfinite(layers) & (True if flags is None else plane.cells(flags))
    return spread(layers, seen, wrap)


def _positions(grid: Any, plane: Plane) -> Floats:
    """Positions of the nodes of a plane, (J, I, 3)."""
    import pyvista as pv

    if isinstance(grid, pv.StructuredGrid):
        return plane.nodes(np.asarray(grid.points)).astype(np.float64)
    if isinstance(grid, pv.RectilinearGrid):
        axes = [np.asarray(a, dtype=np.float64) for a in (grid.x, grid.y, grid.z)]
        matrix = np.eye(4)
    else:
        e = grid.extent
        axes = [np.arange(e[2 * a], e[2 * a + 1] + 1, dtype=np.float64) for a in range(3)]
        matrix = np.asarray(grid.index_to_physical_matrix, dtype=np.float64)
    axes[plane.axis] = axes[plane.axis][plane.index : plane.index + 1]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    places = np.stack([x, y, z], axis=-1).squeeze(2 - plane.axis)
    return np.asarray(places @ matrix[:3, :3].T + matrix[:3, 3])


def _wrap(points: Floats, periodic: str | None) -> tuple[bool, bool]:
    """Whether the last line along (j, i) is the first one again, so that cells go round."""
    found = []
    for letter, lines in (("j", points), ("i", np.swapaxes(points, 0, 1))):
        closure = find_closure(lines)
        wanted = periodic is None or letter in periodic
        found.append(wanted and closure.periodic and closure.line is None)
    return found[0], found[1]


def _stacked(sheets: Sequence[_Sheet]) -> dict[str, Floats]:
    """Scalars that all steps have, (J, I) or (T, J, I)."""
    names = [n for n in sheets[0].scalars if all(n in sheet.scalars for sheet in sheets)]
    if len(sheets) == 1:
        return {n: sheets[0].scalars[n] for n in names}
    return {n: np.stack([sheet.scalars[n] for sheet in sheets]) for n in names}
