"""Data of the Earth as ocean and weather models write them, computed and not observed.

The height of the sea is read from a file that ``tools/example_data/ocean_run.py`` computes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.extras import import_extra
from flowtex.examples._shipped import OCEAN, load, unpack
from flowtex.field.earth import EARTH_RADIUS

if TYPE_CHECKING:
    import xarray as xr

EAST, NORTH = {"units": "degrees_east"}, {"units": "degrees_north"}
LONGITUDE = {"standard_name": "longitude", "long_name": "longitude", "axis": "X", **EAST}
LATITUDE = {"standard_name": "latitude", "long_name": "latitude", "axis": "Y", **NORTH}
SOURCE = "computed by flowtex.examples from formulas; neither observed nor forecast"

#: Earth's turning in radians a second, gravity in m/s², metres of a degree.
TURNING, GRAVITY, DEGREE = 7.2921e-5, 9.81, np.radians(EARTH_RADIUS)

#: Levels of the air in hPa, and for each the speed of the jets, of the trade winds and the waves.
LEVELS = {850.0: (9.0, 7.0, 0.55), 500.0: (22.0, 2.5, 0.85), 250.0: (40.0, -3.0, 1.0)}
#: Planetary waves: how many around the Earth, sine of the latitude, its width, m/s and phase.
WAVES = (
    *((1, 0.80, 0.45, 6.0, 0.6), (2, 0.76, 0.40, 8.0, 2.1), (3, 0.72, 0.30, 9.0, 4.0)),
    *((5, 0.66, 0.22, 11.0, 1.2), (7, 0.62, 0.20, 7.0, 5.0), (1, -0.80, 0.45, 4.0, 3.0)),
    *((4, -0.74, 0.24, 10.0, 0.3), (6, -0.68, 0.20, 7.0, 2.7)),
)
#: Lows and highs: longitude, latitude, radius in degrees, m/s around it, anticlockwise.
VORTICES = (
    *((-32, 58, 11, 17), (175, 52, 12, 18), (95, 64, 10, 9), (-82, 47, 8, 11), (18, 45, 7, 8)),
    *((-38, 33, 17, -11), (-145, 36, 18, -11), (60, -31, 16, 10), (-100, -29, 18, 10)),
    *((-12, -29, 15, 9), (20, -57, 10, -17), (110, -60, 11, -18), (-155, -58, 11, -17)),
    *((-60, -56, 9, -14), (140, 17, 6, 15), (-62, 21, 5, 10), (75, -14, 6, -11)),
)


def ocean() -> xr.Dataset:
    """Return eight days of synthetic currents in the Northwest Atlantic.

    A meandering Gulf Stream leaves the coast at Cape Hatteras; rings and smaller eddies move west,
    like Rossby waves, by about 4 km a day.

    Returns
    -------
    xarray.Dataset
        ``uo`` and ``vo`` in m/s, eastward and northward, and ``zos``, the sea surface height in m,
        with which they are in geostrophic balance; (time, latitude, longitude) = (8, 109, 217), NaN
        on land.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.
    FileNotFoundError
        When the data file of the example is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.ocean(), cmap="viridis")  # doctest: +SKIP
    """
    xarray = import_extra("xarray", "xarray")
    file = load(OCEAN)
    lon, lat, land = file["longitude"], file["latitude"], file["land"]
    height = unpack(file["height"], float(file["step"]), axis=(0, 1, 2))
    coriolis = 2 * TURNING * np.sin(np.radians(lat))[:, None]
    north, east = np.gradient(height, lat * DEGREE, lon * DEGREE, axis=(1, 2))
    east /= np.cos(np.radians(lat))[:, None]
    data = {
        "uo": (-GRAVITY / coriolis * north, "eastward_sea_water_velocity", "m s-1"),
        "vo": (GRAVITY / coriolis * east, "northward_sea_water_velocity", "m s-1"),
        "zos": (height, "sea_surface_height_above_geoid", "m"),
    }
    times = np.datetime64("2024-03-01", "ns") + np.arange(len(height)) * np.timedelta64(1, "D")
    return _dataset(
        xarray,
        {name: (np.where(land, np.nan, values), *names) for name, (values, *names) in data.items()},
        {
            "time": ("time", times, {"standard_name": "time", "axis": "T"}),
            "latitude": ("latitude", lat, LATITUDE),
            "longitude": ("longitude", lon, LONGITUDE),
        },
        "Currents of the Northwest Atlantic, an example",
    )


def weather() -> xr.Dataset:
    """Return synthetic global winds at three levels: jets, planetary waves, lows and highs.

    Returns
    -------
    xarray.Dataset
        ``u`` and ``v`` in m/s, eastward and northward, (level, latitude, longitude) =
        (3, 91, 180), at 850, 500 and 250 hPa. They are free of divergence, and smooth across the
        date line and the poles.

    Raises
    ------
    ModuleNotFoundError
        When xarray is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.weather(), level=250, globe=True)  # doctest: +SKIP
    """
    xarray = import_extra("xarray", "xarray")
    lon, lat = np.arange(0.0, 360.0, 2.0), np.linspace(90.0, -90.0, 91)
    winds = np.stack([_winds(lon, lat, *strengths) for strengths in LEVELS.values()], axis=1)
    level = {"standard_name": "air_pressure", "units": "hPa", "positive": "down", "axis": "Z"}
    return _dataset(
        xarray,
        {"u": (winds[0], "eastward_wind", "m s-1"), "v": (winds[1], "northward_wind", "m s-1")},
        {
            "time": ((), np.datetime64("2024-01-15T12", "ns"), {"standard_name": "time"}),
            "level": ("level", np.array(list(LEVELS)), {"long_name": "pressure level", **level}),
            "latitude": ("latitude", lat, LATITUDE),
            "longitude": ("longitude", lon, LONGITUDE),
        },
        "Winds of the Earth, an example",
    )


def _dataset(
    xarray: Any, data: dict[str, Any], coordinates: dict[str, Any], title: str
) -> xr.Dataset:
    """Put arrays, each with standard name and unit, on coordinates."""
    dims = [name for name, (axes, *_) in coordinates.items() if axes]
    variables = {
        key: (
            dims,
            values,
            {"standard_name": word, "long_name": word.replace("_", " "), "units": unit},
        )
        for key, (values, word, unit) in data.items()
    }
    attributes = {"Conventions": "CF-1.8", "title": title, "source": SOURCE}
    dataset: xr.Dataset = xarray.Dataset(variables, coordinates, attributes)
    return dataset


def _winds(lon: Floats, lat: Floats, jet: float, trade: float, waves: float) -> Floats:
    """Return the components eastward and northward, (2, J, I), of a level.

    All are derivatives of stream functions that are smooth on the sphere.
    """
    a, b = np.radians(np.meshgrid(lon, lat))
    s, c = np.sin(b), np.maximum(np.cos(b), 0.0)
    # Westerlies on both sides, and trade winds between them.
    east = jet * (np.exp(-(((s - 0.62) / 0.2) ** 2)) + 1.1 * np.exp(-(((s + 0.68) / 0.2) ** 2)))
    east = c * (1.25 * east - trade * np.exp(-((s / 0.3) ** 2)))
    north = np.zeros_like(east)
    for count, middle, width, speed, phase in WAVES:
        # Its stream function is size * shape * cos(b)^count * sin(angle).
        size = waves * speed / (count * np.sqrt(1 - middle**2) ** (count - 1))
        shape = np.exp(-(((s - middle) / width) ** 2))
        slope = -2 * (s - middle) / width**2 * shape
        tilt = -2.0 * np.sign(middle)
        angle = count * a + tilt * s - phase
        edge = c ** (count - 1)
        east -= size * edge * (c**2 * slope - count * shape * s) * np.sin(angle)
        east -= size * edge * c**2 * shape * tilt * np.cos(angle)
        north += size * edge * count * shape * np.cos(angle)
    for x, y, radius, speed in VORTICES:
        turn, up, wide = a - np.radians(x), np.radians(y), np.radians(radius)
        nearness = s * np.sin(up) + c * np.cos(up) * np.cos(turn)
        # Fastest at the radius, from where it falls off.
        around = speed / wide * np.exp(0.5 - (1 - nearness) / wide**2)
        east += around * (c * np.sin(up) - s * np.cos(up) * np.cos(turn))
        north += around * np.cos(up) * np.sin(turn)
    return np.stack([east, north])
