"""Forms whose attributes and names say what their values alone do not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from form_table import form, variants
from known_flow import (
    EAST,
    EAST_AT_SEA,
    NORTH,
    NORTH_AT_SEA,
    Truth,
    at_points,
    current,
    earth,
    grid,
    in_plane,
    lab,
    on_earth,
    plane,
    wind,
    without,
)

from flowtex.sources.datasets.coordinates import Places

pyproj = pytest.importorskip("pyproj")

LON, LAT = np.arange(0.0, 24, 2), np.arange(20.0, 51, 3)
HOURS = (0.0, 6.0, 12.0)
A, B = np.meshgrid(LON, LAT)
LAND = (A > 12) & (B > 36)
X, Y = np.linspace(0, 3, 13), np.linspace(0, 2, 9)


def on_levels(values: Any, name: str, attrs: Any, surface: float, *, at_sea: bool = False) -> Any:
    """Return the flow at the level ``surface``, and three times as much at all others."""
    line = np.asarray(values, dtype=float)
    factor = xr.DataArray(np.where(line == surface, 1.0, 3.0), {name: line}, (name,))
    ds = earth(LON, LAT)
    ds = (ds * factor).assign(
        u=lambda d: d.u.assign_attrs(EAST), v=lambda d: d.v.assign_attrs(NORTH)
    )
    ds[name].attrs = attrs
    if at_sea:
        return current(ds)
    return ds


HYBRID = {"standard_name": "atmosphere_hybrid_sigma_pressure_coordinate", "positive": "down"}
#: Values of levels, their name, attributes, and the one nearest to the surface.
LEVELS: dict[str, tuple[Any, ...]] = {
    "heights": ((20, 50, 100, 250), "height", {}, 20),
    "heights that are usual pressures": ((250, 500, 1000), "z", {}, 250),
    "altitude by a long name": ((1000, 850, 500), "lev", {"long_name": "altitude"}, 500),
    "depths below zero": ((-200, -50, -5), "depth", {"units": "m"}, -5),
    "hybrid": ((1, 30, 90, 91), "lev", {"units": "1", **HYBRID}, 91),
    "hybrid numbers": ((1, 60, 137), "hybrid", {}, 137),
    "hybrid times 1000": ((3.6, 300, 992), "lev", {"units": "level", "positive": "down"}, 992),
    "sigma": ((0.1, 0.5, 0.99), "sigma", {}, 0.99),
    "numbers from the ground": ((1, 2, 70), "lev", {"standard_name": "model_level_number"}, 1),
    "mb": ((1000, 500, 50), "plev", {"units": "mb"}, 1000),
    "pascals in words": ((5000, 100000), "lev", {"units": "Pascals"}, 100000),
    "hpa": ((50, 1000), "lev", {"units": "hpa"}, 1000),
    "pressures by values": ((1000, 850, 500), "level", {}, 1000),
    "dbar": ((5, 100, 800), "pressure", {"units": "dbar"}, 5),
}


@variants(LEVELS)
def surface_level(kind: str) -> Any:
    return on_levels(*LEVELS[kind]), on_earth(LON, LAT)


@variants(["down", "up"])
def sigma_in_the_sea(positive: str) -> Any:
    values = [0.01, 0.5, 0.99] if positive == "down" else [-0.99, -0.5, -0.01]
    attrs = {"standard_name": "ocean_sigma_coordinate", "positive": positive}
    surface = values[0] if positive == "down" else values[-1]
    return on_levels(values, "lev", attrs, surface, at_sea=True), on_earth(LON, LAT)


def crooked() -> tuple[Any, Any]:
    """Return longitude and latitude of a grid turned against north."""
    j, i = np.mgrid[0:12, 0:15]
    return 5 + 0.27 * i + 0.08 * j, 45 + 0.18 * j - 0.05 * i


def along_the_grid(u: float, v: float) -> Truth:
    """Return the truth of constant components along the rows and columns of the crooked grid."""
    lon, lat = crooked()
    places = Places(lon, lat, is_earth=True, is_line=False, why="")
    east, north = places.turned((1, 1), np.full(lon.shape, u), np.full(lon.shape, v))
    nodes = grid(lon, lat)

    def flow(a: Any, b: Any, _hours: Any = 0) -> Any:
        near = np.hypot(nodes[:, :1] - a, nodes[:, 1:] - b).argmin(axis=0)
        return east.ravel()[near], north.ravel()[near]

    return Truth(nodes, flow=flow)


def model(u: float, v: float, names: tuple[str, str], **attrs: Any) -> xr.Dataset:
    lon, lat = crooked()
    dims = ("south_north", "west_east")
    parts = {
        name: (dims, np.full(lon.shape, value), {"units": "m s-1", **attrs})
        for name, value in zip(names, (u, v), strict=True)
    }
    return xr.Dataset(parts, {"XLONG": (dims, lon), "XLAT": (dims, lat)})


@variants(["south_north", "west_east"], says="backwards")
def model_grid_turned_over(dim: str) -> Any:
    ds = model(4.0, 7.0, ("U10", "V10")).isel({dim: slice(None, None, -1)})
    return ds, along_the_grid(4.0, 7.0)


@form()
def rotated_to_the_earth_already() -> Any:
    ds = model(10.0, 3.0, ("umet10", "vmet10"), description="10m earth rotated component")
    lon, lat = crooked()
    return ds, Truth(grid(lon, lat), flow=lambda a, _b, _t=0: (10 + 0 * a, 3 + 0 * a))


@variants([0, 1])
def grib_along_a_grid_that_is_scanned(southward: int) -> Any:
    """GRIB calls components eastward that are along the grid; rows may run from the north."""
    flags = {"GRIB_uvRelativeToGrid": 1, "GRIB_jScansPositively": 1 - southward}
    ds = model(4.0, 7.0, ("u10", "v10"), **flags)
    ds = ds.rename(XLONG="longitude", XLAT="latitude", south_north="y", west_east="x")
    for name, attrs in (("u10", EAST), ("v10", NORTH)):
        ds[name].attrs.update(attrs)
    if southward:
        ds = ds.isel(y=slice(None, None, -1))
    return ds, along_the_grid(4.0, 7.0)


@form()
@form(name="told", options={"vectors": "UVEL,VVEL"})
def meridional_called_vvel() -> Any:
    ds = current(earth(LON, LAT)).rename(u="UVEL", v="VVEL")
    ds = xr.concat([ds, ds * 2], pd.Index([5.0, 25.0], name="depth"), combine_attrs="override")
    ds.depth.attrs = {"units": "m", "positive": "down"}
    for name, words in (("UVEL", "Zonal velocity"), ("VVEL", "Meridional velocity")):
        ds[name].attrs = {"units": "m/s", "long_name": words}
    return ds, on_earth(LON, LAT)


@variants(["radian", "degree", ""], options={"vectors": "mag,angle"})
def magnitude_and_angle(unit: str) -> Any:
    ds = lab(X, Y)
    angle = np.arctan2(ds.v, ds.u)
    angle = np.degrees(angle) if unit == "degree" else angle
    return xr.Dataset(
        {"mag": np.hypot(ds.u, ds.v), "angle": angle.assign_attrs(units=unit)}
    ), in_plane(X, Y)


@form(says=r'if it is a direction to which .* components="to"')
def magnitude_and_angle_alone() -> Any:
    """As hvplot.vectorfield takes them, whose angle no attribute explains."""
    return magnitude_and_angle("")[0].transpose("x", "y"), in_plane(X, Y)


def speeds_of_radar() -> xr.Dataset:
    """Return speeds and directions of two winds in one file, as of Sentinel-1."""
    ds = earth(LON, LAT)
    u, v = ds.u.values, ds.v.values
    wind = {"units": "degree", "long_name": "Wind direction"}
    found = ds.drop_vars(["u", "v"])
    for name, turn in (("owiEcmwfWind", 40.0), ("owiWind", 0.0)):
        found[f"{name}Speed"] = (("lat", "lon"), np.hypot(u, v), {"units": "m/s"})
        found[f"{name}Direction"] = (("lat", "lon"), np.degrees(np.arctan2(-u, -v)) + turn, wind)
    return found


@form(error='owiEcmwfWindSpeed, .*; owiWindSpeed, .*as in u="owi', never="EcmwfWindSpeed and owiW")
def speeds_of_two_winds() -> Any:
    return speeds_of_radar()


@form(options={"vectors": "owiWindSpeed,owiWindDirection"})
def speed_of_one_of_two_winds() -> Any:
    return speeds_of_radar(), on_earth(LON, LAT)


@form(says="position is number 0")
def solutions_of_a_scatterometer() -> Any:
    """As of NSCAT: the last axis has four solutions, and places are declared by long names."""
    lon, lat = np.meshgrid(LON, LAT)
    u, v = wind(lon, lat)
    parts = {"Wind_Speed": np.hypot(u, v), "Wind_Dir": np.degrees(np.arctan2(u, v))}
    shares = np.array([1.0, 0.8, 0.6, 0.4])
    dims = ("row", "WVC", "position")
    ds = xr.Dataset({name: (dims, part[..., None] * shares) for name, part in parts.items()})
    ds.Wind_Speed.attrs["units"] = "m/s"
    ds.Wind_Dir.attrs = {"units": "deg", "long_name": "wind direction, toward"}
    for name, values, word in (("WVC_Lat", lat, "latitude"), ("WVC_Lon", lon, "longitude")):
        ds[name] = (dims[:2], values, {"units": "deg", "long_name": word})
    return ds, on_earth(lon, lat)


@form(error='components V1, V2, V3 have numbers.*vectors="V1,V2"', never="u1")
def numbered_components() -> Any:
    """As of ENLIL, whose axes are radius, colatitude and longitude."""
    ds = lab(X, Y, units="m/s").rename(u="V1", v="V2")
    return ds.assign(V3=0 * ds.V1.assign_attrs(units="m/s"))


@form(error='or a speed and its direction, as in vectors="hs", direction="thq"')
def height_and_direction_of_waves() -> Any:
    ds = lab(X, Y)
    parts = {"hs": ("m", np.hypot(ds.u, ds.v)), "thq": ("degree", ds.u)}
    return xr.Dataset({name: part.assign_attrs(units=u) for name, (u, part) in parts.items()})


@variants(["A/m", "V/m", "N m-2", "kg m-1 s-1"], options={"vectors": "mx,my"})
def vectors_of_another_kind(unit: str) -> Any:
    ds = lab(X, Y, units=unit).rename(u="mx", v="my")
    ds = ds.assign_coords(x=("x", X, {"units": "nm"}), y=("y", Y, {"units": "nm"}))
    return ds, in_plane(X, Y)


@form(options={"vectors": "tauu,tauv"})
def stress_on_the_earth() -> Any:
    ds = earth(LON, LAT).rename(u="tauu", v="tauv")
    for name, word in (("tauu", "eastward"), ("tauv", "northward")):
        standard = f"surface_downward_{word}_stress"
        ds[name].attrs = {"units": "N m-2", "standard_name": standard}
    return ds, on_earth(LON, LAT, speed_unit="")


@form(error="ucx, ucy .*; ucxa, ucya [^;]*Name one")
def pairs_beside_each_other() -> Any:
    ds = lab(X, Y).rename(u="ucx", v="ucy")
    ds = ds.assign(ucxa=ds.ucx / 2, ucya=ds.ucy / 2)
    for name in ds:
        standard = f"sea_water_{'x' if 'x' in str(name) else 'y'}_velocity"
        ds[name].attrs = {"units": "m s-1", "standard_name": standard}
    return ds


@form(error="u10")
def heights_that_differ() -> Any:
    return earth(LON, LAT).rename(u="u10", v="v100")


@form(error="vertical component")
def horizontal_current_in_a_section() -> Any:
    ds = current(earth(LON, LAT)).isel(lon=0, drop=True)
    return ds.expand_dims(depth=[0.5, 10.0, 50.0])


@form(error="time and one axis of space")
def profiles_over_time() -> Any:
    ds = earth(LON, LAT, HOURS).isel(lon=0, drop=True).rename(lat="height")
    ds.height.attrs = {"units": "m"}
    return ds


@form(
    error=r"'w' has the axes time and height, .*paths dheight/dtime = w", options={"vectors": "u,w"}
)
def profiles_with_a_vertical_component() -> Any:
    ds = earth(LON, LAT, HOURS).isel(lon=0, drop=True).rename(lat="height", v="w")
    ds.height.attrs = {"units": "m"}
    ds.w.attrs = {"units": "m s-1", "standard_name": "upward_air_velocity"}
    return ds.transpose("time", "height")


@variants(["azimuth", "az"])
def scan_clockwise_from_north(name: str) -> Any:
    turn, r = np.arange(0, 360, 10.0), np.linspace(0.5, 2, 9)
    angle, radius = np.meshgrid(np.radians(turn), r, indexing="ij")
    x, y = radius * np.sin(angle), radius * np.cos(angle)
    u, v = plane(x, y)
    dims = (name, "range")
    ds = xr.Dataset({"u": (dims, u), "v": (dims, v)}, {name: turn, "range": r})
    return ds, at_points(grid(x, y))


@variants(["crs: x y", "geo: lat lon crs: x y"])
def grid_mapping_with_axes(text: str) -> Any:
    x, y = np.arange(300e3, 700e3, 40e3), np.arange(5300e3, 5700e3, 40e3)
    lon, lat = pyproj.Proj("EPSG:32633")(*np.meshgrid(x, y), inverse=True)
    u, v = wind(lon, lat)
    dims = ("y", "x")
    attrs = {"grid_mapping": text}
    places = {
        name: (name, line, {"units": "m", "standard_name": f"projection_{name}_coordinate"})
        for name, line in (("x", x), ("y", y))
    }
    parts: dict[str, Any] = {"u": (dims, u, EAST | attrs), "v": (dims, v, NORTH | attrs)}
    parts["crs"] = ((), 0, pyproj.CRS(32633).to_cf())
    return xr.Dataset(parts, places), on_earth(lon, lat)


@form()
def ideal_case_with_sizes_of_cells() -> Any:
    x, y = np.arange(14) * 100.0, np.arange(9) * 100.0
    u, v = plane(*np.meshgrid(x / 500, y / 500))
    dims = ("Time", "south_north", "west_east")
    zero = (dims, np.zeros((1, 9, 14)), {"units": "degree"})
    unit = {"units": "m s-1"}
    ds = xr.Dataset(
        {"U10": (dims, u[None], unit), "V10": (dims, v[None], unit)},
        {"XLONG": zero, "XLAT": zero},
        {"DX": 100.0, "DY": 100.0},
    )
    scaled: dict[str, Any] = {
        "flow": lambda a, b, _t=0: plane(a / 500, b / 500),
        "speed_unit": "m/s",
    }
    return ds, in_plane(x, y, unit="m", **scaled)


@form()
def versions_that_follow_each_other() -> Any:
    ds = earth(LON, LAT, HOURS)
    late = ds.time > ds.time[0]
    both = [ds.where(~late), ds.where(late)]
    whole = xr.concat(both, pd.Index([1, 5], name="expver"), combine_attrs="override")
    return whole, on_earth(LON, LAT, HOURS)


ABSENT = np.stack([np.zeros(LAND.size, bool), LAND.ravel(), LAND.ravel()])


@variants([-999.0, np.nan], says="step 1")
def gaps_from_the_second_step_on(value: float) -> Any:
    ds = earth(LON, LAT, HOURS)
    gap = xr.DataArray(LAND, dims=("lat", "lon")) & (ds.time > ds.time[0])
    return ds.where(~gap, value), on_earth(LON, LAT, HOURS, absent=ABSENT)


def flagged(words: str, flag: int, name: str) -> xr.Dataset:
    ds = earth(LON, LAT).where(xr.DataArray(~LAND, dims=("lat", "lon")), 0.1)
    bits = np.array([1, 2, 4], "i1")
    attrs = {"flag_masks": bits, "flag_meanings": words}
    ds[name] = (("lat", "lon"), np.where(LAND, flag, 1).astype("i1"), attrs)
    for part, names in (("u", EAST), ("v", NORTH)):
        ds[part].attrs = {**names, "ancillary_variables": name}
    return ds


@form()
def land_as_a_bit() -> Any:
    return flagged("water land ice", 2, "mask"), without(on_earth(LON, LAT), LAND)


@form()
def bad_values_as_a_bit_beside_another() -> Any:
    return flagged("interpolated suspect bad", 5, "quality"), without(on_earth(LON, LAT), LAND)


@form(says="opposite")
def mask_with_the_opposite_meaning() -> Any:
    ds = current(earth(LON, LAT)).where(xr.DataArray(~LAND, dims=("lat", "lon")), 0.0)
    attrs = {"standard_name": "land_binary_mask"}
    ds["mask_rho"] = (("lat", "lon"), np.where(LAND, 0.0, 1.0), attrs)
    for name, names in (("u", EAST_AT_SEA), ("v", NORTH_AT_SEA)):
        ds[name].attrs = names
    return ds, without(on_earth(LON, LAT), LAND)


@form()
def directions_that_are_codes() -> Any:
    ds = earth(LON, LAT)
    turn = np.degrees(np.arctan2(-ds.u.values, -ds.v.values)) % 360
    turn[0, :3], turn[1, :3] = 990, 999
    codes = turn > 360
    dims = ("lat", "lon")
    parts = {
        "wind_speed": (dims, np.hypot(ds.u.values, ds.v.values), {"units": "m/s"}),
        "wind_from_direction": (dims, turn, {"units": "degree"}),
    }
    return xr.Dataset(parts, ds.coords), without(on_earth(LON, LAT), codes)


#: Limits as attributes that people write.
LIMITS: dict[str, dict[str, Any]] = {
    "text": {"valid_range": "-50.0, 50.0"},
    "lists": {"valid_min": [-50.0], "valid_max": [50.0]},
    "texts": {"valid_min": "-50.", "valid_max": "50.f"},
}


@variants(LIMITS)
def limits(kind: str) -> Any:
    ds = earth(LON, LAT).where(xr.DataArray(~LAND, dims=("lat", "lon")), 300.0)
    for name, names in (("u", EAST), ("v", NORTH)):
        ds[name].attrs = {**names, **LIMITS[kind]}
    return ds, without(on_earth(LON, LAT), LAND)


@form(error="u has valid_range 'low to high'")
def limits_that_are_no_numbers() -> Any:
    ds = earth(LON, LAT)
    ds.u.attrs["valid_range"] = "low to high"
    return ds


@form(says="step is 0 h")
def forecasts_of_two_starts() -> Any:
    ds = earth(LON, LAT, (0.0, 12.0)).expand_dims(step=2)
    steps = np.array([0, 6], "m8[h]").astype("m8[ns]")
    return ds.assign_coords(step=steps), on_earth(LON, LAT, (0.0, 12.0))


#: Days as people write them: three from the first of January 2024 on.
DAYS: dict[str, Any] = {
    "eight digits": np.array(["20240101", "20240102", "20240103"]),
    "ten digits": np.array(["2024010100", "2024010200", "2024010300"]),
    "numbers": np.array([20240101, 20240102, 20240103]),
    "a zone": pd.date_range("2024-01-01", periods=3, tz="UTC"),
    "another zone": pd.date_range("2024-01-01T01", periods=3, tz="Europe/Berlin"),
    "nullable numbers": pd.array([0.0, 24.0, 48.0], dtype="Float64"),
}


@variants(DAYS)
def days(kind: str) -> Any:
    ds = earth(LON, LAT, (0.0, 24.0, 48.0)).assign_coords(time=DAYS[kind])
    return ds, on_earth(LON, LAT, (0.0, 24.0, 48.0), undated=kind.startswith("nullable"))


def table() -> pd.DataFrame:
    a, b = (part.ravel() for part in np.meshgrid(X, Y))
    u, v = plane(a, b)
    return pd.DataFrame({"x": a, "y": b, "u": u, "v": v})


@form()
def nullable_columns() -> Any:
    frame = table().convert_dtypes()
    frame.loc[30:33, "u"] = pd.NA
    blank = np.isin(np.arange(len(frame)), range(30, 34))
    return frame, without(in_plane(X, Y), blank)


@form()
def decimal_commas(folder: Path) -> Any:
    path = folder / "flow.csv"
    table().to_csv(path, index=False, sep=";", decimal=",")
    return path, in_plane(X, Y)


@form()
def a_row_of_units(folder: Path) -> Any:
    head, rest = table().to_csv(index=False).split("\n", 1)
    path = folder / "flow.csv"
    path.write_text(f"{head}\nm,m,m s-1,m s-1\n{rest}")
    return path, in_plane(X, Y, unit="m", speed_unit="m/s")


@form(error="column 'u' of numbers has the text 'M' in row 6")
def a_letter_for_a_missing_value(folder: Path) -> Any:
    frame = table().astype({"u": object})
    frame.loc[5, "u"] = "M"
    path = folder / "flow.csv"
    frame.to_csv(path, index=False)
    return path


@form()
def components_in_groups_of_a_tree() -> Any:
    ds = earth(LON, LAT)
    return xr.DataTree.from_dict({"/east": ds[["u"]], "/north": ds[["v"]]}), on_earth(LON, LAT)


@variants(["dataset", "array"])
def complex_values(kind: str) -> Any:
    ds = earth(LON, LAT)
    whole = (ds.u + 1j * ds.v).assign_attrs(units="m s-1")
    data = whole.rename("w").to_dataset() if kind == "dataset" else whole
    return data, on_earth(LON, LAT)


@form(error=r"ds\.rename")
def sides_that_are_exchanged() -> Any:
    lon, lat = np.meshgrid(LON, LAT, indexing="ij")
    u, v = wind(lon, lat)
    return xr.Dataset(
        {
            "u": (("xi_rho", "eta_psi"), u[:, :-1], {"units": "m/s"}),
            "v": (("xi_psi", "eta_rho"), v[:-1], {"units": "m/s"}),
            "lon_rho": (("xi_rho", "eta_rho"), lon),
            "lat_rho": (("xi_rho", "eta_rho"), lat),
        }
    )
