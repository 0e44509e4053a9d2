"""The winds of the example ``weather``: jets, planetary waves, lows and highs."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from packing import LATITUDE, LONGITUDE, save_dataset

from flowtex._util.array_types import Floats
from flowtex.examples._shipped import DATA, WEATHER

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


def run() -> tuple[Floats, Floats, Floats]:
    """Compute longitudes, latitudes, and the components at all levels, (2, L, J, I)."""
    lon, lat = np.arange(0.0, 360.0, 2.0), np.linspace(90.0, -90.0, 91)
    winds = [_winds(lon, lat, *strengths) for strengths in LEVELS.values()]
    return lon, lat, np.stack(winds, axis=1)


def write(folder: Path | None = None) -> None:
    """Compute and write the file."""
    lon, lat, winds = run()
    dims = ("level", "latitude", "longitude")
    level = {"standard_name": "air_pressure", "units": "hPa", "positive": "down", "axis": "Z"}
    data = {
        "u": (dims, winds[0], "eastward_wind", "m s-1"),
        "v": (dims, winds[1], "northward_wind", "m s-1"),
    }
    coordinates = {
        "time": ((), np.datetime64("2024-01-15T12", "ns"), {"standard_name": "time"}),
        "level": ("level", list(LEVELS), {"long_name": "pressure level", **level}),
        "latitude": ("latitude", lat, LATITUDE),
        "longitude": ("longitude", lon, LONGITUDE),
    }
    save_dataset((folder or DATA) / WEATHER, data, coordinates, "Winds of the Earth, an example")


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
