"""Cells of HEALPix: positions by number, a closed globe, and errors for other numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import components

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.field.earth.projection import GLOBE, Projection
from flowtex.sources.models.healpix import healpix_centres

pytestmark = pytest.mark.filterwarnings("ignore::flowtex.sources.notices.DatasetNotice")

EAST, NORTH = ({"units": "m s-1", "standard_name": f"{w}ward_wind"} for w in ("east", "north"))


def share_of_sphere(field: FlowField) -> float:
    """The share of the sphere's area that the triangles of a globe cover."""
    assert field.triangles is not None
    p = field.points[0] / np.linalg.norm(field.points[0], axis=1, keepdims=True)
    a, b, c = (p[field.triangles[:, corner]] for corner in range(3))
    volume = (a * np.cross(b, c)).sum(axis=1)
    cosines = (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1)
    solid_angles = 2 * np.arctan2(volume, 1 + cosines)
    assert (solid_angles > 0).all()
    return float(solid_angles.sum() / (4 * np.pi))


def fault(field: FlowField, lon: Floats, lat: Floats) -> float:
    """The greatest error of components on the globe in m/s, whose nodes must be the cells."""
    globe = Projection(GLOBE)
    nodes, cells = (
        np.unique(p.round(), axis=0) for p in (field.points[0], globe.positions(lon, lat))
    )
    assert np.array_equal(nodes, cells)
    at = globe.lonlat(field.points[0])
    drawn = globe.components(*at, np.asarray(field.velocity[0])[0])
    errors = [np.abs(a - b).max() for a, b in zip(drawn, components(*at), strict=True)]
    return float(max(errors))


def healpix(nside: int, order: str) -> xr.Dataset:
    """The turning Earth on a grid whose mapping has the names of CF."""
    u, v = components(*healpix_centres(np.arange(12 * nside**2), nside, nested=order != "ring"))
    crs = {"grid_mapping_name": "healpix", "healpix_nside": nside, "healpix_order": order}
    more = {"grid_mapping": "crs"}
    variables = {"ua": ("cell", u, EAST | more), "va": ("cell", v, NORTH | more)}
    return xr.Dataset(variables | {"crs": ((), 0, crs)})


@pytest.mark.parametrize("nested", [False, True])
def test_centres_match_astropy(*, nested: bool) -> None:
    cells = np.array([0, 3, 9, 23, 24, 47, 88, 104, 151, 168, 190, 191])
    lon, lat = healpix_centres(cells, 4, nested=nested)
    # From astropy-healpix 1.1.
    if nested:
        a = [45, 45, 33.75, 165, 112.5, 225, 67.5, 157.5, 157.5, 195, 303.75, 315]
        b = [9.5941, 30, 41.8103, 54.3409, 30, 78.2841, -9.5941, -9.5941, -30, -54.3409]
        b += [-19.4712, -9.5941]
    else:
        a = [45, 315, 247.5, 345, 11.25, 157.5, 11.25, 0, 337.5, 15, 225, 315]
        b = [78.2841, 78.2841, 66.4435, 54.3409, 41.8103, 30, 0, -9.5941, -30, -54.3409]
        b += [-78.2841, -78.2841]
    assert np.allclose(lon, a, atol=1e-4)
    assert np.allclose(lat, b, atol=1e-4)


@pytest.mark.parametrize("nside", [1, 2, 8, 64])
def test_both_orders_have_the_same_cells(nside: int) -> None:
    cells = np.arange(12 * nside**2)
    ring, nested = (
        np.stack(healpix_centres(cells, nside, nested=nested), axis=-1).round(9)
        for nested in (False, True)
    )
    assert len(np.unique(ring, axis=0)) == len(cells)
    assert np.array_equal(np.unique(ring, axis=0), np.unique(nested, axis=0))


@pytest.mark.parametrize("order", ["ring", "nested"])
@pytest.mark.parametrize("nside", [2, 4, 16])
def test_cells_cover_the_globe(nside: int, order: str) -> None:
    cells = np.arange(12 * nside**2)
    field = FlowField.from_xarray(healpix(nside, order), globe=True)
    assert share_of_sphere(field) == pytest.approx(1)
    assert fault(field, *healpix_centres(cells, nside, nested=order != "ring")) < 1e-6


def renamed(ds: xr.Dataset, form: str) -> xr.Dataset:
    """Return a dataset in which another convention names the grid."""
    if form == "part":
        cells = np.arange(12 * 8**2)
        return ds.assign_coords(cell=cells).isel(cell=slice(100, 500))
    names = {"indexing_scheme": "nested", "refinement_level": 3}
    if form == "CF 1.13":
        return ds.assign(crs=((), 0, {"grid_mapping_name": "healpix", **names}))
    if form == "xdggs":
        words = {"grid_name": "healpix", "level": 3, "indexing_scheme": "nested"}
        return ds.drop_vars("crs").assign_coords(cell_ids=("cell", np.arange(768), words))
    if form == "Zarr group":
        return ds.drop_vars("crs").assign_attrs(dggs={"name": "healpix", **names})
    return ds.rename(cell="x").assign(crs=((), 0, {**ds["crs"].attrs, "healpix_nside": 8.0}))


@pytest.mark.parametrize("form", ["part", "CF 1.13", "xdggs", "Zarr group", "other name"])
def test_other_forms_of_the_grid(form: str) -> None:
    ds = renamed(healpix(8, "nested"), form)
    cells = np.arange(768)
    if form == "part":
        cells = cells[100:500]
    field = FlowField.from_xarray(ds, globe=True)
    assert fault(field, *healpix_centres(cells, 8, nested=True)) < 1e-6


@pytest.mark.parametrize(
    "attrs",
    [
        {"healpix_nside": 4},
        {"healpix_order": "spiral"},
        {"healpix_nside": 3, "healpix_order": "nest"},
    ],
)
def test_grid_that_does_not_fit_raises(attrs: dict[str, Any]) -> None:
    ds = healpix(8, "ring")
    ds["crs"].attrs |= attrs
    with pytest.raises(FieldError, match=r"not fit the 768 cells along 'cell'.*healpix_nside"):
        FlowField.from_xarray(ds)
