"""Errors of files that are cut or need too much memory."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex._util.memory import available_bytes
from flowtex.errors import FieldError

#: Share of the memory for data: a reader and later computations take several times as much.
MEMORY_SHARE = 0.5
#: Bytes that always fit: to ask for the available memory takes longer than to read them.
SMALL = 100_000


def check_count(found: int, declared: int, what: str, unit: str = "bytes") -> None:
    """Raise a FieldError if a file has less than it declares."""
    if found < declared:
        msg = (
            f"the file is truncated or damaged: {what} declares {_text(declared)} {unit}, but the "
            f"file has {max(found, 0):,}, and {_text(declared - max(found, 0))} are missing; "
            "write or copy it again"
        )
        raise FieldError(msg)


def check_memory(nbytes: int, what: str) -> None:
    """Raise a FieldError if data take more than a share of the available memory."""
    if nbytes < SMALL:
        return
    budget = int(available_bytes() * MEMORY_SHARE)
    if nbytes > budget:
        msg = (
            f"{what} declares {size_text(nbytes)}, but {size_text(budget)} of memory are "
            "available for data; write a part or a coarser version to a separate file, or read "
            "it on a machine with more memory"
        )
        raise FieldError(msg)


def size_text(nbytes: int) -> str:
    """Return a number of bytes as text, such as ``"1.5 GB"``."""
    size, units = float(min(nbytes, 10**30)), ["bytes", "kB", "MB", "GB", "TB", "PB"]
    while size >= 1000 and len(units) > 1:
        size, units = size / 1000, units[1:]
    return f"{size:.3g} {units[0]}" if size < 1000 else f"{size:.0f} {units[0]}"


def _text(count: int) -> str:
    return f"{count:,}" if count < 10**18 else f"some 10^{len(str(count)) - 1}"


def values_in(array: Any) -> AnyArray:
    """Return the values of a variable of xarray's, if they fit into memory as float64."""
    check_memory(8 * array.size, f"the variable {getattr(array, 'name', None) or 'without a name'}")
    return np.asarray(array.values)
