"""Faults of one call, raised together.

Checks return each fault as one sentence that names the value, what was expected and the remedy.
:func:`raise_faults` turns them into a single error, so that a user corrects a call once and not
once for every argument.
"""

from __future__ import annotations

from collections.abc import Sequence


class FieldError(ValueError):
    """Invalid data or arguments; the text names the value, what was expected, and the remedy.

    All other errors of this package for invalid input are subclasses of it.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.FlowField.from_file("missing.vts")
    Traceback (most recent call last):
    flowtex.FieldError: ...
    """


FieldError.__module__ = "flowtex"  # where it is public, as tracebacks show it


def raise_faults(faults: Sequence[str]) -> None:
    """Raise a FieldError with all faults, if there are any."""
    if not faults:
        return
    if len(faults) == 1:
        raise FieldError(faults[0])
    listed = "\n".join(f"  {n}. {fault}" for n, fault in enumerate(faults, start=1))
    raise FieldError(f"{len(faults)} things are wrong:\n{listed}")
