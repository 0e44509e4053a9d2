"""From files to a field, and a summary of what a file holds.

PyVista's readers open most files; PLOT3D, which says little about itself, goes through
:mod:`flowtex.field.io.plot3d`. Whatever a reader raises, and whatever VTK logs, becomes one
:class:`~flowtex.FieldError` that starts with the name of the file.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import ParseError

from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.field.io import plot3d
from flowtex.field.io.from_pyvista import from_pyvista
from flowtex.field.io.meshes import is_reader, is_structured, leaves
from flowtex.field.io.summary import FileSummary, summarize
from flowtex.field.io.vtk_log import kept_vtk_log

__all__ = ["FileSummary", "describe", "from_file", "open_file", "reading"]

_KNOWN = (
    "a structured mesh that PyVista reads (.vts, .vtr, .vti, .vtk, .vtm, .pvd and more), or "
    "PLOT3D (.xyz with .q beside it)"
)


def from_file(
    path: str | Path,
    *,
    vectors: str | None = None,
    plane: str | None = None,
    periodic: str | None = None,
    time: float | None = None,
    block: int | str | None = None,
    sign_free: bool = False,
) -> FlowField:
    """Make a field from a file.

    Parameters
    ----------
    path
        A structured mesh in any format that PyVista reads, or a PLOT3D grid or solution. The
        other one of the two is found beside it by its name: ``postxyz.bin`` and ``postq.bin``,
        ``wing.xyz`` (or ``.x``, ``.g``) and ``wing.q``.
    vectors
        Name of the velocity; see :func:`flowtex.field.io.from_pyvista.from_pyvista`. A PLOT3D
        solution gives ``Velocity``, made from its density and momentum.
    plane
        Surface to draw from a mesh of three dimensions, such as ``"k=20"``.
    periodic
        Axes of the surface that close on themselves, see :meth:`FlowField.from_arrays`.
    time
        Draw this one of the times in the file, as a steady field. All of them by default.
    block
        Number or name of the block to draw, where the file has several grids. Numbers count the
        structured grids from 0.
    sign_free
        Whether v and -v mean the same, see :meth:`FlowField.from_arrays`.

    Returns
    -------
    FlowField
        Its ``name`` is the file's, without folder and suffix.

    Raises
    ------
    FieldError
        When the file is missing, empty, not readable, of an unknown or broken format, or does
        not hold a structured flow; the text starts with the path.
    """
    file, source, velocity = open_file(path)
    with reading(file):
        if time is not None:
            source = _at_time(source, time)
        if block is not None:
            source = _OneBlock(source, block) if is_reader(source) else _pick(source, block)
        return from_pyvista(
            source,
            vectors=vectors if vectors is not None else velocity,
            plane=plane,
            periodic=periodic,
            name=file.stem,
            sign_free=sign_free,
        )


def describe(path: str | Path) -> FileSummary:
    """Tell what a file holds, whether or not a flow can be drawn from it.

    Parameters
    ----------
    path
        As for :func:`from_file`. Of a time series the first step is read.

    Returns
    -------
    FileSummary
        ``problem`` says what :func:`from_file` would need to be told, or why it has to refuse.

    Raises
    ------
    FieldError
        When the file cannot be read at all.
    """
    file, source, velocity = open_file(path)
    with reading(file):
        times = _times(source)
        if is_reader(source):
            source = source.read()
        return summarize(file, source, times, velocity)


def open_file(path: str | Path) -> tuple[Path, Any, str | None]:
    """Open a file without reading more of it than its format asks for.

    Parameters
    ----------
    path
        As for :func:`from_file`.

    Returns
    -------
    path, source, velocity
        The file; a reader or a mesh; and the name of its velocity where the format fixes it.

    Raises
    ------
    FieldError
        When it is missing, empty, or of an unknown format; the text starts with the path.
    """
    file = _checked(path)
    with reading(file):
        return file, *_open(file)


def _checked(path: str | Path) -> Path:
    """Refuse a path that leads to nothing readable, before any reader sees it."""
    file = Path(path).expanduser()
    problem = ""
    if not file.exists():
        problem = "no such file; check the spelling and the folder"
        near = sorted(p.name for p in file.parent.glob(f"{file.stem}.*")) if file.name else []
        if near:
            problem += f". There is {', '.join(near[:5])}"
    elif file.is_dir():
        problem = "a folder, where a file was expected; name the mesh inside it"
    elif file.suffix.lower() in {".pkl", ".pickle", ".joblib"}:
        problem = (
            "a pickle, which can run any program when it is loaded, and is refused; save the mesh "
            'as VTK instead, as in mesh.save("flow.vts")'
        )
    else:
        try:
            with file.open("rb") as opened:
                # OpenFOAM marks a case with an empty file.
                if not opened.read(1) and file.suffix != ".foam":
                    problem = "the file is empty; expected " + _KNOWN
        except OSError as error:
            problem = f"cannot be opened ({error.strerror}); check its permissions"
    if problem:
        msg = f"{file}: {problem}"
        raise FieldError(msg)
    return file


@contextmanager
def reading(file: Path) -> Iterator[None]:
    """Turn what readers raise and log into one error that starts with the path."""
    said_no: Exception | None = None
    with kept_vtk_log() as log:
        try:
            yield
        except (ValueError, RuntimeError, OSError, KeyError, ImportError, ParseError) as error:
            said_no = error
        except (AttributeError, IndexError, TypeError, EOFError) as error:
            # Readers of broken files trip over what is missing in them.
            said_no = RuntimeError(f"its content is not as expected ({error})")
    if log.errors:
        # VTK goes on after an error and gives a part of the data, or none: the cause is here.
        msg = f"{file}: the file is broken or incomplete. VTK says: {log.errors[0]}"
        raise FieldError(msg) from said_no
    if isinstance(said_no, FieldError):
        msg = f"{file}: {said_no}"
        raise FieldError(msg) from said_no
    if said_no is not None:
        reason = str(said_no) or type(said_no).__name__
        msg = f"{file}: cannot be read: {reason}"
        raise FieldError(msg) from said_no
    for warning in dict.fromkeys(log.warnings):
        warnings.warn(f"{file}: VTK says: {warning}", stacklevel=4)


def _open(file: Path) -> tuple[Any, str | None]:
    """Return a reader or a mesh, and the name of its velocity where the format fixes it."""
    import pyvista as pv

    grid = plot3d.find_grid(file) or file
    layout = None
    if grid.suffix.lower() in plot3d.GRID_SUFFIXES:
        layout = plot3d.find_layout(grid)
    if layout is not None:
        return plot3d.read_plot3d(grid, layout, plot3d.find_solution(grid)), "Velocity"
    try:
        reader: Any = pv.get_reader(str(file))
        return reader, None
    except ValueError as error:
        if "does not support a file" not in str(error):
            raise
        what = repr(file.suffix) if file.suffix else "no suffix"
        if file.suffix.lower() in {*plot3d.GRID_SUFFIXES, ".q"}:
            what = "no PLOT3D grid of any layout"
        msg = f"the format is not known ({what}); expected {_KNOWN}"
        if file.suffix.lower() in {".nc", ".nc4", ".zarr", ".grib", ".grb"}:
            msg += ". Open it with xarray; FlowField.from_arrays takes its arrays"
        raise FieldError(msg) from error


def _times(source: Any) -> list[float]:
    return [float(t) for t in getattr(source, "time_values", None) or []]


def _at_time(source: Any, time: float) -> Any:
    """Read the one step of a series that is asked for."""
    times = _times(source)
    for value in times:
        if math.isclose(value, time, rel_tol=1e-6, abs_tol=1e-12):
            source.set_active_time_value(value)
            return source.read()
    listed = ", ".join(f"{t:g}" for t in times[:8]) + (", ..." if len(times) > 8 else "")
    msg = f"time is {time!r}; the file has {f'the times {listed}' if times else 'no times'}"
    raise FieldError(msg)


@dataclass
class _OneBlock:
    """A reader that gives one block of what another reader gives, at any of its times."""

    reader: Any
    block: int | str

    @property
    def time_values(self) -> list[float]:
        return _times(self.reader)

    @property
    def active_time_value(self) -> float:
        return float(self.reader.active_time_value)

    def set_active_time_value(self, time: float) -> None:
        self.reader.set_active_time_value(time)

    def read(self) -> Any:
        return _pick(self.reader.read(), self.block)


def _pick(mesh: Any, block: int | str) -> Any:
    """Pick one of several structured grids, by number or by name."""
    grids = [(name, grid) for name, grid in leaves(mesh) if is_structured(grid)]
    for number, (name, grid) in enumerate(grids):
        if block in (number, name):
            return grid
    listed = ", ".join(f"{number} ({name})" for number, (name, _) in enumerate(grids)) or "none"
    msg = f"block is {block!r}; the structured blocks of the file are: {listed}"
    raise FieldError(msg)
