"""The values of a field at a point of its surface."""

from __future__ import annotations

from datetime import datetime

import numpy as np
import pytest
from earth_fields import winds

from flowtex import FieldError, FlowField
from flowtex.field.point_values import values_at


def test_values_are_linear_in_space_and_time() -> None:
    y, x = np.mgrid[0:4.0, 0:5.0]
    points = np.stack([x, y], axis=-1)
    steps = np.stack([np.stack([1 + x + t, 2 * y], axis=-1) for t in (0.0, 10.0)])
    warmth = 3 * x - y
    field = FlowField.from_arrays(
        points,
        steps,
        times=[1.0, 3.0],
        scalars={"warmth": warmth, "tide": np.stack([0 * x, 0 * x + 4])},
        length_unit="m",
        time_unit="s",
    )
    got = values_at(field, (1.25, 2.5), 1.5)
    assert got.position == pytest.approx([2.5, 1.25, 0])
    assert got.velocity == pytest.approx([1 + 2.5 + 2.5, 2.5, 0])
    assert got.scalars == pytest.approx({"warmth": 7.5 - 1.25, "tide": 1.0})
    assert (got.time, got.speed_unit) == (1.5, "m/s")
    assert values_at(field, (1, 2)).time == 3.0
    assert values_at(field, (1, 2), 1.0).speed == pytest.approx(np.hypot(3, 2))
    with pytest.raises(ValueError, match="time is 4; expected 1 to 3"):
        values_at(field, (1, 2), 4)


@pytest.mark.parametrize(
    ("length", "time", "speed"),
    [
        ("m", "s", "m/s"),
        ("", "s", ""),
        ("m", "", ""),
        ("chords", "chords / free-stream speed", "free-stream speed"),
        ("m", "1/Hz", "m / (1/Hz)"),
    ],
)
def test_the_unit_of_speed(length: str, time: str, speed: str) -> None:
    y, x = np.mgrid[0:3.0, 0:3.0]
    field = FlowField.from_arrays(
        np.stack([x, y], -1), np.ones((3, 3, 2)), length_unit=length, time_unit=time
    )
    assert values_at(field, (1, 1)).speed_unit == speed


def test_a_vector_without_a_sign_does_not_cancel() -> None:
    y, x = np.mgrid[-1:1:5j, -1:1:5j]
    half = 0.5 * np.arctan2(y, x)
    points = np.stack([x, y], axis=-1)
    field = FlowField.from_arrays(
        points, np.stack([np.cos(half), np.sin(half)], -1), sign_free=True, periodic=""
    )
    for j in np.linspace(0.1, 3.9, 7):
        got = values_at(field, (j, 0.3))
        assert np.linalg.norm(got.velocity) > 0.65


def stream(normal: float, **options: object) -> FlowField:
    y, x = np.mgrid[0:4.0, 0:5.0]
    velocity = np.stack([3 + 0 * x, 4 + 0 * x, normal + 0 * x], axis=-1)
    return FlowField.from_arrays(np.stack([x, y], axis=-1), velocity, **options)  # type: ignore[arg-type]


def test_the_speed_says_whether_a_part_of_the_flow_is_left_out() -> None:
    lies, leaves = stream(0.0), stream(12.0)
    assert values_at(lies, (1, 1)).speed_label == lies.label_of("speed") == "speed"
    assert values_at(leaves, (1, 1)).speed_label == "speed in the surface"
    assert leaves.label_of("speed") == "speed in the surface"
    # What is left out is less than a thousandth of the speed.
    assert stream(0.2).label_of("speed") == "speed"
    assert values_at(leaves, (1, 1)).speed == pytest.approx(5)


def test_a_speed_of_the_file_keeps_its_name() -> None:
    y = np.mgrid[0:4.0, 0:5.0][0]
    field = stream(12.0, scalars={"speed": 13 + 0 * y, "height": y})
    assert field.label_of("speed") == "speed"
    assert field.label_of("height") == "height"
    got = values_at(field, (1, 1))
    assert (got.speed_label, got.scalars["speed"]) == ("speed in the surface", 13)


@pytest.mark.parametrize("name", ["globe", "robinson"])
def test_a_field_of_the_earth_tells_place_and_velocity_there(name: str) -> None:
    got = values_at(winds(name, cells=36), (27, 40))
    lat = 45.0 if name == "globe" else 40.0
    assert got.lonlat == pytest.approx((20, lat), abs=0.01)
    assert got.eastward == pytest.approx(10 * np.cos(np.radians(lat)), abs=0.05)
    assert got.northward == pytest.approx(0, abs=0.05)
    y, x = np.mgrid[0:3.0, 0:3.0]
    plain = FlowField.from_arrays(np.stack([x, y], axis=-1), np.stack([x, y], axis=-1))
    assert values_at(plain, (1, 1)).lonlat is None


def test_a_time_may_be_a_date_where_the_times_are() -> None:
    times = np.array(["2000-01-01", "2000-01-03"], dtype="datetime64[D]")
    velocity = np.ones((2, 3, 3, 2)) * np.array([1.0, 3.0])[:, None, None, None]
    field = FlowField.from_arrays((np.arange(3.0), np.arange(3.0)), velocity, times=times)
    cftime = pytest.importorskip("cftime")
    dates = ("2000-01-02", np.datetime64("2000-01-02"), datetime(2000, 1, 2), 86_400)
    for date in (*dates, cftime.datetime(2000, 1, 2, calendar="standard")):
        got = values_at(field, (1, 1), date)
        assert got.time == 86_400 and got.speed == pytest.approx(2 * np.sqrt(2))
    with pytest.raises(FieldError, match="time is '2000-01-04'; expected 2000-01-01 to 2000-01-03"):
        values_at(field, (1, 1), "2000-01-04")
    with pytest.raises(FieldError, match="time is 'noon'; expected a number, or a date such as"):
        values_at(field, (1, 1), "noon")
