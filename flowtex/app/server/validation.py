"""Checks of values that a page sends: numbers and names.

A page may send anything instead of a number or a name. Invalid values are dropped or clipped here,
so that no handler has to check again.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from contextlib import suppress
from typing import Any, TypeGuard

#: Characters of a message to a page, at most.
MESSAGE_LENGTH = 400


def number(value: object, low: float = -math.inf, high: float = math.inf) -> float | None:
    """Return a finite number within limits; ``None`` for anything else, a boolean too."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    with suppress(OverflowError):  # a whole number may have any size
        if math.isfinite(value) and low <= value <= high:
            return float(value)
    return None


def clipped(value: object, default: float, low: float, high: float) -> float:
    """Return a number clipped to limits; the default if the value is not a number."""
    checked = number(value)
    return default if checked is None else min(max(checked, low), high)


def name_among(value: object, names: Container[str]) -> TypeGuard[str]:
    """Return whether a value is one of some names."""
    return isinstance(value, str) and value in names


def mapping(value: object) -> Mapping[str, Any]:
    """Return a mapping, an empty one for anything else."""
    return value if isinstance(value, Mapping) else {}


def shortened(text: str, most: int = MESSAGE_LENGTH) -> str:
    """Return a text, cut at its end if it is long."""
    return text if len(text) <= most else f"{text[: most - 1]}…"
