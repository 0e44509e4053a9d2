"""The content of a PyVista object: meshes, blocks and their times.

A mesh, a block of a MultiBlock, a list of meshes and a reader of a time series all become a
sequence of :class:`TimeStep`. Meshes are yielded one at a time, so that a long series is never in
memory as a whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
import scipy

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex.errors import FieldError
from flowtex.remedies import Remedy
from flowtex.sources.meshes import borders
from flowtex.sources.meshes.cells import check_mesh
from flowtex.sources.meshes.meshio_files import of_meshio
from flowtex.sources.meshes.vectors import (
    BLANKING,
    SHOWN,
    MeshArray,
    Sheet,
    candidates,
    catalogue,
    data_of,
)
from flowtex.sources.meshes.zone_planes import planes_of
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import pyvista as pv

#: Blocks by their paths.
Parts: TypeAlias = "dict[str, pv.DataSet]"

#: Nodes of two steps closer than this share of the extent of the mesh are the same.
SAME_NODE_SHARE = 1e-6
#: Bit of VTK's ghost type of the cells that are copies of other partitions' cells.
COPIED = 1
#: Most blocks that a message lists.
MOST_LISTED = 12
#: Length of a gap in usual steps from which on a notice is issued.
GAP_STEPS = 8
#: Libraries, their classes, and how their objects become data that are read.
OTHERS = (
    ("netCDF4", "Dataset", "xarray.open_dataset(data.filepath())"),
    ("iris", "Cube", "[xarray.DataArray.from_iris(cube) for cube in (u, v)]"),
    ("polars", "LazyFrame", "data.collect()"),
    ("dask", "DataFrame", "data.compute()"),
    ("pyarrow", "Table", "data.to_pandas()"),
)
PARTS = "If these are parts of one mesh and not time steps, give one of them, as in block=0"


@dataclass(frozen=True)
class TimeStep:
    """One mesh and its time, or ``None`` if it has none."""

    grid: Any
    time: float | None
    label: str
    is_plane: bool = False  #: Whether it is already the plane of several volumes.


def time_steps(
    source: Any,
    block: int | str | None = None,
    *,
    cut: bool = False,
    plane: str | None = None,
    record: Record | None = None,
) -> Iterator[TimeStep]:
    """Yield the time steps of a mesh, blocks, a list or a reader, or of one block of these.

    Parameters
    ----------
    source
        A mesh, a list with one mesh for each step, or a PyVista reader.
    block
        Number or name of a block.
    cut
        Whether a cut is drawn, for which volumes are read as a whole.
    plane
        Plane of structured volumes, which is drawn in all blocks together.
    record
        Record of what was chosen automatically.

    Raises
    ------
    FieldError
        When the list is empty, an item is no mesh, or the block does not exist.
    """
    if record is None:
        record = Record()
    options: dict[str, Any] = {"cut": cut, "plane": plane, "record": record}
    if is_reader(source):
        yield from _read(source, block, **options)
    elif isinstance(source, (list, tuple)):
        if not source:
            raise FieldError("the list of meshes is empty; expected one mesh for each time step")
        for n, item in enumerate(source):
            if isinstance(item, TimeStep):
                yield item if block is None else replace(item, grid=pick(item.grid, block))
            else:
                yield from _steps(item, f"step {n}", block, series=True, **options)
    else:
        yield from _steps(source, "the mesh", block, series=False, **options)


def is_reader(source: Any) -> bool:
    """Return whether this is one of PyVista's readers."""
    if _is_of_vtk(source):
        return False
    return hasattr(source, "read") and (hasattr(source, "time_values") or hasattr(source, "reader"))


def is_structured(mesh: Any) -> bool:
    """Return whether a mesh has nodes along i, j and k."""
    import pyvista as pv

    return isinstance(mesh, (pv.StructuredGrid, pv.RectilinearGrid, pv.ImageData))


def times_of(source: Any) -> list[float]:
    """Return the times of a reader; empty for a mesh, or without a series."""
    if _is_of_vtk(source):
        return []
    return [float(t) for t in getattr(source, "time_values", None) or []]


def _is_of_vtk(source: Any) -> bool:
    """Return whether this is a mesh, of which asking for an attribute loads all accessors."""
    return hasattr(type(source), "IsA")


