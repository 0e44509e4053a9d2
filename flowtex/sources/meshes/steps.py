"""From the surfaces of one or several time steps to the arguments of a field of triangles."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex._util.notices import notify
from flowtex.errors import FieldError, raise_faults
from flowtex.field.triangles.arrays import nodal_means
from flowtex.field.triangles.topology import triangle_normals
from flowtex.sources.meshes.cuts import HIDDEN, Cut, cut_faults, surface_of
from flowtex.sources.meshes.parts import TimeStep, check_arrays, check_nodes
from flowtex.sources.meshes.vectors import (
    MeshArray,
    catalogue,
    choose_vectors,
    values_of,
    vector_faults,
)

#: Length of a gap in usual steps from which on a notice is issued.
GAP_STEPS = 8


@dataclass(kw_only=True)
class SheetStep:
    """The drawn arrays at one time: positions, vectors, scalars, and the mask of shown nodes."""

    time: float | None
    points: Floats
    vectors: Floats
    shown: Bools
    scalars: dict[str, Floats] = field(default_factory=dict)


def stacked(sheets: Sequence[SheetStep], times: ArrayLike | None) -> dict[str, Any]:
    """Return arrays of all steps, with the scalars that each of them has."""
    moments = [sheet.time for sheet in sheets if sheet.time is not None]
    if times is None and len(moments) == len(sheets):
        times = moments
        _notify_gaps(moments)
    names = []
    for name in sheets[0].scalars:
        lacking = [n for n, sheet in enumerate(sheets) if name not in sheet.scalars]
        if not lacking:
            names.append(name)
            continue
        when = (
            f"time {moments[lacking[0]]:g}" if len(moments) == len(sheets) else f"step {lacking[0]}"
        )
        notify(f"{name!r} is missing at {when}, so it is not read")
    return {
        "points": sheets[0].points,
        "velocity": np.stack([sheet.vectors for sheet in sheets]),
        "times": times,
        "valid": np.logical_and.reduce([sheet.shown for sheet in sheets]),
        "scalars": {n: np.stack([sheet.scalars[n] for sheet in sheets]) for n in names},
    }


def _notify_gaps(times: Sequence[float]) -> None:
    """Issue a notice about a step that is much longer than usual, as after initial values."""
    steps = np.diff(times)
    if len(steps) > 1 and steps.max() > GAP_STEPS * (usual := float(np.median(steps))) > 0:
        n = int(np.argmax(steps))
        notify(
            f"no data lie between the times {times[n]:g} and {times[n + 1]:g}, where the flow is "
            f"interpolated; other steps are {usual:g} apart. If the first are initial values, "
            "leave them out, as in a list of the other meshes"
        )


@dataclass(kw_only=True)
class _SurfaceStep(SheetStep):
    """The arrays of a surface: points and vectors (N, 2 or 3), the others (N,)."""

    triangles: Indices


def read_surfaces(
    steps: Iterable[TimeStep], vectors: str | None, cut: Cut | None, times: ArrayLike | None
) -> dict[str, Any]:
    """Read the arrays for :meth:`FlowField.from_pyvista` from meshes at one or several times."""
    sheets: list[_SurfaceStep] = []
    chosen: MeshArray | None = None
    for step in steps:
        if chosen is None:
            faults = cut_faults(step.grid, cut)
            raise_faults(faults + (vector_faults(step.grid, vectors) if step.grid.n_cells else []))
            chosen = choose_vectors(step.grid, vectors)
        check_arrays(step, chosen)
        sheets.append(_surface_step(step, chosen, cut, tell=not sheets))
        _check_same(sheets[0], sheets[-1], step)
    return {**stacked(sheets, times), "triangles": sheets[0].triangles}


def _check_same(first: _SurfaceStep, sheet: _SurfaceStep, step: TimeStep) -> None:
    """Raise a FieldError for a step with another surface."""
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


def _surface_step(
    step: TimeStep, vectors: MeshArray, cut: Cut | None, *, tell: bool
) -> _SurfaceStep:
    surface, triangles = surface_of(step.grid, cut, vectors, tell=tell)
    if cut is not None:
        vectors = replace(vectors, where="points")
    points = np.asarray(surface.points, dtype=np.float64)
    arrays = [a for a in catalogue(surface) if a.numeric and a.components == 1 and a.name != HIDDEN]
    if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(points):
        msg = (
            f"its cells refer to points {triangles.min()} to {triangles.max()}, but there are "
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
        finite = np.asarray(np.isfinite(values.reshape(len(values), -1)).all(axis=1))
        return nodal_means(values[None], triangles, areas, len(points), finite)[0]

    shown = np.asarray(surface.point_data[HIDDEN]) <= 0
    sheet = _SurfaceStep(
        time=step.time, points=points, vectors=at_nodes(vectors), shown=shown, triangles=triangles
    )
    for array in arrays:
        if array != vectors:
            # Points come first in the catalogue, and take precedence over cells of the same name.
            sheet.scalars.setdefault(array.name, at_nodes(array))
    return sheet
