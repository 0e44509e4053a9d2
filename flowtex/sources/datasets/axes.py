"""The axes of a variable: the two of the surface, and choices along the others."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.arguments import near_names
from flowtex._util.array_types import AnyArray, Bools, Floats
from flowtex.errors import FieldError
from flowtex.field.dates import as_seconds, span_since

if TYPE_CHECKING:
    import xarray as xr

#: Names of axes that are vertical, and horizontal, where no attribute says so.
LEVELS = re.compile(
    r"^(s_rho|s_w|sc_r|nav_lev|k|k_\w|lev\w*|depth\w*|z|z_\w+|zl|height\w*|altitude|"
    r"level\w*|plev\w*|isobaric\w*|pressure\w*|sigma\w*|hybrid\w*|bottom_top\w*|rc|zc|"
    r"sig(lay|lev)|nz_?\d?|\w*layers?|\w*vgrid\w*|n?vert_?levels\w*)$",
    re.IGNORECASE,
)
ROWS = re.compile(r"^(y\w*|j\w*|lat\w*|nlat|eta\w*|south_north\w*|rlat)$", re.IGNORECASE)
COLUMNS = re.compile(r"^(x\w*|i\w*|lon\w*|nlon|xi\w*|west_east\w*|rlon)$", re.IGNORECASE)
#: Units of pressure, which is greatest at the surface, in pascals; all in small letters.
PRESSURES = {**dict.fromkeys(("pa", "pascal", "pascals"), 1.0), "bar": 1e5}
PRESSURES |= dict.fromkeys(("hpa", "mbar", "mb", "millibar", "millibars"), 100.0)
#: Lengths of the units of time in seconds.
SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "min": 60.0, "minute": 60.0, "h": 3600.0}
SECONDS |= {"hr": 3600.0, "hour": 3600.0, "d": 86400.0, "day": 86400.0}
#: Names of levels that a model numbers from its top on.
FROM_THE_TOP = re.compile(r"generalized.height", re.IGNORECASE)
#: Names of the dimensions of nodes and of faces, where there is a mesh.
NODES, FACES = "mesh_nodes", "mesh_faces"
#: Variables that mark which of these are under water, and their value there.
WET = {
    **dict.fromkeys(("wet_nodes", "wet_cells"), 1),
    **dict.fromkeys(("wetdry_node", "wetdry_elem", "dryFlagNode", "dryFlagElement"), 0),
}
#: Words for choices along an axis, beside its name.
LEVEL, TIME = "level", "time"


@dataclass
class Choice:
    """Choices along the axes, by value and by number; both by name."""

    sel: Mapping[str, Any] = field(default_factory=dict)
    isel: Mapping[str, Any] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)

    def check(self, names: set[str], drawn: set[str]) -> None:
        """Raise for a name that no axis has, or one of those that are drawn."""
        for name in {*self.sel, *self.isel} - self.used:
            msg = f"the axis {name!r} does not exist; {near_names(name, sorted(names))}"
            if name in drawn:
                msg = (
                    f"{name!r} is an axis of the surface, of which all is drawn; to draw a part, "
                    f"cut it out before, as in data.sel({name}=slice(low, high))"
                )
            raise FieldError(msg)


@dataclass(frozen=True)
class Section:
    """The drawn part of a variable: two axes, and time where it has several steps."""

    #: ([time,] rows, columns), or ([time,] nodes or faces of a mesh); not read yet.
    array: xr.DataArray
    #: Dates, or seconds, one for each step; ``None`` where no time is known.
    times: AnyArray | None
    notes: tuple[str, ...]  #: Texts about automatic choices.
    level: str  #: The level as text.
    numbers: Mapping[str, int]  #: Drawn indices along axes with a choice, by name.

    @property
    def is_series(self) -> bool:
        """Whether there are several time steps."""
        return bool(self.array.ndim > len(horizontal_dims(self.array)))

    def step(self, number: int) -> xr.DataArray:
        """Return one time step, by its number."""
        return self.array.isel({self.array.dims[0]: number}) if self.is_series else self.array


def horizontal_dims(array: xr.DataArray) -> tuple[str, ...]:
    """Return the dimensions of rows and columns, or the one of nodes or faces of a mesh."""
    for dim in (NODES, FACES):
        if dim in array.dims:
            return (dim,)
    axes = array.cf.axes
    dims = []
    for kind, pattern, spare in (("Y", ROWS, -2), ("X", COLUMNS, -1)):
        named = [str(d) for d in array.dims if d in axes.get(kind, ())]
        alike = [str(d) for d in array.dims if pattern.match(str(d))]
        dims.append((named or alike or [str(array.dims[spare])])[-1])
    if dims[0] == dims[1]:
        dims = [str(d) for d in array.dims[-2:]]
    return dims[0], dims[1]


def sections(arrays: list[xr.DataArray], choice: Choice) -> list[Section]:
    """Choose along the axes of variables that belong together, the same in all of them."""
    rows = [horizontal_dims(array) for array in arrays]
    others = [
        [str(d) for d in array.dims if d not in pair]
        for array, pair in zip(arrays, rows, strict=True)
    ]
    kinds = [
        {axis_kind(array, d): d for d in dims} for array, dims in zip(arrays, others, strict=True)
    ]
    if len({tuple(k) for k in kinds}) > 1 or any(
        len(k) < len(d) for k, d in zip(kinds, others, strict=True)
    ):
        listed = "; ".join(f"{a.name} has {', '.join(map(str, a.dims))}" for a in arrays)
        msg = f"the components have different axes: {listed}. Select along these axes first"
        raise FieldError(msg)
    for array in arrays:
        if empty := [str(d) for d, count in array.sizes.items() if count == 0]:
            msg = (
                f"{array.name} has no values along {', '.join(empty)}; expected at least one. If "
                "they were cut out, the axis may run the other way: slice(high, low)"
            )
            raise FieldError(msg)
    chosen, notes, level = list(arrays), [], ""
    numbers: dict[str, int] = {}
    times: AnyArray | None = None
    for kind in kinds[0]:
        dims = [k[kind] for k in kinds]
        lines = [_values(array, d) for array, d in zip(arrays, dims, strict=True)]
        picks, note = _picks(kind, dims, lines, arrays[0], choice)
        if kind == TIME:
            times = None if lines[0] is None else np.atleast_1d(np.asarray(lines[0])[picks[0]])
        elif kind == LEVEL and lines[0] is not None and np.ndim(picks[0]) == 0:
            level = _level_text(lines[0][picks[0]], arrays[0], dims[0])
        if note:
            notes.append(note)
        if np.ndim(picks[0]) == 0 and picks[0] != slice(None) and arrays[0].sizes[dims[0]] > 1:
            numbers[dims[0] if kind == TIME else kind] = int(picks[0])
        chosen = [array.isel({d: p}) for array, d, p in zip(chosen, dims, picks, strict=True)]
    order = [
        (kind[TIME],) if kind.get(TIME) in a.dims else ()
        for kind, a in zip(kinds, chosen, strict=True)
    ]
    chosen = [a.transpose(*t, *pair) for a, t, pair in zip(chosen, order, rows, strict=True)]
    names = {str(d) for dims in others for d in dims} | set(kinds[0])
    choice.check(names, {str(d) for pair in rows for d in pair})
    if times is None:
        times = _time_beside(arrays[0])
    level = level or _level_beside(arrays[0])
    return [Section(array, times, tuple(notes), level, numbers) for array in chosen]


def _level_beside(array: xr.DataArray) -> str:
    """Return the text of a level that was selected before, whose coordinate is a scalar."""
    for name, coordinate in array.coords.items():
        is_number = not coordinate.dims and coordinate.dtype.kind in "fiu"
        if is_number and axis_kind(array, str(name)) == LEVEL:
            return _level_text(coordinate.values[()], array, str(name))
    return ""


def _level_text(value: Any, array: xr.DataArray, dim: str) -> str:
    """Return a level as text, with the name of its axis where it has no unit."""
    text = _value_text(value, array, dim)
    return text if " " in text else f"{dim} {text}"


def wet_at(
    section: Section, dim: str, datasets: Sequence[xr.Dataset], choice: Choice
) -> Callable[[int], Bools] | None:
    """Return the mask of nodes or faces under water at a step of a velocity."""
    plain = Choice(choice.sel, choice.isel, {*choice.sel, *choice.isel})
    for ds in datasets:
        for name, water in WET.items():
            if name in ds.data_vars and dim in ds[name].dims:
                (flags,) = sections([ds[name]], plain)
                if flags.is_series == section.is_series:
                    return lambda number: np.asarray(flags.step(number).values) == water
    return None


def drawn_steps(section: Section, array: xr.DataArray) -> tuple[AnyArray | None, list[int]]:
    """Return dates or seconds of the steps that are drawn, and their numbers in the section."""
    times = section.times
    count = section.array.shape[0] if section.is_series else 1
    numbers = list(range(count))
    if times is None:
        return None, numbers[:1]
    times = np.asarray(times)
    if times.dtype.kind in "fiu":
        coordinate = array.coords.get(section.array.dims[0]) if section.is_series else None
        unit = "" if coordinate is None else str(coordinate.attrs.get("units", ""))
        seconds = seconds_in(unit)
        if seconds is None:
            return None, numbers[:1]
        times = times * seconds
    if count > 1:
        order = np.argsort(times, kind="stable")
        times = times[order]
        keep = np.concatenate([[True], times[1:] > times[:-1]])
        return times[keep], [int(n) for n in order[keep]]
    return times, numbers


def axis_values(array: xr.DataArray) -> dict[str, tuple[str, ...]]:
    """Return texts for the values along all axes with a choice except time, the level first."""
    texts: dict[str, tuple[str, ...]] = {}
    surface = horizontal_dims(array)
    for dim in map(str, array.dims):
        kind = axis_kind(array, dim)
        line = _values(array, dim)
        if dim in surface or array.sizes[dim] < 2 or (kind == TIME and _is_time(array, dim, line)):
            continue
        values = range(array.sizes[dim]) if line is None else line
        texts[dim if kind == TIME else kind] = tuple(_value_text(v, array, dim) for v in values)
    return dict(sorted(texts.items(), key=lambda item: item[0] != LEVEL))


def axis_direction(array: xr.DataArray, dim: str) -> int:
    """Return 1 where the coordinate of a dimension grows with its indices, or -1."""
    coordinate = array.coords.get(dim)
    if coordinate is None or coordinate.dtype.kind not in "fiu" or coordinate.size < 2:
        return 1
    first, last = (float(coordinate.values[n]) for n in (0, -1))
    return -1 if last < first else 1


def seconds_in(unit: str) -> float | None:
    """Return the length of a unit of time in seconds, or ``None`` where it is not known."""
    word = unit.strip().lower()
    return SECONDS.get(word, SECONDS.get(word.removesuffix("s")))


def axis_kind(array: xr.DataArray, dim: str) -> str:
    """Return ``"time"``, ``"level"``, or the name of another axis."""
    axes = array.cf.axes
    if dim in axes.get("T", ()) or _dates(array, dim) is not None:
        return TIME
    vertical = (*axes.get("Z", ()), *array.cf.coordinates.get("vertical", ()))
    if dim in vertical or LEVELS.match(dim):
        return LEVEL
    on_axis = [name for name in vertical if array.coords[name].dims == (dim,)]
    return LEVEL if on_axis else dim


def _dates(array: xr.DataArray, dim: str) -> AnyArray | None:
    """Return the dates along an axis, if a coordinate has them."""
    for name, coordinate in array.coords.items():
        if coordinate.dims == (dim,) and _is_dates(coordinate):
            # Other dates, such as those of forecasts, may run along the same axis.
            named = name == dim or coordinate.attrs.get("standard_name") in ("time", None)
            if named:
                return np.asarray(coordinate.values)
    return None


def _is_dates(coordinate: xr.DataArray) -> bool:
    kind = coordinate.dtype.kind
    return kind == "M" or (
        kind == "O" and coordinate.size > 0 and hasattr(coordinate.values.flat[0], "isoformat")
    )


def _values(array: xr.DataArray, dim: str) -> AnyArray | None:
    """Return the values along an axis: its dates, where it has them, or numbers."""
    dates = _dates(array, dim)
    if dates is not None:
        return dates
    coordinate = array.coords.get(dim)
    if coordinate is None:
        alike = [c for c in array.coords.values() if c.dims == (dim,)]
        coordinate = alike[0] if len(alike) == 1 else None
    return None if coordinate is None else np.asarray(coordinate.values)


def _time_beside(array: xr.DataArray) -> AnyArray | None:
    """Return the single date of a variable without a time axis."""
    dates = [c for c in array.coords.values() if c.ndim == 0 and _is_dates(c)]
    named = [c for c in dates if c.attrs.get("standard_name") == "time"] or dates
    return np.atleast_1d(named[0].values) if named else None


def _picks(
    kind: str, dims: list[str], lines: list[AnyArray | None], first: xr.DataArray, choice: Choice
) -> tuple[list[Any], str]:
    """Return the drawn indices along one axis, for each variable, and a note about a default."""
    count, dim, line = first.sizes[dims[0]], dims[0], lines[0]
    names = dict.fromkeys((*dims, kind))
    for name in names:
        if name in choice.isel:
            choice.used.add(name)
            number = choice.isel[name]
            if not isinstance(number, (int, np.integer)) or not -count <= number < count:
                msg = f"{name} has index {number!r} of {count}; expected 0 to {count - 1}"
                raise FieldError(msg)
            value = None if line is None else line[number]
            return [_number_in(value, int(number) % count, other) for other in lines], ""
        if name in choice.sel:
            choice.used.add(name)
            target = choice.sel[name]
            if line is None:
                msg = (
                    f"{name} has no coordinate values; select by index, as in isel={{{name!r}: 0}}"
                )
                raise FieldError(msg)
            if kind == TIME and isinstance(target, slice):
                numbers = _within(target, line, name)
                return [[_number_in(line[n], n, other) for n in numbers] for other in lines], ""
            number = _nearest(target, line, name)
            return [_number_in(line[number], number, other) for other in lines], ""
    if count == 1:
        return [0 if kind != TIME else [0]] * len(dims), ""
    if kind == TIME and _is_time(first, dim, line):
        return [slice(None)] * len(dims), ""
    if kind == LEVEL and line is not None and line.dtype.kind in "fiu":
        number = _at_surface(lines, first.coords.get(dim))
        reason = "the nearest to the surface"
    else:
        number, reason = 0, "the first"
    value = None if line is None else line[number]
    description = f"number {number}" if value is None else _value_text(value, first, dim)
    other_number = 0 if number else count - 1
    if line is None:
        example = f"isel={{{dim!r}: {other_number}}}"
    else:
        other_value = line[other_number]
        text = f"{other_value:g}" if line.dtype.kind in "fiu" else repr(str(other_value))
        example = f"level={text}" if kind == LEVEL else f"sel={{{dim!r}: {text}}}"
    note = f"{dim} is {description}, {reason} of {count} values; choose another, as in {example}"
    return [_number_in(value, number, other) for other in lines], note


def _is_time(array: xr.DataArray, dim: str, line: AnyArray | None) -> bool:
    """Return whether the values of an axis of time are dates, or spans of a known unit."""
    coordinate = array.coords.get(dim)
    if line is None or line.dtype.kind in "MmO":
        return line is not None
    unit = "" if coordinate is None else str(coordinate.attrs.get("units", ""))
    return seconds_in(unit) is not None


def _number_in(value: Any, number: int, line: AnyArray | None) -> int:
    """Return the number of a value along the axis of another variable."""
    if value is None or line is None or line.dtype.kind not in "fiuM":
        return number
    if number < len(line) and line[number] == value:
        return number
    near = np.flatnonzero(line == value)
    if not len(near) and line.dtype.kind in "fiu":
        near = np.flatnonzero(np.isclose(line.astype(float), float(value), rtol=1e-4))
    if not len(near):
        msg = (
            f"only one of the components has the level or time {value}; choose one that both "
            "components have"
        )
        raise FieldError(msg)
    return int(near[0])


def _at_surface(lines: list[Any], coordinate: xr.DataArray | None) -> int:
    """Return the number of the level nearest to the surface that all variables have."""
    line = lines[0].astype(float)
    unit = "" if coordinate is None else str(coordinate.attrs.get("units", ""))
    named = "" if coordinate is None else str(coordinate.attrs.get("long_name", ""))
    falls = unit.lower() in PRESSURES or FROM_THE_TOP.search(named)
    height = -line if falls else np.abs(line)
    for number in np.argsort(height, kind="stable"):
        try:
            [_number_in(lines[0][number], int(number), other) for other in lines[1:]]
        except FieldError:
            continue
        return int(number)
    msg = "the components have no level in common"
    raise FieldError(msg)


def _nearest(target: Any, line: AnyArray, name: str) -> int:
    """Return the number of the value nearest to a target, within the ends of the axis."""
    values = _texts(line)
    listed = ", ".join(values[:8]) + (", ..." if len(line) > 8 else "")
    msg = f"{name} is {target!r}; expected one of {listed}"
    try:
        at, (begin, end) = _places(line, target)
    except (TypeError, ValueError, AttributeError) as error:
        raise FieldError(msg) from error
    within = np.flatnonzero((at >= begin) & (at < end))
    if len(within):  # the first of a day, though it is at noon
        return int(within[0])
    at = at - begin
    number = int(np.argmin(np.abs(at)))
    widest = float(np.abs(np.diff(at)).max()) if len(at) > 1 and np.isfinite(at).all() else 0.0
    if not abs(at[number]) <= max(widest / 2, 1e-6 * np.abs(at).max()):
        raise FieldError(msg)
    return number


def _within(target: slice, line: AnyArray, name: str) -> list[int]:
    """Return the numbers of the times in a range, its ends included as in xarray."""
    ends = _texts(line)[0], _texts(line)[-1]
    try:
        at, (low, _) = _places(line, ends[0] if target.start is None else target.start)
        _, (begin, end) = _places(line, ends[1] if target.stop is None else target.stop)
    except (TypeError, ValueError, AttributeError):
        at, low, begin, end = np.zeros(1), 1.0, 0.0, 0.0
    numbers = np.flatnonzero((at >= low) & ((at <= begin) | (at < end)))[:: target.step]
    if not numbers.size:
        msg = f"{name} is {target!r}; expected a range within {ends[0]} to {ends[1]}"
        raise FieldError(msg)
    return [int(number) for number in numbers]


def _texts(line: AnyArray) -> list[str]:
    """Return values along an axis as text, dates as short as possible."""
    texts = np.datetime_as_string(line, unit="auto") if line.dtype.kind == "M" else line
    return [str(text) for text in texts]


def _places(line: AnyArray, target: Any) -> tuple[Floats, tuple[float, float]]:
    """Return values along an axis, of dates seconds, and the begin and end of the target."""
    if line.dtype.kind == "M" or (line.dtype.kind == "O" and hasattr(line[0], "isoformat")):
        seconds, _, start = as_seconds(line, "")
        return np.asarray(seconds), span_since(start, target)
    if line.dtype.kind not in "mfiu":
        return np.where(line == target, 0.0, np.inf), (0.0, 0.0)
    at = line / np.timedelta64(1, "s") if line.dtype.kind == "m" else line.astype(float)
    return at, (float(target),) * 2


def _value_text(value: Any, array: xr.DataArray, dim: str) -> str:
    coordinate = array.coords.get(dim)
    unit = "" if coordinate is None else str(coordinate.attrs.get("units", ""))
    number = f"{value:.5g}" if isinstance(value, (int, float, np.number)) else str(value)
    return f"{number} {unit}".strip()