def leaves(mesh: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the meshes in a tree of blocks by path; equal names get their number."""
    import pyvista as pv

    mesh = joined(mesh)
    if not isinstance(mesh, pv.MultiBlock):
        yield name, mesh
        return
    keys: list[Any] = mesh.keys()
    for number, (key, block) in enumerate(zip(keys, mesh, strict=True)):
        if block is not None:
            if key is None:
                label = str(number)
            else:
                label = key
            if not (keys.count(key) == 1 or key is None):
                label = f"{label} {number}"
            yield from leaves(block, f"{name}/{label}" if name else label)


def joined(mesh: Any) -> Any:
    """Return the partitions of one mesh as this mesh, structured ones as blocks."""
    import pyvista as pv

    if not isinstance(mesh, pv.PartitionedDataSet):
        return mesh
    pieces = pv.MultiBlock()
    for piece in mesh:
        if piece is not None and piece.n_cells:
            pieces.append(_without_copies(piece))
    if len(pieces) < 2 or any(map(is_structured, pieces)):
        return pieces
    return pieces.combine(merge_points=True, tolerance=0.0)


def _without_copies(piece: pv.DataSet) -> pv.DataSet:
    """Return a partition without the cells that are copies of those of others."""
    ghosts = np.asarray(piece.cell_data.get("vtkGhostType", np.zeros(0)), dtype=np.uint8)
    copies = (ghosts & COPIED) > 0
    if not copies.any() or is_structured(piece):
        return piece
    kept: Any = np.flatnonzero(~copies)
    return piece.extract_cells(kept)


def parts_of(mesh: Any) -> Parts:
    """Return the meshes in a tree of blocks by their paths; those without cells are left out."""
    import pyvista as pv

    meshes = {name: part for name, part in leaves(mesh) if isinstance(part, pv.DataSet)}
    return {name: part for name, part in meshes.items() if part.n_cells} or meshes


def drawn_parts(
    mesh: Any, *, series: bool = False, cut: bool = False
) -> tuple[Parts, Literal["one", "steps", "together", "choose"]]:
    """Return the blocks of a mesh to draw by default, and how to combine them.

    Volumes are cut ``together``, and surfaces are drawn together. Structured grids take precedence
    over their surroundings. Those with the same nodes are time ``steps``, unless the mesh is one
    step of a ``series``. Structured surfaces that meet at their borders are drawn together. Of
    several others one must be chosen.
    """
    parts = parts_of(mesh)
    grids = {name: part for name, part in parts.items() if is_structured(part)}
    dimensions = {name: part.max_cell_dimensionality for name, part in parts.items()}
    flat = {n: p for n, p in parts.items() if dimensions[n] == 2}
    solid = {n: p for n, p in parts.items() if dimensions[n] == 3}
    usable = {name: grid for name, grid in grids.items() if dimensions[name] > 1}
    drawn = (solid if cut else {}) or usable or grids or solid or flat or parts
    if len(drawn) < 2:
        return drawn, "one"
    if not series and _same_nodes(list(drawn.values())):
        return drawn, "steps"
    whole = drawn is flat or (drawn is solid and cut)
    if whole or borders.meet(list(drawn.values())):
        return drawn, "together"
    return drawn, "choose"


def _same_nodes(meshes: list[pv.DataSet]) -> bool:
    first = np.asarray(meshes[0].bounds)
    near = SAME_NODE_SHARE * max(float(np.ptp(first.reshape(3, 2), axis=1).max()), 0.0)
    same = (np.abs(np.asarray(mesh.bounds) - first).max() <= near for mesh in meshes)
    return len({part_size(mesh) for mesh in meshes}) == 1 and all(same)


def part_size(mesh: Any) -> str:
    """Return the size of a mesh as text."""
    if is_structured(mesh):
        return " x ".join(map(str, mesh.dimensions)) + " nodes"
    return f"{mesh.n_points:,} points, {mesh.n_cells:,} cells"


def several_fault(mesh: Any, label: str) -> str:
    """Return the message for a choice of several blocks."""
    parts = parts_of(mesh)
    listed = [f"{n} ({name}, {part_size(parts[name])})" for n, name in enumerate(parts)]
    if len(listed) > MOST_LISTED:
        more = ", ..."
    else:
        more = ""
    solid = any(part.max_cell_dimensionality == 3 for part in parts.values())
    others = ""
    volumes = _volumes(mesh)
    if len(volumes) > 1:
        middle = next(iter(volumes.values())).dimensions[2] // 2
        others = f', draw a plane of all, as in plane="k={middle}"'
    if solid:
        others += ', or cut all volumes, as in slice="z"'
    return (
        f"{label} has {len(parts)} blocks that are not time steps of one mesh: "
        f'{", ".join(listed[:MOST_LISTED])}{more}; choose one, as in block="{next(iter(parts))}"'
        f"{others}"
    )


def read_checked(reader: Any) -> Any:
    """Read what a reader is set to, and check it before any filter of VTK sees it."""
    mesh = reader.read()
    check_mesh(mesh)
    return joined(mesh)


def _read(reader: Any, block: int | str | None, **options: Any) -> Iterator[TimeStep]:
    """Read one time after the other, and restore the time of the reader."""
    times = times_of(reader)
    if len(times) < 2 or not hasattr(reader, "set_active_time_value"):
        for step in _steps(reader.read(), "the mesh", block, series=False, **options):
            yield step if len(times) != 1 else replace(step, time=times[0])
        return
    before = reader.active_time_value
    try:
        for n, time in enumerate(times):
            reader.set_active_time_value(time)
            for step in _steps(reader.read(), f"step {n}", block, series=True, **options):
                yield replace(step, time=time)
    finally:
        reader.set_active_time_value(before)


def pick(mesh: Any, block: int | str) -> pv.DataSet:
    """Return one of the meshes in a mesh, by number, path or the last name of the path.

    Raises
    ------
    FieldError
        When there is no such block, or several have the name.
    """
    parts = parts_of(mesh)
    ends = [name for name in parts if name.rpartition("/")[2] == block]
    for number, (name, part) in enumerate(parts.items()):
        if block in (number, name) or ends == [name]:
            return part
    if not parts:
        raise FieldError(_no_mesh(mesh, "the mesh"))
    listed = ", ".join(f"{number} ({name})" for number, name in enumerate(parts))
    raise FieldError(f"block is {block!r}; the blocks of the file are: {listed}")


def _steps(
    item: Any,
    label: str,
    block: int | str | None,
    *,
    series: bool,
    cut: bool,
    plane: str | None,
    record: Record,
) -> Iterator[TimeStep]:
    """Yield the mesh to draw of a mesh or a MultiBlock, or blocks with the same nodes as steps."""
    whole = _wrapped(item, label)
    zones = {}
    if block is None and plane is not None:
        zones = _volumes(whole)
    if len(zones) > 1:
        planes = planes_of(zones, plane or "", record)
        yield TimeStep(_together(planes, record), _time(whole), label, is_plane=True)
        return
    drawn, combination = drawn_parts(
        whole if block is None else pick(whole, block), series=series, cut=cut
    )
    if not drawn:
        raise FieldError(_no_mesh(whole, label))
    if combination == "choose":
        raise FieldError(several_fault(whole, label))
    if combination == "steps":
        record("align", f"{len(drawn)} blocks with the same nodes are the time steps")
        for name, part in drawn.items():
            yield TimeStep(part, _time(part), f"block {name!r}")
        return
    part = next(iter(drawn.values()))
    time = _time(whole)
    if time is None:
        time = _time(part)
    yield TimeStep(part if combination == "one" else _together(drawn, record), time, label)


def _volumes(whole: Any) -> Parts:
    """Return the structured volumes among blocks, unless they are steps of one."""
    volumes = {}
    for name, part in parts_of(whole).items():
        if is_structured(part) and part.max_cell_dimensionality == 3:
            volumes[name] = part
    if len(volumes) > 1 and _same_nodes(list(volumes.values())):
        return {}
    return volumes


def _together(parts: Parts, record: Record) -> pv.UnstructuredGrid:
    """Return blocks with vectors as one mesh; scalars are NaN where a block lacks them."""
    import pyvista as pv

    moving = {name: part for name, part in parts.items() if candidates(part)} or parts
    still = [name for name in parts if name not in moving]
    if still:
        record("select", f"{', '.join(still)} has no vectors, and is not drawn", notable=True)
    parts = moving
    text = f"{len(parts)} blocks are drawn together: {', '.join(parts)}"
    name = next(iter(parts))
    number: int | str = name
    if name.isdecimal():
        number = int(name)
    record("align", text, Remedy("block", number, "to draw one of them,"), notable=True)
    blocks = {name: part.copy(deep=False) for name, part in parts.items()}
    scalars = [a for b in blocks.values() for a in catalogue(b) if a.numeric and a.components == 1]
    for array, where in sorted({(a.name, a.where) for a in scalars}):
        lacking = [name for name, block in blocks.items() if array not in data_of(block, where)]
        for block in blocks.values() if lacking else ():
            if where == "points":
                count = block.n_points
            else:
                count = block.n_cells
            data = data_of(block, where)
            if array in data:
                values = np.asarray(data[array])
            else:
                values = np.full(count, np.nan)
            data[array] = values.astype(np.float64)  # of one type, as others are dropped
        if lacking:
            record("align", f"{array!r} has no values in {', '.join(lacking)}", notable=True)
    _complete_masks(blocks)
    whole = pv.MultiBlock(list(blocks.values())).combine()
    if borders.meet(list(blocks.values())):
        return borders.joined(whole)
    return whole


def _complete_masks(blocks: Parts) -> None:
    """Give all blocks the arrays that hide nodes or cells of one, which are dropped otherwise."""
    for where in ("points", "cells"):
        data = [data_of(block, where) for block in blocks.values()]
        for name in BLANKING:
            present = [np.asarray(each[name]) for each in data if name in each]
            for each, block in zip(data, blocks.values(), strict=True):
                if present and name not in each:
                    if where == "points":
                        count = block.n_points
                    else:
                        count = block.n_cells
                    each[name] = np.full(count, SHOWN[name], present[0].dtype)


def _wrapped(source: Any, label: str) -> pv.DataObject:
    """Return a mesh of VTK or meshio as a checked PyVista mesh; ``label`` names it in errors."""
    import pyvista as pv

    if type(source).__module__.startswith("meshio"):
        source = of_meshio(source)
    if hasattr(source, "IsA") and source.IsA("vtkDataObject"):
        if isinstance(source, pv.DataObject):
            mesh = source
        else:
            mesh = pv.wrap(source)
        check_mesh(mesh)
        return joined(mesh)
    kind = type(source)
    for library, name, remedy in OTHERS:
        if kind.__module__.startswith(library) and kind.__name__ == name:
            raise FieldError(f"{label} is a {name} of {library}; pass {remedy}")
    raise FieldError(
        f"{label} has type {kind.__name__}; expected a PyVista mesh or MultiBlock, a list "
        "of them, or a reader; for others use FlowField.from_arrays, from_triangles or from_xarray"
    )


def _time(mesh: pv.DataObject) -> float | None:
    values = np.asarray(mesh.field_data.get("TimeValue", []), dtype=float).ravel()
    if len(values):
        return float(values[0])
    return None


def _no_mesh(mesh: pv.DataObject, label: str) -> str:
    if kinds := ", ".join(sorted({type(block).__name__ for _, block in leaves(mesh)})):
        return f"{label} is a {kinds}; expected a mesh, with points and cells"
    return f"{label} has no blocks; check the file or filter that made it"


def check_arrays(step: TimeStep, first: TimeStep, velocity: MeshArray) -> None:
    """Check that a step is of the kind of the first, and has its vectors.

    Raises
    ------
    FieldError
        When a structured step has another size, or an array of the velocity is missing.
    """
    sizes = [part_size(grid) for grid in (step.grid, first.grid)]
    if is_structured(first.grid) and sizes[0] != sizes[1]:
        text = f"{step.label} has {sizes[0]} and the first step has {sizes[1]}"
        raise FieldError(f"{text}; expected the same nodes in every step. {PARTS}")
    needed = [f"{part} ({velocity.where}, 1)" for part in velocity.parts] or [str(velocity)]
    arrays = list(map(str, catalogue(step.grid)))
    if missing := [array for array in needed if array not in arrays]:
        raise FieldError(
            f"{step.label} has no array {missing[0]}, which the first step has; expected it in "
            f"every step. Its arrays, with their numbers of components: {', '.join(arrays)}"
        )


def aligned(step: TimeStep, first: TimeStep) -> TimeStep:
    """Return a step in the order of nodes and cells of the first, itself if it has that order.

    Nodes are the same by their places. A step with others remains as it is, and
    :func:`check_nodes` raises an error if they are drawn.
    """
    grid = step.grid
    before = first.grid
    if grid is before:
        return step
    if (grid.n_points, grid.n_cells) != (before.n_points, before.n_cells) or _equal(grid, before):
        return step
    near = SAME_NODE_SHARE * before.length
    nodes = _order(before.points, grid.points, near)
    if nodes is None:
        return step
    cells = _order(before.cell_centers().points, grid.cell_centers().points, near)
    if cells is None or ((np.diff(nodes) > 0).all() and (np.diff(cells) > 0).all()):
        return step
    ordered = before.copy(deep=False)
    ordered.clear_data()
    for where, order in (("points", nodes), ("cells", cells)):
        for name, values in data_of(grid, where).items():
            data_of(ordered, where)[name] = np.asarray(values)[order]
    return replace(step, grid=ordered)


def _equal(grid: Any, before: Any) -> bool:
    """Return whether two meshes have equal positions and cells, as far as that is quick to see."""
    import pyvista as pv

    if isinstance(grid, pv.ImageData) and isinstance(before, pv.ImageData):
        matrices = grid.index_to_physical_matrix, before.index_to_physical_matrix
        return grid.extent == before.extent and np.array_equal(*matrices)
    names = {
        pv.RectilinearGrid: ("x", "y", "z"),
        pv.PolyData: ("points", "faces", "lines", "strips"),
        pv.UnstructuredGrid: ("points", "cells", "celltypes"),
    }.get(type(grid), ("points",))
    return all(np.array_equal(getattr(grid, n), getattr(before, n, ())) for n in names)


def _order(before: AnyArray, after: AnyArray, near: float) -> Indices | None:
    """Return the number of each place of a step in the order of the first; ``None`` if unknown."""
    before = np.asarray(before, dtype=np.float64)
    after = np.asarray(after, dtype=np.float64)
    if not (np.isfinite(before).all() and np.isfinite(after).all()):
        return None
    if np.abs(after - before).max(initial=0.0) <= near:
        return np.arange(len(before))
    distances, order = (np.asarray(found) for found in scipy.spatial.cKDTree(after).query(before))
    is_whole = distances.max(initial=0.0) <= near and len(np.unique(order)) == len(after)
    if is_whole:
        return order
    return None


def check_nodes(first: Sheet, sheet: Sheet, label: str) -> None:
    """Check that a step has the surface of the first.

    Parameters
    ----------
    first
        The surface of the first step.
    sheet
        The surface of the step.
    label
        What errors call the step.

    Raises
    ------
    FieldError
        When the surface has other nodes or triangles, or drawn nodes have moved.
    """
    before = first.points
    after = sheet.points
    if before.shape != after.shape or not np.array_equal(first.triangles, sheet.triangles):  # type: ignore[arg-type]
        raise FieldError(
            f"{label} has a surface of {len(after):,} nodes and the first step has one of "
            f"{len(before):,}, or other triangles; expected the same nodes and cells in every "
            f"step: sample all steps onto one mesh with mesh.sample(step). {PARTS}"
        )
    compared: Bools = first.shown & sheet.shown & np.isfinite(before + after).all(-1)
    moved = float(np.max(np.abs(after[compared] - before[compared]), initial=0.0))
    if moved > 0 and moved > SAME_NODE_SHARE * float(np.ptp(before[compared], axis=0).max()):
        raise FieldError(
            f"the nodes of {label} are up to {moved:.3g} away from those of the first step; sample "
            f"all steps onto one mesh with mesh.sample(step). {PARTS}"
        )


def ordered_times(steps: Sequence[TimeStep], record: Record) -> tuple[list[int], Any]:
    """Return the order of steps by their times, and the times; ``None`` without them.

    Raises
    ------
    FieldError
        When two steps have the same time.
    """
    numbers = list(range(len(steps)))
    times = [np.nan if step.time is None else step.time for step in steps]
    if lacking := [step.label for step in steps if step.time is None]:
        if len(steps) > 1:
            text = f"{lacking[0]} has no time, so the {len(steps)} steps are numbered from 0"
            record("align", text, notable=len(lacking) < len(steps))
        return numbers, None
    if not np.isfinite(times).all():
        return numbers, times  # the field raises an error
    order = sorted(numbers, key=times.__getitem__)
    if order != numbers:
        record("align", "the steps are sorted by their times", notable=True)
    for n, following in pairwise(order):
        if times[n] == times[following]:
            raise FieldError(
                f"{steps[n].label} and {steps[following].label} both have the time {times[n]:g}; "
                "expected different times: leave out one of them, or give times=[...]"
            )
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


def scalar_steps(
    scalars: Sequence[dict[str, Floats]], times: Any, record: Record
) -> dict[str, Floats]:
    """Return the arrays of all steps, (T, ...), NaN at those that lack one."""
    names: dict[str, Floats] = {}
    for arrays in reversed(scalars):
        names |= arrays
    found = {}
    lacking: dict[tuple[int, ...], list[str]] = {}
    for name, known in names.items():
        missing = np.full_like(known, np.nan, dtype=float)
        found[name] = np.stack([arrays.get(name, missing) for arrays in scalars])
        steps = tuple(n for n, arrays in enumerate(scalars) if name not in arrays)
        if steps:
            lacking.setdefault(steps, []).append(name)
    for steps, lost in lacking.items():
        if times is None:
            texts = [f"step {n}" for n in steps]
        else:
            texts = [f"time {times[n]:g}" for n in steps]
        listed = ", ".join(texts[:MOST_LISTED])
        if len(texts) > MOST_LISTED:
            listed += ", ..."
        # Initial values often lack what is computed from a flow.
        notable = 0 not in steps
        for name in lost:
            if name.rpartition("_")[0] not in lost:  # else a component
                text = f"{name!r} is missing at {listed}, where it has no data"
                record("align", text, notable=notable)
    return found
