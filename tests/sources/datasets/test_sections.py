"""Vertical sections of datasets: a component along the section, and a vertical one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr

import flowtex
from flowtex import FieldError, FlowField
from flowtex.field.steps import LazySteps
from flowtex.plotting.offscreen.axes_kinds import AxesScales
from flowtex.sources.notices import DatasetNotice

#: Metres of a degree.
DEGREE = np.radians(6_371_000.0)
LAT, LEVELS = np.linspace(-60.0, 60.0, 13), np.array([1000.0, 700.0, 400.0, 100.0])
UPWARD = {"units": "m s-1", "standard_name": "upward_air_velocity"}
OMEGA = {"units": "Pa s-1", "standard_name": "lagrangian_tendency_of_air_pressure"}
HPA = {"units": "hPa"}


def section(w: dict[str, str], levels: dict[str, str], name: str = "level") -> xr.Dataset:
    """Return two metres a second to the north, and three units upward or downward."""
    dims, ones = (name, "lat"), np.ones((len(LEVELS), len(LAT)))
    v = {"units": "m s-1", "standard_name": "northward_wind"}
    return xr.Dataset(
        {"v": (dims, 2 * ones, v), "w": (dims, 3 * ones, w)},
        {"lat": ("lat", LAT, {"units": "degrees_north"}), name: (name, LEVELS, levels)},
    )


@pytest.mark.parametrize(
    ("w", "levels", "name", "expected", "downward"),
    [
        (UPWARD, {"units": "m", "positive": "up"}, "height", 3.0, False),
        (UPWARD, {"units": "km", "positive": "up"}, "height", 0.003, False),
        (UPWARD, {"units": "m", "positive": "down"}, "depth", -3.0, True),
        (UPWARD, {"units": "m"}, "depth", -3.0, True),
        (UPWARD | {"units": "mm/s"}, {"units": "m"}, "height", 0.003, False),
        (OMEGA, HPA, "level", 0.03, True),
        (OMEGA, {"units": "Pa", "positive": "down"}, "plev", 3.0, True),
        (OMEGA | {"units": "hPa/day"}, HPA, "level", 3 / 86400, True),
        ({"units": "m/s"}, {"units": "m"}, "height", 3.0, False),
    ],
)
def test_particles_move_in_the_units_of_the_axes(
    w: dict[str, str], levels: dict[str, str], name: str, expected: float, downward: bool
) -> None:
    field = FlowField.from_xarray(section(w, levels, name), "v", "w")
    assert field.section is not None and field.section.downward == downward
    assert field.section.x == "latitude (°)" and field.section.y == f"{name} ({levels['units']})"
    np.testing.assert_allclose(field.velocity[0][..., 0], 2 / DEGREE)
    np.testing.assert_allclose(field.velocity[0][..., 1], expected)
    np.testing.assert_allclose(field.points[..., 0], np.broadcast_to(LAT, field.shape))
    np.testing.assert_allclose(field.points[..., 1].T, np.broadcast_to(LEVELS, field.shape[::-1]))
    assert np.ptp(field.scalars["speed"][0]) == 0 and field.scalars["w"][0][0, 0] == 3


def test_what_is_chosen_along_other_axes_is_a_section() -> None:
    lon, times = np.arange(0.0, 360.0, 30.0), np.array(["2001-01-01", "2001-01-02"], "M8[ns]")
    flat = section(OMEGA, HPA).expand_dims(time=times, lon=lon)
    ds = flat.assign_coords(lon=("lon", lon, {"units": "degrees_east"}))
    ds["v"] = ds["v"] + ds["lon"] + 1000 * xr.DataArray([0, 1], dims="time")
    ds["v"].attrs = flat["v"].attrs
    field = FlowField.from_xarray(ds, "v", "w", lon=90)
    assert (field.shape, len(field.times)) == ((4, 13), 2)
    np.testing.assert_allclose([s[0, 0] for s in field.scalars["v"]], [92, 1092])
    with pytest.warns(DatasetNotice, match="lon is 0 degrees_east, the first of 12 values"):
        assert FlowField.from_xarray(ds, "v", "w").shape == (4, 13)
    ds = ds.rename(v="u")
    ds["u"].attrs = {"units": "m/s", "standard_name": "eastward_wind"}
    field = FlowField.from_xarray(ds, "u", "w", lat=60, time="2001-01-01")
    assert field.section is not None and field.section.x == "longitude (°)"
    np.testing.assert_allclose(field.velocity[0][0, :, 0], (2 + lon) / DEGREE / 0.5)


@pytest.mark.parametrize("begin", [-180.0, 0.0])
@pytest.mark.parametrize("chosen", [-30.0, 330.0, -31.0, 329.0])
def test_a_longitude_is_selected_from_either_side(begin: float, chosen: float) -> None:
    lon = begin + np.arange(0.0, 360.0, 30.0)
    axis = {"units": "degrees_east", "axis": "X"}
    ds = section(OMEGA, HPA).expand_dims(lon=lon).assign_coords(lon=("lon", lon, axis))
    ds["v"] = ds["v"] + (ds["lon"] % 360)
    ds["v"].attrs = section(OMEGA, HPA)["v"].attrs
    field = FlowField.from_xarray(ds, "v", "w", sel={"lon": chosen})
    assert (field.scalars["v"][0] == 332).all()


def kilograms(ds: xr.Dataset) -> xr.Dataset:
    return ds.rename(lat="x").assign_coords(x=("x", LAT, {"units": "kg"}))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda ds: ds.assign(w=ds["w"].assign_attrs(UPWARD)),
            "level is in 'hPa' and w in 'm s-1'",
        ),
        (
            lambda ds: ds.assign(w=ds["w"].isel(level=0)),
            "interpolate one to the levels of the other",
        ),
        (lambda ds: ds.drop_vars("level"), "level has no coordinate; add it, as in"),
        (kilograms, "the unit of x is 'kg'; expected degrees, or one of length"),
        (
            lambda ds: ds.rename(lat="lon").assign_coords(lon=("lon", LAT)),
            "the latitude of a section along lon is not known; add it",
        ),
        (
            lambda ds: ds.isel(level=0, drop=True),
            "v has the axes lat; expected levels and one more",
        ),
    ],
)
def test_what_is_not_known_is_an_error(change: Any, message: str) -> None:
    with pytest.raises(FieldError, match=message):
        FlowField.from_xarray(change(section(OMEGA, HPA)), "v", "w")


def test_axes_have_the_top_above_and_names(opengl: Any) -> None:
    del opengl
    import matplotlib.pyplot as plt

    ds = section(OMEGA, HPA)
    figure, (linear, log) = plt.subplots(1, 2)
    log.set_yscale("log")
    for ax in (linear, log):
        image = flowtex.axes(ax, ds, u="v", v="w", samples=3)
        assert image.colour_label == "speed along the section (m/s)"
        assert ax.get_ylim() == pytest.approx((1000, 100)) and ax.get_aspect() == "auto"
        assert (ax.get_xlabel(), ax.get_ylabel()) == ("latitude (°)", "level (hPa)")
        assert np.asarray(image.make_image(None)[0]).std() > 10
    plt.close(figure)
    times = np.array(["2001-01-01", "2001-01-02"], "M8[ns]")
    series = FlowField.from_xarray(ds.expand_dims(time=times), "v", "w")
    scales, frame = AxesScales(log, framed=False), series.surface.frame
    assert frame is not None and isinstance(scales.field(series, frame).velocity, LazySteps)
    with pytest.warns(DatasetNotice, match=r"vertical section of .* use flowtex\.axes"):
        flowtex.render(ds, u="v", v="w", size=(30, 20), samples=3)


def test_fill_values_of_a_section_are_blank() -> None:
    ds = section(OMEGA, HPA)
    ds["w"] = ds["w"].where(ds["lat"] < 30.0, -999.0).assign_attrs(OMEGA)
    with pytest.warns(DatasetNotice, match="31% of w masked: -999"):
        field = FlowField.from_xarray(ds, "v", "w")
    np.testing.assert_array_equal(field.valid, np.broadcast_to(LAT < 30.0, field.shape))


@pytest.mark.parametrize("option", [{"components": "polar"}, {"max_edge": 2.0}])
def test_options_of_horizontal_flows_are_refused(option: dict[str, Any]) -> None:
    (name,) = option
    with pytest.raises(FieldError, match=f"^{name} applies to horizontal flows.*omit it$"):
        FlowField.from_xarray(section(OMEGA, HPA), "v", "w", **option)


def test_components_of_a_section_are_paired_by_labels() -> None:
    ds = section(OMEGA, HPA)
    ds["w"] = (ds["w"] + ds["lat"] + ds["level"]).assign_attrs(OMEGA)
    turned = ds[["w"]].isel(level=slice(None, None, -1), lat=slice(None, None, -1))
    field = FlowField.from_xarray([ds[["v"]], turned], "v", "w")
    np.testing.assert_array_equal(field.scalars["w"][0], ds["w"].values)
    assert "w: lat reversed to match v" in str(field.reading)
    with pytest.raises(FieldError, match="v and w have no level in common"):
        FlowField.from_xarray([ds[["v"]], turned.assign_coords(level=LEVELS + 10)], "v", "w")


def test_other_variables_of_a_section_colour_it() -> None:
    ds = section(OMEGA, HPA).expand_dims(time=np.arange(3.0))
    ds["v"].attrs, ds["w"].attrs = section(OMEGA, HPA)["v"].attrs, OMEGA
    grown = ds["lat"] + ds["level"] + 100 * ds["time"]
    ds["t"] = grown.transpose("lat", "time", "level").assign_attrs(units="K", long_name="warmth")
    ds["steady"] = ds["lat"] * ds["level"]
    turned = (2 * grown).isel(level=slice(None, None, -1)).to_dataset(name="turned")
    shorter = ds[["t"]].isel(lat=slice(3)).rename(t="shorter")
    ground = (1 + ds["lat"]).to_dataset(name="ground")
    data = [ds, turned, shorter, ground]
    field = FlowField.from_xarray(data, "v", "w")
    assert sorted(field.scalars) == ["speed", "steady", "t", "turned", "v", "w"]
    assert (field.unit_of("t"), field.label_of("t")) == ("K", "warmth")
    for step in range(3):
        wanted = LAT + LEVELS[:, None] + 100 * step
        np.testing.assert_array_equal(field.scalars["t"][step], wanted)
        np.testing.assert_array_equal(field.scalars["turned"][step], 2 * wanted)
        np.testing.assert_array_equal(field.scalars["steady"][step], LAT * LEVELS[:, None])
    assert "shorter lies at other positions" in str(field.reading)
    at = field.at(10.0, 700.0, time=0.5)
    assert at is not None
    assert at.scalars["t"] == pytest.approx(760.0)
    steady = FlowField.from_xarray(data, "v", "w", isel={"time": 1})
    np.testing.assert_array_equal(steady.scalars["t"][0], LAT + LEVELS[:, None] + 100)
