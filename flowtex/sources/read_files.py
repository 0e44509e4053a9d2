"""From files to the arrays of a field: of a mesh, or of a dataset; the state of files.

PyVista's readers open most files; PLOT3D, which does not describe itself, is read by
:mod:`flowtex.sources.meshes.plot3d`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from flowtex._util.addresses import address_of, data_advice
from flowtex._util.child.worker import is_child
from flowtex.errors import FieldError, require_pyvista
from flowtex.field.field_arrays import SourceArrays
from flowtex.field.options import FieldOptions
from flowtex.sources.datasets.read_datasets import read_datasets
from flowtex.sources.datasets.values import Regions
from flowtex.sources.inspection.foam_files import ENDINGS, case_of
from flowtex.sources.inspection.inspect_file import inspect_file
from flowtex.sources.inspection.other_programs import advice_of
from flowtex.sources.inspection.tecplot_files import is_tecplot_text
from flowtex.sources.meshes import meshio_files, parts, plot3d, separate, series
from flowtex.sources.meshes.amr import amr_blocks
from flowtex.sources.meshes.read_meshes import choose, read_meshes
from flowtex.sources.meshes.vectors import MeshArray, candidates, catalogue, hidden_nodes, values_of
from flowtex.sources.notices import Record
from flowtex.sources.opening.dataset_files import (
    common_name,
    dataset_paths,
    is_dataset_file,
    open_datasets,
)
from flowtex.sources.reader_errors import errors_of_file

if TYPE_CHECKING:
    import pyvista as pv

#: Path, number on the disk, size and time of change in nanoseconds of each file; zeros if it does
#: not exist.
Identity = tuple[tuple[str, int, int, int], ...]

#: Endings of files that list others.
LISTS = (".pvd", ".vtm", ".vtmb", ".pvts", ".pvtr", ".pvti", ".pvtu", ".pvtp")
#: Pattern of the members of a list.
MEMBER = re.compile(r'(?:file|Source)\s*=\s*"([^"]+)"')
#: Bytes that are read of a list.
LIST_BYTES = 4_000_000
#: Levels of lists that are followed.
LIST_DEPTH = 3
#: Most files that are examined.
MOST_FILES = 10_000
#: The file in the folder of an OpenFOAM case that its reader needs.
CONTROL = "system/controlDict"
#: Endings of XDMF.
XDMF = (".xdmf", ".xmf")
#: Endings of files whose data may be in others of the same name.
WITH_OTHERS = (*plot3d.SURFACE_SUFFIXES, *plot3d.GRID_SUFFIXES, ".q")


def open_reader(file: Path) -> Any:
    """Return the reader of a file; raises a ValueError if the format is unknown."""
    import pyvista as pv

    if file.suffix.lower() in separate.SUFFIXES and not is_child():
        size = sum(nbytes for _, _, nbytes, _ in file_identity([file]))
        return separate.SeparateReader(file, size)

    class DecomposedReader(pv.POpenFOAMReader):
        """PyVista's reader, which must know of pieces before it opens the case."""

        def _set_defaults(self) -> None:
            super()._set_defaults()
            self._reader.SetCaseType(0)

    if file.suffix.lower() in XDMF:
        return _xdmf_reader(file)
    case = case_of(file)
    if case is not None:
        marker = file
        if file.is_dir():
            marker = case / CONTROL
        in_pieces = (case / "processor0").is_dir() and not (case / "constant/polyMesh").is_dir()
        if in_pieces:
            return DecomposedReader(str(marker))
        return pv.POpenFOAMReader(str(marker))
    if is_tecplot_text(file):
        return pv.TecplotReader(str(file))
    reader: Any = pv.get_reader(str(file))
    if isinstance(reader, pv.CGNSReader):
        return _CGNSReader(reader)
    if isinstance(reader, pv.HDFReader):
        return _TimedReader(reader)
    return reader


def _xdmf_reader(file: Path) -> Any:
    """Return PyVista's reader of XDMF, also for a file without times."""
    import pyvista as pv
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    class XdmfReader(pv.XdmfReader):
        """PyVista's reader, which fails where there are no times."""

        @property
        def time_values(self) -> list[float]:
            """The times of the file; empty if it has none."""
            information = self.reader.GetOutputInformation(0)
            times = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS())
            return list(map(float, times or ()))

        def _set_defaults_post(self) -> None:
            self._active_time_value = next(iter(self.time_values), 0.0)

    return XdmfReader(str(file))


