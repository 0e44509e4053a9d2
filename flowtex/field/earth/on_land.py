"""Which places of the Earth lie on land, as its coasts say."""

from __future__ import annotations

import numpy as np

from flowtex._util.array_types import Bools, Floats
from flowtex.field.earth.coast import Coast
from flowtex.field.earth.map_lines import coast_points

COLUMN_DEGREES = 0.01  #: Width of the strips of places that share a meridian; coasts are as exact.
TURN = 360.0


def on_land(lon: Floats, lat: Floats, coast: Coast | None = None) -> Bools:
    """Return which places lie on land; those without a finite longitude and latitude do not.

    Parameters
    ----------
    lon, lat
        Longitude and latitude in degrees, arrays of one shape.
    coast
        Lines in place of the coasts of the package, where they lie, if they close.

    Returns
    -------
    numpy.ndarray
        Booleans of the same shape. Lakes that have a coast are not land.
    """
    if coast is not None and coast.is_closed:
        return _on_own_land(lon, lat, coast)
    return _within(lon, lat, *coast_points())


def _on_own_land(lon: Floats, lat: Floats, coast: Coast) -> Bools:
    """Return which places lie in closed lines, or on land outside the extent of these."""
    (west, south), (east, north) = coast.extent
    turned = west + (np.asarray(lon) - west) % TURN
    inside = (turned <= east) & (lat >= south) & (lat <= north)
    own = _within(lon, lat, coast.lonlat, coast.joined)
    return np.where(inside, own, on_land(lon, lat))


def _within(lon: Floats, lat: Floats, points: Floats, joined: Bools) -> Bools:
    """Return which places lie within lines, of points (N, 2) of which some are joined."""
    shape = np.shape(lon)
    flat_lon = np.ravel(lon)
    flat_lat = np.ravel(lat)
    known = np.isfinite(flat_lon) & np.isfinite(flat_lat)
    result = np.zeros(flat_lon.shape, dtype=bool)
    # The north pole is sea: coasts to the north of a place are crossed an odd number of times
    # on land. South of Antarctica's coast this holds as well.
    turned = (flat_lon[known] + TURN / 2) % TURN - TURN / 2
    strips, strip = np.unique(np.rint(turned / COLUMN_DEGREES), return_inverse=True)
    number, latitude = _crossings((strips + 0.5) * COLUMN_DEGREES, points, joined)
    # Both sorted by strip and by latitude there, as one number.
    keys = np.sort(number * TURN + latitude)
    last = np.searchsorted(keys, strip * TURN + TURN / 2)
    first = np.searchsorted(keys, strip * TURN + flat_lat[known])
    result[known] = (last - first) % 2 == 1
    return result.reshape(shape)


def _crossings(meridians: Floats, points: Floats, joined: Bools) -> tuple[Floats, Floats]:
    """Return where segments cross ascending meridians: the number of each and the latitude.

    Segment k is from ``points[k]`` to ``points[k + 1]`` where ``joined[k]``. Crossings north of a
    place on its meridian are counted, so numbers are floats, to be sorted with the latitude.
    """
    start = points[:-1][joined]
    step = np.diff(points, axis=0)[joined]
    step[:, 0] = (step[:, 0] + TURN / 2) % TURN - TURN / 2
    west = np.minimum(start[:, 0], start[:, 0] + step[:, 0])
    east = np.maximum(start[:, 0], start[:, 0] + step[:, 0])
    numbers = []
    latitudes = []
    for shift in (-TURN, 0.0, TURN):  # a line may go on across the date line
        low = np.searchsorted(meridians + shift, west, side="right")
        high = np.searchsorted(meridians + shift, east, side="right")
        counts = high - low
        segment = np.repeat(np.arange(len(west)), counts)
        within = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
        number = low[segment] + within
        share = (meridians[number] + shift - start[segment, 0]) / step[segment, 0]
        numbers.append(number.astype(float))
        latitudes.append(start[segment, 1] + share * step[segment, 1])
    return np.concatenate(numbers), np.concatenate(latitudes)
