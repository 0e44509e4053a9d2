"""Arrays with an axis of components, or of complex values, as datasets with a variable for each.

Labels along the axis name the components, such as x and y, u and v, E and N. Without such labels
the name of the axis tells it, and of a single array its size: two or three.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex.errors import FieldError
from flowtex.sources.datasets.coordinates import LATITUDE, LONGITUDE
from flowtex.sources.datasets.select import AROUND, RADIAL
from flowtex.sources.notices import NOTE

if TYPE_CHECKING:
    import xarray as xr

#: Names of an axis of components without labels.
AXES = re.compile(r"^(two|three|vdims?|n?comp\w*|n?vec\w*|uvw?|xyz?)$", re.IGNORECASE)
#: Names of axes of space and time, which have no components even if two or three long.
PLACES = re.compile(r"^([xyz]|lev\w*|depth|height|altitude|plev|pressure|t|time\w*|date)$", re.I)
#: Names that xarray gives to axes without a name.
UNNAMED = re.compile(r"^dim_\d+$")
#: Labels of components, a group for each; a prefix as in ``m_x``, ``vx`` or ``Bx`` is ignored.
LABELS = (
    re.compile(
        r"^(?:.*[_\W])?(?:([xu]|east\w*|zonal)|([yv]|north\w*|meridional)|([zw]|up\w*|vertical))$",
        re.I,
    ),
    re.compile(r"^[a-z]?(?:(x)|(y)|(z))$", re.I),
    re.compile(r"^(?:(x|u|east\w*|zonal)|(y|v|north\w*|meridional)|(z|w|up\w*))[_\W].*$", re.I),
    re.compile(r"^(?:(e)|(n)|(u))$", re.I),
)
#: Labels of directions on the Earth, and the names of components along these.
EARTH = re.compile(r"east|zonal|north|meridional|^[en]$", re.IGNORECASE)
EARTHWARD = ("eastward", "northward", "upward")
#: Names of components along polar coordinates.
POLARWARD = ("u_r", "u_phi", "w")
#: Names of the ends of intervals, which are two as well.
BOUNDS = re.compile(r"bnd|bound", re.IGNORECASE)
#: Components of a profiler with four beams: E, N and two others, such as the error.
OF_BEAMS = 4
#: Attributes that components keep.
KEPT = ("units", "grid_mapping", "mesh", "location", "description", "GRIB_uvRelativeToGrid")


def of_array(array: xr.DataArray, *, several: bool) -> xr.Dataset:
    """Return the dataset of the components of an array; one of several may be a component.

    Raises
    ------
    FieldError
        When a single array has no axis of components, or several axes may be the one.
    """
    if array.dtype.kind == "c":
        return _counted(_of_complex(array.rename("flow").to_dataset(), "flow", prefix=""))
    dim = _axis(array)
    note = ""
    if dim is None and not several:
        dim = _by_size(array)
        if dim is not None:
            note = f"the components lie along {dim}, by its size, in the order u, v"
    if dim is not None:
        ds = _counted(_split(array.rename("flow").to_dataset(), "flow", dim, prefix=""))
        notes = filter(None, (note, ds.encoding.get(NOTE)))
        ds.encoding[NOTE] = "; ".join(notes)
        return ds
    if not several or array.name is None:
        raise FieldError(
            f"data is the DataArray {array.name!r} ({_sizes(array)}) of one scalar; expected "
            "an axis of two or three components, such as 'component', or a Dataset with both"
        )
    return array.to_dataset()


def split_components(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset in which variables with components are several."""
    for name, array in list(ds.data_vars.items()):
        if array.dtype.kind == "c":
            ds = _of_complex(ds, str(name), prefix=f"{name}_")
            continue
        if array.dtype.kind == "f":
            dim = _axis(array)
        else:
            dim = None
        if dim is not None:
            ds = _split(ds, str(name), dim, prefix=f"{name}_")
    return ds


def _of_complex(ds: xr.Dataset, name: str, prefix: str) -> xr.Dataset:
    """Return a dataset in which a variable u + iv is two."""
    array = ds[name]
    parts = {f"{prefix}u": array.real, f"{prefix}v": array.imag}
    for part in parts.values():
        part.attrs = _kept(array)
    return ds.drop_vars([name]).assign(parts)


def _kept(array: xr.DataArray) -> dict[str, Any]:
    found = {}
    for key, value in array.attrs.items():
        if key in KEPT:
            found[key] = value
    return found


def _labels(array: xr.DataArray, dim: str) -> list[str]:
    """Return labels along an axis that are texts; none for numbers.

    Of four, as of acoustic profilers, the first two are components.
    """
    line = array.coords.get(dim)
    if line is None or line.dtype.kind not in "UOT":
        return []
    labels = list(map(str, line.values))
    if len(labels) == OF_BEAMS:
        return labels[:2]
    return labels


def _numbers(labels: Sequence[str]) -> list[int]:
    """Return the numbers of the components that labels name, from 0; none if they name others."""
    for pattern in LABELS:
        matches = list(map(pattern.match, labels))
        numbers = []
        for match in matches:
            if match:
                numbers.append((match.lastindex or 0) - 1)
        if len(set(numbers)) == len(labels):
            return numbers
    return []


