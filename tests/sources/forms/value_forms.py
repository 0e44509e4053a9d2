"""Forms that differ in their values: masks, fill values, flags, units, kinds of components."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from form_table import form, variants
from known_flow import (
    EAST,
    NORTH,
    Truth,
    at_points,
    current,
    earth,
    in_plane,
    lab,
    plane,
    ratio,
    without,
)
from label_forms import BACK, LAT, LON, SERIES, STEADY, series

L, B = np.meshgrid(LON, LAT)
LAND = (L > 20) & (B > 4)
SEA = without(STEADY, LAND)
X, Y = np.linspace(0, 3, 25), np.linspace(0, 1, 16)
ON_LAND = xr.DataArray(LAND, dims=("lat", "lon"))


# --- units --------------------------------------------------------------------------------------

#: Units with a number, and the factor of values in them.
SCALED = {"10^-2 m/s": 100, "0.01 m s-1": 100, "cm s**-1 * 1e-1": 1000, "10-3 m s-1": 1000}


def scaled(ds: Any, factor: float, unit: str) -> Any:
    """Return a dataset with u and v in another unit, without other attributes."""
    for name in "uv":
        ds[name] = (ds[name] * factor).assign_attrs(units=unit)
    return ds


@variants(SCALED, says="converted from")
def unit_with_a_number(unit: str) -> Any:
    return scaled(earth(LON, LAT), SCALED[unit], unit), STEADY


@variants(SCALED, says="converted from")
def unit_with_a_number_of_u_alone(unit: str) -> Any:
    ds = scaled(earth(LON, LAT), SCALED[unit], unit)
    ds["v"] = earth(LON, LAT).v
    return ds, STEADY


@variants(SCALED)
def unit_with_a_number_in_the_plane(unit: str) -> Any:
    ds = scaled(lab(X * 1000, Y * 1000), SCALED[unit], unit)
    u, v = plane(*np.meshgrid(X, Y))
    ds = ds.assign(u=(ds.u.dims, u * SCALED[unit], ds.u.attrs))
    ds = ds.assign(v=(ds.v.dims, v * SCALED[unit], ds.v.attrs))
    for name in "xy":
        ds[name].attrs["units"] = "mm"
    return ds, in_plane(X, Y, unit="m", speed_unit="m/s")


@variants(
    [
        ("u_cm_s", "v_cm_s"),
        ("U [cm/s]", "V [cm/s]"),
        ("u_cms", "v_cms"),
        ("U (cm s-1)", "V (cm s-1)"),
    ],
    says="units by names",
)
def unit_in_the_name(names: tuple[str, str]) -> Any:
    ds = scaled(earth(LON, LAT), 100, "")
    return ds.rename(dict(zip("uv", names, strict=True))), STEADY


@form(says="units by names")
def unit_in_the_long_name() -> Any:
    ds = scaled(earth(LON, LAT), 100, "")
    ds.u.attrs = {"long_name": "eastward velocity (cm/s)"}
    ds.v.attrs = {"long_name": "northward velocity (cm/s)"}
    return ds, STEADY


@variants([True, False])
def units_in_the_names_of_places(table: bool) -> Any:
    ds = lab(X, Y) * 100
    ds = ds.assign_coords(x=ds.x * 1000, y=ds.y * 1000)
    ds = ds.rename(x="x_mm", y="y_mm", u="u_cm_s", v="v_cm_s")
    if table:
        ds = ds.to_dataframe().reset_index()
    return ds, in_plane(X, Y, unit="m", speed_unit="m/s")


# --- masks --------------------------------------------------------------------------------------


@variants([-999.0, -9999.0, 1e20, 9999.0, -32768.0, 9.969209968386869e36], says="mask|fill")
def land_without_declaration(value: float) -> Any:
    """Land has one value in both components, and no attribute says so."""
    return earth(LON, LAT).where(~ON_LAND, value), SEA


@form(says="mask|fill")
def land_without_declaration_and_a_date_as_text() -> Any:
    """(time, longitude, latitude), whose units are unknown."""
    ds = earth(LON, LAT).where(~ON_LAND, -999.0).expand_dims(time=["2024-01-01"])
    for name in ds.variables:
        ds[name].attrs = {"units": "m s-1"} if name in ("u", "v") else {}
    return ds.rename(lon="longitude", lat="latitude").transpose("time", "longitude", ...), SEA


@form(says="mask|fill")
def fill_in_single_precision() -> Any:
    ds = earth(LON, LAT).astype("f4")
    return ds.where(~ON_LAND, np.float32(1e20)), SEA


@form(says="mask|fill")
def fill_in_a_series() -> Any:
    ds = series().where(~ON_LAND, -999.0)
    return ds, without(SERIES, LAND)


@variants(["_FillValue", "missing_value"], says="mask|fill|missing")
def declared_and_not_decoded(name: str) -> Any:
    ds = earth(LON, LAT).where(~ON_LAND, 77.0)
    for component in "uv":
        ds[component].attrs[name] = 77.0
    return ds, SEA


@variants(["valid_min", "valid_max", "valid_range", "both"], says="valid|outside")
def outside_the_valid_values(name: str) -> Any:
    value = -60.0 if name == "valid_min" else 60.0
    ds = earth(LON, LAT).where(~ON_LAND, value)
    limits = {"valid_min": -50.0, "valid_max": 50.0}
    one = limits if name == "both" else {name: limits.get(name, np.array([-50.0, 50.0]))}
    for component in "uv":
        ds[component].attrs.update(one)
    return ds, SEA


#: Names of masks, and their value on land; standard names for the first two.
MASKS: dict[str, tuple[int, str]] = {
    "land_binary_mask": (1, "land_binary_mask"),
    "sea_binary_mask": (0, "sea_binary_mask"),
    "anything": (0, "sea_binary_mask"),
    "lsm": (1, ""),
    "landmask": (1, ""),
    "LANDMASK": (1, ""),
    "mask": (0, ""),
    "wet": (0, ""),
    "tmask": (0, ""),
    "mask_rho": (0, ""),
}


def masked(name: str) -> xr.Dataset:
    on_land, standard_name = MASKS[name]
    values = ON_LAND.astype("i1") if on_land else (~ON_LAND).astype("i1")
    attrs = {"standard_name": standard_name} if standard_name else {}
    ds = current(earth(LON, LAT)).where(~ON_LAND, 0.341)
    return ds.assign({name: values.assign_attrs(attrs)})


@variants(MASKS, says="mask")
def land_beside(name: str) -> Any:
    """Land has a value like those of the sea."""
    return masked(name), SEA


@variants(["lsm", "mask"], says="mask")
def land_in_a_dataset_of_its_own_from_north_to_south(name: str) -> Any:
    ds = masked(name)
    return [ds[["u", "v"]], ds[[name]].isel(lat=BACK)], SEA


@form(says="mask")
def land_with_an_axis_of_time() -> Any:
    ds = current(series()).where(~ON_LAND, 0.341)
    lsm = ON_LAND.astype("f4").expand_dims(time=ds.time)
    return ds.assign(lsm=lsm), without(SERIES, LAND)


@form()
def land_beside_a_wind() -> Any:
    """Air moves over land: the mask of a weather model is about something else."""
    return earth(LON, LAT).assign(lsm=ON_LAND.astype("f4")), STEADY


@variants(["mask", "lsm", "land_binary_mask"], says="mask")
def land_of_a_wind_with_one_value(name: str) -> Any:
    """As satellites measure it over the sea: the one value on land is no wind."""
    ds = masked(name)
    return ds.assign(u=ds.u.assign_attrs(EAST), v=ds.v.assign_attrs(NORTH)), SEA


@form(options={"mask": False})
def mask_that_is_not_wanted() -> Any:
    return current(earth(LON, LAT)).assign(lsm=ON_LAND.astype("i1")), STEADY


@form(says="mask")
def land_as_flags() -> Any:
    flags = {
        "standard_name": "surface_type",
        "flag_values": np.array([0, 1, 2], "i1"),
        "flag_meanings": "sea land lake",
    }
    mask = ON_LAND.astype("i1").assign_attrs(flags)
    return current(earth(LON, LAT)).where(~ON_LAND, 0.341).assign(mask=mask), SEA


def flagged(meaning: str, *, apart: bool = False) -> xr.Dataset:
    """Flags 1 and 4 of quality; the values at 4 are no currents."""
    ds = earth(LON, LAT).where(~ON_LAND, 0.341)
    for component, attrs in (("u", EAST), ("v", NORTH)):
        name = f"{component}_qc" if apart else "quality"
        word = f"{attrs['standard_name']} status_flag" if apart else "quality_flag"
        flags = {
            "standard_name": word,
            "flag_values": np.array([1, 4], "i1"),
            "flag_meanings": f"good {meaning}",
        }
        ds[name] = (1 + 3 * ON_LAND).astype("i1").assign_attrs(flags)
        ds[component].attrs = {**attrs, "ancillary_variables": name}
    return ds


@variants(["bad", "bad_data", "fail"], says="mask|flag")
def bad_by_quality_flags(meaning: str) -> Any:
    return flagged(meaning, apart=True), SEA


@form(says="mask|flag")
def bad_by_one_quality_flag() -> Any:
    return flagged("bad"), SEA


@form()
def flags_beside_that_are_good() -> Any:
    ds = earth(LON, LAT)
    for name, of in (("qc_u", EAST), ("qc_v", NORTH)):
        attrs = {"standard_name": of["standard_name"] + " status_flag", "units": "1"}
        ds[name] = (("lat", "lon"), np.ones(L.shape, "i1"), attrs)
    return ds, STEADY


@variants(["standard_error", "number_of_observations"])
def variables_with_a_modifier(word: str) -> Any:
    ds = earth(LON, LAT)
    for name, of in (("east", EAST), ("north", NORTH)):
        attrs = {**of, "standard_name": f"{of['standard_name']} {word}"}
        ds[f"{name}_more"] = (("lat", "lon"), np.full(L.shape, 0.1), attrs)
    return ds, STEADY


@form()
def heights_beside() -> Any:
    ds = earth(LON, LAT).rename(u="UU", v="VV")
    for n in ("UU", "VV"):
        ds[n].attrs = {"units": "m s-1"}
        ds[f"HGT_{n[0]}"] = (("lat", "lon"), np.full(L.shape, 100.0), {"units": "meters MSL"})
    return ds, STEADY


@form()
def errors_beside() -> Any:
    ds = earth(LON, LAT)
    for n in "uv":
        ds[f"{n}_err"] = (("lat", "lon"), np.full(L.shape, 0.1), {"units": "m s-1"})
    return ds, STEADY


@form()
def bounds_beside() -> Any:
    ds = earth(LON, LAT)
    for name, half in (("lon", 1.0), ("lat", 2.0)):
        line = ds[name].values
        ds[name].attrs["bounds"] = f"{name}_bnds"
        ds[f"{name}_bnds"] = ((name, "bnds"), np.stack([line - half, line + half], axis=-1))
    return ds, STEADY


@form(error="K|unit|velocity|component")
def temperatures_named_u_and_v() -> Any:
    ds = earth(LON, LAT)
    for n in "uv":
        ds[n].attrs = {"units": "K"}
    return ds


# --- units --------------------------------------------------------------------------------------


FACTORS = {
    "cm s-1": 100.0,
    "km/h": 3.6,
    "knots": 3600 / 1852,
    "kt": 3600 / 1852,
    "m s**-1": 1.0,
    "meter second-1": 1.0,
    "ft/s": 1 / 0.3048,
    "m yr-1": 31556952.0,
    "km day-1": 86.4,
    "mm/s": 1000.0,
}


@variants(FACTORS)
def unit_on_the_earth(unit: str) -> Any:
    """Years have 365.2425 or 365.25 days."""
    ds = earth(LON, LAT)
    for name, attrs in (("u", EAST), ("v", NORTH)):
        ds[name] = (ds[name] * FACTORS[unit]).assign_attrs(attrs, units=unit)
    return ds, STEADY


@form()
def units_of_u_and_v_differ() -> Any:
    ds = earth(LON, LAT)
    return ds.assign(u=(ds.u * 100).assign_attrs(EAST, units="cm s-1")), STEADY


@form()
def units_of_u_and_v_differ_without_standard_names() -> Any:
    ds = earth(LON, LAT)
    ds["u"] = (ds.u * 3.6).assign_attrs(units="km/h")
    ds["v"].attrs = {"units": "m/s"}
    return ds, STEADY


@form(says="unit|m/s")
def no_unit_on_the_earth() -> Any:
    ds = earth(LON, LAT)
    for n in "uv":
        ds[n].attrs = {}
    return ds, STEADY


#: Units of the positions and of the velocity in the plane.
LABORATORY = {
    "m and m/s": ("m", "m/s"),
    "mm and m/s": ("mm", "m/s"),
    "mm and mm/s": ("mm", "mm/s"),
    "cm and cm s-1": ("cm", "cm/s"),
    "inch and ft/s": ("inch", "ft/s"),
    "km and knot": ("km", "knot"),
    "um and um/s": ("um", "um/s"),
    "m and m/year": ("m", "m/year"),
    "pixel and pixel/frame": ("pixel", "pixel/frame"),
    "px and px/frame": ("px", "px/frame"),
    "m without": ("m", ""),
    "without m/s": ("", "m/s"),
    "without": ("", ""),
}


@variants(LABORATORY)
def unit_in_the_plane(kind: str) -> Any:
    length, speed = LABORATORY[kind]
    ds = lab(X, Y, units=speed) if speed else lab(X, Y)
    for name in "xy" if length else "":
        ds[name].attrs["units"] = length
    return ds, in_plane(X, Y, unit=length, speed_unit=speed)


@form()
def units_of_x_and_y_differ() -> Any:
    ds = lab(X, Y, units="m/s").assign_coords(
        x=("x", X, {"units": "m"}), y=("y", 100 * Y, {"units": "cm"})
    )
    return ds, in_plane(X, Y, unit="m", speed_unit="m/s")


@form()
def units_of_components_in_the_plane_differ() -> Any:
    ds = lab(X, Y, units="m/s")
    ds["v"] = (ds.v * 1000).assign_attrs(units="mm/s")
    for name in "xy":
        ds[name].attrs["units"] = "mm"
    return ds, in_plane(X, Y, unit="mm", speed_unit="m/s")


# --- kinds of components ------------------------------------------------------------------------


@form(never="longitude")
def laboratory_axes() -> Any:
    ds = lab(X, Y, dims=("x2", "x1")).transpose("x1", "x2")
    return ds, in_plane(X, Y)


@variants(["first", "last", "middle"])
def axis_of_components(place: str) -> Any:
    """One array with an axis of components named x and z, over (x, z)."""
    values = np.stack(plane(*np.meshgrid(X, Y, indexing="ij")))
    array = xr.DataArray(
        values, dims=("vdims", "x", "z"), coords={"vdims": ["x", "z"], "x": X, "z": Y}, name="B"
    )
    order = {"first": ("vdims", "x", "z"), "last": ("x", "z", "vdims")}
    return array.transpose(*order.get(place, ("x", "vdims", "z"))), in_plane(X, Y)


@form()
def axis_of_components_in_another_order() -> Any:
    array, truth = axis_of_components("first")
    return array.isel(vdims=BACK), truth


@form(error="component|name")
def axis_of_components_without_names() -> Any:
    array, truth = axis_of_components("last")
    return array.rename(z="y").drop_vars("vdims"), truth


@variants(["from", "to"])
def speed_and_direction(kind: str) -> Any:
    ds = earth(LON, LAT)
    sign = -1 if kind == "from" else 1
    speed = np.hypot(ds.u, ds.v).assign_attrs(units="m s-1", standard_name="wind_speed")
    angle = np.degrees(np.arctan2(sign * ds.u, sign * ds.v)) % 360
    attrs = {"units": "degree", "standard_name": f"wind_{kind}_direction"}
    return xr.Dataset({"wspd": speed, "wdir": angle.assign_attrs(attrs)}), STEADY


@form()
def direction_in_a_dataset_of_its_own_from_north_to_south() -> Any:
    ds, truth = speed_and_direction("from")
    return [ds[["wspd"]], ds[["wdir"]].isel(lat=BACK)], truth


@form()
def sea_water_speed_and_direction_in_radians() -> Any:
    ds = earth(LON, LAT)
    speed = np.hypot(ds.u, ds.v) * 100
    speed.attrs = {"units": "cm/s", "standard_name": "sea_water_speed"}
    angle = np.arctan2(ds.u, ds.v)
    angle.attrs = {"units": "radian", "standard_name": "sea_water_velocity_to_direction"}
    return xr.Dataset({"speed": speed, "direction": angle}), STEADY


@form(error="direction")
def speed_and_direction_of_unknown_meaning() -> Any:
    """Nothing says whether the wind comes or goes."""
    ds = speed_and_direction("from")[0]
    ds["wdir"].attrs = {"units": "degree"}
    ds["wspd"].attrs = {"units": "m s-1"}
    return ds, STEADY


@variants(["rad", "degrees"], error="polar|radial|r and phi")
def components_along_r_and_phi(unit: str) -> Any:
    r, a = np.geomspace(0.1, 1, 20), np.linspace(0, 2 * np.pi, 48, endpoint=False)
    R, A = np.meshgrid(r, a, indexing="ij")
    x, y = R * np.cos(A), R * np.sin(A)
    u, v = plane(x, y)
    radial, around = u * np.cos(A) + v * np.sin(A), v * np.cos(A) - u * np.sin(A)
    line = a if unit == "rad" else np.degrees(a)
    return xr.Dataset(
        {"v_r": (("r", "phi"), radial), "v_phi": (("r", "phi"), around)},
        {"r": ("r", r, {"units": "m"}), "phi": ("phi", line, {"units": unit})},
    ), in_plane(x, y)


@variants(["ws", "speed10m", "wind_speed"], options={"direction": "wdir"})
def the_only_speed_beside_a_direction(name: str) -> Any:
    ds, truth = speed_and_direction("from")
    return ds.rename(wspd=name), truth


@form(
    options={"vectors": "a", "direction": "b"}, says="a direction from, as nothing says otherwise"
)
def direction_of_wind_by_its_description_alone() -> Any:
    ds, truth = speed_and_direction("from")
    ds = ds.rename(wspd="a", wdir="b")
    ds["b"].attrs = {"long_name": "bearing of the wind"}
    return ds, truth


@form(options={"direction": "b"}, error="may be its speed are a; name the speed")
def a_direction_beside_no_known_speed() -> Any:
    return speed_and_direction("from")[0].drop_attrs().rename(wspd="a", wdir="b")


@variants(["ws_kn", "wind_speed_kt", "WSPD_knots", "wind_speed_kmh"])
def speed_with_its_unit_beside_a_direction(name: str) -> Any:
    """Columns as stations have them: the name of the speed ends with its unit."""
    ds, truth = speed_and_direction("from")
    factor = ratio("m/s", "km/h" if name.endswith("kmh") else "knot")
    columns = {name: factor * ds.wspd.values.ravel(), "wd": ds.wdir.values.ravel()}
    lon, lat = truth.places.T
    return pd.DataFrame({"lon": lon, "lat": lat, **columns}), truth


@form(options={"u": "wspd", "direction": "wdir"})
def speed_and_direction_in_columns() -> Any:
    ds, truth = speed_and_direction("from")
    return ds.to_dataframe().reset_index().drop(columns="time", errors="ignore"), truth


@form(options={"components": "polar"}, error="radius and an angle.*longitude|lon and lat")
def polar_components_on_the_earth() -> Any:
    return earth(LON, LAT)


@form(options={"components": "spherical"}, error="expected the axes theta and phi")
def spherical_components_in_a_plane() -> Any:
    return lab(X, Y)


@form(options={"components": "plane"})
def polar_names_of_components_along_x_and_y() -> Any:
    return lab(X, Y).rename(u="u_r", v="u_phi"), in_plane(X, Y)


@form(error="theta is from -45° to 30°")
def latitudes_that_are_called_theta() -> Any:
    theta, phi = np.radians(np.arange(-45.0, 31, 5)), np.radians(LON)
    values = np.ones((len(theta), len(phi)))
    dims = ("theta", "phi")
    return xr.Dataset(
        {"u_theta": (dims, values), "u_phi": (dims, values)}, {"theta": theta, "phi": phi}
    )


@form()
def x_that_decreases() -> Any:
    return lab(X, Y).isel(x=BACK), in_plane(X, Y)


@form(error="x|monotonic|increas|sort")
def x_that_is_shuffled() -> Any:
    x = np.random.default_rng(2).permutation(X)
    return lab(x, Y), in_plane(X, Y)


@form()
def names_in_capitals_with_numbers() -> Any:
    ds = earth(LON, LAT).rename(u="U10", v="V10")
    for name in ("U10", "V10"):
        ds[name].attrs = {"units": "m/s"}
    return ds, STEADY


@form()
def integers() -> Any:
    ds = earth(LON, LAT)
    for name, attrs in (("u", EAST), ("v", NORTH)):
        ds[name] = (ds[name] * 1e6).round().astype("i4").assign_attrs(attrs, units="um/s")
    return ds, STEADY


# --- tables -------------------------------------------------------------------------------------


def table() -> pd.DataFrame:
    x, y = np.meshgrid(X, Y)
    u, v = plane(x, y)
    return pd.DataFrame({"x": x.ravel(), "y": y.ravel(), "u": u.ravel(), "v": v.ravel()})


def planar(hole: int | None = None) -> Truth:
    truth = in_plane(X, Y)
    return truth if hole is None else replace(truth, places=np.delete(truth.places, hole, axis=0))


@form()
def rows_of_a_grid() -> Any:
    return table().drop(index=100), planar(100)


@form()
def rows_of_a_grid_in_any_order() -> Any:
    return table().sample(frac=1.0, random_state=1), planar()


@form()
def rows_of_a_grid_on_the_earth() -> Any:
    ds = earth(LON, LAT)
    return ds.to_dataframe().reset_index(), STEADY


@form()
def rows_of_a_series() -> Any:
    return series().to_dataframe().reset_index(), SERIES


@form()
def rows_by_index() -> Any:
    return earth(LON, LAT).to_dataframe(), STEADY


@form()
def rows_of_points() -> Any:
    """Points in an L: triangles between neighbours."""
    p = np.random.default_rng(0).uniform(-1, 1, (600, 2))
    x, y = p[~((p[:, 0] > 0) & (p[:, 1] > 0))].T
    u, v = plane(x, y)
    return pd.DataFrame({"x": x, "y": y, "u": u, "v": v}), at_points(np.stack([x, y], axis=-1))


@variants(["knot", "cm/s"])
def quantities_of_pint(unit: str) -> Any:
    """As MetPy's ``quantify`` makes them: the unit belongs to the values, not to attributes."""
    import pint

    registry: Any = pint.UnitRegistry()
    ds = earth(LON, LAT)
    factor = float(registry.Quantity(1.0, "m/s").to(unit).magnitude)
    for name in "uv":
        values = registry.Quantity(ds[name].values * factor, unit)
        ds[name] = (ds[name].dims, values, {"standard_name": ds[name].attrs["standard_name"]})
    return ds, STEADY
