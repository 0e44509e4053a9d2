"""Errors of reading a file, as one sentence.

Each error of a reader, and each that VTK logs, becomes one :class:`~flowtex.field.FieldError` that
starts with the name of the file.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree.ElementTree import ParseError

from flowtex._util.notices import notify
from flowtex.errors import FieldError

if TYPE_CHECKING:
    import pyvista as pv

#: Held while VTK's output window, its logger and Python's root logger are changed: each exists once
#: in a process, and two threads that replace them at the same time corrupt the heap. A file may be
#: opened while another is read, so the thread that holds it may take it again.
_VTK_GLOBALS = threading.RLock()


@contextmanager
def errors_of_file(path: str | Path) -> Iterator[None]:
    """Name the file in errors of readers and in VTK's log, one thread at a time."""
    file = Path(path).expanduser()
    cause: Exception | None = None
    has_vtk = find_spec("pyvista") is not None  # other readers do not need it
    with _VTK_GLOBALS, _vtk_log() if has_vtk else nullcontext() as catcher:
        try:
            yield
        except (ValueError, RuntimeError, OSError, KeyError, ImportError, ParseError) as error:
            cause = error
        except MemoryError:
            cause = RuntimeError("its data do not fit into memory")
        except (AttributeError, IndexError, TypeError, EOFError) as error:
            # Readers fail so where parts of a broken file are missing.
            cause = RuntimeError(f"its content is invalid ({error})")
        except Exception as error:
            # Errors of ecCodes have no class in common with others.
            if not type(error).__module__.startswith("gribapi"):
                raise
            cause = error
    if catcher and catcher.error_events:
        # VTK continues after an error with partial data, or none: this is the cause.
        first = _first_line(catcher.error_events[0].alert)
        msg = (
            f"{file}: the file is damaged, incomplete, or not of this format. VTK reports: {first}"
        )
        raise FieldError(msg) from cause
    if isinstance(cause, FieldError):
        msg = f"{file}: {cause}"
        raise FieldError(msg) from cause
    if cause is not None:
        reason = str(cause) or type(cause).__name__
        msg = f"{file}: cannot be read: {reason}"
        raise FieldError(msg) from cause
    warnings = catcher.warning_events if catcher else []
    for warning in dict.fromkeys(_first_line(event.alert) for event in warnings):
        notify(f"{file}: VTK reports: {warning}", UserWarning)


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
    """Drop the messages that PyVista's observer of VTK passes to the root logger."""
    return not (record.module == "observers" and "pyvista" in record.pathname)


def _first_line(alert: str) -> str:
    lines = [line for line in alert.splitlines() if line.strip()]
    # Messages that come without an object start with a line about the source file.
    texts = [line for line in lines if not line.startswith(("ERROR: In ", "Warning: In "))]
    return (texts or lines or [""])[0].removeprefix("(nullptr): ").strip()
