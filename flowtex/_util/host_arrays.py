"""Arrays of other libraries as arrays of NumPy: PyTorch, JAX, CuPy, pint, astropy and xarray.

No library is loaded: ``__array__`` and DLPack are what they all have.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError

#: Kinds of NumPy types that are numbers: whole, real and complex.
NUMBERS = "iufc"


def is_array(value: Any) -> bool:
    """Return whether a value is an array of any library, or nested lists of numbers or arrays."""
    while isinstance(value, (list, tuple)):
        if not value:
            return False
        value = value[0]
        if isinstance(value, (int, float, complex)) and not isinstance(value, bool):
            return True
    has_values = hasattr(value, "__array__") or hasattr(value, "__dlpack__")
    return has_values and not isinstance(value, (str, bytes, type))


def host_array(name: str, value: Any) -> AnyArray:
    """Return the values of an array in the memory of the processor, without their unit.

    Masked arrays stay masked. Raises a FieldError that names the argument if this fails.
    """
    value = _without_gradient(_magnitude(value))
    if np.ma.isMaskedArray(value):
        masked: AnyArray = value
        return masked
    if isinstance(value, (list, tuple)) and any(map(np.ma.isMaskedArray, value)):
        return np.ma.asarray(np.ma.stack(value))
    try:
        if hasattr(value, "__dlpack__") and not hasattr(value, "__array__"):
            return _by_dlpack(value)
        return np.asarray(value)
    except (TypeError, ValueError, RuntimeError, BufferError) as error:
        return _from_device(name, value, error)


def unit_text(value: Any) -> str:
    """Return the unit that an array carries, as pint, astropy, unyt and xarray have it, or ""."""
    unit = getattr(value, "units", getattr(value, "unit", ""))
    if isinstance(value, Sequence) or callable(unit):
        return ""
    text = str(unit)
    if text == "dimensionless":
        return ""
    return text


def _magnitude(value: Any) -> Any:
    """Return the values of a quantity, which warns if its unit is lost."""
    if hasattr(value, "magnitude") and hasattr(value, "units"):
        return value.magnitude
    return value


def _without_gradient(value: Any) -> Any:
    if hasattr(value, "detach"):
        return value.detach()
    return value


def _by_dlpack(value: Any) -> AnyArray:
    try:
        return np.from_dlpack(value, device="cpu")
    except TypeError:  # NumPy 2.0, or a library without the argument, has no choice of devices
        return np.from_dlpack(value)


def _from_device(name: str, value: Any, error: Exception) -> AnyArray:
    """Copy an array from a graphics card, where NumPy alone could not read it."""
    reason: Exception = error
    if hasattr(value, "__dlpack__"):
        try:
            return _by_dlpack(value)
        except (TypeError, ValueError, RuntimeError, BufferError) as other:
            reason = other
    text = f"{name} is not an array ({reason}); expected real numbers, the same number in every row"
    if is_array(value) and not isinstance(value, (list, tuple)):
        text = (
            f"{name} is an array that NumPy cannot read ({reason}); copy it into the memory of the "
            f"processor first, as in {name}.cpu() or {name}.get()"
        )
    raise FieldError(text) from error
