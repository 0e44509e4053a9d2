"""Files that are read in a separate process, which keeps a source open and answers requests."""

from __future__ import annotations

import logging
import warnings
import weakref
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex._util.child.child import FORKS, Child, ChildError
from flowtex._util.child.fork_server import fork_server
from flowtex._util.child.worker import Answer
from flowtex.errors import FieldError, Notice, notify
from flowtex.field.dates import date_of, written_date
from flowtex.field.earth.projection import Projection
from flowtex.field.field import FlowField
from flowtex.field.field_arrays import Reading, ReadingStep
from flowtex.field.scalars import Scalars
from flowtex.field.steps import LazySteps, Steps
from flowtex.remedies import Remedy
from flowtex.sources.meshes.separate import end_of_reader, time_limit
from flowtex.sources.notices import DatasetNotice
from flowtex.sources.open_source import FlowSource, open_source
from flowtex.sources.read_files import file_identity

_log = logging.getLogger(__name__)

READER = "flowtex.sources.remote:Reader"
#: Modules of readers, those for meshes first.
PRELOAD = (
    *("flowtex.sources.remote", "pyvista", "vtkmodules.vtkIOXML", "vtkmodules.vtkIOLegacy"),
    *("xarray", "cf_xarray", "pyproj", "flowtex.sources.reader_errors:load_netcdf4"),
    *("dask.array", "cfgrib"),
)
#: Most readings of a file that changes meanwhile.
MOST_READINGS = 3
#: Classes of warnings by their names; others are plain ones of the user.
WARNINGS = {kind.__name__: kind for kind in (Notice, DatasetNotice)}
#: Reads a step.
Read = Callable[[int], Floats]
#: Attributes of a field that are arrays, and those that are values of JSON.
ARRAYS = ("points", "velocity", "times", "valid", "has_position", "triangles")
VALUES = (
    *("periodic", "name", "length_unit", "time_unit", "velocity_unit", "vectors", "sign_free"),
    *("units", "long_names", "uncertainty", "on_cells"),
)
#: Attributes of a field that are arrays by name.
NAMED_ARRAYS = ("scalars", "volume_values")
#: Attributes of a source.
CHOICES = (
    *("name", "vectors", "dimensions", "blocks", "block_vectors", "block_word"),
    *("default_plane", "ends", "axes", "reads_late", "nbytes"),
)


class Reader:
    """Handler of the requests of a :class:`~flowtex.sources.remote.RemoteSource`."""

    def __init__(self) -> None:
        self._source: FlowSource | None = None
        #: Steps that are read later, by their numbers in requests.
        self._steps: dict[int, LazySteps] = {}
        self._count = 0

    def __call__(self, request: dict[str, Any]) -> Answer:
        """Carry out a request; the answer has its value, and the warnings of the work."""
        for number in request.pop("forgotten", ()):
            self._steps.pop(number, None)
        action = getattr(self, f"do_{request.pop('do')}")
        try:
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                value, arrays = action(**request)
        except (OSError, ImportError) as error:
            raise FieldError(str(error)) from error
        warned = []
        for warning in caught:
            if issubclass(warning.category, UserWarning):
                remedies = getattr(warning.message, "remedies", ())
                packed = [remedy.packed() for remedy in remedies]
                warned.append([warning.category.__name__, str(warning.message), packed])
        return {"value": value, "warnings": warned}, arrays

    def do_open(self, paths: list[str]) -> Answer:
        """Open a file, or several that belong together."""
        files = [Path(path) for path in paths]
        self._source = open_source(files if len(files) > 1 else files[0])
        return self.do_part(None)

    def do_part(self, block: str | None) -> Answer:
        """Describe the choices of a block."""
        if block is None:
            source = self._opened
        else:
            source = self._opened.part(block)
        return {name: getattr(source, name) for name in CHOICES}, []

    def do_field(self, **options: Any) -> Answer:
        """Make a field."""
        return pack_field(self._opened.field(**options), self._keep)

    def do_step(self, steps: int, number: int) -> Answer:
        """Read a step."""
        return None, [self._steps[steps].step(number)]

    @property
    def _opened(self) -> FlowSource:
        if self._source is None:
            raise RuntimeError("no file is open")
        return self._source

    def _keep(self, steps: LazySteps) -> int:
        self._count += 1
        self._steps[self._count] = steps
        return self._count


