"""The coordinates of a dataset on which its user wants a flow, as ``x=`` and ``y=`` of xarray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flowtex._util.arguments import near_names
from flowtex.errors import FieldError
from flowtex.sources.datasets.axes import LEVEL, TIME, axis_kind
from flowtex.sources.datasets.coordinates import ACROSS, LATITUDE, LONGITUDE, UPWARD

if TYPE_CHECKING:
    import xarray as xr


def placed_on(ds: xr.Dataset, x: str | None, y: str | None, *, as_dims: bool = False) -> xr.Dataset:
    """Return a dataset whose only positions are two coordinates, across and upward.

    The user gave them as ``dims`` or, by default, as ``x`` and ``y``.

    Raises
    ------
    FieldError
        When one of the coordinates is missing, they are exchanged, or they do not span a surface.
    """
    if x is None and y is None:
        return ds
    if x is None or y is None:
        raise FieldError(f"x is {x!r} and y is {y!r}; expected the names of both, or none")
    given = f"x is {x!r} and y is {y!r}"
    exchanged = f"x={y!r}, y={x!r}"
    if as_dims:
        given = f"dims is '{x},{y}'"
        exchanged = f"dims='{y},{x}'"
    for name in (x, y):
        if name not in ds.variables:
            hint = near_names(name, map(str, ds.coords))
            raise FieldError(f"{given}, but the data have no {name!r}; {hint}")
    if _are_exchanged(x, y):
        raise FieldError(
            f"{given}, which are exchanged; use {exchanged}: flows are drawn with north, or y, up"
        )
    across = ds[x]
    upward = ds[y]
    are_lines = across.ndim == upward.ndim == 1 and across.dims != upward.dims
    if not are_lines and (across.ndim != 2 or {*across.dims} != {*upward.dims}):
        raise FieldError(
            f"{given}, along {', '.join(map(str, across.dims))} and "
            f"{', '.join(map(str, upward.dims))}; expected two axes, or two coordinates over both"
        )
    surface = {*across.dims, *upward.dims}
    for other, line in ds.coords.items():
        if other not in (x, y) and line.ndim and {*line.dims} <= surface:
            ds = ds.drop_vars([other])
    if are_lines:
        changed = {line.dims[0]: line.name for line in (across, upward)}
        ds = ds.swap_dims({old: new for old, new in changed.items() if old != new})
    for name, letter in ((x, "X"), (y, "Y")):
        if not _is_known(ds, name):
            ds = ds.assign_coords({name: ds[name].assign_attrs(axis=letter)})
    return ds


def _are_exchanged(x: str, y: str) -> bool:
    """Return whether longitude and latitude, or x and y, are exchanged."""
    for first, second in ((LATITUDE, LONGITUDE), (UPWARD, ACROSS)):
        if first.match(x) and second.match(y):
            return True
    return False


def _is_known(ds: xr.Dataset, name: str) -> bool:
    """Return whether the name of a coordinate tells where it leads."""
    if any(pattern.match(name) for pattern in (LONGITUDE, LATITUDE, ACROSS, UPWARD)):
        return True
    array = ds[name]
    return array.ndim == 1 and axis_kind(array, str(array.dims[0])) in (LEVEL, TIME)
