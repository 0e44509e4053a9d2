"""Files as flows, and what was chosen of them said in plain words."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flowtex._util.progress import waiting
from flowtex.cli.console import in_flags, say
from flowtex.cli.options import UsageError
from flowtex.options import FieldOptions

if TYPE_CHECKING:
    from flowtex.field import FlowField


def load_field(files: Sequence[Path], choice: Mapping[str, Any]) -> FlowField:
    """Return the flow of a file, or of several that belong together."""
    if not files:
        msg = "there is no file; name one"
        raise UsageError(msg)
    options, whole = dict(choice), files[0] if len(files) == 1 else files
    time = options.pop("time", None)
    with waiting(f"Reading {files[0].name}"), notices():
        return FieldOptions(**options).field(whole, time)


@contextmanager
def notices() -> Iterator[None]:
    """Say what was chosen of the data in plain words, and pass on all other warnings."""
    from flowtex._util.notices import Notice

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", Notice)
        yield
    for warning in caught:
        if issubclass(warning.category, Notice):
            say((in_flags(str(warning.message)), "dim"))
        elif not warning.category.__module__.startswith("xarray."):  # how a file was written
            warnings.warn_explicit(
                warning.message, warning.category, warning.filename, warning.lineno
            )
