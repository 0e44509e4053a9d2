"""Components that lie on the sides of cells, as means in the middle of the cells (Arakawa C).

Along its own axis a component has one value for each side. Where the cells of the middle are
numbered c, the sides beside cell c are those numbered c + first and c + first + 1.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.field.io.inspection.limits import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Paddings of SGRID, and the first side that they stand for.
PADDINGS = {"none": 0, "high": 0, "low": -1, "both": -1}


@dataclass(frozen=True)
class Sides:
    """Sides of cells along an axis.

    ``first`` and ``count`` number them as above, for so many cells; ``wraps`` where the axis goes
    around the Earth.
    """

    first: int
    sides: int
    cells: int
    wraps: bool = False

    @property
    def known(self) -> slice:
        """The cells that have a side to both sides."""
        if self.wraps:
            return slice(0, self.cells)
        return slice(max(0, -self.first), min(self.cells, self.sides - self.first - 1))


def centred(values: Floats, axis: int, sides: Sides) -> Floats:
    """Return means of two sides at the known cells; a side that is missing is a wall, with zero.

    ``values`` are NaN at walls. Where both sides are, the mean is NaN.
    """
    cells = np.arange(sides.cells)[sides.known]
    before, after = cells + sides.first, cells + sides.first + 1
    if sides.wraps:
        before, after = before % sides.sides, after % sides.sides
    one, other = np.take(values, before, axis=axis), np.take(values, after, axis=axis)
    mean = (np.nan_to_num(one) + np.nan_to_num(other)) / 2
    mean[np.isnan(one) & np.isnan(other)] = np.nan
    return np.asarray(mean)


def first_side(
    side: str, cell: str, counts: tuple[int, int], datasets: Sequence[xr.Dataset]
) -> int:
    """Return the number of the side before the first cell, for dimensions of so many of each."""
    sides, cells = counts
    if sides != cells:
        return 0 if sides > cells else -1
    told = shift_told(side, cell, datasets)
    if told is not None:
        return told
    lines = [_line(name, datasets) for name in (side, cell)]
    if lines[0] is not None and lines[1] is not None:
        rising = lines[1][-1] > lines[1][0]
        return 0 if (lines[0][0] < lines[1][0]) == rising else -1
    # MITgcm counts the side on the left of a cell, and most others the one on its right.
    return 0 if re.search(r"g$|_l(eft)?$", side, re.IGNORECASE) else -1


def shift_told(side: str, cell: str, datasets: Sequence[xr.Dataset]) -> int | None:
    """Return the same where COMODO's or SGRID's attributes tell it."""
    for ds in datasets:
        shift = ds[side].attrs.get("c_grid_axis_shift") if side in ds.variables else None
        if shift is not None:
            return 0 if float(shift) < 0 else -1
        for variable in ds.variables.values():
            if variable.attrs.get("cf_role") != "grid_topology":
                continue
            texts = " ".join(str(v) for v in variable.attrs.values())
            for one, two, padding in re.findall(r"(\w+):\s*(\w+)\s*\(padding:\s*(\w+)\)", texts):
                if (one, two) == (cell, side):
                    return PADDINGS.get(padding)
    return None


def _line(name: str, datasets: Sequence[xr.Dataset]) -> Any:
    for ds in datasets:
        if name in ds.coords and ds[name].ndim == 1 and ds[name].dtype.kind in "fiu":
            values = np.asarray(values_in(ds[name]), dtype=float)
            # Numbers of the nodes alone tell nothing.
            return None if np.array_equal(values, np.arange(len(values)) + values[0]) else values
    return None
