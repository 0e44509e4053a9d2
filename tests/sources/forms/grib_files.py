"""GRIB on maps of weather models, whose flags say that components are along the grid."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from known_flow import EPOCH, Truth, on_earth, wind
from supported import Made, supported

from flowtex._util.array_types import Floats

#: Definition, keys of GRIB, and the first node of maps.
MAPS: dict[str, tuple[str, dict[str, Any], tuple[float, float]]] = {
    "lambert": (
        "+proj=lcc +lat_1=38.5 +lat_2=38.5 +lat_0=38.5 +lon_0=262.5",
        {"LaDInDegrees": 38.5, "LoVInDegrees": 262.5}
        | dict.fromkeys(("Latin1InDegrees", "Latin2InDegrees"), 38.5),
        (237.28, 21.138),
    ),
    "polar_stereographic": (
        "+proj=stere +lat_0=90 +lat_ts=60 +lon_0=225",
        {"LaDInDegrees": 60.0, "orientationOfTheGridInDegrees": 225.0},
        (181.42, 40.53),
    ),
}
#: Columns, rows and the distance of nodes in metres.
NX, NY, STEP = 20, 16, 90e3
ALONG_GRID = 8  #: The bit of the flags.


def on_map(kind: str) -> tuple[Floats, Floats, Floats, Floats]:
    """Return longitude, latitude, and components along the rows and columns of a map."""
    import pyproj

    project = pyproj.Proj(f"{MAPS[kind][0]} +R=6371229")
    x, y = project(*MAPS[kind][2])
    across, up = np.meshgrid(x + STEP * np.arange(NX), y + STEP * np.arange(NY))
    lon, lat = project(across, up, inverse=True)
    ahead = project(across + 1e3, up, inverse=True)
    turn = (ahead[0] - lon + 180) % 360 - 180
    step = np.stack([turn * np.cos(np.radians(lat)), ahead[1] - lat])
    cos, sin = step / np.hypot(*step)
    east, north = wind(lon, lat)
    return lon, lat, east * cos + north * sin, north * cos - east * sin


def write(path: Path, kind: str, flags: int) -> Truth:
    """Write the wind at 10 m in a file of GRIB, and return its truth."""
    import eccodes

    lon, lat, *along = on_map(kind)
    parts = along
    if not flags & ALONG_GRID:
        parts = list(wind(lon, lat))
    first = MAPS[kind][2]
    keys: dict[str, Any] = {"gridType": kind, "shapeOfTheEarth": 6, "Nx": NX, "Ny": NY}
    keys |= {"longitudeOfFirstGridPointInDegrees": first[0], "DxInMetres": STEP}
    keys |= {"latitudeOfFirstGridPointInDegrees": first[1], "DyInMetres": STEP}
    keys |= MAPS[kind][1] | {"jScansPositively": 1, "resolutionAndComponentFlags": flags}
    keys |= {"discipline": 0, "parameterCategory": 2, "typeOfFirstFixedSurface": 103}
    keys |= {"scaledValueOfFirstFixedSurface": 10, "scaleFactorOfFirstFixedSurface": 0}
    keys |= {"dataDate": int(EPOCH.strftime("%Y%m%d")), "dataTime": 0, "bitsPerValue": 24}
    with path.open("wb") as file:
        for number, values in zip((2, 3), parts, strict=True):
            message = eccodes.codes_grib_new_from_samples("regular_ll_pl_grib2")
            for key, value in {**keys, "parameterNumber": number}.items():
                eccodes.codes_set(message, key, value)
            eccodes.codes_set_values(message, np.ascontiguousarray(values).ravel())
            eccodes.codes_write(message, file)
            eccodes.codes_release(message)
    return on_earth(lon, lat, tolerance=5e-3)


@supported(
    "Models on grids",
    "GRIB on maps: HRRR, RAP, NAM, CERRA, HRDPS",
    'flowtex.show("polar.grib2")',
    "components along the grid, as flags say, are turned to east and north",
    "cfgrib",
)
def grib_on_a_polar_map(folder: Path) -> Made:
    return {}, write(folder / "polar.grib2", "polar_stereographic", ALONG_GRID)
