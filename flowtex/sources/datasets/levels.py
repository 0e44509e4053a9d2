"""Levels: which of them is the nearest to the surface, and whether they are pressures.

Attributes decide first, then names, and values last.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.field import units

if TYPE_CHECKING:
    import xarray as xr

#: Names of vertical axes, where no attribute says so.
LEVELS = re.compile(
    r"^(s_rho|s_w|sc_r|nav_lev|k|k_\w|lev\w*|depth\w*|z|z_\w+|zl|height\w*|altitude|"
    r"level\w*|plev\w*|isobaric\w*|pressure\w*|sigma\w*|hybrid\w*|bottom_top\w*|rc|zc|"
    r"sig(lay|lev)|nz_?\d?|lay\w*|\w*layers?|\w*vgrid\w*|n?vert_?levels\w*)$",
    re.IGNORECASE,
)
#: Standard names of vertical coordinates.
VERTICAL = re.compile(r"^(atmosphere|ocean)_\w*coordinate$|^(height|depth|altitude|air_pressure)$")
#: Names of levels that are pressures.
PRESSURE_NAMES = re.compile(r"^(p|plev\w*|pressure\w*|isobaric\w*)$", re.IGNORECASE)
#: Names of levels, or words of their attributes, that are lengths.
LENGTHS = re.compile(r"(?<![a-z])(height|altitude|elevation|depth)|^(z|alt)$|geometric", re.I)
#: Words for levels of a model that follow the ground: 1, or the greatest number, is the lowest.
FOLLOWING = re.compile(r"sigma|hybrid|model[ _]level|eta[ _]level", re.IGNORECASE)
#: Words for levels that a model numbers from its top on.
FROM_THE_TOP = re.compile(r"generalized.height", re.IGNORECASE)
#: Words for numbers of levels that a model counts from the ground.
FROM_THE_GROUND = re.compile(r"model_level_number", re.IGNORECASE)
#: Words for a velocity, or for levels, in the sea.
AT_SEA = re.compile(r"sea_water|ocean|current|water|^sea_", re.IGNORECASE)
#: Names of currents in CMIP and NEMO.
CURRENTS = re.compile(r"^[uv]o$")
#: Levels of pressure that models of weather use, in hPa.
USUAL_HPA = (1000, 950, 925, 900, 850, 800, 700, 600, 500, 400, 300, 250, 200, 150, 100, 50)
#: Greatest pressure in hPa, beyond which numbers without a unit are pascals.
MOST_HPA = 2000.0


def with_levels(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose vertical dimensions have coordinates.

    A dimension without a coordinate takes the values of the variable along it that has its levels,
    such as ``ZNW`` of ``bottom_top``.
    """
    found: dict[str, xr.Variable] = {}
    for name, variable in ds.variables.items():
        if variable.ndim != 1 or variable.dtype.kind not in "fiu":
            continue
        (dim,) = map(str, variable.dims)
        if dim not in ds.variables and dim not in found and _are_levels(str(name), dim, variable):
            found[dim] = variable
    coordinates = {}
    for dim, variable in found.items():
        coordinates[dim] = (dim, variable.values, {**variable.attrs, "axis": "Z"})
    return ds.assign_coords(coordinates)


def _are_levels(name: str, dim: str, variable: xr.Variable) -> bool:
    """Return whether a variable has the values of a vertical axis, by its attributes or names."""
    attrs = variable.attrs
    standard = str(attrs.get("standard_name", ""))
    declared = "formula_terms" in attrs or standard.endswith("_coordinate")
    named = LEVELS.match(dim) and (LEVELS.match(name) or "positive" in attrs or standard)
    if not ((declared or named) and (VERTICAL.match(standard) or not standard)):
        return False
    if attrs.get("axis") not in (None, "Z") or variable.size < 2:
        return False
    steps = np.diff(np.asarray(variable.values, dtype=float))
    return bool((steps > 0).all() or (steps < 0).all())


