"""A summary of a mesh file, whether or not a flow can be drawn from it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.files import OpenFile, open_file
from flowtex.sources.meshes.nodes import hidden_nodes
from flowtex.sources.meshes.parts import (
    drawn_parts,
    is_reader,
    leaves,
    part_size,
    parts_of,
    pick,
    several_fault,
    time_steps,
    times_of,
)
from flowtex.sources.meshes.read import choose
from flowtex.sources.meshes.vectors import MeshArray, candidates, catalogue, values_of
from flowtex.sources.reader_errors import errors_of_file
from flowtex.sources.record import Record


class ArraySummary(NamedTuple):
    """One array, its finite range, that of lengths for a vector, and its components' names."""

    name: str
    where: Literal["points", "cells"]
    components: int
    low: float
    high: float
    parts: tuple[str, ...] = ()


class BlockSummary(NamedTuple):
    """One block: its path, and the number that counts those with cells; ``None`` for others."""

    name: str
    number: int | None
    grid: str
    size: str = ""


@dataclass(frozen=True)
class FileSummary:
    """The content of a file."""

    path: Path
    grid: str  #: Type of its mesh: of the default block if it has several.
    size: str  #: As text.
    cells: dict[str, int]  #: Number of cells of an unstructured mesh by kind.
    bounds: tuple[tuple[float, float], ...]  #: ((x, x), (y, y), (z, z)).
    volume: bool  #: Whether a volume can be cut.
    blocks: tuple[BlockSummary, ...]  #: Blocks with content, if there are several.
    arrays: tuple[ArraySummary, ...]
    candidates: tuple[str, ...]  #: Names of possible velocities.
    times: tuple[float, ...]
    blanked: int  #: Number of hidden nodes.
    problem: str  #: The reason if :meth:`FlowField.from_file` cannot read it without choices.


def describe(path: str | Path, block: int | str | None = None) -> FileSummary:
    """Summarize the first step of a file, whether or not a flow can be drawn from it."""
    with errors_of_file(path):
        file = open_file(path)
        mesh = file.source.read() if is_reader(file.source) else file.source
        mesh = mesh[0].grid if isinstance(mesh, list) else mesh
        return _summary(file, mesh, block)


def _summary(file: OpenFile, mesh: Any, block: int | str | None) -> FileSummary:
    parts, meshes = list(leaves(mesh)), list(parts_of(mesh))
    drawn = list(drawn_parts(mesh)[0].values())
    part = (drawn or [p for _, p in parts] or [mesh])[0] if block is None else pick(mesh, block)
    is_mesh = hasattr(part, "point_data")
    arrays = catalogue(part) if is_mesh else []
    velocities = candidates(part) if is_mesh else []
    names = dict.fromkeys(a.name for a in velocities) if file.velocity is None else [file.velocity]
    times = times_of(file.source)
    if isinstance(file.source, list):
        times = [float(step.time) for step in file.source]
    series, whole = len(times) > 1, mesh if block is None else part
    blocks = (
        BlockSummary(name, meshes.index(name), type(p).__name__, part_size(p))
        if name in meshes
        else BlockSummary(name, None, type(p).__name__)
        for name, p in parts
    )
    return FileSummary(
        path=file.path,
        grid=type(part).__name__,
        size=part_size(part) if is_mesh else "",
        cells=_cells(part),
        bounds=tuple(zip(part.bounds[::2], part.bounds[1::2], strict=True)) if is_mesh else (),
        volume=is_mesh and part.max_cell_dimensionality == 3,
        blocks=tuple(blocks) if len(parts) > 1 else (),
        arrays=tuple(_array(part, a) for a in (*arrays, *(a for a in velocities if a.parts))),
        candidates=tuple(names),
        times=tuple(times),
        blanked=int(hidden_nodes(part).sum()) if is_mesh else 0,
        problem=file.problem or _problem(whole, file.velocity, series=series),
    )


def _cells(mesh: Any) -> dict[str, int]:
    """Count the cells of each kind of an unstructured mesh, by names such as ``"tetra"``."""
    import pyvista as pv

    if isinstance(mesh, pv.PolyData):
        mesh = mesh.cast_to_unstructured_grid()
    if not isinstance(mesh, pv.UnstructuredGrid):
        return {}
    types, counts = np.unique(np.asarray(mesh.celltypes), return_counts=True)
    names = [pv.CellType(int(kind)).name.lower().replace("_", " ") for kind in types]
    return dict(zip(names, map(int, counts), strict=True))


def _problem(mesh: Any, vectors: str | None, *, series: bool) -> str:
    """Return the choice that a field requires, or the reason why none can be made."""
    if drawn_parts(mesh, series=series)[1] == "choose":
        return several_fault(mesh, "the file")
    try:
        choose(next(time_steps(mesh)).grid, vectors, None, None, Record())
    except FieldError as error:
        return str(error)
    return ""


def _array(mesh: Any, array: MeshArray) -> ArraySummary:
    values = values_of(mesh, array).astype(np.float64) if array.numeric else np.empty(0)
    if array.components > 1:
        values = np.linalg.norm(values.reshape(-1, array.components), axis=1)
    values = values[np.isfinite(values)]
    ends = (float(values.min()), float(values.max())) if len(values) else (np.nan, np.nan)
    return ArraySummary(array.name, array.where, array.components, *ends, array.parts)
