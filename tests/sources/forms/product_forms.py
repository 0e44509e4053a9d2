"""Forms of products: drift and flow of ice, currents of satellites, winds of radars."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from form_table import form, variants
from known_flow import (
    DEGREES,
    Truth,
    at_points,
    current,
    dates,
    earth,
    in_plane,
    on_earth,
    plane,
    wind,
    without,
)
from public_forms import Curved, numbers, places_of

from flowtex._util.array_types import Floats

pyproj = pytest.importorskip("pyproj")

LON, LAT = np.arange(-20.0, 10, 1.5), np.arange(30.0, 55, 1.5)
#: Metres per year of one metre per second.
YEAR = 365.25 * 86400
NORTH_POLE: dict[str, Any] = {
    "grid_mapping_name": "polar_stereographic",
    "straight_vertical_longitude_from_pole": -45.0,
    "latitude_of_projection_origin": 90.0,
    "standard_parallel": 70.0,
    "false_easting": 0.0,
    "false_northing": 0.0,
    "semi_major_axis": 6378273.0,
    "semi_minor_axis": 6356889.5,
}
SOUTH_POLE: dict[str, Any] = {
    **NORTH_POLE,
    "straight_vertical_longitude_from_pole": 0.0,
    "latitude_of_projection_origin": -90.0,
    "standard_parallel": -71.0,
}


def by_names(*parts: tuple[str, Any], dims: Any, **attrs: Any) -> dict[str, Any]:
    """Return variables of the same dimensions and attributes, as for a dataset."""
    return {name: (dims, values, dict(attrs)) for name, values in parts}


class Polar:
    """A grid of a polar stereographic map with falling y, and components along its axes."""

    def __init__(self, mapping: dict[str, Any]) -> None:
        self.mapping = mapping
        crs = pyproj.CRS.from_cf(mapping)
        self.x, self.y = 125e3 * np.arange(-8, 9), 125e3 * np.arange(7, -8, -1)
        to_degrees = pyproj.Transformer.from_crs(crs, crs.geodetic_crs, always_xy=True)
        self.lon, self.lat = to_degrees.transform(*np.meshgrid(self.x + 1e3, self.y))
        east, north = wind(self.lon, self.lat)
        turn = np.radians(self.lon - mapping["straight_vertical_longitude_from_pole"])
        if mapping["latitude_of_projection_origin"] < 0:
            turn = -turn
        self.u = east * np.cos(turn) - north * np.sin(turn)
        self.v = east * np.sin(turn) + north * np.cos(turn)

    def coords(self, names: tuple[str, str], unit: str = "m", per_metre: float = 1.0) -> Any:
        """Return the axes in a unit."""
        lines = ((self.x + 1e3) * per_metre, self.y * per_metre)
        found = {}
        for name, line, axis in zip(names, lines, "xy", strict=True):
            attrs = {"units": unit, "standard_name": f"projection_{axis}_coordinate"}
            found[name] = (name, line, attrs)
        return found

    def truth(self, scale: float = 1.0, **more: Any) -> Truth:
        return on_earth(self.lon, self.lat, scale=scale, tolerance=3e-3, **more)


def drift() -> tuple[xr.Dataset, Truth]:
    """Return OSI SAF's displacements of ice in 48 hours, in km, and their truth."""
    grid = Polar(NORTH_POLE)
    dims = ("time", "yc", "xc")
    km = 172.8
    text = "component of the displacement along the {} axis of the grid"
    ds = xr.Dataset(
        {"Polar_Stereographic_Grid": ((), 0, grid.mapping)},
        {**grid.coords(("xc", "yc"), "km", 1e-3), "time": ("time", dates([0.0]))},
    )
    for name, values, axis in (("dX", grid.u, "x"), ("dY", grid.v, "y")):
        attrs = {"units": "km", "standard_name": f"sea_ice_{axis}_displacement"}
        attrs |= {"long_name": text.format(axis), "grid_mapping": "Polar_Stereographic_Grid"}
        attrs["ancillary_variables"] = "uncert_dX_and_dY status_flag"
        ds[name] = (dims, km * values[None], attrs)
    flags = {"standard_name": "sea_ice_x_displacement status_flag"}
    flags["flag_meanings"] = "missing_input_data over_land no_ice nominal_quality"
    values = np.full(ds.dX.shape, 30, "i1")
    ds["status_flag"] = (dims, values, {**flags, "flag_values": np.array([0, 1, 2, 30], "i1")})
    ds["uncert_dX_and_dY"] = (dims, np.ones(ds.dX.shape), {"units": "km"})
    ds["lat1"] = (dims, grid.lat[None], {**DEGREES["lat"], "long_name": "latitude at end"})
    ds["lon1"] = (dims, grid.lon[None], {**DEGREES["lon"], "long_name": "longitude at end"})
    return ds, grid.truth(km, speed_unit="")


