"""The axes of a variable: the two of the surface, and choices along the others."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.dates import ENDS, as_seconds, span_since
from flowtex.field.options import OF_MESHES, FieldOptions
from flowtex.remedies import Remedy
from flowtex.sources.datasets import labels
from flowtex.sources.datasets.levels import LEVELS, pressure_unit, surface_level
from flowtex.sources.datasets.space_planes import letters_of
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import xarray as xr

#: Names of axes of time, and horizontal ones, where no attribute says so.
TIMES = re.compile(r"^(t|n?times?|time_?\w*|\w+_time|dates?|frames?)$", re.IGNORECASE)
ROWS = re.compile(r"^(y\w*|iy|j(?!x$)\w*|lat\w*|nlat|eta\w*|south_north\w*|rlat)$", re.IGNORECASE)
COLUMNS = re.compile(r"^(x\w*|jx|i(?!y$)\w*|lon\w*|nlon|xi\w*|west_east\w*|rlon)$", re.IGNORECASE)
#: Units of longitude and latitude.
ON_EARTH = re.compile(r"^deg(ree)?s?_?(north|east|N|E)$")
#: Name of the dimension of nodes, where there is a mesh.
NODES = "mesh_nodes"
#: Name of the dimension of faces, where there is a mesh.
FACES = "mesh_faces"
#: Names of the dimensions of rows and columns of a vertical section.
SECTION = ("y_of_section", "x_of_section")
#: A number and its unit.
_WITH_UNIT = re.compile(r"([-+]?[\d.]+(?:e[-+]?\d+)?)\s*([^\d\s].*|)", re.IGNORECASE)
#: Word for a choice along a vertical axis, beside its name.
LEVEL = "level"
#: Word for a choice of a time.
TIME = "time"


@dataclass
class Choice:
    """Choices along the axes, by value and by number; both by name."""

    sel: Mapping[str, Any] = field(default_factory=dict)
    isel: Mapping[str, Any] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    time_unit: str | None = None  #: Unit of times that are numbers, which the user names.

    @classmethod
    def of(cls, options: FieldOptions) -> Choice:
        """Return the choices among options."""
        if options.level is None:
            level = {}
        else:
            level = {LEVEL: options.level}
        sel = {**(options.sel or {}), **level}
        return cls(sel, dict(options.isel or {}), time_unit=options.time_unit)

    def check(self, names: set[str], drawn: set[str]) -> None:
        """Check that each selected axis exists, and is not drawn.

        Parameters
        ----------
        names
            Names and kinds of the axes along which data can be selected.
        drawn
            Names of the axes of the surface.

        Raises
        ------
        FieldError
            When a name of ``sel`` or ``isel`` is no axis, or an axis of the surface.
        """
        for name in {*self.sel, *self.isel} - self.used:
            if name in OF_MESHES and name not in drawn:
                raise FieldError(f"{name} applies to meshes, but this is a dataset; omit it")
            if name not in drawn and not names:
                raise FieldError(
                    f"the axis {name!r} does not exist; the data have no axis besides those of the "
                    f"surface, {' and '.join(sorted(drawn))}, so omit it"
                )
            if name not in drawn:
                text = near_names(name, sorted(names))
                raise FieldError(f"the axis {name!r} does not exist; {text}")
            raise FieldError(
                f"{name!r} is one of the surface's own axes, so it cannot be selected here; "
                f"subset the data first: data.sel({name}=slice(low, high))"
            )


class Axis(NamedTuple):
    """An axis that is not one of the surface's, and the labels that are drawn along it."""

    kind: str  #: ``"time"``, ``"level"``, or the name of another axis.
    dim: str
    line: AnyArray | None  #: Its labels; ``None`` where it has none.
    drawn: int | list[int]  #: Number of the label that is drawn, or the numbers of a series.


