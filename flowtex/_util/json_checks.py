"""Checks of values that were read as JSON, such as the attributes of a store."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, TypeAlias

Check: TypeAlias = Callable[[Any], bool]  #: A function that returns whether a value is valid.
MOST_LETTERS = 10_000  #: Most characters of a text.
MOST_NAMES = 1000  #: Most entries of a dictionary.


def is_flag(value: object) -> bool:
    """Return whether a value is true or false."""
    return isinstance(value, bool)


def is_text(value: object) -> bool:
    """Return whether a value is a text that is not too long."""
    return isinstance(value, str) and len(value) <= MOST_LETTERS


def whole(least: int, most: int) -> Check:
    """Return a check for whole numbers within limits."""
    return lambda value: type(value) is int and least <= value <= most


def is_number(value: Any) -> bool:
    """Return whether a value is a finite number."""
    return type(value) in (int, float) and math.isfinite(value)


def either(*values: object) -> Check:
    """Return a check for one of these values."""
    return lambda value: value in values and type(value) is not bool


def list_of(check: Check, least: int, most: int | None = None) -> Check:
    """Return a check for a list of ``least`` to ``most`` valid values, by default ``least``."""
    if most is None:
        most = least
    return lambda v: isinstance(v, list) and least <= len(v) <= most and all(map(check, v))


def or_none(check: Check) -> Check:
    """Return a check for ``None`` and for valid values."""
    return lambda value: value is None or check(value)


def by_name(check: Check) -> Check:
    """Return a check for valid values by name."""
    return lambda v: (
        isinstance(v, dict)
        and len(v) <= MOST_NAMES
        and all(map(is_text, v))
        and all(map(check, v.values()))
    )
