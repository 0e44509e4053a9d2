"""What a page sends, taken for what it should be, or for nothing.

A page may be anybody's, and send anything in the place of a number or a name. What is no use is
left out here, so that no handler has to think of it.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping
from typing import Any

__all__ = ["clipped", "mapping", "name_among", "number", "shortened"]

#: Characters of what a page is told, at most.
LONGEST = 400


def number(value: Any, low: float = -math.inf, high: float = math.inf) -> float | None:
    """Return a finite number within limits; ``None`` for anything else, a boolean too."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    return float(value) if math.isfinite(value) and low <= value <= high else None


def clipped(value: Any, default: float, low: float, high: float) -> float:
    """Return a number, moved to the nearest limit; the default for what is no number."""
    found = number(value)
    return default if found is None else min(max(found, low), high)


def name_among(value: Any, names: Container[str]) -> bool:
    """Tell whether something is one of a few names; a list or a mapping is none."""
    return isinstance(value, str) and value in names


def mapping(value: Any) -> Mapping[str, Any]:
    """Return a mapping, an empty one for anything else."""
    return value if isinstance(value, Mapping) else {}


def shortened(text: str, most: int = LONGEST) -> str:
    """Return a text, its end left out where it is long."""
    return text if len(text) <= most else f"{text[: most - 1]}…"
