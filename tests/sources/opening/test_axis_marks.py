"""Axes are suggested by the names of coordinates as cf_xarray does."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from flowtex.sources.opening.axis_marks import guess_axes

xr = pytest.importorskip("xarray")
pytest.importorskip("cf_xarray")

NAMES = (
    *("time", "T", "month2", "valid_time", "step"),
    *("x", "ni", "xlong", "longitude", "glamt"),
    *("j", "ylat", "nav_lat", "year"),
    *("lev", "depth", "isobaric3", "run"),
)
#: Names of dates and durations, of which some suggest another axis.
NAMES_OF_TIMES = ("time", "step", "year", "run")
DECLARED: tuple[dict[str, str], ...] = (
    {},
    {"axis": "X"},
    {"axis": "T"},
    {"axis": "unknown"},
    {"units": "degrees_north"},
    {"units": "m", "positive": "down"},
    {"standard_name": "longitude"},
    {"standard_name": "time"},
    {"standard_name": "air_pressure"},
    {"long_name": "as the name says"},
)
DATES = np.array(["2024-01-01", "2024-01-02", "2024-01-03"], dtype="datetime64[ns]")


def values_of(kind: str) -> Any:
    """Return three values of a kind."""
    if kind == "dates":
        return DATES
    if kind == "durations":
        return DATES - DATES[0]
    if kind == "calendar":
        return xr.date_range("2001-02-28", periods=3, calendar="360_day", use_cftime=True).values
    return np.arange(3.0)


def attributes(ds: Any) -> dict[str, Any]:
    return {str(name): variable.attrs for name, variable in ds.variables.items()}


@pytest.mark.parametrize("kind", ["numbers", "dates", "durations", "calendar"])
@pytest.mark.parametrize("declared", DECLARED, ids=str)
def test_guess_is_that_of_cf_xarray(kind: str, declared: dict[str, str]) -> None:
    names: tuple[str, ...] = NAMES_OF_TIMES
    if kind == "numbers":
        names = NAMES
    for name in names:
        ds = xr.Dataset({"u": (name, np.ones(3))}, {name: (name, values_of(kind), declared)})
        before = {name: dict(attrs) for name, attrs in attributes(ds).items()}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            expected = ds.cf.guess_coord_axis()
        assert attributes(guess_axes(ds)) == attributes(expected)
        assert attributes(ds) == before


def test_guess_of_positions_in_two_dimensions_is_that_of_cf_xarray() -> None:
    places = {name: (("y", "x"), np.ones((2, 3))) for name in ("nav_lon", "nav_lat", "depth")}
    ds = xr.Dataset({"u": (("y", "x"), np.ones((2, 3)))}, {**places, "time": DATES[0], "run": 1})
    ds["u"].attrs["coordinates"] = "nav_lon nav_lat"
    assert attributes(guess_axes(ds)) == attributes(ds.cf.guess_coord_axis())
