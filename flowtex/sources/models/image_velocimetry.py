"""Datasets of particle image velocimetry, as PIVPy has them: displacements in pixels, and flags."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from flowtex.field import units
from flowtex.sources.notices import NOTE

if TYPE_CHECKING:
    import xarray as xr

#: Names of components.
COMPONENT = re.compile(r"^([uvw]|velocity(_\w+)?|displacement(_\w+)?)$", re.IGNORECASE)
#: The flag of vectors, which programs other than Insight write with other meanings.
FLAG = "chc"
#: Dimension of pixels.
PIXELS = ("[printing_unit]",)


def with_image_units(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose displacements in pixels are velocities, and whose flags are known."""
    changes: dict[str, xr.DataArray] = {}
    for name, array in ds.data_vars.items():
        unit = str(array.attrs.get("units", ""))
        if array.ndim > 1 and COMPONENT.match(str(name)) and units.measures(unit, PIXELS):
            changes[str(name)] = array.assign_attrs(units=f"{unit}/frame")
    note = ""
    if changes:
        note = f"{', '.join(changes)}: pixels are displacements from frame to frame"
    changes |= _flags(ds)
    if not changes:
        return ds
    changed = ds.assign(changes)
    if note:
        changed.encoding[NOTE] = note
    return changed


def _flags(ds: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the flag and the mask of vectors with attributes that say which are bad."""
    if FLAG not in ds or not any(map(COMPONENT.match, map(str, ds.data_vars))):
        return {}
    flags = {}
    status = {"standard_name": "status_flag", "flag_meanings": "good rejected"}
    values = np.unique(np.nan_to_num(ds[FLAG].values))
    bad = values[values <= 0]
    if (values < 0).any():  # others do not mark bad vectors by a sign
        meanings = ["good", *(f"rejected_{value:g}" for value in bad)]
        marks = {"flag_values": [1.0, *bad.tolist()], "flag_meanings": " ".join(meanings)}
        flags[FLAG] = ds[FLAG].assign_attrs(status | marks)
    if "mask" in ds:
        flags["mask"] = ds["mask"].assign_attrs(status | {"flag_values": [0, 1]})
    return flags
