"""Columns with several levels, and tables whose rows and columns are positions.

``df.pivot(index="y", columns="x", values=["u", "v"])`` has names in one level and positions in the
other one; ``df.pivot(index="y", columns="x", values="u")`` has positions alone.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from flowtex.errors import import_extra
from flowtex.field import units

if TYPE_CHECKING:
    import xarray as xr

#: Beginning of the names that pandas gives to blank cells of a header.
BLANK = "Unnamed: "


def has_positions(table: Any) -> bool:
    """Return whether the columns of a table are positions, so that it is one component."""
    columns = getattr(table, "columns", None)
    if getattr(columns, "nlevels", 0) != 1 or len(table.columns) < 2:
        return False
    return _is_number(columns)


def as_array(table: Any) -> xr.DataArray:
    """Return a table of one component as an array; rows without a name are along y."""
    dims = (table.index.name or "y", table.columns.name or "x")
    lines = (table.index, table.columns)
    xarray = import_extra("xarray", "xarray")
    array: xr.DataArray = xarray.DataArray(table.to_numpy(), lines, dims)
    return array


def with_one_level(frame: Any) -> Any:
    """Return a table whose columns have one level; positions among them become rows."""
    columns = frame.columns
    if columns.nlevels == 1:
        return frame
    positions = []
    for level in range(columns.nlevels):
        if _is_number(columns.get_level_values(level)):
            positions.append(level)
    if positions and len(positions) < columns.nlevels:
        names = list(columns.names)
        names[positions[-1]] = names[positions[-1]] or "x"
        frame = frame.rename_axis(columns=names)
        if frame.index.nlevels == 1:
            frame = frame.rename_axis(index=frame.index.name or "y")
        frame = frame.stack(positions)
    if frame.columns.nlevels > 1:
        last = map(str, frame.columns.get_level_values(-1))
        has_units = any(units.measures(label.strip("[]()"), units.VELOCITIES) for label in last)
        frame = frame.set_axis(
            [_name(labels, has_units=has_units) for labels in frame.columns], axis=1
        )
    return frame


def _name(labels: Iterable[Any], *, has_units: bool) -> str:
    """Return the name of a column with several labels, of which the last one may be its unit."""
    words = []
    for label in map(str, labels):
        if label and not label.startswith(BLANK):
            words.append(label)
    if has_units and len(words) > 1:
        unit = words.pop().strip("[]()")
        return f"{'_'.join(words)} [{unit}]"
    return "_".join(words)


def _is_number(labels: Any) -> bool:
    return bool(import_extra("pandas", "xarray").api.types.is_numeric_dtype(labels.dtype))
