"""The grid that two components lie on: staggered or not, and the places of its nodes.

On a staggered one (Arakawa C) they lie on the sides of cells, and become means in the middle. Along
its direction a component has one value for each side.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.sources.datasets import labels
from flowtex.sources.datasets.align import renamed
from flowtex.sources.datasets.axes import as_slice, horizontal_dims, is_told
from flowtex.sources.datasets.coordinates import Beside, Places, find_places
from flowtex.sources.notices import Record
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Distance, as a share of a cell, up to which a line of a grid repeats another one.
REPEATED = 0.01
#: Offset in cells up to which two grids coincide.
SAME_NODE = 0.03
#: Names of dimensions in the middle of cells.
MIDDLE_DIM = re.compile(r"_(rho|t|c|center)$")
#: Difference from half a cell up to which an offset is half a cell.
HALF = 0.1


@dataclass(frozen=True, eq=False)
class Sides:
    """The cells along an axis that have a side before and after them, and these sides."""

    cells: Indices
    before: Indices
    after: Indices

    @classmethod
    def counted(cls, first: int, sides: int, cells: int, *, wraps: bool = False) -> Sides:
        """Return the sides of cells by numbers: those beside cell c are c + first and the next.

        With ``wraps`` the axis goes around the Earth.
        """
        known = np.arange(cells)
        if not wraps:
            known = known[max(0, -first) : min(cells, sides - first - 1)]
        return cls(known, (known + first) % sides, (known + first + 1) % sides)

    @classmethod
    def between(cls, cells: Floats, sides: Floats, period: float | None) -> Sides:
        """Return the sides of cells by the positions of both along their axis."""
        order = np.argsort(sides if period is None else sides % period, kind="stable")
        line = sides[order]
        at = cells
        if period is not None:
            line = line % period
            at = cells % period
            line = np.concatenate([line[-1:] - period, line, line[:1] + period])
            order = np.concatenate([order[-1:], order, order[:1]])
        after = np.searchsorted(line, at)
        inside = (after > 0) & (after < len(line))
        after = np.where(inside, after, 1)
        share = (at - line[after - 1]) / (line[after] - line[after - 1])
        wide = line[after] - line[after - 1] > 1.5 * labels.spacing(sides)
        inside &= (np.abs(share - 0.5) < HALF) & ~wide
        known = np.flatnonzero(inside)
        return cls(known, order[after[known] - 1], order[after[known]])


class Grid(NamedTuple):
    """Two components of a velocity on a grid, not read yet."""

    u: xr.DataArray
    v: xr.DataArray
    places: Places  #: Places of the cells that have all sides.
    rows: Sides | None = None  #: Sides of the cells along a column, with the second component.
    columns: Sides | None = None


def centred(
    u: Floats, v: Floats, rows: Sides | None, columns: Sides | None
) -> tuple[Floats, Floats]:
    """Return components (J, I) in the middle of the cells that have all sides."""
    if columns is not None:
        u = _mean(u, 1, columns)
        v = v[:, columns.cells]
    if rows is not None:
        u = u[rows.cells]
        v = _mean(v, 0, rows)
    return u, v


def _mean(values: Floats, axis: int, sides: Sides) -> Floats:
    """Return means of two sides at the known cells; a missing side, or NaN, is a wall."""
    one = np.take(values, sides.before, axis=axis)
    other = np.take(values, sides.after, axis=axis)
    mean = (np.nan_to_num(one) + np.nan_to_num(other)) / 2
    mean[np.isnan(one) & np.isnan(other)] = np.nan
    return np.asarray(mean)


def find_grid(u: xr.DataArray, v: xr.DataArray, beside: Beside, *, along_earth: bool) -> Grid:
    """Return the grid of two components, at the same places or half a cell apart.

    Raises
    ------
    FieldError
        When the components differ in size or lie neither at the same places nor half a cell apart,
        or have no positions.
    """
    dims = (horizontal_dims(u), horizontal_dims(v))
    (datasets, _, record) = beside
    nemo = _nemo_places(u, v, beside, along_earth=along_earth)
    if nemo is not None:
        rows = Sides.counted(-1, v.sizes[dims[1][0]], v.sizes[dims[1][0]])
        count = u.sizes[dims[0][1]]
        columns = Sides.counted(-1, count, count, wraps=_wraps(nemo))
        return _staggered(u, v, nemo, (rows, columns), record)
    if dims[0] != dims[1]:
        _check_sides(u, v)
    own = _source(u, datasets)
    apart = own is not _source(v, datasets)
    alike = u.sizes[dims[0][0]] == v.sizes[dims[1][0]] and u.shape == v.shape
    if apart or (dims[0] != dims[1] and alike):
        at = [_own_places(array, beside) for array in (u, v)]
        # In one dataset, only positions on the Earth distinguish axes of other names.
        known = []
        for p in at:
            if p is not None and (p.is_earth or apart):
                known.append(p)
        if len(known) == 2 and known[0].is_earth == known[1].is_earth:
            grid = _by_positions(u, v, known[0], known[1], record)
            if grid is not None:
                return _at_true_cells(grid, dims, beside)
    (row_u, column_u), (_, column_v) = dims
    if dims[0] == dims[1]:
        if u.sizes[row_u] != v.sizes[row_u] or u.sizes[column_u] != v.sizes[column_u]:
            sizes = f"{dict(u.sizes)} and {dict(v.sizes)}"
            raise FieldError(f"{u.name} and {v.name} differ in size, {sizes}; expected one grid")
        return Grid(u, v, find_places(u, dims[0], beside._replace(datasets=[own, *datasets])))
    return _by_names(u, v, (row_u, column_v), beside)


def _staggered(
    u: xr.DataArray, v: xr.DataArray, places: Places, sides: tuple[Sides, Sides], record: Record
) -> Grid:
    at = np.ix_(*(part.cells for part in sides))
    places = places.part(at)
    record("align", f"{u.name} and {v.name} averaged from the sides of cells to their centres")
    return Grid(u, v, places, *sides)


def _at_true_cells(
    grid: Grid, dims: tuple[tuple[str, ...], tuple[str, ...]], beside: Beside
) -> Grid:
    """Return a grid at the 2-D positions of its cells, if known; lines may be nominal (MOM6)."""
    if grid.rows is None or grid.columns is None or {*dims[0]} & {*dims[1]}:
        return grid
    try:
        places = _cell_places(grid.u, (dims[0][0], dims[1][1]), beside)
    except FieldError:
        return grid
    if places.is_line or places.is_earth != grid.places.is_earth:
        return grid
    places = places.part(np.ix_(grid.rows.cells, grid.columns.cells))
    if not grid.places.is_line and not _are_same(grid.places, places):  # such as those of u
        return grid
    return grid._replace(places=places)


def _are_same(one: Places, other: Places) -> bool:
    """Return whether nodes lie at the same places up to a small part of a cell."""
    offset = _offset(one, other)
    return offset is not None and max(map(abs, offset)) < HALF


def _cell_places(u: xr.DataArray, cells: tuple[str, str], beside: Beside) -> Places:
    other = []
    for n, c in u.coords.items():
        if not {*c.dims} <= {*cells}:
            other.append(n)
    inside = u.drop_vars(other).isel({d: 0 for d in u.dims if d not in cells})
    return find_places(inside, cells, beside)


def _by_positions(
    u: xr.DataArray, v: xr.DataArray, at_u: Places, at_v: Places, record: Record
) -> Grid | None:
    """Return the grid of components by their own positions; ``None`` if these do not tell."""
    dims = horizontal_dims(u), horizontal_dims(v)
    if at_u.is_line and at_v.is_line:
        return _by_lines(u, v, at_u, at_v, record)
    rename = dict(zip(dims[1], dims[0], strict=True))
    if at_u.a.shape == at_v.a.shape:
        for flips in ((), (0,), (1,), (0, 1)):
            if flips:
                turned = (np.flip(at_v.a, flips), np.flip(at_v.b, flips))
            else:
                turned = (at_v.a, at_v.b)
            offset = _offset(at_u, replace(at_v, a=turned[0], b=turned[1]))
            if offset is None or max(map(abs, offset)) > SAME_NODE:
                continue
            if flips:
                axes = " and ".join(dims[1][n] for n in flips)
                record("align", f"{v.name}: {axes} reversed to match {u.name}")
            v = v.isel({dims[1][n]: slice(None, None, -1) for n in flips})
            return Grid(u, renamed(v, rename, u), at_u)
    offset = _offset(at_u, at_v)
    if offset is not None and all(abs(abs(part) - 0.5) < HALF for part in offset):
        if offset[0] > 0:
            row = -1
        else:
            row = 0
        if offset[1] > 0:
            column = 0
        else:
            column = -1
        rows = Sides.counted(row, at_v.a.shape[0], at_u.a.shape[0])
        count = at_u.a.shape[1]
        wraps = count == at_v.a.shape[1] and _wraps(at_u)
        columns = Sides.counted(column, count, at_v.a.shape[1], wraps=wraps)
        middle = _moved(at_u, columns, at_v.a.shape[1])
        return _staggered(u, v, middle, (rows, columns), record)
    if dims[0] != dims[1]:
        return None
    raise FieldError(_apart(u, v, at_u, at_v))


def _by_lines(u: xr.DataArray, v: xr.DataArray, at_u: Places, at_v: Places, record: Record) -> Grid:
    dims = horizontal_dims(u), horizontal_dims(v)
    if at_u.is_earth:
        period = 360.0
    else:
        period = None
    (a_u, b_u) = at_u.lines
    (a_v, b_v) = at_v.lines
    matches = labels.match(b_u, b_v), labels.match(a_u, a_v, period)
    if all(len(found.one) for found in matches):
        for n, (one, other) in enumerate(((b_u, b_v), (a_u, a_v))):
            kept = matches[n]
            if len(kept.one) < max(len(one), len(other)):
                text = f"{dims[0][n]}: {len(kept.one)} positions that {u.name} ({labels.text(one)})"
                text += f" and {v.name} ({labels.text(other)}) have in common"
                record("align", text, notable=True)
            elif period and n and np.abs(a_u - a_v[kept.other]).max() > period / 2:
                text = f"{v.name}: {dims[1][n]} counted from the meridian of {u.name}"
                record("align", text)
            elif (np.diff(kept.other) != 1).any():
                if (np.diff(kept.other) < 0).all():
                    word = "reversed"
                else:
                    word = "reordered"
                record("align", f"{v.name}: {dims[1][n]} {word} to match {u.name}")
        u = u.isel({d: as_slice(found.one) for d, found in zip(dims[0], matches, strict=True)})
        v = v.isel({d: as_slice(found.other) for d, found in zip(dims[1], matches, strict=True)})
        at = np.ix_(*(found.one for found in matches))
        places = at_u.part(at)
        v = renamed(v, dict(zip(dims[1], dims[0], strict=True)), u)
        return Grid(u, v, places)
    if labels.is_between(b_u, b_v) and labels.is_between(a_v, a_u, period):
        rows = Sides.between(b_u, b_v, None)
        columns = Sides.between(a_v, a_u, period)
        if len(rows.cells) and len(columns.cells):
            a, b = np.broadcast_arrays(a_v, b_u[:, None])
            middle = replace(at_u, a=a, b=b, why=f"{at_u.why}, at the cell centres")
            return _staggered(u, v, middle, (rows, columns), record)
    raise FieldError(_apart(u, v, at_u, at_v))


def _apart(u: xr.DataArray, v: xr.DataArray, at_u: Places, at_v: Places) -> str:
    """Return the text of the error for components whose positions do not fit together."""
    texts = []
    for array, places in ((u, at_u), (v, at_v)):
        ends = [labels.text(line) for line in places.lines]
        pairs = zip(places.why.split(" and "), ends, strict=False)
        texts.append(f"{array.name} at {', '.join(f'{n} {end}' for n, end in pairs)}")
    return (
        f"{u.name} and {v.name} lie at different positions: {texts[0]}; {texts[1]}. These are "
        f"neither the same nor half a cell apart; bring one to the other, as with "
        f"{v.name}.interp_like({u.name})"
    )


def _offset(at_u: Places, at_v: Places) -> tuple[float, float] | None:
    """Return by how many rows and columns places lie behind others, if by the same everywhere."""
    rows = min((at_u.a.shape[0], at_v.a.shape[0]))
    columns = min((at_u.a.shape[1], at_v.a.shape[1]))
    if min(rows, columns) < 2:
        return None
    p = at_u.positions[:rows, :columns]
    q = at_v.positions[:rows, :columns]
    along = p[:-1, 1:] - p[:-1, :-1]
    up = p[1:, :-1] - p[:-1, :-1]
    way = (q - p)[:-1, :-1]
    basis = np.stack([up, along], axis=-1)
    square = np.swapaxes(basis, -1, -2) @ basis
    right = (np.swapaxes(basis, -1, -2) @ way[..., None])[..., 0]
    good = np.isfinite(square).all(axis=(-1, -2)) & np.isfinite(right).all(axis=-1)
    good = np.asarray(good & (np.linalg.det(np.nan_to_num(square)) != 0))
    if not good.any():
        return None
    cells = np.linalg.solve(square[good], right[good][..., None])[..., 0]
    low, middle, high = np.percentile(cells, (5, 50, 95), axis=0)
    if (high - low).max() < HALF:
        return (float(middle[0]), float(middle[1]))
    return None


def _own_places(array: xr.DataArray, beside: Beside) -> Places | None:
    """Return the positions of a variable from its own coordinates, ``None`` without them."""
    dims = horizontal_dims(array)
    source = _source(array, beside.datasets)
    if len(dims) < 2:
        return None
    own = {str(name): {*c.dims} for name, c in source.variables.items()}
    near = {name for name, at in own.items() if not at or {*dims} & at}
    part = source[[name for name in own if name in near and own[name] <= {*array.dims, *dims}]]
    try:
        return find_places(array, dims, beside._replace(datasets=[part]), any_axes=False)
    except FieldError:
        return None


def lies_in(array: xr.DataArray, cells: Places, at: tuple[Any, ...], beside: Beside) -> bool:
    """Return whether a variable lies in the middle of cells, though its dimensions are others.

    Its positions decide, in the parts ``at`` that are drawn, or without any its names.
    """
    own = _own_places(array, beside)
    if own is None:
        return all(map(MIDDLE_DIM.search, horizontal_dims(array)))
    for part in at:
        own = own.part(part)
    if own.is_earth != cells.is_earth or own.a.shape != cells.a.shape:
        return False
    return _are_same(cells, own)


def _source(array: xr.DataArray, datasets: Sequence[xr.Dataset]) -> xr.Dataset:
    return next((ds for ds in datasets if array.name in ds.variables), datasets[0])


def _check_sides(u: xr.DataArray, v: xr.DataArray) -> None:
    """Raise if names such as eta_psi say that u lies on sides along a column, and v along a row."""
    (row_u, column_u) = horizontal_dims(u)
    (row_v, column_v) = horizontal_dims(v)
    in_middle = all(map(MIDDLE_DIM.search, (column_u, row_v)))
    if not in_middle or any(map(MIDDLE_DIM.search, (row_u, column_v))):
        return
    changes = {row_v: column_u, column_u: row_v, row_u: column_v, column_v: row_u}
    words = ", ".join(f'{one}="{other}"' for one, other in changes.items())
    raise FieldError(
        f"{u.name} on ({row_u}, {column_u}) lies on the sides along {row_u}, and {v.name} on "
        f"({row_v}, {column_v}) on those along {column_v}, so {u.name} is not along {column_u}. "
        f"Exchange the names of the dimensions, as in ds.rename({words})"
    )


def _by_names(u: xr.DataArray, v: xr.DataArray, cells: tuple[str, str], beside: Beside) -> Grid:
    (row_u, column_u) = horizontal_dims(u)
    (row_v, column_v) = horizontal_dims(v)
    rows = (v.sizes[row_v], u.sizes[row_u])
    columns = (u.sizes[column_u], v.sizes[column_v])
    if any(abs(sides - middle) > 1 for sides, middle in (rows, columns)):
        raise FieldError(
            f"{u.name} has {dict(u.sizes)} and {v.name} {dict(v.sizes)}; they differ by more than "
            "one along rows or columns, so they cannot be components of one staggered grid"
        )
    if not any(map(is_told, (u, v))):
        text = f"{u.name} is taken along {column_u} and {v.name} along {row_v}, though no name or "
        order = ", ".join(f'"{dim}"' for dim in (column_u, column_v, row_v, row_u))
        text += f"attribute tells; to exchange them, ds.transpose(..., {order})"
        beside.record("align", text, notable=True)
    first_row = first_side(row_v, row_u, rows, beside.datasets)
    first_column = first_side(column_u, column_v, columns, beside.datasets)
    try:
        places = _cell_places(u, cells, beside)
    except FieldError as error:
        try:
            on_sides = find_places(u, horizontal_dims(u), beside)
        except FieldError:
            raise error from None
        sides = Sides.counted(first_column, on_sides.a.shape[1], columns[1])
        places = _moved(on_sides, sides, columns[1])
    goes_around = rows[0] == rows[1] and not places.is_earth and _wraps(places, axis=0)
    at_rows = Sides.counted(first_row, *rows, wraps=goes_around)
    wraps = columns[0] == columns[1] and _wraps(places)
    at_columns = Sides.counted(first_column, *columns, wraps=wraps)
    return _staggered(u, v, places, (at_rows, at_columns), beside.record)


def _moved(places: Places, sides: Sides, count: int) -> Places:
    """Return places of this many cells between sides along a row; unknown ones are NaN."""
    if places.is_earth:
        lonlat = Projection(GLOBE).lonlat(_mean(places.positions, 1, sides))
    else:
        lonlat = _mean(places.a, 1, sides), _mean(places.b, 1, sides)
    a = np.full((places.a.shape[0], count), np.nan)
    b = np.full((places.a.shape[0], count), np.nan)
    a[:, sides.cells], b[:, sides.cells] = lonlat
    why = f"{places.why}, at the cell centres"
    return replace(places, a=a, b=b, is_line=False, why=why, angle=None)


def _nemo_places(
    u: xr.DataArray, v: xr.DataArray, beside: Beside, *, along_earth: bool
) -> Places | None:
    """Return the places of NEMO's T points, where the components lie on the sides of cells."""
    dims = horizontal_dims(u)
    datasets = beside.datasets
    if dims != horizontal_dims(v) or u.shape != v.shape:
        return None
    names = {str(n) for ds in datasets for n in ds.variables}
    if {"glamt", "gphit", "glamu"} <= names:
        of_t = next(ds for ds in datasets if "glamt" in ds.variables)
        if not {*dims} <= {*of_t["glamt"].dims}:  # of another model
            return None
        of_cells = beside._replace(datasets=[of_t[["glamt", "gphit"]]])
        return find_places(of_t["glamt"], dims, of_cells)
    if u.name != "vozocrtx" or along_earth:
        return None
    at = [_own_places(a, beside) for a in (u, v)]
    if at[0] is None or at[1] is None or not at[0].is_earth or not at[0].is_near(at[1]):
        return None
    return at[0]


