"""Places of the values of a variable: longitude and latitude, or positions in a plane."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.extras import import_extra
from flowtex.errors import FieldError
from flowtex.field.earth import GLOBE, Projection
from flowtex.sources.inspection.limits import values_in

if TYPE_CHECKING:
    import xarray as xr

LONGITUDE = re.compile(
    r"^(nav_lon|(.*_)?lon(gitude)?(_\w+)?|lon[a-z]?|xlong.*|glam\w?|geolon\w*|[tu]long|xc|xg)$",
    re.I,
)
LATITUDE = re.compile(
    r"^(nav_lat|(.*_)?lat(itude)?(_\w+)?|lat[a-z]?|xlat.*|gphi\w?|geolat\w*|[tu]lat|yc|yg)$", re.I
)
ACROSS = re.compile(r"^(x|x_?c|x_?g|x_\w+|xp1|rlon|projection_x_coordinate)$", re.I)
UPWARD = re.compile(r"^(y|y_?c|y_?g|y_\w+|yp1|rlat|projection_y_coordinate)$", re.I)
DEGREES = re.compile(r"^degrees?(_?[NSEW]|_?(north|east))?$", re.I)
#: Units of length, in metres.
LENGTHS = {"m": 1.0, "meter": 1.0, "metre": 1.0, "meters": 1.0, "metres": 1.0, "km": 1000.0}
LENGTHS |= {"kilometer": 1000.0, "kilometre": 1000.0, "kilometers": 1000.0, "kilometres": 1000.0}
#: Letters for the place in a cell of a staggered grid: its middle first.
MIDDLES = ("rho", "t", "c", "r", "")


@dataclass(frozen=True)
class Places:
    """Positions of nodes, (J, I) each."""

    a: Floats  #: Longitude and latitude in degrees on the Earth, else x and y.
    b: Floats
    is_earth: bool
    #: Whether a depends only on the column and b only on the row: views of :attr:`lines`.
    is_line: bool
    why: str  #: Names of the coordinates.
    unit: str = ""  #: Unit of x and y.

    @property
    def lines(self) -> tuple[Floats, Floats]:
        """Values of a in the columns, (I,), and of b in the rows, (J,), where these are lines."""
        return self.a[0], self.b[:, 0]

    @property
    def on_sphere(self) -> Floats:
        """Positions of longitudes and latitudes on the globe, (J, I, 3)."""
        return Projection(GLOBE).positions(self.a, self.b)

    def turned(self, ahead: tuple[int, int], u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return components on the Earth, or along x and y, of those along rows and columns."""
        p = self.on_sphere if self.is_earth else np.stack([self.a, self.b], axis=-1)
        along_j, along_i = (sign * _directions(p, axis) for axis, sign in enumerate(ahead))
        vector = u[..., None] * along_i + v[..., None] * along_j
        if self.is_earth:
            return Projection(GLOBE).components(self.a, self.b, vector)
        return vector[..., 0], vector[..., 1]


def find_places(
    array: xr.DataArray, dims: tuple[str, ...], datasets: Sequence[xr.Dataset]
) -> Places:
    """Return the places of values, by their coordinates, or by those of other datasets."""
    shape = tuple(_size(d, array, datasets) for d in dims)
    for lon, lat in _pairs(array, dims, datasets, (LONGITUDE, LATITUDE), ("longitude", "latitude")):
        a, b = _at_nodes(lon, lat, dims, shape)
        if a is None or b is None:
            continue
        if not _is_lonlat(a, b, lon, lat):
            continue
        unset = (a == 0) & (b == 0) if lon.ndim > 1 else np.False_
        if unset.sum() > 1:  # where a model leaves out land
            a, b = np.where(unset, np.nan, a), np.where(unset, np.nan, b)
        return Places(
            *_over_nodes(_longitudes(a, str(lon.name)), b),
            is_earth=True,
            is_line=lon.ndim == 1,
            why=f"{lon.name} and {lat.name}",
        )
    for x, y in _pairs(array, dims, datasets, (ACROSS, UPWARD), ("X", "Y")):
        a, b = _at_nodes(x, y, dims, shape)
        if a is None or b is None:
            continue
        return _plane(array, x, y, a, b, datasets)
    names = sorted({str(n) for n in array.coords} | {str(n) for ds in datasets for n in ds.coords})
    msg = (
        f"{array.name!r} with the dimensions {', '.join(dims)} has neither longitude and latitude "
        f"nor x and y; the coordinates are {', '.join(names) or 'none'}. Add them, as in "
        f"ds.assign_coords(lon=({dims!r}, ...), lat=({dims!r}, ...)), or open the file that has "
        "them together with this one"
    )
    raise FieldError(msg)


