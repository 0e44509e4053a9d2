"""The process that reads a file: it keeps a source open, and answers requests."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from flowtex._util.array_types import AnyArray, Floats
from flowtex._util.child.worker import Answer
from flowtex.errors import FieldError
from flowtex.field.dates import date_of, written_date
from flowtex.field.earth import Projection
from flowtex.field.field import FlowField
from flowtex.field.steps import LazySteps, Steps
from flowtex.sources.open_source import Source, open_source

#: Reads a step.
Read = Callable[[int], Floats]
#: Attributes of a field that are arrays, and those that are values of JSON.
ARRAYS = ("points", "velocity", "times", "valid", "has_position", "triangles")
VALUES = (
    "periodic",
    "name",
    "length_unit",
    "time_unit",
    "velocity_unit",
    "vectors",
    "sign_free",
    "units",
    "long_names",
    "uncertainty",
    "on_cells",
)
#: Attributes of a source.
CHOICES = (
    *("name", "vectors", "dimensions", "blocks", "block_vectors", "block_word"),
    *("default_plane", "ends", "axes", "reads_late", "nbytes"),
)


class Reader:
    """Handler of the requests of a :class:`~flowtex.sources.remote.source.RemoteSource`."""

    def __init__(self) -> None:
        self._source: Source | None = None
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
        warned = [
            [warning.category.__name__, str(warning.message)]
            for warning in caught
            if issubclass(warning.category, UserWarning)
        ]
        return {"value": value, "warnings": warned}, arrays

    def do_open(self, paths: list[str]) -> Answer:
        """Open a file, or several that belong together."""
        files = [Path(path) for path in paths]
        self._source = open_source(files if len(files) > 1 else files[0])
        return describe_source(self._source), []

    def do_part(self, block: str | None) -> Answer:
        """Describe the choices of a block."""
        return describe_source(self._opened.part(block)), []

    def do_plane_of(self, level: float | str) -> Answer:
        """Find the plane of a level."""
        return self._opened.plane_of(level), []

    def do_field(self, **options: Any) -> Answer:
        """Make a field."""
        return pack_field(self._opened.field(**options), self._keep)

    def do_step(self, steps: int, number: int) -> Answer:
        """Read a step."""
        return None, [self._steps[steps].step(number)]

    @property
    def _opened(self) -> Source:
        if self._source is None:
            raise RuntimeError("no file is open")
        return self._source

    def _keep(self, steps: LazySteps) -> int:
        self._count += 1
        self._steps[self._count] = steps
        return self._count


def describe_source(source: Source) -> dict[str, Any]:
    """Return the choices of a source."""
    return {name: getattr(source, name) for name in CHOICES}


def take_description(source: Source, description: Mapping[str, Any]) -> None:
    """Set the choices of a source, from :func:`describe_source`."""
    for name in CHOICES:
        value = description[name]
        if isinstance(value, dict):
            value = {key: tuple(items) for key, items in value.items()}
        setattr(source, name, tuple(value) if isinstance(value, list) else value)


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
    value["scalars"] = {name: packed(array) for name, array in field.scalars.items()}
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
        return None if packed is None else arrays[packed]

    values = {name: value[name] for name in VALUES}
    values["on_cells"] = tuple(value["on_cells"])
    values["periodic"] = (bool(value["periodic"][0]), bool(value["periodic"][1]))
    field = FlowField(
        **{name: unpacked(value["arrays"][name]) for name in ARRAYS},
        **values,
        scalars={name: unpacked(packed) for name, packed in value["scalars"].items()},
        start=date_of(value["start"]),
        projection=Projection.of(value["projection"]),
    )
    _check(field)
    return field


def _check(field: FlowField) -> None:
    """Raise an error if the shapes, types or numbers of nodes do not describe a field."""
    (rows, columns), steps = field.shape, len(field.times)
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
        count = len(corners) if corners is not None and name in field.on_cells else columns
        shapes[name] = (array, (len(array), rows, count), "biuf")
    for name, (array, shape, kinds) in shapes.items():
        if isinstance(array, LazySteps):
            if len(array) != shape[0]:
                raise ValueError(f"{name} has {len(array)} steps; expected {shape[0]}")
        elif array.shape != shape or array.dtype.kind not in kinds:
            raise ValueError(f"{name} is {array.dtype} of shape {array.shape}; expected {shape}")
