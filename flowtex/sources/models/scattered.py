"""Values along one dimension as points of a mesh: scattered ones, HEALPix, faces of a cube."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError
from flowtex.sources.datasets.axes import LEVEL, NODES, TIME, axis_kind
from flowtex.sources.datasets.coordinates import ACROSS, LATITUDE, LONGITUDE, UPWARD
from flowtex.sources.datasets.select import MOVING, Pair, find_pairs
from flowtex.sources.datasets.vertical import is_vertical
from flowtex.sources.models.mesh import POINTS, Mesh

if TYPE_CHECKING:
    import xarray as xr

#: Most faces of a grid that covers the globe, and names of their dimension.
MOST_FACES = 30
FACES_OF_GLOBE = re.compile(r"^(nf|n?faces?|n?tiles?|panels?)$", re.IGNORECASE)
#: Types of features whose points follow each other in time or height.
PATHS = ("trajectory", "profile", "timeseriesprofile", "trajectoryprofile")
#: Greatest rank of a pair that is a velocity by its names.
NAMED = 4


def with_points(datasets: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets in which the dimension of scattered points is called ``NODES``."""
    datasets = [_with_centres(ds) for ds in datasets]
    pairs = [pair for pair in find_pairs(datasets) if pair.rank <= NAMED]
    for x, y in _positions(datasets):
        along = [a for ds in datasets for a in ds.data_vars.values() if set(x.dims) <= set(a.dims)]
        values = [a for a in along if a.dtype.kind in "fiu" and a.name not in (x.name, y.name)]
        if not values or any(not set(x.dims) <= set(pair.u.dims) for pair in pairs):
            continue
        times = [d for d in map(str, x.dims) if axis_kind(x, d) == TIME]
        dim = next((str(d) for d in x.dims if d not in times), "")
        levels = any(axis_kind(a, str(d)) == LEVEL for a in values for d in {*a.dims} - {*x.dims})
        is_section = levels and any(is_vertical(a) for a in values)
        if is_section and (times or not _is_surface(x, y)):
            continue
        kind = next((str(k) for ds in datasets if (k := ds.attrs.get("featureType"))), "")
        if (times and len(values) > 1) or kind.lower() in PATHS:
            why = f"along {', '.join(times)}" if times else f"of the type {kind!r}"
            msg = (
                f"{x.name} and {y.name} are positions {why}: a trajectory, or points that move. "
                "Flowtex draws the flow on a surface; interpolate the values to a grid"
            )
            if dim and times:
                msg += f", or select one time, as in ds.isel({times[0]}=0)"
            raise FieldError(msg)
        if x.ndim == 1:
            return [ds.rename_dims({dim: NODES}) if dim in ds.dims else ds for ds in datasets]
    return list(datasets)


def points_in(variables: dict[str, xr.DataArray]) -> Iterator[Mesh]:
    """Yield the mesh of points along ``NODES``."""
    for x, y in _pairs(list(variables.values())):
        if x.dims == (NODES,):
            yield Mesh(POINTS, x, y)


def _positions(datasets: Sequence[xr.Dataset]) -> Iterator[tuple[xr.DataArray, xr.DataArray]]:
    """Yield pairs of coordinates along one dimension, perhaps also along time."""
    arrays = [ds[name] for ds in datasets for name in ds.variables]
    for x, y in _pairs(arrays):
        times = [d for d in x.dims if axis_kind(x, str(d)) == TIME]
        if x.ndim == 1 or (x.ndim == 2 and len(times) == 1):
            yield x, y


def _pairs(arrays: list[xr.DataArray]) -> Iterator[tuple[xr.DataArray, xr.DataArray]]:
    """Yield longitudes and latitudes, then x and y, along the same dimensions."""
    for patterns, words, names in (
        ((LONGITUDE, LATITUDE), ("longitude", "latitude"), (("lon", "lat"), ("long", "lat"))),
        (
            (ACROSS, UPWARD),
            ("projection_x_coordinate", "projection_y_coordinate"),
            (("x", "y"), ("easting", "northing")),
        ),
    ):
        firsts, seconds = (
            [
                a
                for a in arrays
                if a.ndim
                and a.dtype.kind in "fiu"
                and not MOVING.search(str(a.name).lower())
                and (a.attrs.get("standard_name") == word or pattern.match(str(a.name)))
            ]
            for pattern, word in zip(patterns, words, strict=True)
        )
        for x in firsts:
            name = str(x.name).lower()
            partners = {name.replace(one, other) for one, other in names if one in name}
            for y in seconds:
                if y.dims == x.dims and str(y.name).lower() in partners:
                    yield x, y


def _is_surface(x: xr.DataArray, y: xr.DataArray) -> bool:
    try:
        return len(Mesh(POINTS, x, y).faces) > 0
    except FieldError:
        return False


