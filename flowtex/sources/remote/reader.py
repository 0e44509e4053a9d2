"""The process that reads a file: it keeps a source open, and answers requests."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

from flowtex._util.child.worker import Answer
from flowtex.errors import FieldError
from flowtex.field.steps import LazySteps
from flowtex.sources.dataset_source import open_source
from flowtex.sources.mesh_source import Source
from flowtex.sources.remote.packing import describe_source, pack_field


class Reader:
    """Handler of the requests of a :class:`~flowtex.sources.remote.RemoteSource`."""

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
            msg = "no file is open"
            raise RuntimeError(msg)
        return self._source

    def _keep(self, steps: LazySteps) -> int:
        self._count += 1
        self._steps[self._count] = steps
        return self._count
