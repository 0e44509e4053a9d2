"""From PyVista's meshes to the arrays of a field.

Each time step of a structured mesh becomes one plane of nodes
(:mod:`flowtex.sources.meshes.planes`): positions, vectors, other single-component arrays, and
masks. Vectors on cells become vectors on nodes. The steps are then stacked into the arguments of
:meth:`FlowField.from_arrays`, which checks the rest. All other meshes, and cuts, go through
:mod:`flowtex.sources.meshes.steps`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats
from flowtex.errors import FieldError, raise_faults
from flowtex.field.arrays import GridArrays, TriangleArrays
from flowtex.field.grids.periodic import find_closure
from flowtex.field.grids.signs import axes, products
from flowtex.sources.meshes.cuts import find_cut
from flowtex.sources.meshes.parts import (
    TimeStep,
    check_arrays,
    check_nodes,
    hidden_nodes,
    is_structured,
    part_size,
    time_steps,
    visible_cells,
)
from flowtex.sources.meshes.planes import (
    Plane,
    choose_plane,
    count_nodes,
    nodes_to_keep,
    plane_faults,
    spread,
)
from flowtex.sources.meshes.steps import SheetStep, read_surfaces, stacked
from flowtex.sources.meshes.vectors import (
    MeshArray,
    catalogue,
    choose_vectors,
    values_of,
    vector_faults,
)


@dataclass(kw_only=True)
class _PlaneStep(SheetStep):
    """The arrays of one plane at one time, (J, I, ...).

    ``cells`` (J - 1, I - 1) are those that the mesh shows and that have vectors. ``wrap`` is
    whether the last line along (j, i) repeats the first one.
    """

    cells: Bools
    wrap: tuple[bool, bool]


def read_meshes(
    mesh: Any,
    *,
    vectors: str | None = None,
    plane: str | None = None,
    slice: Any = None,
    contour: Any = None,
    times: ArrayLike | None = None,
    periodic: str | None = None,
    sign_free: bool = False,
    block: int | str | None = None,
    name: str = "",
) -> GridArrays | TriangleArrays:
    """Read the arrays for :meth:`FlowField.from_pyvista` from a mesh or a series of them."""
    cut = find_cut(slice, contour)
    if cut is not None and plane is not None:
        option = "slice" if slice is not None else "contour"
        msg = f"plane is {plane!r} and {option} is {cut.text}; choose one of the two"
        raise FieldError(msg)
    steps = time_steps(mesh, block, cut=cut is not None)
    first = next(steps)
    if is_structured(first.grid) and cut is None:
        options: dict[str, Any] = {"periodic": periodic, "sign_free": sign_free}
        arrays = _read_planes(chain([first], steps), vectors, plane, times, **options)
        return GridArrays(**arrays, **options, name=name)
    choices = {"plane": plane, "periodic": periodic, "sign_free": sign_free or None}
    if refused := [f"{k}={value!r}" for k, value in choices.items() if value not in (None, "")]:
        cut_here = plane if plane and plane[0] in "xyz" else "x=0.5"
        remedy = f'to cut it, use slice="{cut_here}"; otherwise ' if plane is not None else ""
        msg = (
            f"{', '.join(refused)} applies to structured meshes, and this one is not; {remedy}omit "
            "it, or sample the mesh onto a structured one, as in "
            "pyvista.create_grid(mesh, (200, 150, 50)).sample(mesh)"
        )
        raise FieldError(msg)
    return TriangleArrays(**read_surfaces(chain([first], steps), vectors, cut, times), name=name)


def _read_planes(
    steps: Iterable[TimeStep],
    vectors: str | None,
    plane: str | None,
    times: ArrayLike | None,
    *,
    periodic: str | None,
    sign_free: bool,
) -> dict[str, Any]:
    sheets: list[_PlaneStep] = []
    choice: tuple[Plane, MeshArray] | None = None
    for step in steps:
        if choice is None:
            choice = _choose(step.grid, plane, vectors)
        _check_step(step, *choice)
        sheets.append(_plane_step(step, *choice, periodic, sign_free=sign_free))
        start, sheet = sheets[0], sheets[-1]
        check_nodes(start.points, sheet.points, start.shown & sheet.shown, step.label)
        sheet.points = start.points
    shown = np.logical_and.reduce([sheet.shown for sheet in sheets])
    cells = np.logical_and.reduce([sheet.cells for sheet in sheets])
    shown &= nodes_to_keep(cells, sheets[0].wrap)
    return {**stacked(sheets, times), "valid": shown}


def _choose(grid: Any, plane: str | None, vectors: str | None) -> tuple[Plane, MeshArray]:
    """Find the plane and the vectors in the first step, with all faults in one error."""
    faults = plane_faults(tuple(grid.dimensions), plane)
    if min(grid.dimensions) > 0:
        faults += vector_faults(grid, vectors)
    raise_faults(faults)
    return choose_plane(tuple(grid.dimensions), plane), choose_vectors(grid, vectors)


def _check_step(step: TimeStep, plane: Plane, vectors: MeshArray) -> None:
    """Raise a FieldError for a step of another shape than the first, or without its vectors."""
    grid = step.grid
    if not is_structured(grid) or tuple(grid.dimensions) != plane.dimensions:
        size = count_nodes(tuple(grid.dimensions)) if is_structured(grid) else part_size(grid)
        msg = (
            f"{step.label} has {size} and the first step has "
            f"{count_nodes(plane.dimensions)}; expected the same nodes in every step. If these "
            "are parts of one mesh and not time steps, give one of them, as in block=0"
        )
        raise FieldError(msg)
    check_arrays(step, vectors)


def _plane_step(
    step: TimeStep, plane: Plane, vectors: MeshArray, periodic: str | None, *, sign_free: bool
) -> _PlaneStep:
    grid, time = step.grid, step.time
    points = _positions(grid, plane)
    shown = ~plane.nodes(hidden_nodes(grid))
    wrap = _wrap(np.where(shown[..., None], points, np.nan), periodic)
    visible = plane.cells(visible_cells(grid))
    values = values_of(grid, vectors)
    if vectors.where == "cells":
        layers = plane.cells(values).astype(np.float64)
        visible = visible & np.isfinite(layers).all(axis=-1)
        if sign_free:
            velocity = axes(spread(products(layers), visible, wrap))
        else:
            velocity = spread(layers, visible, wrap)
    else:
        velocity = plane.nodes(values).astype(np.float64)
    sheet = _PlaneStep(
        time=time,
        points=points,
        vectors=velocity,
        shown=shown,
        cells=np.asarray(visible.any(axis=0)),
        wrap=wrap,
    )
    for array in catalogue(grid):
        if array.numeric and array.components == 1 and array != vectors:
            # Points come first in the catalogue, and take precedence over cells of the same name.
            sheet.scalars.setdefault(array.name, _scalar(grid, plane, array, wrap))
    return sheet


def _scalar(grid: Any, plane: Plane, array: MeshArray, wrap: tuple[bool, bool]) -> Floats:
    """Return a single-component array on the nodes of a plane, (J, I)."""
    values = values_of(grid, array).reshape(-1)
    if array.where == "points":
        return plane.nodes(values).astype(np.float64)
    layers = plane.cells(values).astype(np.float64)
    return spread(layers, np.isfinite(layers) & plane.cells(visible_cells(grid)), wrap)


def _positions(grid: Any, plane: Plane) -> Floats:
    """Return positions of the nodes of a plane, (J, I, 3)."""
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
    """Return whether the last line along (j, i) repeats the first one, so that cells go round."""
    wrap = []
    for letter, lines in (("j", points), ("i", np.swapaxes(points, 0, 1))):
        closure = find_closure(lines)
        allowed = periodic is None or letter in periodic
        wrap.append(allowed and closure.periodic and closure.line is None)
    return wrap[0], wrap[1]