@dataclass(frozen=True)
class Drawn:
    """The selection of a velocity along all axes that are not axes of the surface."""

    axes: tuple[Axis, ...] = ()
    times: AnyArray | None = None  #: Dates or numbers, one for each step; ``None`` if unknown.
    time_unit: str = ""  #: Unit of times that are numbers.
    level: str = ""  #: The level as text.

    @property
    def steps(self) -> int:
        """Number of time steps."""
        return next((np.size(axis.drawn) for axis in self.axes if axis.kind == TIME), 1)

    @property
    def numbers(self) -> dict[str, int]:
        """Drawn numbers along axes with a choice, by name."""
        found = {}
        for axis in self.axes:
            if isinstance(axis.drawn, int) and axis.line is not None and len(axis.line) > 1:
                found[axis.dim if axis.kind == TIME else axis.kind] = axis.drawn
        return found

    def of(self, array: xr.DataArray) -> xr.DataArray:
        """Return the same selection of another variable, ([time,] ...).

        Raises
        ------
        FieldError
            When the variable has an axis that the velocity lacks, or other labels along one.
        """
        known = {axis.kind: axis for axis in self.axes}
        surface = horizontal_dims(array)
        series: tuple[str, ...] = ()
        for kind, dim in further_axes(array).items():
            axis = known.get(kind)
            if axis is None:
                if array.sizes[dim] > 1:
                    raise FieldError(f"{array.name} has the axis {dim}, which the velocity lacks")
                array = array.isel({dim: 0})
                continue
            picks = _same_labels(array, dim, axis)
            if isinstance(picks, list):
                series = (dim,)
            array = array.isel({dim: picks if isinstance(picks, int) else as_slice(picks)})
        return array.transpose(*series, *surface)


def _same_labels(array: xr.DataArray, dim: str, axis: Axis) -> int | list[int]:
    """Return where the drawn labels of an axis are along the same axis of another variable."""
    own = line_of(array, dim)
    count = array.sizes[dim]
    if axis.line is None:
        length = count
    else:
        length = len(axis.line)
    if own is None or axis.line is None:
        if count != length:
            raise FieldError(
                f"{array.name} has {count} values along {dim}, and the velocity {length}"
            )
        return axis.drawn
    wanted = axis.line[np.atleast_1d(axis.drawn)]
    found = labels.match(wanted, own)
    if len(found.one) < len(wanted):
        raise FieldError(
            f"{array.name} has {labels.text(own)} along {dim}, without {labels.text(wanted)}"
        )
    numbers = [int(n) for n in found.other]
    if isinstance(axis.drawn, list):
        return numbers
    return numbers[0]


def as_slice(numbers: Sequence[int] | Indices) -> Indices | slice:
    """Return numbers as a slice where they are one, which xarray reads faster."""
    line = np.asarray(numbers, dtype=np.intp)
    steps = np.diff(line)
    if len(steps) and (steps == steps[0]).all() and steps[0] in (1, -1):
        stop = int(line[-1]) + int(steps[0])
        return slice(int(line[0]), None if stop < 0 else stop, int(steps[0]))
    return line


def horizontal_dims(array: xr.DataArray) -> tuple[str, ...]:
    """Return the dimensions of rows and columns, or the one of nodes or faces of a mesh."""
    for dim in (NODES, FACES):
        if dim in array.dims:
            return (dim,)
    if {*SECTION} <= {*array.dims}:
        return SECTION
    axes = marked_axes(array)
    dims = [str(d) for d in array.dims]
    if len(dims) < 2:
        return tuple(dims)
    # Where two axes remain they are those of the surface, also if they are called x and z.
    free = [d for d in dims if axis_kind(array, d) != TIME]
    if len(free) != 2:
        free = dims
    rows, columns = (
        [d for d in free if d in axes.get(kind, ())] or [d for d in free if pattern.match(d)]
        for kind, pattern in (("Y", ROWS), ("X", COLUMNS))
    )
    letters = letters_of(free)
    if len(free) == 2 and letters.keys() == {"y", "z"}:
        return letters["z"], letters["y"]
    if len(free) == 2 and (not rows or not columns or rows[-1] == columns[-1]):
        if len(rows) == 1 and rows != columns:
            return rows[0], next(d for d in free if d != rows[0])
        if len(columns) == 1 and rows != columns:
            return next(d for d in free if d != columns[0]), columns[0]
        if all(line_of(array, d) is not None for d in free):  # such as x1 and x2
            return max(free), min(free)
        return free[0], free[1]
    placed = _placed_dims(array)
    if placed and (not rows or not columns):
        return placed
    pair = (rows or [dims[-2]])[-1], (columns or [dims[-1]])[-1]
    if pair[0] != pair[1]:
        return pair
    return (dims[-2], dims[-1])