def pack_field(
    field: FlowField, keep: Callable[[LazySteps], int]
) -> tuple[dict[str, Any], list[AnyArray]]:
    """Return a field as a value and arrays; ``keep`` returns a number for steps read later."""
    arrays: list[AnyArray] = []

    def packed(array: Steps | None) -> Any:
        if array is None:
            return None
        if isinstance(array, LazySteps):
            return {"steps": keep(array), "count": len(array)}
        arrays.append(array)
        return len(arrays) - 1

    value: dict[str, Any] = {name: getattr(field, name) for name in VALUES}
    value["arrays"] = {name: packed(getattr(field, name)) for name in ARRAYS}
    for group in NAMED_ARRAYS:
        value[group] = {name: packed(array) for name, array in getattr(field, group).items()}
    value["reading"] = []
    for step in field.reading:
        remedies = [remedy.packed() for remedy in step.remedies]
        value["reading"].append([step.step, step.text, step.notable, step.caption, remedies])
    value["start"] = written_date(field.start)
    value["projection"] = field.projection and field.projection.written
    return value, arrays


def unpack_field(
    value: Mapping[str, Any], arrays: Sequence[AnyArray], read: Callable[[int], Read]
) -> FlowField:
    """Return a field from :func:`pack_field`; a ValueError where arrays do not fit together."""

    def unpacked(packed: Any) -> Any:
        if isinstance(packed, dict):
            return LazySteps(int(packed["count"]), read(int(packed["steps"])))
        if packed is None:
            return None
        return arrays[packed]

    values = {name: value[name] for name in VALUES}
    values["on_cells"] = tuple(value["on_cells"])
    values["periodic"] = (bool(value["periodic"][0]), bool(value["periodic"][1]))
    for group in NAMED_ARRAYS:
        values[group] = {name: unpacked(packed) for name, packed in value[group].items()}
    reading = []
    for step, text, notable, caption, packed in value["reading"]:
        remedies = tuple(Remedy(*values) for values in packed)
        reading.append(ReadingStep(step, text, notable, caption, remedies))
    values["scalars"] = Scalars(values["scalars"])
    field = FlowField(
        reading=Reading(reading),
        **{name: unpacked(value["arrays"][name]) for name in ARRAYS},
        **values,
        start=date_of(value["start"]),
        projection=Projection.of(value["projection"]),
    )
    _check(field)
    return field


def _check(field: FlowField) -> None:
    """Raise an error if the shapes, types or numbers of nodes do not describe a field."""
    (rows, columns) = field.shape
    steps = len(field.times)
    shapes: dict[str, tuple[Steps, tuple[int, ...], str]] = {
        "points": (field.points, (rows, columns, 3), "f"),
        "velocity": (field.velocity, (steps, rows, columns, 3), "f"),
        "valid": (field.valid, (rows, columns), "b"),
    }
    if field.has_position is not None:
        shapes["has_position"] = (field.has_position, (rows, columns), "b")
    if (corners := field.triangles) is not None:
        shapes["triangles"] = (corners, (len(corners), 3), "iu")
        if corners.size and not 0 <= corners.min() <= corners.max() < columns:
            raise ValueError(f"triangles have nodes {corners.min()} to {corners.max()}")
    for name, array in field.scalars.items():
        if corners is not None and name in field.on_cells:
            count = len(corners)
        else:
            count = columns
        shapes[name] = (array, (len(array), rows, count), "biuf")
    samples: dict[str, object] = dict(field.volume_values)  # from another process
    for name, sample in samples.items():
        if not isinstance(sample, np.ndarray) or sample.ndim != 1 or sample.dtype.kind != "f":
            raise ValueError(f"the values of {name} in the volume are no row of numbers")
    for name, (array, shape, kinds) in shapes.items():
        if isinstance(array, LazySteps):
            if len(array) != shape[0]:
                raise ValueError(f"{name} has {len(array)} steps; expected {shape[0]}")
        elif array.shape != shape or array.dtype.kind not in kinds:
            raise ValueError(f"{name} is {array.dtype} of shape {array.shape}; expected {shape}")


