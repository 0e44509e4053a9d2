"""Nodes of longitude and latitude on a globe or a flat map, and their order there."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.earth import GLOBE, Projection
from flowtex.field.earth.lines import tear
from flowtex.sources.datasets.coordinates import Places

#: The default flat map, and the maps on which an axis around the Earth continues periodically.
FLAT = "platecarree"
CYLINDERS = (FLAT, "mercator")
#: Latitudes that a map shows, if not all.
LATITUDES = {"mercator": (-85.0, 85.0), "north": (0.0, 90.0), "south": (-90.0, 0.0)}
#: Latitude of the middle of a region from which on it is drawn around a pole.
POLAR = 66.0
#: Span of longitudes from which on a region is around the Earth.
AROUND = 359.0
#: Distance in cells from the first column, one turn further, up to which a column repeats it.
SAME_LINE = 0.01
#: Least columns that close around a globe, and widest gap between the last and first in cells.
LEAST_RING, MOST_GAP = 8, 1.5
#: Share of different longitudes from which on nodes are scattered, and the square root of the
#: sphere's area in square degrees.
SCATTERED, SPHERE_DEGREES = 0.125, 203.0
#: Scale of a map, over its median, beyond which the map ends.
LARGEST = 4.0
#: Edges between nodes are torn where they are longer by this factor than on the Earth.
TORN = 8.0
#: A step across a meridian is longer by this factor than one before it where the map is torn there.
WIDER = 1.5
#: Share of a cell beside a meridian along which a map is torn, up to which the flow is drawn.
BESIDE = 0.02


class Nodes(Protocol):
    """Positions where nodes are drawn, (..., 3), and data and vectors there."""

    points: Floats

    @property
    def projection(self) -> Projection | None:
        """The map; ``None`` in a plane."""

    def at(self, values: Floats) -> Floats:
        """Return values at the nodes."""

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (..., 3) of components at the nodes in m/s."""


@dataclass(eq=False)
class PlaneNodes:
    """Nodes in a plane, whose components are along x and y."""

    points: Floats
    projection: Projection | None = None

    def at(self, values: Floats) -> Floats:
        """Return values as they are."""
        return values

    def vectors(self, u: Floats, v: Floats) -> Floats:
        """Return vectors of components along x and y."""
        return np.stack([u, v, np.zeros_like(u)], axis=-1)


