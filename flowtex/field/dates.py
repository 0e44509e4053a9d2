"""Times that are dates: conversion to seconds since the first, and to text."""

from __future__ import annotations

import math
import re
from datetime import datetime, timedelta
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import is_number
from flowtex._util.host_arrays import host_array
from flowtex.errors import FieldError, import_extra

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

DAY_S = 86_400.0  #: Seconds in a day.
MOST_DECIMALS = 6  #: Most decimals of a time without an exponent.
LONGEST_TIME = 1e9  #: Time from which on an exponent is used.
UNIT_LENGTH = 8  #: Greatest length of a time unit to show; longer ones are omitted.
#: Text of a date of any precision.
_DATE = re.compile(
    r"(\d{1,4})(?:-(\d\d?)(?:-(\d\d?)(?:[T ](\d\d)(?::(\d\d)(?::(\d\d)(?:\.(\d+))?)?)?)?)?)?Z?"
)


def as_seconds(times: Any, time_unit: str) -> tuple[ArrayLike | None, str, Any]:
    """Return times, their unit, and the date at time 0: dates and spans become seconds.

    Parameters
    ----------
    times
        Numbers, dates or spans of any type, (T,).
    time_unit
        Unit of the numbers; empty or ``"s"`` with dates.

    Returns
    -------
    tuple
        Times (T,), their unit, and the first date, ``None`` for numbers and spans.

    Raises
    ------
    FieldError
        When ``time_unit`` is given with dates in addition to them, or the spans are months or
        years.
    """
    start = None
    try:
        values = host_array("times", times)
        if values.dtype.kind == "O" and values.size and hasattr(values.flat[0], "isoformat"):
            start = values.flat[0]
            # Other calendars have days that datetime64 lacks; their differences are spans.
            spans: Any = np.asarray(values - start, dtype="timedelta64[us]")
            values = spans
    except (TypeError, ValueError):  # refused later, with its name
        return times, time_unit, None
    if values.dtype.kind not in "mM":
        return times, time_unit, None
    if time_unit not in ("", "s"):
        raise FieldError(
            f"time_unit is {time_unit!r}, but the times are dates, which are converted to "
            "seconds; omit time_unit and give velocities per second, or give times as numbers"
        )
    if np.datetime_data(values.dtype)[0] in ("M", "Y"):
        if values.dtype.kind == "m":
            raise FieldError(
                f"times has type {values.dtype}, whose units have no fixed length; expected dates "
                "or numbers"
            )
        values = values.astype("datetime64[D]")
    if values.dtype.kind == "M":
        first = values.flat[:1]
        if len(first) and not np.isnat(first[0]):
            start = first.astype("datetime64[us]").item(0)
            if not hasattr(start, "isoformat"):  # a year that datetime lacks
                start = None
        values = values - first
    seconds = np.ma.masked_array(values / np.timedelta64(1, "s"), np.ma.getmask(times))
    return seconds, "s", start


def date_text(start: Any, time: float, step: float) -> str:
    """Return a time in seconds since ``start`` as a date, to the precision of time steps."""
    at_midnight = not (start.hour or start.minute or start.second or start.microsecond)
    whole_days = step % DAY_S == 0 and time % DAY_S == 0 and at_midnight
    if whole_days:
        form = "%Y-%m-%d"
    elif step >= 60:
        form = "%Y-%m-%d %H:%M"
    else:
        form = "%Y-%m-%d %H:%M:%S"
    return str((start + timedelta(seconds=time)).strftime(form))


def time_text(field: Any, time: float) -> str:
    """Return a time of a field: its date, or a number that distinguishes its steps."""
    if field.start is not None:
        alone = DAY_S
    else:
        alone = abs(time) or 1.0
    if len(field.times) > 1:
        step = float(np.diff(field.times).min())
    else:
        step = alone
    if field.start is not None:
        return date_text(field.start, time, step)
    power = math.floor(math.log10(step))
    if power >= 0:
        decimals = max(2 - power, 0)
    else:
        decimals = 1 - power
    short = decimals <= MOST_DECIMALS and abs(time) < LONGEST_TIME
    if short:
        number = f"{time:.{decimals}f}"
    else:
        number = f"{time:.{MOST_DECIMALS}g}"
    if len(field.time_unit) <= UNIT_LENGTH:
        unit = field.time_unit
    else:
        unit = ""
    return f"t = {number} {unit}".strip()


