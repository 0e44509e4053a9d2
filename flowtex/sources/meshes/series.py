"""The time steps of a series, aligned with the first one: the same nodes, in the order of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.sources.meshes.parts import SAME_NODE_SHARE, TimeStep, is_structured, part_size
from flowtex.sources.meshes.vectors import MeshArray, Sheet, catalogue, missing_arrays
from flowtex.sources.meshes.volume import count_nodes
from flowtex.sources.notices import Record

#: Length of a gap in usual steps from which on a notice is issued.
GAP_STEPS = 8
#: Arrays that number the nodes or cells of a mesh, whatever their order.
LABELS = ("GlobalPointIds", "GlobalNodeIds", "GlobalNodeId", "vtkOriginalPointIds", "GlobalCellIds")
PARTS = "If these are parts of one mesh and not time steps, give one of them, as in block=0"


def check_arrays(step: TimeStep, first: TimeStep, velocity: MeshArray) -> None:
    """Raise a FieldError for a step of another kind than the first, or without its vectors."""
    sizes = [
        count_nodes(tuple(grid.dimensions)) if is_structured(grid) else part_size(grid)
        for grid in (step.grid, first.grid)
    ]
    if is_structured(first.grid) and sizes[0] != sizes[1]:
        msg = (
            f"{step.label} has {sizes[0]} and the first step has {sizes[1]}; expected the same "
            f"nodes in every step. {PARTS}"
        )
        raise FieldError(msg)
    if missing := missing_arrays(step.grid, velocity):
        arrays = ", ".join(map(str, catalogue(step.grid))) or "none"
        msg = (
            f"{step.label} has no array {missing[0]}, which the first step has; expected it in "
            f"every step. Its arrays, with their numbers of components: {arrays}"
        )
        raise FieldError(msg)


def aligned(step: TimeStep, first: TimeStep) -> TimeStep:
    """Return a step in the order of nodes and cells of the first, itself if it has that order.

    Nodes are the same by their labels or places. A step with others remains as it is, and
    :func:`check_nodes` raises an error if they are drawn.
    """
    grid, before = step.grid, first.grid
    if (grid.n_points, grid.n_cells) != (before.n_points, before.n_cells) or _equal(grid, before):
        return step
    near = SAME_NODE_SHARE * before.length
    nodes = _order(before.points, grid.points, near, before.point_data, grid.point_data)
    if nodes is None:
        return step
    middles = before.cell_centers().points, grid.cell_centers().points
    cells = _order(*middles, near, before.cell_data, grid.cell_data)
    if cells is None or (_is_sorted(nodes) and _is_sorted(cells)):
        return step
    ordered = before.copy(deep=False)
    ordered.clear_data()
    for name in grid.point_data:
        ordered.point_data[name] = np.asarray(grid.point_data[name])[nodes]
    for name in grid.cell_data:
        ordered.cell_data[name] = np.asarray(grid.cell_data[name])[cells]
    return replace(step, grid=ordered)


def _equal(grid: Any, before: Any) -> bool:
    """Return whether two meshes have equal positions and cells, as far as that is quick to see."""
    import pyvista as pv

    if isinstance(grid, pv.ImageData) and isinstance(before, pv.ImageData):
        matrices = grid.index_to_physical_matrix, before.index_to_physical_matrix
        return grid.extent == before.extent and np.array_equal(*matrices)
    if isinstance(grid, pv.RectilinearGrid) and isinstance(before, pv.RectilinearGrid):
        return all(np.array_equal(getattr(grid, a), getattr(before, a)) for a in "xyz")
    if not np.array_equal(grid.points, before.points):
        return False
    names = {pv.PolyData: ("faces", "lines", "strips"), pv.UnstructuredGrid: ("cells", "celltypes")}
    return all(
        np.array_equal(getattr(grid, name), getattr(before, name, ()))
        for name in names.get(type(grid), ())
    )


def _order(before: AnyArray, after: AnyArray, near: float, *data: Any) -> Indices | None:
    """Return the number of each place of a step in the order of the first; ``None`` if unknown."""
    before, after = (np.asarray(places, dtype=np.float64) for places in (before, after))
    if not (np.isfinite(before).all() and np.isfinite(after).all()):
        return None
    if np.abs(after - before).max(initial=0.0) <= near:
        return np.arange(len(before))
    for name in LABELS:
        if all(name in arrays for arrays in data):
            first, second = (np.asarray(arrays[name]) for arrays in data)
            labelled: Indices = np.argsort(second)[np.argsort(np.argsort(first))]
            same = np.array_equal(second[labelled], first) and len(np.unique(first)) == len(first)
            if same and np.abs(after[labelled] - before).max() <= near:
                return labelled
    distances, order = (np.asarray(found) for found in scipy.spatial.cKDTree(after).query(before))
    is_whole = distances.max(initial=0.0) <= near and len(np.unique(order)) == len(after)
    return order if is_whole else None


def _is_sorted(order: Indices) -> bool:
    return bool((np.diff(order) > 0).all())


def check_nodes(first: Sheet, sheet: Sheet, label: str) -> None:
    """Raise a FieldError for a step with another surface, or with nodes that moved."""
    before, after = first.points, sheet.points
    if before.shape != after.shape or not np.array_equal(first.triangles, sheet.triangles):  # type: ignore[arg-type]
        msg = (
            f"{label} has a surface of {_size(sheet)} and the first step has one of "
            f"{_size(first)}; expected the same nodes and cells in every step: sample all steps "
            f"onto one mesh with mesh.sample(step), or draw one of the times. {PARTS}"
        )
        raise FieldError(msg)
    compared: Bools = first.shown & sheet.shown & np.isfinite(before + after).all(-1)
    moved = float(np.max(np.abs(after[compared] - before[compared]), initial=0.0))
    if moved > 0 and moved > SAME_NODE_SHARE * float(np.ptp(before[compared], axis=0).max()):
        msg = (
            f"the nodes of {label} are up to {moved:.3g} away from those of the first step; moving "
            f"meshes are not supported: sample all steps onto one mesh with mesh.sample(step). "
            f"{PARTS}"
        )
        raise FieldError(msg)


def _size(sheet: Sheet) -> str:
    triangles = () if sheet.triangles is None else sheet.triangles
    return f"{len(sheet.points):,} nodes and {len(triangles):,} triangles"


def ordered_times(steps: Sequence[TimeStep], record: Record) -> tuple[list[int], Any]:
    """Return the order of steps by their times, and the times; ``None`` without them."""
    numbers = list(range(len(steps)))
    times = [np.nan if step.time is None else step.time for step in steps]
    if lacking := [step.label for step in steps if step.time is None]:
        text = f"{lacking[0]} has no time, so the {len(steps)} steps are numbered from 0"
        if len(steps) > 1:
            record("align", text, notable=len(lacking) < len(steps))
        return numbers, None
    if not np.isfinite(times).all():
        return numbers, times  # the field raises an error
    order = sorted(numbers, key=times.__getitem__)
    if order != numbers:
        record("align", "the steps are sorted by their times", notable=True)
    for n, following in pairwise(order):
        if times[n] == times[following]:
            msg = (
                f"{steps[n].label} and {steps[following].label} both have the time {times[n]:g}; "
                "expected different times: leave out one of them, or give times=[...]"
            )
            raise FieldError(msg)
    moments = [times[n] for n in order]
    lengths = np.diff(moments)
    if len(lengths) > 1 and lengths.max() > GAP_STEPS * (usual := float(np.median(lengths))) > 0:
        n = int(np.argmax(lengths))
        text = (
            f"no data lie between the times {moments[n]:g} and {moments[n + 1]:g}, where the flow "
            f"is interpolated; other steps are {usual:g} apart. If the first are initial values, "
            "leave them out, as in a list of the other meshes"
        )
        record("align", text, notable=True)
    return order, moments


def common_scalars(
    scalars: Sequence[dict[str, Floats]], times: Any, record: Record
) -> dict[str, Floats]:
    """Return the arrays that all steps have, (T, ...)."""
    common = dict(scalars[0])
    for n, arrays in enumerate(scalars):
        for name in [name for name in common if name not in arrays]:
            when = f"step {n}" if times is None else f"time {times[n]:g}"
            record("align", f"{name!r} is missing at {when}, so it is not read", notable=True)
            del common[name]
    return {name: np.stack([arrays[name] for arrays in scalars]) for name in common}
