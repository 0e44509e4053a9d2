"""Vertical sections: a velocity along latitudes, longitudes or a distance, and across levels.

Nodes are at the coordinates of the data, in degrees or a unit of length, and in a unit of length or
pressure. Both components are converted to these units per second.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.earth.projection import DEGREE
from flowtex.field.field_arrays import GridArrays, SectionAxes
from flowtex.field.options import FieldOptions
from flowtex.field.steps import LazySteps
from flowtex.sources.datasets import axes, labels
from flowtex.sources.datasets.align import align, common
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE, check_two_of_space
from flowtex.sources.datasets.levels import is_pressure
from flowtex.sources.datasets.select import are_partners, two_names, variable, velocity_unit
from flowtex.sources.datasets.space_planes import is_marked
from flowtex.sources.datasets.values import (
    Component,
    FillWords,
    checked_component,
    numbers_in,
    read_step,
    record_fills,
)
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import xarray as xr

#: Names, and words of standard names, of vertical velocities.
NAMES = re.compile(r"^(w|wo|wa|wap|omega|w_?vel|vvel|vovecrtz|w_velocity)$", re.I)
#: Options that a section cannot follow.
HORIZONTAL_OPTIONS = ("components", "max_edge", "dims", "length_unit", "velocity_unit")
LONGEST_NAME = 40  #: Longest name that fits beside a colour bar.
HORIZONTAL = re.compile(r"eastward|northward|zonal|meridional|[xy]_(velocity|stress)", re.I)
WORDS = re.compile(r"upward|downward|vertical|tendency_of_air_pressure")


def is_vertical(array: xr.DataArray) -> bool:
    """Return whether a variable is a vertical velocity, by its names."""
    texts = [str(array.attrs.get(name, "")) for name in ("standard_name", "long_name")]
    if any(map(HORIZONTAL.search, texts)):
        return False
    if texts[0]:
        return WORDS.search(texts[0]) is not None
    return NAMES.match(str(array.name)) is not None


def is_section(datasets: Sequence[xr.Dataset], u: str, v: str) -> bool:
    """Return whether named components lie in a vertical section, not in a plane without units."""
    array = variable(datasets, v)
    if not is_vertical(array) or are_partners(u, v) or is_marked(array):
        return False
    named = []
    for c in array.coords.values():
        if c.dims and c.attrs.get("units"):
            named.append(c)
    return bool(named) or "standard_name" in array.attrs


def read_section(
    datasets: Sequence[xr.Dataset],
    options: FieldOptions,
    record: Record,
    close: Callable[[], None],
    *,
    name: str,
) -> GridArrays:
    """Read a vertical section, from the names of a component along it and a vertical one.

    Parameters
    ----------
    datasets
        The datasets with both components.
    options
        Options of the field; ``vectors`` names the components.
    record
        Record of what was chosen automatically.
    close
        Closes the files after a step has been read.
    name
        Name of the field.

    Raises
    ------
    FieldError
        When a component does not exist, the two have different dimensions, the section has no
        coordinates that can be drawn, or an option is of horizontal flows only.
    """
    for option in HORIZONTAL_OPTIONS:
        if getattr(options, option) is not None:
            raise FieldError(
                f"{option} applies to horizontal flows, but {options.vectors} lie in a vertical "
                "section; omit it"
            )
    name_along, name_up = two_names(options.vectors)
    one = variable(datasets, str(name_along))
    two = variable(datasets, str(name_up))
    u = str(one.name)
    v = str(two.name)
    choice = axes.Choice.of(options)
    if set(one.dims) != set(two.dims):
        raise FieldError(
            f"{u} has {', '.join(map(str, one.dims))} and {v} {', '.join(map(str, two.dims))}; "
            "interpolate one to the levels of the other, as in ds.w.interp(...)"
        )
    check_two_of_space(two, tuple(map(str, two.dims)))
    level, along = _axes(one, {*choice.sel, *choice.isel})
    for dim in (level, along):
        lines = axes.line_of(one, dim), axes.line_of(two, dim)
        if lines[0] is not None and lines[1] is not None:
            found = common(one, two, dim, lines[0], lines[1], record)
            one, two = one.isel({dim: found.one}), two.isel({dim: found.other})
    across, up = _coordinate(one, along), _coordinate(one, level)
    flat = [_flat(array, level, along) for array in (one, two)]
    first, second = align(flat[0], flat[1], choice, record)
    drawn = axes.choose(first, choice, record)
    parts = drawn.of(first), drawn.of(second)
    unit = velocity_unit(one)
    metres = (units.factor(unit, "m/s") if unit else None) or 1.0
    x, x_factor, x_text = _horizontal(across, parts[0])
    y, y_factor, y_text = _vertical(up, two)
    count = drawn.steps

    fills: FillWords = {}
    checked = [checked_component(part, 1.0, 2, options.mask, record, fills) for part in parts]
    record_fills(fills, record)
    along_u, along_v = (LazySteps(count, partial(_step, part, close)) for part in checked)
    velocities = LazySteps(count, partial(_velocity, along_u, along_v, metres * x_factor, y_factor))
    # The axes have different units, so a speed along both has none.
    speed = along_u.map(np.abs).map(partial(np.multiply, metres))
    scalars = {"speed": speed, u: along_u, v: along_v}
    scalar_units = {"speed": "m/s", u: unit, v: str(two.attrs["units"])}
    long_names = {"speed": "speed along the section"}
    for name_of, part in _others(datasets, one, (level, along), drawn, record).items():
        if name_of not in scalars:
            scalars[name_of] = LazySteps(count, partial(_plain_step, part, close))
            scalar_units[name_of] = str(part.attrs.get("units", ""))
            title = str(part.attrs.get("long_name", name_of))
            if len(title) <= LONGEST_NAME:
                long_names[name_of] = title
    return GridArrays(
        points=np.stack([*np.meshgrid(x, y), np.zeros((len(y), len(x)))], axis=-1),
        velocity=velocities if count > 1 else velocities[0],
        times=drawn.times,
        reading=record.reading,
        scalars=scalars,
        name=name,
        time_unit="s",
        units={key: text for key, text in scalar_units.items() if text},
        long_names=long_names,
        periodic="",
        section=SectionAxes(x_text, y_text, downward=_is_downward(up)),
    )


def _flat(array: xr.DataArray, level: str, along: str) -> xr.DataArray:
    """Return a variable whose rows and columns are levels and places along a section."""
    names = {level: axes.SECTION[0], along: axes.SECTION[1]}
    dropped = []
    for name in array.coords:
        if {level, along} & set(array[name].dims):
            dropped.append(name)
    return array.drop_vars(dropped).swap_dims(names).transpose(..., *axes.SECTION)


def _others(
    datasets: Sequence[xr.Dataset],
    like: xr.DataArray,
    dims: tuple[str, str],
    drawn: axes.Drawn,
    record: Record,
) -> dict[str, xr.DataArray]:
    """Return other variables at the nodes of a section, by name, and record those elsewhere."""
    found = {}
    for ds in datasets:
        for name, array in ds.data_vars.items():
            if array.dtype.kind not in "fiu" or not {*dims} <= {*array.dims}:
                continue
            try:
                found[str(name)] = drawn.of(_flat(_at_labels(array, like, dims), *dims))
            except FieldError:
                text = f"{name} lies at other positions or times, and is left out"
                record("align", text)
    return found


def _at_labels(array: xr.DataArray, like: xr.DataArray, dims: tuple[str, str]) -> xr.DataArray:
    """Return a variable at the labels of another one; a FieldError if it lacks some."""
    for dim in dims:
        own = axes.line_of(array, dim)
        wanted = axes.line_of(like, dim)
        numbers = np.arange(array.sizes[dim])
        if own is not None and wanted is not None:
            numbers = labels.match(wanted, own).other
        if len(numbers) != like.sizes[dim]:
            raise FieldError(f"{array.name} has other labels along {dim} than {like.name}")
        array = array.isel({dim: numbers})
    return array


def _plain_step(part: xr.DataArray, close: Callable[[], None], step: int) -> Floats:
    values = read_step(part.variable, step)
    close()
    return values


def _step(part: Component, close: Callable[[], None], step: int) -> Floats:
    values = part.read(step, None, axes=2)
    close()
    return values


def _velocity(u: LazySteps, v: LazySteps, across: float, up: float, step: int) -> Floats:
    """Return vectors, (J, I, 3), of components in units of the axes per second."""
    a = u.step(step) * across
    b = v.step(step) * up
    return np.stack([a, b, np.zeros_like(a)], axis=-1)


def _axes(array: xr.DataArray, chosen: set[str]) -> tuple[str, str]:
    """Return the names of the dimensions of levels and along a vertical section."""
    kinds = {str(dim): axes.axis_kind(array, str(dim)) for dim in array.dims}
    levels = [dim for dim, kind in kinds.items() if kind == axes.LEVEL]
    others = [
        dim
        for dim, kind in kinds.items()
        if kind not in (axes.LEVEL, axes.TIME) and not {dim, kind} & chosen
    ]
    # Without a choice a northward component is shown along a meridian.
    northward = re.search(r"north|merid|y_|^v", str(array.attrs.get("standard_name", array.name)))
    if northward:
        preferred = LATITUDE
    else:
        preferred = LONGITUDE
    others.sort(key=lambda dim: bool(preferred.match(dim)))
    if not levels or not others:
        text = f"{array.name} has the axes {', '.join(kinds)}; expected levels and one more"
        raise FieldError(f"{text} for a vertical section")
    return levels[0], others[-1]


def _coordinate(array: xr.DataArray, dim: str) -> xr.DataArray:
    along = [c for c in array.coords.values() if c.dims == (dim,) and c.dtype.kind in "fiu"]
    if not along:
        raise FieldError(f"{dim} has no coordinate; add it, as in ds.assign_coords({dim}=...)")
    return min(along, key=lambda c: c.name != dim)


def _horizontal(across: xr.DataArray, array: xr.DataArray) -> tuple[Floats, float, str]:
    """Return places along a section, m/s in their unit per second, and the text of the axis."""
    values = numbers_in(across)
    unit = str(across.attrs.get("units", ""))
    name = str(across.attrs.get("standard_name", across.name))
    if LATITUDE.match(name):
        return values, 1 / DEGREE, "latitude (°)"
    if LONGITUDE.match(name):
        latitudes = []
        for c in array.coords.values():
            if not c.dims and LATITUDE.match(str(c.name)):
                latitudes.append(c)
        if not latitudes:
            text = f"the latitude of a section along {across.name} is not known; add it"
            raise FieldError(f"{text}, as in ds.assign_coords(lat=45.0)")
        return values, 1 / (DEGREE * math.cos(math.radians(float(latitudes[0])))), "longitude (°)"
    length = units.factor(unit, "m")
    if length is None:
        text = "expected degrees, or one of length such as m or km"
        raise FieldError(f"the unit of {across.name} is {unit!r}; {text}")
    return values, 1 / length, f"{across.name} ({unit})"


def _vertical(up: xr.DataArray, w: xr.DataArray) -> tuple[Floats, float, str]:
    """Return levels, the factor of the velocity to their unit per second, and the axis's text."""
    unit = str(up.attrs.get("units", ""))
    moves = str(w.attrs.get("units", ""))
    text = f"{up.attrs.get('long_name', up.name)} ({unit})"
    factor = units.factor(moves, f"({unit})/s")
    if factor is not None and units.measures(unit, units.LENGTHS):
        downward = _is_downward(up) != ("downward" in str(w.attrs.get("standard_name", "")))
        return numbers_in(up), -factor if downward else factor, text
    if factor is not None and units.measures(unit, units.PRESSURES):
        return numbers_in(up), factor, text
    text = f"{up.name} is in {unit!r} and {w.name} in {moves!r}"
    raise FieldError(f"{text}; expected m and m/s, or hPa and Pa/s")


def _is_downward(up: xr.DataArray) -> bool:
    positive = str(up.attrs.get("positive", "")).lower()
    if positive in ("up", "down"):
        return positive == "down"
    return is_pressure(up) or (str(up.name).lower().startswith("depth") and float(up.max()) > 0)
