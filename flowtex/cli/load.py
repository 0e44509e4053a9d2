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

if TYPE_CHECKING:
    from flowtex.field import FlowField

__all__ = ["load_field", "notices"]


def load_field(files: Sequence[Path], choice: Mapping[str, Any]) -> FlowField:
    """Return the flow of a file, or of several that belong together."""
    from flowtex.field import FlowField
    from flowtex.options import FieldOptions
    from flowtex.pyramid import is_store
    from flowtex.pyramid.others import has_parts

    if not files:
        msg = "there is no file; name one"
        raise UsageError(msg)
    options = dict(choice)
    with waiting(f"Reading {files[0].name}"), notices():
        if len(files) == 1 and has_parts(files[0]):
            if options and is_store(files[0]):
                msg = f"--{next(iter(options))} is for what a pyramid is built from; leave it out"
                raise UsageError(msg)
            if (time := options.pop("time", None)) is not None:
                options["sel"] = {**options.get("sel", {}), "time": time}
            return FieldOptions(**options).field(files[0])
        whole: Any = files[0] if len(files) == 1 else files
        return FlowField.from_file(whole, **options)


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
