"""Arrays in files of few bytes, as :mod:`flowtex.examples._shipped` and xarray read them.

Values become whole steps of 1/32000 of the largest one (16 bits). Of those an NPZ file has only the
differences from node to node.
"""

from __future__ import annotations

import gzip
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

#: Whole steps from zero to the largest value; leaves room in 16 bits.
STEPS = 32000

#: Attributes of the coordinates of datasets.
EAST, NORTH = {"units": "degrees_east"}, {"units": "degrees_north"}
LONGITUDE = {"standard_name": "longitude", "long_name": "longitude", "axis": "X", **EAST}
LATITUDE = {"standard_name": "latitude", "long_name": "latitude", "axis": "Y", **NORTH}


def pack(
    values: NDArray[np.float64], axis: int | tuple[int, ...]
) -> tuple[NDArray[np.int16], float]:
    """Whole-numbered differences along one axis or several, and what one step is worth.

    Parameters
    ----------
    values : ndarray
        Finite numbers.
    axis : int or tuple of int
        Axes along which they are smooth.

    Returns
    -------
    differences : ndarray of int16, same shape
        Differences modulo 2^16.
    step : float
        Size of one step; what is unpacked differs from `values` by at most half of it.
    """
    step = float(np.abs(values).max()) / STEPS or 1.0
    whole = np.round(values / step).astype(np.int16)
    # Unsigned numbers wrap around by definition, and cumulative sums wrap back.
    unsigned = whole.view(np.uint16)
    for each in np.atleast_1d(axis):
        unsigned = np.diff(unsigned, axis=each, prepend=np.uint16(0))
    return unsigned.astype(np.uint16).view(np.int16), step


def save(path: Path, arrays: Mapping[str, ArrayLike]) -> None:
    """Write arrays to a compressed file; the same arrays give the same bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    plain: dict[str, Any] = {name: np.asarray(array) for name, array in arrays.items()}
    np.savez_compressed(path, **plain)


def save_dataset(
    path: Path, variables: dict[str, Any], coordinates: dict[str, Any], title: str
) -> None:
    """Write a dataset to a compressed netCDF file; the same data give the same bytes.

    Each variable has dimensions, values, standard name and unit.
    """
    source = "computed by flowtex.examples from formulas; neither observed nor forecast"
    attributes = {"Conventions": "CF-1.8", "title": title, "source": source}
    named = {
        name: (
            dims,
            values,
            {"standard_name": word, "long_name": word.replace("_", " "), "units": unit},
        )
        for name, (dims, values, word, unit) in variables.items()
    }
    dataset = xr.Dataset(named, coordinates, attributes)
    packed = {
        name: {
            "dtype": "int16",
            "scale_factor": float(np.abs(array).max()) / STEPS,
            "_FillValue": np.int16(-STEPS - 1),
        }
        for name, array in dataset.data_vars.items()
        if array.dtype.kind == "f"
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    content = bytes(dataset.to_netcdf(engine="scipy", encoding=packed))
    path.write_bytes(gzip.compress(content, 9, mtime=0))
