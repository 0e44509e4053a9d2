"""Units that only the name, or the long name, of a variable has, such as ``u_cm_s``."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from flowtex.field import units
from flowtex.field.vector_names import is_velocity
from flowtex.sources.datasets.axes import TIMES
from flowtex.sources.datasets.coordinates import ACROSS, UPWARD
from flowtex.sources.datasets.directions import SPEEDS
from flowtex.sources.datasets.levels import LEVELS
from flowtex.sources.notices import Record
from flowtex.sources.opening.column_names import split_unit

if TYPE_CHECKING:
    import xarray as xr

#: Words behind the name of a velocity, and their units.
_OF_VELOCITY = (
    (
        re.compile(r"[_ ]((?:[cmk]?m)|ft|px|pix|pixel)_?(?:per_?|_)?(s|sec|h|hr|d|day|yr)(?:_?1)?"),
        r"\1/\2",
    ),
    (re.compile(r"[_ ]mps"), "m/s"),
    (re.compile(r"[_ ]km?ph"), "km/h"),
    (re.compile(r"[_ ]mph"), "mile/h"),
    (re.compile(r"[_ ](?:kts?|kn|knots?)"), "knot"),
)
#: Lengths and times behind the name of a coordinate.
_OF_LENGTH = re.compile(r"_(mm|cm|dm|m|km|um|inch|ft|px|pix|pixels?)", re.IGNORECASE)
_OF_TIME = re.compile(r"_(ns|us|ms|s|sec|seconds?|min|minutes?|h|hr|hours?|d|days?)", re.IGNORECASE)


def with_named_units(ds: xr.Dataset, record: Record) -> xr.Dataset:
    """Return a dataset in which variables without units have those of their names.

    Units are in brackets, or words behind the name of a velocity, a position or a time.
    """
    found = {}
    for key, variable in ds.variables.items():
        is_number = variable.dtype.kind in "fiu" and variable.ndim > 0
        if is_number and not str(variable.attrs.get("units", "")).strip():
            unit = (
                _in_brackets(variable.attrs.get("long_name", ""))[1] or name_and_unit(str(key))[1]
            )
            if unit:
                found[key] = unit
    if not found:
        return ds
    ds = ds.copy()
    for key, unit in found.items():
        ds[key].attrs["units"] = unit
    listed = ", ".join(f"{name} {unit}" for name, unit in found.items())
    record("units", f"units by names: {listed}")
    return ds


def name_and_unit(name: str) -> tuple[str, str]:
    """Return a name without its unit, and the unit; empty if it has none."""
    stem, unit = _in_brackets(name)
    if unit:
        return stem, unit
    for pattern, unit in _OF_VELOCITY:
        match = re.fullmatch(rf"(.*?){pattern.pattern}", name, re.IGNORECASE)
        if match and (is_velocity(match[1]) or SPEEDS.search(match[1])) and match[1]:
            end = pattern.fullmatch(name[match.end(1) :].lower())
            if end:
                return match[1], end.expand(unit)
    for pattern, stems in ((_OF_LENGTH, (ACROSS, UPWARD, LEVELS)), (_OF_TIME, (TIMES,))):
        match = re.fullmatch(rf"(.*?){pattern.pattern}", name, re.IGNORECASE)
        if match and any(stem.match(match[1]) for stem in stems):
            return match[1], match[2].lower()
    return name, ""


def _in_brackets(name: object) -> tuple[str, str]:
    """Return a name without the unit in brackets at its end, and the unit; empty without one."""
    stem, unit = split_unit(str(name).strip())
    if unit and units.parsed(unit) is not None:
        return stem, unit
    return str(name), ""
