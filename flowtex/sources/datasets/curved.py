"""Axes of polar coordinates and of spherical shells: their names, and places on a globe."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Ends of the names of axes that are staggered, such as ``phi_f`` and ``r_edge``.
_SIDE = r"(_?(f|c|h|s|face|edge|stag|center|centre|half|left|right|inner|outer|b|i|u|v))?$"
#: Names of the distance from the centre.
RADII = re.compile(r"^(r|rho|radius|radial\w*|range)" + _SIDE, re.I)
#: Names of angles, counterclockwise.
ANGLES = re.compile(r"^(phi|theta|angle|polar_angle)" + _SIDE, re.I)
#: Names of angles clockwise from north.
AZIMUTHS = re.compile(r"^(az|azi|azimuth\w*|bearing|heading)$|azimuth", re.I)
#: Names of the angle from the north pole, and of the one around the axis.
COLATITUDES = re.compile(r"^(theta|colat\w*)" + _SIDE, re.I)
LONGITUDES = re.compile(r"^(phi|lon\w*)" + _SIDE, re.I)
#: Greatest colatitude in radians; greater ones are degrees.
MOST_RADIANS = np.pi + 1e-3


def on_sphere(array: xr.DataArray) -> bool:
    """Return whether a variable lies along colatitude and longitude, such as theta and phi."""
    dims = [str(dim) for dim in array.dims]
    return any(map(COLATITUDES.match, dims)) and any(map(LONGITUDES.match, dims))


def is_around(dim: str) -> bool:
    """Return whether an axis is an angle around a centre, or a longitude."""
    return bool(ANGLES.match(dim) or AZIMUTHS.search(dim) or LONGITUDES.match(dim))


def with_lonlat(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose colatitudes and longitudes are those of a globe in degrees.

    Raises
    ------
    FieldError
        When colatitudes lie beyond the poles.
    """
    lines = {str(name): line for name, line in ds.coords.items() if line.dims == (name,)}
    colatitudes = {name: line for name, line in lines.items() if COLATITUDES.match(name)}
    changed = {}
    for name, line in colatitudes.items():
        degrees = _angles_in_degrees(line, MOST_RADIANS)
        low = float(degrees.min())
        high = float(degrees.max())
        if low < -1e-3 or high > 180.001:
            raise FieldError(
                f"{name} is from {low:.4g}° to {high:.4g}°; expected colatitudes, from 0 at the "
                f"north pole to 180°. A latitude needs another name: ds.rename({name}='lat')"
            )
        attrs = {"units": "degrees_north", "standard_name": "latitude", "axis": "Y"}
        changed[name] = (name, 90.0 - degrees, attrs)
    for name, line in lines.items():
        if colatitudes and LONGITUDES.match(name):
            attrs = {"units": "degrees_east", "standard_name": "longitude", "axis": "X"}
            changed[name] = (name, _angles_in_degrees(line, 2 * MOST_RADIANS), attrs)
    return ds.assign_coords(changed)


def _angles_in_degrees(coordinate: xr.DataArray, most_radians: float) -> Floats:
    """Return a colatitude or longitude in degrees, (N,).

    Without a unit, values up to ``most_radians`` are radians, and others degrees.
    """
    values = np.asarray(values_in(coordinate), dtype=float)
    factor = units.factor(str(coordinate.attrs.get("units", "")), "degree")
    if factor is None:
        factor = 1.0
        if np.abs(values).max(initial=0.0) <= most_radians:
            factor = 180.0 / np.pi
    return np.asarray(values * factor)
