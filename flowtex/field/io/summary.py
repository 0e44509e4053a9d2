"""A summary of a mesh file, whether or not a flow can be drawn from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from flowtex.errors import FieldError
from flowtex.field.io.files import OpenFile, open_file
from flowtex.field.io.meshes import (
    hidden_nodes,
    is_reader,
    is_structured,
    leaves,
    pick,
    several_fault,
    several_grids,
    time_steps,
    times_of,
)
from flowtex.field.io.planes import plane_faults
from flowtex.field.io.reader_errors import errors_of_file
from flowtex.field.io.vectors import (
    MeshArray,
    candidates,
    catalogue,
    values_of,
    vector_faults,
)

__all__ = ["ArraySummary", "BlockSummary", "FileSummary", "describe"]


@dataclass(frozen=True)
class ArraySummary:
    """One array of a file.

    ``components`` is the count of numbers at each point or cell; ``low`` and ``high`` are the range
    of the finite values, of the lengths where there are several components, NaN where there are
    none. ``parts`` are the names of the arrays that make a vector together.
    """

    name: str
    where: Literal["points", "cells"]
    components: int
    low: float
    high: float
    parts: tuple[str, ...] = ()


@dataclass(frozen=True)
class BlockSummary:
    """One block of a file.

    ``name`` is its path, ``number`` what counts the structured ones, ``None`` for the others,
    ``dimensions`` the nodes along I, J and K.
    """

    name: str
    number: int | None
    grid: str
    dimensions: tuple[int, ...] | None


@dataclass(frozen=True)
class FileSummary:
    """What a file holds.

    Attributes
    ----------
    grid
        Type of its mesh: of the first structured block where it has several.
    dimensions
        Number of nodes (I, J, K), or ``None`` for an unstructured mesh.
    blocks
        The blocks that hold something, when there are several.
    candidates
        Names of the arrays that may be the velocity.
    times
        Times of a series; empty for a single mesh.
    blanked
        Number of nodes that the file hides.
    problem
        What keeps :meth:`FlowField.from_file` from reading it as it stands; empty if nothing.
    """

    path: Path
    grid: str
    dimensions: tuple[int, int, int] | None
    blocks: tuple[BlockSummary, ...]
    arrays: tuple[ArraySummary, ...]
    candidates: tuple[str, ...]
    times: tuple[float, ...]
    blanked: int
    problem: str


def describe(path: str | Path, block: int | str | None = None) -> FileSummary:
    """Summarize a file, whether or not a flow can be drawn from it; the first step of a series.

    The arrays are those of the block, by its name or number, or of the first structured one.
    Raises a FieldError when the file cannot be read at all, or has no such block.
    """
    with errors_of_file(path):
        file = open_file(path)
        mesh = file.source.read() if is_reader(file.source) else file.source
        return _summary(file, mesh, block)


def _summary(file: OpenFile, mesh: Any, block: int | str | None) -> FileSummary:
    parts = list(leaves(mesh))
    part = next((p for _, p in parts if is_structured(p)), parts[0][1] if parts else mesh)
    if block is not None:
        part = pick(mesh, block)
    structured = is_structured(part)
    data = hasattr(part, "point_data")
    arrays = catalogue(part) if data else []
    found = candidates(part) if data else []
    vectors = file.velocity
    names = dict.fromkeys(array.name for array in found) if vectors is None else [vectors]
    times = times_of(file.source)
    return FileSummary(
        path=file.path,
        grid=type(part).__name__,
        dimensions=tuple(part.dimensions) if structured else None,
        blocks=tuple(_blocks(parts)) if len(parts) > 1 else (),
        arrays=tuple(_array(part, a) for a in (*arrays, *(a for a in found if a.parts))),
        candidates=tuple(names),
        times=tuple(times),
        blanked=int(hidden_nodes(part).sum()) if structured else 0,
        problem=_problem(mesh if block is None else part, vectors, series=len(times) > 1),
    )


def _blocks(parts: list[tuple[str, Any]]) -> Iterator[BlockSummary]:
    number = 0
    for name, part in parts:
        structured = is_structured(part)
        dimensions = tuple(part.dimensions) if structured else None
        yield BlockSummary(name, number if structured else None, type(part).__name__, dimensions)
        number += structured


def _problem(mesh: Any, vectors: str | None, *, series: bool) -> str:
    """Return what has to be chosen to make a field, or why none can be made."""
    if several := several_grids(mesh, series=series):
        return several_fault(several, "the file")
    try:
        first = next(time_steps(mesh))
    except FieldError as error:
        return str(error)
    dimensions = tuple(first.grid.dimensions)
    faults = plane_faults(dimensions, None)
    if min(dimensions) > 0:
        faults += vector_faults(first.grid, vectors)
    return "; ".join(faults)


def _array(mesh: Any, array: MeshArray) -> ArraySummary:
    low = high = float("nan")
    if array.numeric:
        values = values_of(mesh, array).astype(np.float64)
        if array.components > 1:
            values = np.linalg.norm(values.reshape(len(values), -1), axis=1)
        values = values[np.isfinite(values)]
        if len(values):
            low, high = float(values.min()), float(values.max())
    return ArraySummary(array.name, array.where, array.components, low, high, array.parts)
