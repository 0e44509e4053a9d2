"""Places of the values of a variable: longitude and latitude, or positions in a plane."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError, import_extra
from flowtex.field import units
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.remedies import Remedy
from flowtex.sources.datasets import labels
from flowtex.sources.datasets.axes import (
    LEVEL,
    TIME,
    Drawn,
    axis_kind,
    coordinate_of,
    horizontal_dims,
)
from flowtex.sources.datasets.curved import ANGLES, AZIMUTHS, RADII
from flowtex.sources.notices import Record
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

LONGITUDE = re.compile(
    r"^(nav_lon|(.*_)?lon(gitude)?(_\w+)?|lon[a-z]?|lon(cell|node|vertex|edge)|[cev]lon|xlong.*|glam\w?|geolon\w*|[tu]long|xc|xg)$",
    re.I,
)
LATITUDE = re.compile(
    r"^(nav_lat|(.*_)?lat(itude)?(_\w+)?|lat[a-z]?|lat(cell|node|vertex|edge)|[cev]lat|xlat.*|gphi\w?|geolat\w*|[tu]lat|yc|yg)$",
    re.I,
)
#: Words before the letter of a coordinate, as in ``node_x``, ``FlowElem_xcc`` and ``pos_y``.
OF_POINTS = (
    r"\w*(node|face|elem(ent)?|cell|point|particle|vert(ex)?|cent(er|re|roid)|pos(ition)?|"
    r"coord(inate)?)s?_?{}c{{0,2}}"
)
ACROSS = re.compile(
    rf"^(x|x_?c|x_?g|x_\w+|xp1|rlon|projection_x_coordinate|{OF_POINTS.format('x')})$", re.I
)
UPWARD = re.compile(
    rf"^(y|y_?c|y_?g|y_\w+|yp1|rlat|projection_y_coordinate|{OF_POINTS.format('y')})$", re.I
)
#: Words of long names, and standard names, by the axis of a coordinate in the plane.
DESCRIBED = {
    "X": (re.compile(r"\bx[- ]coordinates?\b", re.I), "projection_x_coordinate"),
    "Y": (re.compile(r"\by[- ]coordinates?\b", re.I), "projection_y_coordinate"),
}
#: Letters for the place in a cell of a staggered grid: its middle first.
MIDDLES = ("rho", "t", "c", "r", "")
#: Parts of the names of two coordinates that belong together.
SWAPS = (
    ("lon", "lat"),
    ("long", "lat"),
    ("lam", "phi"),
    ("x", "y"),
    ("xi", "eta"),
    ("east", "north"),
)
#: Spans of longitude and latitude without a unit that are those of the Earth in radians.
RADIANS = (6.0, 2 * np.pi + 1e-3), (3.0, np.pi + 1e-3)
#: Share of a cell by which positions may move in time, as by rounding.
AT_REST = 1e-3
#: Nodes along each axis whose positions are compared at all times.
FEW_NODES = 5


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
    angle: Floats | None = None  #: Angle of polar coordinates in radians.

    @property
    def lines(self) -> tuple[Floats, Floats]:
        """Values of a in the columns, (I,), and of b in the rows, (J,), where these are lines."""
        return self.a[0], self.b[:, 0]

    @property
    def positions(self) -> Floats:
        """Positions on the globe, (J, I, 3), or in the plane, (J, I, 2)."""
        if self.is_earth:
            return Projection(GLOBE).positions(self.a, self.b)
        return np.stack([self.a, self.b], axis=-1)

    def part(self, at: Any) -> Places:
        """Return the places of some rows and columns."""
        angle = self.angle
        if angle is not None:
            angle = angle[at]
        return replace(self, a=self.a[at], b=self.b[at], angle=angle)

    @property
    def angles(self) -> Floats:
        """Angles around the origin in radians, counterclockwise from x."""
        if self.angle is not None:
            return self.angle
        return np.arctan2(self.b, self.a)

    def is_near(self, other: Places) -> bool:
        """Return whether places are the same up to a hundredth of a degree."""
        if self.a.shape != other.a.shape:
            return False
        turn = (self.a - other.a + 180.0) % 360.0 - 180.0
        return bool(np.nanmax(np.abs(turn)) < 0.01 and np.nanmax(np.abs(self.b - other.b)) < 0.01)

    def turned(self, ahead: tuple[int, int], u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return components on the Earth, or along x and y, of those along rows and columns."""
        p = self.positions
        along_j, along_i = (sign * _directions(p, axis) for axis, sign in enumerate(ahead))
        vector = u[..., None] * along_i + v[..., None] * along_j
        if self.is_earth:
            return Projection(GLOBE).components(self.a, self.b, vector)
        return vector[..., 0], vector[..., 1]


