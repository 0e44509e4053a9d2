"""Errors of reading a file, as one sentence: of readers, of cut files and of other programs.

Each error of a reader, and each that VTK logs, becomes one :class:`~flowtex.field.FieldError` that
starts with the name of the file.
"""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree.ElementTree import ParseError

import numpy as np

from flowtex._util.addresses import address_of
from flowtex._util.array_types import AnyArray
from flowtex._util.forks import ProcessLock
from flowtex._util.memory import check_memory
from flowtex.errors import FieldError, notify

if TYPE_CHECKING:
    import pyvista as pv

#: Held while VTK's output window, its logger and Python's root logger are changed: each exists once
#: in a process, and two threads that replace them at the same time corrupt the heap. A file may be
#: opened while another is read, so the thread that holds it may take it again.
_VTK_GLOBALS = ProcessLock()
#: Errors with which readers fail where a file is broken.
BROKEN = (AttributeError, IndexError, TypeError, EOFError, ArithmeticError, AssertionError)
#: Environment variable that decides whether HDF5 locks files.
LOCKING = "HDF5_USE_FILE_LOCKING"


@contextmanager
def errors_of_file(path: str | Path) -> Iterator[None]:
    """Name the file in errors of readers and in VTK's log, one thread at a time.

    Raises
    ------
    FieldError
        When the ``with`` block raises an error of a reader, or VTK reports one.
    """
    file = address_of(path) or Path(path).expanduser()
    cause: Exception | None = None
    has_vtk = find_spec("pyvista") is not None  # other readers do not need it
    with _VTK_GLOBALS, without_locks(), _vtk_log() if has_vtk else nullcontext() as catcher:
        try:
            yield
        except (ValueError, RuntimeError, OSError, KeyError, ImportError, ParseError) as error:
            cause = error
        except MemoryError:
            cause = RuntimeError("its data do not fit into memory")
        except BROKEN as error:
            # Readers fail so where parts of a broken file are missing, or sizes are absurd.
            reason = str(error) or type(error).__name__
            cause = RuntimeError(f"its content is invalid ({reason}); write or copy it again")
        except Exception as error:
            # Errors of readers, such as ecCodes, may have no class in common with others.
            library = type(error).__module__.partition(".")[0]
            if library in ("builtins", "flowtex"):
                raise
            cause = error
    if catcher and catcher.error_events:
        # VTK continues after an error with partial data, or none: this is the cause.
        first = _first_line(catcher.error_events[0].alert)
        raise FieldError(
            f"{file}: the file is damaged, incomplete, or not of this format. VTK reports: {first}"
        ) from cause
    if isinstance(cause, FieldError):
        raise FieldError(f"{file}: {cause}") from cause
    if cause is not None:
        reason = str(cause) or type(cause).__name__
        raise FieldError(f"{file}: cannot be read: {reason}") from cause
    if catcher:
        warnings = catcher.warning_events
    else:
        warnings = []
    for warning in dict.fromkeys(_first_line(event.alert) for event in warnings):
        notify(f"{file}: VTK reports: {warning}", UserWarning)


@contextmanager
def without_locks() -> Iterator[None]:
    """Let libraries of HDF5 that are loaded in the block lock no file, unless the user decided.

    Each of them reads the variable once. A lock would keep others from writing the file meanwhile.
    """
    if LOCKING in os.environ:
        yield
        return
    os.environ[LOCKING] = "FALSE"
    try:
        yield
    finally:
        os.environ.pop(LOCKING, None)


def load_netcdf4() -> None:
    """Load netCDF's library, which then locks no file."""
    with without_locks():
        import netCDF4  # noqa: F401


@contextmanager
def _vtk_log() -> Iterator[pv.VtkErrorCatcher]:
    """Collect VTK's errors and warnings while the block runs, and print none.

    VTK sends errors to an output window and, apart from it, to a logger that writes to standard
    error; PyVista repeats some of them through Python's root logger. All three are held, and put
    back as they were. Yields PyVista's catcher, which has the events once the block ends.
    """
    import pyvista as pv
    from vtkmodules.vtkCommonCore import vtkLogger

    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    root = logging.getLogger()
    quiet = logging.NullHandler()
    catcher = pv.VtkErrorCatcher(send_to_logging=False)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    # Without a handler the first message would make Python set up logging to standard error.
    root.addHandler(quiet)
    root.addFilter(_not_from_vtk)
    try:
        with catcher:
            yield catcher
    finally:
        root.removeFilter(_not_from_vtk)
        root.removeHandler(quiet)
        vtkLogger.SetStderrVerbosity(verbosity)


def _not_from_vtk(record: logging.LogRecord) -> bool:
    return not (record.module == "observers" and "pyvista" in record.pathname)


def _first_line(alert: str) -> str:
    lines = [line for line in alert.splitlines() if line.strip()]
    # Messages that come without an object start with a line about the source file.
    texts = [line for line in lines if not line.startswith(("ERROR: In ", "Warning: In "))]
    return (texts or lines or [""])[0].removeprefix("(nullptr): ").strip()


def check_count(found: int, declared: int, what: str, unit: str = "bytes") -> None:
    """Check that a file has at least what it declares.

    Parameters
    ----------
    found
        Number that the file has.
    declared
        Number that it declares.
    what
        The part of the file that declares it.
    unit
        What is counted.

    Raises
    ------
    FieldError
        When it has less.
    """
    if found < declared:
        raise FieldError(
            f"the file is truncated or damaged: {what} declares {declared:,} {unit}, but the "
            f"file has {max(found, 0):,}; write or copy it again"
        )


def values_in(array: Any) -> AnyArray:
    """Return the values of a variable of xarray's, if they fit into memory as float64."""
    check_memory(8 * array.size, f"the variable {getattr(array, 'name', None) or 'without a name'}")
    return np.asarray(array.values)
