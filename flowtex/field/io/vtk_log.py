"""Keep what VTK has to say about a file, instead of letting it run over the terminal.

VTK tells errors to an output window and, apart from it, to a logger that writes to standard
error; PyVista tells some of them again through Python's root logger. All three are held while a
file is read, and put back as they were.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

__all__ = ["VtkLog", "kept_vtk_log"]


@dataclass
class VtkLog:
    """What VTK said: the first line of each error and of each warning."""

    errors: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


@contextmanager
def kept_vtk_log() -> Iterator[VtkLog]:
    """Collect VTK's errors and warnings while the block runs, and print none.

    Yields
    ------
    VtkLog
        Filled when the block ends, also when it ends by an exception.
    """
    import pyvista as pv
    from vtkmodules.vtkCommonCore import vtkLogger

    said = VtkLog()
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
            yield said
    finally:
        root.removeFilter(_not_from_vtk)
        root.removeHandler(quiet)
        vtkLogger.SetStderrVerbosity(verbosity)
        said.errors += [_first_line(event.alert) for event in catcher.error_events]
        said.warnings += [_first_line(event.alert) for event in catcher.warning_events]


def _not_from_vtk(record: logging.LogRecord) -> bool:
    """Drop what PyVista's observer of VTK passes on to the root logger."""
    return not (record.module == "observers" and "pyvista" in record.pathname)


def _first_line(alert: str) -> str:
    lines = [line for line in alert.splitlines() if line.strip()]
    # Messages that come without an object start with a line about the source file.
    kept = [line for line in lines if not line.startswith(("ERROR: In ", "Warning: In "))]
    return (kept or lines or [""])[0].removeprefix("(nullptr): ").strip()
