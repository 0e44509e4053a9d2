"""Arrays by name as a dataset, for names of components that the reader of datasets knows."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex._util.host_arrays import unit_text
from flowtex.errors import import_extra
from flowtex.field.validation import with_gaps

if TYPE_CHECKING:
    import xarray as xr

#: Names of the axes of grids whose positions have the shape (J, I).
CURVED = ("j", "i")


def named_dataset(
    data: Mapping[str, Any], places: tuple[str, ...], names: Iterable[str], times: Any
) -> xr.Dataset | None:
    """Return the arrays of a grid as a dataset, with the names and units that they have.

    Parameters
    ----------
    data
        Arrays by name.
    places
        The names of the positions along x and y, lines (I,) and (J,) or arrays (J, I).
    names
        Names of the arrays that may be variables; those of other shapes are left out.
    times
        Time of each step, (T,), if known.

    Returns
    -------
    xarray.Dataset or None
        ``None`` where fewer than two arrays are on the grid of the positions.
    """
    along, across = (_without_axis_of_one(with_gaps(name, data[name])) for name in places[:2])
    dims: tuple[str, ...]
    positions: dict[str, tuple[tuple[str, ...], Floats]]
    if along.ndim == across.ndim == 1:
        dims = (places[1], places[0])
        shape = (len(across), len(along))
        positions = {places[0]: (dims[1:], along), places[1]: (dims[:1], across)}
    elif along.ndim == 2 and along.shape == across.shape:
        dims = CURVED
        shape = along.shape
        positions = {places[0]: (dims, along), places[1]: (dims, across)}
    else:
        return None
    variables = {}
    for name in names:
        array = data[name]
        if name in places or np.shape(array)[-2:] != shape or np.ndim(array) > 3:
            continue
        attrs = {}
        unit = unit_text(array)
        if unit:
            attrs["units"] = unit
        all_dims = ("time", *dims)
        variables[name] = (all_dims[-np.ndim(array) :], with_gaps(name, array), attrs)
    if len(variables) < 2:
        return None
    ds: xr.Dataset = import_extra("xarray", "xarray").Dataset(variables, positions)
    if times is not None and "time" in ds.dims:
        ds = ds.assign_coords(time=("time", np.asarray(times)))
    return ds


def _without_axis_of_one(positions: Floats) -> Floats:
    """Return positions as a line (N,) where files of MATLAB have them as (1, N) or (N, 1)."""
    if positions.size == max(positions.shape, default=0):
        return positions.ravel()
    return positions