@form(
    error=r"'km', which is not a unit of velocity.*u=\"dX\", v=\"dY\" draws them as they are, in km"
)
def displacements_of_ice() -> Any:
    ds, _ = drift()
    return ds


@form(options={"u": "dX", "v": "dY"})
def displacements_of_ice_that_are_named() -> Any:
    return drift()


@form()
def kilometres_by_the_hundred() -> Any:
    """TOPAZ: the unit of the axes is "100  km"."""
    grid = Polar(NORTH_POLE)
    dims = ("time", "depth", "y", "x")
    ds = xr.Dataset(
        {"stereographic": ((), 0, grid.mapping)},
        {**grid.coords(("x", "y"), "100  km", 1e-5), "depth": ("depth", [0.0], {"units": "m"})},
    )
    for name, values, axis in (("vxo", grid.u, "x"), ("vyo", grid.v, "y")):
        attrs = {"units": "m s-1", "standard_name": f"sea_water_{axis}_velocity"}
        ds[name] = (dims, values[None, None], {**attrs, "grid_mapping": "stereographic"})
    return ds.assign_coords(time=dates([0.0])), grid.truth()


@form()
def velocities_of_ice_beside_their_errors() -> Any:
    """ITS_LIVE: the standard names of errors have that of the velocity."""
    grid = Polar(NORTH_POLE)
    dims = ("y", "x")
    ds = xr.Dataset({"mapping": ((), b"", grid.mapping)}, grid.coords(("x", "y")))
    attrs = {"units": "meter/year", "grid_mapping": "mapping"}
    for axis, values in zip("xy", (grid.u, grid.v), strict=True):
        ds[f"v{axis}"] = (dims, YEAR * values, {**attrs, "standard_name": f"{axis}_velocity"})
        error = {**attrs, "standard_name": f"{axis}_velocity_error"}
        ds[f"v{axis}_error"] = (dims, np.ones(values.shape), error)
        ds[f"dv{axis}_dt"] = (dims, 0 * values, {"units": "meter/year^2"})
    ds["v"] = (dims, YEAR * np.hypot(grid.u, grid.v), attrs)
    return ds, grid.truth()


@form()
def velocities_of_ice_beside_their_deviation() -> Any:
    """MEaSUREs: only long names say that variables are deviations and errors."""
    grid = Polar(SOUTH_POLE)
    dims = ("y", "x")
    ds = xr.Dataset({"coord_system": ((), 0, grid.mapping)}, grid.coords(("x", "y")))
    ds = ds.assign_coords(places_of(dims, ("lon", "lat"), grid.lon, grid.lat))
    unit = {"units": "meter/year"}
    for axis, values in zip("xy", (grid.u, grid.v), strict=True):
        letter = axis.upper()
        attrs = {"standard_name": f"land_ice_{axis}_velocity", "grid_mapping": "coord_system"}
        ds[f"V{letter}"] = (dims, YEAR * values, unit | attrs)
        words = f"{letter} component of velocity"
        ones = np.ones(values.shape)
        ds[f"STD{letter}"] = (dims, ones, {**unit, "long_name": f"Standard deviation {words}"})
        ds[f"ERR{letter}"] = (dims, ones, {**unit, "long_name": f"Error {letter} component"})
    return ds, grid.truth()


def several(pairs: Any) -> xr.Dataset:
    """Return a dataset of pairs: both names, their standard names, a share of the flow."""
    ds = current(earth(LON, LAT))
    found = xr.Dataset(coords=ds.coords)
    for names, standard_names, share in pairs:
        for name, standard, source in zip(names, standard_names, "uv", strict=True):
            found[name] = share * ds[source]
            found[name].attrs = {"units": "m/s", "standard_name": standard}
    return found


def geostrophic(suffix: str) -> tuple[str, str]:
    east, north = (f"surface_geostrophic_{w}_sea_water_velocity" for w in WORDS)
    return east + suffix, north + suffix


WORDS = ("eastward", "northward")


@form(says="other pairs: ugosa,vgosa")
def geostrophic_currents_and_their_anomalies() -> Any:
    """DUACS: the standard name of anomalies has all words of that of the current, and more."""
    pairs = [
        (("ugosa", "vgosa"), geostrophic("_assuming_sea_level_for_geoid"), 0.4),
        (("ugos", "vgos"), geostrophic(""), 1.0),
    ]
    return several(pairs), on_earth(LON, LAT)