def join_faces(
    datasets: Sequence[xr.Dataset], pair: Pair, chosen: Container[str], wanted: str | None
) -> list[xr.Dataset] | None:
    """Return datasets with the faces of a globe along ``NODES``; ``None`` for other datasets.

    ``chosen`` are axes along which one entry is selected, and ``wanted`` the directions of the
    components, if they are given. Coordinates along a part of the axes only count the nodes, and
    are dropped.
    """
    u = pair.u
    sizes = {str(d): n for d, n in u.sizes.items() if FACES_OF_GLOBE.match(str(d))}
    face = next((d for d, n in sizes.items() if 1 < n <= MOST_FACES and d not in chosen), "")
    if not face:
        return None
    if (wanted or pair.along) != "earth":
        msg = (
            f"{u.name} and {pair.v.name} lie along the rows and columns of each of {sizes[face]} "
            f"faces ({face}), as no standard name says eastward and northward; compute these "
            f"components, or select one face, as in isel={{{face!r}: 0}}"
        )
        raise FieldError(msg)
    for lon, _ in _pairs([ds[name] for ds in datasets for name in ds.variables]):
        dims = {str(d) for d in lon.dims}
        if lon.ndim == 3 and face in dims:
            return [_one_dimension(ds, dims) if dims <= set(ds.dims) else ds for ds in datasets]
    return None


def _one_dimension(ds: xr.Dataset, face: set[str]) -> xr.Dataset:
    parts = [name for name, a in ds.variables.items() if face & {*a.dims} and face - {*a.dims}]
    ds = ds.drop_vars(parts)
    if "source" in ds.encoding and not ds.chunks and find_spec("dask") is not None:
        # Otherwise all of a file is read.
        ds = ds.chunk({d: 1 if d not in face else -1 for d in ds.dims})
    return ds.stack({NODES: sorted(face)}, create_index=False)


def _with_centres(ds: xr.Dataset) -> xr.Dataset:
    """Return a dataset on HEALPix with the positions of its cells, if it has none."""
    names = ("grid_mapping_name", "grid_name")
    grids = [a for a in ds.variables.values() if "healpix" in (a.attrs.get(name) for name in names)]
    if not grids or any(True for _ in _positions([ds])):
        return ds
    attrs = {str(k).removeprefix("healpix_"): value for k, value in grids[0].attrs.items()}
    largest = max(ds.data_vars.values(), key=lambda a: a.size)
    sizes = {str(d): n for d, n in largest.sizes.items() if axis_kind(largest, str(d)) == str(d)}
    dim = max(sizes, key=lambda d: sizes[d], default="")
    level = attrs.get("refinement_level", attrs.get("level"))
    nside = int(attrs.get("nside", 0) if level is None else 2 ** int(level))
    order = str(attrs.get("order", attrs.get("indexing_scheme", ""))).lower()
    cells = next(
        (c.values for c in ds.coords.values() if c.dims == (dim,) and c.dtype.kind in "iu"),
        np.arange(sizes.get(dim, 0)),
    )
    if (
        nside < 1
        or order not in ("ring", "nest", "nested")
        or not 0 < len(cells) <= 12 * nside**2
        or cells.max() >= 12 * nside**2
    ):
        msg = (
            f"the grid mapping {dict(grids[0].attrs)} does not fit {len(cells):,} cells along "
            f"{dim!r}; expected healpix_nside, healpix_order 'ring' or 'nested', and 12 nside² "
            "cells, or an integer coordinate with the numbers of the cells"
        )
        raise FieldError(msg)
    lon, lat = healpix_centres(cells.astype(np.int64), nside, nested=order != "ring")
    return ds.assign_coords(
        lon=(dim, lon, {"units": "degrees_east"}), lat=(dim, lat, {"units": "degrees_north"})
    )


def healpix_centres(cells: Indices, nside: int, *, nested: bool) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes in degrees of cells, by their numbers in a full grid."""
    return _nested(cells, nside) if nested else _ring(cells, nside)


def _ring(cells: Indices, nside: int) -> tuple[Floats, Floats]:
    count, cap = 12 * nside**2, 2 * nside * (nside - 1)
    south = cells >= count - cap
    north = np.where(south, count - 1 - cells, cells)  # of a cap, counted from its pole
    in_cap = south | (cells < cap)
    ring = ((1 + np.sqrt(1 + 2 * np.where(in_cap, north, 0))) / 2).astype(np.int64)
    place = north - 2 * ring * (ring - 1)
    belt = np.where(in_cap, 0, cells - cap)
    row, column = belt // (4 * nside) + nside, belt % (4 * nside)
    z = np.where(in_cap, 1 - ring**2 / (3 * nside**2), 4 / 3 - 2 * row / (3 * nside))
    shift = ((row - nside) % 2 == 0) / 2
    lon = np.where(in_cap, (place + 0.5) * 90 / ring, (column + shift) * 90 / nside)
    lon = np.where(south, 360 - lon, lon)
    return lon, np.degrees(np.arcsin(np.where(south, -z, z)))


def _nested(cells: Indices, nside: int) -> tuple[Floats, Floats]:
    face, bits = cells // nside**2, cells % nside**2
    x, y = np.zeros_like(bits), np.zeros_like(bits)
    for k in range(nside.bit_length()):
        x |= (bits >> 2 * k & 1) << k
        y |= (bits >> 2 * k + 1 & 1) << k
    ring = (face // 4 + 2) * nside - x - y - 1  # from 1 at the north pole
    size = np.minimum(np.minimum(ring, 4 * nside - ring), nside)
    middle = np.where(face // 4 == 1, 2 * (face % 4), 2 * (face % 4) + 1)
    lon = (middle + (x - y) / size) * 45
    near = 1 - size**2 / (3 * nside**2)
    z = np.where(size < nside, np.where(ring < nside, near, -near), 4 / 3 - 2 * ring / (3 * nside))
    return lon % 360, np.degrees(np.arcsin(z))
