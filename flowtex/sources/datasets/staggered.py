"""The grid that two components lie on: staggered or not, and the places of its nodes.

On a staggered one (Arakawa C) they lie on the sides of cells, and become means in the middle. Along
its direction a component has one value for each side. The sides beside cell c are numbered
c + first and c + first + 1.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.earth import GLOBE, Projection
from flowtex.sources.datasets.axes import horizontal_dims
from flowtex.sources.datasets.coordinates import Places, find_places
from flowtex.sources.datasets.select import Pair
from flowtex.sources.inspection.limits import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Paddings of SGRID, and the first side that they mean.
PADDINGS = {"none": 0, "high": 0, "low": -1, "both": -1}
#: Names of masks in the middle of cells, 1 at sea.
MASKS = ("mask_rho", "mask_t", "tmask", "tmaskutil", "wet", "wet_c")
#: Distance, as a share of a cell, up to which a line of a grid repeats another one.
REPEATED = 0.01


def find_grid(
    pair: Pair,
    cells: tuple[str, str],
    dims: tuple[tuple[str, str], tuple[str, str]],
    datasets: Sequence[xr.Dataset],
) -> tuple[tuple[Sides | None, Sides | None], Places, str]:
    """Return the sides along (rows, columns) of a staggered grid, the places, and a text."""
    (row_u, row_v), (column_u, column_v) = dims
    u, v = pair.u, pair.v
    if row_u == row_v and column_u == column_v:
        if u.sizes[row_u] != v.sizes[row_u] or u.sizes[column_u] != v.sizes[column_u]:
            msg = (
                f"{u.name} and {v.name} differ in size, {_sizes(u)} and {_sizes(v)}; expected "
                "components of one grid"
            )
            raise FieldError(msg)
        places = _nemo_places(pair, cells, datasets)
        if places is None:
            return (
                (None, None),
                find_places(u, cells, [_dataset_of(u, datasets), *datasets]),
                "both components at the same position",
            )
        rows = Sides(-1, v.sizes[row_v], v.sizes[row_v])
        columns = Sides(-1, u.sizes[column_u], u.sizes[column_u], _wraps(places))
        return (rows, columns), places, "Arakawa C, sides after the middle"
    counts = {
        "row": (v.sizes[row_v], u.sizes[row_u]),
        "column": (u.sizes[column_u], v.sizes[column_v]),
    }
    for name, (sides, middle) in counts.items():
        if abs(sides - middle) > 1:
            msg = (
                f"{u.name} has {_sizes(u)} and {v.name} {_sizes(v)}; along a {name} they differ "
                "by more than one, so they cannot be components of one staggered grid"
            )
            raise FieldError(msg)
    firsts = [
        first_side(row_v, row_u, counts["row"], datasets),
        first_side(column_u, column_v, counts["column"], datasets),
    ]
    places = _middle_places(pair, cells, firsts, datasets)
    rows = Sides(firsts[0], *counts["row"])
    wraps = counts["column"][0] == counts["column"][1] and _wraps(places)
    columns = Sides(firsts[1], *counts["column"], wraps)
    position = {0: "before", -1: "after"}[firsts[1]]
    return (rows, columns), places, f"Arakawa C, sides {position} the middle"


def _dataset_of(array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> xr.Dataset:
    """Return the dataset that holds a variable."""
    return next((ds for ds in datasets if array.name in ds.variables), datasets[0])


def _middle_places(
    pair: Pair, cells: tuple[str, str], firsts: list[int], datasets: Sequence[xr.Dataset]
) -> Places:
    """Return places in the middle of the cells, from the data or as means of those on sides."""
    inside = pair.u.isel({d: 0 for d in pair.u.dims if d not in cells})
    try:
        return find_places(inside, cells, datasets)
    except FieldError as error:
        try:
            on_sides = find_places(pair.u, horizontal_dims(pair.u), datasets)
        except FieldError:
            raise error from None
    count = pair.v.sizes[cells[1]]
    sides = Sides(firsts[1], on_sides.a.shape[1], count)
    return _moved(on_sides, sides)


def _moved(places: Places, sides: Sides) -> Places:
    """Return places between sides along a row; unknown ones are NaN."""
    shape = (places.a.shape[0], sides.cells)
    if places.is_earth:
        lonlat = Projection(GLOBE).lonlat(centred(places.on_sphere, 1, sides))
    else:
        lonlat = centred(places.a, 1, sides), centred(places.b, 1, sides)
    a, b = np.full(shape, np.nan), np.full(shape, np.nan)
    a[:, sides.known], b[:, sides.known] = lonlat
    return replace(places, a=a, b=b, is_line=False, why=f"{places.why}, at the cell centres")


def _nemo_places(
    pair: Pair, cells: tuple[str, str], datasets: Sequence[xr.Dataset]
) -> Places | None:
    """Return the places of NEMO's T points, where the components lie on the sides of cells."""
    sources = [_dataset_of(array, datasets) for array in (pair.u, pair.v)]
    names = {str(n) for ds in datasets for n in ds.variables}
    if "glamt" in names and "gphit" in names and "glamu" in names:
        of_t = next(ds for ds in datasets if "glamt" in ds.variables)
        if not set(cells) <= set(of_t["glamt"].dims):  # of another model
            return None
        return find_places(of_t["glamt"], cells, [of_t[["glamt", "gphit"]]])
    if sources[0] is sources[1] and pair.u.name != "vozocrtx":
        return None
    try:
        at_u, at_v = (
            find_places(a, cells, [ds]) for a, ds in zip((pair.u, pair.v), sources, strict=True)
        )
    except FieldError:
        return None
    if not at_u.is_earth or pair.along == "earth":
        return None
    if at_u.is_line and at_v.is_line:
        same = np.allclose(at_u.a[0], at_v.a[0], atol=1e-6, equal_nan=True)
    else:
        same = np.allclose(at_u.a, at_v.a, atol=1e-6, equal_nan=True)
    if not same:
        return _moved(at_u, Sides(-1, at_u.a.shape[1], at_u.a.shape[1]))
    return at_u if pair.u.name == "vozocrtx" else None


