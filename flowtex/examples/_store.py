"""Arrays that are shipped as files, in as few bytes as the eye and the tests allow.

Values become whole steps of 1/32000 of the largest one (16 bits), and of those only the
differences from node to node are stored: smooth fields have small differences, which compress
well, and whole numbers add up again without error.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["DATA", "load", "pack", "save", "unpack"]

#: Folder of the shipped files.
DATA = Path(__file__).parent / "data"
#: Whole steps from zero to the largest value; leaves room in 16 bits.
STEPS = 32000


def pack(values: NDArray[np.float64], axis: int) -> tuple[NDArray[np.int16], float]:
    """Whole-numbered differences along an axis, and what one step is worth.

    Parameters
    ----------
    values : ndarray
        Finite numbers.
    axis : int
        Axis along which they are smooth.

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
    unsigned = np.diff(whole.view(np.uint16), axis=axis, prepend=np.uint16(0))
    return unsigned.astype(np.uint16).view(np.int16), step


def unpack(differences: NDArray[np.int16], step: float, axis: int) -> NDArray[np.float64]:
    """Undo :func:`pack`."""
    whole = np.cumsum(differences.view(np.uint16), axis=axis, dtype=np.uint16).view(np.int16)
    return whole.astype(np.float64) * step


def save(path: Path, arrays: Mapping[str, ArrayLike]) -> None:
    """Write arrays to a compressed file; the same arrays give the same bytes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    plain: dict[str, Any] = {name: np.asarray(array) for name, array in arrays.items()}
    np.savez_compressed(path, **plain)


def load(name: str) -> dict[str, NDArray[Any]]:
    """Read a shipped file.

    Parameters
    ----------
    name : str
        Its name in the folder of shipped files.

    Returns
    -------
    dict of str to ndarray

    Raises
    ------
    FileNotFoundError
        When the installation lacks the file.
    """
    path = DATA / name
    if not path.is_file():
        message = (
            f"the example file {name!r} is not in {path.parent}; it comes with flowtex: reinstall "
            "it, or compute the file with: python -m flowtex.examples.build"
        )
        raise FileNotFoundError(message)
    with np.load(path, allow_pickle=False) as file:
        return dict(file)
