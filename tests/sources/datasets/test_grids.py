"""Repeated rows and columns of a grid, and masks."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import xarray as xr
from earth_data import DEGREES, components

from flowtex import FlowField
from flowtex._util.array_types import Floats
from flowtex.errors import FieldError
from flowtex.sources.datasets.coordinates import Places
from flowtex.sources.datasets.staggered import unrepeated


def curvilinear(lon: Floats, lat: Floats, **more: Any) -> xr.Dataset:
    """The rotation at places (J, I), eastward and northward."""
    u, v = components(lon, lat)
    dims = ("y", "x")
    named = {"units": "m/s"}
    return xr.Dataset(
        {
            "uo": (dims, u, {"standard_name": "eastward_sea_water_velocity", **named}),
            "vo": (dims, v, {"standard_name": "northward_sea_water_velocity", **named}),
            **more,
        },
        {"lon": (dims, lon, DEGREES["lon"]), "lat": (dims, lat, DEGREES["lat"])},
    )


def folded(rows: int = 30, columns: int = 40, pivot: int = 0) -> tuple[Floats, Floats]:
    """A grid that is folded onto itself at its end, and a row beyond the fold."""
    i, j = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows + 1.0))
    beyond = j > rows - 1
    # Beyond the seam the nodes are those below it, from the other end.
    i = np.where(beyond, columns - i, i)
    j = np.where(beyond, 2 * (rows - 1) - j + (1 - pivot), j)
    bend = (j / rows) ** 4 * 20 * np.cos(2 * np.pi * i / columns)
    return i * 360 / columns + 3 * np.sin(np.pi * j / rows), 80 * (j / rows) - bend


@pytest.mark.parametrize("halo", [2, 3])
def test_a_halo_beyond_the_date_line_is_left_out(halo: int) -> None:
    lon, lat = np.meshgrid(np.arange(36 + halo) * 10.0, np.linspace(-60, 60, 20))
    lon, lat = (lon + lat / 4) % 360, lat
    field = FlowField.from_xarray(curvilinear(lon, lat), globe=True)
    assert field.shape == (20, 37) and field.periodic == (False, True)


def test_masked_and_unset_positions_are_land() -> None:
    lon, lat = np.meshgrid(np.linspace(0, 20, 30), np.linspace(40, 50, 20))
    lon = lon + lat / 10
    mask = (np.arange(20)[:, None] > 4) & np.ones(30, bool)
    masked = curvilinear(lon, lat, tmask=(("y", "x"), mask.astype(float)))
    assert np.array_equal(FlowField.from_xarray(masked, globe=True).valid, mask)
    with pytest.raises(
        FieldError,
        match=r"^mask is 'tmsk'; did you mean 'tmask'\? To draw all values, use mask=False",
    ):
        FlowField.from_xarray(masked, mask="tmsk")
    lon[15:], lat[15:] = 0.0, 0.0  # as where a model leaves out processors
    assert not FlowField.from_xarray(curvilinear(lon, lat), globe=True).valid[15:].any()


def test_mask_that_hides_everything_is_not_used() -> None:
    lon, lat = np.meshgrid(np.arange(0.0, 30), np.arange(40.0, 60))
    land = (("y", "x"), np.ones(lon.shape))
    field = FlowField.from_xarray(curvilinear(lon, lat, LANDMASK=land))
    assert field.valid.all() and "LANDMASK is not used" in str(field.reading)


@pytest.mark.parametrize("pivot", [0, 1])
def test_rows_beyond_the_fold_are_left_out(pivot: int) -> None:
    lon, lat = folded(pivot=pivot)
    places = Places(lon, lat, is_earth=True, is_line=False, why="")
    rows, columns = unrepeated(places)
    assert rows == slice(0, len(lon) - 1)
    assert columns == slice(0, 40)
    plain = Places(lon[:20], lat[:20], is_earth=True, is_line=False, why="")
    assert unrepeated(plain) == (slice(0, 20), slice(0, 40))
