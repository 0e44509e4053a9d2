"""Dates of datasets, in every calendar."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from earth_data import winds

from flowtex import FlowField
from flowtex.errors import FieldError, Notice
from flowtex.field.dates import date_text
from flowtex.scene.scene import Scene

xr: Any = pytest.importorskip("xarray")
pytest.importorskip("cftime")


@pytest.mark.parametrize(
    ("calendar", "last"),
    [
        ("noleap", "2001-02-28"),
        ("360_day", "2001-02-30"),
        ("all_leap", "2001-02-29"),
        ("julian", "2001-02-28"),
        ("standard", "2001-02-28"),
    ],
)
def test_dates_are_chosen_in_every_calendar(calendar: str, last: str) -> None:
    """The last day of February exists where its calendar has it; the day after is refused."""
    dates = xr.date_range("2001-02-27", periods=6, calendar=calendar, use_cftime=True)
    data = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    series = xr.concat([data] * 6, "time")
    series = series.assign_coords(time=dates)
    after = last[:-2] + str(int(last[-2:]) + 1)
    one = FlowField.from_xarray(series, time=last)
    assert one.start.strftime("%Y-%m-%d") == last
    scene = Scene(FlowField.from_xarray(series))
    scene.time = f"{last} 12:00"
    assert date_text(scene.field.start, scene.time, 60) == f"{last} 12:00"
    for refused in (after, "nonsense"):
        with pytest.raises(FieldError, match=f"time is '{refused}'; expected one of 2001-02-27"):
            FlowField.from_xarray(series, time=refused)
        with pytest.raises(
            FieldError, match=rf"such as 2001-02-27 00:00 of the calendar {calendar}"
        ):
            scene.time = refused
    with pytest.raises(FieldError, match="expected 2001-02-27 to 2001-03-0"):
        scene.time = "2001-05-01"
    for chosen in (slice("2001-02-28", last), slice("2001-02-28", "2001-02")):
        several = FlowField.from_xarray(series, sel={"time": chosen})
        assert len(several.times) == int(last[-2:]) - 27
    with pytest.raises(FieldError, match="expected a range within 2001-02-27"):
        FlowField.from_xarray(series, sel={"time": slice("2001-05", None)})


def test_a_day_and_a_month_are_what_lies_in_them() -> None:
    data = winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5))
    noons = np.array(["2001-12-30T12", "2001-12-31T12", "2002-01-01T12"], "datetime64[ns]")
    series = xr.concat([data] * 3, "time").assign_coords(time=noons)
    for text, expected in (("2001-12-31", 31), ("2002", 1), ("2001-12", 30)):
        assert FlowField.from_xarray(series, time=text).start.day == expected
    assert len(FlowField.from_xarray(series, sel={"time": slice(None, "2001-12")}).times) == 2
    with pytest.raises(FieldError, match="expected one of 2001-12-30T12:00, 2001-12-31T12:00"):
        FlowField.from_xarray(series, time="2001-13")


def test_what_a_steady_field_has_no_use_for_is_said() -> None:
    field = FlowField.from_xarray(winds(np.arange(0.0, 50, 5), np.arange(0.0, 40, 5)))
    with pytest.warns(Notice, match="lines is 'pathlines', but the flow is steady"):
        scene = Scene.of(field, lines="pathlines")
    with pytest.warns(Notice, match="time is '2001-01-01', but the field is steady"):
        scene.time = "2001-01-01"
