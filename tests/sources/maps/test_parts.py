"""What is drawn on a map is what the data have there: nothing in gaps, and all up to its tears."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pyproj
import pytest
import xarray as xr
from earth_data import DEGREES, components

from flowtex import FlowField
from flowtex._util.array_types import Bools, Floats
from flowtex.field.earth import EARTH_RADIUS

#: Maps that flowtex names, maps of PROJ as cartopy's axes have them, and their tears.
MAPS = {
    "platecarree": "",
    "robinson": "",
    "north": "",
    "lambert": "",
    "PlateCarree(0)": "+proj=eqc +lon_0=0",
    "PlateCarree(180)": "+proj=eqc +lon_0=180",
    "Robinson(0)": "+proj=robin +lon_0=0",
    "Robinson(150)": "+proj=robin +lon_0=150",
    "Mercator(0)": "+proj=merc +lon_0=0",
    "EPSG:3857": "EPSG:3857",
    "Mollweide(-20)": "+proj=moll +lon_0=-20",
    "InterruptedGoodeHomolosine": "+proj=igh +lon_0=0",
    "InterruptedGoodeHomolosine(-160)": "+proj=igh +lon_0=-160",
    "NorthPolarStereo": "+proj=stere +lat_0=90 +lon_0=0",
    "SouthPolarStereo": "+proj=stere +lat_0=-90 +lon_0=30",
    "Orthographic": "+proj=ortho +lat_0=20 +lon_0=160",
    "LambertAzimuthal": "+proj=laea +lat_0=-30 +lon_0=40",
    "AlbersEqualArea": "+proj=aea +lat_1=20 +lat_2=50 +lon_0=100",
    "TransverseMercator": "+proj=tmerc +lon_0=10",
    "RotatedPole": "+proj=ob_tran +o_proj=eqc +o_lon_p=0 +o_lat_p=37.5 +lon_0=357.5",
}


class Region(NamedTuple):
    """Data, and where they lie: a depth in degrees of places, negative outside."""

    dataset: xr.Dataset
    depth: Callable[[Floats, Floats], Floats]
    cell: float


def dataset(lon: Floats, lat: Floats) -> xr.Dataset:
    """The rotation on lines, or at places (J, I)."""
    dims: Any = [("lat",), ("lon",)] if lon.ndim == 1 else [("y", "x")] * 2
    at = np.meshgrid(lon, lat) if lon.ndim == 1 else (lon, lat)
    names = ("eastward_wind", "northward_wind")
    values = {
        key: (("lat", "lon") if lon.ndim == 1 else ("y", "x"), part, {"standard_name": name, "units": "m s-1"})
        for key, name, part in zip("uv", names, components(*at), strict=True)
    }
    return xr.Dataset(values, {"lat": (dims[0], lat, DEGREES["lat"]), "lon": (dims[1], lon, DEGREES["lon"])})


def box(lon: Floats, lat: Floats, *, west: float, east: float, gap: Any = None) -> Region:
    def depth(a: Floats, b: Floats) -> Floats:
        beyond = (a - (west + east) / 2 + 180) % 360 - 180
        inside = 400.0 if east - west >= 360 else (east - west) / 2 - np.abs(beyond)
        # A degree of longitude is short near a pole.
        least = np.minimum(inside * np.cos(np.radians(b)), np.minimum(b - lat.min(), lat.max() - b))
        if lat.max() > 89.9:
            least = np.minimum(inside * np.cos(np.radians(b)), b - lat.min())
        if lat.min() < -89.9:
            least = np.minimum(inside * np.cos(np.radians(b)), lat.max() - b) if lat.max() <= 89.9 else inside * np.cos(np.radians(b))
        if gap is not None:
            least = np.minimum(least, gap(a, b))
        return least

    return Region(dataset(lon, lat), depth, abs(float(np.median(np.diff(lat)))))


def turned(lon: Floats, lat: Floats, pole: tuple[float, float]) -> tuple[Floats, Floats]:
    """Longitude and latitude of places on a sphere whose pole lies elsewhere."""
    change = pyproj.Transformer.from_crs(
        f"+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p={pole[1]} +lon_0={pole[0]} +R=6371000",
        "+proj=longlat +R=6371000", always_xy=True)
    return change.transform(lon, lat)


def rotated(lon: Floats, lat: Floats, pole: tuple[float, float]) -> Region:
    """A regional grid on lines of a sphere that is turned."""
    a, b = np.meshgrid(lon, lat)
    places = turned(a, b, pole)
    back = pyproj.Transformer.from_crs(
        f"+proj=ob_tran +o_proj=longlat +o_lon_p=0 +o_lat_p={pole[1]} +lon_0={pole[0]} +R=6371000",
        "+proj=longlat +R=6371000", always_xy=True)

    def depth(p: Floats, q: Floats) -> Floats:
        x, y = back.transform(p, q, direction="INVERSE")
        middle = (lon.min() + lon.max()) / 2
        across = np.ptp(lon) / 2 - np.abs((x - middle + 180) % 360 - 180)
        if np.ptp(lon) > 350:
            across = np.full_like(y, 400.0)
        return np.minimum(across * np.cos(np.radians(y)), np.minimum(y - lat.min(), lat.max() - y))

    return Region(dataset(*places), depth, float(np.diff(lat)[0]))


LAT = np.arange(-60.0, 61.0, 3.0)
REGIONS = {
    "pacific": lambda: box(np.arange(120.0, 241.0, 3.0), LAT, west=120, east=240),
    "pacific, -180 to 180": lambda: box(
        (np.arange(120.0, 241.0, 3.0) + 180) % 360 - 180, LAT, west=120, east=240
    ),
    "pacific, between nodes": lambda: box(np.arange(121.0, 240.0, 3.0), LAT[::-1], west=121, east=238),
    "atlantic": lambda: box(np.arange(-80.0, 20.0, 3.0), LAT, west=-80, east=19),
    "polar cap": lambda: box(np.arange(0.0, 360.0, 6.0), np.arange(60.0, 91.0, 3.0), west=0, east=360),
    "sector at the pole": lambda: box(np.arange(130.0, 221.0, 5.0), np.arange(60.0, 91.0, 3.0), west=130, east=220),
    "ring sector": lambda: box(np.arange(-60.0, 241.0, 5.0), np.arange(50.0, 81.0, 3.0), west=-60, east=240),
    "band": lambda: box(np.arange(2.0, 360.0, 4.0), np.arange(-24.0, 25.0, 3.0), west=0, east=360),
    "south": lambda: box(np.arange(-180.0, 180.0, 5.0), np.arange(-90.0, -29.0, 3.0), west=0, east=360),
    "earth 0 to 360": lambda: box(np.arange(0.0, 360.0, 4.0), np.arange(-88.0, 89.0, 4.0), west=0, east=360),
    "earth, repeated": lambda: box(np.arange(0.0, 361.0, 4.0), np.arange(-90.0, 91.0, 4.0), west=0, east=360),
    "earth -180 to 180": lambda: box(np.arange(-179.0, 180.0, 4.0), np.arange(-88.0, 89.0, 4.0), west=0, east=360),
    "gap in longitude": lambda: box(
        np.concatenate([np.arange(0.0, 100.0, 4.0), np.arange(140.0, 360.0, 4.0)]), LAT, west=0, east=360,
        gap=lambda a, b: (np.abs((a - 118 + 180) % 360 - 180) - 22) * np.cos(np.radians(b)),
    ),
    "gap in latitude": lambda: box(
        np.arange(0.0, 360.0, 4.0), np.concatenate([np.arange(-60.0, -20.0, 3.0), np.arange(0.0, 61.0, 3.0)]), west=0, east=360,
        gap=lambda a, b: np.abs(b + 10.5) - 10.5,
    ),
    "rotated region": lambda: rotated(np.arange(-30.0, 31.0, 3.0), np.arange(-30.0, 31.0, 3.0), (170.0, 40.0)),
    "whole Earth, other poles": lambda: rotated(np.arange(-180.0, 181.0, 4.0), np.arange(-84.0, 85.0, 4.0), (30.0, 60.0)),
    "whole Earth, open": lambda: rotated(np.arange(-180.0, 177.0, 4.0), np.arange(-84.0, 85.0, 4.0), (30.0, 60.0)),
}


def triangles_of(field: FlowField) -> tuple[Floats, Floats]:
    """Positions and vectors (N, 3, 2) at corners of what is drawn."""
    points, velocity = np.asarray(field.points)[..., :2], np.asarray(field.velocity[0])[..., :2]
    if field.triangles is not None:
        return points.reshape(-1, 2)[field.triangles], velocity.reshape(-1, 2)[field.triangles]
    j, i = np.nonzero(field.surface.cells)
    corners = [(j, i), (j, i + 1), (j + 1, i + 1), (j + 1, i)]
    return tuple(
        np.concatenate([np.stack([a[corners[k]] for k in three], axis=1) for three in ((0, 1, 2), (0, 2, 3))])
        for a in (points, velocity)
    )  # type: ignore[return-value]


def drawn_at(corners: Floats, velocity: Floats, places: Floats) -> tuple[Bools, Floats]:
    """Whether places (P, 2) are drawn, and the vectors there, NaN elsewhere."""
    a, b, c = np.moveaxis(corners, 1, 0)
    found, vectors = np.zeros(len(places), bool), np.full((len(places), 2), np.nan)
    det = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    low, high = corners.min(axis=1), corners.max(axis=1)
    for n, p in enumerate(places):
        near = np.flatnonzero(((low <= p) & (p <= high)).all(axis=1) & (det != 0))
        d, u, w = p - a[near], b[near] - a[near], c[near] - a[near]
        s = (d[:, 0] * w[:, 1] - d[:, 1] * w[:, 0]) / det[near]
        t = (u[:, 0] * d[:, 1] - u[:, 1] * d[:, 0]) / det[near]
        inside = np.flatnonzero((s >= 0) & (t >= 0) & (s + t <= 1))
        if len(inside):
            k = inside[0]
            found[n] = True
            vectors[n] = np.array([1 - s[k] - t[k], s[k], t[k]]) @ velocity[near[k]]
    return found, vectors


def check(field: FlowField, region: Region, count: int = 400) -> dict[str, Any]:
    """Compare what is drawn with PROJ, at random places of the map."""
    projection = field.projection
    assert projection is not None
    change = pyproj.Transformer.from_crs(projection._crs.geodetic_crs, projection._crs, always_xy=True)
    shift = projection._origin

    def forward(lon: Floats, lat: Floats) -> Floats:
        lon = (np.asarray(lon) - shift + 180) % 360 - 180 if shift else lon
        return np.stack(change.transform(lon, lat, errcheck=False), axis=-1)

    rng = np.random.default_rng(1)
    corners, velocity = triangles_of(field)
    # Places all over the box of the map, not only of the data.
    lon, lat = rng.uniform(-180, 180, 4000), np.degrees(np.arcsin(rng.uniform(-1, 1, 4000)))
    all_ = forward(lon, lat)
    all_ = all_[np.isfinite(all_).all(axis=1)]
    finite = np.abs(all_).max(axis=1) < 3e7
    low, high = all_[finite].min(axis=0), all_[finite].max(axis=0)
    places = np.concatenate([rng.uniform(low, high, (count, 2)), all_[finite][:count]])
    x, y = places.T
    a, b = change.transform(x, y, direction="INVERSE", errcheck=False)
    a, b = np.asarray(a) + shift, np.asarray(b)
    again = forward(a, b)
    on_map = np.isfinite(a) & (np.abs(again - places).max(axis=1) < 1e-3 * np.ptp(places))
    depth = np.where(on_map, region.depth(np.where(on_map, a, 0), np.where(on_map, b, 0)), -999)
    found, vectors = drawn_at(corners, velocity, places)
    outside = found & (depth < -0.05 * region.cell)
    missing = ~found & (depth > 1.1 * region.cell)
    # Where a particle goes in a short time, as PROJ has it.
    east, north = components(a, b)
    step = 1e-3 / np.hypot(east, north)
    ends = forward(a + step * east / np.cos(np.radians(b)), b + step * north)
    starts = forward(a - step * east / np.cos(np.radians(b)), b - step * north)
    ahead, back = ends - places, places - starts
    smooth = np.linalg.norm(ahead - back, axis=1) < 0.05 * np.linalg.norm(ahead, axis=1)
    good = found & (depth > 0) & smooth
    way = (ahead + back)[good]
    turn = np.degrees(np.abs(np.angle((way[:, 0] + 1j * way[:, 1]) / (vectors[good, 0] + 1j * vectors[good, 1]))))
    return dict(outside=np.c_[a, b, depth][outside], missing=np.c_[a, b, depth][missing], turn=turn, where=np.c_[a, b][good], found=found.sum())