def is_told(array: xr.DataArray) -> bool:
    """Return whether attributes, names or lines tell the rows of a surface from its columns."""
    axes = marked_axes(array)
    known = {*axes.get("Y", ()), *axes.get("X", ())}
    rows, columns = horizontal_dims(array)
    is_named = ROWS.match(rows) is not None or COLUMNS.match(columns) is not None
    return is_named or bool(known & {rows, columns}) or _placed_dims(array) is not None


def _placed_dims(array: xr.DataArray) -> tuple[str, str] | None:
    """Return the two dimensions of longitude and latitude; ``None`` without such coordinates."""
    found = set()
    for c in array.coords.values():
        if c.ndim == 2 and ON_EARTH.match(str(c.attrs.get("units", ""))):
            found.add(tuple(map(str, c.dims)))
    if len(found) != 1:
        return None
    rows, columns = found.pop()
    return rows, columns


def marked_axes(array: xr.DataArray) -> dict[str, list[str]]:
    """Return the coordinates of the axes X, Y, Z and T, which are marked in all datasets."""
    axes: dict[str, list[str]] = {}
    for name, variable in array.coords.variables.items():
        axes.setdefault(str(variable.attrs.get("axis", "")), []).append(str(name))
    return axes


def axis_kind(array: xr.DataArray, dim: str) -> str:
    """Return ``"time"``, ``"level"``, or the name of another axis."""
    axes = marked_axes(array)
    variables = array.coords.variables
    if dim in variables:
        named = variables[dim].attrs
    else:
        named = {}
    by_name = TIMES.match(dim) and not {*axes.get("X", ()), *axes.get("Y", ())} & {dim}
    if dim in axes.get("T", ()) or _dates(array, dim) is not None or by_name:
        return TIME
    vertical = axes.get("Z", [])
    if dim in vertical or LEVELS.match(dim) or named.get("standard_name") == "air_pressure":
        return LEVEL
    on_axis = []
    for name in vertical:
        if variables[name].dims == (dim,):
            on_axis.append(name)
    if on_axis:
        return LEVEL
    return dim


def further_axes(array: xr.DataArray) -> dict[str, str]:
    """Return the dimensions of a variable that are not of its surface, by their kinds.

    Raises
    ------
    FieldError
        When two of them are of one kind, such as two axes of levels.
    """
    surface = horizontal_dims(array)
    dims = [str(d) for d in array.dims if d not in surface]
    times = [d for d in dims if axis_kind(array, d) == TIME]
    # Of several axes of time the first one with dates is that of the series.
    first = next((d for d in times if len(times) == 1 or _dates(array, d) is not None), None)
    kinds = {TIME if d == first else d if d in times else axis_kind(array, d): d for d in dims}
    if len(kinds) < len(dims):
        raise FieldError(
            f"{array.name} has the axes {', '.join(dims)}, of one kind; select along one first"
        )
    return kinds


def choose(array: xr.DataArray, choice: Choice, record: Record) -> Drawn:
    """Choose along the axes of the first component, which the second one has as well.

    Raises
    ------
    FieldError
        When an axis is empty, a selected label does not exist, or a selection names no axis.
    """
    if empty := [str(d) for d, count in array.sizes.items() if count == 0]:
        raise FieldError(
            f"{array.name} has no values along {', '.join(empty)}; expected at least one. If "
            "they were cut out, the axis may run the other way: slice(high, low)"
        )
    kinds = further_axes(array)
    axes = []
    times: AnyArray | None = None
    level = unit = ""
    for kind, dim in kinds.items():
        line = line_of(array, dim)
        drawn = _drawn(kind, dim, line, array, choice, record)
        if kind == TIME and line is not None:
            unit = choice.time_unit or _unit(array, dim)
            times, unit, drawn = _steps(line, unit, dim, drawn, record)
        elif kind == LEVEL and line is not None and isinstance(drawn, int):
            level = _level_text(line[drawn], array, dim)
        elif line is not None and isinstance(drawn, int) and {dim, kind} & {*choice.used}:
            record("select", f"{dim}: {_value_text(line[drawn], array, dim)}")
        axes.append(Axis(kind, dim, line, drawn))
    choice.check({*kinds, *kinds.values()}, set(horizontal_dims(array)))
    # What was selected before is a scalar.
    single = {str(name): c for name, c in array.coords.items() if not c.dims}
    dates = [c for c in single.values() if is_dates(c)]
    if times is None and dates:
        named = [c for c in dates if c.attrs.get("standard_name") == "time"] or dates
        times = np.atleast_1d(named[0].values)
    for name, c in single.items() if not level else ():
        if c.dtype.kind in "fiu" and axis_kind(array, name) == LEVEL:
            level = level or _level_text(c.values[()], array, name)
    return Drawn(tuple(axes), times, unit, level)


