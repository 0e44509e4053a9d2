"""Arrays in files of few bytes, as :func:`flowtex.examples._shipped.unpack` reads them.

Values become whole steps of 1/32000 of the largest one (16 bits), and of those only the
differences from node to node are stored.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Whole steps from zero to the largest value; leaves room in 16 bits.
STEPS = 32000


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
