"""Data of the Earth as ocean and weather models write them, computed here and not observed."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats
from flowtex._util.extras import import_extra
from flowtex.field.earth import EARTH_RADIUS, Projection, coastlines

if TYPE_CHECKING:
    import xarray as xr

EAST, NORTH = {"units": "degrees_east"}, {"units": "degrees_north"}
LONGITUDE = {"standard_name": "longitude", "long_name": "longitude", "axis": "X", **EAST}
LATITUDE = {"standard_name": "latitude", "long_name": "latitude", "axis": "Y", **NORTH}
SOURCE = "computed by flowtex.examples from formulas; neither observed nor forecast"

#: Earth's turning in radians a second, gravity in m/s², seconds of a day, metres of a degree.
TURNING, GRAVITY, DAY, DEGREE = 7.2921e-5, 9.81, 86400.0, np.radians(EARTH_RADIUS)

#: Days of the ocean, and its nodes, (first, last, count) in degrees.
DAYS = 8
OCEAN = {"longitude": (-82.0, -46.0, 217), "latitude": (28.0, 46.0, 109)}
#: Middle of the Gulf Stream before it meanders, longitude and latitude.
STREAM = (
    *((-79.6, 24.0), (-79.4, 29.0), (-77.6, 32.4), (-74.2, 35.6), (-70.0, 37.6)),
    *((-64.0, 38.9), (-58.0, 39.8), (-52.0, 40.6), (-46.0, 42.0), (-38.0, 44.0)),
)
#: Half the difference of the sea's height across it, and half its width, in metres.
HEIGHT, WIDTH = 0.48, 48e3
#: Length over which eddies and the stream end before the coast, in metres.
SHELF = 45e3
#: Meanders: length, most size and speed along the stream, in m and m/s.
MEANDERS = ((420e3, 75e3, 0.10), (260e3, 30e3, 0.14))
#: Rings that the stream has shed: longitude, latitude, height and radius in m.
RINGS = (
    *((-70.6, 39.6, 0.34, 62e3), (-64.2, 41.3, 0.38, 70e3), (-57.0, 42.0, 0.33, 66e3)),
    *((-73.2, 33.6, -0.42, 70e3), (-67.0, 35.2, -0.46, 78e3), (-60.6, 36.2, -0.45, 74e3)),
    *((-54.2, 37.2, -0.40, 76e3), (-49.4, 38.2, 0.25, 80e3), (-75.8, 30.0, 0.26, 84e3)),
)
#: Smaller eddies, and the radius whose square times beta is the speed at which they go west.
EDDIES, ROSSBY_RADIUS = 120, 52e3

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
        When xarray or pyproj is missing.

    Examples
    --------
    >>> flowtex.render(flowtex.examples.ocean(), cmap="viridis")  # doctest: +SKIP
    """
    xarray = import_extra("xarray", "xarray")
    lon, lat, land, height = _sea()
    coriolis = 2 * TURNING * np.sin(np.radians(lat))[:, None]
    north, east = np.gradient(height, lat * DEGREE, lon * DEGREE, axis=(1, 2))
    east /= np.cos(np.radians(lat))[:, None]
    data = {
        "uo": (-GRAVITY / coriolis * north, "eastward_sea_water_velocity", "m s-1"),
        "vo": (GRAVITY / coriolis * east, "northward_sea_water_velocity", "m s-1"),
        "zos": (height, "sea_surface_height_above_geoid", "m"),
    }
    times = np.datetime64("2024-03-01", "ns") + np.arange(DAYS) * np.timedelta64(1, "D")
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
        {
            "u": (winds[0], "eastward_wind", "m s-1"),
            "v": (winds[1], "northward_wind", "m s-1"),
        },
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
            {
                "standard_name": word,
                "long_name": word.replace("_", " "),
                "units": unit,
            },
        )
        for key, (values, word, unit) in data.items()
    }
    attributes = {"Conventions": "CF-1.8", "title": title, "source": SOURCE}
    dataset: xr.Dataset = xarray.Dataset(variables, coordinates, attributes)
    return dataset


