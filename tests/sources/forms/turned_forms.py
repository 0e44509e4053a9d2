"""Forms on grids whose rows are no parallels: curvilinear, rotated and projected."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyproj
import xarray as xr
from form_table import form, variants
from known_flow import (
    AVERAGED,
    DEGREES,
    EAST,
    EAST_AT_SEA,
    NORTH,
    NORTH_AT_SEA,
    Truth,
    dates,
    in_plane,
    on_earth,
    plane,
    wind,
)
from label_forms import BACK, curved, parts

#: Error of directions that follow from differences between nodes.
TURNED = 1e-3
GRID_X = {"units": "m s-1", "standard_name": "sea_water_x_velocity"}
GRID_Y = {"units": "m s-1", "standard_name": "sea_water_y_velocity"}
PLAIN = {"units": "m s-1"}


def turned_grid(i: Any, j: Any) -> tuple[Any, Any, Any]:
    """Longitude, latitude, and the direction of rows from east in radians, of a conformal grid.

    A stereographic projection around 12 E, 48 N is turned by 25 degrees; i and j count cells.
    """
    turn, cell = np.radians(25), 8e4
    i, j = np.broadcast_arrays(*map(np.asarray, (i, j)))
    to = pyproj.Proj("+proj=stere +lat_0=48 +lon_0=12 +R=6371000")

    def places(i: Any, j: Any) -> tuple[Any, Any]:
        x = cell * (np.cos(turn) * i - np.sin(turn) * j)
        y = cell * (np.sin(turn) * i + np.cos(turn) * j)
        return to(x, y, inverse=True)

    lon, lat = places(i, j)
    (west, south), (east, north) = places(i - 1e-3, j), places(i + 1e-3, j)
    return lon, lat, np.arctan2(north - south, (east - west) * np.cos(np.radians(lat)))


def along(lon: Any, lat: Any, angle: Any, hours: float = 0.0) -> tuple[Any, Any]:
    """Return components along rows and columns whose rows point at an angle from east."""
    east, north = wind(lon, lat, hours)
    return (
        east * np.cos(angle) + north * np.sin(angle),
        north * np.cos(angle) - east * np.sin(angle),
    )


J, I = np.mgrid[-8:9, -10:11] * 1.0


# --- curvilinear --------------------------------------------------------------------------------


def on_curved(names: tuple[str, str], values: Any, attrs: Any, **lines: Any) -> xr.Dataset:
    """Return components on the turned grid with 2-D longitude and latitude."""
    lon, lat, _ = turned_grid(I, J)
    dims = ("y", "x")
    return xr.Dataset(
        {n: (dims, v, a) for n, v, a in zip(names, values, attrs, strict=True)},
        {"lon": (dims, lon, DEGREES["lon"]), "lat": (dims, lat, DEGREES["lat"]), **lines},
    )


LON_OF_GRID, LAT_OF_GRID, ANGLE = turned_grid(I, J)
ON_GRID = on_earth(LON_OF_GRID, LAT_OF_GRID)
ALONG = along(LON_OF_GRID, LAT_OF_GRID, ANGLE)
OF_EARTH = wind(LON_OF_GRID, LAT_OF_GRID)


@form(says="grid|rotat|turn")
def x_and_y_of_sea_water_on_a_turned_grid() -> Any:
    return on_curved(("uo", "vo"), ALONG, (GRID_X, GRID_Y)), ON_GRID


@form(says="grid|rotat|turn")
def x_and_y_on_a_turned_grid_in_another_order() -> Any:
    """u is along x, whatever the order of the dimensions."""
    return on_curved(("uo", "vo"), ALONG, (GRID_X, GRID_Y)).transpose("x", "y"), ON_GRID


@form(says="grid|rotat|turn")
def x_and_y_on_a_turned_grid_with_decreasing_y() -> Any:
    """v is along greater y."""
    lines = {"x": ("x", I[0], {"axis": "X"}), "y": ("y", J[:, 0], {"axis": "Y"})}
    return on_curved(("uo", "vo"), ALONG, (GRID_X, GRID_Y), **lines).isel(y=BACK), ON_GRID


@form(says="east")
def eastward_on_a_turned_grid() -> Any:
    return on_curved(("uo", "vo"), OF_EARTH, (EAST_AT_SEA, NORTH_AT_SEA)), ON_GRID


@form(says="east")
def eastward_on_a_bent_grid() -> Any:
    lon, lat = curved()
    u, v = wind(lon, lat)
    dims = ("y", "x")
    return xr.Dataset(
        {"uo": (dims, u, EAST_AT_SEA), "vo": (dims, v, NORTH_AT_SEA)},
        {"lon": (dims, lon, DEGREES["lon"]), "lat": (dims, lat, DEGREES["lat"])},
    ), on_earth(lon, lat)


@form(says="along the grid")
def points_of_a_model_along_parallels() -> Any:
    """Rows bend on the sphere, so that the nodes on the edge need more than their neighbour."""
    lon, lat = np.meshgrid(np.arange(-20.0, 21, 2), np.arange(20.0, 61, 2))
    places = {"lon_psi": lon, "lat_psi": lat}
    dims = ("eta_psi", "xi_psi")
    parts = {name: (dims, part, PLAIN) for name, part in zip("uv", wind(lon, lat), strict=True)}
    return xr.Dataset(parts, {n: (dims, c) for n, c in places.items()}), on_earth(lon, lat)


@form(options={"components": "grid"})
def told_along_the_grid() -> Any:
    return on_curved(("u", "v"), ALONG, (PLAIN, PLAIN)), ON_GRID


@form(options={"components": "earth"})
def told_along_the_earth() -> Any:
    return on_curved(("u", "v"), OF_EARTH, (PLAIN, PLAIN)), ON_GRID


@form(options={"components": "grid"})
def told_along_the_grid_against_the_name() -> Any:
    return on_curved(("u", "v"), ALONG, (EAST, NORTH)), ON_GRID


@form(options={"components": "earth"})
def told_along_the_earth_against_the_name() -> Any:
    return on_curved(("u", "v"), OF_EARTH, (GRID_X, GRID_Y)), ON_GRID


@form(options={"components": "sideways"}, error="components.*earth.*grid.*plane")
def told_something_unknown() -> Any:
    return on_curved(("u", "v"), OF_EARTH, (PLAIN, PLAIN))


@variants([0, 1])
def grib_relative_to_grid(flag: int) -> Any:
    more = {"units": "m s**-1", "GRIB_uvRelativeToGrid": flag}
    attrs = ({**EAST, **more}, {**NORTH, **more})
    return on_curved(("u10", "v10"), ALONG if flag else OF_EARTH, attrs), ON_GRID


@form(says="grid|rotat|turn|WRF")
def wrf_at_10_metres() -> Any:
    attrs = [{"description": f"{c} at 10 M", "units": "m s-1"} for c in "UV"]
    ds = on_curved(("U10", "V10"), ALONG, attrs)
    ds = ds.rename(lon="XLONG", lat="XLAT", y="south_north", x="west_east")
    return ds.expand_dims(Time=dates([0.0])), ON_GRID


def ring() -> tuple[Any, Any, Any, Any]:
    r, a = np.meshgrid(
        np.linspace(0.5, 2, 12), np.linspace(0, 2 * np.pi, 40, endpoint=False), indexing="ij"
    )
    return r * np.cos(a), r * np.sin(a), r, a


def on_ring(u: Any, v: Any, **attrs: str) -> xr.Dataset:
    x, y, *_ = ring()
    dims = ("r", "theta")
    return xr.Dataset(
        {"u": (dims, u, attrs), "v": (dims, v, attrs)},
        {"x": (dims, x, {"units": "m"}), "y": (dims, y, {"units": "m"})},
    )


@form(says=r"x and y|cartesian|along x")
def ring_with_cartesian_components() -> Any:
    x, y, *_ = ring()
    return on_ring(*plane(x, y), **PLAIN), in_plane(x, y, unit="m", speed_unit="m/s")


@form(options={"components": "plane"})
def ring_told_in_the_plane() -> Any:
    return ring_with_cartesian_components()


@form(options={"components": "grid"})
def ring_told_along_the_grid() -> Any:
    """u is along i, around the middle, and v along j, away from it."""
    x, y, _, a = ring()
    u, v = plane(x, y)
    around, outward = v * np.cos(a) - u * np.sin(a), u * np.cos(a) + v * np.sin(a)
    truth = in_plane(x, y, unit="m", speed_unit="m/s", tolerance=0.1)
    return on_ring(around, outward, **PLAIN).rename_dims(r="j", theta="i"), truth


# --- projected ----------------------------------------------------------------------------------


LAMBERT = "+proj=lcc +lat_1=30 +lat_2=60 +lat_0=45 +lon_0=-100 +R=6371000"
ROTATED = {
    "grid_mapping_name": "rotated_latitude_longitude",
    "grid_north_pole_latitude": 39.25,
    "grid_north_pole_longitude": -162.0,
}


def on_mapping(kind: str, *, geographic: bool, unit: str) -> tuple[xr.Dataset, Truth]:
    """The flow on 1-D axes of a grid mapping."""
    sphere = pyproj.CRS.from_user_input("+proj=longlat +R=6371000 +type=crs")
    flat = kind == "lambert"
    attrs = pyproj.CRS.from_user_input(LAMBERT).to_cf() if flat else ROTATED
    change = pyproj.Transformer.from_crs(pyproj.CRS.from_cf(attrs), sphere, always_xy=True)
    x, y = (1e5 * np.arange(-9, 10.0), 1e5 * np.arange(-5, 8.0))
    if not flat:
        x, y = x / 1e5, y / 1e5
    a, b = np.meshgrid(x, y)
    step = 100.0 if flat else 1e-3
    lon, lat = change.transform(a, b)
    (west, south), (east, north) = change.transform(a - step, b), change.transform(a + step, b)
    angle = np.arctan2(north - south, (east - west) * np.cos(np.radians(lat)))
    values = wind(lon, lat) if geographic else along(lon, lat, angle)
    names = ("eastward_wind", "northward_wind") if geographic else ("x_wind", "y_wind")
    axes = ("projection_x_coordinate", "projection_y_coordinate")
    axes = axes if flat else ("grid_longitude", "grid_latitude")
    ds = xr.Dataset({"crs": ((), 0, attrs)})
    for name, value, word in zip("uv", values, names, strict=True):
        ds[name] = (
            ("y", "x"),
            value,
            {"standard_name": word, "units": "m/s", "grid_mapping": "crs"},
        )
    for name, line, word in zip("xy", (x, y), axes, strict=True):
        scaled = line / 1000 if unit == "km" else line
        ds = ds.assign_coords({name: (name, scaled, {"standard_name": word, "units": unit})})
    return ds, on_earth(lon, lat, tolerance=AVERAGED if geographic else TURNED)


@variants(["m", "km"])
def projected_with_x_wind(unit: str) -> Any:
    return on_mapping("lambert", geographic=False, unit=unit)


@variants(["m", "km"])
def projected_with_eastward_wind(unit: str) -> Any:
    return on_mapping("lambert", geographic=True, unit=unit)


@form()
def projected_from_north_to_south_in_v() -> Any:
    ds, truth = on_mapping("lambert", geographic=False, unit="m")
    u, v = parts(ds.drop_vars("crs"))
    return [u.assign(crs=ds.crs), v.assign(crs=ds.crs).isel(y=BACK)], truth


@form()
def rotated_pole_with_x_wind() -> Any:
    return on_mapping("rotated", geographic=False, unit="degrees")


@form()
def rotated_pole_with_eastward_wind() -> Any:
    return on_mapping("rotated", geographic=True, unit="degrees")


@form()
def rotated_pole_beside_two_dimensional_places() -> Any:
    ds, truth = on_mapping("rotated", geographic=False, unit="degrees")
    lon, lat = (c.reshape(ds.u.shape) for c in truth.places.T)
    ds = ds.rename(x="rlon", y="rlat")
    dims = ("rlat", "rlon")
    return ds.assign_coords(
        lon=(dims, lon, {**DEGREES["lon"], "standard_name": "longitude"}),
        lat=(dims, lat, {**DEGREES["lat"], "standard_name": "latitude"}),
    ), truth