class RemoteSource(FlowSource):
    """A file, or several, that another process reads and keeps open, and may crash without harm.

    That process ends with the source, and with all fields of it whose time steps are read late.
    """

    def __init__(
        self, file: _OpenFile, description: Mapping[str, Any], block: str | None = None
    ) -> None:
        super().__init__()
        try:
            for name in CHOICES:
                value = description[name]
                if isinstance(value, dict):
                    value = {key: tuple(items) for key, items in value.items()}
                setattr(self, name, tuple(value) if isinstance(value, list) else value)
        except (TypeError, KeyError, AttributeError) as error:
            raise FieldError(file.malformed(error)) from error
        self.identity = file.identity
        self._file = file
        self._block = block
        self._parts: dict[str | None, FlowSource] = {}

    @property
    def alive(self) -> bool:
        """Whether its process continues, as far as is known."""
        return self._file.child.alive

    def close(self) -> None:
        """End the process of the file."""
        self._file.child.close()

    def part(self, block: str | None = None) -> FlowSource:
        """Return the source of one of the blocks, as :meth:`FlowSource.part` does."""
        if not self.blocks:
            return self
        if block not in self._parts:
            part = RemoteSource(self._file, self._file.ask("part", block=block)[0], block)
            self._parts[block] = part
            self.nbytes += part.nbytes if self.reads_late else 0
        return self._parts[block]

    def field(
        self, vectors: str | None = None, plane: str = "", block: str | None = None, **options: Any
    ) -> FlowField:
        """Make a field, as :meth:`FlowSource.field` does."""
        if block is None:
            block = self._block
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
        self._timeout = time_limit(size)
        #: Steps that the other process forgets with the next request.
        self.forgotten: deque[int] = deque()
        self.child = Child(READER, preload=PRELOAD)

    def ask(self, do: str, **request: Any) -> tuple[Any, list[AnyArray]]:
        """Return the answer to a request, and issue its warnings; errors start with the path."""
        forgotten = [self.forgotten.popleft() for _ in range(len(self.forgotten))]
        message = {"do": do, "forgotten": forgotten, **request}
        try:
            answer, arrays = self.child.request(message, timeout=self._timeout)
            value = answer["value"]
            warned = answer["warnings"]
        except ChildError as error:
            raise FieldError(self._fault(error)) from error
        except (TypeError, KeyError) as error:
            raise FieldError(self.malformed(error)) from error
        for kind, text, packed in warned:
            remedies = [Remedy(*values) for values in packed]
            notify(str(text), WARNINGS.get(kind, UserWarning), remedies)
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

    def _fault(self, error: ChildError) -> str:
        path = self.paths[0]
        text = str(error)
        if error.kind == "FieldError":
            return text
        if error.kind:
            _log.error("the reader of %s failed:\n%s", path, error.trace)
            return f"{path}: cannot be read: {text or error.kind}"
        return f"{path}: {end_of_reader(self.child, error)}"

    def malformed(self, error: Exception) -> str:
        """Return the text of an error for an answer that makes no sense."""
        return f"{self.paths[0]}: the reader of this file sent a malformed answer: {error!r}"


class _RemoteSteps:
    """Reader of steps of a field from the other process, which keeps them while this lives."""

    def __init__(self, file: _OpenFile, number: int) -> None:
        self._file = file
        self._number = number
        weakref.finalize(self, file.forgotten.append, number).atexit = False

    def __call__(self, step: int) -> Floats:
        """Return a step, (J, I, ...)."""
        _, arrays = self._file.ask("step", steps=self._number, number=step)
        self._file.check()
        return arrays[0]


def open_remote(paths: Sequence[Path]) -> RemoteSource:
    """Open a file, or several of one dataset, in another process.

    Raises
    ------
    FieldError
        When the file cannot be read, or changes again and again while it is read.
    """
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