class Beside(NamedTuple):
    """Datasets that belong together, and the selection along the axes of the velocity."""

    datasets: Sequence[xr.Dataset]
    drawn: Drawn
    record: Record


def find_places(
    array: xr.DataArray, dims: tuple[str, ...], beside: Beside, *, any_axes: bool = True
) -> Places:
    """Return the positions of values, from their own coordinates or from other datasets.

    Coordinates with further axes, such as the time of a nest that moves, are selected along these
    axes as the drawn variable is.

    Parameters
    ----------
    array
        The variable.
    dims
        Its dimensions along the surface.
    beside
        All datasets, the selection along further axes, and the record.
    any_axes
        Whether coordinates of the axes serve that are neither longitude and latitude nor x and y.

    Raises
    ------
    FieldError
        When no dataset has positions for these dimensions.
    """
    datasets, drawn, record = beside
    shape = tuple(_size(d, array, datasets) for d in dims)
    found = _on_earth(array, dims, shape, beside)
    if found is not None:
        return found
    for x, y in _pairs(array, dims, datasets, {"X": ACROSS, "Y": UPWARD}):
        if (at := _at_nodes(x, y, dims, shape, drawn)) is not None:
            return _plane(x, y, *at, _mapping(array, datasets))
    cells = _even_cells(array, dims, shape, datasets)
    if cells is not None:
        return cells
    lines = [_own_line(array, d, datasets) for d in dims]
    if any_axes and lines[0] is not None and lines[1] is not None:
        places = _of_lines(lines[1], lines[0])
        if places.angle is None and not any(axis_kind(array, d) in (LEVEL, TIME) for d in dims):
            _record_axes(lines[1], lines[0], record)
        return places
    check_two_of_space(array, dims)
    names = sorted({str(n) for n in array.coords} | {str(n) for ds in datasets for n in ds.coords})
    raise FieldError(
        f"{array.name!r} with the dimensions {', '.join(dims)} has no positions; the coordinates "
        f"are {', '.join(names) or 'none'}. Open the file that has them together with this one, "
        f"or add them, as in ds.assign_coords({dims[0]}=..., {dims[1]}=...)"
    )


def _on_earth(
    array: xr.DataArray, dims: tuple[str, ...], shape: tuple[int, ...], beside: Beside
) -> Places | None:
    """Return places by longitude and latitude; ``None`` without these."""
    datasets, drawn, _ = beside
    found: Places | None = None
    for lon, lat in _pairs(array, dims, datasets, {"longitude": LONGITUDE, "latitude": LATITUDE}):
        if found is not None and lon.ndim > 1:
            continue
        at = _at_nodes(lon, lat, dims, shape, drawn)
        if at is None or (degrees := _in_degrees(*at, lon, lat)) is None:
            continue
        if degrees[1] is not at[1]:
            turned = ", converted from radians"
        else:
            turned = ""
        a, b = degrees
        if _is_one_place(a, b):  # as of an ideal case
            continue
        if min(a.shape) > 1:
            unset = (a == 0) & (b == 0)
        else:
            unset = np.False_
        if unset.sum() > 1:  # where a model leaves out land
            a = np.where(unset, np.nan, a)
            b = np.where(unset, np.nan, b)
        is_line = lon.ndim == 1
        a, b = np.broadcast_arrays(np.unwrap(a, period=360.0) if is_line else a, b)
        why = f"{lon.name} and {lat.name}{turned}"
        places = Places(a, b, is_earth=True, is_line=is_line, why=why)
        if found is None:
            found = places
            if is_line:
                break
        elif is_line and places.is_near(found):
            return places
    return found


def _record_axes(x: xr.DataArray, y: xr.DataArray, record: Record) -> None:
    """Record which of two axes is drawn across, unless their attributes or names tell."""
    if x.attrs.get("axis") == "X" or y.attrs.get("axis") == "Y":
        return
    if ACROSS.match(str(x.name)) or UPWARD.match(str(y.name)):
        return
    text = f"{x.name} is drawn across and {y.name} upward, though their names do not tell"
    exchanged = Remedy("dims", f"{y.name},{x.name}", "to exchange them,")
    record("coordinates", text, exchanged, notable=True)


