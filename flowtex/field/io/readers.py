"""Readers of files, set so that they read all that may be drawn.

PyVista's readers read most files as they are. Here is what some need more: the times of CGNS and
all of its bases, and cases of OpenFOAM that are still in the pieces of a parallel run.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any


def open_reader(file: Path) -> Any:
    """Return the reader of a file; a ValueError tells of a format that is not known."""
    import pyvista as pv

    class DecomposedReader(pv.POpenFOAMReader):
        """PyVista's reader, which has to know of pieces before it opens the case."""

        def _set_defaults(self) -> None:
            super()._set_defaults()
            self._reader.SetCaseType(0)

    case = file.parent
    in_pieces = (case / "processor0").is_dir() and not (case / "constant" / "polyMesh").is_dir()
    if file.suffix.lower() == ".foam" and in_pieces:
        return DecomposedReader(str(file))
    reader: Any = pv.get_reader(str(file))
    return _CGNSReader(reader) if isinstance(reader, pv.CGNSReader) else reader


class _CGNSReader:
    """PyVista's reader of CGNS with times, all bases, and blocks named ``Base/Zone``."""

    def __init__(self, reader: Any) -> None:
        from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

        self._reader = reader
        # With patches each zone is a tree of its own, and patches are no structured grids.
        reader.load_boundary_patch = False
        reader.enable_all_bases()
        reader.reader.UpdateInformation()
        information = reader.reader.GetOutputInformation(0)
        times = information.Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ()
        # VTK tells 0 where the file has no times.
        self.time_values = [] if times == (0.0,) else sorted(map(float, times))
        self.active_time_value = self.time_values[0] if self.time_values else 0.0

    def set_active_time_value(self, time: float) -> None:
        """Choose the time that is read."""
        self.active_time_value = time

    def read(self) -> Any:
        """Read the blocks at the time that is set."""
        if self.time_values:
            self._reader.reader.UpdateTimeStep(self.active_time_value)
        return self._reader.read()
