"""The values of a column: numbers, also of nullable types and with decimal commas, and units."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray, Floats
from flowtex.errors import FieldError, import_extra
from flowtex.sources.datasets.directions import TURNS

#: A number with a decimal comma.
DECIMAL_COMMA = r"[-+]?\d*,\d+(?:[eE][-+]?\d+)?"
#: Points of the compass, clockwise from north.
COMPASS = (
    *("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE"),
    *("S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"),
)
#: Fewest columns with a unit in a first row of units.
FEWEST_UNITS = 2


def plain_values(values: Any) -> AnyArray:
    """Return a column or an index as an array of NumPy's types; dates with a zone are in UTC."""
    pandas = import_extra("pandas", "xarray")
    series = pandas.Series(values)
    if isinstance(series.dtype, np.dtype):
        return np.asarray(series)
    if isinstance(series.dtype, pandas.PeriodDtype):
        return np.asarray(series.dt.to_timestamp())
    kinds = pandas.api.types
    if kinds.is_numeric_dtype(series.dtype):
        return np.asarray(series.to_numpy(dtype=float, na_value=np.nan))
    if kinds.is_datetime64_any_dtype(series.dtype):
        utc = pandas.to_datetime(series, utc=True).dt.tz_localize(None)
        return np.asarray(utc.to_numpy("datetime64[ns]"))
    if kinds.is_timedelta64_dtype(series.dtype):
        return np.asarray(series.to_numpy("timedelta64[ns]"))
    return np.asarray(series.to_numpy(dtype=object))


def without_units(frame: Any) -> tuple[Any, dict[str, str]]:
    """Return a table without a first row of units, as ERDDAP writes it, and these by column."""
    if len(frame) < 2 or not frame.columns.is_unique:
        return frame, {}
    units: dict[str, str] = {}
    for name in frame.columns:
        column = frame[name]
        if not _is_text(column) or not isinstance(column.iloc[0], str):
            continue
        numbers = _parsed(column)
        if np.isnan(numbers[0]) and np.isfinite(numbers[1:]).mean() > 0.5:
            units[str(name)] = column.iloc[0].strip()
    if len(units) < FEWEST_UNITS:
        return frame, {}
    return frame.iloc[1:].reset_index(drop=True), units


def _is_text(column: Any) -> bool:
    kinds = import_extra("pandas", "xarray").api.types
    return bool(kinds.is_object_dtype(column.dtype) or kinds.is_string_dtype(column.dtype))


def _parsed(column: Any) -> Floats:
    """Return the numbers in a column of texts, (N,), also with decimal commas; NaN for others.

    Points of the compass are degrees in a column of directions.
    """
    texts = column.astype("object").where(column.notna(), "").astype(str).str.strip()
    if TURNS.search(str(column.name)):
        degrees = {point: str(22.5 * number) for number, point in enumerate(COMPASS)}
        texts = texts.str.upper().replace(degrees)
    commas = texts.str.fullmatch(DECIMAL_COMMA)
    texts = texts.where(~commas, texts.str.replace(",", ".", regex=False))
    return np.asarray(import_extra("pandas", "xarray").to_numeric(texts, errors="coerce"), float)


def column_numbers(column: Any) -> AnyArray:
    """Return a column as numbers, if most of its texts are some.

    Raises
    ------
    FieldError
        When other texts are among the numbers.
    """
    if not _is_text(column):
        return plain_values(column)
    numbers = _parsed(column)
    unread = np.isnan(numbers) & np.asarray(column.notna(), dtype=bool)
    unread &= np.asarray(column.astype(str).str.strip() != "")
    if np.isfinite(numbers).sum() <= unread.sum():
        return plain_values(column)
    if not unread.any():
        return numbers
    text = str(column[unread].iloc[0])
    raise FieldError(
        f"the column {str(column.name)!r} of numbers has the text {text!r} in row "
        f"{int(np.flatnonzero(unread)[0]) + 1:,}; if it means a missing value, replace it, as in "
        f"pd.read_csv(path, na_values=[{text!r}])"
    )
