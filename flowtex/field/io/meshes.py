"""Which structured grids a PyVista object holds, and at which times.

A grid, a block of a MultiBlock, a list of grids and a reader of a time series all come down to
a sequence of :class:`Step`. Grids are handed out one at a time, so that a long series never is
in memory as a whole.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from flowtex.errors import FieldError
from flowtex.field.io.planes import count_nodes

__all__ = ["Step", "is_reader", "is_structured", "leaves", "steps"]


@dataclass(frozen=True)
class Step:
    """One structured grid and its time, or ``None`` when no time is given with it."""

    grid: Any
    time: float | None
    label: str


def steps(source: Any) -> Iterator[Step]:
    """Go through the time steps of a grid, a MultiBlock, a list of either, or a reader.

    Raises
    ------
    FieldError
        When something is met that is no structured grid.
    """
    if is_reader(source):
        yield from _read(source)
    elif isinstance(source, (list, tuple)):
        if not source:
            msg = "the list of meshes is empty; expected one structured mesh for each time step"
            raise FieldError(msg)
        for n, item in enumerate(source):
            yield _single(item, f"step {n}")
    else:
        yield from _blocks(_wrapped(source, "the mesh"))


def is_reader(source: Any) -> bool:
    """Whether this is one of PyVista's readers."""
    return hasattr(source, "read") and (hasattr(source, "time_values") or hasattr(source, "reader"))


def is_structured(mesh: Any) -> bool:
    """Whether this is a mesh with an order of nodes along i, j and k."""
    import pyvista as pv

    return isinstance(mesh, (pv.StructuredGrid, pv.RectilinearGrid, pv.ImageData))


def leaves(mesh: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Go through the meshes in a tree of blocks, with their paths; empty blocks are left out."""
    import pyvista as pv

    if not isinstance(mesh, pv.MultiBlock):
        yield name, mesh
        return
    keys: list[Any] = mesh.keys()
    for number, (key, block) in enumerate(zip(keys, mesh, strict=True)):
        if block is not None:
            own = str(number) if key is None else key
            yield from leaves(block, f"{name}/{own}" if name else own)


def _read(reader: Any) -> Iterator[Step]:
    """Read one time after the other, and leave the reader at the time it was set to."""
    times = list(getattr(reader, "time_values", None) or [])
    if len(times) < 2 or not hasattr(reader, "set_active_time_value"):
        for step in _blocks(_wrapped(reader.read(), "the mesh")):
            time = step.time if len(times) != 1 else float(times[0])
            yield Step(step.grid, time, step.label)
        return
    before = reader.active_time_value
    try:
        for n, time in enumerate(times):
            reader.set_active_time_value(time)
            step = _single(reader.read(), f"step {n}")
            yield Step(step.grid, float(time), step.label)
    finally:
        reader.set_active_time_value(before)


def _blocks(mesh: Any) -> Iterator[Step]:
    """Take a mesh for one step, and a MultiBlock of several grids for a series."""
    found = [(name, block) for name, block in leaves(mesh) if is_structured(block)]
    usable = [(name, block) for name, block in found if _is_surface(block)] or found
    if len(usable) < 2:
        yield _single(mesh, "the mesh")
        return
    for name, block in usable:
        yield Step(block, _time(block), f"block {name!r}")


def _single(item: Any, label: str) -> Step:
    """Return the only structured grid in a mesh or a MultiBlock."""
    mesh = _wrapped(item, label)
    found = [block for _, block in leaves(mesh) if is_structured(block)]
    usable = [block for block in found if _is_surface(block)] or found
    if len(usable) == 1:
        time = _time(usable[0])
        return Step(usable[0], _time(mesh) if time is None else time, label)
    if usable:
        sizes = "; ".join(count_nodes(block.dimensions) for block in usable)
        msg = (
            f"{label} has {len(usable)} structured blocks: {sizes}; give the one to draw: "
            "mesh[0], or block=0 for a file"
        )
        raise FieldError(msg)
    raise FieldError(_unstructured(mesh, label))


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
        f"{label} is {what}, and no structured grid: its nodes have no order along i and j, which "
        "the method needs. Sample it onto a grid, as in pyvista.ImageData(dimensions=(400, 300, "
        "1), spacing=..., origin=...).sample(mesh), or draw it with ParaView's Surface LIC, which "
        "takes any mesh"
    )
