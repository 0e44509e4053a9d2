"""The values of a variable, read where they fit into memory."""

from __future__ import annotations

from typing import Any

import numpy as np

from flowtex._util.array_types import AnyArray
from flowtex.field.io.inspection.limits import check_memory

__all__ = ["values_in"]


def values_in(array: Any) -> AnyArray:
    """Return the values of a variable of xarray's, (...) as it is.

    Raises
    ------
    FieldError
        When they do not fit into memory as numbers of 8 bytes: a small file may declare many.
    """
    check_memory(8 * array.size, f"the variable {getattr(array, 'name', None) or 'without a name'}")
    return np.asarray(array.values)
