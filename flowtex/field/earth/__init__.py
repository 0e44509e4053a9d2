"""A globe, and flat maps: positions from longitude and latitude, and vectors from east and north.

A vector is mapped by the derivatives of the projection, so that a particle which moves on the
Earth moves along the map of its path; on a globe directions and lengths are those of the Earth.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import AnyArray, Bools, Floats, Indices
from flowtex._util.arrays import dot
from flowtex.errors import FieldError, import_extra

if TYPE_CHECKING:
    from pyproj import CRS, Transformer

EARTH_RADIUS = 6_371_000.0  #: Mean radius of the Earth in metres.
DEGREE = math.radians(EARTH_RADIUS)  #: Metres of a degree of latitude.
GLOBE = "globe"  #: The name of the sphere among the projections.
#: Projections of PROJ by common names.
NAMES = {
    "platecarree": "+proj=eqc",
    "mercator": "+proj=merc",
    "north": "+proj=stere +lat_0=90",
    "south": "+proj=stere +lat_0=-90",
    "lambert": "+proj=lcc",
    "robinson": "+proj=robin",
    "equalearth": "+proj=eqearth",
}
#: Names of the same maps by PROJ's methods.
METHODS = {
    "Equidistant Cylindrical": "platecarree",
    "Equidistant Cylindrical (Spherical)": "platecarree",
    "Mercator (variant A)": "mercator",
    "Mercator (variant B)": "mercator",
    "Mercator (Spherical)": "mercator",
    "Popular Visualisation Pseudo Mercator": "mercator",
    "Robinson": "robinson",
    "Equal Earth": "equalearth",
}
#: Step in degrees for derivatives. PROJ's Robinson projection is discontinuous by a metre between
#: its pieces, so shorter steps turn directions by up to 3 degrees.
STEP = 0.02
NEAREST_POLE = 0.5  #: Least distance in degrees from a pole for computing derivatives.
TORN = 2.0  #: A step that is longer than the opposite one by this factor crosses a tear.
INSIDE = 1 - 1e-7  #: Factor by which a position outside the map is moved towards its middle.
COASTS = Path(__file__).with_name("coastlines.npz")  #: File of the coastlines.
STEPS_PER_DEGREE = 100  #: Stored steps of a degree, as in tools/coastlines.py.
LONGEST_PIECE = 1.0  #: Longest piece of a line in degrees.
BENT = 0.05  #: A piece may be torn if it bends by more than this share of its length.
MOST_BENT = 0.2  #: Share beyond which it is torn, as along the outline of a map.
LEAST_TEAR = 0.02  #: Share of a torn piece that its tear is wide, at least.
MOST_STRETCHED = 20.0  #: Scale beyond which a map has no lines: they go to infinity, as at a pole.
#: Ratio of the scales of a map along two directions beyond which it tears a point open.
MOST_SHEARED = 1e3
#: Least length of a thinned line in spacings: islands of that length are some pixels wide.
FEWEST_SPACINGS = 4
HALVINGS = 14  #: Halvings of a piece in the search of a tear: to some 10 m on the Earth.
#: Possible spacings of a graticule in degrees.
STEPS = (30, 15, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001)
MOST_LINES = 6  #: Most graticule lines across a map.
FEWEST_PIECES = 8  #: Least pieces of a line between two that cross it.
#: Places along each side of the box where longitude and latitude are looked up.
LOOKS = {True: 25, False: 65}


@dataclass(frozen=True)
class Projection:
    """A projection of the Earth, in metres.

    Attributes
    ----------
    name
        ``"globe"``, one of the names ``"platecarree"``, ``"mercator"``, ``"north"`` and
        ``"south"`` (polar stereographic), ``"lambert"``, ``"robinson"`` and ``"equalearth"``, or
        a PROJ definition, such as ``"EPSG:3413"`` or ``"+proj=laea +lat_0=52 +lon_0=10"``.
    center
        Longitude and latitude of the middle of the map, in degrees, if ``name`` is one of the
        names.
    half_height
        Half the extent of the map in degrees of latitude, which determines the standard parallels
        of a Lambert projection.

    Raises
    ------
    FieldError
        When PROJ does not know the projection.

    Examples
    --------
    >>> from flowtex.field.earth import Projection
    >>> north = Projection("north")
    >>> [round(float(x)) for x in north.positions(0.0, 90.0)]
    [0, 0, 0]
    >>> [float(x) for x in Projection("globe").lonlat((0.0, 6_371_000.0, 0.0))]
    [90.0, 0.0]
    """

    name: str
    center: tuple[float, float] = (0.0, 0.0)
    half_height: float = 10.0

    def __post_init__(self) -> None:
        """Check the name."""
        if not self.is_globe:
            _ = self._crs

    @classmethod
    def of(cls, written: Any) -> Projection | None:
        """Return the projection of a value of :attr:`written`; ``None`` for ``None``."""
        if written is None:
            return None
        name, (lon, lat), half_height = written
        return cls(str(name), (float(lon), float(lat)), float(half_height))

    @property
    def written(self) -> list[Any]:
        """The attributes as a list for JSON."""
        return [self.name, list(self.center), self.half_height]

    @property
    def is_globe(self) -> bool:
        """Whether this is the globe."""
        return self.name == GLOBE

    @property
    def family(self) -> str:
        """The name of the map of the same kind: ``"mercator"`` for ``"EPSG:3857"``."""
        if self.is_globe or self.name in NAMES:
            return self.name
        return METHODS.get(self._operation.method_name, self.name)

    @property
    def origin(self) -> float | None:
        """Central longitude in degrees, if a PROJ definition has one."""
        if self.is_globe or self.name in NAMES:
            return None
        named = (p for p in self._operation.params if p.name.startswith(("Longitude of", "lon_0")))
        return next((float(p.value) for p in named), None)

    @property
    def _operation(self) -> Any:
        return self._crs.coordinate_operation

    @property
    def _origin(self) -> float:
        if self.name in NAMES:
            return self.center[0]
        return 0.0

    @cached_property
    def _crs(self) -> CRS:
        pyproj = import_extra("pyproj", "xarray")
        text = self.name
        if text in NAMES:
            # Longitudes are relative to the middle, so that 180 degrees is the edge of the map.
            lat = self.center[1]
            half = self.half_height
            text = f"{NAMES[text]} +lon_0=0 +R={EARTH_RADIUS:.12g} +units=m"
            if self.name == "platecarree":
                text += f" +lat_ts={lat:.12g}"
            elif self.name == "lambert":
                near = math.copysign(max(abs(lat), 1.0), lat)
                parallels = (near - half / 3, near + half / 3)
                if parallels[0] * parallels[1] <= 0:
                    parallels = (near, near)
                text += f" +lat_0={near:.12g} +lat_1={parallels[0]:.12g} +lat_2={parallels[1]:.12g}"
        with suppress(pyproj.exceptions.ProjError):
            crs: CRS = pyproj.CRS.from_user_input(text)
            if crs.is_projected:
                return crs
        raise FieldError(
            f"the projection {self.name!r} is unknown, or in degrees; expected one of "
            f"{', '.join((GLOBE, *NAMES))}, or a PROJ string of one in metres, such as "
            "'EPSG:3413' or '+proj=laea +lat_0=52 +lon_0=10'"
        )

    @cached_property
    def _transform(self) -> Transformer:
        make = import_extra("pyproj", "xarray").Transformer.from_crs
        transform: Transformer = make(self._crs.geodetic_crs, self._crs, always_xy=True)
        return transform

    def positions(self, lon: Floats, lat: Floats) -> Floats:
        """Return positions in metres, (..., 3), of longitudes and latitudes in degrees.

        They are NaN where the projection is undefined.
        """
        if self.is_globe:
            a = np.radians(lon)
            b = np.radians(lat)
            parts = (np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b))
            return np.asarray(EARTH_RADIUS * np.stack(np.broadcast_arrays(*parts), axis=-1))
        lon, lat = np.broadcast_arrays(lon, lat)
        x, y = self._transform.transform(lon - self._origin, lat, errcheck=False)
        points = np.stack([x, y, np.zeros(np.shape(x))], axis=-1)
        points[~np.isfinite(points).all(axis=-1)] = np.nan
        return points

    def vectors(self, lon: Floats, lat: Floats, east: Floats, north: Floats) -> Floats:
        """Return vectors (..., 3) from eastward and northward components, (..., J, I), in m/s.

        ``lon`` and ``lat`` are (J, I), in degrees.
        """
        to_east, to_north = self._directions(lon, lat)
        return np.asarray(east[..., None] * to_east + north[..., None] * to_north)

    def components(self, lon: Floats, lat: Floats, vectors: Floats) -> tuple[Floats, Floats]:
        """Return the eastward and northward components of vectors (..., 3), in m/s.

        This is the inverse of :meth:`vectors`.
        """
        to_east, to_north = self._directions(lon, lat)
        east = dot(vectors, to_east)
        north = dot(vectors, to_north)
        ee = dot(to_east, to_east)
        en = dot(to_east, to_north)
        nn = dot(to_north, to_north)
        area = ee * nn - en * en
        return (east * nn - north * en) / area, (north * ee - east * en) / area

    def has_directions(self, lon: Floats, lat: Floats) -> Bools:
        """Return where a map keeps directions apart, (...): not where it tears a point open."""
        east, north = self._directions(lon, lat)
        area = np.linalg.norm(np.cross(east, north), axis=-1)
        longest = np.maximum(dot(east, east), dot(north, north))
        with np.errstate(invalid="ignore"):
            return np.asarray(longest < MOST_SHEARED * area)

    def _directions(self, lon: Floats, lat: Floats) -> tuple[Floats, Floats]:
        """Return the change of position for a metre eastward and a metre northward."""
        if self.is_globe:
            a = np.radians(lon)
            b = np.radians(lat)
            zero = np.zeros_like(a)
            east = np.stack([-np.sin(a), np.cos(a), zero], axis=-1)
            north = np.stack([-np.sin(b) * np.cos(a), -np.sin(b) * np.sin(a), np.cos(b)], axis=-1)
            return east, north
        lat = np.clip(lat, NEAREST_POLE - 90, 90 - NEAREST_POLE)
        node = self.positions(lon, lat)
        metre = DEGREE * STEP
        east = _mean(self.positions(lon + STEP, lat) - node, node - self.positions(lon - STEP, lat))
        north = _mean(
            self.positions(lon, lat + STEP) - node, node - self.positions(lon, lat - STEP)
        )
        east /= (metre * np.cos(np.radians(lat)))[..., None]
        north /= metre
        return east, north

    def lonlat(self, positions: Floats) -> tuple[Floats, Floats]:
        """Return longitude and latitude in degrees of positions (..., 3); NaN outside the map."""
        x, y, z = np.moveaxis(np.asarray(positions, dtype=float), -1, 0)
        if self.is_globe:
            return np.degrees(np.arctan2(y, x)), np.degrees(np.arctan2(z, np.hypot(x, y)))
        inverse = partial(self._transform.transform, direction="INVERSE", errcheck=False)
        lon, lat = inverse(x, y)
        finite = np.isfinite(lon) & np.isfinite(lat)
        if not finite.all():  # some lie on the outline, and by rounding outside it
            inner = inverse(INSIDE * x, INSIDE * y)
            lon, lat = (np.where(finite, a, b) for a, b in zip((lon, lat), inner, strict=True))
            finite = np.isfinite(lon) & np.isfinite(lat)
        lon = np.where(finite, lon, np.nan)
        lat = np.where(finite, lat, np.nan)
        return (lon + self._origin + 180.0) % 360.0 - 180.0, lat

    def scales(self, lon: Floats, lat: Floats) -> Floats:
        """Return metres of the map per metre, averaged over directions, (...)."""
        east, north = self._directions(np.asarray(lon, dtype=float), np.asarray(lat, dtype=float))
        return np.asarray(np.sqrt(np.linalg.norm(np.cross(east, north), axis=-1)))


def _mean(one: Floats, other: Floats) -> Floats:
    """Return the mean of two vectors, (..., 3), or one of them where the other crosses a tear."""
    a = np.linalg.norm(one, axis=-1)[..., None]
    b = np.linalg.norm(other, axis=-1)[..., None]
    with np.errstate(invalid="ignore"):
        alone = np.where((a > TORN * b) | ~np.isfinite(a), other, one)
        torn = (a > TORN * b) | (b > TORN * a) | (np.isfinite(a) != np.isfinite(b))
    return np.where(torn, alone, (one + other) / 2)


@dataclass(frozen=True)
class MapLines:
    """Lines on a map."""

    points: Floats  #: Positions in metres, (N, 3).
    #: Where each line begins, (L + 1,): line k is ``points[starts[k]:starts[k + 1]]``.
    starts: Indices

    def and_(self, other: MapLines) -> MapLines:
        """Return these lines and the others."""
        starts = np.append(self.starts[:-1], other.starts + len(self.points))
        return MapLines(np.concatenate([self.points, other.points]), starts)

    def within(self, inside: Bools) -> MapLines:
        """Return the pieces with at least one end among some of the points, (N,)."""
        first = np.delete(np.arange(len(self.points)), self.starts[1:] - 1)
        first = first[inside[first] | inside[first + 1]]
        return _assembled(self.points[first], self.points[first + 1], first, first + 1)

    def thinned(self, spacing: float) -> MapLines:
        """Return lines with a point about every ``spacing`` metres, without small islands."""
        lines = np.repeat(np.arange(len(self.starts) - 1), np.diff(self.starts))
        steps = np.linalg.norm(np.diff(self.points, axis=0, prepend=self.points[:1]), axis=1)
        first = np.zeros(len(self.points), dtype=bool)
        first[self.starts[:-1]] = True
        along = np.cumsum(np.where(first, 0.0, steps))
        along -= along[self.starts[lines]]
        lengths = along[self.starts[1:] - 1]
        places = np.floor(along / spacing)
        keep = first | (np.diff(places, prepend=0.0) > 0)
        keep[self.starts[1:] - 1] = True
        keep &= lengths[lines] >= FEWEST_SPACINGS * spacing
        counts = np.bincount(lines[keep], minlength=len(lengths))
        return MapLines(self.points[keep], np.append(0, np.cumsum(counts[counts > 0])))


def coastlines(projection: Projection, box: Floats | None = None) -> MapLines:
    """Return the coasts of land, larger islands and lakes in a box of the map, (2, 3)."""
    lonlat, joined = coast_points()
    return _mapped(projection, lonlat, joined, box)


def graticule(projection: Projection, box: Floats | None = None) -> MapLines:
    """Return meridians and parallels in a box, at round numbers of degrees."""
    lon, lat = _places(projection, box)
    if not len(lon):
        return MapLines(np.zeros((0, 3)), np.zeros(1, dtype=np.intp))
    steps = _steps(lon, lat)
    meridians = _grid_lines(lon, lat, steps, 0)
    parallels = _grid_lines(lon, lat, steps, 1)
    lonlat = np.concatenate([meridians[0], parallels[0]])
    joined = np.concatenate([meridians[1], parallels[1]])
    return _mapped(projection, lonlat, joined[:-1], box)


@cache
def coast_points() -> tuple[Floats, Bools]:
    """Return longitude and latitude of all coasts, and which points are joined to the next."""
    with np.load(COASTS, allow_pickle=False) as file:
        steps = file["steps"]
        lengths = file["lengths"]
    lonlat = np.cumsum(steps, axis=0, dtype=np.int16) / STEPS_PER_DEGREE
    joined = np.ones(len(lonlat) - 1, dtype=bool)
    joined[np.cumsum(lengths)[:-1] - 1] = False
    # Some islands are cut at the date line, which is not a coast.
    at_date_line = np.abs(lonlat[:, 0]) == 180
    joined &= ~(at_date_line[:-1] & at_date_line[1:])
    return lonlat, joined


def _steps(lon: Floats, lat: Floats) -> tuple[float, float]:
    """Choose the degrees between meridians and between parallels."""
    around = np.unique(lon)
    width = 360 - float(np.diff(around, append=around[0] + 360).max())
    height = float(np.ptp(lat))
    middle = math.radians(float(lat.max() + lat.min()) / 2)
    span = math.sqrt(height * width * math.cos(middle))
    # Meridians are closer to each other near a pole, and many of them would meet there.
    narrowest = max(math.cos(math.radians(float(np.abs(lat).max()))), 1e-3)
    across, along = (
        next((step for step in reversed(STEPS) if length <= MOST_LINES * step), STEPS[0])
        for length in (span / narrowest, span)
    )
    return across, along


def _places(projection: Projection, box: Floats | None) -> tuple[Floats, Floats]:
    """Return longitude and latitude of places all over a box."""
    if box is None:
        lon, lat = np.meshgrid(np.arange(-180.0, 180.0), np.arange(-89.5, 90.0))
        return lon.ravel(), lat.ravel()
    count = LOOKS[projection.is_globe]
    axes = [np.linspace(a, b, count if b > a else 1) for a, b in box.T]
    points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, 3)
    lon, lat = projection.lonlat(points)
    finite = np.isfinite(lon) & np.isfinite(lat)
    return lon[finite], lat[finite]


def _grid_lines(
    lon: Floats, lat: Floats, steps: tuple[float, float], kind: int
) -> tuple[Floats, Bools]:
    """Return meridians (0) or parallels (1) around places, and which points are joined."""
    order = slice(None, None, 1 - 2 * kind)
    degrees, along = (lon, lat)[order]
    step = steps[kind]
    length = steps[1 - kind]
    cells = np.unique(np.floor(degrees / step).astype(int))
    values = np.union1d(cells, cells + 1) * step
    values = values[(values < 180) if kind == 0 else (np.abs(values) < 90)]
    pieces = max(math.ceil(length / LONGEST_PIECE), FEWEST_PIECES)
    cells = np.unique(np.floor(along / length).astype(int)) * pieces
    marks = np.unique(cells[:, None] + np.arange(pieces + 1))
    places = marks / pieces * length
    if kind == 0:
        places = np.clip(places, -90, 90)
    joined = np.append(np.diff(marks) == 1, False)
    grid = np.stack(np.meshgrid(values, places, indexing="ij"), axis=-1)[..., order]
    return grid.reshape(-1, 2), np.tile(joined, len(values))


def _mapped(projection: Projection, lonlat: Floats, joined: Bools, box: Floats | None) -> MapLines:
    """Project lines, cut where the map is torn, in a box; ``joined`` marks joined points."""
    first, last, place = _pieces(lonlat, joined)
    torn, *sides = tears(projection, first, last)
    ends = first[torn], last[torn]
    before = between(*ends, sides[0], straight=False)
    after = between(*ends, sides[1], straight=False)
    # Both parts of a torn piece follow each other, and are joined to pieces that are not torn.
    gap = np.full(int(torn.sum()), np.nan)
    (left, right) = place[~torn].T
    (torn_left, torn_right) = place[torn].T
    order = np.argsort(np.concatenate([left, torn_left, torn_left]), kind="stable")
    first = np.concatenate([first[~torn], first[torn], after])
    last = np.concatenate([last[~torn], before, last[torn]])
    left = np.concatenate([left, torn_left, gap])
    right = np.concatenate([right, gap, torn_right])
    first = first[order]
    last = last[order]
    left = left[order]
    right = right[order]
    starts = projection.positions(*first.T)
    stops = projection.positions(*last.T)
    begin = Projection(GLOBE).positions(*first.T)
    end = Projection(GLOBE).positions(*last.T)
    length = np.linalg.norm(stops - starts, axis=1)
    true = np.linalg.norm(end - begin, axis=1)
    keep = length <= MOST_STRETCHED * true
    if box is not None:
        outside = ((starts < box[0]) & (stops < box[0])) | ((starts > box[1]) & (stops > box[1]))
        keep &= ~outside.any(axis=1)
    return _assembled(starts[keep], stops[keep], left[keep], right[keep])


def _pieces(lonlat: Floats, joined: Bools) -> tuple[Floats, Floats, Floats]:
    """Return both ends of short pieces of lines, (N, 2) each, and their places along lines."""
    index = np.flatnonzero(joined)
    start = lonlat[index]
    steps = lonlat[index + 1] - lonlat[index]
    steps[:, 0] = (steps[:, 0] + 180) % 360 - 180
    counts = np.maximum(np.ceil(np.abs(steps).max(axis=1) / LONGEST_PIECE).astype(int), 1)
    segment = np.repeat(np.arange(len(index)), counts)
    number = np.arange(len(segment)) - np.repeat(np.cumsum(counts) - counts, counts)
    part = np.stack([number, number + 1], axis=1) / counts[segment, None]
    first = start[segment] + steps[segment] * part[:, 0, None]
    last = start[segment] + steps[segment] * part[:, 1, None]
    return first, last, index[segment, None] + part


def tears(
    projection: Projection, first: Floats, last: Floats, *, straight: bool = False
) -> tuple[Bools, Floats, Floats]:
    """Find the pieces between longitudes and latitudes, (N, 2), that a map tears apart.

    A piece leads the shorter way around the Earth, or is ``straight`` as a great circle. Returns
    which pieces are torn, (N,), with ends on opposite sides of a map or one end outside it, and of
    these the shares just before and just after the tear, (T,).
    """
    place = partial(between, straight=straight)
    start = projection.positions(*place(first, last, np.full(len(first), 0.0)).T)
    middle = projection.positions(*place(first, last, np.full(len(first), 0.5)).T)
    stop = projection.positions(*place(first, last, np.full(len(first), 1.0)).T)
    length = np.linalg.norm(stop - start, axis=1)
    bend = np.linalg.norm(middle - (start + stop) / 2, axis=1)
    missing = np.isnan([start[:, 0], stop[:, 0]])
    torn = ~missing.all(axis=0) & ~(bend <= BENT * length)
    first = first[torn]
    last = last[torn]
    length = length[torn]
    bend = bend[torn]
    a = start[torn]
    b = stop[torn]
    low = np.zeros(len(first))
    high = np.ones(len(first))
    for _ in range(HALVINGS):
        half = (low + high) / 2
        m = projection.positions(*place(first, last, half).T)
        missing = np.isnan([a[:, 0], m[:, 0], b[:, 0]])
        to_low = np.linalg.norm(m - a, axis=1)
        to_high = np.linalg.norm(m - b, axis=1)
        is_low = np.where(missing.any(axis=0), missing[1] == missing[0], to_low < to_high)
        low = np.where(is_low, half, low)
        high = np.where(is_low, high, half)
        a = np.where(is_low[:, None], m, a)
        b = np.where(is_low[:, None], b, m)
    wide = ~(np.linalg.norm(b - a, axis=1) <= LEAST_TEAR * length) | (bend > MOST_BENT * length)
    torn[torn] = wide
    return torn, low[wide], high[wide]


def between(first: Floats, last: Floats, share: Floats, *, straight: bool) -> Floats:
    """Return places (N, 2) at shares, (N,), of pieces as in :func:`tears`."""
    share = share[:, None]
    if straight:
        globe = Projection(GLOBE)
        one = globe.positions(*first.T)
        other = globe.positions(*last.T)
        place = np.stack(globe.lonlat((1 - share) * one + share * other), axis=-1)
    else:
        steps = last - first
        steps[:, 0] = (steps[:, 0] + 180) % 360 - 180
        place = first + share * steps
    # The ends themselves may lie on a meridian where a map is torn.
    return np.where(share == 0, first, np.where(share == 1, last, place))


def _assembled(starts: Floats, stops: Floats, left: AnyArray, right: AnyArray) -> MapLines:
    """Join successive pieces, of which ``right`` of one is ``left`` of the next."""
    new = np.append(True, right[:-1] != left[1:])[: len(starts)]
    at = np.arange(len(starts)) + np.cumsum(new) - 1
    points = np.empty((len(starts) + int(new.sum()), 3))
    points[at + 1] = stops
    points[at] = starts
    return MapLines(points, np.append(at[new], len(points)))
