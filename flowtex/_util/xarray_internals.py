"""What flowtex needs of xarray that its public interface lacks, in one place.

``Variable._data`` is the array that a variable holds, such as one with units, or what reads it from
a file later. The public ``data`` is the same, but reads the file first.
"""

from __future__ import annotations

from typing import Any


def held_array(variable: Any) -> Any:
    """Return the array of a variable, or what reads it later; ``None`` if xarray has changed."""
    return getattr(variable, "_data", None)
