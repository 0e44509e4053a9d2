"""Nodes of longitude and latitude on a globe or a flat map, and their order there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.earth import GLOBE, Projection
from flowtex.field.datasets.places import Places

__all__ = ["TORN", "MapNodes", "on_map", "projection_of", "shown_positions"]

#: The flat map that is drawn where none is chosen, and those on which an axis that goes around the
#: Earth goes on at the other side, a map further.
FLAT = "platecarree"
CYLINDERS = (FLAT, "mercator")
#: Latitudes that a map shows, where it cannot show all.
LATITUDES = {"mercator": (-85.0, 85.0), "north": (0.0, 90.0), "south": (-90.0, 0.0)}
#: From this latitude on the middle of a region is drawn around its pole.
POLAR = 66.0
#: Longitudes from here on are all around the Earth.
AROUND = 359.0
#: Where a map is larger by this factor than it mostly is, it ends.
LARGEST = 4.0
#: Edges between nodes are torn where they are longer by this factor than on the Earth.
TORN = 8.0


@dataclass(frozen=True, eq=False)
class MapNodes:
    """Nodes on a map.

    ``points`` are (J, I, 3), ``lines`` is the index that takes an array of the grid (J, I) to the
    order of the map, ``periodic`` the argument of :meth:`FlowField.from_arrays`.
    """

    projection: Projection
    points: Floats
    lines: Any
    periodic: str | None
    lon: Floats
    lat: Floats

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (J, I, 3) of components in m/s, in the order of the map."""
        return self.projection.vectors(self.lon, self.lat, east, north)


def on_map(places: Places, name: str | None) -> MapNodes:
    """Put nodes on a map, by its name; by default a flat one that suits the region."""
    lon, lat = places.a, places.b
    columns = np.arange(lon.shape[1])
    projection, around = projection_of(places, name)
    name, center = projection.name, projection.center
    if name == GLOBE:
        return MapNodes(
            projection, projection.positions(lon, lat), (slice(None), columns), None, lon, lat
        )
    periodic: str | None = ""
    lon = center[0] + (lon - center[0] + 180.0) % 360.0 - 180.0
    if places.is_line:
        columns = np.argsort(lon[0], kind="stable")
        lon = lon[:, columns]
        if around:
            # The last column is the first one again, a turn further.
            if lon[0, -1] - lon[0, 0] < 360.0 - 1e-3:
                columns = np.append(columns, columns[0])
                lon = np.concatenate([lon, lon[:, :1] + 360.0], axis=1)
            periodic = "i" if name in CYLINDERS else None if name in ("north", "south") else ""
    lat = lat[:, columns]
    points = shown_positions(projection, lon, lat)
    if not places.is_line or name not in (*CYLINDERS, "north", "south"):
        points[_torn(points, lon, lat)] = np.nan
    rows = np.asarray(np.isfinite(points[..., 0]).any(axis=1))
    first, last = np.flatnonzero(rows)[[0, -1]] if rows.any() else (0, len(rows) - 1)
    kept = slice(int(first), int(last) + 1)
    return MapNodes(projection, points[kept], (kept, columns), periodic, lon[kept], lat[kept])


def projection_of(places: Places, name: str | None) -> tuple[Projection, bool]:
    """Return the map of a name, or one that suits the region, and whether that is around the Earth.

    ``places`` are nodes in any order where they are no lines.
    """
    if name == GLOBE:
        return Projection(GLOBE), False
    middle, span = _middle(places.a)
    around = span >= AROUND
    low, high = float(np.nanmin(places.b)), float(np.nanmax(places.b))
    center = (0.0 if around else middle, 0.0 if around else (low + high) / 2)
    if name is None:
        polar = not around or not places.is_line
        polar = polar and abs(low + high) / 2 > POLAR
        name = FLAT if not polar else "north" if low + high > 0 else "south"
    return Projection(name, center, max((high - low) / 2, 1.0)), around


def shown_positions(projection: Projection, lon: Floats, lat: Floats) -> Floats:
    """Return positions (..., 3) on a flat map, NaN where it has ended."""
    points = projection.positions(lon, lat)
    least, most = LATITUDES.get(projection.name, (-90.0, 90.0))
    with np.errstate(invalid="ignore"):
        points[(lat < least) | (lat > most)] = np.nan
    if projection.name not in ("robinson", "equalearth", *CYLINDERS):
        scale = projection.scales(lon, lat)
        known = scale[np.isfinite(scale)]
        with np.errstate(invalid="ignore"):
            points[~(scale <= LARGEST * (np.median(known) if known.size else 0))] = np.nan
    return points


def _middle(lon: Floats) -> tuple[float, float]:
    """Return the longitude in the middle of a region, and how far it reaches."""
    values = np.sort(np.unique(np.round(lon[np.isfinite(lon)] % 360.0, 6)))
    if len(values) < 2:
        return float(values[0]) if len(values) else 0.0, 0.0
    gaps = np.diff(np.append(values, values[0] + 360.0))
    widest = int(np.argmax(gaps))
    typical = float(np.median(gaps))
    span = 360.0 - gaps[widest]
    if gaps[widest] <= max(1.5 * typical, 1.0):
        return 0.0, 360.0
    middle = values[(widest + 1) % len(values)] + span / 2
    return float((middle + 180.0) % 360.0 - 180.0), float(span)


def _torn(points: Floats, lon: Floats, lat: Floats) -> Any:
    """Return nodes, (J, I), after which the map is torn along a row or a column."""
    sphere = Projection(GLOBE).positions(lon, lat)
    torn = np.zeros(lon.shape, dtype=bool)
    for axis in (0, 1):
        flat, true = (np.linalg.norm(np.diff(p, axis=axis), axis=-1) for p in (points, sphere))
        with np.errstate(invalid="ignore"):
            far = (flat > TORN * true) & (flat > 0.1 * np.nanmax(np.abs(points)))
        at = (slice(None, -1), slice(None)) if axis == 0 else (slice(None), slice(None, -1))
        torn[at] |= far
    return torn