def check_two_of_space(array: xr.DataArray, dims: tuple[str, ...]) -> None:
    """Check that values are not along time and one axis of space, as of Hovmöller diagrams.

    Raises
    ------
    FieldError
        When they are; the text has the line that draws such a diagram.
    """
    times = [dim for dim in dims if axis_kind(array, dim) == TIME]
    others = [dim for dim in dims if dim not in times]
    if len(times) != 1 or len(others) != 1:
        return
    time = times[0]
    space = others[0]
    raise FieldError(
        f"{array.name!r} has the axes {' and '.join(dims)}, time and one axis of space; expected "
        f"two axes of space. To draw the paths d{space}/d{time} = {array.name} of a Hovmöller "
        f"diagram, pass arrays in units that belong together, and 1 along the time t: "
        f"flowtex.render({space}, t, {array.name}, np.ones_like({array.name}))"
    )


def _is_one_place(a: Floats, b: Floats) -> bool:
    """Return whether all nodes have one longitude and latitude."""
    same = (np.nanmax(c, initial=-np.inf) == np.nanmin(c, initial=np.inf) for c in (a, b))
    return a.size * b.size > 1 and all(same)


def _even_cells(
    array: xr.DataArray,
    dims: tuple[str, ...],
    shape: tuple[int, ...],
    datasets: Sequence[xr.Dataset],
) -> Places | None:
    """Return places on cells whose sizes in m the attributes DX and DY of WRF give."""
    sizes = []
    for ds in datasets:
        if {"DX", "DY"} <= {*ds.attrs}:
            sizes.append(ds.attrs)
    if not sizes or not all(re.match("south_north|west_east", dim) for dim in dims):
        return None
    lines = []
    for dim, count, name in zip(dims, shape, ("DY", "DX"), strict=True):
        if dim.endswith("_stag"):
            side = 0.5
        else:
            side = 0.0
        lines.append((np.arange(count) - side) * float(sizes[0][name]))
    b, a = np.meshgrid(*lines, indexing="ij")
    why = "cells of DX and DY, as longitude and latitude are the same everywhere"
    return Places(a, b, is_earth=False, is_line=True, why=why, unit="m")


def ordered(array: xr.DataArray, record: Record, step: str) -> xr.DataArray:
    """Return a variable whose surface has its rows and columns in the order of their labels.

    Raises
    ------
    FieldError
        When unordered labels repeat a value.
    """
    for dim in horizontal_dims(array):
        line = coordinate_of(array, dim)
        if line is None or line.dtype.kind not in "fiu" or line.size < 3:
            continue
        values = np.asarray(line.values, dtype=float)
        known = np.isfinite(values)
        if known.any() and not known.all():
            text = f"{dim}: {(~known).sum()} of {known.size} values are NaN, and left out"
            record(step, text, notable=True)
            array = array.isel({dim: known})
            values = values[known]
            line = array.coords[dim]
        if units.factor(str(line.attrs.get("units", "")), "degree") and LONGITUDE.match(dim):
            values = np.unwrap(values, period=360.0)
        steps = np.diff(values)
        if (steps > 0).all() or (steps < 0).all() or not known.any():
            continue
        if not _is_degrees(line):
            keys = values
        else:
            around = np.sort(values % 360.0)
            start = around[int(np.argmax(np.diff(around, append=around[0] + 360.0)))]
            keys = (values - start - 1e-9) % 360.0
        order = np.argsort(keys, kind="stable")
        if (np.diff(keys[order]) <= 0).any():
            raise FieldError(
                f"{dim} increases and decreases and repeats values ({labels.text(line.values)}); "
                f"expected each value once, as after ds.drop_duplicates({dim!r})"
            )
        record(step, f"{array.name}: sorted by {dim}", notable=step == "coordinates")
        array = array.isel({dim: order})
    return array


def _directions(p: Floats, axis: int) -> Floats:
    """Return unit differences of positions along an axis, one-sided beside unknown ones."""
    p = np.swapaxes(p, 0, axis)
    sides = np.full((len(p) + 3, *p.shape[1:]), np.nan)  # two before the first node, two after
    sides[2:-2] = p[1:] - p[:-1]
    behind = sides[1:-2]
    ahead = sides[2:-1]
    both = ahead + behind
    both = np.where(np.isnan(ahead), _at_end(behind, sides[:-3]), both)
    both = np.where(np.isnan(behind), _at_end(ahead, sides[3:]), both)
    return np.swapaxes(_unit(both), 0, axis)