def _steps(
    line: AnyArray, own_unit: str, dim: str, drawn: int | list[int], record: Record
) -> tuple[AnyArray | None, str, int | list[int]]:
    """Return dates or numbers of the drawn steps, their unit, and their numbers, in order."""
    chosen = np.atleast_1d(drawn)
    times = line[chosen]
    unit = ""
    if times.dtype.kind in "fiu":
        unit = own_unit
        if (seconds := units.factor(unit, "s")) is not None:
            times = times * seconds
            unit = "s"
        elif unit and not units.measures(unit, units.TIMES):
            unit = ""
    elif times.dtype.kind not in "mMO":
        return None, "", drawn
    if times.dtype.kind != "M":
        unknown = np.asarray(times != times)
    else:
        unknown = np.isnat(times)
    if unknown.any():
        record("align", f"{dim}: {unknown.sum()} steps without a time are left out", notable=True)
    chosen = chosen[~unknown]
    times = times[~unknown]
    if not len(times):
        raise FieldError(f"{dim} has no valid time; expected dates or numbers")
    order = np.argsort(times, kind="stable")
    if (order != np.arange(len(order))).any():
        record("align", f"{dim}: steps sorted by time")
    chosen = chosen[order]
    times = times[order]
    keep = np.concatenate([[True], times[1:] > times[:-1]])
    if not keep.all():
        record("align", f"{dim}: {(~keep).sum()} repeated times are left out", notable=True)
    numbers = [int(n) for n in chosen[keep]]
    return times[keep], unit, numbers if isinstance(drawn, list) else numbers[0]


def _level_text(value: Any, array: xr.DataArray, dim: str) -> str:
    """Return a level as text, with the name of its axis where it has no unit."""
    text = _value_text(value, array, dim)
    if " " in text:
        return text
    return f"{dim} {text}"


def axis_values(array: xr.DataArray) -> dict[str, tuple[str, ...]]:
    """Return texts for the values along all axes with a choice except time, the level first."""
    texts: dict[str, tuple[str, ...]] = {}
    for kind, dim in further_axes(array).items():
        line = line_of(array, dim)
        if array.sizes[dim] < 2 or (kind == TIME and line is not None):
            continue
        values: Iterable[Any]
        if line is None:
            values = range(array.sizes[dim])
        else:
            values = line
        texts[dim if kind == TIME else kind] = tuple(_value_text(v, array, dim) for v in values)
    return dict(sorted(texts.items(), key=lambda item: item[0] != LEVEL))


def axis_direction(array: xr.DataArray, dim: str) -> int:
    """Return 1 where the coordinate of a dimension grows with its indices, or -1."""
    line = coordinate_of(array, dim)
    if line is not None and line.dtype.kind in "fiu" and line[-1] < line[0]:
        return -1
    return 1


def _dates(array: xr.DataArray, dim: str) -> AnyArray | None:
    for name, c in array.coords.variables.items():
        # Other dates, such as those of forecasts, may run along the same axis.
        named = name == dim or c.attrs.get("standard_name") in ("time", None)
        if named and c.dims == (dim,) and is_dates(c):
            return np.asarray(c.values)
    return None


def coordinate_of(array: xr.DataArray, dim: str) -> xr.DataArray | None:
    """Return the coordinate of a dimension; xarray makes up numbers for one that lacks it."""
    return next((c for name, c in array.coords.items() if name == dim), None)


