"""Components along a grid whose frame is turned against the Earth's."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyproj
import pytest
import xarray as xr
from earth_data import DEGREES, RATE, along, components, on_sphere, turning

from flowtex import FlowField
from flowtex.field.earth import EARTH_RADIUS

SPHERE = pyproj.CRS.from_user_input(f"+proj=longlat +R={EARTH_RADIUS} +type=crs")
MAPPINGS: dict[str, dict[str, Any]] = {
    "lambert": pyproj.CRS.from_user_input(
        f"+proj=lcc +lat_1=30 +lat_2=60 +lat_0=45 +lon_0=-100 +R={EARTH_RADIUS}"
    ).to_cf(),
    "polar": pyproj.CRS.from_user_input(
        f"+proj=stere +lat_0=90 +lat_ts=70 +lon_0=-45 +R={EARTH_RADIUS}"
    ).to_cf(),
    "rotated": {
        "grid_mapping_name": "rotated_latitude_longitude",
        "grid_north_pole_latitude": 39.25,
        "grid_north_pole_longitude": -162.0,
    },
}


def on_mapping(name: str, *, geographic: bool = False, scale: float = 1.0) -> xr.Dataset:
    """The rotation on lines of x and y of a grid mapping."""
    mapping = MAPPINGS[name]
    flat = name != "rotated"
    width, height = {"lambert": (2e6, 1.5e6), "polar": (4e6, 4e6), "rotated": (20, 15)}[name]
    x, y = np.linspace(-width, width, 60), np.linspace(-height, height, 40)
    step = 10.0 if flat else 1e-4
    change = pyproj.Transformer.from_crs(pyproj.CRS.from_cf(mapping), SPHERE, always_xy=True)
    a, b = np.meshgrid(x, y)
    lon, lat = change.transform(a, b)
    if geographic:
        u, v = components(lon, lat)
        names = ("eastward_wind", "northward_wind")
    else:
        u = along(lon, lat, change.transform(a + step, b))
        v = along(lon, lat, change.transform(a, b + step))
        names = ("x_wind", "y_wind")
    words = ("projection_x_coordinate", "projection_y_coordinate")
    words = words if flat else ("grid_longitude", "grid_latitude")
    unit = ("m" if scale == 1 else "km") if flat else "degrees"
    ds = xr.Dataset({"crs": ((), 0, mapping)})
    for name_, values, word in zip("uv", (u, v), names, strict=True):
        attrs = {"standard_name": word, "units": "m/s", "grid_mapping": "crs"}
        ds[name_] = ("y", "x"), values, attrs
    for axis, line, word in zip("xy", (x, y), words, strict=True):
        attrs = {"standard_name": word, "units": unit, "axis": axis.upper()}
        ds = ds.assign_coords({axis: (axis, line * scale, attrs)})
    return ds


def error(ds: xr.Dataset) -> float:
    field = FlowField.from_xarray(ds, globe=True)
    assert field.valid.all()
    exact = turning(on_sphere(*field.projection.lonlat(field.points)))  # type: ignore[union-attr]
    return float(np.abs(np.asarray(field.velocity)[0] - exact)[1:-1, 1:-1].max())


@pytest.mark.parametrize("name", MAPPINGS)
@pytest.mark.parametrize("axis", ["", "x", "y"])
def test_components_lead_to_greater_x_and_y(name: str, axis: str) -> None:
    """However the rows and columns are numbered."""
    ds = on_mapping(name)
    assert error(ds.isel({axis: slice(None, None, -1)}) if axis else ds) < 1e-3 * RATE


def test_a_grid_around_a_pole_is_drawn_around_it() -> None:
    around, beside = (on_mapping("polar").isel(y=slice(first, None)) for first in (0, 24))
    for ds, name in ((around, "north"), (beside, "platecarree")):
        projection = FlowField.from_xarray(ds).projection
        assert projection is not None and projection.family == name


@pytest.mark.parametrize("name", MAPPINGS)
def test_eastward_is_eastward_on_any_grid(name: str) -> None:
    assert error(on_mapping(name, geographic=True)) < 1e-9


def test_kilometres_are_metres() -> None:
    assert error(on_mapping("lambert", scale=1e-3)) < 1e-3 * RATE


def test_places_in_two_dimensions_win_over_a_mapping() -> None:
    ds = on_mapping("rotated")
    change = pyproj.Transformer.from_crs(
        pyproj.CRS.from_cf(MAPPINGS["rotated"]), SPHERE, always_xy=True
    )
    lon, lat = change.transform(*np.meshgrid(ds.x, ds.y))
    dims = ("y", "x")
    both = ds.assign_coords(lon=(dims, lon, DEGREES["lon"]), lat=(dims, lat, DEGREES["lat"]))
    assert error(both) < 1e-3 * RATE


def test_wrf_repeats_its_places_for_every_time() -> None:
    ds = on_mapping("lambert")
    change = pyproj.Transformer.from_crs(
        pyproj.CRS.from_cf(MAPPINGS["lambert"]), SPHERE, always_xy=True
    )
    lon, lat = change.transform(*np.meshgrid(ds.x, ds.y))
    dims = ("Time", "south_north", "west_east")
    wrf = xr.Dataset(
        {
            "U10": (dims, ds.u.values[None], {"description": "U at 10 M", "units": "m s-1"}),
            "V10": (dims, ds.v.values[None], {"description": "V at 10 M", "units": "m s-1"}),
            "XLONG": (dims, lon[None], {"units": "degree_east"}),
            "XLAT": (dims, lat[None], {"units": "degree_north"}),
        }
    )
    assert error(wrf) < 1e-3 * RATE
    assert error(wrf.set_coords(["XLONG", "XLAT"])) < 1e-3 * RATE
    # Its dates are letters.
    series = xr.concat([wrf, wrf], "Time").assign(
        Times=("Time", np.array([b"2020-01-31_18:00:00", b"2020-02-01_00:00:00"]))
    )
    field = FlowField.from_xarray(series)
    assert field.times.tolist() == [0, 21600] and str(field.start) == "2020-01-31 18:00:00"


def test_what_a_long_name_calls_zonal_is_along_the_grid_on_sides_of_cells() -> None:
    from earth_data import c_grid

    ds = c_grid("comodo", 30.0)[0]
    for name, word in (("U", "Zonal"), ("V", "Meridional")):
        ds[name].attrs = {"long_name": f"{word} velocity", "units": "m s-1"}
    assert error(ds) < 1e-3 * RATE


def test_nothing_along_an_axis_is_told() -> None:
    from flowtex.errors import FieldError

    ds = on_mapping("lambert").expand_dims(time=np.array([], "datetime64[ns]"))
    with pytest.raises(FieldError, match="u has no values along time"):
        FlowField.from_xarray(ds)
