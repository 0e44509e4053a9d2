"""Alignment of the second component, and of further variables, with the first one by labels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.arguments import is_number
from flowtex._util.array_types import AnyArray
from flowtex.errors import FieldError
from flowtex.field import units
from flowtex.sources.datasets import labels
from flowtex.sources.datasets.axes import (
    LEVEL,
    TIME,
    Choice,
    as_slice,
    axis_kind,
    further_axes,
    is_dates,
    line_of,
)
from flowtex.sources.notices import Record

if TYPE_CHECKING:
    import xarray as xr


def align(
    u: xr.DataArray, v: xr.DataArray, choice: Choice, record: Record
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return two components on the labels that both have, with the axes of the first.

    Raises
    ------
    FieldError
        When one component has further axes or other scalar labels than the other, or the two have
        no labels in common along an axis.
    """
    axes = [further_axes(array) for array in (u, v)]
    for kind in [k for k in (*axes[0], *axes[1]) if (k in axes[0]) != (k in axes[1])]:
        n = 0 if kind in axes[0] else 1
        array = (u, v)[n]
        dim = axes[n].pop(kind)
        if array.sizes[dim] != 1:
            raise FieldError(
                f"{u.name} has {', '.join(map(str, u.dims))} and {v.name} "
                f"{', '.join(map(str, v.dims))}; select along the axes that differ first"
            )
        u, v = (array.isel({dim: 0}), v) if n == 0 else (u, array.isel({dim: 0}))
    _check_scalars(u, v)
    for kind, dim in axes[0].items():
        other = axes[1][kind]
        indexes = u.indexes.get(dim), v.indexes.get(other)
        if dim == other and indexes[0] is not None and indexes[0].equals(indexes[1]):
            continue
        lines = [line_of(u, dim), line_of(v, other)]
        named = [
            str(a.coords[d].attrs.get("units", "")) if d in a.coords else ""
            for a, d in ((u, dim), (v, other))
        ]
        factor = units.factor(named[1], named[0]) if named[0] != named[1] else None
        if factor is not None and lines[1] is not None and lines[1].dtype.kind in "fiu":
            record("align", f"{other} of {v.name} converted from {named[1]} to {named[0]}")
            lines[1] = lines[1] * factor
        if lines[0] is not None and lines[1] is not None:
            found = common(u, v, dim, lines[0], lines[1], record)
            kept = lines[0][found.one]
            chosen = {name: choice.sel[name] for name in (dim, kind) if name in choice.sel}
            for name, target in chosen.items() if kept.dtype.kind in "fiu" else ():
                wanted = np.array([float(target)]) if is_number(target) else kept
                one = any(len(labels.match(wanted, line).one) for line in (lines[0], lines[1]))
                if one and not len(labels.match(wanted, kept).one):
                    text = f"only one of the components has the {name} {target}; both have "
                    raise FieldError(text + labels.text(kept))
            u, v = u.isel({dim: as_slice(found.one)}), v.isel({other: as_slice(found.other)})
        elif u.sizes[dim] != v.sizes[other]:
            raise FieldError(
                f"{u.name} has {u.sizes[dim]} values along {dim} and {v.name} {v.sizes[other]}; "
                f"add coordinates to align them by, as in ds.assign_coords({dim}=...)"
            )
        v = renamed(v, {other: dim}, u)
    return u, v


def common(
    u: xr.DataArray, v: xr.DataArray, dim: str, one: AnyArray, other: AnyArray, record: Record
) -> labels.Match:
    """Return where two variables have common labels, and record how many others there are.

    Parameters
    ----------
    u
        A variable.
    v
        Another variable.
    dim
        The dimension that both have.
    one
        Labels of the first variable along it.
    other
        Labels of the second variable along it.
    record
        Record of what was done.

    Raises
    ------
    FieldError
        When they have no label in common.
    """
    found = labels.match(one, other)
    if not len(found.one):
        raise FieldError(
            f"{u.name} and {v.name} have no {dim} in common: {u.name} has {labels.text(one)}, and "
            f"{v.name} {labels.text(other)}. Give both at the same {dim}"
        )
    left_out = []
    for array, line in ((u, one), (v, other)):
        if len(found.one) < len(np.unique(line[line == line])):
            left_out.append(f"{len(line) - len(found.one)} of {len(line)} of {array.name}")
    if left_out:
        text = f"{dim}: {' and '.join(left_out)} are left out, as only one component has them"
        record("align", text, notable=True)
    if len(found.other) > 1 and (np.diff(found.other) < 0).all():
        record("align", f"{v.name}: {dim} reversed to match {u.name}")
    return found


def renamed(array: xr.DataArray, names: dict[str, str], like: xr.DataArray) -> xr.DataArray:
    """Return a variable with other names of dimensions, and the labels of another variable."""
    dims = {}
    for one, other in names.items():
        if one != other:
            dims[one] = other
    clash = [n for n in (*dims.values(), *names) if n in array.coords]
    array = array.drop_vars(clash).rename(dims)
    lines = {}
    for name, c in like.coords.items():
        if c.ndim == 1 and c.dims[0] in names.values():
            lines[name] = c
    return array.drop_vars([n for n in lines if n in array.coords]).assign_coords(lines)


def _check_scalars(u: xr.DataArray, v: xr.DataArray) -> None:
    """Raise for components that were selected at different times or levels."""
    for name, one in u.coords.items():
        other = v.coords.get(name)
        if one.ndim or other is None or other.ndim or name in (*u.dims, *v.dims):
            continue
        is_choice = is_dates(one) or axis_kind(u, str(name)) in (TIME, LEVEL)
        values = np.atleast_1d(one.values), np.atleast_1d(other.values)
        known = (values[0] == values[0]).all()
        if is_choice and known and not len(labels.match(values[0], values[1]).one):
            raise FieldError(
                f"{u.name} is at {name} {labels.text(values[0])} and {v.name} at "
                f"{labels.text(values[1])}; give both at the same {name}"
            )
