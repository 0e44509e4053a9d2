"""Forms of public data about which people have asked elsewhere."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from form_table import form
from known_flow import DEGREES, Truth, dates, earth, on_earth, wind, without

from flowtex._util.array_types import Floats

LON, LAT = np.arange(0.0, 40, 2), np.arange(20.0, 50, 2)


class Curved:
    """A curved grid of oblique rows and columns, steps of which are given in degrees."""

    def __init__(
        self, lon: float, lat: float, along_i: tuple[float, float], along_j: tuple[float, float]
    ) -> None:
        self.first, self.steps = (lon, lat), (along_i, along_j)

    def places(self, i: Any, j: Any) -> tuple[Floats, Floats]:
        (a, b), (c, d) = self.steps
        return self.first[0] + a * i + c * j, self.first[1] + b * i + d * j

    def components(self, i: Any, j: Any) -> tuple[Floats, Floats]:
        """Return the components along rows and columns."""
        lon, lat = self.places(i, j)
        east, north = wind(lon, lat)
        narrow = np.cos(np.radians(lat))
        (a, b), (c, d) = (np.stack([x * narrow, y + 0 * narrow]) for x, y in self.steps)
        one, other = np.hypot(a, b), np.hypot(c, d)
        area = a * d - b * c
        return one * (east * d - north * c) / area, other * (north * a - east * b) / area


def numbers(rows: int, columns: int) -> tuple[Floats, Floats]:
    j, i = np.mgrid[0:rows, 0:columns].astype(float)
    return i, j


def places_of(
    dims: tuple[str, str], names: tuple[str, str], lon: Floats, lat: Floats
) -> dict[str, Any]:
    return {
        names[0]: (dims, lon, {**DEGREES["lon"], "standard_name": "longitude"}),
        names[1]: (dims, lat, {**DEGREES["lat"], "standard_name": "latitude"}),
    }


@form()
def longitudes_beyond_two_turns() -> Any:
    """RTOFS and HYCOM: longitudes from 74 to 1019 on a tripolar grid, and rows counted from 1."""
    lon, lat = Curved(774.12, -20, (0.5, -0.03), (0.05, 0.5)).places(*numbers(30, 40))
    u, v = wind(lon, lat)
    dims = ("MT", "Y", "X")
    attrs = {"units": "m/s", "standard_name": "eastward_sea_water_velocity"}
    ds = xr.Dataset(
        {
            "u_velocity": (dims, u[None], attrs),
            "v_velocity": (
                dims,
                v[None],
                {**attrs, "standard_name": "northward_sea_water_velocity"},
            ),
        },
        {
            **places_of(("Y", "X"), ("Longitude", "Latitude"), lon, lat),
            "MT": ("MT", dates([0.0]), {"axis": "T"}),
            "X": ("X", np.arange(1, 41), {"axis": "X"}),
            "Y": ("Y", np.arange(1, 31), {"axis": "Y"}),
            "Layer": 1.0,
        },
    )
    return ds, on_earth(lon, lat)


@form(name="as_a_dataset", arguments=(True,))
@form(name="as_an_array", arguments=(False,))
def both_components_of_wrf_python(whole: bool) -> Any:
    """``getvar(file, "uvmet10")``: an axis of components, which a description calls rotated."""
    lon, lat = Curved(5, 45, (0.3, -0.06), (0.1, 0.25)).places(*numbers(16, 18))
    dims = ("south_north", "west_east")
    array = xr.DataArray(
        np.stack(wind(lon, lat)),
        {"u_v": ["u", "v"], **places_of(dims, ("XLONG", "XLAT"), lon, lat)},
        ("u_v", *dims),
        name="uvmet10",
        attrs={"units": "m s-1", "description": "10m earth rotated u,v", "MemoryOrder": "XY"},
    )
    if whole:
        return array.to_dataset(), on_earth(lon, lat)
    return array, on_earth(lon, lat)


def swath() -> tuple[xr.Dataset, Truth]:
    """Winds of ASCAT and of a model, as speeds and directions of one standard name."""
    lon, lat = Curved(-3, 30, (0.25, 0.06), (-0.05, 0.22)).places(*numbers(30, 21))
    east, north = wind(lon, lat)
    speed, turn = np.hypot(east, north), np.degrees(np.arctan2(east, north)) % 360
    speed[5:8, 3:6] = turn[5:8, 3:6] = np.nan
    dims = ("NUMROWS", "NUMCELLS")
    of_speed = {"units": "m s-1", "standard_name": "wind_speed"}
    of_turn = {"units": "degree", "standard_name": "wind_to_direction"}
    ds = xr.Dataset(
        {
            "wind_speed": (dims, speed, of_speed),
            "wind_dir": (dims, turn, of_turn),
            "model_speed": (dims, speed / 2, of_speed),
            "model_dir": (dims, turn, of_turn),
        },
        places_of(dims, ("lon", "lat"), lon % 360, lat),
    )
    return ds, without(on_earth(lon, lat), np.isnan(speed))


@form(error=r"velocity: wind_speed, wind_dir \([^;]*; model_speed, model_dir \([^;]*\)\. Name one")
def speeds_of_a_swath_and_of_a_model() -> Any:
    """Each speed has its own direction, by the names."""
    ds, _ = swath()
    return ds


@form(options={"u": "wind_speed", "v": "wind_dir"})
def swath_of_which_a_pair_is_named() -> Any:
    return swath()


@form()
def swath_alone() -> Any:
    ds, truth = swath()
    return ds.drop_vars(["model_speed", "model_dir"]), truth


@form()
def regcm() -> Any:
    """Winds along the grid, whose long names say zonal, on sigma levels."""
    grid = Curved(60, 5, (0.5, -0.06), (0.1, 0.5))
    i, j = numbers(16, 18)
    lon, lat = grid.places(i, j)
    u, v = grid.components(i, j)
    dims = ("time", "kz", "iy", "jx")
    factor = np.array([0.5, 1.0])[None, :, None, None]
    attrs = {"units": "m s-1", "standard_name": "grid_eastward_wind"}
    words = "component of wind (Grid Relative)"
    north = {**attrs, "standard_name": "grid_northward_wind"}
    ds = xr.Dataset(
        {
            "ua": (dims, u * factor, {**attrs, "long_name": f"Zonal {words}"}),
            "va": (dims, v * factor, {**north, "long_name": f"Meridional {words}"}),
        },
        {
            **places_of(("iy", "jx"), ("xlon", "xlat"), lon, lat),
            "time": dates([0.0]),
            "kz": (
                "kz",
                [0.05, 0.995],
                {"standard_name": "atmosphere_sigma_coordinate", "positive": "down", "axis": "Z"},
            ),
            "jx": ("jx", 50e3 * np.arange(18), {"units": "m"}),
            "iy": ("iy", 50e3 * np.arange(16), {"units": "m"}),
        },
    )
    return ds, on_earth(lon, lat, tolerance=3e-3)


@form()
def mars_of_ifremer() -> Any:
    """Sides of cells with positions of their own, and sigma levels from the bottom."""
    grid = Curved(-5, 45, (0.1, -0.015), (0.02, 0.08))
    i, j = numbers(14, 17)
    coords: dict[str, Any] = {"time": dates([0.0])}
    for end, (right, up) in {"": (0, 0), "_u": (0.5, 0), "_v": (0, 0.5)}.items():
        dims = (f"nj{end}", f"ni{end}")
        names = (f"longitude{end}", f"latitude{end}")
        coords |= places_of(dims, names, *grid.places(i + right, j + up))
    coords["level"] = ("level", [-0.95, -0.05], {"standard_name": "ocean_sigma_coordinate"})
    factor = np.array([0.5, 1.0])[None, :, None, None]
    u, v = grid.components(i + 0.5, j)[0], grid.components(i, j + 0.5)[1]
    ds = xr.Dataset(
        {
            "UZ": (
                ("time", "level", "nj_u", "ni_u"),
                u * factor,
                {"units": "m.s-1", "standard_name": "sea_water_x_velocity_at_u_location"},
            ),
            "VZ": (
                ("time", "level", "nj_v", "ni_v"),
                v * factor,
                {"units": "m.s-1", "standard_name": "sea_water_y_velocity_at_v_location"},
            ),
        },
        coords,
    )
    core = np.ones(i.shape, dtype=bool)
    core[0] = core[:, 0] = False
    return ds, on_earth(*grid.places(i, j), core=core, tolerance=3e-3)


@form()
def mom5_in_two_files() -> Any:
    """Longitudes from -280, a calendar without leap days, and names of the axes of MOM."""
    hours = (0.0, 6.0)
    lon, lat = np.arange(-280.0, -250), np.arange(-20.0, 5)
    a, b = np.meshgrid(lon, lat)
    u, v = np.stack([np.stack(wind(a, b, hour)) for hour in hours], axis=1)
    coords = {
        "xu_ocean": ("xu_ocean", lon, {"units": "degrees_E", "cartesian_axis": "X"}),
        "yu_ocean": ("yu_ocean", lat, {"units": "degrees_N", "cartesian_axis": "Y"}),
        "st_ocean": ("st_ocean", [0.54, 1.68], {"units": "meters", "positive": "down"}),
        "time": (
            "time",
            np.array(hours) / 24,
            {"units": "days since 2024-01-01", "calendar": "NOLEAP"},
        ),
    }
    dims = ("time", "st_ocean", "yu_ocean", "xu_ocean")
    factor = np.array([1.0, 0.5])[None, :, None, None]
    files = []
    for name, values, words in (("u", u, "i-current"), ("v", v, "j-current")):
        attrs = {"units": "m/sec", "long_name": words, "valid_range": np.array([-100, 100], "f4")}
        files.append(xr.Dataset({name: (dims, values[:, None] * factor, attrs)}, coords))
    return files, on_earth(lon, lat, hours)


@form(says="units by names: ugrd10m m/s")
def nomads_by_opendap() -> Any:
    """Names and long names of GrADS, with the unit in brackets and a space behind it."""
    ds = earth(LON, LAT, (0.0,)).rename(u="ugrd10m", v="vgrd10m")
    for name in ds.data_vars:
        words = f"** 10 m above ground {str(name)[0]}-component of wind [m/s] "
        ds[name].attrs = {"long_name": words}
    return ds, on_earth(LON, LAT)


@form()
def thredds_of_unidata() -> Any:
    """Names of GRIB with hyphens, and axes that are numbered."""
    ds = earth(LON, LAT[::-1], (0.0, 3.0))
    names = {w: f"{w}-component_of_wind_isobaric" for w in "uv"}
    both = xr.concat([ds / 2, ds], "isobaric1")
    for name in "uv":
        both[name].attrs = {
            "units": "m/s",
            "long_name": f"{name}-component of wind @ Isobaric surface",
            "grid_mapping": "LatLon_Projection",
        }
    both = both.rename(names).rename(time="time3")
    both = both.assign_coords(reftime=dates([0.0])[0])
    both["isobaric1"] = ("isobaric1", [50_000.0, 100_000.0], {"units": "Pa", "positive": "down"})
    both["LatLon_Projection"] = (), 0, {"grid_mapping_name": "latitude_longitude"}
    return both, on_earth(LON, LAT, (0.0, 3.0))


@form()
def sentinel_1() -> Any:
    """Names of SAR winds in one word, and a direction that a long name explains."""
    lon, lat = Curved(-3, 50, (0.01, 0.002), (-0.002, 0.009)).places(*numbers(24, 26))
    east, north = wind(lon, lat)
    dims = ("owiAzSize", "owiRaSize")
    words = "SAR Wind direction (meteorological convention=clockwise direction from where the wind"
    ds = xr.Dataset(
        {
            "owiLon": (dims, lon, DEGREES["lon"]),
            "owiLat": (dims, lat, DEGREES["lat"]),
            "owiWindSpeed": (dims, np.hypot(east, north), {"units": "m/s"}),
            "owiWindDirection": (
                dims,
                np.degrees(np.arctan2(-east, -north)) % 360,
                {"units": "degrees", "long_name": f"{words} comes respect to North)"},
            ),
            "owiHeading": (dims, 0 * lon + 190, {"units": "degrees"}),
        }
    )
    return ds, on_earth(lon, lat)


@form()
def winds_of_goes() -> Any:
    """Points of a satellite's images, of which each has its own pressure."""
    rng = np.random.default_rng(1)
    lon, lat = rng.uniform(-100, -60, 600), rng.uniform(10, 40, 600)
    east, north = wind(lon, lat)
    dim = ("nMeasures",)
    ds = xr.Dataset(
        {
            "lon": (dim, lon, {**DEGREES["lon"], "standard_name": "longitude"}),
            "lat": (dim, lat, {**DEGREES["lat"], "standard_name": "latitude"}),
            "wind_speed": (
                dim,
                np.hypot(east, north),
                {"units": "m s-1", "standard_name": "wind_speed"},
            ),
            "wind_direction": (
                dim,
                np.degrees(np.arctan2(-east, -north)) % 360,
                {"units": "degree", "standard_name": "wind_from_direction"},
            ),
            "pressure": (dim, rng.uniform(200, 900, 600), {"units": "hPa"}),
        }
    )
    return ds, on_earth(lon[None], lat[None])