@dataclass(eq=False)
class MapNodes:
    """Nodes on a map."""

    projection: Projection
    points: Floats  #: (J, I, 3).
    #: Index that takes an array of the grid (J, I) to the order of the map.
    lines: tuple[slice, Indices]
    periodic: str | None  #: As for :meth:`FlowField.from_arrays`.
    lon: Floats  #: Longitudes and latitudes, for the directions of vectors.
    lat: Floats

    def at(self, values: Floats) -> Floats:
        """Return values in the order of the map."""
        return np.asarray(values[self.lines])

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (J, I, 3) of components in m/s, in the order of the map."""
        return self.projection.vectors(self.lon, self.lat, east, north)


@dataclass(frozen=True, eq=False)
class MapLines:
    """Lines of longitude (I,) and latitude (J,) in the order of a map."""

    lon: Floats
    shown: Floats  #: Longitudes where the map has them, such as a turn further at its end.
    lat: Floats
    columns: Indices  #: Numbers of the longitudes in the data.
    periodic: str | None  #: As in :class:`MapNodes`.


def on_map(places: Places, name: str | None) -> MapNodes:
    """Put nodes on a map, by its name; by default a flat one that suits the region."""
    projection, around = projection_of(places, name)
    name, lon, lat = projection.family, places.a, places.b
    columns, periodic = np.arange(lon.shape[1]), None if projection.is_globe else ""
    if places.is_line:
        lines = lines_on_map(places, projection, around=around)
        lon, shown, lat = np.broadcast_arrays(lines.lon, lines.shown, lines.lat[:, None])
        columns, periodic = lines.columns, lines.periodic
    else:
        shown = lon = lon if projection.is_globe else _around_middle(lon, projection)
    if projection.is_globe:
        points = projection.positions(shown, lat)
        return MapNodes(projection, points, (slice(None), columns), periodic, lon, lat)
    points = shown_positions(projection, shown, lat)
    if not places.is_line or name not in (*CYLINDERS, "north", "south"):
        torn = _torn(points, shown, lat)
        if places.is_line and torn.any():
            (lon, shown), between, columns = _beside_tears(lines, projection, torn)
            lat = np.broadcast_to(lines.lat[:, None], lon.shape)
            points = shown_positions(projection, shown, lat)
            points[between] = np.nan
            torn = _torn(points, shown, lat)
        points[torn] = np.nan
    kept = shown_rows(points)
    return MapNodes(projection, points[kept], (kept, columns), periodic, lon[kept], lat[kept])


def lines_on_map(places: Places, projection: Projection, *, around: bool) -> MapLines:
    """Return the lines of places in the order of a map; one around the Earth is closed."""
    lon, lat = places.lines
    turn = np.abs(lon - lon[0])
    step = float(np.median(np.diff(turn))) if len(turn) > 1 else 0.0
    columns = np.flatnonzero(~(turn > 360.0 - SAME_LINE * step))
    lon = lon[columns]
    if projection.is_globe:
        ends = turn[columns]
        widest = max(ends[1] - ends[0], ends[-1] - ends[-2]) if len(ends) >= LEAST_RING else 0.0
        if not 0 < 360.0 - ends[-1] <= MOST_GAP * widest:
            return MapLines(lon, lon, lat, columns, "")
        lon = np.append(lon, lon[0])
        return MapLines(lon, lon, lat, np.append(columns, columns[0]), "i")
    lon = _around_middle(lon, projection)
    order = np.argsort(lon, kind="stable")
    lon, columns = lon[order], columns[order]
    if not around:
        return MapLines(lon, lon, lat, columns, "")
    shown = np.append(lon, lon[0] + 360.0)
    lon, columns = np.append(lon, lon[0]), np.append(columns, columns[0])
    name = projection.family
    periodic = "i" if name in CYLINDERS else None if name in ("north", "south") else ""
    return MapLines(lon, shown, lat, columns, periodic)


def _around_middle(lon: Floats, projection: Projection) -> Floats:
    """Return longitudes within half a turn of the middle of a map."""
    middle = projection.center[0]
    return np.asarray(middle + (lon - middle + 180.0) % 360.0 - 180.0)


def shown_rows(points: Floats) -> slice:
    """Return the rows of nodes (J, I, 3) on a map that it shows, from the first to the last."""
    rows = np.flatnonzero(np.isfinite(points[..., 0]).any(axis=1))
    return slice(int(rows[0]), int(rows[-1]) + 1) if len(rows) else slice(0, len(points))


def projection_of(places: Places, name: str | None) -> tuple[Projection, bool]:
    """Return the map of a name, or one that suits, and whether the region is around the Earth."""
    if name == GLOBE:
        return Projection(GLOBE), False
    lon, lat = places.lines if places.is_line else (places.a, places.b)
    middle, span = _middle(lon)
    around = span >= AROUND
    low, high = float(np.nanmin(lat)), float(np.nanmax(lat))
    center = (0.0 if around else middle, 0.0 if around else (low + high) / 2)
    if name is None:
        polar = not around or not places.is_line
        polar = polar and (abs(low + high) / 2 > POLAR or (low * high > 0 and _has_pole(places)))
        name = FLAT if not polar else "north" if low + high > 0 else "south"
    projection = Projection(name, center, max((high - low) / 2, 1.0))
    if (origin := projection.origin) is not None:
        projection = replace(projection, center=(origin, center[1]))
    return projection, around


def _has_pole(places: Places) -> bool:
    """Return whether the edge of a grid goes around a pole."""
    lon = places.a
    edge = np.concatenate([lon[0], lon[1:, -1], lon[-1, -2::-1], lon[-2::-1, 0]])
    steps = np.diff(edge[np.isfinite(edge)])
    return bool(abs(((steps + 180.0) % 360.0 - 180.0).sum()) > 180.0)


def shown_positions(projection: Projection, lon: Floats, lat: Floats) -> Floats:
    """Return positions (..., 3) on a flat map, NaN beyond its end."""
    # The last column of the whole Earth is the first one, a turn further.
    points = projection.positions(lon, lat, beyond=True)
    least, most = LATITUDES.get(projection.family, (-90.0, 90.0))
    with np.errstate(invalid="ignore"):
        points[(lat < least) | (lat > most)] = np.nan
    if projection.family not in ("robinson", "equalearth", *CYLINDERS):
        scale = projection.scales(lon, lat)
        finite = scale[np.isfinite(scale)]
        with np.errstate(invalid="ignore"):
            points[~(scale <= LARGEST * (np.median(finite) if finite.size else 0))] = np.nan
    return points


def _middle(lon: Floats) -> tuple[float, float]:
    """Return the longitude in the middle of a region, and its span."""
    values = np.sort(np.unique(np.round(lon[np.isfinite(lon)] % 360.0, 6)))
    if len(values) < 2:
        return float(values[0]) if len(values) else 0.0, 0.0
    gaps = np.diff(np.append(values, values[0] + 360.0))
    widest = int(np.argmax(gaps))
    typical = float(np.median(gaps))
    span = 360.0 - gaps[widest]
    # Scattered nodes have longitudes at all distances.
    scattered = len(values) > SCATTERED * lon.size
    spacing = SPHERE_DEGREES / np.sqrt(lon.size) if scattered else 0.0
    if gaps[widest] <= max(1.5 * typical, 2.0 * spacing, 1.0):
        return 0.0, 360.0
    middle = values[(widest + 1) % len(values)] + span / 2
    return float((middle + 180.0) % 360.0 - 180.0), float(span)


def _beside_tears(
    lines: MapLines, projection: Projection, torn: Bools
) -> tuple[Floats, Bools, Indices]:
    """Return longitudes with nodes moved to the meridians where the map is interrupted.

    At such a meridian the nodes on both sides move to it, and a node between them is blank;
    otherwise the cells beside it would not be drawn. ``torn`` marks nodes, (J, I), after
    which the map is torn. Returns the longitudes, and those on the map, (2, J, I), the nodes that
    are blank, and the numbers of the columns in the data.
    """
    lon, shown, columns = lines.lon, lines.shown, lines.columns
    at = np.flatnonzero(torn[:, :-1].sum(axis=0) > 2)  # two rows are not enough
    rows = np.argmax(torn, axis=0)[at], len(torn) - 1 - np.argmax(torn[::-1], axis=0)[at]
    near = BESIDE * float(np.median(np.diff(shown)))
    around = shown[at] - near, shown[at + 1] + near  # one may be on the meridian
    first, last = (
        tear(projection, *(np.stack([ends, lines.lat[row]], axis=-1) for ends in around))
        for row in rows
    )
    meridians = np.sort(first[0][np.abs(first[0] - last[0])[:, 0] < near, 0])
    meridians = meridians[np.diff(meridians, prepend=-np.inf) > near]
    middles = []
    for meridian in meridians:
        middle = int(np.argmin(np.abs(shown - meridian)))
        if abs(shown[middle] - meridian) > near:
            number, middle = columns[middle], int(np.searchsorted(shown, meridian))
            halfway = shown[middle - 1 : middle + 1].mean()
            lon, shown = np.insert(lon, middle, halfway), np.insert(shown, middle, halfway)
            columns = np.insert(columns, middle, number)
        middles.append(middle)
    both = np.repeat(np.stack([lon, shown])[:, None], len(lines.lat), axis=1)
    blank = np.zeros(both.shape[1:], dtype=bool)
    for meridian, middle in zip(meridians, middles, strict=True):
        if not 0 < middle < len(shown) - 1:
            continue
        sides = meridian + near * np.array([-3.0, -1.0, 1.0])
        places = projection.positions(sides, lines.lat[:, None])
        before, across = np.linalg.norm(np.diff(places, axis=1), axis=-1).T
        apart = across > WIDER * before
        moved = apart.copy()  # with the rows beside, or the cells to these would be blank
        moved[1:] |= apart[:-1]
        moved[:-1] |= apart[1:]
        both[:, moved, middle - 1 : middle + 2 : 2] = sides[1:]
        blank[apart, middle] = True
    return both, blank, columns


def _torn(points: Floats, lon: Floats, lat: Floats) -> Bools:
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