def _at_end(near: Floats, far: Floats) -> Floats:
    """Return the direction at the end of a line from its last two sides, which it turns past."""
    near = _unit(near)
    return np.where(np.isnan(far), near, 3 * near - _unit(far))


def _unit(vectors: Floats) -> Floats:
    """Return vectors of length one, or zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(length > 0, length, 1.0))


def _size(dim: str, array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> int:
    if dim in array.sizes:
        return int(array.sizes[dim])
    for ds in datasets:
        if dim in ds.sizes:
            return int(ds.sizes[dim])
    raise FieldError(f"{array.name!r} has the dimensions {array.dims}; expected {dim!r} among them")


def _pairs(
    array: xr.DataArray,
    dims: tuple[str, ...],
    datasets: Sequence[xr.Dataset],
    kinds: Mapping[str, re.Pattern[str]],
) -> Iterator[tuple[xr.DataArray, xr.DataArray]]:
    candidates: list[list[xr.DataArray]] = [[], []]
    # All of them are looked up at each request.
    own = {**array.cf.axes, **array.cf.coordinates}
    others = [(ds, ds.cf.coordinates, ds.cf.standard_names) for ds in datasets]
    for coordinates, (word, pattern) in zip(candidates, kinds.items(), strict=True):
        declared = tuple(own.get(word, ()))
        named = [n for n in (*declared, *array.coords) if n in declared or pattern.match(str(n))]
        coordinates += [array.coords[n] for n in dict.fromkeys(named) if n in array.coords]
        for ds, places, names in others:
            declared = (*places.get(word, ()), *names.get(word, ()))
            named = [n for n in ds.variables if pattern.match(str(n)) or _describes(ds[n], word)]
            coordinates += [ds[n] for n in dict.fromkeys((*declared, *named)) if n in ds.variables]
    # Those in the middle of cells come before those on their sides.
    firsts = {id(c): n for n, c in enumerate(candidates[0])}

    def order(c: xr.DataArray) -> tuple[int, int, int]:
        letter = re.sub(r".*(lon|long|lam|x)_?", "", str(c.name).lower())
        if letter in MIDDLES:
            middle = MIDDLES.index(letter)
        else:
            middle = len(MIDDLES)
        # Positions in two dimensions come before lines that may be mere numbers of the nodes.
        kind = 1 if c.ndim == 1 else 0 if units.parsed(str(c.attrs.get("units", ""))) else 2
        return 0 if set(c.dims) <= set(dims) else 1, kind, middle if c.ndim > 1 else 0

    for a in sorted(candidates[0], key=lambda c: (order(c), firsts[id(c)])):
        name = str(a.name).lower()
        partners = {name.replace(one, other) for one, other in SWAPS if one in name}
        for b in sorted(candidates[1], key=lambda c: str(c.name).lower() not in partners):
            of_axes = a.dims == (dims[1],) and b.dims == (dims[0],)
            if a.ndim == b.ndim and (of_axes or str(b.name).lower() in partners):
                yield a, b


def _describes(c: xr.DataArray, axis: str) -> bool:
    """Return whether attributes say that a variable has x or y, such as "x-coordinate"."""
    if axis not in DESCRIBED:
        return False
    words, name = DESCRIBED[axis]
    is_described = words.search(str(c.attrs.get("long_name", ""))) is not None
    return is_described or c.attrs.get("standard_name") == name


def _at_nodes(
    a: xr.DataArray, b: xr.DataArray, dims: tuple[str, ...], shape: tuple[int, ...], drawn: Drawn
) -> tuple[Floats, Floats] | None:
    """Return two coordinates at the nodes, of lines (1, I) and (J, 1); none for other nodes."""
    if a.ndim == 1 and b.ndim == 1:
        is_line = a.dims == (dims[1],) and b.dims == (dims[0],)
        if is_line:
            return (_numbers(a)[None], _numbers(b)[:, None])
        return None
    at = [_drawn_positions(c, dims, drawn) for c in (a, b)]
    at = [c.transpose(*dims) if {*c.dims} == {*dims} else c for c in at]
    if at[0].shape == at[1].shape == shape:
        return (_numbers(at[0]), _numbers(at[1]))
    return None


def _drawn_positions(c: xr.DataArray, dims: tuple[str, ...], drawn: Drawn) -> xr.DataArray:
    """Return a coordinate of what is drawn along its further axes; an error if it moves."""
    for dim in [str(d) for d in c.dims if d not in dims]:
        kind = axis_kind(c, dim)
        axis = next((axis for axis in drawn.axes if dim == axis.dim or kind == axis.kind), None)
        if axis is not None and c.sizes[dim] == (1 if axis.line is None else len(axis.line)):
            c = c.isel({dim: axis.drawn})
        elif axis is None and c.ndim > 2 and (c.sizes[dim] == 1 or kind == TIME):
            c = c.isel({dim: slice(None)})
        else:
            continue
        if dim in c.dims:
            _check_rest(c, dim)
            c = c.isel({dim: 0})
    return c


def _check_rest(c: xr.DataArray, dim: str) -> None:
    if c.sizes[dim] < 2:
        return
    few = {}
    for d, n in c.sizes.items():
        if d != dim:
            few[d] = slice(None, None, max(n // FEW_NODES, 1))
    lines = np.asarray(values_in(c.isel(few)), dtype=float)
    axis = c.dims.index(dim)
    first = np.take(lines, [0], axis=axis)
    with np.errstate(invalid="ignore"):
        moved = float(np.nanmax(np.abs(lines - first), initial=0.0))
        size = float(np.nanmax(first, initial=-np.inf) - np.nanmin(first, initial=np.inf))
    if moved > AT_REST * size / max(c.shape):
        raise FieldError(
            f"positions vary in time: {c.name} changes by up to {moved:.4g} along {dim}; draw one "
            f"step, as in isel={{{dim!r}: 0}}"
        )


def _numbers(c: xr.DataArray) -> Floats:
    if c.dtype.kind not in "fiu":
        raise FieldError(f"the coordinate {c.name!r} has type {c.dtype}; expected numbers")
    return np.asarray(values_in(c), dtype=float)


def _is_degrees(c: xr.DataArray) -> bool:
    unit = str(c.attrs.get("units", ""))
    name = str(c.attrs.get("standard_name", c.name))
    if name in ("grid_longitude", "grid_latitude"):  # of a rotated pole
        return False
    if units.is_angle(unit) and not (ANGLES.match(name) or AZIMUTHS.search(name)):
        return True
    # Some models give a wrong unit.
    return "lon" in name.lower() or "lat" in name.lower() or bool(re.match("glam|gphi", name))


def _in_degrees(
    a: Floats, b: Floats, lon: xr.DataArray, lat: xr.DataArray
) -> tuple[Floats, Floats] | None:
    """Return longitudes and latitudes in degrees; ``None`` for other coordinates, such as XC."""
    if not (_is_degrees(lon) and _is_degrees(lat)):
        return None
    given = [str(c.attrs.get("units", "")) for c in (lon, lat)]
    # A line has values of one coordinate only.
    finite = np.isfinite(a), np.isfinite(b)
    if lon.ndim > 1:
        usable = bool((finite[0] & finite[1]).any())
    else:
        usable = all(f.any() for f in finite)
    if not usable:
        raise FieldError(
            f"{lon.name} and {lat.name} are NaN everywhere; expected positions of the nodes. Open "
            "the file that has them together with this one, or set them, as in "
            f"ds[{str(lon.name)!r}] = (dims, longitudes)"
        )
    spans = [float(np.ptp(part[np.isfinite(part)])) for part in (a, b)]
    by_span = all(low <= s <= high for s, (low, high) in zip(spans, RADIANS, strict=True))
    if (by_span and not any(map(units.parsed, given))) or all(
        unit.lower().startswith("rad") for unit in given
    ):
        return np.degrees(a), np.degrees(b)
    with np.errstate(invalid="ignore"):
        far = np.nanmax(np.abs(b), initial=0.0)
        wide = np.nanmax(np.abs(a), initial=0.0)
    if lon.ndim > 1 and far <= 90.001 and wide > 720:  # HYCOM counts further turns
        return a % 360.0, b
    if far > 90.001 or wide > 720:
        if all(units.parsed(unit) is not None for unit in given):
            text = f"{lat.name} reaches {far:g} and {lon.name} {wide:g}"
            raise FieldError(
                f"{text} in magnitude; expected degrees, up to 90 and 360. If they are lengths, "
                f'set their units, as in ds[{str(lat.name)!r}].attrs["units"] = "m"'
            )
        return None
    return a, b


def _own_line(array: xr.DataArray, dim: str, datasets: Sequence[xr.Dataset]) -> Any:
    """Return the coordinate of a dimension that is numbers, of any name; ``None`` without one."""
    for holder in (array.coords, *datasets):
        if dim in holder and holder[dim].dims == (dim,) and holder[dim].dtype.kind in "fiu":
            return holder[dim]
    alike = []
    for c in array.coords.values():
        if c.dims == (dim,) and c.dtype.kind in "fiu":
            alike.append(c)
    if len(alike) == 1:
        return alike[0]
    return None


def _of_lines(x: xr.DataArray, y: xr.DataArray) -> Places:
    """Return positions on axes of any name, such as x1 and x2, or of polar coordinates."""
    a = _numbers(x)[None]
    b = _numbers(y)[:, None]
    for radius, angle, r, turn in ((x, y, a, b), (y, x, b, a)):
        named = str(angle.name), str(angle.attrs.get("standard_name", ""))
        is_azimuth = any(map(AZIMUTHS.search, named))
        if not (RADII.match(str(radius.name)) and (is_azimuth or ANGLES.match(named[0]))):
            continue
        unit = str(angle.attrs.get("units", ""))
        degrees = units.parsed(unit) is None and np.ptp(turn) > RADIANS[0][1]
        turn = turn * (units.factor("degree" if degrees else unit, "radian") or 1.0)
        if is_azimuth:
            turn = np.pi / 2 - turn
        unit = str(radius.attrs.get("units", ""))
        if units.parsed(unit) is not None:
            unit = units.symbol(unit)
        else:
            unit = ""
        a, b, turn = np.broadcast_arrays(r * np.cos(turn), r * np.sin(turn), turn)
        why = f"{radius.name} and {angle.name}"
        return Places(a, b, is_earth=False, is_line=False, why=why, unit=unit, angle=turn)
    return _plane(x, y, a, b)


def _plane(
    x: xr.DataArray, y: xr.DataArray, a: Floats, b: Floats, crs: Mapping[str, Any] | None = None
) -> Places:
    """Return positions in a plane, or on the Earth if a grid mapping gives them."""
    one = str(x.attrs.get("units", "")).strip()
    other = str(y.attrs.get("units", "")).strip()
    why = f"{x.name} and {y.name}"
    if crs is not None:
        pyproj = import_extra("pyproj", "xarray")
        source = pyproj.CRS.from_cf(crs)
        geodetic = pyproj.CRS.from_user_input(source.geodetic_crs or 4326)
        if source.is_projected:
            a = a * (units.factor(one, "m") or 1.0)
            b = b * (units.factor(other, "m") or 1.0)
        else:
            geodetic = pyproj.CRS.from_user_input("+proj=longlat +R=6371000 +type=crs")
            a = a * (units.factor(one, "degree") or 1.0)
            b = b * (units.factor(other, "degree") or 1.0)
        change = pyproj.Transformer.from_crs(source, geodetic, always_xy=True)
        lon, lat = change.transform(*np.broadcast_arrays(a, b), errcheck=False)
        bad = ~(np.isfinite(lon) & np.isfinite(lat))
        places = np.where(bad, np.nan, lon), np.where(bad, np.nan, lat)
        words = f"{why} by {crs.get('grid_mapping_name', 'its CRS')}"
        return Places(*places, is_earth=True, is_line=False, why=words)
    if one != other and (factor := units.factor(other, one)) is not None:
        b = b * factor
    a, b = np.broadcast_arrays(a, b)
    if units.parsed(one) is not None:
        unit = units.symbol(one)
    else:
        unit = ""
    return Places(a, b, is_earth=False, is_line=x.ndim == 1, why=why, unit=unit)


def _mapping_of_axes(text: str, dims: set[str]) -> str:
    """Return the name of a grid mapping, as in ``"crs: x y geo: lat lon"`` that of the axes."""
    parts = re.findall(r"(\S+):((?:\s+[^\s:]+(?=\s|$))+)", text)
    for name, axes in parts:
        if dims & set(axes.split()):
            return str(name)
    if parts:
        return str(parts[0][0])
    return text.strip()


def _mapping(array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> dict[str, Any] | None:
    text = array.attrs.get("grid_mapping", array.encoding.get("grid_mapping", "spatial_ref"))
    name = _mapping_of_axes(str(text), {*map(str, array.dims)})
    for ds in ({**array.coords}, *datasets):
        if name in ds and {"grid_mapping_name", "crs_wkt"} & set(attrs := dict(ds[name].attrs)):
            return attrs
    return None
