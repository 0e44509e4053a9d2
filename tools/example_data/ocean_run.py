"""The sea of the example ``ocean``: a meandering stream, its rings, and smaller eddies."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy
from packing import LATITUDE, LONGITUDE, save_dataset

from flowtex._util.array_types import Bools, Floats
from flowtex.examples._shipped import DATA, TURNING
from flowtex.examples._shipped import OCEAN as FILE
from flowtex.field.earth.map_lines import coastlines
from flowtex.field.earth.projection import DEGREE, EARTH_RADIUS, Projection

#: Seconds of a day.
DAY = 86400.0
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


def run() -> tuple[Floats, Floats, Bools, Floats]:
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


def write(folder: Path | None = None) -> None:
    """Compute and write the file."""
    lon, lat, land, height = run()
    dims = ("time", "latitude", "longitude")
    times = np.datetime64("2024-03-01", "ns") + np.arange(DAYS) * np.timedelta64(1, "D")
    data = {
        # The package computes the currents from the height.
        "uo": ((), np.int8(0), "eastward_sea_water_velocity", "m s-1"),
        "vo": ((), np.int8(0), "northward_sea_water_velocity", "m s-1"),
        "zos": (dims, height, "sea_surface_height_above_geoid", "m"),
        "land": (dims[1:], land.astype(np.int8), "land_binary_mask", "1"),
    }
    coordinates = {
        "time": ("time", times, {"standard_name": "time", "axis": "T"}),
        "latitude": ("latitude", lat, LATITUDE),
        "longitude": ("longitude", lon, LONGITUDE),
    }
    title = "Currents of the Northwest Atlantic, an example"
    save_dataset((folder or DATA) / FILE, data, coordinates, title)