@form(says="other pairs: ug,vg")
def total_and_geostrophic_currents() -> Any:
    """OSCAR: lines along dimensions of other names, in the order time, longitude, latitude."""
    standard = [f"{word}_sea_water_velocity" for word in WORDS]
    pairs = [
        (("ug", "vg"), [f"geostrophic_{name}" for name in standard], 0.5),
        (("u", "v"), standard, 1.0),
    ]
    ds = several(pairs).expand_dims(time=dates([0.0])).transpose("time", "lon", "lat")
    ds = ds.rename(lon="longitude", lat="latitude")
    lines = {"longitude": "lon", "latitude": "lat"}
    named = {short: (name, ds[name].values, DEGREES[short]) for name, short in lines.items()}
    return ds.drop_vars(list(lines)).assign(named), on_earth(LON, LAT)


@form(says="other pairs: utide,vtide; utotal,vtotal; vsdx,vsdy")
def currents_tides_and_waves() -> Any:
    """SMOC: four velocities in one file, one of them along x and y."""
    pairs = [
        (("utotal", "vtotal"), [f"surface_sea_water_{a}_velocity" for a in "xy"], 1.0),
        (("uo", "vo"), [f"{word}_sea_water_velocity" for word in WORDS], 0.6),
        (("utide", "vtide"), [f"{word}_tidal_current" for word in WORDS], 0.3),
        (
            ("vsdx", "vsdy"),
            [f"sea_surface_wave_stokes_drift_{a}_velocity" for a in "xy"],
            0.1,
        ),
    ]
    return several(pairs), on_earth(LON, LAT, scale=0.6)


@form(error="U2M, V2M .*; U10M, V10M .*Name one")
def winds_at_several_heights() -> Any:
    """MERRA-2: the height is a part of the standard name."""
    pairs = []
    for height in (2, 10, 50):
        names = [f"{height}-meter_{word}_wind" for word in WORDS]
        pairs.append(((f"U{height}M", f"V{height}M"), names, height / 10))
    return several(pairs)


@form(error="uwnd, vwnd .*; ucur, vcur .*Name one")
def wind_and_current_of_a_wave_model() -> Any:
    """WAVEWATCH III, whose triangles have no attributes."""
    pairs = [
        (("uwnd", "vwnd"), [f"{word}_wind" for word in WORDS], 1.0),
        (("ucur", "vcur"), [f"{word}_sea_water_velocity" for word in WORDS], 0.1),
    ]
    ds = several(pairs)
    return ds.assign(hs=0 * ds.uwnd)


@form()
def speed_and_direction_that_long_names_explain() -> Any:
    """CERRA by cfgrib: the name of the speed is si10, and the standard name is unknown."""
    lon, lat = Curved(5, 45, (0.3, -0.06), (0.1, 0.25)).places(*numbers(14, 17))
    east, north = wind(lon, lat)
    turn = np.degrees(np.arctan2(-east, -north)) % 360
    dims = ("y", "x")
    common = {"standard_name": "unknown", "GRIB_gridType": "lambert"}
    ds = xr.Dataset(
        {
            **by_names(
                ("si10", np.hypot(east, north)),
                dims=dims,
                units="m s**-1",
                long_name="10 metre wind speed",
                **common,
            ),
            **by_names(
                ("wdir10", turn),
                dims=dims,
                units="Degree true",
                long_name="10 metre wind direction",
                **common,
            ),
        },
        places_of(dims, ("longitude", "latitude"), lon, lat),
    )
    return ds, on_earth(lon, lat)


@form(says="GDOP_QC is bad_data")
def radar_with_flags_of_each_test() -> Any:
    """Copernicus: names EWCT and NSCT, deviations beside them, and flags of several tests."""
    hours = (0.0, 1.0)
    ds = current(earth(LON, LAT, hours)).rename(
        u="EWCT", v="NSCT", lon="LONGITUDE", lat="LATITUDE", time="TIME"
    )
    bad = np.zeros(ds.EWCT.shape[1:], dtype=bool)
    bad[:3, :5] = True
    flags = {"flag_meanings": "no_qc_performed good_data bad_data missing_value"}
    values = np.broadcast_to(np.where(bad, 4, 1), ds.EWCT.shape).astype("i1")
    for name in ("QCflag", "GDOP_QC"):
        ds[name] = (ds.EWCT.dims, values, {**flags, "flag_values": np.array([0, 1, 4, 9], "i1")})
    for name, word in (("EWCT", "eastward"), ("NSCT", "northward")):
        ds[name].attrs["ancillary_variables"] = "QCflag, GDOP_QC"
        long_name = f"Standard deviation of surface {word} sea water velocity"
        ds[name.replace("CT", "CS")] = 0 * ds[name] + 0.1
        ds[name.replace("CT", "CS")].attrs = {"units": "m s-1", "long_name": long_name}
    return ds.expand_dims(DEPTH=[0.0]), without(on_earth(LON, LAT, hours), bad)


