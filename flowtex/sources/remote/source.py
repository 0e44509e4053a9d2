"""A file that is open in another process: its choices, and its fields."""

from __future__ import annotations

import logging
import weakref
from collections import deque
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from flowtex._util.array_types import AnyArray, Floats
from flowtex._util.child import FORKS, Child, ChildError, fork_server
from flowtex._util.notices import Notice, notify
from flowtex.errors import FieldError
from flowtex.field.field import FlowField
from flowtex.sources.files import file_identity
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.open_source import Source
from flowtex.sources.remote.reader import take_description, unpack_field

_log = logging.getLogger(__name__)

READER = "flowtex.sources.remote.reader:Reader"
#: Modules of readers, those for meshes first.
PRELOAD = (
    *("flowtex.sources.remote.reader", "pyvista", "vtkmodules.vtkIOXML", "vtkmodules.vtkIOLegacy"),
    *("xarray", "cf_xarray", "pyproj", "netCDF4", "dask.array", "cfgrib"),
)
#: Time limit of a request, which a large file extends by its bytes per second.
REQUEST_TIMEOUT_S, BYTES_PER_S = 60.0, 10e6
#: Most readings of a file that changes meanwhile.
MOST_READINGS = 3
#: Classes of warnings by their names; others are plain ones of the user.
WARNINGS = {kind.__name__: kind for kind in (Notice, DatasetNotice)}


class RemoteSource(Source):
    """A file, or several, that another process reads and keeps open, and may crash without harm.

    That process ends with the source, and with all fields of it whose time steps are read late.
    """

    def __init__(
        self, file: _OpenFile, description: Mapping[str, Any], block: str | None = None
    ) -> None:
        super().__init__()
        try:
            take_description(self, description)
        except (TypeError, KeyError, AttributeError) as error:
            raise FieldError(file.malformed(error)) from error
        self.identity = file.identity
        self._file, self._block = file, block
        self._parts: dict[str | None, Source] = {}

    @property
    def alive(self) -> bool:
        """Whether its process continues, as far as is known."""
        return self._file.child.alive

    def close(self) -> None:
        """End the process of the file."""
        self._file.child.close()

    def part(self, block: str | None = None) -> Source:
        """Return the source of one of the blocks, as :meth:`Source.part` does."""
        if not self.blocks:
            return self
        if block not in self._parts:
            part = RemoteSource(self._file, self._file.ask("part", block=block)[0], block)
            self._parts[block] = part
            self.nbytes += part.nbytes if self.reads_late else 0
        return self._parts[block]

    def plane_of(self, level: float | str) -> str:
        """Return the plane of a level, as :meth:`Source.plane_of` does."""
        return str(self._file.ask("plane_of", level=level)[0])

    def _field(
        self, vectors: str | None, plane: str | None, block: str | None, options: dict[str, Any]
    ) -> FlowField:
        block = self._block if block is None else block
        field = self._file.field({"vectors": vectors, "plane": plane, "block": block, **options})
        if self.reads_late:
            self._file.check()
        return field


class _OpenFile:
    """The process in which a file is open, and requests to it."""

    def __init__(self, paths: list[Path]) -> None:
        self.paths = paths
        self.identity = file_identity(paths)
        size = sum(size for _, _, size, _ in self.identity)
        self._timeout = REQUEST_TIMEOUT_S + size / BYTES_PER_S
        self._forgotten: deque[int] = deque()
        self.child = Child(READER, preload=PRELOAD)

    def ask(self, do: str, **request: Any) -> tuple[Any, list[AnyArray]]:
        """Return the answer to a request, and issue its warnings; errors start with the path."""
        forgotten = [self._forgotten.popleft() for _ in range(len(self._forgotten))]
        message = {"do": do, "forgotten": forgotten, **request}
        try:
            answer, arrays = self.child.request(message, timeout=self._timeout)
            value, warned = answer["value"], answer["warnings"]
        except ChildError as error:
            raise FieldError(self._fault(error)) from error
        except (TypeError, KeyError) as error:
            raise FieldError(self.malformed(error)) from error
        for kind, text in warned:
            notify(str(text), WARNINGS.get(kind, UserWarning))
        return value, arrays

    def field(self, options: dict[str, Any]) -> FlowField:
        value, arrays = self.ask("field", **options)
        try:
            return unpack_field(value, arrays, lambda number: _RemoteSteps(self, number))
        except (TypeError, KeyError, ValueError, IndexError, AttributeError) as error:
            raise FieldError(self.malformed(error)) from error

    def check(self) -> None:
        """Raise a FieldError if the file has changed since it was opened."""
        if file_identity(self.paths) != self.identity:
            raise FieldError(
                f"{self.paths[0]}: the file has changed since it was opened; open it again"
            )

    def forget(self, number: int) -> None:
        """Let the other process forget steps, with the next request."""
        self._forgotten.append(number)

    def _fault(self, error: ChildError) -> str:
        path, text = self.paths[0], str(error)
        if error.kind == "FieldError":
            return text
        if error.kind:
            _log.error("the reader of %s failed:\n%s", path, error.trace)
            return f"{path}: cannot be read: {text or error.kind}"
        limit = self.child.memory / 1e9
        if "memory" in text:
            return f"{path}: its reader {text}"
        return (
            f"{path}: the reader of this file {text}; the file is damaged, or needs more than "
            f"{limit:.1f} GB of memory"
        )

    def malformed(self, error: Exception) -> str:
        """Return the text of an error for an answer that makes no sense."""
        return f"{self.paths[0]}: the reader of this file sent a malformed answer: {error!r}"


class _RemoteSteps:
    """Reader of steps of a field from the other process, which keeps them while this lives."""

    def __init__(self, file: _OpenFile, number: int) -> None:
        self._file, self._number = file, number
        weakref.finalize(self, file.forget, number).atexit = False

    def __call__(self, step: int) -> Floats:
        """Return a step, (J, I, ...)."""
        _, arrays = self._file.ask("step", steps=self._number, number=step)
        self._file.check()
        return arrays[0]


def open_remote(paths: Sequence[Path]) -> RemoteSource:
    """Open a file, or several of data of the Earth, in another process."""
    for _ in range(MOST_READINGS):
        file = _OpenFile([path.expanduser().absolute() for path in paths])
        source = RemoteSource(file, file.ask("open", paths=[str(path) for path in file.paths])[0])
        if file_identity(paths) == source.identity:
            return source
        source.close()
    raise FieldError(f"{paths[0]}: the file changed while it was read; open it when it is complete")


def prepare_readers() -> None:
    """Load the readers of files in the background, so that the first file opens sooner."""
    if FORKS:
        fork_server(PRELOAD)
