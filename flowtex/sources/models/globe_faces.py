"""Faces of a globe, such as those of a cubed sphere or the tiles of an LLC grid, as one surface.

Their nodes become points along one dimension. Components along the rows and columns of each face,
also those on the sides of cells, become eastward and northward ones before: rows and columns of one
face may go on as columns and rows of another one.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np
import scipy

from flowtex._util.array_types import Bools, Floats, Indices
from flowtex.errors import FieldError, import_extra
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.sources.datasets.axes import NODES
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.select import Pair, variable
from flowtex.sources.datasets.staggered import first_side
from flowtex.sources.models.conventions import FACES_OF_GLOBE, MOST_FACES, position_pairs
from flowtex.sources.notices import Record
from flowtex.sources.reader_errors import values_in

if TYPE_CHECKING:
    import xarray as xr

#: Names of the cosine and sine of the angle of the rows against parallels.
ANGLES = (("CS", "SN"), ("AngleCS", "AngleSN"))
#: Greatest distance of two neighbours across a border, in usual distances beside it.
NEAR = 1.5
#: Least cosine of the angle between the steps up to a border and on from it.
AHEAD = 0.5


def join_faces(
    datasets: Sequence[xr.Dataset],
    pair: Pair,
    chosen: Container[str],
    wanted: str | None,
    record: Record,
) -> list[xr.Dataset] | None:
    """Return datasets with the faces of a globe along ``NODES``; ``None`` for other datasets.

    ``chosen`` are axes along which one entry is selected, and ``wanted`` the directions of the
    components, if they are given. Coordinates along a part of the axes only count the nodes, and
    are dropped.

    Raises
    ------
    FieldError
        When the components lie along rows and columns in a way that is not known.
    """
    u = pair.u
    sizes = {str(d): n for d, n in u.sizes.items() if FACES_OF_GLOBE.match(str(d))}
    face = next((d for d, n in sizes.items() if 1 < n <= MOST_FACES and d not in chosen), "")
    if not face:
        return None
    arrays = [ds[name] for ds in datasets for name in ds.variables]
    places = [p for p in position_pairs(arrays) if p[0].ndim == 3 and face in p[0].dims]
    if (wanted or pair.along) != "earth":
        faces = None
        if places:
            faces = Faces.of(datasets, pair, face, places, is_along=wanted == "grid")
        if faces is None:
            raise FieldError(_unknown(pair, face, sizes[face]))
        datasets = _turned(datasets, pair, faces, record)
        places = [(faces.lon, faces.lat)]
    if not places:
        return None
    dims = {str(d) for d in places[0][0].dims}
    return [_one_dimension(ds, dims) if dims <= set(ds.dims) else ds for ds in datasets]


def _unknown(pair: Pair, face: str, count: int) -> str:
    """Return the text of an error for components along the rows and columns of faces."""
    u = str(pair.u.name)
    v = str(pair.v.name)
    text = (
        f"{u} and {v} lie along the rows and columns of each of {count} faces ({face}), as no "
        "standard name says eastward and northward. "
    )
    if pair.u.dims != pair.v.dims:
        text += (
            f"Open the file with the positions of the centres, such as XC and YC, together with "
            f"this one; or bring {u} and {v} to the middle of cells, as with xgcm, and turn them: "
        )
    else:
        text += (
            "If so, components='grid' turns them, if the file with XC and YC is opened as well; or "
            "turn them by the cosine and sine of the angle of the rows, such as CS and SN: "
        )
    return (
        f"{text}east = {u} * CS - {v} * SN, north = {u} * SN + {v} * CS, and name these, as in "
        f"u='east', v='north', components='earth'. Or select one face: isel={{{face!r}: 0}}"
    )


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces of which components lie in the middle of cells, or on their first or last sides."""

    lon: xr.DataArray  #: Of the middles of cells, along the face, rows and columns.
    lat: xr.DataArray
    u_dims: tuple[str, ...]  #: Dimensions of the components: face, rows and columns.
    v_dims: tuple[str, ...]
    #: Eastward and northward parts of vectors along rows and along columns, (F, J, I, 2) each.
    along_i: Floats
    along_j: Floats
    why: str  #: What says the directions.
    #: Steps along rows and columns in which components lie on the first sides of cells.
    steps: tuple[int, int] = (1, 1)

    @classmethod
    def of(
        cls,
        datasets: Sequence[xr.Dataset],
        pair: Pair,
        face: str,
        places: Sequence[tuple[xr.DataArray, xr.DataArray]],
        *,
        is_along: bool,
    ) -> Faces | None:
        """Return the faces of two components; ``None`` where their sides are not known.

        ``is_along`` is whether the user says that the components lie along rows and columns.
        """
        for lon, lat in places:
            rows, columns = (str(d) for d in lon.dims if d != face)
            u_dims = _surface_dims(pair.u, face, (rows, columns))
            v_dims = _surface_dims(pair.v, face, (rows, columns))
            is_centred = u_dims == v_dims == (face, rows, columns)
            on_sides = u_dims[1:2] == (rows,) and v_dims[2:] == (columns,)
            if not (on_sides and (is_along or not is_centred)):
                continue
            steps: tuple[int, int] | None = (1, 1)
            if not is_centred:
                steps = _steps(u_dims, v_dims, lon, datasets)
            if steps is None:
                continue
            lon = lon.transpose(face, rows, columns)
            lat = lat.transpose(face, rows, columns)
            along_i, along_j, why = _directions(datasets, lon, lat)
            return cls(lon, lat, u_dims, v_dims, along_i, along_j, why, steps)
        return None

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions of the middles of cells."""
        return tuple(map(str, self.lon.dims))

    def ahead(self, values: Floats) -> Floats:
        """Return values (..., J, I) in the order in which the sides before cells are theirs."""
        row, column = self.steps
        return values[..., ::row, ::column]

    def components(self, u: Floats, v: Floats, beyond: Beyond | None) -> tuple[Floats, Floats]:
        """Return eastward and northward components (..., F, J, I) in the middle of cells."""
        if beyond is not None:
            row, column = self.steps
            # In the other direction the last sides are the first ones.
            u, v = beyond.centred(column * self.ahead(u), row * self.ahead(v))
            u = column * self.ahead(u)
            v = row * self.ahead(v)
        east = u * self.along_i[..., 0] + v * self.along_j[..., 0]
        north = u * self.along_i[..., 1] + v * self.along_j[..., 1]
        return east, north


@dataclass(frozen=True, eq=False)
class Beyond:
    """The sides of the last column and of the last row of each face, which other faces have.

    The first value of each is 0 for the first component, 1 for the second one and -1 for none, the
    others are numbers of the face and of the place along its border, (F, N) each.
    """

    east: tuple[Indices, Indices, Indices]
    north: tuple[Indices, Indices, Indices]

    @classmethod
    def of(cls, lon: Floats, lat: Floats) -> Beyond:
        """Return the sides by positions of the middles of cells, (F, J, I) in degrees."""
        p = Projection(GLOBE).positions(lon, lat)
        return cls(_borders(p[:, :, -1], p[:, :, -2], p), _borders(p[:, -1], p[:, -2], p))

    def centred(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """Return means of both sides of cells (..., F, J, I); NaN beside unknown sides.

        A side without data is a wall. Cells whose sides are all at rest are land, unless all of
        them are.
        """
        after_u = np.concatenate([u[..., 1:], self._beyond(self.east, u, v)[..., None]], axis=-1)
        last = self._beyond(self.north, u, v)[..., None, :]
        after_v = np.concatenate([v[..., 1:, :], last], axis=-2)
        sides = np.stack([u, after_u, v, after_v])
        at_rest = (np.nan_to_num(sides) == 0).all(axis=0)
        lacking = np.isnan(sides).all(axis=0)
        if not at_rest.all():
            lacking |= at_rest
        means = np.nan_to_num(sides)
        across = np.where(lacking, np.nan, (means[0] + means[1]) / 2)
        upward = np.where(lacking, np.nan, (means[2] + means[3]) / 2)
        across[..., -1][..., self.east[0] < 0] = np.nan
        upward[..., -1, :][..., self.north[0] < 0] = np.nan
        return across, upward

    @staticmethod
    def _beyond(border: tuple[Indices, Indices, Indices], u: Floats, v: Floats) -> Floats:
        kind, face, place = border
        own = np.maximum(face, 0)
        at = np.maximum(place, 0)
        first = u[..., own, np.minimum(at, u.shape[-2] - 1), 0]
        second = v[..., own, 0, np.minimum(at, v.shape[-1] - 1)]
        return np.where(kind == 0, first, second)


def _surface_dims(array: xr.DataArray, face: str, cells: tuple[str, str]) -> tuple[str, ...]:
    """Return the face, rows and columns of a component; empty where they are not known."""
    others = [str(d) for d in array.dims if d != face]
    if {*cells} <= {*others}:
        return (face, *cells)
    for number, cell in enumerate(cells):
        if cell in others:
            side = others[-1] if others[-1] != cell else others[-2]
            dims = [side, side]
            dims[number] = cell
            return (face, *dims)
    return ()


def _steps(
    u_dims: tuple[str, ...],
    v_dims: tuple[str, ...],
    lon: xr.DataArray,
    datasets: Sequence[xr.Dataset],
) -> tuple[int, int] | None:
    """Return steps along rows and columns, 1 for components on first sides and -1 for last ones.

    They are ``None`` where there are not as many sides as cells.
    """
    steps = []
    for side, cell in ((v_dims[1], u_dims[1]), (u_dims[2], v_dims[2])):
        count = lon.sizes[cell]
        sizes = {ds.sizes[side] for ds in datasets if side in ds.sizes}
        if sizes != {count}:
            return None
        if first_side(side, cell, (count, count), datasets) == 0:
            steps.append(1)
        else:
            steps.append(-1)
    return steps[0], steps[1]


def _directions(
    datasets: Sequence[xr.Dataset], lon: xr.DataArray, lat: xr.DataArray
) -> tuple[Floats, Floats, str]:
    """Return eastward and northward parts of unit vectors along rows and columns, and the source.

    Columns are at right angles to rows where the angles of rows are known.
    """
    found = {}
    for ds in datasets:
        for name in ds.variables:
            found[str(name)] = ds[name]
    for names in ANGLES:
        if all(name in found and {*found[name].dims} == {*lon.dims} for name in names):
            cos, sin = (np.asarray(values_in(found[n].transpose(*lon.dims))) for n in names)
            return np.stack([cos, sin], -1), np.stack([-sin, cos], -1), " and ".join(names)
    along: list[list[Floats]] = [[], []]
    for a, b in zip(np.asarray(values_in(lon)), np.asarray(values_in(lat)), strict=True):
        places = Places(a, b, is_earth=True, is_line=False, why="")
        ones = np.ones(a.shape)
        along[0].append(np.stack(places.turned((1, 1), ones, 0 * ones), -1))
        along[1].append(np.stack(places.turned((1, 1), 0 * ones, ones), -1))
    return np.stack(along[0]), np.stack(along[1]), f"{lon.name} and {lat.name}"


def _borders(last: Floats, before: Floats, p: Floats) -> tuple[Indices, Indices, Indices]:
    """Return the sides beyond the last cells of each face, as :class:`Beyond` has them.

    Parameters
    ----------
    last
        Positions of the last cells, (F, N, 3).
    before
        Positions of the cells before them, (F, N, 3).
    p
        Positions of all cells, (F, J, I, 3).
    """
    first_columns = p[:, :, 0]
    first_rows = p[:, 0]
    known = [np.isfinite(part).all(axis=-1) for part in (first_columns, first_rows)]
    cells = np.concatenate([first_columns[known[0]], first_rows[known[1]]])
    ahead = np.concatenate(
        [(p[:, :, 1] - first_columns)[known[0]], (p[:, 1] - first_rows)[known[1]]]
    )
    kinds = np.repeat([0, 1], [known[0].sum(), known[1].sum()])
    numbers = np.concatenate([np.argwhere(part) for part in known])
    step = last - before
    target = last + step
    sought: Bools = np.asarray(np.isfinite(target).all(axis=-1))
    tree = scipy.spatial.cKDTree(cells)
    places = np.where(sought[..., None], target, 0.0)
    distance, near = map(np.asarray, tree.query(places, k=2))
    # A corner is in the first column and in the first row: the flow goes on along one of them.
    steps = step[..., None, :]
    length = np.linalg.norm(step, axis=-1, keepdims=True)
    fits = (ahead[near] * steps).sum(axis=-1) / (np.linalg.norm(ahead[near], axis=-1) * length)
    close = distance <= NEAR * length
    fits = np.where(close & sought[..., None], fits, -np.inf)
    best = np.argmax(fits, axis=-1)
    chosen = np.take_along_axis(near, best[..., None], axis=-1)[..., 0]
    found: Bools = np.take_along_axis(fits, best[..., None], axis=-1)[..., 0] > AHEAD
    kind = np.where(found, kinds[chosen], -1)
    return _whole_edges(kind, numbers[chosen, 0], numbers[chosen, 1])


def _whole_edges(kind: Indices, face: Indices, place: Indices) -> tuple[Indices, Indices, Indices]:
    """Return, for each cell of each edge, the edge, the face and the cell that it meets.

    The arrays are (edges, cells); an edge of the kind 0 is a first column, of the kind 1 a first
    row, and -1 means that none is met. Cells along one edge may disagree: all of them get the edge
    that most of them meet, in the order of its cells or the reverse, and none if fewer than half
    meet any.
    """
    kinds = np.full(kind.shape, -1)
    faces = np.full(kind.shape, -1)
    places = np.full(kind.shape, -1)
    count = kind.shape[1]
    for number in range(len(kind)):
        known = np.flatnonzero(kind[number] >= 0)
        if 2 * len(known) < count:
            continue
        pairs, votes = np.unique(
            np.stack([kind[number, known], face[number, known]]), axis=1, return_counts=True
        )
        own_kind, own_face = pairs[:, np.argmax(votes)]
        same = known[(kind[number, known] == own_kind) & (face[number, known] == own_face)]
        along = np.arange(count)
        here = place[number, same]
        if np.abs(here - (count - 1 - same)).sum() < np.abs(here - same).sum():
            along = along[::-1]
        kinds[number] = own_kind
        faces[number] = own_face
        places[number] = along
    return kinds, faces, places


def _turned(
    datasets: Sequence[xr.Dataset], pair: Pair, faces: Faces, record: Record
) -> list[xr.Dataset]:
    """Return datasets in which both components are eastward and northward, in middles of cells."""
    u = variable(datasets, str(pair.u.name))
    v = variable(datasets, str(pair.v.name))
    beyond = None
    text = f"{u.name} and {v.name} turned to east and north by {faces.why}"
    if faces.u_dims != faces.v_dims:
        lon, lat = (np.asarray(values_in(c)) for c in (faces.lon, faces.lat))
        beyond = Beyond.of(faces.ahead(lon), faces.ahead(lat))
        text += f", after means of the sides of cells, also across borders of {faces.dims[0]}"
    record("components", text)
    xarray = import_extra("xarray", "xarray")
    u, v = (_in_chunks(array, {*faces.dims, *faces.u_dims, *faces.v_dims}) for array in (u, v))
    east, north = xarray.apply_ufunc(
        partial(faces.components, beyond=beyond),
        u,
        v,
        input_core_dims=[faces.u_dims, faces.v_dims],
        output_core_dims=[faces.dims, faces.dims],
        dask="parallelized",
        output_dtypes=[float, float],
    )
    changed = []
    for ds in datasets:
        for name, array, before in ((u.name, east, u), (v.name, north, v)):
            if name in ds:
                attrs = {key: text for key, text in before.attrs.items() if key != "standard_name"}
                ds = ds.drop_vars([name]).assign({name: array.assign_attrs(attrs)})
        changed.append(ds)
    return changed


def _in_chunks(array: xr.DataArray, whole: set[str]) -> xr.DataArray:
    """Return a variable of a file in chunks of one surface each; otherwise all of it is read."""
    if find_spec("dask") is None or ("source" not in array.encoding and array.chunks is None):
        return array
    return array.chunk({d: -1 if d in whole else 1 for d in array.dims})


def _one_dimension(ds: xr.Dataset, face: set[str]) -> xr.Dataset:
    parts = []
    for name, a in ds.variables.items():
        if face & {*a.dims} and face - {*a.dims}:
            parts.append(name)
    ds = ds.drop_vars(parts)
    if "source" in ds.encoding and not ds.chunks and find_spec("dask") is not None:
        # Otherwise all of a file is read.
        ds = ds.chunk({d: 1 if d not in face else -1 for d in ds.dims})
    return ds.stack({NODES: sorted(face)}, create_index=False)
