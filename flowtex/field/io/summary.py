"""What a mesh file holds, in numbers and words, whether or not a flow can be drawn from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from flowtex.errors import FieldError
from flowtex.field.io import mesh_arrays
from flowtex.field.io.meshes import is_structured, leaves, steps
from flowtex.field.io.planes import count_nodes, plane_faults

__all__ = ["ArraySummary", "FileSummary", "summarize"]


@dataclass(frozen=True)
class ArraySummary:
    """One array of a file.

    Attributes
    ----------
    name
        Its name.
    where
        What its values belong to.
    components
        How many numbers there are at each point or cell.
    low, high
        Range of the finite values, of the lengths where there are several components; NaN when
        there is none.
    """

    name: str
    where: Literal["points", "cells"]
    components: int
    low: float
    high: float


@dataclass(frozen=True)
class FileSummary:
    """What a file holds.

    Attributes
    ----------
    path
        The file.
    grid
        Type of its mesh: of the first structured block where it has several.
    dimensions
        Number of nodes (I, J, K), or ``None`` for an unstructured mesh.
    blocks
        Paths of the blocks that hold something, when there are several.
    arrays
        Arrays on points and on cells.
    candidates
        Names of the arrays that may be the velocity.
    times
        Times of a series; empty for a single mesh.
    blanked
        Number of nodes that the file hides.
    problem
        What keeps :func:`flowtex.field.io.files.from_file` from reading it as it stands; empty
        when nothing does.
    """

    path: Path
    grid: str
    dimensions: tuple[int, int, int] | None
    blocks: tuple[str, ...]
    arrays: tuple[ArraySummary, ...]
    candidates: tuple[str, ...]
    times: tuple[float, ...]
    blanked: int
    problem: str

    def __str__(self) -> str:
        lines = [f"{self.path}", f"  grid      {self.grid}"]
        if self.dimensions is not None:
            lines[-1] += f", {count_nodes(self.dimensions)}, {self.blanked} blanked"
        if len(self.blocks) > 1:
            lines.append(f"  blocks    {', '.join(self.blocks)}")
        if self.times:
            ends = f"{self.times[0]:g} to {self.times[-1]:g}"
            lines.append(f"  times     {len(self.times)}, {ends}")
        lines += [f"  array     {_line(array)}" for array in self.arrays]
        lines.append(f"  vectors   {', '.join(self.candidates) or 'none found'}")
        lines.append(f"  to draw   {self.problem or 'nothing else is needed'}")
        return "\n".join(lines)


def summarize(path: Path, mesh: Any, times: Sequence[float], vectors: str | None) -> FileSummary:
    """Summarize what was read from a file.

    Parameters
    ----------
    path
        The file.
    mesh
        The mesh, or the first step of a series.
    times
        Times of the series; empty for a single mesh.
    vectors
        Name of the velocity where the format fixes it.
    """
    parts = list(leaves(mesh))
    part = next((p for _, p in parts if is_structured(p)), parts[0][1] if parts else mesh)
    structured = is_structured(part)
    hidden = mesh_arrays.hidden_nodes(part) if structured else None
    data = hasattr(part, "point_data")
    found = [a.name for a in mesh_arrays.candidates(part)] if data else []
    return FileSummary(
        path=path,
        grid=type(part).__name__,
        dimensions=tuple(part.dimensions) if structured else None,
        blocks=tuple(name for name, _ in parts) if len(parts) > 1 else (),
        arrays=tuple(_array(part, a) for a in mesh_arrays.catalogue(part)) if data else (),
        candidates=(vectors,) if vectors is not None else tuple(found),
        times=tuple(times),
        blanked=0 if hidden is None else int(hidden.sum()),
        problem=_problem(mesh, vectors),
    )


def _problem(mesh: Any, vectors: str | None) -> str:
    """Say what a field could not be made without being told, or why not at all."""
    try:
        found = list(steps(mesh))
    except FieldError as error:
        return str(error)
    dimensions = tuple(found[0].grid.dimensions)
    if any(tuple(step.grid.dimensions) != dimensions for step in found):
        return "the file has several grids: choose one of the blocks, as in block=0"
    faults = plane_faults(dimensions, None)
    if min(dimensions) > 0:
        faults += mesh_arrays.vector_faults(found[0].grid, vectors)
    return "; ".join(faults)


def _array(mesh: Any, array: mesh_arrays.MeshArray) -> ArraySummary:
    low = high = float("nan")
    if array.numeric:
        values = mesh_arrays.values_of(mesh, array).astype(np.float64)
        if array.components > 1:
            values = np.linalg.norm(values.reshape(len(values), -1), axis=1)
        values = values[np.isfinite(values)]
        if len(values):
            low, high = float(values.min()), float(values.max())
    return ArraySummary(array.name, array.where, array.components, low, high)


def _line(array: ArraySummary) -> str:
    kind = "lengths" if array.components > 1 else "values"
    numbers = "number" if array.components == 1 else "numbers"
    known = np.isfinite(array.low)
    span = f"{kind} {array.low:g} to {array.high:g}" if known else "no finite values"
    return f"{array.name}: {array.components} {numbers} on {array.where}, {span}"
