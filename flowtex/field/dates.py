"""Times that are dates: as seconds since the first, and back as text."""

from __future__ import annotations

import re
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import is_number
from flowtex._util.extras import import_extra
from flowtex.errors import FieldError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

DAY_S = 86_400.0
#: Text of a date, as exact as it is known.
_DATE = re.compile(
    r"(\d{1,4})(?:-(\d\d?)(?:-(\d\d?)(?:[T ](\d\d)(?::(\d\d)(?::(\d\d)(?:\.(\d+))?)?)?)?)?)?Z?"
)


def as_seconds(times: Any, time_unit: str) -> tuple[ArrayLike | None, str, Any]:
    """Return times, their unit, and the date at time 0: dates and spans become seconds."""
    start = None
    try:
        given = np.asarray(times)
        if given.dtype.kind == "O" and given.size and hasattr(given.flat[0], "isoformat"):
            start = given.flat[0]
            # Other calendars have days that datetime64 lacks; their differences are spans.
            given = (given - start).astype("timedelta64[us]")
    except (TypeError, ValueError):  # what is not an array is refused later, by its name
        return times, time_unit, None
    if given.dtype.kind not in "mM":
        return times, time_unit, None
    if time_unit not in ("", "s"):
        msg = (
            f"time_unit is {time_unit!r}, but the times are dates, which are converted to "
            "seconds; omit time_unit and give velocities per second, or give times as numbers"
        )
        raise FieldError(msg)
    if np.datetime_data(given.dtype)[0] in ("M", "Y"):
        if given.dtype.kind == "m":
            msg = (
                f"times has type {given.dtype}, whose units have no fixed length; expected dates "
                "or numbers"
            )
            raise FieldError(msg)
        given = given.astype("datetime64[D]")
    if given.dtype.kind == "M":
        first = given.flat[:1]
        if len(first) and not np.isnat(first[0]):
            start = first.astype("datetime64[us]").item(0)
            start = start if hasattr(start, "isoformat") else None  # a year that datetime lacks
        given = given - first
    seconds = np.ma.masked_array(given / np.timedelta64(1, "s"), np.ma.getmask(times))
    return seconds, "s", start


def date_text(start: Any, time: float, step: float) -> str:
    """Return a time in seconds since ``start`` as a date, as exact as steps apart need it."""
    at_midnight = not (start.hour or start.minute or start.second or start.microsecond)
    whole_days = step % DAY_S == 0 and time % DAY_S == 0 and at_midnight
    form = "%Y-%m-%d" if whole_days else "%Y-%m-%d %H:%M" if step >= 60 else "%Y-%m-%d %H:%M:%S"
    return str((start + timedelta(seconds=time)).strftime(form))


def seconds_since(start: Any, date: Any) -> float:
    """Return seconds since ``start`` of a number, a date, or a text such as a date."""
    if is_number(date) and not isinstance(date, (np.datetime64, np.timedelta64)):
        return float(date)
    if start is None:
        msg = f"time is {date!r}; expected a number, because the times of the field are not dates"
        raise FieldError(msg)
    try:
        return span_since(start, date)[0]
    except (TypeError, ValueError, AttributeError) as error:
        msg = f"time is {date!r}; expected a number, or a date such as {date_text(start, 0, 60)}"
        if calendar := getattr(start, "calendar", ""):
            msg += f" of the calendar {calendar}"
        raise FieldError(msg) from error


def span_since(start: Any, date: Any) -> tuple[float, float]:
    """Return when a date begins and ends, in seconds since ``start``, in its calendar.

    The text of a day, month or year ends with it; any other date when it begins.
    """
    if isinstance(date, np.datetime64):
        date = str(date)
    elif hasattr(date, "isoformat") and not isinstance(date, type(start)):
        date = date.isoformat()  # as a day of another calendar is written, so it is in this one
    if not isinstance(date, str):
        return (float((date - start).total_seconds()),) * 2
    if (match := _DATE.fullmatch(date.strip())) is None:
        msg = f"{date!r} is no date"
        raise FieldError(msg)
    *parts, fraction = match.groups()
    given = [int(part) for part in parts if part is not None]
    microsecond = int(f"{fraction or '':0<6.6}")
    same = {n: getattr(start, n) for n in ("calendar", "has_year_zero") if hasattr(start, n)}

    def since(year: int, month: int = 1, day: int = 1, *clock: int) -> float:
        return float((type(start)(year, month, day, *clock, **same) - start).total_seconds())

    begin = since(*given, *[0] * (6 - len(given)), microsecond) if len(given) > 3 else since(*given)
    if len(given) == 1:
        return begin, since(given[0] + 1)
    if len(given) == 2:
        year, month = given
        return begin, since(year + month // 12, month % 12 + 1)
    return begin, begin + (DAY_S if len(given) == 3 else 0)


def time_within(start: Any, times: Any, given: Any) -> float:
    """Return a time of a field, a number or a date; raise a FieldError if it is outside of them."""
    time = seconds_since(start, given)
    if not float(times[0]) <= time <= float(times[-1]):
        msg = f"time is {given!r}; expected {expected_times(start, times)}"
        raise FieldError(msg)
    return time


def expected_times(start: Any, times: Any) -> str:
    """Return the first and the last time of a field as text, as dates where they are such."""
    first, last = float(times[0]), float(times[-1])
    if start is None:
        return f"{first:g} to {last:g}, the times of the field"
    step = DAY_S if len(times) < 2 else (last - first) / (len(times) - 1)
    return f"{date_text(start, first, step)} to {date_text(start, last, step)}"


def written_date(start: Any) -> list[Any] | None:
    """Return a date as JSON holds it: numbers, and its calendar unless it is ``datetime``'s."""
    if start is None:
        return None
    parts = ("year", "month", "day", "hour", "minute", "second", "microsecond")
    return [[int(getattr(start, part)) for part in parts], getattr(start, "calendar", "")]


def date_of(written: Any) -> Any:
    """Return the date of :func:`written_date`."""
    if written is None:
        return None
    numbers, calendar = written
    if not calendar:
        return datetime(*numbers)
    # Not all calendars have a year 0, which climatologies begin with.
    zero = True if numbers[0] == 0 else None
    cftime = import_extra("cftime", "xarray")
    return cftime.datetime(*numbers, calendar=calendar, has_year_zero=zero)