def is_dates(coordinate: xr.DataArray | xr.Variable) -> bool:
    """Return whether a coordinate has dates, of any calendar."""
    kind = coordinate.dtype.kind
    return kind == "M" or (
        kind == "O" and coordinate.size > 0 and hasattr(coordinate.values.flat[0], "isoformat")
    )


def line_of(array: xr.DataArray, dim: str) -> AnyArray | None:
    """Return the labels along an axis: its dates, where it has them, or numbers."""
    dates = _dates(array, dim)
    if dates is not None:
        return dates
    coordinate = coordinate_of(array, dim)
    if coordinate is None:
        alike = []
        for c in array.coords.values():
            if c.dims == (dim,):
                alike.append(c)
        if len(alike) != 1:
            return None
        coordinate = alike[0]
    return np.asarray(coordinate.values)


def _drawn(
    kind: str, dim: str, line: AnyArray | None, array: xr.DataArray, choice: Choice, record: Record
) -> int | list[int]:
    """Return the drawn numbers along one axis, all of a time without a choice."""
    count = array.sizes[dim]
    for name in dict.fromkeys((dim, kind)):
        if name in choice.isel:
            choice.used.add(name)
            number = choice.isel[name]
            if not isinstance(number, (int, np.integer)) or not -count <= number < count:
                raise FieldError(
                    f"{name} has index {number!r} of {count}; expected 0 to {count - 1}"
                )
            return int(number) % count
        if name in choice.sel:
            choice.used.add(name)
            if line is None:
                raise FieldError(
                    f"{name} has no coordinate values; select by index: isel={{{name!r}: 0}}"
                )
            if kind == TIME:
                found = _of_times(choice.sel[name], line, name)
                if found is not None:
                    return found
            unit = value_unit(array, dim)
            target = _in_unit(choice.sel[name], line, unit)
            is_longitude = dim.lower().startswith("lon") or unit.endswith("_east")
            return _nearest(target, line, name, unit, is_longitude=is_longitude)
    if kind == TIME and line is not None and line.dtype.kind in "mMOfiu":
        return list(range(count))
    if kind == TIME and line is not None and count > 1:
        raise FieldError(
            f"{dim} has the texts {labels.text(line)}; expected dates such as 2024-01-31T06:00, or "
            f"numbers. Set them, as in ds.assign_coords({dim}=...)"
        )
    if count == 1:
        return 0
    return _by_default(kind, dim, line, array, record)


def _by_default(
    kind: str, dim: str, line: AnyArray | None, array: xr.DataArray, record: Record
) -> int:
    """Return the number that is drawn along an axis without a choice, and record it."""
    count = array.sizes[dim]
    if kind == LEVEL and line is not None and line.dtype.kind in "fiu":
        number = surface_level(coordinate_of(array, dim), line, array)
        reason = "the nearest to the surface"
    else:
        number, reason = 0, "the first"
    other = 0 if number else count - 1
    if line is None:
        description = f"number {number}"
        remedy = Remedy("isel", {dim: other})
    else:
        description = _value_text(line[number], array, dim)
        remedy = _remedy(kind, dim, typed_value(line[other], value_unit(array, dim)))
    text = f"{dim} is {description}, {reason} of {count} values"
    record("select", text, remedy, notable=True)
    return number


def _remedy(kind: str, dim: str, value: Any) -> Remedy:
    """Return the argument that selects a value along an axis."""
    if kind == LEVEL:
        return Remedy("level", value)
    return Remedy("sel", {dim: value})


def typed_value(value: Any, unit: str = "") -> float | str:
    """Return a label as users type it: a number, a number with its unit, or a text."""
    if isinstance(value, np.timedelta64):
        return f"{value / np.timedelta64(1, 'h'):.9g} h"
    if not isinstance(value, (int, float, np.number)):
        return str(value)
    number = float(f"{value:.9g}")
    if unit and units.parsed(unit) is not None:
        return f"{number:.9g} {unit}"
    if number.is_integer():
        return int(number)
    return number