class _TimedReader:
    """A reader of PyVista's that has no times itself, with those that VTK reports."""

    def __init__(self, reader: Any) -> None:
        from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

        self._reader = reader
        reader.reader.UpdateInformation()
        information = reader.reader.GetOutputInformation(0)
        times = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ()
        # VTK reports 0 if the file has no times.
        if times == (0.0,):
            self.time_values = []
        else:
            self.time_values = sorted(map(float, times))
        if self.time_values:
            self.active_time_value = self.time_values[0]
        else:
            self.active_time_value = 0.0

    def set_active_time_value(self, time: float) -> None:
        """Set the time to read."""
        self.active_time_value = time

    def read(self) -> pv.DataObject:
        """Read the mesh or the blocks at the active time."""
        if self.time_values:
            self._reader.reader.UpdateTimeStep(self.active_time_value)
        else:
            self._reader.reader.Update()
        read = self._reader.reader.GetOutputDataObject(0)
        if read is not None and read.IsA("vtkOverlappingAMR"):  # which PyVista does not know
            return amr_blocks(read)
        return self._reader.read()


class _CGNSReader(_TimedReader):
    """PyVista's reader of CGNS with times, all bases, and blocks named ``Base/Zone``."""

    def __init__(self, reader: Any) -> None:
        # With patches each zone is a tree, and patches are not structured grids.
        reader.load_boundary_patch = False
        reader.enable_all_bases()
        super().__init__(reader)


_KNOWN_FORMATS = (
    "a mesh that PyVista reads (.vts, .vtr, .vti, .vtk, .vtu, .vtp, .vtm, .pvd, .cgns, .case, "
    ".foam, .xdmf and more) or meshio (.msh, .med and more), PLOT3D (.xyz with .q beside it), or a "
    "dataset or table (.nc, .zarr, .grib, .json, .geojson, .csv, .txt, .vec)"
)


@dataclass(frozen=True)
class OpenFile:
    """A file that was opened, and read only as far as its format requires."""

    path: Path
    source: Any  #: One of PyVista's readers, a mesh, or a list of time steps.
    velocity: str | None  #: Name of the velocity where the format fixes it.
    problem: str = ""  #: The reason if nothing can be drawn.


def open_file(path: str | Path) -> OpenFile:
    """Open a file of a mesh; callers name errors by :func:`errors_of`.

    Raises
    ------
    FieldError
        When the file is missing or damaged, or its format is unknown.
    ModuleNotFoundError
        When PyVista or the reader of the format is not installed.
    """
    file = one_path(path)
    if problem := _path_problem(file):
        raise FieldError(problem)
    inspect_file(file)
    require_pyvista("its format")
    grid = plot3d.find_grid(file) or file
    layout = None
    if grid.suffix.lower() in plot3d.GRID_SUFFIXES:
        layout = plot3d.find_layout(grid)
    if layout is not None:
        mesh = plot3d.read_plot3d(grid, layout, plot3d.find_solution(grid))
        return OpenFile(file, mesh, "Velocity")
    if meshio_files.is_meshio_file(file):
        return OpenFile(file, meshio_files.read_meshio(file), None)
    try:
        if file.suffix.lower() in plot3d.SURFACE_SUFFIXES:
            return OpenFile(file, *plot3d.read_with_vectors(file))
        return OpenFile(file, open_reader(file), None)
    except ValueError as error:
        if "does not support a file" not in str(error):
            raise
        if grid.suffix.lower() in plot3d.GRID_SUFFIXES:
            reason = "not PLOT3D"
        else:
            reason = repr(file.suffix)
        raise FieldError(f"unknown format ({reason}); expected {_KNOWN_FORMATS}") from error


def _case_problem(file: Path, case: Path | None) -> str:
    """Return why nothing can be read of an OpenFOAM case; empty otherwise."""
    if case is None:
        return ""
    if not [*case.glob("constant"), *case.glob("processor*")]:
        return "its folder has no folder constant; expected the folder of an OpenFOAM case"
    if case == file and not (case / CONTROL).is_file():
        text = f"this is a case of OpenFOAM without {CONTROL}; copy that file into it, or make an"
        return f"{text} empty file {file.name}.foam in it, and name that"
    return ""


