"""Data of the Earth as ocean and weather models write them, computed and not observed.

The height of the sea and the winds are read from files that ``tools/example_data`` computes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.extras import import_extra
from flowtex.examples._shipped import OCEAN, WEATHER, load, unpack
from flowtex.field.earth import EARTH_RADIUS

if TYPE_CHECKING:
    import xarray as xr

EAST, NORTH = {"units": "degrees_east"}, {"units": "degrees_north"}
LONGITUDE = {"standard_name": "longitude", "long_name": "longitude", "axis": "X", **EAST}
LATITUDE = {"standard_name": "latitude", "long_name": "latitude", "axis": "Y", **NORTH}
SOURCE = "computed by flowtex.examples from formulas; neither observed nor forecast"

#: Earth's turning in radians a second, gravity in m/s², metres of a degree.
TURNING, GRAVITY, DEGREE = 7.2921e-5, 9.81, np.radians(EARTH_RADIUS)


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
    FileNotFoundError
        When the data file of the example is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.weather(), level=250, globe=True)  # doctest: +SKIP
    """
    xarray = import_extra("xarray", "xarray")
    file = load(WEATHER)
    winds = unpack(file["winds"], float(file["step"]), axis=(2, 3))
    level = {"standard_name": "air_pressure", "units": "hPa", "positive": "down", "axis": "Z"}
    return _dataset(
        xarray,
        {"u": (winds[0], "eastward_wind", "m s-1"), "v": (winds[1], "northward_wind", "m s-1")},
        {
            "time": ((), np.datetime64("2024-01-15T12", "ns"), {"standard_name": "time"}),
            "level": ("level", file["level"], {"long_name": "pressure level", **level}),
            "latitude": ("latitude", file["latitude"], LATITUDE),
            "longitude": ("longitude", file["longitude"], LONGITUDE),
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