def _wraps(places: Places, axis: int = 1) -> bool:
    """Return whether rows, or columns of polar coordinates (axis 0), go around.

    Those that repeat their first values at the end do not: another one would follow the last.
    """
    if not places.is_earth and places.angle is None:
        return False
    p = places.positions
    if axis == 0:
        p = np.swapaxes(p, 0, 1)
    step = np.linalg.norm(p[:, 1] - p[:, 0], axis=-1)
    gap = np.linalg.norm(p[:, 0] - p[:, -1], axis=-1)
    beyond = np.linalg.norm(p[:, 1] - p[:, -1], axis=-1)
    with np.errstate(invalid="ignore"):
        near = gap <= 1.5 * step
        repeats = np.minimum(gap, beyond) < 0.5 * step
    finite = np.isfinite(gap) & np.isfinite(step) & (step > 0)
    return bool(finite.any() and near[finite].all() and not repeats[finite].all())


def unrepeated(places: Places) -> tuple[slice, slice]:
    """Return rows and columns without repeated ones, except for one repeated column."""
    if not places.is_earth or places.is_line:
        return slice(None), slice(None)
    p = places.positions
    rows, columns = p.shape[:2]
    near = REPEATED * float(np.nanmedian(np.linalg.norm(np.diff(p, axis=1), axis=-1)))
    last = columns
    period = columns
    for halo in range(min(4, columns // 4), 0, -1):
        if all(_same(p[:, columns - halo + k], p[:, k], near) for k in range(halo)):
            last = columns - halo + 1
            period = columns - halo
            break
    is_folded = rows > 4 and any(_is_turned_over(p[:, :period], below, near) for below in (1, 2))
    return slice(0, rows - is_folded), slice(0, last)


def _same(one: Floats, other: Floats, near: float) -> bool:
    """Return whether two lines of positions (N, 3) are one."""
    gap = np.linalg.norm(one - other, axis=-1)
    finite = np.isfinite(gap)
    return bool(finite.any() and (gap[finite] <= near).all())


def _is_turned_over(p: Floats, below: int, near: float) -> bool:
    """Return whether the last row of positions (J, I, 3) is a row below it from its end on.

    The columns go around, and none is there twice.
    """
    last = p[-1]
    other = p[-1 - below]
    known = np.flatnonzero(np.isfinite(last).all(axis=-1))
    if not len(known):
        return False
    number = known[len(known) // 2]
    gap = np.linalg.norm(other - last[number], axis=-1)
    if not np.isfinite(gap).any():
        return False
    partner = int(np.nanargmin(gap))
    return _same(last, other[(number + partner - np.arange(len(last))) % len(last)], near)


def first_side(
    side: str, cell: str, counts: tuple[int, int], datasets: Sequence[xr.Dataset]
) -> int:
    """Return the number of the side before the first cell, for dimensions of this many of each."""
    sides, cells = counts
    if sides != cells:
        if sides > cells:
            return 0
        return -1
    sgrid = re.compile(rf"\b{re.escape(cell)}:\s*{re.escape(side)}\s*\(padding:\s*(\w+)\)")
    for ds in datasets:  # by COMODO, or by SGRID
        if side in ds.variables:
            shift = ds[side].attrs.get("c_grid_axis_shift")
        else:
            shift = None
        if shift is not None:
            if float(shift) < 0:
                return 0
            return -1
        for variable in ds.variables.values():
            is_grid = variable.attrs.get("cf_role") == "grid_topology"
            if is_grid and (match := sgrid.search(" ".join(map(str, variable.attrs.values())))):
                if match[1] in ("low", "both"):
                    return -1
                return 0
    lines = [_line(name, datasets) for name in (side, cell)]
    if lines[0] is not None and lines[1] is not None:
        rising = lines[1][-1] > lines[1][0]
        if (lines[0][0] < lines[1][0]) == rising:
            return 0
        return -1
    # MITgcm counts the side on the left of a cell, and most others the one on its right.
    if re.search(r"g$|_l(eft)?$", side, re.IGNORECASE):
        return 0
    return -1


def _line(name: str, datasets: Sequence[xr.Dataset]) -> Floats | None:
    for ds in datasets:
        if name in ds.coords and ds[name].ndim == 1 and ds[name].dtype.kind in "fiu":
            values = np.asarray(values_in(ds[name]), dtype=float)
            # Mere indices of the nodes are not coordinates.
            is_index = np.array_equal(values, np.arange(len(values)) + values[0])
            if is_index and not ds[name].attrs.get("units"):
                return None
            return values
    return None
