"""Arrays with an axis of two or three components, which become variables of their own."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from flowtex.errors import FieldError

if TYPE_CHECKING:
    import xarray as xr

#: Names of an axis of components without labels.
AXES = re.compile(r"^(two|three|vdims?|n?comp\w*|n?vec\w*|uvw?|xyz?)$", re.IGNORECASE)
#: Labels of components; a prefix as in ``m_x`` is ignored.
LABELS = re.compile(
    r"^(?:.*[_\W])?(?:([xu]|east\w*|zonal)|([yv]|north\w*|meridional)|([zw]|up\w*|vertical))$", re.I
)
#: Labels of directions on the Earth, and the names of components along these.
EARTH = re.compile(r"east|zonal|north|meridional", re.IGNORECASE)
EARTHWARD = ("eastward", "northward", "upward")
#: Names of the ends of intervals, which are two as well.
BOUNDS = re.compile(r"bnd|bound", re.IGNORECASE)
#: Attributes that components keep.
KEPT = ("units", "grid_mapping", "mesh", "location")


def of_array(array: xr.DataArray, *, several: bool) -> xr.Dataset:
    """Return the dataset of the components of an array; one of several may be a component."""
    dim = _axis(array)
    if dim is None:
        if not several or array.name is None:
            dims = ", ".join(f"{name}: {size}" for name, size in array.sizes.items())
            msg = (
                f"data is the DataArray {array.name!r} ({dims}) of one scalar; expected an axis of "
                "two or three components, such as 'component', or a Dataset with both components"
            )
            raise FieldError(msg)
        return array.to_dataset()
    named = array.rename("flow").to_dataset()
    return _split(named, "flow", dim, prefix="")


def split_components(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset in which variables with an axis of components are several."""
    for name, array in list(ds.data_vars.items()):
        dim = _axis(array)
        if dim is not None:
            ds = _split(ds, str(name), dim, prefix=f"{name}_")
    return ds


def _axis(array: xr.DataArray) -> str | None:
    """Return the dimension of the components."""
    if array.dtype.kind != "f" or array.ndim < 2 or BOUNDS.search(str(array.name)):
        return None
    for dim in (str(d) for d in array.dims if array.sizes[d] in (2, 3)):
        labels = array.coords.get(dim)
        texts = [] if labels is None or labels.dtype.kind not in "UO" else labels.values.tolist()
        if texts and all(LABELS.match(str(text)) for text in texts):
            return dim
        if not texts and AXES.match(dim):
            return dim
    return None


def _split(ds: xr.Dataset, name: str, dim: str, prefix: str) -> xr.Dataset:
    array = ds[name]
    count = array.sizes[dim]
    labels = [str(v) for v in array.coords[dim].values] if dim in array.coords else []
    matches = [LABELS.match(label) for label in labels]
    numbers = [m.lastindex or 0 for m in matches if m]
    places = [number - 1 for number in numbers] if len(numbers) == count else list(range(count))
    plane = _plane(array, dim)
    are_axes = all(label[-1:].lower() in "xyz" for label in labels)
    drawn = plane if plane and (count == 3 or are_axes or set(places) != {0, 1}) else [0, 1]
    if count == 2 and not numbers:
        places = drawn
    if not set(drawn) <= set(places):
        axes = " and ".join("xyz"[n] for n in drawn)
        msg = (
            f"{name!r} has the components {', '.join(labels)} along {dim!r} on the axes {axes}; "
            "expected components along these axes"
        )
        raise FieldError(msg)
    words = EARTHWARD if all(map(EARTH.search, labels[:2])) and labels else "uvw"
    order = [*drawn, *(n for n in range(3) if n in places and n not in drawn)]
    parts: dict[str, Any] = {}
    for word, place in zip(words, order, strict=False):
        part = array.isel({dim: places.index(place)}, drop=True)
        part.attrs = {key: value for key, value in array.attrs.items() if key in KEPT}
        parts[f"{prefix}{word}"] = part
    ds = ds.drop_vars([name]).assign(parts)
    return _upright(ds, array, plane) if plane not in ([], [0, 1]) else ds


def _plane(array: xr.DataArray, dim: str) -> list[int]:
    """Return the numbers of the two axes x, y, z along which an array lies; empty for others."""
    lengths = {str(d).lower(): n for d, n in array.sizes.items() if str(d) != dim}
    axes = [n for n, letter in enumerate("xyz") if lengths.get(letter, 1) > 1]
    return axes if len(axes) == 2 else []


def _upright(ds: xr.Dataset, array: xr.DataArray, plane: list[int]) -> xr.Dataset:
    """Return a dataset in the plane x, y instead of x, z or y, z."""
    names = {str(d).lower(): str(d) for d in array.dims}
    changes = {names["xyz"[n]]: letter for n, letter in zip(plane, "xy", strict=True)}
    free = {old: new for old, new in changes.items() if old != new}
    ds = ds.drop_vars([n for n in free.values() if n in ds.variables and n not in free])
    ds = ds.squeeze([n for n in free.values() if n in ds.dims and n not in free], drop=True)
    return ds.rename(free)