def surface_level(coordinate: xr.DataArray | None, line: AnyArray, velocity: xr.DataArray) -> int:
    """Return the number of the level nearest to the surface, of levels (N,) of a velocity."""
    values = line.astype(float)
    if coordinate is not None and _is_greatest(coordinate, at_sea=_is_at_sea(coordinate, velocity)):
        return int(np.nanargmax(values))
    return int(np.nanargmin(np.abs(values)))


def _is_greatest(coordinate: xr.DataArray, *, at_sea: bool) -> bool:
    """Return whether the greatest level is the nearest to the surface."""
    words = _words(coordinate)
    if is_pressure(coordinate):
        return not at_sea
    if FROM_THE_TOP.search(words):
        return True
    below = bool(np.nanmax(coordinate.values) <= 0)
    if below or _is_length(coordinate):
        return False
    positive = str(coordinate.attrs.get("positive", "")).lower()
    if positive in ("up", "down"):
        return at_sea == (positive == "up")
    if FROM_THE_GROUND.search(words) or at_sea:
        return False
    return FOLLOWING.search(words) is not None


def _words(coordinate: xr.DataArray) -> str:
    named = (
        coordinate.name,
        *(coordinate.attrs.get(n, "") for n in ("standard_name", "long_name")),
    )
    return " ".join(map(str, named)).strip()


def _is_at_sea(coordinate: xr.DataArray, velocity: xr.DataArray) -> bool:
    declared = str(coordinate.attrs.get("standard_name", ""))
    unit = str(coordinate.attrs.get("units", ""))
    if declared.startswith(("atmosphere", "air_")):
        return False
    if AT_SEA.search(declared) or units.factor(unit, "dbar") == 1.0:
        return True
    if units.measures(unit, units.PRESSURES):
        return False
    named = (str(velocity.attrs.get(n, "")) for n in ("standard_name", "long_name"))
    return any(map(AT_SEA.search, named)) or CURRENTS.match(str(velocity.name)) is not None


def _is_length(coordinate: xr.DataArray) -> bool:
    """Return whether levels are heights or depths, by their unit or their names."""
    unit = str(coordinate.attrs.get("units", ""))
    if units.parsed(unit) is not None:
        return units.measures(unit, units.LENGTHS)
    standard = str(coordinate.attrs.get("standard_name", ""))
    if standard and not LENGTHS.search(standard):
        return False
    named = str(coordinate.name), standard, str(coordinate.attrs.get("long_name", ""))
    return any(map(LENGTHS.search, named))


def is_pressure(coordinate: xr.DataArray | None) -> bool:
    """Return whether levels are pressures, by their unit, their name or their values."""
    if coordinate is None:
        return False
    unit = str(coordinate.attrs.get("units", ""))
    if units.parsed(unit) is not None:
        return units.measures(unit, units.PRESSURES)
    return pressure_unit(coordinate) != ""


def pressure_unit(coordinate: xr.DataArray) -> str:
    """Return the unit of pressures without one, by names and values; empty for other levels."""
    values = np.atleast_1d(coordinate.values)
    if values.dtype.kind not in "fiu" or _is_length(coordinate):
        return ""
    standard = str(coordinate.attrs.get("standard_name", ""))
    named = PRESSURE_NAMES.match(str(coordinate.name)) or standard.endswith("_pressure")
    if np.nanmax(np.abs(values), initial=0.0) <= MOST_HPA:
        unit = "hPa"
    else:
        unit = "Pa"
    if named:
        return unit
    is_other = FOLLOWING.search(_words(coordinate)) or "positive" in coordinate.attrs
    usual = np.isin(values / (1.0 if unit == "hPa" else 100.0), USUAL_HPA)
    by_values = values.size > 1 and usual.mean() > 0.5 and values.max() >= 100
    if by_values and not is_other:
        return unit
    return ""
