"""Nodes of longitude and latitude, and meshes of these, on a globe or a flat map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.field.earth.projection import GLOBE, NAMES, Projection
from flowtex.field.earth.tears import between, tears
from flowtex.field.grids.grid_nodes import find_closure
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.space_planes import SpacePlane

#: Rows or columns, by numbers or as a slice.
Lines: TypeAlias = Indices | slice
#: The default flat map, and the maps on which an axis around the Earth continues periodically.
FLAT = "platecarree"
CYLINDERS = (FLAT, "mercator")
#: Maps around a pole, which have no edge at a meridian.
POLAR_MAPS = ("north", "south")
#: Latitudes that a map shows, if not all.
LATITUDES = {"mercator": (-85.0, 85.0), "north": (0.0, 90.0), "south": (-90.0, 0.0)}
ROUNDED = 1e-5  #: Degrees of rounding of these.
#: Latitude of the middle of a region from which on it is drawn around a pole.
POLAR = 66.0
#: Span of longitudes from which on a region is around the Earth.
AROUND = 359.0
#: Distance in cells from another column, one turn further, up to which a column repeats it, and
#: from the edge of a map, up to which it lies there.
SAME_LINE = 0.01
#: Least columns that close around the Earth.
LEAST_RING = 8
#: Widest gap in cells between the last column and the first, across which they close.
MOST_GAP = 1.5
#: Least ratio of a gap in the data to the distances of the lines beside it, and to most others.
GAP = 1.75
#: Quantile of the distances between lines that stands for most of them.
ALMOST_ALL = 0.9
#: Share of different longitudes from which on nodes are scattered.
SCATTERED = 0.125
#: Square root of the area of the sphere in square degrees.
SPHERE_DEGREES = 203.0
#: Scale of a map, over its median, beyond which the map ends.
LARGEST = 4.0
#: Scale of a map along an edge between nodes, over its median, up to which it is not torn.
PLAIN = 1.5
#: Length on a map in metres below which an edge is a point, as along a pole, and has no scale.
SHORTEST = 1.0
#: Scale from which on a long edge is not drawn.
WIDE = 4.0
#: Length of an edge from which on it is long, as a share of the map.
FAR = 0.5
#: Degrees by which nodes on the edge of a map lie inside it, so that rounding does not move them.
INSIDE = 1e-9
#: Share of a cell on both sides of a tear's end, between which nodes beside it lie.
BESIDE = 0.02
#: Least distance on the map between the sides of a tear, as a share of the edge that it tears.
LEAST_OPENING = 0.02
#: Up to how many nodes one of the blank lines between parts remains where a coarser view leaves
#: lines out, if there is one.
COARSE_NODES = 20_000
#: Degrees beside the edge of a map in which it is searched.
STEP = 0.02
#: Latitudes at which the edge of a map is searched.
EDGE_LATITUDES = np.linspace(-75.0, 75.0, 31)


@dataclass(eq=False)
class PlaneNodes:
    """Nodes in a plane, whose components are along x and y, or along a plane across one of them."""

    positions: Floats  #: (..., 2).
    plane: SpacePlane | None = None
    projection: Projection | None = None

    @property
    def points(self) -> Floats:
        """Positions of the nodes, (..., 2), or in space, (..., 3)."""
        if self.plane is None:
            return self.positions
        return self.plane.points(self.positions)

    def at(self, values: Floats) -> Floats:
        """Return values as they are."""
        return values

    def components(self, values: Floats) -> Floats:
        """Return components, (2, ...), as they are."""
        return values

    def vectors(self, u: Floats, v: Floats) -> Floats:
        """Return vectors of components along the axes of the plane."""
        if self.plane is not None:
            return self.plane.vectors(u, v)
        return np.stack([u, v, np.zeros_like(u)], axis=-1)


@dataclass(frozen=True, eq=False)
class Chosen:
    """Some rows and columns of a grid; some of their nodes move between two rows or columns."""

    rows: Indices | slice
    columns: Indices | slice
    #: Rows and columns of nodes that move, and of the two nodes between which they move, (2, M).
    moved: tuple[Indices, Indices, Indices] | None = None
    share: Floats | float = 0.0  #: Share of the way from one of these to the other, (M,).

    def __call__(self, values: Floats) -> Floats:
        """Return values at the nodes, from values of the grid, (J, I)."""
        chosen = np.array(values[self.rows][:, self.columns])
        if self.moved is not None:
            at, one, other = map(tuple, self.moved)
            chosen[at] = (1 - self.share) * values[one] + self.share * values[other]
        return chosen


@dataclass(eq=False)
class MapNodes:
    """Nodes on a map."""

    projection: Projection
    points: Floats  #: (J, I, 3).
    #: Take an array of the grid to the nodes, one after the other.
    choices: Sequence[Chosen]
    periodic: str | None  #: As for :meth:`FlowField.from_arrays`.
    lon: Floats  #: Longitudes and latitudes, NaN between parts.
    lat: Floats

    def at(self, values: Floats) -> Floats:
        """Return values at the nodes, from values of the grid."""
        for chosen in self.choices:
            values = chosen(values)
        return values

    def components(self, values: Floats) -> Floats:
        """Return eastward and northward components at the nodes, (2, J, I), from the grid's."""
        east, north = values
        return np.stack([self.at(east), self.at(north)])

    def vectors(self, east: Floats, north: Floats) -> Floats:
        """Return vectors (J, I, 3) of components at the nodes in m/s."""
        return self.projection.vectors(self.lon, self.lat, east, north)


