"""From the surfaces of one or several time steps to the arguments of a field of triangles."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError, raise_faults
from flowtex.field.io.meshes import TimeStep, check_arrays, check_nodes
from flowtex.field.io.surfaces.cuts import HIDDEN, Cut, cut_faults, surface_of
from flowtex.field.io.vectors import (
    MeshArray,
    catalogue,
    choose_vectors,
    values_of,
    vector_faults,
)
from flowtex.field.triangles.arrays import nodal_means
from flowtex.field.triangles.topology import triangle_normals

__all__ = ["SurfaceArguments", "read_surfaces"]


class SurfaceArguments(TypedDict):
    """Those arguments of :meth:`FlowField.from_triangles` that a mesh holds."""

    points: Floats
    triangles: Indices
    velocity: Floats
    times: ArrayLike | None
    valid: Bools
    scalars: dict[str, Floats]


@dataclass
class _SurfaceStep:
    """The arrays of a surface at one time: points and vectors (N, 2 or 3), the others (N,)."""

    points: Floats
    triangles: Indices
    vectors: Floats
    shown: Bools
    scalars: dict[str, Floats] = field(default_factory=dict)


def read_surfaces(
    steps: Iterable[TimeStep], vectors: str | None, cut: Cut | None, times: ArrayLike | None
) -> SurfaceArguments:
    """Read what a field needs from meshes at one or several times.

    Parameters and errors are those of :meth:`FlowField.from_pyvista`.
    """
    sheets: list[_SurfaceStep] = []
    own_times: list[float | None] = []
    chosen: MeshArray | None = None
    for step in steps:
        if chosen is None:
            faults = cut_faults(step.grid, cut)
            raise_faults(faults + (vector_faults(step.grid, vectors) if step.grid.n_cells else []))
            chosen = choose_vectors(step.grid, vectors)
        check_arrays(step, chosen)
        sheets.append(_surface_step(step.grid, chosen, cut, tell=not sheets))
        own_times.append(step.time)
        _check_same(sheets[0], sheets[-1], step)
    known = [t for t in own_times if t is not None]
    if times is None and len(known) == len(sheets):
        times = known
    names = [n for n in sheets[0].scalars if all(n in sheet.scalars for sheet in sheets)]
    several = len(sheets) > 1

    def stacked(arrays: list[Floats]) -> Floats:
        return np.stack(arrays) if several else arrays[0]

    return SurfaceArguments(
        points=sheets[0].points,
        triangles=sheets[0].triangles,
        velocity=stacked([sheet.vectors for sheet in sheets]),
        times=times,
        valid=np.logical_and.reduce([sheet.shown for sheet in sheets]),
        scalars={n: stacked([sheet.scalars[n] for sheet in sheets]) for n in names},
    )


def _check_same(first: _SurfaceStep, sheet: _SurfaceStep, step: TimeStep) -> None:
    """Refuse a step whose surface is another one."""
    if first.points.shape != sheet.points.shape or not np.array_equal(
        first.triangles, sheet.triangles
    ):
        msg = (
            f"{step.label} has a surface of {_size(sheet)} and the first step has one of "
            f"{_size(first)}; expected the same nodes and cells in every step: sample all steps "
            "onto one mesh with mesh.sample(step), or draw one of the times. If these are parts "
            "of one mesh and not time steps, give one of them, as in block=0"
        )
        raise FieldError(msg)
    check_nodes(first.points, sheet.points, first.shown & sheet.shown, step.label)
    sheet.points, sheet.triangles = first.points, first.triangles


def _size(sheet: _SurfaceStep) -> str:
    return f"{len(sheet.points):,} nodes and {len(sheet.triangles):,} triangles"


def _surface_step(mesh: Any, vectors: MeshArray, cut: Cut | None, *, tell: bool) -> _SurfaceStep:
    """Take the surface out of one mesh."""
    surface, triangles = surface_of(mesh, cut, vectors, tell=tell)
    if cut is not None:
        vectors = replace(vectors, where="points")
    points = np.asarray(surface.points, dtype=np.float64)
    arrays = [a for a in catalogue(surface) if a.numeric and a.components == 1 and a.name != HIDDEN]
    if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points):
        msg = (
            f"its cells have points {triangles.min()} to {triangles.max()}, and there are "
            f"{len(points):,}; write or copy it again"
        )
        raise FieldError(msg)
    areas = np.nan_to_num(np.linalg.norm(triangle_normals(points, triangles), axis=-1) / 2)

    def at_nodes(array: MeshArray) -> Floats:
        values = values_of(surface, array).astype(np.float64)
        if array.components == 1:
            values = values.reshape(-1)
        if array.where == "points":
            return values
        known = np.asarray(np.isfinite(values.reshape(len(values), -1)).all(axis=1))
        return nodal_means(values[None], triangles, areas, len(points), known)[0]

    shown = np.asarray(surface.point_data[HIDDEN]) <= 0
    sheet = _SurfaceStep(points, triangles, at_nodes(vectors), shown)
    for array in arrays:
        if array != vectors:
            # Points come first in the catalogue, and win over cells of the same name.
            sheet.scalars.setdefault(array.name, at_nodes(array))
    return sheet
