"""Positions of the cells of HEALPix grids, which files give by numbers alone."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flowtex._util.array_types import Floats, Indices
from flowtex.errors import FieldError
from flowtex.sources.datasets.coordinates import LONGITUDE

if TYPE_CHECKING:
    import xarray as xr

#: Attributes that name the grid: of CF's grid mapping, and of the cell numbers of xdggs.
GRID_NAMES = ("grid_mapping_name", "grid_name")
#: Names of dimensions and coordinates of cells.
CELLS = re.compile(r"^(healpix\w*|hp|cells?|cell_ids?|i?pix|pixels?)$", re.IGNORECASE)
#: Words for numbering, and whether cells are nested.
ORDERS = {"ring": False, "nest": True, "nested": True}


def with_centres(datasets: Sequence[xr.Dataset]) -> list[xr.Dataset]:
    """Return datasets in which cells of HEALPix have a longitude and a latitude."""
    grid = _grid_attributes(datasets)
    if grid is None:
        return list(datasets)
    return [_with_centres(ds, grid) for ds in datasets]


def _grid_attributes(datasets: Sequence[xr.Dataset]) -> dict[str, Any] | None:
    """Return the attributes of the grid, without prefixes; ``None`` for other grids."""
    for ds in datasets:
        holders = [dict(a.attrs) for a in ds.variables.values()]
        grids = []
        for attrs in holders:
            if "healpix" in map(attrs.get, GRID_NAMES):
                grids.append(attrs)
        group = ds.attrs.get("dggs")  # the convention of Zarr groups
        if isinstance(group, Mapping) and group.get("name") == "healpix":
            grids.append(dict(group))
        if grids:
            return {str(key).removeprefix("healpix_"): value for key, value in grids[0].items()}
    return None


def _with_centres(ds: xr.Dataset, grid: Mapping[str, Any]) -> xr.Dataset:
    """Return a dataset on a HEALPix grid with longitudes and latitudes of its cells."""
    dim = _cell_dimension(ds, grid)
    located = [name for name, a in ds.variables.items() if dim in a.dims]
    if not dim or any(LONGITUDE.match(str(name)) for name in located):
        return ds
    cells = _cell_numbers(ds, dim)
    nside = _resolution(grid, len(cells))
    nested = ORDERS.get(str(grid.get("order", grid.get("indexing_scheme"))).lower())
    is_power = nside > 0 and nside & (nside - 1) == 0
    fits = nside > 0 and len(cells) > 0 and 0 <= cells.min() <= cells.max() < 12 * nside**2
    if nested is None or not fits or (nested and not is_power):
        raise FieldError(
            f"the HEALPix grid {dict(grid)} does not fit the {len(cells):,} cells along {dim!r}; "
            "expected the attributes healpix_nside, and healpix_order 'ring' or 'nested', and "
            "12 nside² cells, or an integer coordinate with the numbers of the cells"
        )
    lon, lat = healpix_centres(cells, nside, nested=nested)
    return ds.assign_coords(
        lon=(dim, lon, {"units": "degrees_east"}), lat=(dim, lat, {"units": "degrees_north"})
    )


def _cell_dimension(ds: xr.Dataset, grid: Mapping[str, Any]) -> str:
    """Return the dimension of the cells; empty where a dataset has none."""
    own = [a for a in ds.variables.values() if "healpix" in map(a.attrs.get, GRID_NAMES)]
    if own and own[0].ndim == 1:
        return str(own[0].dims[0])
    for name, a in ds.variables.items():
        if a.ndim == 1 and CELLS.match(str(name)):
            return str(a.dims[0])
    named = [str(dim) for dim in ds.dims if CELLS.match(str(dim))]
    fitting = [str(dim) for dim, n in ds.sizes.items() if n == 12 * _resolution(grid, n) ** 2]
    return next(iter((*named, *fitting)), "")


def _cell_numbers(ds: xr.Dataset, dim: str) -> Indices:
    """Return the numbers of the cells in the full grid; without a coordinate, all of them."""
    for c in ds.coords.values():
        if c.dims == (dim,) and c.dtype.kind in "iu":
            return np.asarray(c.values, dtype=np.int64)
    return np.arange(ds.sizes[dim])


def _resolution(grid: Mapping[str, Any], count: int) -> int:
    """Return nside, the number of cells along a side of the 12 faces; 0 where unknown."""
    level = grid.get("refinement_level", grid.get("level", grid.get("zoom")))
    if level is not None:
        return int(2 ** int(level))
    if "nside" in grid:
        return int(grid["nside"])
    nside = math.isqrt(count // 12)
    if 12 * nside**2 != count:
        return 0
    return nside


def healpix_centres(cells: Indices, nside: int, *, nested: bool) -> tuple[Floats, Floats]:
    """Return longitudes and latitudes in degrees of cells, by their numbers in a full grid.

    The rows of a grid are rings of latitude, counted from 1 at the north pole: in the caps around
    the poles ring i has 4i cells, and in the belt between them each ring has 4 nside.

    Parameters
    ----------
    cells
        Numbers of cells, from 0, (N,).
    nside
        Number of cells along a side of each of the 12 faces.
    nested
        Whether cells are counted by face, in the order of a quadtree, or by ring.
    """
    if nested:
        ring, lon = _nested(cells, nside)
    else:
        ring, lon = _by_ring(cells, nside)
    from_pole = np.minimum(ring, 4 * nside - ring)
    in_cap = 1 - from_pole**2 / (3 * nside**2)
    in_cap = np.where(ring > 2 * nside, -in_cap, in_cap)
    in_belt = 4 / 3 - 2 * ring / (3 * nside)
    height = np.where(from_pole < nside, in_cap, in_belt)
    return lon % 360, np.degrees(np.arcsin(height))


def _by_ring(cells: Indices, nside: int) -> tuple[Indices, Floats]:
    """Return the rings and the longitudes of cells that are counted along rings."""
    count = 12 * nside**2
    cap = 2 * nside * (nside - 1)  # number of cells in a cap
    is_south = cells >= count - cap
    from_pole = np.where(is_south, count - 1 - cells, cells)
    is_cap = from_pole < cap
    # Before ring i of a cap there are 2 i (i - 1) cells.
    cap_ring = (1 + np.sqrt(1 + 2 * np.where(is_cap, from_pole, 0)).astype(np.int64)) // 2
    cap_lon = (from_pole - 2 * cap_ring * (cap_ring - 1) + 0.5) * 90 / cap_ring
    cap_lon = np.where(is_south, -cap_lon, cap_lon)
    cap_ring = np.where(is_south, 4 * nside - cap_ring, cap_ring)
    row, column = np.divmod(np.where(is_cap, 0, cells - cap), 4 * nside)
    # Every second ring of the belt starts half a cell further east.
    belt_lon = (column + 0.5 * (row % 2 == 0)) * 90 / nside
    return np.where(is_cap, cap_ring, row + nside), np.where(is_cap, cap_lon, belt_lon)


def _nested(cells: Indices, nside: int) -> tuple[Indices, Floats]:
    """Return the rings and the longitudes of cells that are counted as a quadtree per face."""
    face, inside = np.divmod(cells, nside**2)
    # Even bits of a number give the place towards north-east, odd ones towards north-west.
    east = np.zeros_like(inside)
    west = np.zeros_like(inside)
    for bit in range(nside.bit_length()):
        east |= ((inside >> 2 * bit) & 1) << bit
        west |= ((inside >> (2 * bit + 1)) & 1) << bit
    row, column = np.divmod(face, 4)
    ring = (row + 2) * nside - east - west - 1
    cells_of_quarter = np.minimum(np.minimum(ring, 4 * nside - ring), nside)
    middle = 2 * column + (row != 1)  # of a face, in eighths of a turn
    return ring, (middle + (east - west) / cells_of_quarter) * 45