@dataclass(frozen=True, eq=False)
class NodeLines:
    """Two lines of coordinates of nodes, in the order of a map; NaN between parts of it."""

    a: Floats  #: Longitude of each column, (I,), or x.
    b: Floats  #: Latitude of each row, (J,), or y.
    rows: Indices  #: Numbers of the rows in the data, (J,).
    columns: Indices  #: Numbers in the data between which each column lies, (2, I).
    share: Floats  #: Share of the way from the first to the second, (I,).
    projection: Projection | None  #: The map; ``None`` in a plane.
    periodic: str | None  #: As in :class:`MapNodes`.

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes (J, I)."""
        return len(self.rows), len(self.share)

    def some(self, rows: Lines, columns: Lines) -> NodeLines:
        """Return some of the lines."""
        return replace(
            self,
            a=self.a[columns],
            b=self.b[rows],
            rows=self.rows[rows],
            columns=self.columns[:, columns],
            share=self.share[columns],
        )

    def points(self, rows: Lines, columns: Lines) -> Floats:
        """Return positions (J, I, 3) of some rows and columns."""
        a, b = np.broadcast_arrays(self.a[columns], self.b[rows][:, None])
        if self.projection is None:
            return np.stack([a, b, np.zeros(a.shape)], axis=-1)
        if self.projection.is_globe:
            return self.projection.positions(a, b)
        return shown_positions(self.projection, a, b)

    def vectors(self, u: Floats, v: Floats, rows: Lines, columns: Lines) -> Floats:
        """Return vectors (J, I, 3) of components at some rows and columns."""
        if self.projection is None:
            return np.stack([u, v, np.zeros(u.shape)], axis=-1)
        a, b = np.broadcast_arrays(self.a[columns], self.b[rows][:, None])
        return self.projection.vectors(a, b, u, v)

    @property
    def chosen(self) -> Chosen:
        """The nodes in the data."""
        columns = np.flatnonzero(self.share)
        row, number = np.indices((len(self.rows), len(columns))).reshape(2, -1)
        column = columns[number]
        one, other = (np.stack([self.rows[row], ends[column]]) for ends in self.columns)
        moved = np.stack([row, column]), one, other
        return Chosen(self.rows, self.columns[0], moved, self.share[column])


def on_map(places: Places, name: str | None) -> MapNodes:
    """Put nodes on a map, by its name; by default a flat one that suits the region."""
    projection = projection_of(places, name)
    is_flat = not projection.is_globe
    is_line = places.is_line
    periodic = None
    if is_line:
        lines = lines_on_map(places, projection)
        lon, lat = np.broadcast_arrays(lines.a, lines.b[:, None])
        choices = [lines.chosen]
        periodic = lines.periodic
    else:
        columns = np.arange(places.a.shape[1])
        if is_flat and find_closure(np.swapaxes(places.positions, 0, 1))[1] is not None:
            columns = np.append(columns, 0)
        choices = [Chosen(slice(None), columns)]
        # A node on the edge of a map lies on its western side.
        west = projection.center[0] - 180.0
        lon = west + (places.a[:, columns] - west) % 360.0
        lat = places.b[:, columns]
    if not is_line or (is_flat and projection.family not in (*CYLINDERS, *POLAR_MAPS)):
        for axis in (1, 0):
            if (parts := _parts(projection, lon, lat, axis, is_line=is_line)) is not None:
                lon, lat, chosen = parts
                choices.append(chosen)
    if not is_flat:
        points = projection.positions(lon, lat)
        return MapNodes(projection, points, choices, periodic, lon, lat)
    points = shown_positions(projection, lon, lat)
    if periodic is None:
        step = float(np.nanmax(np.abs(points[:, 1] - points[:, 0]), initial=0.0))
        ends = float(np.nanmax(np.abs(points[:, -1] - points[:, 0]), initial=0.0))
        if ends <= SAME_LINE * step:
            periodic = "i"
        else:
            periodic = ""
    kept = shown_rows(points)
    choices.append(Chosen(kept, slice(None)))
    return MapNodes(projection, points[kept], choices, periodic, lon[kept], lat[kept])


def lines_on_map(places: Places, projection: Projection) -> NodeLines:
    """Return the lines of places in the order of a map.

    If the data are around the Earth, the first column comes again at the end. At the edge of a map
    are columns between those of the data beside it.
    """
    lon, lat = places.lines
    turn = (lon - lon[0]) % 360.0
    columns = np.argsort(turn, kind="stable")
    turn = turn[columns]
    least = SAME_LINE * float(np.median(np.diff(turn))) if len(turn) > 1 else 0.0
    apart = (np.diff(turn, prepend=-360.0) > least) & (turn <= 360.0 - least)
    columns = columns[apart]
    turn = turn[apart]
    count = len(turn)
    steps = np.diff(turn, append=360.0)
    widest = int(np.argmax(steps))
    gap = steps[widest] / max(steps[widest - 1], steps[(widest + 1) % count])
    closed = count >= LEAST_RING and gap <= MOST_GAP
    has_edge = _has_edge(projection)
    west = projection.center[0] - 180.0
    first = 0 if closed else (widest + 1) % count
    if closed and has_edge:
        first = int(np.argmin((lon[0] + turn - west) % 360.0))
    columns = np.roll(columns, -first)
    lon = lon[0] + np.roll(turn + 360.0 * (np.arange(count) < first), -first)
    gaps = _gaps(np.diff(lon))
    blank = math.ceil(math.sqrt(places.a.size / COARSE_NODES))
    # Columns to insert: before which, where, between which, and the share of the way there.
    new: list[tuple[Any, ...]]
    new = [(k + 1, np.nan, k, k, 0.0) for k in np.flatnonzero(gaps) for _ in range(blank)]
    near = np.zeros(count, dtype=bool)
    if has_edge:
        lon -= 360.0 * np.floor((lon[0] - west) / 360.0)
        cut = count if closed else int(np.searchsorted(lon, west + 360.0 + least))
        if closed or (cut < count and not gaps[cut - 1]):
            a = cut - 1
            b = cut % count
            step = (lon[b] - lon[a]) % 360.0
            share = (west + 360.0 - lon[a]) / step
            near = np.abs((lon - west + 180.0) % 360.0 - 180.0) < SAME_LINE * step
            a, b = (a if share < 1 - SAME_LINE else b), (b if share > SAME_LINE else a)
            between = (a, b, share if a != b else 0.0)
            new += [(cut, west + 360.0, *between)]
            new += [(cut, np.nan, a, a, 0.0)] * (0 if closed else blank)
            new += [(0 if closed else cut, west, *between)]
        lon[cut:] -= 360.0
    elif closed:
        new += [(count, lon[0], 0, 0, 0.0)]
    ends = np.stack([columns, columns])
    share = np.zeros(count)
    if new:
        at, more, one, other, shares = (np.array(values) for values in zip(*new, strict=True))
        lon = np.insert(lon, at, more)
        share = np.insert(share, at, shares)
        near = np.insert(near, at, 0)
        ends = np.insert(ends, at, columns[np.stack([one, other])], axis=1)
    if has_edge:
        lon = np.clip(lon, west + INSIDE, west + 360.0 - INSIDE)
    periodic = "i" if closed and (not has_edge or projection.family in CYLINDERS) else ""
    missing = np.repeat(np.flatnonzero(_gaps(np.diff(lat))) + 1, blank)
    rows = np.insert(np.arange(len(lat)), missing, missing)
    lat = np.insert(lat, missing, np.nan)
    return NodeLines(lon[~near], lat, rows, ends[:, ~near], share[~near], projection, periodic)


def _has_edge(projection: Projection) -> bool:
    """Return whether a map ends at a meridian, a half turn from its middle."""
    if projection.is_globe or projection.family in NAMES:
        return projection.family not in (GLOBE, *POLAR_MAPS)
    lon = projection.center[0] + 180.0 + STEP * np.array([-2.0, -1.0, 1.0])
    before, across = np.diff(projection.positions(lon[:, None], EDGE_LATITUDES), axis=0)
    before = np.linalg.norm(before, axis=1)
    across = np.linalg.norm(across, axis=1)
    known = np.isfinite(across)
    return bool(known.any() and (across > 10 * before)[known].all())


def _gaps(steps: Floats) -> Bools:
    """Return which distances between lines, (..., I), are gaps in the data."""
    if not steps.shape[-1]:
        return np.zeros(steps.shape, dtype=bool)
    steps = np.abs(steps)
    beside = np.pad(steps, [(0, 0)] * (steps.ndim - 1) + [(1, 1)], constant_values=np.nan)
    beside = np.fmax(beside[..., :-2], beside[..., 2:])
    number = (ALMOST_ALL * (np.isfinite(steps).sum(axis=-1, keepdims=True) - 1)).astype(int)
    usual = np.take_along_axis(np.sort(steps, axis=-1), np.maximum(number, 0), axis=-1)
    return (steps > GAP * beside) & (steps > GAP * usual)


def data_gaps(lon: Floats, lat: Floats) -> Bools:
    """Return which steps along the rows of a grid, (J, I - 1), are gaps in the data."""
    steps = np.diff(Projection(GLOBE).positions(lon, lat), axis=1)
    return _gaps(np.linalg.norm(steps, axis=-1))


def _parts(
    projection: Projection, lon: Floats, lat: Floats, axis: int, *, is_line: bool
) -> tuple[Floats, Floats, Chosen] | None:
    """Part a grid, (J, I), where a map tears it apart along an axis, or data are missing there.

    Nodes beside a tear move to it, and lines between the parts are blank. Returns longitudes and
    latitudes, NaN where nodes are blank, and the nodes; ``None`` where there is nothing to part.
    """
    if axis == 0:
        lon = lon.T
        lat = lat.T
    parted = np.zeros((len(lon), lon.shape[1] - 1), dtype=bool)
    if not is_line:
        parted = data_gaps(lon, lat)
    places = np.stack([lon, lat], axis=-1)
    sides = np.zeros((2, 0))
    row = column = np.zeros(0, dtype=np.intp)
    if not projection.is_globe:
        points = shown_positions(projection, lon, lat).reshape(-1, 3)
        nodes = np.arange(lon.size).reshape(lon.shape)
        edges = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=-1)
        stretched, wide = stretches(lon.ravel(), lat.ravel(), points, edges)
        row, column = np.nonzero(stretched & ~parted)
        ends = places[row, column], places[row, column + 1]
        torn, *shares = tears(projection, *ends, straight=not is_line)
        row = row[torn]
        column = column[torn]
        sides = np.array(shares)
        parted |= wide
        parted[row, column] = True
        ends = ends[0][torn], ends[1][torn]
        length = np.linalg.norm(points[nodes[row, column]] - points[nodes[row, column + 1]], axis=1)
        is_open = _opens(projection, ends, sides, LEAST_OPENING * length, straight=not is_line)
        row = row[is_open]
        column = column[is_open]
        sides = sides[:, is_open]
    columns = np.flatnonzero(parted.any(axis=0))
    if not len(columns):
        return None
    start = np.zeros((len(lon), len(columns)))
    stop = np.ones((len(lon), len(columns)))
    number = np.searchsorted(columns, column)
    start[row, number], stop[row, number] = sides
    for beside in (-1, 1):  # in the row where a tear ends
        near = np.clip(row + beside, 0, len(lon) - 1)
        last = parted.shape[1] - 1
        whole = ~(parted[near, column - (column > 0)] | parted[near, np.minimum(column + 1, last)])
        whole &= ~parted[near, column]
        at = near[whole], number[whole]
        start[at] = np.maximum(sides[0][whole] - BESIDE, 0.0)
        stop[at] = np.minimum(sides[1][whole] + BESIDE, 1.0)
    most = max(lon.shape[1] // (4 * len(columns)), 1)
    blank = min(math.ceil(math.sqrt(lon.size / COARSE_NODES)), most)
    copies = np.ones(lon.shape[1], dtype=int)
    copies[columns] += blank
    chosen = np.repeat(np.arange(len(copies)), copies)
    first = np.cumsum(copies) - copies
    all_shares = np.linspace(start, stop, blank + 2, axis=-1)
    row, number, extra = np.nonzero((all_shares > 0) & (all_shares < 1))
    share = all_shares[row, number, extra]
    column = columns[number]
    one = np.stack([row, column])
    other = np.stack([row, column + 1])
    new = np.stack([row, first[column] + extra])
    ends = places[tuple(one)], places[tuple(other)]
    places = places[:, chosen]
    places[tuple(new)] = between(*ends, share, straight=not is_line)
    is_blank = parted[row, column] & (extra > 0) & (extra <= blank)
    places[tuple(new[:, is_blank])] = np.nan
    lon, lat = np.moveaxis(places, -1, 0)
    if axis == 1:
        return lon, lat, Chosen(slice(None), chosen, (new, one, other), share)
    moved = new[::-1], one[::-1], other[::-1]
    return lon.T, lat.T, Chosen(chosen, slice(None), moved, share)


def _opens(
    projection: Projection,
    ends: tuple[Floats, Floats],
    sides: Floats,
    least: Floats,
    *,
    straight: bool,
) -> Bools:
    """Return which torn edges, (T,), have a tear to whose sides their nodes can move.

    ``sides`` are the shares of both sides, (2, T). An edge near the point of the Earth that an
    azimuthal map opens into its outline is bent and may have both sides at one place, less than
    ``least`` apart. At that point itself the map has no directions.
    """
    places = [between(*ends, side, straight=straight).T for side in sides]
    here, there = (projection.positions(*place) for place in places)
    is_wide = ~(np.linalg.norm(there - here, axis=1) <= least)
    return is_wide & projection.has_directions(*places[0])


def stretches(lon: Floats, lat: Floats, points: Floats, ends: Indices) -> tuple[Bools, Bools]:
    """Return which edges may be torn by a map, and which are too long there to be drawn.

    Edges are between two nodes, (..., 2), of those with ``lon`` and ``lat``, (N,), which lie at
    ``points`` of the map, (N, 3).
    """
    places = points, Projection(GLOBE).positions(lon, lat)
    length, true = (np.linalg.norm(p[ends[..., 0]] - p[ends[..., 1]], axis=-1) for p in places)
    with np.errstate(invalid="ignore", divide="ignore"):
        scale = np.where(length < SHORTEST, np.nan, length / true)
        known = scale[np.isfinite(scale)]
        scale /= np.median(known) if known.size else 1.0
        is_long = length > FAR * np.nanmax(np.abs(points), initial=0.0)
        return scale > PLAIN, (scale > WIDE) & is_long


def shown_rows(points: Floats) -> slice:
    """Return the rows of nodes (J, I, 3) on a map that it shows, from the first to the last."""
    rows = np.flatnonzero(np.isfinite(points[..., 0]).any(axis=1))
    if len(rows):
        return slice(int(rows[0]), int(rows[-1]) + 1)
    return slice(0, len(points))


def projection_of(places: Places, name: str | None) -> Projection:
    """Return the map of a name, or one that suits the region."""
    if name == GLOBE:
        return Projection(GLOBE)
    if places.is_line:
        lon, lat = places.lines
    else:
        lon = places.a
        lat = places.b
    middle, span = _middle(lon)
    around = span >= AROUND
    low = float(np.nanmin(lat))
    high = float(np.nanmax(lat))
    center = (0.0 if around else middle, 0.0 if around else (low + high) / 2)
    if name is None:
        lon = places.a
        edge = np.concatenate([lon[0], lon[1:, -1], lon[-1, -2::-1], lon[-2::-1, 0]])
        steps = np.diff(edge[np.isfinite(edge)])
        turn = ((steps + 180.0) % 360.0 - 180.0).sum()
        has_pole = bool(abs(turn) > 180.0)  # inside the edge
        polar = not around or not places.is_line
        polar = polar and (abs(low + high) / 2 > POLAR or (low * high > 0 and has_pole))
        if not polar:
            name = FLAT
        elif low + high > 0:
            name = "north"
        else:
            name = "south"
    projection = Projection(name, center, max((high - low) / 2, 1.0))
    if (origin := projection.origin) is not None:
        projection = replace(projection, center=(origin, center[1]))
    return projection


def shown_positions(projection: Projection, lon: Floats, lat: Floats) -> Floats:
    """Return positions (..., 3) on a flat map, NaN beyond its end."""
    points = projection.positions(lon, lat)
    least, most = LATITUDES.get(projection.family, (-90.0, 90.0))
    with np.errstate(invalid="ignore"):
        points[(lat < least - ROUNDED) | (lat > most + ROUNDED)] = np.nan
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
    if scattered:
        spacing = SPHERE_DEGREES / np.sqrt(lon.size)
    else:
        spacing = 0.0
    if gaps[widest] <= max(1.5 * typical, 2.0 * spacing, 1.0):
        return 0.0, 360.0
    middle = values[(widest + 1) % len(values)] + span / 2
    return float((middle + 180.0) % 360.0 - 180.0), float(span)