def _path_problem(file: Path) -> str:
    """Return why nothing can be read from a path, before any reader opens it; empty otherwise."""
    address = address_of(file)
    if address and not file.exists():
        return data_advice(address) or (
            "this address has no flowtex pyramid, and files are read only from folders; open the "
            f'data with xarray, as in flowtex.show(xarray.open_zarr("{address}"))'
        )
    case = case_of(file)
    if problem := _case_problem(file, case):
        return problem
    if not file.exists():
        if file.name:
            similar = sorted(p.name for p in file.parent.glob(f"{file.stem}.*"))
        else:
            similar = []
        if similar:
            names = f". Similar names: {', '.join(similar[:5])}"
        else:
            names = ""
        text = "the file does not exist; check the spelling and the folder (patterns are not"
        return f"{text} expanded){names}"
    if file.is_dir() and case is None:
        return "this is a folder; expected a file: name the mesh inside it"
    if file.suffix.lower() in {".pkl", ".pickle", ".joblib"}:
        return (
            "this is a pickle, which can run any program when it is loaded, so it is refused; "
            'save the mesh as VTK instead, as in mesh.save("flow.vts")'
        )
    if advice := advice_of(file):
        return advice
    if case is not None:  # an empty file marks it
        return ""
    try:
        with file.open("rb") as stream:
            is_empty = not stream.read(1)
    except OSError as error:
        return f"cannot be opened ({error.strerror}); check its permissions"
    if is_empty:
        return f"the file is empty; expected {_KNOWN_FORMATS}"
    return ""


def read_files(
    path: str | Path | Sequence[str | Path],
    options: FieldOptions,
    *,
    time: float | str | None = None,
    regions: bool = False,
) -> SourceArrays | Regions:
    """Read the arrays of a field; callers name errors by :func:`errors_of`.

    Parameters
    ----------
    path
        A file, or several files of one dataset.
    options
        Options of the field.
    time
        One of the times; all by default.
    regions
        Whether no nodes are read if any part can be read by itself.

    Raises
    ------
    FieldError
        When a file is missing, cannot be read or has no such time, or the options do not fit its
        kind.
    """
    if paths := dataset_paths(path):
        if time is not None:
            options = replace(options, sel={**(options.sel or {}), "time": time})
        name = common_name(paths)
        return read_datasets(open_datasets(paths), options, name=name, regions=regions)
    file = one_path(path)
    if problem := _path_problem(file):
        raise FieldError(problem)
    if options.times is not None:
        raise FieldError("times is given, but the file already has times; omit it")
    opened = open_file(file)
    if opened.problem:
        raise FieldError(opened.problem)
    if options.vectors is None:
        options = replace(options, vectors=opened.velocity)
    if time is None:
        return read_meshes(opened.source, options, name=file.stem)
    source, moment = series.around(opened.source, time, options)
    arrays = read_meshes(source, options, name=file.stem)
    if len(series.times_of(source)) > 1:
        return series.interpolated(arrays, moment)
    return arrays


def one_path(path: str | Path | Sequence[str | Path]) -> Path:
    """Return the path of a mesh, with ``~`` expanded.

    Raises
    ------
    FieldError
        When several paths are given; several files are read only as datasets.
    """
    if isinstance(path, (str, Path)):
        return Path(path).expanduser()
    missing = []
    others = []
    for each in path:
        file = Path(each).expanduser()
        if not file.exists():
            missing.append(str(each))
        elif not is_dataset_file(file):
            others.append(file.name)
    if missing:
        names = ", ".join(missing)
        raise FieldError(f"{names}: no such file; check the path and the working directory")
    raise FieldError(
        f"{len(path)} files are given, and {', '.join(others)} is no dataset or table, of which "
        "alone several are read together. Name one file; for steps of a mesh it is a .pvd file, "
        "which lists them"
    )


def errors_of(path: str | Path | Sequence[str | Path]) -> AbstractContextManager[None]:
    """Name a file, or the first of several, in errors until its field is made."""
    first = next(iter(dataset_paths(path)), path)
    return errors_of_file(first if isinstance(first, (str, Path)) else "several files")


def file_identity(paths: Iterable[Path]) -> Identity:
    """Return the state of files, and of those that are read with them.

    These are members of a list, vectors and solutions beside a mesh, all files in the folder of an
    EnSight case, and those below an OpenFOAM case or a Zarr store. Missed are changes of the same
    size within the resolution of the disk's clock, targets of links in CGNS and HDF5 files, and
    changes among more than :data:`MOST_FILES` files.
    """
    files = (file for path in paths for file in _files(path.expanduser().absolute(), 0))
    states = []
    for file in islice(files, MOST_FILES):
        try:
            state = file.stat()
            states.append((str(file), state.st_ino, state.st_size, state.st_mtime_ns))
        except (OSError, ValueError):
            states.append((str(file), 0, 0, 0))
    return tuple(states)


def members_of(path: Path) -> list[Path]:
    """Return the files that a series or a collection lists."""
    if path.suffix.lower() not in LISTS:
        return []
    try:
        with path.open(encoding="utf-8", errors="replace") as file:
            names = MEMBER.findall(file.read(LIST_BYTES))
    except OSError:
        return []
    return [path.parent / name for name in dict.fromkeys(names)]