@form(says="other pairs: ship_velocity_eastward,ship_velocity_northward$|ship_velocity")
def points_of_a_radar_on_a_ship() -> Any:
    """Marine radar: errors whose long names alone say so, and the velocity of the ship."""
    rng = np.random.default_rng(2)
    lon, lat = rng.uniform(-20, 10, 300), rng.uniform(30, 55, 300)
    parts = dict(zip(WORDS, wind(lon, lat), strict=True))
    ds = xr.Dataset()
    for word, values in parts.items():
        name = f"{word}_sea_water_velocity"
        ds[name] = ("measurement", values, {"units": "m s-1", "standard_name": name})
        words = f"standard error of the {word} component of the current velocity"
        attrs = {"units": "m s-1", "long_name": words}
        ds[f"{name}_standard_error"] = ("measurement", 0 * values, attrs)
        ship = {"units": "m s-1", "long_name": f"{word} velocity of ship"}
        ds[f"ship_velocity_{word}"] = ("measurement", 0 * values, ship)
    ds["lon"] = ("measurement", lon, DEGREES["lon"])
    ds["lat"] = ("measurement", lat, DEGREES["lat"])
    return ds, on_earth(lon[None], lat[None])


def gridded_radars() -> tuple[xr.Dataset, Truth]:
    """Return winds of PyDDA, on a grid around a radar whose place may vary with time."""
    x, y = 5e3 * np.arange(-8, 9), 5e3 * np.arange(-6, 7)
    project = pyproj.Proj(proj="aeqd", lat_0=36.5, lon_0=-97.5)
    lon, lat = project(*np.meshgrid(x, y), inverse=True)
    dims = ("time", "z", "y", "x")
    factor = np.array([1.0, 0.5])[None, :, None, None]
    ds = xr.Dataset()
    for name, values, words in zip("uv", wind(lon, lat), ("meridional", "zonal"), strict=True):
        attrs = {"units": "m/s", "standard_name": f"{name}_wind"}
        attrs["long_name"] = f"{words} component of wind velocity"  # exchanged in the source
        ds[name] = (dims, values * factor, attrs)
    for name, places in (("longitude", lon), ("latitude", lat)):
        level = np.broadcast_to(places, (2, *places.shape))
        unit = DEGREES[name[:3]]
        ds[f"point_{name}"] = (dims[1:], level, {**unit, "long_name": f"{name} of each point"})
        ds[f"origin_{name}"] = ("time", places.mean(keepdims=True)[0], unit)
    lines = {"x": ("x", x, {"units": "m"}), "y": ("y", y, {"units": "m"})}
    z = ("z", [500.0, 1500.0], {"units": "m", "positive": "up", "axis": "Z"})
    ds = ds.assign_coords({**lines, "z": z, "time": dates([0.0])})
    return ds, on_earth(lon, lat, tolerance=5e-3)


@form(error=r"v, u \(long name .*; u, v \(standard name .*Name one")
def long_names_that_contradict_the_names() -> Any:
    ds, _ = gridded_radars()
    return ds


@form(options={"u": "u", "v": "v"})
def place_of_a_radar_beside_those_of_points() -> Any:
    return gridded_radars()


@variants(["scale_factor", "missing_value"])
def number_that_is_text(name: str) -> Any:
    """FNOC by OPeNDAP: the scale and the missing value are text."""
    ds = earth(LON, LAT)
    packed: Floats = np.round(ds.to_array().values / 0.0005).astype("i2")
    packed[:, :2, :3] = -32767
    attrs: dict[str, Any] = {"scale_factor": 0.0005, "missing_value": np.int16(-32767)}
    attrs[name] = str(attrs[name])
    for part, values in zip("uv", packed, strict=True):
        ds[part] = (ds[part].dims, values, ds[part].attrs | attrs)
    land = np.zeros(packed.shape[1:], dtype=bool)
    land[:2, :3] = True
    return ds, without(on_earth(LON, LAT), land)


