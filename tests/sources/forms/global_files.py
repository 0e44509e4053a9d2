"""Grids of the globe whose cells are no lattice of longitudes and latitudes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from known_flow import EAST, NORTH, Truth, wind
from scipy.spatial import ConvexHull
from supported import Made, supported

from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.sources.models.healpix import healpix_centres

KIND = "Grids of the globe"


def turning(lon: Any, lat: Any, hours: Any = 0.0) -> tuple[Any, Any]:
    """Velocity of a sphere that turns about a tilted axis, also smooth at the poles."""
    a, b = np.radians(lon), np.radians(lat)
    return 9 * np.cos(b) - 5 * np.cos(a) * np.sin(b), 5 * np.sin(a) + 0 * b


def at(lon: Any, lat: Any, dim: str, flow: Any = wind) -> dict[str, Any]:
    """Return the flow along one dimension."""
    u, v = flow(lon, lat)
    return {"u": (dim, u, EAST), "v": (dim, v, NORTH)}


def truth(lon: Any, lat: Any) -> Truth:
    return Truth(np.stack([lon, lat], axis=-1))


@supported(
    KIND,
    "HEALPix, with a grid mapping of CF",
    'flowtex.show("healpix.nc", globe=True)',
    "`healpix_nside` or `refinement_level`; rings or nested",
)
def healpix_file(folder: Path) -> Made:
    lon, lat = healpix_centres(np.arange(12 * 16**2), 16, nested=True)
    crs = {"grid_mapping_name": "healpix", "healpix_nside": 16, "healpix_order": "nest"}
    xr.Dataset({**at(lon, lat, "cell"), "crs": ((), 0, crs)}).to_netcdf(folder / "healpix.nc")
    return {}, truth(lon, lat)


@supported(
    KIND,
    "HEALPix of xdggs, all cells or some",
    "flowtex.show(ds, globe=True)",
    "the numbers in `cell_ids`",
)
def healpix_of_xdggs(folder: Path) -> Made:
    cells = np.arange(480 + 10 * 64)  # rings from the north pole
    lon, lat = healpix_centres(cells, 16, nested=False)
    words = {"grid_name": "healpix", "level": 4, "indexing_scheme": "ring"}
    ids = {"cell_ids": ("cells", cells, words)}
    return {"ds": xr.Dataset(at(lon, lat, "cells"), ids)}, truth(lon, lat)


def octahedral(rows: int) -> tuple[Any, Any]:
    """Return longitudes and latitudes of an octahedral reduced Gaussian grid."""
    from_pole = np.minimum(np.arange(rows), np.arange(rows)[::-1])
    counts = 20 + 4 * from_pole
    sines, _ = np.polynomial.legendre.leggauss(rows)
    lon = np.concatenate([np.arange(count) * 360 / count for count in counts])
    return lon, np.repeat(np.degrees(np.arcsin(sines))[::-1], counts)


@supported(
    KIND,
    "reduced Gaussian grids, such as octahedral ones of ECMWF",
    'flowtex.show("octahedral.nc", globe=True)',
    "points along one dimension, joined by triangles, also over poles",
)
def octahedral_file(folder: Path) -> Made:
    lon, lat = octahedral(32)
    places = {"longitude": ("values", lon), "latitude": ("values", lat)}
    xr.Dataset(at(lon, lat, "values"), places).to_netcdf(folder / "octahedral.nc")
    return {}, truth(lon, lat)


def sphere(count: int) -> tuple[Any, Any, Any]:
    """Return even points on the sphere in degrees, (N,) each, and triangles, (M, 3)."""
    sine = 1 - (2 * np.arange(count) + 1) / count
    lon = np.arange(count, dtype=np.float64) * 180 * (3 - 5**0.5) % 360
    lat = np.degrees(np.arcsin(sine)).astype(np.float64)
    points = Projection(GLOBE).positions(lon, lat)
    return lon, lat, ConvexHull(points).simplices


@supported(
    KIND,
    "ICON: `clon` and `clat` alone",
    'flowtex.show("icon.nc", globe=True)',
    "middles of cells, in radians or degrees, are joined by triangles",
)
def icon_middles(folder: Path) -> Made:
    lon, lat, _ = sphere(600)
    radians = {"units": "radian"}
    places = {
        "clon": ("cell", np.radians((lon + 180) % 360 - 180), radians),
        "clat": ("cell", np.radians(lat), radians),
    }
    xr.Dataset(at(lon, lat, "cell"), places).to_netcdf(folder / "icon.nc")
    return {}, truth(lon, lat)


@supported(
    KIND,
    "ICON and lists of cells with `clon_vertices`, `lon_bnds`",
    'flowtex.show("cells.nc", globe=True)',
    "values of cells become means at their corners",
)
def icon_cells(folder: Path) -> Made:
    lon, lat, triangles = sphere(2500)
    points = Projection(GLOBE).positions(lon, lat)
    middle = Projection(GLOBE).lonlat(points[triangles].mean(axis=1))
    corners = ("cell", "vertices")
    places = {
        "clon": ("cell", np.radians(middle[0])),
        "clat": ("cell", np.radians(middle[1])),
        "clon_vertices": (corners, np.radians(lon[triangles])),
        "clat_vertices": (corners, np.radians(lat[triangles])),
    }
    xr.Dataset(at(*middle, "cell", turning), places).to_netcdf(folder / "cells.nc")
    return {}, Truth(np.stack([lon, lat], axis=-1), flow=turning, tolerance=0.02)