def _files(path: Path, depth: int) -> Iterator[Path]:
    yield path
    suffix = path.suffix.lower()
    if path.is_dir() or suffix in ENDINGS:
        # A store may have far more files than are compared, so its folders are listed one by one.
        for folder, folders, names in os.walk(path if path.is_dir() else path.parent):
            folders.sort()
            yield from (Path(folder, name) for name in sorted(names))
    elif suffix == ".case":
        yield from sorted(other for other in path.parent.iterdir() if other.is_file())
    elif suffix in WITH_OTHERS and path.parent.is_dir():
        yield from sorted(other for other in path.parent.iterdir() if other.stem == path.stem)
    elif depth < LIST_DEPTH:
        for member in members_of(path):
            yield from _files(member, depth + 1)


class ArraySummary(NamedTuple):
    """One array, its finite range (for a vector, of its lengths), and its components' names."""

    name: str
    where: Literal["points", "cells"]
    components: int
    low: float
    high: float
    parts: tuple[str, ...] = ()
    since: float | None = None  #: The first time that has it, if earlier ones lack it.


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
        if parts.is_reader(file.source):
            mesh = parts.read_checked(file.source)
        else:
            mesh = file.source
        if isinstance(mesh, list):
            mesh = mesh[0].grid
        return _summary(file, mesh, block)


def _summary(file: OpenFile, mesh: Any, block: int | str | None) -> FileSummary:
    found = list(parts.leaves(mesh))
    meshes = list(parts.parts_of(mesh))
    drawn = list(parts.drawn_parts(mesh)[0].values())
    if block is None:
        part = (drawn or [p for _, p in found] or [mesh])[0]
    else:
        part = parts.pick(mesh, block)
    is_mesh = hasattr(part, "point_data")
    arrays, velocities = (catalogue(part), candidates(part)) if is_mesh else ([], [])
    listed = [_array(part, a) for a in (*arrays, *(a for a in velocities if a.parts))]
    if is_mesh:
        path = next((name for name, each in found if each is part), None)
        later = _later_arrays(file.source, path, listed)
        listed += [summary for _, summary in later]
        velocities += [array for array, _ in later if array.components > 1 and array.real]
    names = dict.fromkeys(a.name for a in velocities) if file.velocity is None else [file.velocity]
    times = parts.times_of(file.source)
    if isinstance(file.source, list):
        times = [float(step.time) for step in file.source]
    whole = mesh if block is None else part
    blocks = [
        BlockSummary(name, meshes.index(name), type(p).__name__, parts.part_size(p))
        if name in meshes
        else BlockSummary(name, None, type(p).__name__)
        for name, p in found
    ]
    return FileSummary(
        path=file.path,
        grid=type(part).__name__,
        size=parts.part_size(part) if is_mesh else "",
        bounds=tuple(zip(part.bounds[::2], part.bounds[1::2], strict=True)) if is_mesh else (),
        volume=is_mesh and part.max_cell_dimensionality == 3,
        blocks=tuple(blocks) if len(found) > 1 else (),
        arrays=tuple(listed),
        candidates=tuple(names),
        times=tuple(times),
        blanked=int(hidden_nodes(part).sum()) if is_mesh else 0,
        problem=file.problem or _problem(whole, file.velocity, series=len(times) > 1),
    )


def _later_arrays(
    source: Any, path: str | None, known: Sequence[ArraySummary]
) -> list[tuple[MeshArray, ArraySummary]]:
    """Return the arrays of a block that its first time lacks, of which most times are examined."""
    if path is None or not parts.is_reader(source) or len(parts.times_of(source)) < 2:
        return []
    names = {(array.name, array.where) for array in known}
    later = []
    for step in parts.time_steps(series.examined(source), path):
        for array in catalogue(step.grid):
            if (array.name, array.where) not in names:
                names.add((array.name, array.where))
                later.append((array, _array(step.grid, array)._replace(since=step.time)))
    return later


def _problem(mesh: Any, vectors: str | None, *, series: bool) -> str:
    if parts.drawn_parts(mesh, series=series)[1] == "choose":
        return parts.several_fault(mesh, "the file")
    try:
        choose(next(parts.time_steps(mesh)).grid, vectors, None, None, Record())
    except FieldError as error:
        return str(error)
    return ""


def _array(mesh: Any, array: MeshArray) -> ArraySummary:
    if array.numeric:
        values = values_of(mesh, array).astype(np.float64)
    else:
        values = np.empty(0)
    if array.components > 1:
        values = np.linalg.norm(values.reshape(-1, array.components), axis=1)
    values = values[np.isfinite(values)]
    if len(values):
        ends = (float(values.min()), float(values.max()))
    else:
        ends = (np.nan, np.nan)
    return ArraySummary(array.name, array.where, array.components, *ends, array.parts)
