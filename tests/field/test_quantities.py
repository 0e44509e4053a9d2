"""The values of a field at a point of its surface."""

from __future__ import annotations

import pickle
from datetime import datetime
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import RegularGridInterpolator
from scipy.spatial import Delaunay

from flowtex import FieldError, FlowField
from flowtex.field.earth.projection import Projection
from flowtex.field.quantities import values_at
from flowtex.scene.scene import Scene

Floats = NDArray[np.float64]


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
    assert values_at(field, (1, 2)).time == 1.0
    assert values_at(field, (1, 2), 1.0).speed == pytest.approx(np.hypot(3, 2))
    with pytest.raises(ValueError, match="time is 4; expected 1 to 3"):
        values_at(field, (1, 2), 4)


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


def weather(lon: Floats, lat: Floats, hours: tuple[int, ...] = (0,)) -> xr.Dataset:
    """A wind on the Earth in m/s, and a scalar."""
    t = xr.DataArray(np.array(hours, float), dims="time") / 12
    b, a = (xr.DataArray(np.radians(v), dims=[d]) for v, d in ((lat, "lat"), (lon, "lon")))
    parts = {
        "u": 10 * np.cos(b) + 4 * np.sin(2 * a + t),
        "v": 6 * np.sin(a - t) * np.cos(b) + 2 * np.sin(3 * b) + 0 * t,
        "warmth": 280 + 20 * np.cos(b) * np.sin(a),
    }
    names = {"u": "eastward_wind", "v": "northward_wind"}
    data = xr.Dataset(parts).assign_coords(lon=lon, lat=lat)
    data = data.assign_coords(
        time=np.datetime64("2024-01-01", "ns") + (t.values * 12).astype("m8[h]")
    )
    for name, standard in names.items():
        data[name].attrs = {"units": "m s-1", "standard_name": standard}
    return data.transpose("time", "lat", "lon", ...)


MAPS = ["globe", "platecarree", "mercator", "robinson", "north", "+proj=laea +lat_0=50 +lon_0=20"]


@pytest.mark.parametrize("projection", MAPS)
def test_values_are_those_of_the_data_on_every_map(
    projection: str, rng: np.random.Generator
) -> None:
    data = weather(np.arange(0, 61, 2.5), np.arange(20, 71, 2.5), (0, 6, 12))
    field = FlowField.from_xarray(data, projection=projection)
    for lon, lat, hour in rng.uniform((0, 20, 0), (60, 70, 12), (12, 3)):
        when = np.datetime64("2024-01-01", "s") + np.timedelta64(int(3600 * hour), "s")
        here = data.interp(lon=lon, lat=lat)
        got, expected = field.at(lon, lat, when), here.interp(time=when)
        speed = np.hypot(here.u, here.v).interp(time=when)
        assert got is not None
        assert got.eastward == pytest.approx(float(expected.u), abs=2e-6)
        assert got.northward == pytest.approx(float(expected.v), abs=2e-6)
        assert got.speed == pytest.approx(float(speed), abs=2e-6)
        assert got.scalars == {"warmth": pytest.approx(float(expected.warmth))}
        assert got.lonlat == pytest.approx((lon, lat))
        assert got.speed_unit == "m/s"
    for lon, lat in ((61, 40), (-0.1, 40), (30, 71), (30, 19.9), (240, -40)):
        assert field.at(lon, lat) is None


@pytest.mark.parametrize("projection", ["globe", "mercator", "north"])
def test_values_do_not_change_at_the_date_line_and_the_pole(projection: str) -> None:
    data = weather(np.arange(-180, 180, 4.0), np.arange(0, 91, 3.0))
    closed = xr.concat([data, data.isel(lon=[0]).assign_coords(lon=[180.0])], "lon")
    field = FlowField.from_xarray(data, projection=projection)
    high = [] if projection == "mercator" else [(12.0, 89.0), (-100.0, 88.1), (33.0, 90.0)]
    for lon, lat in [(179.0, 40.3), (-179.9, 11.0), (178.3, 0.0), *high]:
        got, expected = field.at(lon, lat), closed.isel(time=0).interp(lon=lon, lat=lat)
        assert got is not None
        parts = [float(expected.u), float(expected.v)]
        assert [got.eastward, got.northward] == pytest.approx(parts, abs=1e-5)


