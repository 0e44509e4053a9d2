"""What a PyVista object holds: structured grids, their times, and what they hide.

A grid, a block of a MultiBlock, a list of grids and a reader of a time series all come down to a
sequence of :class:`TimeStep`. Grids are handed out one at a time, so that a long series is never
in memory as a whole.

Meshes hide nodes and cells in several ways: VTK's ghost arrays on points and on cells, PLOT3D's
``IBlank``, and the mask of points that a sampling filter missed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from flowtex._util.array_types import Bools
from flowtex.errors import FieldError

__all__ = [
    "SAME_NODE_SHARE",
    "TimeStep",
    "hidden_nodes",
    "is_reader",
    "is_structured",
    "leaves",
    "pick",
    "several_fault",
    "several_grids",
    "time_steps",
    "times_of",
    "visible_cells",
]

#: Flags of VTK's ghost arrays that hide: a hidden point; a refined or a hidden cell. Points and
#: cells that are duplicates of a neighbouring piece carry data and count as visible.
_HIDDEN_POINT, _HIDDEN_CELL = 2, 8 | 32
#: Nodes of two steps closer than this share of the extent of the mesh are the same.
SAME_NODE_SHARE = 1e-6
#: Blocks that a message lists at most.
MOST_LISTED = 12


@dataclass(frozen=True)
class TimeStep:
    """One structured grid and its time, or ``None`` when no time is given with it."""

    grid: Any
    time: float | None
    label: str


def time_steps(source: Any, block: int | str | None = None) -> Iterator[TimeStep]:
    """Go through the time steps of a grid, a MultiBlock, a list of either, or a reader.

    With a block, by its name or number, only of that one. Raises a FieldError when something is
    met that is no structured grid.
    """
    if is_reader(source):
        yield from _read(source, block)
    elif isinstance(source, (list, tuple)):
        if not source:
            msg = "the list of meshes is empty; expected one structured mesh for each time step"
            raise FieldError(msg)
        for n, item in enumerate(source):
            yield item if isinstance(item, TimeStep) else _single(item, f"step {n}", block)
    else:
        yield from _blocks(_wrapped(source, "the mesh"), block)


def is_reader(source: Any) -> bool:
    """Whether this is one of PyVista's readers."""
    return hasattr(source, "read") and (hasattr(source, "time_values") or hasattr(source, "reader"))


def is_structured(mesh: Any) -> bool:
    """Whether this is a mesh with an order of nodes along i, j and k."""
    import pyvista as pv

    return isinstance(mesh, (pv.StructuredGrid, pv.RectilinearGrid, pv.ImageData))


def times_of(source: Any) -> list[float]:
    """Return the times of a reader; none where it has no series, or for a mesh."""
    return [float(t) for t in getattr(source, "time_values", None) or []]