def seconds_since(start: Any, date: Any) -> float:
    """Return seconds since ``start`` from a number, a date, or its text.

    Raises
    ------
    FieldError
        When a date is given and the field's times are numbers, or the calendar lacks the date.
    """
    if is_number(date) and not isinstance(date, (np.datetime64, np.timedelta64)):
        return float(date)
    if start is None:
        raise FieldError(
            f"time is {date!r}; expected a number, because the times of the field are not dates"
        )
    try:
        return span_since(start, date)[0]
    except (TypeError, ValueError, AttributeError) as error:
        msg = f"time is {date!r}; expected a number, or a date such as {date_text(start, 0, 60)}"
        if calendar := getattr(start, "calendar", ""):
            msg += f" of the calendar {calendar}"
        raise FieldError(msg) from error


def span_since(start: Any, date: Any) -> tuple[float, float]:
    """Return the begin and end of a date, in seconds since ``start``, in its calendar.

    The text of a day, month or year spans all of it; other dates end when they begin.

    Raises
    ------
    FieldError
        When the text is not a date, such as ``"2001-02-03 12:00"``.
    ValueError
        When the calendar lacks the date, such as 30 February.
    """
    if isinstance(date, np.datetime64):
        date = str(date)
    elif hasattr(date, "isoformat") and not isinstance(date, type(start)):
        date = date.isoformat()  # the same text in this calendar
    if not isinstance(date, str):
        return (float((date - start).total_seconds()),) * 2
    if (match := _DATE.fullmatch(date.strip())) is None:
        raise FieldError(f"{date!r} is not a valid date")
    *parts, fraction = match.groups()
    numbers = []
    for part in parts:
        if part is not None:
            numbers.append(int(part))
    microsecond = int(f"{fraction or '':0<6.6}")
    calendar = {}
    for n in ("calendar", "has_year_zero"):
        if hasattr(start, n):
            calendar[n] = getattr(start, n)

    def since(year: int, month: int = 1, day: int = 1, *clock: int) -> float:
        return float((type(start)(year, month, day, *clock, **calendar) - start).total_seconds())

    if len(numbers) > 3:
        clock = (*[0] * (6 - len(numbers)), microsecond)
    else:
        clock = ()
    begin = since(*numbers, *clock)
    if len(numbers) == 1:
        return begin, since(numbers[0] + 1)
    if len(numbers) == 2:
        year, month = numbers
        return begin, since(year + month // 12, month % 12 + 1)
    if len(numbers) == 3:
        return begin, begin + DAY_S
    return begin, begin


#: Names of the ends of a series, and their numbers.
ENDS = {"first": 0, "last": -1}


def time_within(start: Any, times: Any, date: Any) -> float:
    """Return a time of a field from a number, a date, ``"first"`` or ``"last"``.

    Parameters
    ----------
    start
        Date at time 0, or ``None`` for times that are numbers.
    times
        Times of the field, increasing, (T,).
    date
        A number, a date, or its text.

    Raises
    ------
    FieldError
        When the time is not from the first to the last one of the field, or cannot be read.
    """
    if isinstance(date, str) and date in ENDS:
        return float(times[ENDS[date]])
    time = seconds_since(start, date)
    if not float(times[0]) <= time <= float(times[-1]):
        raise FieldError(f"time is {date!r}; expected {expected_times(start, times)}")
    return time


def expected_times(start: Any, times: Any) -> str:
    """Return the first and the last time of a field as text, as dates if the field has them."""
    first = float(times[0])
    last = float(times[-1])
    if start is None:
        return f"{first:g} to {last:g}, the times of the field"
    if len(times) < 2:
        step = DAY_S
    else:
        step = (last - first) / (len(times) - 1)
    return f"{date_text(start, first, step)} to {date_text(start, last, step)}"


def written_date(start: Any) -> list[Any] | None:
    """Return a date as JSON: numbers, and its calendar unless ``datetime`` has the same."""
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
    if numbers[0] == 0:
        zero = True
    else:
        zero = None
    cftime = import_extra("cftime", "xarray")
    return cftime.datetime(*numbers, calendar=calendar, has_year_zero=zero)
