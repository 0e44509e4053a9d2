"""An ocean around the Earth, of any size, made by code one part after the other.

The stream function is a sum of octaves of random cubic B-splines, so that there are eddies of all
sizes from an eighth of the Earth down to eight cells, and it is constant along the coasts. A larger
grid has the same flow, with more of the small eddies.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]

#: Largest and least latitude in degrees.
LATITUDES = (-76.0, 76.0)
#: Nodes from a knot of the smallest octave to the next; knots of the largest around the Earth.
SMALLEST_NODES, LARGEST_KNOTS = 8, 8
#: Speed of the octaves as a power of their size; largest octaves of which there is land.
ROUGHNESS, LAND_OCTAVES = 0.5, 6
#: Height from which on there is land, and over which the flow grows to its full speed beside it.
LAND, SHORE = 0.6, 0.4
#: Speed in m/s of a stream function that grows by one over a knot.
SPEED = np.float32(0.2)
#: Rows and columns of a chunk.
CHUNK = (512, 1024)


def ocean(columns: int, rows: int) -> Any:
    """Return the dataset, whose values are made when they are read."""
    import dask.array as da
    import xarray as xr

    lon, lat = lines(columns, rows)
    chunks = tuple(
        tuple(min(size, n - at) for at in range(0, n, size))
        for n, size in zip((rows, columns), CHUNK, strict=True)
    )

    def made(block_info: Any = None) -> Floats:
        (j, stop_j), (i, stop_i) = block_info[None]["array-location"][-2:]
        return np.stack(part(columns, rows, slice(j, stop_j), slice(i, stop_i)))

    both = da.map_blocks(
        made, dtype=np.float32, chunks=((2,), *chunks), meta=np.empty((0, 0, 0), np.float32)
    )
    names = ("eastward_sea_water_velocity", "northward_sea_water_velocity")
    return xr.Dataset(
        {
            short: (("lat", "lon"), both[axis], {"standard_name": name, "units": "m s-1"})
            for axis, (short, name) in enumerate(zip(("u", "v"), names, strict=True))
        },
        {
            "lon": ("lon", lon, {"units": "degrees_east", "standard_name": "longitude"}),
            "lat": ("lat", lat, {"units": "degrees_north", "standard_name": "latitude"}),
        },
    )


def lines(columns: int, rows: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Longitudes and latitudes of the grid; the last longitude is a step before the first one."""
    return np.arange(columns) * 360.0 / columns - 180.0, np.linspace(*LATITUDES, rows)


def part(columns: int, rows: int, j: slice, i: slice) -> tuple[Floats, Floats]:
    """Return both components of some rows and columns, not a number on land."""
    lon, lat = lines(columns, rows)
    # In knots of the largest octave.
    x = (lon[i] + 180) * LARGEST_KNOTS / 360
    y = (lat[j] + 90) * LARGEST_KNOTS / 360
    psi, psi_x, psi_y, land, land_x, land_y = (np.float32(0) for _ in range(6))
    octave = 0
    while SMALLEST_NODES * LARGEST_KNOTS << octave <= columns:
        value, along_x, along_y = _octave(octave, x, y)
        weight = np.float32(2.0 ** (-(1 + ROUGHNESS) * octave))
        psi, psi_x, psi_y = psi + weight * value, psi_x + weight * along_x, psi_y + weight * along_y
        if octave < LAND_OCTAVES:
            weight = np.float32(2.0 ** (-0.9 * octave))
            # Other knots of the same octave, so that land is not where the eddies are.
            value, along_x, along_y = _octave(octave, x + LARGEST_KNOTS / 2, y + 7)
            land, land_x = land + weight * value, land_x + weight * along_x
            land_y = land_y + weight * along_y
        octave += 1
    # Currents around the Earth, eastward and westward by turns.
    psi = psi + np.float32(0.15) * np.cos(3 * np.pi * y)[:, None].astype(np.float32)
    psi_y = psi_y - np.float32(0.45 * np.pi) * np.sin(3 * np.pi * y)[:, None].astype(np.float32)
    near = np.tanh((LAND - land) / SHORE)
    slope = (near**2 - 1) / SHORE
    cosine = np.cos(np.radians(lat[j]))[:, None].astype(np.float32)
    u = -(psi_y * near + psi * slope * land_y)
    v = (psi_x * near + psi * slope * land_x) / cosine
    dry = land > LAND
    u[dry] = v[dry] = np.nan
    return SPEED * u, SPEED * v


def _octave(octave: int, x: NDArray[Any], y: NDArray[Any]) -> tuple[Floats, Floats, Floats]:
    """Values of an octave and what they grow by along x and y, (J, I), in the largest knots."""
    knots, scale = _knots(octave), np.float32(1 << octave)
    (b, db), (a, da) = (
        _splines(some * (1 << octave), count)
        for some, count in zip((x, y), knots.shape[::-1], strict=True)
    )
    across = knots @ b.T
    return a @ across, scale * (a @ (knots @ db.T)), scale * (da @ across)


@lru_cache(maxsize=16)
def _knots(octave: int) -> Floats:
    rng = np.random.default_rng([20261122, octave])
    size = LARGEST_KNOTS << octave
    return rng.standard_normal((size, size), dtype=np.float32)


def _splines(at: NDArray[Any], count: int) -> tuple[Any, Any]:
    """Return cubic B-splines and their derivatives at places as sparse matrices (N, count)."""
    from scipy.sparse import csr_array

    first = np.floor(at).astype(int)
    t = at - first
    s = 1 - t
    values = (s**3 / 6, 2 / 3 - t**2 + t**3 / 2, 2 / 3 - s**2 + s**3 / 2, t**3 / 6)
    growth = (-(s**2) / 2, -2 * t + 1.5 * t**2, 2 * s - 1.5 * s**2, t**2 / 2)
    columns = (first[:, None] + np.arange(4)) % count
    ends = np.arange(0, 4 * len(at) + 1, 4)
    shape = (len(at), count)
    value, grown = (
        csr_array((np.stack(w, -1).astype(np.float32).ravel(), columns.ravel(), ends), shape=shape)
        for w in (values, growth)
    )
    return value, grown