def leaves(mesh: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Go through the meshes in a tree of blocks, with their paths; empty blocks are left out.

    A block without a name is named after its number, and so are those of one name.
    """
    import pyvista as pv

    if not isinstance(mesh, pv.MultiBlock):
        yield name, mesh
        return
    keys: list[Any] = mesh.keys()
    for number, (key, block) in enumerate(zip(keys, mesh, strict=True)):
        if block is not None:
            own = str(number) if key is None else key
            own = own if keys.count(key) == 1 or key is None else f"{own} {number}"
            yield from leaves(block, f"{name}/{own}" if name else own)


def several_grids(mesh: Any, *, series: bool = False) -> dict[str, Any]:
    """Return the structured blocks of a mesh by their paths, where one has to be chosen.

    That is not so where there is only one, and where all have the same nodes: those are time steps,
    unless the mesh is itself one step of a ``series``.
    """
    grids = _grids(mesh)
    usable = [grid for grid in grids.values() if _is_surface(grid)] or list(grids.values())
    if len(usable) < 2 or (not series and _same_nodes(usable)):
        return {}
    return grids


def _grids(mesh: Any) -> dict[str, Any]:
    return {name: grid for name, grid in leaves(mesh) if is_structured(grid)}


def _same_nodes(grids: list[Any]) -> bool:
    """Whether grids have the same nodes, as far as their sizes and bounds tell."""
    first = np.asarray(grids[0].bounds)
    near = SAME_NODE_SHARE * max(float(np.ptp(first.reshape(3, 2), axis=1).max()), 0.0)
    return all(
        tuple(grid.dimensions) == tuple(grids[0].dimensions)
        and bool(np.all(np.abs(np.asarray(grid.bounds) - first) <= near))
        for grid in grids
    )


def several_fault(grids: dict[str, Any], label: str) -> str:
    """Return words about a choice of several blocks."""
    listed = [
        f"{number} ({name}, {' x '.join(map(str, grid.dimensions))} nodes)"
        for number, (name, grid) in enumerate(grids.items())
    ]
    more = ", ..." if len(listed) > MOST_LISTED else ""
    return (
        f"{label} has {len(grids)} structured blocks, and no time steps of one: "
        f"{', '.join(listed[:MOST_LISTED])}{more}; choose one, as in "
        f'block="{next(iter(grids))}"'
    )


def _read(reader: Any, block: int | str | None) -> Iterator[TimeStep]:
    """Read one time after the other, and leave the reader at the time it was set to."""
    times = times_of(reader)
    if len(times) < 2 or not hasattr(reader, "set_active_time_value"):
        for step in _blocks(_wrapped(reader.read(), "the mesh"), block):
            time = step.time if len(times) != 1 else times[0]
            yield TimeStep(step.grid, time, step.label)
        return
    before = reader.active_time_value
    try:
        for n, time in enumerate(times):
            reader.set_active_time_value(time)
            step = _single(reader.read(), f"step {n}", block)
            yield TimeStep(step.grid, time, step.label)
    finally:
        reader.set_active_time_value(before)


def pick(mesh: Any, block: int | str) -> Any:
    """Return one of the structured grids in a mesh, by number or by name.

    Raises a FieldError when there is none.
    """
    grids = _grids(mesh)
    for number, (name, grid) in enumerate(grids.items()):
        if block in (number, name):
            return grid
    for name, other in leaves(mesh):
        if block == name:
            raise FieldError(_unstructured(other, f"block {name!r}"))
    if not grids:
        raise FieldError(_unstructured(mesh, "the mesh"))
    listed = ", ".join(f"{number} ({name})" for number, name in enumerate(grids))
    msg = f"block is {block!r}; the structured blocks of the file are: {listed}"
    raise FieldError(msg)


def _blocks(mesh: Any, block: int | str | None) -> Iterator[TimeStep]:
    """Take a mesh for one step, and a MultiBlock of grids with the same nodes for a series."""
    if block is not None:
        mesh = pick(mesh, block)
    if several := several_grids(mesh):
        raise FieldError(several_fault(several, "the mesh"))
    grids = list(_grids(mesh).items())
    usable = [(name, block) for name, block in grids if _is_surface(block)] or grids
    if len(usable) < 2:
        yield _single(mesh, "the mesh")
        return
    for name, grid in usable:
        yield TimeStep(grid, _time(grid), f"block {name!r}")


def _single(item: Any, label: str, block: int | str | None = None) -> TimeStep:
    """Return the only structured grid in a mesh or a MultiBlock, or the block of that name."""
    mesh = _wrapped(item, label)
    if block is not None:
        grid, time = pick(mesh, block), _time(mesh)
        return TimeStep(grid, _time(grid) if time is None else time, label)
    if several := several_grids(mesh, series=True):
        raise FieldError(several_fault(several, label))
    grids = list(_grids(mesh).values())
    usable = [grid for grid in grids if _is_surface(grid)] or grids
    if not usable:
        raise FieldError(_unstructured(mesh, label))
    time = _time(usable[0])
    return TimeStep(usable[0], _time(mesh) if time is None else time, label)


def _is_surface(grid: Any) -> bool:
    return bool(sum(n > 1 for n in grid.dimensions) > 1)


def _wrapped(source: Any, label: str) -> Any:
    """Return a PyVista mesh, also of a bare VTK one."""
    import pyvista as pv

    if isinstance(source, pv.DataObject):
        return source
    if hasattr(source, "IsA") and source.IsA("vtkDataObject"):
        return pv.wrap(source)
    msg = (
        f"{label} is of type {type(source).__name__}; expected a PyVista StructuredGrid, "
        "RectilinearGrid, ImageData or MultiBlock, a list of them, or a reader. Arrays go to "
        "FlowField.from_arrays(points, velocity)"
    )
    raise FieldError(msg)


def _time(mesh: Any) -> float | None:
    """Time of a mesh as VTK's writers keep it."""
    if "TimeValue" not in mesh.field_data:
        return None
    values = np.asarray(mesh.field_data["TimeValue"], dtype=float).ravel()
    return float(values[0]) if len(values) else None


def _unstructured(mesh: Any, label: str) -> str:
    kinds = sorted({type(block).__name__ for _, block in leaves(mesh)})
    if not kinds:
        return f"{label} has no blocks; check the file or the filter that made it"
    what = f"a {type(mesh).__name__}"
    if kinds != [type(mesh).__name__]:
        what += f" of {', '.join(kinds)}"
    return (
        f"{label} is {what}, and no structured grid: its nodes have no order along i and j, "
        "which the method needs, and unstructured surfaces are not drawn yet. Sample it onto a "
        "grid, as in pyvista.create_grid(mesh, (200, 150, 50)).sample(mesh), with 1 along what "
        "is flat, or draw it with ParaView's Surface LIC, which takes any mesh"
    )


def hidden_nodes(mesh: Any) -> Bools:
    """Nodes that a mesh hides, (N,)."""
    data = mesh.point_data
    hidden = np.zeros(mesh.n_points, dtype=bool)
    if "vtkGhostType" in data:
        hidden |= (np.asarray(data["vtkGhostType"]) & _HIDDEN_POINT) != 0
    # Negative values and those above one are walls and overlaps of grids, with data.
    for name in {"IBlank", "vtkValidPointMask"} & set(data):
        hidden |= np.asarray(data[name]) == 0
    return hidden


def visible_cells(mesh: Any) -> Bools:
    """Cells that a mesh shows, (N,)."""
    if "vtkGhostType" not in mesh.cell_data:
        return np.ones(mesh.n_cells, dtype=bool)
    return np.asarray((np.asarray(mesh.cell_data["vtkGhostType"]) & _HIDDEN_CELL) == 0)