def _wraps(places: Places) -> bool:
    """Return whether the first column follows the last one."""
    if not places.is_earth:
        return False
    p = places.on_sphere
    step, gap = (np.linalg.norm(a, axis=-1) for a in (p[:, 1] - p[:, 0], p[:, 0] - p[:, -1]))
    with np.errstate(invalid="ignore"):
        near = gap <= 1.5 * step
    finite = np.isfinite(gap) & np.isfinite(step) & (step > 0)
    return bool(finite.any() and near[finite].all())


def unrepeated(places: Places) -> tuple[slice, slice]:
    """Return rows and columns without repeated ones, except for one repeated column."""
    if not places.is_earth or places.is_line:
        return slice(None), slice(None)
    p = places.on_sphere
    rows, columns = p.shape[:2]

    def same(one: Floats, other: Floats) -> bool:
        gap = np.linalg.norm(one - other, axis=-1)
        cell = np.nanmedian(np.linalg.norm(np.diff(p, axis=1), axis=-1))
        finite = np.isfinite(gap)
        return bool(finite.any() and (gap[finite] <= REPEATED * cell).all())

    last = columns
    for halo in range(min(4, columns // 4), 1, -1):
        if all(same(p[:, columns - halo + k], p[:, k]) for k in range(halo)):
            last = columns - halo + 1
            break
    top = rows
    for below in (1, 2):
        inside = p[:, : last if last < columns else columns]
        for shift in (0, 1, 2):
            mirrored = np.roll(inside[rows - 1 - below, ::-1], shift, axis=0)
            if rows > 4 and same(inside[rows - 1], mirrored):
                top = rows - 1
    return slice(0, max(top, 2)), slice(0, last)


def sea_mask(shape: tuple[int, ...], datasets: Sequence[xr.Dataset]) -> xr.DataArray | None:
    """Return a variable that is positive where there is data, (J, I); ``None`` without one."""
    for ds in datasets:
        for name in MASKS:
            if name in ds.variables:
                mask = ds[name]
                mask = mask.isel({d: 0 for d in mask.dims[:-2]})
                if mask.shape == tuple(shape):
                    return mask
    return None


def _sizes(array: xr.DataArray) -> str:
    return " x ".join(f"{n} {d}" for d, n in array.sizes.items())


@dataclass(frozen=True)
class Sides:
    """Sides of cells along an axis.

    ``first`` is that of the module, ``sides`` and ``cells`` are counts; ``wraps`` where the axis
    goes around the Earth.
    """

    first: int
    sides: int
    cells: int
    wraps: bool = False

    @property
    def known(self) -> slice:
        """The cells with a side before and after them."""
        if self.wraps:
            return slice(0, self.cells)
        return slice(max(0, -self.first), min(self.cells, self.sides - self.first - 1))


def centred(values: Floats, axis: int, sides: Sides) -> Floats:
    """Return means of two sides at the known cells; a missing side, or NaN, is a wall."""
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
    """Return the number of the side before the first cell, for dimensions of this many of each."""
    sides, cells = counts
    if sides != cells:
        return 0 if sides > cells else -1
    declared = declared_first(side, cell, datasets)
    if declared is not None:
        return declared
    lines = [_line(name, datasets) for name in (side, cell)]
    if lines[0] is not None and lines[1] is not None:
        rising = lines[1][-1] > lines[1][0]
        return 0 if (lines[0][0] < lines[1][0]) == rising else -1
    # MITgcm counts the side on the left of a cell, and most others the one on its right.
    return 0 if re.search(r"g$|_l(eft)?$", side, re.IGNORECASE) else -1


def declared_first(side: str, cell: str, datasets: Sequence[xr.Dataset]) -> int | None:
    """Return :func:`first_side` by the attributes of COMODO or SGRID, if present."""
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


def _line(name: str, datasets: Sequence[xr.Dataset]) -> Floats | None:
    for ds in datasets:
        if name in ds.coords and ds[name].ndim == 1 and ds[name].dtype.kind in "fiu":
            values = np.asarray(values_in(ds[name]), dtype=float)
            # Mere indices of the nodes are not coordinates.
            return None if np.array_equal(values, np.arange(len(values)) + values[0]) else values
    return None