def _are_polar(labels: Sequence[str]) -> bool:
    """Return whether two labels are those of components along a radius and around it."""
    if len(labels) < 2:
        return False
    return bool(RADIAL.match(labels[0]) and AROUND.match(labels[1]))


def _axis(array: xr.DataArray) -> str | None:
    """Return the axis whose labels or name are those of components."""
    if array.dtype.kind not in "fiu" or array.ndim < 2 or BOUNDS.search(str(array.name)):
        return None
    for dim in map(str, array.dims):
        if array.sizes[dim] not in (2, 3, OF_BEAMS):
            continue
        labels = _labels(array, dim)
        if _numbers(labels) or _are_polar(labels):
            return dim
        if not labels and AXES.match(dim) and array.sizes[dim] != OF_BEAMS:
            return dim
    return None


def _by_size(array: xr.DataArray) -> str | None:
    """Return the only axis of length 2 or 3 apart from space and time."""
    if array.ndim < 3:
        return None
    found = []
    for dim in map(str, array.dims):
        is_place = PLACES.match(dim) or LONGITUDE.match(dim) or LATITUDE.match(dim)
        if array.sizes[dim] not in (2, 3) or is_place or BOUNDS.search(dim):
            continue
        line = array.coords.get(dim)
        counted = line is not None and line.dtype.kind in "iu" and line.values[0] in (0, 1)
        if line is None or _labels(array, dim) or counted:
            found.append(dim)
    if len(found) > 1:
        raise FieldError(
            f"the DataArray {array.name!r} has the sizes {_sizes(array)}, and its components may "
            f"lie along {' or '.join(found)}; name the axis, as in "
            f"da.rename({{{found[0]!r}: 'component'}})"
        )
    if found:
        return found[0]
    return None


def _sizes(array: xr.DataArray) -> str:
    return str(dict(array.sizes))


def _counted(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset whose nodes have positions, 0, 1, 2, ... where it has no coordinates."""
    first = next(iter(ds.data_vars.values()))
    surface = list(map(str, first.dims[-2:]))
    used: set[str] = set()
    for line in first.coords.values():
        used.update(map(str, line.dims))
    if used & set(surface) or len(surface) < 2:
        return ds
    if all(map(UNNAMED.match, surface)):
        # Rows are along y, as in plain arrays.
        ds = ds.rename({surface[0]: "y", surface[1]: "x"})
        surface = ["y", "x"]
    rows, columns = first.shape[-2:]
    counted = {surface[0]: np.arange(float(rows)), surface[1]: np.arange(float(columns))}
    ds = ds.assign_coords(counted)
    ds.encoding[NOTE] = f"{' and '.join(surface)} have no coordinates; nodes are counted from 0"
    return ds


def _split(ds: xr.Dataset, name: str, dim: str, prefix: str) -> xr.Dataset:
    array = ds[name]
    count = array.sizes[dim]
    labels = _labels(array, dim)
    numbers = _numbers(labels)
    places = numbers or [*range(count)]
    plane = _plane(array, dim)
    are_axes = all(label[-1:].lower() in "xyz" for label in labels)
    if plane and (count == 3 or are_axes or set(places) != {0, 1}):
        drawn = plane
    else:
        drawn = [0, 1]
    if count == 2 and not numbers:
        places = drawn
    if not set(drawn) <= set(places):
        axes = " and ".join("xyz"[n] for n in drawn)
        text = f"{name!r} has the components {', '.join(labels)} along {dim!r} on the axes {axes}"
        raise FieldError(f"{text}; expected components along these axes")
    words: Sequence[str] = "uvw"
    if _are_polar(labels):
        words = POLARWARD
    elif numbers and all(map(EARTH.search, labels[:2])):
        words = EARTHWARD
    order = [*drawn, *(n for n in range(3) if n in places and n not in drawn)]
    parts: dict[str, Any] = {}
    for word, place in zip(words, order, strict=False):
        part = array.isel({dim: places.index(place)}, drop=True)
        part.attrs = _kept(array)
        parts[f"{prefix}{word}"] = part
    ds = ds.drop_vars([name]).assign(parts)
    if plane not in ([], [0, 1]):
        return _upright(ds, array, plane)
    return ds


def _plane(array: xr.DataArray, dim: str) -> list[int]:
    """Return the numbers of the two axes x, y, z along which an array lies; empty for others."""
    lengths = {str(d).lower(): n for d, n in array.sizes.items() if str(d) != dim}
    axes = [n for n, letter in enumerate("xyz") if lengths.get(letter, 1) > 1]
    if len(axes) == 2:
        return axes
    return []


def _upright(ds: xr.Dataset, array: xr.DataArray, plane: list[int]) -> xr.Dataset:
    """Return a dataset in the plane x, y instead of x, z or y, z."""
    names = {str(d).lower(): str(d) for d in array.dims}
    changes = ((names["xyz"[n]], letter) for n, letter in zip(plane, "xy", strict=True))
    free = {}
    for old, new in changes:
        if old != new:
            free[old] = new
    ds = ds.drop_vars([n for n in free.values() if n in ds.variables and n not in free])
    ds = ds.squeeze([n for n in free.values() if n in ds.dims and n not in free], drop=True)
    return ds.rename(free)
