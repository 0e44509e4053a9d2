"""Coordinates are marked with their axes, which they declare or which their names suggest."""

from __future__ import annotations

import itertools
import re
import warnings
from collections.abc import Hashable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from flowtex.errors import import_extra
from flowtex.field import units
from flowtex.sources.datasets.axes import ON_EARTH, TIMES, is_dates
from flowtex.sources.datasets.levels import with_levels

if TYPE_CHECKING:
    import xarray as xr

#: Units of longitude and latitude in two words.
IN_WORDS = re.compile(r"deg(?:ree)?s? (east|north)", re.IGNORECASE)
AXES = ("X", "Y", "Z", "T")
#: Axes whose first letters suggest other ones.
OF_REGCM = {"iy": "Y", "jx": "X"}
#: Attributes of what a name suggests, as cf_xarray sets them.
ATTRIBUTES = {
    **{axis: {"axis": axis} for axis in AXES},
    "T": {"axis": "T", "standard_name": "time"},
    "time": {"axis": "T", "standard_name": "time"},
    "latitude": {"units": "degrees_north", "standard_name": "latitude"},
    "longitude": {"units": "degrees_east", "standard_name": "longitude"},
}


def with_axes(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose coordinates are marked with their axes."""
    import_extra("cf_xarray", "xarray")
    ds = with_levels(_with_places(_with_cf_degrees(ds)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        guessed = guess_axes(ds)
        # Asked for often, and slowly found: each coordinate is marked with its axis.
        axes = guessed.cf.axes
        marks = {**axes, "Z": [*axes.get("Z", []), *guessed.cf.coordinates.get("vertical", [])]}
        for axis, names in marks.items():
            for name in names:
                guessed[name].attrs.setdefault("axis", axis)
    for name, c in guessed.coords.items():  # such as months, which are no times of a series
        is_guess = "axis" not in ds[name].attrs and c.attrs.get("axis") == "T"
        is_time = units.measures(str(c.attrs.get("units", "")), units.TIMES)
        if is_guess and c.dtype.kind in "fiu" and not (is_time or TIMES.match(str(name))):
            del c.attrs["axis"]
        is_number = name in ("i", "j") and "axis" not in ds[name].attrs
        if is_number and "axis" in c.attrs:  # which of them is across is a choice
            del c.attrs["axis"]
    return guessed


def _with_cf_degrees(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with the units of CF for longitude and latitude, as of "degrees east"."""
    found = {}
    for name, variable in ds.variables.items():
        match = IN_WORDS.fullmatch(str(variable.attrs.get("units", "")))
        if match:
            found[name] = f"degrees_{match[1].lower()}"
    if found:
        ds = ds.copy()
    for name, unit in found.items():
        ds[name].attrs["units"] = unit
    return ds


def _with_places(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose longitude and latitude over two axes are coordinates."""
    units_of = {}
    for name, array in ds.data_vars.items():
        if array.ndim != 2:
            continue
        unit = str(array.attrs.get("units", ""))
        word = str(array.attrs.get("long_name", "")).lower()
        if ON_EARTH.match(unit):
            units_of[name] = unit
        elif word in ("longitude", "latitude"):
            units_of[name] = str(ATTRIBUTES[word]["units"])
    places = ds.set_coords(list(units_of))
    for name, unit in units_of.items():
        places = places.assign_coords({name: places[name].assign_attrs(units=unit)})
    return places


def time_axis(datasets: Sequence[xr.Dataset]) -> str:
    """Return the name of the axis of time, ``"time"`` where none is recognised."""
    axes = [with_axes(ds).cf.axes.get("T", []) for ds in (datasets[0], datasets[-1])]
    if axes[0] and axes[0] == axes[-1]:
        return str(axes[0][0])
    return "time"


def guess_axes(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset with the attributes that ``ds.cf.guess_coord_axis()`` adds.

    That method looks all axes and coordinates up for each kind of each coordinate, and takes half
    the time of reading a small dataset. Here they are looked up after a change alone.
    """
    from cf_xarray.criteria import regex

    guessed = ds.copy(deep=False)
    on_axis, placed = _declared(guessed)
    for name in ds.coords:
        coordinate = guessed[name]
        has_dates = coordinate.dtype.kind == "m" or is_dates(coordinate)
        if name not in placed and coordinate.ndim == 1 and has_dates:
            kinds = ["time"]
        elif str(name).lower() in OF_REGCM:
            kinds = [OF_REGCM[str(name).lower()]]
        else:
            kinds = [kind for kind, pattern in regex.items() if pattern.match(str(name).lower())]
        for kind in kinds:
            is_known = name in placed
            if kind in AXES:
                is_known = name in on_axis
            if not is_known:
                coordinate.attrs = {**ATTRIBUTES[kind], **coordinate.attrs}
                on_axis, placed = _declared(guessed)
    return guessed


def _declared(ds: xr.Dataset) -> tuple[set[Hashable], set[Hashable]]:
    """Return the coordinates that declare an axis, and those that declare what they are."""
    return _names(ds.cf.axes), _names(ds.cf.coordinates)


def _names(found: Mapping[str, list[Any]]) -> set[Hashable]:
    return set(itertools.chain.from_iterable(found.values()))