def _in_unit(target: Any, line: AnyArray, unit: str) -> Any:
    """Return a text such as ``"250 hPa"`` as the number in the unit of an axis, if it is one."""
    if line.dtype.kind == "m":
        unit = "s"
    found = _WITH_UNIT.fullmatch(target.strip()) if isinstance(target, str) else None
    if found is None or line.dtype.kind not in "mfiu":
        return target
    number = float(found[1])
    given = found[2]
    if given in ("", unit):
        return number
    factor = units.factor(given, unit)
    if factor is None:
        return target
    return number * factor


def _nearest(target: Any, line: AnyArray, name: str, unit: str, *, is_longitude: bool) -> int:
    """Return the number of the value nearest to a target, within the ends of the axis."""
    msg = f"{name} is {target!r}; expected one of {labels.text(line)} {unit}".rstrip()
    try:
        at, (begin, end) = _places(line, target)
    except (TypeError, ValueError, AttributeError) as error:
        raise FieldError(msg) from error
    within = np.flatnonzero((at >= begin) & (at < end))
    if len(within):  # the first of a day, though it is at noon
        return int(within[0])
    if len(at) > 1 and np.isfinite(at).all():
        widest = float(np.abs(np.diff(at)).max())
    else:
        widest = 0.0
    off = np.abs(at - begin)
    if is_longitude:  # -30 and 330 are one
        off = np.minimum(off, np.abs(off - 360.0))
    if not off.min() <= max(widest / 2, 1e-6 * off.max(where=np.isfinite(off), initial=0.0)):
        raise FieldError(msg)
    return int(np.argmin(off))


def _of_times(target: Any, line: AnyArray, name: str) -> int | list[int] | None:
    """Return the times of a range, or the first or last one; ``None`` for other targets."""
    if isinstance(target, slice):
        return _within(target, line, name)
    known = np.flatnonzero(line == line)
    if not isinstance(target, str) or target not in ENDS or not len(known):
        return None
    order = np.argsort(line[known], kind="stable")
    return int(known[order[ENDS[target]]])


def _within(target: slice, line: AnyArray, name: str) -> list[int]:
    """Return the numbers of the times in a range, its ends included as in xarray."""
    inside = np.ones(len(line), dtype=bool)
    try:
        if target.start is not None:
            at, (low, _) = _places(line, target.start)
            inside &= at >= low
        if target.stop is not None:
            at, (begin, end) = _places(line, target.stop)
            inside &= (at <= begin) | (at < end)
    except (TypeError, ValueError, AttributeError):
        inside[:] = False
    numbers = np.flatnonzero(inside)[:: target.step]
    if not numbers.size:
        raise FieldError(f"{name} is {target!r}; expected a range within {labels.text(line)}")
    return [int(number) for number in numbers]


def _places(line: AnyArray, target: Any) -> tuple[Floats, tuple[float, float]]:
    """Return values along an axis, of dates seconds, and the begin and end of the target."""
    if line.dtype.kind == "M" or (line.dtype.kind == "O" and hasattr(line[0], "isoformat")):
        seconds, _, start = as_seconds(line, "")
        return np.asarray(seconds), span_since(start, target)
    if line.dtype.kind not in "mfiu":
        return np.where(line == target, 0.0, np.inf), (0.0, 0.0)
    if line.dtype.kind == "m":
        at = line / np.timedelta64(1, "s")
    else:
        at = line.astype(float)
    return at, (float(target),) * 2


def _unit(array: xr.DataArray, dim: str) -> str:
    coordinate = coordinate_of(array, dim)
    if coordinate is None:
        return ""
    return str(coordinate.attrs.get("units", ""))


def value_unit(array: xr.DataArray, dim: str) -> str:
    """Return the unit of the labels along an axis, also that of pressures that have none."""
    unit = _unit(array, dim)
    if not unit and dim in array.coords and axis_kind(array, dim) == LEVEL:
        unit = pressure_unit(array.coords[dim])
    if unit.lower() in units.NONE:
        return ""
    return unit


def _value_text(value: Any, array: xr.DataArray, dim: str) -> str:
    return f"{value_word(value)} {value_unit(array, dim)}".strip()


def value_word(value: Any) -> str:
    """Return a label as text: numbers with five digits, and spans in hours."""
    if isinstance(value, np.timedelta64):
        return f"{value / np.timedelta64(1, 'h'):g} h"
    if isinstance(value, (int, float, np.number)):
        return f"{value:.5g}"
    return str(value)
