"""Faults of one call, raised together.

Checks return each fault as one sentence that names the value, what was expected and the remedy.
:func:`raise_faults` turns them into a single error, so that a user corrects a call once and not
once for every argument.
"""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["FieldError", "raise_faults"]


class FieldError(ValueError):
    """The data or arguments make no flow; the text names them, what was expected and the remedy.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.FlowField.from_file("missing.vts")
    Traceback (most recent call last):
    flowtex.errors.FieldError: ...
    """


def raise_faults(faults: Sequence[str], error: type[Exception] = FieldError) -> None:
    """Raise ``error`` with every fault, or return when there is none."""
    if not faults:
        return
    if len(faults) == 1:
        raise error(faults[0])
    listed = "\n".join(f"  {n}. {fault}" for n, fault in enumerate(faults, start=1))
    msg = f"{len(faults)} things are wrong:\n{listed}"
    raise error(msg)
