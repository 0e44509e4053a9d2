"""What a PyVista object holds: structured grids, their times, their arrays, and what they hide.

A grid, a block of a MultiBlock, a list of grids and a reader of a time series all come down to a
sequence of :class:`TimeStep`. Grids are handed out one at a time, so that a long series is never
in memory as a whole.

Meshes hide nodes and cells in several ways: VTK's ghost arrays on points and on cells, PLOT3D's
``IBlank``, and the mask of points that a sampling filter missed.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from flowtex._util.array_types import AnyArray, Bools
from flowtex.errors import FieldError
from flowtex.field.io.planes import count_nodes

__all__ = [
    "MeshArray",
    "TimeStep",
    "candidates",
    "catalogue",
    "choose_vectors",
    "hidden_nodes",
    "is_reader",
    "is_structured",
    "leaves",
    "time_steps",
    "times_of",
    "values_of",
    "vector_faults",
    "visible_cells",
]

#: Arrays that say what is hidden and nothing about the flow.
_BLANKING = {"vtkGhostType", "IBlank", "vtkValidPointMask"}
#: Flags of VTK's ghost arrays that hide: a hidden point; a refined or a hidden cell. Points and
#: cells that are duplicates of a neighbouring piece carry data and count as visible.
_HIDDEN_POINT, _HIDDEN_CELL = 2, 8 | 32

_NO_VELOCITY = re.compile(
    r".*normals?|.*texture.?coord.*|t_?coords?|coord(inate)?s?|points?|positions?", re.IGNORECASE
)


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
            yield item if isinstance(item, TimeStep) else _single(item, f"step {n}")
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
            mesh = reader.read()
            step = _single(mesh if block is None else _pick(mesh, block), f"step {n}")
            yield TimeStep(step.grid, time, step.label)
    finally:
        reader.set_active_time_value(before)


def _pick(mesh: Any, block: int | str) -> Any:
    """Pick one of several structured grids, by number or by name."""
    grids = [(name, grid) for name, grid in leaves(mesh) if is_structured(grid)]
    for number, (name, grid) in enumerate(grids):
        if block in (number, name):
            return grid
    listed = ", ".join(f"{number} ({name})" for number, (name, _) in enumerate(grids)) or "none"
    msg = f"block is {block!r}; the structured blocks of the file are: {listed}"
    raise FieldError(msg)


def _blocks(mesh: Any, block: int | str | None) -> Iterator[TimeStep]:
    """Take a mesh for one step, and a MultiBlock of several grids for a series."""
    if block is not None:
        mesh = _pick(mesh, block)
    grids = [(name, block) for name, block in leaves(mesh) if is_structured(block)]
    usable = [(name, block) for name, block in grids if _is_surface(block)] or grids
    if len(usable) < 2:
        yield _single(mesh, "the mesh")
        return
    for name, block in usable:
        yield TimeStep(block, _time(block), f"block {name!r}")


def _single(item: Any, label: str) -> TimeStep:
    """Return the only structured grid in a mesh or a MultiBlock."""
    mesh = _wrapped(item, label)
    grids = [block for _, block in leaves(mesh) if is_structured(block)]
    usable = [block for block in grids if _is_surface(block)] or grids
    if len(usable) == 1:
        time = _time(usable[0])
        return TimeStep(usable[0], _time(mesh) if time is None else time, label)
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


@dataclass(frozen=True)
class MeshArray:
    """An array of a mesh: its name, where its values are, and how many there are at each."""

    name: str
    where: Literal["points", "cells"]
    components: int
    numeric: bool
    real: bool

    def __str__(self) -> str:
        return f"{self.name} ({self.where}, {self.components})"


def catalogue(mesh: Any) -> list[MeshArray]:
    """List the arrays on the points and cells of a mesh, without those that only hide."""
    arrays = []
    for where, data in (("points", mesh.point_data), ("cells", mesh.cell_data)):
        for name in data:
            if name in _BLANKING:
                continue
            array = np.asarray(data[name])
            arrays.append(
                MeshArray(
                    name=name,
                    where="points" if where == "points" else "cells",
                    components=int(np.prod(array.shape[1:], dtype=int)),
                    numeric=array.dtype.kind in "fiub",
                    real=array.dtype.kind == "f",
                )
            )
    return arrays


def values_of(mesh: Any, array: MeshArray) -> AnyArray:
    """Return the values of an array, (N,) or (N, C)."""
    data = mesh.point_data if array.where == "points" else mesh.cell_data
    return np.asarray(data[array.name])


def candidates(mesh: Any) -> list[MeshArray]:
    """Arrays that may be the velocity: real, two or three components, no normals or positions."""
    named = set()
    for data in (mesh.GetPointData(), mesh.GetCellData()):
        named |= {a.GetName() for a in (data.GetNormals(), data.GetTCoords()) if a is not None}
    return [
        array
        for array in catalogue(mesh)
        if array.real
        and array.components in (2, 3)
        and array.name not in named
        and not _NO_VELOCITY.fullmatch(array.name)
    ]


def vector_faults(mesh: Any, vectors: Any) -> list[str]:
    """Faults in a choice of vectors; ``None`` stands for the only ones there are."""
    arrays = catalogue(mesh)
    listed = ", ".join(map(str, arrays)) or "none"
    if vectors is None:
        return _search_faults(mesh, listed)
    named = [a for a in arrays if a.name == vectors]
    if not named:
        close = difflib.get_close_matches(str(vectors), [a.name for a in arrays], n=1)
        hint = f'. Did you mean "{close[0]}"?' if close else "."
        return [
            f"vectors is {vectors!r}, and the mesh has no such array{hint} Its arrays, with their "
            f"components: {listed}"
        ]
    if not any(a.numeric and a.components in (2, 3) for a in named):
        return [
            f"vectors is {vectors!r}, an array of {named[0].components} component(s); expected 2 "
            f"or 3 numbers at each point or cell. The arrays of the mesh, with their components: "
            f"{listed}"
        ]
    return []


def choose_vectors(mesh: Any, vectors: str | None) -> MeshArray:
    """Return the vectors that are meant; :func:`vector_faults` returned none before."""
    if vectors is None:
        return _preferred(mesh)[0]
    fits = [a for a in catalogue(mesh) if a.name == vectors and a.components in (2, 3)]
    return next(a for a in fits if a.numeric)


def _preferred(mesh: Any) -> list[MeshArray]:
    """Candidates, or the single one that the mesh itself marks as its vectors."""
    arrays = candidates(mesh)
    active = mesh.active_vectors_name
    # VTK's PLOT3D reader marks the momentum by itself: that is no one's choice.
    if active == "Momentum" and any(a.name == "Velocity" for a in arrays):
        active = None
    return [a for a in arrays if a.name == active][:1] or arrays


def _search_faults(mesh: Any, listed: str) -> list[str]:
    arrays = _preferred(mesh)
    if not arrays:
        return [
            "the mesh has no vectors that could be the velocity; expected a point or cell array "
            f"of real numbers with 2 or 3 components. Its arrays, with their components: {listed}. "
            'Join single components with mesh["velocity"] = numpy.column_stack((u, v, w))'
        ]
    if len(arrays) > 1:
        return [
            f"the mesh has {len(arrays)} arrays that could be the velocity: "
            f'{", ".join(map(str, arrays))}; choose one, as in vectors="{arrays[-1].name}"'
        ]
    return []


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
