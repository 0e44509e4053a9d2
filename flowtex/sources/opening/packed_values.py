"""Attributes of packed values that some programs write as text, such as the scale "0.005"."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flowtex.errors import FieldError
from flowtex.sources.datasets.masks import declared_numbers

if TYPE_CHECKING:
    import xarray as xr

#: Attributes that must be numbers.
NUMBERS = ("scale_factor", "add_offset", "missing_value", "_FillValue")


def has_texts(ds: xr.Dataset) -> bool:
    """Return whether a file was unpacked with texts, which gives no numbers."""
    for variable in ds.variables.values():
        if any(isinstance(variable.encoding.get(name), str) for name in NUMBERS):
            return True
    return False


def with_numbers(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset, not unpacked, in which these attributes of numbers are numbers.

    Raises
    ------
    FieldError
        When a text is no number, or xarray has unpacked the values with it.
    """
    _check_unpacked(ds)
    texts = []
    for key, variable in ds.variables.items():
        if variable.dtype.kind in "iuf":
            texts += [(key, n) for n in NUMBERS if isinstance(variable.attrs.get(n), str)]
    if not texts:
        return ds
    ds = ds.copy()
    for key, name in texts:
        number = declared_numbers(ds[key], name)[0]
        if name in ("missing_value", "_FillValue"):
            ds[key].attrs[name] = ds[key].dtype.type(number)
        else:
            ds[key].attrs[name] = number
    return ds


def _check_unpacked(ds: xr.Dataset) -> None:
    for key, variable in ds.variables.items():
        for name in NUMBERS:
            value = variable.encoding.get(name)
            if isinstance(value, str):
                raise FieldError(
                    f"{key} has the {name} {value!r} as text, with which xarray cannot unpack it; "
                    "open the file with xarray.open_dataset(path, mask_and_scale=False)"
                )
