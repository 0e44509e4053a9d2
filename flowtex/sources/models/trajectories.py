"""The observations of drifters, floats and particles, by trajectory and time.

Trajectories have the axes (trajectory, observation) or (time, trajectory), or follow each other
along one axis, as CF's ragged arrays and rows of a table do.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import AnyArray, Floats, Indices
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.field.dates import as_seconds
from flowtex.sources.datasets.axes import TIMES, is_dates
from flowtex.sources.models.conventions import position_pairs
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: The type of CF's features that are trajectories.
TRAJECTORY = "trajectory"
#: Names of the number of a trajectory, and of its axis.
IDENTITIES = re.compile(
    r"^(id|ids|\w+_id|traj\w*|drifters?|buoys?|floats?|particles?|platform\w*|wmo\w*|argos\w*)$",
    re.IGNORECASE,
)
#: Names of the number of observations of each trajectory.
COUNTS = re.compile(r"^(row_?size|obs_?count|n_?obs)$", re.IGNORECASE)


class Parts(NamedTuple):
    """Variables of trajectories: longitude and latitude, or x and y, and the time."""

    x: xr.DataArray
    y: xr.DataArray
    time: xr.DataArray


def find_trajectories(ds: xr.Dataset) -> Parts | None:
    """Return the variables of trajectories; ``None`` for data of another kind."""
    arrays = [ds[name] for name in ds.variables]
    is_declared = str(ds.attrs.get("featureType", "")).lower() == TRAJECTORY
    is_declared |= any(array.attrs.get("cf_role") == "trajectory_id" for array in arrays)
    for x, y in position_pairs(arrays):
        time = _time_of(ds, x)
        if time is None:
            continue
        if x.ndim == 2 and (is_declared or _are_moving(ds, x, time)):
            return Parts(x, y, time)
        if x.ndim == 1 and is_declared and time.dims == x.dims and time.name not in x.dims:
            return Parts(x, y, time)
    return None


def _time_of(ds: xr.Dataset, x: xr.DataArray) -> xr.DataArray | None:
    """Return the times of positions, along all their axes or one of two."""
    for name in ds.variables:
        array = ds[name]
        is_named = array.attrs.get("standard_name") == "time" or TIMES.match(str(name))
        is_time = is_dates(array) or array.dtype.kind in "mMfiu"
        if is_named and is_time and array.ndim and {*array.dims} <= {*x.dims}:
            return array
    return None


def _are_moving(ds: xr.Dataset, x: xr.DataArray, time: xr.DataArray) -> bool:
    """Return whether positions are those of points that move, by the names of their axes."""
    dims = [str(dim) for dim in x.dims]
    values = []
    for array in ds.data_vars.values():
        if {*array.dims} == {*dims}:
            values.append(array)
    if time.ndim == 2 or any(map(IDENTITIES.match, dims)):
        return any(map(IDENTITIES.match, dims))
    return len(values) > 1 and bool(TIMES.match(str(time.dims[0])))


@dataclass(frozen=True, eq=False)
class Tracks:
    """Observations in the order of trajectory and time, (N,) each.

    Attributes
    ----------
    columns
        Positions and other variables by name.
    names
        Names of the positions.
    times
        Seconds since the origin, or numbers where the unit is unknown.
    unit
        Unit of the times; empty where unknown.
    first
        Number of the first observation of each trajectory, and that after the last one.
    origin
        The date at time 0; ``None`` for times that are numbers.
    attributes
        Those of the variables.
    """

    columns: Mapping[str, Floats]
    names: tuple[str, str]
    times: Floats
    unit: str
    first: Indices
    origin: Any
    attributes: Mapping[str, Mapping[str, Any]]

    @classmethod
    def of(cls, ds: xr.Dataset, parts: Parts) -> Tracks:
        """Return the observations of trajectories.

        Raises
        ------
        FieldError
            When no observation has a position and a time.
        """
        x, y, time = parts
        names = [str(name) for name in ds.variables if {*ds[name].dims} == {*x.dims}]
        numeric = [name for name in names if ds[name].dtype.kind in "fiu" and name != time.name]
        columns = {}
        for name in numeric:
            if not IDENTITIES.match(name):
                values = values_in(ds[name].transpose(*x.dims))
                columns[name] = np.asarray(values, dtype=float).ravel()
        times, unit, origin = _numbers(time.broadcast_like(x).transpose(*x.dims))
        known = np.isfinite(times + columns[str(x.name)] + columns[str(y.name)])
        if not known.any():
            raise FieldError(
                f"{x.name}, {y.name} and {time.name} are missing everywhere; expected positions "
                "and times of trajectories"
            )
        numbers = np.ravel(_trajectory_numbers(ds, parts))[known]
        order = np.lexsort([times[known], numbers])
        begins = np.flatnonzero(np.diff(numbers[order])) + 1
        return cls(
            {name: values[known][order] for name, values in columns.items()},
            (str(x.name), str(y.name)),
            times[known][order],
            unit,
            np.concatenate([[0], begins, [len(numbers)]]),
            origin,
            {name: dict(ds[name].attrs) for name in columns},
        )

    @property
    def count(self) -> int:
        """Number of trajectories."""
        return len(self.first) - 1


def _numbers(time: xr.DataArray) -> tuple[Floats, str, Any]:
    """Return times as numbers, (N,), their unit, and the date at 0."""
    values = np.ravel(values_in(time))
    if values.dtype.kind == "m":
        return _of_spans(values), "s", None
    if values.dtype.kind == "M":
        known = values[~np.isnat(values)]
        if len(known):
            origin = known.min()
        else:
            origin = np.datetime64(0, "s")
        _, _, start = as_seconds(np.array([origin]), "")
        return _of_spans(values - origin), "s", start
    if values.dtype.kind == "O":
        seconds, _, start = as_seconds(values, "")
        return np.asarray(seconds, dtype=float), "s", start
    unit = str(time.attrs.get("units", ""))
    factor = units.factor(unit, "s")
    if factor is None:
        return values.astype(float), "", None
    return values * factor, "s", None


def _of_spans(values: AnyArray) -> Floats:
    """Return spans of time in seconds, NaN where they are missing."""
    seconds = values / np.timedelta64(1, "s")
    return np.where(np.isnat(values), np.nan, seconds)


def _trajectory_numbers(ds: xr.Dataset, parts: Parts) -> AnyArray:
    """Return the number of the trajectory of each position."""
    x, _, time = parts
    if x.ndim == 1:
        return _ragged_numbers(ds, x)
    named = [axis for axis, dim in enumerate(x.dims) if IDENTITIES.match(str(dim))]
    axis = 0
    if time.ndim == 1:
        axis = 1 - x.dims.index(time.dims[0])
    elif named:
        axis = named[0]
    return np.indices(x.shape)[axis]


def _ragged_numbers(ds: xr.Dataset, x: xr.DataArray) -> AnyArray:
    """Return the number of the trajectory of each observation along one axis."""
    (dim,) = x.dims
    for name in ds.variables:
        array = ds[name]
        is_count = array.attrs.get("sample_dimension") == dim or COUNTS.match(str(name))
        if is_count and array.ndim == 1:
            counts = np.asarray(values_in(array), dtype=int)
            if counts.sum() == x.size:
                return np.repeat(np.arange(len(counts)), counts)
    for name in ds.variables:
        array = ds[name]
        is_identity = array.attrs.get("cf_role") == "trajectory_id" or IDENTITIES.match(str(name))
        is_identity = is_identity or "instance_dimension" in array.attrs
        if array.dims == x.dims and is_identity:
            return np.unique(values_in(array), return_inverse=True)[1]
    return np.zeros(x.size, dtype=int)