@cache
def _sea() -> tuple[Floats, Floats, Bools, Floats]:
    """Return longitudes, latitudes, which nodes are land, and heights of the sea, (T, J, I)."""
    lon, lat = (np.linspace(*line) for line in OCEAN.values())
    places = np.stack(np.meshgrid(lon, lat), axis=-1)
    land = _land(lon, lat)
    cell = np.array([lat[1] - lat[0], (lon[1] - lon[0]) * np.cos(np.radians(lat.mean()))])
    distances = scipy.ndimage.distance_transform_edt(~land, sampling=cell * DEGREE)
    sea = 1 - np.exp(-((distances / SHELF) ** 2))
    # The sea is as high along all of the coast, so no current goes through it.
    heights = [(_height(places, day * DAY) + HEIGHT) * sea - HEIGHT for day in range(DAYS)]
    return lon, lat, land, np.stack(heights)


def _land(lon: Floats, lat: Floats) -> Bools:
    """Return which nodes of rows and columns are land: a parallel crosses coasts into it."""
    lines = coastlines(Projection("platecarree"))
    x, y = Projection("platecarree").lonlat(lines.points)
    first = np.delete(np.arange(len(x)), lines.starts[1:] - 1)
    land = []
    for parallel in lat:
        edges = first[(y[first] > parallel) != (y[first + 1] > parallel)]
        shares = (parallel - y[edges]) / (y[edges + 1] - y[edges])
        crossings = np.sort(x[edges] + shares * (x[edges + 1] - x[edges]))
        land.append(np.searchsorted(crossings, lon) % 2 == 1)
    return np.array(land)


def _height(places: Floats, seconds: float) -> Floats:
    """Return the height of the sea in metres at a grid of longitudes and latitudes, (J, I, 2)."""
    narrow = np.cos(np.radians(38.0))
    positions = places * [narrow, 1.0] * DEGREE
    path, along = _stream(seconds, narrow)
    near = scipy.spatial.cKDTree(path).query(positions)[1]
    offsets = positions - path[near]
    # Metres to the left of the stream.
    left = along[near, 0] * offsets[..., 1] - along[near, 1] * offsets[..., 0]
    height = -HEIGHT * np.tanh(left / WIDTH)
    random = np.random.default_rng(7)
    low, high, _ = np.array(list(OCEAN.values())).T
    middles = random.uniform(low - 2.0, high + 2.0, (EDDIES, 2))
    sizes = random.uniform(0.04, 0.14, EDDIES) * random.choice([-1, 1], EDDIES)
    small = np.column_stack([middles, sizes, random.uniform(45e3, 85e3, EDDIES)])
    eddies = np.concatenate([np.array(RINGS), small])
    lon, lat, sizes, radii = eddies.T
    beta = 2 * TURNING / EARTH_RADIUS * np.cos(np.radians(lat))
    west = beta * ROSSBY_RADIUS**2 * seconds
    # Those of a high sea go a little towards the equator, and those of a low one away from it.
    x, y = lon * narrow * DEGREE - west, lat * DEGREE - np.sign(sizes) * west / 6
    # A Gaussian is the product of one along each axis.
    across = np.exp(-(((positions[0, :, 0] - x[:, None]) / radii[:, None]) ** 2) / 2)
    along = np.exp(-(((positions[:, 0, 1] - y[:, None]) / radii[:, None]) ** 2) / 2)
    return np.asarray(height + (sizes[:, None] * along).T @ across)


def _stream(seconds: float, narrow: float) -> tuple[Floats, Floats]:
    """Return points along the middle of the stream and its directions, (N, 2) each, in metres."""
    corners = np.array(STREAM) * [narrow, 1.0] * DEGREE
    lengths = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1)))
    line = scipy.interpolate.CubicSpline(lengths, corners)
    s = np.arange(0.0, lengths[-1], 2e3)
    along = line(s, 1) / np.linalg.norm(line(s, 1), axis=1, keepdims=True)
    # They begin where the stream leaves the coast, and grow.
    grown = np.clip((s - lengths[3]) / 900e3, 0.0, 1.0)
    grown = grown**2 * (3 - 2 * grown)
    aside = sum(
        size * grown * np.sin(2 * np.pi * (s - speed * seconds) / length)
        for length, size, speed in MEANDERS
    )
    path = line(s) + aside[:, None] * np.stack([-along[:, 1], along[:, 0]], axis=-1)
    along = np.gradient(path, axis=0)
    return path, along / np.linalg.norm(along, axis=1, keepdims=True)


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