def _directions(p: Floats, axis: int) -> Floats:
    """Return unit differences of positions along an axis, one-sided beside unknown ones."""
    p = np.swapaxes(p, 0, axis)
    ahead, behind = np.full_like(p, np.nan), np.full_like(p, np.nan)
    behind[1:] = ahead[:-1] = p[1:] - p[:-1]
    both = np.where(np.isnan(ahead), behind, np.where(np.isnan(behind), ahead, ahead + behind))
    length = np.linalg.norm(both, axis=-1, keepdims=True)
    return np.swapaxes(both / np.where(length > 0, length, 1.0), 0, axis)


def _size(dim: str, array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> int:
    if dim in array.sizes:
        return int(array.sizes[dim])
    for ds in datasets:
        if dim in ds.sizes:
            return int(ds.sizes[dim])
    msg = (
        f"{array.name!r} has the dimensions {', '.join(map(str, array.dims))}; expected {dim!r} "
        "among them, as in the velocity; open only files of one model"
    )
    raise FieldError(msg)


def _pairs(
    array: xr.DataArray,
    dims: tuple[str, ...],
    datasets: Sequence[xr.Dataset],
    patterns: tuple[re.Pattern[str], re.Pattern[str]],
    words: tuple[str, str],
) -> Iterator[tuple[xr.DataArray, xr.DataArray]]:
    """Yield pairs of possible coordinates, the likely ones first."""
    candidates: list[list[xr.DataArray]] = [[], []]
    for coordinates, pattern, word in zip(candidates, patterns, words, strict=True):
        declared = (*array.cf.coordinates.get(word, ()), *array.cf.axes.get(word, ()))
        coordinates += [array.coords[name] for name in declared if name in array.coords]
        coordinates += [c for c in array.coords.values() if pattern.match(str(c.name))]
        for ds in datasets:
            of_dataset = (*ds.cf.coordinates.get(word, ()), *ds.cf.standard_names.get(word, ()))
            coordinates += [ds[name] for name in of_dataset if name in ds.variables]
            coordinates += [ds[n] for n in ds.variables if pattern.match(str(n))]
    # Those in the middle of cells come before those on their sides.
    firsts = {id(c): n for n, c in enumerate(candidates[0])}

    def order(c: xr.DataArray) -> tuple[int, int]:
        letter = re.sub(r".*(lon|long|lam|x)_?", "", str(c.name).lower())
        middle = MIDDLES.index(letter) if letter in MIDDLES else len(MIDDLES)
        return (0 if set(c.dims) <= set(dims) else 1, middle if c.ndim > 1 else -1)

    for a in sorted(candidates[0], key=lambda c: (order(c), firsts[id(c)])):
        partners = _partner_names(str(a.name))
        for b in sorted(candidates[1], key=lambda c: str(c.name).lower() not in partners):
            if a.ndim == b.ndim and str(b.name).lower() in partners:
                yield a, b


def _partner_names(name: str) -> set[str]:
    """Return the names that the second coordinate may have, by that of the first."""
    low = name.lower()
    swaps = (("lon", "lat"), ("long", "lat"), ("lam", "phi"), ("x", "y"), ("xi", "eta"))
    return {low.replace(a, b) for a, b in swaps if a in low}


def _at_nodes(
    a: xr.DataArray, b: xr.DataArray, dims: tuple[str, ...], shape: tuple[int, ...]
) -> tuple[Floats | None, Floats | None]:
    """Return two coordinates at the nodes, of lines (1, I) and (J, 1); none for other nodes."""
    if a.ndim == 1 and b.ndim == 1:
        if a.dims == b.dims:
            msg = (
                f"{a.name} and {b.name} both lie along {a.dims[0]}: the values are on an "
                "unstructured mesh with unknown faces, or at stations. Open the file of the "
                "mesh, with the nodes of each face, together with this one"
            )
            raise FieldError(msg)
        if a.dims != (dims[1],) or b.dims != (dims[0],):
            return None, None
        return _numbers(a)[None], _numbers(b)[:, None]
    flat = []
    for c in (a, b):
        # Some files repeat them for every time.
        other = {d: 0 for d in c.dims if c.sizes[d] == 1 or str(d).lower().startswith("t")}
        other = {d: n for d, n in other.items() if d not in dims}
        c = c.isel(other)
        if c.ndim != 2:
            return None, None
        if set(c.dims) == set(dims):
            c = c.transpose(*dims)
        if c.shape != shape:
            return None, None
        flat.append(_numbers(c))
    return flat[0], flat[1]


def _numbers(c: xr.DataArray) -> Floats:
    if c.dtype.kind not in "fiu":
        msg = f"the coordinate {c.name!r} has type {c.dtype}; expected numbers"
        raise FieldError(msg)
    return np.asarray(values_in(c), dtype=float)


def _is_lonlat(a: Floats, b: Floats, lon: xr.DataArray, lat: xr.DataArray) -> bool:
    """Return whether coordinates are degrees; a name such as XC alone is not sufficient."""
    units = [str(c.attrs.get("units", "")) for c in (lon, lat)]
    is_declared = all(DEGREES.match(u) for u in units) or all(
        "lon" in str(c.attrs.get("standard_name", c.name)).lower()
        or "lat" in str(c.attrs.get("standard_name", c.name)).lower()
        or re.match("glam|gphi", str(c.name))
        for c in (lon, lat)
    )
    if not is_declared:
        return False
    with np.errstate(invalid="ignore"):
        far = np.nanmax(np.abs(b), initial=0.0)
        wide = np.nanmax(np.abs(a), initial=0.0)
    # A line has values of one coordinate only.
    finite = np.isfinite(a), np.isfinite(b)
    usable = (finite[0] & finite[1]).any() if lon.ndim > 1 else all(f.any() for f in finite)
    if not usable:
        msg = f"{lon.name} and {lat.name} are NaN everywhere; expected positions of the nodes"
        raise FieldError(msg)
    if far > 90.001 or wide > 720:
        if all(DEGREES.match(u) for u in units):
            msg = (
                f"{lat.name} reaches {far:g} and {lon.name} reaches {wide:g} in magnitude; "
                "expected degrees, up to 90 and 360"
            )
            raise FieldError(msg)
        return False
    return True


def _longitudes(lon: Floats, name: str) -> Floats:
    """Return longitudes without jumps along a row; those of a line must be sorted."""
    if not (np.ptp(lon, axis=0) == 0).all():  # as on a curvilinear grid
        return lon
    line = np.unwrap(lon[0], period=360.0)
    steps = np.diff(line)
    if not ((steps > 0).all() or (steps < 0).all()):
        msg = (
            f"{name} increases and decreases along its axis; expected longitudes in one "
            f"direction. Sort them, as in ds.sortby({name!r})"
        )
        raise FieldError(msg)
    return np.broadcast_to(line, lon.shape)


def _over_nodes(a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """Return coordinates (J, I), of lines (1, I) and (J, 1) as views of these."""
    shape = np.broadcast_shapes(a.shape, b.shape)
    return np.broadcast_to(a, shape), np.broadcast_to(b, shape)


def _plane(
    array: xr.DataArray,
    x: xr.DataArray,
    y: xr.DataArray,
    a: Floats,
    b: Floats,
    datasets: Sequence[xr.Dataset],
) -> Places:
    """Return positions in a plane, or on the Earth if the grid mapping gives them."""
    units = [str(c.attrs.get("units", "")).strip() for c in (x, y)]
    why = f"{x.name} and {y.name}"
    crs = _mapping(array, datasets)
    if crs is not None:
        a, b = _over_nodes(a, b)
        pyproj = import_extra("pyproj", "xarray")
        source = pyproj.CRS.from_cf(crs)
        geodetic = pyproj.CRS.from_user_input(source.geodetic_crs or 4326)
        if source.is_projected:
            factor = LENGTHS.get(units[0].lower(), 1.0)
            change = pyproj.Transformer.from_crs(source, geodetic, always_xy=True)
            lon, lat = change.transform(a * factor, b * factor, errcheck=False)
        else:
            base = pyproj.CRS.from_user_input("+proj=longlat +R=6371000 +type=crs")
            change = pyproj.Transformer.from_crs(source, base, always_xy=True)
            lon, lat = change.transform(a, b)
        bad = ~(np.isfinite(lon) & np.isfinite(lat))
        places = np.where(bad, np.nan, lon), np.where(bad, np.nan, lat)
        words = f"{why} by {crs.get('grid_mapping_name', 'its CRS')}"
        return Places(*places, is_earth=True, is_line=False, why=words)
    unit = "m" if units[0].lower() in LENGTHS else units[0]
    factor = LENGTHS.get(units[0].lower(), 1.0)
    places = _over_nodes(a * factor, b * factor)
    return Places(*places, is_earth=False, is_line=x.ndim == 1, why=why, unit=unit)


def _mapping(array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> dict[str, Any] | None:
    """Return the attributes of the grid mapping of a variable."""
    name = array.attrs.get("grid_mapping", array.encoding.get("grid_mapping"))
    for ds in datasets:
        if name in ds.variables:
            attrs = dict(ds[name].attrs)
            return attrs if {"grid_mapping_name", "crs_wkt"} & set(attrs) else None
    return None
