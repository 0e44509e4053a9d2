"""Times that are dates, as seconds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex.errors import FieldError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["as_seconds"]


def as_seconds(times: Any, time_unit: str) -> tuple[ArrayLike | None, str]:
    """Return times and their unit: dates as seconds since the first, and spans of time as seconds.

    Numbers are returned as they are.

    Raises
    ------
    FieldError
        When the unit of dates or spans is said to be another one, or spans are of months or years.
    """
    try:
        given = np.asarray(times)
        if given.dtype.kind == "O" and given.size and hasattr(given.flat[0], "isoformat"):
            given = given.astype("datetime64[us]")
    except (TypeError, ValueError):  # what is no array is refused later, by its name
        return times, time_unit
    if given.dtype.kind not in "mM":
        return times, time_unit
    if time_unit not in ("", "s"):
        msg = (
            f"time_unit is {time_unit!r} and the times are dates, which become seconds; leave it "
            "out and give velocities per second, or give times as numbers"
        )
        raise FieldError(msg)
    if np.datetime_data(given.dtype)[0] in ("M", "Y"):
        if given.dtype.kind == "m":
            msg = (
                f"times holds {given.dtype}, which have no fixed length; expected dates or numbers"
            )
            raise FieldError(msg)
        given = given.astype("datetime64[D]")
    spans = given - given.flat[:1] if given.dtype.kind == "M" else given
    return np.ma.masked_array(spans / np.timedelta64(1, "s"), np.ma.getmask(times)), "s"
