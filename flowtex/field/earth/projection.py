"""A globe, and flat maps: positions from longitude and latitude, and vectors from east and north.

A vector is mapped by the derivatives of the projection, so that a particle which moves on the
Earth moves along the map of its path; on a globe directions and lengths are those of the Earth.
"""

from __future__ import annotations

import math
import re
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, partial
from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import brief
from flowtex._util.array_types import Bools, Floats
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
#: What an error expects of a projection.
EXPECTED = (
    f"one of {', '.join((GLOBE, *NAMES))}, or a PROJ string of one in metres, such as 'EPSG:3413' "
    "or '+proj=laea +lat_0=52 +lon_0=10'"
)
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
#: Ratio of the scales of a map along two directions beyond which it tears a point open.
MOST_SHEARED = 1e3
#: The same within POLAR degrees of a pole that a map draws as a line, where directions are exact.
MOST_SHEARED_AT_LINE = 1e9
POLAR = 2.0
#: Difference of two steps along a parallel, as a share of both, up to which it is a line.
STRAIGHT = 1e-4


def map_name(wanted: Any) -> str:
    """Return the name or the PROJ definition of a map, as :class:`Projection` takes it.

    Parameters
    ----------
    wanted
        A name in any case, a PROJ definition, an EPSG code, or a projection of pyproj or cartopy.

    Raises
    ------
    FieldError
        When it is something else.

    Examples
    --------
    >>> from flowtex.field.earth.projection import map_name
    >>> map_name("Robinson"), map_name(3413)
    ('robinson', 'EPSG:3413')
    """
    if isinstance(wanted, str):
        name = wanted.strip()
        if name.isdecimal():
            return f"EPSG:{name}"
        if name.lower() in (GLOBE, *NAMES):
            return name.lower()
        return name
    if isinstance(wanted, Integral) and not isinstance(wanted, bool):
        return f"EPSG:{wanted}"
    if is_cartopy(wanted):
        return cartopy_map(wanted)
    if hasattr(wanted, "to_wkt"):  # pyproj's, and what rasterio and geopandas return
        pyproj = import_extra("pyproj", "xarray")
        return str(pyproj.CRS.from_user_input(wanted).to_string())
    raise FieldError(f"projection is {brief(wanted)}; expected {EXPECTED}")


def is_cartopy(projection: Any) -> bool:
    """Return whether a projection is one of cartopy."""
    return hasattr(projection, "proj4_init")


def cartopy_map(projection: Any) -> str:
    """Return the PROJ definition of a projection of cartopy; one in degrees is taken in metres."""
    text = str(projection.proj4_init)
    if projection.is_projected:
        return text
    middle = re.search(r"\+pm=(\S+)", text)
    text = re.sub(r"\+(pm|a|ellps|to_meter)=\S+ ?", "", text)
    text = re.sub(r"proj=lat ?long?|proj=longlat", "proj=eqc", text)
    if middle:
        text += f" +lon_0={middle[1]}"
    return f"{text} +R={EARTH_RADIUS:.12g}"


def as_projection(wanted: Any) -> Projection | None:
    """Return a projection as it is, or of a map as :func:`map_name` takes it; ``None`` of none."""
    if wanted is None or isinstance(wanted, Projection):
        return wanted
    return Projection(map_name(wanted))


def _fault_of(crs: CRS) -> str:
    """Return why a coordinate system of PROJ is no map in metres; empty if it is one."""
    if not crs.is_projected:
        return "in degrees"
    for axis in crs.axis_info[:2]:
        if axis.unit_conversion_factor != 1.0:
            return f"in units of {axis.unit_name}"
    return ""


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
    >>> from flowtex.field.earth.projection import Projection
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
        for parameter in self._operation.params:
            if parameter.name.startswith(("Longitude of", "lon_0")):
                return float(parameter.value)
        return None

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
        fault = "unknown"
        with suppress(pyproj.exceptions.ProjError):
            crs: CRS = pyproj.CRS.from_user_input(text)
            fault = _fault_of(crs)
            if not fault:
                return crs
        raise FieldError(f"the projection {self.name!r} is {fault}; expected {EXPECTED}")

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
        most = np.where(self._is_on_line(lon, lat), MOST_SHEARED_AT_LINE, MOST_SHEARED)
        with np.errstate(invalid="ignore"):
            return np.asarray(longest < most * area)

    def _is_on_line(self, lon: Floats, lat: Floats) -> Bools:
        """Return where a map draws the parallels near a pole as straight lines, (...)."""
        result = np.abs(lat) > 90 - POLAR
        near_lon = lon[result]
        near_lat = lat[result]
        straight = np.zeros(near_lon.shape, dtype=bool)
        for aside in (0, 2 * STEP, -2 * STEP):  # a tear of the map may be nearer than a step
            places = []
            for step in (-STEP, 0, STEP):
                places.append(self.positions(near_lon + aside + step, near_lat))
            backward = places[1] - places[0]
            forward = places[2] - places[1]
            apart = np.linalg.norm(forward - backward, axis=-1)
            size = np.linalg.norm(forward + backward, axis=-1)
            with np.errstate(invalid="ignore"):
                straight |= apart <= STRAIGHT * size
        result[result] = straight
        return np.asarray(result)

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
            inner_lon, inner_lat = inverse(INSIDE * x, INSIDE * y)
            lon = np.where(finite, lon, inner_lon)
            lat = np.where(finite, lat, inner_lat)
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