def test_triangles_around_the_pole_agree_on_the_globe_and_a_map() -> None:
    # A solid rotation, which has no direction of its own at the pole.
    places = np.random.default_rng(1).normal((0, 0, 2), size=(800, 3))
    places = places[places[:, 2] > 0] / np.linalg.norm(places[places[:, 2] > 0], axis=1)[:, None]
    lon, lat = np.degrees(np.arctan2(*places.T[1::-1])), np.degrees(np.arcsin(places[:, 2]))
    triangles = Delaunay(places[:, :2] / (1 + places[:, 2:])).simplices
    turning = np.cross([3.0, 4, 5], places)
    globe = Projection("globe")
    east, north = globe.components(lon, lat, turning)
    fields = [
        FlowField.from_triangles(
            projection.positions(lon, lat),
            triangles,
            projection.vectors(lon, lat, east, north),
            projection=projection,
            length_unit="m",
            time_unit="s",
        )
        for projection in (globe, Projection("north"))
    ]
    for at in ((20.0, 89.9), (-150.0, 75.0), (100.0, 60.0)):
        one, other = (field.at(*at) for field in fields)
        assert one is not None and other is not None
        here = [np.atleast_1d(degrees) for degrees in at]
        moved = np.cross([3.0, 4, 5], globe.positions(here[0], here[1]) / 6_371_000)
        parts = [float(part[0]) for part in globe.components(here[0], here[1], moved)]
        assert [one.eastward, one.northward] == pytest.approx(parts, abs=0.1)
        same = [one.eastward, one.northward, one.speed]
        assert [other.eastward, other.northward, other.speed] == pytest.approx(same, abs=1e-5)


@pytest.mark.parametrize("projection", ["mercator", "robinson", "+proj=laea +lat_0=40"])
@pytest.mark.parametrize("kind", ["grid", "triangles", "gaps"])
def test_arrays_on_a_map_have_the_speed_on_the_earth(projection: str, kind: str) -> None:
    lon, lat = np.meshgrid(np.arange(0.0, 61, 5), np.arange(20.0, 71, 5))
    drawn = Projection(projection, (30.0, 45.0))
    points, flow = drawn.positions(lon, lat), drawn.vectors(lon, lat, 3 + 0 * lon, 4 + 0 * lon)
    steps = np.stack([flow, -2 * flow])
    given: Any = {"projection": drawn, "length_unit": "m", "time_unit": "s", "times": [0, 1]}
    if kind == "triangles":
        triangles = Delaunay(np.stack([lon.ravel(), lat.ravel()], axis=-1)).simplices
        nodal = steps.reshape(2, -1, 3)
        field = FlowField.from_triangles(points.reshape(-1, 3), triangles, nodal, **given)
    else:
        if kind == "gaps":
            steps[1, 2, 3] = np.nan
        field = FlowField.from_arrays(points, steps, **given)
    scene = Scene.of(field)
    shown = np.stack([np.asarray(step) for step in scene.scalar_steps("speed")])
    expected = np.array([5.0, 10])[:, None, None] * np.ones(field.shape)
    if kind == "gaps":
        expected[1, 2, 3] = np.nan
    np.testing.assert_allclose(shown, expected, rtol=1e-5)
    got = field.at(30.0, 45.0, time=1)
    assert got is not None
    assert got.speed == pytest.approx(10, rel=1e-5)
    assert (field.speed_unit, field.unit_of("speed")) == ("m/s", "m/s")


def test_a_blank_place_has_no_values() -> None:
    data = weather(np.arange(0, 61, 2.0), np.arange(-40, 41, 2.0))
    land = (data.lon > 20) & (data.lon < 30) & (data.lat > 0) & (data.lat < 20)
    for projection in ("globe", "mercator"):
        field = FlowField.from_xarray(data.where(~land), projection=projection)
        assert field.at(25, 10) is None and field.at(17, 10) is not None


