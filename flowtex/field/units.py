"""Words for units that follow from others."""

from __future__ import annotations

__all__ = ["speed_unit"]


def speed_unit(length: str, time: str) -> str:
    """Return the word for the unit of speed; empty when one of the units is not known."""
    if not length or not time:
        return ""
    if time.startswith(f"{length} / "):
        return time.removeprefix(f"{length} / ")
    return f"{length} / ({time})" if "/" in time else f"{length}/{time}"
