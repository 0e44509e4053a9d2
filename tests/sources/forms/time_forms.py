"""Forms that differ in their times: offsets, order, calendars, text, numbers, gaps."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from form_table import form, variants
from known_flow import dates, earth, in_plane, lab, on_earth
from label_forms import BACK, HOURS, LAT, LON, SERIES, STEADY, parts, series

FOUR = np.arange(4) * 6.0
X, Y = np.linspace(0, 3, 25), np.linspace(0, 1, 16)


def retimed(ds: xr.Dataset, times: Any, **attrs: str) -> xr.Dataset:
    return ds.assign_coords(time=("time", times, attrs))


@form(says="time")
def v_at_two_of_four_times() -> Any:
    u, v = parts(earth(LON, LAT, FOUR))
    return [u, v.isel(time=slice(1, 3))], on_earth(LON, LAT, FOUR[1:3])


@form(says="time")
def v_at_later_times_as_many() -> Any:
    u, v = parts(earth(LON, LAT, FOUR))
    return [u.isel(time=slice(0, 3)), v.isel(time=slice(1, 4))], on_earth(LON, LAT, FOUR[1:3])


@form(says="time")
def one_time_in_common() -> Any:
    u, v = parts(earth(LON, LAT, FOUR))
    return [u.isel(time=slice(0, 2)), v.isel(time=slice(1, 4))], on_earth(LON, LAT, FOUR[1:2])


@variants([0.5, 3.0, 100.0], error="time")
def v_later_by_hours(hours: float) -> Any:
    u, v = parts(series())
    return [u, retimed(v, dates(HOURS + hours))]


@form(error="time")
def v_at_a_single_other_time() -> Any:
    u, v = parts(earth(LON, LAT, FOUR))
    return [u.isel(time=0), v.isel(time=1)]


@form(error="time")
def v_without_time_beside_a_series_of_u() -> Any:
    u, v = parts(series())
    return [u, v.isel(time=0, drop=True)]


@form(error="time")
def v_along_a_dimension_of_another_name() -> Any:
    u, v = parts(series())
    return [u, v.rename(time="t")], SERIES


@form(error="time")
def v_along_a_dimension_of_another_name_later() -> Any:
    u, v = parts(earth(LON, LAT, FOUR))
    v = v.rename(time="time_counter").isel(time_counter=slice(1, 4))
    return [u.isel(time=slice(0, 3)), v], on_earth(LON, LAT, FOUR[1:3])


@form()
def times_out_of_order() -> Any:
    return series().isel(time=[2, 0, 1]), SERIES


@form(says="duplicate|repeat|twice")
def times_that_repeat() -> Any:
    return series().isel(time=[0, 1, 1, 2]), SERIES


@form(says="NaT|missing")
def a_missing_time() -> Any:
    ds = earth(LON, LAT, FOUR)
    times = ds.time.values.copy()
    times[3] = np.datetime64("NaT", "ns")
    return retimed(ds, times), on_earth(LON, LAT, FOUR[:3])


@form(says="NaT|missing")
def a_missing_time_between() -> Any:
    ds = earth(LON, LAT, FOUR)
    times = ds.time.values.copy()
    times[1] = np.datetime64("NaT", "ns")
    return retimed(ds, times), on_earth(LON, LAT, FOUR[[0, 2, 3]])


CALENDARS = ["standard", "noleap", "360_day", "proleptic_gregorian", "julian", "all_leap"]


@variants(CALENDARS)
def calendar(name: str) -> Any:
    numbers = {"units": "hours since 2024-01-01", "calendar": name}
    ds = xr.decode_cf(
        retimed(series(), HOURS, **numbers), decode_times=xr.coders.CFDatetimeCoder(use_cftime=True)
    )
    return ds, SERIES


@form(error="calendar|time")
def calendars_of_u_and_v_differ() -> Any:
    return [calendar("noleap")[0][["u"]], series()[["v"]]], SERIES


@form(error="calendar|time|unit")
def times_of_v_are_not_decoded() -> Any:
    u, v = parts(series())
    return [u, retimed(v, HOURS, units="hours since 2024-01-01")], SERIES


@variants(["hours since 2024-01-01", "days since 2023-12-31 00:00:00", "minutes since 2024-01-01"])
def numbers_since(unit: str) -> Any:
    """Not decoded; the date is in the unit."""
    length = {"hours": 1.0, "days": 24.0, "minutes": 1 / 60}[unit.split()[0]]
    first = 24.0 if "2023" in unit else 0.0
    return retimed(series(), (HOURS + first) / length, units=unit), SERIES


@variants(["nc", "undecoded"])
def no_calendar_of_another_variable(kind: str, folder: Path) -> Any:
    """HYCOM has ``tau``, in "hours since analysis", beside dates that are well declared."""
    ds = series()
    edges = {"bounds": "tau_bnds", "units": "hours since analysis"}
    ds = ds.assign(tau=("time", HOURS, edges), tau_bnds=(("time", "side"), np.zeros((3, 2))))
    ds.time.encoding["units"] = "hours since 2023-12-31"
    path = folder / "hycom.nc"
    ds.to_netcdf(path)
    if kind == "nc":
        return path, SERIES
    return xr.load_dataset(path, decode_times=False), SERIES


@variants(["h", "hours", "s", "days", "min"])
def numbers_in(unit: str) -> Any:
    """Spans of time without a date."""
    length = {"h": 1.0, "hours": 1.0, "s": 1 / 3600, "days": 24.0, "min": 1 / 60}[unit]
    return retimed(series(), HOURS / length, units=unit), SERIES


@form()
def spans_of_time() -> Any:
    return retimed(series(), (HOURS * 3600e9).astype("m8[ns]")), SERIES


@variants(["time", "t", "Time", "step"])
def plain_numbers_along(name: str) -> Any:
    """An axis that is named or marked as time, with numbers without a unit."""
    ds = retimed(series(), HOURS).rename(time=name)
    if name == "step":
        ds[name].attrs["axis"] = "T"
    return ds, replace(SERIES, undated=True)


TEXTS = {
    "date": "%Y-%m-%d",
    "minutes": "%Y-%m-%dT%H:%M",
    "seconds": "%Y-%m-%d %H:%M:%S",
    "zone": "%Y-%m-%dT%H:%M:%SZ",
}


@variants(TEXTS)
def dates_as_text(kind: str) -> Any:
    hours = HOURS * 4 if kind == "date" else HOURS
    texts = xr.DataArray(dates(hours), dims="time").dt.strftime(TEXTS[kind]).values
    return retimed(earth(LON, LAT, hours), texts.astype(str)), on_earth(LON, LAT, hours)


@form()
def one_date_as_text() -> Any:
    """A series of one step whose date is text."""
    return retimed(series().isel(time=[0]), ["2024-01-01"]), STEADY


@form(error="time|date", never=r"astype|longitude")
def text_that_is_no_date() -> Any:
    return retimed(series(), ["first", "second", "third"])


@form(options={"sel": {"time": "2024-01-01T06:00"}})
def a_chosen_time_of_v_in_another_order() -> Any:
    u, v = parts(series())
    return [u, v.isel(time=BACK)], on_earth(LON, LAT, HOURS[1:2])


@form(options={"sel": {"time": "last"}})
def last_of_times_out_of_order() -> Any:
    """As ``--time last`` of the shell selects it in a file."""
    times = dates([12.0, 0.0, 6.0])
    times[1] = np.datetime64("NaT", "ns")
    return retimed(series().isel(time=[2, 0, 1]), times), on_earth(LON, LAT, HOURS[2:])


@form(options={"sel": {"time": slice("2024-01-01T05:00", "2024-01-01T13:00")}})
def a_range_of_times() -> Any:
    return series(), on_earth(LON, LAT, HOURS[1:])


@form(says="zero|rest")
def first_step_zero_everywhere() -> Any:
    """As models write the state before the first step."""
    ds = series()
    for name in "uv":
        ds[name][0] = 0.0
    return ds, replace(SERIES, scale=(0.0, 1.0, 1.0))


@form()
def gaps_that_vary_in_time() -> Any:
    """As radars leave them: a node without data at one time has data at another."""
    ds = earth(LON, LAT, HOURS)
    known = np.random.default_rng(3).random(ds.u.shape) > 0.2
    known[0] |= ~known.any(axis=0)
    missing = ~known.reshape(len(HOURS), -1)
    return ds.where(xr.DataArray(known, dims=ds.u.dims)), replace(SERIES, absent=missing)


@form()
def times_of_v_with_errors_of_rounding() -> Any:
    u, v = parts(series())
    return [u, retimed(v, v.time.values + np.timedelta64(1, "ms"))], SERIES


@form()
def letters_of_wrf() -> Any:
    """Dates are the text of a variable beside the data, and the axis has no coordinate."""
    ds = series().rename(time="Time").drop_vars("Time")
    hours = dates(HOURS).astype("datetime64[s]").astype(str)
    letters = [text.replace("T", "_").encode() for text in hours]
    return ds.assign(Times=("Time", np.array(letters))), SERIES


@form()
def steps_of_a_forecast() -> Any:
    """As cfgrib has them: a date, spans since then, and the dates of the steps beside."""
    ds = series().rename(time="step")
    valid = ds.step.values
    spans = (HOURS * 3600e9).astype("m8[ns]")
    return ds.assign_coords(
        step=("step", spans),
        time=((), dates(0.0), {"standard_name": "forecast_reference_time"}),
        valid_time=("step", valid, {"standard_name": "time"}),
    ), SERIES


@form()
def dates_of_python() -> Any:
    return retimed(series(), pd.DatetimeIndex(dates(HOURS)).to_pydatetime()), SERIES


# --- in the plane -------------------------------------------------------------------------------


@variants(["t x y", "x y t", "y t x"])
def numbers_as_times_in_the_plane(order: str) -> Any:
    t = np.linspace(0, 1, 5)
    return lab(X, Y, t).transpose(*order.split()), in_plane(X, Y, t, undated=True)


@form()
def milliseconds() -> Any:
    t = np.linspace(0, 2, 5)
    ds = lab(X, Y, t, units="m/s").assign_coords(t=("t", 1000 * t, {"units": "ms"}))
    for name in "xy":
        ds[name].attrs["units"] = "m"
    return ds, in_plane(X, Y, t, unit="m", speed_unit="m/s")


@form(says="time|t ")
def v_of_numbered_times_partly_the_same() -> Any:
    t = np.linspace(0, 1, 5)
    u, v = parts(lab(X, Y, t))
    return [u, v.isel(t=slice(2, None))], in_plane(X, Y, t[2:], undated=True)