def test_a_point_in_space_is_bilinear_in_a_rectangle() -> None:
    x, y = np.array([0.0, 1, 3, 4]), np.array([0.0, 2, 3])
    flow = np.random.default_rng(0).normal(size=(2, 3, 4, 2))
    field = FlowField.from_arrays((x, y), flow, times=[0, 2], time_unit="s")
    expected = RegularGridInterpolator((np.array([0.0, 2]), y, x), flow)((0.5, 1.2, 2.3))
    steps = [RegularGridInterpolator((y, x), step)((1.2, 2.3)) for step in flow]
    speed = np.average(np.linalg.norm(steps, axis=-1), weights=[0.75, 0.25])
    got = field.at(2.3, 1.2, time=0.5)
    assert got is not None
    assert got.velocity[:2] == pytest.approx(expected)
    assert got.speed == pytest.approx(speed)
    places = np.stack([*np.meshgrid(x, y), np.full((3, 4), 5.0)], axis=-1)
    raised = FlowField.from_arrays(places, flow[0])
    one, other = raised.at(2.3, 1.2), raised.at(2.3, 1.2, 5.0)
    assert one is not None and other is not None and one.speed == other.speed
    assert raised.at(2.3, 1.2, 4.0) is None
    with pytest.raises(FieldError, match="expected finite numbers"):
        field.at(np.nan, 1.0)
    with pytest.raises(FieldError, match=r"the place is \['abc', 1\.0\]"):
        field.at("abc", 1.0)  # type: ignore[arg-type]
    with pytest.raises(FieldError, match="those of one place"):
        field.at(np.array([1.0, 2.0]), np.array([1.0, 2.0]))  # type: ignore[arg-type]
    assert field.at(1e300, 1.0) is None
    assert raised.at(1e300, 1.0, -1e300) is None
    with pytest.raises(FieldError, match="the quantity is 3; expected its name"):
        field.derive(3)  # type: ignore[arg-type]


def test_unknown_scalars_say_how_to_get_them() -> None:
    x, y = np.linspace(0, 1, 11), np.linspace(0, 1, 9)
    v = np.stack(np.meshgrid(x, y), axis=-1)
    field = FlowField.from_arrays((x, y), v, scalars={"heat": v[..., 0]})
    at = field.at(0.5, 0.5)
    assert at is not None
    for scalars in (field.scalars, at.scalars, pickle.loads(pickle.dumps(field)).scalars):
        for name, words in {
            "vorticity": "with_derived('vorticity')",
            "ftle": "horizon=",
            "speed": "field.speed",
            "heet": "did you mean 'heat'",
        }.items():
            for kind in (KeyError, FieldError):
                with pytest.raises(kind) as raised:
                    scalars[name]
            assert words in str(raised.value)
            assert scalars.get(name) is None
            assert name not in scalars
    other = field.with_derived("shear")
    assert other.scalars["shear"] == pytest.approx(np.zeros((1, 9, 11)), abs=1e-9)


def test_the_first_time_is_that_of_pictures_and_points() -> None:
    x, y = np.linspace(0, 1, 11), np.linspace(0, 1, 9)
    steps = np.stack([np.ones((9, 11, 2)) * k for k in (1, 2, 3)])
    field = FlowField.from_arrays((x, y), steps, times=[5.0, 6.0, 7.0])
    at = field.at(0.5, 0.5)
    assert at is not None
    assert at.time == Scene.of(field).time == 5.0
    assert at.speed == pytest.approx(np.sqrt(2))


def test_a_value_that_is_missing_at_one_step_is_that_of_the_nearer_one() -> None:
    x, y = np.linspace(0, 1, 11), np.linspace(0, 1, 9)
    heat = np.ones((3, 9, 11)) * np.array([1.0, np.nan, 3.0])[:, None, None]
    field = FlowField.from_arrays((x, y), np.ones((3, 9, 11, 2)), scalars={"heat": heat})
    scene = Scene.of(field)
    for time, wanted in ((0.0, 1.0), (0.4, 1.0), (0.6, np.nan), (1.0, np.nan), (1.9, 3.0), (2, 3)):
        scene.time = time
        at = field.at(0.33, 0.21, time=time)
        assert at is not None
        assert at.scalars["heat"] == pytest.approx(wanted, nan_ok=True)
        assert scene.scalar("heat")[3, 3] == pytest.approx(wanted, nan_ok=True)