@form(error="missing_value 'none'; expected numbers")
def number_that_is_a_word() -> Any:
    ds = earth(LON, LAT)
    ds.u.attrs["missing_value"] = "none"
    return ds


@form(error="u has the scale_factor '0.001' as text.*mask_and_scale=False")
def number_that_was_text_when_xarray_unpacked() -> Any:
    """As of ``xr.open_dataset``, whose values are no numbers any more."""
    ds = earth(LON, LAT)
    ds.u.encoding["scale_factor"] = "0.001"
    return ds


#: Places along the planes of cuts through a volume, and their flow.
CUT = [np.ravel(a) for a in np.meshgrid(np.linspace(0, 3, 13), np.linspace(0, 2, 9))]


def cut_across(letter: str) -> dict[str, Any]:
    """Return the columns of points of which one position is the same everywhere."""
    u, v = plane(*CUT)
    same = 0 * u + 0.5
    if letter == "x":
        return {"x": same, "y": CUT[0], "z": CUT[1], "u": same, "v": u, "w": v}
    return {"x": CUT[0], "y": same, "z": CUT[1], "u": u, "v": same, "w": v}


def cut_truth(letter: str, points: Any = None) -> Truth:
    axes = {"x": (1, 2), "y": (0, 2)}[letter]
    if points is None:
        points = np.stack(CUT, axis=-1)
    return at_points(points, axes=axes)


@variants(["x", "y"], says="in space")
def table_of_a_plane_across(letter: str) -> Any:
    """OpenFOAM and ParaView: a cut through a volume, whose points have one x or y."""
    return pd.DataFrame(cut_across(letter)), cut_truth(letter)


@variants(["x", "y"], says="in space")
def columns_of_a_plane_across(letter: str) -> Any:
    """Points that are no lattice, as arrays by name, with names of OpenFOAM."""
    columns = cut_across(letter)
    keep = np.random.default_rng(1).permutation(len(CUT[0]))[:100]
    names = dict(zip("uvw", ("U_x", "U_y", "U_z"), strict=True))
    few = {names.get(key, key): values[keep] for key, values in columns.items()}
    return few, cut_truth(letter, np.stack(CUT, axis=-1)[keep])


@form(options={"vectors": "u,w"}, says="in space")
def named_components_of_a_plane_across_y() -> Any:
    """The unit of the positions is that of the columns."""
    table = pd.DataFrame(cut_across("y"))
    changes = {letter: f"{letter} [m]" for letter in "xyz"}
    changes |= {letter: f"{letter} [m/s]" for letter in "uvw"}
    return table.rename(columns=changes), replace(cut_truth("y"), unit="m", speed_unit="m/s")


@form(error=r"all points have lon = 0.5.*df.rename\(columns=")
def table_of_a_plane_along_a_meridian() -> Any:
    table = pd.DataFrame(cut_across("x"))
    return table.rename(columns={"x": "lon", "y": "lat"})


@variants(["y", "x"])
def dataset_of_a_plane_with_z(letter: str) -> Any:
    """The components along the axes, though u and v exist as well, and z is upward."""
    x, z = np.linspace(0, 3, 13), np.linspace(0, 2, 9)
    columns = cut_across("x" if letter == "y" else "y")
    shaped = {key: (("z", letter), columns[key].reshape(9, 13)) for key in "uvw"}
    return xr.Dataset(shaped, {letter: x, "z": z}), in_plane(x, z)


@form(error='open_dataset."refs.json", engine="kerchunk"')
def references_of_kerchunk(folder: Path) -> Any:
    path = folder / "refs.json"
    path.write_text('{"version": 1, "refs": {".zgroup": "{}"}}')
    return path


def beams(dims: tuple[str, str]) -> xr.Dataset:
    """Return a velocity with components E, N, U1 and U2, as DOLfYN has it of four beams."""
    ds = earth(LON, LAT).rename(lat=dims[0], lon=dims[1])
    parts = [ds.u, ds.v, 0 * ds.u, 0 * ds.u]
    attrs = {"units": "m s-1", "standard_name": "sea_water_velocity"}
    whole = np.stack([part.values for part in parts])
    coords = {dim: ds[dim] for dim in dims} | {"dir": ["E", "N", "U1", "U2"]}
    return xr.Dataset({"vel": (("dir", *dims), whole, attrs)}, coords)


@form()
def components_of_four_beams() -> Any:
    return beams(("lat", "lon")), on_earth(LON, LAT)


@form(error="time and one axis of space")
def profiler_over_time() -> Any:
    ds = beams(("range", "time"))
    return ds.assign_coords(range=("range", LAT, {"units": "m"}), time=dates(LON))
